//! All tables and keys of cases as a page of the book, made of their JSON schema.

use std::fmt::Write as _;

use serde_json::{Map, Value};

use crate::input::{ABSENT, referred};

/// What the page says before its tables.
const HEAD: &str = "\
# Input reference

<!-- Written by `whipple generate reference`: change the schema (src/input/schema), not this page. -->

All tables and keys of a case, in alphabetical order within each table. This page is made from the same
declarations that read the case, so it names every key that there is, and no other. The [input guide](input.md)
explains what the keys do and how they go together.

- **Type**: quantities are strings with a unit, as in the example; any unit of the same dimension will do
  ([units](input.md)), and zero needs none. Words stand in quotes.
- **Default**: what holds where the key is absent. *required*: it must be given. A dash: there is no value,
  and nothing of that kind happens; constants of a material come from the library, if it names one.
";

/// Tables by their names in the schema.
type Tables = Map<String, Value>;

/// The page of a schema (that of [`crate::input::described`]).
pub fn page(schema: &Value) -> String {
    let mut page = HEAD.to_owned();
    let empty = Tables::new();
    let tables = schema["definitions"].as_object().unwrap_or(&empty);
    let mut order = Vec::new();
    in_order(&schema["allOf"], tables, &mut order);
    for name in order {
        write_table(&mut page, &tables[name], tables);
    }
    page
}

/// Names of the tables that a value refers to, each before those that it refers to itself.
fn in_order<'a>(value: &'a Value, tables: &'a Tables, order: &mut Vec<&'a str>) {
    if let Some(name) = referred(value) {
        if !order.contains(&name) {
            order.push(name);
            in_order(&tables[name], tables, order);
        }
        return;
    }
    match value {
        Value::Object(entries) => {
            for entry in entries.values() {
                in_order(entry, tables, order);
            }
        }
        Value::Array(entries) => {
            for entry in entries {
                in_order(entry, tables, order);
            }
        }
        _ => {}
    }
}

fn write_table(page: &mut String, table: &Value, tables: &Tables) {
    let (heading, rest) = heading(table);
    let _ = writeln!(page, "\n## {heading}\n");
    if !rest.is_empty() {
        let _ = writeln!(page, "{}\n", sentence(rest));
    }
    page.push_str("| key | type | default | meaning |\n|---|---|---|---|\n");
    let required = table["required"].as_array();
    for (key, value) in table["properties"].as_object().into_iter().flatten() {
        let must = required.is_some_and(|keys| keys.iter().any(|other| other == key.as_str()));
        let meaning = text(value, "description").trim_end_matches('.');
        let default = if must {
            "*required*"
        } else {
            value[ABSENT].as_str().unwrap_or("–")
        };
        let kind = kind(value, tables).replace('|', "\\|");
        let _ = writeln!(page, "| `{key}` | {kind} | {default} | {meaning} |");
    }
}

/// What a table is called, and what else its description says.
fn heading(table: &Value) -> (&str, &str) {
    let text = text(table, "description");
    let mut in_code = false;
    let end = text.char_indices().find(|&(_, c)| {
        in_code ^= c == '`';
        !in_code && [':', ';', '.'].contains(&c)
    });
    end.map_or((text, ""), |(at, _)| (&text[..at], text[at + 1..].trim()))
}

/// What may be typed, in Markdown.
fn kind(value: &Value, tables: &Tables) -> String {
    if let Some(title) = value["title"].as_str() {
        return quoted(&title.replace(" with a unit, such as", ", as in"));
    }
    if let Some(name) = referred(value) {
        let (heading, _) = heading(&tables[name]);
        return format!("[{heading}](#{})", anchor(heading));
    }
    if let Some(words) = value["enum"].as_array() {
        return any_of(words.iter().map(|word| format!("`{word}`")));
    }
    if let Some(ways) = value["anyOf"].as_array().or(value["allOf"].as_array()) {
        return any_of(ways.iter().map(|way| kind(way, tables)));
    }
    if !value["const"].is_null() {
        return format!("`{}`", value["const"]);
    }
    match text(value, "type") {
        "boolean" => "`true` or `false`".to_owned(),
        "string" => "a text".to_owned(),
        "number" => "a number".to_owned(),
        "integer" => "a whole number".to_owned(),
        "array" => format!("an array of: {}", kind(&value["items"], tables)),
        _ => format!(
            "tables by name: {}",
            kind(&value["additionalProperties"], tables)
        ),
    }
}

/// Several ways of typing a value, each once.
fn any_of(ways: impl Iterator<Item = String>) -> String {
    let mut listed: Vec<String> = Vec::new();
    for way in ways {
        if !listed.contains(&way) {
            listed.push(way);
        }
    }
    let Some(last) = listed.pop() else {
        return String::new();
    };
    if listed.is_empty() {
        return last;
    }
    format!("{} or {last}", listed.join(", "))
}

/// A text whose quoted words are code.
fn quoted(text: &str) -> String {
    let parts = text.split('"').enumerate();
    parts
        .map(|(n, part)| match n % 2 {
            1 => format!("`\"{part}\"`"),
            _ => part.to_owned(),
        })
        .collect()
}

/// A text that begins with a large letter.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}

/// What mdBook calls the place of a heading.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter_map(|c| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || c == '_' || c == '-' => Some(c.to_ascii_lowercase()),
        _ => None,
    });
    kept.collect()
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}
