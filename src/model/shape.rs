//! The initial shape of a body.

use super::axis::{Axis, SymmetryPlane};
use super::{Placement, Polygon, Primitive, Solid, Vec3};

/// The geometry of a body, in its final place (m).
///
/// In one dimension a box is an interval of x; in two dimensions a box is a rectangle, a sphere a
/// disc and a shell a ring of the x-y plane.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Axis-aligned box between two corners.
    Box {
        /// Smallest coordinates (m).
        lower: Vec3,
        /// Largest coordinates (m).
        upper: Vec3,
    },
    /// Ball of a radius about a centre.
    Sphere {
        /// Centre (m).
        centre: Vec3,
        /// Radius (m).
        radius: f64,
    },
    /// Ball with a concentric hole; a ring in two dimensions.
    Shell {
        /// Centre (m).
        centre: Vec3,
        /// Outer radius (m).
        radius: f64,
        /// Radius of the hole (m).
        inner_radius: f64,
    },
    /// Circular cylinder along a coordinate axis.
    Cylinder {
        /// Middle of the cylinder, half way along its axis (m).
        centre: Vec3,
        /// Direction of the axis.
        axis: Axis,
        /// Radius (m).
        radius: f64,
        /// Full length along the axis (m).
        length: f64,
    },
    /// Any other: turned, joined, cut, read from a file.
    Solid(Solid),
}

impl Shape {
    /// Half way between its ends (m).
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        match self {
            Self::Box { lower, upper } => 0.5 * (lower + upper),
            Self::Sphere { centre, .. }
            | Self::Shell { centre, .. }
            | Self::Cylinder { centre, .. } => *centre,
            Self::Solid(solid) => {
                let (lower, upper) = solid.bounds();
                0.5 * (lower + upper)
            }
        }
    }

    /// Radius about the centre within which it lies (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        match self {
            Self::Box { lower, upper } => 0.5 * (upper - lower).norm(),
            Self::Sphere { radius, .. } | Self::Shell { radius, .. } => *radius,
            Self::Cylinder { radius, length, .. } => radius.hypot(0.5 * length),
            Self::Solid(solid) => solid.reach(),
        }
    }

    /// The same shape as a solid; in two dimensions it goes on along z.
    ///
    /// # Panics
    /// If a cylinder has no radius or no length.
    #[must_use]
    pub fn solid(&self, dimension: usize) -> Solid {
        let ball = |centre: &Vec3, radius: f64| {
            Solid::Primitive(Primitive::Ball(radius), Placement::at(*centre))
        };
        match self {
            Self::Box { lower, upper } => {
                let mut half = (upper - lower) * 0.5;
                for a in dimension..3 {
                    half[a] = f64::INFINITY;
                }
                Solid::Primitive(Primitive::Box(half), Placement::at((lower + upper) * 0.5))
            }
            Self::Sphere { centre, radius } => ball(centre, *radius),
            Self::Shell {
                centre,
                radius,
                inner_radius,
            } => Solid::Difference(
                Box::new(ball(centre, *radius)),
                vec![ball(centre, *inner_radius)],
            ),
            Self::Cylinder {
                centre,
                axis,
                radius: r,
                length,
            } => {
                let half = 0.5 * length;
                let outline = vec![[0.0, -half], [*r, -half], [*r, half], [0.0, half]];
                let profile = Polygon::new(outline).expect("a rectangle");
                Solid::Primitive(
                    Primitive::Revolved(profile),
                    Placement::turned(Self::onto(*axis), *centre),
                )
            }
            Self::Solid(solid) => solid.clone(),
        }
    }

    /// The matrix that turns z into an axis, and changes none of the three into its opposite.
    #[must_use]
    pub fn onto(axis: Axis) -> nalgebra::Matrix3<f64> {
        let first = (axis.index() + 1) % 3;
        nalgebra::Matrix3::from_fn(|row, column| f64::from(u8::from(row == (first + column) % 3)))
    }

    /// Volume (m³; m² or m in two or one dimensions).
    #[must_use]
    pub fn volume(&self, dimension: usize) -> f64 {
        let ball = |radius: f64| Primitive::Ball(radius).volume(dimension);
        match self {
            Self::Box { lower, upper } => (0..dimension).map(|a| upper[a] - lower[a]).product(),
            Self::Sphere { radius, .. } => ball(*radius),
            Self::Shell {
                radius,
                inner_radius,
                ..
            } => ball(*radius) - ball(*inner_radius),
            Self::Cylinder { .. } | Self::Solid(_) => self.solid(dimension).volume(dimension),
        }
    }

    /// [`Self::volume`] of what lies above symmetry planes. Planes through the middle of a ready shape
    /// halve it; others cut a volume that is integrated, but for boxes.
    #[must_use]
    pub fn volume_above(&self, planes: &[SymmetryPlane], dimension: usize) -> f64 {
        let sides = planes
            .iter()
            .map(|plane| (plane.axis.index(), plane.position));
        if let Self::Box { lower, upper } = self {
            let mut lower = *lower;
            for (a, at) in sides {
                lower[a] = lower[a].max(at);
            }
            let edges = (0..dimension).map(|a| (upper[a] - lower[a]).max(0.0));
            return edges.product();
        }
        let solid = self.solid(dimension);
        let (lower, _) = solid.bounds();
        let (middle, rounding) = (self.centre(), 1e-9 * self.reach());
        let cut: Vec<(usize, f64)> = sides.filter(|&(a, at)| at > lower[a]).collect();
        let is_halved = |&(a, at): &(usize, f64)| (middle[a] - at).abs() < rounding;
        if !matches!(self, Self::Solid(_)) && cut.iter().all(is_halved) {
            return cut.iter().fold(self.volume(dimension), |v, _| 0.5 * v);
        }
        solid.volume_above(&cut, dimension)
    }

    /// Moves it (m).
    pub fn translate(&mut self, way: &Vec3) {
        match self {
            Self::Box { lower, upper } => {
                *lower += way;
                *upper += way;
            }
            Self::Sphere { centre, .. }
            | Self::Shell { centre, .. }
            | Self::Cylinder { centre, .. } => *centre += way,
            Self::Solid(solid) => solid.translate(way),
        }
    }
}
