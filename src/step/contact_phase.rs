//! Contact in the step: foreign fractions before the exchange of stresses, forces after it.

use rayon::prelude::*;

use super::contact_sums::{ContactSums, Met};
use super::search::{GRAIN, Search};
use super::simulation::Simulation;
use crate::comm::Comm;
use crate::contact::hold::{self, Hold};
use crate::contact::overlap::{self, Fraction};
use crate::contact::{BodyReaction, ContactTable, ContactView, Reaction, penalty, potential};
use crate::neighbours::{CHUNKS_AT_ONCE, Chunk, ForeignChunk};
use crate::particles::{HaloPhase, ParticleStore, Scatter};

/// Results of each task before they go into the store, kept from step to step.
#[derive(Default)]
pub struct ContactPhase {
    tasks: Vec<Task>,
}

#[derive(Default)]
struct Task {
    fractions: Vec<Weighed>,
    normals: Vec<(usize, [f64; 3])>,
    holds: Vec<(usize, Hold)>,
    /// Of `penalty` contact, see [`penalty::boundary`].
    boundary: Vec<(usize, [f64; 3])>,
    reactions: Vec<Booked>,
    /// Receiving particle and its body, and what another body does to it.
    by_body: Vec<(usize, usize, BodyReaction)>,
    reaction: Reaction,
}

/// The foreign fraction of one particle, and for how long it has been enclosed after this step (s).
struct Weighed {
    base: usize,
    fraction: Fraction,
    enclosed: f64,
}

/// What contact does to one particle.
#[derive(Clone, Copy)]
struct Booked {
    base: usize,
    force: [f64; 3],
    from_mirrors: [f64; 3],
    energy: f64,
    stiffness: f64,
    dashpot: f64,
    heat: f64,
    closest: f64,
    approach: f64,
    /// Number of foreign neighbours.
    neighbours: usize,
}

/// Work for a foreign neighbour, in neighbours of the pair sums, as timed on the quarter impact: its
/// own sums, its search, and the disorder where bodies meet.
const FOREIGN_WORK: usize = 90;

/// A foreign particle closer than this (in mean spacings) counts as interpenetrated.
const INTERPENETRATION_DISTANCE: f64 = 0.28;
/// A particle whose foreign fraction with current volumes exceeds this is enclosed.
const ENCLOSED_FRACTION: f64 = 0.5;

impl ContactPhase {
    pub(super) fn memory(&self) -> usize {
        let task = |task: &Task| {
            size_of::<Weighed>() * task.fractions.capacity()
                + size_of::<(usize, [f64; 3])>() * task.normals.capacity()
                + size_of::<(usize, Hold)>() * task.holds.capacity()
                + size_of::<(usize, [f64; 3])>() * task.boundary.capacity()
                + size_of::<Booked>() * task.reactions.capacity()
                + size_of::<(usize, usize, BodyReaction)>() * task.by_body.capacity()
                + size_of::<BodyReaction>() * task.reaction.by_body.capacity()
        };
        size_of::<Task>() * self.tasks.capacity() + self.tasks.iter().map(task).sum::<usize>()
    }
}

/// What the contact sums read after a step of `dt` (s).
fn view<'a>(
    search: &'a Search,
    store: &'a ParticleStore,
    table: &'a ContactTable,
    dt: f64,
) -> ContactView<'a> {
    ContactView {
        images: search.sequence.images(),
        motion: &search.motion,
        store,
        table,
        dt,
    }
}

