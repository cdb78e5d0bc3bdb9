//! Units as people read and type them, with the prefix that keeps numbers short.

use super::PlotError;
use model::readable::tidy;
pub use model::readable::{Readable, fixed, superscript};
use model::units;

/// The number of decimals that shows about three digits of `largest`.
#[must_use]
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
    // As few decimals as separate each time to two thousandths of the largest.
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

/// Reads `"0.1 mm"` for a quantity of the unit `unit`, in that unit; zero and pure numbers need no
/// unit.
///
/// # Errors
/// [`PlotError::Quantity`] if the text is not a number or its unit is another or missing.
pub fn parse(text: &str, unit: &str) -> Result<f64, PlotError> {
    number(text, unit)
        .ok_or_else(|| PlotError::quantity(text, format!("a number{}", in_unit(unit))))
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
    let common = match unit_behind(high) {
        "" => last_unit.unwrap_or_default(),
        own => own,
    };
    let end = |end: &str| {
        let value = match unit_behind(end) {
            "" => number(&format!("{end} {common}"), unit),
            _ => number(end, unit),
        };
        value.ok_or_else(|| no_number(text, unit))
    };
    let span = [end(low)?, end(high)?];
    if span[0] < span[1] {
        Ok(span)
    } else {
        Err(wrong())
    }
}

/// The unit of `"0.1 mm"`; nothing if there is none.
pub fn unit_behind(text: &str) -> &str {
    units::split(text).map_or("", |(_, unit)| unit)
}

fn no_number(text: &str, unit: &str) -> PlotError {
    PlotError::quantity(text, format!("a number{}", in_unit(unit)))
}

fn number(text: &str, unit: &str) -> Option<f64> {
    let unit = tidy(unit);
    let (digits, suffix) = units::split(text)?;
    if tidy(suffix) == unit {
        // Any of its meanings in tables of other programs.
        return digits.parse().ok().filter(|value: &f64| value.is_finite());
    }
    let (value, powers) = units::parse(text).ok()?;
    if value == 0.0 && suffix.is_empty() {
        return Some(0.0);
    }
    let one = match unit.strip_prefix('1') {
        Some(divisor) => format!("1{divisor}"),
        None => format!("1 {unit}"),
    };
    let (size, own) = units::parse(&one).ok()?;
    (powers == own).then(|| value / size)
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
        assert!(parse("nan m", "m").is_err());
        assert!(parse("1e999 m", "m").is_err());
        assert_eq!(
            parse("0.5 in", "m").unwrap().to_bits(),
            0.0127_f64.to_bits()
        );
        assert!((parse("20 °C", "K").unwrap() - 293.15).abs() < 1e-12);
        assert!((parse("1 dyn/cm^2", "Pa").unwrap() - 0.1).abs() < 1e-15);
        // Of tables of others.
        assert!((parse("2 mm", "cm").unwrap() - 0.2).abs() < 1e-15);
        assert!((parse("3 counts", "counts").unwrap() - 3.0).abs() < 1e-15);
        assert!(parse("3", "counts").is_err());
        assert!((parse("3 1/s", "1/s").unwrap() - 3.0).abs() < 1e-15);
        assert!((parse("3/us", "1/s").unwrap() - 3e6).abs() < 1e-9);
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
