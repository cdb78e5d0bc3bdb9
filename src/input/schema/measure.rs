//! What is measured in a run, as it is typed.

use serde::Deserialize;
use toml::Spanned;

use super::short::NormalParams;
use crate::input::quantity::{Length, Placed, Pressure, Time};

tables! {
    /// `[[gauge]]`
    GaugeParams {
        /// Name in tables, as of a body.
        name: Option<Spanned<String>>,
        /// Where it is, or begins.
        at: Spanned<Vec<Placed<Length>>>,
        /// Whether the particle nearest at the start carries it; fixed in space if absent.
        moves: Option<bool>,
        /// Name of the body whose matter it reads; all that deform if absent.
        body: Option<Spanned<String>>,
        /// Names of what it reads.
        fields: Option<Spanned<Vec<Spanned<String>>>>,
        /// Direction of the normal stress that it reads; none if absent.
        along: Option<Spanned<NormalParams>>,
        /// Time between readings.
        every: Option<Placed<Time>>,
        /// Steps between readings; each step if both are absent.
        every_steps: Option<Spanned<i64>>,
    }

    /// `[[witness]]`
    WitnessParams {
        /// Name in tables, as of a body.
        name: Option<Spanned<String>>,
        /// To the side to which matter passes forwards.
        normal: Spanned<NormalParams>,
        /// A point of the plane; the origin if absent.
        point: Option<Spanned<Vec<Placed<Length>>>>,
    }
}

optional_tables! {
    /// `[measure]`
    MeasureParams {
        /// Whether `bodies.csv` is written; it is if absent.
        bodies: Option<bool>,
        /// Pressure that counts as the arrival of a shock; that of each material if absent.
        arrival_pressure: Option<Placed<Pressure>>,
    }
}
