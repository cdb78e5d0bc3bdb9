//! Times at which a run writes rows of its tables.

use super::Schedule;
use model::{Cadence, Case, RunControl};

/// Rows of a run without an interval of its own: enough for a curve, and for one of 200 also where steps are
/// uneven.
const ROWS: u32 = 250;

/// Such rows of `bodies.csv`, which cost most: some 7 % of a step.
const BODIES: u32 = 50;

/// Most steps between two checks of the sums over all particles, which find spurious gains of energy.
const SUMS_EVERY: u64 = 10;

/// Due rows of `history.csv` and the tables that go with it: a pure function of steps and
/// their times, as [`Schedule`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowSchedule {
    rows: Marks,
    bodies: Marks,
}

/// Steps and times at which something is due.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Marks {
    steps: Option<u64>,
    time: Schedule,
}

impl Marks {
    fn new(steps: Option<u64>, time: Option<f64>) -> Self {
        Self {
            steps: steps.map(|steps| steps.max(1)),
            time: Schedule::new(time),
        }
    }

    /// A number of marks in a run, evenly by time and by steps.
    fn evenly(run: &RunControl, count: u32) -> Self {
        let steps = run.max_steps.map(|most| most / u64::from(count));
        Self::new(steps, Some(run.end_time / f64::from(count)))
    }

    /// About how often they are met in so many steps to a time (s).
    #[allow(clippy::cast_precision_loss, reason = "an estimate")]
    fn count(&self, steps: f64, end: f64) -> f64 {
        let by_steps = self.steps.map_or(0.0, |every| steps / every as f64);
        (by_steps.floor() + self.time.count(end)).min(steps)
    }

    fn are_met(&self, step: u64, before: f64, now: f64) -> bool {
        let by_steps = self.steps.is_some_and(|every| step.is_multiple_of(every));
        by_steps || self.time.is_due(before, now)
    }
}

impl RowSchedule {
    /// Of a case; by default at fractions of its end by time and by steps, whichever comes first.
    #[must_use]
    pub fn of(case: &Case) -> Self {
        let same = |marks| Self {
            rows: marks,
            bodies: marks,
        };
        match case.output.history_every {
            Some(Cadence::Steps(steps)) => same(Marks::new(Some(steps), None)),
            Some(Cadence::Time(time)) => same(Marks::new(None, Some(time))),
            None => Self {
                rows: Marks::evenly(&case.run, ROWS),
                bodies: Marks::evenly(&case.run, BODIES),
            },
        }
    }

    /// About how many rows are due in so many steps to a time (s), that of the start with them, and how many of those have
    /// bodies too.
    #[must_use]
    pub fn counts(&self, steps: f64, end: f64) -> [f64; 2] {
        [self.rows, self.bodies].map(|marks| 1.0 + marks.count(steps, end))
    }

    /// Returns true if a row is due after a step of this number from time `before` to time `now` (s).
    #[must_use]
    pub fn is_due(&self, step: u64, before: f64, now: f64) -> bool {
        self.rows.are_met(step, before, now) || self.bodies_are_due(step, before, now)
    }

    /// Returns true if rows of bodies are due too.
    #[must_use]
    pub fn bodies_are_due(&self, step: u64, before: f64, now: f64) -> bool {
        self.bodies.are_met(step, before, now)
    }

    /// Returns true if the sums over all particles are due after such a step: for a row, and every
    /// n-th step where rows are rare.
    #[must_use]
    pub fn sums_are_due(&self, step: u64, before: f64, now: f64) -> bool {
        step.is_multiple_of(SUMS_EVERY) || self.is_due(step, before, now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of rows in `steps` steps up to a time of 1 s, and of those with bodies.
    fn rows(schedule: RowSchedule, steps: u32) -> [usize; 2] {
        let time = |n: u32| f64::from(n) / f64::from(steps);
        let count = |due: fn(&RowSchedule, u64, f64, f64) -> bool| {
            let due = |n: &u32| due(&schedule, u64::from(*n), time(n - 1), time(*n));
            (1..=steps).filter(due).count()
        };
        [
            count(RowSchedule::is_due),
            count(RowSchedule::bodies_are_due),
        ]
    }

    fn default_schedule(max_steps: Option<u64>) -> RowSchedule {
        let run = RunControl {
            end_time: 1.0,
            max_steps,
        };
        RowSchedule {
            rows: Marks::evenly(&run, ROWS),
            bodies: Marks::evenly(&run, BODIES),
        }
    }

    #[test]
    fn short_runs_have_every_step_and_long_ones_a_curve() {
        for (steps, expected) in [(9, 9), (150, 150), (240, 240), (400, 250), (100_000, 250)] {
            let [all, bodies] = rows(default_schedule(None), steps);
            // Marks of the two may differ by rounding, and so by a step.
            assert!(all >= expected && all <= expected + 50, "{steps}: {all}");
            assert!(
                bodies <= 50 && bodies >= expected.min(49),
                "{steps}: {bodies}"
            );
        }
        // As many again at most, where the case limits steps too.
        let [all, _] = rows(default_schedule(Some(10_000)), 10_000);
        assert!((250..=550).contains(&all), "{all}");
    }

    #[test]
    fn sums_are_looked_at_where_rows_are_rare() {
        let never = Marks::new(None, None);
        let rare = RowSchedule {
            rows: never,
            bodies: never,
        };
        let due = (1..=100).filter(|&step| rare.sums_are_due(step, 0.1, 0.2));
        assert_eq!(due.count(), 10);
    }
}
