//! The keys that `--set` may name, as far as they do not hang on the names of a case.

use std::collections::BTreeSet;

use serde_json::Value;

use super::overrides::RESTARTABLE;
use super::schema::CaseParams;
use super::schema::describe::{self, referred};

/// Paths of the keys of the schema. Of lists they are those of the first element, and what a case
/// names by itself, such as materials, is left out.
#[must_use]
pub fn keys() -> BTreeSet<String> {
    let schema = describe::schema::<CaseParams>("");
    let mut found = BTreeSet::new();
    let mut above = Vec::new();
    collect(&schema["allOf"][0], &schema, ("", &mut above), &mut found);
    found
}

/// Those of them that a restart may change.
#[must_use]
pub fn restartable_keys() -> BTreeSet<String> {
    let first = |key: &String| {
        key.split('.')
            .next()
            .is_some_and(|k| RESTARTABLE.contains(&k))
    };
    keys().into_iter().filter(first).collect()
}

/// Adds the paths below a schema, which stands below tables `above` at a path.
fn collect<'s>(
    schema: &'s Value,
    all: &'s Value,
    (path, above): (&str, &mut Vec<&'s str>),
    found: &mut BTreeSet<String>,
) {
    if let Some(table) = referred(schema) {
        // Tables may hold themselves.
        if !above.contains(&table) {
            above.push(table);
            collect(&all["definitions"][table], all, (path, &mut *above), found);
            above.pop();
        }
        return;
    }
    for (key, value) in schema["properties"].as_object().into_iter().flatten() {
        let path = if path.is_empty() {
            key.clone()
        } else {
            format!("{path}.{key}")
        };
        if value.get("additionalProperties").is_none() {
            collect(value, all, (&path, &mut *above), found);
            let is_table = !schema_of_table(value, all).is_null();
            if !is_table {
                found.insert(path);
            }
        }
    }
    for way in ["allOf", "anyOf"]
        .iter()
        .filter_map(|way| schema[way].as_array())
        .flatten()
    {
        collect(way, all, (path, &mut *above), found);
    }
    // Tables of tables alone have elements with keys.
    if referred(&schema["items"]).is_some() {
        collect(&schema["items"], all, (&format!("{path}.0"), above), found);
    }
}

/// Keys below a key that can hold nothing but a table.
fn schema_of_table<'s>(value: &'s Value, all: &'s Value) -> &'s Value {
    referred(&value["allOf"][0])
        .map_or(&Value::Null, |name| &all["definitions"][name]["properties"])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_those_of_tables_and_of_first_elements() {
        let keys = keys();
        for key in [
            "spacing",
            "run.end_time",
            "sph.alpha",
            "output.history_every",
            "body.0.velocity",
            "body.0.shape.sphere.radius",
            "contact.overlap.stiffness",
            "output.snapshot.0.every",
        ] {
            assert!(keys.contains(key), "{key}: {keys:?}");
        }
        assert!(!keys.contains("sph") && !keys.contains("run"));
        assert!(keys.len() < 1000, "{}", keys.len());
        let few = restartable_keys();
        assert!(few.contains("run.end_time") && !few.contains("spacing"));
    }
}
