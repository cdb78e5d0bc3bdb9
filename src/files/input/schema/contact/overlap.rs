//! `contact.overlap`: table and parameters.

use serde::Deserialize;
use toml::Spanned;

use super::{DirectionName, Shared, direction};
use crate::input::source::Diagnostic;
use crate::input::validate::check::{Allowed, number};
use model::Overlap;

optional_tables! {
    /// `contact.overlap`
    OverlapParams {
        /// Stiffness κ; `4`, or that of all pairs, if absent.
        stiffness: Option<Spanned<f64>>,
        /// Stiffness `κ_c` of the core; `2.2`, or that of all pairs, if absent.
        core_stiffness: Option<Spanned<f64>>,
        /// Radius of the core in mean spacings; `0.6`, or that of all pairs, if absent.
        core_radius: Option<Spanned<f64>>,
        /// Along what it acts; `"pair"`, or that of all pairs, if absent.
        direction: Option<Spanned<DirectionName>>,
    }
}

impl OverlapParams {
    /// The parameters, with those of `base` where the table has none.
    pub(super) fn law(&self, base: Overlap, shared: &Shared) -> Result<Overlap, Diagnostic> {
        let (stiffness, core) = (self.stiffness.as_ref(), self.core_stiffness.as_ref());
        let (radius, one) = (self.core_radius.as_ref(), Allowed::Within(0.0, 1.0));
        Ok(Overlap {
            stiffness: number(stiffness, "stiffness", base.stiffness, Allowed::Positive)?,
            core_stiffness: number(
                core,
                "core_stiffness",
                base.core_stiffness,
                Allowed::NotNegative,
            )?,
            core_radius: number(radius, "core_radius", base.core_radius, one)?,
            direction: direction(self.direction.as_ref(), base.direction, shared)?,
            resistance: shared.resistance,
        })
    }
}
