//! Quantities by place, as they are typed: a number with a unit, or a formula.

use std::marker::PhantomData;

use serde::de::{Deserialize, Deserializer};

use super::quantity::{Kind, PLAIN, TextVisitor, expected};

/// A constant or a formula, as typed, of a kind of quantity.
#[derive(Debug)]
pub struct ProfileParams<K> {
    /// Text between the quotes.
    pub text: String,
    kind: PhantomData<K>,
}

impl<'de, K: Kind> Deserialize<'de> for ProfileParams<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextVisitor {
            expected: || expected::<K>(""),
            read: |text| {
                Ok(Self {
                    text: text.to_owned(),
                    kind: PhantomData,
                })
            },
            takes_numbers: K::POWERS == PLAIN,
        })
    }
}
