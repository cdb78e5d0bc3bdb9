//! Sums of a step over all particles and ranks: exact sums, counts and extremes.

use rayon::prelude::*;

use super::ledger::{NearestPair, RunState};
use super::meetings::Meetings;
use crate::contact::{Closest, Contact, ContactTable, least, pair_key, pair_of};
use crate::domain::Span;
use crate::gravity::SelfGravity;
use crate::loads::Loads;
use comm::{Comm, Joint};
use numerics::alone;
use numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use numerics::vector::cross;
use particles::Mirrors;
use particles::{GRAIN, ParticleStore};

/// Sums of a step beside contact and loads, with the memory to join all.
pub(crate) struct StepSums {
    /// Work of contact forces on this rank's particles.
    pub contact_work: ExactSum,
    /// Impulse of symmetry planes on particles that crossed them.
    pub crossing_impulse: [ExactSum; 3],
    /// The same about the origin.
    crossing_angular_impulse: [ExactSum; 3],
    /// Particles that crossed a symmetry plane in this step.
    pub crossings: i64,
    /// Extents of positions and velocities of all particles, after the step.
    pub span: Span,
    uncorrected: i64,
    meetings: Meetings,
    bodies: usize,
    /// Particles that have crossed a symmetry plane, by task.
    crossed: Vec<Vec<usize>>,
    /// True if there is friction or damping between bodies, whose heat is summed.
    friction: bool,
    joint: Joint,
}

/// Values on which ranks agree at the end of a step with its sums: first of this rank, then of all.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Votes {
    /// The first candidate for the next step, in the order of its words.
    pub candidate: [u64; 3],
    /// Requests of any rank (a set of bits).
    pub requests: u64,
    /// Sum of the counted work.
    pub work: u64,
    /// Largest load, which is the work of a rank over its speed.
    pub load: u64,
}

/// Other sums of a step on each rank.
pub(crate) struct Booked<'a> {
    pub contact: &'a mut Contact,
    pub loads: &'a mut Loads,
    pub self_gravity: Option<&'a mut SelfGravity>,
    pub mirrors: &'a Mirrors,
    /// Particles whose gradient has no correction.
    pub uncorrected: i64,
}

impl StepSums {
    pub fn new(table: &ContactTable) -> Self {
        Self {
            bodies: table.bodies(),
            crossed: Vec::new(),
            friction: table.has_heat(),
            meetings: Meetings::default(),
            contact_work: ExactSum::default(),
            crossing_impulse: Default::default(),
            crossing_angular_impulse: Default::default(),
            crossings: 0,
            uncorrected: 0,
            span: Span::NONE,
            joint: Joint::default(),
        }
    }

    pub fn memory(&self) -> usize {
        let crossed = self.crossed.iter().map(Vec::capacity).sum::<usize>();
        self.meetings.memory() + size_of::<usize>() * crossed + self.joint.memory()
    }

    /// Particles that crossed a symmetry plane change places with their images; books the impulse.
    pub fn cross_planes(
        &mut self,
        particles: &mut ParticleStore,
        mirrors: &Mirrors,
        loads: &Loads,
    ) {
        if mirrors.is_empty() {
            return;
        }
        let positions = particles.position.par_chunks(GRAIN);
        self.crossed.resize(positions.len(), Vec::new());
        (&mut self.crossed, positions)
            .into_par_iter()
            .enumerate()
            .for_each(|(chunk, (crossed, positions))| {
                let beyond = |(_, x): &(usize, &[f64; 3])| !mirrors.beyond(x).is_own();
                let indices = positions.iter().enumerate().filter(beyond);
                crossed.clear();
                crossed.extend(indices.map(|(k, _)| chunk * GRAIN + k));
            });
        for &i in self.crossed.iter().flatten() {
            alone::visit(1);
            self.crossings += 1;
            let (x, before) = (particles.position[i], particles.velocity[i]);
            mirrors.fold(particles, i);
            let (y, after) = (particles.position[i], particles.velocity[i]);
            let bits = particles.load.get(i);
            if bits.is_some_and(|&bits| loads.is_driven(bits)) {
                continue;
            }
            let mass = particles.mass[i];
            for a in 0..3 {
                self.crossing_impulse[a].add(mass * (after[a] - before[a]));
            }
            let (old, new) = (cross(&x, &before), cross(&y, &after));
            for a in 0..3 {
                self.crossing_angular_impulse[a].add(mass * (new[a] - old[a]));
            }
        }
    }

