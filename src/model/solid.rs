//! Solids of any form: turned, moved, joined, cut out of each other.
//!
//! A solid answers three questions about a point: how far it is from the surface, which faces it
//! lies below, and nothing else, so that filling, contact and checks take every solid alike. The
//! distance from a union or a cut is a bound: its sign is exact, its size no more than the true
//! distance, and it changes no faster than the point moves.

mod ellipsoid;
mod polygon;
mod primitive;
mod repeat;
mod support;
mod volume;

#[cfg(test)]
mod tests;

pub use polygon::Polygon;
pub use primitive::{Faces, Primitive};
pub use repeat::Repeat;

use std::sync::Arc;

use super::{Mesh, Vec3};

/// A rotation (its rows are the axes of the frame that it turns into) and a translation.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// Matrix that turns a vector of the form into one of space.
    pub turn: nalgebra::Matrix3<f64>,
    /// Position of the primitive's origin (m).
    pub at: Vec3,
}

impl Placement {
    /// Moved alone.
    #[must_use]
    pub fn at(at: Vec3) -> Self {
        let turn = nalgebra::Matrix3::identity();
        Self { turn, at }
    }

    /// Turned about the origin, which is then moved.
    #[must_use]
    pub fn turned(turn: nalgebra::Matrix3<f64>, at: Vec3) -> Self {
        Self { turn, at }
    }

    /// Corners of the smallest box around a form in this place (m), flat along an axis without end.
    fn bounds(&self, primitive: &Primitive) -> (Vec3, Vec3) {
        let is_whole = |c: &f64| *c == 0.0 || c.abs() == 1.0;
        if self.turn.iter().all(is_whole) {
            // Along axes, to the last bit.
            let finite = |v: Vec3| v.map(|c| if c.is_finite() { c } else { 0.0 });
            let (lower, upper) = primitive.bounds();
            let centre = self.at + self.turn * finite((lower + upper) * 0.5);
            let aside = self.turn.abs() * finite((upper - lower) * 0.5);
            return (centre - aside, centre + aside);
        }
        let farthest = |n: Vec3| {
            let most = primitive.support(&self.turn.tr_mul(&n));
            if most.is_finite() { most } else { 0.0 }
        };
        let axis = |a: usize| Vec3::from_fn(|b, _| f64::from(u8::from(a == b)));
        let lower = Vec3::from_fn(|a, _| -farthest(-axis(a)));
        let upper = Vec3::from_fn(|a, _| farthest(axis(a)));
        (self.at + lower, self.at + upper)
    }

    fn inward(&self, x: &Vec3) -> Vec3 {
        self.turn.tr_mul(&(x - self.at))
    }
}

/// The matrix that turns by an angle (rad) about an axis, by the formula of Rodrigues.
#[must_use]
pub fn rotation(axis: &Vec3, angle: f64) -> nalgebra::Matrix3<f64> {
    let Some(n) = axis.try_normalize(0.0) else {
        return nalgebra::Matrix3::identity();
    };
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let cross = nalgebra::Matrix3::new(0.0, -n.z, n.y, n.z, 0.0, -n.x, -n.y, n.x, 0.0);
    nalgebra::Matrix3::identity() * cos + cross * sin + n * n.transpose() * (1.0 - cos)
}

/// A solid: a form in its place, or several solids together.
#[derive(Debug, Clone, PartialEq)]
pub enum Solid {
    /// One form.
    Primitive(Primitive, Placement),
    /// The union of all.
    Union(Vec<Solid>),
    /// The intersection of all.
    Intersection(Vec<Solid>),
    /// The first without any of the others.
    Difference(Box<Solid>, Vec<Solid>),
    /// One over and over, in its place.
    Repeat(Box<Repeat>, Placement),
}

impl Solid {
    /// Distance (m) of a point from the surface, negative inside; of solids together a bound.
    #[must_use]
    pub fn distance(&self, x: &Vec3) -> f64 {
        match self {
            Self::Primitive(primitive, placement) => primitive.distance(&placement.inward(x)),
            Self::Union(parts) => parts.iter().fold(f64::INFINITY, |least, part| {
                if part.is_beyond(x, least) {
                    return least;
                }
                least.min(part.distance(x))
            }),
            Self::Intersection(parts) => parts
                .iter()
                .map(|part| part.distance(x))
                .fold(f64::NEG_INFINITY, f64::max),
            Self::Difference(base, cuts) => cuts.iter().fold(base.distance(x), |most, cut| {
                if cut.is_beyond(x, -most) {
                    return most;
                }
                most.max(-cut.distance(x))
            }),
            Self::Repeat(units, placement) => units.distance(&placement.inward(x)),
        }
    }

