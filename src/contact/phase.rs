//! Contact in the step: foreign fractions before the exchange of stresses, forces after it.

use rayon::prelude::*;

use super::books::{Books, Fractions};
use super::connectivity::Connectivity;
use super::hold::Hold;
use super::sums::ContactSums;
use super::surfaces::SurfaceForces;
use super::task::Task;
use super::{ContactTable, ContactView, overlap};
use crate::loads::Loads;
use crate::model::Case;
use crate::neighbours::{CHUNKS_AT_ONCE, Lists};
use crate::particles::{GRAIN, HaloPhase, ParticleStore, Scatter};

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
    /// of both. Sums are those of this rank.
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

/// Sets all elements, on all threads.
fn fill<T: Copy + Send + Sync>(values: &mut [T], value: T) {
    values
        .par_chunks_mut(16 * GRAIN)
        .for_each(|chunk| chunk.fill(value));
}
