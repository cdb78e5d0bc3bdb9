//! Von Mises plasticity with radial return.
//!
//! A trial stress of equivalent `q = √(3/2 S:S)` above the yield stress `Y = Y₀ + H ε_p` returns
//! along its radius: `Δε_p = (q − Y)/(3G + H)`, `S ← (1 − 3G Δε_p/q) S`, which lands on the
//! hardened yield surface exactly. Source: Wilkins (1964), *Calculation of elastic-plastic flow*,
//! UCRL-7322; with hardening Simo & Hughes (1998), *Computational Inelasticity*, box 3.1.

use super::{Conditions, LANES, Law, PointBatch, jaumann};

law! {
    /// Elastic–plastic: elastic inside the von Mises cylinder, whose radius may grow with plastic
    /// strain.
    VonMises {
        /// Shear modulus G (Pa).
        shear_modulus: "Pa",
        /// Yield stress in uniaxial tension at zero plastic strain, Y₀ (Pa).
        yield_stress: "Pa",
        /// Hardening modulus H (Pa): `Y = Y₀ + H ε_p`; 0 for perfect plasticity.
        hardening_modulus: "Pa",
    }
}

impl Law for VonMises {
    const STATE: &'static [&'static str] = &["deviatoric_stress", "plastic_strain"];

    fn shear_modulus(&self) -> f64 {
        self.shear_modulus
    }

    fn yield_stress(&self) -> f64 {
        self.yield_stress
    }

    fn hardening(&self, point: &PointBatch, k: usize, _now: &Conditions) -> [f64; 2] {
        let hard = self.yield_stress + self.hardening_modulus * point.plastic_strain[k];
        [self.hardening_modulus / hard, 0.0]
    }

    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        jaumann::deform(point, now);
    }

    /// Radial return.
    #[inline(always)]
    fn flow(&self, point: &mut PointBatch, now: &Conditions) {
        if now.dt == 0.0 {
            return;
        }
        let s = &mut point.deviatoric_stress;
        for k in 0..LANES {
            let diagonal = s[0][k] * s[0][k] + s[1][k] * s[1][k] + s[2][k] * s[2][k];
            let shear = s[3][k] * s[3][k] + s[4][k] * s[4][k] + s[5][k] * s[5][k];
            let q = (1.5 * (diagonal + 2.0 * shear)).sqrt();
            let three_g = 3.0 * now.shear_modulus[k];
            let (soft, before) = (now.softening[k], point.plastic_strain[k]);
            let excess = q - soft * (self.yield_stress + self.hardening_modulus * before);
            let stiffness = three_g + soft * self.hardening_modulus;
            let yields = excess > 0.0;
            let strain = if yields { excess / stiffness } else { 0.0 };
            let divisor = if yields { q } else { 1.0 };
            let scale = 1.0 - three_g * strain / divisor;
            for component in s.iter_mut() {
                component[k] *= scale;
            }
            point.plastic_strain[k] += strain;
        }
    }
}
