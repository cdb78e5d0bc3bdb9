//! Pressures on faces in the step, see the page on loads.
//!
//! A pressure acts on a particle by its [face](particles::ParticleStore::face), the acceleration by a unit of pressure, with
//! its mean over the step in both half kicks, so that the impulse is that of the table.

use super::absorption::Absorbed;
use super::{Loads, VelocityStage};
use model::Case;
use numerics::vector::{cross, dot};
use particles::ParticleStore;

/// Fields of particles by which loads move them, where absorbing zones, a relaxation or pressures do.
pub(crate) struct Acting<'a> {
    pub contact: &'a [[f64; 3]],
    pub load: &'a [u32],
    pub body: &'a [u32],
    pub absorption: &'a [f64],
    pub pressed: &'a [u32],
    pub face: &'a [[f64; 3]],
}

impl Acting<'_> {
    /// Acceleration by contact (m/s²) of a particle at `x` (m), and its motion beside forces.
    #[inline(always)]
    pub fn on(&self, i: usize, x: &[f64; 3], loads: &Loads) -> ([f64; 3], Absorbed) {
        let contact = self.contact.get(i).copied().unwrap_or_default();
        let prescribed = loads.at(self.load.get(i).copied().unwrap_or_default(), x);
        let zone = self.absorption.get(i).copied().unwrap_or_default();
        let rate = zone + loads.absorption.relaxing(self.body[i]);
        let absorbed = loads.absorption.of(prescribed, self.body[i], rate);
        let pressure = loads.pressure(self.pressed.get(i).copied().unwrap_or_default());
        let face = self.face.get(i).copied().unwrap_or_default();
        (contact, absorbed.pushed(face.map(|a| pressure * a)))
    }
}

impl Loads {
    /// The pressures that act on a particle of `body` that begins at `position` (m): a set of bits.
    pub(crate) fn pressed(case: &Case, body: usize, position: &[f64; 3]) -> u32 {
        let loads = case.loads.pressures.iter().enumerate();
        let acts = loads.filter(|(_, load)| load.body == body && load.region.contains(position));
        acts.fold(0, |bits, (k, _)| bits | 1 << k)
    }

    /// The sum of the pressures of a set (Pa).
    #[inline(always)]
    fn pressure(&self, mut bits: u32) -> f64 {
        let mut sum = 0.0;
        while bits != 0 {
            sum += self.pressures[bits.trailing_zeros() as usize];
            bits &= bits - 1;
        }
        sum
    }

    /// Acceleration of a particle by pressures on its faces (m/s²).
    #[inline(always)]
    pub(super) fn push(&self, particles: &ParticleStore, i: usize) -> [f64; 3] {
        let pressure = self.pressure(particles.pressed.get(i).copied().unwrap_or_default());
        let face = particles.face.get(i).copied().unwrap_or_default();
        face.map(|a| pressure * a)
    }

    /// Books impulse and work of pressures in a half kick of a step `dt` (s) that is about to come: the first one, or the
    /// second.
    pub(crate) fn book_pressures(&mut self, particles: &ParticleStore, dt: f64, first: bool) {
        let half = 0.5 * dt;
        let stage = if first {
            VelocityStage::Middle
        } else {
            VelocityStage::End
        };
        let acting = Acting {
            contact: &particles.contact_acceleration,
            load: &particles.load,
            body: &particles.body,
            absorption: &particles.absorption,
            pressed: &particles.pressed,
            face: &particles.face,
        };
        for n in 0..self.pressures.len() {
            let meant = |i: usize| particles.pressed[i] >> n & 1 == 1;
            let all = self.sum_where(particles, meant, |i| {
                let (contact, motion) = acting.on(i, &particles.position[i], self);
                let v = &particles.velocity[i];
                let mut total = std::array::from_fn(|a| {
                    particles.acceleration[i][a] + (contact[a] + self.gravity[a])
                });
                let mean = motion.mean(stage, v, half, &mut total);
                let share = particles.mass[i] * half * self.pressures[n];
                let impulse = particles.face[i].map(|a| share * a);
                let [x, y, z] = impulse;
                let [turn_x, turn_y, turn_z] = cross(&particles.position[i], &impulse);
                [x, y, z, dot(&impulse, &mean), turn_x, turn_y, turn_z]
            });
            let (sums, turn) = all.split_at(4);
            let ledger = &mut self.sums[self.motions.len() + self.absorption.count() + n];
            for (sum, part) in ledger.iter_mut().zip(sums) {
                sum.merge(part);
            }
            for (sum, part) in self.angular_impulse.iter_mut().zip(turn) {
                sum.merge(part);
            }
        }
    }
}
