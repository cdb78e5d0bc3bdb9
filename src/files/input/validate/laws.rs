//! What reads a law of a table: all of its constants, or single values changed.

/// The value of a constant: that of the table, else that of the library's law of the same kind
/// (`$base`), else its default, if it has one.
macro_rules! value {
    ($params:ident $key:ident $base:expr, Word, $at:ident) => {{
        let word = $params.$key.as_ref().map(|word| *word.get_ref());
        word.or($base).unwrap_or_default()
    }};
    ($params:ident $key:ident $base:expr, $allowed:ident, $at:ident, $default:literal) => {
        $crate::input::validate::check::number(
            $params.$key.as_ref(),
            stringify!($key),
            $base.unwrap_or($default),
            $crate::input::validate::check::Allowed::$allowed,
        )?
    };
    ($params:ident $key:ident $base:expr, $allowed:ident, $at:ident) => {
        $crate::input::validate::check::required(
            $params.$key.as_ref(),
            stringify!($key),
            $base,
            $crate::input::validate::check::Allowed::$allowed,
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
        let law = material::$made {
            $( $key: $crate::input::validate::laws::value!($params $key $crate::input::validate::laws::base!($key $base $g), $allowed, $at $(, $default)?), )+
        };
        if let Some(wrong) = material::Law::contradiction(&law) {
            let place = |key: &&str| match *key {
                $( stringify!($key) => $params.$key.as_ref().map(toml::Spanned::span), )+
                _ => None,
            };
            let place = wrong.keys.iter().find_map(place);
            return Err($crate::input::source::Diagnostic::new(place.unwrap_or($at), wrong.title));
        }
        law
    }};
}

pub(super) use {base, law, value};
