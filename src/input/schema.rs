//! A case as it is typed: what each table may hold, before anything is checked.
//!
//! Each choice with parameters is a table of its own (`shape.sphere`, `eos.mie_gruneisen`) rather
//! than a tagged enum, since places in the text do not survive those.

use serde::Deserialize;
use toml::Spanned;

use super::forms::{FrictionParams, LatticeParams, Named, OneOrMany, SelfContactParams};
use super::quantity::{
    Acceleration, Angle, Density, Extent, Length, Quantity, SpecificEnergy, Time, Velocity,
};

/// A quantity with its place in the text.
pub type Placed<K> = Spanned<Quantity<K>>;
/// A vector of lengths.
pub type Point = Spanned<Vec<Spanned<Extent>>>;

/// Declares tables whose keys are all optional unless said, and closed to others.
macro_rules! tables {
    ($($(#[$doc:meta])+ $table:ident { $($(#[$key_doc:meta])+ $key:ident: $value:ty,)* })+) => { $(
        $(#[$doc])+
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields, remote = "Self")]
        pub struct $table { $($(#[$key_doc])+ pub $key: $value,)* }
        from_table!($table);
    )+ };
}

/// Reads a struct from a table alone: serde would take an array of its values too, in the order of
/// the declaration. What is derived is an inherent function, by `remote = "Self"`.
macro_rules! from_table {
    ($table:ident) => {
        impl crate::input::forms::Table for $table {
            fn from_map<'de, A: serde::de::MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
                Self::deserialize(serde::de::value::MapAccessDeserializer::new(map))
            }
        }

        impl<'de> Deserialize<'de> for $table {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                crate::input::forms::table(deserializer)
            }
        }
    };
}

tables! {
    /// The whole document.
    CaseParams {
        /// One line for reports and plots, without control characters.
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
        /// Acceleration of gravity.
        gravity: Option<Spanned<Vec<Placed<Acceleration>>>>,
        /// Prescribed velocities.
        #[serde(default)]
        load: Vec<Spanned<LoadParams>>,
        /// Rigid planes.
        #[serde(default)]
        plane: Vec<Spanned<PlaneParams>>,
        /// Rigid surfaces of other shapes.
        #[serde(default)]
        surface: Vec<Spanned<SurfaceParams>>,
        /// Numerical trouble.
        #[serde(default)]
        trouble: TroubleParams,
        /// What is written.
        #[serde(default)]
        output: OutputParams,
    }

    /// `[run]`
    RunParams {
        /// End of the case.
        end_time: Placed<Time>,
        /// Largest number of steps.
        max_steps: Option<Spanned<i64>>,
    }

    /// `[[body]]`
    BodyParams {
        /// Unique name, of letters, digits, spaces and `-_.+()`.
        name: Spanned<String>,
        /// Name of a material; only a rigid body needs none.
        material: Option<Spanned<String>>,
        /// Geometry.
        shape: Spanned<ShapeParams>,
        /// Stacking of the particles; cubic if absent.
        lattice: Option<Spanned<LatticeParams>>,
        /// Own particle spacing.
        spacing: Option<Placed<Length>>,
        /// Initial velocity; at rest if absent.
        velocity: Option<Spanned<Vec<Placed<Velocity>>>>,
        /// Initial density; the material's reference density if absent.
        density: Option<Placed<Density>>,
        /// Initial specific energy; that of the material's reference state if absent.
        specific_energy: Option<Placed<SpecificEnergy>>,
        /// Moves the body until it touches another one.
        touch: Option<TouchParams>,
        /// Whether the body is rigid: it keeps its velocity, whatever acts on it.
        rigid: Option<bool>,
        /// Motion of a rigid body.
        motion: Option<Spanned<MotionParams>>,
    }

    /// `[[load]]`
    LoadParams {
        /// Name in reports, as of a body.
        name: Option<Spanned<String>>,
        /// Name of a body.
        body: Spanned<String>,
        /// Smallest coordinates of the region.
        above: Option<Spanned<SidesParams>>,
        /// Largest coordinates of the region.
        below: Option<Spanned<SidesParams>>,
        /// The velocity.
        velocity: Spanned<MotionParams>,
        /// When the particles are free again.
        until: Option<Placed<Time>>,
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

    /// `shape`: exactly one of these.
    ShapeParams {
        /// Axis-aligned box.
        r#box: Option<Spanned<BoxParams>>,
        /// Ball; a disc in two dimensions.
        sphere: Option<Spanned<SphereParams>>,
        /// Circular cylinder along an axis.
        cylinder: Option<Spanned<CylinderParams>>,
    }

    /// `shape.box`: two corners, or size and centre.
    BoxParams {
        /// Corner of smallest coordinates.
        lower: Option<Point>,
        /// Corner of largest coordinates.
        upper: Option<Point>,
        /// Centre; the origin if absent.
        centre: Option<Point>,
        /// Edges.
        size: Option<Point>,
    }

    /// `shape.sphere`
    SphereParams {
        /// The origin if absent.
        centre: Option<Point>,
        /// Radius.
        radius: Spanned<Extent>,
        /// Radius of a hole in the middle; none if absent.
        inner_radius: Option<Spanned<Extent>>,
    }

    /// `shape.cylinder`
    CylinderParams {
        /// Middle of the axis; the origin if absent.
        centre: Option<Point>,
        /// Direction of the axis; z if absent.
        axis: Option<Spanned<AxisName>>,
        /// Radius.
        radius: Spanned<Extent>,
        /// Length along the axis.
        length: Spanned<Extent>,
    }

    /// `lattice` as a table.
    LatticeTable {
        /// Kind of stacking.
        kind: Spanned<LatticeName>,
        /// Turn about z.
        angle: Option<Placed<Angle>>,
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
        axis: Spanned<AxisName>,
        /// Where the plane cuts the axis; zero if absent.
        position: Option<Placed<Length>>,
    }

    /// `[[contact.pair]]`
    PairParams {
        /// Names of two bodies.
        bodies: Spanned<Vec<Spanned<String>>>,
        /// What happens where they meet; as for all others if absent.
        mode: Option<ModeName>,
        /// Coefficients of friction.
        friction: Option<Spanned<FrictionParams>>,
        /// Share of critical damping.
        damping: Option<Spanned<f64>>,
        /// Parameters of the mode `overlap`.
        #[serde(default)]
        overlap: OverlapParams,
        /// Parameters of the mode `potential`.
        #[serde(default)]
        potential: PotentialParams,
        /// Parameters of the mode `penalty`.
        #[serde(default)]
        penalty: PenaltyParams,
    }
}

/// Declares tables that may be left out altogether.
macro_rules! optional_tables {
    ($($(#[$doc:meta])+ $table:ident { $($(#[$key_doc:meta])+ $key:ident: $value:ty,)* })+) => { $(
        $(#[$doc])+
        #[derive(Debug, Default, Deserialize)]
        #[serde(default, deny_unknown_fields, remote = "Self")]
        pub struct $table { $($(#[$key_doc])+ pub $key: $value,)* }
        from_table!($table);
    )+ };
}

mod materials;
mod surfaces;
mod trouble;
pub use materials::*;
pub use surfaces::*;
pub use trouble::*;

optional_tables! {
    /// `[sph]`
    SphParams {
        /// How gradients are taken.
        form: Option<Spanned<SphFormName>>,
        /// Smoothing length over particle spacing.
        smoothing: Option<Spanned<f64>>,
        /// Linear viscosity.
        alpha: Option<Spanned<f64>>,
        /// Quadratic viscosity.
        beta: Option<Spanned<f64>>,
        /// Constant or variable.
        smoothing_length: Option<SmoothingName>,
        /// Smallest h/h₀ of a variable smoothing length.
        smoothing_length_min: Option<Spanned<f64>>,
        /// Largest h/h₀ of a variable smoothing length.
        smoothing_length_max: Option<Spanned<f64>>,
        /// Factor of the artificial stress.
        artificial_stress: Option<Spanned<f64>>,
        /// The Balsara switch.
        balsara: Option<bool>,
        /// Coefficient of the artificial conduction.
        conduction: Option<Spanned<f64>>,
        /// Factor of XSPH.
        xsph: Option<Spanned<f64>>,
    }

    /// `[time_step]`
    TimeStepParams {
        /// Factor of the sound and viscosity criterion.
        courant: Option<Spanned<f64>>,
        /// Factor of the acceleration criterion.
        force: Option<Spanned<f64>>,
        /// Safety factor of the contact criterion.
        contact: Option<Spanned<f64>>,
        /// Upper bound.
        max: Option<Placed<Time>>,
    }

    /// `[domain]`
    DomainParams {
        /// Axis of the slabs.
        axis: Option<Spanned<AxisName>>,
        /// Steps between two balances.
        balance_every: Option<Spanned<i64>>,
    }

    /// `[contact]`
    ContactParams {
        /// Mode of all pairs that have no own.
        mode: Option<ModeName>,
        /// Coefficients of friction.
        friction: Option<Spanned<FrictionParams>>,
        /// Share of critical damping.
        damping: Option<Spanned<f64>>,
        /// Contact of a body with itself.
        self_contact: Option<Spanned<SelfContactParams>>,
        /// Parameters of the mode `overlap`.
        overlap: OverlapParams,
        /// Parameters of the mode `potential`.
        potential: PotentialParams,
        /// Parameters of the mode `penalty`.
        penalty: PenaltyParams,
        /// Pairs with a mode or parameters of their own.
        pair: Vec<PairParams>,
    }

    /// `contact.self_contact` as a table.
    SelfContactTable {
        /// Spacings between the beginnings of particles that can fold onto each other.
        folds: Option<Spanned<f64>>,
    }

    /// `contact.overlap`
    OverlapParams {
        /// Stiffness κ.
        stiffness: Option<Spanned<f64>>,
        /// Stiffness `κ_c` of the core.
        core_stiffness: Option<Spanned<f64>>,
        /// Radius of the core in mean spacings.
        core_radius: Option<Spanned<f64>>,
        /// Along what it acts.
        direction: Option<Spanned<DirectionName>>,
    }

    /// `contact.potential`
    PotentialParams {
        /// Stiffness k.
        stiffness: Option<Spanned<f64>>,
        /// Exponent n.
        exponent: Option<Spanned<i64>>,
        /// Range of the force.
        range: Option<Spanned<RangeName>>,
        /// Along what it acts.
        direction: Option<Spanned<DirectionName>>,
    }

    /// `contact.penalty`
    PenaltyParams {
        /// Stiffness κ.
        stiffness: Option<Spanned<f64>>,
        /// Law of the force.
        law: Option<PenaltyLawName>,
    }

    /// `[output]`
    OutputParams {
        /// Time between snapshots.
        snapshot_every: Option<Placed<Time>>,
        /// Time between checkpoints.
        checkpoint_every: Option<Placed<Time>>,
        /// Steps between checkpoints.
        checkpoint_every_steps: Option<Spanned<i64>>,
        /// Time of the clock between checkpoints.
        checkpoint_every_wall: Option<Placed<Time>>,
        /// How many are kept.
        checkpoints_kept: Option<Spanned<i64>>,
        /// Steps between rows of the histories.
        history_every: Option<Spanned<i64>>,
        /// Snapshot fields, at least one.
        fields: Option<Spanned<Vec<Spanned<String>>>>,
    }
}

tables! {
    /// `friction` as a table.
    FrictionTable {
        /// Of faces that stick.
        r#static: Spanned<f64>,
        /// Of faces that slide.
        kinetic: Spanned<f64>,
    }
}

/// Declares words to choose from.
macro_rules! choices {
    ($($(#[$doc:meta])+ $choice:ident { $($(#[$word_doc:meta])+ $word:ident,)+ })+) => { $(
        $(#[$doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum $choice { $($(#[$word_doc])+ $word,)+ }
    )+ };
}

choices! {
    /// A coordinate axis.
    AxisName {
        /// First.
        X,
        /// Second.
        Y,
        /// Third.
        Z,
    }
    /// Side of a surface.
    SideName {
        /// Outside, as of a punch.
        Outside,
        /// Inside, as of a container.
        Inside,
    }
    /// Kind of lattice.
    LatticeName {
        /// Simple cubic.
        Cubic,
        /// Hexagonal close-packed.
        Hexagonal,
        /// Concentric rings.
        Rings,
    }
    /// How the SPH sums take gradients.
    SphFormName {
        /// By the kernel's gradient.
        Conventional,
        /// By the corrected gradient.
        Normalised,
        /// By linear fits at stress points.
        StressPoints,
    }
    /// Smoothing length in the SPH sums.
    SmoothingName {
        /// h = h₀.
        Constant,
        /// h follows the density.
        Variable,
    }
    /// Along what contact forces act.
    DirectionName {
        /// The line between particles.
        Pair,
        /// The normal of the surfaces.
        Normal,
    }
    /// Contact mode.
    ModeName {
        /// Nothing.
        None,
        /// One continuum.
        Kernel,
        /// Contact potential.
        Potential,
        /// Overlap energy.
        Overlap,
        /// Penalty between boundary particles.
        Penalty,
    }
    /// Law of the penalty force.
    PenaltyLawName {
        /// Depth to the power 3/2.
        Hertz,
        /// No more than what stops the approach in one step.
        Pinball,
    }
    /// Range of the contact potential.
    RangeName {
        /// 2h.
        Support,
        /// Mean spacing.
        Spacing,
    }
    /// Form of the linear equation of state.
    FormName {
        /// ln(ρ/ρ₀).
        Logarithmic,
        /// ρ/ρ₀ − 1.
        DensityRatio,
    }
}

/// A signed axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum Direction {
    /// Towards larger x.
    #[serde(rename = "+x")]
    PlusX,
    /// Towards smaller x.
    #[serde(rename = "-x")]
    MinusX,
    /// Towards larger y.
    #[serde(rename = "+y")]
    PlusY,
    /// Towards smaller y.
    #[serde(rename = "-y")]
    MinusY,
    /// Towards larger z.
    #[serde(rename = "+z")]
    PlusZ,
    /// Towards smaller z.
    #[serde(rename = "-z")]
    MinusZ,
}
