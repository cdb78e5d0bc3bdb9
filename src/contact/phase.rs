//! Contact in the step: foreign fractions before the exchange of stresses, forces after it.

use rayon::prelude::*;

use super::connectivity::Connectivity;
use super::hold::{self, Hold};
use super::overlap::{self, Fraction};
use super::sums::{ContactSums, Met};
use super::surfaces::SurfaceForces;
use super::{BodyReaction, ContactTable, ContactView, GRAIN, Reaction, penalty, potential};
use crate::loads::Loads;
use crate::model::Case;
use crate::neighbours::{CHUNKS_AT_ONCE, Chunk, ForeignChunk, Lists};
use crate::particles::{HaloPhase, ParticleStore, Scatter};

/// Results of a task before they go into the store, kept from step to step.
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

/// Contact of a case, with what it keeps from step to step.
pub struct Contact {
    /// Parameters of all pairs of bodies.
    pub table: ContactTable,
    /// The fragments that bodies come apart into.
    pub(crate) connectivity: Connectivity,
    pub(crate) surfaces: SurfaceForces,
    /// What contact adds up: on this rank, then on all.
    pub(crate) sums: ContactSums,
    /// The same by thread, until they are joined.
    parts: Vec<ContactSums>,
    tasks: Vec<Task>,
    bodies: usize,
    /// How long a particle may be enclosed before it counts as interpenetrated (s).
    enclosed_limit: f64,
    /// Safety factor of the contact step.
    safety: f64,
}

