//! Quantities and texts as people read them.

use std::borrow::Cow;

/// Prefixes in steps of a thousand, largest first.
pub const PREFIXES: [(&str, f64); 9] = [
    ("T", 1e12),
    ("G", 1e9),
    ("M", 1e6),
    ("k", 1e3),
    ("", 1.0),
    ("m", 1e-3),
    ("µ", 1e-6),
    ("n", 1e-9),
    ("p", 1e-12),
];

/// Units that take a prefix, as the first factor of the whole unit.
const PREFIXABLE: [&str; 7] = ["Pa", "m", "s", "J", "N", "W", "Hz"];

/// Units of length that are no metres (m).
const OTHER_LENGTHS: [(&str, f64); 2] = [("in", 0.0254), ("ft", 0.3048)];

/// Longest plain number without its sign; longer ones have an exponent.
const LONGEST: usize = 8;

/// A unit chosen so that the numbers before it are short.
#[derive(Debug, Clone, PartialEq)]
pub struct Readable {
    /// SI value of one readable unit.
    pub size: f64,
    /// Its name; empty for a pure number.
    pub name: String,
}

impl Readable {
    /// The unit in which values up to `largest` (SI) are easy to read.
    #[must_use]
    pub fn new(unit: &str, largest: f64) -> Self {
        let unit = tidy(unit);
        if takes_prefix(&unit) {
            return Self::prefixed(&unit, largest);
        }
        if unit == "kg" && largest > 0.0 && largest < 1.0 {
            let gram = Self::prefixed("g", 1e3 * largest);
            return Self {
                size: 1e-3 * gram.size,
                ..gram
            };
        }
        let power = power_of_thousand(largest);
        let factor = match power {
            0 => String::new(),
            _ => format!("10{}", superscript(power)),
        };
        let name = match (factor.is_empty(), unit.is_empty()) {
            (true, _) => unit,
            (false, true) => factor,
            (false, false) => format!("{factor} {unit}"),
        };
        Self {
            size: 10_f64.powi(power),
            name,
        }
    }

    /// The largest prefix that leaves at least one unit, or a tenth for lengths and times, which
    /// read well so: 0.2 µs, 0.6 mm.
    fn prefixed(unit: &str, largest: f64) -> Self {
        let (least, top) = match unit {
            "s" => (0.1, 1.0),
            "m" => (0.1, 1e3),
            _ => (1.0, f64::INFINITY),
        };
        // Results of rounding, such as .99999999999999 mm, keep their unit.
        let reached = |size: f64| largest >= least * size * (1.0 - 1e-9);
        let fits = |prefix: &&(&str, f64)| prefix.1 <= top && reached(prefix.1);
        let (prefix, size) = PREFIXES.iter().find(fits).copied().unwrap_or(("", 1.0));
        Self {
            size,
            name: format!("{prefix}{unit}"),
        }
    }

    /// The unit of the axes of a picture that reaches so far (m): millimetres up to half a metre.
    #[must_use]
    pub fn axes(reach: f64) -> Self {
        Self::new("m", if reach < 0.5 { reach.min(0.05) } else { reach })
    }

    /// The unit of length of this size (m), if it has a name; else one that fits.
    #[must_use]
    pub fn length(size: f64) -> Self {
        let metric = PREFIXES.iter().chain(&[("c", 1e-2)]);
        let metric = metric.map(|(prefix, size)| (format!("{prefix}m"), *size));
        let known = metric.chain(OTHER_LENGTHS.map(|(name, size)| (name.to_owned(), size)));
        let same = |unit: &(String, f64)| (unit.1 / size - 1.0).abs() < 1e-9;
        match known.into_iter().find(same) {
            Some((name, size)) => Self { size, name },
            None => Self::new("m", size),
        }
    }

    /// `"pressure (GPa)"`.
    #[must_use]
    pub fn label(&self, quantity: &str) -> String {
        if self.name.is_empty() {
            quantity.to_owned()
        } else {
            format!("{quantity} ({})", self.name)
        }
    }

    /// A value in SI as a number of this unit with a number of decimals.
    #[must_use]
    pub fn number(&self, value: f64, decimals: usize) -> String {
        fixed(value / self.size, decimals)
    }

    /// A value in SI with this unit, in the syntax of the input: `"0.2 us"`.
    #[must_use]
    pub fn text(&self, value: f64) -> String {
        format!("{}{}", short(value / self.size), self.suffix())
    }

    /// Components in SI with this unit: `"[20, 20, 10.5] mm"`.
    #[must_use]
    pub fn vector(&self, components: &[f64]) -> String {
        let numbers: Vec<String> = components.iter().map(|x| short(x / self.size)).collect();
        format!("[{}]{}", numbers.join(", "), self.suffix())
    }

