//! Materials: from the library with single values changed, or inline.

use std::ops::Range;

use toml::Spanned;

use super::check::{Allowed, number, required};
use crate::input::forms::{Named, OrNone};
use crate::input::schema::{
    ElasticParams, EosParams, FormName, LinearParams, MaterialParams, MieGruneisenParams,
    SpallParams, StrengthParams, VonMisesParams,
};
use crate::input::source::Complaint;
use crate::material::{
    Elastic, Eos, Linear, LinearForm, Material, MieGruneisen, Spall, Strength, VonMises, library,
};

/// Names and materials in the order of the input.
pub fn materials(
    params: &Named<MaterialParams>,
) -> Result<(Vec<String>, Vec<Material>), Complaint> {
    let materials: Result<_, _> = params.0.iter().map(|(n, t)| material(n, t)).collect();
    let names = params.0.iter().map(|(name, _)| name.get_ref().clone());
    Ok((names.collect(), materials?))
}

fn material(
    name: &Spanned<String>,
    table: &Spanned<MaterialParams>,
) -> Result<Material, Complaint> {
    let params = table.get_ref();
    let base = params.library.as_ref().map(|library| {
        library::find(library.get_ref()).ok_or_else(|| {
            let known = library::names();
            Complaint::unknown(library.span(), "material", library.get_ref(), known)
        })
    });
    let base = base.transpose()?;
    let base = base.as_ref();
    let missing = |key: &str| {
        let title = format!("the material `{}` has no `{key}`", name.get_ref());
        Complaint::new(name.span(), title).help("name a `library` material or give the key")
    };
    if base.is_none() && params.density.is_none() {
        return Err(missing("density"));
    }
    Ok(Material {
        name: name.get_ref().clone(),
        reference_density: number(
            params.density.as_ref(),
            "density",
            base.map_or(0.0, |b| b.reference_density),
            Allowed::Positive,
        )?,
        eos: match (&params.eos, base.map(|b| &b.eos)) {
            (Some(table), base) => eos(table, base)?,
            (None, base) => base.cloned().ok_or_else(|| missing("eos"))?,
        },
        strength: match (&params.strength, base.map(|b| &b.strength)) {
            (Some(table), base) => strength(table, base)?,
            (None, base) => base.cloned().ok_or_else(|| missing("strength"))?,
        },
        spall: match &params.spall {
            Some(table) => spall(table)?,
            None => base.and_then(|b| b.spall),
        },
        thermal: None,
    })
}

/// Says that a table must have exactly one of several others.
fn exactly_one(at: Range<usize>, table: &str, choices: &str) -> Complaint {
    Complaint::new(at, format!("`{table}` must have exactly one of {choices}"))
}

fn eos(table: &Spanned<EosParams>, base: Option<&Eos>) -> Result<Eos, Complaint> {
    let at = table.span();
    let EosParams {
        linear: linear_table,
        mie_gruneisen: mie_gruneisen_table,
    } = table.get_ref();
    match (linear_table, mie_gruneisen_table) {
        (Some(params), None) => linear(params, base, &at).map(Eos::Linear),
        (None, Some(params)) => mie_gruneisen(params, base, &at).map(Eos::MieGruneisen),
        _ => Err(exactly_one(at, "eos", "`linear`, `mie_gruneisen`")),
    }
}

fn linear(
    params: &LinearParams,
    base: Option<&Eos>,
    at: &Range<usize>,
) -> Result<Linear, Complaint> {
    let base = match base {
        Some(Eos::Linear(linear)) => Some(linear),
        _ => None,
    };
    let modulus = params.bulk_modulus.as_ref();
    let base_modulus = base.map(|l| l.bulk_modulus);
    Ok(Linear {
        bulk_modulus: required(modulus, "bulk_modulus", base_modulus, Allowed::Positive, at)?,
        form: match params.form {
            Some(FormName::Logarithmic) => LinearForm::Logarithmic,
            Some(FormName::DensityRatio) => LinearForm::DensityRatio,
            None => base.map_or(LinearForm::Logarithmic, |l| l.form),
        },
    })
}

