//! `porosity`: pores of a material, all of their law or single values changed.

use toml::Spanned;

use super::check::exactly_one;
use super::laws::law;
use crate::input::forms::OrNone;
use crate::input::schema::{PorosityParams, compaction_laws};
use crate::input::source::Diagnostic;
use material::{
    Compaction, CompactionDamage, CompactionLaw, Eos, Failure, Porosity, Strength, StrengthOf,
};

/// What pores lie in: equation of state and density (kg/m³) of the solid, its strength and failure.
pub struct Matrix<'a> {
    pub eos: &'a Eos,
    pub density: f64,
    pub strength: &'a Strength,
    pub failure: &'a Failure,
}

macro_rules! compaction {
    ($(
        $(#[$doc:meta])+ $law:ident: $table:ident => $made:ident { $(
            $(#[$key_doc:meta])+ $key:ident: $typed:ty
                $(= $value:expr)? $(, $allowed:ident)? $(=> $words:literal)?;
        )+ }
    )+) => {
        /// The law of compaction of a table, with values of the library's `base` where the table has none, and where its key
        /// stands.
        fn compaction(
            params: &PorosityParams,
            at: std::ops::Range<usize>,
            base: Option<&Compaction>,
        ) -> Result<Compaction, Diagnostic> {
            let choices = [$( concat!("`", stringify!($law), "`") ),+].join(", ");
            let chosen = [$( params.$law.is_some() ),+];
            let count = chosen.iter().filter(|is_there| **is_there).count();
            if let (0, Some(base)) = (count, base) {
                return Ok(base.clone());
            }
            if count != 1 {
                return Err(exactly_one(at, "porosity", &choices));
            }
            $( if let Some(params) = &params.$law {
                let base = match base {
                    Some(Compaction::$made(law)) => Some(law),
                    _ => None,
                };
                let law = law!(params, base, |_: &str| None::<f64>, at, $made { $($key [$($value)?])+ });
                return Ok(Compaction::$made(law));
            } )+
            Err(exactly_one(at, "porosity", &choices))
        }

        /// Where one of the keys of the law stands.
        fn place(params: &PorosityParams, keys: &[&str]) -> Option<std::ops::Range<usize>> {
            let of = |key: &&str| {
                $( if let Some(params) = &params.$law {
                    return match *key {
                        $( stringify!($key) => params.$key.as_ref().map(Spanned::span), )+
                        _ => None,
                    };
                } )+
                None
            };
            keys.iter().find_map(of)
        }
    };
}
compaction_laws!(compaction);

/// Pores of a table, with values of the library's `base` where the table has none.
pub fn porosity(
    table: Option<&Spanned<OrNone<PorosityParams>>>,
    base: Option<&Porosity>,
    matrix: &Matrix,
) -> Result<Option<Porosity>, Diagnostic> {
    let table = match (table, base) {
        (None, None) => return Ok(None),
        (None, Some(base)) => {
            let law = base.law.clone();
            let same = Porosity::new(base.distension, law, matrix.density, matrix.eos);
            return Ok(Some(Porosity {
                strength: base.strength,
                damage: base.damage,
                ..same
            }));
        }
        (Some(table), _) => table,
    };
    let at = table.span();
    let OrNone::Table(params) = table.get_ref() else {
        return Ok(None);
    };
    if matrix.eos.modulus_over_pressure().is_some() || matches!(matrix.eos, Eos::Jwl(_)) {
        let title = "a gas or an explosive has no pores that could crush";
        return Err(Diagnostic::new(at, title));
    }
    let distension = distension(params, &at, base)?;
    let law = compaction(params, at.clone(), base.map(|b| &b.law))?;
    let mut pores = Porosity::new(distension, law, matrix.density, matrix.eos);
    if let Some(wrong) = pores.law.contradicts(distension, &pores.solid) {
        let place = place(params, wrong.keys).unwrap_or(at);
        return Err(Diagnostic::new(place, wrong.title));
    }
    let strength = params.strength.as_ref().map(|word| *word.get_ref());
    let damage = params.damage.as_ref().map(|word| *word.get_ref());
    pores.strength = strength.or(base.map(|b| b.strength)).unwrap_or_default();
    pores.damage = damage.or(base.map(|b| b.damage)).unwrap_or_default();
    let directed = matches!(matrix.strength, Strength::Orthotropic(_));
    if directed && (matrix.failure.hashin.is_some() || pores.strength == StrengthOf::Matrix) {
        let title = "matter with directions of its own has pores only without `hashin`, and the strength of the whole";
        return Err(Diagnostic::new(at, title));
    }
    if pores.strength == StrengthOf::Matrix
        && matches!(
            matrix.strength,
            Strength::None | Strength::NeoHookean(_) | Strength::Viscous(_)
        )
    {
        let place = params.strength.as_ref().map_or(at, Spanned::span);
        let title = "a strength of the matrix must be elastic, or elastic and plastic";
        return Err(Diagnostic::new(place, title));
    }
    if pores.damage == CompactionDamage::Crushed && !matrix.failure.has_memory() {
        let place = params.damage.as_ref().map_or(at, Spanned::span);
        let title =
            "crushing damages what can fail, and this material has no law of failure for good";
        return Err(
            Diagnostic::new(place, title).help("`failure.spall` with `after = \"failed\"` is one")
        );
    }
    Ok(Some(pores))
}

/// The initial distension.
fn distension(
    params: &PorosityParams,
    at: &std::ops::Range<usize>,
    base: Option<&Porosity>,
) -> Result<f64, Diagnostic> {
    let (distension, share) = (params.distension()?, params.porosity()?);
    if let (Some(_), Some(_), Some(twice)) = (distension, share, &params.porosity) {
        let title = "`distension` and `porosity` say the same twice: give one of them";
        return Err(Diagnostic::new(twice.span(), title));
    }
    let stated = distension.or(share.map(|share| 1.0 / (1.0 - share)));
    let Some(stated) = stated.or(base.map(|b| b.distension)) else {
        let title = "`porosity` needs `distension` or `porosity`, how much of it is pores";
        return Err(Diagnostic::new(at.clone(), title).label("in this table"));
    };
    if stated <= 1.0 {
        let key = params.distension.as_ref().or(params.porosity.as_ref());
        let title = "matter without pores needs no `porosity`";
        return Err(Diagnostic::new(
            key.map_or(at.clone(), Spanned::span),
            title,
        ));
    }
    Ok(stated)
}
