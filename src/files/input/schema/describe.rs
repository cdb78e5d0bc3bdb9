//! The tables as a JSON schema (draft 7), by which editors complete and check a case.

use serde::Deserialize;
use serde::de::value::{Error, StrDeserializer};
use serde::de::{Deserializer, Error as _, Visitor};
use serde_json::{Map, Value, json};
use toml::Spanned;

use super::ClockParams;
use crate::input::forms::{Named, OneOrMany, OrNone};
use crate::input::profile::ProfileParams;
use crate::input::quantity::{Extent, Kind, Length, PLAIN, Quantity, Time};
use material::{
    AfterSpall, Burn, CompactionDamage, Coupling, Criterion, Crosses, Effect, Flaws, LinearForm,
    Molten, RateForm, StrengthOf,
};
use model::{
    Axis, BodyForm, ContactDirection, FibrePattern, Include, LatticeKind, NumericalFailurePolicy,
    PenaltyLaw, PotentialRange, Precision, SphForm,
};

/// Type of value that may be typed.
pub trait Described {
    /// True if a key of this type may be left out.
    const OPTIONAL: bool = false;

    /// Its schema; tables stand in `definitions`.
    fn describe(definitions: &mut Definitions) -> Value;
}

/// Place of tables in a schema.
const DEFINITIONS: &str = "#/definitions/";

/// The table that a schema refers to, if it is a reference.
#[must_use]
pub fn referred(schema: &Value) -> Option<&str> {
    schema["$ref"].as_str()?.strip_prefix(DEFINITIONS)
}

/// Schemas of tables, by their names.
#[derive(Debug, Default)]
pub struct Definitions(Map<String, Value>);

/// A key of a table.
pub struct Key {
    /// Its name in the program.
    pub name: &'static str,
    /// Lines of its documentation.
    pub docs: &'static [&'static str],
    /// True if it may be left out.
    pub optional: bool,
    /// Schema of the values that may be typed.
    pub value: fn(&mut Definitions) -> Value,
    /// Value or words without it.
    pub absent: Absent,
}

/// Value or words of a key that is absent.
#[derive(Debug, Clone, PartialEq)]
pub struct Absent {
    /// The value that the key has then, if that is always the same.
    pub value: Option<Value>,
    /// In words; nothing if nothing is.
    pub words: Option<String>,
}

impl Absent {
    /// A value, which may be that of `other` instead, or is told by `words`.
    pub fn with(value: Value, other: Option<&str>, words: Option<&str>) -> Self {
        let other = other.map_or_else(String::new, |other| format!(", or {other}"));
        let words = words.map_or_else(|| format!("`{value}`{other}"), str::to_owned);
        Self {
            value: Some(value),
            words: Some(words),
        }
    }
}

/// Place of the words of absence of a key in internal schemas; the value is its `default`.
pub const ABSENT: &str = "absent";

impl Key {
    /// As it is typed.
    fn name(&self) -> &'static str {
        self.name.trim_start_matches("r#")
    }
}

impl Definitions {
    /// A reference to a table, which is defined if it was not yet.
    pub fn table(&mut self, name: &str, docs: &[&str], keys: &[Key]) -> Value {
        if !self.0.contains_key(name) {
            // Tables may hold themselves.
            self.0.insert(name.to_owned(), Value::Null);
            let properties = keys.iter().map(|key| {
                let mut value = (key.value)(self);
                if referred(&value).is_some() {
                    value = json!({ "allOf": [value] });
                }
                value["description"] = text(key.docs).into();
                if let Some(default) = &key.absent.value {
                    value["default"] = default.clone();
                }
                if let Some(words) = &key.absent.words {
                    value[ABSENT] = words.as_str().into();
                }
                (key.name().to_owned(), value)
            });
            let properties: Map<String, Value> = properties.collect();
            let required = keys.iter().filter(|key| !key.optional);
            let required: Vec<&str> = required.map(Key::name).collect();
            let table = json!({
                "type": "object",
                "description": text(docs),
                "properties": properties,
                "required": required,
                "additionalProperties": false,
            });
            self.0.insert(name.to_owned(), table);
        }
        json!({ "$ref": format!("{DEFINITIONS}{name}") })
    }
}

