//! Brittle fracture by the growth of cracks from flaws that are spread at random.
//!
//! `n(ε) = k ε^m` flaws in a unit of volume are active at a strain ε (Weibull 1939). The strain of
//! a point is that of its largest principal tension, `ε = σ₁/[(1 − D) E]`, and while it exceeds that
//! of its weakest flaw the n flaws that have become active grow at the crack speed `c_g`,
//!
//! ```text
//! dD^{1/3}/dt = n^{1/3} c_g/R,
//! ```
//!
//! since n cracks of radius a take `D = n (a/R)³` of a sphere of radius R: Grady & Kipp (1980),
//! *Continuum modelling of explosive fracture in oil shale*, Int. J. Rock Mech. Min. Sci. 17, 147.
//! Codes differ here: others let D^{1/3} grow with n or with n/N. Shear and tension scale with
//! 1 − D.
//!
//! **Flaws** of a particle of the reference volume V are a Poisson process in `x = k V ε^m`, with a
//! rate of one: thresholds are `x_1 = E_1, x_2 = x_1 + E_2, …` where the E are exponential draws of
//! (seed, id of the particle, number of the flaw). They are the same on any ranks, there is no list
//! of them, and particles twice as large have twice as many. (Benz & Asphaug 1994, *Impact
//! simulations with fracture*, Icarus 107, 98, hand flaws to particles one after the other.) Beyond
//! [`DRAWN`] of them the count is x itself, whose scatter is a thousandth there and less.
//!
//! Constants that were fitted with particles of some size hold for that size: a particle without an active flaw bears
//! any tension, since no crack of a neighbour grows into it, so smaller ones are stronger by `Δp^{−3/m}` without end. So none
//! counts as smaller than a least size.
//!
//! **R** is that of the particle's own sphere, `(3V/4π)^{1/3}`, for which the point obeys Grady and
//! Kipp's law with `α' = 36π c_g³ k/(m + 3)³`; or, as in other codes, of the support of the kernel
//! at h = 1.3 Δp, which a crack then has to cross: the growth is slower and the strength larger, by
//! 73.6^{1/(m+3)}.

use serde::Deserialize;

use super::failure::FAILED;
use super::principal_tension::{may_exceed, pull};
use super::{Conditions, LANES, Law, PointBatch};
use crate::{at_least, at_most};
use numerics::counter::exponential;

/// Flaws of a particle that are drawn one by one.
const DRAWN: f64 = 1000.0;
/// Support of the kernel over the edge of a particle, at h = 1.3 Δp.
const SUPPORT: f64 = 2.6;
/// Radius of the sphere of a cube's volume over the cube's edge, `(3/4π)^{1/3}`.
const RADIUS: f64 = 0.620_350_490_899_400_1;
/// Key of the draws of flaws.
const FLAWS: u64 = 0x464C_4157;

/// Extent of a crack when its particle fails.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Crosses {
    /// The particle.
    #[default]
    Particle,
    /// The support of its kernel.
    Support,
}

impl Crosses {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Particle => "particle",
            Self::Support => "support",
        }
    }
}

/// Number of active flaws.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Flaws {
    /// As many as have been drawn.
    #[default]
    Drawn,
    /// `k V ε^m`, a fraction too.
    Continuous,
}

impl Flaws {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Drawn => "drawn",
            Self::Continuous => "continuous",
        }
    }
}

law! {
    /// Growth of cracks from flaws.
    GradyKipp {
        /// Coefficient k of Weibull's distribution (1/m³).
        k: "1/m^3",
        /// Exponent m of Weibull's distribution.
        m: "",
        /// Crack speed over the longitudinal sound speed of the reference state.
        crack_speed: "",
        /// Extent of a crack.
        crosses: Crosses,
        /// Number of active flaws.
        flaws: Flaws,
        /// Flaws of a particle: damage is `n/N` at most as long as n of N are active. Zero for no
        /// such limit.
        most_flaws: "",
        /// Edge (m) of the smallest cube that flaws are drawn for: smaller particles have the flaws, and the way of
        /// cracks, of one.
        least_size: "m",
    }
}

