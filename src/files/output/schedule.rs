//! Times at which output is due.

/// Due times 0, Δ, 2Δ, …: output due at `nΔ` happens at the first step at or after it.
///
/// A pure function of the step's times, so that neither a restart nor an early stop shifts
/// anything, and a restart may change the interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    every: Option<f64>,
}

impl Schedule {
    /// Due at an interval (s), or never. Intervals that are not positive mean never.
    #[must_use]
    pub fn new(every: Option<f64>) -> Self {
        Self {
            every: every.filter(|&every| every > 0.0),
        }
    }

    /// Number of due times up to one (s), but for zero.
    #[must_use]
    pub fn count(&self, end: f64) -> f64 {
        self.every.map_or(0.0, |every| passed(every, end))
    }

    /// Returns true if a step from time `before` to time `now` (s) reaches or passes a due time.
    #[must_use]
    pub fn is_due(&self, before: f64, now: f64) -> bool {
        self.every
            .is_some_and(|every| passed(every, before) < passed(every, now))
    }
}

/// The largest whole n with `n · every ≤ time`, in the arithmetic of that very product.
fn passed(every: f64, time: f64) -> f64 {
    let n = (time / every).floor();
    if (n + 1.0) * every <= time {
        n + 1.0
    } else if n * every > time {
        n - 1.0
    } else {
        n
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_due_time_is_met_once_at_the_first_step_at_or_after_it() {
        let schedule = Schedule::new(Some(0.1));
        let times = [0.0, 0.04, 0.1, 0.13, 0.19, 0.21, 0.55, 0.61];
        let due: Vec<f64> = times
            .windows(2)
            .filter(|step| schedule.is_due(step[0], step[1]))
            .map(|step| step[1])
            .collect();
        // 0.55 passes three due times at once and is one output.
        assert_eq!(due, [0.1, 0.21, 0.55, 0.61]);
    }

    #[test]
    fn rounding_neither_drops_nor_doubles_a_due_time() {
        // A run whose steps hit n·Δ as another product rounds it: 3 × 0.1 ≠ 0.3.
        for every in [0.1, 1e-8, 3e-9, 0.7] {
            let schedule = Schedule::new(Some(every));
            let mut time = 0.0;
            let mut count = 0;
            for n in 1..=10_000 {
                let next = f64::from(n) * every;
                count += u32::from(schedule.is_due(time, next));
                time = next;
            }
            assert_eq!(count, 10_000, "{every}");
        }
    }

    #[test]
    fn nothing_is_due_without_an_interval() {
        assert!(!Schedule::new(None).is_due(0.0, 1.0));
        assert!(!Schedule::new(Some(0.0)).is_due(0.0, 1.0));
        assert!(!Schedule::new(Some(f64::NAN)).is_due(0.0, 1.0));
    }
}
