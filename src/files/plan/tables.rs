//! Sizes of a run's tables.

use crate::output::{RowSchedule, Schedule, gauge_records};
use crate::preflight::Approach;
use crate::run::columns::{BODIES, CONTACTS, GAUGES, HISTORY, LOADS, WITNESS, columns};
use engine::measure::Gauges;
use model::{Cadence, Case};

/// Bytes of a number in a table with its comma: one with all its digits, and one that is zero or a small count.
const NUMBER: f64 = 19.5;
const NOUGHT: f64 = 4.0;

/// Bytes of a number in records of many gauges.
const RECORDED: f64 = 8.0;

/// Bytes of the tables of a case of so many steps. Of measures, fragments and crossings, which nobody knows before, there is
/// nothing.
#[allow(clippy::cast_precision_loss, reason = "an estimate")]
pub(super) fn bytes(case: &Case, approaches: &[Approach], steps: f64) -> f64 {
    let [rows, of_bodies] = RowSchedule::of(case).counts(steps, case.run.end_time);
    let width = |list| columns(case.extent(), list).len() as f64;
    let bodies = case.bodies.len() as f64;
    let mut each_row = NUMBER * width(HISTORY);
    each_row += NUMBER * width(CONTACTS) * touching(case, approaches);
    each_row += NUMBER * width(LOADS) * case.load_names().count() as f64;
    let sides = 2.0 * case.measure.witnesses.len() as f64 * bodies;
    each_row += NOUGHT * width(WITNESS) * sides;
    let figures = if case.measure.bodies {
        NUMBER * width(BODIES) * bodies
    } else {
        0.0
    };
    rows * each_row + of_bodies * figures + gauges(case, steps)
}

/// Mean number of pairs of bodies with contact that have met in a run, as far as that is foreseen.
fn touching(case: &Case, approaches: &[Approach]) -> f64 {
    let pushes = |pair: &&Approach| {
        let [a, b] = pair.bodies;
        case.contact_between(a, b).class().is_some()
    };
    let left = |pair: &Approach| (1.0 - pair.time / case.run.end_time).max(0.0);
    approaches.iter().filter(pushes).map(left).sum()
}

/// Bytes of the readings of gauges.
#[allow(clippy::cast_precision_loss, reason = "an estimate")]
fn gauges(case: &Case, steps: f64) -> f64 {
    let all = &case.measure.gauges;
    let width = columns(case.extent(), GAUGES).len() + Gauges::new(case).columns().count();
    let each = if all.len() < gauge_records::MANY {
        NUMBER
    } else {
        RECORDED
    };
    let readings = all.iter().map(|gauge| match gauge.every {
        Cadence::Steps(every) => 1.0 + (steps / every.max(1) as f64).floor(),
        Cadence::Time(every) => {
            1.0 + Schedule::new(Some(every))
                .count(case.run.end_time)
                .min(steps)
        }
    });
    each * width as f64 * readings.sum::<f64>()
}
