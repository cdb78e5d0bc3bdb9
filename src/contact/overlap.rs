//! Overlap contact: an energy of the foreign volume fraction above its touching value
//! (physics page, section 5).
//!
//! With `S_i = Σ_{j foreign} V_j W_ij` and fraction-weighted means
//! `M̄_i = Σ V_j W_ij M_ij / S_i`, `C̄_i = Σ V_j W_ij C*_ij / S_i`, the excess is
//! `E_i = ⟨S_i − C̄_i − s_i⟩₊` and the energy `Φ = Σ_i ½ M̄_i V_i E_i²` (the stiffness κ is part
//! of `M`). A core `½ κ_c M V̄ ⟨1 − r/r_c⟩₊²` keeps lone particles apart.

use super::friction::{Grip, Law, Memory, dot};
use super::{ContactView, Gap, Pair, Party, Reaction};
use crate::domain::Mirrors;

/// The foreign fraction of one receiver and what follows from it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Fraction {
    /// `S_i`.
    pub fraction: f64,
    /// `M̄_i` (Pa), stiffness included.
    pub modulus: f64,
    /// `C̄_i`.
    pub touching: f64,
    /// `E_i`.
    pub excess: f64,
    /// `g_i = Σ V_j |∇W_ij|` (1/m).
    pub slope: f64,
    /// `Σ V_j W_ij` with current volumes.
    pub current: f64,
}

/// Largest touching value plus relief: beyond it a particle counts as inside the other body.
pub const RELIEF_LIMIT: f64 = 0.45;

/// The relief of a particle laid with foreign fraction `fraction` and touching value `touching`
/// at the start, and whether it had to be capped.
#[must_use]
pub fn relief(fraction: &Fraction) -> (f64, bool) {
    let wanted = (fraction.fraction - fraction.touching).max(0.0);
    let limit = (RELIEF_LIMIT - fraction.touching).max(0.0);
    (wanted.min(limit), wanted > limit)
}

/// Sums the foreign fraction of the receiver at `place`, whose relief is `relief`.
#[must_use]
pub fn fraction(view: &ContactView, place: u32, neighbours: &[u32], relief: f64) -> Fraction {
    let i = view.party(place);
    let mut sum = Fraction::default();
    for &other in neighbours {
        let j = view.party(other);
        let pair = view.table.pair(i.body, j.body);
        let gap = Gap::between(&i, &j);
        let kernel = view.table.kernel.value(gap.distance, pair.h);
        let share = j.volume * kernel;
        sum.fraction += share;
        sum.modulus += share * pair.modulus;
        sum.touching += share * pair.touching;
        sum.slope -= j.volume * view.table.kernel.slope(gap.distance, pair.h);
        sum.current += view.motion[other as usize].volume * kernel;
    }
    if sum.fraction > 0.0 {
        sum.modulus /= sum.fraction;
        sum.touching /= sum.fraction;
        sum.excess = (sum.fraction - sum.touching - relief).max(0.0);
    }
    sum
}

/// The stored fraction of a particle, as its neighbours see it.
fn stored(view: &ContactView, base: usize) -> Fraction {
    Fraction {
        fraction: view.store.foreign_fraction[base],
        modulus: view.store.contact_modulus[base],
        touching: view.store.touching_value[base],
        excess: view.store.contact_excess[base],
        slope: view.store.contact_slope[base],
        current: 0.0,
    }
}

/// `a_ij = M̄_i E_i [1 − (C*_ij − C̄_i)/S_i] + ½ E_i² (M_ij − M̄_i)/S_i` (Pa): derivative of
/// particle i's energy by its fraction of j, per volume of i.
fn slope_of_energy(i: &Fraction, pair: &Pair) -> f64 {
    if i.excess == 0.0 {
        return 0.0;
    }
    i.modulus * i.excess * (1.0 - (pair.touching - i.touching) / i.fraction)
        + 0.5 * (i.excess * i.excess) * (pair.modulus - i.modulus) / i.fraction
}

/// The pair force of i's own energy, `o_ij = V_i V_j ⟨a_ij⟩₊ |∇W_ij|` and half of the core (N):
/// what friction of the pair rests on from i's side.
fn own_force(view: &ContactView, i: &Party, j: &Party, gap: &Gap, here: &Fraction) -> f64 {
    let pair = view.table.pair(i.body, j.body);
    let slope = -view.table.kernel.slope(gap.distance, pair.h);
    let bulk = i.volume * j.volume * slope_of_energy(here, pair).max(0.0) * slope;
    let depth = (1.0 - gap.distance / pair.core_radius).max(0.0);
    let stress = pair.core_modulus * (0.5 * (i.volume + j.volume));
    bulk + 0.5 * stress * depth / pair.core_radius
}

