//! `strength`: none or exactly one law, all of it or single values changed.

use std::ops::Range;

use toml::Spanned;

use super::check::{Allowed, exactly_one, number, required};
use crate::input::forms::OrNone;
use crate::input::schema::{
    JohnsonCookParams, SteinbergGuinanParams, StrengthParams, VonMisesParams,
};
use crate::input::source::Complaint;
use crate::material::{
    Elastic, JohnsonCook, NeoHookean, SteinbergGuinan, Strength, Viscous, VonMises,
};

const CHOICES: &str = "`viscous`, `elastic`, `neo_hookean`, `von_mises`, `johnson_cook`, \
     `steinberg_guinan`";

/// Reads the value of a key that must be in the table or in the library's material.
macro_rules! value {
    ($params:ident, $key:ident, $base:expr, $allowed:ident, $at:expr) => {
        required(
            $params.$key.as_ref(),
            stringify!($key),
            $base,
            Allowed::$allowed,
            $at,
        )?
    };
}

/// The strength of a table, with values of the library's `base` where the table has none.
pub fn strength(
    table: &Spanned<OrNone<StrengthParams>>,
    base: Option<&Strength>,
) -> Result<Strength, Complaint> {
    let at = table.span();
    let OrNone::Table(params) = table.get_ref() else {
        return Ok(Strength::None);
    };
    let laws = [
        params.viscous.is_some(),
        params.elastic.is_some(),
        params.neo_hookean.is_some(),
        params.von_mises.is_some(),
        params.johnson_cook.is_some(),
        params.steinberg_guinan.is_some(),
    ];
    if laws.iter().filter(|is_there| **is_there).count() != 1 {
        return Err(
            exactly_one(at, "strength", CHOICES).help("or write `strength = \"none\"` for a fluid")
        );
    }
    // Every law of solids has a shear modulus, so one may take it from another.
    let g = base.map(Strength::shear_modulus).filter(|g| *g > 0.0);
    if let Some(params) = &params.viscous {
        let base = match base {
            Some(Strength::Viscous(law)) => Some(law.viscosity),
            _ => None,
        };
        let viscosity = value!(params, viscosity, base, Positive, &at);
        return Ok(Strength::Viscous(Viscous { viscosity }));
    }
    if let Some(params) = &params.elastic {
        let shear_modulus = value!(params, shear_modulus, g, Positive, &at);
        return Ok(Strength::Elastic(Elastic { shear_modulus }));
    }
    if let Some(params) = &params.neo_hookean {
        let shear_modulus = value!(params, shear_modulus, g, Positive, &at);
        return Ok(Strength::NeoHookean(NeoHookean { shear_modulus }));
    }
    if let Some(params) = &params.von_mises {
        return von_mises(params, base, g, &at).map(Strength::VonMises);
    }
    if let Some(params) = &params.johnson_cook {
        return johnson_cook(params, base, g, &at).map(Strength::JohnsonCook);
    }
    match &params.steinberg_guinan {
        Some(params) => steinberg_guinan(params, base, g, &at).map(Strength::SteinbergGuinan),
        None => Err(exactly_one(at, "strength", CHOICES)),
    }
}

fn von_mises(
    params: &VonMisesParams,
    base: Option<&Strength>,
    g: Option<f64>,
    at: &Range<usize>,
) -> Result<VonMises, Complaint> {
    let base = match base {
        Some(Strength::VonMises(law)) => Some(law),
        _ => None,
    };
    let base_yield = base.map(|law| law.yield_stress);
    Ok(VonMises {
        shear_modulus: value!(params, shear_modulus, g, Positive, at),
        yield_stress: value!(params, yield_stress, base_yield, NotNegative, at),
        hardening_modulus: number(
            params.hardening_modulus.as_ref(),
            "hardening_modulus",
            base.map_or(0.0, |law| law.hardening_modulus),
            Allowed::NotNegative,
        )?,
    })
}

fn johnson_cook(
    params: &JohnsonCookParams,
    base: Option<&Strength>,
    g: Option<f64>,
    at: &Range<usize>,
) -> Result<JohnsonCook, Complaint> {
    let base = match base {
        Some(Strength::JohnsonCook(law)) => Some(law),
        _ => None,
    };
    Ok(JohnsonCook {
        shear_modulus: value!(params, shear_modulus, g, Positive, at),
        a: value!(params, a, base.map(|law| law.a), NotNegative, at),
        b: value!(params, b, base.map(|law| law.b), NotNegative, at),
        n: value!(params, n, base.map(|law| law.n), UpToOne, at),
        c: value!(params, c, base.map(|law| law.c), NotNegative, at),
        m: value!(params, m, base.map(|law| law.m), Positive, at),
        reference_rate: number(
            params.reference_rate.as_ref(),
            "reference_rate",
            base.map_or(1.0, |law| law.reference_rate),
            Allowed::Positive,
        )?,
    })
}

fn steinberg_guinan(
    params: &SteinbergGuinanParams,
    base: Option<&Strength>,
    g: Option<f64>,
    at: &Range<usize>,
) -> Result<SteinbergGuinan, Complaint> {
    let base = match base {
        Some(Strength::SteinbergGuinan(law)) => Some(law),
        _ => None,
    };
    macro_rules! own {
        ($key:ident, $allowed:ident) => {
            value!(params, $key, base.map(|law| law.$key), $allowed, at)
        };
    }
    let law = SteinbergGuinan {
        shear_modulus: value!(params, shear_modulus, g, Positive, at),
        yield_stress: own!(yield_stress, NotNegative),
        max_yield_stress: own!(max_yield_stress, NotNegative),
        beta: own!(beta, NotNegative),
        n: own!(n, UpToOne),
        initial_strain: number(
            params.initial_strain.as_ref(),
            "initial_strain",
            base.map_or(0.0, |law| law.initial_strain),
            Allowed::NotNegative,
        )?,
        pressure_coefficient: own!(pressure_coefficient, NotNegative),
        temperature_coefficient: own!(temperature_coefficient, NotNegative),
        melting_temperature: own!(melting_temperature, Positive),
        gamma0: own!(gamma0, NotNegative),
        a: own!(a, NotNegative),
    };
    if law.max_yield_stress < law.yield_stress {
        let place = params.max_yield_stress.as_ref();
        let place = place.or(params.yield_stress.as_ref());
        let title = "`max_yield_stress` must not be below `yield_stress`";
        let place = place.map_or(at.clone(), Spanned::span);
        return Err(Complaint::new(place, title));
    }
    Ok(law)
}
