//! Differences of two trees of values, by key.

use serde_json::Value;

/// A leaf that differs; what only one tree has is [`None`] in the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Keys from the root: `body[0].size`.
    pub path: String,
    /// The value of the one.
    pub a: Option<Value>,
    /// The value of the other.
    pub b: Option<Value>,
}

/// All leaves in which two trees differ, in the order of the first. Texts are compared, so that −0 and 0 differ.
#[must_use]
pub fn differences(a: &Value, b: &Value) -> Vec<Difference> {
    let mut differences = Vec::new();
    walk("", Some(a), Some(b), &mut differences);
    differences
}

fn walk(path: &str, a: Option<&Value>, b: Option<&Value>, differences: &mut Vec<Difference>) {
    let below = |key: &str| {
        if path.is_empty() {
            key.to_owned()
        } else {
            format!("{path}.{key}")
        }
    };
    match (a, b) {
        (Some(Value::Object(a)), Some(Value::Object(b))) => {
            for key in a.keys().chain(b.keys().filter(|key| !a.contains_key(*key))) {
                walk(&below(key), a.get(key), b.get(key), differences);
            }
        }
        (Some(Value::Array(a)), Some(Value::Array(b))) => {
            for k in 0..a.len().max(b.len()) {
                walk(&format!("{path}[{k}]"), a.get(k), b.get(k), differences);
            }
        }
        (a, b) => {
            if a.map(Value::to_string) != b.map(Value::to_string) {
                differences.push(Difference {
                    path: path.to_owned(),
                    a: a.cloned(),
                    b: b.cloned(),
                });
            }
        }
    }
}
