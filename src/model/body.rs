//! Bodies: a shape filled with particles of one material on one lattice.

use serde::Deserialize;

use super::{Initial, Motion, Place, Vec3};

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// First coordinate.
    X,
    /// Second coordinate.
    Y,
    /// Third coordinate.
    Z,
}

impl Axis {
    /// All three axes in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The axis of a [`Self::name`].
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|axis| axis.name() == name)
    }

    /// 0, 1 or 2.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// `"x"`, `"y"` or `"z"`.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["x", "y", "z"][self.index()]
    }
}

/// A plane of symmetry normal to a coordinate axis. The model keeps the side above it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SymmetryPlane {
    /// Normal of the plane.
    pub axis: Axis,
    /// Where the plane cuts that axis (m).
    pub position: f64,
}

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
        }
    }

    /// Radius about the centre within which it lies (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        match self {
            Self::Box { lower, upper } => 0.5 * (upper - lower).norm(),
            Self::Sphere { radius, .. } | Self::Shell { radius, .. } => *radius,
            Self::Cylinder { radius, length, .. } => radius.hypot(0.5 * length),
        }
    }
}

/// How particles are stacked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LatticeKind {
    /// Simple cubic (square in two dimensions).
    Cubic,
    /// Hexagonal close-packed (triangular in two dimensions), stacked along z.
    Hexagonal,
    /// Concentric rings about z, as wide apart as their particles; the outermost follows the
    /// outline of a disc, a ring or a cylinder along z.
    Rings,
}

/// A lattice of particles: its kind, spacing and orientation.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    /// Kind of stacking.
    pub kind: LatticeKind,
    /// Particle spacing Δp (m): the edge of the cube that holds one particle's volume, so that
    /// a particle's volume is Δp^d for every kind (but for what rounding leaves of rings).
    pub spacing: f64,
    /// Turn of the lattice about the z axis through the shape's centre (rad).
    pub angle: f64,
}

/// One body of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name, unique in the case.
    pub name: String,
    /// Geometry in its final place (after `touch` has been applied).
    pub shape: Shape,
    /// Index into [`super::Case::materials`].
    pub material: usize,
    /// Lattice of its particles.
    pub lattice: Lattice,
    /// Initial density (kg/m³), if not the material's reference density.
    pub density: Option<f64>,
    /// What else its particles begin with.
    pub initial: Initial,
    /// Initial velocity of its centre (m/s); where that varies, the middle of all.
    pub velocity: Vec3,
    /// Initial angular velocity about its centre (rad/s).
    pub angular_velocity: Vec3,
    /// The motion of a rigid body; its particles feel nothing. Absent for bodies that deform.
    pub rigid: Option<Motion>,
    /// Constant smoothing length h₀ (m): the reference of contact, and of the SPH sums unless
    /// they vary it.
    pub smoothing_length: f64,
}

impl Body {
    /// Initial velocity (m/s) of a particle at `position` (m).
    #[must_use]
    pub fn velocity_at(&self, position: &Vec3) -> Vec3 {
        let velocity = match &self.initial.velocity {
            None => self.velocity,
            Some(components) => {
                let place = Place::new(position, &self.shape.centre());
                Vec3::from_fn(|axis, _| components[axis].at(&place))
            }
        };
        if self.angular_velocity == Vec3::zeros() {
            return velocity;
        }
        velocity
            + self
                .angular_velocity
                .cross(&(position - self.shape.centre()))
    }

    /// Largest difference (m/s) of the initial velocity of a particle from [`Self::velocity`], or
    /// somewhat more: by rotation, and where the velocity varies.
    #[must_use]
    pub fn speed_spread(&self) -> f64 {
        self.angular_velocity.norm() * self.shape.reach() + self.initial.velocity_spread
    }
}