    /// The unit behind its number: a power of ten multiplies it.
    #[must_use]
    pub fn behind(&self) -> String {
        match self.name.as_str() {
            "" => String::new(),
            name if name.starts_with("10") => format!(" · {name}"),
            name => format!(" {name}"),
        }
    }

    fn suffix(&self) -> String {
        if self.name.is_empty() {
            return String::new();
        }
        let typed = self.name.replace('µ', "u");
        format!(" {}", typed.replace('²', "^2").replace('³', "^3"))
    }
}

/// The unit itself where it takes no prefix: numbers of texts may have exponents instead.
fn plain(unit: &str, largest: f64) -> Readable {
    let tidied = tidy(unit);
    if takes_prefix(&tidied) && largest.is_finite() {
        return Readable::prefixed(&tidied, largest);
    }
    Readable {
        size: 1.0,
        name: tidied,
    }
}

/// A value in SI with a unit that fits it, to five digits, in the syntax of the input: `"0.254
/// us"`, `"12.5 mm"`, `"2785 kg/m^3"`.
#[must_use]
pub fn shown(value: f64, unit: &str) -> String {
    plain(unit, value.abs()).text(value)
}

/// The same of a vector, with one unit: `"[0, 0, -7] km/s"`.
#[must_use]
pub fn shown_vector(components: &[f64], unit: &str) -> String {
    let largest = components.iter().fold(0.0, |most, x| x.abs().max(most));
    plain(unit, largest).vector(components)
}

/// A value in SI with a unit that fits it, as people read it: `"2.5 µs"`, `"3 · 10⁶ 1/s"`; `–` if it is no number.
#[must_use]
pub fn with_unit(value: f64, unit: &str) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let unit = Readable::new(unit, value.abs());
    format!("{}{}", short(value / unit.size), unit.behind())
}

/// A number to five digits, with an exponent where it would be long.
#[must_use]
pub fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.4e}").parse().unwrap_or(number);
    // No minus before zero.
    let plain = format!("{}", rounded + 0.0);
    if plain.trim_start_matches('-').len() <= LONGEST {
        plain
    } else {
        format!("{rounded:e}")
    }
}

/// A number with a true minus sign, and no minus before zero.
#[must_use]
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|b| b == b'0' || b == b'.') => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// `"kg/m^3"` as `"kg/m³"`, `"1"` and `"-"` as nothing.
#[must_use]
pub fn tidy(unit: &str) -> String {
    match unit.trim() {
        "1" | "-" | "none" => String::new(),
        unit => unit
            .replace("^2", "²")
            .replace("^3", "³")
            .replace("**2", "²")
            .replace("**3", "³")
            .replace('*', "·"),
    }
}

fn takes_prefix(unit: &str) -> bool {
    let head = unit.split(['/', '·', ' ']).next().unwrap_or_default();
    PREFIXABLE.contains(&head)
}

/// Exponent of the power of a thousand taken out of numbers that would be long: below 0.01 or
/// from 100,000 on.
fn power_of_thousand(largest: f64) -> i32 {
    if !largest.is_finite() || largest == 0.0 || (1e-2..1e5).contains(&largest) {
        return 0;
    }
    #[expect(clippy::cast_possible_truncation, reason = "within ±108")]
    let power = (largest.log10() / 3.0).floor() as i32;
    3 * power
}

/// A whole number in small raised digits.
#[must_use]
pub fn superscript(power: i32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    power
        .to_string()
        .bytes()
        .map(|b| match b {
            b'-' => '⁻',
            digit => digits[usize::from(digit - b'0')],
        })
        .collect()
}

/// `true` if a terminal prints a character as such: it is no control character, and neither parts
/// lines nor turns the direction of others.
#[must_use]
pub fn is_printable(c: char) -> bool {
    !(c.is_control()
        || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}'))
}

/// A text that does no more to a terminal than to show itself: what [`is_printable`] refuses, but
/// for line feeds and tabs, is written as `\u{1b}`.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, |c| c == '\n' || c == '\t')
}

/// The same without line feeds, for a text that may not begin a line of its own, such as a title.
#[must_use]
pub fn one_line(text: &str) -> Cow<'_, str> {
    escaped(text, |c| c == '\t')
}

