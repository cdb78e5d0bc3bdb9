//! How tables and words to choose from are declared.

/// Declares tables whose keys are all optional unless said, and closed to others.
macro_rules! tables {
    ($($(#[doc = $doc:literal])+ $table:ident {
        $($(#[doc = $key_doc:literal])+ $(#[serde($option:ident)])? $key:ident: $value:ty,)*
    })+) => { $(
        $(#[doc = $doc])+
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields, remote = "Self")]
        pub struct $table {
            $($(#[doc = $key_doc])+ $(#[serde($option)])? pub $key: $value,)*
        }
        from_table!($table);
        described_table!($table [$($doc)+] {
            $( $key: $value, [$($key_doc)+], [$($option)?]; )*
        });
    )+ };
}

/// Describes a table; a key whose last bracket holds anything may be left out.
macro_rules! described_table {
    ($table:ident [$($doc:literal)+] {
        $( $key:ident: $value:ty, [$($key_doc:literal)+], [$($option:ident)?]; )*
    }) => {
        impl $crate::input::schema::describe::Described for $table {
            fn describe(
                definitions: &mut $crate::input::schema::describe::Definitions,
            ) -> serde_json::Value {
                use $crate::input::schema::describe::{Described, Key};
                definitions.table(stringify!($table), &[$($doc),+], &[$( Key {
                    name: stringify!($key),
                    docs: &[$($key_doc),+],
                    optional: <$value as Described>::OPTIONAL $( || stringify!($option) != "" )?,
                    value: <$value as Described>::describe,
                }, )*])
            }
        }
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

/// Declares tables that may be left out altogether.
macro_rules! optional_tables {
    ($($(#[doc = $doc:literal])+ $table:ident {
        $($(#[doc = $key_doc:literal])+ $key:ident: $value:ty,)*
    })+) => { $(
        $(#[doc = $doc])+
        #[derive(Debug, Default, Deserialize)]
        #[serde(default, deny_unknown_fields, remote = "Self")]
        pub struct $table { $($(#[doc = $key_doc])+ pub $key: $value,)* }
        from_table!($table);
        described_table!($table [$($doc)+] {
            $( $key: $value, [$($key_doc)+], [default]; )*
        });
    )+ };
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
