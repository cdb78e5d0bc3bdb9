//! Materials: from the library with single values changed, or inline.

use std::ops::Range;
use std::path::Path;

use toml::Spanned;

use super::check::required;
use super::eos::eos;
use super::failure::failure;
use super::porosity::{Matrix, porosity};
use super::strength::strength;
use crate::input::forms::Named;
use crate::input::names;
use crate::input::schema::{MaterialParams, ThermalParams};
use crate::input::source::Diagnostic;
use material::{Eos, Material, Molten, Strength, Thermal, ThermalConstants, library};

/// Names and materials in the order of the input.
pub fn materials(
    params: &Named<MaterialParams>,
    dimension: usize,
    folder: &Path,
) -> Result<(Vec<String>, Vec<Material>), Diagnostic> {
    let materials: Result<_, _> = params
        .0
        .iter()
        .map(|(n, t)| material(n, t, dimension, folder))
        .collect();
    let names = params.0.iter().map(|(name, _)| name.get_ref().clone());
    Ok((names.collect(), materials?))
}

fn material(
    name: &Spanned<String>,
    table: &Spanned<MaterialParams>,
    dimension: usize,
    folder: &Path,
) -> Result<Material, Diagnostic> {
    names::check(name, "material")?;
    let params = table.get_ref();
    let base = params.library.as_ref().map(|library| {
        library::find(library.get_ref()).ok_or_else(|| {
            let known = library::names();
            Diagnostic::unknown(library.span(), "material", library.get_ref(), known)
        })
    });
    let base = base.transpose()?;
    let base = base.as_ref();
    let missing = |key: &str| {
        let title = format!("the material `{}` has no `{key}`", name.get_ref());
        Diagnostic::new(name.span(), title).help("name a `library` material or give the key")
    };
    if base.is_none() && params.density.is_none() {
        return Err(missing("density"));
    }
    let known_density = base.map_or(0.0, Material::matter_density);
    let density = params.density()?.unwrap_or(known_density);
    let eos = match (&params.eos, base.map(|b| &b.eos)) {
        (Some(table), base) => eos(table, base, density, folder)?,
        (None, base) => base.cloned().ok_or_else(|| missing("eos"))?,
    };
    let strength = match (&params.strength, base.map(|b| &b.strength)) {
        (Some(table), base) => strength(table, base)?,
        (None, base) => base.cloned().ok_or_else(|| missing("strength"))?,
    };
    let base_thermal = base.and_then(|b| b.thermal.as_ref());
    let thermal = thermal(params.thermal.as_ref(), base_thermal, density, &eos)?;
    let (given, known) = (params.failure.as_ref(), base.map(|b| &b.failure));
    let failure = failure(given, known, (&eos, &strength), dimension)?;
    let matrix = Matrix {
        eos: &eos,
        density,
        strength: &strength,
        failure: &failure,
    };
    let known = base.and_then(|b| b.porosity.as_ref());
    let pores = porosity(params.porosity.as_ref(), known, &matrix)?;
    let material = Material {
        name: name.get_ref().clone(),
        reference_density: pores.as_ref().map_or(density, |pores| pores.density),
        eos,
        strength,
        failure,
        thermal,
        porosity: pores,
    };
    burns_alone(&material, name, params)?;
    match missing_heat(&material) {
        None => Ok(material),
        Some(key) => Err(heat_diagnostic(&material, key, name.span(), params)),
    }
}

/// Refuses an explosive whose detonation contradicts itself, or which bears shear.
fn burns_alone(
    material: &Material,
    name: &Spanned<String>,
    params: &MaterialParams,
) -> Result<(), Diagnostic> {
    let Eos::Jwl(explosive) = &material.eos else {
        return Ok(());
    };
    if explosive.cj_volume(material.reference_density) <= 0.0 {
        let at = params.eos.as_ref().map_or(name.span(), Spanned::span);
        let title = "`cj_pressure` must be below ρ₀ D² of the density and `detonation_velocity`";
        return Err(Diagnostic::new(at, title));
    }
    if !matches!(material.strength, Strength::None | Strength::Viscous(_)) {
        let at = params.strength.as_ref().map_or(name.span(), Spanned::span);
        let title = "an explosive burns to gas and has no `strength`";
        return Err(Diagnostic::new(at, title).help("`strength = \"none\"`"));
    }
    Ok(())
}

/// Says that a law follows the temperature and has no `key`.
fn heat_diagnostic(
    material: &Material,
    key: &str,
    name: Range<usize>,
    params: &MaterialParams,
) -> Diagnostic {
    let (law, at) = if material.strength.needs_temperature() {
        ("strength", params.strength.as_ref().map(Spanned::span))
    } else {
        ("failure", params.failure.as_ref().map(Spanned::span))
    };
    let title = format!("this {law} follows the temperature and needs `{key}`");
    Diagnostic::new(at.unwrap_or(name), title)
}

/// The key without which a strength or a failure that follows the temperature cannot.
fn missing_heat(material: &Material) -> Option<&'static str> {
    let melting = |thermal: &Thermal| thermal.constants().melting_temperature.is_some();
    match &material.thermal {
        None if material.needs_temperature() => Some("thermal.specific_heat"),
        Some(_) if melts_unknown(material) => Some("thermal.melting_temperature"),
        Some(thermal) if material.needs_melting() && !melting(thermal) => {
            Some("thermal.melting_temperature")
        }
        _ => None,
    }
}

/// True if molten matter is to fail, and nothing says when the material melts.
fn melts_unknown(material: &Material) -> bool {
    material.failure.options.molten == Some(Molten::Fails)
        && material
            .melting_temperature(material.reference_density, 0.0)
            .is_none()
}

/// Thermal constants, with the cold curve of this material's own equation of state.
fn thermal(
    table: Option<&Spanned<ThermalParams>>,
    base: Option<&Thermal>,
    reference_density: f64,
    eos: &Eos,
) -> Result<Option<Thermal>, Diagnostic> {
    let base = base.map(Thermal::constants);
    let constants = match table {
        None => base.copied(),
        Some(table) => {
            let params = table.get_ref();
            let cold = base.map(|b| b.reference_temperature);
            let reference_temperature = params.reference_temperature(cold)?;
            let given = params.melting_temperature()?;
            if let (Some(value), Some(t)) = (&params.melting_temperature, given)
                && t <= reference_temperature
            {
                let title = "`melting_temperature` must be above `reference_temperature`";
                return Err(Diagnostic::new(value.span(), title).label("out of range"));
            }
            let specific_heat = params.specific_heat()?.or(base.map(|b| b.specific_heat));
            Some(ThermalConstants {
                specific_heat: required(specific_heat, "specific_heat", &table.span())?,
                reference_temperature,
                melting_temperature: given.or(base.and_then(|b| b.melting_temperature)),
                taylor_quinney: params.taylor_quinney(base.map(|b| b.taylor_quinney))?,
            })
        }
    };
    Ok(constants.map(|constants| Thermal::new(constants, reference_density, eos)))
}
