//! A point of a sweep: values of the keys that vary, and the folder of its run.

use std::fmt::Write as _;

use sha2::{Digest, Sha256};
use toml::{Table, Value as Toml};

use super::values::Value;
use model::units;

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
    /// The point of some keys and values in a case, whose resolved text is given.
    ///
    /// # Errors
    /// A message, for a length of something that is no vector with a direction.
    pub fn new(case: &Table, keys: &[String], values: Vec<Value>) -> Result<Self, String> {
        let pairs = keys.iter().zip(&values);
        let settings = pairs.map(|(key, value)| setting(case, key, value));
        let settings: Vec<String> = settings.collect::<Result<_, _>>()?;
        let name = name(keys, &values);
        Ok(Self {
            values,
            settings,
            name,
        })
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

/// `key=value`; a number for a key that holds a vector sets the length of the vector, whose
/// direction stays.
fn setting(case: &Table, key: &str, value: &Value) -> Result<String, String> {
    let of_case = find(case, key).and_then(Toml::as_array);
    let (Some(vector), Some((length, _))) = (of_case, value.number) else {
        return Ok(format!("{key}={}", value.text));
    };
    let components = vector.iter().map(|component| match component {
        Toml::Integer(0) => Some(0.0),
        Toml::Float(x) => Some(*x),
        Toml::String(text) => units::parse(text).ok().map(|(si, _)| si),
        _ => None,
    });
    let components: Option<Vec<f64>> = components.collect();
    let components = components.unwrap_or_default();
    let norm = components.iter().fold(0.0, |n, c| libm::hypot(n, *c));
    if norm == 0.0 || !norm.is_finite() {
        return Err(format!(
            "`{key}` has no direction in the case: `{}` cannot be its length",
            value.text
        ));
    }
    let (scale, unit) = split(&value.text).unwrap_or((length, ""));
    let texts: Vec<String> = components
        .iter()
        .map(|c| format!("\"{} {unit}\"", scale * (c / norm)))
        .collect();
    Ok(format!("{key}=[{}]", texts.join(", ")))
}

/// The number that a text begins with, and its unit.
fn split(text: &str) -> Option<(f64, &str)> {
    let ends = (1..=text.len()).rev();
    let mut ends = ends.filter(|&end| text.is_char_boundary(end));
    ends.find_map(|end| {
        let number = text[..end].trim_end().parse().ok()?;
        Some((number, text[end..].trim()))
    })
}

/// The value of a dotted key; bodies and other tables in a row go by their names or numbers.
fn find<'a>(case: &'a Table, key: &str) -> Option<&'a Toml> {
    let mut parts = key.split('.').map(|part| part.trim().trim_matches('"'));
    let mut here = case.get(parts.next()?)?;
    for part in parts {
        here = match here {
            Toml::Table(table) => table.get(part)?,
            Toml::Array(tables) => {
                let named = |table: &&Toml| table.get("name").and_then(Toml::as_str) == Some(part);
                let table = tables.iter().find(named);
                table.or_else(|| tables.get(part.parse::<usize>().ok()?))?
            }
            _ => return None,
        };
    }
    Some(here)
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

    const CASE: &str = r#"
        spacing = "0.02 mm"
        [[body]]
        name = "plate"
        [[body]]
        name = "sphere"
        velocity = [0, "3 km/s", "-4 km/s"]
        [contact]
        mode = "overlap"
    "#;

    fn point(key: &str, value: &str) -> Result<Point, String> {
        let case: Table = CASE.parse().unwrap();
        Point::new(&case, &[key.to_owned()], vec![Value::new(value)])
    }

    #[test]
    fn a_number_for_a_vector_is_its_length() {
        let settings = |key, value| point(key, value).unwrap().settings[0].clone();
        assert_eq!(
            settings("body.sphere.velocity", "5 km/s"),
            "body.sphere.velocity=[\"0 km/s\", \"3 km/s\", \"-4 km/s\"]"
        );
        assert_eq!(
            settings("body.1.velocity", "1e3 m/s"),
            "body.1.velocity=[\"0 m/s\", \"600 m/s\", \"-800 m/s\"]"
        );
        assert_eq!(
            settings("body.sphere.velocity", "[1, 2, 3]"),
            "body.sphere.velocity=[1, 2, 3]"
        );
        assert_eq!(settings("spacing", "0.03 mm"), "spacing=0.03 mm");
        assert_eq!(
            settings("contact.mode", "potential"),
            "contact.mode=potential"
        );
        assert_eq!(settings("no.such.key", "3"), "no.such.key=3");
    }

    #[test]
    fn folders_have_names_of_their_own() {
        let name = |key, value| point(key, value).unwrap().name;
        let a = name("spacing", "0.03 mm");
        assert!(a.starts_with("spacing=0.03mm-"), "{a}");
        assert_ne!(a, name("spacing", "0.03  mm"));
        assert_ne!(name("a.b", "x/y"), name("a.b", "x_y"));
        let long = name("k", &"../".repeat(100));
        assert!(long.len() < 100 && !long.contains('/'), "{long}");
    }
}
