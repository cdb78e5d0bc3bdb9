//! Overlap contact: an energy of the foreign volume fraction above its touching value
//! (physics page, section 5).
//!
//! With `S_i = Σ_{j foreign} V_j W_ij` and fraction-weighted means
//! `M̄_i = Σ V_j W_ij M_ij / S_i`, `C̄_i = Σ V_j W_ij C*_ij / S_i`, the excess is
//! `E_i = ⟨S_i − C̄_i − s_i⟩₊` and the energy `Φ = Σ_i ½ M̄_i V_i E_i²` (the stiffness κ is part
//! of `M`). A core `½ κ_c M V̄ ⟨1 − r/r_c⟩₊²` keeps lone particles apart.

mod measure;

use super::ContactTable;
use super::mode::{MeasuredChunks, Mode, PairForce, ParticlePair, Scene};
use super::pair::{Between, Constants, Pair};
use super::resistance::NormalLoad;
use super::view::{ContactParticle, ContactView, Separation};
pub use measure::{Fraction, OFFSET_LIMIT, fraction, initial_offset};
use measure::{Measured, weigh};
use model::{Body, Case, ContactClass, ContactDirection, Overlap};
use particles::HaloPhase;
use populate;

/// Factor of the core's viscosity for the mass of a pair, its approach squared and its depth, over
/// its radius.
const CORE_VISCOSITY: f64 = 5.0;

/// Factor of the viscosity of an isolated particle for the density of a pair, its approach squared
/// and the slope of its kernel over both volumes.
const ISOLATED_VISCOSITY: f64 = 20.0;

/// The excess of both sides at which that viscosity is whole.
const WHOLE_EXCESS: f64 = 0.1;

/// Constants of an ordered pair of bodies.
#[derive(Debug, Clone, Default)]
pub struct OverlapPair {
    /// κ times the smaller p-wave modulus (Pa).
    pub modulus: f64,
    /// Touching value C* of the receiver's body on the other.
    pub touching: f64,
    /// `κ_c` times the scale `max(M', .85 ρ' v²)` of the core (Pa).
    pub core_modulus: f64,
    /// Radius of the core (m).
    pub core_radius: f64,
    /// Viscosity of the core over volume: `μ' B/r_c` for the mass `μ' V̄` of a pair (kg/m⁴).
    pub core_viscosity: f64,
    /// Viscosity of isolated particles over excess, both volumes and slope: `ρ' B/E_0` (kg/m³).
    pub isolated_viscosity: f64,
    /// True if forces but those of the core act along the normals of the surfaces.
    pub along_normal: bool,
}

impl ContactTable {
    /// Constants of overlap contact of a receiver of size class `a` and a neighbour of size class `b`.
    #[inline]
    #[must_use]
    pub fn overlap(&self, a: usize, b: usize) -> &OverlapPair {
        self.own::<Overlap>(a, b)
    }

    /// True if any pair of bodies has overlap contact, which alone measures foreign fractions.
    #[must_use]
    pub fn measures_fractions(&self) -> bool {
        self.foreign.class.contains(&Some(ContactClass::Overlap))
    }
}

impl Constants for Overlap {
    type Pair = OverlapPair;

    const HALO: HaloPhase = HaloPhase::CONTACT;

    fn pair(&self, of: &Between) -> OverlapPair {
        let [a, b] = of.bodies;
        let density = harmonic_mean(of, |body| of.case.initial_density(body));
        let core_modulus = harmonic_mean(of, |body| of.case.contact_modulus(body));
        let impact = Case::impact_stiffness(density, of.impact_speed);
        let core_radius = self.core_radius * of.pair.spacing;
        OverlapPair {
            modulus: self.stiffness * of.modulus.max(impact),
            touching: populate::touching_value(a, b, of.case.extent()),
            core_modulus: self.core_stiffness * core_modulus.max(impact),
            core_radius,
            core_viscosity: 0.5 * CORE_VISCOSITY * density / core_radius,
            isolated_viscosity: ISOLATED_VISCOSITY * density / WHOLE_EXCESS,
            along_normal: self.direction == ContactDirection::Normal,
        }
    }
}

/// Harmonic mean of a value of two bodies, as the mass of two particles that meet head-on is; what is driven counts as
/// infinite.
fn harmonic_mean(of: &Between, value: impl Fn(&Body) -> f64) -> f64 {
    let bodies = of.indices.map(|index| &of.case.bodies[index]);
    let soft = bodies.into_iter().filter(|body| body.driven().is_none());
    2.0 / soft.map(|body| 1.0 / value(body)).sum::<f64>()
}