/// A text with all escaped that is neither printable nor `allowed`.
fn escaped(text: &str, allowed: impl Fn(char) -> bool) -> Cow<'_, str> {
    let harmless = |c: char| is_printable(c) || allowed(c);
    if text.chars().all(harmless) {
        return Cow::Borrowed(text);
    }
    let mut clean = String::with_capacity(text.len());
    for c in text.chars() {
        if harmless(c) {
            clean.push(c);
        } else {
            clean.extend(c.escape_unicode());
        }
    }
    Cow::Owned(clean)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(unit: &str, largest: f64) -> String {
        Readable::new(unit, largest).name
    }

    #[test]
    fn picks_prefixes_that_keep_numbers_short() {
        assert_eq!(name("Pa", 97.6e9), "GPa");
        assert_eq!(name("Pa", 0.26e9), "MPa");
        assert_eq!(name("m/s", 7000.0), "km/s");
        assert_eq!(name("s", 0.2e-6), "µs");
        assert_eq!(name("s", 1.0), "s");
        assert_eq!(name("m", 1.5e-3), "mm");
        assert_eq!(name("m", 0.584), "m");
        assert_eq!(name("J/kg", 2.4e7), "MJ/kg");
        assert_eq!(name("kg/m^3", 2785.0), "kg/m³");
        assert_eq!(name("kg", 8e-8), "µg");
        assert_eq!(name("kg", 0.3), "g");
        assert_eq!(name("kg", 3.0), "kg");
        assert_eq!(name("kg m/s", 3e-9), "10⁻⁹ kg m/s");
        assert_eq!(Readable::axes(0.3).name, "mm");
        assert_eq!(Readable::axes(0.584).name, "m");
        assert_eq!(Readable::axes(2e-5).name, "µm");
        assert_eq!(with_unit(1e-5, "s"), "10 µs");
        assert_eq!(with_unit(3e7, "1/s"), "30 · 10⁶ 1/s");
        assert_eq!(name("1", 0.3), "");
        assert_eq!(name("1", 0.0), "");
        assert_eq!(name("1/s", 3e7), "10⁶ 1/s");
        assert_eq!(name("K", 9000.0), "K");
        assert_eq!(name("Pa", 0.0), "Pa");
    }

    #[test]
    fn texts_have_short_numbers_and_units_that_an_input_takes() {
        for (value, unit, text) in [
            (2e-7, "s", "0.2 us"),
            (1.234_567e-5, "s", "12.346 us"),
            (0.0, "s", "0 s"),
            (4.2e-3, "s", "4.2 ms"),
            (1e30, "s", "1e30 s"),
            (1e-30, "s", "1e-30 s"),
            (f64::INFINITY, "s", "inf s"),
            (50.0, "m", "50 m"),
            (5e-5, "m", "50 um"),
            (0.1 * 3.0, "m", "0.3 m"),
            (-7000.0, "m/s", "-7 km/s"),
            (2785.0, "kg/m^3", "2785 kg/m^3"),
            (1e300, "kg/m^3", "1e300 kg/m^3"),
            (0.1 + 0.2, "", "0.3"),
        ] {
            assert_eq!(shown(value, unit), text);
        }
        assert_eq!(
            shown_vector(&[0.0, -1e-9, -7e3], "m/s"),
            "[0, -1e-12, -7] km/s"
        );
        assert_eq!(short(1e39), "1e39");
        assert_eq!(short(123_456_789.0), "1.2346e8");
        assert_eq!(short(-0.012_345_6), "-0.012346");
        assert_eq!(short(-0.0), "0");
    }

    #[test]
    fn a_length_keeps_the_unit_that_it_was_given_in() {
        assert_eq!(Readable::length(1e-2).text(0.25), "25 cm");
        assert_eq!(
            Readable::length(1e-3).vector(&[0.2, 0.0105]),
            "[200, 10.5] mm"
        );
        assert_eq!(Readable::length(0.0254).text(0.000_508), "0.02 in");
        assert_eq!(Readable::length(0.025).name, "mm");
    }

    #[test]
    fn numbers_carry_a_true_minus_sign() {
        assert_eq!(fixed(-0.25, 2), "−0.25");
        assert_eq!(fixed(-1e-9, 1), "0.0");
    }

    #[test]
    fn texts_for_a_terminal_have_no_control_characters() {
        assert_eq!(printable("two\n\tlines: κ, 1 mm"), "two\n\tlines: κ, 1 mm");
        let hostile = "a\u{1b}[2J\r\u{9b}1m\u{202e}b\u{7}";
        let clean = printable(hostile);
        assert!(clean.chars().all(is_printable), "{clean}");
        assert!(clean.starts_with("a\\u{1b}[2J"), "{clean}");
        assert_eq!(one_line("a °\nb\tc"), "a °\\u{a}b\tc");
    }
}