    /// `true` if the box shows that a point is `distance` (m) or farther from the surface outside;
    /// `false` for primitives whose distance takes no longer.
    fn is_beyond(&self, x: &Vec3, distance: f64) -> bool {
        match self {
            Self::Primitive(Primitive::Mesh(mesh), placement) => {
                let least = mesh.distance_of_box(&placement.inward(x).into());
                least > 0.0 && least >= distance
            }
            Self::Primitive(..) => false,
            Self::Union(parts) => parts.iter().all(|part| part.is_beyond(x, distance)),
            Self::Intersection(parts) => parts.iter().any(|part| part.is_beyond(x, distance)),
            Self::Difference(base, _) => base.is_beyond(x, distance),
            Self::Repeat(units, placement) => {
                let (x, (lower, upper)) = (placement.inward(x), units.bounds());
                let least = (x - x.zip_zip_map(&lower, &upper, f64::clamp)).norm();
                least > 0.0 && least >= distance
            }
        }
    }

    /// Tells the faces that a point inside lies less than `reach` (m) below: depth (m), and the
    /// unit normal out of the solid.
    pub fn faces(&self, x: &Vec3, reach: f64, emit: Faces) {
        match self {
            Self::Primitive(primitive, placement) => {
                let mut outward = |depth, normal| emit(depth, placement.turn * normal);
                primitive.faces(&placement.inward(x), reach, &mut outward);
            }
            Self::Union(parts) => {
                // Where parts overlap, the faces of the one that holds the point deepest.
                let depth = |part: &&Self| -part.distance(x);
                let deepest = parts.iter().max_by(|a, b| depth(a).total_cmp(&depth(b)));
                if let Some(part) = deepest {
                    part.faces(x, reach, emit);
                }
            }
            Self::Intersection(parts) => {
                for part in parts {
                    part.faces(x, reach, emit);
                }
            }
            Self::Difference(base, cuts) => {
                base.faces(x, reach, emit);
                for cut in cuts.iter().filter(|cut| !cut.is_beyond(x, reach)) {
                    let depth = cut.distance(x);
                    if depth < reach {
                        emit(depth, -cut.outward(x));
                    }
                }
            }
            Self::Repeat(units, placement) => {
                let mut outward = |depth, normal| emit(depth, placement.turn * normal);
                units.faces(&placement.inward(x), reach, &mut outward);
            }
        }
    }

    /// Unit vector along which the distance grows.
    #[must_use]
    pub fn outward(&self, x: &Vec3) -> Vec3 {
        if let Self::Primitive(primitive, placement) = self {
            return placement.turn * primitive.outward(&placement.inward(x));
        }
        if let Self::Repeat(units, placement) = self {
            return placement.turn * units.outward(&placement.inward(x));
        }
        let step = 1e-6 * self.reach();
        let slope = Vec3::from_fn(|a, _| {
            let mut aside = Vec3::zeros();
            aside[a] = step;
            self.distance(&(x + aside)) - self.distance(&(x - aside))
        });
        slope.try_normalize(0.0).unwrap_or_else(Vec3::z)
    }

    /// The largest `n·x` (m) of the solid, for a vector `n` along axes of the dimension; of what lies
    /// in several solids, or in none of those cut out of it, it may be less than this.
    #[must_use]
    pub fn support(&self, n: &Vec3) -> f64 {
        let of = |parts: &[Self], from: f64, pick: fn(f64, f64) -> f64| {
            let all = parts.iter().map(|part| part.support(n));
            all.fold(from, pick)
        };
        match self {
            Self::Primitive(primitive, placement) => {
                primitive.support(&placement.turn.tr_mul(n)) + n.dot(&placement.at)
            }
            Self::Union(parts) => of(parts, f64::NEG_INFINITY, f64::max),
            Self::Intersection(parts) => of(parts, f64::INFINITY, f64::min),
            Self::Difference(base, _) => base.support(n),
            Self::Repeat(units, placement) => {
                units.support(&placement.turn.tr_mul(n)) + n.dot(&placement.at)
            }
        }
    }

