//! Bodies: a shape filled with particles of one material on one lattice.

use std::sync::Arc;

use serde::Deserialize;

use super::{
    Cloud, Freedom, Grading, Initial, Motion, Place, Placement, Primitive, Quantity, Shape, Solid,
    SymmetryPlane, Vec3, cube,
};
use numerics::extent::Extent;

/// The arrangement of particles.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LatticeKind {
    /// Simple cubic (square in two dimensions).
    #[default]
    Cubic,
    /// Hexagonal close-packed (triangular in two dimensions), stacked along z.
    Hexagonal,
    /// Concentric rings about z, as wide apart as their particles; the outermost follows the
    /// outline of a disc, a ring or a cylinder along z.
    Rings,
    /// Concentric spheres, as wide apart as their particles, each turned at random; the outermost
    /// follows the surface of a ball, the innermost that of its hollow.
    Shells,
    /// Body-centred cubic, two particles in a cell; three dimensions alone.
    BodyCentred,
    /// Face-centred cubic, four particles in a cell; three dimensions alone.
    FaceCentred,
    /// Without any order: a relaxed, periodic tile, fitted to the surface of the shape.
    Glass,
}

/// A lattice of particles: its arrangement, spacing and orientation.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Lattice {
    /// Kind of stacking.
    pub kind: LatticeKind,
    /// Particle spacing Δp (m): there is one particle in a volume Δp^d, for every arrangement (but
    /// for the rounding of rings). If it is graded, the finest.
    pub spacing: f64,
    /// The growth of the spacing, if any: of glass alone.
    pub grading: Option<Grading>,
    /// Smallest and largest size of particles against those of the spacing, unless all are alike.
    pub sizes: Option<[f64; 2]>,
    /// Turn of the lattice about an axis through the shape's centre (rad).
    pub angle: f64,
    /// That axis; z if absent.
    pub axis: Option<Vec3>,
    /// `true` if a cubic lattice is stretched by axis until it fills a box exactly.
    pub fit: bool,
    /// Seed of a filling that is drawn at random.
    pub seed: u64,
    /// Volume of one particle (m³; m² or m in two or one dimensions), if not Δp^d, so that all
    /// together fill the volume of the shape; where the spacing is graded, of a finest one.
    pub volume: Option<f64>,
}

impl Lattice {
    /// Spacing (m) at a place (m).
    #[must_use]
    pub fn spacing_at(&self, place: &Vec3) -> f64 {
        self.grading.map_or(self.spacing, |grading| {
            grading.spacing(self.spacing, grading.from.distance(place))
        })
    }

    /// Half of what the spacing at a place (m) is above the finest (m): so much earlier a particle
    /// there touches something.
    #[must_use]
    pub fn wider(&self, place: &[f64; 3]) -> f64 {
        0.5 * (self.spacing_at(&Vec3::from(*place)) - self.spacing)
    }

    /// The coarsest spacing (m).
    #[must_use]
    pub fn coarsest(&self) -> f64 {
        match (&self.grading, self.sizes) {
            (Some(grading), _) => grading.coarsest,
            (None, Some([_, largest])) => self.spacing * largest,
            (None, None) => self.spacing,
        }
    }

    /// Lets the spacing grow.
    pub fn grade(&mut self, grading: Option<Grading>) {
        self.sizes = grading.map(|grading| [1.0, grading.coarsest / self.spacing]);
        self.grading = grading;
    }

    /// Volume of one particle (m³; m² or m in two or one dimensions), of a finest one where the
    /// spacing is graded.
    #[must_use]
    pub fn particle_volume(&self, dimension: usize) -> f64 {
        self.volume.unwrap_or_else(|| cube(self.spacing, dimension))
    }
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
    /// The rest of the initial state of its particles.
    pub initial: Initial,
    /// Initial velocity of its centre (m/s); where that varies, the middle of all.
    pub velocity: Vec3,
    /// Initial angular velocity about its centre (rad/s).
    pub angular_velocity: Vec3,
    /// The motion of a rigid body; forces move one that has no component of it. Absent for bodies that deform.
    pub rigid: Option<Motion>,
    /// How a rigid body can move, if forces move it.
    pub freedom: Freedom,
    /// Constant smoothing length h₀ (m): the reference of contact, and of the SPH sums unless
    /// they vary it.
    pub smoothing_length: f64,
    /// True if its sums are over the neighbours of its initial configuration, until it tears.
    pub total: bool,
    /// True if it is a layer of a mass for its area: too thin for waves and bending of its own.
    pub layer: bool,
    /// Its sites as they were counted once it stood in its final place; absent if nobody has counted them.
    /// A change of shape or lattice makes it void.
    pub filled: Option<Filled>,
}

/// Number and bounds of the sites of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Filled {
    /// The planes above which sites are counted.
    pub symmetry: Vec<SymmetryPlane>,
    /// Sites above the planes.
    pub count: u64,
    /// Smallest and largest coordinates (m) of all sites of the body; `None` if it has none.
    pub whole: Option<Extent>,
    /// Those of the sites above the planes.
    pub above: Option<Extent>,
}

impl Body {
    /// Constant smoothing length of its largest particles (m).
    #[must_use]
    pub fn longest_smoothing_length(&self) -> f64 {
        let [_, largest] = self.lattice.sizes.unwrap_or([1.0; 2]);
        self.smoothing_length * largest
    }

    /// Its particles and the position of their origin (m), if a file gives them.
    #[must_use]
    pub fn cloud(&self) -> Option<(&Arc<Cloud>, &Vec3)> {
        match &self.shape {
            Shape::Solid(Solid::Primitive(Primitive::Cloud(cloud), Placement { at, .. })) => {
                Some((cloud, at))
            }
            _ => None,
        }
    }

    /// Its extent (m) along a unit vector.
    #[must_use]
    pub fn thickness_along(&self, way: &Vec3, dimension: usize) -> f64 {
        let solid = self.shape.solid(dimension);
        solid.support(way) + solid.support(&-way)
    }

    /// `true` if a file gives a quantity of its particles.
    #[must_use]
    pub fn holds(&self, quantity: Quantity) -> bool {
        let cloud = self.cloud();
        cloud.is_some_and(|(cloud, _)| cloud.all(quantity).is_some())
    }

    /// `true` for a rigid body that forces move.
    #[must_use]
    pub fn is_free(&self) -> bool {
        let mut axes = 0..3;
        let motion = self.rigid.as_ref();
        motion.is_some_and(|motion| !axes.any(|axis| motion.has(axis)))
    }

    /// The motion that a rigid body keeps, whatever acts on it.
    #[must_use]
    pub fn driven(&self) -> Option<&Motion> {
        self.rigid.as_ref().filter(|_| !self.is_free())
    }

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
