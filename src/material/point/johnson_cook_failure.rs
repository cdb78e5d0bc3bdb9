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
//! - `ε_f` is at least `least_strain`: fits with a negative D₁ may fall below zero.
//! - Constants are fitted to torsion (η = 0) and notched bars (η up to about one). Beyond, the spall limit of the
//!   material rules, and flow damages nothing; without such a limit `ε_f` is that of η = 1. With a `spall_stress` `σ_s`,
//!   `ε_f` falls from there linearly in the mean tension, to `least_strain` at `σ_s`; in section 5 of the paper of 1985
//!   this line begins at η = 1.5.
//! - Nothing is damaged below η = −1/3, the value of uniaxial compression: Bao & Wierzbicki (2005),
//!   *On the cut-off value of negative triaxiality for fracture*, Eng. Fract. Mech. 72, 1049.
//!
//! **Coupled damage** takes its share of the strength from the start, `(1 − D) Y`, as in Børvik et al. (2001). Where
//! Y hardens less than damage takes, the strength is at its maximum, and deformation localises into the
//! smallest size that a model has:
//!
//! ```text
//! (1 − D) d ln Y/dε < 1/ε_f        d ln Y/dε = ∂ ln Y/∂ε + χ Y/(ρ c) ∂ ln Y/∂T
//! ```
//!
//! with the share χ of plastic work that is heat and the specific heat c. From there on a
//! `fracture_energy` G rules, less what one size L of the particle has taken by then, `L (1 − D) Y ε`, so that a
//! band costs about the same at any spacing. `failure_onset` holds `G/(G − L (1 − D) Y ε)` from then on.
//!
//! **Localised damage** takes nothing of the strength before the maximum, and beyond it in shear bands alone. A band is a
//! ridge of plastic strain: its particles have flowed at least 1.15 times as far as their neighbours on the mean, without
//! the linear part of the field, since a hole that opens is a slope. It is sheared: the square of its spin is at
//! least half of that of its strain rate. And it is closed: the triaxiality is at most 1/3, beyond which voids grow (Bao &
//! Wierzbicki 2004, *On fracture locus in the equivalent strain and stress triaxiality space*, Int. J. Mech. Sci. 46, 81).
//! What has not localised keeps its strength to D = 1, where it fails at once.

use serde::Deserialize;

use super::radial_return::equivalent_stress;
use super::{Conditions, FAILED, LANES, Law, PointBatch};
use crate::{ThermalConstants, at_least};

/// Plastic strain over the mean of the neighbours' in a shear band, at least.
const RIDGE: f64 = 1.15;
/// Square of the spin over that of the strain rate in a shear band, at least: one in simple shear, zero where a hole opens.
const SHEAR: f64 = 0.5;
/// Largest triaxiality of a shear band, that of uniaxial tension: beyond, voids grow.
const CLOSED: f64 = 1.0 / 3.0;
/// Triaxiality below which nothing is damaged.
const CUT_OFF: f64 = -1.0 / 3.0;
/// Least share of a fracture energy that is left at the onset of softening.
const LEAST_LEFT: f64 = 1e-6;
/// Largest triaxiality of the tests that constants are fitted to: that of notched bars.
const LARGEST: f64 = 1.0;

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

/// Strength of material that is damaged and has not failed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coupling {
    /// All of it.
    #[default]
    Uncoupled,
    /// `1 − D` of it.
    Coupled,
    /// Nothing before deformation localises; what the fracture energy leaves from there on.
    Localised,
}

impl Coupling {
    /// Its name in the input.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Uncoupled => "uncoupled",
            Self::Coupled => "coupled",
            Self::Localised => "localised",
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
        /// Mean tension at which the least strain is enough (Pa); zero if there is none.
        spall_stress: "Pa",
        /// Share of the strength that damage takes before failure.
        coupling: Coupling,
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
        let high = LARGEST * equivalent;
        if tension < high {
            return at(tension / equivalent);
        }
        let first = at(LARGEST);
        if self.spall_stress == 0.0 {
            return first;
        }
        if tension >= self.spall_stress {
            return self.least_strain;
        }
        let along = (tension - high) / (self.spall_stress - high);
        first + (self.least_strain - first) * along
    }

    /// Failure strain of lane k, which has flowed; infinite beyond the tests of the fit where a spall limit rules.
    #[inline(always)]
    fn strain_of(&self, point: &PointBatch, k: usize, now: &Conditions) -> f64 {
        let stress = [point.pressure[k], equivalent_stress(point, k)];
        if now.spalls && self.spall_stress == 0.0 && -stress[0] > LARGEST * stress[1] {
            return f64::INFINITY;
        }
        let rate = now.plastic_increment[k] / now.dt;
        let strain = self.failure_strain(stress, rate, now.temperature[k], &now.thermal);
        strain * now.options.strain_factor(point.id[k])
    }

    /// True if deformation of lane k localises in a shear band: it has flowed farther than its neighbours, it turns as much as
    /// it is strained, and tension is not what opens it.
    #[inline(always)]
    fn is_band(point: &PointBatch, k: usize) -> bool {
        let l = |c: usize| point.velocity_gradient[c][k];
        let (mut strain, mut spin) = (0.0, 0.0);
        for a in [0, 4, 8] {
            strain += l(a) * l(a);
        }
        // Twice the squares of each off-diagonal component.
        for (a, b) in [(1, 3), (2, 6), (5, 7)] {
            let (sum, difference) = (l(a) + l(b), l(a) - l(b));
            strain += 0.5 * sum * sum;
            spin += 0.5 * difference * difference;
        }
        point.plastic_strain[k] > RIDGE * point.neighbour_strain[k]
            && spin > SHEAR * strain
            && -point.pressure[k] <= CLOSED * equivalent_stress(point, k)
    }

    /// Lane by lane: only what flows is damaged.
    #[inline(never)]
    fn soften_flow(&self, point: &mut PointBatch, now: &Conditions) {
        let is_coupled = self.coupling == Coupling::Coupled;
        for k in 0..LANES {
            if now.plastic_increment[k] > 0.0 && point.failure_onset[k] < 1.0 {
                let damage = at_least(point.damage[k], point.failure_onset[k]);
                if is_coupled {
                    point.damage[k] = damage;
                }
                let hardens = (1.0 - damage) * now.hardening[k];
                if hardens * self.strain_of(point, k, now) < 1.0
                    && (is_coupled || Self::is_band(point, k))
                {
                    let energy = now.options.fracture_energy;
                    let taken =
                        now.size(point, k) * equivalent_stress(point, k) * point.plastic_strain[k];
                    point.failure_onset[k] = energy / at_least(energy - taken, LEAST_LEFT * energy);
                }
            }
        }
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
        let localises = self.localises() && now.options.softens();
        for k in 0..LANES {
            let increment = now.plastic_increment[k];
            if increment > 0.0 {
                let before = point.damage[k];
                point.damage[k] += increment / self.strain_of(point, k, now);
                // Where matter softens, this is its way to the onset, and what has not localised has no softening.
                if localises && before < FAILED && point.damage[k] >= FAILED {
                    point.failure_onset[k] = FAILED;
                }
            }
        }
    }

    fn asks_hardening(&self) -> bool {
        self.coupling != Coupling::Uncoupled
    }

    fn localises(&self) -> bool {
        self.coupling == Coupling::Localised
    }

    /// Coupled damage before the strength is at its maximum, and the onset of softening there.
    #[inline(always)]
    fn open(&self, point: &mut PointBatch, now: &Conditions) {
        if self.coupling != Coupling::Uncoupled {
            self.soften_flow(point, now);
        }
    }
}
