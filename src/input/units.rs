//! Numbers with a unit: `"7 km/s"`, `"0.2 Mbar"`, `"2.785 g/cm^3"`.
//!
//! A unit is a product of powers of the symbols in [`SYMBOLS`], each with an optional prefix of
//! [`PREFIXES`], so that every combination a user may think of is understood. Powers of ten are
//! added to the number's own exponent before it is read: `"0.02 mm"` is exactly `2e-5`.

/// Exponents of metre, kilogram, second, kelvin and radian.
pub type Powers = [i32; 5];

/// Symbol, dimension, decimal exponent and factor with respect to SI.
const SYMBOLS: &[(&str, Powers, i32, f64)] = &[
    ("m", [1, 0, 0, 0, 0], 0, 1.0),
    ("g", [0, 1, 0, 0, 0], -3, 1.0),
    ("s", [0, 0, 1, 0, 0], 0, 1.0),
    ("K", [0, 0, 0, 1, 0], 0, 1.0),
    ("rad", [0, 0, 0, 0, 1], 0, 1.0),
    ("deg", [0, 0, 0, 0, 1], 0, std::f64::consts::PI / 180.0),
    ("°", [0, 0, 0, 0, 1], 0, std::f64::consts::PI / 180.0),
    ("N", [1, 1, -2, 0, 0], 0, 1.0),
    ("dyn", [1, 1, -2, 0, 0], -5, 1.0),
    ("J", [2, 1, -2, 0, 0], 0, 1.0),
    ("erg", [2, 1, -2, 0, 0], -7, 1.0),
    ("W", [2, 1, -3, 0, 0], 0, 1.0),
    ("Pa", [-1, 1, -2, 0, 0], 0, 1.0),
    ("bar", [-1, 1, -2, 0, 0], 5, 1.0),
];

/// Prefixes and their powers of ten.
const PREFIXES: &[(&str, i32)] = &[
    ("T", 12),
    ("G", 9),
    ("M", 6),
    ("k", 3),
    ("c", -2),
    ("m", -3),
    ("u", -6),
    ("µ", -6), // micro sign
    ("μ", -6), // Greek mu
    ("n", -9),
    ("p", -12),
];

/// Longest text of a number with its unit (bytes): nobody writes more, and nothing that is read
/// from less can overflow.
const LONGEST: usize = 200;
/// Largest decimal exponent that is told from infinity.
const LARGEST_EXPONENT: i32 = 100_000;

/// Value in SI units and dimension of a number with an optional unit.
pub fn parse(text: &str) -> Result<(f64, Powers), String> {
    let text = text.trim();
    if text.len() > LONGEST {
        let begin: String = text.chars().take(20).collect();
        return Err(format!("`{begin}…` is too long for a number with a unit"));
    }
    let (mantissa, exponent, rest) =
        split_number(text).ok_or_else(|| format!("`{text}` does not begin with a number"))?;
    let mut unit = Unit::default();
    let left = unit.read(rest, 1)?;
    if !left.is_empty() {
        return Err(format!(
            "`{left}` in the unit `{}` is not understood",
            rest.trim()
        ));
    }
    let exponent = exponent + unit.exponent;
    let value: f64 = format!("{mantissa}e{exponent}")
        .parse()
        .map_err(|_| format!("`{mantissa}` is not a number"))?;
    let value = value * unit.factor;
    if value.is_finite() {
        Ok((value, unit.powers))
    } else {
        Err(format!("`{text}` is too large"))
    }
}

/// One of the unit that a number is written with, in SI units.
pub fn unit_of(text: &str) -> f64 {
    let unit = split_number(text.trim()).map_or("", |(_, _, unit)| unit);
    parse(&format!("1{unit}")).map_or(1.0, |(size, _)| size)
}

/// Mantissa, decimal exponent and what follows the number.
fn split_number(text: &str) -> Option<(&str, i32, &str)> {
    let digits = |s: &str| s.bytes().take_while(u8::is_ascii_digit).count();
    let sign = usize::from(text.starts_with(['+', '-']));
    let whole = digits(&text[sign..]);
    let mut end = sign + whole;
    let mut count = whole;
    if text[end..].starts_with('.') {
        let fraction = digits(&text[end + 1..]);
        end += 1 + fraction;
        count += fraction;
    }
    if count == 0 {
        return None;
    }
    let (mantissa, rest) = text.split_at(end);
    if let Some(power) = rest.strip_prefix(['e', 'E']) {
        let signed = usize::from(power.starts_with(['+', '-']));
        let length = digits(&power[signed..]);
        if length > 0 {
            let (exponent, rest) = power.split_at(signed + length);
            let most = LARGEST_EXPONENT;
            let beyond = if power.starts_with('-') { -most } else { most };
            let exponent: i32 = exponent.parse().unwrap_or(beyond);
            return Some((mantissa, exponent.clamp(-most, most), rest));
        }
    }
    Some((mantissa, 0, rest))
}

/// A unit while it is read.
struct Unit {
    powers: Powers,
    exponent: i32,
    factor: f64,
}