    /// Corners of the smallest box around the solid (m); of what lies in several solids, or in none of
    /// those cut out of it, it may be wider.
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let nothing = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        match self {
            Self::Primitive(primitive, placement) => placement.bounds(primitive),
            Self::Union(parts) => {
                let boxes = parts.iter().map(Self::bounds);
                boxes.fold(nothing, |a, b| (a.0.inf(&b.0), a.1.sup(&b.1)))
            }
            Self::Intersection(parts) => {
                let boxes = parts.iter().map(Self::bounds);
                let both = boxes.reduce(|a, b| (a.0.sup(&b.0), a.1.inf(&b.1)));
                both.unwrap_or(nothing)
            }
            Self::Difference(base, _) => base.bounds(),
            Self::Repeat(units, placement) => {
                let (lower, upper) = units.bounds();
                let centre = placement.at + placement.turn * ((lower + upper) * 0.5);
                let aside = placement.turn.abs() * ((upper - lower) * 0.5);
                (centre - aside, centre + aside)
            }
        }
    }

    /// Half the diagonal of its box (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        let (lower, upper) = self.bounds();
        0.5 * (upper - lower).norm()
    }

    /// True if it has a form over and over.
    #[must_use]
    pub fn repeats(&self) -> bool {
        match self {
            Self::Primitive(..) => false,
            Self::Union(parts) | Self::Intersection(parts) => parts.iter().any(Self::repeats),
            Self::Difference(base, cuts) => base.repeats() || cuts.iter().any(Self::repeats),
            Self::Repeat(..) => true,
        }
    }

    /// Adds the meshes among its forms.
    pub fn meshes<'a>(&'a self, meshes: &mut Vec<&'a Arc<Mesh>>) {
        match self {
            Self::Primitive(Primitive::Mesh(mesh), _) => meshes.push(mesh),
            Self::Primitive(..) => {}
            Self::Repeat(units, _) => units.unit().meshes(meshes),
            Self::Union(parts) | Self::Intersection(parts) => {
                for part in parts {
                    part.meshes(meshes);
                }
            }
            Self::Difference(base, cuts) => {
                base.meshes(meshes);
                for cut in cuts {
                    cut.meshes(meshes);
                }
            }
        }
    }

    /// Moves it (m).
    pub fn translate(&mut self, way: &Vec3) {
        match self {
            Self::Primitive(_, placement) | Self::Repeat(_, placement) => placement.at += way,
            Self::Union(parts) | Self::Intersection(parts) => {
                for part in parts {
                    part.translate(way);
                }
            }
            Self::Difference(base, cuts) => {
                base.translate(way);
                for cut in cuts {
                    cut.translate(way);
                }
            }
        }
    }

    /// Turns it about a point (m).
    pub fn rotate(&mut self, turn: &nalgebra::Matrix3<f64>, about: &Vec3) {
        match self {
            Self::Primitive(_, placement) | Self::Repeat(_, placement) => {
                placement.at = about + turn * (placement.at - about);
                placement.turn = turn * placement.turn;
            }
            Self::Union(parts) | Self::Intersection(parts) => {
                for part in parts {
                    part.rotate(turn, about);
                }
            }
            Self::Difference(base, cuts) => {
                base.rotate(turn, about);
                for cut in cuts {
                    cut.rotate(turn, about);
                }
            }
        }
    }

    /// Volume (m³; m² in two dimensions); of solids together it is integrated, to about a millionth.
    #[must_use]
    pub fn volume(&self, dimension: usize) -> f64 {
        match self {
            Self::Primitive(primitive, _) => primitive.volume(dimension),
            _ => volume::integrated(&|x| self.distance(x), self.bounds(), dimension),
        }
    }

    /// Volume (m³; m² in two dimensions) of what lies above planes normal to axes.
    #[must_use]
    pub fn volume_above(&self, planes: &[(usize, f64)], dimension: usize) -> f64 {
        if planes.is_empty() {
            return self.volume(dimension);
        }
        if let Self::Primitive(Primitive::Mesh(mesh), placement) = self {
            let planes = planes.iter().map(|&(a, at)| {
                let across = Vec3::from_fn(|b, _| f64::from(u8::from(a == b)));
                (placement.turn.tr_mul(&across).into(), at - placement.at[a])
            });
            return mesh.volume_above(&planes.collect::<Vec<_>>());
        }
        let distance = |x: &Vec3| {
            let beyond = planes.iter().map(|&(a, at)| at - x[a]);
            beyond.fold(self.distance(x), f64::max)
        };
        let (mut lower, upper) = self.bounds();
        for &(a, at) in planes {
            lower[a] = lower[a].max(at);
        }
        volume::integrated(&distance, (lower, upper), dimension)
    }
}
