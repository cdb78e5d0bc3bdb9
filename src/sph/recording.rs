//! What particles remember of a material update: plastic work, and the extremes so far.

use super::step::Step;
use super::sums::Sums;
use crate::material::{FAILED, LANES, Material, PointBatch};
use crate::particles::{Records, Scatter};

/// Books updates in the records of particles.
pub(super) struct Recording<'a> {
    records: Records<'a>,
    materials: &'a [Material],
    /// Pressure (Pa) that has arrived, by material.
    arrival: &'a [f64],
    /// End of the step (s).
    time: f64,
}

impl<'a> Recording<'a> {
    /// Of a step; nothing if no particle keeps records.
    pub fn new(records: Records<'a>, sums: &'a Sums, step: &Step) -> Option<Self> {
        records.any().then_some(Self {
            records,
            materials: &sums.materials,
            arrival: &sums.arrival,
            time: step.time,
        })
    }

    /// Books what an update has made of points of the material `own`: bit k of `lanes` is set if
    /// lane k is one of them, particle `particles[k]`.
    ///
    /// A function of its own: inside the sweep it slows down cases without records.
    ///
    /// # Safety
    /// No other thread may read or write the records of these particles.
    #[inline(never)]
    pub unsafe fn book(
        &self,
        own: usize,
        [before, after]: [&PointBatch; 2],
        lanes: u8,
        particles: &[usize; LANES],
    ) {
        let records = &self.records;
        for k in (0..LANES).filter(|k| lanes >> k & 1 == 1) {
            let (i, pressure) = (particles[k], after.pressure[k]);
            // SAFETY: by this function's contract; no reference outlives its statement.
            unsafe {
                add(&records.plastic_energy, i, || {
                    plastic_work(before, after, k)
                });
                if raise(&records.peak_pressure, i, || pressure) {
                    *records.peak_pressure_time.slot(i) = self.time;
                }
                raise(&records.peak_tension, i, || -pressure);
                raise(&records.peak_strain_rate, i, || strain_rate(before, k));
                raise(&records.peak_temperature, i, || {
                    let material = &self.materials[own];
                    let work = self.plastic_energy(i);
                    let energy = material.thermal_energy(after.specific_energy[k], work);
                    let temperature =
                        material.temperature(after.density[k], energy, after.damage[k]);
                    temperature.unwrap_or_default()
                });
                self.arrive(i, pressure > self.arrival[own]);
            }
        }
    }

    /// Plastic work (J/kg) so far of particle `i`.
    ///
    /// # Safety
    /// No other thread may write the records of this particle.
    #[inline(always)]
    pub unsafe fn plastic_energy(&self, i: usize) -> f64 {
        let work = &self.records.plastic_energy;
        if work.is_empty() {
            0.0
        } else {
            // SAFETY: by this function's contract.
            unsafe { *work.slot(i) }
        }
    }

    /// Notes that pressure has arrived at particle `i`, if it has not before.
    ///
    /// # Safety
    /// As of [`Self::book`].
    #[inline(always)]
    unsafe fn arrive(&self, i: usize, arrived: bool) {
        let times = &self.records.arrival_time;
        if arrived && !times.is_empty() {
            // SAFETY: by this function's contract; no reference outlives its statement.
            let time = unsafe { times.slot(i) };
            if *time == 0.0 {
                *time = self.time;
            }
        }
    }
}

/// Adds to a record, if it is kept.
///
/// # Safety
/// No other thread may read or write it.
#[inline(always)]
unsafe fn add(record: &Scatter<f64>, i: usize, more: impl FnOnce() -> f64) {
    if !record.is_empty() {
        // SAFETY: by this function's contract.
        unsafe { *record.slot(i) += more() };
    }
}

/// Raises a record, if it is kept; whether it was raised.
///
/// # Safety
/// No other thread may read or write it.
#[inline(always)]
unsafe fn raise(record: &Scatter<f64>, i: usize, value: impl FnOnce() -> f64) -> bool {
    if record.is_empty() {
        return false;
    }
    // SAFETY: by this function's contract.
    let (record, value) = (unsafe { record.slot(i) }, value());
    let raised = value > *record;
    if raised {
        *record = value;
    }
    raised
}

/// Plastic work (J/kg) of an update at point `k`: equivalent stress on the yield surface times the
/// plastic strain of the step, over the density. Matter that fails in the step has let go of its
/// stress, so the one before counts.
fn plastic_work(before: &PointBatch, after: &PointBatch, k: usize) -> f64 {
    let strain = after.plastic_strain[k] - before.plastic_strain[k];
    if strain == 0.0 {
        return 0.0;
    }
    let held = if after.damage[k] >= FAILED {
        before
    } else {
        after
    };
    let s = |c: usize| held.deviatoric_stress[c][k];
    let normal = s(0) * s(0) + s(1) * s(1) + s(2) * s(2);
    let shear = s(3) * s(3) + s(4) * s(4) + s(5) * s(5);
    (1.5 * (normal + 2.0 * shear)).sqrt() * strain / after.density[k]
}

/// Equivalent strain rate `√(2/3 d':d')` (1/s) at point `k`, of the deviatoric rate of deformation
/// `d'` in the middle of the step.
fn strain_rate(point: &PointBatch, k: usize) -> f64 {
    let l = |c: usize| point.velocity_gradient[c][k];
    let mean = (l(0) + l(4) + l(8)) / 3.0;
    let normal = [l(0) - mean, l(4) - mean, l(8) - mean];
    let shear = [l(1) + l(3), l(2) + l(6), l(5) + l(7)];
    let square = |v: [f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    (2.0 / 3.0 * (square(normal) + 0.5 * square(shear))).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_and_rates_are_those_of_uniaxial_and_simple_shear() {
        let mut point = PointBatch::ZERO;
        // Uniaxial rate of a solid that keeps its volume, and simple shear.
        for (c, l) in [(0, 2.0), (4, -1.0), (8, -1.0)] {
            point.velocity_gradient[c][0] = l;
        }
        point.velocity_gradient[1][1] = 3.0;
        assert!((strain_rate(&point, 0) - 2.0).abs() < 1e-15);
        assert!((strain_rate(&point, 1) - 3.0_f64.sqrt()).abs() < 1e-15);

        let mut after = point;
        after.density = [2.0; LANES];
        for (c, s) in [(0, 4.0), (1, -2.0), (2, -2.0)] {
            after.deviatoric_stress[c][0] = s;
        }
        after.plastic_strain[0] = 0.01;
        assert!((plastic_work(&point, &after, 0) - 6.0 * 0.01 / 2.0).abs() < 1e-15);
        after.damage[0] = 1.0;
        assert!(plastic_work(&point, &after, 0).abs() < 1e-15);
    }
}
