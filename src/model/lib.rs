//! The simulated problem, in SI units, before there are particles: bodies, materials, contact,
//! symmetry planes, and the controls of a run.
//!
//! A [`Case`] is complete and validated: the `input` module builds it from TOML, every later module
//! only reads it.

mod absorber;
mod axis;
mod axisymmetric;
mod beginning;
mod body;
mod closing_speeds;
mod cloud;
mod contact;
mod control;
pub mod differences;
mod distance;
mod fibres;
mod formula;
mod fragments;
mod freedom;
mod gauge;
mod grading;
mod initial;
mod load;
mod loading;
mod measure;
mod motion;
mod numerical_limits;
mod pair_terms;
pub mod readable;
mod region;
mod shape;
mod sizes;
mod solid;
mod surface;
mod total;
pub mod units;

pub use absorber::{Absorber, OuterFace};
pub use axis::{Axis, SymmetryPlane};
pub use beginning::Beginning;
pub use body::{Body, Filled, Lattice, LatticeKind};
pub use closing_speeds::ClosingSpeeds;
pub use cloud::{Cloud, Quantity, cube, edge};
pub use contact::*;
pub use control::{
    ClockInterval, DefaultFactors, DomainOptions, OutputOptions, Precision, RunControl, Sharing,
    SmoothingLength, SnapshotSchedule, SphForm, SphOptions, TimeStepOptions,
};
pub use fibres::{FibrePattern, Fibres, Layup};
pub use formula::{Combination, Formula, Function, Operation, Place, Profile};
pub use fragments::{FragmentOptions, Include};
pub use freedom::Freedom;
pub use gauge::{Cadence, Gauge, Witness};
pub use grading::{Focus, Grading};
pub use initial::{Heat, Initial};
pub use load::{Detonator, Loads, PressureLoad, Relaxation, SelfGravity, VelocityLoad};
pub use loading::{Column, ColumnOf, Loading};
pub use measure::{
    Bar, Debris, FrontLine, Measure, MeasureKind, MeasureOptions, Slab, Zone, ZonePlace,
};
pub use motion::Motion;
pub use numerical_limits::{NumericalFailurePolicy, NumericalLimits};
pub use pair_terms::TermOptions;
pub use region::Region;
pub use shape::Shape;
pub use sizes::Sizes;
pub use solid::{Placement, Polygon, Primitive, Repeat, Solid, rotation};
pub use surface::{
    Crossing, Feature, Foot, Mended, Mesh, MeshError, RigidSurface, Spin, SurfaceFile,
    SurfaceShape, closest_on_triangle, triangulate,
};
pub use total::BodyForm;

use material::Material;
use readable::Readable;

/// A vector of three components (m, m/s, …).
pub type Vec3 = nalgebra::Vector3<f64>;

/// Everything a run needs to know.
#[derive(Debug, Clone)]
pub struct Case {
    /// One line for reports and plots.
    pub title: String,
    /// The unit of length that the input speaks in: that of its spacing.
    pub length_unit: Readable,
    /// Number of space dimensions: 1 (uniaxial strain), 2 (plane strain) or 3.
    pub dimension: usize,
    /// True if the two dimensions are a radius and a place along the axis, about which all is the same: particles are rings.
    pub axisymmetric: bool,
    /// Materials, in the order of the input.
    pub materials: Vec<Material>,
    /// Bodies, in the order of the input; a particle's `body` is an index into this.
    pub bodies: Vec<Body>,
    /// Contact of each unordered pair of bodies that the input names; all others use
    /// [`Case::default_contact`].
    pub contacts: Vec<ContactPair>,
    /// Contact between bodies that no entry of [`Case::contacts`] names.
    pub default_contact: ContactMode,
    /// Contact of parts of one body with each other, of all bodies that are not rigid.
    pub self_contact: Option<SelfContact>,
    /// Planes of symmetry, at most one for each axis.
    pub symmetry: Vec<SymmetryPlane>,
    /// Gravity, prescribed velocities, absorbing zones and rigid surfaces.
    pub loads: Loads,
    /// Options of the SPH sums.
    pub sph: SphOptions,
    /// Stability factors.
    pub time_step: TimeStepOptions,
    /// Distribution over ranks.
    pub domain: DomainOptions,
    /// Numerical failure limits.
    pub numerical_limits: NumericalLimits,
    /// When to stop.
    pub run: RunControl,
    /// The files to write and their times.
    pub output: OutputOptions,
    /// The output of fragments, if any.
    pub fragments: Option<FragmentOptions>,
    /// The measurements of the run.
    pub measure: MeasureOptions,
    /// The input with all overrides applied, as TOML text; reading it gives this case again.
    pub resolved: String,
}