/// The normal that the receiver at `place` sees, `−∇S_i/|∇S_i|`, times `S_i²`: how much it knows. The
/// particle that sees a face knows the normal; one of a face that sees a lone particle does not.
#[must_use]
pub fn normal(view: &ContactView, place: u32, neighbours: &[u32], fraction: &Fraction) -> [f64; 3] {
    let i = view.party(place);
    let mut sum = [0.0; 3];
    for &other in neighbours {
        let j = view.party(other);
        let pair = view.table.pair(i.body, j.body);
        let gap = Gap::between(&i, &j);
        let slope = -view.table.kernel.slope(gap.distance, pair.h);
        let along = gap.along(j.volume * slope);
        for a in 0..3 {
            sum[a] += along[a];
        }
    }
    let size = (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]).sqrt();
    let weight = fraction.fraction * fraction.fraction / size.max(f64::MIN_POSITIVE);
    sum.map(|x| x * weight)
}

/// Friction and damping that rest on one receiver.
#[derive(Debug, Clone, Copy, Default)]
pub struct Hold {
    /// `O_i = Σ_j o_ij` (N), over pairs that have friction or damping.
    pub load: f64,
    /// Force on the receiver, of which neighbour j bears the share `o_ij/O_i`; heat; energy; and
    /// what it remembers.
    pub grip: Grip,
}

