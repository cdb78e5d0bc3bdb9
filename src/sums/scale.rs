//! The pair scale of a case.

use numerics::dimension::{Any, Three};
use numerics::kernel::{ConstantScale, Kernel, MeanScale};

/// The pair scale of a case, chosen once.
#[derive(Debug, Clone, Copy)]
pub enum Scale {
    /// One smoothing length for all.
    Constant(ConstantScale),
    /// Mean lengths of pairs, in three dimensions.
    Three(MeanScale<Three>),
    /// Mean lengths of pairs, in fewer dimensions.
    Any(MeanScale<Any>),
}

impl Scale {
    /// Of a kernel and the smoothing length (m) of all pairs, if they share one.
    #[must_use]
    pub fn new(kernel: &Kernel, constant: Option<f64>) -> Self {
        match (constant, kernel.dimension()) {
            (Some(h), _) => Self::Constant(ConstantScale::new(kernel, h)),
            (None, 3) => Self::Three(MeanScale::three(kernel)),
            (None, _) => Self::Any(MeanScale::any(kernel)),
        }
    }
}

/// Calls `$work` with the scale of a case as a concrete type.
#[macro_export]
macro_rules! with_scale {
    ($scale:expr, $name:ident => $work:expr) => {
        match $scale {
            $crate::scale::Scale::Constant($name) => $work,
            $crate::scale::Scale::Three($name) => $work,
            $crate::scale::Scale::Any($name) => $work,
        }
    };
}