fn mie_gruneisen(
    params: &MieGruneisenParams,
    base: Option<&Eos>,
    at: &Range<usize>,
) -> Result<MieGruneisen, Complaint> {
    let base = match base {
        Some(Eos::MieGruneisen(law)) => Some(law),
        _ => None,
    };
    let positive = Allowed::NotNegative;
    let [s1, gamma0] = [params.s1.as_ref(), params.gamma0.as_ref()];
    let curved = |value: &Option<Spanned<f64>>, key, base: Option<f64>| {
        number(value.as_ref(), key, base.unwrap_or(0.0), Allowed::Any)
    };
    Ok(MieGruneisen {
        c0: required(
            params.c0.as_ref(),
            "c0",
            base.map(|m| m.c0),
            Allowed::Positive,
            at,
        )?,
        s1: required(s1, "s1", base.map(|m| m.s1), positive, at)?,
        s2: curved(&params.s2, "s2", base.map(|m| m.s2))?,
        s3: curved(&params.s3, "s3", base.map(|m| m.s3))?,
        gamma0: required(gamma0, "gamma0", base.map(|m| m.gamma0), positive, at)?,
        b: curved(&params.b, "b", base.map(|m| m.b))?,
    })
}

fn strength(
    table: &Spanned<OrNone<StrengthParams>>,
    base: Option<&Strength>,
) -> Result<Strength, Complaint> {
    let at = table.span();
    let OrNone::Table(params) = table.get_ref() else {
        return Ok(Strength::None);
    };
    match (&params.elastic, &params.von_mises) {
        (Some(params), None) => elastic(params, base, &at).map(Strength::Elastic),
        (None, Some(params)) => von_mises(params, base, &at).map(Strength::VonMises),
        _ => Err(exactly_one(at, "strength", "`elastic`, `von_mises`")
            .help("or write `strength = \"none\"` for a fluid")),
    }
}

/// Every law of solids has a shear modulus, so one may take it from another.
fn shear_modulus(base: Option<&Strength>) -> Option<f64> {
    base.map(Strength::shear_modulus).filter(|g| *g > 0.0)
}

fn elastic(
    params: &ElasticParams,
    base: Option<&Strength>,
    at: &Range<usize>,
) -> Result<Elastic, Complaint> {
    let value = params.shear_modulus.as_ref();
    let base = shear_modulus(base);
    Ok(Elastic {
        shear_modulus: required(value, "shear_modulus", base, Allowed::Positive, at)?,
    })
}

fn von_mises(
    params: &VonMisesParams,
    base: Option<&Strength>,
    at: &Range<usize>,
) -> Result<VonMises, Complaint> {
    let base_law = match base {
        Some(Strength::VonMises(law)) => Some(law),
        _ => None,
    };
    let base_yield = base_law.map(|law| law.yield_stress);
    let base_hardening = base_law.map_or(0.0, |law| law.hardening_modulus);
    let [shear, yielding, hardening] = [
        params.shear_modulus.as_ref(),
        params.yield_stress.as_ref(),
        params.hardening_modulus.as_ref(),
    ];
    let positive = Allowed::Positive;
    let or_zero = Allowed::NotNegative;
    Ok(VonMises {
        shear_modulus: required(shear, "shear_modulus", shear_modulus(base), positive, at)?,
        yield_stress: required(yielding, "yield_stress", base_yield, or_zero, at)?,
        hardening_modulus: number(hardening, "hardening_modulus", base_hardening, or_zero)?,
    })
}

fn spall(table: &Spanned<OrNone<SpallParams>>) -> Result<Option<Spall>, Complaint> {
    let OrNone::Table(params) = table.get_ref() else {
        return Ok(None);
    };
    let value = params.pressure.as_ref();
    let at = table.span();
    Ok(Some(Spall {
        pressure: required(value, "pressure", None, Allowed::NotPositive, &at)?,
    }))
}
