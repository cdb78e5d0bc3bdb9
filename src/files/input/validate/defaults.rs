//! Measures of a body because of its shape: plates, bars and targets.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, SymmetricEigen};

use model::{Bar, Case, Include, MeasureKind, Primitive, Slab, Solid, Vec3};

/// A plate is at most this part as thick as it is wide.
const THIN: f64 = 1.0 / 3.0;

/// A bar is at least so many times as long as it is wide.
const LONG: f64 = 2.0;

/// And no more than so many times as wide as it is thick.
const ROUND: f64 = 1.5;

/// A target is at least so many times as large as what strikes it.
const LARGE: f64 = 1.5;

/// Axes that are turned by less than this (rad) are those of space.
const TURNED: f64 = 1e-3;

/// True if a direction is along each symmetry plane; if it `may_cross`, also normal to one.
pub fn suits_symmetry(case: &Case, way: &[f64; 3], may_cross: bool) -> bool {
    case.symmetry.iter().all(|plane| {
        let across = way[plane.axis.index()].abs();
        across == 0.0 || may_cross && across == 1.0
    })
}

/// A body along its own axes, its images behind symmetry planes with it.
struct Own {
    /// Unit vectors along its edges, from the shortest to the longest.
    axes: [Vec3; 3],
    /// Lengths of the edges (m).
    sides: [f64; 3],
    /// True if it has faces that a measure of a plate could count from.
    has_faces: bool,
}

/// The axes of boxes, cylinders, prisms and what is cut from them, turned as they are.
fn axes_of(solid: &Solid) -> Option<[Vec3; 3]> {
    match solid {
        Solid::Primitive(
            Primitive::Box(_) | Primitive::Revolved(_) | Primitive::Prism { .. },
            place,
        ) => Some([0, 1, 2].map(|a| place.turn.column(a).into_owned())),
        Solid::Difference(base, _) => axes_of(base),
        _ => None,
    }
}

/// The principal axes of what a file tells: of a surface, or of particles; its images behind symmetry
/// planes, which lie in the same axes, with it.
fn principal_axes(case: &Case, solid: &Solid) -> Option<[Vec3; 3]> {
    let Solid::Primitive(form, place) = solid else {
        return None;
    };
    let own = match form {
        Primitive::Mesh(mesh) => mesh.covariance(),
        Primitive::Cloud(cloud) => cloud.covariance(),
        _ => return None,
    };
    let mut covariance = place.turn * own * place.turn.transpose();
    for plane in &case.symmetry {
        let a = plane.axis.index();
        for b in (0..3).filter(|&b| b != a) {
            (covariance[(a, b)], covariance[(b, a)]) = (0.0, 0.0);
        }
    }
    let beside = covariance - Matrix3::from_diagonal(&covariance.diagonal());
    let axes = if beside.amax() <= TURNED * covariance.trace() {
        Matrix3::identity()
    } else {
        SymmetricEigen::new(covariance).eigenvectors
    };
    Some([0, 1, 2].map(|a| axes.column(a).into_owned()))
}

/// Ends (m) of a body along a unit vector; across symmetry planes it goes on as far as above them.
fn reach(case: &Case, body: usize, way: &Vec3) -> [f64; 2] {
    let solid = case.bodies[body].shape.solid(case.dimension);
    let [mut low, high] = [-solid.support(&-way), solid.support(way)];
    for plane in &case.symmetry {
        if way[plane.axis.index()].abs() == 1.0 {
            low = 2.0 * plane.position - high;
        }
    }
    [low, high]
}

impl Own {
    fn of(case: &Case, body: usize) -> Option<Self> {
        let solid = case.bodies[body].shape.solid(case.dimension);
        let faces = axes_of(&solid);
        let has_faces = faces.is_some();
        let mut axes = faces.or_else(|| principal_axes(case, &solid))?;
        // A half of a symmetric body has its sides on the positive axes.
        for axis in &mut axes {
            if axis.iter().any(|&c| c == -1.0) {
                *axis = -*axis;
            }
        }
        let side = |axis: &Vec3| {
            let [low, high] = reach(case, body, axis);
            high - low
        };
        axes.sort_by(|a, b| side(a).total_cmp(&side(b)));
        let sides = axes.each_ref().map(side);
        Some(Self {
            axes,
            sides,
            has_faces,
        })
    }

    fn is_thin(&self) -> bool {
        self.sides[0] <= THIN * self.sides[1]
    }

    fn is_long(&self) -> bool {
        self.sides[2] >= LONG * self.sides[1] && self.sides[1] <= ROUND * self.sides[0]
    }
}

/// Middle of a body (m), its images with it.
fn middle(case: &Case, body: usize) -> Vec3 {
    Vec3::from_fn(|a, _| {
        let way = Vec3::from_fn(|b, _| f64::from(u8::from(a == b)));
        let [low, high] = reach(case, body, &way);
        0.5 * (low + high)
    })
}

