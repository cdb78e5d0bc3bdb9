//! `--set key=value`: dotted keys laid over the document before it is read.
//!
//! Array tables are addressed by the name or the index of their element: `body.sphere.velocity`,
//! `contact.pair.0.mode`. Keys that the schema does not know are found out later, by the reader
//! itself, which points at the override like at any other line.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::source::Diagnostic;
use model::units;

/// Sections that do not touch the state of a run, so that a restart may change them.
pub(super) const RESTARTABLE: [&str; 7] = [
    "run",
    "output",
    "fragments",
    "domain",
    "measure",
    "gauge",
    LIMITS,
];

/// Key of the numerical failure limits, and its older name.
const LIMITS: &str = "numerical_limits";
const OLD_LIMITS: &str = "trouble";

/// Gives tables of older names their present ones. What stands there under both stays, and is found
/// out by the reader.
pub fn modernise(document: &mut DeTable) {
    if document.contains_key(LIMITS) {
        return;
    }
    if let Some((key, value)) = document.remove_entry(OLD_LIMITS) {
        document.insert(Spanned::new(key.span(), Cow::Borrowed(LIMITS)), value);
    }
}

type Key<'t> = Spanned<Cow<'t, str>>;
type Value<'t> = Spanned<DeValue<'t>>;

/// A parsed override.
pub struct Override<'t> {
    path: Vec<Key<'t>>,
    value: Value<'t>,
    /// True if the value goes to the end of a list.
    adds: bool,
}

impl<'t> Override<'t> {
    /// Reads `key=value`, or `key+=value`, which adds an element to a list; `start` is the address of the text.
    pub fn parse(text: &'t str, start: usize) -> Result<Self, Diagnostic> {
        let Some(equals) = text.find('=') else {
            let diagnostic = Diagnostic::new(start..start + text.len(), "an override needs a `=`");
            return Err(diagnostic.help("write it as `--set key=value`"));
        };
        let key = text[..equals].trim_end();
        let adds = key.ends_with('+');
        let mut path = parse_path(key.strip_suffix('+').unwrap_or(key), start)?;
        if path[0].get_ref() == OLD_LIMITS {
            path[0] = Spanned::new(path[0].span(), Cow::Borrowed(LIMITS));
        }
        Ok(Self {
            path,
            value: parse_value(&text[equals + 1..], start + equals + 1)?,
            adds,
        })
    }

    /// Lays the value over the document.
    pub fn apply(self, document: &mut DeTable<'t>) -> Result<(), Diagnostic> {
        let Self {
            mut path,
            value,
            adds,
        } = self;
        let last = path.pop().expect("a parsed path has a key");
        let mut path = path.into_iter();
        let Some(first) = path.next() else {
            return if adds {
                add(document, last, value)
            } else {
                replace(document, last, value)
            };
        };
        let mut place = entry(document, first);
        for key in path {
            place = child(place, key)?;
        }
        let span = last.span();
        match place.get_mut() {
            DeValue::Table(table) if adds => add(table, last, value),
            DeValue::Table(table) => replace(table, last, value),
            DeValue::Array(array) if !adds => {
                let index = element(array, &last)?;
                let place = &mut array.as_mut()[index];
                *place = in_place_of(place, value)?;
                Ok(())
            }
            _ => Err(not_a_table(&span)),
        }
    }

    /// Complains if the override changes more than a restart may.
    pub fn restartable(&self) -> Result<(), Diagnostic> {
        let section = &self.path[0];
        if RESTARTABLE.contains(&section.get_ref().as_ref()) {
            return Ok(());
        }
        let title = format!("`{}` cannot change on a restart", section.get_ref());
        let help = "a restart may change `run`, `output`, `domain` and `numerical_limits`";
        Err(Diagnostic::new(section.span(), title).help(help))
    }
}

/// The keys of a dotted path, read as TOML so that quotes work.
fn parse_path<'t>(text: &str, start: usize) -> Result<Vec<Key<'t>>, Diagnostic> {
    let bad_key = || {
        Diagnostic::new(start..start + text.len(), "this is not a dotted key")
            .help("keys look like `body.sphere.velocity` or `output.snapshot_every`")
    };
    let document = format!("{text}=0");
    let mut table = DeTable::parse(&document)
        .map_err(|_| bad_key())?
        .into_inner();
    let mut path = Vec::new();
    while let Some((key, value)) = table.into_iter().next() {
        let span = moved_range(&key.span(), start);
        path.push(Spanned::new(
            span,
            Cow::Owned(key.into_inner().into_owned()),
        ));
        match value.into_inner() {
            DeValue::Table(inner) => table = inner,
            _ => return Ok(path),
        }
    }
    Err(bad_key())
}

/// The TOML value in a text at `start`; what is no TOML value is a string.
fn parse_value(text: &str, start: usize) -> Result<Value<'_>, Diagnostic> {
    let start = start + (text.len() - text.trim_start().len());
    let text = text.trim();
    let span = start..start + text.len();
    if text.is_empty() {
        return Err(Diagnostic::new(span, "an override needs a value after `=`"));
    }
    match DeValue::parse(text) {
        Ok(value) => Ok(moved(value, start)),
        Err(error) if text.starts_with(['[', '{', '"', '\'']) => {
            let span = error.span().map_or(span, |s| moved_range(&s, start));
            Err(Diagnostic::new(span, error.message()))
        }
        Err(_) => Ok(Spanned::new(span, DeValue::String(Cow::Borrowed(text)))),
    }
}

