//! Cracks across the directions of matter that has some of its own: broken fibres, split layers, delamination.
//!
//! A crack across direction i begins where the tractions on it reach their strengths,
//!
//! ```text
//! f_i² = (⟨σ_i⟩/T_i)² + (τ_ij/S_ij)² + (τ_ik/S_ik)² = 1        (hashin)
//! f_i  = max(⟨σ_i⟩/T_i, |τ|/S)                                 (maximum_stress)
//! ```
//!
//! In the second one shear of the plane 12 counts for direction 2, that of 13 and 23 for 3. Fibres along 1 break by shear only
//! beside tension. Sources: Hashin (1980), *Failure criteria for unidirectional fiber composites*, J. Appl. Mech. 47, 329; for all
//! three directions, with softening, Clegg et al. (2006), Int. J. Impact Eng. 33, 190.
//!
//! From there on the tractions fall with the energy that the crack has taken, `G_i` over the size L of the particle when they
//! are gone, as those of a band that softens linearly (Bažant & Oh 1983): with damage d, `f_i ≤ 1 − d` and
//!
//! ```text
//! (1 − d)² = 1 − W L/G_i,    dW = ½ (1 − λ²) (⟨σ_i⟩²/C_ii + τ_ij²/G_ij + τ_ik²/G_ik)
//! ```
//!
//! where a step leaves λ of the tractions. What they lose, strain of cracks takes over from the elastic strain; that across the
//! crack is its *opening*, which closes without stress before the crack bears pressure again. It is in the density of the whole
//! and not in that of the matter: with `φ = exp(−Σ o_i)` the stress is φ times that of the matter, at the density ρ/φ. Shear over an open or closed crack that has
//! taken all of `G_i` is zero: there is no friction.
//!
//! Matter with cracks across all three directions has failed, and so has what they have opened to spray.

use serde::Deserialize;

use super::damage::SPRAY;
use super::orthotropic::{bear, frame, held_strain, hold_strain, solid_share};
use super::{Conditions, FAILED, LANES, Lanes, Law, PointBatch};
use crate::{at_least, at_most};

/// How strengths against tension and shear go together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Criterion {
    /// The sum of their squares.
    #[default]
    Hashin,
    /// Each for itself.
    MaximumStress,
}

impl Criterion {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Hashin => "hashin",
            Self::MaximumStress => "maximum_stress",
        }
    }
}

law! {
    /// Cracks across the directions of the matter. Zero stands for no limit, of an energy for failure at once.
    Hashin {
        /// Strength against tension along direction 1 (Pa).
        t1: "Pa",
        /// Strength against tension along direction 2 (Pa).
        t2: "Pa",
        /// Strength against tension along direction 3 (Pa).
        t3: "Pa",
        /// Strength against shear of 1 and 2 (Pa).
        s12: "Pa",
        /// Strength against shear of 1 and 3 (Pa).
        s13: "Pa",
        /// Strength against shear of 2 and 3 (Pa).
        s23: "Pa",
        /// Energy of a crack across direction 1 (J/m²).
        gf1: "J/m^2",
        /// Energy of a crack across direction 2 (J/m²).
        gf2: "J/m^2",
        /// Energy of a crack across direction 3 (J/m²).
        gf3: "J/m^2",
        /// How tension and shear go together.
        criterion: Criterion,
    }
}

/// Components of a symmetric tensor `11 22 33 12 13 23` that shear the plane across a direction.
const SHEARS: [[usize; 2]; 3] = [[3, 4], [3, 5], [4, 5]];
/// The order in which cracks take from the stress: what is weak first.
const ORDER: [usize; 3] = [2, 1, 0];

/// Stress of the matter of a point in its frame, from its elastic strain.
struct Cracked<'a> {
    now: &'a Conditions,
    /// Elastic strain `11 22 33 12 13 23`.
    strain: [f64; 6],
    /// Pressure (Pa).
    pressure: f64,
}

impl Cracked<'_> {
    /// Stress `11 22 33 12 13 23` (Pa).
    fn stress(&self) -> [f64; 6] {
        let mut stress = self.now.stiffness.stress(&self.strain);
        let mean = (stress[0] + stress[1] + stress[2]) * (1.0 / 3.0);
        for normal in &mut stress[..3] {
            *normal -= mean + self.pressure;
        }
        stress
    }

    /// Lets a crack across direction i take over a stretch.
    fn open(&mut self, i: usize, stretch: f64) {
        let before = self.mean();
        self.strain[i] -= stretch;
        self.pressure += before - self.mean() + self.now.stiffness.volume * stretch;
    }

    /// Mean of the normal stresses (Pa), without the pressure of the equation of state.
    fn mean(&self) -> f64 {
        let stress = self.now.stiffness.stress(&self.strain);
        (stress[0] + stress[1] + stress[2]) * (1.0 / 3.0)
    }
}

/// Strains of open cracks across direction i.
#[inline(always)]
fn opening(point: &mut PointBatch, i: usize) -> &mut Lanes {
    match i {
        0 => &mut point.opening_1,
        1 => &mut point.opening_2,
        _ => &mut point.opening_3,
    }
}

/// Damage by cracks across direction i.
#[inline(always)]
fn crack(point: &mut PointBatch, i: usize) -> &mut Lanes {
    match i {
        0 => &mut point.fibre_damage,
        1 => &mut point.matrix_damage,
        _ => &mut point.delamination,
    }
}

