//! Titles that follow their case: `"Sphere at {velocity}"`.

use std::ops::Range;

use toml::de::DeTable;
use toml::{Table, Value};

use model::readable::short;
use model::units;

/// The title of a case with the values of the keys that it names in braces, and the case's text with that title, if it
/// names any.
///
/// A key is written as for `--set`; one that a single body has may stand alone. A vector stands for its length. Braces
/// around anything else stay as they are.
pub fn filled(text: &str) -> Option<(String, String)> {
    let document: Table = text.parse().ok()?;
    let template = document.get("title")?.as_str()?;
    let title = fill(template, &document);
    if title == template {
        return None;
    }
    let at = place(text)?;
    let quoted = Value::String(title.clone()).to_string();
    let text = format!("{}{quoted}{}", &text[..at.start], &text[at.end..]);
    Some((title, text))
}

/// Where the value of the title stands.
fn place(text: &str) -> Option<Range<usize>> {
    let document = DeTable::parse(text).ok()?;
    Some(document.get_ref().get("title")?.span())
}

fn fill(template: &str, document: &Table) -> String {
    let mut title = String::new();
    let mut rest = template;
    while let Some((before, (key, after))) = rest
        .split_once('{')
        .and_then(|(before, behind)| Some((before, behind.split_once('}')?)))
    {
        title.push_str(before);
        match value(document, key).and_then(words) {
            Some(words) => title.push_str(&words),
            None => title.push_str(&rest[before.len()..rest.len() - after.len()]),
        }
        rest = after;
    }
    title + rest
}

/// The value of a key as `--set` names it, or of one that a single body has.
fn value<'a>(document: &'a Table, key: &str) -> Option<&'a Value> {
    let path: Vec<&str> = key.trim().split('.').collect();
    let (first, others) = path.split_first()?;
    let Some(found) = document.get(*first) else {
        let bodies = document.get("body")?.as_array()?.iter();
        let mut own = bodies.filter_map(|body| child(body, first));
        let only = own.next().filter(|_| others.is_empty())?;
        return own.next().is_none().then_some(only);
    };
    others
        .iter()
        .try_fold(found, |value, key| child(value, key))
}

/// An entry of a table, or an element of a list by its name or number.
fn child<'a>(value: &'a Value, key: &str) -> Option<&'a Value> {
    match value {
        Value::Table(table) => table.get(key),
        Value::Array(list) => {
            let is_named = |own: &&Value| own.get("name").and_then(Value::as_str) == Some(key);
            let named = list.iter().find(is_named);
            named.or_else(|| list.get(key.parse::<usize>().ok()?))
        }
        _ => None,
    }
}

/// A value as people read it: a number, a quantity as it was typed, the length of a vector in the unit of its first
/// component that is not zero.
fn words(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => {
            units::parse(text).ok()?;
            Some(text.clone())
        }
        Value::Integer(number) => Some(number.to_string()),
        Value::Float(number) => Some(short(*number)),
        Value::Array(list) => length(list),
        _ => None,
    }
}

fn length(components: &[Value]) -> Option<String> {
    let mut sum = 0.0;
    let mut typed: Option<(&str, units::Powers)> = None;
    for component in components {
        match component {
            Value::Integer(0) => {}
            Value::String(text) => {
                let (value, powers) = units::parse(text).ok()?;
                let (_, known) = *typed.get_or_insert((text, powers));
                if known != powers {
                    return None;
                }
                sum += value * value;
            }
            _ => return None,
        }
    }
    let (text, _) = typed?;
    let (_, unit) = units::split(text)?;
    Some(format!(
        "{} {unit}",
        short(sum.sqrt() / units::unit_of(text))
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "# A case.\ntitle = \"TITLE\" # here\nspacing = \"0.1 mm\"\n[sph]\nalpha = 1.5\n\
        [[body]]\nname = \"ball\"\nvelocity = [0, \"-3 km/s\", \"4 km/s\"]\nshape.sphere.radius = \"2 mm\"\n\
        [[body]]\nname = \"wall\"\n";

    fn title(template: &str) -> String {
        let text = CASE.replace("TITLE", template);
        filled(&text).map_or_else(|| template.to_owned(), |(title, _)| title)
    }

    #[test]
    fn keys_in_braces_are_told() {
        assert_eq!(title("A ball at {velocity}"), "A ball at 5 km/s");
        assert_eq!(
            title("{body.ball.velocity} at {spacing}"),
            "5 km/s at 0.1 mm"
        );
        let radius = "{body.ball.shape.sphere.radius}, alpha {sph.alpha}";
        assert_eq!(title(radius), "2 mm, alpha 1.5");
    }

    #[test]
    fn other_braces_stay() {
        for template in [
            "{",
            "}",
            "{}",
            "{{velocity",
            "{nothing}",
            "{name}",
            "{body.wall.velocity}",
            "{body}",
            "{body.7}",
            "}{",
        ] {
            assert_eq!(title(template), template);
        }
    }

    #[test]
    fn the_text_of_the_case_has_the_title() {
        let (_, text) = filled(&CASE.replace("TITLE", "At {velocity}")).unwrap();
        assert_eq!(text, CASE.replace("TITLE", "At 5 km/s"));
    }
}
