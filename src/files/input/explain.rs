//! A case key by key: what is typed, with its place, and what the schema says of what is not.

use std::path::Path;

use serde::Deserialize;
use serde_json::{Map, Value as Schema};
use toml::de::{DeArray, DeTable, DeValue};
use toml::{Table, Value};

use super::schema::describe::{ABSENT, referred};
use super::source::Sources;
use super::{InputError, case_file, document, parse, schema};
use model::Case;

/// A line of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum Explained {
    /// A table begins: `[run]` or `[[body]]`.
    Header(String),
    /// A key that is typed.
    Typed {
        /// Its path within the table.
        key: String,
        /// Its value as TOML.
        value: String,
        /// Its place: `case.toml:12` or `--set`.
        place: String,
    },
    /// A key that is not.
    Absent {
        /// Its path within the table, or from the root if the table is not there.
        key: String,
        /// The value that it has then, as TOML, if that is always the same.
        default: Option<String>,
        /// Consequence of its absence, in words.
        said: String,
    },
}

/// A case from a file or from the `case.toml` of a folder, with `--set` overrides, and its lines: as TOML
/// they give the same case.
///
/// # Errors
/// Those of [`load`](super::load).
pub fn explain(path: &Path, overrides: &[String]) -> Result<(Case, Vec<Explained>), InputError> {
    let (path, text) = case_file::text(path)?;
    let name = path.display().to_string();
    let case = parse(&name, &text, overrides)?;
    let mut sources = Sources::default();
    sources.add(&name, &text);
    let places = overrides.iter().map(|text| sources.add("--set", text));
    let places: Vec<usize> = places.collect();
    let document = document::laid(&text, overrides, &places)
        .map_err(|diagnostic| InputError::Invalid(sources.render(&diagnostic)))?;
    let values = Table::deserialize(toml::Deserializer::from(document.clone()))
        .map_err(|error| InputError::Invalid(format!("error: {error}")))?;
    let schema = schema::describe::schema::<schema::CaseParams>("");
    let mut walk = Walk {
        sources: &sources,
        definitions: &schema["definitions"],
        lines: Vec::new(),
    };
    let root = walk.keys(&schema["allOf"][0]).unwrap_or(&NOTHING);
    walk.root(root, document.get_ref(), &values);
    Ok((case, walk.lines))
}

/// Keys of a table of which nothing is known.
static NOTHING: std::sync::LazyLock<Map<String, Schema>> = std::sync::LazyLock::new(Map::new);

/// Goes through a document and the schema together.
struct Walk<'a> {
    sources: &'a Sources,
    definitions: &'a Schema,
    lines: Vec<Explained>,
}

