//! External loads on bodies: gravity, prescribed velocities, absorbing zones, rigid surfaces.

use super::{Absorber, Case, Motion, Region, RigidSurface, Vec3};
use material::{Eos, UNLIT};

/// All loads of a case.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Loads {
    /// Acceleration of every particle that is no part of a rigid body (m/s²).
    pub gravity: [f64; 3],
    /// Attraction of all particles by each other, if there is any.
    pub self_gravity: Option<SelfGravity>,
    /// Velocities prescribed to regions of bodies. Where several hold, the last one does.
    pub velocities: Vec<VelocityLoad>,
    /// Absorbing zones, at most one of each body.
    pub absorbers: Vec<Absorber>,
    /// Rigid planes and other surfaces.
    pub surfaces: Vec<RigidSurface>,
    /// Points from which detonations run.
    pub detonators: Vec<Detonator>,
    /// Pressures on faces of bodies; where several act, they add up.
    pub pressures: Vec<PressureLoad>,
    /// What brings bodies to rest at first.
    pub relaxation: Option<Relaxation>,
}

/// A pressure on the free faces of the particles of a body that are in a region at time zero.
#[derive(Debug, Clone, PartialEq)]
pub struct PressureLoad {
    /// Name in reports.
    pub name: String,
    /// Index into [`super::Case::bodies`].
    pub body: usize,
    /// The region of these particles.
    pub region: Region,
    /// The pressure (Pa), as a motion along the first axis.
    pub pressure: Motion,
}

/// A drag by which bodies come to rest before something happens to them.
#[derive(Debug, Clone, PartialEq)]
pub struct Relaxation {
    /// When it ends (s), at the end of a step.
    pub until: f64,
    /// Rate of the drag of each body (1/s), zero without.
    pub rates: Vec<f64>,
}

impl Relaxation {
    /// Its name in reports.
    pub const NAME: &'static str = "relaxation";
}

/// Attraction of all particles by each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfGravity {
    /// Constant of gravitation (m³/(kg s²)).
    pub constant: f64,
    /// Side of a cell that counts as one body over the distance of its middle, at most.
    pub opening_angle: f64,
}

/// A point from which a detonation runs through explosives, straight and at their own speeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Detonator {
    /// Index into [`super::Case::bodies`] of the one that it lights; all explosives without.
    pub body: Option<usize>,
    /// The point (m).
    pub at: Vec3,
    /// When it lights (s).
    pub time: f64,
}

impl Loads {
    /// Most prescribed velocities and rigid bodies together: a particle keeps a bit of each.
    pub const MOST: usize = 32;

    /// `true` if any rigid surface has friction or damping.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        self.surfaces.iter().any(|s| s.resistance.is_any())
    }

    /// `true` if there is gravity from outside.
    #[must_use]
    pub fn has_gravity(&self) -> bool {
        self.gravity != [0.0; 3]
    }

    /// `true` if gravity moves all that is free, from outside or by itself.
    #[must_use]
    pub fn moves_all(&self) -> bool {
        self.has_gravity() || self.self_gravity.is_some()
    }
}

/// A velocity prescribed to the particles of a body that are in a region at time zero.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityLoad {
    /// Name in reports.
    pub name: String,
    /// Index into [`super::Case::bodies`].
    pub body: usize,
    /// The region of these particles.
    pub region: Region,
    /// The velocity.
    pub motion: Motion,
    /// The particles are free from the step boundary nearest to this time on (s); may be
    /// infinite.
    pub until: f64,
    /// True if the last velocity that it prescribes is that of a start: it holds in the step in which it ends.
    pub starts: bool,
}

impl VelocityLoad {
    /// True if it holds in a step between two times (s).
    #[must_use]
    pub fn holds(&self, from: f64, to: f64) -> bool {
        let time = if self.starts {
            from
        } else {
            from + 0.5 * (to - from)
        };
        time < self.until
    }
}

impl Case {
    /// When the first detonation reaches a place (m) of a body (s); zero if it is no explosive.
    #[must_use]
    pub fn lighting_time(&self, body: usize, position: &Vec3) -> f64 {
        let Eos::Jwl(explosive) = &self.materials[self.bodies[body].material].eos else {
            return 0.0;
        };
        let reaches = |detonator: &Detonator| {
            let lights = detonator.body.is_none_or(|lit| lit == body);
            let way = (position - detonator.at).norm();
            lights.then(|| detonator.time + way / explosive.detonation_velocity)
        };
        let all = self.loads.detonators.iter().filter_map(reaches);
        all.fold(UNLIT, f64::min)
    }
}
