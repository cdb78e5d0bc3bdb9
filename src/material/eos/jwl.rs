//! Jones, Wilkins and Lee's equation of state of the products of an explosive, and its programmed burn.
//!
//! With the relative volume `V = ρ₀/ρ` the products have
//!
//! ```text
//! p = A (1 − ω/(R₁ V)) exp(−R₁ V) + B (1 − ω/(R₂ V)) exp(−R₂ V) + ω ρ e
//! ```
//!
//! (Lee, Hornig & Kury 1968, *Adiabatic expansion of high explosive detonation products*, UCRL-50422;
//! constants in Dobratz & Crawford 1985, *LLNL explosives handbook*, UCRL-52997). The specific energy e
//! includes the energy of detonation: unburnt matter begins with `E₀/ρ₀`. At constant entropy
//! `p = A exp(−R₁ V) + B exp(−R₂ V) + C V^{−(1 + ω)}`.
//!
//! In compression beyond the largest value of the first term, some six times the density of unburnt matter, the terms without
//! e keep their values there: they would fall below zero.
//!
//! # Burn
//!
//! A share F of the matter has burnt. What has not bears pressure as far as a bulk modulus K says so:
//!
//! ```text
//! p = F p_JWL(ρ, e) + (1 − F) K ⟨ρ/ρ₀ − 1⟩₊
//! ```
//!
//! By the program a point begins to burn at its lighting time and has burnt once the detonation of speed D
//! has run a width of w particles on: `F₁ = (t − t_L) D/(w Δp)`. By compression it has burnt as far as it
//! is compressed towards the state of Chapman and Jouguet: `F₂ = (1 − V)/(1 − V_CJ)`, `V_CJ = 1 −
//! p_CJ/(ρ₀ D²)` (Wilkins 1964, *Calculation of elastic-plastic flow*, UCRL-7322). By default F is the larger
//! of both: by the program alone a supported front outruns its lighting times, since it sweeps up what has
//! not been lit. F never falls.
//!
//! The sound speed is that of products whatever the burn, so that steps are short enough for the front.

use serde::Deserialize;

use super::{EquationOfState, PointResponse, Response};
use crate::{Contradiction, LANES, Lanes, PointBatch, at_least, at_most};

/// What burns an explosive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Burn {
    /// The detonation that the case programs, or compression, whichever is first.
    #[default]
    Either,
    /// The detonation that the case programs, alone.
    Programmed,
    /// Compression alone.
    Compression,
}

impl Burn {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Programmed => "programmed",
            Self::Compression => "compression",
            Self::Either => "either",
        }
    }
}

/// Lighting time (s) of matter that no detonation reaches.
pub const UNLIT: f64 = 1e30;

law! {
    /// Products of an explosive, with its burn.
    Jwl {
        /// Coefficient A (Pa).
        a: "Pa",
        /// Coefficient B (Pa).
        b: "Pa",
        /// Exponent R₁.
        r1: "",
        /// Exponent R₂.
        r2: "",
        /// Grüneisen parameter ω.
        omega: "",
        /// Specific energy of detonation e₀, `E₀/ρ₀` (J/kg).
        e0: "J/kg",
        /// Speed D of the detonation (m/s).
        detonation_velocity: "m/s",
        /// Pressure of Chapman and Jouguet (Pa).
        cj_pressure: "Pa",
        /// Bulk modulus K of unburnt matter (Pa); zero for none.
        bulk_modulus: "Pa",
        /// What burns it.
        burn: Burn,
        /// Width w of the programmed burn, in particles.
        width: "",
    }
}

impl Jwl {
    /// Relative volume of the state of Chapman and Jouguet.
    #[must_use]
    pub fn cj_volume(&self, rho0: f64) -> f64 {
        let speed = self.detonation_velocity;
        1.0 - self.cj_pressure / (rho0 * speed * speed)
    }

