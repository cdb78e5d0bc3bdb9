//! The relaxation by which bodies come to rest, and bodies that wait for its end.

use std::f64::consts::PI;

use toml::Spanned;

use crate::input::schema::{CaseParams, RelaxationParams};
use crate::input::source::Diagnostic;
use model::{Body, Case, Loads, Motion, Region, Relaxation, Vec3, VelocityLoad};

/// Reads the relaxation of a case that is whole but for it and what follows from forms of bodies.
pub fn relax(case: &mut Case, params: &CaseParams) -> Result<(), Diagnostic> {
    let Some(table) = &params.relaxation else {
        return Ok(());
    };
    let relaxation = table.get_ref();
    let until = relaxation.until()?;
    if until >= case.run.end_time {
        let title = "the relaxation must end before the run does";
        return Err(Diagnostic::new(relaxation.until.span(), title));
    }
    let waiting = waiting(case, relaxation, until)?;
    let rate = rate(case, table, &waiting)?;
    let of_body = |b: usize| {
        if relaxes(case, b, &waiting) {
            rate
        } else {
            0.0
        }
    };
    let rates = (0..case.bodies.len()).map(of_body).collect();
    case.loads.velocities.extend(waiting);
    case.loads.relaxation = Some(Relaxation { until, rates });
    Ok(())
}

/// True if a body relaxes: it deforms, no zone absorbs it, and it does not wait.
fn relaxes(case: &Case, body: usize, waiting: &[VelocityLoad]) -> bool {
    let absorbs = case.loads.absorbers.iter().any(|zone| zone.body == body);
    let waits = waiting.iter().any(|load| load.body == body);
    case.bodies[body].rigid.is_none() && !absorbs && !waits
}

/// What holds the bodies that wait, and lets them start.
fn waiting(
    case: &Case,
    params: &RelaxationParams,
    until: f64,
) -> Result<Vec<VelocityLoad>, Diagnostic> {
    let mut all: Vec<VelocityLoad> = Vec::new();
    for name in params.waiting.iter().flatten() {
        let body = case.body_named(name.get_ref()).ok_or_else(|| {
            let known = case.bodies.iter().map(|body| body.name.as_str());
            Diagnostic::unknown(name.span(), "body", name.get_ref(), known)
        })?;
        let held = &case.bodies[body];
        let mut loads = case.loads.velocities.iter().chain(&all);
        let refused = if held.is_free() {
            Some("is rigid and free, and cannot wait")
        } else if held.rigid.is_some() {
            Some("is rigid and can wait by its `motion`")
        } else if held.angular_velocity != Vec3::zeros() || held.initial.velocity.is_some() {
            Some("begins with velocities that differ from place to place, and cannot wait")
        } else if loads.any(|load| load.body == body) {
            Some("is driven by another load, or waits already")
        } else {
            None
        };
        if let Some(why) = refused {
            let title = format!("the body `{}` {why}", held.name);
            return Err(Diagnostic::new(name.span(), title));
        }
        all.push(start(body, held, until));
        let rigid = case.bodies.iter().filter(|body| body.rigid.is_some());
        if case.loads.velocities.len() + all.len() + rigid.count() > Loads::MOST {
            let title = format!(
                "a case can have at most {} loads, rigid and waiting bodies together",
                Loads::MOST
            );
            return Err(Diagnostic::new(name.span(), title));
        }
    }
    Ok(all)
}

/// The load that holds a body until a time (s), when it gives it its velocity.
fn start(index: usize, body: &Body, until: f64) -> VelocityLoad {
    let jump = |axis: usize| Some(vec![0.0, 0.0, body.velocity[axis]]);
    VelocityLoad {
        name: format!("{} waits", body.name),
        body: index,
        region: Region::OPEN,
        motion: Motion {
            times: vec![0.0, until, until],
            velocities: [jump(0), jump(1), jump(2)],
        },
        until,
        starts: true,
    }
}

/// The rate (1/s) that is stated, or the critical one of the slowest vibration of the bodies that relax: `2 ω` of
/// `ω = π c/2L`, that of a column which stands on its end, with the longest side L of the box around them all and the least
/// speed of sound.
fn rate(
    case: &Case,
    table: &Spanned<RelaxationParams>,
    waiting: &[VelocityLoad],
) -> Result<f64, Diagnostic> {
    if let Some(rate) = table.get_ref().rate()? {
        return Ok(rate);
    }
    let mut speed = f64::INFINITY;
    let mut around = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
    for b in (0..case.bodies.len()).filter(|&b| relaxes(case, b, waiting)) {
        let body = &case.bodies[b];
        let (lower, upper) = body.shape.solid(case.dimension).bounds();
        around = [around[0].inf(&lower), around[1].sup(&upper)];
        let of_sound = case.materials[body.material].longitudinal_speed();
        if of_sound > 0.0 {
            speed = speed.min(of_sound);
        }
    }
    let sides = (0..case.dimension).map(|a| around[1][a] - around[0][a]);
    let longest = sides.fold(0.0, f64::max);
    let rate = PI * speed / longest;
    if rate.is_finite() && rate > 0.0 {
        return Ok(rate);
    }
    let title = "no body relaxes in which sound has a speed, so the relaxation has no `rate`";
    Err(Diagnostic::new(table.span(), title))
}
