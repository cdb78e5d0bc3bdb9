//! Between the sweeps: the stress of stress points, that of viscosity included, by the geometry of
//! their fits gives the moments that pull at velocity particles.

use rayon::prelude::*;

use particles::{GRAIN, ParticleStore};
use sums::momentum::Viscosity;
use sums::normalised::stress_power;
use sums::stress_points::{moment, viscous_stress};

/// Moments of this rank's stress points from their stress, that of viscosity included, and their
/// power.
pub(super) fn find_moments(viscosity: Viscosity, particles: &mut ParticleStore) {
    let owned = particles.owned();
    let point = PointView {
        stress_mass: &particles.stress_mass,
        predicted_density: &particles.predicted_density,
        density: &particles.density,
        pressure: &particles.pressure,
        deviatoric_stress: &particles.deviatoric_stress,
        predicted_gradient: &particles.predicted_gradient,
        sound_speed: &particles.sound_speed,
        smoothing_length: &particles.smoothing_length,
        viscosity,
    };
    (
        &mut particles.stress_moment[..owned],
        &mut particles.stress_offset[..owned],
        &mut particles.specific_stress,
        &mut particles.d_specific_energy_dt,
        &mut particles.approach_speed,
        &mut particles.fit_norm,
    )
        .into_par_iter()
        .with_min_len(GRAIN)
        .enumerate()
        .for_each(|(i, (moment, offset, specific, power, approach, norm))| {
            if point.stress_mass[i] > 0.0 {
                (*power, *approach) = point.stress(i, moment, offset, specific);
            } else {
                (*moment, *offset, *norm) = ([0.0; 9], [0.0; 3], 0.0);
            }
        });
}

/// Inputs of the stress of a stress point.
struct PointView<'a> {
    stress_mass: &'a [f64],
    predicted_density: &'a [f64],
    density: &'a [f64],
    pressure: &'a [f64],
    deviatoric_stress: &'a [[f64; 6]],
    predicted_gradient: &'a [[f64; 9]],
    sound_speed: &'a [f64],
    smoothing_length: &'a [f64],
    viscosity: Viscosity,
}

impl PointView<'_> {
    /// Turns the geometry of the fit of point `i` into its moment; gives its power (W/kg) and the
    /// approach speed for the time step (m/s).
    #[inline]
    fn stress(
        &self,
        i: usize,
        inverse: &mut [f64; 9],
        offset: &mut [f64; 3],
        specific: &mut [f64; 6],
    ) -> (f64, f64) {
        let l = &self.predicted_gradient[i];
        let (mut total, approach) = viscous_stress(
            l,
            self.density[i],
            self.sound_speed[i],
            self.smoothing_length[i],
            &self.viscosity,
        );
        for c in 0..6 {
            total[c] += self.deviatoric_stress[i][c];
        }
        let pressure = self.pressure[i];
        let density = self.predicted_density[i];
        let power = stress_power(pressure, &total, l, density);
        for a in 0..3 {
            total[a] -= pressure;
        }
        for c in 0..6 {
            specific[c] = total[c] / density;
        }
        let volume = self.stress_mass[i] / density;
        (*inverse, *offset) = moment(&total, volume, inverse, offset);
        (power, approach)
    }
}