impl Case {
    /// Contact mode between bodies `a` and `b` (order does not matter).
    #[must_use]
    pub fn contact_between(&self, a: usize, b: usize) -> &ContactMode {
        self.pair(a, b)
            .map_or(&self.default_contact, |pair| &pair.mode)
    }

    /// What holds bodies `a` and `b` together (order does not matter), if anything does.
    #[must_use]
    pub fn joint_between(&self, a: usize, b: usize) -> Option<&Joint> {
        self.pair(a, b)?.joint.as_ref()
    }

    /// The contact that bodies `a` and `b` have of their own.
    fn pair(&self, a: usize, b: usize) -> Option<&ContactPair> {
        let mut pairs = self.contacts.iter();
        pairs.find(|pair| (pair.bodies == [a, b]) || (pair.bodies == [b, a]))
    }

    /// Names of what acts from outside, in the order of its ledgers: prescribed velocities, rigid
    /// bodies, absorbing zones, relaxation, pressures, rigid surfaces.
    pub fn load_names(&self) -> impl Iterator<Item = &str> {
        let loads = self.loads.velocities.iter().map(|load| &load.name);
        let rigid = self.bodies.iter().filter(|body| body.rigid.is_some());
        let absorbers = self.loads.absorbers.iter().map(|absorber| &absorber.name);
        let relaxation = self.loads.relaxation.iter().map(|_| Relaxation::NAME);
        let pressures = self.loads.pressures.iter().map(|pressure| &pressure.name);
        let surfaces = self.loads.surfaces.iter().map(|surface| &surface.name);
        (loads.chain(rigid.map(|body| &body.name)))
            .chain(absorbers)
            .map(String::as_str)
            .chain(relaxation)
            .chain(pressures.chain(surfaces).map(String::as_str))
    }

    /// Density of a body at rest (kg/m³): its own, or that of its material.
    #[must_use]
    pub fn density_of(&self, body: usize) -> f64 {
        let body = &self.bodies[body];
        let reference = || self.materials[body.material].reference_density;
        body.density.unwrap_or_else(reference)
    }

    /// The meshes of bodies and of rigid surfaces, with the names of these.
    #[must_use]
    pub fn meshes(&self) -> Vec<(&str, &Mesh)> {
        let mut all: Vec<(&str, &Mesh)> = Vec::new();
        for body in &self.bodies {
            let mut meshes = Vec::new();
            if let Shape::Solid(solid) = &body.shape {
                solid.meshes(&mut meshes);
            }
            all.extend(meshes.into_iter().map(|mesh| (body.name.as_str(), &**mesh)));
        }
        for surface in &self.loads.surfaces {
            if let SurfaceShape::Mesh(mesh) = &surface.shape {
                all.push((&surface.name, mesh));
            }
        }
        all
    }

