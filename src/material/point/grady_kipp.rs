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
//! **R** is that of the particle's own sphere, `(3V/4π)^{1/3}`, for which the point obeys Grady and
//! Kipp's law with `α' = 36π c_g³ k/(m + 3)³`; or, as in other codes, of the support of the kernel
//! at h = 1.3 Δp, which a crack then has to cross: the growth is slower and the strength larger, by
//! 73.6^{1/(m+3)}.

use serde::Deserialize;

use super::damage::FAILED;
use super::principal_tension::{largest, may_exceed};
use super::{Conditions, LANES, Law, PointBatch};
use crate::material::{at_least, at_most};
use crate::numerics::counter::exponential;

/// Flaws of a particle that are drawn one by one.
const DRAWN: f64 = 1000.0;
/// Support of the kernel over the edge of a particle, at h = 1.3 Δp.
const SUPPORT: f64 = 2.6;
/// Radius of the sphere of a cube's volume over the cube's edge, `(3/4π)^{1/3}`.
const RADIUS: f64 = 0.620_350_490_899_400_1;
/// Key of the draws of flaws.
const FLAWS: u64 = 0x464C_4157;

/// What a crack crosses when its particle fails.
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

/// How many flaws are active.
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
        /// What a crack crosses.
        crosses: Crosses,
        /// How many flaws are active.
        flaws: Flaws,
        /// Flaws of a particle: damage is `n/N` at most as long as n of N are active. Zero for no
        /// such limit.
        most_flaws: "",
    }
}

impl GradyKipp {
    /// Active flaws of lane `k` at `x = k V ε^m`; those that are newly active are counted.
    #[inline(always)]
    fn activate(&self, point: &mut PointBatch, k: usize, x: f64, seed: u32) -> f64 {
        if self.flaws == Flaws::Continuous {
            point.flaws[k] = at_least(point.flaws[k], x);
            return point.flaws[k];
        }
        let draw = |number: f64| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 1000 at most
            let number = number as u64;
            exponential([u64::from(seed), FLAWS, point.id[k], number])
        };
        let (mut n, mut next) = (point.flaws[k], point.next_flaw[k]);
        if next == 0.0 {
            next = draw(0.0);
        }
        while x >= next && n < DRAWN {
            n += 1.0;
            next += draw(n);
        }
        if n >= DRAWN {
            n = at_least(n, x);
        }
        (point.flaws[k], point.next_flaw[k]) = (n, next);
        n
    }
}

impl Law for GradyKipp {
    const STATE: &'static [&'static str] = &[
        "deviatoric_stress",
        "damage",
        "failure_energy",
        "flaws",
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
            if !(damage < FAILED && may_exceed(point, k, 0.0)) {
                continue;
            }
            let strain = largest(point, k) / (now.kept[k] * young);
            if strain <= 0.0 {
                continue;
            }
            let size = now.size(point, k);
            let volume = size * size * size;
            let x = self.k * volume * libm::pow(strain, self.m);
            let n = self.activate(point, k, x, now.manner.seed);
            // The weakest flaw stays active while the strain is that of it.
            let first = match self.flaws {
                Flaws::Continuous => 0.0,
                Flaws::Drawn => exponential([u64::from(now.manner.seed), FLAWS, point.id[k], 0]),
            };
            if n == 0.0 || x < first {
                continue;
            }
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
