//! What a symmetry plane cuts does not move across it: its image would move the other way, and tear it.

use std::ops::Range;

use toml::Spanned;

use super::initial::{MOST_PLACES, key_span};
use crate::input::schema::CaseParams;
use crate::input::source::Diagnostic;
use model::{Body, Case, Motion, RigidSurface, SurfaceShape, SymmetryPlane, Vec3};
use populate::Wanted;

/// Velocities that differ by less than this part are the same but for rounding.
const ROUNDING: f64 = 1e-9;

/// Refuses motion of bodies, loads and rigid surfaces across the symmetry planes that cut them.
pub fn check(case: &Case, params: &CaseParams) -> Result<(), Diagnostic> {
    for plane in &case.symmetry {
        bodies(case, params, plane)?;
        loads(case, params, plane)?;
        surfaces(case, params, plane)?;
    }
    Ok(())
}

fn refused(what: &str, plane: &SymmetryPlane, at: Range<usize>) -> Diagnostic {
    let axis = plane.axis.name();
    let title = format!(
        "{what} moves across the symmetry plane of {axis} that cuts it, so that its mirror image moves the other way"
    );
    Diagnostic::new(at, title).help("let it move along the plane, or model the whole without it")
}

/// True if a body stands on both sides of a plane.
fn is_cut(body: &Body, dimension: usize, plane: &SymmetryPlane) -> bool {
    let ends = populate::bounds(body, dimension);
    ends.is_some_and(|(lower, _)| lower[plane.axis.index()] <= plane.position)
}

/// True if a motion ever goes along the normal of a plane.
fn goes(motion: &Motion, plane: &SymmetryPlane) -> bool {
    let mut along = motion.velocities[plane.axis.index()].iter().flatten();
    along.any(|&speed| speed != 0.0)
}

fn bodies(case: &Case, params: &CaseParams, plane: &SymmetryPlane) -> Result<(), Diagnostic> {
    let cut = |body: &Body| is_cut(body, case.dimension, plane);
    for (body, table) in case.bodies.iter().zip(&params.body) {
        let moves = match body.driven() {
            Some(motion) => goes(motion, plane),
            None => flows(case, body, plane),
        };
        // All planes cut a free rigid body.
        if moves && (body.is_free() || cut(body)) {
            let motion = table.get_ref().motion.as_ref();
            let at = motion.map_or_else(|| key_span(table, "velocity"), Spanned::span);
            return Err(refused(&format!("`{}`", body.name), plane, at));
        }
    }
    Ok(())
}

/// True if the velocity with which a deforming body begins has, in a plane, a part normal to it.
fn flows(case: &Case, body: &Body, plane: &SymmetryPlane) -> bool {
    let axis = plane.axis.index();
    if !body.initial.varies() && body.angular_velocity == Vec3::zeros() {
        return body.velocity[axis] != 0.0;
    }
    let reach = 1.5 * body.lattice.coarsest();
    let least = ROUNDING * (body.velocity.norm() + body.speed_spread());
    let (sites, _) = populate::sample(body, case.dimension, &case.symmetry, MOST_PLACES);
    let near = sites.filter(|site| site.position[axis] < plane.position + reach);
    let mut places = near.map(|site| {
        let mut place = Vec3::from(site.position);
        place[axis] = plane.position;
        place
    });
    places.any(|place| body.velocity_at(&place)[axis].abs() > least)
}

/// Loads on particles of a cut body within a spacing of the plane.
fn loads(case: &Case, params: &CaseParams, plane: &SymmetryPlane) -> Result<(), Diagnostic> {
    let axis = plane.axis.index();
    for (load, table) in case.loads.velocities.iter().zip(&params.load) {
        let body = &case.bodies[load.body];
        if !goes(&load.motion, plane) || !is_cut(body, case.dimension, plane) {
            continue;
        }
        // Nought where the load acts beside the plane, and infinite elsewhere.
        let reach = plane.position + body.lattice.coarsest();
        let value = |acts: bool| if acts { 0.0 } else { f64::INFINITY };
        let found = populate::search(
            (body, case.dimension, &case.symmetry),
            Wanted {
                most: 1,
                limit: 1.0,
                any: true,
            },
            |lower, upper| value(lower[axis] < reach && load.region.meets(lower, upper)),
            |x| value(x[axis] < reach && load.region.contains(x)),
        );
        if !found.is_empty() {
            let what = format!("what `{}` drives", load.name);
            return Err(refused(&what, plane, table.get_ref().velocity.span()));
        }
    }
    Ok(())
}

fn surfaces(case: &Case, params: &CaseParams, plane: &SymmetryPlane) -> Result<(), Diagnostic> {
    let axis = plane.axis.index();
    let planes = params.plane.iter().map(|table| {
        let table = table.get_ref();
        (table.motion.as_ref().map(Spanned::span), None)
    });
    let others = params.surface.iter().map(|table| {
        let table = table.get_ref();
        let [motion, turn] = [
            table.motion.as_ref().map(Spanned::span),
            table.rotation.as_ref().map(Spanned::span),
        ];
        (motion, turn)
    });
    let cut = |surface: &RigidSurface| {
        // A plane that faces a symmetry plane comes from afar.
        if let SurfaceShape::Plane { normal, .. } = &surface.shape {
            return normal[axis].abs() < 1.0;
        }
        let (lower, upper) = surface.bounds();
        lower[axis] < plane.position && upper[axis] > plane.position
    };
    for (surface, (motion, turn)) in case.loads.surfaces.iter().zip(planes.chain(others)) {
        // A turn about the normal is its own mirror image.
        let turns = surface
            .spin
            .as_ref()
            .is_some_and(|spin| spin.axis[axis].abs() < 1.0 && spin.rate.largest_speed() > 0.0);
        let at = motion.filter(|_| goes(&surface.motion, plane));
        if let Some(at) = at.or(turn.filter(|_| turns)).filter(|_| cut(surface)) {
            return Err(refused(&format!("`{}`", surface.name), plane, at));
        }
    }
    Ok(())
}
