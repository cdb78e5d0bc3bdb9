//! The scalar state of a run: what a step reads before it writes it, beside the particles.

use serde::{Deserialize, Deserializer, Serialize};

use super::reason::Reason;
use super::remembered::Remembered;
use super::taken_out::Removed;
use crate::contact::{PairExtremes, PairSums, SurfaceForces};
use crate::loads::{Loads, RigidState};
use numerics::vector::{dot, norm};

/// Ledger of one pair of bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairState {
    /// The two bodies, the smaller index first; one body twice for its parts.
    pub bodies: [usize; 2],
    /// Force of the second body on the first now (N).
    pub force: [f64; 3],
    /// Its time integral (N s).
    pub impulse: [f64; 3],
    /// Contact energy between the two now (J).
    pub energy: f64,
    /// Heat by friction and damping now (W).
    #[serde(default)]
    pub heat_power: f64,
    /// Its time integral (J).
    #[serde(default)]
    pub heat: f64,
    /// Particles with excess now.
    pub touching: i64,
    /// Their extremes since the last row of tables.
    #[serde(default)]
    pub extremes: PairExtremes,
}

/// The nearest two particles of any two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NearestPair {
    /// Their distance in mean spacings.
    pub distance: f64,
    /// Their bodies.
    pub bodies: [usize; 2],
    /// Their identities.
    pub particles: [u64; 2],
}

impl NearestPair {
    /// The nearer two, with any order where they are as near.
    pub(super) fn min(self, other: Self) -> Self {
        let order = |c: &Self| (c.distance.to_bits(), c.bodies, c.particles);
        if order(&other) < order(&self) {
            other
        } else {
            self
        }
    }
}

impl PairState {
    /// True if the two bodies have pushed each other, or have been within reach since the last row.
    #[must_use]
    pub fn has_met(&self) -> bool {
        self.extremes.closest.is_some() || self.touching > 0 || self.impulse != [0.0; 3]
    }

    /// Takes the sums of a step of which dt (s) is left to book; none if there are none. Forces `along`
    /// an axis are those of no symmetry plane normal to it.
    pub(super) fn book(&mut self, sums: Option<&PairSums>, along: [bool; 3], dt: f64) {
        let force = sums.map_or([0.0; 3], |s| std::array::from_fn(|a| s.force[a].value()));
        let heat_power = sums.map_or(0.0, |s| s.heat.value());
        self.force = force;
        for (impulse, force) in self.impulse.iter_mut().zip(force) {
            *impulse += 0.5 * dt * force;
        }
        self.energy = sums.map_or(0.0, |s| s.energy.value());
        self.heat_power = heat_power;
        self.heat += 0.5 * dt * heat_power;
        self.touching = sums.map_or(0, |s| s.touching);
        self.extremes.peak_force = self.extremes.peak_force.max(norm(&force));
        let along = std::array::from_fn(|a| if along[a] { force[a] } else { 0.0 });
        self.extremes.peak_along = self.extremes.peak_along.max(norm(&along));
    }
}

/// Ledger of what acts from outside: a load, a rigid body, an absorbing zone, a rigid surface.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadState {
    /// Force on the model (N): the mean of the last step, of surfaces that of now.
    pub force: [f64; 3],
    /// Torque on the model about the axis of a surface that turns (N m), now.
    #[serde(default)]
    pub torque: f64,
    /// Impulse given to the model so far (N s).
    pub impulse: [f64; 3],
    /// Work done on the model so far (J).
    pub work: f64,
    /// Heat by friction and damping of a surface now (W).
    #[serde(default)]
    pub heat_power: f64,
    /// Its time integral (J).
    #[serde(default)]
    pub heat: f64,
}

/// Particles that have passed a witness plane in one direction so far (SI).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Passed {
    /// Number of particles, each as often as it passed.
    pub particles: u64,
    /// `Σ m` (kg).
    pub mass: f64,
    /// `Σ m v` (kg m/s).
    pub momentum: [f64; 3],
    /// `Σ ½ m v²` (J).
    pub kinetic_energy: f64,
    /// `Σ m e` (J).
    pub internal_energy: f64,
}

