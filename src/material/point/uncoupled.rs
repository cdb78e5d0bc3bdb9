//! Yarns of cloth and walls of cells: members along three directions that know nothing of each other, in matter with pores.
//!
//! Members along direction i bear their own stretch alone. Pressed, they crush at a plateau; without one they buckle and bear nothing, and are
//! taut again once they have their length:
//!
//! ```text
//! τ_i = (1 − d_i) E_i ⟨ε_i⟩ − min(E_i ⟨−ε_i⟩, c_i ρ₀/ρ),    τ_ij = 2 G_ij ε_ij,    |τ_ij| ≤ s_ij [1 − max(d_i, d_j)]
//! σ = (ρ/ρ_m) τ − ⟨p(ρ, e)⟩ I
//! ```
//!
//! with the elastic strain ε in the frame of the directions, the torn shares `d_i` and the density `ρ_m` that the constants belong to. So a yarn
//! pulls with the same force however thin the cloth has been pressed, and walls that are pressed along themselves crush at the same stress all the way. The energy of members is
//! `[½ (1 − d_i) E_i ⟨ε_i⟩² + …]/ρ_m` for each mass, and no closed path of strain gives any. The matter between has pressure alone, that
//! of the law of compaction: `⟨p⟩` bears no tension.
//!
//! Uncoupled directions up to dense matter are how honeycombs are mostly described: Whirley & Engelmann (1993), *DYNA3D: a nonlinear, explicit,
//! three-dimensional finite element code*, UCRL-MA-107254, material type 26. Frame and strain are those of [`orthotropic`](super::orthotropic).

use super::orthotropic::{bear, equivalent_squared, frame, held_strain, hold_strain, strain};
use super::{Conditions, Contradiction, FAILED, LANES, Law, PointBatch, Stiffness};
use crate::{at_least, at_most};

law! {
    /// Members along three directions, which know nothing of each other. Zero stands for none at all.
    Uncoupled {
        /// Young's modulus of members along direction 1 (Pa).
        e1: "Pa",
        /// Young's modulus of those along direction 2 (Pa).
        e2: "Pa",
        /// Young's modulus of those along direction 3 (Pa).
        e3: "Pa",
        /// Shear modulus of 1 and 2 (Pa).
        g12: "Pa",
        /// Shear modulus of 1 and 3 (Pa).
        g13: "Pa",
        /// Shear modulus of 2 and 3 (Pa).
        g23: "Pa",
        /// Stress at which members along direction 1 crush (Pa).
        c1: "Pa",
        /// Stress at which those along direction 2 crush (Pa).
        c2: "Pa",
        /// Stress at which those along direction 3 crush (Pa).
        c3: "Pa",
        /// Strength against shear of 1 and 2 (Pa).
        s12: "Pa",
        /// Strength against shear of 1 and 3 (Pa).
        s13: "Pa",
        /// Strength against shear of 2 and 3 (Pa).
        s23: "Pa",
    }
}

/// Planes `12 13 23` by their two directions.
const PLANES: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

/// What members bear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Members {
    /// Young's moduli along the directions (Pa).
    pub stretch: [f64; 3],
    /// Shear moduli of the planes 12, 13, 23 (Pa).
    pub shear: [f64; 3],
    /// Stresses at which they crush (Pa).
    pub crush: [f64; 3],
    /// Strengths against shear of the planes (Pa).
    pub slip: [f64; 3],
}

impl Members {
    /// None at all.
    pub const NONE: Self = Self {
        stretch: [0.0; 3],
        shear: [0.0; 3],
        crush: [0.0; 3],
        slip: [0.0; 3],
    };

    /// Stress `11 22 33 12 13 23` (Pa, at the density of the constants) of an elastic strain of the same components, of members of which shares
    /// are torn.
    #[inline(always)]
    #[must_use]
    pub fn stress(&self, strain: &[f64; 6], torn: &[f64; 3]) -> [f64; 6] {
        let mut stress = [0.0; 6];
        for i in 0..3 {
            let pull = self.stretch[i] * strain[i];
            let kept = if strain[i] > 0.0 {
                1.0 - torn[i]
            } else if self.crush[i] > 0.0 {
                1.0
            } else {
                0.0
            };
            stress[i] = kept * pull;
            stress[3 + i] = 2.0 * self.shear[i] * strain[3 + i];
        }
        stress
    }

    /// Returns an elastic strain to what members bear, of matter of a volume over that of the reference state, and tells the work (J/m³)
    /// that it takes.
    #[inline(always)]
    fn give_way(&self, strain: &mut [f64; 6], torn: &[f64; 3], volume: f64) -> f64 {
        let volume = at_most(volume, 1.0);
        let mut work = 0.0;
        for i in 0..3 {
            let crush = self.crush[i] * volume;
            let beyond = -self.stretch[i] * strain[i] - crush;
            if self.crush[i] > 0.0 && beyond > 0.0 {
                let flow = beyond / self.stretch[i];
                strain[i] += flow;
                work += crush * flow;
            }
        }
        for (plane, [i, j]) in PLANES.into_iter().enumerate() {
            let (modulus, held) = (2.0 * self.shear[plane], strain[3 + plane]);
            let strength = self.slip[plane] * (1.0 - at_least(torn[i], torn[j]));
            let beyond = modulus * held.abs() - strength;
            if beyond > 0.0 {
                let flow = beyond / modulus;
                strain[3 + plane] -= flow * held.signum();
                work += 2.0 * strength * flow;
            }
        }
        work
    }
}

