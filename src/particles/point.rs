//! Particles as material points: gathered into a batch and stored from it, field by field as the
//! material declares what a point holds.

use super::columns::Life;
use super::fields::{FIELDS, FieldId};
use super::scatter::Scatter;
use material::{FAILED, LANES, PointBatch, PointField, point_fields, point_lanes};

/// Copies a field into a batch if its role says so; a memory that no particle has is zero, and so is
/// what no material asks for.
macro_rules! gather {
    (Answer $asked:expr, $to:expr, $k:ident, $from:expr, $i:ident) => {};
    (Known $asked:expr, $to:expr, $k:ident, $from:expr, $i:ident) => {
        if $asked && !$from.is_empty() {
            $to.set_lane($k, $from.slot($i))
        }
    };
    (Memory $asked:expr, $to:expr, $k:ident, $from:expr, $i:ident) => {
        if !$from.is_empty() {
            $to.set_lane($k, $from.slot($i))
        }
    };
    ($role:ident $asked:expr, $to:expr, $k:ident, $from:expr, $i:ident) => {
        $to.set_lane($k, $from.slot($i))
    };
}

/// Copies a field out of a batch if its role says so.
macro_rules! store {
    (Given $to:expr, $i:ident, $k:ident, $from:expr) => {};
    (Known $to:expr, $i:ident, $k:ident, $from:expr) => {};
    (Memory $to:expr, $i:ident, $k:ident, $from:expr) => {
        if !$to.is_empty() {
            *$to.slot($i) = $from.lane($k)
        }
    };
    ($role:ident $to:expr, $i:ident, $k:ident, $from:expr) => {
        *$to.slot($i) = $from.lane($k)
    };
}

/// Refuses, as it is compiled, a state that would not outlive a step, and what only some cases hold
/// where all must.
macro_rules! check {
    (Memory $name:ident) => {
        let field = &FIELDS[FieldId::$name as usize];
        assert!(
            matches!(field.life, Life::State) && field.is_optional(),
            "memory of a material must be state of particles that have use for it"
        );
    };
    (State $name:ident) => {
        let field = &FIELDS[FieldId::$name as usize];
        assert!(
            matches!(field.life, Life::State) && !field.is_optional(),
            "state of a material must be state of every particle"
        );
    };
    ($role:ident $name:ident) => {};
}

macro_rules! points {
    (($d:tt) $( $(#[doc = $doc:literal])+ $name:ident: $kind:ident, $role:ident; )+) => {
        const _: () = { $( check!($role $name); )+ };

        /// Fields of the particles that the material's update reads and writes.
        pub struct MaterialPoints<'a> {
            /// Index of the body.
            pub body: &'a [u32],
            /// Rate of the specific energy at the beginning of the step (W/kg).
            pub heating: &'a [f64],
            /// Work of the step, for the balance between ranks.
            pub work: Scatter<'a, u32>,
            /// True if a material asks for what only some laws must know.
            pub needs_particle: bool,
            $( $(#[doc = $doc])+ pub $name: Scatter<'a, <point_lanes!($kind) as PointField>::Value>, )+
        }

        impl<'a> MaterialPoints<'a> {
            /// True if particle `i` has failed.
            ///
            /// # Safety
            /// No other thread may write to this particle.
            ///
            /// # Panics
            /// If there is no such particle.
            #[inline(always)]
            #[must_use]
            pub unsafe fn has_failed(&self, i: usize) -> bool {
                // SAFETY: by this function's contract; no reference outlives its statement.
                !self.damage.is_empty() && unsafe { *self.damage.slot(i) >= FAILED }
            }

            /// Values of the particles `slot`, in this order; zero for what a material answers.
            ///
            /// # Safety
            /// No other thread may write to these particles.
            ///
            /// # Panics
            /// If there is no such particle.
            #[inline(always)]
            #[must_use]
            pub unsafe fn gather(&self, slot: &[usize; LANES]) -> PointBatch {
                let mut batch = PointBatch::ZERO;
                for (k, &i) in slot.iter().enumerate() {
                    // SAFETY: by this function's contract; no reference outlives its statement.
                    unsafe { $( gather!($role self.needs_particle, batch.$name, k, self.$name, i); )+ }
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
                unsafe { $( store!($role self.$name, i, k, batch.$name); )+ }
            }
        }

        /// Borrows [`MaterialPoints`] of a store, which leaves its other fields free.
        #[macro_export]
        macro_rules! material_points {
            ($d particles:expr) => {
                $crate::MaterialPoints {
                    body: &$d particles.body,
                    heating: &$d particles.d_specific_energy_dt,
                    work: $crate::Scatter::new(&mut $d particles.work),
                    needs_particle: false,
                    $( $name: $crate::Scatter::new(&mut $d particles.$name), )+
                }
            };
        }
    };
}
point_fields!(points ($));
