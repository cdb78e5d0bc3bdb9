//! Measurements of a run.

use super::gauge::{Gauge, Witness};
use super::{Case, Include, Region, Vec3};
use material::Material;

/// Measurements of a run: the tables `[measure]`, `[[gauge]]` and `[[witness]]`.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasureOptions {
    /// `true` if `bodies.csv` is written.
    pub bodies: bool,
    /// Time between rows of `measures.csv` (s).
    pub every: f64,
    /// Pressure (Pa) beyond which a shock has arrived; by material if absent.
    pub arrival_pressure: Option<f64>,
    /// The measures of `measures.csv`: those that the input names, then the default ones.
    pub measures: Vec<Measure>,
    /// Gauges, in the order of the input.
    pub gauges: Vec<Gauge>,
    /// Witness planes, in the order of the input.
    pub witnesses: Vec<Witness>,
}

impl Default for MeasureOptions {
    fn default() -> Self {
        Self {
            bodies: true,
            every: f64::INFINITY,
            arrival_pressure: None,
            measures: Vec::new(),
            gauges: Vec::new(),
            witnesses: Vec::new(),
        }
    }
}

/// A shock has arrived where pressure is beyond this fraction of the bulk modulus of the material:
/// a tenth of a percent of compression, well above the pressures of a filling that comes to rest
/// and below the elastic limits of metals.
const ARRIVED: f64 = 1e-3;

impl MeasureOptions {
    /// `true` if particles must know that they carry gauges or belong to regions.
    #[must_use]
    pub fn marks_particles(&self) -> bool {
        let mut zones = self.measures.iter();
        (self.gauges.iter()).any(|gauge| gauge.moves && gauge.particle.is_none())
            || zones.any(
                |measure| matches!(&measure.kind, MeasureKind::Zone(zone) if zone.mark.is_some()),
            )
    }

    /// The pressure (Pa) beyond which a shock has arrived in a material.
    #[must_use]
    pub fn arrival_of(&self, material: &Material) -> f64 {
        let modulus = || material.bulk_modulus();
        self.arrival_pressure.unwrap_or_else(|| ARRIVED * modulus())
    }
}

/// One measure with rows in `measures.csv`.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// Name in tables.
    pub name: String,
    /// Its quantity.
    pub kind: MeasureKind,
}

/// The quantity of a measure.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasureKind {
    /// Hole, lips, bulge and verdict of a plate.
    Plate(Slab),
    /// The crater of a target.
    Target(Slab),
    /// Length and diameters of a bar.
    Bar(Bar),
    /// Debris beyond a plane.
    Debris(Debris),
    /// Means and extremes of a part of space or of a body.
    Zone(Zone),
    /// A shock on a line.
    Front(FrontLine),
}

impl MeasureKind {
    /// Its word in the input and in tables.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Plate(_) => "plate",
            Self::Target(_) => "target",
            Self::Bar(_) => "bar",
            Self::Debris(_) => "debris",
            Self::Zone(_) => "region",
            Self::Front(_) => "front",
        }
    }
}

/// A body between two faces that something strikes.
#[derive(Debug, Clone, PartialEq)]
pub struct Slab {
    /// Index of the body.
    pub body: usize,
    /// Unit vector out of the face that is struck.
    pub normal: [f64; 3],
    /// Position of the struck face at the start, `n·x` (m).
    pub front: f64,
    /// Position of the other one (m).
    pub rear: f64,
    /// Finest spacing of the body (m).
    pub spacing: f64,
    /// Bodies that begin on the struck side, and the body itself.
    pub before: Vec<usize>,
    /// The particles that can remain of it.
    pub include: Include,
}

impl Slab {
    /// A body of a case with a unit vector out of its struck face, and what can remain of it.
    #[must_use]
    pub fn new(case: &Case, body: usize, normal: [f64; 3], include: Include) -> Self {
        let n = Vec3::from(normal);
        let reach = |index: usize, way: &Vec3| {
            let shape = &case.bodies[index].shape;
            shape.solid(case.dimension).support(way)
        };
        let (front, rear) = (reach(body, &n), -reach(body, &-n));
        let middle = 0.5 * (front + rear);
        let struck =
            |&index: &usize| index == body || 0.5 * (reach(index, &n) - reach(index, &-n)) > middle;
        let before: Vec<usize> = (0..case.bodies.len()).filter(struck).collect();
        Self {
            body,
            normal,
            front,
            rear,
            spacing: case.bodies[body].lattice.spacing,
            before,
            include,
        }
    }

    /// Distance of the faces at the start (m).
    #[must_use]
    pub fn thickness(&self) -> f64 {
        self.front - self.rear
    }
}

/// A bar, whose foot is the end that a direction points to.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// Index of the body.
    pub body: usize,
    /// Unit vector along the bar to its foot.
    pub foot: [f64; 3],
    /// Finest spacing of the body (m).
    pub spacing: f64,
}

/// Matter beyond a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Debris {
    /// Index of the measure of a plate or a target, whose attached particles are no debris.
    pub of: Option<usize>,
    /// A point of the plane (m).
    pub point: [f64; 3],
    /// Unit vector of flight: what is beyond the plane along it may be debris.
    pub direction: [f64; 3],
    /// Bodies whose particles may be debris.
    pub bodies: Vec<usize>,
    /// Areal mass (kg/m²) of the outline.
    pub outline: f64,
    /// Finest spacing of these bodies (m).
    pub spacing: f64,
}

/// A part of space, or the particles that begin there.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// Its place.
    pub place: ZonePlace,
    /// The bit, from 1 on, of particles that began in it, if it moves with them.
    pub mark: Option<u32>,
    /// The body that it reads; all that deform if absent.
    pub body: Option<usize>,
    /// Names of what it reads.
    pub fields: Vec<String>,
}

/// Forms of [`Zone`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ZonePlace {
    /// Between sides normal to the axes.
    Sides(Region),
    /// A ball.
    Ball {
        /// Its centre (m).
        centre: [f64; 3],
        /// Its radius (m).
        radius: f64,
    },
}

impl ZonePlace {
    /// Most zones that move with particles, which have as many bits.
    pub const MOST: usize = 31;

    /// `true` if a place (m) is in it.
    #[must_use]
    pub fn contains(&self, x: &[f64; 3]) -> bool {
        match self {
            Self::Sides(region) => region.contains(x),
            Self::Ball { centre, radius } => {
                let square: f64 = (0..3).map(|a| (x[a] - centre[a]).powi(2)).sum();
                square <= radius * radius
            }
        }
    }
}

/// A line along which a shock is followed.
#[derive(Debug, Clone, PartialEq)]
pub struct FrontLine {
    /// Its first end (m).
    pub from: [f64; 3],
    /// Its last end (m).
    pub to: [f64; 3],
    /// Largest distance of particles from the line (m).
    pub radius: f64,
    /// Length of the pieces in which the line is read (m).
    pub piece: f64,
    /// Pressure (Pa) of the front; by material if absent.
    pub pressure: Option<f64>,
}
