//! The tables of a run.

use crate::comm::Comm;
use crate::model::{Case, NumericalFailurePolicy, SphForm};
use crate::output::{Column, OutputError, RunFolder, Table, Value, fragments, unit_of_model};
use crate::step::{LoadState, PairState, Removed, RunState, Simulation};

/// The tables of a run, written by rank 0.
pub struct Tables {
    history: Table,
    contacts: Table,
    loads: Option<Table>,
    removed: Option<Table>,
    departed: Option<Table>,
    fragments: Option<Table>,
    performance: Table,
}

/// How evenly the ranks are loaded, and what they have sent.
pub struct Load {
    ranks: usize,
    /// Of all ranks, and of the one with the most.
    pub particles: [u64; 2],
    work: [u64; 2],
    empty_ranks: u64,
    /// Sent so far.
    pub messages: u64,
    /// Sent so far.
    pub bytes: u64,
    /// Of particles, since the start of the process.
    pub updates: u64,
}

impl Load {
    /// The most that a rank has over the mean.
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    fn imbalance(&self, [sum, most]: [u64; 2]) -> f64 {
        most as f64 * self.ranks as f64 / (sum as f64).max(1.0)
    }
}

/// The load of all ranks. Collective.
pub fn load(comm: &Comm, simulation: &Simulation) -> Load {
    let particles = simulation.particles.owned() as u64;
    let work: u64 = simulation.particles.work[..simulation.particles.owned()]
        .iter()
        .map(|&work| u64::from(work))
        .sum();
    let (messages, bytes) = simulation.traffic();
    let empty = u64::from(particles == 0);
    let mut sums = [
        particles,
        work,
        messages,
        bytes,
        simulation.timers.updates,
        empty,
    ];
    comm.sum_u64(&mut sums);
    let mut most = [particles, work];
    comm.max_u64(&mut most);
    Load {
        ranks: comm.size(),
        particles: [sums[0], most[0]],
        work: [sums[1], most[1]],
        messages: sums[2],
        bytes: sums[3],
        updates: sums[4],
        empty_ranks: sums[5],
    }
}

/// Columns with SI units; what a model of fewer dimensions has is by length or area. A name that
/// ends with `*` is that of three columns.
fn columns(dimension: usize, list: &[(&str, &str)]) -> Vec<Column> {
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

/// What stands in one row below a name: one value, or three.
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

/// A time that is none yet is not a number.
impl Cells<'_> for Option<f64> {
    fn add(self, row: &mut Vec<Value>) {
        row.push(Value::Real(self.unwrap_or(f64::NAN)));
    }
}

/// Nothing is an empty cell.
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
        const $columns: &[(&str, &str)] = &[$( ($name, $unit) ),+];

        $(#[$doc])+
        fn $row<'a>($($given: $type),+) -> Vec<Value<'a>> {
            let mut row = Vec::new();
            $( $value.add(&mut row); )+
            row
        }
    )+ };
}

tables! {
    /// A row of the history; in other forms than the conventional a count of uncorrected gradients
    /// follows, where matter may fail what has, and where there is a box of interest what left it.
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

    /// What of a row of the history is told where matter may fail.
    FAILURE, failure(state: &'a RunState) {
        "failed_mass", "kg", state.totals.failed_mass;
        "failure_energy", "J", state.totals.failure_energy;
    }

    /// What of a row of the history is told where there are absorbing zones.
    ABSORBED, absorbed(state: &'a RunState) {
        "yielded_mass_in_zones", "kg", state.totals.yielded_mass;
    }

    /// What of a row of the history is told where there is a box of interest.
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

    /// A row of what was removed from a body.
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

    /// What is told besides of what left the box of interest.
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
}

