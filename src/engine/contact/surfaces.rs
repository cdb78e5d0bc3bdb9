//! Rigid surfaces in the step: a penalty on particles nearer than half a spacing, see
//! [`escape`], and what rests on it.

use rayon::prelude::*;

mod escape;
mod friction;

use friction::SurfaceFriction;

use super::force::ContactStress;
use super::friction::Law;
use super::gas::{Gas, stiffening};
use super::{ContactSums, ContactTable};
use crate::loads::{Loads, Placed, SurfaceStep};
use model::{Body, Case, RigidSurface};
use numerics::exact_sum::ExactSum;
use numerics::gathered_sums::{self, GatheredSums};
use numerics::vector::{cross, dot};
use particles::neighbours::SizeClasses;
use particles::{GRAIN, ParticleStore, Scatter};

/// Push of a surface on one particle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Push {
    particle: usize,
    pub surface: usize,
    /// Force (N) and its torque about the axis that the surface turns about (N m).
    pub force: [f64; 3],
    pub torque: f64,
    pub energy: f64,
    pub stiffness: f64,
    approach: f64,
    /// Unit normal of the surface there, and the distance from it (m).
    normal: [f64; 3],
    gap: f64,
    /// Velocity of the surface there (m/s).
    pub ground: [f64; 3],
    /// Heat by friction and damping (W).
    pub heat: f64,
    /// Heat that a gas gives as it stiffens, negative (W).
    exchanged: f64,
}

/// Constants of a surface and a size class of particles that it acts on.
#[derive(Debug, Clone, Copy)]
struct Penalty {
    /// Stiffness over volume, `κ M/Δp²` (Pa/m²).
    stiffness: f64,
    /// Distance at which it begins, ½Δp (m).
    reach: f64,
    h: f64,
    /// Over volume: the spring that sticks (Pa/m²), `2 ζ √(κ M ρ₀)/Δp` (Pa s/m²).
    friction: Law,
}

/// The surfaces of a case and what they do, kept from step to step.
#[derive(Debug, Default)]
pub(crate) struct SurfaceForces {
    /// By surface and size class of particles; absent where a surface does not act.
    penalties: Vec<Vec<Option<Penalty>>>,
    /// By size class: stiffness over volume of the spring that sticks (Pa/m²).
    sticks: Vec<f64>,
    surfaces: Vec<RigidSurface>,
    /// Force of each surface, and its torque about the axis that it turns about.
    pub(crate) sums: Vec<[ExactSum; 4]>,
    /// Heat of each, if any has friction or damping or a body is of gas.
    pub(crate) heat: Vec<ExactSum>,
    has_friction: bool,
    /// By task.
    pushes: Vec<Vec<Push>>,
    /// The same of friction and damping; empty without.
    friction: Vec<Vec<SurfaceFriction>>,
}

impl SurfaceForces {
    pub(super) fn new(case: &Case) -> Self {
        let has_gas = (case.bodies.iter()).any(|body| Gas::of(case, body).is_some());
        let size_classes = SizeClasses::new(case);
        let bodies: Vec<Body> = (0..size_classes.count())
            .map(|size_class| size_classes.body_of_size(case, size_class))
            .collect();
        let penalties = case.loads.surfaces.iter().map(|surface| {
            let penalty = bodies.iter().enumerate().map(|(size_class, body)| {
                let acts = surface.bodies[size_classes.body(size_class)];
                acts.then(|| Penalty::new(case, body, surface))
            });
            penalty.collect()
        });
        let sticks = bodies.iter().map(|body| stick(case, body));
        Self {
            penalties: penalties.collect(),
            sticks: sticks.collect(),
            surfaces: case.loads.surfaces.clone(),
            sums: case
                .loads
                .surfaces
                .iter()
                .map(|_| Default::default())
                .collect(),
            heat: if case.loads.has_friction() || has_gas {
                vec![ExactSum::default(); case.loads.surfaces.len()]
            } else {
                Vec::new()
            },
            has_friction: case.loads.has_friction(),
            pushes: Vec::new(),
            friction: Vec::new(),
        }
    }

    pub(super) fn memory(&self) -> usize {
        let penalties = self.penalties.iter().map(Vec::capacity).sum::<usize>();
        let pushes = self.pushes.iter().map(Vec::capacity).sum::<usize>();
        let friction = self.friction.iter().map(Vec::capacity).sum::<usize>();
        penalties * size_of::<Option<Penalty>>()
            + pushes * size_of::<Push>()
            + friction * size_of::<SurfaceFriction>()
            + size_of::<f64>() * self.sticks.capacity()
            + 4 * size_of::<ExactSum>() * self.sums.capacity()
            + size_of::<ExactSum>() * self.heat.capacity()
    }
}

