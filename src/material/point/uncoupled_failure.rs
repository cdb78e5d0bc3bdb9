//! Yarns and walls that tear: shares of the members along each direction, the weakest first.
//!
//! Members along direction i tear from their strength on, as bundles of threads do (Daniels 1945, Proc. R. Soc. A 183, 405): what is torn is gone, the
//! rest is elastic from its first length on. With the stretch ε of members and their Young's modulus E the traction falls linearly,
//!
//! ```text
//! (1 − d) E ε = t (ε_f − ε)/(ε_f − ε_t),    ε_t = t/E,    ε_f = 2 G/(L t)
//! ```
//!
//! so that all are torn once they have taken the energy G over the size L of the particle (Bažant & Oh 1983); what holds more at its strength
//! tears at once. Torn shares never heal: they are those of the largest stretch so far. A stretch ε has taken
//! `½ (t ε − (1 − d) E ε ε_t)` for good.
//!
//! Matter without members along any direction has failed, and so has spray.

use super::damage::SPRAY;
use super::orthotropic::{bear, frame, held_strain};
use super::uncoupled::{mean, of_members};
use super::{Conditions, FAILED, LANES, Lanes, Law, PointBatch};
use crate::{at_least, at_most};

law! {
    /// Strengths of members along three directions. Zero stands for no limit, of an energy for tearing at once.
    UncoupledFailure {
        /// Strength against tension along direction 1 (Pa).
        t1: "Pa",
        /// Strength against tension along direction 2 (Pa).
        t2: "Pa",
        /// Strength against tension along direction 3 (Pa).
        t3: "Pa",
        /// Energy that tears the members along direction 1 (J/m²).
        gf1: "J/m^2",
        /// Energy that tears those along direction 2 (J/m²).
        gf2: "J/m^2",
        /// Energy that tears those along direction 3 (J/m²).
        gf3: "J/m^2",
    }
}

/// How members along one direction tear.
struct Tear {
    /// Strength (Pa).
    strength: f64,
    /// Stretches at which the first and the last of them tear.
    first: f64,
    last: f64,
}

impl Tear {
    /// Share that is left at a stretch beyond the first.
    fn left(&self, stretch: f64) -> f64 {
        if stretch >= self.last {
            0.0
        } else {
            self.first * (self.last - stretch) / (stretch * (self.last - self.first))
        }
    }

    /// Largest stretch of members of which a share is left.
    fn stretch(&self, left: f64) -> f64 {
        self.first * self.last / (left * (self.last - self.first) + self.first)
    }

    /// Energy (J/m³) that tearing has taken once a share is left.
    fn taken(&self, left: f64) -> f64 {
        0.5 * self.strength * self.stretch(left) * (1.0 - left)
    }
}

/// Torn share of members along direction i.
#[inline(always)]
fn share(point: &mut PointBatch, i: usize) -> &mut Lanes {
    match i {
        0 => &mut point.fibre_damage,
        1 => &mut point.matrix_damage,
        _ => &mut point.delamination,
    }
}

impl UncoupledFailure {
    /// Tears members of lane k.
    fn advance(&self, point: &mut PointBatch, k: usize, now: &Conditions) {
        let axes = frame(point, k);
        let strain = held_strain(point, k, &axes);
        let before = of_members(point, k, now, &strain);
        let (strengths, energies) = ([self.t1, self.t2, self.t3], [self.gf1, self.gf2, self.gf3]);
        let (mut tears, mut least) = (false, FAILED);
        for i in 0..3 {
            let modulus = now.members.stretch[i];
            if modulus == 0.0 {
                continue;
            }
            let (strength, torn) = (strengths[i], share(point, i)[k]);
            if strength > 0.0 && modulus * strain[i] > strength {
                let first = strength / modulus;
                let all = 2.0 * energies[i] / (now.size(point, k) * strength);
                let last = at_least(all, first);
                let tear = Tear {
                    strength,
                    first,
                    last,
                };
                let left = at_most(tear.left(strain[i]), 1.0 - torn);
                if left < 1.0 - torn {
                    let taken = tear.taken(left) - tear.taken(1.0 - torn);
                    point.failure_energy[k] += taken / now.bearing_density;
                    share(point, i)[k] = 1.0 - left;
                    tears = true;
                }
            }
            least = at_most(least, share(point, i)[k]);
        }
        if !tears {
            return;
        }
        point.damage[k] = at_least(point.damage[k], least);
        let after = of_members(point, k, now, &strain);
        point.pressure[k] += mean(&before) - mean(&after);
        bear(point, k, &axes, &after);
    }
}

impl Law for UncoupledFailure {
    const STATE: &'static [&'static str] = &[
        "deviatoric_stress",
        "damage",
        "failure_energy",
        "fibre_damage",
        "matrix_damage",
        "delamination",
    ];
    const FOLLOWS_STATE: bool = true;
    const ASKS_IDENTITY: bool = true;

    #[inline(never)]
    fn fail(&self, point: &mut PointBatch, now: &Conditions) {
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
