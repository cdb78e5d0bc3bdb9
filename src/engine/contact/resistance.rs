//! Friction and damping between bodies: each particle has a law of its own, which rests on its part
//! `o_ij` of the pair forces and is borne by its neighbours with the shares of that (theory page
//! "Contact").

use super::friction::{Friction, Law, Slip};
use super::pair::Pair;
use super::view::{ContactParticle, ContactView};
use numerics::vector::norm;

/// Load of friction and damping of a receiver: sums over its pairs, weighted with `o_ij`.
#[derive(Default)]
pub(crate) struct NormalLoad {
    load: f64,
    force: [f64; 3],
    motion: [f64; 3],
    /// Normal, of any length.
    facing: [f64; 3],
    law: Law,
}

impl NormalLoad {
    /// Adds a pair whose part of i's side is `force` (N), `own` long.
    pub fn add(&mut self, pair: &Pair, [i, j]: [&ContactParticle; 2], own: f64, force: &[f64; 3]) {
        self.load += own;
        for a in 0..3 {
            self.force[a] += force[a];
            self.motion[a] += own * (i.velocity[a] - j.velocity[a]);
        }
        self.law.add(own, &pair.friction.of_volume(i.volume));
    }

    /// Adds to the normal `weight` times a vector.
    pub fn face(&mut self, weight: f64, towards: &[f64; 3]) {
        for (facing, part) in self.facing.iter_mut().zip(towards) {
            *facing += weight * part;
        }
    }

    /// `O_i = Σ_j o_ij` (N), over pairs that have friction or damping, and what these do to the
    /// receiver after the step; neighbour j bears the share `o_ij/O_i` of it.
    ///
    /// Its load is `Σ_j o_ij e_ij·n`, its velocity against what it lies on `Σ_j o_ij v_ij/O_i`.
    #[must_use]
    pub fn friction(&self, view: &ContactView, i: &ContactParticle) -> Option<(f64, Friction)> {
        let size = norm(&self.facing);
        if size <= 0.0 {
            return None;
        }
        let before = Slip {
            displacement: view.particles.slip[i.slot],
            rate: view.particles.slip_rate[i.slot],
            sliding: view.particles.sliding[i.slot] != 0,
        };
        let normal = self.facing.map(|n| n / size);
        let mut velocity = self.motion.map(|v| v / self.load);
        view.mirror(&mut velocity);
        let law = self.law.over(self.load);
        let friction = law.step(&before, &self.force, &normal, &velocity, view.dt);
        Some((self.load, friction))
    }
}

/// Effects on its pairs of friction that rests on one particle, over its load.
struct Shared {
    /// Force on the particle.
    force: [f64; 3],
    /// Heat (m/s).
    power: f64,
    /// Energy (m).
    energy: f64,
    /// 1/N.
    inverse_load: f64,
}

impl Shared {
    const NONE: Self = Self {
        force: [0.0; 3],
        power: 0.0,
        energy: 0.0,
        inverse_load: 0.0,
    };

    fn of(view: &ContactView, particle: &ContactParticle) -> Self {
        let (particles, slot) = (view.particles, particle.slot);
        let load = particles.friction_load[slot];
        if load <= 0.0 {
            return Self::NONE;
        }
        let force = view.shown(particle, &particles.friction_force[slot]);
        Self {
            force: force.map(|f| f / load),
            power: particles.friction_power[slot] / load,
            // Of this rank's particles only, and never asked of others.
            energy: particles
                .friction_energy
                .get(slot)
                .map_or(0.0, |e| e / load),
            inverse_load: 1.0 / load,
        }
    }
}

/// Friction of a receiver: its own, that of the pair in hand, and sums over pairs for the time
/// step.
pub(super) struct PairFriction {
    here: Shared,
    /// Of the pair (N).
    pub force: [f64; 3],
    /// Of the pair (J).
    pub energy: f64,
    /// Of the pair (W).
    pub heat: f64,
    /// Of all pairs (N/m).
    pub stiffness: f64,
    /// Of all pairs (N s/m).
    pub dashpot: f64,
}

impl PairFriction {
    /// Of the receiver `i`.
    pub fn of(view: &ContactView, i: &ContactParticle) -> Self {
        Self {
            here: Shared::of(view, i),
            force: [0.0; 3],
            energy: 0.0,
            heat: 0.0,
            stiffness: 0.0,
            dashpot: 0.0,
        }
    }

    /// Friction and damping of the pair with `j`: `o_ij T_i/O_i − o_ji T_j/O_j`, its heat and its
    /// energy, given `o_ij` and `o_ji` (N).
    pub fn pair(
        &mut self,
        view: &ContactView,
        [i, j]: [&ContactParticle; 2],
        [own, their]: [f64; 2],
    ) {
        (self.force, self.energy, self.heat) = ([0.0; 3], 0.0, 0.0);
        let pair = view.table.pair(i.size_class, j.size_class);
        let (law, back) = (
            &pair.friction,
            &view.table.pair(j.size_class, i.size_class).friction,
        );
        if !law.is_any() {
            return;
        }
        let there = Shared::of(view, j);
        for a in 0..3 {
            self.force[a] = own * self.here.force[a] - their * there.force[a];
        }
        self.energy = own * self.here.energy;
        self.heat = pair.heat_share * (own * self.here.power + their * there.power);
        // Rows of the matrices of all springs and dashpots that i has a part in.
        let [mine, theirs] = [own * self.here.inverse_load, their * there.inverse_load];
        self.stiffness +=
            2.0 * (mine * (law.stiffness * i.volume) + theirs * (back.stiffness * j.whole));
        self.dashpot += 2.0 * (mine * (law.dashpot * i.volume) + theirs * (back.dashpot * j.whole));
    }
}
