//! Sizes and numbers of a run's files.

use super::tables;
use crate::output::OutputError;
use crate::output::snapshot::{Plan, bytes_per_particle};
use crate::preflight::Approach;
use engine::step::store_of;
use model::{Case, OutputOptions};
use particles::Life;

/// Files of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Files {
    /// Bytes of a default snapshot.
    pub snapshot: f64,
    /// Number of default snapshots.
    pub snapshots: f64,
    /// Bytes of all snapshots of schedules, as if each held all particles.
    pub further: f64,
    /// Bytes of a checkpoint.
    pub checkpoint: f64,
    /// Number of checkpoints written, by time and by steps.
    pub checkpoints: f64,
    /// Number of checkpoints kept.
    pub kept: f64,
    /// Bytes of tables.
    pub tables: f64,
}

impl Files {
    /// Files of a run with `particles`, `steps` and these approaches.
    ///
    /// # Errors
    /// [`OutputError::UnknownField`].
    #[allow(clippy::cast_precision_loss, reason = "bytes of a particle")]
    pub fn new(
        case: &Case,
        approaches: &[Approach],
        particles: f64,
        steps: f64,
    ) -> Result<Self, OutputError> {
        let store = store_of(case);
        let (output, end) = (&case.output, case.run.end_time);
        let plans = Plan::all(case, &store)?;
        let sizes = plans.iter().map(|plan| {
            let bytes = bytes_per_particle(&plan.format(), &store);
            particles * bytes as f64
        });
        let sizes: Vec<f64> = sizes.collect();
        let further = sizes[1..].iter().zip(&output.snapshots);
        let further = further.map(|(size, schedule)| size * times(schedule.every, end));
        let checkpoints = checkpoints(output, end, steps);
        Ok(Self {
            snapshot: sizes[0],
            snapshots: times(output.snapshot_every, end),
            further: further.sum(),
            checkpoint: particles * store.bytes_per_particle(Life::State) as f64,
            checkpoints,
            kept: checkpoints.min(output.checkpoints_kept as f64),
            tables: tables::bytes(case, approaches, steps),
        })
    }

    /// Bytes on the disk at the end.
    #[must_use]
    pub fn disk(&self) -> f64 {
        self.snapshots * self.snapshot + self.further + self.kept * self.checkpoint + self.tables
    }

    /// Bytes written in all.
    #[must_use]
    pub fn written(&self) -> f64 {
        self.snapshots * self.snapshot
            + self.further
            + self.checkpoints * self.checkpoint
            + self.tables
    }
}

/// Number of snapshots at an interval up to an end (s): the first and the last state are always written.
fn times(every: Option<f64>, end: f64) -> f64 {
    let Some(every) = every.filter(|&every| every > 0.0) else {
        return 2.0;
    };
    let due = (end / every * (1.0 + 1e-12)).floor();
    let last = if due * every < end * (1.0 - 1e-12) {
        1.0
    } else {
        0.0
    };
    1.0 + due + last
}

/// Number of checkpoints by time and by steps, and the last one; none by the clock.
#[allow(clippy::cast_precision_loss, reason = "few")]
fn checkpoints(output: &OutputOptions, end: f64, steps: f64) -> f64 {
    let by_time = output.checkpoint_every.map_or(0.0, |every| end / every);
    let by_steps = output
        .checkpoint_every_steps
        .map_or(0.0, |every| steps / every.max(1) as f64);
    // The last is that of the end.
    (by_time + by_steps).ceil().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::times;

    #[test]
    fn the_first_and_the_last_state_are_written_once() {
        for (every, count) in [
            (None, 2.0),
            (Some(0.5), 3.0),
            (Some(0.4), 4.0),
            (Some(2.0), 2.0),
        ] {
            assert!((times(every, 1.0) - count).abs() < 1e-12, "{every:?}");
        }
        assert!((times(Some(0.1), 0.3) - 4.0).abs() < 1e-12);
    }
}
