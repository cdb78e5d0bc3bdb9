//! Rows as lines of text, made by all threads and written in their order.

use rayon::prelude::*;

use super::ExportError;
use super::column::Column;
use super::frame::Frame;
use super::values::Values;
use files::output::NewFile;

/// Lines that a thread makes at a time.
const LINES: usize = 2048;

/// A column of text, or several of one name.
#[derive(Debug, Clone, Copy)]
pub struct Printed<'a> {
    pub column: &'a Column,
    /// Words for the numbers 0, 1, 2, …, if any.
    pub words: Option<&'a [String]>,
}

impl<'a> Printed<'a> {
    /// A column's own numbers.
    pub fn numbers(column: &'a Column) -> Self {
        Self {
            column,
            words: None,
        }
    }
}

/// The style of lines.
#[derive(Debug, Clone, Copy)]
pub struct Style {
    /// Between values.
    pub separator: u8,
    /// The word for NaN.
    pub nan: &'static str,
}

/// Writes a line for each row of a frame.
pub fn write_lines(
    frame: &Frame,
    columns: &[Printed],
    style: Style,
    out: &mut NewFile,
) -> Result<(), ExportError> {
    for piece in frame.pieces() {
        let read = |printed: &Printed| frame.read(printed.column, &piece);
        let values = columns.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let rows: Vec<usize> = (0..piece.rows.len()).collect();
        let lines = |rows: &[usize]| lines(columns, &values, style, rows);
        let texts: Vec<_> = rows.par_chunks(LINES).map(lines).collect();
        for text in texts {
            match text {
                Ok(text) => out.put(&text)?,
                Err(name) => {
                    return Err(frame.wrong(format!("a {name} that it does not tell of")));
                }
            }
        }
    }
    Ok(())
}

/// The lines of some rows, or the name of a column with a number that has no word.
fn lines<'a>(
    columns: &[Printed<'a>],
    values: &[Values],
    style: Style,
    rows: &[usize],
) -> Result<Vec<u8>, &'a str> {
    let mut text = Vec::with_capacity(rows.len() * columns.len() * 16);
    for row in rows {
        for (printed, values) in columns.iter().zip(values) {
            let width = printed.column.components.len();
            for k in row * width..(row + 1) * width {
                match printed.words {
                    None => values.print(k, style.nan, &mut text),
                    Some(words) => {
                        let word = values.index(k).and_then(|index| words.get(index));
                        let word = word.ok_or(printed.column.name.as_str())?;
                        text.extend_from_slice(word.as_bytes());
                    }
                }
                text.push(style.separator);
            }
        }
        if let Some(last) = text.last_mut() {
            *last = b'\n';
        }
    }
    Ok(text)
}

/// A text without blanks, quotes and characters that are not printed, for formats whose words end
/// at blanks.
pub fn word(text: &str) -> String {
    let sound = |c: char| !(c.is_whitespace() || c.is_control() || "\"'\\=".contains(c));
    let word: String = text
        .chars()
        .map(|c| if sound(c) { c } else { '_' })
        .collect();
    if word.is_empty() {
        "_".to_owned()
    } else {
        word
    }
}

/// A text on one line, without double quotes.
pub fn line(text: &str) -> String {
    let sound = |c: char| !(c.is_control() || "\"\\".contains(c));
    text.chars()
        .map(|c| if sound(c) { c } else { '_' })
        .collect()
}