/// Stiffness over volume of the spring that sticks, `¼ M/Δp²` (Pa/m²).
fn stick(case: &Case, body: &Body) -> f64 {
    let spacing = body.lattice.spacing;
    0.25 * case.contact_modulus(body) / (spacing * spacing)
}

impl Penalty {
    fn new(case: &Case, body: &Body, surface: &RigidSurface) -> Self {
        let spacing = body.lattice.spacing;
        let modulus = surface.stiffness * case.contact_modulus(body);
        let input = &surface.resistance;
        let critical = 2.0 * (modulus * case.initial_density(body)).sqrt() / spacing;
        Self {
            stiffness: modulus / (spacing * spacing),
            reach: 0.5 * spacing,
            h: body.smoothing_length,
            friction: Law {
                static_friction: input.static_friction,
                kinetic_friction: input.kinetic_friction,
                stiffness: stick(case, body),
                dashpot: input.damping * critical,
            },
        }
    }

    /// Distance within which particles are looked for: where they feel the surface or approach it,
    /// and as far behind it as no penalty lets them come.
    fn limit(&self) -> f64 {
        2.0 * self.h.max(self.reach)
    }

    /// The approach speed of a particle at a separation (m) that changes at `rate` (m/s): that
    /// towards its mirror image, see `Separation::raise_approach`.
    fn approach(&self, separation: f64, rate: f64) -> f64 {
        let soft = 4.0 * (separation * separation) + 0.01 * (self.h * self.h);
        (-4.0 * self.h * rate * separation.abs() / soft).max(0.0)
    }
}

impl SurfaceForces {
    /// Adds what the rigid surfaces do after a step `dt` (s) to the forces of contact, and their
    /// energy and torque to the sums `of_contact`.
    pub(super) fn act(
        &mut self,
        particles: &mut ParticleStore,
        table: &ContactTable,
        loads: &Loads,
        dt: f64,
        of_contact: &mut ContactSums,
    ) {
        self.sums.fill_with(Default::default);
        self.heat.fill_with(ExactSum::default);
        if self.surfaces.is_empty() {
            return;
        }
        self.find_pushes(particles, table, loads, dt);
        self.push(particles);
        let [energy, x, y, z] = self.sum(|push| {
            let [x, y, z] = cross(&particles.position[push.particle], &push.force);
            Some([push.energy, x, y, z])
        });
        of_contact.energy.merge(&energy);
        for (sum, torque) in of_contact.outside_torque.iter_mut().zip([x, y, z]) {
            sum.merge(&torque);
        }
        for surface in 0..self.sums.len() {
            let [x, y, z, torque, heat] = self.sum(|push| {
                let [x, y, z] = push.force;
                let heat = push.heat + push.exchanged;
                (push.surface == surface).then_some([x, y, z, push.torque, heat])
            });
            self.sums[surface] = [x, y, z, torque];
            if let Some(sum) = self.heat.get_mut(surface) {
                *sum = heat;
            }
        }
        SurfaceFriction::clear(particles);
        SurfaceFriction::store(&self.friction, particles);
    }

    /// Gives particles what the surfaces do to them.
    fn push(&self, particles: &mut ParticleStore) {
        let mass = &particles.mass;
        let [energy, stiffness, approach] = [
            &mut particles.contact_energy,
            &mut particles.contact_stiffness,
            &mut particles.approach_speed,
        ]
        .map(|field| Scatter::new(field));
        let acceleration = Scatter::new(&mut particles.contact_acceleration);
        let heating = Scatter::new(&mut particles.d_specific_energy_dt);
        let all = self.pushes.par_iter().flat_map_iter(|chunk| chunk);
        all.for_each(|push| {
            let i = push.particle;
            let per_mass = 1.0 / mass[i];
            // SAFETY: all pushes of a particle are in one chunk, which one thread has.
            unsafe {
                for (a, force) in acceleration.slot(i).iter_mut().zip(push.force) {
                    *a += force * per_mass;
                }
                *energy.slot(i) += push.energy;
                *heating.slot(i) += push.exchanged * per_mass;
                *stiffness.slot(i) += push.stiffness;
                *approach.slot(i) = approach.slot(i).max(push.approach);
            }
        });
    }

    /// Exact sums of the terms of those pushes that have any.
    fn sum<const N: usize>(
        &self,
        terms: impl Fn(&Push) -> Option<[f64; N]> + Sync,
    ) -> [ExactSum; N] {
        let of_chunk = |mut sums: GatheredSums<N>, chunk: &Vec<Push>| {
            let all = chunk.iter().filter_map(&terms);
            all.for_each(|terms| sums.add(&terms));
            sums
        };
        self.pushes
            .par_iter()
            // same bits in any order: exact sums are integers
            .fold(GatheredSums::default, of_chunk)
            .map(GatheredSums::into_sums)
            // same bits in any order, as above
            .reduce(gathered_sums::none, gathered_sums::merged)
    }

