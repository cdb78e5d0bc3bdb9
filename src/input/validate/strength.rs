//! Laws of strength and failure: all of a law, or single values changed.

use toml::Spanned;

use super::check::{Allowed, exactly_one, number, required};
use crate::input::forms::OrNone;
use crate::input::schema::{MaterialParams, StrengthParams, failure_laws, strength_laws};
use crate::input::source::Diagnostic;
use crate::material::{Failure, Law, Strength};

/// The value of a constant: that of the table, else that of the library's law of the same kind
/// (`$base`), else its default, if it has one.
macro_rules! value {
    ($params:ident $key:ident $base:expr, Word, $at:ident) => {{
        let word = $params.$key.as_ref().map(|word| *word.get_ref());
        word.or($base).unwrap_or_default()
    }};
    ($params:ident $key:ident $base:expr, $allowed:ident, $at:ident, $default:literal) => {
        number(
            $params.$key.as_ref(),
            stringify!($key),
            $base.unwrap_or($default),
            Allowed::$allowed,
        )?
    };
    ($params:ident $key:ident $base:expr, $allowed:ident, $at:ident) => {
        required(
            $params.$key.as_ref(),
            stringify!($key),
            $base,
            Allowed::$allowed,
            &$at,
        )?
    };
}

/// The library's value of a constant. Every law of solids has a shear modulus (`$g`), so one may
/// take it from another.
macro_rules! base {
    (shear_modulus $law:ident $g:expr) => {
        $law.map(|law| law.shear_modulus).or($g)
    };
    ($key:ident $law:ident $g:expr) => {
        $law.map(|law| law.$key)
    };
}

/// The law of a table, with values of `$base`, the library's law of the same kind.
macro_rules! law {
    ($params:ident, $base:ident, $g:expr, $at:ident, $made:ident {
        $($key:ident $allowed:ident $($default:literal)?;)+
    }) => {{
        let law = crate::material::$made {
            $( $key: value!($params $key base!($key $base $g), $allowed, $at $(, $default)?), )+
        };
        if let Some(wrong) = law.contradiction() {
            let place = |key: &&str| match *key {
                $( stringify!($key) => $params.$key.as_ref().map(Spanned::span), )+
                _ => None,
            };
            let place = wrong.keys.iter().find_map(place);
            return Err(Diagnostic::new(place.unwrap_or($at), wrong.title));
        }
        law
    }};
}

macro_rules! strength {
    ($(
        $(#[$doc:meta])+ $law:ident: $table:ident => $made:ident {
            $( $(#[$key_doc:meta])+ $key:ident: $value:ty, $allowed:ident $(, or $default:literal)?; )+
        }
    )+) => {
        /// The strength of a table, with values of the library's `base` where the table has none.
        pub fn strength(
            table: &Spanned<OrNone<StrengthParams>>,
            base: Option<&Strength>,
        ) -> Result<Strength, Diagnostic> {
            let at = table.span();
            let OrNone::Table(params) = table.get_ref() else {
                return Ok(Strength::None);
            };
            let choices = [$( concat!("`", stringify!($law), "`") ),+].join(", ");
            let chosen = [$( params.$law.is_some() ),+];
            if chosen.iter().filter(|is_there| **is_there).count() != 1 {
                return Err(exactly_one(at, "strength", &choices)
                    .help("or write `strength = \"none\"` for a fluid"));
            }
            let g = base.map(Strength::shear_modulus).filter(|g| *g > 0.0);
            $( if let Some(params) = &params.$law {
                let base = match base {
                    Some(Strength::$made(law)) => Some(law),
                    _ => None,
                };
                let law = law!(params, base, g, at, $made { $($key $allowed $($default)?;)+ });
                return Ok(Strength::$made(law));
            } )+
            Err(exactly_one(at, "strength", &choices))
        }
    };
}
strength_laws!(strength);

macro_rules! failure {
    ($(
        $(#[$doc:meta])+ $law:ident: $table:ident => $made:ident {
            $( $(#[$key_doc:meta])+ $key:ident: $value:ty, $allowed:ident $(, or $default:literal)?; )+
        }
    )+) => {
        /// The failure of a material: laws of its table, and those of the library's `base` that it
        /// does not name.
        pub fn failure(
            params: &MaterialParams,
            base: Option<&Failure>,
        ) -> Result<Failure, Diagnostic> {
            Ok(Failure { $( $law: match &params.$law {
                None => base.and_then(|base| base.$law),
                Some(table) => match table.get_ref() {
                    OrNone::None => None,
                    OrNone::Table(params) => {
                        let (at, base) = (table.span(), None::<crate::material::$made>);
                        Some(law!(params, base, None, at, $made { $($key $allowed $($default)?;)+ }))
                    }
                },
            }, )+ })
        }
    };
}
failure_laws!(failure);
