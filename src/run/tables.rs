//! The tables of a run.

use crate::comm::Comm;
use crate::model::{Case, SphForm, TroublePolicy};
use crate::output::{Column, OutputError, RunFolder, Table, Value, unit_of_model};
use crate::step::{PairState, RunState, Simulation};

/// The tables of a run, written by rank 0.
pub struct Tables {
    history: Table,
    contacts: Table,
    loads: Option<Table>,
    removed: Option<Table>,
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

/// The load of all ranks. Collective.
pub fn load(comm: &Comm, simulation: &Simulation) -> Load {
    let particles = simulation.store.owned() as u64;
    let work: u64 = simulation.store.work[..simulation.store.owned()]
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

/// Columns with SI units; what a model of fewer dimensions has is by length or area.
fn columns(dimension: usize, list: &[(&str, &str)]) -> Vec<Column> {
    list.iter()
        .map(|(name, unit)| Column::new(name, unit_of_model(unit, dimension)))
        .collect()
}

/// Of the history; with a count of uncorrected gradients but in the conventional form.
fn history_columns(case: &Case) -> Vec<Column> {
    let mut all = columns(
        case.dimension,
        &[
            ("step", ""),
            ("time", "s"),
            ("dt", "s"),
            ("dt_reason", ""),
            ("kinetic_energy", "J"),
            ("internal_energy", "J"),
            ("contact_energy", "J"),
            ("gravity_energy", "J"),
            ("total_energy", "J"),
            ("momentum_x", "kg m/s"),
            ("momentum_y", "kg m/s"),
            ("momentum_z", "kg m/s"),
            ("plane_impulse_x", "N s"),
            ("plane_impulse_y", "N s"),
            ("plane_impulse_z", "N s"),
            ("load_work", "J"),
            ("load_impulse_x", "N s"),
            ("load_impulse_y", "N s"),
            ("load_impulse_z", "N s"),
            ("contact_work", "J"),
            ("contact_heat", "J"),
            ("interpenetrated", ""),
        ],
    );
    if case.sph.form != SphForm::Conventional {
        all.push(Column::new("uncorrected", ""));
    }
    all
}

fn contact_columns(dimension: usize) -> Vec<Column> {
    columns(
        dimension,
        &[
            ("time", "s"),
            ("body_a", ""),
            ("body_b", ""),
            ("force_x", "N"),
            ("force_y", "N"),
            ("force_z", "N"),
            ("impulse_x", "N s"),
            ("impulse_y", "N s"),
            ("impulse_z", "N s"),
            ("contact_energy", "J"),
            ("heat", "J"),
            ("peak_force", "N"),
            ("touching", ""),
            ("largest_excess", ""),
            ("closest_pair", "spacings"),
            ("closest_a", ""),
            ("closest_b", ""),
            ("contact_dt", "s"),
        ],
    )
}

fn load_columns(dimension: usize) -> Vec<Column> {
    columns(
        dimension,
        &[
            ("time", "s"),
            ("load", ""),
            ("force_x", "N"),
            ("force_y", "N"),
            ("force_z", "N"),
            ("impulse_x", "N s"),
            ("impulse_y", "N s"),
            ("impulse_z", "N s"),
            ("work", "J"),
            ("heat", "J"),
        ],
    )
}

fn removed_columns(dimension: usize) -> Vec<Column> {
    columns(
        dimension,
        &[
            ("time", "s"),
            ("body", ""),
            ("particles", ""),
            ("mass", "kg"),
            ("momentum_x", "kg m/s"),
            ("momentum_y", "kg m/s"),
            ("momentum_z", "kg m/s"),
            ("kinetic_energy", "J"),
            ("internal_energy", "J"),
            ("gravity_energy", "J"),
        ],
    )
}

fn performance_columns() -> Vec<Column> {
    columns(
        3,
        &[
            ("step", ""),
            ("wall_seconds", "s"),
            ("million_updates", ""),
            ("particles", ""),
            ("particle_imbalance", ""),
            ("work_imbalance", ""),
            ("empty_ranks", ""),
            ("messages", ""),
            ("megabytes_sent", "MB"),
        ],
    )
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
        let dimension = case.dimension;
        Ok(Self {
            history: open(&folder.history(), &history_columns(case), "step", step)?,
            contacts: open(
                &folder.contacts(),
                &contact_columns(dimension),
                "time",
                time,
            )?,
            loads: (case.load_names().next().is_some())
                .then(|| open(&folder.loads(), &load_columns(dimension), "time", time))
                .transpose()?,
            removed: (case.trouble.policy != TroublePolicy::Stop
                || resume.is_some_and(|state| !state.removed.is_empty()))
            .then(|| open(&folder.removed(), &removed_columns(dimension), "time", time))
            .transpose()?,
            performance: open(&folder.performance(), &performance_columns(), "step", step)?,
        })
    }

    /// Writes a row of each.
    pub fn write(
        &mut self,
        simulation: &Simulation,
        load: &Load,
        wall: f64,
    ) -> Result<(), OutputError> {
        let state = &simulation.state;
        let totals = &state.totals;
        let [px, py, pz] = totals.momentum.map(Value::Real);
        let [ix, iy, iz] = state.plane_impulse.map(Value::Real);
        let [lx, ly, lz] = state.load_impulse().map(Value::Real);
        let mut row = vec![
            Value::Count(state.step),
            Value::Real(state.time),
            Value::Real(state.last_dt),
            Value::Word(state.last_reason.name()),
            Value::Real(totals.kinetic_energy),
            Value::Real(totals.internal_energy),
            Value::Real(state.contact_energy),
            Value::Real(totals.gravity_energy),
            Value::Real(totals.energy()),
            px,
            py,
            pz,
            ix,
            iy,
            iz,
            Value::Real(state.load_work()),
            lx,
            ly,
            lz,
            Value::Real(state.contact_work),
            Value::Real(state.contact_heat()),
            Value::Count(state.interpenetrated.unsigned_abs()),
        ];
        if simulation.case.sph.form != SphForm::Conventional {
            row.push(Value::Count(state.uncorrected.unsigned_abs()));
        }
        self.history.row(&row)?;
        let pairs = simulation.contact().active_pairs();
        for (bodies, pair) in pairs.iter().zip(&state.pairs) {
            let names = bodies.map(|b| simulation.case.bodies[b].name.as_str());
            self.write_pair(state.time, names, pair)?;
        }
        if let Some(table) = &mut self.loads {
            for (name, load) in simulation.case.load_names().zip(&state.loads) {
                let [fx, fy, fz] = load.force.map(Value::Real);
                let [ix, iy, iz] = load.impulse.map(Value::Real);
                let [time, work, heat] = [state.time, load.work, load.heat].map(Value::Real);
                table.row(&[time, Value::Word(name), fx, fy, fz, ix, iy, iz, work, heat])?;
            }
        }
        if let Some(table) = &mut self.removed {
            for (body, gone) in simulation.case.bodies.iter().zip(&state.removed) {
                let [px, py, pz] = gone.momentum.map(Value::Real);
                table.row(&[
                    Value::Real(state.time),
                    Value::Word(&body.name),
                    Value::Count(gone.particles),
                    Value::Real(gone.mass),
                    px,
                    py,
                    pz,
                    Value::Real(gone.kinetic_energy),
                    Value::Real(gone.internal_energy),
                    Value::Real(gone.gravity_energy),
                ])?;
            }
        }
        self.write_performance(state.step, load, wall)
    }

    /// Brings all rows written so far to the disk.
    pub fn sync(&self) -> Result<(), OutputError> {
        let always = [&self.history, &self.contacts, &self.performance];
        let some = [&self.loads, &self.removed];
        let mut all = always.into_iter().chain(some.into_iter().flatten());
        all.try_for_each(Table::sync)
    }

    fn write_pair(
        &mut self,
        time: f64,
        names: [&str; 2],
        pair: &PairState,
    ) -> Result<(), OutputError> {
        let [fx, fy, fz] = pair.force.map(Value::Real);
        let [ix, iy, iz] = pair.impulse.map(Value::Real);
        let (extremes, closest) = (&pair.extremes, pair.extremes.closest);
        let [id_a, id_b] = closest.map_or([Value::Word(""); 2], |closest| {
            closest.particles.map(Value::Count)
        });
        self.contacts.row(&[
            Value::Real(time),
            Value::Word(names[0]),
            Value::Word(names[1]),
            fx,
            fy,
            fz,
            ix,
            iy,
            iz,
            Value::Real(pair.energy),
            Value::Real(pair.heat),
            Value::Real(extremes.peak_force),
            Value::Count(pair.touching.unsigned_abs()),
            Value::Real(extremes.largest_excess),
            Value::Real(closest.map_or(f64::INFINITY, |closest| closest.distance)),
            id_a,
            id_b,
            Value::Real(extremes.contact_dt.unwrap_or(f64::INFINITY)),
        ])
    }

    #[allow(clippy::cast_precision_loss, reason = "for people")]
    fn write_performance(&mut self, step: u64, load: &Load, wall: f64) -> Result<(), OutputError> {
        let imbalance =
            |[sum, most]: [u64; 2]| most as f64 * load.ranks as f64 / (sum as f64).max(1.0);
        self.performance.row(&[
            Value::Count(step),
            Value::Real(wall),
            Value::Real(load.updates as f64 * 1e-6),
            Value::Count(load.particles[0]),
            Value::Real(imbalance(load.particles)),
            Value::Real(imbalance(load.work)),
            Value::Count(load.empty_ranks),
            Value::Count(load.messages),
            Value::Real(load.bytes as f64 * 1e-6),
        ])
    }
}
