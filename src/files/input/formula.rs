//! Quantities by place, as typed: `"-3 km/s * (1 - (r / 5 mm)^2)"`.
//!
//! Numbers stand with their units, as everywhere, and units go as far as they can: `r / 5 mm` is `r`
//! over a length. As the text is read, each part of it has a dimension, so that a sum of a length and a
//! time is told where it stands. Radians are plain numbers here: `100 rad/s * y` is a velocity.
//!
//! No crate does this: of those for expressions that are kept, exmex 0.21 reads `-2^2` as 4 and
//! refuses `min(1, max(2, 3))`, and evalexpr has a licence of another kind.

mod code;
#[cfg(test)]
mod tests;

use std::ops::Range;

use super::quantity::PLAIN;
use super::source::Diagnostic;
use code::{Code, Part, no_celsius, powers_of};
use model::units::{self, Powers};
use model::{Combination, Formula, Function, Operation, Place, Profile};

/// Longest text of a formula (bytes).
const LONGEST: usize = 1000;
/// Parts within parts, signs and exponents beyond this are no formula that somebody would write.
const MOST_NESTED: usize = 50;
const TEMPERATURE: Powers = [0, 0, 0, 1, 0];

/// The profile in a text and its dimension, for a case of a dimension; ranges of the diagnostic are
/// those of the text.
pub fn read(text: &str, dimension: usize) -> Result<(Profile, Powers), Diagnostic> {
    if text.len() > LONGEST {
        let title = format!("a formula can have {LONGEST} bytes at most");
        return Err(Diagnostic::new(0..text.len(), title));
    }
    let mut reader = Reader {
        text,
        at: 0,
        code: Code::default(),
        nested: 0,
        dimension,
    };
    let whole = reader.sum()?;
    if reader.peek().is_some() {
        return Err(reader.unexpected("an operator"));
    }
    let profile = match whole.constant {
        Some(value) => Profile::Constant(value),
        None => Profile::Formula(Formula::new(reader.code.0).ok_or_else(|| nested(0..text.len()))?),
    };
    Ok((profile, whole.powers))
}

fn nested(range: Range<usize>) -> Diagnostic {
    Diagnostic::new(range, "the formula is nested too deeply")
}

struct Reader<'a> {
    text: &'a str,
    /// Bytes of it that have been read.
    at: usize,
    code: Code,
    nested: usize,
    dimension: usize,
}

impl<'a> Reader<'a> {
    /// The next sign, past blanks.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    /// Goes beyond one of some signs, if it is next.
    fn take(&mut self, signs: &[char]) -> Option<char> {
        let next = self.peek().filter(|c| signs.contains(c))?;
        self.at += next.len_utf8();
        Some(next)
    }

    /// Fault of the next word, which should be something else.
    fn unexpected(&mut self, expected: &str) -> Diagnostic {
        let Some(next) = self.peek() else {
            let last = self.text.char_indices().last().map_or(0, |(at, _)| at);
            let title = format!("the formula ends where {expected} should stand");
            return Diagnostic::new(last..self.text.len(), title);
        };
        let word = self.word();
        let length = word.map_or(next.len_utf8(), str::len);
        let range = self.at..self.at + length;
        let found = &self.text[range.clone()];
        if word.is_some() && self.code.ends_with_number() {
            return Diagnostic::new(range, format!("unknown unit `{found}`"))
                .help("parts of a formula are joined by `+ - * / ^`");
        }
        Diagnostic::new(range, format!("expected {expected}, found `{found}`"))
    }

