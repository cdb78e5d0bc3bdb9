//! The columns of the tables of a run, and rows of them.

use super::load::{Group, Load};
use crate::output::{Column, Value, unit_of_model};
use engine::measure::{BodyFigures, Crossing, GaugeRow};
use engine::step::{LoadState, PairState, Passed, Removed, RigidState, RunState};

/// Columns with SI units, by length or area in a model of fewer dimensions. A name that ends with `*` is
/// that of three columns.
pub(crate) fn columns(dimension: usize, list: &[(&str, &str)]) -> Vec<Column> {
    let mut all = Vec::new();
    for (name, unit) in list {
        let unit = unit_of_model(unit, dimension);
        match name.strip_suffix('*') {
            Some(stem) => {
                let names = ["x", "y", "z"].map(|axis| format!("{stem}{axis}"));
                all.extend(names.iter().map(|name| Column::new(name, unit)));
            }
            None => all.push(Column::new(name, unit)),
        }
    }
    all
}

/// The cells of one row below a name: one, or three.
trait Cells<'a> {
    /// Adds them to a row.
    fn add(self, row: &mut Vec<Value<'a>>);
}

impl Cells<'_> for f64 {
    fn add(self, row: &mut Vec<Value>) {
        row.push(Value::Real(self));
    }
}

impl Cells<'_> for u64 {
    fn add(self, row: &mut Vec<Value>) {
        row.push(Value::Count(self));
    }
}

/// A missing time is NaN.
impl Cells<'_> for Option<f64> {
    fn add(self, row: &mut Vec<Value>) {
        row.push(Value::Real(self.unwrap_or(f64::NAN)));
    }
}

/// A missing count is an empty cell.
impl Cells<'_> for Option<u64> {
    fn add(self, row: &mut Vec<Value>) {
        row.push(self.map_or(Value::Word(""), Value::Count));
    }
}

impl<'a> Cells<'a> for &'a str {
    fn add(self, row: &mut Vec<Value<'a>>) {
        row.push(Value::Word(self));
    }
}

impl Cells<'_> for [f64; 3] {
    fn add(self, row: &mut Vec<Value>) {
        row.extend(self.map(Value::Real));
    }
}

