//! The columns of the table of fields.

use bitflags::bitflags;
use model::{TermOptions, pair_terms};

/// Kind of the value of one particle in a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldKind {
    /// One `f64`.
    Scalar,
    /// Three `f64`: x, y, z.
    Vector,
    /// Six `f64`: xx, yy, zz, xy, xz, yz.
    Symmetric,
    /// Nine `f64`, row-major.
    Tensor,
    /// One `u64`.
    Id,
    /// One `u32`.
    Index,
}

impl FieldKind {
    /// Numbers per particle.
    #[must_use]
    pub const fn components(self) -> usize {
        match self {
            Self::Scalar | Self::Id | Self::Index => 1,
            Self::Vector => 3,
            Self::Symmetric => 6,
            Self::Tensor => 9,
        }
    }

    /// Bytes per particle.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Index => 4,
            _ => 8 * self.components(),
        }
    }

    /// True if the numbers are `f64`.
    #[must_use]
    pub const fn is_real(self) -> bool {
        !matches!(self, Self::Id | Self::Index)
    }

    /// The mirror rule of a row that says nothing else.
    pub(super) const fn mirror(self) -> Mirror {
        match self {
            Self::Scalar | Self::Id | Self::Index => Mirror::Same,
            Self::Vector => Mirror::Vector,
            Self::Symmetric => Mirror::Symmetric,
            Self::Tensor => Mirror::Tensor,
        }
    }
}

/// Rule for a value behind a symmetry plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mirror {
    /// It stays.
    Same,
    /// A place: its image is as far behind the plane.
    Place,
    /// The component normal to the plane changes its sign.
    Vector,
    /// Components with one index normal to the plane change their sign.
    Symmetric,
    /// The same of a tensor of nine components.
    Tensor,
}

/// From when to when a value lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Life {
    /// A step reads it before it writes it: in checkpoints, and moved between ranks.
    State,
    /// Alive while particles change ranks within a step: moved between ranks.
    Migrated,
    /// Written by a step before it is read.
    Scratch,
}

/// Use of a field in snapshots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Output {
    /// In snapshots by default.
    Default,
    /// In snapshots by default of cases that have use for it.
    IfHeld,
    /// In snapshots if `output.fields` names it.
    OnDemand,
    /// In no snapshot.
    Never,
}

bitflags! {
    /// The messages in which halo particles get a field: a set.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct HaloPhase: u8 {
        /// Before the neighbour search and the velocity gradient.
        const MOTION = 1;
        /// Before the forces.
        const STRESS = 1 << 1;
        /// Before the contact forces.
        const CONTACT = 1 << 2;
        /// Before the contact forces, if these have friction.
        const FRICTION = 1 << 3;
        /// Before a snapshot.
        const SHOWN = 1 << 4;
        /// With the motion, if materials ask for plastic strains about them.
        const STRAIN = 1 << 5;
        /// Before the forces, if these read it of neighbours and not of their records; else before a post-mortem.
        const STATE = 1 << 6;
        /// Whatever is needed before forces of stress and contact, in one message.
        const FORCES = Self::STRESS.bits() | Self::STATE.bits() | Self::CONTACT.bits();
    }
}

/// Bit of the first pair term in a set of options.
const FIRST_TERM: usize = 40;

macro_rules! owners {
    ($( $(#[$doc:meta])+ $term:ident { $key:ident: $($more:tt)+ } )+) => {
        #[allow(non_camel_case_types, reason = "variants carry the key of the term")]
        enum Term { $( $key, )+ }

        bitflags! {
            /// The options of a case that have use for a field: a set, empty for a field of every case.
            #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
            pub struct Owner: u64 {
                /// Contact beyond the SPH sums.
                const CONTACT = 1;
                /// Loads or rigid bodies that prescribe velocities.
                const LOADS = 1 << 1;
                /// Friction or damping between bodies in contact.
                const FRICTION = 1 << 2;
                /// The normalised form of the sums.
                const NORMALISED = 1 << 3;
                /// `penalty` contact.
                const PENALTY = 1 << 4;
                /// Friction or damping of rigid surfaces.
                const SURFACE_FRICTION = 1 << 5;
                /// Self-contact.
                const SELF_CONTACT = 1 << 6;
                /// Self-contact of folds.
                const FOLDS = 1 << 7;
                /// Freezing of particles that fail numerically.
                const FREEZE = 1 << 8;
                /// Stress points, which carry the stress.
                const STRESS_POINTS = 1 << 9;
                /// The corrected form of the sums.
                const CORRECTED = 1 << 10;
                /// Materials that may fail for good.
                const FAILURE = 1 << 11;
                /// Absorbing zones.
                const ABSORBERS = 1 << 12;
                /// Materials that yield.
                const YIELD = 1 << 13;
                /// The record of the largest pressure.
                const PEAK_PRESSURE = 1 << 14;
                /// The record of the largest tension.
                const PEAK_TENSION = 1 << 15;
                /// The record of the highest temperature.
                const PEAK_TEMPERATURE = 1 << 16;
                /// The record of the largest strain rate.
                const PEAK_STRAIN_RATE = 1 << 17;
                /// The record of when pressure arrived.
                const ARRIVAL = 1 << 18;
                /// Witness planes.
                const WITNESSES = 1 << 19;
                /// Gauges that particles carry.
                const CARRIERS = 1 << 20;
                /// Materials that soften before they fail.
                const SOFTENING = 1 << 21;
                /// Materials whose flaws grow to cracks.
                const FLAWS = 1 << 22;
                /// Bodies of the total form.
                const TOTAL = 1 << 23;
                /// Contact of gases, whose stiffness follows their pressure.
                const GAS_CONTACT = 1 << 24;
                /// Materials that soften where deformation localises.
                const LOCALISED = 1 << 25;
                /// The conventional form of the sums.
                const CONVENTIONAL = 1 << 26;
                /// Materials with pores.
                const POROUS = 1 << 27;
                /// Explosives.
                const EXPLOSIVE = 1 << 28;
                /// Pressures on faces.
                const PRESSURES = 1 << 29;
                /// Self-gravity.
                const SELF_GRAVITY = 1 << 30;
                /// Materials that bulk as they break.
                const BULKING = 1 << 31;
                /// Materials with directions of their own.
                const DIRECTIONS = 1 << 32;
                /// Materials that crack across their directions.
                const CRACKS = 1 << 33;
                /// Rigid bodies that forces move.
                const FREE_RIGID = 1 << 34;
                /// Joints between bodies.
                const JOINTS = 1 << 35;
                $(
                    #[doc = concat!("The pair term `", stringify!($key), "`.")]
                    const $term = 1 << (FIRST_TERM + Term::$key as usize);
                )+
                /// Records that a particle keeps because snapshots are to show them.
                const PEAKS = Self::PEAK_PRESSURE.bits() | Self::PEAK_TENSION.bits()
                    | Self::PEAK_TEMPERATURE.bits() | Self::PEAK_STRAIN_RATE.bits() | Self::ARRIVAL.bits();
            }
        }
    };
}
pair_terms!(owners);

impl Owner {
    /// The pair terms that are on.
    #[must_use]
    pub fn of_terms(terms: &TermOptions) -> Self {
        let terms = terms.acting();
        terms.fold(Self::empty(), |all, (number, _)| {
            all | Self::from_bits_retain(1 << (FIRST_TERM + number))
        })
    }
}
