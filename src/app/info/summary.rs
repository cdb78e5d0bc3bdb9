//! The figures of a finished run.

use std::path::Path;

use serde_json::Value;

use super::text::Text;
use crate::results::ResultsError;
use files::output::read_small;

/// The figures of a finished run.
pub(super) fn summary(path: &Path, text: &mut Text) -> Result<(), ResultsError> {
    if !path.exists() {
        text.entry("summary", "none yet");
        return Ok(());
    }
    let content = read_small(path)?;
    let figures: Value = serde_json::from_slice(&content).map_err(|error| ResultsError::Text {
        path: path.to_owned(),
        reason: error.to_string(),
    })?;
    text.value("summary", figures.clone());
    text.line("");
    for (name, figure) in figures.as_object().into_iter().flatten() {
        if ["title", "steps", "time"].contains(&name.as_str()) {
            continue;
        }
        match figure {
            Value::Object(parts) => {
                text.entry(name, "");
                for (part, value) in parts {
                    text.entry(&format!("  {part}"), parts_of(value));
                }
            }
            value => text.entry(name, short(value)),
        }
    }
    Ok(())
}

/// A figure, or several with their names and vectors in one line.
fn parts_of(value: &Value) -> String {
    match value {
        Value::Object(parts) => {
            let part = |(name, value): (&String, &Value)| {
                format!("{} {}", name.replace('_', " "), parts_of(value))
            };
            parts.iter().map(part).collect::<Vec<_>>().join(", ")
        }
        Value::Array(parts) => {
            let all: Vec<String> = parts.iter().map(short).collect();
            format!("[{}]", all.join(", "))
        }
        value => short(value),
    }
}

/// A figure to five digits.
fn short(value: &Value) -> String {
    match value {
        Value::String(word) => word.clone(),
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap_or(f64::NAN);
            if number != 0.0 && !(1e-3..1e6).contains(&number.abs()) {
                format!("{number:.4e}")
            } else {
                format!("{number:.4}")
            }
        }
        Value::Null => "-".to_owned(),
        other => other.to_string(),
    }
}
