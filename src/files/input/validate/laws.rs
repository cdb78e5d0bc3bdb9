//! Macros that read a law of a table: all of its constants, or single values changed.

/// The law of a table that stands `$at` a place, with values of `$base`, the library's law of the same kind, where the
/// table has none; a number without a default may be that of `$other` then, a function of its key.
macro_rules! law {
    ($params:ident, $base:ident, $other:expr, $at:ident, $made:ident { $($key:ident [$($value:expr)?])+ }) => {{
        #[allow(unused_variables, reason = "if all numbers have defaults")]
        let other = $other;
        let law = material::$made {
            $( $key: $params.$key(
                $crate::input::validate::laws::base!($base $key other [$($value)?]),
                &$at,
            )?, )+
        };
        if let Some(wrong) = law.contradiction() {
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

/// Value of a constant that the table does not state.
macro_rules! base {
    ($base:ident $key:ident $other:ident []) => {
        $base
            .map(|law| law.$key)
            .or_else(|| $other(stringify!($key)))
    };
    ($base:ident $key:ident $other:ident [$value:expr]) => {
        $base.map(|law| law.$key)
    };
}

pub(super) use {base, law};
