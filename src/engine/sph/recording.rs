//! Records of material updates by particles: plastic work, and the extremes so far.

use super::shared::Sums;
use material::{FAILED, LANES, Lanes as Numbers, Material, PointBatch};
use numerics::dispatch::{Vectorised, instructions};
use numerics::lane_matrix::dot;
use numerics::lanes::Lanes;
use particles::{Records, Scatter};
use sums::step::Step;

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

    /// Books what an update has made of points of the material `own` and told of them, `before_failure`: bit k of
    /// `lanes` is set if lane k is one of them, particle `particles[k]`.
    ///
    /// A function of its own: inside the sweep it slows down cases without records.
    ///
    /// # Safety
    /// No other thread may read or write the records of these particles.
    #[inline(never)]
    pub unsafe fn book(
        &self,
        own: usize,
        points: [&PointBatch; 2],
        before_failure: &Numbers,
        lanes: u8,
        particles: &[usize; LANES],
    ) {
        let booking = Booking {
            recording: self,
            own,
            points,
            before_failure,
            lanes,
            particles,
        };
        instructions().run(booking);
    }

    /// Plastic work (J/kg) so far of eight particles; zero where it is not kept.
    ///
    /// # Safety
    /// No other thread may write the records of these particles.
    #[inline(always)]
    pub unsafe fn plastic_energy(&self, particles: &[usize; LANES]) -> [f64; LANES] {
        let work = &self.records.plastic_energy;
        if work.is_empty() {
            return [0.0; LANES];
        }
        let mut all = [0.0; LANES];
        for k in 0..LANES {
            // SAFETY: by this function's contract.
            all[k] = unsafe { *work.slot(particles[k]) };
        }
        all
    }
}

/// One update that is booked. Whoever makes it has the records of its particles alone.
struct Booking<'a> {
    recording: &'a Recording<'a>,
    own: usize,
    points: [&'a PointBatch; 2],
    /// Pressures (Pa) of the equation of state.
    before_failure: &'a Numbers,
    lanes: u8,
    particles: &'a [usize; LANES],
}

impl Vectorised for Booking<'_> {
    type Output = ();

    /// Each record by itself: what is not kept costs nothing, and the numbers of eight points are told at once.
    #[inline(always)]
    fn run<V: Lanes>(self) {
        let (records, time) = (&self.recording.records, self.recording.time);
        let [before, after] = self.points;
        if !records.plastic_energy.is_empty() {
            self.book_work();
        }
        if !records.peak_pressure.is_empty() {
            self.raise(&records.peak_pressure, V::read(&after.pressure), |i| {
                // SAFETY: as of [`Recording::book`].
                unsafe { *records.peak_pressure_time.slot(i) = time };
            });
        }
        if !records.peak_tension.is_empty() {
            let tension = V::splat(0.0).sub(V::read(&after.pressure));
            self.raise(&records.peak_tension, tension, |_| ());
        }
        if !records.peak_strain_rate.is_empty() {
            let rates = strain_rates::<V>(before);
            self.raise(&records.peak_strain_rate, rates, |_| ());
        }
        if !records.peak_temperature.is_empty() {
            self.book_temperature::<V>();
        }
        if !records.arrival_time.is_empty() {
            self.arrive(V::read(&after.pressure));
        }
    }
}

