//! Numbers with a unit: `"7 km/s"`, `"0.2 Mbar"`, `"2.785 g/cm^3"`.
//!
//! A unit is a product of powers of the symbols in `SYMBOLS`, each with an optional prefix of
//! `PREFIXES`, so that every combination a user may think of is understood. Powers of ten are
//! added to the number's own exponent before it is read: `"0.02 mm"` is exactly `2e-5`, and `"0.5
//! in"` exactly `0.0127`.
//!
//! A degree Celsius that is the whole unit makes a temperature (`"20 °C"` is 293.15 K); in a product
//! it is the difference of one kelvin (`"896 J/(kg °C)"`).

/// Exponents of metre, kilogram, second, kelvin and radian.
pub type Powers = [i32; 5];

/// Symbol, dimension, decimal exponent and factor with respect to SI. The inch, the pound and its
/// force are what they are defined to be: .0254 m, .45359237 kg and 4.4482216152605 N.
const SYMBOLS: &[(&str, Powers, i32, f64)] = &[
    ("m", [1, 0, 0, 0, 0], 0, 1.0),
    ("in", [1, 0, 0, 0, 0], -4, 254.0),
    ("inch", [1, 0, 0, 0, 0], -4, 254.0),
    ("ft", [1, 0, 0, 0, 0], -4, 3048.0),
    ("g", [0, 1, 0, 0, 0], -3, 1.0),
    ("lb", [0, 1, 0, 0, 0], -8, 45_359_237.0),
    ("s", [0, 0, 1, 0, 0], 0, 1.0),
    ("min", [0, 0, 1, 0, 0], 0, 60.0),
    ("h", [0, 0, 1, 0, 0], 2, 36.0),
    ("K", [0, 0, 0, 1, 0], 0, 1.0),
    ("°C", [0, 0, 0, 1, 0], 0, 1.0),
    ("degC", [0, 0, 0, 1, 0], 0, 1.0),
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
    ("psi", [-1, 1, -2, 0, 0], 0, POUND_PER_INCH2),
    ("ksi", [-1, 1, -2, 0, 0], 3, POUND_PER_INCH2),
];

/// 4.4482216152605 N over (.0254 m)².
const POUND_PER_INCH2: f64 = 6_894.757_293_168_361;
/// The degree Celsius, whose zero differs from that of its dimension when it is alone.
const CELSIUS: [&str; 2] = ["°C", "degC"];
/// Zero of the Celsius scale (K).
pub const ICE: f64 = 273.15;

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
/// Largest finite decimal exponent.
const LARGEST_EXPONENT: i32 = 100_000;

/// Value in SI units and dimension of a number with an optional unit.
///
/// # Errors
/// A message on the part of the text that is not understood, or if the number is too large.
pub fn parse(text: &str) -> Result<(f64, Powers), String> {
    let text = text.trim();
    if text.len() > LONGEST {
        let begin: String = text.chars().take(20).collect();
        return Err(format!("`{begin}…` is too long for a number with a unit"));
    }
    let (mantissa, exponent, rest) =
        split_number(text).ok_or_else(|| format!("`{text}` does not begin with a number"))?;
    let unit = Unit::whole(rest)?;
    let value = unit.scale(mantissa, exponent)? + unit.zero();
    if value.is_finite() {
        Ok((value, unit.powers))
    } else {
        Err(format!("`{text}` is too large"))
    }
}

/// A number with its unit at the beginning of a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leading {
    /// In SI units; infinite if that is too large.
    pub value: f64,
    /// Dimension.
    pub powers: Powers,
    /// `true` for a temperature in degrees Celsius.
    pub celsius: bool,
    /// Bytes of the text that it takes.
    pub length: usize,
}