impl Default for Unit {
    fn default() -> Self {
        Self {
            powers: [0; 5],
            exponent: 0,
            factor: 1.0,
        }
    }
}

impl Unit {
    /// Multiplies by the product in `text`, to the power `sign`, and returns what follows it:
    /// nothing or a closing parenthesis.
    fn read<'a>(&mut self, text: &'a str, sign: i32) -> Result<&'a str, String> {
        let mut rest = text.trim_start();
        let mut factor_sign = sign;
        // A divisor may come first: `1/s`.
        if let Some(after) = rest.strip_prefix('/') {
            (rest, factor_sign) = (after.trim_start(), -sign);
            if rest.is_empty() {
                return Err(format!("the unit `{}` ends too early", text.trim()));
            }
        }
        while !rest.is_empty() && !rest.starts_with(')') {
            if let Some(inner) = rest.strip_prefix('(') {
                let after = self.read(inner, factor_sign)?;
                rest = after
                    .strip_prefix(')')
                    .ok_or("a parenthesis is not closed")?;
            } else {
                rest = self.read_symbol(rest, factor_sign)?;
            }
            rest = rest.trim_start();
            factor_sign = sign;
            if let Some(after) = rest.strip_prefix('/') {
                (rest, factor_sign) = (after.trim_start(), -sign);
            } else if let Some(after) = rest.strip_prefix(['*', '·']) {
                rest = after.trim_start();
            } else {
                continue;
            }
            if rest.is_empty() {
                return Err(format!("the unit `{}` ends too early", text.trim()));
            }
        }
        Ok(rest)
    }

    /// One symbol and its power: `cm^3`, `cm3`, `m²`, `s^-1`.
    fn read_symbol<'a>(&mut self, text: &'a str, sign: i32) -> Result<&'a str, String> {
        let is_letter = |c: char| c.is_alphabetic() || c == '°';
        let end = text.find(|c| !is_letter(c)).unwrap_or(text.len());
        let (name, rest) = text.split_at(end);
        let (powers, exponent, factor) = find_symbol(name).ok_or_else(|| {
            let shown = if name.is_empty() { text } else { name };
            format!("unknown unit `{shown}`")
        })?;
        let (power, rest) = split_power(rest)?;
        let power = power * sign;
        for (sum, p) in self.powers.iter_mut().zip(powers) {
            *sum += power * p;
        }
        self.exponent += power * exponent;
        for _ in 0..power.unsigned_abs() {
            self.factor = if power > 0 {
                self.factor * factor
            } else {
                self.factor / factor
            };
        }
        Ok(rest)
    }
}

fn split_power(text: &str) -> Result<(i32, &str), String> {
    for (superscript, power) in [("²", 2), ("³", 3)] {
        if let Some(rest) = text.strip_prefix(superscript) {
            return Ok((power, rest));
        }
    }
    let (marked, digits) = match text.strip_prefix('^') {
        Some(after) => (true, after),
        None => (false, text),
    };
    let sign = usize::from(marked && digits.starts_with('-'));
    let end = sign
        + digits[sign..]
            .bytes()
            .take_while(u8::is_ascii_digit)
            .count();
    match digits[..end].parse::<i32>() {
        Ok(power) if power.abs() <= 9 => Ok((power, &digits[end..])),
        Err(_) if !marked && end == 0 => Ok((1, text)),
        _ => Err(format!("`{text}` is not a power of a unit")),
    }
}

fn find_symbol(name: &str) -> Option<(Powers, i32, f64)> {
    let find = |symbol: &str| SYMBOLS.iter().find(|(s, ..)| *s == symbol);
    if let Some(&(_, powers, exponent, factor)) = find(name) {
        return Some((powers, exponent, factor));
    }
    PREFIXES.iter().find_map(|(prefix, more)| {
        let &(_, powers, exponent, factor) = find(name.strip_prefix(prefix)?)?;
        Some((powers, exponent + more, factor))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_compose() {
        assert_eq!(parse("896 J/(kg K)").unwrap(), (896.0, [2, 0, -2, -1, 0]));
        assert_eq!(parse("3.5 kJ/g").unwrap(), (3.5e6, [2, 0, -2, 0, 0]));
        assert_eq!(parse("1 g/(cm us^2)").unwrap(), (1e11, [-1, 1, -2, 0, 0]));
        assert_eq!(parse("1 g cm^-1·us^-2").unwrap(), (1e11, [-1, 1, -2, 0, 0]));
        assert_eq!(parse("6.5 /s").unwrap(), (6.5, [0, 0, -1, 0, 0]));
        assert_eq!(parse("2/Mbar").unwrap(), (2e-11, [1, -1, 2, 0, 0]));
        assert!(parse("1/").unwrap_err().contains("ends too early"));
        assert_eq!(parse("300 K").unwrap(), (300.0, [0, 0, 0, 1, 0]));
        assert_eq!(parse("-.5").unwrap(), (-0.5, [0; 5]));
    }
}
