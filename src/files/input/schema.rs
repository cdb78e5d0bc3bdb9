//! A case as it is typed: what each table may hold, before anything is checked.
//!
//! Each choice with parameters is a table of its own (`shape.sphere`, `eos.mie_gruneisen`) rather
//! than a tagged enum, since places in the text do not survive those.

use serde::Deserialize;
use toml::Spanned;

use super::forms::{Named, OneOrMany};
use super::profile::ProfileParams;
use super::quantity::{
    Acceleration, Density, Extent, Length, Placed, SpecificEnergy, Strain, Temperature, Time,
    Velocity,
};
use model::{Axis, SphForm};

#[macro_use]
mod declare;
mod choices;
pub mod contact;
pub mod describe;
mod fragments;
mod materials;
mod measure;
mod numerical_limits;
mod output;
mod particles;
mod shapes;
mod short;
mod surfaces;
pub use choices::*;
pub use contact::{ContactParams, PairParams};
pub use fragments::*;
pub use materials::*;
pub use measure::*;
pub use numerical_limits::*;
pub use output::*;
pub use particles::*;
pub use shapes::*;
pub use short::*;
pub use surfaces::*;

/// A vector of lengths.
pub type Point = Spanned<Vec<Spanned<Extent>>>;

tables! {
    /// The whole document.
    CaseParams {
        /// One line for reports and plots, without control characters; `"untitled"` if absent.
        title: Option<Spanned<String>>,
        /// 1, 2 or 3.
        dimension: Spanned<i64>,
        /// Particle spacing of every body that sets no own.
        spacing: Option<Placed<Length>>,
        /// When the run ends.
        run: Spanned<RunParams>,
        /// Options of the SPH sums.
        #[serde(default)]
        sph: SphParams,
        /// Stability factors.
        #[serde(default)]
        time_step: TimeStepParams,
        /// Distribution over ranks.
        #[serde(default)]
        domain: DomainParams,
        /// Materials by name, as of a body.
        #[serde(default)]
        material: Named<MaterialParams>,
        /// Bodies.
        #[serde(default)]
        body: Vec<Spanned<BodyParams>>,
        /// Contact between bodies.
        #[serde(default)]
        contact: ContactParams,
        /// Symmetry planes.
        #[serde(default)]
        symmetry: Vec<SymmetryParams>,
        /// Acceleration of gravity; none if absent.
        gravity: Option<Spanned<Vec<Placed<Acceleration>>>>,
        /// Prescribed velocities.
        #[serde(default)]
        load: Vec<Spanned<LoadParams>>,
        /// Absorbing zones.
        #[serde(default)]
        absorb: Vec<Spanned<AbsorbParams>>,
        /// Rigid planes.
        #[serde(default)]
        plane: Vec<Spanned<PlaneParams>>,
        /// Rigid surfaces of other shapes.
        #[serde(default)]
        surface: Vec<Spanned<SurfaceParams>>,
        /// Numerical failure limits; `trouble` is an older name of this table.
        #[serde(default)]
        numerical_limits: NumericalLimitsParams,
        /// What is written.
        #[serde(default)]
        output: OutputParams,
        /// Fragments; not told if absent.
        fragments: Option<FragmentsParams>,
        /// Gauges.
        #[serde(default)]
        gauge: Vec<Spanned<GaugeParams>>,
        /// Planes that count what passes.
        #[serde(default)]
        witness: Vec<Spanned<WitnessParams>>,
        /// What is measured.
        #[serde(default)]
        measure: MeasureParams,
    }

    /// `[run]`
    RunParams {
        /// End of the case.
        end_time: Placed<Time>,
        /// Largest number of steps; no bound if absent.
        max_steps: Option<Spanned<i64>>,
    }

    /// `[[body]]`
    BodyParams {
        /// Unique name, of letters, digits, spaces and `-_.+()`.
        name: Spanned<String>,
        /// Name of a material; only a rigid body needs none.
        material: Option<Spanned<String>>,
        /// Geometry.
        shape: Option<Spanned<ShapeParams>>,
        /// Those of a file, in place of a shape and its filling.
        particles: Option<Spanned<ParticlesParams>>,
        /// Stacking of the particles; glass, in fewer than three dimensions and with stress points cubic, if
        /// absent.
        lattice: Option<Spanned<LatticeParams>>,
        /// Own particle spacing, or how it grows; the case's if absent.
        spacing: Option<Spanned<SpacingParams>>,
        /// Initial velocity; at rest if absent.
        velocity: Option<Spanned<Vec<Spanned<ProfileParams<Velocity>>>>>,
        /// Initial angular velocity; none if absent.
        angular_velocity: Option<Spanned<AngularVelocityParams>>,
        /// Initial density; the material's reference density if absent.
        density: Option<Placed<Density>>,
        /// Initial specific energy; that of the material's reference state if absent.
        specific_energy: Option<Spanned<ProfileParams<SpecificEnergy>>>,
        /// Initial temperature, in place of it.
        temperature: Option<Spanned<ProfileParams<Temperature>>>,
        /// Initial equivalent plastic strain; none if absent.
        plastic_strain: Option<Spanned<ProfileParams<Strain>>>,
        /// Moves the body until it touches another one; not moved if absent.
        touch: Option<TouchParams>,
        /// Whether the body is rigid and keeps its velocity, whatever acts on it; `false` if absent.
        rigid: Option<bool>,
        /// Motion of a rigid body; its `velocity` for ever if absent.
        motion: Option<Spanned<MotionParams>>,
    }

    /// `[[load]]`
    LoadParams {
        /// Name in reports, as of a body; `load-1` and so on if absent.
        name: Option<Spanned<String>>,
        /// Name of a body.
        body: Spanned<String>,
        /// Smallest coordinates of the region; open if absent.
        above: Option<Spanned<SidesParams>>,
        /// Largest coordinates of the region; open if absent.
        below: Option<Spanned<SidesParams>>,
        /// The velocity.
        velocity: Spanned<MotionParams>,
        /// When the particles are free again; never if absent.
        until: Option<Placed<Time>>,
    }

    /// `[[absorb]]`
    AbsorbParams {
        /// Name in reports, as of a body; `absorb-1` and so on if absent.
        name: Option<Spanned<String>>,
        /// Name of a body.
        body: Spanned<String>,
        /// Directions out of the body in which it goes on; none if absent.
        faces: Option<Spanned<Vec<Spanned<NormalParams>>>>,
        /// Whether it goes on beyond its curved face, or which one that is; false if absent.
        round: Option<Spanned<RoundParams>>,
        /// How far the zone reaches into the body; 30 spacings if absent.
        depth: Option<Spanned<Extent>>,
    }

    /// `above`, `below`: sides of a region, open where absent.
    SidesParams {
        /// On the first axis.
        x: Option<Spanned<Extent>>,
        /// On the second axis.
        y: Option<Spanned<Extent>>,
        /// On the third axis.
        z: Option<Spanned<Extent>>,
    }

    /// `domain.keep`: sides of the box of interest, at least one.
    KeepParams {
        /// Smallest coordinates; open if absent.
        above: Option<Spanned<SidesParams>>,
        /// Largest coordinates; open if absent.
        below: Option<Spanned<SidesParams>>,
    }

    /// A velocity as a function of time; free on axes that are absent.
    MotionParams {
        /// Times of the table.
        times: Option<Spanned<Vec<Placed<Time>>>>,
        /// Along the first axis.
        x: Option<Spanned<OneOrMany<Velocity>>>,
        /// Along the second axis.
        y: Option<Spanned<OneOrMany<Velocity>>>,
        /// Along the third axis.
        z: Option<Spanned<OneOrMany<Velocity>>>,
    }

    /// `touch`
    TouchParams {
        /// The body to touch.
        body: Spanned<String>,
        /// Where to move: `"-z"`.
        direction: Spanned<Direction>,
    }

    /// `[[symmetry]]`
    SymmetryParams {
        /// Normal.
        axis: Spanned<Axis>,
        /// Where the plane cuts the axis; `0` if absent.
        position: Option<Placed<Length>>,
    }
}

