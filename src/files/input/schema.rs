//! A case as it is typed: what each table may hold, before anything is checked.
//!
//! Each choice with parameters is a table of its own (`shape.sphere`, `eos.mie_gruneisen`) rather
//! than a tagged enum, since places in the text do not survive those.

use serde::Deserialize;
use toml::Spanned;

use super::forms::{Named, OneOrMany};
use super::profile::ProfileParams;
use super::quantity::{
    Acceleration, Angle, ArealMass, Density, Extent, Gravitation, Length, Placed, Pressure, Rate,
    SpecificEnergy, Strain, Temperature, Time, Velocity,
};
use super::source::Diagnostic;
use model::{Axis, BodyForm, FibrePattern, SphForm, TermOptions, pair_terms};

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
pub mod value;
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
        /// One line for reports and plots, without control characters. Keys in braces, as in `{velocity}`, stand for
        /// their values.
        title: Option<Spanned<String>> = "untitled";
        /// 1, 2 or 3.
        dimension: Spanned<i64>;
        /// In two dimensions: x is the distance from an axis and y the place along it, about which all is the same. Bodies
        /// stand at x above zero.
        axisymmetric: Option<Spanned<bool>> = false;
        /// Particle spacing of every body that sets no own.
        spacing: Option<Placed<Length>>, Positive;
        /// When the run ends.
        run: Spanned<RunParams>;
        /// Options of the SPH sums.
        #[serde(default)]
        sph: SphParams;
        /// Stability factors.
        #[serde(default)]
        time_step: TimeStepParams;
        /// Distribution over ranks.
        #[serde(default)]
        domain: DomainParams;
        /// Materials by name, as of a body.
        #[serde(default)]
        material: Named<MaterialParams>;
        /// Bodies.
        #[serde(default)]
        body: Vec<Spanned<BodyParams>>;
        /// Contact between bodies.
        #[serde(default)]
        contact: ContactParams;
        /// Symmetry planes.
        #[serde(default)]
        symmetry: Vec<SymmetryParams>;
        /// Acceleration of gravity.
        gravity: Option<Spanned<Vec<Placed<Acceleration>>>> => "none";
        /// Attraction of all particles by each other.
        self_gravity: Option<Spanned<SelfGravityParams>> => "none";
        /// Prescribed velocities.
        #[serde(default)]
        load: Vec<Spanned<LoadParams>>;
        /// Pressures on faces.
        #[serde(default)]
        pressure: Vec<Spanned<PressureParams>>;
        /// What brings bodies to rest at first.
        relaxation: Option<Spanned<RelaxationParams>> => "none";
        /// Points from which detonations run.
        #[serde(default)]
        detonate: Vec<Spanned<DetonateParams>>;
        /// Absorbing zones.
        #[serde(default)]
        absorb: Vec<Spanned<AbsorbParams>>;
        /// Rigid planes.
        #[serde(default)]
        plane: Vec<Spanned<PlaneParams>>;
        /// Rigid surfaces of other shapes.
        #[serde(default)]
        surface: Vec<Spanned<SurfaceParams>>;
        /// Numerical failure limits; `trouble` is an older name of this table.
        #[serde(default)]
        numerical_limits: NumericalLimitsParams;
        /// What is written.
        #[serde(default)]
        output: OutputParams;
        /// Fragments.
        fragments: Option<FragmentsParams> => "not told";
        /// Gauges.
        #[serde(default)]
        gauge: Vec<Spanned<GaugeParams>>;
        /// Planes that count what passes.
        #[serde(default)]
        witness: Vec<Spanned<WitnessParams>>;
        /// What is measured.
        #[serde(default)]
        measure: MeasureParams;
    }

    /// `[run]`
    RunParams {
        /// End of the case.
        end_time: Placed<Time>, Positive;
        /// Largest number of steps.
        max_steps: Option<Spanned<i64>>, AtLeast(1) => "no bound";
    }

    /// `[[body]]`
    BodyParams {
        /// Unique name, of letters, digits, spaces and `-_.+()`.
        name: Spanned<String>;
        /// Name of a material; only a rigid body needs none.
        material: Option<Spanned<String>>;
        /// Geometry.
        shape: Option<Spanned<ShapeParams>>;
        /// Those of a file, in place of a shape and its filling.
        particles: Option<Spanned<ParticlesParams>>;
        /// Stacking of the particles.
        lattice: Option<Spanned<LatticeParams>> => "glass, in fewer than three dimensions without axial symmetry and with stress points cubic";
        /// Own particle spacing, or how it grows.
        spacing: Option<Spanned<SpacingParams>> => "the case's";
        /// Initial velocity.
        velocity: Option<Spanned<Vec<Spanned<ProfileParams<Velocity>>>>> => "at rest";
        /// Initial speed, in place of `velocity`, along the last axis towards its smaller coordinates: `-z`, in two
        /// dimensions `-y`, in one `-x`.
        speed: Option<Placed<Velocity>>, NotNegative;
        /// Obliquity of `speed`: between the velocity and that axis, turned towards `+x`.
        angle: Option<Placed<Angle>> = "0", Any;
        /// Initial angular velocity.
        angular_velocity: Option<Spanned<AngularVelocityParams>> => "none";
        /// Initial density.
        density: Option<Placed<Density>>, Positive => "the material's reference density";
        /// Mass for an area of a layer with pores, as of cloth: how much of it is pores follows from its thickness.
        areal_density: Option<Placed<ArealMass>>, Positive => "that of its density and thickness";
        /// Initial specific energy.
        specific_energy: Option<Spanned<ProfileParams<SpecificEnergy>>> => "that of the material's reference state";
        /// Initial temperature, in place of it.
        temperature: Option<Spanned<ProfileParams<Temperature>>>;
        /// Initial equivalent plastic strain.
        plastic_strain: Option<Spanned<ProfileParams<Strain>>> => "none";
        /// Initial pressure, compression positive, from which the density follows.
        pressure: Option<Spanned<ProfileParams<Pressure>>> => "that of the density";
        /// Initial stress, tension positive, in place of it.
        stress: Option<Spanned<StressParams>> => "that pressure alone";
        /// True if the body begins under the weight of what lies above, or with which share of it on its sides.
        overburden: Option<Spanned<OverburdenParams>> => "false";
        /// Configuration whose neighbours its sums are over: the initial one until it tears (total), that of each step
        /// (updated), or the initial one of what yields and nothing meets faster than a tenth of its sound speed (auto).
        form: Option<Spanned<BodyForm>> = BodyForm::Auto;
        /// Directions of matter that has some of its own.
        fibres: Option<Spanned<FibresParams>> => "1 along x, 3 along z; in plates of `strength.uncoupled` 3 across them";
        /// Moves the body until it touches another one.
        touch: Option<TouchParams> => "not moved";
        /// True if the body is rigid: it keeps its velocity, whatever acts on it, unless it is `free`.
        rigid: Option<bool> = false;
        /// True if forces move the rigid body.
        free: Option<Spanned<bool>> = false;
        /// Axes along which a free rigid body moves.
        moves: Option<Spanned<Vec<Spanned<Axis>>>> => "all";
        /// Axes about which it turns: one, or none.
        turns: Option<Spanned<Vec<Spanned<Axis>>>> => "all";
        /// Point that stays where it is, and about which a free rigid body turns.
        pivot: Option<Spanned<Vec<Placed<Length>>>> => "none";
        /// Motion of a rigid body.
        motion: Option<Spanned<MotionParams>> => "its `velocity` for ever";
    }

    /// `body.fibres`: direction 1 along the fibres, 3 across the layers.
    FibresParams {
        /// How the directions depend on the place: the same everywhere (straight), 1 away from an axis and 3 along it (radial),
        /// or 1 around an axis and 3 away from it (wrapped).
        pattern: Option<FibrePattern> = FibrePattern::Straight;
        /// Direction 1 of what is straight.
        along: Option<Spanned<AxisParams>> => "x, where 3 is along x y";
        /// Direction 3 of what is straight.
        normal: Option<Spanned<AxisParams>> => "z; in plates of `strength.uncoupled` across them";
        /// Axis of the other patterns.
        axis: Option<Spanned<AxisParams>> => "z";
        /// A point of the axis, from which layers count.
        centre: Option<Spanned<Vec<Placed<Length>>>> => "the origin";
        /// Turn of directions 1 and 2 about 3.
        angle: Option<Placed<Angle>> = "0", Any;
        /// Turns of layers beside that, from `centre` on along direction 3; the first follows the last.
        layup: Option<Spanned<Vec<Placed<Angle>>>> => "none";
        /// Thickness of a layer of `layup`.
        ply: Option<Placed<Length>>, Positive;
    }

    /// `[[load]]`
    LoadParams {
        /// Name in reports, as of a body.
        name: Option<Spanned<String>> => "`load-1` and so on";
        /// Name of a body.
        body: Spanned<String>;
        /// Smallest coordinates of the region.
        above: Option<Spanned<SidesParams>> => "open";
        /// Largest coordinates of the region.
        below: Option<Spanned<SidesParams>> => "open";
        /// The velocity.
        velocity: Spanned<MotionParams>;
        /// When the particles are free again.
        until: Option<Placed<Time>>, Positive => "never";
    }

    /// `[[pressure]]`
    PressureParams {
        /// Name in reports, as of a body.
        name: Option<Spanned<String>> => "`pressure-1` and so on";
        /// Name of a body.
        body: Spanned<String>;
        /// Smallest coordinates of the region.
        above: Option<Spanned<SidesParams>> => "open";
        /// Largest coordinates of the region.
        below: Option<Spanned<SidesParams>> => "open";
        /// Times of the table.
        times: Option<Spanned<Vec<Placed<Time>>>>;
        /// The pressure on the free faces of what is in the region.
        value: Spanned<OneOrMany<Pressure>>;
    }

    /// `[relaxation]`
    RelaxationParams {
        /// When it ends.
        until: Placed<Time>, Positive;
        /// Rate at which velocities fall.
        rate: Option<Placed<Rate>>, Positive => "critical for the slowest vibration of the bodies together";
        /// Names of the bodies that wait, and start when it ends.
        waiting: Option<Vec<Spanned<String>>> => "none";
    }

    /// `[[absorb]]`
    AbsorbParams {
        /// Name in reports, as of a body.
        name: Option<Spanned<String>> => "`absorb-1` and so on";
        /// Name of a body.
        body: Spanned<String>;
        /// Directions out of the body in which it goes on.
        faces: Option<Spanned<Vec<Spanned<NormalParams>>>> => "none";
        /// True if it goes on beyond its curved face, or which one that is.
        round: Option<Spanned<RoundParams>> => "false";
        /// How far the zone reaches into the body.
        depth: Option<Spanned<Extent>> => "30 spacings";
    }

    /// `above`, `below`: sides of a region, open where absent.
    SidesParams {
        /// On the first axis.
        x: Option<Spanned<Extent>>;
        /// On the second axis.
        y: Option<Spanned<Extent>>;
        /// On the third axis.
        z: Option<Spanned<Extent>>;
    }

    /// `domain.keep`: sides of the box of interest, at least one.
    KeepParams {
        /// Smallest coordinates.
        above: Option<Spanned<SidesParams>> => "open";
        /// Largest coordinates.
        below: Option<Spanned<SidesParams>> => "open";
    }

    /// `stress` of a body: components, tension positive, zero where absent.
    StressParams {
        /// On the faces normal to x.
        xx: Option<Spanned<ProfileParams<Pressure>>>;
        /// On the faces normal to y.
        yy: Option<Spanned<ProfileParams<Pressure>>>;
        /// On the faces normal to z.
        zz: Option<Spanned<ProfileParams<Pressure>>>;
        /// Shear in the plane of x and y.
        xy: Option<Spanned<ProfileParams<Pressure>>>;
        /// Shear in the plane of x and z.
        xz: Option<Spanned<ProfileParams<Pressure>>>;
        /// Shear in the plane of y and z.
        yz: Option<Spanned<ProfileParams<Pressure>>>;
    }

    /// A velocity as a function of time; free on axes that are absent.
    MotionParams {
        /// Times of the table.
        times: Option<Spanned<Vec<Placed<Time>>>>;
        /// Along the first axis.
        x: Option<Spanned<OneOrMany<Velocity>>>;
        /// Along the second axis.
        y: Option<Spanned<OneOrMany<Velocity>>>;
        /// Along the third axis.
        z: Option<Spanned<OneOrMany<Velocity>>>;
    }

    /// `touch`
    TouchParams {
        /// The body to touch.
        body: Spanned<String>;
        /// Where to move: `"-z"`.
        direction: Spanned<Direction>;
    }

    /// `[[detonate]]`
    DetonateParams {
        /// The point.
        at: Spanned<Vec<Placed<Length>>>;
        /// When it lights.
        time: Option<Placed<Time>> = "0", NotNegative;
        /// The body that it lights.
        body: Option<Spanned<String>> => "all explosives";
    }

    /// `[[symmetry]]`
    SymmetryParams {
        /// Normal.
        axis: Spanned<Axis>;
        /// Where the plane cuts the axis.
        position: Option<Placed<Length>> = "0", Any;
    }
}

