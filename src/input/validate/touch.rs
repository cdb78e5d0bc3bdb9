//! `touch`: bodies moved until their outermost layers are one mean spacing apart.

use std::ops::Range;

use toml::Spanned;

use crate::input::schema::{BodyParams, Direction, TouchParams};
use crate::input::source::Complaint;
use crate::model::{Axis, Body, Shape};
use crate::populate;

/// Moves all bodies that touch others; a body moves after the one that it touches.
pub fn resolve(
    params: &[Spanned<BodyParams>],
    bodies: &mut [Body],
    dimension: usize,
) -> Result<(), Complaint> {
    let mut waiting: Vec<(usize, usize, &TouchParams)> = Vec::new();
    for (index, table) in params.iter().enumerate() {
        if let Some(touch) = &table.get_ref().touch {
            let name = touch.body.get_ref();
            let others = bodies
                .iter()
                .enumerate()
                .filter(|(other, _)| *other != index);
            let names = others.map(|(_, body)| body.name.as_str());
            let target = bodies.iter().position(|b| b.name == *name);
            match target.filter(|target| *target != index) {
                Some(target) => waiting.push((index, target, touch)),
                None => return Err(Complaint::unknown(touch.body.span(), "body", name, names)),
            }
        }
    }
    while !waiting.is_empty() {
        let moving: Vec<usize> = waiting.iter().map(|(index, ..)| *index).collect();
        let (ready, later): (Vec<_>, Vec<_>) = waiting
            .into_iter()
            .partition(|(_, target, _)| !moving.contains(target));
        if let ([], Some((_, _, touch))) = (ready.as_slice(), later.first()) {
            let title = "bodies touch each other in a circle: one of them must stand still";
            return Err(Complaint::new(touch.body.span(), title));
        }
        for (index, target, touch) in ready {
            let (axis, forward) = direction(
                *touch.direction.get_ref(),
                touch.direction.span(),
                dimension,
            )?;
            let (body, other) = (&bodies[index], &bodies[target]);
            // A body without particles is refused later on.
            let distance = populate::touching_distance(body, other, dimension, axis, forward);
            translate(&mut bodies[index].shape, axis, distance.unwrap_or(0.0));
        }
        waiting = later;
    }
    Ok(())
}

/// The axis that a word at `at` names, and whether it points to larger coordinates.
pub fn direction(
    direction: Direction,
    at: Range<usize>,
    dimension: usize,
) -> Result<(Axis, bool), Complaint> {
    let (axis, forward) = match direction {
        Direction::PlusX => (Axis::X, true),
        Direction::MinusX => (Axis::X, false),
        Direction::PlusY => (Axis::Y, true),
        Direction::MinusY => (Axis::Y, false),
        Direction::PlusZ => (Axis::Z, true),
        Direction::MinusZ => (Axis::Z, false),
    };
    if axis.index() < dimension {
        return Ok((axis, forward));
    }
    let title = format!("a {dimension}-dimensional case has no {} axis", axis.name());
    Err(Complaint::new(at, title))
}

fn translate(shape: &mut Shape, axis: Axis, distance: f64) {
    let a = axis.index();
    match shape {
        Shape::Box { lower, upper } => {
            lower[a] += distance;
            upper[a] += distance;
        }
        Shape::Sphere { centre, .. }
        | Shape::Shell { centre, .. }
        | Shape::Cylinder { centre, .. } => centre[a] += distance,
    }
}
