//! `eos`: exactly one equation of state, all of it or single values changed.

use std::ops::Range;

use toml::Spanned;

use super::check::{Allowed, exactly_one, number};
use crate::input::schema::{
    EosParams, IdealGasParams, LinearParams, MieGruneisenParams, TaitParams, TillotsonParams,
};
use crate::input::source::Diagnostic;
use material::{Eos, IdealGas, Linear, LinearForm, MieGruneisen, Tait, Tillotson};

const CHOICES: &str = "`linear`, `mie_gruneisen`, `tait`, `tillotson`, `ideal_gas`";

/// The equation of state of a table, with values of the library's `base` where the table has none;
/// `rho0` is the reference density (kg/m³).
pub fn eos(table: &Spanned<EosParams>, base: Option<&Eos>, rho0: f64) -> Result<Eos, Diagnostic> {
    let (at, params) = (table.span(), table.get_ref());
    let EosParams {
        linear: a,
        mie_gruneisen: b,
        tait: c,
        tillotson: d,
        ideal_gas: e,
    } = params;
    match (a, b, c, d, e) {
        (Some(law), None, None, None, None) => linear(law, base, &at).map(Eos::Linear),
        (None, Some(law), None, None, None) => mie_gruneisen(law, base, &at).map(Eos::MieGruneisen),
        (None, None, Some(law), None, None) => tait(law, base, rho0, &at).map(Eos::Tait),
        (None, None, None, Some(law), None) => tillotson(law, base, &at).map(Eos::Tillotson),
        (None, None, None, None, Some(law)) => ideal_gas(law, base, &at).map(Eos::IdealGas),
        _ => Err(exactly_one(at, "eos", CHOICES)),
    }
}

/// The library's law, if it is of the same kind.
macro_rules! same {
    ($base:ident, $law:ident) => {
        match $base {
            Some(Eos::$law(law)) => Some(law),
            _ => None,
        }
    };
}

fn linear(
    params: &LinearParams,
    base: Option<&Eos>,
    at: &Range<usize>,
) -> Result<Linear, Diagnostic> {
    let base = same!(base, Linear);
    let known = base.map_or(LinearForm::Logarithmic, |law| law.form);
    Ok(Linear {
        bulk_modulus: required!(params.bulk_modulus, base, Positive, at),
        form: params.form.unwrap_or(known),
    })
}

fn mie_gruneisen(
    params: &MieGruneisenParams,
    base: Option<&Eos>,
    at: &Range<usize>,
) -> Result<MieGruneisen, Diagnostic> {
    let base = same!(base, MieGruneisen);
    Ok(MieGruneisen {
        c0: required!(params.c0, base, Positive, at),
        s1: required!(params.s1, base, NotNegative, at),
        s2: number!(params.s2, or base.map_or(0.0, |law| law.s2), Any),
        s3: number!(params.s3, or base.map_or(0.0, |law| law.s3), Any),
        gamma0: required!(params.gamma0, base, NotNegative, at),
        b: number!(params.b, or base.map_or(0.0, |law| law.b), Any),
    })
}

fn tait(
    params: &TaitParams,
    base: Option<&Eos>,
    rho0: f64,
    at: &Range<usize>,
) -> Result<Tait, Diagnostic> {
    let base = same!(base, Tait);
    let gamma = number!(params.gamma, or base.map_or(7.0, |law| law.gamma), Positive);
    match (&params.b, &params.sound_speed) {
        (None, Some(c0)) => {
            let c0 = number(Some(c0), "sound_speed", 0.0, Allowed::Positive)?;
            Ok(Tait::with_sound_speed(rho0, c0, gamma))
        }
        (Some(_), Some(c0)) => {
            let title = "`b` and `sound_speed` say the same twice: give one of them";
            Err(Diagnostic::new(c0.span(), title))
        }
        (None, None) if base.is_none() => {
            let title = "`eos.tait` needs `sound_speed` or `b`";
            Err(Diagnostic::new(at.clone(), title).label("in this table"))
        }
        (_, None) => Ok(Tait {
            b: number!(params.b, or base.map_or(0.0, |law| law.b), Positive),
            gamma,
        }),
    }
}

fn tillotson(
    params: &TillotsonParams,
    base: Option<&Eos>,
    at: &Range<usize>,
) -> Result<Tillotson, Diagnostic> {
    let base = same!(base, Tillotson);
    let law = Tillotson {
        a: required!(params.a, base, Positive, at),
        b: required!(params.b, base, NotNegative, at),
        bulk_modulus: required!(params.bulk_modulus, base, Positive, at),
        quadratic_modulus: required!(params.quadratic_modulus, base, NotNegative, at),
        alpha: required!(params.alpha, base, NotNegative, at),
        beta: required!(params.beta, base, NotNegative, at),
        e0: required!(params.e0, base, Positive, at),
        e_iv: required!(params.e_iv, base, Positive, at),
        e_cv: required!(params.e_cv, base, Positive, at),
    };
    if law.e_cv > law.e_iv {
        return Ok(law);
    }
    let place = params.e_cv.as_ref().or(params.e_iv.as_ref());
    let title = "`e_cv` must be above `e_iv`: complete vaporisation takes more than incipient";
    Err(Diagnostic::new(
        place.map_or(at.clone(), Spanned::span),
        title,
    ))
}

fn ideal_gas(
    params: &IdealGasParams,
    base: Option<&Eos>,
    at: &Range<usize>,
) -> Result<IdealGas, Diagnostic> {
    let base = same!(base, IdealGas);
    let stiffening = base.map_or(0.0, |law| law.stiffening_pressure);
    let reference = base.map_or(0.0, |law| law.reference_pressure);
    Ok(IdealGas {
        gamma: required!(params.gamma, base, AboveOne, at),
        stiffening_pressure: number!(params.stiffening_pressure, or stiffening, NotNegative),
        reference_pressure: number!(params.reference_pressure, or reference, NotNegative),
    })
}
