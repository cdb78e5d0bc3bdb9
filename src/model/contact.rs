//! Contact between pairs of bodies, as chosen by the user.
//!
//! Modes with forces are registered in [`contact_modes`]. Each has its parameters in a file here,
//! the table of its keys in one of `input/schema/contact/`, and its forces in one of `contact/`.

use serde::Deserialize;

mod joint;
mod overlap;
mod penalty;
mod potential;

pub use joint::Joint;
pub use overlap::Overlap;
pub use penalty::{Penalty, PenaltyLaw};
pub use potential::{Potential, PotentialRange};

/// Passes the modes that have forces to the macro `$then`: name in the input, and parameters.
/// Forces are added in this order.
#[macro_export]
macro_rules! contact_modes {
    ($then:ident) => {
        $then! {
            overlap: Overlap,
            potential: Potential,
            penalty: Penalty,
        }
    };
}

/// The contact of one pair of bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPair {
    /// Two indices into [`super::Case::bodies`].
    pub bodies: [usize; 2],
    /// The contact where they meet.
    pub mode: ContactMode,
    /// What holds them together, if anything does.
    pub joint: Option<Joint>,
}

/// The properties of every mode with forces.
pub trait ContactLaw {
    /// Stiffness of the forces, relative to that of the materials.
    fn stiffness(&self) -> f64;

    /// Friction and damping, if the mode has any.
    fn resistance(&self) -> Option<&Resistance> {
        None
    }

    /// `true` if it needs sums over the particles of a body, which rigid bodies and stress points
    /// do without.
    fn needs_sums(&self) -> bool {
        false
    }
}

macro_rules! declare {
    ($($name:ident: $Mode:ident,)+) => {
        /// The contact of two bodies.
        #[derive(Debug, Clone, PartialEq)]
        pub enum ContactMode {
            /// The bodies do not see each other.
            None,
            /// Particles of the other body enter the SPH sums: both act as one continuum.
            Kernel,
            $(
                #[doc = concat!("See [`struct@", stringify!($Mode), "`].")]
                $Mode($Mode),
            )+
        }

        /// Number of a mode that has forces.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum ContactClass {
            $(
                #[doc = concat!("Of [`struct@", stringify!($Mode), "`].")]
                $Mode,
            )+
        }

        impl ContactClass {
            /// All modes with forces.
            pub const ALL: &[Self] = &[$(Self::$Mode),+];
            /// The number of modes.
            pub const COUNT: usize = Self::ALL.len();
        }

        impl ContactMode {
            /// The modes with forces, with default parameters.
            #[must_use]
            pub fn with_forces() -> [Self; ContactClass::COUNT] {
                [$(Self::$Mode($Mode::default())),+]
            }

            /// The name used in inputs.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    Self::None => "none",
                    Self::Kernel => "kernel",
                    $(Self::$Mode(_) => stringify!($name),)+
                }
            }

            /// Its number, if it has forces.
            #[must_use]
            pub fn class(&self) -> Option<ContactClass> {
                match self {
                    Self::None | Self::Kernel => None,
                    $(Self::$Mode(_) => Some(ContactClass::$Mode),)+
                }
            }

            /// Its properties, if it has forces.
            #[must_use]
            pub fn law(&self) -> Option<&dyn ContactLaw> {
                match self {
                    Self::None | Self::Kernel => None,
                    $(Self::$Mode(law) => Some(law),)+
                }
            }
        }
    };
}
contact_modes!(declare);

impl ContactMode {
    /// Friction and damping, if the mode has any.
    #[must_use]
    pub fn resistance(&self) -> Option<&Resistance> {
        self.law()?.resistance()
    }

    /// `true` if it needs sums over the particles of a body, which rigid bodies and stress points
    /// do without.
    #[must_use]
    pub fn needs_sums(&self) -> bool {
        let of_law = |law: &dyn ContactLaw| law.needs_sums();
        self.law().map_or(*self == Self::Kernel, of_law)
    }
}

/// Along what contact forces act.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactDirection {
    /// The line between two particles, as the gradient of an energy.
    Pair,
    /// The mean normal of both surfaces, in the normalised form of the SPH sums.
    Normal,
}

/// Contact of a body with itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfContact {
    /// Its law.
    pub overlap: Overlap,
    /// Particles of one part are strangers if they began farther from each other than this
    /// (spacings).
    pub folds: Option<f64>,
}

impl SelfContact {
    /// The contact of two fragments of a body.
    #[must_use]
    pub fn mode(&self) -> ContactMode {
        ContactMode::Overlap(self.overlap)
    }
}

/// The resistance of bodies in contact against their relative motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Resistance {
    /// Coefficient of friction of faces that stick.
    pub static_friction: f64,
    /// Coefficient of friction of faces that slide; at most that of faces that stick.
    pub kinetic_friction: f64,
    /// Share of critical damping, 0 to 1.
    pub damping: f64,
}

impl Resistance {
    /// `true` if there is any.
    #[must_use]
    pub fn is_any(&self) -> bool {
        self.static_friction > 0.0 || self.damping > 0.0
    }
}
