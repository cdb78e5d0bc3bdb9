//! Witness planes: what passes them, by body and direction, and where.
//!
//! A particle knows the side of each plane that it is on, as state. At the end of a step in which it has
//! changed sides it has passed, where and when it was on the plane as it moved with its velocity
//! in a straight line. Ranks keep what passes until a row of the tables or a checkpoint; then all of
//! it is joined in the order of steps, planes and ids and added to the ledgers one by one, so that
//! they have the same bits for any ranks and restarts.

use crate::diagnose::{Passed, RunState};
use comm::Comm;
use model::{Case, Witness};
use numerics::alone;
use numerics::collector::Collector;
use numerics::ordered::{disordered, ordered};
use numerics::vector::{dot, square};
use particles::{GRAIN, ParticleStore};

/// A particle that has passed a witness plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The step in which it passed.
    pub step: u64,
    /// Index of the plane.
    pub plane: usize,
    /// Its identity.
    pub id: u64,
    /// Index of its body.
    pub body: usize,
    /// True if it went along the normal.
    pub forwards: bool,
    /// When (s).
    pub time: f64,
    /// Position (m).
    pub position: [f64; 3],
    /// Its velocity at the end of the step (m/s).
    pub velocity: [f64; 3],
    /// Its mass (kg).
    pub mass: f64,
    /// Its internal energy (J).
    pub internal_energy: f64,
}

/// Words of a crossing in a message.
const WORDS: usize = 12;

impl Crossing {
    /// As words, which begin with what crossings are ordered by.
    fn write(&self, words: &mut Vec<u64>) {
        let sides = (self.plane as u64) << 33 | (self.body as u64) << 1 | u64::from(self.forwards);
        words.extend([self.step, sides, self.id]);
        let numbers = [self.time, self.mass, self.internal_energy];
        let vectors = self.position.into_iter().chain(self.velocity);
        words.extend(numbers.into_iter().chain(vectors).map(ordered));
    }

    /// Takes the words of [`Self::write`].
    fn read(words: &[u64]) -> Self {
        let real = |k: usize| disordered(words[k]);
        let three = |first: usize| std::array::from_fn(|a| real(first + a));
        let index = |word: u64| usize::try_from(word).unwrap_or(usize::MAX);
        let sides = words[1];
        Self {
            step: words[0],
            plane: index(sides >> 33),
            body: index(sides >> 1 & u64::from(u32::MAX)),
            forwards: sides & 1 == 1,
            id: words[2],
            time: real(3),
            mass: real(4),
            internal_energy: real(5),
            position: three(6),
            velocity: three(9),
        }
    }
}

/// Witness planes of a case, and the particles that pass them.
#[derive(Debug, Default)]
pub struct Witnesses {
    planes: Vec<Witness>,
    bodies: usize,
    /// Crossings on this rank since the last time that all ranks joined.
    passed: Vec<Crossing>,
    /// Particles that have passed in a step.
    passing: Vec<u32>,
    collector: Collector,
}

