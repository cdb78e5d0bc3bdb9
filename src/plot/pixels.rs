//! Pixels: what an SVG picture looks like, and PNG files.

use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};

use super::PlotError;
use super::font;

/// Pixels row by row from the top: red, green, blue and alpha, by which the colours are not
/// multiplied.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Four bytes for each.
    pub rgba: Vec<u8>,
}

/// The font inside the program alone, so that pixels are the same on every machine.
static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    fonts.load_font_data(font::FILE.to_vec());
    Arc::new(fonts)
});

impl Pixels {
    /// Those of an SVG picture on opaque paper.
    ///
    /// # Errors
    /// [`PlotError::Size`] if they cannot be held, [`PlotError::Svg`] if it is none.
    pub fn of(svg: &str, [width, height]: [u32; 2]) -> Result<Self, PlotError> {
        let options = Options {
            fontdb: FONTS.clone(),
            font_family: font::NAME.to_owned(),
            ..Options::default()
        };
        let tree = Tree::from_str(svg, &options).map_err(|error| PlotError::Svg {
            reason: error.to_string(),
        })?;
        let pixmap = Pixmap::new(width, height);
        let mut pixmap = pixmap.ok_or(PlotError::Size { width, height })?;
        resvg::render(&tree, Transform::identity(), &mut pixmap.as_mut());
        // On opaque paper nothing is multiplied.
        let rgba = pixmap.take();
        Ok(Self {
            width,
            height,
            rgba,
        })
    }

    /// Red, green and blue of each, without alpha.
    #[must_use]
    pub fn rgb(&self) -> Vec<u8> {
        let pixels = self.rgba.as_chunks::<4>().0.iter();
        pixels.flat_map(|&[r, g, b, _]| [r, g, b]).collect()
    }

    /// A small PNG file without alpha: and without filters, which spoil the repetition of the discs
    /// of a lattice and of blank paper.
    ///
    /// # Errors
    /// The error of the encoder.
    pub fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        self.encode(&self.rgb(), png::ColorType::Rgb, png::Compression::High)
    }

    /// A PNG file with alpha if any pixel has it, made fast.
    ///
    /// # Errors
    /// The error of the encoder.
    pub fn fast_png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let fast = png::Compression::Balanced;
        if self.rgba.chunks_exact(4).all(|p| p[3] == 255) {
            self.encode(&self.rgb(), png::ColorType::Rgb, fast)
        } else {
            self.encode(&self.rgba, png::ColorType::Rgba, fast)
        }
    }

    fn encode(
        &self,
        bytes: &[u8],
        colour: png::ColorType,
        compression: png::Compression,
    ) -> Result<Vec<u8>, png::EncodingError> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width, self.height);
        encoder.set_color(colour);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(compression);
        encoder.set_filter(png::Filter::NoFilter);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(bytes)?;
        writer.finish()?;
        Ok(file)
    }
}
