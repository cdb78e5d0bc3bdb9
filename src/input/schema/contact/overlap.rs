//! `contact.overlap`: table and parameters.

use serde::Deserialize;
use toml::Spanned;

use super::{Shared, direction};
use crate::input::source::Diagnostic;
use crate::model::{ContactDirection, Overlap};

optional_tables! {
    /// `contact.overlap`
    OverlapParams {
        /// Stiffness κ.
        stiffness: Option<Spanned<f64>> = Overlap::default().stiffness, Positive => or "that of all pairs";
        /// Stiffness `κ_c` of the core.
        core_stiffness: Option<Spanned<f64>> = Overlap::default().core_stiffness, NotNegative => or "that of all pairs";
        /// Radius of the core in mean spacings.
        core_radius: Option<Spanned<f64>> = Overlap::default().core_radius, Within(0.0, 1.0) => or "that of all pairs";
        /// Along what it acts.
        direction: Option<Spanned<ContactDirection>> = Overlap::default().direction => or "that of all pairs";
    }
}

impl OverlapParams {
    /// The parameters, with those of `base` where the table has none.
    pub(super) fn parameters(&self, base: Overlap, shared: &Shared) -> Result<Overlap, Diagnostic> {
        Ok(Overlap {
            stiffness: self.stiffness(base.stiffness)?,
            core_stiffness: self.core_stiffness(base.core_stiffness)?,
            core_radius: self.core_radius(base.core_radius)?,
            direction: direction(self.direction.as_ref(), base.direction, shared)?,
            resistance: shared.resistance,
        })
    }
}
