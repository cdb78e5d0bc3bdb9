//! Contact forces on their way from pairs of particles to the store and the sums.

use super::pair::Pair;
use super::view::{ContactParticle, Separation};
use numerics::virial::Virial;
use particles::empty;

/// Forces of contact of one mode on one particle.
#[derive(Debug, Clone, Copy)]
pub struct ContactForce {
    /// Index in the store.
    pub particle: usize,
    /// Number of foreign neighbours.
    pub neighbours: usize,
    /// Force (N).
    pub force: [f64; 3],
    /// Force of the viscosity of contact, which is no part of `force` (N).
    pub drag: [f64; 3],
    /// The part of both that images behind symmetry planes exert (N).
    pub from_mirrors: [f64; 3],
    /// Its share of the contact energy (J).
    pub energy: f64,
    /// Stiffness for the time step (N/m).
    pub stiffness: f64,
    /// Damping for the time step (N s/m).
    pub dashpot: f64,
    /// Its share of the heat by friction, damping and viscosity (W).
    pub heat: f64,
    /// Smallest distance to a foreign particle in mean spacings.
    pub closest: f64,
    /// Largest approach speed `|μ|` towards a foreign particle (m/s).
    pub approach: f64,
}

/// Forces of one foreign body on one particle.
#[derive(Debug, Clone, Copy)]
pub struct BodyForce {
    /// Index in the store.
    pub particle: usize,
    /// The body of the particle, and the other.
    pub bodies: [usize; 2],
    /// Force, with that of viscosity (N).
    pub force: [f64; 3],
    /// Share of the contact energy (J).
    pub energy: f64,
    /// Share of the heat by friction and damping (W).
    pub heat: f64,
    /// Smallest distance to a particle of that body in mean spacings.
    pub closest: f64,
    /// Index of that particle in the store.
    pub nearest: usize,
}

/// Stress that contact forces carry through the material of a particle.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ContactStress {
    /// Of all forces, over half of the line of each pair and all of that to a rigid surface.
    pub virial: Virial,
    /// The sum of what presses, without friction of pairs (N); zero without contact.
    pub press: [f64; 3],
}

impl ContactStress {
    /// Adds a force and the part of it that presses (N), over an arm (m).
    #[inline(always)]
    pub fn add(&mut self, force: &[f64; 3], press: &[f64; 3], arm: &[f64; 3]) {
        self.virial.add(force, arm);
        for a in 0..3 {
            self.press[a] += press[a];
        }
    }

    /// Leaves out what pairs of points of rings cancel.
    pub fn mirror(&mut self) {
        let [.., xz, yz] = &mut self.virial.0;
        (*xz, *yz, self.press[2]) = (0.0, 0.0, 0.0);
    }

    pub fn join(&mut self, other: &Self) {
        self.virial.join(&other.virial);
        for a in 0..3 {
            self.press[a] += other.press[a];
        }
    }
}

/// Contact forces on the particles of one task, kept from step to step.
#[derive(Debug, Default)]
pub struct TaskForces {
    /// Those on each of them, mode after mode.
    pub particles: Vec<ContactForce>,
    /// The same by the other body.
    pub by_body: Vec<BodyForce>,
}

/// The particle that forces of pairs are added to.
pub(super) struct Receiver<'a> {
    pub sum: ContactForce,
    body: usize,
    by_body: &'a mut Vec<BodyForce>,
    /// Index of the first of its own.
    first: usize,
}

impl TaskForces {
    /// Forgets everything but the buffers.
    pub fn clear(&mut self) {
        empty(&mut self.particles);
        empty(&mut self.by_body);
    }

    pub(super) fn memory(&self) -> usize {
        size_of::<ContactForce>() * self.particles.capacity()
            + size_of::<BodyForce>() * self.by_body.capacity()
    }
}

impl<'a> Receiver<'a> {
    pub fn new(i: &ContactParticle, neighbours: usize, by_body: &'a mut Vec<BodyForce>) -> Self {
        Self {
            sum: ContactForce {
                particle: i.slot,
                neighbours,
                force: [0.0; 3],
                drag: [0.0; 3],
                from_mirrors: [0.0; 3],
                energy: 0.0,
                stiffness: 0.0,
                dashpot: 0.0,
                heat: 0.0,
                closest: f64::INFINITY,
                approach: 0.0,
            },
            body: i.body,
            first: by_body.len(),
            by_body,
        }
    }

    /// Distance and approach of the pair with `other`.
    #[inline]
    pub fn meet(&mut self, other: &ContactParticle, separation: &Separation, pair: &Pair) {
        separation.raise_approach(pair.h, &mut self.sum.approach);
        let distance = separation.distance * pair.inverse_spacing;
        self.sum.closest = self.sum.closest.min(distance);
        let body = self.by(other.body);
        if distance < body.closest {
            (body.closest, body.nearest) = (distance, other.slot);
        }
    }

    /// Force (N), energy (J) and heat (W) of the pair with `other`.
    #[inline]
    pub fn add(&mut self, other: &ContactParticle, force: &[f64; 3], energy: f64, heat: f64) {
        self.sum.energy += energy;
        self.sum.heat += heat;
        for a in 0..3 {
            self.sum.force[a] += force[a];
        }
        let body = self.exert(other, force);
        body.energy += energy;
        body.heat += heat;
    }

    /// Viscosity of the pair with `other`, which approaches: `drag` (N), which is `force` (N).
    #[inline]
    pub fn brake(
        &mut self,
        other: &ContactParticle,
        (separation, force): (&Separation, &[f64; 3]),
        drag: f64,
        pair: &Pair,
    ) {
        for a in 0..3 {
            self.sum.drag[a] += force[a];
        }
        let approach = separation.approach();
        self.sum.heat += pair.heat_share * (drag * approach);
        // Its matrix has the two on its diagonal and off it.
        self.sum.dashpot += 2.0 * drag / approach;
        self.exert(other, force);
    }

    /// Books a force (N) of `other` by where that stands and by its body; gives what is by this body.
    #[inline]
    fn exert(&mut self, other: &ContactParticle, force: &[f64; 3]) -> &mut BodyForce {
        if !other.mirror_mask.is_own() {
            for a in 0..3 {
                self.sum.from_mirrors[a] += force[a];
            }
        }
        let body = self.by(other.body);
        for a in 0..3 {
            body.force[a] += force[a];
        }
        body
    }

    /// Entry by one body, beside few others.
    #[inline]
    fn by(&mut self, body: usize) -> &mut BodyForce {
        let own = &self.by_body[self.first..];
        let at = own.iter().position(|entry| entry.bodies[1] == body);
        let at = at.map_or(self.by_body.len(), |at| self.first + at);
        if at == self.by_body.len() {
            self.by_body.push(BodyForce {
                particle: self.sum.particle,
                bodies: [self.body, body],
                force: [0.0; 3],
                energy: 0.0,
                heat: 0.0,
                closest: f64::INFINITY,
                nearest: 0,
            });
        }
        &mut self.by_body[at]
    }
}
