//! The texts a case is read from, and diagnostics that point into them.
//!
//! The file and each `--set` lie one after the other in a single address space, so that a byte
//! range says both which text and where in it.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

/// A fault, and its place.
#[derive(Debug)]
pub struct Diagnostic {
    /// Bytes in the address space of [`Sources`].
    pub span: Range<usize>,
    /// One line: value, allowed range.
    pub title: String,
    /// A few words beside the caret; may be empty.
    pub label: String,
    /// Remedy, if it is not plain from the title.
    pub help: Option<String>,
}

impl Diagnostic {
    /// A diagnostic with a title alone.
    pub fn new(span: Range<usize>, title: impl Into<String>) -> Self {
        Self {
            span,
            title: title.into(),
            label: String::new(),
            help: None,
        }
    }

    /// Adds words beside the caret.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Adds a line that says what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// `what` named `found` is none of `known`: names the nearest and lists all.
    pub fn unknown<'a>(
        span: Range<usize>,
        what: &str,
        found: &str,
        known: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let known: Vec<&str> = known.into_iter().collect();
        let diagnostic = Self::new(span, format!("unknown {what} `{found}`"));
        let diagnostic = match nearest(found, &known) {
            Some(name) => diagnostic.label(format!("did you mean `{name}`?")),
            None => diagnostic,
        };
        if known.is_empty() {
            return diagnostic.help(format!("there is no {what} here"));
        }
        let list: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
        diagnostic.help(format!("the choices are {}", list.join(", ")))
    }
}

/// One text and where it begins in the address space.
#[derive(Debug)]
struct Source {
    name: String,
    text: String,
    start: usize,
}

/// All texts of a case.
#[derive(Debug, Default)]
pub struct Sources(Vec<Source>);

impl Sources {
    /// Adds a text and returns its first address.
    pub fn add(&mut self, name: &str, text: &str) -> usize {
        let start = self.0.last().map_or(0, |s| s.start + s.text.len() + 1);
        self.0.push(Source {
            name: name.to_owned(),
            text: text.to_owned(),
            start,
        });
        start
    }

    /// The name of the text and the number of the line that an address is in.
    pub fn place(&self, address: usize) -> (&str, usize) {
        let after = self.0.partition_point(|s| s.start <= address);
        let source = &self.0[after.saturating_sub(1)];
        let bytes = source.text.as_bytes();
        let before = &bytes[..(address - source.start).min(bytes.len())];
        let ends = before.iter().filter(|byte| **byte == b'\n');
        (&source.name, 1 + ends.count())
    }

    /// The diagnostic as the user sees it: title, file, line, column, caret, help.
    pub fn render(&self, diagnostic: &Diagnostic) -> String {
        let after = self.0.partition_point(|s| s.start <= diagnostic.span.start);
        let source = &self.0[after.saturating_sub(1)];
        let text = &source.text;
        let begin = (diagnostic.span.start - source.start).min(text.len());
        let end = (diagnostic.span.end - source.start).clamp(begin, text.len());
        // A caret under one line says as much as a bracket around a whole table.
        let end = text[begin..end].find('\n').map_or(end, |line| begin + line);
        let mut annotation = AnnotationKind::Primary.span(begin..end);
        if !diagnostic.label.is_empty() {
            annotation = annotation.label(diagnostic.label.as_str());
        }
        let snippet = Snippet::source(text)
            .path(&source.name)
            .annotation(annotation);
        let group: Group<'_> = Level::ERROR
            .primary_title(diagnostic.title.as_str())
            .element(snippet);
        let group = match &diagnostic.help {
            Some(help) => group.element(Level::HELP.message(help.as_str())),
            None => group,
        };
        Renderer::plain().render(&[group])
    }
}

/// The name closest to `word`, if one is near enough to be a slip of the finger.
pub fn nearest<'a>(word: &str, names: &[&'a str]) -> Option<&'a str> {
    let word = word.to_lowercase();
    names
        .iter()
        .map(|name| (strsim::osa_distance(&word, &name.to_lowercase()), *name))
        .filter(|(d, name)| *d <= name.chars().count().div_ceil(3))
        .min_by_key(|(d, _)| *d)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_a_slip_away() {
        let names = ["smoothing", "alpha", "beta", "axis"];
        assert_eq!(nearest("smothing", &names), Some("smoothing"));
        assert_eq!(nearest("Alpah", &names), Some("alpha"));
        assert_eq!(nearest("alfa", &names), Some("alpha"));
        assert_eq!(nearest("axsi", &names), Some("axis"));
        assert_eq!(nearest("velocity", &names), None);
    }
}