    /// The name that is next.
    fn word(&self) -> Option<&'a str> {
        let rest = &self.text[self.at..];
        let length = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '°'));
        let word = &rest[..length.unwrap_or(rest.len())];
        word.starts_with(|c: char| !c.is_ascii_digit())
            .then_some(word)
            .filter(|word| !word.is_empty())
    }

    fn sum(&mut self) -> Result<Part, Diagnostic> {
        let mut left = self.product()?;
        while let Some(sign) = self.take(&['+', '-']) {
            let right = self.product()?;
            let (how, verb) = if sign == '+' {
                (Combination::Plus, "add")
            } else {
                (Combination::Less, "subtract")
            };
            let preposition = if sign == '+' { "to" } else { "from" };
            let wrong = |left: &Part, right: &Part| {
                format!(
                    "cannot {verb} {} {preposition} {}",
                    right.name(),
                    left.name()
                )
            };
            left = self.code.alike(how, [left, right], wrong)?;
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Part, Diagnostic> {
        let mut left = self.signed()?;
        while let Some(sign) = self.take(&['*', '·', '/']) {
            let right = self.signed()?;
            let (how, factor) = match sign {
                '/' => (Combination::Over, -1),
                _ => (Combination::Times, 1),
            };
            no_celsius([&left, &right])?;
            let powers = std::array::from_fn(|k| left.powers[k] + factor * right.powers[k]);
            left = self.code.combine(how, [left, right], powers)?;
        }
        Ok(left)
    }

    /// A power with signs before it, which bind less: `-x^2` is `-(x^2)`.
    fn signed(&mut self) -> Result<Part, Diagnostic> {
        let begin = self.at;
        match self.take(&['+', '-']) {
            None => self.power(),
            Some(sign) => {
                let mut part = self.deeper(Self::signed)?;
                part.range.start = begin + self.text[begin..].find(sign).unwrap_or(0);
                // `-20 °C` is a number with its sign.
                if sign == '-' && part.celsius {
                    part.celsius = false;
                    let value = part.constant.unwrap_or(f64::NAN);
                    return Ok(self.code.number(
                        part.range,
                        2.0 * units::ICE - value,
                        TEMPERATURE,
                        true,
                    ));
                }
                if sign == '-' {
                    let powers = part.powers;
                    part = self.code.apply(Function::Minus, part, powers)?;
                }
                Ok(part)
            }
        }
    }

    /// `2^3^2` is `2^(3^2)`.
    fn power(&mut self) -> Result<Part, Diagnostic> {
        let base = self.primary()?;
        let exponent = match self.take(&['^', '²', '³']) {
            None => return Ok(base),
            Some('^') => self.deeper(Self::signed)?,
            Some(raised) => {
                let range = self.at - raised.len_utf8()..self.at;
                let exponent = if raised == '²' { 2.0 } else { 3.0 };
                self.code.number(range, exponent, PLAIN, false)
            }
        };
        no_celsius([&base, &exponent])?;
        if exponent.powers != PLAIN {
            let title = format!("an exponent is a plain number, found {}", exponent.name());
            return Err(Diagnostic::new(exponent.range, title));
        }
        let whole = exponent
            .constant
            .filter(|n| n.trunc() == *n && n.abs() <= 9.0);
        #[allow(clippy::cast_possible_truncation)] // whole and small
        let powers = match whole {
            Some(n) => base.powers.map(|power| power * n as i32),
            None if base.powers == PLAIN => PLAIN,
            None => {
                let title = format!(
                    "the exponent of {} is a whole number of 9 at most, and a constant",
                    base.name()
                );
                return Err(Diagnostic::new(exponent.range, title));
            }
        };
        self.code
            .combine(Combination::Power, [base, exponent], powers)
    }

    fn primary(&mut self) -> Result<Part, Diagnostic> {
        let Some(next) = self.peek() else {
            return Err(self.unexpected("a number or a name"));
        };
        let begin = self.at;
        if let Some(number) = units::leading(&self.text[begin..]) {
            let (value, length) = (number.value, number.length);
            self.at += length;
            let range = begin..self.at;
            if !value.is_finite() {
                let title = format!("`{}` is too large", self.text[range.clone()].trim());
                return Err(Diagnostic::new(range, title));
            }
            // Radians are plain numbers.
            let [m, kg, s, kelvin, _] = number.powers;
            let powers = [m, kg, s, kelvin, 0];
            return Ok(self.code.number(range, value, powers, number.celsius));
        }
        if self.take(&['(']).is_some() {
            let mut part = self.deeper(Self::sum)?;
            self.close(begin)?;
            part.range = begin..self.at;
            return Ok(part);
        }
        let Some(word) = self.word() else {
            return Err(self.unexpected(if next == ')' {
                "a number or a name before it"
            } else {
                "a number or a name"
            }));
        };
        self.at += word.len();
        let range = begin..self.at;
        if self.take(&['(']).is_some() {
            return self.call(word, range);
        }
        if word == "pi" {
            return Ok(self.code.number(range, std::f64::consts::PI, PLAIN, false));
        }
        let index = Place::NAMES.iter().position(|name| *name == word);
        match index.filter(|index| self.exists(*index)) {
            Some(index) => Ok(self.code.length(range, Operation::Of(index))),
            None => Err(self.unknown(word, range)),
        }
    }

    /// True if the dimension has a name of a place.
    fn exists(&self, index: usize) -> bool {
        // x, y, z, r, and the centre's.
        index == 3 || index % 4 < self.dimension
    }

    fn unknown(&self, word: &str, range: Range<usize>) -> Diagnostic {
        if Function::ALL.iter().any(|f| f.name() == word) || two_of(word).is_some() {
            let title = format!("the function `{word}` has no arguments: `{word}(…)`");
            return Diagnostic::new(range, title);
        }
        if units::parse(&format!("1 {word}")).is_ok() {
            let title = format!("the unit `{word}` follows no number");
            return Diagnostic::new(range, title).help(format!("write `1 {word}`"));
        }
        let known = (0..Place::NAMES.len()).filter(|index| self.exists(*index));
        let known = known.map(|index| Place::NAMES[index]).chain(["pi"]);
        Diagnostic::unknown(range, "name", word, known)
    }

    /// A function of one or two arguments, from behind its parenthesis.
    fn call(&mut self, word: &str, range: Range<usize>) -> Result<Part, Diagnostic> {
        let one = Function::ALL.iter().find(|f| f.name() == word);
        let two = two_of(word);
        if one.is_none() && two.is_none() {
            let ones = Function::ALL.iter().map(|f| f.name());
            let twos = Combination::ALL.iter().map(|f| f.name());
            let known = ones.chain(twos).filter(|name| name.len() > 1);
            return Err(Diagnostic::unknown(range, "function", word, known));
        }
        let open = self.at - 1;
        let first = self.deeper(Self::sum)?;
        let mut part = if let Some(two) = two {
            if self.take(&[',']).is_none() {
                let title = format!("`{word}` takes two arguments");
                return Err(Diagnostic::new(range, title));
            }
            let second = self.deeper(Self::sum)?;
            let wrong =
                |a: &Part, b: &Part| format!("`{word}` compares {} with {}", a.name(), b.name());
            self.code.alike(two, [first, second], wrong)?
        } else {
            let function = one.copied().unwrap_or(Function::Abs);
            let powers = powers_of(function, &first)?;
            self.code.apply(function, first, powers)?
        };
        self.close(open)?;
        part.range = range.start..self.at;
        Ok(part)
    }

    /// Goes beyond the parenthesis that closes the one at `open`.
    fn close(&mut self, open: usize) -> Result<(), Diagnostic> {
        if self.take(&[')']).is_some() {
            return Ok(());
        }
        if self.peek().is_none() {
            let range = open..open + 1;
            return Err(Diagnostic::new(range, "this parenthesis is not closed"));
        }
        Err(self.unexpected("an operator or `)`"))
    }

    /// Reads a part within another.
    fn deeper(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<Part, Diagnostic>,
    ) -> Result<Part, Diagnostic> {
        self.nested += 1;
        if self.nested > MOST_NESTED {
            return Err(nested(self.at.saturating_sub(1)..self.at));
        }
        let part = read(self);
        self.nested -= 1;
        part
    }
}

/// A function of two arguments.
fn two_of(word: &str) -> Option<Combination> {
    let mut all = Combination::ALL.iter().filter(|how| how.name().len() > 1);
    all.find(|how| how.name() == word).copied()
}
