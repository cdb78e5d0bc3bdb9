//! Movies as PNG files of several pictures: of each after the first the rectangle that has changed.

use std::io::Write;
use std::path::Path;

use super::patch::Patch;
use crate::PlotError;
use crate::pixels::Pixels;

/// Writes pictures of one size, at a number a second, into the file that will have a path.
pub fn write(
    file: impl Write,
    path: &Path,
    mut pictures: impl ExactSizeIterator<Item = Result<Pixels, PlotError>>,
    fps: f64,
) -> Result<(), PlotError> {
    let unsaved = |e: png::EncodingError| PlotError::unsaved(path, e);
    let count = u32::try_from(pictures.len()).map_err(|e| PlotError::unsaved(path, e))?;
    let Some(first) = pictures.next().transpose()? else {
        return Err(PlotError::unsaved(path, "it has no pictures"));
    };
    let mut encoder = png::Encoder::new(file, first.width, first.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    encoder.set_animated(count, 0).map_err(unsaved)?;
    encoder
        .set_blend_op(png::BlendOp::Source)
        .map_err(unsaved)?;
    encoder
        .set_dispose_op(png::DisposeOp::None)
        .map_err(unsaved)?;
    let (numerator, denominator) = delay(fps);
    encoder
        .set_frame_delay(numerator, denominator)
        .map_err(unsaved)?;
    let mut writer = encoder.write_header().map_err(unsaved)?;
    let width = first.width as usize;
    let mut before = first.rgb();
    writer.write_image_data(&before).map_err(unsaved)?;
    for picture in pictures {
        let now = picture?.rgb();
        let pixels = now.as_chunks::<3>().0;
        let patch = Patch::changed(before.as_chunks().0, pixels, width);
        let colours: Vec<u8> = patch.indices(width).flat_map(|k| pixels[k]).collect();
        set_region(&mut writer, patch).map_err(unsaved)?;
        writer.write_image_data(&colours).map_err(unsaved)?;
        before = now;
    }
    writer.finish().map_err(unsaved)
}

/// Says where the pixels of the next picture go.
#[expect(
    clippy::cast_possible_truncation,
    reason = "parts of a picture whose sides fit"
)]
fn set_region(
    writer: &mut png::Writer<impl Write>,
    patch: Patch,
) -> Result<(), png::EncodingError> {
    // At no time may the frame reach beyond the picture.
    writer.set_frame_position(0, 0)?;
    writer.set_frame_dimension(patch.width as u32, patch.height as u32)?;
    writer.set_frame_position(patch.left as u32, patch.top as u32)
}

/// The time of a picture, as a fraction of seconds.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of 5 × 4 pixels, all of a colour but some.
    fn picture(others: &[u8]) -> Pixels {
        let mut rgba = [10, 20, 30, 255].repeat(20);
        for &k in others {
            rgba[4 * usize::from(k)..][..3].copy_from_slice(&[200, 7 * k, 0]);
        }
        Pixels {
            width: 5,
            height: 4,
            rgba,
        }
    }

    #[test]
    fn parts_make_each_picture_again() {
        let pictures = [
            picture(&[]),
            picture(&[7, 13]),
            picture(&[7, 13]),
            picture(&[19]),
            picture(&[0, 19]),
        ];
        let mut file = Vec::new();
        let all = pictures.iter().cloned().map(Ok);
        write(&mut file, Path::new("movie.apng"), all, 2.0).unwrap();

        let decoder = png::Decoder::new(std::io::Cursor::new(file));
        let mut reader = decoder.read_info().unwrap();
        let mut screen = vec![0; 3 * 20];
        let mut parts = Vec::new();
        for picture in &pictures {
            let mut own = vec![0; 3 * 20];
            let size = reader.next_frame(&mut own).unwrap();
            let control = *reader.info().frame_control().unwrap();
            assert_eq!(control.blend_op, png::BlendOp::Source);
            assert_eq!(control.dispose_op, png::DisposeOp::None);
            assert_eq!((control.width, control.height), (size.width, size.height));
            let patch = [control.x_offset, control.y_offset, size.width, size.height];
            let [left, top, width, height] = patch.map(|length| length as usize);
            for row in 0..height {
                let line = &own[3 * row * width..][..3 * width];
                screen[3 * ((top + row) * 5 + left)..][..3 * width].copy_from_slice(line);
            }
            assert_eq!(screen, picture.rgb());
            parts.push(patch);
        }
        let wanted = [
            [0, 0, 5, 4],
            [2, 1, 2, 2],
            [0, 0, 1, 1],
            [2, 1, 3, 3],
            [0, 0, 1, 1],
        ];
        assert_eq!(parts, wanted);
    }
}
