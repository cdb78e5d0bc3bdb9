//! Matter that begins at rest under a stress.
//!
//! The deviator of the stress is state of the matter. Its pressure is that of the equation of state at a density, which is
//! found between two densities that enclose it, so that it is found or there is none. Pores that the pressure crushes are
//! crushed from the start.

use super::{FAILED, LANES, Material, PointBatch, UNLIT, equivalent_stress};

/// State of matter at rest under a stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stressed {
    /// Density (kg/m³).
    pub density: f64,
    /// Specific energy (J/kg).
    pub specific_energy: f64,
    /// Deviatoric stress `xx yy zz xy xz yz`, tension positive (Pa).
    pub deviatoric_stress: [f64; 6],
    /// How far pores have been crushed, along the crush curve; zero without pores.
    pub compaction: f64,
}

/// What matter does not bear of a stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unborne {
    /// The equation of state has no such pressure (Pa) at the energy of the matter.
    Pressure(f64),
    /// The pressure (Pa) is a tension that the matter does not bear.
    Tension(f64),
    /// The equivalent stress of the deviator (Pa) is beyond the strength.
    Shear(f64),
}

/// First step of the search for a density, over the density; the next ones are twice as large, up to [`LONGEST`].
const FIRST: f64 = 1e-3;
const LONGEST: f64 = 1.0;
/// Most steps of the search: 2⁶⁴ times the reference density.
const MOST: usize = 74;
/// Most divisions of the bracket.
const DIVISIONS: usize = 200;
/// Relative error of stresses that is rounding.
const ROUNDING: f64 = 1e-6;
/// A step (s) in which nothing but a return to the strength happens.
const INSTANT: f64 = 1e-100;

/// The pressure (Pa) of a stress `xx yy zz xy xz yz` (Pa), tension positive, and its deviator (Pa).
#[must_use]
pub fn pressure_and_deviator(stress: &[f64; 6]) -> (f64, [f64; 6]) {
    let [xx, yy, zz, xy, xz, yz] = *stress;
    let pressure = -(xx + yy + zz) / 3.0;
    let deviator = [xx + pressure, yy + pressure, zz + pressure, xy, xz, yz];
    // Three equal stresses have no deviator, to the bit.
    if xx == yy && yy == zz {
        return (-xx, [0.0, 0.0, 0.0, xy, xz, yz]);
    }
    (pressure, deviator)
}

impl Material {
    /// Matter at rest under a `stress` (Pa), tension positive, whose specific energy (J/kg) at a density (kg/m³) is
    /// `energy`; a particle of it has a mass (kg) and an equivalent plastic strain.
    ///
    /// # Errors
    /// What the matter does not bear.
    pub fn stressed(
        &self,
        stress: &[f64; 6],
        energy: impl Fn(f64) -> f64,
        [mass, plastic_strain]: [f64; 2],
    ) -> Result<Stressed, Unborne> {
        let (pressure, deviator) = pressure_and_deviator(stress);
        let density = self.density_under(pressure, &energy);
        let density = density.ok_or(Unborne::Pressure(pressure))?;
        let specific_energy = energy(density);
        let point = self.first(density, specific_energy, true);
        let pores = match self.porosity {
            Some(_) => [point.distension, point.compaction],
            None => [0.0; 2],
        };
        let mut batch = PointBatch {
            density: [density; LANES],
            specific_energy: [specific_energy; LANES],
            deviatoric_stress: deviator.map(|component| [component; LANES]),
            plastic_strain: [plastic_strain; LANES],
            distension: [pores[0]; LANES],
            compaction: [pores[1]; LANES],
            mass: [mass; LANES],
            lighting_time: [UNLIT; LANES],
            ..PointBatch::ZERO
        };
        let before = equivalent_stress(&batch, 0);
        self.update(&mut batch, INSTANT);
        let after = equivalent_stress(&batch, 0);
        let misses = (batch.pressure[0] - pressure).abs() > ROUNDING * pressure.abs();
        if misses || batch.damage[0] >= FAILED {
            return Err(Unborne::Tension(pressure));
        }
        if after < (1.0 - ROUNDING) * before {
            return Err(Unborne::Shear(before));
        }
        Ok(Stressed {
            density,
            specific_energy,
            deviatoric_stress: deviator,
            compaction: pores[1],
        })
    }

    /// The density (kg/m³) nearest to that of the reference state, on the way on which pressure rises with it, at which
    /// matter that has been loaded for the first time has a pressure (Pa); its specific energy (J/kg) at a density is
    /// `energy`. None if there is none.
    #[must_use]
    pub fn density_under(&self, pressure: f64, energy: impl Fn(f64) -> f64) -> Option<f64> {
        let above = |density: f64| {
            let point = self.first(density, energy(density), true);
            point.response.pressure - pressure
        };
        let mut near = [self.reference_density, above(self.reference_density)];
        let rises = near[1] < 0.0;
        let mut step = FIRST;
        for _ in 0..MOST {
            if near[1] == 0.0 {
                return Some(near[0]);
            }
            let density = if rises {
                near[0] * (1.0 + step)
            } else {
                near[0] / (1.0 + step)
            };
            let next = [density, above(density)];
            if !next[1].is_finite() {
                return None;
            }
            if (next[1] >= 0.0) == rises {
                return enclosed(near, next, pressure, above);
            }
            if (next[1] <= near[1]) == rises {
                return None;
            }
            near = next;
            step = (2.0 * step).min(LONGEST);
        }
        None
    }
}

