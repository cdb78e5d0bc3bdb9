//! From the results of tasks to the store and the sums.

use super::force::{ContactForce, TaskForces};
use super::sums::ContactSums;
use particles::Scatter;

/// Work for a foreign neighbour, in neighbours of the pair sums, as timed on the quarter impact:
/// its own sums, its search, and the disorder where bodies meet.
const FOREIGN_WORK: usize = 90;

/// A foreign particle closer than this (in mean spacings) counts as interpenetrated.
const INTERPENETRATION_DISTANCE: f64 = 0.28;

/// Target of contact forces, and the fields of particles that the sums need.
pub(super) struct Accumulators<'a> {
    pub acceleration: Scatter<'a, [f64; 3]>,
    /// That by stress and viscosity.
    pub viscous: Scatter<'a, [f64; 3]>,
    pub energy: Scatter<'a, f64>,
    pub stiffness: Scatter<'a, f64>,
    pub heating: Scatter<'a, f64>,
    pub approach: Scatter<'a, f64>,
    pub work: Scatter<'a, u32>,
    pub id: &'a [u64],
    /// Number of bodies.
    pub bodies: usize,
    pub mass: &'a [f64],
    pub position: &'a [[f64; 3]],
    pub enclosed_time: &'a [f64],
    pub foreign_fraction: &'a [f64],
    pub excess: &'a [f64],
    pub enclosed_limit: f64,
    /// Safety factor of the contact step.
    pub safety: f64,
}

impl Accumulators<'_> {
    #[inline]
    pub fn book(&self, forces: &TaskForces, sums: &mut ContactSums) {
        for force in &forces.particles {
            self.book_particle(force);
            let i = force.particle;
            sums.energy.add(force.energy);
            sums.add_plane_force(&force.from_mirrors, &self.position[i]);
            let inside = force.closest < INTERPENETRATION_DISTANCE
                || self.enclosed_time[i] > self.enclosed_limit;
            sums.note_particle(inside, force.closest, self.foreign_fraction[i]);
        }
        for force in &forces.by_body {
            let i = force.particle;
            // SAFETY: a particle is receiver in one task, and each thread has its own tasks.
            let stiffness = unsafe { *self.stiffness.slot(i) };
            let dt =
                (stiffness > 0.0).then(|| 2.0 * self.safety * (self.mass[i] / stiffness).sqrt());
            let particles = [self.id[i], self.id[force.nearest]];
            sums.note_pair(self.bodies, force, particles, self.excess[i], dt);
        }
    }

    #[inline]
    fn book_particle(&self, contact: &ContactForce) {
        let (i, mass) = (contact.particle, self.mass[contact.particle]);
        let per_mass = 1.0 / mass;
        // SAFETY: a particle is receiver in one task, and each thread has its own tasks.
        let (acceleration, viscous, energy, stiffness, heating, approach, work) = unsafe {
            (
                self.acceleration.slot(i),
                self.viscous.slot(i),
                self.energy.slot(i),
                self.stiffness.slot(i),
                self.heating.slot(i),
                self.approach.slot(i),
                self.work.slot(i),
            )
        };
        for a in 0..3 {
            acceleration[a] += contact.force[a] * per_mass;
            viscous[a] += contact.drag[a] * per_mass;
        }
        let more = u32::try_from(FOREIGN_WORK * contact.neighbours);
        *work = work.saturating_add(more.unwrap_or(u32::MAX));
        *energy += contact.energy;
        *stiffness += contact.stiffness;
        *heating += contact.heat * per_mass;
        // A step of m/c is stable: as if it were that of a spring, 2 √(m/k).
        let rate = contact.dashpot * per_mass;
        *stiffness += 4.0 * mass * (rate * rate);
        *approach = approach.max(contact.approach);
    }
}
