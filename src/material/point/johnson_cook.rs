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

use super::radial_return::{FlowStress, Return, positive};
use super::{Conditions, LANES, Law, PointBatch, jaumann};
use crate::ThermalConstants;
use numerics::dispatch::{Vectorised, instructions};
use numerics::elementary::{ln, pow};
use numerics::lanes::{F64x8, Lanes};

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

/// Flow stresses of eight points at the end of a step `dt` (s): [`JohnsonCook::hardened`] for vectors.
struct Flow<'a> {
    law: &'a JohnsonCook,
    strain: &'a super::Lanes,
    softening: &'a super::Lanes,
    dt: f64,
}

impl FlowStress for Flow<'_> {
    #[inline(always)]
    fn at<V: Lanes>(&self, increment: V) -> [V; 2] {
        let (law, one) = (self.law, V::splat(1.0));
        let strain = V::read(self.strain).add(increment);
        let least = V::splat(f64::MIN_POSITIVE);
        let power = pow(strain.max(least), V::splat(law.n)).mul(positive(strain));
        let power = power.mul(V::splat(law.b));
        let softening = V::read(self.softening);
        let hard = power.add(V::splat(law.a)).mul(softening);
        let slope = power
            .mul(V::splat(law.n))
            .div(strain.max(least))
            .mul(softening);
        let ratio = increment.div(V::splat(self.dt * law.reference_rate));
        let c = V::splat(law.c);
        let fast = ln(ratio.max(one)).mul_add(c, one);
        let by_log = hard.mul(c).mul(positive(ratio.sub(one)));
        [hard.mul(fast), slope.mul_add(fast, by_log.div(increment))]
    }

    /// That without hardening, if hardening only adds to it.
    #[inline(always)]
    fn least(&self) -> super::Lanes {
        let mut least = [0.0; LANES];
        if self.law.b >= 0.0 && self.law.c >= 0.0 {
            for k in 0..LANES {
                least[k] = self.law.a * self.softening[k];
            }
        }
        least
    }
}

/// `1 − T*^m` of eight points.
struct Softening<'a> {
    homologous: &'a F64x8,
    m: f64,
}

impl Vectorised for Softening<'_> {
    type Output = F64x8;

    #[inline(always)]
    fn run<V: Lanes>(self) -> F64x8 {
        let homologous = V::load(self.homologous);
        let power = pow(
            homologous.max(V::splat(f64::MIN_POSITIVE)),
            V::splat(self.m),
        );
        V::splat(1.0).sub(power.mul(positive(homologous))).store()
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

    /// Thermal softening.
    #[inline(never)]
    fn soften(&self, _point: &PointBatch, now: &mut Conditions) {
        let mut homologous = F64x8([0.0; LANES]);
        for k in 0..LANES {
            homologous.0[k] = now.thermal.homologous(now.temperature[k]);
        }
        // What has not been heated, as most of a plate, takes no power.
        now.softening = if homologous.0 == [0.0; LANES] {
            [1.0; LANES]
        } else {
            let (homologous, m) = (&homologous, self.m);
            instructions().run(Softening { homologous, m }).0
        };
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

    /// Radial return.
    #[inline(never)]
    fn flow(&self, point: &mut PointBatch, now: &Conditions) {
        if now.dt == 0.0 {
            return;
        }
        let strain = point.plastic_strain;
        let flow = Flow {
            law: self,
            strain: &strain,
            softening: &now.softening,
            dt: now.dt,
        };
        let shear_modulus = &now.shear_modulus;
        instructions().run(Return {
            point,
            shear_modulus,
            flow,
        });
    }
}
