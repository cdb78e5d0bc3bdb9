//! Movies as GIF files: one palette for all pictures, so that nothing flickers; of each picture
//! after the first what has changed.

use std::borrow::Cow;
use std::io::{Read, Write};
use std::path::Path;

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use gif::{DisposalMethod, Encoder, Frame, Repeat};

use super::palette::{Palette, Tally};
use super::patch::Patch;
use crate::PlotError;
use crate::pixels::Pixels;

/// Writes pictures of one size, at a number a second, into the file that will have a path. They wait,
/// compressed, until all colours are known.
pub fn write(
    file: impl Write,
    path: &Path,
    pictures: impl ExactSizeIterator<Item = Result<Pixels, PlotError>>,
    fps: f64,
) -> Result<(), PlotError> {
    let unsaved = |e: gif::EncodingError| PlotError::unsaved(path, e);
    let refused = |e: std::io::Error| PlotError::unsaved(path, e);
    let mut tally = Tally::new();
    let mut waiting = Vec::with_capacity(pictures.len());
    let mut size = [1, 1];
    for picture in pictures {
        let picture = picture?;
        size = [picture.width, picture.height];
        let colours = picture.rgb();
        tally.add(colours.as_chunks::<3>().0);
        waiting.push(pack(&colours).map_err(refused)?);
    }
    let side = |length: u32| {
        let side = u16::try_from(length);
        side.map_err(|e| PlotError::unsaved(path, format!("a side of it: {e}")))
    };
    let (width, height) = (side(size[0])?, side(size[1])?);

    let palette = Palette::new(&tally);
    let mut encoder = Encoder::new(file, width, height, &palette.table()).map_err(unsaved)?;
    encoder.set_repeat(Repeat::Infinite).map_err(unsaved)?;
    let delay = delay(fps);
    let mut before: Option<Vec<u8>> = None;
    for packed in waiting {
        let colours = unpack(&packed).map_err(refused)?;
        let indices = palette.indices(colours.as_chunks::<3>().0);
        let (patch, own) = changed(before.as_deref(), &indices, usize::from(width));
        let frame = frame(patch, &own, delay);
        encoder.write_frame(&frame).map_err(unsaved)?;
        before = Some(indices);
    }
    encoder.into_inner().map(drop).map_err(unsaved)
}

/// The part of a picture that is not as before, and its places in the palette, row by row; what is as
/// before is [`Palette::SAME`].
fn changed(before: Option<&[u8]>, now: &[u8], width: usize) -> (Patch, Vec<u8>) {
    let Some(before) = before else {
        let whole = Patch {
            left: 0,
            top: 0,
            width,
            height: now.len() / width,
        };
        return (whole, now.to_vec());
    };
    let patch = Patch::changed(before, now, width);
    let index = |k: usize| {
        if now[k] == before[k] {
            Palette::SAME
        } else {
            now[k]
        }
    };
    (patch, patch.indices(width).map(index).collect())
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "parts of a picture whose sides fit"
)]
fn frame(patch: Patch, indices: &[u8], delay: u16) -> Frame<'_> {
    Frame {
        delay,
        dispose: DisposalMethod::Keep,
        transparent: Some(Palette::SAME),
        needs_user_input: false,
        top: patch.top as u16,
        left: patch.left as u16,
        width: patch.width as u16,
        height: patch.height as u16,
        interlaced: false,
        palette: None,
        buffer: Cow::Borrowed(indices),
    }
}

/// The time of a picture, in hundredths of a second; many viewers know nothing below two.
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
        let (patch, indices) = changed(Some(&before), &now, 4);
        assert_eq!(
            (patch.left, patch.top, patch.width, patch.height),
            (1, 1, 2, 2)
        );
        assert_eq!(indices, [3, Palette::SAME, Palette::SAME, 4]);
        let (patch, indices) = changed(Some(&now), &now, 4);
        assert_eq!((patch.width, patch.height), (1, 1));
        assert_eq!(indices, [Palette::SAME]);
    }
}
