//! Ranges of single values, and tables that must hold one of several.

use std::ops::Range;

use toml::Spanned;

use crate::input::quantity::Quantity;
use crate::input::source::Diagnostic;
use model::readable::short;

/// Values that a key accepts.
#[derive(Debug, Clone, Copy)]
pub enum Allowed {
    /// Any finite number.
    Any,
    /// Above zero.
    Positive,
    /// Zero or more.
    NotNegative,
    /// Zero or less.
    NotPositive,
    /// Above one.
    AboveOne,
    /// Above zero, at most one.
    UpToOne,
    /// Between two numbers, both included.
    Within(f64, f64),
    /// A whole number or more.
    AtLeast(u32),
}

impl Allowed {
    fn has(self, x: f64) -> bool {
        x.is_finite()
            && match self {
                Self::Any => true,
                Self::Positive => x > 0.0,
                Self::NotNegative => x >= 0.0,
                Self::NotPositive => x <= 0.0,
                Self::AboveOne => x > 1.0,
                Self::UpToOne => x > 0.0 && x <= 1.0,
                Self::Within(low, high) => low <= x && x <= high,
                Self::AtLeast(least) => x >= f64::from(least),
            }
    }

    /// True if it has a whole number.
    #[allow(clippy::cast_precision_loss, reason = "bounds are small")]
    pub fn has_whole(self, n: u64) -> bool {
        self.has(n as f64)
    }

    pub fn words(self) -> String {
        match self {
            Self::Any => "finite".to_owned(),
            Self::Positive => "positive".to_owned(),
            Self::NotNegative => "zero or positive".to_owned(),
            Self::NotPositive => "zero or negative".to_owned(),
            Self::AboveOne => "above 1".to_owned(),
            Self::UpToOne => "above 0 and at most 1".to_owned(),
            Self::Within(low, high) => format!("between {low} and {high}"),
            Self::AtLeast(least) => format!("{least} or more"),
        }
    }
}

pub fn out_of_range(at: Range<usize>, key: &str, allowed: &str) -> Diagnostic {
    Diagnostic::new(at, format!("`{key}` must be {allowed}")).label("out of range")
}

/// A number without a unit that is larger is a slip, and its powers would be infinite.
const LARGEST: f64 = 1e9;

/// A plain number or a quantity.
pub trait Value: Copy {
    /// No value is larger, in SI units; that of quantities is told as they are read.
    const LARGEST: f64;
    /// The number, in SI units.
    fn si(self) -> f64;
}

impl Value for f64 {
    const LARGEST: f64 = LARGEST;

    fn si(self) -> f64 {
        self
    }
}

impl<K> Value for Quantity<K> {
    const LARGEST: f64 = f64::INFINITY;

    fn si(self) -> f64 {
        self.si
    }
}

/// A number in SI units.
pub fn number<V: Value>(
    value: &Spanned<V>,
    key: &str,
    allowed: Allowed,
) -> Result<f64, Diagnostic> {
    let x = value.get_ref().si();
    if x.is_finite() && x.abs() > V::LARGEST {
        let title = format!("`{key}` cannot be larger than {}", short(V::LARGEST));
        return Err(Diagnostic::new(value.span(), title).label("out of range"));
    }
    if allowed.has(x) {
        return Ok(x);
    }
    Err(out_of_range(value.span(), key, &allowed.words()))
}

/// Value from a key or another source; `table` is the place where the key should be.
pub fn required<T>(found: Option<T>, key: &str, table: &Range<usize>) -> Result<T, Diagnostic> {
    found.ok_or_else(|| {
        let title = format!("the key `{key}` is missing");
        Diagnostic::new(table.clone(), title).label("in this table")
    })
}

/// A radius, or half of the diameter in its place, by their keys; nothing of neither.
pub fn radius(
    [radius, diameter]: [Option<f64>; 2],
    keys: [&str; 2],
    table: &Range<usize>,
) -> Result<Option<f64>, Diagnostic> {
    if radius.is_some() && diameter.is_some() {
        let [radius, diameter] = keys;
        let title = format!("`{radius}` and `{diameter}` cannot both be given");
        return Err(Diagnostic::new(table.clone(), title));
    }
    Ok(radius.or(diameter.map(|diameter| 0.5 * diameter)))
}

/// The radius of what must have one, or half of its diameter.
pub fn outer_radius(typed: [Option<f64>; 2], table: &Range<usize>) -> Result<f64, Diagnostic> {
    let radius = radius(typed, ["radius", "diameter"], table)?;
    required(radius, "radius", table).map_err(|error| error.help("or give a `diameter`"))
}

/// A vector must have a component for each dimension.
pub fn components<T>(
    key: &str,
    vector: &Spanned<Vec<T>>,
    dimension: usize,
) -> Result<(), Diagnostic> {
    let found = vector.get_ref().len();
    if found == dimension {
        return Ok(());
    }
    let s = if dimension == 1 { "" } else { "s" };
    let title = format!("`{key}` must have {dimension} component{s}, found {found}");
    Err(Diagnostic::new(vector.span(), title))
}

/// Says that a table must have exactly one of several others.
pub fn exactly_one(at: Range<usize>, table: &str, choices: &str) -> Diagnostic {
    Diagnostic::new(at, format!("`{table}` must have exactly one of {choices}"))
}
