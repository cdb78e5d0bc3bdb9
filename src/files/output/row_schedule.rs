//! When a run writes rows of its tables.

use super::Schedule;
use model::{Cadence, Case, RunControl};

/// Rows of a run that does not say when it has them: enough for a curve, and for one of 200 also where
/// steps are uneven.
const ROWS: u32 = 250;

/// The same of `bodies.csv`, whose rows cost most: some 7 % of a step.
const BODIES: u32 = 50;

/// Most steps between two looks at the sums of all particles, which find what gains energy from nowhere.
const SUMS_EVERY: u64 = 10;

/// When rows of `history.csv` and the tables that go with it are due: a pure function of steps and
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

    /// So many of a run, by time and by steps.
    fn parts(run: &RunControl, count: u32) -> Self {
        let steps = run.max_steps.map(|most| most / u64::from(count));
        Self::new(steps, Some(run.end_time / f64::from(count)))
    }

    fn are_met(&self, step: u64, before: f64, now: f64) -> bool {
        let by_steps = self.steps.is_some_and(|every| step.is_multiple_of(every));
        by_steps || self.time.is_due(before, now)
    }
}

impl RowSchedule {
    /// Of a case; where it does not say, a part of its end by time and by steps, whichever comes.
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
                rows: Marks::parts(&case.run, ROWS),
                bodies: Marks::parts(&case.run, BODIES),
            },
        }
    }

    /// Whether a row is due after a step of this number from time `before` to time `now` (s).
    #[must_use]
    pub fn is_due(&self, step: u64, before: f64, now: f64) -> bool {
        self.rows.are_met(step, before, now) || self.bodies_are_due(step, before, now)
    }

    /// Whether that row tells of each body too.
    #[must_use]
    pub fn bodies_are_due(&self, step: u64, before: f64, now: f64) -> bool {
        self.bodies.are_met(step, before, now)
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

    /// Rows of so many steps up to a time of 1 s, and those of them that tell of bodies.
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

    fn usual(max_steps: Option<u64>) -> RowSchedule {
        let run = RunControl {
            end_time: 1.0,
            max_steps,
        };
        RowSchedule {
            rows: Marks::parts(&run, ROWS),
            bodies: Marks::parts(&run, BODIES),
        }
    }

    #[test]
    fn short_runs_have_every_step_and_long_ones_a_curve() {
        for (steps, expected) in [(9, 9), (150, 150), (240, 240), (400, 250), (100_000, 250)] {
            let [all, bodies] = rows(usual(None), steps);
            // Marks of the two may differ by rounding, and so by a step.
            assert!(all >= expected && all <= expected + 50, "{steps}: {all}");
            assert!(
                bodies <= 50 && bodies >= expected.min(49),
                "{steps}: {bodies}"
            );
        }
        // As many again at most, where the case tells of steps too.
        let [all, _] = rows(usual(Some(10_000)), 10_000);
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
