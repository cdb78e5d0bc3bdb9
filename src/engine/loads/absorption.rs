//! Absorbing zones in the step, see the page on loads.
//!
//! At the rate γ of its place a particle is slowed down against the velocity at which its body
//! began, in each half kick by the mean of its velocities before and after, and its stress relaxes
//! towards that of the body's first state along with the elastic energy that it holds. What goes
//! is booked.

use rayon::prelude::*;

use super::{Loads, Prescribe, Prescribed};
use crate::loads::VelocityStage;
use material::FAILED;
use model::Case;
use numerics::exact_sum::ExactSum;
use numerics::vector::{cross, dot};
use particles::{GRAIN, ParticleStore};

/// The absorbing zones and the relaxation of a case in the current step.
#[derive(Debug, Default)]
pub(crate) struct Absorption {
    zones: Vec<Zone>,
    /// Rates of the relaxation by body (1/s); empty without.
    relaxing: Vec<f64>,
    /// When it ends (s).
    until: f64,
    /// True if it acts in this step.
    relaxes: bool,
    /// By body, the velocity of its matter before waves come (m/s).
    rest: Vec<[f64; 3]>,
    /// A quarter of the step (s).
    quarter: f64,
}

/// The zone of one body.
#[derive(Debug, Clone, Copy)]
struct Zone {
    body: u32,
    /// Of the first state (kg/m³).
    density: f64,
    /// ∂p/∂ρ of the reference state (m²/s²).
    stiffness: f64,
    /// Of the reference state (Pa).
    shear_modulus: f64,
}

/// Motion of a particle beside forces in a case with absorbing zones, a relaxation or pressures on faces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Absorbed {
    prescribed: Prescribed,
    /// Rate of the zone (1/s).
    rate: f64,
    /// `1/(1 + ¼ γ Δt)`.
    share: f64,
    rest: [f64; 3],
    /// Acceleration by pressures on faces (m/s²).
    push: [f64; 3],
}

impl Absorbed {
    /// The same under pressures on faces that accelerate it (m/s²).
    #[inline(always)]
    pub fn pushed(self, push: [f64; 3]) -> Self {
        Self { push, ..self }
    }

    /// Mean velocity (m/s) in a half kick of `half` a step (s) of matter at the velocity `v` (m/s) that forces accelerate
    /// by `total` (m/s²).
    #[inline(always)]
    pub fn mean(
        &self,
        stage: VelocityStage,
        v: &[f64; 3],
        half: f64,
        total: &mut [f64; 3],
    ) -> [f64; 3] {
        let per_half = if half > 0.0 { 1.0 / half } else { 0.0 };
        self.accelerate(stage, v, per_half, total);
        std::array::from_fn(|a| v[a] + 0.5 * half * total[a])
    }

    /// Acceleration (m/s²) of matter at the velocity `v` (m/s) that forces accelerate by `total`.
    #[inline(always)]
    fn slowed(&self, v: &[f64; 3], total: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| (total[a] - self.rate * (v[a] - self.rest[a])) * self.share)
    }
}

impl Prescribe for Absorbed {
    #[inline(always)]
    fn accelerate(&self, stage: VelocityStage, v: &[f64; 3], per_half: f64, total: &mut [f64; 3]) {
        let pushed = std::array::from_fn(|a| total[a] + self.push[a]);
        *total = self.slowed(v, &pushed);
        self.prescribed.accelerate(stage, v, per_half, total);
    }

    #[inline(always)]
    fn set(&self, stage: VelocityStage, v: &mut [f64; 3]) {
        self.prescribed.set(stage, v);
    }

    #[inline(always)]
    fn correct_mean(&self, whole: &[f64; 3], middle: &[f64; 3], mean: &mut [f64; 3]) {
        if self.rate > 0.0 || self.push != [0.0; 3] {
            *mean = std::array::from_fn(|a| 0.5 * (whole[a] + middle[a]));
        }
        self.prescribed.correct_mean(whole, middle, mean);
    }

    #[inline(always)]
    fn is_rigid(&self) -> bool {
        self.prescribed.is_rigid()
    }

    #[inline(always)]
    fn push(&self) -> [f64; 3] {
        self.push
    }
}

impl Absorption {
    pub fn new(case: &Case) -> Self {
        let zones = case.loads.absorbers.iter().map(|absorber| {
            let body = &case.bodies[absorber.body];
            let material = &case.materials[body.material];
            let density = material.reference_density;
            Zone {
                body: u32::try_from(absorber.body).unwrap_or(u32::MAX),
                density: case.initial_density(body),
                stiffness: material.bulk_modulus() / density,
                shear_modulus: material.shear_modulus(),
            }
        });
        let zones: Vec<Zone> = zones.collect();
        let rest = case.bodies.iter().map(|body| body.velocity.into());
        let relaxation = case.loads.relaxation.as_ref();
        Self {
            rest: rest.collect(),
            zones,
            relaxing: relaxation.map_or_else(Vec::new, |relaxation| relaxation.rates.clone()),
            until: relaxation.map_or(0.0, |relaxation| relaxation.until),
            relaxes: false,
            quarter: 0.0,
        }
    }