    fn exact<'a>(&'a mut self, booked: &'a mut Booked) -> impl Iterator<Item = &'a mut ExactSum> {
        let Booked {
            contact,
            loads,
            self_gravity,
            ..
        } = booked;
        let of_gravity = self_gravity.iter_mut().flat_map(|gravity| gravity.exact());
        [&mut self.contact_work]
            .into_iter()
            .chain(&mut self.crossing_impulse)
            .chain(&mut self.crossing_angular_impulse)
            .chain(&mut loads.angular_impulse)
            .chain(loads.sums.iter_mut().flatten())
            .chain(contact.surfaces.sums.iter_mut().flatten())
            .chain(&mut contact.surfaces.heat)
            .chain([&mut contact.sums.energy])
            .chain(&mut contact.sums.plane_force)
            .chain(&mut contact.sums.outside_torque)
            .chain(of_gravity)
    }

    /// Joins the sums of all ranks, if there are any, with the `votes` of this rank, which become those of
    /// all. Collective.
    pub fn join(&mut self, comm: &Comm, booked: Option<&mut Booked>, votes: &mut Votes) {
        let mut joint = std::mem::take(&mut self.joint);
        joint.sums.clear();
        joint.least.clear();
        (joint.first, joint.bits) = (votes.candidate, votes.requests);
        match booked {
            Some(booked) if comm.size() > 1 => {
                self.gather(booked, &mut joint);
                join_with_work(comm, &mut joint, votes);
                self.scatter(comm, booked, &joint);
            }
            Some(booked) => self.meet(comm, booked),
            None => join_with_work(comm, &mut joint, votes),
        }
        (votes.candidate, votes.requests) = (joint.first, joint.bits);
        self.joint = joint;
    }

    /// Adds this rank's sums and extremes to what ranks join. Positive doubles order as their bits do, and
    /// a largest value is the smallest complement.
    fn gather(&mut self, booked: &mut Booked, joint: &mut Joint) {
        self.uncorrected = booked.uncorrected;
        gather_limbs(self.exact(booked), &mut joint.sums);
        let contact = &mut *booked.contact;
        let news = self.meetings.news(&contact.sums.pairs);
        joint.sums.extend([
            self.uncorrected,
            self.crossings,
            contact.sums.interpenetrated,
            i64::try_from(news).unwrap_or(1),
        ]);
        let book = &mut contact.sums.pairs;
        self.meetings.gather(book, self.friction, &mut joint.sums);
        joint.least.extend([
            contact.sums.closest.map_or(u64::MAX, f64::to_bits),
            !contact.sums.foreign_fraction.to_bits(),
        ]);
        self.span.write(&mut joint.least);
    }

    /// Takes what the ranks have joined. Collective where bodies have met for the first time.
    fn scatter(&mut self, comm: &Comm, booked: &mut Booked, joint: &Joint) {
        let rest = scatter_limbs(self.exact(booked), &joint.sums);
        let contact = &mut *booked.contact;
        let (counts, rest) = rest.split_at(4);
        [self.uncorrected, self.crossings] = [counts[0], counts[1]];
        contact.sums.interpenetrated = counts[2];
        let book = &mut contact.sums.pairs;
        self.meetings.scatter(book, self.friction, rest);
        if counts[3] > 0 {
            self.meetings.admit(comm, book, self.friction);
        }
        self.meetings.note(book);
        let [closest, fraction] = [joint.least[0], !joint.least[1]];
        contact.sums.closest = (closest != u64::MAX).then(|| f64::from_bits(closest));
        contact.sums.foreign_fraction = f64::from_bits(fraction);
        self.span = Span::read(&joint.least[2..]);
    }