/// The root between two arguments, whose values have different signs, by false position with the weights of Dowell and
/// Jarratt (1971, BIT 11, 168; "Illinois"); none if the function jumps over it by more than rounding of `scale`.
fn enclosed(
    [mut a, mut of_a]: [f64; 2],
    [mut b, mut of_b]: [f64; 2],
    scale: f64,
    f: impl Fn(f64) -> f64,
) -> Option<f64> {
    for _ in 0..DIVISIONS {
        if of_b == 0.0 || (b - a).abs() <= 4.0 * f64::EPSILON * b.abs() {
            break;
        }
        let mut x = b - of_b * ((b - a) / (of_b - of_a));
        if !(a.min(b) < x && x < a.max(b)) {
            x = 0.5 * (a + b);
        }
        let of_x = f(x);
        if (of_x > 0.0) == (of_b > 0.0) {
            of_a *= 0.5;
        } else {
            (a, of_a) = (b, of_b);
        }
        (b, of_b) = (x, of_x);
    }
    let [at_a, at_b] = [f(a).abs(), f(b).abs()];
    let (x, off) = if at_a < at_b { (a, at_a) } else { (b, at_b) };
    (off <= ROUNDING * scale.abs()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Compaction, PAlpha, Porosity, library};

    /// Energy of the reference state.
    fn reference(material: &Material) -> impl Fn(f64) -> f64 + '_ {
        |density| material.eos.reference_energy(density)
    }

    /// Every material of the library begins under pressures and under none, or says that it has no such state.
    #[test]
    fn materials_have_the_pressure_that_they_begin_under() {
        for name in library::names() {
            let material = library::find(name).unwrap();
            for pressure in [0.0, 1e5, 3e7, 1e9, 2e10] {
                let stress = [-pressure, -pressure, -pressure, 0.0, 0.0, 0.0];
                let found = material.stressed(&stress, reference(&material), [1e-3, 0.0]);
                if material.eos.modulus_over_pressure().is_some() || material.burns() {
                    // A gas has one pressure at the energy of the reference state, an explosive may have none before it burns.
                    continue;
                }
                let state = found.unwrap_or_else(|e| panic!("{name} {pressure:e}: {e:?}"));
                assert!(state.density >= material.reference_density);
                let mut batch = PointBatch {
                    density: [state.density; LANES],
                    specific_energy: [state.specific_energy; LANES],
                    compaction: [state.compaction; LANES],
                    lighting_time: [UNLIT; LANES],
                    ..PointBatch::ZERO
                };
                material.update(&mut batch, 0.0);
                let missed = (batch.pressure[0] - pressure).abs();
                assert!(missed <= 1e-6 * pressure, "{name} {pressure:e}: {missed:e}");
                if pressure == 0.0 {
                    let same = state.density.to_bits() == material.reference_density.to_bits();
                    assert!(same, "{name}");
                }
            }
        }
    }

    #[test]
    fn what_is_not_borne_is_told() {
        let metal = library::find("aluminium-6061").unwrap();
        let shear = |value: f64| [0.0, 0.0, 0.0, value, 0.0, 0.0];
        let try_it = |stress: [f64; 6], strain: f64| {
            metal.stressed(&stress, reference(&metal), [1e-6, strain])
        };
        assert!(try_it(shear(1e8), 0.0).is_ok());
        assert!(
            matches!(try_it(shear(1e9), 0.0), Err(Unborne::Shear(q)) if (q - 3f64.sqrt() * 1e9).abs() < 1.0)
        );
        let pulled = |value: f64| [value, value, value, 0.0, 0.0, 0.0];
        assert!(try_it(pulled(1e8), 0.0).is_ok());
        assert!(matches!(
            try_it(pulled(1e12), 0.0),
            Err(Unborne::Pressure(_))
        ));
        let gas = library::find("air").unwrap();
        let at_rest = gas.stressed(&pulled(-5e6), reference(&gas), [1e-6, 0.0]);
        assert_eq!(at_rest, Err(Unborne::Pressure(5e6)));
        let warm = gas.stressed(&pulled(-5e6), |_| 3e5, [1e-6, 0.0]).unwrap();
        let pressure = gas
            .eos
            .at(gas.reference_density, warm.density, 3e5)
            .pressure;
        assert!((pressure / 5e6 - 1.0).abs() < 1e-12, "{pressure}");
    }

    /// Below the elastic limit pores stay, beyond it they are where the crush curve has them.
    #[test]
    fn pores_are_crushed_from_the_start() {
        let mut rock = library::find("basalt-tillotson").unwrap();
        let law = Compaction::PAlpha(PAlpha {
            elastic_pressure: 1e8,
            solid_pressure: 1e9,
            exponent: 2.0,
            transition_pressure: 0.0,
            transition_distension: 1.0,
            transition_exponent: 1.0,
            sound_speed: 0.0,
        });
        let porosity = Porosity::new(1.25, law, rock.reference_density, &rock.eos);
        rock.reference_density = porosity.density;
        rock.porosity = Some(porosity);
        for (pressure, crushed) in [(5e7, 0.0), (4e8, (4e8 - 1e8) / 9e8), (2e9, 1.0)] {
            let stress = [-pressure, -pressure, -pressure, 0.0, 0.0, 0.0];
            let state = rock.stressed(&stress, |_| 0.0, [1e-3, 0.0]).unwrap();
            assert!((state.compaction - crushed).abs() < 1e-9, "{state:?}");
        }
    }
}
