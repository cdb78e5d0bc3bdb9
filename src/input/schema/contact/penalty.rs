//! `contact.penalty`: table and parameters.

use serde::Deserialize;
use toml::Spanned;

use super::Shared;
use crate::input::source::Diagnostic;
use crate::model::{Penalty, PenaltyLaw};

optional_tables! {
    /// `contact.penalty`
    PenaltyParams {
        /// Stiffness κ.
        stiffness: Option<Spanned<f64>> = Penalty::default().stiffness, Positive => or "that of all pairs";
        /// Law of the force.
        law: Option<PenaltyLaw> = Penalty::default().law => or "that of all pairs";
    }
}

impl PenaltyParams {
    /// The parameters, with those of `base` where the table has none.
    pub(super) fn parameters(&self, base: Penalty, shared: &Shared) -> Result<Penalty, Diagnostic> {
        Ok(Penalty {
            stiffness: self.stiffness(base.stiffness)?,
            law: self.law(base.law)?,
            resistance: shared.resistance,
        })
    }
}
