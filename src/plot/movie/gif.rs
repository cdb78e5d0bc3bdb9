//! Movies as GIF files: one palette for all pictures, so that nothing flickers; of each picture
//! after the first what has changed.

use std::borrow::Cow;
use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use gif::{DisposalMethod, Encoder, Frame, Repeat};

use super::palette::{Palette, Tally};
use crate::plot::PlotError;
use crate::plot::canvas::Canvas;

/// Writes the pictures that `draw` makes, at a number a second. They wait, compressed, until all
/// colours are known.
pub fn write(
    file: impl Write,
    pictures: usize,
    fps: f64,
    mut draw: impl FnMut(usize) -> Result<Canvas, PlotError>,
    failed: impl Fn(String) -> PlotError,
) -> Result<(), PlotError> {
    let unsaved = |e: gif::EncodingError| failed(e.to_string());
    let mut tally = Tally::new();
    let mut waiting = Vec::with_capacity(pictures);
    let mut size = None;
    for k in 0..pictures {
        let picture = draw(k)?.pixels()?;
        let own = [picture.width, picture.height];
        if *size.get_or_insert(own) != own {
            return Err(failed("its pictures differ in size".to_owned()));
        }
        let colours = picture.rgb();
        tally.add(colours.as_chunks::<3>().0);
        waiting.push(pack(&colours).map_err(|e| failed(e.to_string()))?);
    }
    let side =
        |length: u32| u16::try_from(length).map_err(|e| failed(format!("a side of it: {e}")));
    let [width, height] = size.unwrap_or([1, 1]);
    let (width, height) = (side(width)?, side(height)?);

    let palette = Palette::new(&tally);
    let mut encoder = Encoder::new(file, width, height, &palette.table()).map_err(unsaved)?;
    encoder.set_repeat(Repeat::Infinite).map_err(unsaved)?;
    let delay = delay(fps);
    let mut before: Option<Vec<u8>> = None;
    for packed in waiting {
        let colours = unpack(&packed).map_err(|e| failed(e.to_string()))?;
        let indices = palette.indices(colours.as_chunks::<3>().0);
        let part = changed(before.as_deref(), &indices, usize::from(width));
        encoder.write_frame(&frame(&part, delay)).map_err(unsaved)?;
        before = Some(indices);
    }
    encoder
        .into_inner()
        .map(drop)
        .map_err(|e| failed(e.to_string()))
}

/// The part of a picture that is not as before.
struct Part {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
    /// Places in the palette, row by row; what is as before is [`Palette::SAME`].
    indices: Vec<u8>,
}

/// What of a picture differs from the one before.
fn changed(before: Option<&[u8]>, now: &[u8], width: usize) -> Part {
    let height = now.len() / width;
    let Some(before) = before else {
        return Part {
            left: 0,
            top: 0,
            width,
            height,
            indices: now.to_vec(),
        };
    };
    let differs = |k: &usize| now[*k] != before[*k];
    let places = || (0..now.len()).filter(differs);
    // A picture like the one before has a pixel, and its time.
    let (first, last) = (
        places().next().unwrap_or(0),
        places().next_back().unwrap_or(0),
    );
    let (left, right) = places().fold((width, 0), |(left, right), k| {
        (left.min(k % width), right.max(k % width))
    });
    let left = left.min(right);
    let (top, bottom) = (first / width, last / width);
    let mut indices = Vec::with_capacity((right - left + 1) * (bottom - top + 1));
    for row in top..=bottom {
        for k in row * width + left..=row * width + right {
            indices.push(if differs(&k) { now[k] } else { Palette::SAME });
        }
    }
    Part {
        left,
        top,
        width: right - left + 1,
        height: bottom - top + 1,
        indices,
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "parts of a picture whose sides fit"
)]
fn frame(part: &Part, delay: u16) -> Frame<'_> {
    Frame {
        delay,
        dispose: DisposalMethod::Keep,
        transparent: Some(Palette::SAME),
        needs_user_input: false,
        top: part.top as u16,
        left: part.left as u16,
        width: part.width as u16,
        height: part.height as u16,
        interlaced: false,
        palette: None,
        buffer: Cow::Borrowed(&part.indices),
    }
}

/// How long a picture is shown, in hundredths of a second; many viewers know nothing below two.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates"
)]
fn delay(fps: f64) -> u16 {
    (100.0 / fps).round().max(2.0) as u16
}

fn pack(colours: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(colours)?;
    encoder.finish()
}

fn unpack(packed: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut colours = Vec::new();
    ZlibDecoder::new(packed).read_to_end(&mut colours)?;
    Ok(colours)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_has_changed_is_kept() {
        let before = [0; 12];
        let mut now = before;
        now[5] = 3;
        now[10] = 4;
        let part = changed(Some(&before), &now, 4);
        assert_eq!((part.left, part.top, part.width, part.height), (1, 1, 2, 2));
        assert_eq!(part.indices, [3, Palette::SAME, Palette::SAME, 4]);
        let part = changed(Some(&now), &now, 4);
        assert_eq!((part.width, part.height), (1, 1));
        assert_eq!(part.indices, [Palette::SAME]);
    }
}
