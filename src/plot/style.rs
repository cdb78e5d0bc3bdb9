//! Lengths that all pictures share, in proportion to their width.

use super::font;
use super::ticks::Ticks;

/// Default width of a picture of one panel (pixels), at which [`Style::unit`] is 1.
pub const WIDTH: u32 = 1200;

/// Default width of a picture of several panels (pixels).
const PANELS_WIDTH: u32 = 1800;

/// Default width of a picture of some panels (pixels).
pub fn default_width(panels: usize) -> u32 {
    if panels > 1 { PANELS_WIDTH } else { WIDTH }
}

/// Lengths of a picture in pixels, all in proportion to its width.
#[derive(Debug, Clone, Copy)]
pub struct Style {
    /// Pixels of one unit of layout; 1 at the default width.
    pub unit: f32,
}

impl Style {
    /// Lengths for a picture of a width that looks as designed at the nominal one; text in small
    /// pictures stays large enough to be read.
    pub fn new(width: u32, nominal: u32) -> Self {
        Self {
            unit: (width as f32 / nominal as f32).max(0.6),
        }
    }

    /// Lengths for a picture of a width with some panels.
    pub fn of(width: u32, panels: usize) -> Self {
        Self::new(width, default_width(panels))
    }

    pub fn title(self) -> f32 {
        26.0 * self.unit
    }

    pub fn text(self) -> f32 {
        20.0 * self.unit
    }

    pub fn small(self) -> f32 {
        18.0 * self.unit
    }

    /// Length of a mark.
    pub fn tick(self) -> f32 {
        7.0 * self.unit
    }

    /// Space between things that belong together.
    pub fn gap(self) -> f32 {
        8.0 * self.unit
    }

    /// Space between panels: half a number on either side, and some.
    pub fn between(self) -> f32 {
        40.0 * self.unit
    }

    /// Blank border of the picture.
    pub fn margin(self) -> f32 {
        22.0 * self.unit
    }

    /// Width of axis lines.
    pub fn line(self) -> f32 {
        (1.5 * self.unit).max(1.0)
    }

    /// Height of what hangs below a frame: marks, numbers, label.
    pub fn below(self) -> f32 {
        self.tick() + self.small() + self.text() + 3.0 * self.gap()
    }

    /// Height of the marks below frames without axes: the directions of the model's axes, and a
    /// length.
    pub fn beneath(self) -> f32 {
        104.0 * self.unit
    }

    /// Width left of a frame with these numbers: label, numbers, marks.
    pub fn beside(self, ticks: &Ticks) -> f32 {
        self.tick() + self.widest(ticks) + self.text() + 3.0 * self.gap()
    }

    /// Width of the widest number of an axis.
    pub fn widest(self, ticks: &Ticks) -> f32 {
        let widths = ticks.labels.iter().map(|l| font::width(l, self.small()));
        widths.fold(0.0, f32::max)
    }
}

/// A height as a number of pixels.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates; the canvas refuses what it cannot hold"
)]
pub fn whole(height: f32) -> u32 {
    height.ceil() as u32
}
