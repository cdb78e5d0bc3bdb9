//! What acts on bodies from outside: gravity, prescribed velocities, rigid planes.

use super::Motion;

/// All loads of a case.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Loads {
    /// Acceleration of every particle that is no part of a rigid body (m/s²).
    pub gravity: [f64; 3],
    /// Velocities prescribed to regions of bodies. Where several hold, the last one does.
    pub velocities: Vec<VelocityLoad>,
    /// Rigid planes.
    pub planes: Vec<RigidPlane>,
}

impl Loads {
    /// Most prescribed velocities and rigid bodies together: a particle keeps a bit of each.
    pub const MOST: usize = 32;

    /// Whether there is gravity.
    #[must_use]
    pub fn has_gravity(&self) -> bool {
        self.gravity != [0.0; 3]
    }
}

/// A velocity prescribed to the particles of a body that stand in a region at time zero.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityLoad {
    /// Name in reports.
    pub name: String,
    /// Index into [`super::Case::bodies`].
    pub body: usize,
    /// Smallest coordinates of the region (m); −∞ where it is open.
    pub above: [f64; 3],
    /// Largest coordinates of the region (m); ∞ where it is open.
    pub below: [f64; 3],
    /// The velocity.
    pub motion: Motion,
    /// The particles are free from the step boundary nearest to this time on (s); may be
    /// infinite.
    pub until: f64,
}

impl VelocityLoad {
    /// Whether a place (m) is in the region.
    #[must_use]
    pub fn contains(&self, position: &[f64; 3]) -> bool {
        (0..3).all(|a| self.above[a] <= position[a] && position[a] <= self.below[a])
    }
}

/// A frictionless rigid plane, which pushes particles that come nearer than half a spacing to the
/// side that its normal points to.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidPlane {
    /// Name in reports.
    pub name: String,
    /// Unit normal.
    pub normal: [f64; 3],
    /// Where it stands at time zero: the normal's product with a point of the plane (m).
    pub position: f64,
    /// Stiffness κ of the penalty relative to the p-wave modulus.
    pub stiffness: f64,
    /// Whether it acts on each of [`super::Case::bodies`].
    pub bodies: Vec<bool>,
    /// Its motion; fixed on free axes.
    pub motion: Motion,
}

impl RigidPlane {
    /// Distance of a place (m) from the plane at time zero, positive on the side that it keeps.
    #[must_use]
    pub fn gap(&self, position: &[f64; 3]) -> f64 {
        self.along(position) - self.position
    }

    /// Component of a vector along the normal.
    #[inline]
    #[must_use]
    pub fn along(&self, vector: &[f64; 3]) -> f64 {
        self.normal[0] * vector[0] + self.normal[1] * vector[1] + self.normal[2] * vector[2]
    }

    /// Mean velocity along the normal (m/s) from time `from` to `to` (s).
    #[must_use]
    pub fn velocity(&self, from: f64, to: f64) -> f64 {
        self.along(&std::array::from_fn(|a| self.motion.mean(a, from, to)))
    }
}
