//! `contact.penalty`: table and parameters.

use serde::Deserialize;
use toml::Spanned;

use super::Shared;
use crate::input::source::Diagnostic;
use crate::input::validate::check::{Allowed, number};
use model::{Penalty, PenaltyLaw};

optional_tables! {
    /// `contact.penalty`
    PenaltyParams {
        /// Stiffness κ; `2`, or that of all pairs, if absent.
        stiffness: Option<Spanned<f64>>,
        /// Law of the force; `"hertz"`, or that of all pairs, if absent.
        law: Option<PenaltyLawName>,
    }
}

choices! {
    /// Law of the penalty force.
    PenaltyLawName {
        /// Depth to the power 3/2.
        Hertz,
        /// No more than what stops the approach in one step.
        Pinball,
    }
}

impl PenaltyParams {
    /// The parameters, with those of `base` where the table has none.
    pub(super) fn law(&self, base: Penalty, shared: &Shared) -> Result<Penalty, Diagnostic> {
        let stiffness = self.stiffness.as_ref();
        Ok(Penalty {
            stiffness: number(stiffness, "stiffness", base.stiffness, Allowed::Positive)?,
            law: match self.law {
                Some(PenaltyLawName::Hertz) => PenaltyLaw::Hertz,
                Some(PenaltyLawName::Pinball) => PenaltyLaw::Pinball,
                None => base.law,
            },
            resistance: shared.resistance,
        })
    }
}
