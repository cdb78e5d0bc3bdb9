//! The tables of a run.

use super::columns::{
    ABSORBED, BODIES, CONTACTS, DEPARTED, DEPARTURE, FAILURE, HISTORY, LOADS, PERFORMANCE, REMOVED,
    absorbed, body_row, columns, contact, departed, departure, failure, history, load_row,
    performance, removed,
};
use super::load::Load;
use crate::measure::BodyFigures;
use crate::model::{Case, NumericalFailurePolicy, SphForm};
use crate::output::{Column, OutputError, RunFolder, Table, Value};
use crate::step::{RunState, Simulation};

/// The tables of a run, written by rank 0.
pub struct Tables {
    history: Table,
    contacts: Table,
    loads: Option<Table>,
    removed: Option<Table>,
    departed: Option<Table>,
    bodies: Option<Table>,
    performance: Table,
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
            bodies: (case.measure.bodies)
                .then(|| open(&folder.bodies(), &columns(BODIES), "time", time))
                .transpose()?,
            performance: open(&folder.performance(), &columns(PERFORMANCE), "step", step)?,
        })
    }

    /// Writes a row of each, after `wall` seconds; `bodies` are measured where the case asks for it.
    pub fn write(
        &mut self,
        simulation: &Simulation,
        bodies: &[BodyFigures],
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
        if let Some(table) = &mut self.bodies {
            for (body, figures) in case.bodies.iter().zip(bodies) {
                table.row(&body_row(state.time, &body.name, figures))?;
            }
        }
        self.performance.row(&performance(state.step, wall, load))
    }

    /// Brings all rows written so far to the disk.
    pub fn sync(&self) -> Result<(), OutputError> {
        let always = [&self.history, &self.contacts, &self.performance];
        let some = [&self.loads, &self.removed, &self.departed, &self.bodies];
        let mut all = always.into_iter().chain(some.into_iter().flatten());
        all.try_for_each(Table::sync)
    }
}