impl GradyKipp {
    /// Draws the weakest flaw of lane `k`, if that has not been done: `scale` is `k V`.
    #[inline(always)]
    fn begin(&self, point: &mut PointBatch, k: usize, scale: f64, seed: u32) {
        if self.flaws == Flaws::Drawn && point.first_flaw[k] == 0.0 {
            let x = flaw(seed, point.id[k], 0.0);
            point.first_flaw[k] = libm::pow(x / scale, 1.0 / self.m);
            point.next_flaw[k] = point.first_flaw[k];
        }
    }

    /// Active flaws of lane `k` at a strain; those that are newly active are counted.
    #[inline(always)]
    fn activate(
        &self,
        point: &mut PointBatch,
        k: usize,
        strain: f64,
        scale: f64,
        seed: u32,
    ) -> f64 {
        let x = |strain: f64| scale * libm::pow(strain, self.m);
        if self.flaws == Flaws::Continuous || point.flaws[k] >= DRAWN {
            point.flaws[k] = at_least(point.flaws[k], x(strain));
        } else if strain >= point.next_flaw[k] {
            let (now, mut next, mut n) = (x(strain), x(point.next_flaw[k]), point.flaws[k]);
            while now >= next && n < DRAWN {
                n += 1.0;
                next += flaw(seed, point.id[k], n);
            }
            point.flaws[k] = n;
            point.next_flaw[k] = libm::pow(next / scale, 1.0 / self.m);
        }
        point.flaws[k]
    }
}

/// Delay of the flaw of this number after the one before, in flaws expected.
#[inline(always)]
fn flaw(seed: u32, id: u64, number: f64) -> f64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 1000 at most
    let number = number as u64;
    exponential([u64::from(seed), FLAWS, id, number])
}

impl Law for GradyKipp {
    const STATE: &'static [&'static str] = &[
        "deviatoric_stress",
        "damage",
        "failure_energy",
        "flaws",
        "first_flaw",
        "next_flaw",
    ];
    const FOLLOWS_STATE: bool = true;
    const ASKS_IDENTITY: bool = true;

    /// Lane by lane: only what is under tension is damaged.
    #[inline(never)]
    fn fail(&self, point: &mut PointBatch, now: &Conditions) {
        let g = now.reference_shear_modulus;
        let bulk = now.bulk_modulus;
        let young = 9.0 * bulk * g / (3.0 * bulk + g);
        let longitudinal = ((bulk + g * (4.0 / 3.0)) / now.reference_density).sqrt();
        for k in 0..LANES {
            let damage = point.damage[k];
            let stiffness = now.kept[k] * young;
            if damage >= FAILED || !may_exceed(point, k, point.first_flaw[k] * stiffness) {
                continue;
            }
            let size = at_least(now.size(point, k), self.least_size);
            let (scale, seed) = (self.k * size * size * size, now.options.seed);
            self.begin(point, k, scale, seed);
            // The weakest flaw is active as long as the strain is that of it.
            let first = point.first_flaw[k];
            if !may_exceed(point, k, first * stiffness) {
                continue;
            }
            let strain = pull(point, k, now) / stiffness;
            if strain <= 0.0 || strain < first {
                continue;
            }
            let n = self.activate(point, k, strain, scale, seed);
            let reach = match self.crosses {
                Crosses::Particle => size * RADIUS,
                Crosses::Support => size * SUPPORT,
            };
            let growth = libm::cbrt(n) * self.crack_speed * longitudinal / reach * now.dt;
            let edge = libm::cbrt(damage) + growth;
            let mut most = FAILED;
            if self.most_flaws > 0.0 {
                most = at_most(n / self.most_flaws, FAILED);
            }
            let grown = at_most(edge * edge * edge, most);
            point.damage[k] = at_least(damage, grown);
        }
    }
}
