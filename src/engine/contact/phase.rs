//! Contact in the step: measurements before the exchange of stresses, forces after it.

use rayon::prelude::*;

use super::ContactTable;
use super::accumulators::Accumulators;
use super::connectivity::Connectivity;
use super::gas;
use super::joint;
use super::mode::{Measurements, Scene, fill};
use super::sums::ContactSums;
use super::surfaces::SurfaceForces;
use super::task::Task;
use super::view::ContactView;
use crate::loads::Loads;
use model::Case;
use particles::neighbours::{CHUNKS_AT_ONCE, Chunk, ForeignChunk, Lists};
use particles::{HaloPhase, ParticleStore, Scatter};

/// Contact of a case, with what it keeps from step to step.
pub struct Contact {
    /// Parameters of all pairs of bodies.
    pub table: ContactTable,
    /// The fragments that bodies come apart into.
    pub(crate) connectivity: Connectivity,
    pub(crate) surfaces: SurfaceForces,
    /// Sums of contact: on this rank, then on all.
    pub(crate) sums: ContactSums,
    /// The same by thread, until they are joined.
    parts: Vec<ContactSums>,
    measurements: Measurements,
    joints: Vec<Vec<joint::Measured>>,
    tasks: Vec<Task>,
    bodies: usize,
    /// Time that a particle may be enclosed before it counts as interpenetrated (s).
    enclosed_limit: f64,
    /// Safety factor of the contact step.
    safety: f64,
}

impl Contact {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let speed = case.impact_speed();
        let spacings = case.bodies.iter().map(|b| b.lattice.coarsest());
        Self {
            table: ContactTable::new(case),
            connectivity: Connectivity::new(case),
            surfaces: SurfaceForces::new(case),
            sums: ContactSums::default(),
            parts: vec![ContactSums::default(); rayon::current_num_threads()],
            measurements: Measurements::default(),
            joints: Vec::new(),
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
            + self.measurements.memory()
            + self
                .joints
                .iter()
                .map(|found| size_of_val(&found[..]))
                .sum::<usize>()
            + parts
            + size_of::<Task>() * self.tasks.capacity()
            + tasks
    }

    /// Fields that halo particles need before the forces of contact, at once with those of stress.
    #[must_use]
    pub fn halo_of_forces(&self) -> HaloPhase {
        self.table.halo
    }

    /// Measures particles with foreign neighbours for the forces, after a step `dt` (s).
    pub fn measure(&mut self, particles: &mut ParticleStore, lists: &Lists, dt: f64) {
        if self.table.is_active() {
            if self.table.has_gas() {
                gas::stiffen(&self.table.gases, particles);
            }
            let scene = &mut Scene {
                particles,
                lists,
                table: &self.table,
                dt,
            };
            self.measurements.measure(scene);
            joint::measure(&mut self.joints, scene);
        }
    }

    /// Lets the start of a case be free of force; returns of how many particles of this rank not
    /// all could be forgiven. Before the first forces.
    pub fn begin(&mut self, particles: &mut ParticleStore, lists: &Lists) -> i64 {
        if !self.table.is_active() {
            return 0;
        }
        self.measurements.begin(&mut Scene {
            particles,
            lists,
            table: &self.table,
            dt: 0.0,
        })
    }