/// Torn shares of the members of lane k.
#[inline(always)]
pub(super) fn torn(point: &PointBatch, k: usize) -> [f64; 3] {
    if point.damage[k] >= FAILED {
        return [1.0; 3];
    }
    [
        point.fibre_damage[k],
        point.matrix_damage[k],
        point.delamination[k],
    ]
}

/// Stress (Pa) of the members of lane k in their frame; none of what has failed.
#[inline(always)]
pub(super) fn of_members(
    point: &PointBatch,
    k: usize,
    now: &Conditions,
    strain: &[f64; 6],
) -> [f64; 6] {
    if point.damage[k] >= FAILED {
        return [0.0; 6];
    }
    let share = point.density[k] / now.bearing_density;
    now.members
        .stress(strain, &torn(point, k))
        .map(|component| share * component)
}

/// Mean of the normal stresses.
#[inline(always)]
pub(super) fn mean(stress: &[f64; 6]) -> f64 {
    (stress[0] + stress[1] + stress[2]) * (1.0 / 3.0)
}

impl Uncoupled {
    /// What members bear.
    #[inline(always)]
    #[must_use]
    pub fn members(&self) -> Members {
        Members {
            stretch: [self.e1, self.e2, self.e3],
            shear: [self.g12, self.g13, self.g23],
            crush: [self.c1, self.c2, self.c3],
            slip: [self.s12, self.s13, self.s23],
        }
    }
}

impl Law for Uncoupled {
    const STATE: &'static [&'static str] = &[
        "deviatoric_stress",
        "plastic_strain",
        "fibre",
        "normal",
        "elastic_strain",
    ];
    const FOLLOWS_STATE: bool = true;
    const BOUNDS_TENSION: bool = true;

    fn contradiction(&self) -> Option<Contradiction> {
        let Members {
            stretch,
            shear,
            crush,
            slip,
        } = self.members();
        let of_crush: [&'static [&'static str]; 3] = [&["c1"], &["c2"], &["c3"]];
        let of_slip: [&'static [&'static str]; 3] = [&["s12"], &["s13"], &["s23"]];
        for i in 0..3 {
            if crush[i] > 0.0 && stretch[i] == 0.0 {
                return Some(Contradiction {
                    keys: of_crush[i],
                    title: "nothing crushes along a direction without members: give it a Young's modulus",
                });
            }
            if slip[i] > 0.0 && shear[i] == 0.0 {
                return Some(Contradiction {
                    keys: of_slip[i],
                    title: "a strength against shear needs the shear modulus of its plane",
                });
            }
        }
        None
    }

    /// That beside the pressure of pores, whatever their modulus: waves along one direction are the stiffest.
    #[inline(always)]
    fn shear_modulus(&self) -> f64 {
        let [a, b, c] = [self.e1, self.e2, self.e3];
        let stiffness = Stiffness {
            stretch: [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]],
            shear: [self.g12, self.g13, self.g23],
            volume: 0.0,
        };
        0.75 * stiffness.wave_modulus()
    }

    fn yield_stress(&self) -> f64 {
        let most = self.c1.max(self.c2).max(self.c3);
        if most > 0.0 { most } else { f64::INFINITY }
    }

    /// The matter between members bears no tension.
    #[inline(always)]
    fn limit_tension(&self, point: &mut PointBatch, _softens: bool) {
        for pressure in &mut point.pressure {
            *pressure = at_least(*pressure, 0.0);
        }
    }

    #[inline(always)]
    fn soften(&self, _point: &PointBatch, now: &mut Conditions) {
        now.members = self.members();
    }

    #[inline(never)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        for k in 0..LANES {
            let mut work = 0.0;
            if now.dt != 0.0 {
                strain(point, k, now.dt);
            }
            let axes = frame(point, k);
            let mut held = held_strain(point, k, &axes);
            if now.dt != 0.0 && point.damage[k] < FAILED {
                let volume = now.reference_density / point.density[k];
                work = now.members.give_way(&mut held, &torn(point, k), volume);
                if work > 0.0 {
                    hold_strain(point, k, &axes, &held);
                }
            }
            let stress = of_members(point, k, now, &held);
            if now.dt != 0.0 {
                bear(point, k, &axes, &stress);
            }
            point.pressure[k] -= mean(&stress);
            let share = point.density[k] / now.bearing_density;
            let equivalent = equivalent_squared(&stress).sqrt();
            if work > 0.0 && equivalent > 0.0 {
                point.plastic_strain[k] += share * work / equivalent;
            }
            now.shear_modulus[k] *= share;
        }
    }
}
