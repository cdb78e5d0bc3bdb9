//! Friction and damping on rigid surfaces: one law for each particle, which rests on all that it
//! touches (theory page "Loads").

use rayon::prelude::*;

use super::{Push, View};
use crate::contact::friction::{Law, Slip};
use crate::contact::mode::fill;
use numerics::vector::norm;
use particles::{ParticleStore, Scatter};

/// Friction and damping of one particle, beside their part of its [`Push`]es.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceFriction {
    particle: usize,
    slip: Slip,
    /// Heat (W) of the particle.
    power: f64,
    /// Sum of dashpots (N s/m), for the time step.
    dashpot: f64,
}

fn slip(particles: &ParticleStore, i: usize) -> Slip {
    Slip {
        displacement: particles.surface_slip[i],
        rate: particles.surface_slip_rate[i],
        sliding: particles.surface_sliding[i] != 0,
    }
}

/// Load of friction of a particle: sums over the surfaces that it touches.
#[derive(Default)]
struct Rest {
    load: f64,
    resultant: [f64; 3],
    /// Velocity of the surfaces, weighted with the load.
    ground: [f64; 3],
    /// The same of their coefficients, over volume.
    law: Law,
    /// Direction of the first.
    first: Option<[f64; 3]>,
}

impl Rest {
    /// Adds a surface that presses with `press` (N).
    fn add(&mut self, push: &Push, law: &Law, press: f64) {
        self.first = self.first.or(Some(push.force.map(|f| f / press)));
        self.load += press;
        self.law.add(press, law);
        for a in 0..3 {
            self.resultant[a] += push.force[a];
            self.ground[a] += press * push.ground[a];
        }
    }

    /// The direction of the resultant, or of the first if they cancel; none without surfaces.
    fn normal(&self) -> Option<[f64; 3]> {
        let size = norm(&self.resultant);
        if size > 0.0 {
            Some(self.resultant.map(|f| f / size))
        } else {
            self.first
        }
    }
}

impl View<'_> {
    /// Adds friction and damping of particle `i` after a step `dt` (s) to what surfaces do to it.
    ///
    /// The law is given the sum of the presses along their resultant, and the velocity against what
    /// bears them, each with the share of its press; each bears that share of the law's force.
    pub(super) fn friction(
        &self,
        i: usize,
        pushes: &mut [Push],
        dt: f64,
    ) -> Option<SurfaceFriction> {
        let before = slip(self.particles, i);
        let (size_class, volume) = self.size_class(i);
        let of = |push: &Push| {
            let penalty = self.penalties[push.surface][size_class].as_ref();
            let law = penalty.map(|p| p.friction).filter(Law::is_any)?;
            let press = norm(&push.force);
            (press > 0.0).then_some((law, press))
        };
        let mut rest = Rest::default();
        for push in &*pushes {
            if let Some((law, press)) = of(push) {
                rest.add(push, &law, press);
            }
        }
        let Some(normal) = rest.normal() else {
            return self.release(i, &before, dt);
        };
        let (load, ground) = (rest.load, rest.ground);
        let law = rest.law.over(load).of_volume(volume);
        let v = &self.particles.predicted_velocity[i];
        let velocity = std::array::from_fn(|a| v[a] - ground[a] / load);
        let friction = law.step(&before, &normal.map(|n| n * load), &normal, &velocity, dt);
        for push in pushes {
            let Some((_, press)) = of(push) else { continue };
            let share = press / load;
            push.heat = share * friction.power;
            push.energy += share * friction.energy;
            push.stiffness += share * law.stiffness;
            let force = friction.force.map(|f| share * f);
            push.torque += self
                .placed(push.surface)
                .torque(&self.particles.position[i], &force);
            for a in 0..3 {
                push.force[a] += force[a];
            }
        }
        Some(SurfaceFriction {
            particle: i,
            slip: friction.slip,
            power: friction.power,
            dashpot: law.dashpot,
        })
    }

    /// A particle that touches nothing any more: what its spring held becomes heat.
    fn release(&self, i: usize, before: &Slip, dt: f64) -> Option<SurfaceFriction> {
        if before.displacement == [0.0; 3] {
            return None;
        }
        let (size_class, volume) = self.size_class(i);
        let law = Law {
            stiffness: self.sticks[size_class] * volume,
            ..Law::default()
        };
        let friction = law.step(before, &[0.0; 3], &[0.0; 3], &before.rate, dt);
        Some(SurfaceFriction {
            particle: i,
            slip: Slip::default(),
            power: friction.power,
            dashpot: 0.0,
        })
    }
}

impl SurfaceFriction {
    /// Forgets the slip, before [`Self::store`].
    pub(super) fn clear(particles: &mut ParticleStore) {
        fill(&mut particles.surface_slip, [0.0; 3]);
        fill(&mut particles.surface_slip_rate, [0.0; 3]);
        fill(&mut particles.surface_sliding, 0);
    }

    /// Gives particles their heat, their time step and their slip.
    pub(super) fn store(chunks: &[Vec<Self>], particles: &mut ParticleStore) {
        let mass = &particles.mass;
        let displacement = Scatter::new(&mut particles.surface_slip);
        let slip_rate = Scatter::new(&mut particles.surface_slip_rate);
        let sliding = Scatter::new(&mut particles.surface_sliding);
        let heating = Scatter::new(&mut particles.d_specific_energy_dt);
        let stiffness = Scatter::new(&mut particles.contact_stiffness);
        let all = chunks.par_iter().flat_map_iter(|chunk| chunk);
        all.for_each(|friction| {
            let (i, slip) = (friction.particle, friction.slip);
            let per_mass = 1.0 / mass[i];
            // A step of m/c is stable: as if it were that of a spring, 2 √(m/k).
            let rate = friction.dashpot * per_mass;
            // SAFETY: a particle is in one chunk once, and one thread has that.
            unsafe {
                *displacement.slot(i) = slip.displacement;
                *slip_rate.slot(i) = slip.rate;
                *sliding.slot(i) = u32::from(slip.sliding);
                *heating.slot(i) += friction.power * per_mass;
                *stiffness.slot(i) += 4.0 * mass[i] * (rate * rate);
            }
        });
    }
}
