//! Distribution over ranks, and the box of interest.

use toml::Spanned;

use super::check::out_of_range;
use super::region::KeepReader;
use super::{Diagnostic, axis};
use crate::input::schema::{DomainParams, LevelsParams};
use crate::model::{Axis, DomainOptions};

/// Lengths of `boxes` may count the case's own `spacing` (m).
pub fn domain(
    params: &DomainParams,
    boxes: &KeepReader,
    spacing: Option<f64>,
) -> Result<DomainOptions, Diagnostic> {
    let dimension = boxes.dimension;
    let keep = params.keep.as_ref();
    let keep = keep.map(|table| boxes.read(table, spacing));
    Ok(DomainOptions {
        levels: levels(params, dimension)?,
        axes: axes(params, dimension)?,
        balance_every: params.balance_every()?,
        keep: keep.transpose()?,
    })
}

/// The number of levels, unless it is to be chosen.
fn levels(params: &DomainParams, dimension: usize) -> Result<Option<usize>, Diagnostic> {
    let LevelsParams::Number(number) = params.levels() else {
        return Ok(None);
    };
    #[allow(
        clippy::float_cmp,
        clippy::cast_precision_loss,
        reason = "small whole numbers"
    )]
    let found = (1..=dimension).find(|&levels| levels as f64 == number);
    let allowed = format!("\"auto\" or a whole number from 1 to {dimension}");
    let at = params.levels.as_ref().map_or(0..0, Spanned::span);
    let refused = || out_of_range(at.clone(), "levels", &allowed);
    found.map(Some).ok_or_else(refused)
}

/// The axes that are named, by level.
fn axes(params: &DomainParams, dimension: usize) -> Result<[Option<Axis>; 3], Diagnostic> {
    let mut axes = [None; 3];
    let names: Vec<&Spanned<Axis>> = match (&params.axis, &params.axes) {
        (Some(name), Some(_)) => {
            let title = "`axis` and `axes` both say how slabs are cut";
            return Err(Diagnostic::new(name.span(), title).help("`axis` is the first of `axes`"));
        }
        (Some(name), None) => vec![name],
        (None, Some(names)) => names.get_ref().iter().collect(),
        (None, None) => Vec::new(),
    };
    for (level, name) in names.into_iter().enumerate() {
        let axis = axis(name, dimension)?;
        if axes.contains(&Some(axis)) {
            let title = format!("{} a second time", axis.name());
            return Err(Diagnostic::new(name.span(), title).help("each level has its own axis"));
        }
        axes[level] = Some(axis);
    }
    Ok(axes)
}