optional_tables! {
    /// `[time_step]`
    TimeStepParams {
        /// Factor of the sound and viscosity criterion.
        courant: Option<Spanned<f64>>, UpToOne => "0.65 in three dimensions, less with a small `alpha`; 0.5 in fewer, and with a body in the total form";
        /// Factor of the acceleration criterion.
        force: Option<Spanned<f64>>, UpToOne => "0.2 in three dimensions, 0.25 in fewer, and with a body in the total form";
        // Of a bound that is safe by itself; .55 of it is what the first moments of an impact at
        // h = 1.3 Δp take by their sound criterion, so that contact does not slow them down.
        /// Safety factor of the contact criterion.
        contact: Option<Spanned<f64>>, UpToOne => "1 in three dimensions, 0.8 in fewer, and with a body in the total form";
        /// Upper bound.
        max: Option<Placed<Time>>, Positive => "none but what materials demand";
    }

    /// `[self_gravity]`
    SelfGravityParams {
        /// Constant of gravitation.
        constant: Option<Placed<Gravitation>> = "6.6743e-11 m^3/(kg s^2)", Positive;
        /// Largest side of a cell that attracts as one body, over the distance of its middle.
        opening_angle: Option<Spanned<f64>> = 0.5, Within(0.1, 1.0);
    }

    /// `[domain]`
    DomainParams {
        /// The first of `axes`, if it alone is said.
        axis: Option<Spanned<Axis>>;
        /// Axes of the slabs, of the slabs of these, and so on.
        axes: Option<Spanned<Vec<Spanned<Axis>>>> => "the longest of the others at each level";
        /// How many of them there are at most.
        levels: Option<Spanned<LevelsParams>> = LevelsParams::Auto(AutoWord::Auto);
        /// Most steps between two balances.
        balance_every: Option<Spanned<i64>> = 25, AtLeast(0);
        /// The box of interest.
        keep: Option<Spanned<KeepParams>> => "everything";
    }
}

