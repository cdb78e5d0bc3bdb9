//! The keys of the schema, as its source declares them, and the key that a message points at.

use std::collections::BTreeMap;
use std::fs;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A key that holds a value.
pub struct Key {
    /// With dots; `*` is any name.
    pub path: String,
    /// Its type in the schema.
    pub kind: String,
}

impl Key {
    /// True if the key takes a number with a unit, or some.
    pub fn takes_quantity(&self) -> bool {
        let kinds = ["Placed<", "ProfileParams<", "OneOrMany<", "Extent", "Point"];
        kinds.iter().any(|kind| self.kind.contains(kind))
    }
}

/// Every key of the schema that holds a value.
pub fn keys() -> Vec<Key> {
    let folder = crate::project::root().join("src/files/input");
    let mut files = vec![folder.join("schema.rs"), folder.join("schema")];
    let mut tables: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    while let Some(file) = files.pop() {
        if file.is_dir() {
            let entries = fs::read_dir(file).unwrap();
            files.extend(entries.map(|entry| entry.unwrap().path()));
        } else {
            read_tables(&fs::read_to_string(file).unwrap(), &mut tables);
        }
    }
    let mut found = Vec::new();
    walk(&tables, &["CaseParams"], "", &mut found);
    found
}

/// Macros of laws, and the tables whose keys they are.
const LAWS: [(&str, &str); 3] = [
    ("equations_of_state", "EosParams"),
    ("strength_laws", "StrengthParams"),
    ("failure_laws", "FailureParams"),
];

/// Reads declarations such as `Table { key: Type = default, Range; }`, one key a line, and those of laws, `law:
/// Table => Law { key: Type, Range; } or { key: Type, Range }`.
fn read_tables(source: &str, tables: &mut BTreeMap<String, Vec<(String, String)>>) {
    let mut table = None;
    let mut laws = None;
    let is_word = |text: &str| text.chars().all(|c| c.is_alphanumeric() || c == '_');
    for line in source.lines().map(str::trim) {
        if line.starts_with("macro_rules! ") {
            let named = |(of, _): &&(&str, &str)| line.contains(&format!(" {of} "));
            laws = LAWS.iter().find(named).map(|(_, table)| *table);
        }
        if line.ends_with('{')
            && let Some((row, _)) = line.split_once(" => ")
            && let Some((law, name)) = row.split_once(": ")
            && is_word(law)
        {
            tables.insert(name.to_owned(), Vec::new());
            table = Some(name.to_owned());
            if let Some(laws) = laws {
                let all = tables.entry(laws.to_owned()).or_default();
                all.push((law.to_owned(), name.to_owned()));
            }
        } else if let Some(name) = line.strip_suffix(" {")
            && name.chars().all(char::is_alphanumeric)
        {
            tables.entry(name.to_owned()).or_default();
            table = Some(name.to_owned());
        } else if line.starts_with('}') {
            // What stands after `or` is of the same table.
            table = table.filter(|_| line.ends_with('{'));
        } else if let (Some(name), Some((key, kind))) = (&table, line.split_once(": "))
            && !line.starts_with(['/', '#', '$', '='])
        {
            let key = key.trim_start_matches("r#").to_owned();
            let kind = type_of(kind).to_owned();
            tables.get_mut(name).unwrap().push((key, kind));
        }
    }
    tables.retain(|_, keys| !keys.is_empty());
}

/// The type at the beginning of what a row says of a key.
fn type_of(row: &str) -> &str {
    let mut depth = 0;
    let end = row.char_indices().find(|&(_, letter)| {
        match letter {
            '<' => depth += 1,
            '>' => depth -= 1,
            _ => {}
        }
        depth == 0 && [' ', ',', ';'].contains(&letter)
    });
    end.map_or(row, |(end, _)| &row[..end])
}

fn walk(
    tables: &BTreeMap<String, Vec<(String, String)>>,
    above: &[&str],
    path: &str,
    found: &mut Vec<Key>,
) {
    for (key, kind) in &tables[above[above.len() - 1]] {
        let path = format!("{path}{key}");
        let words = || kind.split(['<', '>']).filter(|word| !word.is_empty());
        let below = words().find_map(|word| {
            let other = word.replace("Params", "Table");
            [word.to_owned(), other]
                .into_iter()
                .find(|w| tables.contains_key(w))
        });
        let within = |table: &str| above.contains(&table);
        match below {
            Some(table) if words().any(|word| word == "Named") => {
                walk(
                    tables,
                    &[above, &[&table]].concat(),
                    &format!("{path}.*."),
                    found,
                );
            }
            // What the table itself is, or a list of such: its keys are those found already.
            Some(below) if within(&below) => {
                found.extend(kind.contains("Vec<").then(|| Key {
                    path,
                    kind: kind.clone(),
                }));
            }
            Some(table) => walk(
                tables,
                &[above, &[&table]].concat(),
                &format!("{path}."),
                found,
            ),
            None => found.push(Key {
                path,
                kind: kind.clone(),
            }),
        }
    }
}

/// Line and column that a message points at in a file.
pub fn caret(message: &str, file: &str) -> Option<(usize, usize)> {
    let place = message.split(&format!("--> {file}:")).nth(1)?;
    let (line, column) = place.lines().next()?.split_once(':')?;
    Some((line.parse().ok()?, column.parse().ok()?))
}

/// The key of which the name or the value stands at a line and column of a text.
pub fn key_at(text: &str, (line, column): (usize, usize)) -> Option<String> {
    let before: usize = text
        .split_inclusive('\n')
        .take(line - 1)
        .map(str::len)
        .sum();
    let shown = text.lines().nth(line - 1)?;
    let at = before
        + shown
            .chars()
            .take(column - 1)
            .map(char::len_utf8)
            .sum::<usize>();
    let document = DeTable::parse(text).ok()?;
    let mut path = Vec::new();
    descend(document.get_ref(), at, &mut path);
    (!path.is_empty()).then(|| path.join("."))
}

fn descend(table: &DeTable, at: usize, path: &mut Vec<String>) {
    for (key, value) in table {
        let depth = path.len();
        // The names of materials are the user's.
        let named = depth == 1 && path[0] == "material";
        path.push(if named {
            "*".to_owned()
        } else {
            key.get_ref().to_string()
        });
        into(value, at, path);
        if path.len() > depth + 1 || value.span().contains(&at) || key.span().contains(&at) {
            return;
        }
        path.truncate(depth);
    }
}

fn into(value: &Spanned<DeValue>, at: usize, path: &mut Vec<String>) {
    match value.get_ref() {
        DeValue::Table(table) => descend(table, at, path),
        DeValue::Array(array) => {
            let depth = path.len();
            for element in array {
                if path.len() == depth {
                    into(element, at, path);
                }
            }
        }
        _ => {}
    }
}