    /// Relative volume at which the first term is largest, where `ω/R₁ + ω V = R₁ V²`. Products that are denser, six
    /// times the unburnt matter of TNT, keep the cold pressure of it.
    fn least_volume(&self) -> f64 {
        let omega = self.omega;
        (omega + (omega * omega + 4.0 * omega).sqrt()) / (2.0 * self.r1)
    }

    /// Pressure and derivatives of the products at density `rho` and specific energy `e` (J/kg), for the
    /// density `rho0` of the unburnt matter (kg/m³).
    #[must_use]
    #[inline]
    pub fn response(&self, rho0: f64, rho: f64, e: f64) -> PointResponse {
        let (volume, least) = (rho0 / rho, self.least_volume());
        let dense = volume < least;
        let volume = at_least(volume, least);
        let follows = if dense { 0.0 } else { volume / rho };
        // A term and its derivative by the volume.
        let term = |a: f64, r: f64| {
            let fade = a * libm::exp(-r * volume);
            let share = self.omega / (r * volume);
            [
                fade * (1.0 - share),
                fade * (share / volume - r * (1.0 - share)),
            ]
        };
        let ([first, of_first], [second, of_second]) =
            (term(self.a, self.r1), term(self.b, self.r2));
        PointResponse {
            pressure: first + second + self.omega * rho * e,
            dp_drho: self.omega * e - (of_first + of_second) * follows,
            dp_de: self.omega * rho,
        }
    }

    /// Pressure of unburnt matter (Pa).
    #[must_use]
    #[inline]
    pub fn unburnt(&self, rho0: f64, rho: f64) -> f64 {
        self.bulk_modulus * at_least(rho / rho0 - 1.0, 0.0)
    }

    /// Burns a batch for a step `dt` (s) and tells its pressures, with the derivatives of the products; `sizes` are those of
    /// the particles (m).
    #[inline(never)]
    pub(crate) fn burn_batch(
        &self,
        rho0: f64,
        batch: &mut PointBatch,
        dt: f64,
        sizes: &Lanes,
    ) -> Response {
        let span = 1.0 - self.cj_volume(rho0);
        let mut response = Response::default();
        for k in 0..LANES {
            let rho = batch.density[k];
            batch.lighting_time[k] -= dt;
            let mut burnt = batch.burn[k];
            if self.burn != Burn::Compression {
                let time = self.width * sizes[k] / self.detonation_velocity;
                let since = -batch.lighting_time[k];
                if since > 0.0 {
                    // A point without size burns at once.
                    burnt = at_least(burnt, if since < time { since / time } else { 1.0 });
                }
            }
            if self.burn != Burn::Programmed {
                burnt = at_least(burnt, (1.0 - rho0 / rho) / span);
            }
            burnt = at_most(burnt, 1.0);
            batch.burn[k] = burnt;
            let mut at = self.response(rho0, rho, batch.specific_energy[k]);
            at.pressure = burnt * at.pressure + (1.0 - burnt) * self.unburnt(rho0, rho);
            at.dp_drho = at_least(at.dp_drho, self.bulk_modulus / rho0);
            response.set(k, at);
        }
        response
    }
}

impl EquationOfState for Jwl {
    const APART: bool = true;

    fn contradiction(&self) -> Option<Contradiction> {
        (self.r1 <= self.r2).then_some(Contradiction {
            keys: &["r1", "r2"],
            title: "`r1` must be above `r2`: the first term is that of the densest products",
        })
    }

    /// `ρ c²` of products at the density of the unburnt matter.
    fn bulk_modulus(&self, rho0: f64) -> f64 {
        let at = self.response(rho0, rho0, self.e0);
        let products = rho0 * at.dp_drho + at.pressure / rho0 * at.dp_de;
        at_least(products, self.bulk_modulus)
    }

    /// That of detonation, whatever the density: it belongs to the mass.
    fn reference_energy(&self, _rho: f64) -> f64 {
        self.e0
    }

    #[inline]
    fn at(&self, rho0: f64, rho: f64, e: f64) -> PointResponse {
        self.response(rho0, rho, e)
    }
}