#[inline(always)]
fn constants<'a>(
    view: &ContactView<'a>,
    i: &ContactParticle,
    j: &ContactParticle,
) -> (&'a Pair, &'a OverlapPair) {
    let table = view.table;
    (
        table.pair(i.size_class, j.size_class),
        table.overlap(i.size_class, j.size_class),
    )
}

impl Mode for Overlap {
    type Measured = Measured;
    /// The stored fraction of a particle, as its neighbours see it; nothing without excess.
    type Side = Fraction;

    fn measure(found: &mut MeasuredChunks<Self>, scene: &mut Scene) {
        weigh(found, scene);
        measure::store(found, scene);
    }

    /// Gives every particle the initial overlap offset that makes it start free of force; some are
    /// capped.
    fn begin(found: &mut MeasuredChunks<Self>, scene: &mut Scene) -> i64 {
        weigh(found, scene);
        let mut capped = 0;
        for measured in found.iter().flatten() {
            let (offset, was_capped) = initial_offset(&measured.fraction);
            scene.particles.touch_relief[measured.particle] = offset;
            capped += i64::from(was_capped);
        }
        capped
    }

    #[inline(always)]
    fn side(view: &ContactView, particle: &ContactParticle) -> Fraction {
        let (particles, slot) = (view.particles, particle.slot);
        let excess = particles.contact_excess[slot];
        if excess == 0.0 {
            return Fraction::default();
        }
        Fraction {
            excess,
            fraction: particles.foreign_fraction[slot],
            modulus: particles.contact_modulus[slot],
            touching: particles.touching_value[slot],
            slope: particles.contact_slope[slot],
            current: 0.0,
            isolation: particles.isolation[slot],
        }
    }

    /// `f_ij = −V_i V_j (a_ij + a_ji) ∇_i W_ij`, and the core.
    #[inline(always)]
    fn force(pair: &ParticlePair<Self>, stiffness: &mut f64) -> Option<PairForce> {
        let ParticlePair {
            view,
            i,
            j,
            separation,
            constants,
            stiffening: [s_i, s_j],
            own,
            here,
            there,
        } = pair;
        let distance = separation.distance;
        let pressed = here.excess > 0.0 || there.excess > 0.0;
        if !pressed && distance >= own.core_radius {
            return None;
        }
        let (mut bulk, mut core, mut energy, mut drag) = (0.0, 0.0, 0.0, 0.0);
        let back = view.table.overlap(j.size_class, i.size_class);
        let slope = -constants.kernel.slope(distance);
        if pressed {
            let pressure = s_i * slope_of_energy(here, own) + s_j * slope_of_energy(there, back);
            bulk = i.volume * j.volume * pressure * slope;
            *stiffness += bulk_stiffness(pair, slope);
            drag = isolated_drag(pair, slope);
            if here.excess > 0.0 {
                let share = j.volume * constants.kernel.value(distance) * own.modulus;
                energy +=
                    s_i * (0.5 * i.volume * (here.excess * here.excess) * share / here.fraction);
            }
        }
        let depth = 1.0 - distance / own.core_radius;
        if depth > 0.0 {
            let volume = view.core_volume([i, j]);
            let stress = own.core_modulus * volume;
            let mean = pair.mean_stiffening();
            core = mean * stress * depth / own.core_radius;
            let approach = separation.approach().max(0.0);
            drag += own.core_viscosity * volume * depth * (approach * approach);
            // Half of the pair's energy stands on each side.
            energy += s_i * (0.25 * stress * (depth * depth));
            *stiffness += mean * 2.0 * stress / (own.core_radius * own.core_radius);
        }
        if drag > 0.0 {
            drag = drag.min(most_drag(pair, slope));
        }
        let force = if own.along_normal {
            // The core has no use for normals: it keeps lone particles apart.
            let bulk = pair.along(bulk, true);
            let core = separation.along(core);
            [bulk[0] + core[0], bulk[1] + core[1], bulk[2] + core[2]]
        } else {
            separation.along(bulk + core)
        };
        Some(PairForce {
            force,
            drag,
            energy,
            loads: [
                own_force(view, [i, j], separation, here),
                own_force(view, [j, i], separation, there),
            ],
        })
    }

    /// The normal is that which i sees less the mean of those that its neighbours see, weighted
    /// with `o_ij`.
    fn normal_load(
        view: &ContactView,
        i: &ContactParticle,
        neighbours: &[u32],
        load: &mut NormalLoad,
    ) {
        let here = Self::side(view, i);
        let normal = |of: &ContactParticle| {
            let mut normal = view.shown(of, &view.particles.contact_normal[of.slot]);
            view.mirror(&mut normal);
            normal
        };
        let mut sum = 0.0;
        for (_, j) in view.others(i, neighbours) {
            let pair = view.table.pair(i.size_class, j.size_class);
            if !pair.friction.is_any() {
                continue;
            }
            let separation = Separation::between(i, &j);
            let own = own_force(view, [i, &j], &separation, &here);
            let mut along = separation.along(own);
            view.mirror(&mut along);
            load.add(pair, [i, &j], own, &along);
            load.face(-own, &normal(&j));
            sum += own;
        }
        load.face(sum, &normal(i));
    }
}

