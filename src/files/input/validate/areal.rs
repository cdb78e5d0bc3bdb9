//! Layers by their mass for an area, as cloth is sold: how much of them is pores follows.

use toml::Spanned;

use super::fibres;
use crate::input::schema::BodyParams;
use crate::input::source::Diagnostic;
use material::{Material, Porosity};
use model::readable::shown;
use model::{Body, Case, Shape};

/// Distensions that differ by less, relatively, are one.
const SAME: f64 = 1e-9;

/// Gives each body with an areal density a material of its own distension.
pub fn resolve(case: &mut Case, params: &[Spanned<BodyParams>]) -> Result<(), Diagnostic> {
    let stated = |(b, table): (usize, &Spanned<BodyParams>)| distension(case, b, table.get_ref());
    let distensions: Result<Vec<_>, _> = params.iter().enumerate().map(stated).collect();
    let distensions = distensions?;
    let of_bodies: Vec<usize> = case.bodies.iter().map(|body| body.material).collect();
    let mut made: Vec<(usize, f64, usize)> = Vec::new();
    for (b, distension) in distensions.iter().enumerate() {
        let (Some(distension), of) = (*distension, of_bodies[b]) else {
            continue;
        };
        case.bodies[b].layer = true;
        let same = |other: f64| (other / distension - 1.0).abs() < SAME;
        let known = made.iter().find(|&&(m, d, _)| m == of && same(d));
        if let Some(&(_, _, place)) = known {
            case.bodies[b].material = place;
            continue;
        }
        let mut material = with_distension(&case.materials[of], distension, &params[b])?;
        let mut users = of_bodies.iter().zip(&distensions);
        let place = if users.all(|(m, d)| *m != of || d.is_some_and(same)) {
            case.materials[of] = material;
            of
        } else {
            material.name = format!("{} ({})", material.name, case.bodies[b].name);
            case.materials.push(material);
            case.materials.len() - 1
        };
        case.bodies[b].material = place;
        made.push((of, distension, place));
    }
    Ok(())
}

/// The distension with which the solid of a body's material has its areal density, if it states one.
fn distension(case: &Case, b: usize, params: &BodyParams) -> Result<Option<f64>, Diagnostic> {
    let (Some(areal), Some(given)) = (params.areal_density()?, &params.areal_density) else {
        return Ok(None);
    };
    let (body, refuse) = (&case.bodies[b], |title: String| {
        Diagnostic::new(given.span(), title)
    });
    if let Some(twice) = &params.density {
        let title = "`density` and `areal_density` say the same twice: give one of them";
        return Err(Diagnostic::new(twice.span(), title));
    }
    let Some(Some(pores)) = (case.materials.get(body.material)).map(|m| &m.porosity) else {
        let title = format!(
            "`areal_density` tells how much of `{}` is pores, and its matter has none",
            body.name
        );
        return Err(refuse(title).help("of other matter `density` and thickness tell it"));
    };
    let Some(thickness) = thickness(body, params, case.dimension)? else {
        let title = format!(
            "`{}` is no box or cylinder along an axis that is as thick everywhere",
            body.name
        );
        return Err(refuse(title).help("give its matter the `porosity.distension` that it has"));
    };
    let distension = pores.solid.density * thickness / areal;
    if distension > 1.0 {
        return Ok(Some(distension));
    }
    let title = format!(
        "a layer of {} with {} would be denser than its solid, which has {}",
        case.length_unit.text(thickness),
        shown(areal, "kg/m^2"),
        shown(pores.solid.density, "kg/m^3")
    );
    Err(refuse(title).help("make the body thicker"))
}

/// Thickness (m) of a body that is as thick everywhere.
fn thickness(
    body: &Body,
    params: &BodyParams,
    dimension: usize,
) -> Result<Option<f64>, Diagnostic> {
    let normal = fibres::normal(params, body, dimension)?;
    let along = match &body.shape {
        Shape::Box { .. } => normal.iter().any(|c| c.abs() == 1.0),
        Shape::Cylinder { axis, .. } => normal[axis.index()].abs() == 1.0,
        _ => false,
    };
    let thickness = body.thickness_along(&normal, dimension);
    Ok(Some(thickness).filter(|thickness| along && thickness.is_finite()))
}

/// The same material with another distension.
fn with_distension(
    of: &Material,
    distension: f64,
    table: &Spanned<BodyParams>,
) -> Result<Material, Diagnostic> {
    let mut material = of.clone();
    if let Some(pores) = &of.porosity {
        if let Some(wrong) = pores.law.contradicts(distension, &pores.solid) {
            let at = table.get_ref().areal_density.as_ref();
            let at = at.map_or_else(|| table.span(), Spanned::span);
            let title = format!(
                "as light a layer does not go with its pores: {}",
                wrong.title
            );
            return Err(Diagnostic::new(at, title));
        }
        let made = Porosity::new(distension, pores.law.clone(), pores.solid.density, &of.eos);
        material.reference_density = made.density;
        material.porosity = Some(Porosity {
            strength: pores.strength,
            damage: pores.damage,
            ..made
        });
    }
    Ok(material)
}
