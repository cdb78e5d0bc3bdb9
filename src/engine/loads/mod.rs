//! Loads in the step: what they prescribe, and what they put into the model.
//!
//! A prescribed component of a velocity is V(t) at whole steps, and its mean over the step is the
//! velocity in the middle, so that places follow the integral of V. In a half kick a load gives a
//! particle the impulse that forces lack, `J = m (v_to − v_from) − ½Δt m a`, and with it the work
//! `J · ½(v_from + v_to)`, which balances the energy of the half kick to round-off. A rigid body
//! that is driven has no mass of its own here: what holds it gives the reaction of contact, `J = −½Δt m a_c`.

mod absorption;
mod held;
mod pressures;
mod rigid;
mod sums;
mod surface_motion;

pub(crate) use absorption::Absorption;
pub(crate) use pressures::Acting;
use rigid::FreeBodies;
pub use rigid::RigidState;
pub(crate) use sums::sum_over;
pub(crate) use surface_motion::{Placed, SurfaceStep};

use model::{self, Case, Motion};
use numerics::exact_sum::ExactSum;
use numerics::vector::cross;
use particles::ParticleStore;

/// Stage of the two prescribed velocities of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VelocityStage {
    /// That after the first half kick.
    Middle,
    /// That after the second.
    End,
}

/// Prescribed velocity of a particle in one step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Prescribed {
    /// The ledger of who prescribes each component, if anybody does.
    by: [Option<u8>; 3],
    middle: [f64; 3],
    end: [f64; 3],
    rigid: bool,
}

impl Prescribed {
    fn velocity(&self, stage: VelocityStage) -> &[f64; 3] {
        match stage {
            VelocityStage::Middle => &self.middle,
            VelocityStage::End => &self.end,
        }
    }

    /// The motion from time `from` to `to` (s), by the ledger `by`.
    fn new(motion: &Motion, by: usize, rigid: bool, from: f64, to: f64) -> Self {
        Self {
            by: std::array::from_fn(|a| motion.has(a).then(|| u8::try_from(by).unwrap_or(u8::MAX))),
            middle: std::array::from_fn(|a| motion.mean(a, from, to)),
            end: std::array::from_fn(|a| motion.velocity(a, to)),
            rigid,
        }
    }
}

/// Motion of a particle beside forces.
pub(crate) trait Prescribe: Copy + Send {
    /// Replaces what forces do (`total`, m/s²) by what takes the velocity `v` (m/s) to the stage
    /// in a half kick, of which there are `per_half` in a second.
    fn accelerate(&self, stage: VelocityStage, v: &[f64; 3], per_half: f64, total: &mut [f64; 3]);
    /// Sets what is prescribed of a velocity (m/s).
    fn set(&self, stage: VelocityStage, v: &mut [f64; 3]);
    /// Corrects the mean velocity (m/s) in a half kick, as forces make it, of a particle with the
    /// velocity `whole` (m/s) at the whole step that begins or ends it and `middle` between.
    fn correct_mean(&self, whole: &[f64; 3], middle: &[f64; 3], mean: &mut [f64; 3]);
    /// True if the particle is part of a driven rigid body.
    fn is_rigid(&self) -> bool;
    /// Acceleration by pressures on faces (m/s²).
    #[inline(always)]
    fn push(&self) -> [f64; 3] {
        [0.0; 3]
    }
}

/// No load anywhere.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Free;

impl Prescribe for Free {
    #[inline(always)]
    fn accelerate(&self, _: VelocityStage, _: &[f64; 3], _: f64, _: &mut [f64; 3]) {}
    #[inline(always)]
    fn set(&self, _: VelocityStage, _: &mut [f64; 3]) {}
    #[inline(always)]
    fn correct_mean(&self, _: &[f64; 3], _: &[f64; 3], _: &mut [f64; 3]) {}
    #[inline(always)]
    fn is_rigid(&self) -> bool {
        false
    }
}

impl Prescribe for Prescribed {
    #[inline(always)]
    fn accelerate(&self, stage: VelocityStage, v: &[f64; 3], per_half: f64, total: &mut [f64; 3]) {
        for a in 0..3 {
            if self.by[a].is_some() {
                total[a] = (self.velocity(stage)[a] - v[a]) * per_half;
            }
        }
    }