/// Declares tables: a list of columns with their units, and the function that makes a row of them.
macro_rules! tables {
    ($(
        $(#[$doc:meta])+ $columns:ident, $row:ident($($given:ident: $type:ty),+) {
            $( $name:literal, $unit:literal, $value:expr; )+
        }
    )+) => { $(
        pub(crate) const $columns: &[(&str, &str)] = &[$( ($name, $unit) ),+];

        $(#[$doc])+
        pub(super) fn $row<'a>($($given: $type),+) -> Vec<Value<'a>> {
            let mut row = Vec::new();
            $( $value.add(&mut row); )+
            row
        }
    )+ };
}

tables! {
    /// A row of the history. In other forms than the conventional the number of uncorrected gradients
    /// follows, then the failed mass where a material may fail, self-gravity where there is any, and the departed mass and energy where
    /// there is a box of interest.
    HISTORY, history(state: &'a RunState) {
        "step", "", state.step;
        "time", "s", state.time;
        "dt", "s", state.last_dt;
        "dt_reason", "", state.last_reason.name();
        "kinetic_energy", "J", state.totals.kinetic_energy;
        "internal_energy", "J", state.totals.internal_energy;
        "contact_energy", "J", state.contact_energy;
        "gravity_energy", "J", state.totals.gravity_energy;
        "total_energy", "J", state.totals.energy();
        "momentum_*", "kg m/s", state.totals.momentum;
        "plane_impulse_*", "N s", state.plane_impulse;
        "load_work", "J", state.load_work();
        "load_impulse_*", "N s", state.load_impulse();
        "contact_work", "J", state.contact_work;
        "contact_heat", "J", state.contact_heat();
        "interpenetrated", "", state.interpenetrated.unsigned_abs();
        "angular_momentum_*", "kg m^2/s", state.totals.angular_momentum;
        "angular_impulse_*", "N m s", state.angular_impulse;
    }

    /// Cells of the history where a material may fail.
    FAILURE, failure(state: &'a RunState) {
        "failed_mass", "kg", state.totals.failed_mass;
        "failure_energy", "J", state.totals.failure_energy;
    }

    /// Cells of the history with self-gravity.
    SELF_GRAVITY, self_gravity(state: &'a RunState) {
        "self_gravity_energy", "J", state.self_gravity_energy;
        "tree_impulse_*", "N s", state.tree_impulse;
    }

    /// Cells of the history where there are absorbing zones.
    ABSORBED, absorbed(state: &'a RunState) {
        "yielded_mass_in_zones", "kg", state.totals.yielded_mass;
    }

    /// Cells of the history where there is a box of interest.
    DEPARTED, departed(state: &'a RunState) {
        "departed_mass", "kg", state.departed_mass();
        "departed_energy", "J", state.departed_energy();
    }

    /// A row of the contacts, of two bodies by name.
    CONTACTS, contact(time: f64, names: [&'a str; 2], pair: &PairState) {
        "time", "s", time;
        "body_a", "", names[0];
        "body_b", "", names[1];
        "force_*", "N", pair.force;
        "impulse_*", "N s", pair.impulse;
        "contact_energy", "J", pair.energy;
        "heat", "J", pair.heat;
        "peak_force", "N", pair.extremes.peak_force;
        "touching", "", pair.touching.unsigned_abs();
        "largest_excess", "", pair.extremes.largest_excess;
        "closest_pair", "spacings", pair.extremes.closest.map_or(f64::INFINITY, |c| c.distance);
        "closest_a", "", pair.extremes.closest.map(|c| c.particles[0]);
        "closest_b", "", pair.extremes.closest.map(|c| c.particles[1]);
        "contact_dt", "s", pair.extremes.contact_dt.unwrap_or(f64::INFINITY);
    }

    /// A row of the loads.
    LOADS, load_row(time: f64, name: &'a str, load: &LoadState) {
        "time", "s", time;
        "load", "", name;
        "force_*", "N", load.force;
        "impulse_*", "N s", load.impulse;
        "work", "J", load.work;
        "heat", "J", load.heat;
    }

    /// A row of a rigid body that forces move.
    RIGID, rigid_row(time: f64, body: &'a str, rigid: &RigidState) {
        "time", "s", time;
        "body", "", body;
        "place_*", "m", rigid.place;
        "velocity_*", "m/s", rigid.velocity;
        "spin_*", "rad/s", rigid.spin();
        "attitude_w", "", rigid.attitude[0];
        "attitude_*", "", [rigid.attitude[1], rigid.attitude[2], rigid.attitude[3]];
        "force_*", "N", rigid.force;
        "torque_*", "N m", rigid.torque;
    }

    /// A row of the particles removed from a body.
    REMOVED, removed(time: f64, body: &'a str, gone: &Removed) {
        "time", "s", time;
        "body", "", body;
        "particles", "", gone.particles;
        "mass", "kg", gone.mass;
        "momentum_*", "kg m/s", gone.momentum;
        "kinetic_energy", "J", gone.kinetic_energy;
        "internal_energy", "J", gone.internal_energy;
        "gravity_energy", "J", gone.gravity_energy;
    }

    /// Further cells of the particles that left the box of interest.
    DEPARTURE, departure(gone: &Removed) {
        "angular_momentum_*", "kg m^2/s", gone.angular_momentum;
        "first_time", "s", gone.times.map(|[first, _]| first);
        "last_time", "s", gone.times.map(|[_, last]| last);
    }

    /// A row of the performance, after `wall` seconds.
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    PERFORMANCE, performance(step: u64, wall: f64, load: &Load) {
        "step", "", step;
        "wall_seconds", "s", wall;
        "million_updates", "", load.updates as f64 * 1e-6;
        "particles", "", load.particles[0];
        "particle_imbalance", "", load.imbalance(load.particles);
        "work_imbalance", "", load.imbalance(load.work);
        "empty_ranks", "", load.empty_ranks;
        "messages", "", load.messages;
        "megabytes_sent", "MB", load.bytes as f64 * 1e-6;
    }

    /// A row of consecutive ranks.
    RANKS, rank_row(step: u64, group: &Group) {
        "step", "", step;
        "first_rank", "", group.ranks[0];
        "last_rank", "", group.ranks[1];
        "particles", "", group.particles;
        "work_over_mean", "", group.work;
    }

    /// A row of the sums over a body.
    BODIES, body_row(time: f64, name: &'a str, body: &BodyFigures) {
        "time", "s", time;
        "body", "", name;
        "particles", "", body.particles;
        "mass", "kg", body.mass;
        "momentum_*", "kg m/s", body.momentum;
        "angular_momentum_*", "kg m^2/s", body.angular_momentum;
        "kinetic_energy", "J", body.kinetic_energy;
        "internal_energy", "J", body.internal_energy;
        "plastic_energy", "J", body.plastic_energy;
        "velocity_*", "m/s", body.velocity;
        "least_velocity_*", "m/s", body.velocities[0];
        "largest_velocity_*", "m/s", body.velocities[1];
        "largest_speed", "m/s", body.speed;
        "centre_*", "m", body.centre;
        "lower_*", "m", body.extents[0];
        "upper_*", "m", body.extents[1];
        "failed_mass", "kg", body.failed_mass;
        "molten_mass", "kg", body.molten_mass;
        "least_pressure", "Pa", body.pressures[0];
        "largest_pressure", "Pa", body.pressures[1];
        "largest_temperature", "K", body.temperature;
        "largest_plastic_strain", "", body.plastic_strain;
    }

    /// Cells of a gauge before its readings.
    GAUGES, gauge_row(state: &RunState, name: &'a str, gauge: &GaugeRow) {
        "step", "", state.step;
        "time", "s", state.time;
        "gauge", "", name;
        "place_*", "m", gauge.position;
        "coverage", "", gauge.coverage;
    }

    /// A row of the particles that have passed a witness plane in a direction.
    WITNESS, witness_row(time: f64, names: [&'a str; 3], passed: &Passed) {
        "time", "s", time;
        "witness", "", names[0];
        "body", "", names[1];
        "direction", "", names[2];
        "particles", "", passed.particles;
        "mass", "kg", passed.mass;
        "momentum_*", "kg m/s", passed.momentum;
        "kinetic_energy", "J", passed.kinetic_energy;
        "internal_energy", "J", passed.internal_energy;
    }

    /// A row of a particle that has passed a witness plane.
    CROSSINGS, crossing_row(crossing: &Crossing, names: [&'a str; 3]) {
        "step", "", crossing.step;
        "time", "s", crossing.time;
        "witness", "", names[0];
        "body", "", names[1];
        "direction", "", names[2];
        "id", "", crossing.id;
        "place_*", "m", crossing.position;
        "velocity_*", "m/s", crossing.velocity;
        "mass", "kg", crossing.mass;
        "internal_energy", "J", crossing.internal_energy;
    }
}
