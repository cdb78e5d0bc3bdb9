//! `eos`: exactly one equation of state, all of it or single values changed.

use toml::Spanned;

use super::check::{Allowed, exactly_one};
use super::laws::law;
use crate::input::schema::value::Ranged;
use crate::input::schema::{EosParams, equations_of_state};
use crate::input::source::Diagnostic;
use material::{Eos, EquationOfState, Jwl, Tait};

macro_rules! eos {
    ($(
        $(#[$doc:meta])+ $law:ident: $table:ident => $made:ident { $(
            $(#[$key_doc:meta])+ $key:ident: $typed:ty
                $(= $value:expr)? $(, $allowed:ident)? $(=> $words:literal)?;
        )+ } $(or {
            $(#[$way_doc:meta])+ $way:ident: $way_typed:ty, $way_allowed:ident => $of:ident: $make:expr;
        })?
    )+) => {
        /// The equation of state of a table, with values of the library's `base` where the table has none;
        /// `rho0` is the reference density (kg/m³).
        pub fn eos(
            table: &Spanned<EosParams>,
            base: Option<&Eos>,
            rho0: f64,
        ) -> Result<Eos, Diagnostic> {
            let (at, params) = (table.span(), table.get_ref());
            let choices = [$( concat!("`", stringify!($law), "`") ),+].join(", ");
            let chosen = [$( params.$law.is_some() ),+];
            if chosen.iter().filter(|is_there| **is_there).count() != 1 {
                return Err(exactly_one(at, "eos", &choices));
            }
            $( if let Some(params) = &params.$law {
                let base = match base {
                    Some(Eos::$made(law)) => Some(law),
                    _ => None,
                };
                let other = |_: &str| None::<f64>;
                $(
                    let way = params.$way.within(stringify!($way), Allowed::$way_allowed)?;
                    if let (Some(_), Some(way)) = (&params.$of, &params.$way) {
                        let title = concat!(
                            "`", stringify!($of), "` and `", stringify!($way),
                            "` say the same twice: give one of them"
                        );
                        return Err(Diagnostic::new(way.span(), title));
                    }
                    if params.$of.is_none() && way.is_none() && base.is_none() {
                        let title = concat!(
                            "`eos.", stringify!($law), "` needs `", stringify!($way), "` or `",
                            stringify!($of), "`"
                        );
                        return Err(Diagnostic::new(at, title).label("in this table"));
                    }
                    // Known below.
                    let other = |key: &str| other(key).or(way.filter(|_| key == stringify!($of)));
                )?
                let law = law!(params, base, other, at, $made { $($key [$($value)?])+ });
                $( let law = way.map_or(law, |way| ($make)(&law, rho0, way)); )?
                return Ok(Eos::$made(law));
            } )+
            Err(exactly_one(at, "eos", &choices))
        }
    };
}
equations_of_state!(eos);
