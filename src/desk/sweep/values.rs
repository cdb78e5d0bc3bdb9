//! The values of a key in a sweep: a list, or a range of numbers.

use model::units::{self, Powers};

/// The default number of values of a range.
const VALUES: usize = 5;
/// Values of one key at most: more are a slip.
const MOST: usize = 100_000;

/// A value as a case takes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// As typed: `3 km/s`, `potential`, `[0, 0, 1]`.
    pub text: String,
    /// The same in SI units, if it is a number, with its dimension.
    pub number: Option<(f64, Powers)>,
}

impl Value {
    /// Reads a value.
    #[must_use]
    pub fn new(text: &str) -> Self {
        Self {
            text: text.to_owned(),
            number: units::parse(text).ok(),
        }
    }
}

/// A range of numbers with a unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Range {
    /// Both ends, in the unit as typed.
    pub ends: [f64; 2],
    /// The unit as typed; empty for none.
    pub unit: String,
}

impl Range {
    /// A number of it in its unit, with as many digits as separate it from its neighbours.
    #[must_use]
    pub fn value(&self, number: f64) -> Value {
        // Below a hundred-thousandth of the range it is round-off.
        let width = (self.ends[1] - self.ends[0]).abs();
        let digits = (8.0 - width.log10().floor()).clamp(0.0, 17.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 17
        let text = format!("{number:.*}", digits as usize);
        let number = match text.split_once('.') {
            Some(_) => text.trim_end_matches('0').trim_end_matches('.'),
            None => &text,
        };
        let space = if self.unit.is_empty() { "" } else { " " };
        Value::new(&format!("{number}{space}{}", self.unit))
    }
}

/// The values of a key.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Some values.
    List(Vec<Value>),
    /// So many numbers at even distances.
    Range(Range, usize),
}

impl Values {
    /// Reads `3, 5, 7 km/s` (a unit at the end holds for numbers without), `3..9 km/s` (five
    /// values) or `3..9/7 km/s` (seven). Dots of a path and in quotes are no range.
    ///
    /// # Errors
    /// A message on a text of another form.
    pub fn parse(text: &str) -> Result<Self, String> {
        if let Some((from, rest)) = text.split_once("..")
            && !(text.contains(['"', '\'']) || from.ends_with('/') || rest.starts_with('/'))
        {
            return range(from, rest);
        }
        let texts = split(text);
        let texts: Vec<&str> = texts.into_iter().map(str::trim).collect();
        if texts.iter().any(|text| text.is_empty()) {
            return Err(format!("`{text}` has an empty value"));
        }
        if texts.len() > MOST {
            return Err(format!("more than {MOST} values"));
        }
        let last = texts.last().copied().unwrap_or_default();
        let unit = units::split(last).map_or("", |(_, unit)| unit);
        let with_unit = |text: &str| {
            let is_bare = text.parse::<f64>().is_ok();
            if is_bare && last.parse::<f64>().is_err() && units::parse(last).is_ok() {
                Value::new(&format!("{text} {unit}"))
            } else {
                Value::new(text)
            }
        };
        Ok(Self::List(texts.into_iter().map(with_unit).collect()))
    }

    /// All of them, in order.
    #[must_use]
    pub fn all(&self) -> Vec<Value> {
        match self {
            Self::List(values) => values.clone(),
            Self::Range(range, count) => {
                let [from, to] = range.ends;
                #[allow(clippy::cast_precision_loss)] // far below 2^53
                let at = |k: usize| from + (to - from) * (k as f64 / (count - 1) as f64);
                (0..*count).map(|k| range.value(at(k))).collect()
            }
        }
    }
}

