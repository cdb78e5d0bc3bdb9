//! Eight doubles side by side: one for each receiver of a cluster.
//!
//! Plain arrays and loops that the compiler turns into the vector instructions of the function
//! they are inlined into ([`super::dispatch`]); every operation is IEEE-exact, so all
//! instruction sets give the same bits.

use std::ops::{Add, Div, Mul, Sub};

/// Receivers of a cluster.
pub const LANES: usize = 8;

/// One double for each receiver of a cluster.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct F64x8(pub [f64; LANES]);

impl F64x8 {
    /// The same value in every lane.
    #[inline(always)]
    #[must_use]
    pub fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    /// Square root of each lane.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].sqrt()))
    }

    /// The larger of each lane and `other`'s; `other`'s where this one is NaN.
    #[inline(always)]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| {
            if self.0[k] > other.0[k] {
                self.0[k]
            } else {
                other.0[k]
            }
        }))
    }

    /// The smaller of each lane and `other`'s; `other`'s where this one is NaN.
    #[inline(always)]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| {
            if self.0[k] < other.0[k] {
                self.0[k]
            } else {
                other.0[k]
            }
        }))
    }

    /// Each lane where `mask` is positive, zero elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn where_positive(self, mask: Self) -> Self {
        Self(std::array::from_fn(|k| {
            if mask.0[k] > 0.0 { self.0[k] } else { 0.0 }
        }))
    }

    /// `self · factor + term` with one rounding.
    #[inline(always)]
    #[must_use]
    pub fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(std::array::from_fn(|k| {
            self.0[k].mul_add(factor.0[k], term.0[k])
        }))
    }
}

macro_rules! lane_operator {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl $trait for F64x8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(std::array::from_fn(|k| self.0[k] $operator other.0[k]))
            }
        }
    };
}

lane_operator!(Add, add, +);
lane_operator!(Sub, sub, -);
lane_operator!(Mul, mul, *);
lane_operator!(Div, div, /);
