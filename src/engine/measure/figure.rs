//! Figures: what a measure tells, by name, with its uncertainty.

use std::borrow::Cow;

/// A value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Told {
    /// A number in SI units; not a number where there is nothing to tell.
    Number(f64),
    /// A word.
    Word(&'static str),
}

/// One thing that a measure tells at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Name.
    pub name: Cow<'static, str>,
    /// Value.
    pub value: Told,
    /// Uncertainty in the same unit, if that is known.
    pub uncertainty: Option<f64>,
    /// SI unit; empty for none.
    pub unit: &'static str,
}

impl Figure {
    /// A number.
    #[must_use]
    pub fn number(name: impl Into<Cow<'static, str>>, value: f64, unit: &'static str) -> Self {
        Self {
            name: name.into(),
            // Zero has one sign.
            value: Told::Number(value + 0.0),
            uncertainty: None,
            unit,
        }
    }

    /// A word.
    #[must_use]
    pub fn word(name: &'static str, word: &'static str) -> Self {
        Self {
            name: name.into(),
            value: Told::Word(word),
            uncertainty: None,
            unit: "",
        }
    }

    /// The same with an uncertainty.
    #[must_use]
    pub fn within(mut self, uncertainty: f64) -> Self {
        self.uncertainty = Some(uncertainty);
        self
    }
}

/// A value by some coordinate: a profile, or mass by velocity.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    /// Name.
    pub name: &'static str,
    /// SI unit of the coordinate.
    pub along: &'static str,
    /// SI unit of the values.
    pub unit: &'static str,
    /// Beginning and end of each bin, and its value.
    pub bins: Vec<[f64; 3]>,
}

/// Findings of a measure at a time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Findings {
    /// Figures in a fixed order.
    pub figures: Vec<Figure>,
    /// Distributions in a fixed order.
    pub distributions: Vec<Distribution>,
}