/// The schema of a whole document.
pub fn schema<T: Described>(title: &str) -> Value {
    let mut definitions = Definitions::default();
    let root = T::describe(&mut definitions);
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": title,
        "allOf": [root],
        "definitions": definitions.0,
    })
}

/// Lines of documentation as one text.
pub fn text(docs: &[&str]) -> String {
    let lines: Vec<&str> = docs.iter().map(|line| line.trim()).collect();
    lines.join(" ")
}

/// A schema for others: what is so without a key stands in its description.
pub fn published(mut schema: Value) -> Value {
    match &mut schema {
        Value::Object(entries) => {
            if let Some(Value::String(words)) = entries.get(ABSENT)
                && let Some(Value::String(meaning)) = entries.get("description")
            {
                let meaning = meaning.trim_end_matches('.');
                let comma = if words.contains(", ") { "," } else { "" };
                let text = format!("{meaning}; {words}{comma} if absent.");
                entries.remove(ABSENT);
                entries.insert("description".to_owned(), text.into());
            }
            for entry in entries.values_mut() {
                *entry = published(entry.take());
            }
        }
        Value::Array(entries) => {
            for entry in entries {
                *entry = published(entry.take());
            }
        }
        _ => {}
    }
    schema
}

/// One of several ways of typing what is `expected`.
pub fn any_of(expected: &str, ways: &[Value]) -> Value {
    json!({ "description": expected, "anyOf": ways })
}

/// The argument of a function that makes something of what is typed.
pub fn argument<A: Described, M>(definitions: &mut Definitions, _: fn(A) -> M) -> Value {
    A::describe(definitions)
}

/// The words of an enum that serde reads.
pub fn words<'de, T: Deserialize<'de>>() -> Vec<String> {
    struct Listing;
    impl<'de> Deserializer<'de> for Listing {
        type Error = Error;

        fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
            Err(Error::custom(""))
        }

        fn deserialize_enum<V: Visitor<'de>>(
            self,
            _: &'static str,
            words: &'static [&'static str],
            _: V,
        ) -> Result<V::Value, Error> {
            Err(Error::custom(words.join(" ")))
        }

        serde::forward_to_deserialize_any! {
            bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf
            option unit unit_struct newtype_struct seq tuple tuple_struct map struct identifier
            ignored_any
        }
    }
    let listed = T::deserialize(Listing).err();
    let listed = listed.map_or_else(String::new, |words| words.to_string());
    listed.split_whitespace().map(str::to_owned).collect()
}

/// The word for a value of such an enum.
pub fn word<T: for<'de> Deserialize<'de> + PartialEq>(value: &T) -> Option<String> {
    let read = |word: &str| T::deserialize(StrDeserializer::<Error>::new(word)).ok();
    let mut words = words::<T>().into_iter();
    words.find(|word| read(word).as_ref() == Some(value))
}

/// Types that serde reads as words to choose from.
macro_rules! described_words {
    ($($choice:ty),+ $(,)?) => { $(
        impl $crate::input::schema::describe::Described for $choice {
            fn describe(_: &mut $crate::input::schema::describe::Definitions) -> serde_json::Value {
                serde_json::json!({ "enum": $crate::input::schema::describe::words::<$choice>() })
            }
        }

        impl $crate::input::schema::value::Typed for $choice {
            type Stated = Self;
            type Value = Self;

            fn value(stated: Self) -> Self {
                stated
            }

            fn written(stated: Self) -> serde_json::Value {
                $crate::input::schema::describe::word(&stated).into()
            }
        }

        impl $crate::input::schema::value::Free for $choice {
            fn typed(&self) -> Self {
                *self
            }
        }
    )+ };
}
pub(super) use described_words;