impl Simulation {
    /// Foreign fraction, excess and their weights of every particle with foreign neighbours.
    pub(super) fn contact_fractions(&mut self, dt: f64) {
        if !self.contact.is_active() {
            return;
        }
        self.run_fractions(dt);
        self.find_boundaries();
        let store = &mut self.store;
        // What else there is of a fraction nobody reads without excess.
        for field in [
            &mut store.foreign_fraction,
            &mut store.contact_excess,
            &mut store.enclosed_time,
        ] {
            fill(field, 0.0);
        }
        fill(&mut store.contact_normal, [0.0; 3]);
        let tasks = &self.contact_phase.tasks;
        for &(i, normal) in tasks.iter().flat_map(|task| &task.normals) {
            store.contact_normal[i] = normal;
        }
        let target = Fractions {
            fraction: Scatter::new(&mut store.foreign_fraction),
            excess: Scatter::new(&mut store.contact_excess),
            modulus: Scatter::new(&mut store.contact_modulus),
            touching: Scatter::new(&mut store.touching_value),
            slope: Scatter::new(&mut store.contact_slope),
            enclosed: Scatter::new(&mut store.enclosed_time),
        };
        let tasks = tasks.par_iter().with_max_len(CHUNKS_AT_ONCE);
        tasks.for_each(|task| {
            task.fractions
                .iter()
                .for_each(|weighed| target.store(weighed));
        });
    }

