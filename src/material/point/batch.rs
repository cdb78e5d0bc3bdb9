//! The numbers that material points hold, eight points at a time.

use super::failure::viscous_speed;
use crate::point_fields;

/// Points advanced together; a batch lane is one point.
pub const LANES: usize = 8;

/// One value for each point of a batch.
pub type Lanes = [f64; LANES];

/// Type of a field in a batch.
#[macro_export]
macro_rules! point_lanes {
    (Scalar) => {
        $crate::Lanes
    };
    (Id) => {
        [u64; $crate::LANES]
    };
    (Vector) => {
        [$crate::Lanes; 3]
    };
    (Symmetric) => {
        [$crate::Lanes; 6]
    };
    (Tensor) => {
        [$crate::Lanes; 9]
    };
}

macro_rules! point_batch {
    ($( $(#[doc = $doc:literal])+ $name:ident: $kind:ident, $role:ident; )+) => {
        /// The state of [`LANES`] points before and after an update. Unused lanes repeat a valid
        /// point.
        #[derive(Debug, Clone, Copy)]
        #[repr(align(64))]
        pub struct PointBatch {
            $( $(#[doc = $doc])+ pub $name: point_lanes!($kind), )+
            /// Plastic work so far (J/kg), of which particles keep a record, if a material asks.
            pub plastic_energy: Lanes,
        }

        impl PointBatch {
            /// All numbers zero.
            pub const ZERO: Self = Self {
                $( $name: <point_lanes!($kind)>::ZERO, )+
                plastic_energy: [0.0; LANES],
            };

            /// Speed (m/s) of the artificial viscosity at point `k`, whose linear part takes a share of that of
            /// sound: see [`viscous_speed`].
            #[inline(always)]
            #[must_use]
            pub fn viscous_speed(&self, k: usize, share: f64) -> f64 {
                viscous_speed(share * self.sound_speed[k], self.pressure[k], self.damage[k])
            }
        }
    };
}
point_fields!(point_batch);

/// Squares of the deviatoric rates of deformation, `d':d'` (1/s²).
#[inline(always)]
pub(super) fn strain_rates_squared(point: &PointBatch) -> Lanes {
    let mut squares = [0.0; LANES];
    for k in 0..LANES {
        let l = |c: usize| point.velocity_gradient[c][k];
        let third = (l(0) + l(4) + l(8)) * (1.0 / 3.0);
        let [xx, yy, zz] = [l(0) - third, l(4) - third, l(8) - third];
        let [xy, xz, yz] = [l(1) + l(3), l(2) + l(6), l(5) + l(7)];
        squares[k] = xx * xx + yy * yy + zz * zz + 0.5 * (xy * xy + xz * xz + yz * yz);
    }
    squares
}

/// The values of a batch in one field, one lane of them at a time.
pub trait PointField {
    /// Value of one point.
    type Value;
    /// Zeros.
    const ZERO: Self;
    /// The value of lane `k`.
    fn lane(&self, k: usize) -> Self::Value;
    /// Sets that of lane `k`.
    fn set_lane(&mut self, k: usize, value: &Self::Value);
}

impl PointField for Lanes {
    type Value = f64;
    const ZERO: Self = [0.0; LANES];

    #[inline(always)]
    fn lane(&self, k: usize) -> f64 {
        self[k]
    }

    #[inline(always)]
    fn set_lane(&mut self, k: usize, value: &f64) {
        self[k] = *value;
    }
}

impl PointField for [u64; LANES] {
    type Value = u64;
    const ZERO: Self = [0; LANES];

    #[inline(always)]
    fn lane(&self, k: usize) -> u64 {
        self[k]
    }

    #[inline(always)]
    fn set_lane(&mut self, k: usize, value: &u64) {
        self[k] = *value;
    }
}

impl<const N: usize> PointField for [Lanes; N] {
    type Value = [f64; N];
    const ZERO: Self = [[0.0; LANES]; N];

    #[inline(always)]
    fn lane(&self, k: usize) -> [f64; N] {
        let mut value = [0.0; N];
        for c in 0..N {
            value[c] = self[c][k];
        }
        value
    }

    #[inline(always)]
    fn set_lane(&mut self, k: usize, value: &[f64; N]) {
        for c in 0..N {
            self[c][k] = value[c];
        }
    }
}
