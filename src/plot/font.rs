//! The one font that is part of the program: no system fonts are needed.

use std::sync::LazyLock;

use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

use model::readable::one_line;

/// The cut-down font that `font/README.md` describes.
pub const FILE: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");

/// Its name.
pub const NAME: &str = "DejaVu Sans";

/// It, and what others may have in its place: fonts of the same widths, nearly, come first.
pub const FAMILIES: &str = "DejaVu Sans, Bitstream Vera Sans, Verdana, sans-serif";

static FONT: LazyLock<FontRef<'static>> =
    LazyLock::new(|| FontRef::new(FILE).expect("the font inside the program is whole"));

/// Width of a line of text of a size in pixels (pixels).
pub fn width(text: &str, size: f32) -> f32 {
    let metrics = FONT.glyph_metrics(Size::new(size), LocationRef::default());
    let glyphs = FONT.charmap();
    // Unknown characters are drawn as an empty box.
    let glyph = |c: char| glyphs.map(c).unwrap_or_default();
    let advance = |c: char| metrics.advance_width(glyph(c)).unwrap_or(0.0);
    one_line(text).chars().map(advance).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn has_the_signs_that_units_and_titles_need() {
        for c in "aZ09µΔρσ·×−²³⁻⁶°…éüßñ".chars() {
            assert!(FONT.charmap().map(c).is_some(), "{c} is missing");
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
