//! `contact.potential`: table and parameters.

use serde::Deserialize;
use toml::Spanned;

use super::{Shared, direction};
use crate::input::source::Diagnostic;
use crate::model::{ContactDirection, Potential, PotentialRange};

/// Largest exponent of the contact potential: beyond it a power of the kernel ratio says no more
/// than that particles are closer than the mean spacing or not.
const LARGEST_EXPONENT: f64 = 100.0;

optional_tables! {
    /// `contact.potential`
    PotentialParams {
        /// Stiffness k.
        stiffness: Option<Spanned<f64>> = Potential::default().stiffness, Positive => or "that of all pairs";
        /// Exponent n.
        exponent: Option<Spanned<i64>> = Potential::default().exponent.into(), Within(1.0, LARGEST_EXPONENT) => or "that of all pairs";
        /// Range of the force.
        range: Option<Spanned<PotentialRange>> = Potential::default().range => or "that of all pairs";
        /// Along what it acts.
        direction: Option<Spanned<ContactDirection>> = Potential::default().direction => or "that of all pairs";
    }
}

impl PotentialParams {
    /// The parameters, with those of `base` where the table has none.
    pub(super) fn parameters(
        &self,
        base: Potential,
        shared: &Shared,
    ) -> Result<Potential, Diagnostic> {
        let exponent = self.exponent(u64::from(base.exponent))?;
        let potential = Potential {
            stiffness: self.stiffness(base.stiffness)?,
            exponent: u32::try_from(exponent).unwrap_or(base.exponent),
            range: self.range(base.range)?,
            direction: direction(self.direction.as_ref(), base.direction, shared)?,
        };
        check_range(self, &potential)?;
        Ok(potential)
    }
}

/// The force that sets in at the spacing is that of the exponent less that of an exponent of one.
fn check_range(params: &PotentialParams, potential: &Potential) -> Result<(), Diagnostic> {
    if potential.range == PotentialRange::Support || potential.exponent > 1 {
        return Ok(());
    }
    let spans = [
        params.exponent.as_ref().map(Spanned::span),
        params.range.as_ref().map(Spanned::span),
    ];
    // One of the two is new: the combination was refused where it was inherited from.
    let at = spans.into_iter().flatten().next().unwrap_or_default();
    let title = "a potential of `range = \"spacing\"` needs an `exponent` of 2 or more";
    let help = "with 1 its force would begin with a jump: take \"support\", or a larger exponent";
    Err(Diagnostic::new(at, title).help(help))
}
