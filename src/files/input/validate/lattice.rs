//! Filling of a body.

use toml::Spanned;

use super::shapes::{Shapes, axis_vector};
use crate::input::schema::LatticeParams;
use crate::input::source::Diagnostic;
use model::{Axis, Lattice, LatticeKind, Shape, SphForm};

/// Filling of bodies that do not state one: glass, which prefers no direction. In the plane, where
/// the kernel sums of glass scatter five times as much, and where stress points need rows, a cubic
/// lattice. Rings extend in three dimensions.
pub fn default_kind(extent: usize, form: SphForm) -> LatticeKind {
    if extent == 3 && form != SphForm::StressPoints {
        LatticeKind::Glass
    } else {
        LatticeKind::Cubic
    }
}

/// The lattice of a body of some shape; of the default kind if absent.
pub fn lattice(
    shapes: &Shapes,
    params: Option<&Spanned<LatticeParams>>,
    shape: &Shape,
    default: LatticeKind,
) -> Result<Lattice, Diagnostic> {
    let spacing = shapes.spacing;
    let Some(table) = params else {
        return Ok(Lattice {
            kind: default,
            spacing,
            ..Lattice::default()
        });
    };
    let params = table.get_ref();
    let angle = params
        .angle
        .as_ref()
        .map_or(0.0, |angle| angle.get_ref().si);
    let is_turned = angle != 0.0 || params.axis.is_some();
    if let Some(title) = misfit(params.kind, is_turned, shapes.dimension, shape) {
        return Err(Diagnostic::new(table.span(), title));
    }
    let seed = match &params.seed {
        None => 0,
        Some(seed) if params.kind != LatticeKind::Glass => {
            return Err(Diagnostic::new(seed.span(), "only glass has a `seed`"));
        }
        Some(seed) => u64::try_from(*seed.get_ref())
            .map_err(|_| Diagnostic::new(seed.span(), "`seed` must not be negative"))?,
    };
    let axis = match &params.axis {
        None => None,
        Some(axis) if shapes.dimension < 3 => {
            let title = "in two dimensions a lattice turns about z alone";
            return Err(Diagnostic::new(axis.span(), title));
        }
        Some(_) => Some(axis_vector(params.axis.as_ref())?),
    };
    Ok(Lattice {
        kind: params.kind,
        spacing,
        grading: None,
        sizes: None,
        angle,
        axis: axis.filter(|axis| axis.z != 1.0),
        fit: fits(params, is_turned, shape)?,
        seed,
        volume: None,
    })
}

/// True if a lattice is stretched to fill its shape.
fn fits(params: &LatticeParams, is_turned: bool, shape: &Shape) -> Result<bool, Diagnostic> {
    let Some(fit) = params.fit.as_ref().filter(|fit| *fit.get_ref()) else {
        return Ok(false);
    };
    let is_cubic = params.kind == LatticeKind::Cubic && !is_turned;
    if is_cubic && matches!(shape, Shape::Box { .. }) {
        return Ok(true);
    }
    let title = "`fit` stretches a cubic lattice that is not turned, and in a box alone";
    Err(Diagnostic::new(fit.span(), title))
}

/// Why a lattice does not go with a shape.
fn misfit(
    kind: LatticeKind,
    is_turned: bool,
    dimension: usize,
    shape: &Shape,
) -> Option<&'static str> {
    match kind {
        _ if dimension == 1 && (kind != LatticeKind::Cubic || is_turned) => {
            Some("in one dimension particles stand in a row: `lattice` must be \"cubic\"")
        }
        LatticeKind::BodyCentred | LatticeKind::FaceCentred if dimension == 2 => {
            Some("a lattice of cells with centres needs three dimensions")
        }
        LatticeKind::Glass if is_turned => {
            Some("glass, which has no order, has no `angle` and no `axis`")
        }
        LatticeKind::Shells => {
            let is_round = matches!(shape, Shape::Sphere { .. } | Shape::Shell { .. });
            (!is_round || is_turned || dimension < 3).then_some(
                "a lattice of shells, which has no `angle`, fills spheres and hollow spheres in \
                 three dimensions; \"rings\" fill discs and cylinders",
            )
        }
        LatticeKind::Rings => {
            let is_round = match shape {
                Shape::Box { .. } | Shape::Solid(_) => false,
                Shape::Sphere { .. } | Shape::Shell { .. } => dimension == 2,
                Shape::Cylinder { axis, .. } => *axis == Axis::Z,
            };
            (!is_round || is_turned).then_some(
                "a lattice of rings, which has no `angle`, fills discs and rings in two \
                 dimensions and cylinders along z in three",
            )
        }
        _ => None,
    }
}
