//! Text of SESAME files: the numbers of one record.
//!
//! Two layouts are in use, both in columns of a fixed width, five numbers a line. That of Los Alamos begins each record with a
//! line of index, material, record, count of numbers, and a letter (Lyon & Johnson 1992, LA-UR-92-3407);
//! numbers are 15 or 22 characters wide, and flags may follow the fifth. That which programs for ANEOS write begins
//! a record with `RECORD TYPE = 301 NWDS = …`, and its numbers are 16 characters wide.
//!
//! A record 301 has the numbers of densities and temperatures, the densities (g/cm³), the temperatures (K), and then for each
//! temperature, and for each density at it, the pressures (`GPa`), likewise the specific energies (MJ/kg), and often
//! the free energies.

/// Numbers of a line.
const A_LINE: usize = 5;
/// Characters of a line of a comment, records 101 to 199.
const COMMENT_LINE: usize = 80;
/// The record that is read: states of the whole matter.
const STATES: u32 = 301;

/// The first line of a record.
struct Head {
    material: u32,
    record: u32,
    count: usize,
    /// Width of its numbers, or none where the lines tell it.
    width: Option<usize>,
}

impl Head {
    /// Of a line, or none where it begins no record.
    fn of(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_ascii_whitespace().take(8).collect();
        if let [what, "TYPE", "=", record, "NWDS", "=", count, ..] = words[..] {
            return (what == "RECORD").then_some(Self {
                material: 0,
                record: record.parse().ok()?,
                count: count.parse().ok()?,
                width: Some(16),
            });
        }
        if let ["INDEX", "MATID", "=", _, "NWDS", "=", count, ..] = words[..] {
            return Some(Self {
                material: 0,
                record: 0,
                count: count.parse().ok()?,
                width: Some(16),
            });
        }
        let [index, material, record, count, letter, ..] = words[..] else {
            return None;
        };
        (matches!(index, "0" | "1") && letter.starts_with(|c: char| c.is_ascii_alphabetic()))
            .then_some(Self {
                material: material.parse().ok()?,
                record: record.parse().ok()?,
                count: count.parse().ok()?,
                width: None,
            })
    }

    fn lines(&self) -> usize {
        match self.record {
            101..=199 => self.count.div_ceil(COMMENT_LINE),
            _ => self.count.div_ceil(A_LINE),
        }
    }
}

/// The numbers of the record 301 of a file, or none where the text is no SESAME file.
///
/// # Errors
/// The fault, in words: no such record, or one of each of several materials, or one that is cut off.
pub(super) fn states(text: &str) -> Result<Option<Vec<f64>>, String> {
    let lines: Vec<&str> = text.lines().collect();
    let Some(mut at) = lines.iter().position(|line| !line.trim().is_empty()) else {
        return Ok(None);
    };
    if Head::of(lines[at]).is_none() {
        return Ok(None);
    }
    let mut found: Option<(u32, Vec<f64>)> = None;
    while let Some(head) = lines.get(at).and_then(|line| Head::of(line)) {
        let (first, last) = (at + 1, at.saturating_add(1).saturating_add(head.lines()));
        if last > lines.len() {
            return Err(format!(
                "line {}: the file ends before the {} numbers of record {}",
                at + 1,
                head.count,
                head.record
            ));
        }
        if head.record == STATES {
            if let Some((other, _)) = found {
                return Err(format!(
                    "it holds the materials {other} and {}: a file is to hold one",
                    head.material
                ));
            }
            found = Some((head.material, numbers(&lines[first..last], first, &head)?));
        }
        at = last;
    }
    match found {
        Some((_, numbers)) => Ok(Some(numbers)),
        None => Err(format!(
            "line {}: it has no record {STATES} before this line",
            at + 1
        )),
    }
}

/// Numbers of the lines of a record; the first is that after `before` others.
fn numbers(lines: &[&str], before: usize, head: &Head) -> Result<Vec<f64>, String> {
    let long = lines[0].trim_end().len() > A_LINE * 16;
    let width = head.width.unwrap_or(if long { 22 } else { 15 });
    let mut numbers = Vec::with_capacity(head.count.min(lines.len() * A_LINE));
    for (n, line) in lines.iter().enumerate() {
        let wanted = A_LINE.min(head.count - n * A_LINE);
        for word in 0..wanted {
            let last = line.len().min((word + 1) * width);
            let word = line.get(word * width..last).unwrap_or("").trim();
            let number = number(word).filter(|number| number.is_finite());
            numbers.push(number.ok_or_else(|| {
                format!(
                    "line {}: `{}` is no number",
                    before + n + 1,
                    super::table::shortened(word)
                )
            })?);
        }
    }
    Ok(numbers)
}

/// A number of Fortran, which leaves out the letter before an exponent of three digits, and may write `D`.
fn number(word: &str) -> Option<f64> {
    if let Ok(number) = word.parse() {
        return Some(number);
    }
    let sign = word.rfind(['+', '-']).filter(|sign| *sign > 0)?;
    let (digits, exponent) = word.split_at(sign);
    let digits = digits.trim_end_matches(['d', 'D', 'e', 'E']);
    format!("{digits}e{exponent}").parse().ok()
}
