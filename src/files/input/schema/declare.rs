//! Declarations of tables and of words to choose from.
//!
//! A key is one row:
//!
//! ```text
//! /// Smoothing length over particle spacing.
//! smoothing: Option<Spanned<f64>> = 1.3, Within(0.6, 3.0);
//! /// Time between two censuses.
//! every: Option<Placed<Time>>, Positive => "at usual snapshots";
//! ```
//!
//! what it means, its name, how it is typed, what it is if absent (of a quantity a text with its unit), the values
//! that it may have, and what holds if it is absent where that is no value, or, after `=> or`, what may hold
//! instead of the value. Of a row come reading, schema, reference page and explanation, and, where it has a
//! value or a range, a function of the key's name that gives what holds: `params.smoothing()?`. It is an error where
//! there is a range. After `=> or` the function is given what may hold in place of the value of the row.

/// Declares tables whose keys must be there unless their types say that they may be absent, and closed to others.
macro_rules! tables {
    ($($(#[doc = $doc:literal])+ $table:ident { $($rows:tt)* })+) => { $(
        table! {
            value_of false #[derive(Debug, Deserialize)] #[serde(deny_unknown_fields, remote = "Self")]
            $(#[doc = $doc])+ $table { $($rows)* }
        }
    )+ };
}

/// Declares tables that may be left out altogether, and each of their keys.
macro_rules! optional_tables {
    ($($(#[doc = $doc:literal])+ $table:ident { $($rows:tt)* })+) => { $(
        table! {
            value_of true
            #[derive(Debug, Default, Deserialize)] #[serde(default, deny_unknown_fields, remote = "Self")]
            $(#[doc = $doc])+ $table { $($rows)* }
        }
    )+ };
}

/// Declares a table, what its keys hold by the macro `$value_of`, and whether all of them may be absent.
macro_rules! table {
    ($value_of:ident $optional:literal #[$derived:meta] #[$read:meta] $(#[doc = $doc:literal])+ $table:ident { $(
        $(#[doc = $key_doc:literal])+ $(#[serde($option:ident)])? $key:ident: $typed:ty
            $(= $value:expr)? $(, $allowed:ident $(($($bound:expr),+))?)?
            $(=> $(or $other:literal)? $($words:literal)?)?;
    )* }) => {
        $(#[doc = $doc])+
        #[$derived]
        #[$read]
        pub struct $table {
            $($(#[doc = $key_doc])+ $(#[serde($option)])? pub $key: $typed,)*
        }
        from_table!($table);

        impl $table { $(
            $value_of! {
                $key: $typed; [$($value)?] [$($allowed $(($($bound),+))?)?] [$($($other)?)?]
                [concat!("What `", stringify!($key), "` holds.")]
            }
        )* }

        impl $crate::input::schema::describe::Described for $table {
            fn describe(
                definitions: &mut $crate::input::schema::describe::Definitions,
            ) -> serde_json::Value {
                use $crate::input::schema::describe::{Described, Key};
                definitions.table(stringify!($table), &[$($doc),+], &[$( Key {
                    name: stringify!($key),
                    docs: &[$($key_doc),+],
                    optional: $optional || <$typed as Described>::OPTIONAL
                        $( || stringify!($option) == "default" )?,
                    value: <$typed as Described>::describe,
                    absent: absent!($typed; [$($value)?] [$($($other)?)?] [$($($words)?)?]),
                }, )*])
            }
        }
    };
}

/// Value that is typed for a key, within its range if it has one.
macro_rules! typed_in {
    ($given:expr, $key:expr,) => {
        $given.as_ref().map($crate::input::schema::value::Free::typed)
    };
    ($given:expr, $key:expr, $($allowed:tt)+) => {{
        use $crate::input::schema::value::Ranged;
        $given.within($key, $crate::input::validate::check::Allowed::$($allowed)+)?
    }};
}

/// The function that tells what a key holds: of a value, a range, or both.
macro_rules! value_of {
    ($key:ident: $typed:ty; [] [] [] [$doc:expr]) => {};
    ($key:ident: $typed:ty; [$value:expr] [] [] [$doc:expr]) => {
        #[doc = $doc]
        #[allow(dead_code, reason = "some keys are asked together with their place")]
        pub fn $key(&self) -> <$typed as $crate::input::schema::value::Typed>::Value {
            $crate::input::schema::value::free(self.$key.as_ref(), $value)
        }
    };
    ($key:ident: $typed:ty; [] [$($allowed:tt)+] [] [$doc:expr]) => {
        #[doc = $doc]
        pub fn $key(
            &self,
        ) -> Result<<$typed as $crate::input::schema::value::Ranged>::Found, $crate::input::source::Diagnostic> {
            use $crate::input::schema::value::Ranged;
            self.$key.within(stringify!($key), $crate::input::validate::check::Allowed::$($allowed)+)
        }
    };
    ($key:ident: $typed:ty; [$value:expr] [$($allowed:tt)+] [] [$doc:expr]) => {
        #[doc = $doc]
        pub fn $key(
            &self,
        ) -> Result<<$typed as $crate::input::schema::value::Typed>::Value, $crate::input::source::Diagnostic> {
            use $crate::input::schema::value::{Ranged, Typed};
            let allowed = $crate::input::validate::check::Allowed::$($allowed)+;
            let found = self.$key.within(stringify!($key), allowed)?;
            Ok(found.unwrap_or_else(|| <$typed as Typed>::value($value)))
        }
    };
    ($key:ident: $typed:ty; [$value:expr] [$($allowed:tt)*] [$other:literal] [$doc:expr]) => {
        #[doc = $doc]
        #[allow(dead_code, reason = "some keys are asked together with their place")]
        pub fn $key(
            &self,
            other: impl Into<Option<<$typed as $crate::input::schema::value::Typed>::Value>>,
        ) -> Result<
            <$typed as $crate::input::schema::value::Typed>::Value,
            $crate::input::source::Diagnostic,
        > {
            let found = typed_in!(self.$key, stringify!($key), $($allowed)*).or(other.into());
            Ok(found.unwrap_or_else(|| {
                <$typed as $crate::input::schema::value::Typed>::value($value)
            }))
        }
    };
}

/// The function that tells a constant of a law: what is typed, else that of `base`, else that of the row; without any
/// it is missing in the table that stands `at` a place.
macro_rules! value_of_law {
    ($key:ident: $typed:ty; [] [] [] [$doc:expr]) => {};
    ($key:ident: $typed:ty; [$($value:expr)?] [$($allowed:tt)*] [] [$doc:expr]) => {
        #[doc = $doc]
        pub fn $key(
            &self,
            base: Option<<$typed as $crate::input::schema::value::Typed>::Value>,
            at: &std::ops::Range<usize>,
        ) -> Result<
            <$typed as $crate::input::schema::value::Typed>::Value,
            $crate::input::source::Diagnostic,
        > {
            let found = typed_in!(self.$key, stringify!($key), $($allowed)*).or(base);
            $( let found = found.or_else(|| {
                Some(<$typed as $crate::input::schema::value::Typed>::value($value))
            }); )?
            $crate::input::validate::check::required(found, stringify!($key), at)
        }
    };
}

/// Value or words of a key that is absent.
macro_rules! absent {
    ($typed:ty; [] [] [$($words:literal)?]) => {
        $crate::input::schema::describe::Absent {
            value: None,
            words: <[&str]>::first(&[$($words)?]).map(|words| (*words).to_owned()),
        }
    };
    ($typed:ty; [$value:expr] [$($other:literal)?] [$($words:literal)?]) => {
        $crate::input::schema::describe::Absent::with(
            <$typed as $crate::input::schema::value::Typed>::written($value),
            [$($other)?].first().copied(),
            [$($words)?].first().copied(),
        )
    };
}

/// Reads a struct from a table alone: serde would take an array of its values too, in the order of
/// the declaration. What is derived is an inherent function, by `remote = "Self"`.
macro_rules! from_table {
    ($table:ident) => {
        impl crate::input::forms::Table for $table {
            fn from_map<'de, A: serde::de::MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
                Self::deserialize(serde::de::value::MapAccessDeserializer::new(map))
            }
        }

        impl<'de> Deserialize<'de> for $table {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                crate::input::forms::table(deserializer)
            }
        }
    };
}

/// Declares words to choose from.
macro_rules! choices {
    ($($(#[$doc:meta])+ $choice:ident { $($(#[$word_doc:meta])+ $word:ident,)+ })+) => { $(
        $(#[$doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum $choice { $($(#[$word_doc])+ $word,)+ }
        $crate::input::schema::describe::described_words!($choice);
    )+ };
}

/// Reads a value that may be typed in several ways: what is expected, and what each way makes of
/// what it reads.
macro_rules! typed_as {
    ($made:ident: $expected:literal { $($way:ident: $make:expr;)+ }) => {
        impl<'de> Deserialize<'de> for $made {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Ways;
                impl<'de> Visitor<'de> for Ways {
                    type Value = $made;

                    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                        f.write_str($expected)
                    }

                    $( way!($way, $made, $make); )+
                }
                deserializer.deserialize_any(Ways)
            }
        }

        impl $crate::input::schema::describe::Described for $made {
            fn describe(
                definitions: &mut $crate::input::schema::describe::Definitions,
            ) -> serde_json::Value {
                let ways = [$( described_way!($way, definitions, $make) ),+];
                $crate::input::schema::describe::any_of($expected, &ways)
            }
        }
    };
}

/// The schema of one of the ways of [`typed_as`].
macro_rules! described_way {
    (truth, $definitions:ident, $make:expr) => {
        serde_json::json!({ "type": "boolean" })
    };
    (number, $definitions:ident, $make:expr) => {
        serde_json::json!({ "type": "number" })
    };
    (count, $definitions:ident, $make:expr) => {
        serde_json::json!({ "type": "integer" })
    };
    ($way:ident, $definitions:ident, $make:expr) => {
        $crate::input::schema::describe::argument($definitions, $make)
    };
}

/// One of the ways of [`typed_as`].
macro_rules! way {
    (word, $made:ident, $make:expr) => {
        fn visit_str<E: Error>(self, word: &str) -> Result<$made, E> {
            Deserialize::deserialize(StrDeserializer::new(word)).map($make)
        }
    };
    (truth, $made:ident, $make:expr) => {
        fn visit_bool<E: Error>(self, value: bool) -> Result<$made, E> {
            Ok($make(value))
        }
    };
    (count, $made:ident, $make:expr) => {
        fn visit_i64<E: Error>(self, value: i64) -> Result<$made, E> {
            Ok($make(value))
        }
    };
    (number, $made:ident, $make:expr) => {
        fn visit_f64<E: Error>(self, value: f64) -> Result<$made, E> {
            Ok($make(value))
        }

        #[allow(clippy::cast_precision_loss, reason = "as typed")]
        fn visit_i64<E: Error>(self, value: i64) -> Result<$made, E> {
            Ok($make(value as f64))
        }
    };
    (list, $made:ident, $make:expr) => {
        fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<$made, A::Error> {
            Deserialize::deserialize(SeqAccessDeserializer::new(list)).map($make)
        }
    };
    (table, $made:ident, $make:expr) => {
        fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<$made, A::Error> {
            Deserialize::deserialize(MapAccessDeserializer::new(table)).map($make)
        }
    };
}