    #[inline(always)]
    fn set(&self, stage: VelocityStage, v: &mut [f64; 3]) {
        for a in 0..3 {
            if self.by[a].is_some() {
                v[a] = self.velocity(stage)[a];
            }
        }
    }

    #[inline(always)]
    fn correct_mean(&self, whole: &[f64; 3], _: &[f64; 3], mean: &mut [f64; 3]) {
        for a in 0..3 {
            if self.by[a].is_some() {
                mean[a] = 0.5 * (whole[a] + self.middle[a]);
            }
        }
    }

    #[inline(always)]
    fn is_rigid(&self) -> bool {
        self.rigid
    }
}

/// Prescribed motions by the loads of a case in the current step.
#[derive(Debug, Default)]
pub struct Loads {
    /// By bit of [`particles::ParticleStore::load`]: prescribed velocities, then rigid
    /// bodies. Ledgers have the same order, then come those of absorbing zones and of the surfaces.
    motions: Vec<Prescribed>,
    /// Rigid bodies.
    rigid_bodies: Vec<usize>,
    velocities: usize,
    /// Bits of those that are driven.
    driven_bits: u32,
    /// Those that forces move.
    free: FreeBodies,
    /// True on the one rank that books what holds these.
    keeps_books: bool,
    pub(crate) absorption: Absorption,
    /// Mean pressures on faces in the step (Pa).
    pressures: Vec<f64>,
    pub(crate) surfaces: Vec<SurfaceStep>,
    /// Acceleration (m/s²).
    pub gravity: [f64; 3],
    /// Impulse and work of prescribed velocities, rigid bodies, absorbing zones, relaxation and pressures in this step,
    /// by ledger.
    pub(crate) sums: Vec<[ExactSum; 4]>,
    /// Angular impulse about the origin of all of them in this step.
    pub(crate) angular_impulse: [ExactSum; 3],
}

impl Loads {
    /// Of a case, on a rank that keeps the books of all, or not.
    pub(crate) fn new(case: &Case, keeps_books: bool) -> Self {
        let rigid = |&b: &usize| case.bodies[b].rigid.is_some();
        let rigid_bodies: Vec<usize> = (0..case.bodies.len()).filter(rigid).collect();
        let velocities = case.loads.velocities.len();
        let motions = velocities + rigid_bodies.len();
        assert!(
            motions <= model::Loads::MOST,
            "too many loads and rigid bodies"
        );
        let absorption = Absorption::new(case);
        let free = FreeBodies::new(case, velocities, &rigid_bodies);
        let mut step = Self {
            motions: vec![Prescribed::default(); motions],
            driven_bits: (velocities..motions).fold(0, |bits, k| bits | 1 << k) & !free.bits(),
            free,
            keeps_books,
            rigid_bodies,
            velocities,
            surfaces: vec![SurfaceStep::default(); case.loads.surfaces.len()],
            gravity: case.loads.gravity,
            sums: (0..motions + absorption.count() + case.loads.pressures.len())
                .map(|_| Default::default())
                .collect(),
            absorption,
            pressures: vec![0.0; case.loads.pressures.len()],
            angular_impulse: Default::default(),
        };
        step.prepare(case, 0.0, 0.0);
        step
    }

    /// Half kicks in a second of steps `dt` (s); zero at the start of a case.
    pub(crate) fn per_half(dt: f64) -> f64 {
        if dt > 0.0 { 2.0 / dt } else { 0.0 }
    }

    /// True if there is anything but rigid surfaces.
    pub(crate) fn act(&self) -> bool {
        self.has_motions() || self.drive() || self.gravity != [0.0; 3]
    }

    /// True if there is an absorbing zone, a relaxation or a pressure.
    pub(crate) fn drive(&self) -> bool {
        self.absorption.is_any() || !self.pressures.is_empty()
    }

    /// True if velocities of any particle are prescribed.
    pub(crate) fn has_motions(&self) -> bool {
        !self.motions.is_empty()
    }

    /// True if bits name loads and rigid bodies of the case and no others.
    pub(crate) fn knows(&self, bits: u32) -> bool {
        u64::from(bits) >> self.motions.len() == 0
    }

    /// Number of ledgers before those of surfaces.
    pub(crate) fn driven(&self) -> usize {
        self.sums.len()
    }

