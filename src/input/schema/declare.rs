//! How tables and words to choose from are declared.

/// Declares tables whose keys are all optional unless said, and closed to others.
macro_rules! tables {
    ($($(#[$doc:meta])+ $table:ident { $($(#[$key_doc:meta])+ $key:ident: $value:ty,)* })+) => { $(
        $(#[$doc])+
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields, remote = "Self")]
        pub struct $table { $($(#[$key_doc])+ pub $key: $value,)* }
        from_table!($table);
    )+ };
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
    ($($(#[$doc:meta])+ $table:ident { $($(#[$key_doc:meta])+ $key:ident: $value:ty,)* })+) => { $(
        $(#[$doc])+
        #[derive(Debug, Default, Deserialize)]
        #[serde(default, deny_unknown_fields, remote = "Self")]
        pub struct $table { $($(#[$key_doc])+ pub $key: $value,)* }
        from_table!($table);
    )+ };
}

/// Declares words to choose from.
macro_rules! choices {
    ($($(#[$doc:meta])+ $choice:ident { $($(#[$word_doc:meta])+ $word:ident,)+ })+) => { $(
        $(#[$doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum $choice { $($(#[$word_doc])+ $word,)+ }
    )+ };
}
