//! From the results of tasks to the store and the sums.

use super::sums::{ContactSums, Met};
use super::task::{Booked, Task, Weighed};
use crate::particles::Scatter;

/// Work for a foreign neighbour, in neighbours of the pair sums, as timed on the quarter impact: its
/// own sums, its search, and the disorder where bodies meet.
const FOREIGN_WORK: usize = 90;

/// A foreign particle closer than this (in mean spacings) counts as interpenetrated.
const INTERPENETRATION_DISTANCE: f64 = 0.28;

/// Where foreign fractions go.
pub(super) struct Fractions<'a> {
    pub fraction: Scatter<'a, f64>,
    pub excess: Scatter<'a, f64>,
    pub modulus: Scatter<'a, f64>,
    pub touching: Scatter<'a, f64>,
    pub slope: Scatter<'a, f64>,
    pub enclosed: Scatter<'a, f64>,
}

impl Fractions<'_> {
    #[inline]
    pub fn store(&self, weighed: &Weighed) {
        let (i, fraction) = (weighed.base, &weighed.fraction);
        // SAFETY: a particle is receiver in one task, and each thread has its own tasks.
        unsafe {
            *self.fraction.slot(i) = fraction.fraction;
            *self.excess.slot(i) = fraction.excess;
            *self.modulus.slot(i) = fraction.modulus;
            *self.touching.slot(i) = fraction.touching;
            *self.slope.slot(i) = fraction.slope;
            *self.enclosed.slot(i) = weighed.enclosed;
        }
    }
}

/// Where reactions go, and what of the particles the sums need.
pub(super) struct Books<'a> {
    pub acceleration: Scatter<'a, [f64; 3]>,
    pub energy: Scatter<'a, f64>,
    pub stiffness: Scatter<'a, f64>,
    pub heating: Scatter<'a, f64>,
    pub approach: Scatter<'a, f64>,
    pub work: Scatter<'a, u32>,
    pub id: &'a [u64],
    /// How many there are.
    pub bodies: usize,
    pub mass: &'a [f64],
    pub enclosed_time: &'a [f64],
    pub foreign_fraction: &'a [f64],
    pub excess: &'a [f64],
    pub enclosed_limit: f64,
    /// Safety factor of the contact step.
    pub safety: f64,
    pub friction: bool,
}

impl Books<'_> {
    #[inline]
    pub fn book(&self, task: &Task, sums: &mut ContactSums) {
        for booked in &task.reactions {
            self.book_particle(booked);
            let i = booked.base;
            sums.energy.add(booked.energy);
            sums.add_plane_force(&booked.from_mirrors);
            let inside = booked.closest < INTERPENETRATION_DISTANCE
                || self.enclosed_time[i] > self.enclosed_limit;
            sums.note_particle(inside, booked.closest, self.foreign_fraction[i]);
        }
        for (i, body, reaction) in &task.by_body {
            // SAFETY: a particle is receiver in one task, and each thread has its own tasks.
            let stiffness = unsafe { *self.stiffness.slot(*i) };
            let dt = if stiffness > 0.0 {
                2.0 * self.safety * (self.mass[*i] / stiffness).sqrt()
            } else {
                f64::INFINITY
            };
            let met = Met {
                body: *body,
                excess: self.excess[*i],
                dt,
                particles: [self.id[*i], self.id[reaction.nearest]],
            };
            sums.note_pair(self.bodies, &met, reaction);
        }
    }

    #[inline]
    fn book_particle(&self, booked: &Booked) {
        let (i, mass) = (booked.base, self.mass[booked.base]);
        let per_mass = 1.0 / mass;
        // SAFETY: a particle is receiver in one task, and each thread has its own tasks.
        let (acceleration, energy, stiffness, heating, approach, work) = unsafe {
            (
                self.acceleration.slot(i),
                self.energy.slot(i),
                self.stiffness.slot(i),
                self.heating.slot(i),
                self.approach.slot(i),
                self.work.slot(i),
            )
        };
        for a in 0..3 {
            acceleration[a] += booked.force[a] * per_mass;
        }
        let more = u32::try_from(FOREIGN_WORK * booked.neighbours);
        *work = work.saturating_add(more.unwrap_or(u32::MAX));
        *energy += booked.energy;
        *stiffness += booked.stiffness;
        if self.friction {
            *heating += booked.heat * per_mass;
            // A step of m/c is stable: as if it were that of a spring, 2 √(m/k).
            let rate = booked.dashpot * per_mass;
            *stiffness += 4.0 * mass * (rate * rate);
        }
        *approach = approach.max(booked.approach);
    }
}