/// Sums over all particles that are no part of a driven body (SI).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Totals {
    /// `Σ ½ m v²` (J).
    pub kinetic_energy: f64,
    /// `Σ m e` (J).
    pub internal_energy: f64,
    /// Φ (J).
    pub contact_energy: f64,
    /// `−Σ m g·x` (J), zero at the origin.
    pub gravity_energy: f64,
    /// `½ Σ m φ` of self-gravity (J).
    #[serde(default)]
    pub self_gravity_energy: f64,
    /// `Σ m` (kg).
    pub mass: f64,
    /// `Σ m v` (kg m/s).
    pub momentum: [f64; 3],
    /// `Σ |m v|` (kg m/s).
    pub momentum_scale: f64,
    /// `Σ x × m v` about the origin (kg m²/s).
    #[serde(default)]
    pub angular_momentum: [f64; 3],
    /// Mass that has failed (kg).
    #[serde(default)]
    pub failed_mass: f64,
    /// Elastic energy that it held when it failed (J), which is part of the internal energy.
    #[serde(default)]
    pub failure_energy: f64,
    /// Mass in absorbing zones that has yielded or failed (kg).
    #[serde(default)]
    pub yielded_mass: f64,
}

impl Totals {
    /// Kinetic, internal and contact energy and that of gravity from outside and by itself together (J).
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.kinetic_energy
            + self.internal_energy
            + self.contact_energy
            + self.gravity_energy
            + self.self_gravity_energy
    }
}

/// A body that has left the total form.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Torn {
    /// Index of the body.
    pub body: usize,
    /// When it left it (s).
    pub time: f64,
    /// Why.
    pub tear: Tear,
}

/// Reason for which a body leaves the total form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tear {
    /// Two of its particles meet that began far from each other.
    Fold,
    /// A particle expands that limits tension.
    Void,
    /// A particle has been strained more than its deformation gradient tells.
    Slip,
    /// A particle has been turned inside out.
    Inversion,
    /// A particle has failed.
    Failure,
    /// A particle has been taken out.
    Removal,
}

impl Tear {
    /// All reasons, by their words.
    pub(crate) const ALL: [Self; 6] = [
        Self::Fold,
        Self::Void,
        Self::Slip,
        Self::Inversion,
        Self::Failure,
        Self::Removal,
    ];

    /// Number of a reason in messages, from 1 on.
    pub(crate) fn word(self) -> u64 {
        self as u64 + 1
    }
}

/// The scalar state of a run; equal on all ranks, saved with each checkpoint.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunState {
    /// Steps done.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// The next time step by candidates (s), infinite where there are none; the end of the case may
    /// clip it.
    #[serde(deserialize_with = "step_or_none")]
    pub dt: f64,
    /// Limit that sets it.
    pub dt_reason: Reason,
    /// The time step just done (s).
    pub last_dt: f64,
    /// Limit that set that.
    pub last_reason: Reason,
    /// Sums at the start.
    pub initial: Totals,
    /// Sums at the last diagnosis.
    pub totals: Totals,
    /// Contact energy after the last step (J).
    pub contact_energy: f64,
    /// Work done by contact forces on all bodies so far (J).
    pub contact_work: f64,
    /// Force of the symmetry planes on the model now (N).
    pub plane_force: [f64; 3],
    /// Its time integral, particles that crossed a plane included (N s).
    pub plane_impulse: [f64; 3],
    /// Potential energy of self-gravity after the last step (J).
    #[serde(default)]
    pub self_gravity_energy: f64,
    /// Force of self-gravity on the model now but for that of images (N), which only the error of its tree makes.
    #[serde(default)]
    pub tree_force: [f64; 3],
    /// Its time integral (N s).
    #[serde(default)]
    pub tree_impulse: [f64; 3],
    /// Number of crossings of symmetry planes by particles so far.
    #[serde(default)]
    pub plane_crossings: i64,
    /// Torque about the origin of symmetry planes, rigid surfaces, gravity and the error of its tree now (N m).
    #[serde(default)]
    pub outside_torque: [f64; 3],
    /// Angular impulse about the origin of these, of loads and of rigid bodies so far (N m s).
    #[serde(default)]
    pub angular_impulse: [f64; 3],
    /// Largest `Σ |(x − x̄) × m v|` about the centre of mass so far (kg m²/s); none in states of
    /// programs that did not sum it.
    #[serde(default)]
    pub angular_momentum_scale: Option<f64>,
    /// Largest of these so far, of any component (N m s).
    #[serde(default)]
    pub angular_momentum_put_in: f64,
    /// Ledgers of the pairs of bodies that have come into reach of each other, in the order of their bodies.
    pub pairs: Vec<PairState>,
    /// Ledgers of prescribed velocities, rigid bodies, absorbing zones and rigid surfaces.
    pub loads: Vec<LoadState>,
    /// Largest kinetic energy so far (J).
    #[serde(default)]
    pub most_kinetic_energy: f64,
    /// Largest `Σ |m v|` so far (kg m/s).
    #[serde(default)]
    pub most_momentum: f64,
    /// Largest work of loads and gravity so far (J).
    pub work_put_in: f64,
    /// Largest impulse of loads and gravity so far (N s).
    pub momentum_put_in: f64,
    /// Particles whose relief was capped at the start.
    pub capped_reliefs: i64,
    /// The most interpenetrated particles in a step since the last row of tables.
    pub interpenetrated: i64,
    /// Particles whose gradient has no correction now, in the normalised form.
    pub uncorrected: i64,
    /// Sums that removed particles took with them, by body; empty as long as there are none.
    #[serde(default)]
    pub removed: Vec<Removed>,
    /// Contact energy that went with them (J).
    #[serde(default)]
    pub removed_contact_energy: f64,
    /// Potential energy of self-gravity that went with them (J).
    #[serde(default)]
    pub removed_self_gravity_energy: f64,
    /// Sums that particles that left the box of interest took with them, by body; empty as long as
    /// the case has none.
    #[serde(default)]
    pub departed: Vec<Removed>,
    /// Contact energy that went with them (J).
    #[serde(default)]
    pub departed_contact_energy: f64,
    /// Potential energy of self-gravity that went with them (J).
    #[serde(default)]
    pub departed_self_gravity_energy: f64,
    /// Ids of the particles that carry gauges, in the order of these.
    #[serde(default)]
    pub gauge_carriers: Vec<u64>,
    /// Crossings of the witness planes: by plane, body and direction, along the normal first.
    #[serde(default)]
    pub passed: Vec<Passed>,
    /// Memory of the measures, in their order.
    #[serde(default)]
    pub remembered: Vec<Remembered>,
    /// By body: whether it has the total form; empty in states of programs without it.
    #[serde(default)]
    pub total: Vec<bool>,
    /// Bodies that have left the total form, in turn.
    #[serde(default)]
    pub torn: Vec<Torn>,
    /// Factor by which initial neighbours of the total form may be farther apart than they were; zero without.
    #[serde(default)]
    pub stretch: f64,
    /// Rigid bodies that forces move.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rigid: Vec<RigidState>,
    /// Largest values over the run.
    pub worst: Worst,
}