impl Booking<'_> {
    /// Calls `book` with each lane that is booked and its particle.
    #[inline(always)]
    fn each(&self, mut book: impl FnMut(usize, usize)) {
        for (k, &i) in self.particles.iter().enumerate() {
            if self.lanes >> k & 1 == 1 {
                book(k, i);
            }
        }
    }

    /// Adds plastic work.
    #[inline(always)]
    fn book_work(&self) {
        let [before, after] = self.points;
        let work = &self.recording.records.plastic_energy;
        self.each(|k, i| {
            let more = plastic_work(before, after, k);
            if more != 0.0 {
                // SAFETY: as of [`Recording::book`].
                unsafe { *work.slot(i) += more };
            }
        });
    }

    /// Raises the temperatures. Matter that has cooled down since its shock is told by its energy alone.
    #[inline(always)]
    fn book_temperature<V: Lanes>(&self) {
        let (record, after) = (&self.recording.records.peak_temperature, self.points[1]);
        let material = &self.recording.materials[self.own];
        let Some(thermal) = &material.thermal else {
            return;
        };
        // Stored energy heats nothing, so all of the energy is a bound, too.
        let most: V = thermal.most(&after.specific_energy);
        if self.above(record, most) == 0 {
            return;
        }
        // SAFETY: as of [`Recording::book`].
        let work = unsafe { self.recording.plastic_energy(self.particles) };
        if let Some(temperatures) = material.updated_temperatures(after, &work, self.before_failure)
        {
            self.raise(record, V::read(&temperatures), |_| ());
        }
    }

    /// Lanes with values above a record.
    #[inline(always)]
    fn above<V: Lanes>(&self, record: &Scatter<f64>, values: V) -> u8 {
        let mut held = [0.0; LANES];
        for k in 0..LANES {
            // SAFETY: as of [`Recording::book`].
            held[k] = unsafe { *record.slot(self.particles[k]) };
        }
        V::read(&held).less_than(values) & self.lanes
    }

    /// Raises a record to values, and calls `raised` with the particles where it does. Mostly it does nowhere.
    #[inline(always)]
    fn raise<V: Lanes>(&self, record: &Scatter<f64>, values: V, raised: impl Fn(usize)) {
        let mut above = self.above(record, values);
        if above == 0 {
            return;
        }
        let values = values.store().0;
        while above != 0 {
            let k = above.trailing_zeros() as usize;
            above &= above - 1;
            let i = self.particles[k];
            // SAFETY: as of [`Recording::book`].
            unsafe { *record.slot(i) = values[k] };
            raised(i);
        }
    }

    /// Notes that pressure has arrived where it has not before.
    #[inline(always)]
    fn arrive<V: Lanes>(&self, pressure: V) {
        let times = &self.recording.records.arrival_time;
        let arrival = V::splat(self.recording.arrival[self.own]);
        let mut above = arrival.less_than(pressure) & self.lanes;
        while above != 0 {
            let k = above.trailing_zeros() as usize;
            above &= above - 1;
            // SAFETY: as of [`Recording::book`].
            let time = unsafe { times.slot(self.particles[k]) };
            if *time == 0.0 {
                *time = self.recording.time;
            }
        }
    }
}

/// Plastic work (J/kg) of an update at point `k`: equivalent stress on the yield surface times the
/// plastic strain of the step, over the density. Matter that fails in the step has let go of its
/// stress, so the one before counts.
fn plastic_work(before: &PointBatch, after: &PointBatch, k: usize) -> f64 {
    let strain = after.plastic_strain[k] - before.plastic_strain[k];
    if strain == 0.0 {
        return 0.0;
    }
    let fails = after.damage[k] >= FAILED && before.damage[k] < FAILED;
    let held = if fails { before } else { after };
    let s = |c: usize| held.deviatoric_stress[c][k];
    let normal = s(0) * s(0) + s(1) * s(1) + s(2) * s(2);
    let shear = s(3) * s(3) + s(4) * s(4) + s(5) * s(5);
    (1.5 * (normal + 2.0 * shear)).sqrt() * strain / after.density[k]
}

/// Equivalent strain rates `√(2/3 d':d')` (1/s), of the deviatoric rates of deformation `d'` in the middle of
/// the step.
#[inline(always)]
fn strain_rates<V: Lanes>(points: &PointBatch) -> V {
    let l = &points.velocity_gradient;
    let [xx, yy, zz] = [V::read(&l[0]), V::read(&l[4]), V::read(&l[8])];
    let mean = xx.add(yy).add(zz).mul(V::splat(1.0 / 3.0));
    let normal = [xx.sub(mean), yy.sub(mean), zz.sub(mean)];
    let mut shear = [V::splat(0.0); 3];
    for (c, [a, b]) in [[1, 3], [2, 6], [5, 7]].into_iter().enumerate() {
        shear[c] = V::read(&l[a]).add(V::read(&l[b]));
    }
    let all = V::splat(0.5).mul_add(dot(&shear, &shear), dot(&normal, &normal));
    V::splat(2.0 / 3.0).mul(all).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use numerics::lanes::F64x8;

    #[test]
    fn work_and_rates_are_those_of_uniaxial_and_simple_shear() {
        let mut point = PointBatch::ZERO;
        // Uniaxial rate of a solid that keeps its volume, and simple shear.
        for (c, l) in [(0, 2.0), (4, -1.0), (8, -1.0)] {
            point.velocity_gradient[c][0] = l;
        }
        point.velocity_gradient[1][1] = 3.0;
        let rates = strain_rates::<F64x8>(&point).store().0;
        assert!((rates[0] - 2.0).abs() < 1e-15);
        assert!((rates[1] - 3.0_f64.sqrt()).abs() < 1e-15);

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