    /// Friction and damping after a step of `dt` (s), of every particle in contact. Collective.
    pub(super) fn hold_by_friction(&mut self, comm: &Comm, dt: f64) {
        if !self.contact.has_friction() {
            return;
        }
        let view = view(&self.search, &self.store, &self.contact, dt);
        self.contact_phase
            .tasks
            .par_iter_mut()
            .zip(self.search.foreign.chunks())
            .zip(self.search.clusters.chunks())
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|((task, foreign), own)| task.hold(&view, foreign, own));
        self.store_holds();
        self.halo.post(comm, &self.store, HaloPhase::FRICTION);
        self.halo.finish(&mut self.store, HaloPhase::FRICTION);
    }

    /// What friction remembers, and what it does to each pair.
    fn store_holds(&mut self) {
        let store = &mut self.store;
        for field in [
            &mut store.slip,
            &mut store.slip_rate,
            &mut store.friction_force,
        ] {
            fill(field, [0.0; 3]);
        }
        fill(&mut store.sliding, 0);
        for field in [
            &mut store.friction_load,
            &mut store.friction_power,
            &mut store.friction_energy,
        ] {
            fill(field, 0.0);
        }
        for &(i, Hold { load, grip }) in self.contact_phase.tasks.iter().flat_map(|t| &t.holds) {
            store.slip[i] = grip.memory.slip;
            store.slip_rate[i] = grip.memory.rate;
            store.sliding[i] = u32::from(grip.memory.sliding);
            store.friction_force[i] = grip.force;
            store.friction_load[i] = load;
            store.friction_power[i] = grip.power;
            store.friction_energy[i] = grip.energy;
        }
    }

    /// Foreign fractions after a step of `dt` (s).
    fn run_fractions(&mut self, dt: f64) {
        let friction = self.contact.has_friction();
        let chunks = self.search.foreign.chunks();
        self.contact_phase
            .tasks
            .resize_with(chunks.len(), Task::default);
        let view = view(&self.search, &self.store, &self.contact, 0.0);
        self.contact_phase
            .tasks
            .par_iter_mut()
            .zip(chunks)
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|(task, chunk)| {
                task.fractions.clear();
                task.normals.clear();
                for (place, neighbours) in chunk.overlap.iter() {
                    let base = view.images[place as usize].base();
                    let relief = view.store.touch_relief[base];
                    let fraction = overlap::fraction(&view, place, neighbours, relief);
                    let mut enclosed = 0.0;
                    if fraction.current > ENCLOSED_FRACTION {
                        enclosed = view.store.enclosed_time[base] + dt;
                    }
                    if friction {
                        let normal = overlap::normal(&view, place, neighbours, &fraction);
                        task.normals.push((base, normal));
                    }
                    task.fractions.push(Weighed {
                        base,
                        fraction,
                        enclosed,
                    });
                }
            });
    }

    /// Normals of the boundary particles that `penalty` contact may press on.
    fn find_boundaries(&mut self) {
        if !self.contact.has_penalty() {
            return;
        }
        let view = view(&self.search, &self.store, &self.contact, 0.0);
        self.contact_phase
            .tasks
            .par_iter_mut()
            .zip(self.search.foreign.chunks())
            .zip(self.search.clusters.chunks())
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|((task, foreign), own)| task.find_boundaries(&view, foreign, own));
        fill(&mut self.store.boundary_normal, [0.0; 3]);
        for (i, normal) in self.contact_phase.tasks.iter().flat_map(|t| &t.boundary) {
            self.store.boundary_normal[*i] = *normal;
        }
    }

    /// Gives every particle the relief that makes it start free of force; returns how many had
    /// to be capped on this rank. For the start of a case, before the first forces.
    pub(super) fn set_touch_relief(&mut self) -> i64 {
        if !self.contact.is_active() {
            return 0;
        }
        self.run_fractions(0.0);
        let mut capped = 0;
        for weighed in self.contact_phase.tasks.iter().flat_map(|t| &t.fractions) {
            let (relief, was_capped) = overlap::relief(&weighed.fraction);
            self.store.touch_relief[weighed.base] = relief;
            capped += i64::from(was_capped);
        }
        capped
    }

    /// Contact forces after a step `dt` (s), the energy of contact, and what the time step must know
    /// of both.
    pub(super) fn contact_forces(&mut self, dt: f64) {
        self.sums.clear_rates();
        if self.contact.is_active() {
            self.run_reactions(dt);
            self.store_reactions();
            self.surface_forces(dt);
        }
        for force in self
            .sweeps
            .from_mirrors
            .iter()
            .flat_map(|part| &part.forces)
        {
            self.sums.contact.add_plane_force(force);
        }
    }

    fn run_reactions(&mut self, dt: f64) {
        let friction = self.contact.has_friction();
        let view = view(&self.search, &self.store, &self.contact, dt);
        self.contact_phase
            .tasks
            .par_iter_mut()
            .zip(self.search.foreign.chunks())
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|(task, chunk)| {
                if friction {
                    task.react::<true>(&view, chunk);
                } else {
                    task.react::<false>(&view, chunk);
                }
            });
    }

    /// What contact does to each particle, and the sums of it. Each thread takes every so manieth
    /// task, since those that have contact stand together.
    fn store_reactions(&mut self) {
        let (store, sums) = (&mut self.store, &mut self.sums);
        fill(&mut store.contact_acceleration, [0.0; 3]);
        fill(&mut store.contact_energy, 0.0);
        fill(&mut store.contact_stiffness, 0.0);
        let books = Books {
            acceleration: Scatter::new(&mut store.contact_acceleration),
            energy: Scatter::new(&mut store.contact_energy),
            stiffness: Scatter::new(&mut store.contact_stiffness),
            heating: Scatter::new(&mut store.d_specific_energy_dt),
            approach: Scatter::new(&mut store.approach_speed),
            work: Scatter::new(&mut store.work),
            id: &store.id,
            bodies: self.case.bodies.len(),
            mass: &store.mass,
            enclosed_time: &store.enclosed_time,
            foreign_fraction: &store.foreign_fraction,
            excess: &store.contact_excess,
            enclosed_limit: sums.enclosed_limit,
            safety: self.case.time_step.contact,
            friction: self.contact.has_friction(),
        };
        let (tasks, threads) = (&self.contact_phase.tasks, sums.parts.len());
        let parts = sums.parts.par_iter_mut().enumerate();
        parts.with_max_len(1).for_each(|(thread, part)| {
            part.clear();
            for task in tasks.iter().skip(thread).step_by(threads) {
                books.book(task, part);
            }
        });
        for part in &sums.parts {
            sums.contact.merge(part);
        }
    }
}

/// Where foreign fractions go.
struct Fractions<'a> {
    fraction: Scatter<'a, f64>,
    excess: Scatter<'a, f64>,
    modulus: Scatter<'a, f64>,
    touching: Scatter<'a, f64>,
    slope: Scatter<'a, f64>,
    enclosed: Scatter<'a, f64>,
}

