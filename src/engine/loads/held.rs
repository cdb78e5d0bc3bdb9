//! Impulse and work of prescribed velocities and of what holds rigid bodies.

use super::Loads;
use super::sums::sum_over;
use numerics::exact_sum::ExactSum;
use numerics::vector::cross;
use particles::ParticleStore;

impl Loads {
    /// Books impulse and work of loads and of what holds rigid bodies in a half kick of a step
    /// `dt` (s): before the first one, or after the second.
    pub(crate) fn book(&mut self, particles: &ParticleStore, dt: f64, first: bool) {
        if !self.has_motions() {
            return;
        }
        let mut sums = std::mem::take(&mut self.sums);
        let held = Held {
            loads: self,
            particles,
            half: 0.5 * dt,
            first,
        };
        for (by, sums) in sums[..self.motions.len()].iter_mut().enumerate() {
            for (k, part) in held.sums_of(by).iter().enumerate() {
                sums[k.min(3)].merge(part);
            }
        }
        let angular = sum_over(particles.owned(), |i| {
            let impulses = held.impulses(i)?.map(|(_, impulse, _)| impulse);
            Some(cross(&particles.position[i], &impulses))
        });
        self.sums = sums;
        for (sum, part) in self.angular_impulse.iter_mut().zip(&angular) {
            sum.merge(part);
        }
    }
}

/// Effect of prescribed velocities and rigid bodies on particles in a half kick.
struct Held<'a> {
    loads: &'a Loads,
    particles: &'a ParticleStore,
    /// Half of the step (s).
    half: f64,
    /// True if the half kick is the first.
    first: bool,
}

impl Held<'_> {
    /// Impulse (N s) along each axis and its work (J) of one load.
    fn sums_of(&self, by: usize) -> [ExactSum; 6] {
        sum_over(self.particles.owned(), |i| {
            let mut terms = [0.0; 6];
            for (a, (load, impulse, work)) in self.impulses(i)?.into_iter().enumerate() {
                if load.map(usize::from) == Some(by) {
                    (terms[a], terms[3 + a]) = (impulse, work);
                }
            }
            Some(terms)
        })
    }

    /// For each axis the ledger, the impulse (N s) and the work (J) that a particle takes; `None` where
    /// there is no load.
    fn impulses(&self, i: usize) -> Option<[(Option<u8>, f64, f64); 3]> {
        let Self {
            loads, particles, ..
        } = self;
        let bits = particles.load[i];
        let contact = particles.contact_acceleration.get(i);
        let is_idle = || loads.is_driven(bits) && contact.is_none_or(|c| *c == [0.0; 3]);
        // Forces alone move free bodies.
        if bits & !loads.free.bits() == 0 || is_idle() {
            return None;
        }
        let contact = contact.copied().unwrap_or_default();
        let prescribed = loads.of(bits);
        let push = loads.push(particles, i);
        let (mass, v) = (particles.mass[i], &particles.velocity[i]);
        Some(std::array::from_fn(|a| {
            let Some(by) = prescribed.by[a] else {
                return (None, 0.0, 0.0);
            };
            let middle = prescribed.middle[a];
            let change = if self.first {
                middle - v[a]
            } else {
                v[a] - middle
            };
            let forces = particles.acceleration[i][a] + contact[a] + push[a];
            let impulse = if prescribed.rigid {
                -mass * (self.half * forces)
            } else {
                let own = particles.gravity_acceleration.get(i);
                let gravity = own.map_or(loads.gravity[a], |own| loads.gravity[a] + own[a]);
                mass * (change - self.half * (forces + gravity))
            };
            (Some(by), impulse, impulse * (0.5 * (v[a] + middle)))
        }))
    }
}
