//! Contact of gases: its stiffness follows their pressure.
//!
//! The energy that a particle has in contact is proportional to its factor `s`, which is the bulk modulus at its present
//! pressure over that of the reference state or of the start, and at least one. Forces are the gradient of that
//! energy at the present factors. A gas that stiffens at `ds/dt` by being compressed or heated raises its energy of contact
//! `Φ_i` by `Φ_i (ds/dt)/s`, which its specific energy gives.

use rayon::prelude::*;

use material::Eos;
use model::{Body, Case};
use particles::{GRAIN, ParticleStore};

/// A body of gas.
#[derive(Debug, Clone)]
pub(crate) struct Gas {
    eos: Eos,
    reference_density: f64,
    /// `[a, b]` of the factor `a (p + b)` (1/Pa, Pa).
    factor: [f64; 2],
}

impl Gas {
    /// That of a body, if it is one and has any modulus.
    pub fn of(case: &Case, body: &Body) -> Option<Self> {
        let material = &case.materials[body.material];
        let [slope, offset] = material.eos.modulus_over_pressure()?;
        let modulus = case.contact_modulus(body);
        (modulus > 0.0 && body.rigid.is_none()).then(|| Self {
            eos: material.eos.clone(),
            reference_density: material.reference_density,
            factor: [slope / modulus, offset],
        })
    }

    /// Factor at a pressure (Pa).
    fn at(&self, pressure: f64) -> f64 {
        let [slope, offset] = self.factor;
        (slope * (pressure + offset)).max(1.0)
    }

    /// `(ds/dt)/s` of particle `i` (1/s).
    pub fn rate(&self, particles: &ParticleStore, i: usize) -> f64 {
        let factor = particles.contact_stiffening[i];
        if factor <= 1.0 {
            return 0.0;
        }
        let (density, energy) = (particles.density[i], particles.specific_energy[i]);
        let at = self.eos.at(self.reference_density, density, energy);
        let [xx, _, _, _, yy, _, _, _, zz] = particles.velocity_gradient[i];
        let rise =
            at.dp_de * particles.d_specific_energy_dt[i] - at.dp_drho * density * (xx + yy + zz);
        self.factor[0] * rise / factor
    }
}

/// Factor of particle `i`; one in a case without gas in contact.
#[inline(always)]
pub(super) fn stiffening(particles: &ParticleStore, i: usize) -> f64 {
    particles.contact_stiffening.get(i).copied().unwrap_or(1.0)
}

/// Sets the factors of owned particles, given the gases by body.
pub(super) fn stiffen(gases: &[Option<Gas>], particles: &mut ParticleStore) {
    let owned = particles.owned();
    let (pressure, body) = (&particles.pressure, &particles.body);
    let chunks = particles.contact_stiffening[..owned].par_chunks_mut(GRAIN);
    chunks.enumerate().for_each(|(chunk, factors)| {
        for (i, factor) in (chunk * GRAIN..).zip(factors) {
            let gas = gases[body[i] as usize].as_ref();
            *factor = gas.map_or(1.0, |gas| gas.at(pressure[i]));
        }
    });
}
