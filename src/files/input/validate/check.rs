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
            }
    }

    fn words(self) -> String {
        match self {
            Self::Any => "finite".to_owned(),
            Self::Positive => "positive".to_owned(),
            Self::NotNegative => "zero or positive".to_owned(),
            Self::NotPositive => "zero or negative".to_owned(),
            Self::AboveOne => "above 1".to_owned(),
            Self::UpToOne => "above 0 and at most 1".to_owned(),
            Self::Within(low, high) => format!("between {low} and {high}"),
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

/// The [`number`](number()) of a key of a table, or its default: `number!(params.alpha, or 1.0,
/// Positive)`.
macro_rules! number {
    ($table:ident.$key:ident, or $default:expr, $($allowed:tt)+) => {
        $crate::input::validate::check::number(
            $table.$key.as_ref(),
            stringify!($key),
            $default,
            $crate::input::validate::check::Allowed::$($allowed)+,
        )?
    };
}

/// The [`required`](required()) number of a key of a table; `$base` is the law whose field of the
/// same name is taken without one.
macro_rules! required {
    ($table:ident.$key:ident, $base:expr, $allowed:ident, $at:expr) => {
        $crate::input::validate::check::required(
            $table.$key.as_ref(),
            stringify!($key),
            $base.map(|law| law.$key),
            $crate::input::validate::check::Allowed::$allowed,
            $at,
        )?
    };
}

/// A number in SI units, or its default.
pub fn number<V: Value>(
    value: Option<&Spanned<V>>,
    key: &str,
    default: f64,
    allowed: Allowed,
) -> Result<f64, Diagnostic> {
    match value {
        None => Ok(default),
        Some(x) if x.get_ref().si().is_finite() && x.get_ref().si().abs() > V::LARGEST => {
            let title = format!("`{key}` cannot be larger than {}", short(V::LARGEST));
            Err(Diagnostic::new(x.span(), title).label("out of range"))
        }
        Some(x) if allowed.has(x.get_ref().si()) => Ok(x.get_ref().si()),
        Some(x) => Err(out_of_range(x.span(), key, &allowed.words())),
    }
}

/// A number in SI units, if there is one.
pub fn optional<V: Value>(
    value: Option<&Spanned<V>>,
    key: &str,
    allowed: Allowed,
) -> Result<Option<f64>, Diagnostic> {
    value
        .map(|x| number(Some(x), key, 0.0, allowed))
        .transpose()
}

/// A number in SI units that has no default but the `base`, if there is one; `table` is where it
/// should stand.
pub fn required<V: Value>(
    value: Option<&Spanned<V>>,
    key: &str,
    base: Option<f64>,
    allowed: Allowed,
    table: &Range<usize>,
) -> Result<f64, Diagnostic> {
    if value.is_none() && base.is_none() {
        let title = format!("the key `{key}` is missing");
        return Err(Diagnostic::new(table.clone(), title).label("in this table"));
    }
    number(value, key, base.unwrap_or_default(), allowed)
}

/// A whole number of at least `least`, or its default.
pub fn whole(
    value: Option<&Spanned<i64>>,
    key: &str,
    default: u64,
    least: u64,
) -> Result<u64, Diagnostic> {
    let Some(value) = value else {
        return Ok(default);
    };
    match u64::try_from(*value.get_ref()) {
        Ok(n) if n >= least => Ok(n),
        _ => Err(out_of_range(value.span(), key, &format!("{least} or more"))),
    }
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
