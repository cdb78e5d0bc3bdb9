//! Text and overrides → typed tables, and the text that stands for both.

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, Error};

use super::overrides::{Override, modernise};
use super::schema::CaseParams;
use super::source::Diagnostic;
use model::readable::short;

/// Reads the document with its overrides, which begin at `places` in the address space. Returns
/// the tables and the resolved text, from which the same tables can be read without overrides.
pub fn read(
    text: &str,
    overrides: &[String],
    places: &[usize],
) -> Result<(CaseParams, String), Diagnostic> {
    let document = laid(text, overrides, places)?;
    let resolved = if overrides.is_empty() {
        text.to_owned()
    } else {
        resolve(document.clone(), overrides)?
    };
    let params = CaseParams::deserialize(toml::Deserializer::from(document));
    Ok((params.map_err(|e| translate(&e))?, resolved))
}

/// The document with its overrides laid over it.
pub fn laid<'t>(
    text: &'t str,
    overrides: &'t [String],
    places: &[usize],
) -> Result<Spanned<DeTable<'t>>, Diagnostic> {
    let mut document = DeTable::parse(text).map_err(|e| translate(&e))?;
    modernise(document.get_mut());
    for (text, &start) in overrides.iter().zip(places) {
        Override::parse(text, start)?.apply(document.get_mut())?;
    }
    Ok(document)
}

/// The document as text, headed by the overrides in it.
fn resolve(document: Spanned<DeTable<'_>>, overrides: &[String]) -> Result<String, Diagnostic> {
    let lines = overrides.iter().flat_map(|text| text.lines());
    // Comments hold no control characters but tabs.
    let bare = |c: char| c.is_control() && c != '\t';
    let line = |line: &str| format!("#   --set {}\n", line.replace(bare, " "));
    let head: Vec<String> = lines.map(line).collect();
    let table =
        toml::Table::deserialize(toml::Deserializer::from(document)).map_err(|e| translate(&e))?;
    let text = toml::to_string(&table).map_err(|e| Diagnostic::new(0..0, e.to_string()))?;
    let head = head.concat();
    Ok(format!(
        "# the case with its overrides laid over it:\n{head}{text}"
    ))
}

/// A diagnostic of the TOML reader or of a derived `Deserialize`, in our words.
fn translate(error: &Error) -> Diagnostic {
    let span = error.span().unwrap_or(0..0);
    let message = error.message();
    let words: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    if let [found, known @ ..] = words.as_slice() {
        let known = || known.iter().copied();
        if message.starts_with("unknown field") {
            return Diagnostic::unknown(span, "key", found, known());
        }
        if message.starts_with("unknown variant") {
            return Diagnostic::unknown(span, "choice", found, known());
        }
        if message.starts_with("missing field") {
            return missing(span, found);
        }
    }
    if let Some(types) = message.strip_prefix("invalid type: ") {
        let (found, expected) = types
            .split_once(", expected ")
            .unwrap_or((types, "another"));
        let [found, expected] = [plain_type(found), plain_type(expected)];
        if let Some(number) = found.strip_suffix(" as i128") {
            let digits = number.trim_matches(|c: char| !c.is_ascii_digit() && c != '-');
            let number = digits.parse().map_or_else(|_| number.to_owned(), short);
            let title = format!("expected {expected}, found {number}, which is too large");
            return Diagnostic::new(span, title);
        }
        return Diagnostic::new(span, format!("expected {expected}, found {found}"));
    }
    // What the reader says where one of several words is wanted.
    if message.starts_with("wanted ") {
        return Diagnostic::new(span, "expected a word in quotes");
    }
    Diagnostic::new(span, message)
}

fn missing(span: Range<usize>, key: &str) -> Diagnostic {
    let diagnostic = Diagnostic::new(span.clone(), format!("the key `{key}` is missing"));
    if span.start == 0 {
        return diagnostic.label("in this case");
    }
    diagnostic.label("in this table")
}

/// Rust's names of types in words.
fn plain_type(name: &str) -> &str {
    match name {
        "f64" => "a number",
        "i64" => "a whole number",
        "a sequence" | "sequence" => "an array",
        "a map" | "map" => "a table",
        "a boolean" => "`true` or `false`",
        other if other.starts_with("struct ") => "a table",
        other if other.starts_with("enum ") => "a word in quotes",
        other => other,
    }
}