/// Reads both sides of `..`.
fn range(from: &str, rest: &str) -> Result<Values, String> {
    let number = |text: &str| {
        let parsed = text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        parsed.ok_or_else(|| format!("`{}` is no number", text.trim()))
    };
    let rest = rest.trim();
    let (to, after) = units::split(rest).unwrap_or((rest, ""));
    let (count, unit) = match after.strip_prefix('/') {
        None => (VALUES, after.trim()),
        Some(after) => {
            let end = after
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(after.len());
            let (count, unit) = after.split_at(end);
            let parsed = count.parse::<usize>().ok();
            let count = parsed
                .filter(|n| (2..=MOST).contains(n))
                .ok_or_else(|| format!("`{count}` is no count of values, which is 2 to {MOST}"))?;
            (count, unit.trim())
        }
    };
    // Either end may have the unit.
    let from = match units::split(from) {
        Some((number, own)) if own == unit => number,
        _ => from,
    };
    let range = Range {
        ends: [number(from)?, number(to)?],
        unit: unit.to_owned(),
    };
    if range.ends[0] == range.ends[1] {
        return Err("a range needs two different ends".to_owned());
    }
    units::parse(&format!("1 {unit}"))?;
    Ok(Values::Range(range, count))
}

/// Parts between commas outside brackets and quotes.
fn split(text: &str) -> Vec<&str> {
    let (mut parts, mut begin, mut depth, mut quote) = (Vec::new(), 0, 0_usize, None);
    for (at, c) in text.char_indices() {
        match (quote, c) {
            (Some(q), _) if c == q => quote = None,
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{' | '(') => depth += 1,
            (None, ']' | '}' | ')') => depth = depth.saturating_sub(1),
            (None, ',') if depth == 0 => {
                parts.push(&text[begin..at]);
                begin = at + 1;
            }
            (Some(_) | None, _) => {}
        }
    }
    parts.push(&text[begin..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<String> {
        let values = Values::parse(text).unwrap().all();
        values.into_iter().map(|value| value.text).collect()
    }

    #[test]
    fn lists_and_ranges_become_values_with_units() {
        assert_eq!(texts("3, 5,7 km/s"), ["3 km/s", "5 km/s", "7 km/s"]);
        assert_eq!(texts("30 deg, 1 rad"), ["30 deg", "1 rad"]);
        assert_eq!(texts("overlap, potential"), ["overlap", "potential"]);
        assert_eq!(texts("[1, 2], [3, 4]"), ["[1, 2]", "[3, 4]"]);
        assert_eq!(texts("\"a, b\""), ["\"a, b\""]);
        assert_eq!(
            texts("3..9/4 km/s"),
            ["3 km/s", "5 km/s", "7 km/s", "9 km/s"]
        );
        assert_eq!(texts("3 km/s..9 km/s"), texts("3..9 km/s"));
        assert_eq!(texts("1e3, 2.5e3 m/s"), ["1e3 m/s", "2.5e3 m/s"]);
        assert_eq!(texts("1e-3..2e-3/2 m"), ["0.001 m", "0.002 m"]);
        assert_eq!(texts("../a.csv, b/../c.csv"), ["../a.csv", "b/../c.csv"]);
        assert_eq!(texts("\"a..b\""), ["\"a..b\""]);
        assert_eq!(texts("0..1"), ["0", "0.25", "0.5", "0.75", "1"]);
        assert_eq!(texts("-1e-3, 2e-3"), ["-1e-3", "2e-3"]);
        assert_eq!(texts("0.1..0.4/4"), ["0.1", "0.2", "0.3", "0.4"]);
        let si = Value::new("3 km/s").number.unwrap().0;
        assert_eq!(si, 3000.0);
    }

    #[test]
    fn what_is_no_list_and_no_range_is_refused() {
        for (text, part) in [
            ("", "empty"),
            ("1,,2", "empty"),
            ("1..1", "different"),
            ("a..2", "no number"),
            ("1..b", "no number"),
            ("1..2/1", "count"),
            ("1..2/x", "count"),
            ("1..2/99999999999999999999", "count"),
            ("1..2 parsec", "parsec"),
            ("nan..2", "no number"),
        ] {
            let message = Values::parse(text).unwrap_err();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