    /// True if there are zones or a relaxation.
    pub fn is_any(&self) -> bool {
        self.count() > 0
    }

    /// Number of zones, and one for a relaxation.
    pub fn count(&self) -> usize {
        self.zones.len() + usize::from(!self.relaxing.is_empty())
    }

    pub fn memory(&self) -> usize {
        size_of::<Zone>() * self.zones.capacity()
            + size_of::<[f64; 3]>() * self.rest.capacity()
            + size_of::<f64>() * self.relaxing.capacity()
    }

    /// Goes on to a step between two times (s).
    pub fn prepare(&mut self, from: f64, to: f64) {
        self.quarter = 0.25 * (to - from);
        self.relaxes = from < self.until;
    }

    /// Rate of the relaxation of a body (1/s).
    #[inline(always)]
    pub fn relaxing(&self, body: u32) -> f64 {
        if self.relaxes {
            self.relaxing
                .get(body as usize)
                .copied()
                .unwrap_or_default()
        } else {
            0.0
        }
    }

    /// Rate (1/s) of a particle of `body` that begins at `place` (m).
    pub fn rate(case: &Case, body: usize, place: &[f64; 3]) -> f64 {
        let mut absorbers = case.loads.absorbers.iter();
        let absorber = absorbers.find(|absorber| absorber.body == body);
        absorber.map_or(0.0, |absorber| {
            let material = &case.materials[case.bodies[body].material];
            let speed = material.longitudinal_speed();
            absorber.rate(place, speed)
        })
    }

    /// Motion of a particle of a body that has a rate (1/s) and to which this is prescribed.
    #[inline(always)]
    pub fn of(&self, prescribed: Prescribed, body: u32, rate: f64) -> Absorbed {
        Absorbed {
            prescribed,
            rate,
            share: 1.0 / (1.0 + self.quarter * rate),
            rest: self.rest[body as usize],
            push: [0.0; 3],
        }
    }

    /// Share of the stress that a step leaves: as that of velocity, which two half kicks leave.
    fn kept(&self, rate: f64) -> f64 {
        let lost = self.quarter * rate;
        let half = ((1.0 - lost) / (1.0 + lost)).max(0.0);
        half * half
    }
}

impl Loads {
    /// True if there are absorbing zones.
    pub(crate) fn absorb(&self) -> bool {
        !self.absorption.zones.is_empty()
    }

    /// Books impulse and work of absorbing zones and relaxation in a half kick of the step that is about to come.
    pub(crate) fn book_drag(&mut self, particles: &ParticleStore) {
        let absorption = &self.absorption;
        let half = 2.0 * absorption.quarter;
        for n in 0..absorption.count() {
            let rate = |i: usize| match absorption.zones.get(n) {
                Some(zone) if zone.body == particles.body[i] => particles.absorption[i],
                Some(_) => 0.0,
                None => absorption.relaxing(particles.body[i]),
            };
            let all = self.sum_where(
                particles,
                |i| rate(i) > 0.0,
                |i| {
                    let prescribed = self.of(particles.load.get(i).copied().unwrap_or_default());
                    let contact = particles.contact_acceleration.get(i);
                    let contact = contact.copied().unwrap_or_default();
                    let push = self.push(particles, i);
                    let v = &particles.velocity[i];
                    let forces: [f64; 3] = std::array::from_fn(|a| {
                        (particles.acceleration[i][a] + (contact[a] + self.gravity[a])) + push[a]
                    });
                    let absorbed = absorption.of(prescribed, particles.body[i], rate(i));
                    let slowed = absorbed.slowed(v, &forces);
                    let impulse: [f64; 3] = std::array::from_fn(|a| match prescribed.by[a] {
                        Some(_) => 0.0,
                        None => particles.mass[i] * half * (slowed[a] - forces[a]),
                    });
                    let mean = std::array::from_fn(|a| v[a] + 0.5 * half * slowed[a]);
                    let [x, y, z] = impulse;
                    let [turn_x, turn_y, turn_z] = cross(&particles.position[i], &impulse);
                    [x, y, z, dot(&impulse, &mean), turn_x, turn_y, turn_z]
                },
            );
            let (sums, turn) = all.split_at(4);
            let ledger = &mut self.sums[self.motions.len() + n];
            for (sum, part) in ledger.iter_mut().zip(sums) {
                sum.merge(part);
            }
            for (sum, part) in self.angular_impulse.iter_mut().zip(turn) {
                sum.merge(part);
            }
        }
    }

    /// Relaxes the stress in absorbing zones after a step, takes out the elastic energy that it held,
    /// and books that as work.
    pub(crate) fn relax(&mut self, particles: &mut ParticleStore) {
        if self.absorption.quarter == 0.0 {
            return;
        }
        for (n, zone) in self.absorption.zones.iter().enumerate() {
            let work = zone.relax(&self.absorption, particles);
            self.sums[self.motions.len() + n][3].merge(&work);
        }
    }
}

