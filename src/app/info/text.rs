//! A report, in lines and as values.

use serde_json::{Map, Value};

use model::readable::one_line;

/// Lines for people, and the same as values for programs.
#[derive(Default)]
pub(super) struct Text {
    /// The lines.
    pub(super) lines: String,
    /// The values, in SI units.
    pub(super) values: Map<String, Value>,
}

impl Text {
    pub(super) fn line(&mut self, text: &str) {
        self.lines.push_str(&one_line(text));
        self.lines.push('\n');
    }

    pub(super) fn entry(&mut self, name: &str, value: impl std::fmt::Display) {
        let name = name.replace('_', " ");
        self.line(&format!("{name:<36} {value}"));
    }

    /// A value whose line is written separately.
    pub(super) fn value(&mut self, name: &str, value: impl Into<Value>) {
        self.values.insert(name.to_owned(), value.into());
    }

    /// One of several values of a name.
    pub(super) fn one_of(&mut self, name: &str, value: Value) {
        let list = self
            .values
            .entry(name)
            .or_insert_with(|| Value::Array(Vec::new()));
        if let Value::Array(list) = list {
            list.push(value);
        }
    }

    /// A line of a value that needs no words.
    pub(super) fn both(&mut self, name: &str, value: impl Into<Value> + std::fmt::Display) {
        self.entry(name, &value);
        self.value(name, value);
    }
}