    /// Index of the body of a name.
    #[must_use]
    pub fn body_named(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| body.name == name)
    }

    /// Places of absorbing zones among [`Self::load_names`].
    #[must_use]
    pub fn absorber_ledgers(&self) -> std::ops::Range<usize> {
        let rigid = self.bodies.iter().filter(|body| body.rigid.is_some());
        let first = self.loads.velocities.len() + rigid.count();
        first..first + self.loads.absorbers.len()
    }

    /// `true` if this holds of the material of a body.
    pub fn any_material(&self, is: impl Fn(&Material) -> bool) -> bool {
        let mut bodies = self.bodies.iter();
        bodies.any(|body| is(&self.materials[body.material]))
    }

    /// `true` if a material of the case may fail for good.
    #[must_use]
    pub fn may_fail(&self) -> bool {
        self.any_material(|material| material.failure.has_memory())
    }

    /// `true` if a material of the case has pores.
    #[must_use]
    pub fn is_porous(&self) -> bool {
        self.any_material(|material| material.porosity.is_some())
    }

    /// `true` if a material of the case is an explosive.
    #[must_use]
    pub fn is_explosive(&self) -> bool {
        self.any_material(Material::burns)
    }

    /// `true` if a material of the case has directions of its own.
    #[must_use]
    pub fn has_directions(&self) -> bool {
        self.any_material(Material::has_directions)
    }

    /// `true` if failure of a material of the case changes this field.
    #[must_use]
    pub fn fails_with(&self, field: &str) -> bool {
        self.any_material(|material| material.failure.state().any(|name| name == field))
    }

    /// `true` if a material of the case may yield.
    #[must_use]
    pub fn may_yield(&self) -> bool {
        self.any_material(|material| material.strength.yields())
    }

    /// `true` if a material of a body tells its temperature.
    #[must_use]
    pub fn has_temperature(&self) -> bool {
        self.any_material(|material| material.thermal.is_some())
    }

    /// The largest sound speed (m/s) of what forces move; what is driven has a material that carries nothing.
    #[must_use]
    pub fn fastest_sound(&self) -> f64 {
        let bodies = self.bodies.iter().filter(|body| body.driven().is_none());
        let speeds = bodies.map(|body| self.materials[body.material].longitudinal_speed());
        speeds.fold(0.0, f64::max)
    }

    /// The impact speed (m/s) of contact and of the interpenetration measure: the largest speed of two bodies against each
    /// other by the velocities at which they begin and those that loads and rigid motions prescribe, at whatever times; or
    /// the largest speed of a single one if there is none.
    #[must_use]
    pub fn impact_speed(&self) -> f64 {
        let speed = ClosingSpeeds::new(self).largest();
        if speed > 0.0 {
            return speed;
        }
        let largest = |body: usize| {
            let velocities = self.known_velocities(body).into_iter();
            let largest = velocities.fold(0.0, |most: f64, velocity| most.max(velocity.norm()));
            largest + self.bodies[body].initial.velocity_spread
        };
        (0..self.bodies.len()).map(largest).fold(0.0, f64::max)
    }

    /// True if some bodies may meet so fast that their speed stiffens their contact, see [`Self::impact_stiffness`].
    #[must_use]
    pub fn meets_fast(&self) -> bool {
        let soft = || self.bodies.iter().filter(|body| body.driven().is_none());
        let modulus = soft().map(|body| self.contact_modulus(body));
        let density = soft().map(|body| self.initial_density(body));
        // A harmonic mean is as large as its smaller value, and with what is driven twice the other one, at most.
        let softest = modulus.fold(f64::INFINITY, f64::min) * (1.0 - 1e-9);
        let densest = 2.0 * density.fold(0.0, f64::max);
        Self::impact_stiffness(densest, self.impact_speed()) > softest
    }

    /// Stiffness (Pa) that stops particles of a density (kg/m³) which meet at a speed (m/s), whatever they are of.
    #[must_use]
    pub fn impact_stiffness(density: f64, speed: f64) -> f64 {
        0.85 * density * speed * speed
    }

    /// The velocity at which a body begins and all corners of the tables that prescribe one (m/s).
    fn known_velocities(&self, body: usize) -> Vec<Vec3> {
        let first = self.bodies[body].velocity;
        let loads = self.loads.velocities.iter().filter(|l| l.body == body);
        let tables = loads.map(|load| (&load.motion, load.until));
        let rigid = self.bodies[body].rigid.iter().map(|m| (m, f64::INFINITY));
        let corners = tables.chain(rigid).flat_map(|(motion, until)| {
            (0..motion.times.len()).map(move |k| {
                let along = |axis: usize, values: &Vec<f64>| {
                    if motion.times[k] <= until {
                        values[k]
                    } else {
                        motion.velocity(axis, until)
                    }
                };
                let velocity = |axis: usize| {
                    let values = motion.velocities[axis].as_ref();
                    values.map_or(first[axis], |values| along(axis, values))
                };
                Vec3::from_fn(|axis, _| velocity(axis))
            })
        });
        std::iter::once(first).chain(corners).collect()
    }
}