optional_tables! {
    /// `[sph]`
    SphParams {
        /// How gradients are taken; `"corrected"` if absent.
        form: Option<Spanned<SphForm>>,
        /// Smoothing length over particle spacing; `1.3` if absent.
        smoothing: Option<Spanned<f64>>,
        /// Linear viscosity; `1.0` if absent.
        alpha: Option<Spanned<f64>>,
        /// Quadratic viscosity; `2.0` if absent.
        beta: Option<Spanned<f64>>,
        /// Constant or variable; `"constant"` if absent.
        smoothing_length: Option<SmoothingName>,
        /// Smallest h/h₀ of a variable smoothing length; `0.6` if absent.
        smoothing_length_min: Option<Spanned<f64>>,
        /// Largest h/h₀ of a variable smoothing length; `2.0` if absent.
        smoothing_length_max: Option<Spanned<f64>>,
        /// Factor of the artificial stress; `0` if absent.
        artificial_stress: Option<Spanned<f64>>,
        /// The Balsara switch; `false` if absent.
        balsara: Option<bool>,
        /// Coefficient of the artificial conduction; `0` if absent.
        conduction: Option<Spanned<f64>>,
        /// Factor of XSPH; `0` if absent.
        xsph: Option<Spanned<f64>>,
        /// Stiffness of the hourglass control of the corrected form; `0.1` if absent.
        hourglass: Option<Spanned<f64>>,
    }

    /// `[time_step]`
    TimeStepParams {
        /// Factor of the sound and viscosity criterion; `0.5` if absent.
        courant: Option<Spanned<f64>>,
        /// Factor of the acceleration criterion; `0.25` if absent.
        force: Option<Spanned<f64>>,
        /// Safety factor of the contact criterion; `0.8` if absent.
        contact: Option<Spanned<f64>>,
        /// Upper bound; none but what materials demand if absent.
        max: Option<Placed<Time>>,
    }

    /// `[domain]`
    DomainParams {
        /// The first of `axes`, if it alone is said.
        axis: Option<Spanned<Axis>>,
        /// Axes of the slabs, of the slabs of these, and so on; the longest of the others at each level if absent.
        axes: Option<Spanned<Vec<Spanned<Axis>>>>,
        /// How many of them there are at most; `"auto"` if absent.
        levels: Option<Spanned<LevelsParams>>,
        /// Most steps between two balances; `25` if absent.
        balance_every: Option<Spanned<i64>>,
        /// The box of interest; everything if absent.
        keep: Option<Spanned<KeepParams>>,
    }
}