/// The number without a sign that a text begins with, and its unit as far as symbols of units go:
/// of `"3 km/s * (1 - x)"` it takes `3 km/s`. None if there is no number.
#[must_use]
pub fn leading(text: &str) -> Option<Leading> {
    if text.starts_with(['+', '-']) {
        return None;
    }
    let (mantissa, exponent, rest) = split_number(text)?;
    let (unit, rest) = Unit::leading(rest);
    let value = unit.scale(mantissa, exponent).ok()? + unit.zero();
    Some(Leading {
        value,
        powers: unit.powers,
        celsius: unit.zero() != 0.0,
        length: text.len() - rest.len(),
    })
}

/// A number as it is written, and the unit behind it; none if the text begins with no number.
#[must_use]
pub fn split(text: &str) -> Option<(&str, &str)> {
    let text = text.trim();
    let (_, _, unit) = split_number(text)?;
    Some((text[..text.len() - unit.len()].trim_end(), unit.trim()))
}

/// One of the unit that a number is written with, in SI units.
#[must_use]
pub fn unit_of(text: &str) -> f64 {
    let unit = split(text).map_or("", |(_, unit)| unit);
    Unit::whole(unit)
        .and_then(|unit| unit.scale("1", 0))
        .unwrap_or(1.0)
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
#[derive(Clone)]
struct Unit {
    powers: Powers,
    exponent: i32,
    factor: f64,
    /// The number of its symbols, and how many of them are the degree Celsius.
    symbols: [u32; 2],
}

impl Default for Unit {
    fn default() -> Self {
        Self {
            powers: [0; 5],
            exponent: 0,
            factor: 1.0,
            symbols: [0; 2],
        }
    }
}

impl Unit {
    /// The unit that a text is.
    fn whole(text: &str) -> Result<Self, String> {
        let mut unit = Self::default();
        let left = unit.read(text, 1)?;
        if left.is_empty() {
            return Ok(unit);
        }
        let text = text.trim();
        Err(format!("`{left}` in the unit `{text}` is not understood"))
    }

    /// The longest unit at the beginning of a text, and what follows it.
    fn leading(text: &str) -> (Self, &str) {
        let (mut unit, mut rest) = (Self::default(), text);
        loop {
            let next = rest.trim_start();
            let (sign, next) = match next.strip_prefix('/') {
                Some(after) => (-1, after),
                None => (1, next.strip_prefix(['*', '·']).unwrap_or(next)),
            };
            let mut longer = unit.clone();
            let read = match next.trim_start().strip_prefix('(') {
                // A parenthesis without an operator before it is none of a unit.
                Some(_) if next.len() == rest.trim_start().len() => break,
                Some(inner) => longer
                    .read(inner, sign)
                    .map(|after| after.strip_prefix(')')),
                None => longer.read_symbol(next.trim_start(), sign).map(Some),
            };
            match read {
                // A name with a parenthesis is a function: `min(`.
                Ok(Some(after)) if !after.starts_with('(') => (unit, rest) = (longer, after),
                _ => break,
            }
        }
        (unit, rest)
    }

    /// A number of this unit in SI units, rounded once where the factor is decimal.
    fn scale(&self, mantissa: &str, exponent: i32) -> Result<f64, String> {
        let exponent = exponent + self.exponent;
        let read = |mantissa: &str| {
            let number = format!("{mantissa}e{exponent}").parse::<f64>();
            number.map_err(|_| format!("`{mantissa}` is not a number"))
        };
        if self.factor == 1.0 {
            return read(mantissa);
        }
        let plain: f64 = mantissa
            .parse()
            .map_err(|_| format!("`{mantissa}` is not a number"))?;
        let product = plain * self.factor;
        if product.is_finite() {
            read(&product.to_string())
        } else {
            Ok(product)
        }
    }

    /// The zero of its scale, in SI units.
    fn zero(&self) -> f64 {
        let is_celsius = self.symbols == [1, 1] && self.powers == [0, 0, 0, 1, 0];
        if is_celsius { ICE } else { 0.0 }
    }

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
            let named = if name.is_empty() { text } else { name };
            format!("unknown unit `{named}`")
        })?;
        let (power, rest) = split_power(rest)?;
        let power = power * sign;
        self.symbols[0] += 1;
        self.symbols[1] += u32::from(CELSIUS.contains(&name));
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
mod tests;