impl Tables {
    /// Starts the tables of a run of `case`, or goes on with them after the state `resume`.
    pub fn open(
        folder: &RunFolder,
        case: &Case,
        resume: Option<&RunState>,
    ) -> Result<Self, OutputError> {
        let open =
            |path: &std::path::Path, columns: &[Column], key: &str, last: Option<f64>| match last {
                Some(last) => Table::resume(path, columns, key, last),
                None => Table::create(path, columns),
            };
        #[allow(clippy::cast_precision_loss, reason = "steps fit a double")]
        let step = resume.map(|state| state.step as f64);
        let time = resume.map(|state| state.time);
        let columns = |list| columns(case.dimension, list);
        let mut of_history = columns(HISTORY);
        if case.sph.form != SphForm::Conventional {
            of_history.push(Column::new("uncorrected", ""));
        }
        if case.may_fail() {
            of_history.extend(columns(FAILURE));
        }
        if !case.loads.absorbers.is_empty() {
            of_history.extend(columns(ABSORBED));
        }
        let departs =
            case.domain.keep.is_some() || resume.is_some_and(|state| !state.departed.is_empty());
        if departs {
            of_history.extend(columns(DEPARTED));
        }
        let of_departed = [columns(REMOVED), columns(DEPARTURE)].concat();
        let has_loads = case.load_names().next().is_some();
        let removes = case.numerical_limits.policy != NumericalFailurePolicy::Stop
            || resume.is_some_and(|state| !state.removed.is_empty());
        Ok(Self {
            history: open(&folder.history(), &of_history, "step", step)?,
            contacts: open(&folder.contacts(), &columns(CONTACTS), "time", time)?,
            loads: has_loads
                .then(|| open(&folder.loads(), &columns(LOADS), "time", time))
                .transpose()?,
            removed: removes
                .then(|| open(&folder.removed(), &columns(REMOVED), "time", time))
                .transpose()?,
            departed: departs
                .then(|| open(&folder.departed(), &of_departed, "time", time))
                .transpose()?,
            fragments: (case.fragments.is_some())
                .then(|| {
                    open(
                        &folder.fragments(),
                        &fragments::columns(case.dimension),
                        "time",
                        time,
                    )
                })
                .transpose()?,
            performance: open(&folder.performance(), &columns(PERFORMANCE), "step", step)?,
        })
    }

    /// Writes a row of each, after `wall` seconds.
    pub fn write(
        &mut self,
        simulation: &Simulation,
        load: &Load,
        wall: f64,
    ) -> Result<(), OutputError> {
        let (case, state) = (&simulation.case, &simulation.state);
        let mut row = history(state);
        if case.sph.form != SphForm::Conventional {
            row.push(Value::Count(state.uncorrected.unsigned_abs()));
        }
        if case.may_fail() {
            row.extend(failure(state));
        }
        if !case.loads.absorbers.is_empty() {
            row.extend(absorbed(state));
        }
        if self.departed.is_some() {
            row.extend(departed(state));
        }
        self.history.row(&row)?;
        let pairs = simulation.contact().active_pairs();
        for (bodies, pair) in pairs.iter().zip(&state.pairs) {
            let names = bodies.map(|b| case.bodies[b].name.as_str());
            self.contacts.row(&contact(state.time, names, pair))?;
        }
        if let Some(table) = &mut self.loads {
            for (name, load) in case.load_names().zip(&state.loads) {
                table.row(&load_row(state.time, name, load))?;
            }
        }
        if let Some(table) = &mut self.removed {
            for (body, gone) in case.bodies.iter().zip(&state.removed) {
                table.row(&removed(state.time, &body.name, gone))?;
            }
        }
        if let Some(table) = &mut self.departed {
            for (body, gone) in case.bodies.iter().zip(&state.departed) {
                let mut row = removed(state.time, &body.name, gone);
                row.extend(departure(gone));
                table.row(&row)?;
            }
        }
        self.performance.row(&performance(state.step, wall, load))
    }

    /// Writes a row of fragments.
    pub fn write_fragments(&mut self, row: &[Value]) -> Result<(), OutputError> {
        self.fragments
            .as_mut()
            .map_or(Ok(()), |table| table.row(row))
    }

    /// Brings all rows written so far to the disk.
    pub fn sync(&self) -> Result<(), OutputError> {
        let always = [&self.history, &self.contacts, &self.performance];
        let some = [&self.loads, &self.removed, &self.departed, &self.fragments];
        let mut all = always.into_iter().chain(some.into_iter().flatten());
        all.try_for_each(Table::sync)
    }
}