impl Zone {
    /// True if it holds a particle of a body with this rate (1/s).
    #[inline(always)]
    fn holds(&self, rate: f64, body: u32) -> bool {
        rate > 0.0 && body == self.body
    }

    /// Relaxes the stress of the zone's particles; gives the work on them (J), that is minus the
    /// energy that they lose.
    fn relax(&self, absorption: &Absorption, particles: &mut ParticleStore) -> ExactSum {
        let owned = particles.owned();
        let (rates, body, damage) = (&particles.absorption, &particles.body, &particles.damage);
        let has_failed = |i: usize| damage.get(i).is_some_and(|&damage| damage >= FAILED);
        let (mass, stress_mass) = (&particles.mass, &particles.stress_mass);
        let pressure = &particles.pressure;
        (
            particles.density[..owned].par_chunks_mut(GRAIN),
            particles.deviatoric_stress[..owned].par_chunks_mut(GRAIN),
            particles.specific_energy[..owned].par_chunks_mut(GRAIN),
        )
            .into_par_iter()
            .enumerate()
            // same bits in any order: exact sums are integers
            .fold(ExactSum::default, |mut work, (chunk, (rho, s, e))| {
                for k in 0..e.len() {
                    let i = chunk * GRAIN + k;
                    if !self.holds(rates[i], body[i]) || has_failed(i) {
                        continue;
                    }
                    let kept = absorption.kept(rates[i]);
                    let change = self.relax_point(kept, pressure[i], &mut rho[k], &mut s[k]);
                    e[k] += change;
                    let mass = mass[i] + stress_mass.get(i).copied().unwrap_or_default();
                    work.add(mass * change);
                }
                work
            })
            // same bits in any order, as above
            .reduce(ExactSum::default, |mut all, part| {
                all.merge(&part);
                all
            })
    }

    /// Leaves `kept` of the deviatoric stress (Pa) and of the density (kg/m³) beyond that of the first
    /// state; gives the elastic energy (J/kg) of the reference moduli that comes with it, positive if
    /// it is put in.
    #[inline(always)]
    fn relax_point(&self, kept: f64, p: f64, density: &mut f64, stress: &mut [f64; 6]) -> f64 {
        let before = *density;
        let after = self.density + kept * (before - self.density);
        *density = after;
        let mean = p + 0.5 * self.stiffness * (after - before);
        let mut change = mean * (1.0 / before - 1.0 / after);
        if self.shear_modulus > 0.0 {
            let [xx, yy, zz, xy, xz, yz] = *stress;
            let square = (xx * xx + yy * yy + zz * zz) + 2.0 * (xy * xy + xz * xz + yz * yz);
            change -= (1.0 - kept * kept) * square / (4.0 * self.shear_modulus * before);
            for component in stress {
                *component *= kept;
            }
        }
        change
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ZONE: Zone = Zone {
        body: 0,
        density: 2700.0,
        stiffness: 2.8e7,
        shear_modulus: 2.6e10,
    };

    /// A wave's energy ½ M ε² of a strain ε, half of what it carries, is what relaxation takes.
    #[test]
    fn elastic_energy_goes_with_the_stress() {
        let strain = -1e-4;
        let mut density = ZONE.density * (1.0 - strain);
        let p = -strain * ZONE.stiffness * ZONE.density;
        let lateral = -2.0 / 3.0 * ZONE.shear_modulus * strain;
        let mut stress = [-2.0 * lateral, lateral, lateral, 0.0, 0.0, 0.0];
        let mut gone = 0.0;
        for _ in 0..200 {
            let p = p * (density / ZONE.density - 1.0) / -strain;
            gone -= ZONE.relax_point(0.9, p, &mut density, &mut stress);
        }
        let modulus = ZONE.stiffness * ZONE.density + 4.0 / 3.0 * ZONE.shear_modulus;
        let held = 0.5 * modulus * strain * strain / ZONE.density;
        assert!((gone / held - 1.0).abs() < 3e-4, "{gone} of {held}");
        assert!((density / ZONE.density - 1.0).abs() < 1e-12);
    }

    /// However long the step is, nothing is turned round by more than it was.
    #[test]
    fn any_step_is_bounded() {
        for rate in [0.0, 1e-3, 1.0, 1e3, 1e9] {
            let mut absorption = Absorption {
                rest: vec![[1.0, 0.0, 0.0]],
                ..Absorption::default()
            };
            absorption.prepare(0.0, 1.0);
            let kept = absorption.kept(rate);
            assert!((0.0..=1.0).contains(&kept), "{kept}");
            let slowed = absorption.of(Prescribed::default(), 0, rate);
            let a = slowed.slowed(&[3.0, 0.0, 0.0], &[0.0; 3])[0];
            assert!((3.0 + 0.5 * a - 1.0).abs() <= 2.0, "{a}");
        }
    }
}
