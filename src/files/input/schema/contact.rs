//! Contact as it is typed: the keys that all modes share, and one file for each mode with the table
//! of its keys, and what they make.

mod overlap;
mod penalty;
mod potential;

use serde::Deserialize;
use toml::Spanned;

use super::{FrictionParams, SelfContactParams};
use crate::input::source::Diagnostic;
use crate::input::validate::check::{Allowed, number};
use model::{ContactDirection, ContactMode, Resistance, SphForm, contact_modes};
use overlap::OverlapParams;
use penalty::PenaltyParams;
use potential::PotentialParams;

optional_tables! {
    /// `[contact]`
    ContactParams {
        /// Mode of all pairs that have no own; `"overlap"` if absent.
        mode: Option<ModeName>,
        /// Coefficients of friction; `0` if absent.
        friction: Option<Spanned<FrictionParams>>,
        /// Share of critical damping; `0` if absent.
        damping: Option<Spanned<f64>>,
        /// Contact of a body with itself; where matter may fail if absent.
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
}

tables! {
    /// `[[contact.pair]]`
    PairParams {
        /// Names of two bodies.
        bodies: Spanned<Vec<Spanned<String>>>,
        /// What happens where they meet; as for all others if absent.
        mode: Option<ModeName>,
        /// Coefficients of friction; the case's if absent.
        friction: Option<Spanned<FrictionParams>>,
        /// Share of critical damping; the case's if absent.
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
    /// Along what contact forces act.
    DirectionName {
        /// The line between particles.
        Pair,
        /// The normal of the surfaces.
        Normal,
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
            mode: ModeName::Overlap,
            resistance: Resistance::default(),
            laws: Laws::default(),
        }
    }
}

impl Choice {
    /// What is chosen.
    pub fn mode(&self) -> ContactMode {
        self.of(None)
    }
}

/// What the table of a mode must know of others.
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
            /// What this table chooses; the rest is that of `base`.
            pub fn choice(&self, base: &Choice, form: SphForm) -> Result<Choice, Diagnostic> {
                let (friction, damping) = (self.friction.as_ref(), self.damping.as_ref());
                let shared = Shared {
                    resistance: resistance(friction, damping, base.resistance)?,
                    form,
                };
                Ok(Choice {
                    mode: self.mode.unwrap_or(base.mode),
                    resistance: shared.resistance,
                    laws: Laws {
                        $($name: self.$name.law(base.laws.$name, &shared)?,)+
                    },
                })
            }
        }
    };
}
contact_modes!(choice);

/// Friction and damping; what is not given is that of `base`.
pub fn resistance(
    friction: Option<&Spanned<FrictionParams>>,
    damping: Option<&Spanned<f64>>,
    base: Resistance,
) -> Result<Resistance, Diagnostic> {
    let of = |value: &Spanned<f64>, key: &str| {
        number(Some(value), key, 0.0, Allowed::NotNegative).map(Some)
    };
    let [sticking, sliding] = match friction.map(|f| (f.get_ref(), f.span())) {
        None => [None, None],
        Some((&FrictionParams::One(value), at)) => [of(&Spanned::new(at, value), "friction")?; 2],
        Some((FrictionParams::Two(table), _)) => {
            let [sticking, sliding] = [
                of(&table.r#static, "static")?,
                of(&table.kinetic, "kinetic")?,
            ];
            if sliding > sticking {
                let title = "`kinetic` must be at most `static`";
                return Err(Diagnostic::new(table.kinetic.span(), title).label("out of range"));
            }
            [sticking, sliding]
        }
    };
    Ok(Resistance {
        static_friction: sticking.unwrap_or(base.static_friction),
        kinetic_friction: sliding.unwrap_or(base.kinetic_friction),
        damping: number(damping, "damping", base.damping, Allowed::Within(0.0, 1.0))?,
    })
}

/// Normals are those of corrected gradients.
fn direction(
    name: Option<&Spanned<DirectionName>>,
    base: ContactDirection,
    shared: &Shared,
) -> Result<ContactDirection, Diagnostic> {
    let Some(name) = name else {
        return Ok(base);
    };
    match (name.get_ref(), shared.form) {
        (DirectionName::Pair, _) => Ok(ContactDirection::Pair),
        (DirectionName::Normal, SphForm::Normalised) => Ok(ContactDirection::Normal),
        (DirectionName::Normal, _) => {
            let title = "contact along normals needs the corrected gradients of normalised SPH";
            let help = "set `form = \"normalised\"` in [sph], or take \"pair\"";
            Err(Diagnostic::new(name.span(), title).help(help))
        }
    }
}