    /// Stress that the forces of the last step carry through particles, with their indices: the
    /// material between a particle and a surface is all its own.
    pub(super) fn carried(&self) -> impl Iterator<Item = (usize, ContactStress)> {
        self.pushes.iter().flatten().map(|push| {
            let press = dot(&push.force, &push.normal);
            let mut carried = ContactStress::default();
            carried.add(
                &push.force,
                &push.normal.map(|n| press * n),
                &push.normal.map(|n| push.gap * n),
            );
            (push.particle, carried)
        })
    }

    /// The particles near surfaces, chunk after chunk.
    fn find_pushes(
        &mut self,
        particles: &ParticleStore,
        table: &ContactTable,
        loads: &Loads,
        dt: f64,
    ) {
        let owned = particles.owned();
        let chunks = owned.div_ceil(GRAIN);
        self.pushes.resize(chunks, Vec::new());
        self.friction.resize(chunks, Vec::new());
        let view = View {
            particles,
            table,
            surfaces: &self.surfaces,
            steps: &loads.surfaces,
            penalties: &self.penalties,
            sticks: &self.sticks,
        };
        let has_friction = self.has_friction;
        let chunks = self.pushes.par_iter_mut().zip(&mut self.friction);
        chunks.enumerate().for_each(|(chunk, (pushes, friction))| {
            pushes.clear();
            friction.clear();
            for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(owned) {
                let first = pushes.len();
                pushes.extend((0..view.surfaces.len()).filter_map(|n| view.push(i, n)));
                if has_friction {
                    friction.extend(view.friction(i, &mut pushes[first..], dt));
                }
            }
        });
    }
}

/// Inputs of a push.
struct View<'a> {
    pub particles: &'a ParticleStore,
    pub table: &'a ContactTable,
    surfaces: &'a [RigidSurface],
    steps: &'a [SurfaceStep],
    penalties: &'a [Vec<Option<Penalty>>],
    pub sticks: &'a [f64],
}

impl View<'_> {
    /// Surface `n` as it stands.
    pub(super) fn placed(&self, n: usize) -> Placed<'_> {
        Placed {
            surface: &self.surfaces[n],
            step: &self.steps[n],
        }
    }

    /// The size class of a particle, and its reference volume (m^d).
    pub(super) fn size_class(&self, i: usize) -> (usize, f64) {
        let (body, mass) = (self.particles.body[i] as usize, self.particles.mass[i]);
        let volume = mass * self.table.inverse_density(body);
        (self.table.size_class(body, mass), volume)
    }

    /// Push of surface `n` on particle `i`, if that is near it.
    fn push(&self, i: usize, n: usize) -> Option<Push> {
        let (size_class, volume) = self.size_class(i);
        let penalty = self.penalties[n][size_class].as_ref()?;
        let placed = self.placed(n);
        let x = &self.particles.position[i];
        let local = placed.local(x);
        let escape = escape::escape(placed.surface, &local, penalty.reach, penalty.limit())?;
        let separation = escape.foot.gap;
        // Stress points have no mass and no contact.
        if separation >= penalty.h.max(penalty.reach) || self.particles.mass[i] == 0.0 {
            return None;
        }
        let stiffness = penalty.stiffness * stiffening(self.particles, i) * volume;
        let force = placed.outward(escape.way.map(|u| stiffness * u));
        let energy = 0.5 * stiffness * escape.depth2;
        let (v, surface_v) = (&self.particles.predicted_velocity[i], placed.velocity(x));
        let normal = placed.outward(escape.foot.normal);
        let rate = dot(
            &normal,
            &[
                v[0] - surface_v[0],
                v[1] - surface_v[1],
                v[2] - surface_v[2],
            ],
        );
        Some(Push {
            particle: i,
            surface: n,
            torque: placed.torque(x, &force),
            force,
            energy,
            stiffness: stiffness * escape.walls,
            approach: penalty.approach(separation, rate),
            normal,
            gap: separation,
            ground: surface_v,
            heat: 0.0,
            exchanged: -self.table.stiffening_rate(self.particles, i) * energy,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At its own mirror image, twice the speed at twice the distance.
    #[test]
    fn a_surface_is_approached_like_a_mirror() {
        let penalty = Penalty {
            stiffness: 3e11,
            reach: 0.5e-3,
            h: 1.3e-3,
            friction: Law::default(),
        };
        let approach = penalty.approach(0.5e-3, -10.0);
        let expected = 1.3e-3 * 20.0 * 1e-3 / (1e-6 + 0.01 * 1.69e-6);
        assert!((approach / expected - 1.0).abs() < 1e-14);
    }
}