/// What a row holds: in error where it has a range.
macro_rules! held {
    ($found:expr; = $value:expr) => {
        $found
    };
    ($found:expr; = $value:expr, $($allowed:tt)+) => {
        $found?
    };
}

macro_rules! sph_table {
    ($( $(#[doc = $doc:literal])+ $term:ident { $key:ident: $typed:ident $($more:tt)+ } )+) => {
        optional_tables! {
            /// `[sph]`
            SphParams {
                /// How gradients are taken.
                form: Option<Spanned<SphForm>> = SphForm::Corrected;
                /// Smoothing length over particle spacing.
                smoothing: Option<Spanned<f64>> = 1.3, Within(0.6, 3.0);
                /// Linear viscosity.
                alpha: Option<Spanned<f64>> = 1.0, NotNegative;
                /// Quadratic viscosity.
                beta: Option<Spanned<f64>> = 2.0, NotNegative;
                /// Constant or variable.
                smoothing_length: Option<SmoothingName> => "variable where a material is an ideal gas, else constant";
                /// Smallest h/h₀ of a variable smoothing length.
                smoothing_length_min: Option<Spanned<f64>>, UpToOne => "1 where that is the default, else 0.6";
                /// Largest h/h₀ of a variable smoothing length.
                smoothing_length_max: Option<Spanned<f64>>, Within(1.0, 10.0) => "10 where that is the default, else 2";
                $( $(#[doc = $doc])+ $key: Option<Spanned<$typed>> $($more)+; )+
                /// Stiffness of the hourglass control of the corrected form.
                hourglass: Option<Spanned<f64>> = 0.1, Within(0.0, 1.0);
            }
        }

        impl SphParams {
            /// Options of the pair terms.
            pub fn terms(&self) -> Result<TermOptions, Diagnostic> {
                Ok(TermOptions { $( $key: held!(self.$key(); $($more)+), )+ })
            }
        }
    };
}
pair_terms!(sph_table);
