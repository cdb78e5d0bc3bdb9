//! Differences of two resolved cases, key by key: comments, order and formatting are none, nor is
//! another unit for the same quantity.

use serde::Deserialize;
use toml::de::DeTable;
use toml::{Table, Value};

use super::overrides::{RESTARTABLE, modernise};
use material::Material;
use model::{Case, units};

/// A key with other values in two cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Its path, as for `--set`.
    pub key: String,
    /// Its values as TOML; `None` where it is absent.
    pub values: [Option<String>; 2],
}

impl Difference {
    /// True if a restart may change the key.
    #[must_use]
    pub fn is_restartable(&self) -> bool {
        let section = self.key.split('.').next().unwrap_or_default();
        RESTARTABLE.contains(&section)
    }
}

/// The keys in which two cases differ; `None` if one of the texts is no TOML.
#[must_use]
pub fn differences(a: &str, b: &str) -> Option<Vec<Difference>> {
    let [a, b] = [a, b].map(read);
    let mut found = Vec::new();
    compare("", Some(&a?), Some(&b?), &mut found);
    Some(found)
}

/// What of a case tells how long it is the same as another one.
#[derive(Debug)]
pub struct Compared {
    resolved: String,
    materials: Vec<Material>,
}

impl Compared {
    /// That of a case.
    #[must_use]
    pub fn of(case: &Case) -> Self {
        Self {
            resolved: case.resolved.clone(),
            materials: case.materials.clone(),
        }
    }

    /// The materials, by their numbers, that another case has with other constants of failure, if nothing else in the cases differs
    /// but what a restart may change: matter that this case has not damaged is the same, to the last bit, with the other.
    ///
    /// # Errors
    /// The first key that matters before anything is damaged.
    pub fn apart_once_damaged(&self, other: &Self) -> Result<Vec<usize>, String> {
        let differences = differences(&self.resolved, &other.resolved).unwrap_or_default();
        let of_material = |found: &Difference| found.key.split('.').next() == Some("material");
        let mut others = differences.iter();
        if let Some(found) = others.find(|found| !found.is_restartable() && !of_material(found)) {
            return Err(found.key.clone());
        }
        let [a, b] = [&self.materials, &other.materials];
        if a.len() != b.len() {
            return Err("material".to_owned());
        }
        let mut apart = Vec::new();
        for (number, (a, b)) in a.iter().zip(b).enumerate() {
            if let Some(key) = a.differs_undamaged(b) {
                return Err(format!("material.{}: {key}", a.name));
            }
            if a != b {
                apart.push(number);
            }
        }
        Ok(apart)
    }
}

/// The document of a text, with tables of older names under their present ones.
fn read(text: &str) -> Option<Value> {
    let mut document = DeTable::parse(text).ok()?;
    modernise(document.get_mut());
    let table = Table::deserialize(toml::Deserializer::from(document));
    table.ok().map(Value::Table)
}

fn compare(key: &str, a: Option<&Value>, b: Option<&Value>, found: &mut Vec<Difference>) {
    match (a, b) {
        (Some(Value::Table(a)), Some(Value::Table(b))) => {
            let more = b.keys().filter(|name| !a.contains_key(*name));
            for name in a.keys().chain(more) {
                compare(&below(key, name), a.get(name), b.get(name), found);
            }
        }
        (Some(Value::Array(a)), Some(Value::Array(b)))
            if a.len() == b.len() && a.iter().chain(b).all(Value::is_table) =>
        {
            for (n, (a, b)) in a.iter().zip(b).enumerate() {
                let name = a.get("name").and_then(Value::as_str);
                let name = name.map_or_else(|| n.to_string(), str::to_owned);
                compare(&below(key, &name), Some(a), Some(b), found);
            }
        }
        (Some(a), Some(b)) if is_same(a, b) => {}
        (a, b) => found.push(Difference {
            key: key.to_owned(),
            values: [a, b].map(|value| value.map(short)),
        }),
    }
}

fn below(key: &str, name: &str) -> String {
    if key.is_empty() {
        name.to_owned()
    } else {
        format!("{key}.{name}")
    }
}

#[allow(
    clippy::cast_precision_loss,
    reason = "compared as the case reads them"
)]
fn is_same(a: &Value, b: &Value) -> bool {
    let number = |value: &Value| match value {
        Value::Integer(number) => Some(*number as f64),
        Value::Float(number) => Some(*number),
        _ => None,
    };
    match (a, b) {
        (Value::String(a), Value::String(b)) => {
            a == b || units::parse(a).is_ok_and(|a| Ok(a) == units::parse(b))
        }
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_same(a, b))
        }
        _ => a == b || number(a).is_some_and(|a| Some(a) == number(b)),
    }
}

/// A value on one line of bearable length.
fn short(value: &Value) -> String {
    const MOST: usize = 60;
    let text = match value {
        Value::Array(list) if list.iter().any(Value::is_table) => {
            return format!("{} entries", list.len());
        }
        Value::Table(table) => return format!("a table of {} keys", table.len()),
        other => other.to_string().replace(char::is_control, " "),
    };
    if text.chars().count() <= MOST {
        return text;
    }
    let begin: String = text.chars().take(MOST).collect();
    format!("{begin}…")
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = r#"
title = "a"
[run]
end_time = "0.2us"
[[body]]
name = "ball"
velocity = [0, "7 km/s"]
[[body]]
name = "plate"
"#;

    fn keys(text: &str) -> Vec<String> {
        let found = differences(CASE, text).unwrap();
        found.into_iter().map(|found| found.key).collect()
    }

    #[test]
    fn only_values_count() {
        let same = r#"
# Another comment, another order, another form, another unit.
body = [{ name = "ball", velocity = [0.0, "7000 m/s"] }, { name = "plate" }]
run.end_time = "200 ns"
title = "a"
"#;
        assert_eq!(keys(same), [""; 0]);
    }

    #[test]
    fn keys_are_named_with_both_values() {
        let edited = CASE.replace("7 km/s", "8 km/s").replace("0.2us", "0.3us");
        let found = differences(CASE, &format!("{edited}shape = 1\n")).unwrap();
        let texts: Vec<String> = found.iter().map(|found| format!("{found:?}")).collect();
        assert_eq!(found.len(), 3, "{texts:?}");
        assert_eq!(found[0].key, "run.end_time");
        assert!(found[0].is_restartable() && !found[1].is_restartable());
        assert_eq!(found[1].key, "body.ball.velocity");
        assert_eq!(found[1].values[1].as_deref(), Some("[0, \"8 km/s\"]"));
        assert_eq!(found[2].key, "body.plate.shape");
        assert_eq!(found[2].values, [None, Some("1".to_owned())]);
        assert_eq!(
            keys(&CASE.replace("[[body]]\nname = \"plate\"\n", "")),
            ["body"]
        );
        assert_eq!(differences(CASE, "a = "), None);
    }
}
