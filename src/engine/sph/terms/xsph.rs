//! XSPH (Monaghan 1989): particles drift with the mean velocity of their neighbours.

use rayon::prelude::*;

use crate::loads::Loads;
use numerics::lanes::Lanes;
use particles::{GRAIN, ParticleStore};

/// The sums of eight receivers.
pub(super) struct Lane<V> {
    factor: V,
    sum: [V; 3],
}

impl<V: Lanes> Lane<V> {
    #[inline(always)]
    pub fn begin(epsilon: f64) -> Self {
        Self {
            factor: V::splat(-2.0 * epsilon),
            sum: [V::splat(0.0); 3],
        }
    }

    /// Sums `v_ij` times the `share` `m_j W/(ρ_i + ρ_j)`.
    #[inline(always)]
    pub fn follow(&mut self, v: &[V; 3], share: V) {
        for a in 0..3 {
            self.sum[a] = v[a].mul_add(share, self.sum[a]);
        }
    }

    /// `ε Σ (m_j/ρ̄) (v_j − v_i) W_ij` (m/s).
    #[inline(always)]
    pub fn correction(&self) -> [V; 3] {
        // Of what moves alike zero with a plus, as where no sum is made.
        let zero = V::splat(0.0);
        let [x, y, z] = self.sum;
        [
            x.mul_add(self.factor, zero),
            y.mul_add(self.factor, zero),
            z.mul_add(self.factor, zero),
        ]
    }
}

/// The rest of the drift of a step `dt` (s). The mean velocity of the neighbours is that of the
/// last sums, taken with the velocities predicted for the beginning of this step.
///
/// Particles that feel contact move with their own velocity: the energy of contact is a
/// function of their positions, and its balance holds only where force times velocity is work.
/// So do particles that a load drives, along the axes that it prescribes.
pub(super) fn drift(particles: &mut ParticleStore, loads: &Loads, dt: f64) {
    let (contact, bits) = (&particles.contact_acceleration, &particles.load);
    (&mut particles.position, &particles.velocity_correction)
        .into_par_iter()
        .with_min_len(GRAIN)
        .enumerate()
        .for_each(|(i, (x, correction))| {
            if contact.get(i).is_some_and(|force| *force != [0.0; 3]) {
                return;
            }
            let mut drift = *correction;
            if let Some(&bits) = bits.get(i) {
                loads.clear_prescribed(bits, &mut drift);
            }
            for a in 0..3 {
                x[a] += dt * drift[a];
            }
        });
}
