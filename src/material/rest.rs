//! The reference state, and what is too little to leave it.

use super::{LANES, Material, PointBatch};

/// A strain in one step, or a velocity over that of sound, that is none: 2⁻⁴³ = 1.1e-13. Positions of a model of
/// a thousand spacings resolve no smaller one.
pub const NEGLIGIBLE: f64 = 512.0 * f64::EPSILON;

/// A reference state without stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Density (kg/m³).
    density: f64,
    /// Specific energy (J/kg) below which there is no pressure.
    energy: f64,
    /// Sound speed (m/s) of virgin matter without energy.
    pub sound_speed: f64,
}

impl Rest {
    /// That of a material, if there is no pressure in its reference state. Pressures of less than [`NEGLIGIBLE`] times
    /// the modulus are none.
    #[must_use]
    pub fn of(material: &Material) -> Option<Self> {
        let density = material.reference_density;
        let speed = material.longitudinal_speed();
        let mut point = PointBatch {
            density: [density; LANES],
            ..PointBatch::ZERO
        };
        material.update(&mut point, 0.0);
        (point.pressure[0] == 0.0).then_some(Self {
            density,
            energy: NEGLIGIBLE * speed * speed,
            sound_speed: point.sound_speed[0],
        })
    }

    /// True if matter of this density (kg/m³), specific energy (J/kg), compaction and deviatoric stress (Pa) is in it.
    #[inline(always)]
    #[must_use]
    pub fn holds(&self, density: f64, energy: f64, compaction: f64, deviator: &[f64; 6]) -> bool {
        density.to_bits() == self.density.to_bits()
            && energy.abs() < self.energy
            && compaction == 0.0
            && *deviator == [0.0; 6]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library;

    #[test]
    fn a_solid_rests_in_its_reference_state_alone() {
        let metal = library::find("aluminium-2024").unwrap();
        let rest = Rest::of(&metal).unwrap();
        let (density, free) = (metal.reference_density, [0.0; 6]);
        assert!(rest.holds(density, 0.0, 0.0, &free) && rest.holds(density, -1e-9, 0.0, &free));
        assert!(!rest.holds(density.next_up(), 0.0, 0.0, &free));
        assert!(!rest.holds(density, 1e-3 * density, 0.0, &free));
        assert!(!rest.holds(density, 0.0, 0.5, &free));
        assert!(!rest.holds(density, 0.0, 0.0, &[0.0, 0.0, 0.0, 0.0, 1e-9, 0.0]));
    }
}
