//! Impact of elastic bars in uniaxial strain with the program's own laws: the first shocks and
//! the release fans behind them, in closed form.
//!
//! With the stretch `λ = ρ₀/ρ` the stress along the bar is a function of λ alone, since uniaxial
//! strain does not rotate and neither law includes heat:
//!
//! | form | σ(λ), G from `dS/dt = 2G dev D` | C² = σ′/ρ₀ | L(λ) = ∫₁ C dλ |
//! |---|---|---|---|
//! | logarithmic | `M ln λ`, that is `dσ/dt = M D` | `M/(ρ₀ λ)` | `2 c (√λ − 1)` |
//! | density ratio | `−K (1/λ − 1) + g ln λ`, `g = 4G/3` | `(K/λ² + g/λ)/ρ₀` | `{2 (s − s₁) + √K [ln λ − 2 ln((s + √K)/(s₁ + √K))]}/√ρ₀`, `s = √(K + g λ)`, `s₁ = √M` |
//!
//! In reference coordinates `ρ₀ ∂v/∂t = ∂σ/∂X`, `∂λ/∂t = ∂v/∂X`. Jumps at a front of speed U
//! into a bar at rest: `u = U (1 − λ)`, `−σ = ρ₀ U u`, so `u² = −σ (1 − λ)/ρ₀`. C falls with λ in
//! either law: compression runs as a shock, release as a fan of straight characteristics of
//! speed C(λ), along which `v ± L` stays. A free end that the shock reaches at `X/U` sends back a
//! fan between C(λ) and C(1), and gains `L(1) − L(λ) = −L(λ)`.

use super::bisect;
use material::{Eos, LinearForm, Material, Strength};

/// An elastic medium at rest without stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Medium {
    /// Reference density ρ₀ (kg/m³).
    pub reference_density: f64,
    /// Bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
    /// Form of the pressure as a function of density.
    pub form: LinearForm,
}

impl Medium {
    /// The medium of a material, if it is linear elastic.
    #[must_use]
    pub fn of(material: &Material) -> Option<Self> {
        let (Eos::Linear(eos), None) = (&material.eos, &material.porosity) else {
            return None;
        };
        let elastic = matches!(material.strength, Strength::None | Strength::Elastic(_));
        (elastic && material.failure.is_none()).then_some(Self {
            reference_density: material.reference_density,
            bulk_modulus: eos.bulk_modulus,
            shear_modulus: material.strength.shear_modulus(),
            form: eos.form,
        })
    }

    /// p-wave modulus M = K + 4G/3 (Pa).
    #[must_use]
    pub fn p_wave_modulus(&self) -> f64 {
        self.bulk_modulus + self.shear_modulus * (4.0 / 3.0)
    }

    /// Stress σ along the bar at stretch λ, tension positive (Pa).
    #[must_use]
    pub fn stress(&self, stretch: f64) -> f64 {
        let logarithm = libm::log(stretch);
        match self.form {
            LinearForm::Logarithmic => self.p_wave_modulus() * logarithm,
            LinearForm::DensityRatio => {
                self.shear_modulus * (4.0 / 3.0) * logarithm
                    - self.bulk_modulus * (1.0 / stretch - 1.0)
            }
        }
    }

    /// Speed C of small waves in reference coordinates at stretch λ (m/s).
    #[must_use]
    pub fn wave_speed(&self, stretch: f64) -> f64 {
        let slope = match self.form {
            LinearForm::Logarithmic => self.p_wave_modulus() / stretch,
            LinearForm::DensityRatio => {
                let shear = self.shear_modulus * (4.0 / 3.0);
                (self.bulk_modulus / stretch + shear) / stretch
            }
        };
        (slope / self.reference_density).sqrt()
    }

    /// The Riemann integral L(λ) = ∫₁ C dλ (m/s), negative in compression.
    #[must_use]
    pub fn riemann_integral(&self, stretch: f64) -> f64 {
        match self.form {
            LinearForm::Logarithmic => 2.0 * self.wave_speed(1.0) * (stretch.sqrt() - 1.0),
            LinearForm::DensityRatio => {
                let shear = self.shear_modulus * (4.0 / 3.0);
                let root = self.bulk_modulus.sqrt();
                let s = |stretch: f64| (self.bulk_modulus + shear * stretch).sqrt();
                let (s, s_1) = (s(stretch), s(1.0));
                let logarithms = libm::log(stretch) - 2.0 * libm::log((s + root) / (s_1 + root));
                (2.0 * (s - s_1) + root * logarithms) / self.reference_density.sqrt()
            }
        }
    }

    /// Pressure at stretch λ, compression positive (Pa).
    #[must_use]
    pub fn pressure(&self, stretch: f64) -> f64 {
        match self.form {
            LinearForm::Logarithmic => -self.bulk_modulus * libm::log(stretch),
            LinearForm::DensityRatio => self.bulk_modulus * (1.0 / stretch - 1.0),
        }
    }

    /// `∫₁ σ dλ/ρ₀` (J/kg): the strain energy; the heat of shocks, of third order in the strain,
    /// is not in it.
    #[must_use]
    pub fn strain_energy(&self, stretch: f64) -> f64 {
        let logarithm = libm::log(stretch);
        let of_logarithm = stretch * logarithm - (stretch - 1.0);
        let energy = match self.form {
            LinearForm::Logarithmic => self.p_wave_modulus() * of_logarithm,
            LinearForm::DensityRatio => {
                self.shear_modulus * (4.0 / 3.0) * of_logarithm
                    - self.bulk_modulus * (logarithm - (stretch - 1.0))
            }
        };
        energy / self.reference_density
    }

    /// The stretch λ at a stress (Pa): the inverse of [`Self::stress`].
    #[must_use]
    pub fn stretch(&self, stress: f64) -> f64 {
        match self.form {
            LinearForm::Logarithmic => libm::exp(stress / self.p_wave_modulus()),
            LinearForm::DensityRatio => bisect(1e-3, 1e3, |stretch| self.stress(stretch) - stress),
        }
    }

    /// Speed of a front between two stretches in reference coordinates (m/s).
    pub(super) fn front_speed(&self, a: f64, b: f64) -> f64 {
        if (a - b).abs() < 1e-6 {
            return self.wave_speed(0.5 * (a + b));
        }
        ((self.stress(b) - self.stress(a)) / (b - a) / self.reference_density).sqrt()
    }

    /// Change of velocity (m/s) of the material behind a wave to the left from stretch `ahead` to
    /// `stretch`, a shock or a fan; one to the right changes it by as much the other way.
    pub(super) fn change(&self, stretch: f64, ahead: f64) -> f64 {
        if stretch >= ahead {
            self.riemann_integral(stretch) - self.riemann_integral(ahead)
        } else {
            (stretch - ahead) * self.front_speed(ahead, stretch)
        }
    }
}