/// `a_ij = M̄_i E_i [1 − (C*_ij − C̄_i)/S_i] + ½ E_i² (M_ij − M̄_i)/S_i` (Pa): derivative of
/// particle i's energy by its fraction of j, per volume of i.
fn slope_of_energy(i: &Fraction, pair: &OverlapPair) -> f64 {
    if i.excess == 0.0 {
        return 0.0;
    }
    let stress = i.modulus * i.excess;
    let steeper = 0.5 * (i.excess * i.excess) * (pair.modulus - i.modulus);
    stress + (steeper - stress * (pair.touching - i.touching)) / i.fraction
}

/// The pair force of i's own energy, `o_ij = V_i V_j ⟨a_ij⟩₊ |∇W_ij|` and half of the core (N):
/// what friction of the pair rests on from i's side.
fn own_force(
    view: &ContactView,
    [i, j]: [&ContactParticle; 2],
    separation: &Separation,
    here: &Fraction,
) -> f64 {
    let (pair, own) = constants(view, i, j);
    let stiffening = view.stiffening(i);
    let slope = -pair.kernel.slope(separation.distance);
    let bulk = i.volume * j.volume * slope_of_energy(here, own).max(0.0) * slope;
    let depth = (1.0 - separation.distance / own.core_radius).max(0.0);
    let stress = own.core_modulus * view.core_volume([i, j]);
    stiffening * (bulk + 0.5 * stress * depth / own.core_radius)
}

/// `B ρ' ṙ² V_i V_j |∇W_ij| min(1, (E_i + E_j)/E_0) min(1, λ_i + λ_j)` of a pair that approaches (N).
#[inline(always)]
fn isolated_drag(pair: &ParticlePair<Overlap>, slope: f64) -> f64 {
    let (here, there) = (&pair.here, &pair.there);
    let isolation = here.isolation + there.isolation;
    if isolation == 0.0 {
        return 0.0;
    }
    let share = isolation.min(1.0) * (here.excess + there.excess).min(WHOLE_EXCESS);
    let approach = pair.separation.approach().max(0.0);
    let volumes = pair.i.volume * pair.j.volume;
    pair.own.isolated_viscosity * share * volumes * slope * (approach * approach)
}

/// The viscosity (N) of a pair that stops its approach within a step: half of it at the end of the one that led here, before which the
/// two may have been out of reach of each other, half in the next one. `w μ ṙ/Δt` with the reduced mass μ and the share `w = min(V_j |∇W_ij|/g_i, V_i |∇W_ij|/g_j)`, of which a particle's sum
/// over its neighbours is one at most.
#[inline(always)]
fn most_drag(pair: &ParticlePair<Overlap>, slope: f64) -> f64 {
    let (view, dt) = (pair.view, pair.view.dt);
    if dt == 0.0 {
        return f64::INFINITY;
    }
    let (pairs, [v_i, v_j], [m_i, m_j]) = view.meeting([pair.i, pair.j]);
    let share = |side: &Fraction, volume: f64| {
        if side.slope > 0.0 {
            (volume * slope / side.slope).min(1.0)
        } else {
            1.0
        }
    };
    let share = share(&pair.here, v_j).min(share(&pair.there, v_i));
    let approach = pair.separation.approach().max(0.0);
    pairs * (share * (m_i * m_j / (m_i + m_j)) * approach / dt)
}

/// A pair's part of `k_i = 2 M V_i Σ_j V_j [(g_i + g_j)|∇W_ij| + (E_i + E_j)|W″_ij|]` (N/m), with
/// `g` counted where there is excess and `slope` for `|∇W_ij|`.
#[inline(always)]
fn bulk_stiffness(pair: &ParticlePair<Overlap>, slope: f64) -> f64 {
    let (here, there) = (&pair.here, &pair.there);
    let curvature = pair
        .constants
        .kernel
        .curvature(pair.separation.distance)
        .abs();
    let active = |f: &Fraction| if f.excess > 0.0 { f.slope } else { 0.0 };
    let steep = (active(here) + active(there)) * slope;
    let bent = (here.excess + there.excess) * curvature;
    let modulus = pair.own.modulus * pair.stiffening[0].max(pair.stiffening[1]);
    2.0 * modulus * pair.i.volume * pair.j.volume * (steep + bent)
}