    /// Work of one rank alone in place of both.
    fn meet(&mut self, comm: &Comm, booked: &mut Booked) {
        self.uncorrected = booked.uncorrected;
        let book = &mut booked.contact.sums.pairs;
        if self.meetings.news(book) > 0 {
            self.meetings.admit(comm, book, self.friction);
        }
        self.meetings.note(book);
    }

    /// Books the sums of all ranks into the state, after the second half of a step `dt` (s).
    pub fn book(&mut self, state: &mut RunState, booked: &mut Booked, dt: f64) {
        state.book_loads(booked.loads, &booked.contact.surfaces, dt);
        let contact = &booked.contact.sums;
        state.contact_energy = contact.energy.value();
        state.contact_work += self.contact_work.value();
        self.contact_work = ExactSum::default();
        for a in 0..3 {
            state.plane_force[a] = contact.plane_force[a].value();
            state.plane_impulse[a] +=
                0.5 * dt * state.plane_force[a] + self.crossing_impulse[a].value();
            self.crossing_impulse[a] = ExactSum::default();
            state.outside_torque[a] = contact.outside_torque[a].value();
            state.angular_impulse[a] += 0.5 * dt * state.outside_torque[a]
                + self.crossing_angular_impulse[a].value()
                + booked.loads.angular_impulse[a].value();
            self.crossing_angular_impulse[a] = ExactSum::default();
            booked.loads.angular_impulse[a] = ExactSum::default();
        }
        if let Some(gravity) = &booked.self_gravity {
            gravity.book(state, dt);
        }
        state.plane_crossings += std::mem::take(&mut self.crossings);
        let along = std::array::from_fn(|a| booked.mirrors.plane(a).is_none());
        let bodies = self.bodies;
        for key in self.meetings.keys() {
            state.pair(pair_of(bodies, key));
        }
        for pair in &mut state.pairs {
            let [a, b] = pair.bodies;
            pair.book(contact.pairs.get(pair_key(bodies, a, b)), along, dt);
        }
        state.interpenetrated = state.interpenetrated.max(contact.interpenetrated);
        state.uncorrected = self.uncorrected;
        let worst = &mut state.worst;
        worst.interpenetrated = worst.interpenetrated.max(contact.interpenetrated);
        worst.uncorrected = worst.uncorrected.max(self.uncorrected);
        worst.foreign_fraction = worst.foreign_fraction.max(contact.foreign_fraction);
        worst.closest = least(worst.closest, contact.closest);
        state.book_defect();
    }

    /// Joins what the pairs of bodies have come to since the last time on all ranks into the state:
    /// before rows and checkpoints. Collective.
    pub fn join_extremes(&mut self, comm: &Comm, state: &mut RunState) {
        let bodies = self.bodies;
        for (key, extremes) in self.meetings.join(comm) {
            let met = pair_of(bodies, key);
            state.pair(met).extremes.join(&extremes);
            let Some(Closest {
                distance,
                particles,
            }) = extremes.closest
            else {
                continue;
            };
            let nearest = NearestPair {
                distance,
                bodies: met,
                particles,
            };
            let worst = &mut state.worst.nearest;
            *worst = Some(worst.map_or(nearest, |worst| worst.min(nearest)));
        }
    }
}

/// Joins what ranks have, and with it the sum of their work and their largest load. Collective.
fn join_with_work(comm: &Comm, joint: &mut Joint, votes: &mut Votes) {
    joint.sums.push(votes.work.cast_signed());
    joint.least.push(!votes.load);
    comm.join(joint);
    let (sum, least) = (joint.sums.pop(), joint.least.pop());
    (votes.work, votes.load) = (
        sum.unwrap_or_default().cast_unsigned(),
        !least.unwrap_or(u64::MAX),
    );
}
