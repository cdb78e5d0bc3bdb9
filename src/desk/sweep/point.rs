//! A point of a sweep: values of the keys that vary, and the folder of its run.

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use super::values::Value;

/// Longest part of a folder's name that is made of values (bytes).
const LONGEST: usize = 80;

/// A point.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Values in the order of the keys.
    pub values: Vec<Value>,
    /// The values of `--set`, in this order.
    pub settings: Vec<String>,
    /// Name of the folder of its run, which no other point has.
    pub name: String,
}

impl Point {
    /// The point of some keys and values.
    #[must_use]
    pub fn new(keys: &[String], values: Vec<Value>) -> Self {
        let pairs = keys.iter().zip(&values);
        let settings = pairs.map(|(key, value)| format!("{key}={}", value.text));
        Self {
            settings: settings.collect(),
            name: name(keys, &values),
            values,
        }
    }

    /// The point for people: `velocity = 3 km/s, angle = 45 deg`.
    #[must_use]
    pub fn label(&self, keys: &[String]) -> String {
        let pairs = keys.iter().zip(&self.values);
        let texts: Vec<String> = pairs
            .map(|(key, value)| format!("{} = {}", short(key), value.text))
            .collect();
        texts.join(", ")
    }
}

/// The last part of a key.
#[must_use]
pub fn short(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}

/// A folder's name: the values, as far as file systems take them, and a digest of keys and values.
fn name(keys: &[String], values: &[Value]) -> String {
    let mut digest = Sha256::new();
    let mut text = String::new();
    for (key, value) in keys.iter().zip(values) {
        digest.update(format!("{key}={}\n", value.text));
        let kept = |c: char| {
            if c.is_ascii_alphanumeric() || "+-.".contains(c) {
                c
            } else {
                '_'
            }
        };
        let words = value.text.replace(' ', "").replace('/', "p");
        let kept_words: String = words.chars().map(kept).collect();
        let _ = write!(
            text,
            "{}={kept_words}_",
            short(key).replace(|c: char| !c.is_ascii_alphanumeric(), "_")
        );
    }
    text.truncate(LONGEST);
    let digest = format!("{:x}", digest.finalize());
    format!("{}-{}", text.trim_end_matches('_'), &digest[..8])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(key: &str, value: &str) -> String {
        Point::new(&[key.to_owned()], vec![Value::new(value)]).name
    }

    #[test]
    fn folders_have_names_of_their_own() {
        let a = name("spacing", "0.03 mm");
        assert!(a.starts_with("spacing=0.03mm-"), "{a}");
        assert_ne!(a, name("spacing", "0.03  mm"));
        assert_ne!(name("a.b", "x/y"), name("a.b", "x_y"));
        let long = name("k", &"../".repeat(100));
        assert!(long.len() < 100 && !long.contains('/'), "{long}");
    }
}