/// Reads an infinite step, for which JSON has `null` alone.
fn step_or_none<'a, D: Deserializer<'a>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::INFINITY))
}

impl RunState {
    /// The ledger of a pair of bodies, a new one for those that have not met so far.
    pub(super) fn pair(&mut self, bodies: [usize; 2]) -> &mut PairState {
        let found = self.pairs.binary_search_by_key(&bodies, |pair| pair.bodies);
        let at = found.unwrap_or_else(|at| {
            let new = PairState {
                bodies,
                ..PairState::default()
            };
            self.pairs.insert(at, new);
            at
        });
        &mut self.pairs[at]
    }

    /// Notes which bodies have the total form at a time (s), which ones have left it, and the factor by which neighbours may
    /// be farther apart.
    pub(crate) fn book_forms(
        &mut self,
        time: f64,
        stretch: f64,
        tear: impl Fn(usize) -> Option<Tear>,
    ) {
        self.stretch = stretch;
        for (body, total) in self.total.iter_mut().enumerate() {
            if let Some(tear) = tear(body).filter(|_| *total) {
                *total = false;
                self.torn.push(Torn { body, time, tear });
            }
        }
    }

    /// The step to do now and what limits it: the smallest candidate, unless the case ends before,
    /// at `end` (s).
    pub(crate) fn next_step(&self, end: f64) -> (f64, Reason) {
        let left = end - self.time;
        if left <= self.dt {
            (left, Reason::End)
        } else {
            (self.dt, self.dt_reason)
        }
    }

    /// Work done by all loads so far (J).
    #[must_use]
    pub fn load_work(&self) -> f64 {
        self.loads.iter().map(|load| load.work).sum()
    }

    /// Heat by friction and damping of contact so far (J).
    #[must_use]
    pub fn contact_heat(&self) -> f64 {
        self.pairs.iter().map(|pair| pair.heat).sum::<f64>()
            + self.loads.iter().map(|load| load.heat).sum::<f64>()
    }

    /// Impulse given by all loads so far (N s).
    #[must_use]
    pub fn load_impulse(&self) -> [f64; 3] {
        std::array::from_fn(|a| self.loads.iter().map(|load| load.impulse[a]).sum())
    }

    /// Impulse of symmetry planes, rigid surfaces and pairs in the first half of a step `dt` (s).
    pub(crate) fn book_first_half(&mut self, loads: &Loads, dt: f64) {
        self.book_surfaces(loads, dt, true);
        for a in 0..3 {
            self.plane_impulse[a] += 0.5 * dt * self.plane_force[a];
            self.angular_impulse[a] += 0.5 * dt * self.outside_torque[a];
            self.tree_impulse[a] += 0.5 * dt * self.tree_force[a];
        }
        for pair in &mut self.pairs {
            for a in 0..3 {
                pair.impulse[a] += 0.5 * dt * pair.force[a];
            }
            pair.heat += 0.5 * dt * pair.heat_power;
        }
    }

