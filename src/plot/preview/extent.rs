//! The part of space in pictures of a model, and the plane of its section.

use crate::snapshots::plane::Plane;
use model::{Axis, Body, Case, RigidSurface, SurfaceShape};

/// Blank border about the model, over its longest side.
const BORDER: f64 = 0.06;

/// A rigid surface is drawn whole if it reaches beyond the bodies by no more than this, over their
/// longest side.
const NEAR: f64 = 1.0;

/// Smallest and largest coordinates (m).
pub type Ends = ([f64; 3], [f64; 3]);

/// The box that the particles of a body fill (m), above all symmetry planes; axes that a case does
/// not have are a spacing wide.
pub fn of_body(body: &Body, case: &Case) -> Option<Ends> {
    let (lower, upper) = populate::bounds_above(body, case.dimension, &case.symmetry)?;
    let half = 0.5 * body.lattice.coarsest();
    Some((lower.map(|x| x - half), upper.map(|x| x + half)))
}

/// The box around all bodies (m), and the visible one; nothing without particles.
pub fn extents(case: &Case) -> Option<[Ends; 2]> {
    let boxes = case.bodies.iter().filter_map(|body| of_body(body, case));
    let all = boxes.reduce(|all, one| join(&all, &one))?;
    let longest = longest(&all);
    let most = grown(&all, NEAR * longest);
    let surfaces = case.loads.surfaces.iter();
    let surfaces = surfaces.map(|surface| bounds_of(surface, &all));
    let near = surfaces.filter(|(lower, upper)| {
        (0..case.dimension).all(|a| lower[a] >= most.0[a] && upper[a] <= most.1[a])
    });
    let with_surfaces = near.fold(all, |all, one| join(&all, &one));
    let border = BORDER * self::longest(&with_surfaces);
    let mut visible = grown(&with_surfaces, border);
    for axis in case.dimension..3 {
        (visible.0[axis], visible.1[axis]) = (all.0[axis] - border, all.1[axis] + border);
    }
    Some([all, visible])
}

/// The box of a surface (m); of a plane normal to an axis at its position, as wide as the bodies
/// are.
fn bounds_of(surface: &RigidSurface, bodies: &Ends) -> Ends {
    let SurfaceShape::Plane { normal, position } = &surface.shape else {
        return surface.bounds();
    };
    let (mut lower, mut upper) = *bodies;
    if let Some(a) = (0..3).find(|&a| normal[a].abs() > 1.0 - 1e-9) {
        (lower[a], upper[a]) = (normal[a] * position, normal[a] * position);
    }
    (lower, upper)
}

fn join(a: &Ends, b: &Ends) -> Ends {
    (
        std::array::from_fn(|k| a.0[k].min(b.0[k])),
        std::array::from_fn(|k| a.1[k].max(b.1[k])),
    )
}

fn grown((lower, upper): &Ends, by: f64) -> Ends {
    (lower.map(|x| x - by), upper.map(|x| x + by))
}

fn longest((lower, upper): &Ends) -> f64 {
    (0..3).fold(0.0, |most, a| (upper[a] - lower[a]).max(most))
}

/// The plane that shows most: z of a flat model. Else one that cuts most bodies, be it a plane of
/// symmetry or through the middle of a body, along the fastest motion if there is one.
pub fn best_plane(case: &Case, all: &Ends) -> Plane {
    if case.dimension < 3 {
        let axis = Axis::Z;
        return Plane {
            axis,
            position: 0.0,
        };
    }
    let speed = |body: &&Body| body.velocity.norm();
    let fastest = case
        .bodies
        .iter()
        .max_by(|a, b| speed(a).total_cmp(&speed(b)));
    let fastest = fastest.map(|body| body.velocity).unwrap_or_default();
    let boxes: Vec<Ends> = (case.bodies.iter())
        .filter_map(|body| of_body(body, case))
        .collect();
    // Faces at a plane of symmetry may lie behind it by rounding.
    let near = 1e-6 * longest(all);
    let mut best: Option<(Plane, [usize; 2])> = None;
    for axis in [Axis::Y, Axis::X, Axis::Z] {
        let a = axis.index();
        let across = usize::from(fastest[a].abs() < 0.5 * fastest.norm() || fastest.norm() == 0.0);
        let mirror = case.symmetry.iter().find(|plane| plane.axis == axis);
        let mirror = mirror.map(|plane| plane.position);
        let middles = boxes
            .iter()
            .chain([all])
            .map(|(lower, upper)| 0.5 * (lower[a] + upper[a]));
        for position in mirror.into_iter().chain(middles) {
            let cut = boxes
                .iter()
                .filter(|(l, u)| l[a] - near <= position && position <= u[a] + near);
            let merit = [across, cut.count()];
            if best.is_none_or(|(_, most)| merit > most) {
                best = Some((Plane { axis, position }, merit));
            }
        }
    }
    best.map_or(
        Plane {
            axis: Axis::Y,
            position: 0.0,
        },
        |(plane, _)| plane,
    )
}

/// The plane that a text names, `y=0.1mm` or `y`, the latter at the symmetry plane or the middle.
pub fn plane_of(
    (axis, position): (Axis, Option<f64>),
    case: &Case,
    (lower, upper): &Ends,
) -> Plane {
    let a = axis.index();
    let mirror = case.symmetry.iter().find(|plane| plane.axis == axis);
    let middle = || mirror.map_or(0.5 * (lower[a] + upper[a]), |plane| plane.position);
    Plane {
        axis,
        position: position.unwrap_or_else(middle),
    }
}
