//! Movies as PNG files of several pictures.

use std::io::Write;

use crate::plot::PlotError;
use crate::plot::canvas::Canvas;

/// Writes the pictures that `draw` makes, at a number a second.
pub fn write(
    file: impl Write,
    pictures: usize,
    fps: f64,
    mut draw: impl FnMut(usize) -> Result<Canvas, PlotError>,
    failed: impl Fn(String) -> PlotError,
) -> Result<(), PlotError> {
    let unsaved = |e: png::EncodingError| failed(e.to_string());
    let first = draw(0)?.pixels()?;
    let (width, height) = (first.width, first.height);
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let count = u32::try_from(pictures).map_err(|e| failed(e.to_string()))?;
    encoder.set_animated(count, 0).map_err(unsaved)?;
    let (numerator, denominator) = delay(fps);
    encoder
        .set_frame_delay(numerator, denominator)
        .map_err(unsaved)?;
    let mut writer = encoder.write_header().map_err(unsaved)?;
    writer.write_image_data(&first.rgb()).map_err(unsaved)?;
    for k in 1..pictures {
        let picture = draw(k)?.pixels()?;
        if (picture.width, picture.height) != (width, height) {
            return Err(failed("its pictures differ in size".to_owned()));
        }
        writer.write_image_data(&picture.rgb()).map_err(unsaved)?;
    }
    writer.finish().map_err(unsaved)
}

/// How long a picture is shown, as a fraction of seconds.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates"
)]
fn delay(fps: f64) -> (u16, u16) {
    if fps >= 1.0 && fps.fract() == 0.0 {
        (1, fps as u16)
    } else {
        ((1000.0 / fps).round().max(1.0) as u16, 1000)
    }
}