described_words!(
    AfterSpall,
    Burn,
    CompactionDamage,
    StrengthOf,
    Axis,
    ContactDirection,
    Coupling,
    Criterion,
    Crosses,
    Effect,
    FibrePattern,
    Flaws,
    Include,
    LatticeKind,
    LinearForm,
    Molten,
    NumericalFailurePolicy,
    PenaltyLaw,
    PotentialRange,
    Precision,
    RateForm,
    SphForm,
    BodyForm,
);

/// Types of one schema.
macro_rules! described_as {
    ($($made:ty => $schema:tt;)+) => { $(
        impl Described for $made {
            fn describe(_: &mut Definitions) -> Value {
                json!($schema)
            }
        }
    )+ };
}

described_as! {
    bool => { "type": "boolean" };
    f64 => { "type": "number" };
    i64 => { "type": "integer" };
    u32 => { "type": "integer", "minimum": 0, "maximum": 4_294_967_295_u32 };
    String => { "type": "string" };
}

/// A number with a unit, or zero.
fn with_unit<K: Kind>(more: &str) -> Value {
    let text = if K::POWERS == PLAIN {
        json!({ "type": ["string", "number"] })
    } else {
        json!({ "anyOf": [{ "type": "string" }, { "const": 0 }] })
    };
    let mut schema = text;
    schema["title"] = format!("{} with a unit, such as \"{}\"{more}", K::NAME, K::EXAMPLE).into();
    schema["examples"] = json!([K::EXAMPLE]);
    schema
}

impl<K: Kind> Described for Quantity<K> {
    fn describe(_: &mut Definitions) -> Value {
        with_unit::<K>("")
    }
}

impl<K: Kind> Described for ProfileParams<K> {
    fn describe(_: &mut Definitions) -> Value {
        with_unit::<K>(", or a formula of the position")
    }
}

impl Described for Extent {
    fn describe(_: &mut Definitions) -> Value {
        with_unit::<Length>(" or \"2 spacing\"")
    }
}

impl Described for ClockParams {
    fn describe(_: &mut Definitions) -> Value {
        with_unit::<Time>(" or \"auto\"")
    }
}

impl<K: Kind> Described for OneOrMany<K> {
    fn describe(definitions: &mut Definitions) -> Value {
        let one = Quantity::<K>::describe(definitions);
        json!({ "anyOf": [one, { "type": "array", "items": one }] })
    }
}

impl<T: Described> Described for OrNone<T> {
    fn describe(definitions: &mut Definitions) -> Value {
        let table = T::describe(definitions);
        json!({ "anyOf": [{ "const": "none" }, table] })
    }
}

impl<T: Described> Described for Named<T> {
    fn describe(definitions: &mut Definitions) -> Value {
        let table = T::describe(definitions);
        json!({ "type": "object", "additionalProperties": table })
    }
}

impl<T: Described> Described for Option<T> {
    const OPTIONAL: bool = true;

    fn describe(definitions: &mut Definitions) -> Value {
        T::describe(definitions)
    }
}

impl<T: Described> Described for Spanned<T> {
    const OPTIONAL: bool = T::OPTIONAL;

    fn describe(definitions: &mut Definitions) -> Value {
        T::describe(definitions)
    }
}

impl<T: Described> Described for Box<T> {
    const OPTIONAL: bool = T::OPTIONAL;

    fn describe(definitions: &mut Definitions) -> Value {
        T::describe(definitions)
    }
}

impl<T: Described> Described for Vec<T> {
    fn describe(definitions: &mut Definitions) -> Value {
        let items = T::describe(definitions);
        json!({ "type": "array", "items": items })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_published_schema_says_in_words_what_is_so_without_a_key() {
        let key = |words: &str| json!({ "properties": { "absent": { "description": "A; b.", ABSENT: words } } });
        let text = |schema: Value| published(schema)["properties"]["absent"].clone();
        assert_eq!(
            text(key("`7`")),
            json!({ "description": "A; b; `7` if absent." })
        );
        let absent = Absent::with(json!(4), Some("that of all"), None);
        let words = absent.words.unwrap();
        assert_eq!(
            text(key(&words))["description"],
            "A; b; `4`, or that of all, if absent."
        );
        assert_eq!(published(json!(["absent"])), json!(["absent"]));
    }
}
