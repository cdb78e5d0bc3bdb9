//! Values that may be a word or a table, and tables whose keys are names.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer, StrDeserializer};
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use super::quantity::{Angle, Kind, Quantity};
use super::schema::{
    Direction, FrictionTable, LatticeName, LatticeTable, Placed, SelfContactTable,
};

/// What is read from a table alone.
pub trait Table: Sized {
    /// Reads the entries of a table.
    fn from_map<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error>;
}

/// Reads a table and refuses all else.
pub fn table<'de, T: Table, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    struct TableVisitor<T>(PhantomData<T>);
    impl<'de, T: Table> Visitor<'de> for TableVisitor<T> {
        type Value = T;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a table")
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
            T::from_map(map)
        }
    }
    deserializer.deserialize_any(TableVisitor(PhantomData))
}

/// `"cubic"`, or a table with more.
#[derive(Debug)]
pub struct LatticeParams {
    /// Kind of stacking.
    pub kind: LatticeName,
    /// Turn about z.
    pub angle: Option<Placed<Angle>>,
}

impl<'de> Deserialize<'de> for LatticeParams {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct LatticeVisitor;
        impl<'de> Visitor<'de> for LatticeVisitor {
            type Value = LatticeParams;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"cubic\", \"hexagonal\" or a table with `kind` and `angle`")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<LatticeParams, E> {
                let kind = LatticeName::deserialize(StrDeserializer::new(word))?;
                Ok(LatticeParams { kind, angle: None })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<LatticeParams, A::Error> {
                let table = LatticeTable::deserialize(MapAccessDeserializer::new(map))?;
                Ok(LatticeParams {
                    kind: table.kind.into_inner(),
                    angle: table.angle,
                })
            }
        }
        deserializer.deserialize_any(LatticeVisitor)
    }
}

/// A coefficient of friction, or one of faces that stick and one of faces that slide.
#[derive(Debug)]
pub enum FrictionParams {
    /// One for both.
    One(f64),
    /// One for each.
    Two(FrictionTable),
}

impl<'de> Deserialize<'de> for FrictionParams {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct FrictionVisitor;
        impl<'de> Visitor<'de> for FrictionVisitor {
            type Value = FrictionParams;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, or a table with `static` and `kinetic`")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<FrictionParams, E> {
                Ok(FrictionParams::One(value))
            }

            #[allow(clippy::cast_precision_loss, reason = "as typed")]
            fn visit_i64<E: Error>(self, value: i64) -> Result<FrictionParams, E> {
                Ok(FrictionParams::One(value as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FrictionParams, A::Error> {
                FrictionTable::deserialize(MapAccessDeserializer::new(map)).map(FrictionParams::Two)
            }
        }
        deserializer.deserialize_any(FrictionVisitor)
    }
}

/// Whether there is self-contact, or a table of what it does.
#[derive(Debug)]
pub enum SelfContactParams {
    /// With parts alone, or not at all.
    Is(bool),
    /// With more.
    With(SelfContactTable),
}

impl<'de> Deserialize<'de> for SelfContactParams {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct SelfContactVisitor;
        impl<'de> Visitor<'de> for SelfContactVisitor {
            type Value = SelfContactParams;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("true, false, or a table with `folds`")
            }

            fn visit_bool<E: Error>(self, value: bool) -> Result<SelfContactParams, E> {
                Ok(SelfContactParams::Is(value))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<SelfContactParams, A::Error> {
                SelfContactTable::deserialize(MapAccessDeserializer::new(map))
                    .map(SelfContactParams::With)
            }
        }
        deserializer.deserialize_any(SelfContactVisitor)
    }
}

/// `"none"`, or a table.
#[derive(Debug)]
pub enum OrNone<T> {
    /// The word `none`.
    None,
    /// A table.
    Table(T),
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OrNone<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OrNoneVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for OrNoneVisitor<T> {
            type Value = OrNone<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"none\" or a table")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<OrNone<T>, E> {
                match word {
                    "none" => Ok(OrNone::None),
                    _ => Err(E::unknown_variant(word, &["none"])),
                }
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<OrNone<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(OrNone::Table)
            }
        }
        deserializer.deserialize_any(OrNoneVisitor(PhantomData))
    }
}

/// A quantity, or an array of quantities.
#[derive(Debug)]
pub enum OneOrMany<K> {
    /// One for all times.
    One(Quantity<K>),
    /// One for each time.
    Many(Vec<Placed<K>>),
}

impl<'de, K: Kind> Deserialize<'de> for OneOrMany<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrManyVisitor<K>(PhantomData<K>);
        impl<'de, K: Kind> Visitor<'de> for OneOrManyVisitor<K> {
            type Value = OneOrMany<K>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(
                    f,
                    "{} with a unit, such as \"{}\", or an array of such",
                    K::NAME,
                    K::EXAMPLE
                )
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<OneOrMany<K>, E> {
                Quantity::deserialize(StrDeserializer::new(word)).map(OneOrMany::One)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<OneOrMany<K>, E> {
                Quantity::deserialize(value.into_deserializer()).map(OneOrMany::One)
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<OneOrMany<K>, E> {
                Quantity::deserialize(value.into_deserializer()).map(OneOrMany::One)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<OneOrMany<K>, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(OneOrMany::Many)
            }
        }
        deserializer.deserialize_any(OneOrManyVisitor(PhantomData))
    }
}

/// `"+x"`, or the components of a vector of any length.
#[derive(Debug)]
pub enum NormalParams {
    /// Along an axis.
    Axis(Direction),
    /// Any other.
    Vector(Vec<f64>),
}

impl<'de> Deserialize<'de> for NormalParams {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NormalVisitor;
        impl<'de> Visitor<'de> for NormalVisitor {
            type Value = NormalParams;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"+z\" and the like, or an array of numbers")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<NormalParams, E> {
                Direction::deserialize(StrDeserializer::new(word)).map(NormalParams::Axis)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<NormalParams, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(NormalParams::Vector)
            }
        }
        deserializer.deserialize_any(NormalVisitor)
    }
}

/// A table of tables, in the order of the text.
#[derive(Debug)]
pub struct Named<T>(pub Vec<(Spanned<String>, Spanned<T>)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NamedVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for NamedVisitor<T> {
            type Value = Named<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table of named tables")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Named(entries))
            }
        }
        deserializer.deserialize_map(NamedVisitor(PhantomData))
    }
}
