//! `contact.potential`: table and parameters.

use serde::Deserialize;
use toml::Spanned;

use super::{DirectionName, Shared, direction};
use crate::input::source::Diagnostic;
use crate::input::validate::check::{Allowed, number};
use model::{Potential, PotentialRange};

/// Largest exponent of the contact potential: beyond it a power of the kernel ratio says no more
/// than that particles are closer than the mean spacing or not.
const LARGEST_EXPONENT: u32 = 100;

optional_tables! {
    /// `contact.potential`
    PotentialParams {
        /// Stiffness k; `1`, or that of all pairs, if absent.
        stiffness: Option<Spanned<f64>>,
        /// Exponent n; `4`, or that of all pairs, if absent.
        exponent: Option<Spanned<i64>>,
        /// Range of the force; `"support"`, or that of all pairs, if absent.
        range: Option<Spanned<RangeName>>,
        /// Along what it acts; `"pair"`, or that of all pairs, if absent.
        direction: Option<Spanned<DirectionName>>,
    }
}

choices! {
    /// Range of the contact potential.
    RangeName {
        /// 2h.
        Support,
        /// Mean spacing.
        Spacing,
    }
}

impl PotentialParams {
    /// The parameters, with those of `base` where the table has none.
    pub(super) fn law(&self, base: Potential, shared: &Shared) -> Result<Potential, Diagnostic> {
        let stiffness = self.stiffness.as_ref();
        let potential = Potential {
            stiffness: number(stiffness, "stiffness", base.stiffness, Allowed::Positive)?,
            exponent: exponent(self.exponent.as_ref(), base.exponent)?,
            range: match self.range.as_ref().map(Spanned::get_ref) {
                Some(RangeName::Support) => PotentialRange::Support,
                Some(RangeName::Spacing) => PotentialRange::Spacing,
                None => base.range,
            },
            direction: direction(self.direction.as_ref(), base.direction, shared)?,
        };
        check_range(self, &potential)?;
        Ok(potential)
    }
}

/// The exponent of the contact potential.
fn exponent(value: Option<&Spanned<i64>>, base: u32) -> Result<u32, Diagnostic> {
    let Some(value) = value else {
        return Ok(base);
    };
    let exponent = u32::try_from(*value.get_ref()).ok();
    let allowed = exponent.filter(|n| (1..=LARGEST_EXPONENT).contains(n));
    allowed.ok_or_else(|| {
        let title = format!("`exponent` must be between 1 and {LARGEST_EXPONENT}");
        Diagnostic::new(value.span(), title).label("out of range")
    })
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
