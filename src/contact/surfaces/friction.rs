//! Friction and damping on rigid surfaces: one law for each particle, which rests on all that it
//! touches (theory page "Loads").

use super::{Push, View};
use crate::contact::friction::{Law, Memory};
use crate::numerics::vector::norm;
use crate::particles::ParticleStore;

/// What friction and damping do to one particle, beside their part of its [`Push`]es.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceHold {
    particle: usize,
    memory: Memory,
    /// Heat (W) of the particle.
    power: f64,
    /// Sum of dashpots (N s/m), for the time step.
    dashpot: f64,
}

/// Constants of friction and damping of a surface on a body.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Resisting {
    pub static_friction: f64,
    pub kinetic_friction: f64,
    /// Stiffness of the spring that sticks over volume, `¼ M/Δp²` (Pa/m²).
    pub stick: f64,
    /// Damping over volume, `2 ζ √(κ M ρ₀)/Δp` (Pa s/m²).
    pub dashpot: f64,
}

impl Resisting {
    fn is_any(&self) -> bool {
        self.static_friction > 0.0 || self.dashpot > 0.0
    }
}

fn memory(store: &ParticleStore, i: usize) -> Memory {
    Memory {
        slip: store.surface_slip[i],
        rate: store.surface_slip_rate[i],
        sliding: store.surface_sliding[i] != 0,
    }
}

impl View<'_> {
    /// Adds friction and damping of particle `i` after a step `dt` (s) to what surfaces do to it.
    ///
    /// The law is given the sum of the presses along their resultant, and the velocity against what
    /// bears them, each with the share of its press; each bears that share of the law's force.
    pub(super) fn hold(&self, i: usize, pushes: &mut [Push], dt: f64) -> Option<SurfaceHold> {
        let store = self.store;
        let before = memory(store, i);
        let body = store.body[i] as usize;
        let of = |push: &Push| {
            let penalty = self.penalties[push.surface][body].as_ref();
            let resisting = penalty.map(|p| p.resisting).filter(Resisting::is_any)?;
            let press = norm(&push.force);
            (press > 0.0).then_some((resisting, press))
        };
        let (mut load, mut resultant, mut ground) = (0.0, [0.0; 3], [0.0; 3]);
        let mut mean = Resisting::default();
        let mut first = None;
        for push in &*pushes {
            let Some((resisting, press)) = of(push) else {
                continue;
            };
            first = first.or(Some(push.force.map(|f| f / press)));
            load += press;
            mean.static_friction += press * resisting.static_friction;
            mean.kinetic_friction += press * resisting.kinetic_friction;
            mean.stick += press * resisting.stick;
            mean.dashpot += press * resisting.dashpot;
            for a in 0..3 {
                resultant[a] += push.force[a];
                ground[a] += press * push.ground[a];
            }
        }
        let Some(first) = first else {
            return self.release(i, &before, dt);
        };
        let size = norm(&resultant);
        let normal = if size > 0.0 {
            resultant.map(|f| f / size)
        } else {
            first
        };
        let volume = store.mass[i] * self.table.inverse_density(body);
        let law = Law {
            static_friction: mean.static_friction / load,
            kinetic_friction: mean.kinetic_friction / load,
            stiffness: mean.stick / load * volume,
            dashpot: mean.dashpot / load * volume,
        };
        let v = &store.predicted_velocity[i];
        let velocity = std::array::from_fn(|a| v[a] - ground[a] / load);
        let grip = law.step(&before, &normal.map(|n| n * load), &normal, &velocity, dt);
        for push in pushes {
            let Some((_, press)) = of(push) else { continue };
            let share = press / load;
            push.heat = share * grip.power;
            push.energy += share * grip.energy;
            push.stiffness += share * law.stiffness;
            let force = grip.force.map(|f| share * f);
            push.torque += self.placed(push.surface).torque(&store.position[i], &force);
            for a in 0..3 {
                push.force[a] += force[a];
            }
        }
        Some(SurfaceHold {
            particle: i,
            memory: grip.memory,
            power: grip.power,
            dashpot: law.dashpot,
        })
    }

    /// A particle that touches nothing any more: what its spring held becomes heat.
    fn release(&self, i: usize, before: &Memory, dt: f64) -> Option<SurfaceHold> {
        if before.slip == [0.0; 3] {
            return None;
        }
        let body = self.store.body[i] as usize;
        let volume = self.store.mass[i] * self.table.inverse_density(body);
        let law = Law {
            stiffness: self.sticks[body] * volume,
            ..Law::default()
        };
        let grip = law.step(before, &[0.0; 3], &[0.0; 3], &before.rate, dt);
        Some(SurfaceHold {
            particle: i,
            memory: Memory::default(),
            power: grip.power,
            dashpot: 0.0,
        })
    }
}

impl SurfaceHold {
    /// Forgets what friction remembered, before [`Self::store`].
    pub(super) fn clear(store: &mut ParticleStore) {
        store.surface_slip.fill([0.0; 3]);
        store.surface_slip_rate.fill([0.0; 3]);
        store.surface_sliding.fill(0);
    }

    /// Gives the particle its heat, its time step and what it remembers.
    pub(super) fn store(&self, store: &mut ParticleStore) {
        let i = self.particle;
        let per_mass = 1.0 / store.mass[i];
        store.surface_slip[i] = self.memory.slip;
        store.surface_slip_rate[i] = self.memory.rate;
        store.surface_sliding[i] = u32::from(self.memory.sliding);
        store.d_specific_energy_dt[i] += self.power * per_mass;
        // A step of m/c is stable: as if it were that of a spring, 2 √(m/k).
        let rate = self.dashpot * per_mass;
        store.contact_stiffness[i] += 4.0 * store.mass[i] * (rate * rate);
    }
}