/// A stress over its strength, which is without limit if that is zero.
#[inline(always)]
fn over(stress: f64, strength: f64) -> f64 {
    if strength > 0.0 {
        stress.abs() / strength
    } else {
        0.0
    }
}

/// Of shears over their strengths across direction i, the one that counts by itself.
#[inline(always)]
fn largest_shear(i: usize, [first, second]: [f64; 2]) -> f64 {
    match i {
        0 => 0.0,
        1 => first,
        _ => at_least(first, second),
    }
}

impl Hashin {
    /// How near to their strengths tractions (Pa) across direction i are: `⟨σ_i⟩` and those of shear.
    fn progress(&self, i: usize, normal: f64, stress: &[f64; 6]) -> f64 {
        let pull = over(normal, [self.t1, self.t2, self.t3][i]);
        let strengths = [self.s12, self.s13, self.s23];
        let [a, b] = SHEARS[i];
        let shear = [
            over(stress[a], strengths[a - 3]),
            over(stress[b], strengths[b - 3]),
        ];
        match self.criterion {
            Criterion::Hashin => (pull * pull + shear[0] * shear[0] + shear[1] * shear[1]).sqrt(),
            Criterion::MaximumStress => at_least(pull, largest_shear(i, shear)),
        }
    }

    /// Opens and closes the cracks of lane k.
    fn advance(&self, point: &mut PointBatch, k: usize, now: &Conditions) {
        let (axes, share) = (frame(point, k), solid_share(point, k));
        let mut of = Cracked {
            now,
            strain: held_strain(point, k, &axes),
            pressure: point.pressure[k] / share,
        };
        let mut changed = false;
        for i in ORDER {
            if opening(point, i)[k] <= 0.0 {
                continue;
            }
            let normal = of.stress()[i];
            if normal < 0.0 {
                let stretch = at_most(opening(point, i)[k], -normal / now.stiffness.stretch[i][i]);
                opening(point, i)[k] -= stretch;
                of.open(i, -stretch);
                changed = true;
            }
        }
        let mut stress = of.stress();
        for i in ORDER {
            if self.part(&mut of, point, k, i, &stress) {
                stress = of.stress();
                changed = true;
            }
        }
        if !changed {
            return;
        }
        hold_strain(point, k, &axes, &of.strain);
        let share = solid_share(point, k);
        point.pressure[k] = of.pressure * share;
        let mut stress = of.stress();
        for component in &mut stress {
            *component *= share;
        }
        bear(point, k, &axes, &stress);
        let least = at_most(
            point.fibre_damage[k],
            at_most(point.matrix_damage[k], point.delamination[k]),
        );
        point.damage[k] = at_least(point.damage[k], least);
    }

    /// Advances the crack across direction i under a stress (Pa); true if it has grown or opened.
    fn part(
        &self,
        of: &mut Cracked,
        point: &mut PointBatch,
        k: usize,
        i: usize,
        stress: &[f64; 6],
    ) -> bool {
        let normal = at_least(stress[i], 0.0);
        if i == 0 && normal == 0.0 {
            return false;
        }
        let left = 1.0 - crack(point, i)[k];
        let progress = self.progress(i, normal, stress);
        if progress <= left {
            return false;
        }
        let stiffness = &of.now.stiffness;
        let across = stiffness.stretch[i][i];
        let mut twice = normal * normal / across;
        for c in SHEARS[i] {
            twice += stress[c] * stress[c] / stiffness.shear[c - 3];
        }
        let all = 2.0 * [self.gf1, self.gf2, self.gf3][i] / of.now.size(point, k);
        // (1 − d)² after the step, where the tractions end on the strengths that are left.
        let square = progress * progress;
        let kept_square = if all > 0.0 && twice / all < square {
            let share = twice / all;
            at_most(
                at_least((left * left - share) / (1.0 - share / square), 0.0),
                left * left,
            )
        } else {
            0.0
        };
        let strength = kept_square.sqrt();
        let kept = strength / progress;
        let stretch = (1.0 - kept) * normal / across;
        of.open(i, stretch);
        for c in SHEARS[i] {
            of.strain[c] *= kept;
        }
        opening(point, i)[k] += stretch;
        crack(point, i)[k] = 1.0 - strength;
        let volume = solid_share(point, k) / point.density[k];
        point.failure_energy[k] += 0.5 * (1.0 - kept * kept) * twice * volume;
        true
    }

    /// Opens and closes all cracks.
    #[inline(never)]
    fn damage(&self, point: &mut PointBatch, now: &Conditions) {
        let spray = SPRAY * now.reference_density;
        for k in 0..LANES {
            if point.density[k] <= spray {
                point.damage[k] = FAILED;
            } else if point.damage[k] < FAILED {
                self.advance(point, k, now);
            }
        }
    }
}

impl Law for Hashin {
    const STATE: &'static [&'static str] = &[
        "deviatoric_stress",
        "damage",
        "failure_energy",
        "elastic_strain",
        "opening_1",
        "opening_2",
        "opening_3",
        "fibre_damage",
        "matrix_damage",
        "delamination",
    ];
    const FOLLOWS_STATE: bool = true;
    const ASKS_IDENTITY: bool = true;

    #[inline(always)]
    fn fail(&self, point: &mut PointBatch, now: &Conditions) {
        self.damage(point, now);
    }
}
