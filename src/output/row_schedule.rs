//! When a run writes rows of its tables.

use super::Schedule;
use crate::model::{Cadence, Case};

/// Rows of a run that does not say when it has them: enough for a curve, and for one of 200 also where
/// steps are uneven.
const ROWS: u32 = 250;

/// Most steps between two looks at the sums of all particles, which find what gains energy from nowhere.
const SUMS_EVERY: u64 = 10;

/// When rows of `history.csv` and the tables that go with it are due: a pure function of steps and
/// their times, as [`Schedule`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowSchedule {
    steps: Option<u64>,
    time: Schedule,
}

impl RowSchedule {
    /// Of a case; where it does not say, a part of its end by time and by steps, whichever comes.
    #[must_use]
    pub fn of(case: &Case) -> Self {
        let run = &case.run;
        let (steps, time) = match case.output.history_every {
            Some(Cadence::Steps(steps)) => (Some(steps), None),
            Some(Cadence::Time(time)) => (None, Some(time)),
            None => {
                let steps = run.max_steps.map(|most| most / u64::from(ROWS));
                (steps, Some(run.end_time / f64::from(ROWS)))
            }
        };
        Self {
            steps: steps.map(|steps| steps.max(1)),
            time: Schedule::new(time),
        }
    }

    /// Whether a row is due after a step of this number from time `before` to time `now` (s).
    #[must_use]
    pub fn is_due(&self, step: u64, before: f64, now: f64) -> bool {
        let by_steps = self.steps.is_some_and(|every| step.is_multiple_of(every));
        by_steps || self.time.is_due(before, now)
    }

    /// Whether the sums over all particles are to be looked at after such a step: for a row, and now and
    /// then where rows are rare.
    #[must_use]
    pub fn sums_are_due(&self, step: u64, before: f64, now: f64) -> bool {
        step.is_multiple_of(SUMS_EVERY) || self.is_due(step, before, now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of so many steps up to a time of 1 s.
    fn rows(schedule: RowSchedule, steps: u32) -> usize {
        let time = |n: u32| f64::from(n) / f64::from(steps);
        let due = |n: &u32| schedule.is_due(u64::from(*n), time(n - 1), time(*n));
        (1..=steps).filter(due).count()
    }

    #[test]
    fn short_runs_have_every_step_and_long_ones_a_curve() {
        let by_time = RowSchedule {
            steps: None,
            time: Schedule::new(Some(1.0 / f64::from(ROWS))),
        };
        for (steps, expected) in [(9, 9), (150, 150), (240, 240), (400, 250), (100_000, 250)] {
            assert_eq!(rows(by_time, steps), expected, "{steps}");
        }
        // As many again at most, where the case tells of steps too.
        let both = RowSchedule {
            steps: Some(40),
            ..by_time
        };
        assert!((250..=500).contains(&rows(both, 10_000)));
    }

    #[test]
    fn sums_are_looked_at_where_rows_are_rare() {
        let rare = RowSchedule {
            steps: None,
            time: Schedule::new(Some(1.0)),
        };
        let due = (1..=100).filter(|&step| rare.sums_are_due(step, 0.1, 0.2));
        assert_eq!(due.count(), 10);
    }
}
