//! What is written, as it is typed.

use std::fmt;

use serde::de::value::StrDeserializer;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

use super::KeepParams;
use crate::input::quantity::{Placed, Quantity, TextVisitor, Time, expected, quantity};
use model::Precision;

optional_tables! {
    /// `[output]`
    OutputParams {
        /// Time between snapshots; the first and the last state alone if absent.
        snapshot_every: Option<Placed<Time>>,
        /// Time between checkpoints; the last one alone if absent.
        checkpoint_every: Option<Placed<Time>>,
        /// Steps between checkpoints; none by steps if absent.
        checkpoint_every_steps: Option<Spanned<i64>>,
        /// Time of the clock between checkpoints; none by the clock if absent.
        checkpoint_every_wall: Option<Spanned<ClockParams>>,
        /// Mean time between failures of the machine, for `"auto"`; 6 h if absent.
        mean_time_between_failures: Option<Placed<Time>>,
        /// How many are kept; `2` if absent.
        checkpoints_kept: Option<Spanned<i64>>,
        /// Steps, or time, between rows of the histories; 250 rows a run if absent.
        history_every: Option<Spanned<CadenceParams>>,
        /// Snapshot fields, at least one; the usual ones if absent.
        fields: Option<Spanned<Vec<Spanned<String>>>>,
        /// How many ranks write; all if absent.
        writers: Option<Spanned<i64>>,
        /// Arrays begin at multiples of so many bytes; anywhere if absent.
        alignment: Option<Spanned<i64>>,
        /// Snapshots with schedules of their own.
        snapshot: Vec<Spanned<SnapshotParams>>,
    }
}

tables! {
    /// `[[output.snapshot]]`
    SnapshotParams {
        /// Name of its folder, as of a body but without dots.
        name: Spanned<String>,
        /// Time between snapshots; the first and the last state alone if absent.
        every: Option<Placed<Time>>,
        /// Fields, at least one; those of the usual snapshots if absent.
        fields: Option<Spanned<Vec<Spanned<String>>>>,
        /// Names of the bodies whose particles it holds; all if absent.
        bodies: Option<Spanned<Vec<Spanned<String>>>>,
        /// What of space it holds; all if absent.
        region: Option<Spanned<KeepParams>>,
        /// Whether numbers have 64 bits or 32; `"double"` if absent.
        precision: Option<Precision>,
    }
}

/// A time of the clock, or `"auto"`.
#[derive(Debug, Clone, Copy)]
pub enum ClockParams {
    /// By what a checkpoint costs.
    Auto,
    /// Always the same.
    Every(Quantity<Time>),
}

impl<'de> Deserialize<'de> for ClockParams {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextVisitor {
            expected: || expected::<Time>(" or \"auto\""),
            takes_numbers: false,
            read: |text| match text.trim() {
                "auto" => Ok(Self::Auto),
                _ => quantity::<Time>(text).map(Self::Every),
            },
        })
    }
}

/// How often, by steps or by time.
#[derive(Debug, Clone, Copy)]
pub enum CadenceParams {
    /// Every so many steps.
    Steps(i64),
    /// Every so much time.
    Time(Quantity<Time>),
}

typed_as! {
    CadenceParams: "a whole number of steps or a time with a unit, such as 10 or \"0.01 us\"" {
        count: CadenceParams::Steps;
        word: CadenceParams::Time;
    }
}
