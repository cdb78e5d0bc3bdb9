//! Output, as it is typed.

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
        /// Time between snapshots.
        snapshot_every: Option<Placed<Time>>, Positive => "the first and the last state alone";
        /// Time between checkpoints.
        checkpoint_every: Option<Placed<Time>>, Positive => "the last one alone";
        /// Steps between checkpoints.
        checkpoint_every_steps: Option<Spanned<i64>>, AtLeast(1) => "none by steps";
        /// Time of the clock between checkpoints.
        checkpoint_every_wall: Option<Spanned<ClockParams>> => "none by the clock";
        // If nothing is known of the machine, that of some thousand nodes.
        /// Mean time between failures of the machine, for `"auto"`.
        mean_time_between_failures: Option<Placed<Time>> = "6 h", Positive;
        /// How many are kept.
        checkpoints_kept: Option<Spanned<i64>> = 2, AtLeast(1);
        /// Steps, or time, between rows of the histories.
        history_every: Option<Spanned<CadenceParams>> => "250 rows a run";
        /// Snapshot fields, at least one.
        fields: Option<Spanned<Vec<Spanned<String>>>> => "the usual ones";
        /// How many ranks write.
        writers: Option<Spanned<i64>>, AtLeast(1) => "one for each 16 MB of an array, 16 at least";
        /// Arrays begin at multiples of so many bytes.
        alignment: Option<Spanned<i64>>, AtLeast(1) => "anywhere";
        /// Snapshots with schedules of their own.
        snapshot: Vec<Spanned<SnapshotParams>>;
    }
}

tables! {
    /// `[[output.snapshot]]`
    SnapshotParams {
        /// Name of its folder, as of a body but without dots.
        name: Spanned<String>;
        /// Time between snapshots.
        every: Option<Placed<Time>>, Positive => "the first and the last state alone";
        /// Fields, at least one.
        fields: Option<Spanned<Vec<Spanned<String>>>> => "those of the usual snapshots";
        /// Names of the bodies whose particles it holds.
        bodies: Option<Spanned<Vec<Spanned<String>>>> => "all";
        /// What of space it holds.
        region: Option<Spanned<KeepParams>> => "all";
        /// Numbers of 64 bits or of 32.
        precision: Option<Precision> = Precision::Double;
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

/// Interval, in steps or in time.
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