/// Gives a key of a table another value.
fn replace<'t>(
    table: &mut DeTable<'t>,
    key: Key<'t>,
    mut value: Value<'t>,
) -> Result<(), Diagnostic> {
    // Where there are times, a list is no vector but has a value for each of them.
    let name: &str = key.get_ref();
    if let (Some(old), false) = (table.get(name), table.contains_key("times")) {
        value = in_place_of(old, value)?;
    }
    table.insert(key, value);
    Ok(())
}

/// Adds an element to a list of a table, which is made if it is not there.
fn add<'t>(table: &mut DeTable<'t>, key: Key<'t>, value: Value<'t>) -> Result<(), Diagnostic> {
    let span = key.span();
    let none = || Spanned::new(span.clone(), DeValue::Array(DeArray::new()));
    match table.entry(key).or_insert_with(none).get_mut() {
        DeValue::Array(array) => {
            array.push(value);
            Ok(())
        }
        _ => Err(Diagnostic::new(span, "only a list gets one more element")),
    }
}

/// What stands in place of an old value: for a vector a quantity of its dimension is its length, and its
/// direction stays.
fn in_place_of<'t>(old: &Value<'t>, value: Value<'t>) -> Result<Value<'t>, Diagnostic> {
    let lengthened = |vector: &DeArray<'t>, text: &str| {
        let (_, dimension) = units::parse(text).ok()?;
        let components = vector.iter().map(|component| {
            let text = match component.get_ref() {
                DeValue::String(text) => text.as_ref(),
                DeValue::Integer(number) => number.as_str(),
                DeValue::Float(number) => number.as_str(),
                _ => return None,
            };
            let (si, powers) = units::parse(text).ok()?;
            (powers == dimension || si == 0.0).then_some(si)
        });
        let components: Vec<f64> = components.collect::<Option<_>>()?;
        let (length, unit) = units::split(text).filter(|(_, unit)| !unit.is_empty())?;
        Some((components, length.parse::<f64>().ok()?, unit.to_owned()))
    };
    let (DeValue::Array(vector), DeValue::String(text)) = (old.get_ref(), value.get_ref()) else {
        return Ok(value);
    };
    let Some((components, length, unit)) = lengthened(vector, text) else {
        return Ok(value);
    };
    let norm = components.iter().fold(0.0, |n, c| libm::hypot(n, *c));
    if norm == 0.0 || !norm.is_finite() {
        let title =
            format!("the vector has no direction in the case: `{text}` cannot be its length");
        return Err(Diagnostic::new(value.span(), title));
    }
    let mut array = DeArray::new();
    for component in components {
        let text = format!("{} {unit}", length * (component / norm));
        array.push(Spanned::new(
            value.span(),
            DeValue::String(Cow::Owned(text)),
        ));
    }
    Ok(Spanned::new(value.span(), DeValue::Array(array)))
}

fn moved_range(span: &Range<usize>, by: usize) -> Range<usize> {
    span.start + by..span.end + by
}

/// The value with all its addresses moved by `by`.
fn moved(value: Value<'_>, by: usize) -> Value<'_> {
    let span = moved_range(&value.span(), by);
    let inner = match value.into_inner() {
        DeValue::Array(array) => {
            let mut shifted = DeArray::new();
            for element in array {
                shifted.push(moved(element, by));
            }
            DeValue::Array(shifted)
        }
        DeValue::Table(table) => DeValue::Table(
            table
                .into_iter()
                .map(|(key, value)| {
                    let span = moved_range(&key.span(), by);
                    (Spanned::new(span, key.into_inner()), moved(value, by))
                })
                .collect(),
        ),
        plain => plain,
    };
    Spanned::new(span, inner)
}

/// The entry of a table, made as an empty table if it is not there.
fn entry<'d, 't>(table: &'d mut DeTable<'t>, key: Key<'t>) -> &'d mut Value<'t> {
    let span = key.span();
    table
        .entry(key)
        .or_insert_with(|| Spanned::new(span, DeValue::Table(DeTable::new())))
}

fn child<'d, 't>(place: &'d mut Value<'t>, key: Key<'t>) -> Result<&'d mut Value<'t>, Diagnostic> {
    match place.get_mut() {
        DeValue::Table(table) => Ok(entry(table, key)),
        DeValue::Array(array) => {
            let index = element(array, &key)?;
            Ok(&mut array.as_mut()[index])
        }
        _ => Err(not_a_table(&key.span())),
    }
}

/// The index of the element that a key names by its `name` or by its position.
fn element(array: &DeArray<'_>, key: &Key<'_>) -> Result<usize, Diagnostic> {
    let word = key.get_ref().as_ref();
    let names: Vec<&str> = array
        .iter()
        .filter_map(|v| v.get_ref().get("name")?.get_ref().as_str())
        .collect();
    let by_name = array.iter().position(|element| {
        let name = element.get_ref().get("name");
        name.and_then(|n| n.get_ref().as_str()) == Some(word)
    });
    let by_index = word.parse().ok().filter(|i| *i < array.len());
    by_name
        .or(by_index)
        .ok_or_else(|| match (names.len(), array.len()) {
            (0, 0) => Diagnostic::new(key.span(), "there is no element in this list"),
            (0, n) => {
                let title = format!("there is no element `{word}` in this list");
                Diagnostic::new(key.span(), title).help(format!("the elements are 0 to {}", n - 1))
            }
            _ => Diagnostic::unknown(key.span(), "element", word, names),
        })
}

fn not_a_table(span: &Range<usize>) -> Diagnostic {
    Diagnostic::new(span.clone(), "there are no keys below a plain value")
}
