//! Overlap contact: an energy of the foreign volume fraction above its touching value
//! (physics page, section 5).
//!
//! With `S_i = Σ_{j foreign} V_j W_ij` and fraction-weighted means
//! `M̄_i = Σ V_j W_ij M_ij / S_i`, `C̄_i = Σ V_j W_ij C*_ij / S_i`, the excess is
//! `E_i = ⟨S_i − C̄_i − s_i⟩₊` and the energy `Φ = Σ_i ½ M̄_i V_i E_i²` (the stiffness κ is part
//! of `M`). A core `½ κ_c M V̄ ⟨1 − r/r_c⟩₊²` keeps lone particles apart.

use super::hold::{Bearing, Resisting};
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
        let kernel = pair.kernel.value(gap.distance);
        let share = j.volume * kernel;
        sum.fraction += share;
        sum.modulus += share * pair.modulus;
        sum.touching += share * pair.touching;
        sum.slope -= j.volume * pair.kernel.slope(gap.distance);
        sum.current += view.motion[other as usize].volume * kernel;
    }
    if sum.fraction > 0.0 {
        sum.modulus /= sum.fraction;
        sum.touching /= sum.fraction;
        sum.excess = (sum.fraction - sum.touching - relief).max(0.0);
    }
    sum
}

/// The stored fraction of a particle, as its neighbours see it; nothing without excess.
#[inline]
fn stored(view: &ContactView, base: usize) -> Fraction {
    let excess = view.store.contact_excess[base];
    if excess == 0.0 {
        return Fraction::default();
    }
    Fraction {
        excess,
        fraction: view.store.foreign_fraction[base],
        modulus: view.store.contact_modulus[base],
        touching: view.store.touching_value[base],
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
    let stress = i.modulus * i.excess;
    let steeper = 0.5 * (i.excess * i.excess) * (pair.modulus - i.modulus);
    stress + (steeper - stress * (pair.touching - i.touching)) / i.fraction
}

/// The pair force of i's own energy, `o_ij = V_i V_j ⟨a_ij⟩₊ |∇W_ij|` and half of the core (N):
/// what friction of the pair rests on from i's side.
fn own_force(view: &ContactView, i: &Party, j: &Party, gap: &Gap, here: &Fraction) -> f64 {
    let pair = view.table.pair(i.body, j.body);
    let slope = -pair.kernel.slope(gap.distance);
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
        let slope = -pair.kernel.slope(gap.distance);
        let along = gap.along(j.volume * slope);
        for a in 0..3 {
            sum[a] += along[a];
        }
    }
    let size = (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]).sqrt();
    let weight = fraction.fraction * fraction.fraction / size.max(f64::MIN_POSITIVE);
    sum.map(|x| x * weight)
}

/// Adds the neighbours that friction and damping of `i` rest on.
///
/// The normal is that which i sees less the mean of those that its neighbours see, weighted with
/// `o_ij`.
pub(super) fn bear(view: &ContactView, i: &Party, neighbours: &[u32], bearing: &mut Bearing) {
    let here = stored(view, i.base);
    for &other in neighbours {
        let j = view.party(other);
        let pair = view.table.pair(i.body, j.body);
        if !pair.resistance.is_any() {
            continue;
        }
        let gap = Gap::between(i, &j);
        let own = own_force(view, i, &j, &gap, &here);
        bearing.add(pair, [i, &j], own, &gap.along(own));
        let code = view.images[other as usize].code();
        let theirs = Mirrors::reflect_vector(&view.store.contact_normal[j.base], code);
        for (facing, seen) in bearing.facing.iter_mut().zip(theirs) {
            *facing -= own * seen;
        }
    }
    let load = bearing.load;
    let seen = &view.store.contact_normal[i.base];
    for (facing, seen) in bearing.facing.iter_mut().zip(seen) {
        *facing += load * seen;
    }
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
    let mut resisting = FRICTION.then(|| Resisting::of(view, &i));
    for &other in neighbours {
        let j = view.party(other);
        let gap = Gap::between(&i, &j);
        let pair = view.table.pair(i.body, j.body);
        reaction.meet(&j, &gap, pair);
        let there = stored(view, j.base);
        let pressed = here.excess > 0.0 || there.excess > 0.0;
        if !FRICTION && !pressed && gap.distance >= pair.core_radius {
            continue;
        }
        let (mut force, mut core) = (0.0, 0.0);
        let mut energy = 0.0;
        if pressed {
            let back = view.table.pair(j.body, i.body);
            let slope = -pair.kernel.slope(gap.distance);
            let pressure = slope_of_energy(&here, pair) + slope_of_energy(&there, back);
            force += i.volume * j.volume * pressure * slope;
            reaction.stiffness += bulk_stiffness(view, &i, &j, &gap, &here, &there);
            if here.excess > 0.0 {
                let share = j.volume * pair.kernel.value(gap.distance) * pair.modulus;
                energy += 0.5 * i.volume * (here.excess * here.excess) * share / here.fraction;
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
            at.pair(view, [&i, &j], other, || {
                let own = own_force(view, &i, &j, &gap, &here);
                [own, own_force(view, &j, &i, &gap, &there)]
            });
            for a in 0..3 {
                force[a] += at.force[a];
            }
            energy += at.energy;
        }
        reaction.press(&j, force, energy);
        if let Some(at) = &resisting {
            at.book_heat(j.body, reaction);
        }
    }
    if let Some(at) = resisting {
        at.finish(reaction);
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
    let slope = -pair.kernel.slope(gap.distance);
    let curvature = pair.kernel.curvature(gap.distance).abs();
    let active = |f: &Fraction| if f.excess > 0.0 { f.slope } else { 0.0 };
    let steep = (active(here) + active(there)) * slope;
    let bent = (here.excess + there.excess) * curvature;
    2.0 * pair.modulus * i.volume * j.volume * (steep + bent)
}
