//! Pixels: discs, lines and text on white paper. Positions are pixels from the upper left corner.

use std::path::Path;

use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, PremultipliedColorU8, Rect,
    Stroke, Transform,
};

use super::PlotError;
use super::font;

/// A colour: red, green, blue.
pub type Rgb = [u8; 3];

/// Colour of text and axes.
pub const INK: Rgb = [32, 32, 32];

/// Colour of the paper.
pub const PAPER: Rgb = [255, 255, 255];

/// A rectangle of the picture (pixels).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    pub left: f32,
    pub top: f32,
    pub width: f32,
    pub height: f32,
}

impl Frame {
    pub fn right(&self) -> f32 {
        self.left + self.width
    }

    pub fn bottom(&self) -> f32 {
        self.top + self.height
    }
}

/// Which point of a line of text its position names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    Start,
    Middle,
    End,
}

/// A picture while it is drawn.
pub struct Canvas {
    pixmap: Pixmap,
}

impl Canvas {
    /// White paper of a size in pixels.
    ///
    /// # Errors
    /// [`PlotError::Size`] if it cannot be held.
    pub fn new(width: u32, height: u32) -> Result<Self, PlotError> {
        Self::fits(width, height)?;
        let mut pixmap = Pixmap::new(width, height).ok_or(PlotError::Size { width, height })?;
        pixmap.fill(Color::WHITE);
        Ok(Self { pixmap })
    }

    /// Whether paper of a size in pixels can be held: no more than 2³¹ bytes of it.
    ///
    /// # Errors
    /// [`PlotError::Size`] if not.
    pub fn fits(width: u32, height: u32) -> Result<(), PlotError> {
        let pixels = u64::from(width) * u64::from(height);
        if pixels > 0 && pixels <= 1 << 29 {
            Ok(())
        } else {
            Err(PlotError::Size { width, height })
        }
    }