    /// Friction and damping after a step of `dt` (s), of every particle in contact: halo particles
    /// must hear before the forces.
    pub fn resist(&mut self, particles: &mut ParticleStore, lists: &Lists, dt: f64) {
        self.for_each_task(particles, lists, dt, |task, view, foreign, own| {
            task.resist(view, foreign, own);
        });
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
        let vectors = [
            &mut particles.slip,
            &mut particles.slip_rate,
            &mut particles.friction_force,
        ]
        .map(|field| Scatter::new(field));
        let numbers = [
            &mut particles.friction_load,
            &mut particles.friction_power,
            &mut particles.friction_energy,
        ]
        .map(|field| Scatter::new(field));
        let sliding = Scatter::new(&mut particles.sliding);
        let tasks = self.tasks.par_iter().with_max_len(CHUNKS_AT_ONCE);
        let all = tasks.flat_map_iter(|task| &task.friction);
        all.for_each(|&(i, load, friction)| {
            let slip = friction.slip;
            // SAFETY: a particle is receiver in one task.
            unsafe {
                let values = [slip.displacement, slip.rate, friction.force];
                for (field, value) in vectors.iter().zip(values) {
                    *field.slot(i) = value;
                }
                let values = [load, friction.power, friction.energy];
                for (field, value) in numbers.iter().zip(values) {
                    *field.slot(i) = value;
                }
                *sliding.slot(i) = u32::from(slip.sliding);
            }
        });
    }

    /// Contact forces after a step `dt` (s), the energy of contact, and what the time step must
    /// know of both. Sums are those of this rank.
    pub fn forces(&mut self, particles: &mut ParticleStore, lists: &Lists, loads: &Loads, dt: f64) {
        self.sums.clear();
        loads.add_weight(particles, &mut self.sums.outside_torque);
        if !self.table.is_active() {
            return;
        }
        let (friction, joints) = (self.table.has_friction(), self.table.has_joints());
        self.for_each_task(particles, lists, dt, |task, view, foreign, _| {
            if friction {
                task.add_forces::<true>(view, foreign);
            } else {
                task.add_forces::<false>(view, foreign);
            }
            if joints {
                task.add_joints(view, foreign);
            }
        });
        self.book(particles);
        let (table, sums) = (&self.table, &mut self.sums);
        self.surfaces.act(particles, table, loads, dt, sums);
    }

    /// Calls `work` for each task with its foreign pairs and the lists of the own body.
    fn for_each_task(
        &mut self,
        particles: &ParticleStore,
        lists: &Lists,
        dt: f64,
        work: impl Fn(&mut Task, &ContactView, &ForeignChunk, &Chunk) + Sync,
    ) {
        let chunks = lists.foreign();
        self.tasks.resize_with(chunks.len(), Task::default);
        let view = ContactView::new(particles, lists, &self.table, dt);
        self.tasks
            .par_iter_mut()
            .zip(chunks)
            .zip(lists.chunks())
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|((task, foreign), own)| work(task, &view, foreign, own));
    }

    /// Adds contact to each particle, and the sums of it. Each thread takes every so manieth
    /// task, since those that have contact are adjacent.
    fn book(&mut self, particles: &mut ParticleStore) {
        fill(&mut particles.contact_acceleration, [0.0; 3]);
        fill(&mut particles.contact_energy, 0.0);
        fill(&mut particles.contact_stiffness, 0.0);
        let accumulators = Accumulators {
            acceleration: Scatter::new(&mut particles.contact_acceleration),
            viscous: Scatter::new(&mut particles.acceleration),
            energy: Scatter::new(&mut particles.contact_energy),
            stiffness: Scatter::new(&mut particles.contact_stiffness),
            heating: Scatter::new(&mut particles.d_specific_energy_dt),
            approach: Scatter::new(&mut particles.approach_speed),
            work: Scatter::new(&mut particles.work),
            id: &particles.id,
            bodies: self.bodies,
            mass: &particles.mass,
            position: &particles.position,
            enclosed_time: &particles.enclosed_time,
            foreign_fraction: &particles.foreign_fraction,
            excess: &particles.contact_excess,
            enclosed_limit: self.enclosed_limit,
            safety: self.safety,
        };
        let (tasks, threads) = (&self.tasks, self.parts.len());
        let parts = self.parts.par_iter_mut().enumerate();
        parts.with_max_len(1).for_each(|(thread, part)| {
            part.clear();
            for task in tasks.iter().skip(thread).step_by(threads) {
                accumulators.book(&task.forces, part);
            }
        });
        for part in &self.parts {
            self.sums.merge(part);
        }
    }
}