/// Friction and damping of the receiver at `place` after the step.
///
/// The normal `n` is that which it sees less the mean of those that its neighbours see, weighted
/// with `o_ij`. Its load is `Σ_j o_ij e_ij·n`, its velocity against what it lies on
/// `Σ_j o_ij v_ij/O_i`.
#[must_use]
pub fn hold(view: &ContactView, place: u32, neighbours: &[u32]) -> Hold {
    let i = view.party(place);
    let here = stored(view, i.base);
    let (mut load, mut force) = (0.0, [0.0; 3]);
    let (mut motion, mut facing) = ([0.0; 3], [0.0; 3]);
    let mut law = Law::default();
    for &other in neighbours {
        let j = view.party(other);
        let pair = &view.table.pair(i.body, j.body).resistance;
        if !pair.is_any() {
            continue;
        }
        let gap = Gap::between(&i, &j);
        let own = own_force(view, &i, &j, &gap, &here);
        let along = gap.along(own);
        let code = view.images[other as usize].code();
        let theirs = Mirrors::reflect_vector(&view.store.contact_normal[j.base], code);
        load += own;
        for a in 0..3 {
            force[a] += along[a];
            facing[a] -= own * theirs[a];
            motion[a] += own * (i.velocity[a] - j.velocity[a]);
        }
        law.static_friction += own * pair.static_friction;
        law.kinetic_friction += own * pair.kinetic_friction;
        law.stiffness += own * (pair.stick * i.volume);
        law.dashpot += own * (pair.dashpot * i.volume);
    }
    for (facing, seen) in facing.iter_mut().zip(&view.store.contact_normal[i.base]) {
        *facing += load * seen;
    }
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

/// Adds friction and damping of a pair: `o_ij T_i/O_i − o_ji T_j/O_j`, its heat and its energy.
fn resist(view: &ContactView, [i, j]: [&Party; 2], other: u32, gap: &Gap, at: &mut Resisting) {
    let (pair, back) = (
        &view.table.pair(i.body, j.body).resistance,
        &view.table.pair(j.body, i.body).resistance,
    );
    if !pair.is_any() {
        return;
    }
    let there = Shared::of(view, j.base, view.images[other as usize].code());
    let own = own_force(view, i, j, gap, &stored(view, i.base));
    let their = own_force(view, j, i, gap, &stored(view, j.base));
    for a in 0..3 {
        at.force[a] = own * at.here.force[a] - their * there.force[a];
    }
    at.energy = own * at.here.energy;
    at.heat = pair.heat_share * (own * at.here.power + their * there.power);
    // Rows of the matrices of all springs and dashpots that i has a part in.
    let [mine, theirs] = [own * at.here.inverse_load, their * there.inverse_load];
    at.stiffness += 2.0 * (mine * (pair.stick * i.volume) + theirs * (back.stick * j.volume));
    at.dashpot += 2.0 * (mine * (pair.dashpot * i.volume) + theirs * (back.dashpot * j.volume));
}

/// Friction of a receiver: its own, that of the pair in hand, and sums over pairs.
struct Resisting {
    here: Shared,
    force: [f64; 3],
    energy: f64,
    heat: f64,
    stiffness: f64,
    dashpot: f64,
}

/// Adds what the foreign neighbours do to the receiver at `place` to `reaction`:
/// `f_ij = −V_i V_j (a_ij + a_ji) ∇_i W_ij`, the core, and with `FRICTION` friction and damping.
pub fn react<const FRICTION: bool>(
    view: &ContactView,
    place: u32,
    neighbours: &[u32],
    reaction: &mut Reaction,
) {
    let i = view.party(place);
    let here = stored(view, i.base);
    let mut resisting = FRICTION.then(|| Resisting {
        here: Shared::of(view, i.base, 0),
        force: [0.0; 3],
        energy: 0.0,
        heat: 0.0,
        stiffness: 0.0,
        dashpot: 0.0,
    });
    for &other in neighbours {
        let j = view.party(other);
        let gap = Gap::between(&i, &j);
        let (pair, back) = (
            view.table.pair(i.body, j.body),
            view.table.pair(j.body, i.body),
        );
        let there = stored(view, j.base);
        let (mut force, mut core) = (0.0, 0.0);
        let mut energy = 0.0;
        if here.excess > 0.0 || there.excess > 0.0 {
            let kernel = &view.table.kernel;
            let slope = -kernel.slope(gap.distance, pair.h);
            let pressure = slope_of_energy(&here, pair) + slope_of_energy(&there, back);
            force += i.volume * j.volume * pressure * slope;
            reaction.stiffness += bulk_stiffness(view, &i, &j, &gap, &here, &there);
            if here.excess > 0.0 {
                let share = j.volume * kernel.value(gap.distance, pair.h) * pair.modulus
                    / (here.fraction * here.modulus);
                energy += 0.5 * here.modulus * i.volume * (here.excess * here.excess) * share;
            }
        }
        let depth = 1.0 - gap.distance / pair.core_radius;
        if depth > 0.0 {
            let stress = pair.core_modulus * (0.5 * (i.volume + j.volume));
            core = stress * depth / pair.core_radius;
            // Half of the pair's energy stands on each side.
            energy += 0.25 * stress * (depth * depth);
            reaction.stiffness += 2.0 * stress / (pair.core_radius * pair.core_radius);
        }
        let mut force = if pair.along_normal {
            // The core has no use for normals: it keeps lone particles apart.
            let bulk = gap.along_normal(force, view.normal(place, other));
            let core = gap.along(core);
            [bulk[0] + core[0], bulk[1] + core[1], bulk[2] + core[2]]
        } else {
            gap.along(force + core)
        };
        if let Some(at) = &mut resisting {
            (at.force, at.energy, at.heat) = ([0.0; 3], 0.0, 0.0);
            resist(view, [&i, &j], other, &gap, at);
            for a in 0..3 {
                force[a] += at.force[a];
            }
            energy += at.energy;
        }
        reaction.book(&j, &gap, pair, force, energy);
        if let Some(at) = &resisting {
            reaction.book_heat(j.body, at.heat);
        }
    }
    if let Some(at) = resisting {
        reaction.stiffness += at.stiffness;
        reaction.dashpot += at.dashpot;
    }
}

/// A pair's part of `k_i = 2 M V_i Σ_j V_j [(g_i + g_j)|∇W_ij| + (E_i + E_j)|W″_ij|]` (N/m), with
/// `g` counted where there is excess.
fn bulk_stiffness(
    view: &ContactView,
    i: &Party,
    j: &Party,
    gap: &Gap,
    here: &Fraction,
    there: &Fraction,
) -> f64 {
    let pair = view.table.pair(i.body, j.body);
    let kernel = &view.table.kernel;
    let slope = -kernel.slope(gap.distance, pair.h);
    let curvature = kernel.curvature(gap.distance, pair.h).abs();
    let active = |f: &Fraction| if f.excess > 0.0 { f.slope } else { 0.0 };
    let steep = (active(here) + active(there)) * slope;
    let bent = (here.excess + there.excess) * curvature;
    2.0 * pair.modulus * i.volume * j.volume * (steep + bent)
}
