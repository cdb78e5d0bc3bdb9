//! `touch`: bodies moved until their outermost layers are one mean spacing apart, and bodies laid
//! on rigid planes, half a spacing from them.

use std::collections::HashMap;
use std::ops::Range;

use toml::Spanned;

use super::in_dimension;
use crate::input::schema::{BodyParams, Direction, TouchParams};
use crate::input::source::Diagnostic;
use model::{Axis, Body, RigidSurface, SurfaceShape, SymmetryPlane, Vec3};
use populate;

/// A shape as near to a plane as this rests on it (spacings).
const RESTING: f64 = 1e-3;
/// Effect of rounding on places (spacings): bodies do not move for it, and begin as much farther
/// from a plane than where it pushes.
const ROUNDING: f64 = 1e-9;

/// Moves all bodies that touch others; a body moves after the one that it touches.
pub fn resolve(
    params: &[Spanned<BodyParams>],
    bodies: &mut [Body],
    dimension: usize,
) -> Result<(), Diagnostic> {
    let touches = targets(params, bodies)?;
    let mut state = vec![State::Waiting; bodies.len()];
    for start in 0..bodies.len() {
        // Along the chain of what is touched, then back from its end.
        let (mut chain, mut at) = (Vec::new(), start);
        while let (State::Waiting, Some((target, touch))) = (state[at], touches[at]) {
            state[at] = State::Moving;
            chain.push((at, target, touch));
            at = target;
        }
        if let (State::Moving, Some((_, touch))) = (state[at], touches[start]) {
            let title = "bodies touch each other in a circle: one of them must stand still";
            return Err(Diagnostic::new(touch.body.span(), title));
        }
        for (index, target, touch) in chain.into_iter().rev() {
            let (axis, forward) = direction(
                *touch.direction.get_ref(),
                touch.direction.span(),
                dimension,
            )?;
            let (body, other) = (&bodies[index], &bodies[target]);
            // A body without particles is refused later on.
            let distance = populate::touching_distance(body, other, dimension, axis, forward);
            translate(&mut bodies[index], axis, distance.unwrap_or(0.0));
            state[index] = State::Still;
        }
    }
    Ok(())
}

/// What a body that touches another does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Waiting,
    /// As soon as the one that it touches stands.
    Moving,
    Still,
}

/// By body, the one that it touches.
fn targets<'a>(
    params: &'a [Spanned<BodyParams>],
    bodies: &[Body],
) -> Result<Vec<Option<(usize, &'a TouchParams)>>, Diagnostic> {
    let names = || bodies.iter().map(|body| body.name.as_str()).enumerate();
    let places: HashMap<&str, usize> = names().map(|(index, name)| (name, index)).collect();
    let target = |(index, table): (usize, &'a Spanned<BodyParams>)| {
        let Some(touch) = &table.get_ref().touch else {
            return Ok(None);
        };
        let name = touch.body.get_ref();
        let found = places.get(name.as_str()).filter(|found| **found != index);
        found.map(|found| Some((*found, touch))).ok_or_else(|| {
            let others = names().filter(|(other, _)| *other != index);
            let others = others.map(|(_, name)| name);
            Diagnostic::unknown(touch.body.span(), "body", name, others)
        })
    };
    params.iter().enumerate().map(target).collect()
}

/// Moves bodies whose shapes rest on rigid planes until their outermost particles are where the
/// planes begin to push, and then all that touch others. A lattice need not fill its shape, and
/// stands in its middle; the layers of a close-packed one are not a spacing apart either.
pub fn lay_on_planes(
    params: &[Spanned<BodyParams>],
    bodies: &mut [Body],
    planes: &[RigidSurface],
    symmetry: &[SymmetryPlane],
    dimension: usize,
) -> Result<(), Diagnostic> {
    let mut moved = false;
    for (index, table) in params.iter().enumerate() {
        if table.get_ref().touch.is_some() {
            continue;
        }
        let body = &mut bodies[index];
        let acting = planes.iter().filter(|plane| plane.bodies[index]);
        let way = way_to_planes(body, acting, symmetry, dimension);
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            let distance = way[axis.index()];
            if distance.abs() > ROUNDING * body.lattice.spacing {
                translate(body, axis, distance);
                moved = true;
            }
        }
    }
    if moved {
        resolve(params, bodies, dimension)?;
        populate::fill(bodies, dimension, symmetry);
    }
    Ok(())
}

/// The way (m) of a body into touch with the planes that its shape rests on. Zero if there are
/// none, if no way leads to all of them, as between two plates, or if it led across a symmetry
/// plane.
fn way_to_planes<'a>(
    body: &Body,
    surfaces: impl Iterator<Item = &'a RigidSurface>,
    symmetry: &[SymmetryPlane],
    dimension: usize,
) -> Vec3 {
    let spacing = body.lattice.spacing;
    let mut ways = Vec::new();
    for surface in surfaces {
        let SurfaceShape::Plane { normal, position } = surface.shape else {
            continue;
        };
        let normal = Vec3::from(normal);
        if (body.shape.lowest(&normal) - position).abs() <= RESTING * spacing {
            let gap = populate::smallest_gap(body, dimension, symmetry, surface);
            ways.push((normal, (0.5 + ROUNDING) * spacing - gap));
        }
    }
    let all = ways.iter().map(|(normal, way)| *way * normal);
    let whole = all.fold(Vec3::zeros(), |sum, way| sum + way);
    let reaches = |(normal, way): &(Vec3, f64)| (whole.dot(normal) - way).abs() < RESTING * spacing;
    let crosses = |plane: &SymmetryPlane| whole[plane.axis.index()] != 0.0;
    if ways.iter().all(reaches) && !symmetry.iter().any(crosses) {
        whole
    } else {
        Vec3::zeros()
    }
}

/// The axis that a word at `at` names, and whether it points to larger coordinates.
pub fn direction(
    direction: Direction,
    at: Range<usize>,
    dimension: usize,
) -> Result<(Axis, bool), Diagnostic> {
    let (axis, forward) = match direction {
        Direction::PlusX => (Axis::X, true),
        Direction::MinusX => (Axis::X, false),
        Direction::PlusY => (Axis::Y, true),
        Direction::MinusY => (Axis::Y, false),
        Direction::PlusZ => (Axis::Z, true),
        Direction::MinusZ => (Axis::Z, false),
    };
    Ok((in_dimension(axis, dimension, at)?, forward))
}

fn translate(body: &mut Body, axis: Axis, distance: f64) {
    let mut way = Vec3::zeros();
    way[axis.index()] = distance;
    body.shape.translate(&way);
    body.filled = None;
    if let Some(grading) = &mut body.lattice.grading {
        grading.from.translate(&way);
    }
}
