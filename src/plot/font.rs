//! Text from the one font that is part of the program: no system fonts are needed.

use std::sync::LazyLock;

use tiny_skia::{Path, PathBuilder};
use ttf_parser::{Face, OutlineBuilder};

/// The cut-down font that `font/README.md` describes.
static FONT: LazyLock<Face<'static>> = LazyLock::new(|| {
    Face::parse(include_bytes!("font/DejaVuSans-subset.ttf"), 0)
        .expect("the font inside the program is whole")
});

/// Width of a line of text of a size in pixels (pixels).
pub fn width(text: &str, size: f32) -> f32 {
    text.chars().map(|c| advance(c) * scale(size)).sum()
}

/// Outline of a line of text that starts at the origin with its baseline on y = 0, y downwards;
/// `None` for blanks.
pub fn outline(text: &str, size: f32) -> Option<Path> {
    let mut pen = Pen {
        path: PathBuilder::new(),
        x: 0.0,
        scale: scale(size),
    };
    for c in text.chars() {
        FONT.outline_glyph(FONT.glyph_index(c).unwrap_or_default(), &mut pen);
        pen.x += advance(c) * pen.scale;
    }
    pen.path.finish()
}

/// Pixels for one unit of the font.
fn scale(size: f32) -> f32 {
    size / f32::from(FONT.units_per_em())
}

/// Width of a character in units of the font; unknown characters are drawn as an empty box.
fn advance(c: char) -> f32 {
    let glyph = FONT.glyph_index(c).unwrap_or_default();
    f32::from(FONT.glyph_hor_advance(glyph).unwrap_or(0))
}

/// Carries glyph outlines (y upwards) into a path.
struct Pen {
    path: PathBuilder,
    x: f32,
    scale: f32,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> (f32, f32) {
        (self.x + x * self.scale, -y * self.scale)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.place(x1, y1), self.place(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2)) = (self.place(x1, y1), self.place(x2, y2));
        let (x, y) = self.place(x, y);
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn has_the_signs_that_units_and_titles_need() {
        for c in "aZ09µΔρσ·×−²³⁻⁶°…éüßñ".chars() {
            assert!(FONT.glyph_index(c).is_some(), "{c} is missing");
        }
    }

    #[test]
    fn width_grows_with_size_and_text() {
        let one = width("0", 10.0);
        // 1303 of 2048 units: the width of a digit of DejaVu Sans.
        assert!((one - 10.0 * 1303.0 / 2048.0).abs() < 1e-4);
        assert!((width("00", 20.0) - 4.0 * one).abs() < 1e-4);
    }
}
