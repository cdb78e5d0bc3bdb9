//! The part of its plane that a picture shows.

use crate::PlotError;
use crate::units::{self, Readable};

/// Width of a drawn view over its height, at least, and height over width.
const NARROWEST: f64 = 0.45;
const FLATTEST: f64 = 0.2;

/// Share of a length that is nothing but rounding.
const ROUNDING: f64 = 1e-9;

/// A part of the section's plane (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Left and right.
    pub x: [f64; 2],
    /// Bottom and top.
    pub y: [f64; 2],
}

impl View {
    /// Reads `LEFT:RIGHT,BOTTOM:TOP`; numbers without a unit take the last one's.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] for anything else.
    pub fn parse(text: &str) -> Result<Self, PlotError> {
        let (x, y) = text.split_once(',').ok_or_else(|| {
            PlotError::quantity(text, "a view LEFT:RIGHT,BOTTOM:TOP, as in -1:1,0:2mm")
        })?;
        let unit = units::unit_behind(y.rsplit(':').next().unwrap_or_default());
        Ok(Self {
            x: units::parse_span(x, Some(unit), "m")?,
            y: units::parse_span(y, None, "m")?,
        })
    }

    /// `true` if a disc reaches into it.
    pub fn shows(&self, at: [f64; 2], radii: [f64; 2]) -> bool {
        let within =
            |k: usize, span: [f64; 2]| at[k] + radii[k] > span[0] && at[k] - radii[k] < span[1];
        within(0, self.x) && within(1, self.y)
    }

    pub fn width(&self) -> f64 {
        self.x[1] - self.x[0]
    }

    pub fn height(&self) -> f64 {
        self.y[1] - self.y[0]
    }

    /// The view as pictures draw it: widened about its middle until neither side is a thin strip.
    pub fn drawn(self) -> Self {
        let grow = |span: [f64; 2], least: f64| {
            let lack = least - (span[1] - span[0]);
            // A view that has been widened is not widened again by the rest of rounding.
            if lack <= ROUNDING * least {
                return span;
            }
            [span[0] - 0.5 * lack, span[1] + 0.5 * lack]
        };
        Self {
            x: grow(self.x, NARROWEST * self.height()),
            y: grow(self.y, FLATTEST * self.width()),
        }
    }

    /// Ends of both axes in a unit.
    pub fn in_unit(&self, unit: &Readable) -> [[f64; 2]; 2] {
        [self.x, self.y].map(|span| span.map(|v| v / unit.size))
    }

    /// Largest distance from the origin along either axis (m).
    pub fn reach(&self) -> f64 {
        let ends = self.x.into_iter().chain(self.y);
        ends.fold(0.0, |reach, end| end.abs().max(reach))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_is_widened_once() {
        for (x, y) in [
            ([0.1, 0.1001], [-3.0, 7.7]),
            ([-1e-3, 0.3], [0.2, 0.2]),
            ([-1.0, 1.0], [0.0, 1.0]),
        ] {
            let view = View { x, y }.drawn();
            assert!(view.width() >= 0.449_999 * view.height());
            assert!(view.height() >= 0.199_999 * view.width());
            assert_eq!(view.drawn(), view);
        }
        let wide = View {
            x: [-1.0, 1.0],
            y: [0.0, 1.0],
        };
        assert_eq!(wide.drawn(), wide);
    }
}
