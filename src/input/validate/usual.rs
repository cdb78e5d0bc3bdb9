//! What is measured of a body because of its shape: plates, bars and targets.

use super::shapes::unit;
use crate::model::{Axis, Bar, Case, Include, MeasureKind, Shape, Slab, Vec3};

/// A plate is at most this part as thick as it is wide.
const THIN: f64 = 1.0 / 3.0;

/// A bar is at least so many times as long as it is wide.
const LONG: f64 = 2.0;

/// And no more than so many times as wide as it is thick.
const ROUND: f64 = 1.5;

/// A target is at least so many times as large as what strikes it.
const LARGE: f64 = 1.5;

/// Whether a direction is along each symmetry plane; if it `may_cross`, also normal to one.
pub fn suits_symmetry(case: &Case, way: &[f64; 3], may_cross: bool) -> bool {
    case.symmetry.iter().all(|plane| {
        let across = way[plane.axis.index()].abs();
        across == 0.0 || may_cross && across == 1.0
    })
}

/// Corners (m) of a body, its images behind symmetry planes with it.
fn extents(case: &Case, body: usize) -> (Vec3, Vec3) {
    let (mut lower, upper) = case.bodies[body].shape.solid(case.dimension).bounds();
    for plane in &case.symmetry {
        let a = plane.axis.index();
        lower[a] = 2.0 * plane.position - upper[a];
    }
    (lower, upper)
}

/// The other body that moves fastest towards a body: its velocity against it (m/s), and its index.
fn striker(case: &Case, body: usize) -> Option<(Vec3, usize)> {
    let own = &case.bodies[body];
    let (lower, upper) = extents(case, body);
    let towards = |other: usize| {
        let velocity = case.bodies[other].velocity - own.velocity;
        let (other_lower, other_upper) = extents(case, other);
        let way = 0.5 * (lower + upper - other_lower - other_upper);
        (velocity, way.dot(&velocity) > 0.0)
    };
    let others = (0..case.bodies.len()).filter(|&other| other != body);
    let all = others.map(|other| (towards(other), other));
    let coming = all.filter(|((velocity, comes), _)| *comes && velocity.norm() > 0.0);
    let fastest = coming.max_by(|(a, _), (b, _)| a.0.norm().total_cmp(&b.0.norm()));
    fastest.map(|((velocity, _), other)| (velocity, other))
}

/// The axis with the greatest part of a vector, of those along all symmetry planes.
fn main_axis(case: &Case, way: &Vec3) -> Option<Axis> {
    let free = |axis: &Axis| !case.symmetry.iter().any(|plane| plane.axis == *axis);
    let size = |axis: &Axis| way[axis.index()].abs();
    let axes = Axis::ALL.into_iter().filter(free);
    axes.max_by(|a, b| size(a).total_cmp(&size(b)))
}

/// A unit vector along an axis with the sign of a number.
fn along(axis: Axis, sense: f64) -> [f64; 3] {
    unit(axis).map(|c| if sense < 0.0 { 0.0 - c } else { c })
}

/// Out of the face of a body that the fastest other body moves towards: across its least extent if it is thin.
pub fn struck_face(case: &Case, body: usize) -> Option<[f64; 3]> {
    let (velocity, other) = striker(case, body)?;
    let (lower, upper) = extents(case, body);
    let sides = upper - lower;
    let free = |axis: &Axis| !case.symmetry.iter().any(|plane| plane.axis == *axis);
    let size = |axis: &Axis| sides[axis.index()];
    let mut axes: Vec<Axis> = Axis::ALL.into_iter().collect();
    axes.sort_by(|a, b| size(a).total_cmp(&size(b)));
    let is_thin = size(&axes[0]) <= THIN * size(&axes[1]) && free(&axes[0]);
    let axis = if is_thin {
        axes[0]
    } else {
        main_axis(case, &velocity)?
    };
    let (other_lower, other_upper) = extents(case, other);
    let middle = |lower: &Vec3, upper: &Vec3| 0.5 * (lower + upper)[axis.index()];
    let off = middle(&other_lower, &other_upper) - middle(&lower, &upper);
    (off != 0.0).then(|| along(axis, off))
}

/// To the end of a bar that strikes, or is struck: as it moves against what comes, or by its own velocity.
pub fn foot(case: &Case, body: usize) -> [f64; 3] {
    let (lower, upper) = extents(case, body);
    let sides = upper - lower;
    let longest = Axis::ALL.into_iter().fold(Axis::X, |best, axis| {
        if sides[axis.index()] > sides[best.index()] {
            axis
        } else {
            best
        }
    });
    let own = case.bodies[body].velocity;
    let against = striker(case, body).map_or(own, |(velocity, _)| -velocity);
    along(longest, against[longest.index()])
}

/// The measure that a body's shape asks for.
pub fn measure(case: &Case, body: usize) -> Option<MeasureKind> {
    let own = &case.bodies[body];
    if own.rigid.is_some() || matches!(own.shape, Shape::Sphere { .. } | Shape::Shell { .. }) {
        return None;
    }
    let (lower, upper) = extents(case, body);
    let mut sides: Vec<f64> = (upper - lower).iter().copied().collect();
    sides.sort_by(f64::total_cmp);
    let [thin, middle, long] = sides[..] else {
        return None;
    };
    if thin <= THIN * middle {
        let normal = struck_face(case, body)?;
        return Some(MeasureKind::Plate(Slab::new(
            case,
            body,
            normal,
            Include::Intact,
        )));
    }
    if long >= LONG * middle && middle <= ROUND * thin {
        return Some(MeasureKind::Bar(Bar {
            body,
            foot: foot(case, body),
            spacing: own.lattice.spacing,
        }));
    }
    let (_, other) = striker(case, body)?;
    let (other_lower, other_upper) = extents(case, other);
    let largest = (other_upper - other_lower).max();
    if own.velocity.norm() == 0.0 && middle >= LARGE * largest {
        let normal = struck_face(case, body)?;
        return Some(MeasureKind::Target(Slab::new(
            case,
            body,
            normal,
            Include::All,
        )));
    }
    None
}
