//! The pair scale of a case.

use crate::numerics::dimension::{Any, Three};
use crate::numerics::kernel::{ConstantScale, Kernel, MeanScale};

/// The pair scale of a case, chosen once.
#[derive(Debug, Clone, Copy)]
pub(super) enum Scale {
    Constant(ConstantScale),
    Three(MeanScale<Three>),
    /// Of fewer dimensions.
    Any(MeanScale<Any>),
}

impl Scale {
    /// Of a kernel and the smoothing length (m) of all pairs, if they share one.
    pub fn new(kernel: &Kernel, constant: Option<f64>) -> Self {
        match (constant, kernel.dimension()) {
            (Some(h), _) => Self::Constant(ConstantScale::new(kernel, h)),
            (None, 3) => Self::Three(MeanScale::three(kernel)),
            (None, _) => Self::Any(MeanScale::any(kernel)),
        }
    }
}

/// Calls `$work` with the scale of a case as a concrete type.
macro_rules! with_scale {
    ($scale:expr, $name:ident => $work:expr) => {
        match $scale {
            $crate::sph::scale::Scale::Constant($name) => $work,
            $crate::sph::scale::Scale::Three($name) => $work,
            $crate::sph::scale::Scale::Any($name) => $work,
        }
    };
}
pub(super) use with_scale;