impl<'a> Walk<'a> {
    /// Schema to which that of one thing refers.
    fn resolved(&self, schema: &'a Schema) -> &'a Schema {
        let inner = schema.get("allOf").map_or(schema, |all| &all[0]);
        referred(inner).map_or(inner, |name| &self.definitions[name])
    }

    /// Part of a schema, or of one of its ways of typing, under a word.
    fn part(&self, schema: &'a Schema, word: &str) -> Option<&'a Schema> {
        let schema = self.resolved(schema);
        let ways = schema.get("anyOf").and_then(Schema::as_array);
        let own = schema.get(word).filter(|found| found.is_object());
        own.or_else(|| {
            ways.into_iter()
                .flatten()
                .find_map(|way| self.part(way, word))
        })
    }

    /// The keys of a table.
    fn keys(&self, schema: &'a Schema) -> Option<&'a Map<String, Schema>> {
        self.part(schema, "properties")?.as_object()
    }

    /// The whole document: plain keys first, then tables.
    fn root(&mut self, keys: &'a Map<String, Schema>, places: &DeTable, values: &Table) {
        let typed = in_order(places);
        let section = |value: &Value| match value {
            Value::Table(_) => true,
            Value::Array(list) => !list.is_empty() && list.iter().all(Value::is_table),
            _ => false,
        };
        let (sections, plain): (Vec<_>, Vec<_>) = typed
            .into_iter()
            .partition(|(name, _)| section(&values[*name]));
        for (name, place) in plain {
            self.typed("", name, &values[name], place.span().start);
        }
        for (name, schema) in keys.iter().filter(|(name, _)| !values.contains_key(*name)) {
            self.absent(name, schema, true);
        }
        for (name, place) in sections {
            let Some(schema) = keys.get(name) else {
                continue;
            };
            match (place.get_ref(), &values[name]) {
                (DeValue::Array(places), Value::Array(values)) => {
                    self.list(name, schema, places, values);
                }
                (DeValue::Table(places), Value::Table(values)) => {
                    self.section(name, schema, places, values);
                }
                _ => {}
            }
        }
    }

    /// A list of tables.
    fn list(&mut self, name: &str, schema: &'a Schema, places: &DeArray, values: &[Value]) {
        let keys = self
            .part(schema, "items")
            .and_then(|items| self.keys(items));
        for (place, value) in places.iter().zip(values) {
            self.lines.push(Explained::Header(format!("[[{name}]]")));
            if let (DeValue::Table(places), Value::Table(values)) = (place.get_ref(), value) {
                self.table("", keys.unwrap_or(&NOTHING), places, values, false);
            }
        }
    }

    /// A table with a header, or several by name.
    fn section(&mut self, name: &str, schema: &'a Schema, places: &DeTable, values: &Table) {
        if let Some(named) = self.part(schema, "additionalProperties") {
            let keys = self.keys(named).unwrap_or(&NOTHING);
            for (entry, place) in in_order(places) {
                let header = format!("[{name}.{}]", bare(entry));
                self.lines.push(Explained::Header(header));
                if let (DeValue::Table(places), Value::Table(values)) =
                    (place.get_ref(), &values[entry])
                {
                    self.table("", keys, places, values, false);
                }
            }
            return;
        }
        self.lines.push(Explained::Header(format!("[{name}]")));
        let keys = self.keys(schema).unwrap_or(&NOTHING);
        self.table("", keys, places, values, true);
    }

    /// The keys of a table, those of tables below it dotted; with `all` those of tables that are not there
    /// too, where these are always meant.
    fn table(
        &mut self,
        before: &str,
        keys: &'a Map<String, Schema>,
        places: &DeTable,
        values: &Table,
        all: bool,
    ) {
        for (name, place) in in_order(places) {
            let inner = keys.get(name).and_then(|schema| self.keys(schema));
            match (place.get_ref(), &values[name], inner) {
                (DeValue::Table(places), Value::Table(values), Some(inner))
                    if !values.is_empty() =>
                {
                    let before = format!("{before}{}.", bare(name));
                    self.table(&before, inner, places, values, all);
                }
                (_, value, _) => self.typed(before, name, value, place.span().start),
            }
        }
        for (name, schema) in keys.iter().filter(|(name, _)| !values.contains_key(*name)) {
            self.absent(&format!("{before}{name}"), schema, all);
        }
    }

    fn typed(&mut self, before: &str, name: &str, value: &Value, address: usize) {
        let (source, line) = self.sources.place(address);
        let place = match source {
            "--set" => source.to_owned(),
            file => format!("{file}:{line}"),
        };
        self.lines.push(Explained::Typed {
            key: format!("{before}{}", bare(name)),
            value: value.to_string(),
            place,
        });
    }

    /// A key that is not typed, if something is so without it; of a table that is always there, its keys.
    fn absent(&mut self, key: &str, schema: &'a Schema, below: bool) {
        if let Some(said) = schema[ABSENT].as_str() {
            self.lines.push(Explained::Absent {
                key: key.to_owned(),
                default: schema.get("default").map(Schema::to_string),
                said: said.to_owned(),
            });
            return;
        }
        let table = self.resolved(schema);
        let required = table.get("required").and_then(Schema::as_array);
        if !below || required.is_none_or(|required| !required.is_empty()) {
            return;
        }
        let keys = table.get("properties").and_then(Schema::as_object);
        for (name, schema) in keys.into_iter().flatten() {
            self.absent(&format!("{key}.{name}"), schema, true);
        }
    }
}

/// The keys of a table as they are typed, those of `--set` last.
fn in_order<'d, 't>(table: &'d DeTable<'t>) -> Vec<(&'d str, &'d toml::Spanned<DeValue<'t>>)> {
    let mut keys: Vec<_> = table.iter().collect();
    keys.sort_by_key(|(key, value)| (value.span().start, key.span().start));
    let named = keys
        .into_iter()
        .map(|(key, value)| (key.get_ref().as_ref(), value));
    named.collect()
}

/// A key as TOML.
fn bare(key: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
    if !key.is_empty() && key.chars().all(plain) {
        key.to_owned()
    } else {
        Value::String(key.to_owned()).to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each key whose row has a value, but the one that another must go with, gives the same case with that value.
    #[test]
    fn what_is_said_of_absent_keys_is_so() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("case.toml");
        let text = "dimension = 3\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\n\
                    material.metal.library = \"copper\"\nfragments = {}\n\
                    [[body]]\nname = \"cube\"\nmaterial = \"metal\"\n\
                    shape.box = { lower = [0, 0, 0], upper = [\"9 mm\", \"9 mm\", \"9 mm\"] }\n\
                    [[symmetry]]\naxis = \"x\"\n[[gauge]]\nat = [\"1 mm\", 0, 0]\n";
        std::fs::write(&path, text).unwrap();
        let case = |overrides: &[String]| {
            let mut case = super::super::load(&path, overrides).unwrap();
            case.resolved.clear();
            format!("{case:?}")
        };
        let default = case(&[]);
        let (_, lines) = explain(&path, &[]).unwrap();
        let (mut place, mut tried) = (String::new(), 0);
        for line in lines {
            match line {
                Explained::Header(header) => {
                    let name = header.trim_matches(['[', ']']);
                    let first = if header.starts_with("[[") { ".0." } else { "." };
                    place = format!("{name}{first}");
                }
                Explained::Absent {
                    key,
                    default: Some(value),
                    ..
                } if !key.ends_with("mean_time_between_failures") => {
                    let set = format!("{place}{key}={value}");
                    assert_eq!(case(std::slice::from_ref(&set)), default, "{set}");
                    tried += 1;
                }
                _ => {}
            }
        }
        assert!(tried > 40, "{tried}");
    }
}