impl Contact {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let speed = case.impact_speed();
        let spacings = case.bodies.iter().map(|b| b.lattice.spacing);
        Self {
            table: ContactTable::new(case),
            connectivity: Connectivity::new(case),
            surfaces: SurfaceForces::new(case),
            sums: ContactSums::default(),
            parts: vec![ContactSums::default(); rayon::current_num_threads()],
            tasks: Vec::new(),
            bodies: case.bodies.len(),
            enclosed_limit: if speed > 0.0 {
                2.0 * spacings.fold(0.0, f64::max) / speed
            } else {
                f64::INFINITY
            },
            safety: case.time_step.contact,
        }
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let tasks = self.tasks.iter().map(Task::memory).sum::<usize>();
        let parts = self.parts.iter().map(ContactSums::memory).sum::<usize>();
        self.connectivity.memory()
            + self.surfaces.memory()
            + self.sums.memory()
            + parts
            + size_of::<Task>() * self.tasks.capacity()
            + tasks
    }

    /// What halo particles need before the forces of stress and contact.
    #[must_use]
    pub fn halo_of_forces(&self) -> HaloPhase {
        if self.table.has_pairs() {
            HaloPhase::FORCES
        } else {
            HaloPhase::STRESS
        }
    }

    /// Foreign fraction, excess and their weights of every particle with foreign neighbours, and the
    /// normals of boundary particles, after a step `dt` (s).
    pub fn measure(&mut self, particles: &mut ParticleStore, lists: &Lists, dt: f64) {
        if !self.table.is_active() {
            return;
        }
        self.weigh(particles, lists, dt);
        self.find_boundaries(particles, lists);
        // What else there is of a fraction nobody reads without excess.
        for field in [
            &mut particles.foreign_fraction,
            &mut particles.contact_excess,
            &mut particles.enclosed_time,
        ] {
            fill(field, 0.0);
        }
        fill(&mut particles.contact_normal, [0.0; 3]);
        for &(i, normal) in self.tasks.iter().flat_map(|task| &task.normals) {
            particles.contact_normal[i] = normal;
        }
        let target = Fractions {
            fraction: Scatter::new(&mut particles.foreign_fraction),
            excess: Scatter::new(&mut particles.contact_excess),
            modulus: Scatter::new(&mut particles.contact_modulus),
            touching: Scatter::new(&mut particles.touching_value),
            slope: Scatter::new(&mut particles.contact_slope),
            enclosed: Scatter::new(&mut particles.enclosed_time),
        };
        let tasks = self.tasks.par_iter().with_max_len(CHUNKS_AT_ONCE);
        tasks.for_each(|task| {
            task.fractions
                .iter()
                .for_each(|weighed| target.store(weighed));
        });
    }

    /// Foreign fractions after a step of `dt` (s).
    fn weigh(&mut self, particles: &ParticleStore, lists: &Lists, dt: f64) {
        let friction = self.table.has_friction();
        let chunks = lists.foreign();
        self.tasks.resize_with(chunks.len(), Task::default);
        let view = ContactView::new(particles, lists, &self.table, 0.0);
        self.tasks
            .par_iter_mut()
            .zip(chunks)
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|(task, chunk)| task.weigh(&view, chunk, friction, dt));
    }

    /// Normals of the boundary particles that `penalty` contact may press on.
    fn find_boundaries(&mut self, particles: &mut ParticleStore, lists: &Lists) {
        if !self.table.has_penalty() {
            return;
        }
        let view = ContactView::new(particles, lists, &self.table, 0.0);
        self.tasks
            .par_iter_mut()
            .zip(lists.foreign())
            .zip(lists.chunks())
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|((task, foreign), own)| task.find_boundaries(&view, foreign, own));
        fill(&mut particles.boundary_normal, [0.0; 3]);
        for (i, normal) in self.tasks.iter().flat_map(|t| &t.boundary) {
            particles.boundary_normal[*i] = *normal;
        }
    }

    /// Friction and damping after a step of `dt` (s), of every particle in contact: halo particles must
    /// hear before the forces.
    pub fn hold(&mut self, particles: &mut ParticleStore, lists: &Lists, dt: f64) {
        let view = ContactView::new(particles, lists, &self.table, dt);
        self.tasks
            .par_iter_mut()
            .zip(lists.foreign())
            .zip(lists.chunks())
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|((task, foreign), own)| task.hold(&view, foreign, own));
        for field in [
            &mut particles.slip,
            &mut particles.slip_rate,
            &mut particles.friction_force,
        ] {
            fill(field, [0.0; 3]);
        }
        fill(&mut particles.sliding, 0);
        for field in [
            &mut particles.friction_load,
            &mut particles.friction_power,
            &mut particles.friction_energy,
        ] {
            fill(field, 0.0);
        }
        for &(i, Hold { load, grip }) in self.tasks.iter().flat_map(|t| &t.holds) {
            particles.slip[i] = grip.memory.slip;
            particles.slip_rate[i] = grip.memory.rate;
            particles.sliding[i] = u32::from(grip.memory.sliding);
            particles.friction_force[i] = grip.force;
            particles.friction_load[i] = load;
            particles.friction_power[i] = grip.power;
            particles.friction_energy[i] = grip.energy;
        }
    }

    /// Gives every particle the relief that makes it start free of force; returns how many had
    /// to be capped on this rank. For the start of a case, before the first forces.
    pub fn set_touch_relief(&mut self, particles: &mut ParticleStore, lists: &Lists) -> i64 {
        if !self.table.is_active() {
            return 0;
        }
        self.weigh(particles, lists, 0.0);
        let mut capped = 0;
        for weighed in self.tasks.iter().flat_map(|t| &t.fractions) {
            let (relief, was_capped) = overlap::relief(&weighed.fraction);
            particles.touch_relief[weighed.base] = relief;
            capped += i64::from(was_capped);
        }
        capped
    }

    /// Contact forces after a step `dt` (s), the energy of contact, and what the time step must know
    /// of both; into [`Self::sums`] go those of this rank.
    pub fn forces(&mut self, particles: &mut ParticleStore, lists: &Lists, loads: &Loads, dt: f64) {
        self.sums.clear();
        if !self.table.is_active() {
            return;
        }
        self.react(particles, lists, dt);
        self.book(particles);
        let (table, energy) = (&self.table, &mut self.sums.energy);
        self.surfaces.act(particles, table, loads, dt, energy);
    }

    fn react(&mut self, particles: &ParticleStore, lists: &Lists, dt: f64) {
        let friction = self.table.has_friction();
        let view = ContactView::new(particles, lists, &self.table, dt);
        self.tasks
            .par_iter_mut()
            .zip(lists.foreign())
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
    fn book(&mut self, particles: &mut ParticleStore) {
        fill(&mut particles.contact_acceleration, [0.0; 3]);
        fill(&mut particles.contact_energy, 0.0);
        fill(&mut particles.contact_stiffness, 0.0);
        let books = Books {
            acceleration: Scatter::new(&mut particles.contact_acceleration),
            energy: Scatter::new(&mut particles.contact_energy),
            stiffness: Scatter::new(&mut particles.contact_stiffness),
            heating: Scatter::new(&mut particles.d_specific_energy_dt),
            approach: Scatter::new(&mut particles.approach_speed),
            work: Scatter::new(&mut particles.work),
            id: &particles.id,
            bodies: self.bodies,
            mass: &particles.mass,
            enclosed_time: &particles.enclosed_time,
            foreign_fraction: &particles.foreign_fraction,
            excess: &particles.contact_excess,
            enclosed_limit: self.enclosed_limit,
            safety: self.safety,
            friction: self.table.has_friction(),
        };
        let (tasks, threads) = (&self.tasks, self.parts.len());
        let parts = self.parts.par_iter_mut().enumerate();
        parts.with_max_len(1).for_each(|(thread, part)| {
            part.clear();
            for task in tasks.iter().skip(thread).step_by(threads) {
                books.book(task, part);
            }
        });
        for part in &self.parts {
            self.sums.merge(part);
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
    fn memory(&self) -> usize {
        size_of::<Weighed>() * self.fractions.capacity()
            + size_of::<(usize, [f64; 3])>() * self.normals.capacity()
            + size_of::<(usize, Hold)>() * self.holds.capacity()
            + size_of::<(usize, [f64; 3])>() * self.boundary.capacity()
            + size_of::<Booked>() * self.reactions.capacity()
            + size_of::<(usize, usize, BodyReaction)>() * self.by_body.capacity()
            + size_of::<BodyReaction>() * self.reaction.by_body.capacity()
    }

    /// Foreign fractions of one chunk's receivers after a step of `dt` (s).
    fn weigh(&mut self, view: &ContactView, chunk: &ForeignChunk, friction: bool, dt: f64) {
        self.fractions.clear();
        self.normals.clear();
        for (place, neighbours) in chunk.overlap.iter() {
            let base = view.images[place as usize].base();
            let relief = view.store.touch_relief[base];
            let fraction = overlap::fraction(view, place, neighbours, relief);
            let mut enclosed = 0.0;
            if fraction.current > ENCLOSED_FRACTION {
                enclosed = view.store.enclosed_time[base] + dt;
            }
            if friction {
                let normal = overlap::normal(view, place, neighbours, &fraction);
                self.normals.push((base, normal));
            }
            self.fractions.push(Weighed {
                base,
                fraction,
                enclosed,
            });
        }
    }

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