impl Witnesses {
    /// Those of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        Self {
            planes: case.measure.witnesses.clone(),
            bodies: case.bodies.len(),
            ..Self::default()
        }
    }

    /// True if there are any planes.
    #[must_use]
    pub fn any(&self) -> bool {
        !self.planes.is_empty()
    }

    /// Number of ledgers: by plane, body and direction, the one along the normal first.
    #[must_use]
    pub fn ledgers(&self) -> usize {
        2 * self.planes.len() * self.bodies
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of::<Crossing>() * self.passed.capacity()
            + 4 * self.passing.capacity()
            + self.collector.memory()
    }

    /// The planes that a position (m) is beyond: a set of bits.
    fn sides(&self, x: &[f64; 3]) -> u32 {
        let planes = self.planes.iter().enumerate();
        planes.fold(0, |sides, (k, plane)| {
            sides | u32::from(plane.beyond(x) > 0.0) << k
        })
    }

    /// Marks particles at the start of a case by the sides that they are on.
    pub fn begin(&self, particles: &mut ParticleStore) {
        if !self.any() {
            return;
        }
        // At the start, not in every step.
        for i in 0..particles.owned() {
            particles.witness_sides[i] = self.sides(&particles.position[i]);
        }
    }

    /// Notes the particles that have passed a plane in the last step of a state.
    pub fn watch(&mut self, particles: &mut ParticleStore, state: &RunState) {
        if !self.any() {
            return;
        }
        let (step, time, dt) = (state.step, state.time, state.last_dt);
        let mut passing = std::mem::take(&mut self.passing);
        passing.clear();
        let mut collector = std::mem::take(&mut self.collector);
        let (positions, known) = (&particles.position, &particles.witness_sides);
        collector.extend(&mut passing, (particles.owned(), GRAIN), |i| {
            let is_passing = self.sides(&positions[i]) != known[i];
            is_passing.then(|| u32::try_from(i).unwrap_or(u32::MAX))
        });
        self.collector = collector;
        alone::visit(passing.len());
        for i in passing.iter().map(|&i| i as usize) {
            let sides = self.sides(&particles.position[i]);
            let mut changed = std::mem::replace(&mut particles.witness_sides[i], sides) ^ sides;
            while changed != 0 {
                let plane = changed.trailing_zeros() as usize;
                changed &= changed - 1;
                let crossing = self.crossing(particles, i, plane, (time, dt));
                self.passed.push(Crossing { step, ..crossing });
            }
        }
        self.passing = passing;
    }

    /// Particle `i`, which has passed a plane in a step `dt` (s) that ends at a time (s).
    fn crossing(
        &self,
        particles: &ParticleStore,
        i: usize,
        plane: usize,
        (time, dt): (f64, f64),
    ) -> Crossing {
        let (x, v) = (&particles.position[i], &particles.velocity[i]);
        let witness = &self.planes[plane];
        let (beyond, speed) = (witness.beyond(x), dot(&witness.normal, v));
        let ago = if speed == 0.0 { 0.0 } else { beyond / speed };
        let ago = ago.clamp(0.0, dt);
        let mass = particles.thermal_mass(i);
        Crossing {
            step: 0,
            plane,
            id: particles.id[i],
            body: particles.body[i] as usize,
            forwards: beyond > 0.0,
            time: time - ago,
            position: std::array::from_fn(|a| x[a] - ago * v[a]),
            velocity: *v,
            mass,
            internal_energy: mass * particles.specific_energy[i],
        }
    }

    /// Joins what has passed on all ranks, adds it to the ledgers and gives it in its order: before
    /// rows and checkpoints. The same on all ranks. Collective.
    pub fn join(&mut self, ledgers: &mut [Passed], comm: &Comm) -> Vec<Crossing> {
        if !self.any() {
            return Vec::new();
        }
        let mut most = [self.passed.len() as u64];
        comm.max_u64(&mut most);
        let places = usize::try_from(most[0]).unwrap_or(usize::MAX);
        let mut own = Vec::with_capacity(WORDS * places);
        for crossing in self.passed.drain(..) {
            crossing.write(&mut own);
        }
        own.resize(WORDS * places, u64::MAX);
        let mut all = Vec::new();
        comm.all_gather_u64(&own, &mut all);
        let there = all.chunks_exact(WORDS).filter(|words| words[0] != u64::MAX);
        let mut joined: Vec<Crossing> = there.map(Crossing::read).collect();
        joined.sort_by_key(|crossing| (crossing.step, crossing.plane, crossing.id));
        for crossing in &joined {
            let side = usize::from(!crossing.forwards);
            let at = 2 * (crossing.plane * self.bodies + crossing.body) + side;
            let ledger = &mut ledgers[at];
            let (m, v) = (crossing.mass, &crossing.velocity);
            ledger.particles += 1;
            ledger.mass += m;
            ledger.kinetic_energy += 0.5 * m * square(v);
            ledger.internal_energy += crossing.internal_energy;
            for a in 0..3 {
                ledger.momentum[a] += m * v[a];
            }
        }
        joined
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_come_back_from_their_words() {
        let crossing = Crossing {
            step: 7,
            plane: 31,
            id: u64::MAX >> 2,
            body: 1_000_000,
            forwards: true,
            time: 1e-6,
            position: [-1.0, 0.0, 2e-3],
            velocity: [5.0, -7e3, 0.25],
            mass: 3e-9,
            internal_energy: -1.5,
        };
        let mut words = Vec::new();
        crossing.write(&mut words);
        assert_eq!(words.len(), WORDS);
        assert_eq!(Crossing::read(&words), crossing);
    }
}
