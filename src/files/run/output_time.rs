//! The share of output in the time of a run.

use std::time::{Duration, Instant};

use comm::Comm;

/// Time that a rank has spent in output, waiting for others included.
#[derive(Debug, Clone, Copy, Default)]
pub struct OutputTime {
    /// In snapshots.
    pub snapshots: Duration,
    /// In checkpoints.
    pub checkpoints: Duration,
    /// In all output.
    all: Duration,
}

impl OutputTime {
    /// Adds the time since the beginning of output.
    pub fn add(&mut self, begun: Instant) {
        self.all += begun.elapsed();
    }

    /// Seconds by type of output, the mean of all ranks. Collective.
    #[must_use]
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        reason = "nanoseconds of a run fit well"
    )]
    pub fn seconds(&self, comm: &Comm) -> Seconds {
        let times = [self.snapshots, self.checkpoints, self.all];
        let mut sums = times.map(|time| time.as_nanos() as u64);
        comm.sum_u64(&mut sums);
        let [snapshots, checkpoints, all] = sums.map(|sum| sum as f64 * 1e-9 / comm.size() as f64);
        Seconds {
            snapshots,
            checkpoints,
            others: (all - snapshots - checkpoints).max(0.0),
        }
    }
}

/// Seconds by type of output.
#[derive(Debug, Clone, Copy)]
pub struct Seconds {
    /// In snapshots.
    pub snapshots: f64,
    /// In checkpoints.
    pub checkpoints: f64,
    /// In tables and their measurements.
    pub others: f64,
}

impl Seconds {
    /// In all output.
    #[must_use]
    pub fn all(self) -> f64 {
        self.snapshots + self.checkpoints + self.others
    }

    /// With their names.
    #[must_use]
    pub fn by_name(self) -> [(&'static str, f64); 3] {
        [
            ("snapshots", self.snapshots),
            ("checkpoints", self.checkpoints),
            ("tables", self.others),
        ]
    }

    /// Fraction of a run of `wall` seconds.
    #[must_use]
    pub fn share(self, wall: f64) -> f64 {
        self.all() / wall.max(f64::MIN_POSITIVE)
    }

    /// A line for the log of such a run.
    #[must_use]
    pub fn line(self, wall: f64) -> String {
        let percent = 100.0 * self.share(wall);
        format!(
            "output took {:.3} s, {percent:.1} % of the time: snapshots {:.3} s, checkpoints {:.3} s, \
             tables and what they measure {:.3} s",
            self.all(),
            self.snapshots,
            self.checkpoints,
            self.others
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_neither_snapshot_nor_checkpoint_is_of_tables() {
        let time = OutputTime {
            snapshots: Duration::from_secs(1),
            checkpoints: Duration::from_secs(2),
            all: Duration::from_secs(4),
        };
        let seconds = time.seconds(&Comm::solo());
        assert!((seconds.share(40.0) - 0.1).abs() < 1e-12);
        assert_eq!(
            seconds.line(40.0),
            "output took 4.000 s, 10.0 % of the time: snapshots 1.000 s, checkpoints 2.000 s, \
             tables and what they measure 1.000 s"
        );
    }
}
