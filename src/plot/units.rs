//! Units as people read and type them, with the prefix that keeps numbers short.

use super::PlotError;

/// Prefixes in steps of a thousand, largest first.
const PREFIXES: [(&str, f64); 9] = [
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
    pub fn new(unit: &str, largest: f64) -> Self {
        let unit = tidy(unit);
        let head = unit.split(['/', '·', ' ']).next().unwrap_or_default();
        if PREFIXABLE.contains(&head) {
            return Self::prefixed(&unit, largest);
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
        let fits = |prefix: &&(&str, f64)| prefix.1 <= top && largest >= least * prefix.1;
        let (prefix, size) = PREFIXES.iter().find(fits).copied().unwrap_or(("", 1.0));
        Self {
            size,
            name: format!("{prefix}{unit}"),
        }
    }

    /// `"pressure (GPa)"`.
    pub fn label(&self, quantity: &str) -> String {
        if self.name.is_empty() {
            quantity.to_owned()
        } else {
            format!("{quantity} ({})", self.name)
        }
    }

    /// A value in SI as a number of this unit with a number of decimals.
    pub fn number(&self, value: f64, decimals: usize) -> String {
        fixed(value / self.size, decimals)
    }
}

/// A number with a true minus sign, and no minus before zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|b| b == b'0' || b == b'.') => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// The number of decimals that shows about three digits of `largest`.
pub fn decimals(largest: f64) -> usize {
    match largest.abs() {
        x if x >= 100.0 => 0,
        x if x >= 10.0 => 1,
        x if x >= 1.0 => 2,
        _ => 3,
    }
}

/// Times (s) with one unit and as many digits for all.
pub fn times(times: &[f64]) -> Vec<String> {
    let largest = times.iter().copied().fold(0.0, f64::max);
    let unit = Readable::new("s", largest);
    // As few decimals as tell each time to two thousandths of the largest.
    let most = match largest {
        0.0 => 0,
        largest => decimals(largest / unit.size),
    };
    let exact = |&decimals: &usize| {
        let size = 10_f64.powi(i32::try_from(decimals).unwrap_or(0)) / unit.size;
        times
            .iter()
            .all(|t| ((t * size).round() / size - t).abs() <= 2e-3 * largest)
    };
    let decimals = (0..most).find(exact).unwrap_or(most);
    let text = |&time: &f64| format!("{} {}", unit.number(time, decimals), unit.name);
    times.iter().map(text).collect()
}

/// Reads `"0.1 mm"` for a quantity whose SI unit is `unit`; zero and pure numbers need no unit.
///
/// # Errors
/// [`PlotError::Quantity`] if the text is no number or its unit is another or missing.
pub fn parse(text: &str, unit: &str) -> Result<f64, PlotError> {
    let (number, suffix) = split(text);
    quantity(text, number, suffix, unit)
}

/// Reads `"0:100 GPa"`, `"-1:2"`, `"0 mm:3 mm"`: a number without a unit takes the last one's.
pub fn parse_span(text: &str, last_unit: Option<&str>, unit: &str) -> Result<[f64; 2], PlotError> {
    let wrong = || PlotError::Quantity {
        text: text.to_owned(),
        expected: format!("a range LOW:HIGH with LOW < HIGH{}", in_unit(unit)),
    };
    let (low, high) = text.split_once(':').ok_or_else(wrong)?;
    let (high_number, high_suffix) = split(high);
    let common = if high_suffix.is_empty() {
        last_unit.unwrap_or_default()
    } else {
        high_suffix
    };
    let (low_number, low_suffix) = split(low);
    let low_suffix = if low_suffix.is_empty() {
        common
    } else {
        low_suffix
    };
    let span = [
        quantity(text, low_number, low_suffix, unit)?,
        quantity(text, high_number, common, unit)?,
    ];
    if span[0] < span[1] {
        Ok(span)
    } else {
        Err(wrong())
    }
}

/// Splits `"0.1 mm"` into its number and its unit.
pub fn split(text: &str) -> (&str, &str) {
    let text = text.trim();
    let numeric = |(i, c): &(usize, char)| {
        let exponent = matches!(c, 'e' | 'E')
            && text[i + 1..].starts_with(|d: char| d.is_ascii_digit() || d == '-' || d == '+');
        !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+') || exponent)
    };
    let end = text
        .char_indices()
        .find(numeric)
        .map_or(text.len(), |(i, _)| i);
    (text[..end].trim(), text[end..].trim())
}

fn quantity(text: &str, number: &str, suffix: &str, unit: &str) -> Result<f64, PlotError> {
    let wrong = || PlotError::Quantity {
        text: text.to_owned(),
        expected: format!("a number{}", in_unit(unit)),
    };
    let value: f64 = number.parse().map_err(|_| wrong())?;
    if !value.is_finite() {
        return Err(wrong());
    }
    let plain = |unit: &str| {
        tidy(unit)
            .replace('²', "2")
            .replace('³', "3")
            .replace('u', "µ")
    };
    let (unit, suffix) = (plain(unit), plain(suffix));
    if suffix == unit || (suffix.is_empty() && value == 0.0) {
        return Ok(value);
    }
    let prefix = suffix.strip_suffix(&unit).filter(|_| !unit.is_empty());
    let size = match prefix {
        Some("c") => Some(1e-2),
        Some(prefix) => PREFIXES.iter().find(|p| p.0 == prefix).map(|p| p.1),
        None => None,
    };
    size.map(|size| value * size).ok_or_else(wrong)
}

fn in_unit(unit: &str) -> String {
    match tidy(unit) {
        unit if unit.is_empty() => " without a unit".to_owned(),
        unit => {
            let example = match unit.as_str() {
                "m" => "mm",
                "s" => "us",
                "Pa" => "GPa",
                other => other,
            };
            format!(" with a unit of {unit}, as in \"1 {example}\"")
        }
    }
}

/// `"kg/m^3"` as `"kg/m³"`, `"1"` and `"-"` as nothing.
fn tidy(unit: &str) -> String {
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
        assert_eq!(name("1", 0.3), "");
        assert_eq!(name("1", 0.0), "");
        assert_eq!(name("1/s", 3e7), "10⁶ 1/s");
        assert_eq!(name("K", 9000.0), "K");
        assert_eq!(name("Pa", 0.0), "Pa");
    }

    #[test]
    fn reads_quantities_with_prefixes() {
        assert!((parse("0.1 mm", "m").unwrap() - 1e-4).abs() < 1e-18);
        assert!((parse("-2cm", "m").unwrap() + 0.02).abs() < 1e-15);
        assert!((parse("0.2us", "s").unwrap() - 2e-7).abs() < 1e-18);
        assert!((parse("1e2 GPa", "Pa").unwrap() - 1e11).abs() < 1.0);
        assert!((parse("5 km/s", "m/s").unwrap() - 5e3).abs() < 1e-9);
        assert!((parse("2700 kg/m3", "kg/m^3").unwrap() - 2700.0).abs() < 1e-9);
        assert!(parse("0", "m").unwrap().abs() < 1e-300);
        assert!(parse("0.1", "m").unwrap_err().to_string().contains("unit"));
        assert!(parse("3 GPa", "m").is_err());
        assert!(parse("µ", "m").is_err());
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "products of small integers are exact")]
    fn a_range_shares_its_last_unit() {
        assert_eq!(parse_span("-1:2", None, "1").unwrap(), [-1.0, 2.0]);
        assert_eq!(parse_span("0:3 km/s", None, "m/s").unwrap(), [0.0, 3000.0]);
        assert_eq!(
            parse_span("1 m/s:3 km/s", None, "m/s").unwrap(),
            [1.0, 3000.0]
        );
        assert!(parse_span("3:1 km/s", None, "m/s").is_err());
        assert!(parse_span("3 km/s", None, "m/s").is_err());
    }

    #[test]
    fn numbers_carry_a_true_minus_sign() {
        assert_eq!(fixed(-0.25, 2), "−0.25");
        assert_eq!(fixed(-1e-9, 1), "0.0");
    }
}
