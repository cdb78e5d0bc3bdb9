//! Spacings that grow with the distance from a place.

use toml::Spanned;

use super::shapes::{Shapes, axis_vector};
use super::surfaces::unit_vector;
use crate::input::quantity::{Length, expected};
use crate::input::schema::{SpacingParams, SpacingTable};
use crate::input::source::Diagnostic;
use model::{Focus, Grading, LatticeKind, Shape, Vec3};

/// The finest spacing (m) of a body.
pub fn finest(params: &Spanned<SpacingParams>) -> Result<f64, Diagnostic> {
    let title = match params.get_ref() {
        SpacingParams::Graded(table) => {
            return table.inner();
        }
        SpacingParams::Even(length) if length.si > 0.0 => return Ok(length.si),
        SpacingParams::Plain(plain) if *plain != 0.0 => {
            let expected = expected::<Length>("");
            format!("expected {expected}, found the plain number {plain}")
        }
        SpacingParams::Even(_) | SpacingParams::Plain(_) => "`spacing` must be positive".to_owned(),
    };
    Err(Diagnostic::new(params.span(), title))
}

/// The table of a spacing that grows.
pub fn graded(params: Option<&Spanned<SpacingParams>>) -> Option<&SpacingTable> {
    match params?.get_ref() {
        SpacingParams::Graded(table) => Some(table),
        SpacingParams::Even(_) | SpacingParams::Plain(_) => None,
    }
}

/// Growth of the spacing of a body of some shape; nothing if it does not grow within it.
pub fn grading(
    shapes: &Shapes,
    table: &SpacingTable,
    shape: &Shape,
    kind: LatticeKind,
) -> Result<Option<Grading>, Diagnostic> {
    if kind != LatticeKind::Glass {
        let title = "only glass can have a spacing that grows: take `lattice = \"glass\"`";
        return Err(Diagnostic::new(table.inner.span(), title));
    }
    let outer = table.outer()?;
    if outer < shapes.spacing {
        let title = "the `outer` spacing must be no finer than the `inner` one";
        return Err(Diagnostic::new(table.outer.span(), title));
    }
    let most = 1.0 + Grading::MOST_GROWTH;
    let ratio = table.ratio();
    if !(ratio > 1.0 && ratio <= most) {
        let at = table.ratio.as_ref().map_or(0..0, Spanned::span);
        let title = format!("`ratio` must be above 1 and no more than {most}");
        return Err(Diagnostic::new(at, title)
            .help("it is how many times as thick a layer is as the one before it"));
    }
    let even = match &table.within {
        None => 0.0,
        Some(within) => within.get_ref().metres(shapes.spacing),
    };
    if let (Some(within), true) = (&table.within, even < 0.0) {
        return Err(Diagnostic::new(
            within.span(),
            "`within` must not be negative",
        ));
    }
    let mut grading = Grading {
        from: focus(shapes, table, shape)?,
        even,
        growth: ratio - 1.0,
        coarsest: outer,
    };
    // What is coarser than all of the body would make searches longer.
    grading.coarsest = grading.spacing(shapes.spacing, farthest(&grading.from, shapes, shape));
    Ok((grading.coarsest > shapes.spacing).then_some(grading))
}

/// Place at which the body is finest.
fn focus(shapes: &Shapes, table: &SpacingTable, shape: &Shape) -> Result<Focus, Diagnostic> {
    let place = "a spacing that grows counts from `at`, a point, or from a `face`";
    match (&table.at, &table.face) {
        (Some(at), None) => {
            let point = shapes.point(Some(at), "at")?;
            match &table.axis {
                None => Ok(Focus::Point(point)),
                Some(axis) if shapes.dimension < 3 => {
                    let title = "in two dimensions a spacing grows from a point or a face";
                    Err(Diagnostic::new(axis.span(), title))
                }
                Some(_) => Ok(Focus::Line(point, axis_vector(table.axis.as_ref())?)),
            }
        }
        (None, Some(face)) => {
            if let Some(axis) = &table.axis {
                let title = "the `axis` of a line goes with a point `at` it, not with a `face`";
                return Err(Diagnostic::new(axis.span(), title));
            }
            let normal = Vec3::from(unit_vector("face", face, shapes.dimension)?);
            let position = -shape.lowest(&-normal);
            Ok(Focus::Plane(normal * position, normal))
        }
        (Some(_), Some(face)) => Err(Diagnostic::new(face.span(), format!("{place}, not both"))),
        (None, None) => Err(Diagnostic::new(table.inner.span(), place)),
    }
}

/// The largest distance (m) of the box around a shape.
fn farthest(from: &Focus, shapes: &Shapes, shape: &Shape) -> f64 {
    let (lower, upper) = shape.solid(shapes.dimension).bounds();
    let corners = (0..8_u8).map(|corner| {
        Vec3::from_fn(|a, _| {
            let end = if corner >> a & 1 == 1 { upper } else { lower };
            if a < shapes.dimension { end[a] } else { 0.0 }
        })
    });
    corners.fold(0.0, |most, x| f64::max(most, from.distance(&x)))
}
