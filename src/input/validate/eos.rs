//! `eos`: exactly one equation of state, all of it or single values changed.

use std::ops::Range;

use toml::Spanned;

use super::check::{Allowed, exactly_one, number, required};
use crate::input::schema::{
    EosParams, FormName, IdealGasParams, LinearParams, MieGruneisenParams, TaitParams,
    TillotsonParams,
};
use crate::input::source::Complaint;
use crate::material::{Eos, IdealGas, Linear, LinearForm, MieGruneisen, Tait, Tillotson};

const CHOICES: &str = "`linear`, `mie_gruneisen`, `tait`, `tillotson`, `ideal_gas`";

/// The equation of state of a table, with values of the library's `base` where the table has none;
/// `rho0` is the reference density (kg/m³).
pub fn eos(table: &Spanned<EosParams>, base: Option<&Eos>, rho0: f64) -> Result<Eos, Complaint> {
    let (at, params) = (table.span(), table.get_ref());
    let laws = [
        params.linear.is_some(),
        params.mie_gruneisen.is_some(),
        params.tait.is_some(),
        params.tillotson.is_some(),
        params.ideal_gas.is_some(),
    ];
    if laws.iter().filter(|is_there| **is_there).count() != 1 {
        return Err(exactly_one(at, "eos", CHOICES));
    }
    if let Some(params) = &params.linear {
        return linear(params, base, &at).map(Eos::Linear);
    }
    if let Some(params) = &params.mie_gruneisen {
        return mie_gruneisen(params, base, &at).map(Eos::MieGruneisen);
    }
    if let Some(params) = &params.tait {
        return tait(params, base, rho0, &at).map(Eos::Tait);
    }
    if let Some(params) = &params.tillotson {
        return tillotson(params, base, &at).map(Eos::Tillotson);
    }
    match &params.ideal_gas {
        Some(params) => ideal_gas(params, base, &at).map(Eos::IdealGas),
        None => Err(exactly_one(at, "eos", CHOICES)),
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

fn tait(
    params: &TaitParams,
    base: Option<&Eos>,
    rho0: f64,
    at: &Range<usize>,
) -> Result<Tait, Complaint> {
    let base = match base {
        Some(Eos::Tait(law)) => Some(law),
        _ => None,
    };
    let gamma = number(
        params.gamma.as_ref(),
        "gamma",
        base.map_or(7.0, |law| law.gamma),
        Allowed::Positive,
    )?;
    match (&params.b, &params.sound_speed) {
        (None, Some(c0)) => {
            let c0 = number(Some(c0), "sound_speed", 0.0, Allowed::Positive)?;
            Ok(Tait::with_sound_speed(rho0, c0, gamma))
        }
        (Some(_), Some(c0)) => {
            let title = "`b` and `sound_speed` say the same twice: give one of them";
            Err(Complaint::new(c0.span(), title))
        }
        (None, None) if base.is_none() => {
            let title = "`eos.tait` needs `sound_speed` or `b`";
            Err(Complaint::new(at.clone(), title).label("in this table"))
        }
        (b, None) => Ok(Tait {
            b: number(
                b.as_ref(),
                "b",
                base.map_or(0.0, |law| law.b),
                Allowed::Positive,
            )?,
            gamma,
        }),
    }
}

fn tillotson(
    params: &TillotsonParams,
    base: Option<&Eos>,
    at: &Range<usize>,
) -> Result<Tillotson, Complaint> {
    let base = match base {
        Some(Eos::Tillotson(law)) => Some(law),
        _ => None,
    };
    macro_rules! value {
        ($key:ident, $allowed:ident) => {
            required(
                params.$key.as_ref(),
                stringify!($key),
                base.map(|law| law.$key),
                Allowed::$allowed,
                at,
            )?
        };
    }
    let law = Tillotson {
        a: value!(a, Positive),
        b: value!(b, NotNegative),
        bulk_modulus: value!(bulk_modulus, Positive),
        quadratic_modulus: value!(quadratic_modulus, NotNegative),
        alpha: value!(alpha, NotNegative),
        beta: value!(beta, NotNegative),
        e0: value!(e0, Positive),
        e_iv: value!(e_iv, Positive),
        e_cv: value!(e_cv, Positive),
    };
    if law.e_cv > law.e_iv {
        return Ok(law);
    }
    let place = params.e_cv.as_ref().or(params.e_iv.as_ref());
    let title = "`e_cv` must be above `e_iv`: complete vaporisation takes more than incipient";
    Err(Complaint::new(
        place.map_or(at.clone(), Spanned::span),
        title,
    ))
}

fn ideal_gas(
    params: &IdealGasParams,
    base: Option<&Eos>,
    at: &Range<usize>,
) -> Result<IdealGas, Complaint> {
    let base = match base {
        Some(Eos::IdealGas(law)) => Some(law),
        _ => None,
    };
    let pressure = |value: Option<_>, key, base: Option<f64>| {
        number(value, key, base.unwrap_or(0.0), Allowed::NotNegative)
    };
    Ok(IdealGas {
        gamma: required(
            params.gamma.as_ref(),
            "gamma",
            base.map(|law| law.gamma),
            Allowed::AboveOne,
            at,
        )?,
        stiffening_pressure: pressure(
            params.stiffening_pressure.as_ref(),
            "stiffening_pressure",
            base.map(|law| law.stiffening_pressure),
        )?,
        reference_pressure: pressure(
            params.reference_pressure.as_ref(),
            "reference_pressure",
            base.map(|law| law.reference_pressure),
        )?,
    })
}
