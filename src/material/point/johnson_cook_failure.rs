//! Ductile failure by Johnson and Cook.
//!
//! ```text
//! dD = dε/ε_f,    ε_f = [D₁ + D₂ exp(D₃ η)] f(ε̇*) [1 + D₅ T*],    η = −p/q
//! f = 1 + D₄ ln ε̇*  (logarithm)    or    (1 + ε̇*)^D₄  (power)
//! ```
//!
//! with the equivalent plastic strain ε, its rate over the reference rate ε̇* (at least one in the
//! logarithm), the triaxiality η of pressure p (positive in compression) and equivalent stress q,
//! and T* as in [`JohnsonCook`](super::JohnsonCook). D₃ is negative for metals: tension breaks at
//! smaller strains. Sources: Johnson & Cook (1985), *Fracture characteristics of three metals
//! subjected to various strains, strain rates, temperatures and pressures*, Eng. Fract. Mech. 21,
//! 31; the power form Børvik, Hopperstad, Berstad & Langseth (2001), *A computational model of
//! viscoplasticity and ductile damage for impact and penetration*, Eur. J. Mech. A 20, 685.
//!
//! Rules that the fit leaves open:
//!
//! - `ε_f` is at least `least_strain`: fits with a negative D₁ fall below zero where tension is high.
//! - Beyond η = 1.5 the fit does not hold. With a `spall_stress` `σ_s`, `ε_f` falls from there linearly
//!   in the mean tension, to `least_strain` at `σ_s` (1985, section 5); η counts as three at most.
//! - Nothing is damaged below η = −1/3, the value of uniaxial compression: Bao & Wierzbicki (2005),
//!   *On the cut-off value of negative triaxiality for fracture*, Eng. Fract. Mech. 72, 1049.

use serde::Deserialize;

use super::radial_return::equivalent_stress;
use super::{Conditions, LANES, Law, PointBatch};
use crate::{ThermalConstants, at_least};

/// Triaxiality below which nothing is damaged.
const CUT_OFF: f64 = -1.0 / 3.0;
/// Triaxiality up to which the fit holds.
const HIGH_TENSION: f64 = 1.5;
/// Largest triaxiality that counts.
const MOST: f64 = 3.0;

/// Dependence of the failure strain on the strain rate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RateForm {
    /// `1 + D₄ ln ε̇*`.
    #[default]
    Logarithm,
    /// `(1 + ε̇*)^D₄`.
    Power,
}

impl RateForm {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Logarithm => "logarithm",
            Self::Power => "power",
        }
    }
}

law! {
    /// Damage by plastic strain, the more the larger the tension.
    JohnsonCookFailure {
        /// D₁.
        d1: "",
        /// D₂.
        d2: "",
        /// D₃, negative for metals.
        d3: "",
        /// D₄ of the strain rate.
        d4: "",
        /// D₅ of the temperature.
        d5: "",
        /// Reference strain rate (1/s).
        reference_rate: "1/s",
        /// Dependence of the failure strain on the rate.
        rate_form: RateForm,
        /// Least failure strain.
        least_strain: "",
        /// Mean tension at which the least strain is enough (Pa); zero if the fit holds for any.
        spall_stress: "Pa",
    }
}

impl JohnsonCookFailure {
    /// Failure strain at a pressure (Pa, compression positive), an equivalent stress (Pa), a rate
    /// of plastic strain (1/s) and a temperature (K); infinite where nothing is damaged.
    #[must_use]
    pub fn failure_strain(
        &self,
        [pressure, equivalent]: [f64; 2],
        rate: f64,
        temperature: f64,
        thermal: &ThermalConstants,
    ) -> f64 {
        let tension = -pressure;
        if tension < CUT_OFF * equivalent {
            return f64::INFINITY;
        }
        let factor = self.rate_factor(rate) * self.heat_factor(temperature, thermal);
        let at = |eta: f64| {
            let strain = (self.d1 + self.d2 * libm::exp(self.d3 * eta)) * factor;
            at_least(strain, self.least_strain)
        };
        let high = HIGH_TENSION * equivalent;
        if tension <= high || self.spall_stress == 0.0 {
            // No division by a stress that vanishes.
            let most = tension >= MOST * equivalent;
            return at(if most { MOST } else { tension / equivalent });
        }
        if tension >= self.spall_stress {
            return self.least_strain;
        }
        let along = (tension - high) / (self.spall_stress - high);
        let first = at(HIGH_TENSION);
        first + (self.least_strain - first) * along
    }

    #[inline(always)]
    fn rate_factor(&self, rate: f64) -> f64 {
        let ratio = rate / self.reference_rate;
        match self.rate_form {
            _ if self.d4 == 0.0 => 1.0,
            RateForm::Logarithm if ratio > 1.0 => 1.0 + self.d4 * libm::log(ratio),
            RateForm::Logarithm => 1.0,
            RateForm::Power => libm::pow(1.0 + ratio, self.d4),
        }
    }

    #[inline(always)]
    fn heat_factor(&self, temperature: f64, thermal: &ThermalConstants) -> f64 {
        1.0 + self.d5 * thermal.homologous(temperature)
    }
}

impl Law for JohnsonCookFailure {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "damage", "failure_energy"];
    const NEEDS_MELTING: bool = true;
    const FOLLOWS_STATE: bool = true;

    fn needs_temperature(&self) -> bool {
        self.d5 != 0.0
    }

    /// Lane by lane: only what flows is damaged.
    #[inline(never)]
    fn fail(&self, point: &mut PointBatch, now: &Conditions) {
        for k in 0..LANES {
            let increment = now.plastic_increment[k];
            if increment > 0.0 {
                let stress = [point.pressure[k], equivalent_stress(point, k)];
                let rate = increment / now.dt;
                let strain = self.failure_strain(stress, rate, now.temperature[k], &now.thermal);
                point.damage[k] += increment / (strain * now.options.strain_factor(point.id[k]));
            }
        }
    }
}
