//! Friction and damping between bodies: each particle has a law of its own, which rests on its part
//! `o_ij` of the pair forces and is borne by its neighbours with the shares of that (theory page
//! "Contact").

use super::friction::{Grip, Law, Memory};
use super::{ContactView, Pair, Party, Reaction};
use crate::domain::Mirrors;
use crate::numerics::vector::dot;

/// Friction and damping that rest on one receiver.
#[derive(Debug, Clone, Copy, Default)]
pub struct Hold {
    /// `O_i = Σ_j o_ij` (N), over pairs that have friction or damping.
    pub load: f64,
    /// Force on the receiver, of which neighbour j bears the share `o_ij/O_i`; heat; energy; and
    /// what it remembers.
    pub grip: Grip,
}

/// Sums over what a receiver lies on, weighted with `o_ij`.
#[derive(Default)]
pub(super) struct Bearing {
    pub(super) load: f64,
    force: [f64; 3],
    motion: [f64; 3],
    /// Normal, of any length.
    pub(super) facing: [f64; 3],
    law: Law,
}

impl Bearing {
    /// Adds a pair whose part of i's side is `force` (N), `own` long.
    pub(super) fn add(&mut self, pair: &Pair, [i, j]: [&Party; 2], own: f64, force: &[f64; 3]) {
        let resistance = &pair.resistance;
        self.load += own;
        for a in 0..3 {
            self.force[a] += force[a];
            self.motion[a] += own * (i.velocity[a] - j.velocity[a]);
        }
        self.law.static_friction += own * resistance.static_friction;
        self.law.kinetic_friction += own * resistance.kinetic_friction;
        self.law.stiffness += own * (resistance.stick * i.volume);
        self.law.dashpot += own * (resistance.dashpot * i.volume);
    }
}

/// Friction and damping of a receiver after the step, which rest on what all modes have added to
/// `bearing`.
///
/// Its load is `Σ_j o_ij e_ij·n`, its velocity against what it lies on `Σ_j o_ij v_ij/O_i`.
#[must_use]
pub(super) fn hold(view: &ContactView, i: &Party, bearing: &Bearing) -> Hold {
    let Bearing {
        load,
        force,
        motion,
        facing,
        law,
    } = *bearing;
    let size = dot(&facing, &facing).sqrt();
    if size <= 0.0 {
        return Hold::default();
    }
    let law = Law {
        static_friction: law.static_friction / load,
        kinetic_friction: law.kinetic_friction / load,
        stiffness: law.stiffness / load,
        dashpot: law.dashpot / load,
    };
    let memory = Memory {
        slip: view.store.slip[i.base],
        rate: view.store.slip_rate[i.base],
        sliding: view.store.sliding[i.base] != 0,
    };
    let normal = facing.map(|n| n / size);
    let velocity = motion.map(|v| v / load);
    Hold {
        load,
        grip: law.step(&memory, &force, &normal, &velocity, view.dt),
    }
}

/// What friction that rests on one particle does to its pairs, over its load.
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

    /// Of the particle `base`, of which an image with `code` is met.
    fn of(view: &ContactView, base: usize, code: u8) -> Self {
        let store = view.store;
        let load = store.friction_load[base];
        if load <= 0.0 {
            return Self::NONE;
        }
        let force = Mirrors::reflect_vector(&store.friction_force[base], code);
        Self {
            force: force.map(|f| f / load),
            power: store.friction_power[base] / load,
            // Of this rank's particles only, and never asked of others.
            energy: store.friction_energy.get(base).map_or(0.0, |e| e / load),
            inverse_load: 1.0 / load,
        }
    }
}

/// Friction of a receiver: its own, that of the pair in hand, and sums over pairs.
pub(super) struct Resisting {
    here: Shared,
    pub(super) force: [f64; 3],
    pub(super) energy: f64,
    heat: f64,
    stiffness: f64,
    dashpot: f64,
}

impl Resisting {
    /// Of the receiver `i`.
    pub(super) fn of(view: &ContactView, i: &Party) -> Self {
        Self {
            here: Shared::of(view, i.base, 0),
            force: [0.0; 3],
            energy: 0.0,
            heat: 0.0,
            stiffness: 0.0,
            dashpot: 0.0,
        }
    }

    /// Friction and damping of the pair with `j`, which is at the place `other`: `o_ij T_i/O_i −
    /// o_ji T_j/O_j`, its heat and its energy, with `parts` giving `o_ij` and `o_ji` (N).
    pub(super) fn pair(
        &mut self,
        view: &ContactView,
        [i, j]: [&Party; 2],
        other: u32,
        parts: impl FnOnce() -> [f64; 2],
    ) {
        (self.force, self.energy, self.heat) = ([0.0; 3], 0.0, 0.0);
        let (pair, back) = (
            &view.table.pair(i.body, j.body).resistance,
            &view.table.pair(j.body, i.body).resistance,
        );
        if !pair.is_any() {
            return;
        }
        let there = Shared::of(view, j.base, view.images[other as usize].code());
        let [own, their] = parts();
        for a in 0..3 {
            self.force[a] = own * self.here.force[a] - their * there.force[a];
        }
        self.energy = own * self.here.energy;
        self.heat = pair.heat_share * (own * self.here.power + their * there.power);
        // Rows of the matrices of all springs and dashpots that i has a part in.
        let [mine, theirs] = [own * self.here.inverse_load, their * there.inverse_load];
        self.stiffness += 2.0 * (mine * (pair.stick * i.volume) + theirs * (back.stick * j.volume));
        self.dashpot +=
            2.0 * (mine * (pair.dashpot * i.volume) + theirs * (back.dashpot * j.volume));
    }

    /// Books the heat of the pair in hand, after the pair itself.
    pub(super) fn book_heat(&self, body: usize, reaction: &mut Reaction) {
        reaction.book_heat(body, self.heat);
    }

    /// Adds what the time step must know, after all pairs.
    pub(super) fn finish(&self, reaction: &mut Reaction) {
        reaction.stiffness += self.stiffness;
        reaction.dashpot += self.dashpot;
    }
}