    /// A filled disc with smooth edges, cut at the borders of `clip`.
    ///
    /// A pixel's cover is taken from its centre's distance to the edge, or for small discs from
    /// a grid of samples: exact enough for the eye, and far faster than a general path.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "bounds are clamped to the picture first"
    )]
    pub fn disc(&mut self, centre: (f32, f32), radius: f32, colour: Rgb, clip: &Frame) {
        let reach = radius + 0.5;
        let columns = self.pixmap.width() as usize;
        let range = |middle: f32, low: f32, high: f32, size: u32| {
            let (low, high) = (low.max(0.0), high.min(size as f32));
            let first = (middle - reach).clamp(low, high).floor() as usize;
            first..(middle + reach).clamp(low, high).ceil() as usize
        };
        let xs = range(centre.0, clip.left, clip.right(), self.pixmap.width());
        let ys = range(centre.1, clip.top, clip.bottom(), self.pixmap.height());
        let pixels = self.pixmap.pixels_mut();
        for y in ys {
            let dy = y as f32 + 0.5 - centre.1;
            for x in xs.clone() {
                let dx = x as f32 + 0.5 - centre.0;
                let cover = if radius < 3.0 {
                    sampled_cover(dx, dy, radius)
                } else {
                    (reach - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0)
                };
                if cover > 0.0 {
                    blend(&mut pixels[y * columns + x], colour, cover);
                }
            }
        }
    }

    /// A filled rectangle.
    pub fn fill(&mut self, frame: &Frame, colour: Rgb) {
        if let Some(rect) = Rect::from_xywh(frame.left, frame.top, frame.width, frame.height) {
            self.pixmap
                .fill_rect(rect, &paint(colour), Transform::identity(), None);
        }
    }

    /// The pixels of a frame, row by row; those beyond the picture are left out.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "frames are whole pixels, and a float cast saturates"
    )]
    pub fn image(&mut self, frame: &Frame, colours: &[Rgb]) {
        let columns = self.pixmap.width() as usize;
        let (left, width) = (frame.left as usize, frame.width as usize);
        let room = columns.saturating_sub(left).min(width);
        let rows = self.pixmap.pixels_mut().chunks_mut(columns);
        let rows = rows.skip(frame.top as usize);
        for (row, colours) in rows.zip(colours.chunks(width.max(1))) {
            for (pixel, &colour) in row[left.min(columns)..].iter_mut().zip(&colours[..room]) {
                *pixel = opaque(colour);
            }
        }
    }

    /// A filled polygon.
    pub fn polygon(&mut self, corners: &[(f32, f32)], colour: Rgb) {
        let mut path = PathBuilder::new();
        for (k, &(x, y)) in corners.iter().enumerate() {
            if k == 0 {
                path.move_to(x, y);
            } else {
                path.line_to(x, y);
            }
        }
        path.close();
        if let Some(path) = path.finish() {
            self.pixmap.fill_path(
                &path,
                &paint(colour),
                FillRule::Winding,
                Transform::identity(),
                None,
            );
        }
    }

    /// A line through points.
    pub fn line(&mut self, points: &[(f32, f32)], width: f32, colour: Rgb) {
        let mut path = PathBuilder::new();
        for (k, &(x, y)) in points.iter().enumerate() {
            if k == 0 {
                path.move_to(x, y);
            } else {
                path.line_to(x, y);
            }
        }
        let stroke = Stroke {
            width,
            line_cap: LineCap::Butt,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        if let Some(path) = path.finish() {
            self.pixmap
                .stroke_path(&path, &paint(colour), &stroke, Transform::identity(), None);
        }
    }

    /// Blank paper around a frame: what was drawn beyond it goes.
    pub fn clear_around(&mut self, frame: &Frame) {
        let (width, height) = (self.pixmap.width() as f32, self.pixmap.height() as f32);
        let band = |left, top, width, height| Frame {
            left,
            top,
            width,
            height,
        };
        for band in [
            band(0.0, 0.0, width, frame.top),
            band(0.0, frame.bottom(), width, height - frame.bottom()),
            band(0.0, 0.0, frame.left, height),
            band(frame.right(), 0.0, width - frame.right(), height),
        ] {
            self.fill(&band, PAPER);
        }
    }

    /// The four sides of a frame.
    pub fn border(&mut self, frame: &Frame, width: f32, colour: Rgb) {
        let (left, right) = (frame.left, frame.right());
        let (top, bottom) = (frame.top, frame.bottom());
        let half = 0.5 * width;
        self.line(&[(left - half, top), (right + half, top)], width, colour);
        self.line(
            &[(left - half, bottom), (right + half, bottom)],
            width,
            colour,
        );
        self.line(&[(left, top), (left, bottom)], width, colour);
        self.line(&[(right, top), (right, bottom)], width, colour);
    }

    /// A line of text with its baseline at `at`.
    pub fn text(&mut self, text: &str, at: (f32, f32), size: f32, align: Align) {
        let shift = shift(text, size, align);
        self.glyphs(text, size, Transform::from_translate(at.0 + shift, at.1));
    }

    /// A line of text that runs upwards, with its baseline at `at`.
    pub fn text_upwards(&mut self, text: &str, at: (f32, f32), size: f32, align: Align) {
        let shift = shift(text, size, align);
        let turned = Transform::from_row(0.0, -1.0, 1.0, 0.0, at.0, at.1 - shift);
        self.glyphs(text, size, turned);
    }

    fn glyphs(&mut self, text: &str, size: f32, place: Transform) {
        if let Some(path) = font::outline(text, size) {
            self.pixmap
                .fill_path(&path, &paint(INK), FillRule::Winding, place, None);
        }
    }

    /// The picture as a PNG: without the opaque alpha, and without filters, which spoil the
    /// repetition that discs of a lattice and blank paper are made of.
    fn encode(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.pixmap.width(), self.pixmap.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder.set_filter(png::Filter::NoFilter);
        let pixels = self.pixmap.pixels().iter();
        let colours: Vec<u8> = pixels
            .flat_map(|p| [p.red(), p.green(), p.blue()])
            .collect();
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&colours)?;
        writer.finish()?;
        Ok(bytes)
    }

    /// The picture as the bytes of a PNG file.
    ///
    /// # Errors
    /// [`PlotError::Encode`] if there is no memory for it.
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        self.encode().map_err(|e| PlotError::Encode(e.to_string()))
    }

    /// Writes the picture as a PNG file.
    ///
    /// # Errors
    /// [`PlotError::Save`] if the system refuses.
    pub fn save(&self, path: &Path) -> Result<(), PlotError> {
        let failed = |reason: String| PlotError::Save {
            path: path.to_owned(),
            reason,
        };
        let bytes = self.encode().map_err(|e| failed(e.to_string()))?;
        std::fs::write(path, bytes).map_err(|e| failed(e.to_string()))
    }
}