    /// True if a particle with these bits is part of a driven rigid body, which no sums count.
    #[inline]
    pub(crate) fn is_driven(&self, bits: u32) -> bool {
        bits & self.driven_bits != 0
    }

    /// True if a particle with these bits is part of a rigid body.
    #[inline]
    pub(crate) fn is_rigid(&self, bits: u32) -> bool {
        bits & (self.driven_bits | self.free.bits()) != 0
    }

    /// Works out the step from time `from` to `to` (s).
    pub(crate) fn prepare(&mut self, case: &Case, from: f64, to: f64) {
        self.absorption.prepare(from, to);
        for (mean, load) in self.pressures.iter_mut().zip(&case.loads.pressures) {
            *mean = load.pressure.mean(0, from, to);
        }
        for (k, load) in case.loads.velocities.iter().enumerate() {
            self.motions[k] = if load.holds(from, to) {
                Prescribed::new(&load.motion, k, false, from, to)
            } else {
                Prescribed::default()
            };
        }
        for (n, &body) in self.rigid_bodies.iter().enumerate() {
            let k = self.velocities + n;
            if let Some(motion) = case.bodies[body].driven() {
                self.motions[k] = Prescribed::new(motion, k, true, from, to);
            }
        }
        for (step, surface) in self.surfaces.iter_mut().zip(&case.loads.surfaces) {
            *step = SurfaceStep::new(surface, from, to);
        }
    }

    /// The bits of a particle of `body` that begins at `position` (m).
    pub(crate) fn bits(&self, case: &Case, body: usize, position: &[f64; 3]) -> u32 {
        let loads = case.loads.velocities.iter();
        let held = loads.map(|load| load.body == body && load.region.contains(position));
        let rigid = self.rigid_bodies.iter().map(|&rigid| rigid == body);
        (held.chain(rigid).enumerate()).fold(0, |bits, (k, is)| bits | u32::from(is) << k)
    }

    /// Prescribed velocity of a particle with these bits; on each axis the last load holds.
    #[inline]
    pub(crate) fn of(&self, bits: u32) -> Prescribed {
        let mut all = Prescribed::default();
        let mut rest = bits;
        while rest != 0 {
            let one = &self.motions[rest.trailing_zeros() as usize];
            rest &= rest - 1;
            all.rigid |= one.rigid;
            for a in 0..3 {
                if one.by[a].is_some() {
                    all.by[a] = one.by[a];
                    all.middle[a] = one.middle[a];
                    all.end[a] = one.end[a];
                }
            }
        }
        all
    }

    /// That of a particle with these bits at `x` (m), which may be part of a rigid body that forces move.
    #[inline]
    pub(crate) fn at(&self, bits: u32, x: &[f64; 3]) -> Prescribed {
        if bits & self.free.bits() == 0 {
            self.of(bits)
        } else {
            self.free.at(bits, x)
        }
    }

    /// Clears the components of a vector that are prescribed to a particle with these bits.
    #[inline]
    pub(crate) fn clear_prescribed(&self, bits: u32, vector: &mut [f64; 3]) {
        let prescribed = self.of(bits);
        for a in 0..3 {
            if prescribed.by[a].is_some() {
                vector[a] = 0.0;
            }
        }
    }

    pub(crate) fn memory(&self) -> usize {
        size_of::<Prescribed>() * self.motions.capacity()
            + size_of::<SurfaceStep>() * self.surfaces.capacity()
            + size_of::<usize>() * self.rigid_bodies.capacity()
            + self.free.memory()
            + self.absorption.memory()
            + size_of::<f64>() * self.pressures.capacity()
            + 4 * size_of::<ExactSum>() * self.sums.capacity()
    }

    /// Adds the torque of gravity on what is no part of a driven body to `torque`.
    pub(crate) fn add_weight(&self, particles: &ParticleStore, torque: &mut [ExactSum; 3]) {
        if self.gravity == [0.0; 3] {
            return;
        }
        let all = self.sum_free(particles, |i| {
            let weight = self.gravity.map(|g| particles.mass[i] * g);
            cross(&particles.position[i], &weight)
        });
        for (sum, other) in torque.iter_mut().zip(&all) {
            sum.merge(other);
        }
    }
}
