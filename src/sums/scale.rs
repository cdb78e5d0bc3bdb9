//! The pair scale of a case.

use numerics::kernel::{ConstantScale, Kernel, MeanScale, RingScale};

/// The pair scale of a case, chosen once.
#[derive(Debug, Clone, Copy)]
pub enum Scale {
    /// One smoothing length for all.
    Constant(ConstantScale),
    /// Mean lengths of pairs.
    Mean(MeanScale),
    /// The same between rings about an axis.
    Ring(RingScale),
}

impl Scale {
    /// Of a kernel and the smoothing length (m) of all pairs, if they share one.
    #[must_use]
    pub fn new(kernel: &Kernel, constant: Option<f64>) -> Self {
        match constant {
            Some(h) => Self::Constant(ConstantScale::new(kernel, h)),
            None => Self::Mean(MeanScale::new(kernel)),
        }
    }
}

/// Calls `$work` with the scale of a case as a concrete type.
#[macro_export]
macro_rules! with_scale {
    ($scale:expr, $name:ident => $work:expr) => {
        match $scale {
            $crate::scale::Scale::Constant($name) => $work,
            $crate::scale::Scale::Mean($name) => $work,
            $crate::scale::Scale::Ring($name) => $work,
        }
    };
}