    /// Impulse and work of the rigid surfaces in a half of a step `dt` (s). The work is also what
    /// contact takes from the surfaces.
    fn book_surfaces(&mut self, loads: &Loads, dt: f64, first: bool) {
        let ledgers = &mut self.loads[loads.driven()..];
        for (ledger, step) in ledgers.iter_mut().zip(&loads.surfaces) {
            let impulse = ledger.force.map(|f| 0.5 * dt * f);
            let (velocity, rate) = step.in_half(first);
            let work = dot(&impulse, &velocity) + 0.5 * dt * ledger.torque * rate;
            for a in 0..3 {
                ledger.impulse[a] += impulse[a];
            }
            ledger.work += work;
            ledger.heat += 0.5 * dt * ledger.heat_power;
            self.contact_work -= work;
        }
    }

    /// Impulses and work of loads, after the second half of a step `dt` (s); forgets their sums.
    pub(super) fn book_loads(&mut self, loads: &mut Loads, surfaces: &SurfaceForces, dt: f64) {
        let driven = loads.driven();
        for (ledger, sums) in self.loads.iter_mut().zip(&mut loads.sums) {
            for a in 0..3 {
                let impulse = sums[a].value();
                // Sums without a step leave the mean of the last one.
                if dt > 0.0 {
                    ledger.force[a] = impulse * (1.0 / dt);
                }
                ledger.impulse[a] += impulse;
            }
            ledger.work += sums[3].value();
            *sums = Default::default();
        }
        let ledgers = self.loads[driven..].iter_mut();
        for (ledger, push) in ledgers.zip(&surfaces.sums) {
            ledger.force = std::array::from_fn(|a| push[a].value());
            ledger.torque = push[3].value();
        }
        let ledgers = self.loads[driven..].iter_mut();
        for (ledger, heat) in ledgers.zip(&surfaces.heat) {
            ledger.heat_power = heat.value();
        }
        self.book_surfaces(loads, dt, false);
        self.work_put_in = self.work_put_in.max(self.load_work().abs());
    }

    /// Begins the next interval between rows of tables: extremes are of what comes from now on.
    pub fn begin_interval(&mut self) {
        self.interpenetrated = 0;
        for pair in &mut self.pairs {
            pair.extremes = PairExtremes::default();
        }
    }
}

/// Largest deviations over a run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Worst {
    /// |total energy − first value − work of loads| (J).
    pub energy_deviation: f64,
    /// |contact work + Φ − Φ(0)| (J).
    pub contact_deviation: f64,
    /// |momentum − first value − impulses of planes, loads, gravity and the error of its tree| (kg m/s), by component.
    pub momentum_deviation: [f64; 3],
    /// `energy_deviation` over the largest kinetic energy so far, or over the work put in if that is more.
    pub energy_error: f64,
    /// `contact_deviation` over the same.
    pub contact_defect: f64,
    /// `momentum_deviation` over the largest Σ|m v| so far, or over the impulse put in if that is more.
    pub momentum_error: [f64; 3],
    /// |angular momentum − first value − angular impulses| (kg m²/s), by component.
    #[serde(default)]
    pub angular_momentum_deviation: [f64; 3],
    /// `angular_momentum_deviation` over the largest Σ|(x − x̄) × m v| so far, or over the angular impulse put
    /// in if that is more.
    #[serde(default)]
    pub angular_momentum_error: [f64; 3],
    /// Interpenetrated particles.
    pub interpenetrated: i64,
    /// Particles whose gradient has no correction, in the normalised form.
    pub uncorrected: i64,
    /// Smallest foreign distance in mean spacings.
    pub closest: Option<f64>,
    /// Whose it is, as of the last diagnosis or checkpoint.
    #[serde(default)]
    pub nearest: Option<NearestPair>,
    /// Largest foreign fraction.
    pub foreign_fraction: f64,
    /// Steps that the contact criterion limited.
    pub contact_limited_steps: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_that_nobody_limits_is_read_again() {
        #[derive(Serialize, Deserialize)]
        struct Step {
            #[serde(deserialize_with = "step_or_none")]
            dt: f64,
        }
        for dt in [f64::INFINITY, 1.0 / 3.0] {
            let text = serde_json::to_string(&Step { dt }).unwrap();
            let read: Step = serde_json::from_str(&text).unwrap();
            assert_eq!(read.dt.to_bits(), dt.to_bits());
        }
    }
}
