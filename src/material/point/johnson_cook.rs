//! Johnson–Cook plasticity.
//!
//! ```text
//! Y = (A + B ε^n) (1 + C ln ε̇*) (1 − T*^m),    T* = (T − T₀)/(T_m − T₀)
//! ```
//!
//! with the equivalent plastic strain ε, its rate over the reference rate ε̇*, and the temperature
//! between the material's reference and melting temperatures. Source: Johnson & Cook (1983), *A
//! constitutive model and data for metals subjected to large strains, high strain rates and high
//! temperatures*, Proc. 7th Int. Symp. Ballistics, 541.
//!
//! Rates below the reference rate count as that rate, T* stays between 0 and 1 (molten: Y = 0). ε
//! and ε̇ are those of the end of the step: the return solves for both at once.

use super::{Conditions, LANES, Law, PointBatch, jaumann, radial_return};
use crate::ThermalConstants;

law! {
    /// Elastic–plastic with strain hardening, strain rate hardening and thermal softening.
    JohnsonCook {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
        /// Yield stress A (Pa).
        a: "Pa",
        /// Hardening coefficient B (Pa).
        b: "Pa",
        /// Hardening exponent n.
        n: "",
        /// Rate coefficient C.
        c: "",
        /// Exponent m of thermal softening.
        m: "",
        /// Reference strain rate (1/s).
        reference_rate: "1/s",
    }
}

impl JohnsonCook {
    /// Flow stress (Pa) at an equivalent plastic strain, its rate (1/s) and a temperature (K).
    #[must_use]
    pub fn flow_stress(
        &self,
        strain: f64,
        rate: f64,
        temperature: f64,
        thermal: &ThermalConstants,
    ) -> f64 {
        let softening = self.softening(temperature, thermal);
        self.hardened(strain, rate, softening)[0]
    }

    /// `1 − T*^m`.
    fn softening(&self, temperature: f64, thermal: &ThermalConstants) -> f64 {
        let homologous = thermal.homologous(temperature);
        if homologous > 0.0 {
            1.0 - libm::pow(homologous, self.m)
        } else {
            1.0
        }
    }

    /// Y (Pa), and its derivatives by the strain (Pa) and by the logarithm of the rate (Pa).
    #[inline(always)]
    fn hardened(&self, strain: f64, rate: f64, softening: f64) -> [f64; 3] {
        let power = if strain > 0.0 {
            self.b * libm::pow(strain, self.n)
        } else {
            0.0
        };
        let hard = (self.a + power) * softening;
        let slope = self.n * power / strain * softening;
        if rate > self.reference_rate {
            let fast = 1.0 + self.c * libm::log(rate / self.reference_rate);
            [hard * fast, slope * fast, hard * self.c]
        } else {
            [hard, slope, 0.0]
        }
    }
}

impl Law for JohnsonCook {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];
    const NEEDS_TEMPERATURE: bool = true;
    const NEEDS_MELTING: bool = true;
    const FOLLOWS_STATE: bool = true;

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    fn yield_stress(&self) -> f64 {
        self.a
    }

    /// Thermal softening, lane by lane.
    #[inline(never)]
    fn soften(&self, _point: &PointBatch, now: &mut Conditions) {
        for k in 0..LANES {
            now.softening[k] = self.softening(now.temperature[k], &now.thermal);
        }
    }

    fn hardening(&self, point: &PointBatch, k: usize, now: &Conditions) -> [f64; 2] {
        let strain = point.plastic_strain[k];
        let [hard, slope, _] = self.hardened(strain, 0.0, 1.0);
        let homologous = now.thermal.homologous(now.temperature[k]);
        let by_temperature = if 0.0 < homologous && homologous < 1.0 {
            let power = libm::pow(homologous, self.m);
            let warmer = now.temperature[k] - now.thermal.reference_temperature;
            -self.m * power / (warmer * (1.0 - power))
        } else {
            0.0
        };
        [slope / hard, by_temperature]
    }

    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        jaumann::deform(point, now);
    }

    /// Radial return, lane by lane: not for vectors, so it stays out of their loops.
    #[inline(never)]
    fn flow(&self, point: &mut PointBatch, now: &Conditions) {
        if now.dt == 0.0 {
            return;
        }
        for k in 0..LANES {
            let before = point.plastic_strain[k];
            radial_return::return_lane(point, k, now.shear_modulus[k], |increment| {
                let [y, by_strain, by_log] =
                    self.hardened(before + increment, increment / now.dt, now.softening[k]);
                [y, by_strain + by_log / increment]
            });
        }
    }
}
