//! Lines of numbers and words, as meshes are written in.

use std::borrow::Cow;

/// A text of bytes; those that are no UTF-8, as in comments of old, stand for nothing.
pub fn of(bytes: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

/// Text of a fault in a line, whose number counts from zero.
pub fn at(line: usize, what: impl AsRef<str>) -> String {
    format!("line {}: {}", line + 1, what.as_ref())
}

/// A number; Fortran's exponents are `d` as well.
///
/// # Errors
/// If it is none, or is not finite.
pub fn number(word: &str) -> Result<f64, String> {
    let word = word.trim();
    let plain = word.parse::<f64>();
    let value = plain.or_else(|_| word.replace(['d', 'D'], "e").parse::<f64>());
    match value {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("`{}` is no number", shortened(word))),
    }
}

/// A whole number above zero, as nodes and elements have.
///
/// # Errors
/// If it is none.
pub fn id(word: &str) -> Result<u64, String> {
    match word.trim().parse::<u64>() {
        Ok(id) if id > 0 => Ok(id),
        _ => Err(format!(
            "`{}` is no number of a node or an element",
            shortened(word.trim())
        )),
    }
}

/// A word as it can stand in a message.
pub fn shortened(word: &str) -> String {
    let short: String = word.chars().take(40).collect();
    if short.len() < word.len() {
        short + "…"
    } else {
        short
    }
}

/// Words of a text with the numbers of their lines.
pub struct Words<'t> {
    lines: std::iter::Enumerate<std::str::Lines<'t>>,
    in_line: std::str::SplitWhitespace<'t>,
    line: usize,
}

impl<'t> Words<'t> {
    /// All words of a text.
    pub fn of(text: &'t str) -> Self {
        Self {
            lines: text.lines().enumerate(),
            in_line: "".split_whitespace(),
            line: 0,
        }
    }

    /// Leaves the rest of the line, and gives the next one that is not blank.
    pub fn line(&mut self) -> Option<&'t str> {
        for (line, text) in self.lines.by_ref() {
            self.line = line;
            self.in_line = "".split_whitespace();
            if !text.trim().is_empty() {
                return Some(text.trim());
            }
        }
        None
    }

    /// The next word, in this line or a later one.
    ///
    /// # Errors
    /// At the end of the text.
    pub fn next(&mut self) -> Result<&'t str, String> {
        loop {
            if let Some(word) = self.in_line.next() {
                return Ok(word);
            }
            let Some((line, text)) = self.lines.next() else {
                return Err(self.wrong("the file ends too early"));
            };
            (self.line, self.in_line) = (line, text.split_whitespace());
        }
    }

    /// The rest of the line.
    pub fn rest(&mut self) -> String {
        let words = std::mem::replace(&mut self.in_line, "".split_whitespace());
        words.collect::<Vec<_>>().join(" ")
    }

    /// The next word as a number.
    ///
    /// # Errors
    /// If it is none.
    pub fn number(&mut self) -> Result<f64, String> {
        let word = self.next()?;
        number(word).map_err(|what| self.wrong(what))
    }

    /// The next word as a whole number above zero.
    ///
    /// # Errors
    /// If it is none.
    pub fn id(&mut self) -> Result<u64, String> {
        let word = self.next()?;
        id(word).map_err(|what| self.wrong(what))
    }

    /// The next word as a whole number of things, no more than the rest of the file could hold.
    ///
    /// # Errors
    /// If it is none, or too large.
    pub fn count(&mut self) -> Result<usize, String> {
        let word = self.next()?;
        match word.parse::<usize>() {
            Ok(count) if count <= super::MOST => Ok(count),
            _ => Err(self.wrong(format!("`{}` is no number of things", shortened(word)))),
        }
    }

    /// The next word as a whole number.
    ///
    /// # Errors
    /// If it is none.
    pub fn whole(&mut self) -> Result<i64, String> {
        let word = self.next()?;
        word.parse::<i64>()
            .map_err(|_| self.wrong(format!("`{}` is no whole number", shortened(word))))
    }

    /// Text of a fault here.
    pub fn wrong(&self, what: impl AsRef<str>) -> String {
        at(self.line, what)
    }
}
