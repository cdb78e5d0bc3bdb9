//! The report on a case, for programs.

use serde_json::{Value, json};

use super::{layer, machine, mass_of, meetings, wall_time};
use comm::Comm;
use files::output::unit_of_model;
use files::plan::{self, Files};
use files::preflight::{Approach, memory};
use model::{Body, Case};

/// The whole report, in SI units.
pub(super) fn document(
    case: &Case,
    approaches: &[Approach],
    ranks: usize,
    warnings: &[String],
) -> Value {
    let bodies: Vec<(Value, u64)> = case.bodies.iter().map(|body| of_body(case, body)).collect();
    let total: u64 = bodies.iter().map(|(_, count)| count).sum();
    let bodies: Vec<Value> = bodies.into_iter().map(|(body, _)| body).collect();
    let meetings = meetings(case, approaches).map(
        |(pair, names)| json!({ "bodies": names, "time": pair.time, "gap_spacings": pair.gap }),
    );
    let measures = case.measure.measures.iter();
    let measures: Vec<Value> = measures
        .map(|measure| json!({ "measure": measure.name, "kind": measure.kind.word() }))
        .collect();
    let steps = plan::expected_steps(case, approaches, 0.0);
    let machine = machine(case, approaches);
    #[allow(clippy::cast_precision_loss, reason = "an estimate")]
    let files = Files::new(case, approaches, total as f64, steps.unwrap_or(0.0)).ok();
    let wall = steps.zip(files);
    let wall = wall.map(|(steps, files)| wall_time(case, ranks, &machine, steps, &files));
    json!({
        "title": case.title,
        "dimension": case.dimension,
        "particles": total,
        "bodies": bodies,
        "ranks": ranks,
        "memory_of_rank": memory::of_rank(case, &Comm::solo(), ranks),
        "meetings": meetings.collect::<Value>(),
        "measures": measures,
        "gauges": case.measure.gauges.len(),
        "witness_planes": case.measure.witnesses.len(),
        "end_time": case.run.end_time,
        "steps": steps,
        "machine": machine.name,
        "wall_time": wall,
        "disk": files.map(|files| files.disk()),
        "warnings": warnings,
        "units": {
            "mass": unit_of_model("kg", case.extent()),
            "areal_density": "kg/m^2",
            "spacing": "m",
            "smoothing_length": "m",
            "memory_of_rank": "bytes",
            "time": "s",
            "end_time": "s",
            "wall_time": "s",
            "disk": "bytes",
        },
    })
}

/// A body, and the number of its particles.
fn of_body(case: &Case, body: &Body) -> (Value, u64) {
    let count = populate::count(body, case.dimension, &case.symmetry, None);
    let sizes = body.lattice.sizes.unwrap_or([1.0; 2]);
    let entry = json!({
        "body": body.name,
        "material": case.materials[body.material].name,
        "particles": count,
        "spacing": sizes.map(|size| size * body.lattice.spacing),
        "smoothing_length": sizes.map(|size| size * body.smoothing_length),
        "mass": mass_of(case, body, count),
        "areal_density": layer(case, body).map(|[areal, ..]| areal),
        "rigid": body.rigid.is_some(),
        "total": body.total,
    });
    (entry, count)
}
