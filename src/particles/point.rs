//! Particles as material points: gathered into a batch and stored from it, field by field as the
//! material declares what a point holds.

use super::columns::Life;
use super::fields::{FIELDS, FieldId};
use super::scatter::Scatter;
use crate::material::{LANES, PointBatch, PointField, point_fields, point_lanes};

/// Copies a field into a batch if its role says so.
macro_rules! gather {
    (Answer $to:expr, $k:ident, $from:expr) => {};
    ($role:ident $to:expr, $k:ident, $from:expr) => {
        $to.set_lane($k, $from)
    };
}

/// Copies a field out of a batch if its role says so.
macro_rules! store {
    (Given $to:expr, $k:ident, $from:expr) => {};
    ($role:ident $to:expr, $k:ident, $from:expr) => {
        *$to = $from.lane($k)
    };
}

/// Refuses, as it is compiled, a state that would not outlive a step.
macro_rules! check {
    (State $name:ident) => {
        let life = FIELDS[FieldId::$name as usize].life;
        assert!(
            matches!(life, Life::State),
            "state of a material must be state of the particle"
        );
    };
    ($role:ident $name:ident) => {};
}

macro_rules! points {
    (($d:tt) $( $(#[doc = $doc:literal])+ $name:ident: $kind:ident, $role:ident; )+) => {
        const _: () = { $( check!($role $name); )+ };

        /// What the material's update reads and writes of the particles.
        pub struct MaterialPoints<'a> {
            /// Index of the body.
            pub body: &'a [u32],
            /// Rate of the specific energy at the beginning of the step (W/kg).
            pub heating: &'a [f64],
            /// Work of the step, for the balance between ranks.
            pub work: Scatter<'a, u32>,
            $( $(#[doc = $doc])+ pub $name: Scatter<'a, <point_lanes!($kind) as PointField>::Value>, )+
        }

        impl<'a> MaterialPoints<'a> {
            /// What the particles `base` hold, in this order; zero for what a material answers.
            ///
            /// # Safety
            /// No other thread may write to these particles.
            ///
            /// # Panics
            /// If there is no such particle.
            #[inline(always)]
            #[must_use]
            pub unsafe fn gather(&self, base: &[usize; LANES]) -> PointBatch {
                let mut batch = PointBatch::ZERO;
                for (k, &i) in base.iter().enumerate() {
                    // SAFETY: by this function's contract; no reference outlives its statement.
                    unsafe { $( gather!($role batch.$name, k, self.$name.slot(i)); )+ }
                }
                batch
            }

            /// Writes lane `k` of a batch to particle `i`.
            ///
            /// # Safety
            /// No other thread may read or write this particle.
            ///
            /// # Panics
            /// If there is no such particle.
            #[inline(always)]
            pub unsafe fn store(&self, i: usize, k: usize, batch: &PointBatch) {
                // SAFETY: by this function's contract; no reference outlives its statement.
                unsafe { $( store!($role self.$name.slot(i), k, batch.$name); )+ }
            }
        }

        /// Borrows [`MaterialPoints`] of a store, which leaves its other fields free.
        macro_rules! material_points {
            ($d particles:expr) => {
                $crate::particles::MaterialPoints {
                    body: &$d particles.body,
                    heating: &$d particles.d_specific_energy_dt,
                    work: $crate::particles::Scatter::new(&mut $d particles.work),
                    $( $name: $crate::particles::Scatter::new(&mut $d particles.$name), )+
                }
            };
        }
        pub(crate) use material_points;
    };
}
point_fields!(points ($));