/// The share of a pixel within a disc, from 4 × 4 samples; the pixel's centre lies at (dx, dy)
/// from the disc's.
fn sampled_cover(dx: f32, dy: f32, radius: f32) -> f32 {
    let offsets = [-0.375, -0.125, 0.125, 0.375];
    let inside = |x: f32, y: f32| x * x + y * y <= radius * radius;
    let samples = offsets
        .iter()
        .flat_map(|v| offsets.map(|u| inside(dx + u, dy + v)));
    samples.filter(|&hit| hit).count() as f32 / 16.0
}

/// How far left of its position a line of text begins.
fn shift(text: &str, size: f32, align: Align) -> f32 {
    match align {
        Align::Start => 0.0,
        Align::Middle => -0.5 * font::width(text, size),
        Align::End => -font::width(text, size),
    }
}

fn paint(colour: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(colour[0], colour[1], colour[2], 255);
    paint
}

/// Lays a colour over an opaque pixel.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a mean of two bytes is a byte"
)]
fn blend(pixel: &mut PremultipliedColorU8, colour: Rgb, cover: f32) {
    let mix =
        |old: u8, new: u8| (f32::from(old) * (1.0 - cover) + f32::from(new) * cover).round() as u8;
    *pixel = opaque([
        mix(pixel.red(), colour[0]),
        mix(pixel.green(), colour[1]),
        mix(pixel.blue(), colour[2]),
    ]);
}

/// A colour as a pixel holds it.
fn opaque([red, green, blue]: Rgb) -> PremultipliedColorU8 {
    PremultipliedColorU8::from_rgba(red, green, blue, 255)
        .expect("an opaque colour is premultiplied")
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLIP: Frame = Frame {
        left: 0.0,
        top: 0.0,
        width: 40.0,
        height: 40.0,
    };

    #[test]
    fn a_disc_covers_its_area() {
        for radius in [0.4_f32, 1.0, 3.3, 10.0] {
            let mut canvas = Canvas::new(40, 40).unwrap();
            canvas.disc((20.3, 19.8), radius, [0, 0, 0], &CLIP);
            let ink: f32 = canvas
                .pixmap
                .pixels()
                .iter()
                .map(|p| 1.0 - f32::from(p.red()) / 255.0)
                .sum();
            let area = std::f32::consts::PI * radius * radius;
            // 8 of 16 samples fall into the smallest; larger discs are better, and the cover by
            // distance adds π/12 pixels.
            let bound = 0.3 / area;
            assert!((ink / area - 1.0).abs() < bound, "{radius}: {ink} {area}");
        }
    }

    #[test]
    fn a_disc_stays_inside_its_clip() {
        let mut canvas = Canvas::new(40, 40).unwrap();
        let clip = Frame {
            left: 10.0,
            width: 10.0,
            ..CLIP
        };
        canvas.disc((10.0, 20.0), 5.0, [0, 0, 0], &clip);
        canvas.disc((-50.0, 20.0), 5.0, [0, 0, 0], &clip);
        let red = |x, y| canvas.pixmap.pixel(x, y).unwrap().red();
        assert_eq!(red(9, 20), 255);
        assert_eq!(red(10, 20), 0);
    }
}