impl Fractions<'_> {
    #[inline]
    fn store(&self, weighed: &Weighed) {
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
struct Books<'a> {
    acceleration: Scatter<'a, [f64; 3]>,
    energy: Scatter<'a, f64>,
    stiffness: Scatter<'a, f64>,
    heating: Scatter<'a, f64>,
    approach: Scatter<'a, f64>,
    work: Scatter<'a, u32>,
    id: &'a [u64],
    /// How many there are.
    bodies: usize,
    mass: &'a [f64],
    enclosed_time: &'a [f64],
    foreign_fraction: &'a [f64],
    excess: &'a [f64],
    enclosed_limit: f64,
    /// Safety factor of the contact step.
    safety: f64,
    friction: bool,
}

impl Books<'_> {
    #[inline]
    fn book(&self, task: &Task, sums: &mut ContactSums) {
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

/// Sets all elements, on all threads.
fn fill<T: Copy + Send + Sync>(values: &mut [T], value: T) {
    values
        .par_chunks_mut(16 * GRAIN)
        .for_each(|chunk| chunk.fill(value));
}

impl Task {
    /// Receivers of both lists stand in the same order.
    fn find_boundaries(&mut self, view: &ContactView, foreign: &ForeignChunk, own: &Chunk) {
        self.boundary.clear();
        let mut wanted = foreign.penalty.iter().map(|(place, _)| place).peekable();
        for (cluster, neighbours, _) in own.iter() {
            for &place in &cluster.receivers[..cluster.lanes] {
                if wanted.next_if_eq(&place).is_some() {
                    let normal = penalty::boundary(view, place, neighbours);
                    self.boundary
                        .push((view.images[place as usize].base(), normal));
                }
            }
        }
    }

    /// Friction and damping of one chunk's receivers, which stand in the same order in all lists.
    fn hold(&mut self, view: &ContactView, foreign: &ForeignChunk, own: &Chunk) {
        self.holds.clear();
        let mut overlap = foreign.overlap.iter().peekable();
        let mut penalty = foreign.penalty.iter().peekable();
        for (cluster, _, _) in own.iter() {
            for &place in &cluster.receivers[..cluster.lanes] {
                let mine = overlap.next_if(|(at, _)| *at == place);
                let theirs = penalty.next_if(|(at, _)| *at == place);
                if mine.is_none() && theirs.is_none() {
                    continue;
                }
                let [mine, theirs] = [mine, theirs].map(|list| list.map_or(&[][..], |(_, n)| n));
                let hold = hold::hold(view, place, mine, theirs);
                self.holds.push((view.images[place as usize].base(), hold));
            }
        }
    }

    /// Reactions of one chunk's receivers, mode after mode.
    fn react<const FRICTION: bool>(&mut self, view: &ContactView, chunk: &ForeignChunk) {
        self.reactions.clear();
        self.by_body.clear();
        for (place, neighbours) in chunk.overlap.iter() {
            self.reaction.clear();
            overlap::react::<FRICTION>(view, place, neighbours, &mut self.reaction);
            self.keep(view, place, neighbours.len());
        }
        for (place, neighbours) in chunk.potential.iter() {
            self.reaction.clear();
            potential::react(view, place, neighbours, &mut self.reaction);
            self.keep(view, place, neighbours.len());
        }
        for (place, neighbours) in chunk.penalty.iter() {
            self.reaction.clear();
            penalty::react::<FRICTION>(view, place, neighbours, &mut self.reaction);
            self.keep(view, place, neighbours.len());
        }
    }

    fn keep(&mut self, view: &ContactView, place: u32, neighbours: usize) {
        let base = view.images[place as usize].base();
        let body = view.store.body[base] as usize;
        let reaction = &self.reaction;
        self.reactions.push(Booked {
            base,
            force: reaction.force,
            from_mirrors: reaction.from_mirrors,
            energy: reaction.energy,
            stiffness: reaction.stiffness,
            dashpot: reaction.dashpot,
            heat: reaction.heat,
            closest: reaction.closest,
            approach: reaction.approach,
            neighbours,
        });
        self.by_body
            .extend(reaction.by_body.iter().map(|&entry| (base, body, entry)));
    }
}
