//! Contact as it is typed: the keys that all modes share, and one file for each mode with the table
//! of its keys, and what they make.

mod joint;
mod overlap;
mod penalty;
mod potential;

use serde::Deserialize;
use toml::Spanned;

use super::{FrictionParams, SelfContactParams};
use crate::input::source::Diagnostic;
use joint::JointParams;
use model::{ContactDirection, ContactMode, Resistance, SphForm, contact_modes};
use overlap::OverlapParams;
use penalty::PenaltyParams;
use potential::PotentialParams;

optional_tables! {
    /// `[contact]`
    ContactParams {
        /// Mode of all pairs that have no own.
        mode: Option<ModeName> = ModeName::Overlap;
        /// Coefficients of friction.
        friction: Option<Spanned<FrictionParams>> = 0.0, NotNegative;
        /// Share of critical damping.
        damping: Option<Spanned<f64>> = 0.0, Within(0.0, 1.0);
        /// Contact of a body with itself.
        self_contact: Option<Spanned<SelfContactParams>> => "where matter may fail";
        /// Parameters of the mode `overlap`.
        overlap: OverlapParams;
        /// Parameters of the mode `potential`.
        potential: PotentialParams;
        /// Parameters of the mode `penalty`.
        penalty: PenaltyParams;
        /// Pairs with a mode or parameters of their own.
        pair: Vec<PairParams>;
    }
}

tables! {
    /// `[[contact.pair]]`
    PairParams {
        /// Names of two bodies.
        bodies: Spanned<Vec<Spanned<String>>>;
        /// What happens where they meet.
        mode: Option<ModeName> => "as for all others";
        /// Coefficients of friction.
        friction: Option<Spanned<FrictionParams>>, NotNegative => "the case's";
        /// Share of critical damping.
        damping: Option<Spanned<f64>>, Within(0.0, 1.0) => "the case's";
        /// What holds them together, as an adhesive does.
        joint: Option<Spanned<JointParams>> => "they are separate";
        /// Parameters of the mode `overlap`.
        #[serde(default)]
        overlap: OverlapParams;
        /// Parameters of the mode `potential`.
        #[serde(default)]
        potential: PotentialParams;
        /// Parameters of the mode `penalty`.
        #[serde(default)]
        penalty: PenaltyParams;
    }
}

choices! {
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
}

/// A choice of mode with the parameters of all modes, of which a pair takes what it does not give.
#[derive(Clone, Copy)]
pub struct Choice {
    mode: ModeName,
    resistance: Resistance,
    pub laws: Laws,
}

impl Default for Choice {
    fn default() -> Self {
        Self {
            mode: ContactParams::default().mode(),
            resistance: Resistance::default(),
            laws: Laws::default(),
        }
    }
}

impl Choice {
    /// Chosen mode.
    pub fn mode(&self) -> ContactMode {
        self.of(None)
    }
}

/// Parameters of others that the table of a mode needs.
struct Shared {
    resistance: Resistance,
    form: SphForm,
}

macro_rules! choice {
    ($($name:ident: $Mode:ident,)+) => {
        /// Parameters of all modes.
        #[derive(Clone, Copy, Default)]
        pub struct Laws {
            $(pub $name: model::$Mode,)+
        }

        impl Choice {
            /// The given mode, else what is chosen.
            pub fn of(&self, mode: Option<ModeName>) -> ContactMode {
                match mode.unwrap_or(self.mode) {
                    ModeName::None => ContactMode::None,
                    ModeName::Kernel => ContactMode::Kernel,
                    $(ModeName::$Mode => ContactMode::$Mode(self.laws.$name),)+
                }
            }
        }

        read!(ContactParams: $($name)+);
        read!(PairParams: $($name)+);
    };
}

macro_rules! read {
    ($Table:ident: $($name:ident)+) => {
        impl $Table {
            /// Choice of this table; the rest is that of `base`.
            pub fn choice(&self, base: &Choice, form: SphForm) -> Result<Choice, Diagnostic> {
                let shared = Shared {
                    resistance: resistance(self.friction()?, self.damping()?, base.resistance),
                    form,
                };
                Ok(Choice {
                    mode: self.mode.unwrap_or(base.mode),
                    resistance: shared.resistance,
                    laws: Laws {
                        $($name: self.$name.parameters(base.laws.$name, &shared)?,)+
                    },
                })
            }
        }
    };
}
contact_modes!(choice);

/// Friction, of faces that stick and of those that slide, and damping; what is not given is that of `base`.
pub fn resistance(
    friction: impl Into<Option<[f64; 2]>>,
    damping: impl Into<Option<f64>>,
    base: Resistance,
) -> Resistance {
    let known = [base.static_friction, base.kinetic_friction];
    let [static_friction, kinetic_friction] = friction.into().unwrap_or(known);
    Resistance {
        static_friction,
        kinetic_friction,
        damping: damping.into().unwrap_or(base.damping),
    }
}

/// Normals are those of corrected gradients.
fn direction(
    name: Option<&Spanned<ContactDirection>>,
    base: ContactDirection,
    shared: &Shared,
) -> Result<ContactDirection, Diagnostic> {
    let Some(name) = name else {
        return Ok(base);
    };
    let direction = *name.get_ref();
    if direction == ContactDirection::Normal && shared.form != SphForm::Normalised {
        let title = "contact along normals needs the corrected gradients of normalised SPH";
        let help = "set `form = \"normalised\"` in [sph], or take \"pair\"";
        return Err(Diagnostic::new(name.span(), title).help(help));
    }
    Ok(direction)
}
