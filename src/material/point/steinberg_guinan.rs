//! Steinberg–Guinan: shear modulus and yield stress at high pressure, temperature and strain rate.
//!
//! With `η = ρ/ρ₀`, equivalent plastic strain ε and `T₀` the material's reference temperature
//! (300 K in the source),
//!
//! ```text
//! G = G₀ g,    Y = min(Y₀ [1 + β (ε + ε_i)]^n, Y_max) g,    g = 1 + A p η^(−1/3) − B (T − T₀)
//! T_m = T_m0 exp[2 a (1 − 1/η)] η^{2 (γ₀ − a − 1/3)}
//! ```
//!
//! where `A = G'_p/G₀` and `B = −G'_T/G₀`; above `T_m` both are zero, and so they are where the fit
//! would be negative. Source: Steinberg, Cochran & Guinan (1980), *A constitutive model for metals
//! applicable at high-strain rate*, J. Appl. Phys. 51, 1498, whose assumption `Y'_p/Y₀ = G'_p/G₀`
//! is part of this form. It holds above some 1e5/s, where the flow stress no longer follows the
//! rate.
//!
//! `T_m0` is a constant of the fit, above the melting point at zero pressure.

use super::radial_return::{FlowStress, Return, positive};
use super::{Conditions, Contradiction, LANES, Law, PointBatch, jaumann};
use crate::{at_least, at_most};
use numerics::dispatch::instructions;
use numerics::elementary::pow;
use numerics::lanes::Lanes;

law! {
    /// Elastic–plastic with a shear modulus and a yield stress that follow pressure and
    /// temperature.
    SteinbergGuinan {
        /// Shear modulus G₀ of the reference state (Pa).
        shear_modulus: "Pa",
        /// Yield stress Y₀ (Pa).
        yield_stress: "Pa",
        /// Largest yield stress by hardening `Y_max` (Pa).
        max_yield_stress: "Pa",
        /// Hardening coefficient β.
        beta: "",
        /// Hardening exponent n.
        n: "",
        /// Initial plastic strain `ε_i`.
        initial_strain: "",
        /// `G'_p/G₀` (1/Pa).
        pressure_coefficient: "1/Pa",
        /// `−G'_T/G₀` (1/K), positive for softening.
        temperature_coefficient: "1/K",
        /// Melting temperature `T_m0` of the fit (K).
        melting_temperature: "K",
        /// Grüneisen parameter γ₀ in the melting law.
        gamma0: "",
        /// Its volume correction a in the melting law.
        a: "",
    }
}

impl SteinbergGuinan {
    /// Melting temperature (K) at the compression `η = ρ/ρ₀`.
    #[must_use]
    pub fn melting_temperature(&self, eta: f64) -> f64 {
        let exponent = 2.0 * (self.gamma0 - self.a - 1.0 / 3.0);
        self.melting_temperature
            * libm::exp(2.0 * self.a * (1.0 - 1.0 / eta))
            * libm::pow(eta, exponent)
    }

    /// Shear modulus over that of the reference state, at a pressure (Pa), the compression
    /// `η = ρ/ρ₀` and a temperature, whose `reference` is T₀ (K).
    #[must_use]
    pub fn stiffening(&self, pressure: f64, eta: f64, temperature: f64, reference: f64) -> f64 {
        let g = 1.0 + self.pressure_coefficient * pressure / libm::cbrt(eta)
            - self.temperature_coefficient * (temperature - reference);
        if temperature >= self.melting_temperature(eta) {
            0.0
        } else {
            at_least(g, 0.0)
        }
    }

    /// Yield stress before pressure and temperature (Pa) and its slope (Pa).
    fn hardened(&self, strain: f64) -> [f64; 2] {
        let base = 1.0 + self.beta * (strain + self.initial_strain);
        let y = self.yield_stress * libm::pow(base, self.n);
        if y < self.max_yield_stress {
            [y, self.n * self.beta * y / base]
        } else {
            [at_most(y, self.max_yield_stress), 0.0]
        }
    }
}

/// Flow stresses of eight points: [`SteinbergGuinan::hardened`] for vectors.
struct Flow<'a> {
    law: &'a SteinbergGuinan,
    strain: &'a super::Lanes,
    softening: &'a super::Lanes,
}

impl FlowStress for Flow<'_> {
    #[inline(always)]
    fn at<V: Lanes>(&self, increment: V) -> [V; 2] {
        let (law, softening) = (self.law, V::read(self.softening));
        let strain = V::read(self.strain).add(increment);
        let (beta, n) = (V::splat(law.beta), V::splat(law.n));
        let whole = strain.add(V::splat(law.initial_strain));
        let base = whole.mul_add(beta, V::splat(1.0));
        let hardened = pow(base, n).mul(V::splat(law.yield_stress));
        let most = V::splat(law.max_yield_stress);
        let slope = n.mul(beta).mul(hardened).div(base);
        let slope = slope.mul(positive(most.sub(hardened)));
        [hardened.min(most).mul(softening), slope.mul(softening)]
    }

    /// That without hardening, if hardening only adds to it.
    #[inline(always)]
    fn least(&self) -> super::Lanes {
        let mut least = [0.0; LANES];
        if self.law.beta >= 0.0 && self.law.n >= 0.0 {
            for k in 0..LANES {
                // Less what rounding of the power may take.
                least[k] = (1.0 - 1e-12) * self.law.yield_stress * self.softening[k];
            }
        }
        least
    }
}

impl Law for SteinbergGuinan {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];
    const NEEDS_TEMPERATURE: bool = true;
    const FOLLOWS_STATE: bool = true;

    fn contradiction(&self) -> Option<Contradiction> {
        (self.max_yield_stress < self.yield_stress).then_some(Contradiction {
            keys: &["max_yield_stress", "yield_stress"],
            title: "`max_yield_stress` must not be below `yield_stress`",
        })
    }

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    fn yield_stress(&self) -> f64 {
        self.yield_stress
    }

    fn melts_at(&self, compression: f64) -> Option<f64> {
        Some(self.melting_temperature(compression))
    }

    /// Moduli, and the flow stress with them.
    #[inline(never)]
    fn soften(&self, point: &PointBatch, now: &mut Conditions) {
        let reference = now.thermal.reference_temperature;
        for k in 0..LANES {
            let eta = point.density[k] / now.reference_density * now.packing[k];
            let g = self.stiffening(point.pressure[k], eta, now.temperature[k], reference);
            now.softening[k] = g;
            now.shear_modulus[k] = self.shear_modulus * g;
        }
    }

    fn hardening(&self, point: &PointBatch, k: usize, now: &Conditions) -> [f64; 2] {
        let [hard, slope] = self.hardened(point.plastic_strain[k]);
        let softened = at_least(now.shear_modulus[k] / self.shear_modulus, f64::MIN_POSITIVE);
        [slope / hard, -self.temperature_coefficient / softened]
    }

    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        jaumann::deform(point, now);
    }

    /// Radial return.
    #[inline(never)]
    fn flow(&self, point: &mut PointBatch, now: &Conditions) {
        if now.dt == 0.0 {
            return;
        }
        for k in 0..LANES {
            if now.shear_modulus[k] == 0.0 {
                // Molten: no stress, and no measure of strain.
                for component in &mut point.deviatoric_stress {
                    component[k] = 0.0;
                }
            }
        }
        let strain = point.plastic_strain;
        let flow = Flow {
            law: self,
            strain: &strain,
            softening: &now.softening,
        };
        let shear_modulus = &now.shear_modulus;
        instructions().run(Return {
            point,
            shear_modulus,
            flow,
        });
    }
}
