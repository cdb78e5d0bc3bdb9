//! Laws of strength: all of a law, or single values changed.

use toml::Spanned;

use super::check::exactly_one;
use super::laws::law;
use crate::input::forms::OrNone;
use crate::input::schema::{StrengthParams, strength_laws};
use crate::input::source::Diagnostic;
use crate::material::{Law, Strength};

macro_rules! strength {
    ($(
        $(#[$doc:meta])+ $law:ident: $table:ident => $made:ident { $(
            $(#[$key_doc:meta])+ $key:ident: $typed:ty
                $(= $value:expr)? $(, $allowed:ident)? $(=> $words:literal)?;
        )+ }
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
            // Every law of solids has one.
            let g = base.map(Strength::shear_modulus).filter(|g| *g > 0.0);
            let other = |key: &str| g.filter(|_| key == "shear_modulus");
            $( if let Some(params) = &params.$law {
                let base = match base {
                    Some(Strength::$made(law)) => Some(law),
                    _ => None,
                };
                let law = law!(params, base, other, at, $made { $($key [$($value)?])+ });
                return Ok(Strength::$made(law));
            } )+
            Err(exactly_one(at, "strength", &choices))
        }
    };
}
strength_laws!(strength);
