//! `axisymmetric`: two dimensions as a radius and a place along an axis, and what does not go with it.

use super::super::schema::CaseParams;
use super::super::source::Diagnostic;
use model::{Axis, Body, Case, ContactMode, SphForm, SymmetryPlane, Vec3};

/// True if the case asks for it. The axis joins the symmetry planes, as their first.
pub fn axisymmetric(
    params: &CaseParams,
    dimension: usize,
    symmetry: &mut Vec<SymmetryPlane>,
) -> Result<bool, Diagnostic> {
    let Some(key) = params.axisymmetric.as_ref().filter(|key| *key.get_ref()) else {
        return Ok(false);
    };
    if dimension != 2 {
        let title = "`axisymmetric` takes `dimension = 2`: x is the distance from the axis, y the place along it";
        return Err(Diagnostic::new(key.span(), title));
    }
    let mut planes = params.symmetry.iter();
    if let Some(plane) = planes.find(|plane| *plane.axis.get_ref() == Axis::X) {
        let title =
            "the axis of an axisymmetric case is at x = 0, and no other plane is normal to x";
        return Err(Diagnostic::new(plane.axis.span(), title).help("leave this plane out"));
    }
    symmetry.insert(
        0,
        SymmetryPlane {
            axis: Axis::X,
            position: 0.0,
        },
    );
    Ok(true)
}

/// Cells across a spacing, of the sums over a shape, and the most across the shape.
const FINE: f64 = 6.0;
const MOST_CELLS: f64 = 2000.0;

/// Gives the particles of bodies the areas with which their rings have the volume of the shape about the axis.
pub fn fit(case: &mut Case) {
    if !case.axisymmetric {
        return;
    }
    for b in 0..case.bodies.len() {
        let rings = populate::rings(case, &case.bodies[b]);
        let body = &mut case.bodies[b];
        if body.cloud().is_none() && rings > 0.0 {
            body.lattice.volume = Some(revolved(body, &case.symmetry) / rings);
        }
    }
}

/// Volume (m³) of what turns about the axis above the symmetry planes: of fine cells, of which those at a face count by their part within it.
fn revolved(body: &Body, planes: &[SymmetryPlane]) -> f64 {
    let solid = body.shape.solid(2);
    let (mut lower, upper) = solid.bounds();
    for plane in planes {
        let least = &mut lower[plane.axis.index()];
        *least = least.max(plane.position);
    }
    let first = lower.x;
    let widest = (upper.x - first).max(upper.y - lower.y);
    let step = (body.lattice.spacing / FINE).max(widest / MOST_CELLS);
    let cells = |from: f64, to: f64| ((to - from) / step).ceil().max(0.0);
    let [across, along] = [cells(first, upper.x), cells(lower.y, upper.y)];
    let [wide, high] = [(upper.x - first) / across, (upper.y - lower.y) / along];
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "cells of a shape"
    )]
    let [across, along] = [across as u32, along as u32];
    let mut volume = 0.0;
    for n in 0..across {
        let mut filled = 0.0;
        let radius = first + (f64::from(n) + 0.5) * wide;
        for m in 0..along {
            let at = Vec3::new(radius, lower.y + (f64::from(m) + 0.5) * high, 0.0);
            filled += (0.5 - solid.distance(&at) / step).clamp(0.0, 1.0);
        }
        volume += std::f64::consts::TAU * radius * wide * high * filled;
    }
    volume
}

/// Refuses what rings do not have.
pub fn check(case: &Case, params: &CaseParams) -> Result<(), Diagnostic> {
    let Some(key) = params.axisymmetric.as_ref().filter(|_| case.axisymmetric) else {
        return Ok(());
    };
    let modes = case.contacts.iter().map(|pair| &pair.mode);
    let mut modes = modes.chain([&case.default_contact]);
    let other = |mode: &ContactMode| {
        !matches!(
            mode,
            ContactMode::Overlap(_) | ContactMode::None | ContactMode::Kernel
        )
    };
    let term = case.sph.terms.acting().next();
    let obstacles = [
        (
            case.sph.form != SphForm::Corrected,
            "`sph.form` must be \"corrected\"".to_owned(),
        ),
        (
            term.is_some(),
            term.map(|(_, key)| format!("`sph.{key}` is not theirs"))
                .unwrap_or_default(),
        ),
        (
            modes.any(other),
            "`contact.mode` must be \"overlap\", \"kernel\" or \"none\"".to_owned(),
        ),
        (
            !params.measure.region.is_empty(),
            "`measure.region` does not read them".to_owned(),
        ),
        (
            params.fragments.is_some(),
            "`fragments` does not tell them apart".to_owned(),
        ),
        (
            !case.loads.pressures.is_empty(),
            "`[[pressure]]` does not act on them".to_owned(),
        ),
    ];
    if let Some((_, why)) = obstacles.into_iter().find(|(is_there, _)| *is_there) {
        let title = format!("particles of an axisymmetric case are rings: {why}");
        return Err(Diagnostic::new(key.span(), title));
    }
    for (body, table) in case.bodies.iter().zip(&params.body) {
        let graded = body.lattice.sizes.is_some();
        if graded
            || body.cloud().is_some()
            || (body.velocity.x != 0.0 && body.speed_spread() == 0.0)
            || body.angular_velocity != Vec3::zeros()
        {
            let why = if graded {
                "its `spacing` must be the same everywhere"
            } else if body.cloud().is_some() {
                "it must have a `shape`"
            } else {
                "it can move along y alone"
            };
            let title = format!("`{}` consists of rings about an axis: {why}", body.name);
            return Err(Diagnostic::new(table.get_ref().name.span(), title));
        }
    }
    Ok(())
}
