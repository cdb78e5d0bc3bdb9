//! A rectangle of the picture and its colours. Positions are pixels from the upper left corner.

/// A colour: red, green, blue.
pub type Rgb = [u8; 3];

/// A rectangle of the picture (pixels).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    pub left: f32,
    pub top: f32,
    pub width: f32,
    pub height: f32,
}

impl Frame {
    /// The whole of every picture.
    pub const PAGE: Self = Self {
        left: 0.0,
        top: 0.0,
        width: f32::MAX,
        height: f32::MAX,
    };

    pub fn right(&self) -> f32 {
        self.left + self.width
    }

    pub fn bottom(&self) -> f32 {
        self.top + self.height
    }

    /// Columns and rows of a frame of whole pixels, one at least.
    pub fn pixels(&self) -> [usize; 2] {
        [self.width, self.height].map(whole)
    }

    /// The same with room on all sides.
    pub fn grown(&self, by: f32) -> Self {
        Self {
            left: self.left - by,
            top: self.top - by,
            width: self.width + 2.0 * by,
            height: self.height + 2.0 * by,
        }
    }
}

/// A length as a number of pixels, one at least.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates"
)]
pub fn whole(length: f32) -> usize {
    (length.round() as usize).max(1)
}
