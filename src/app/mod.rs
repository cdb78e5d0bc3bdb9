//! Room app.

pub mod plot;
