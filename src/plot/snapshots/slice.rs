//! A slice of a model about a plane: its thickness, its place, and what lies in it.

use crate::PlotError;
use crate::units::{self, Readable};

/// Shift of the slice's faces in spacings: far above the round-off of positions, far below what
/// the eye sees.
pub const NUDGE: f64 = 1e-6;

/// `true` if a slice of a half thickness holds a distance from its middle: −half < d ≤ half but for
/// round-off, so that exactly one layer of a lattice is drawn.
pub fn slice(distance: f64, half: f64, spacing: f64) -> bool {
    let nudge = NUDGE * spacing;
    distance > nudge - half && distance <= half + nudge
}

/// Reads the thickness of a slice (m).
pub fn thickness(text: &str) -> Result<f64, PlotError> {
    let value = units::parse(text, "m")?;
    if value > 0.0 {
        Ok(value)
    } else {
        Err(PlotError::quantity(
            text,
            "a thickness above zero, as in 0.1mm",
        ))
    }
}

/// `"y = 0.1 mm"`, in a unit that suits the position and the particle spacing.
pub fn position_text(axis: &str, position: f64, spacing: f64) -> String {
    format!("{axis} = {}", quantity(position, spacing))
}

/// `"mirrored at x = 0 and y = 0"`, if there are planes, each as [`position_text`] names it.
pub fn mirrored(planes: impl Iterator<Item = String>) -> Option<String> {
    let planes: Vec<String> = planes.collect();
    (!planes.is_empty()).then(|| format!("mirrored at {}", planes.join(" and ")))
}

/// A length with a unit that suits it and the particle spacing.
pub fn quantity(length: f64, spacing: f64) -> String {
    let unit = Readable::new("m", length.abs().max(spacing));
    let number = unit.number(length, 3);
    let number = number.trim_end_matches('0').trim_end_matches('.');
    if number == "0" {
        number.to_owned()
    } else {
        format!("{number} {}", unit.name)
    }
}
