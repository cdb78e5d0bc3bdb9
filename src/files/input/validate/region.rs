//! Regions between sides, and boxes: that of interest (`[domain] keep`) and those of snapshots.

use std::ops::Range;

use toml::Spanned;

use super::in_dimension;
use crate::input::quantity::Extent;
use crate::input::schema::{KeepParams, SidesParams};
use crate::input::source::Diagnostic;
use model::readable::Readable;
use model::{Axis, Body, Region, SymmetryPlane};
use populate;

/// A side of a region.
type Side<'a> = &'a Spanned<Extent>;

/// The sides that a table names, by axis.
fn sides(table: Option<&Spanned<SidesParams>>) -> impl Iterator<Item = (Axis, Side<'_>)> {
    table.into_iter().flat_map(|table| {
        let params = table.get_ref();
        let all = Axis::ALL.into_iter().zip([&params.x, &params.y, &params.z]);
        all.filter_map(|(axis, side)| Some((axis, side.as_ref()?)))
    })
}

/// The region between the sides `above` and `below`, which may count spacings (m).
pub fn region(
    tables: [Option<&Spanned<SidesParams>>; 2],
    dimension: usize,
    spacing: f64,
) -> Result<Region, Diagnostic> {
    let mut region = Region::OPEN;
    let [above, below] = tables;
    for (table, ends) in [(above, &mut region.above), (below, &mut region.below)] {
        for (axis, side) in sides(table) {
            in_dimension(axis, dimension, side.span())?;
            ends[axis.index()] = side.get_ref().metres(spacing);
        }
    }
    Ok(region)
}

/// Inputs of the reading of boxes.
pub struct KeepReader<'a> {
    pub dimension: usize,
    /// Bodies, where they begin.
    pub bodies: &'a [Body],
    pub symmetry: &'a [SymmetryPlane],
    /// The unit of length in messages.
    pub length_unit: &'a Readable,
}

impl<'a> KeepReader<'a> {
    pub fn new(
        dimension: usize,
        bodies: &'a [Body],
        symmetry: &'a [SymmetryPlane],
        length_unit: &'a Readable,
    ) -> Self {
        Self {
            dimension,
            bodies,
            symmetry,
            length_unit,
        }
    }

    /// The box of interest, in which all bodies begin that can leave it. Lengths may count a case's own
    /// spacing (m), if it has one.
    pub fn read(
        &self,
        table: &Spanned<KeepParams>,
        spacing: Option<f64>,
    ) -> Result<Region, Diagnostic> {
        let params = table.get_ref();
        let tables = [params.above.as_ref(), params.below.as_ref()];
        let keep = self.read_box(table, "keep", spacing)?;
        let deforming = self.bodies.iter().filter(|body| body.rigid.is_none());
        for body in deforming {
            self.check_start(body, &keep, tables)?;
        }
        Ok(keep)
    }

    /// A box that a key names, of which some side is closed and which has some place.
    pub fn read_box(
        &self,
        table: &Spanned<KeepParams>,
        key: &str,
        spacing: Option<f64>,
    ) -> Result<Region, Diagnostic> {
        let params = table.get_ref();
        let tables = [params.above.as_ref(), params.below.as_ref()];
        let all = || tables.into_iter().flat_map(sides);
        if all().next().is_none() {
            return Err(
                Diagnostic::new(table.span(), format!("`{key}` has no side")).help(format!(
                    "name what is of interest, as in `{key}.below = {{ z = \"5 mm\" }}`"
                )),
            );
        }
        let counted = all().find(|(_, side)| matches!(side.get_ref(), Extent::Spacings(_)));
        if let (Some((_, side)), None) = (counted, spacing) {
            let title =
                format!("a case without a `spacing` of its own has none that `{key}` could count");
            return Err(Diagnostic::new(side.span(), title).help("give a length"));
        }
        let found = region(tables, self.dimension, spacing.unwrap_or_default())?;
        let [_, below] = tables;
        for (axis, side) in sides(below) {
            let [low, high] = [found.above, found.below].map(|ends| ends[axis.index()]);
            if low >= high {
                let [low, high] = [low, high].map(|x| self.length_unit.text(x));
                let title = format!(
                    "nothing is above {low} and below {high} along {}",
                    axis.name()
                );
                return Err(Diagnostic::new(side.span(), title));
            }
        }
        Ok(found)
    }

    /// Refuses a body that begins beyond a side.
    fn check_start(
        &self,
        body: &Body,
        keep: &Region,
        [above, below]: [Option<&Spanned<SidesParams>>; 2],
    ) -> Result<(), Diagnostic> {
        let bounds = populate::bounds_above(body, self.dimension, self.symmetry);
        let Some((lower, upper)) = bounds else {
            return Ok(());
        };
        let below_it =
            sides(above).find(|(axis, _)| lower[axis.index()] < keep.above[axis.index()]);
        let above_it =
            sides(below).find(|(axis, _)| upper[axis.index()] > keep.below[axis.index()]);
        let Some((_, side)) = below_it.or(above_it) else {
            return Ok(());
        };
        let at: Range<usize> = side.span();
        let partly = if keep.meets(&lower, &upper) {
            "partly "
        } else {
            ""
        };
        let corner = |x: [f64; 3]| self.length_unit.vector(&x[..self.dimension]);
        let title = format!("`{}` begins {partly}beyond this side of `keep`", body.name);
        Err(Diagnostic::new(at, title).help(format!(
            "its particles stand from {} to {}, and what is beyond is taken out",
            corner(lower),
            corner(upper)
        )))
    }
}