/// The bodies of a case by what may strike what.
pub struct Strikers<'a> {
    case: &'a Case,
    /// Middles (m) of the bodies.
    middles: Vec<Vec3>,
    /// Bodies by their velocity (m/s).
    flights: Vec<(Vec3, Vec<usize>)>,
}

impl<'a> Strikers<'a> {
    pub fn new(case: &'a Case) -> Self {
        let all = 0..case.bodies.len();
        let mut flights = BTreeMap::<_, (Vec3, Vec<usize>)>::new();
        for (index, body) in case.bodies.iter().enumerate() {
            let key: [u64; 3] = body.velocity.map(f64::to_bits).into();
            let flight = flights.entry(key).or_default();
            flight.0 = body.velocity;
            flight.1.push(index);
        }
        Self {
            case,
            middles: all.map(|body| middle(case, body)).collect(),
            flights: flights.into_values().collect(),
        }
    }

    /// The other body that moves fastest towards a body, of equals the last: its velocity against it (m/s), and its index.
    fn of(&self, body: usize) -> Option<(Vec3, usize)> {
        let at = self.middles[body];
        let mut fastest: Option<(Vec3, usize)> = None;
        for (velocity, others) in &self.flights {
            let velocity = velocity - self.case.bodies[body].velocity;
            let (speed, is_first) = (velocity.norm_squared(), fastest.is_none());
            let least = fastest.map_or(0.0, |(fastest, _)| fastest.norm_squared());
            if speed < least || speed == 0.0 {
                continue;
            }
            let comes = |other: &&usize| {
                **other != body && (at - self.middles[**other]).dot(&velocity) > 0.0
            };
            let last = others.iter().rev().find(comes).copied();
            let found = last.filter(|&other| {
                is_first || speed > least || fastest.is_some_and(|(_, known)| other > known)
            });
            fastest = found.map(|other| (velocity, other)).or(fastest);
        }
        fastest
    }
}

/// Out of the face of a body that the fastest other body moves towards: across its least extent if it is thin,
/// else the one that is struck most squarely.
pub fn struck_face(strikers: &Strikers, body: usize) -> Option<[f64; 3]> {
    let case = strikers.case;
    let (velocity, other) = strikers.of(body)?;
    let own = Own::of(case, body).filter(|own| own.has_faces)?;
    let free = |axis: &&Vec3| suits_symmetry(case, &(**axis).into(), false);
    let axis = match own.axes.iter().find(free) {
        Some(axis) if own.is_thin() && *axis == own.axes[0] => axis,
        _ => own.axes.iter().filter(free).max_by(|a, b| {
            let along = |axis: &Vec3| axis.dot(&velocity).abs();
            along(a).total_cmp(&along(b))
        })?,
    };
    let off = axis.dot(&(strikers.middles[other] - strikers.middles[body]));
    (off != 0.0).then(|| outward(axis, off))
}

/// A unit vector along an axis with the sign of a number.
fn outward(axis: &Vec3, sense: f64) -> [f64; 3] {
    let sign = if sense < 0.0 { -1.0 } else { 1.0 };
    (axis * sign).map(|c| c + 0.0).into()
}

/// To the end of a bar that strikes, or is struck: as it moves against what comes, or by its own velocity.
pub fn foot(strikers: &Strikers, body: usize) -> Option<[f64; 3]> {
    let case = strikers.case;
    let own = Own::of(case, body)?;
    let velocity = case.bodies[body].velocity;
    let against = strikers
        .of(body)
        .map_or(velocity, |(velocity, _)| -velocity);
    Some(outward(&own.axes[2], own.axes[2].dot(&against)))
}

/// The measure that a body's shape asks for.
pub fn measure(strikers: &Strikers, body: usize) -> Option<MeasureKind> {
    let case = strikers.case;
    let matter = &case.bodies[body];
    if matter.rigid.is_some() {
        return None;
    }
    let own = Own::of(case, body)?;
    let slab = |include| Some(Slab::new(case, body, struck_face(strikers, body)?, include));
    if own.is_thin() {
        return slab(Include::Intact).map(MeasureKind::Plate);
    }
    if own.is_long() {
        return Some(MeasureKind::Bar(Bar {
            body,
            foot: foot(strikers, body)?,
            spacing: matter.lattice.spacing,
        }));
    }
    if matter.velocity.norm() > 0.0 {
        return None;
    }
    let (_, other) = strikers.of(body)?;
    let across = |way: Vec3| {
        let [low, high] = reach(case, other, &way);
        high - low
    };
    let largest = [Vec3::x(), Vec3::y(), Vec3::z()].map(across);
    let largest = largest.into_iter().fold(0.0, f64::max);
    let is_large = own.sides[1] >= LARGE * largest;
    is_large.then(|| slab(Include::All).map(MeasureKind::Target))?
}
