//! The conventional formulation: plain sums over pairs.

use super::Formulation;
use super::gradient_sweep::{Gradient, strain};
use super::momentum_sweep::accelerate;
use crate::neighbours::{Among, Cluster, Lists};
use crate::numerics::dispatch::Vectorised;
use crate::numerics::kernel::PairScale;
use crate::numerics::lanes::{F64x8, LANES, Lanes};
use crate::particles::{ParticleStore, material_points};
use crate::sph::gradient::VelocityGradient;
use crate::sph::neighbourhood::Neighbourhood;
use crate::sph::signal::{SignalSpeed, Signals};
use crate::sph::step::{Side, Step};
use crate::sph::sums::Sums;

/// The conventional formulation.
#[derive(Debug)]
pub struct Conventional;

impl Formulation for Conventional {
    fn rates(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        step: &Step,
    ) {
        strain(self, sums, material_points!(particles), lists, step.dt);
    }

    fn forces(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        side: Side,
    ) {
        sums.fill_stresses(particles, lists, side);
        sums.terms.show(particles, lists, side);
        let set = sums.terms.set();
        accelerate(sums, (set, &[]), particles, lists, side);
    }
}

impl SignalSpeed for Conventional {
    #[inline(always)]
    fn speed(_: &Signals, _: usize, plain: f64) -> f64 {
        plain
    }
}

impl Gradient for Conventional {
    #[inline(always)]
    fn of<V: Lanes, S: PairScale>(
        &self,
        _: &Cluster,
        among: Among,
        around: Neighbourhood<S>,
    ) -> [F64x8; 9] {
        if among.moving {
            VelocityGradient { around }.run::<V>()
        } else {
            // No relative velocity: the sum would be this, to the bit.
            [F64x8([0.0; LANES]); 9]
        }
    }
}
