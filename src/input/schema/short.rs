//! Values that may be a word or a number in place of a table.

use std::fmt;

use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer, StrDeserializer};
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};
use toml::Spanned;

use super::choices::Direction;
use crate::input::quantity::{Angle, Placed};
use crate::model::LatticeKind;

tables! {
    /// `lattice` as a table.
    LatticeTable {
        /// Kind of stacking.
        kind: Spanned<LatticeKind>,
        /// Turn about z.
        angle: Option<Placed<Angle>>,
    }

    /// `friction` as a table.
    FrictionTable {
        /// Of faces that stick.
        r#static: Spanned<f64>,
        /// Of faces that slide.
        kinetic: Spanned<f64>,
    }
}

optional_tables! {
    /// `contact.self_contact` as a table.
    SelfContactTable {
        /// Spacings between the beginnings of particles that can fold onto each other.
        folds: Option<Spanned<f64>>,
    }
}

/// `"cubic"`, or a table with more.
#[derive(Debug)]
pub struct LatticeParams {
    /// Kind of stacking.
    pub kind: LatticeKind,
    /// Turn about z.
    pub angle: Option<Placed<Angle>>,
}

impl<'de> Deserialize<'de> for LatticeParams {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct LatticeVisitor;
        impl<'de> Visitor<'de> for LatticeVisitor {
            type Value = LatticeParams;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "\"cubic\", \"hexagonal\", \"rings\" or a table with `kind` and `angle`",
                )
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<LatticeParams, E> {
                let kind = LatticeKind::deserialize(StrDeserializer::new(word))?;
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
