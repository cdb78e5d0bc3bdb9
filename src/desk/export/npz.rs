//! `NumPy`'s `.npz`: an array for each field, shaped as in the snapshot, in a ZIP archive of stored entries.
//!
//! Layouts: the module numpy.lib.format (version 1.0), and PKWARE's APPNOTE.TXT 6.3, sections 4.3 and
//! 4.5.3 (sizes beyond 4 GB).

mod zip;

use serde_json::json;

use super::ExportError;
use super::column::Column;
use super::frame::Frame;
use super::values::{IS_LITTLE, Values};
use files::output::NewFile;
use zip::Archive;

/// Writes a snapshot.
pub fn write(frame: &Frame, out: &mut NewFile) -> Result<(), ExportError> {
    let mut archive = Archive::new(out);
    for column in [&frame.position].into_iter().chain(&frame.columns) {
        let (rows, width) = (frame.rows(), column.components.len());
        let shape = if width == 1 {
            format!("({rows},)")
        } else {
            format!("({rows}, {width})")
        };
        let head = head(dtype(column), &shape);
        let size = head.len() as u64 + rows * (width * column.element.bytes()) as u64;
        archive.begin(&format!("{}.npy", column.name), size)?;
        archive.put(&head)?;
        for piece in frame.pieces() {
            archive.put(frame.read(column, &piece)?.bytes())?;
        }
        archive.end()?;
    }
    let entry = |archive: &mut Archive, name: &str, dtype: &str, shape: &str, bytes: &[u8]| {
        let head = head(dtype, shape);
        archive.begin(&format!("{name}.npy"), (head.len() + bytes.len()) as u64)?;
        archive.put(&head)?;
        archive.put(bytes)?;
        archive.end()
    };
    let time = frame.snapshot.time.to_ne_bytes();
    entry(&mut archive, "time", "f8", "()", &time)?;
    let (dtype, bytes) = words(&frame.snapshot.bodies);
    let shape = format!("({},)", frame.snapshot.bodies.len());
    entry(&mut archive, "body_names", &dtype, &shape, &bytes)?;
    let (dtype, bytes) = words(&[about(frame)]);
    entry(&mut archive, "about", &dtype, "()", &bytes)?;
    archive.finish()?;
    Ok(())
}

/// Description of the whole and of each array, as JSON.
fn about(frame: &Frame) -> String {
    let columns = [&frame.position].into_iter().chain(&frame.columns);
    let arrays = columns.map(|column| {
        let entry = json!({
            "unit": column.unit,
            "components": column.components,
            "description": column.description,
        });
        (column.name.clone(), entry)
    });
    let arrays: serde_json::Map<_, _> = arrays.collect();
    let about = json!({
        "title": frame.snapshot.title,
        "time": frame.snapshot.time,
        "step": frame.step,
        "bodies": frame.snapshot.bodies,
        "arrays": arrays,
    });
    about.to_string()
}

/// The head of an array, whose length is a multiple of 64.
fn head(dtype: &str, shape: &str) -> Vec<u8> {
    let order = if IS_LITTLE { '<' } else { '>' };
    let text = format!("{{'descr': '{order}{dtype}', 'fortran_order': False, 'shape': {shape}, }}");
    let length = (10 + text.len() + 1).next_multiple_of(64) - 10;
    let mut head = b"\x93NUMPY\x01\x00".to_vec();
    head.extend(u16::try_from(length).unwrap_or(u16::MAX).to_le_bytes());
    head.extend(text.bytes());
    head.resize(10 + length - 1, b' ');
    head.push(b'\n');
    head
}

fn dtype(column: &Column) -> &'static str {
    match Values::zeros(column.element, 0) {
        Values::F64(_) => "f8",
        Values::F32(_) => "f4",
        Values::I64(_) => "i8",
        Values::U64(_) => "u8",
        Values::U32(_) => "u4",
        Values::U8(_) => "u1",
    }
}

/// Texts as an array of the length of the longest, with its type.
fn words(texts: &[String]) -> (String, Vec<u8>) {
    let lengths = texts.iter().map(|text| text.chars().count());
    let longest = lengths.max().unwrap_or(0).max(1);
    let mut bytes = Vec::new();
    for text in texts {
        let letters = text.chars().map(u32::from).chain(std::iter::repeat(0));
        letters
            .take(longest)
            .for_each(|letter| bytes.extend(letter.to_ne_bytes()));
    }
    (format!("U{longest}"), bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_are_those_of_numpy() {
        let head = head("f8", "(3, 6)");
        assert_eq!(head.len() % 64, 0);
        assert!(head.starts_with(b"\x93NUMPY\x01\x00\x76\x00{'descr': '"));
        assert!(head.ends_with(b" \n"));
    }

    #[test]
    fn texts_have_four_bytes_a_letter() {
        let (dtype, bytes) = words(&["é".to_owned(), "ab".to_owned()]);
        assert_eq!((dtype.as_str(), bytes.len()), ("U2", 16));
        assert_eq!(bytes[..4], u32::from('é').to_ne_bytes());
    }
}
