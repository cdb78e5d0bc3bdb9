//! Units as people read and type them, with the prefix that keeps numbers short.

use super::PlotError;
use crate::model::readable::{PREFIXES, tidy};
pub use crate::model::readable::{Readable, fixed, superscript};

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
/// [`PlotError::Quantity`] if the text is not a number or its unit is another or missing.
pub fn parse(text: &str, unit: &str) -> Result<f64, PlotError> {
    let (number, suffix) = split(text);
    quantity(text, number, suffix, unit)
}

/// Reads `"0:100 GPa"`, `"-1:2"`, `"0 mm:3 mm"`: a number without a unit takes the last one's.
pub fn parse_span(text: &str, last_unit: Option<&str>, unit: &str) -> Result<[f64; 2], PlotError> {
    let wrong = || {
        PlotError::quantity(
            text,
            format!("a range LOW:HIGH with LOW < HIGH{}", in_unit(unit)),
        )
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
    let wrong = || PlotError::quantity(text, format!("a number{}", in_unit(unit)));
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
