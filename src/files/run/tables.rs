//! The tables of a run.

use std::path::Path;

use super::columns::{
    ABSORBED, BODIES, CONTACTS, CROSSINGS, DEPARTED, DEPARTURE, FAILURE, GAUGES, HISTORY, LOADS,
    PERFORMANCE, RANKS, REMOVED, RIGID, SELF_GRAVITY, WITNESS, absorbed, body_row, columns,
    contact, crossing_row, departed, departure, failure, gauge_row, history, load_row, performance,
    rank_row, removed, rigid_row, self_gravity, witness_row,
};
use super::load::Load;
use crate::output::gauge_records::{self, GaugeRecords};
use crate::output::{
    Column, OutputError, RunFolder, Table, TableExtent, Value, fragments, measures,
};
use engine::measure::{BodyFigures, Crossing, Findings, GaugeRow};
use engine::step::{RunState, Simulation, measurements};
use model::{Case, NumericalFailurePolicy, SphForm};

/// The tables of a run, written by rank 0.
pub struct Tables {
    history: Table,
    contacts: Table,
    loads: Option<Table>,
    rigid: Option<Table>,
    removed: Option<Table>,
    departed: Option<Table>,
    fragments: Option<Table>,
    bodies: Option<Table>,
    /// Figures of measures, and their distributions.
    measures: Option<[Table; 2]>,
    gauges: Option<Table>,
    /// In place of these where there are many gauges.
    gauge_records: Option<GaugeRecords>,
    /// Sums over the particles that have passed witness planes, and the particles.
    witnesses: Option<[Table; 2]>,
    performance: Table,
    ranks: Table,
}

/// The directions through a witness plane, that of its normal first.
const DIRECTIONS: [&str; 2] = ["forwards", "backwards"];

/// The columns of the history of a case, from whose box of interest particles may have departed.
fn of_history(case: &Case, departs: bool) -> Vec<Column> {
    let columns = |list| columns(case.extent(), list);
    let mut all = columns(HISTORY);
    if case.sph.form != SphForm::Conventional {
        all.push(Column::new("uncorrected", ""));
    }
    if case.may_fail() {
        all.extend(columns(FAILURE));
    }
    if case.loads.self_gravity.is_some() {
        all.extend(columns(SELF_GRAVITY));
    }
    if !case.loads.absorbers.is_empty() {
        all.extend(columns(ABSORBED));
    }
    if departs {
        all.extend(columns(DEPARTED));
    }
    all
}

/// Starts a table, or continues it after the last value of a column.
fn open(
    folder: &RunFolder,
    path: &Path,
    columns: &[Column],
    key: &str,
    last: Option<f64>,
) -> Result<Table, OutputError> {
    open_stating(folder, path, columns, 1, (key, last))
}

/// The same of a table that states the share that is computed, of a model of several copies of that.
fn open_stating(
    folder: &RunFolder,
    path: &Path,
    columns: &[Column],
    copies: u32,
    (key, last): (&str, Option<f64>),
) -> Result<Table, OutputError> {
    folder.list(path)?;
    match last {
        Some(last) => Table::resume(path, columns, copies, key, last),
        None => Table::create(path, columns, copies),
    }
}

/// The tables of measures, if the case has any, after a time (s).
fn of_measures(
    folder: &RunFolder,
    case: &Case,
    time: Option<f64>,
) -> Result<Option<[Table; 2]>, OutputError> {
    if case.measure.measures.is_empty() {
        return Ok(None);
    }
    let figures = open(
        folder,
        &folder.measures(),
        &measures::of_figures(),
        "time",
        time,
    )?;
    let others = measures::of_distributions();
    let distributions = open(folder, &folder.distributions(), &others, "time", time)?;
    Ok(Some([figures, distributions]))
}

/// The columns of gauges.
fn of_gauges(simulation: &Simulation) -> Vec<Column> {
    let mut all = columns(simulation.case.extent(), GAUGES);
    let readings = simulation.gauges().columns();
    all.extend(readings.map(|(name, unit)| Column::new(&name, unit)));
    all
}

/// Records of the gauges of a case.
fn records(folder: &RunFolder, case: &Case, columns: Vec<Column>) -> GaugeRecords {
    let gauges = case.measure.gauges.iter();
    GaugeRecords::new(folder, columns, gauges.map(|g| g.name.clone()).collect())
}

impl Tables {
    /// Starts the tables of a run, or continues them after the state `resume`.
    pub fn open(
        folder: &RunFolder,
        simulation: &Simulation,
        resume: Option<&RunState>,
    ) -> Result<Self, OutputError> {
        let case = &simulation.case;
        #[allow(clippy::cast_precision_loss, reason = "steps fit a double")]
        let step = resume.map(|state| state.step as f64);
        let time = resume.map(|state| state.time);
        let columns = |list| columns(case.extent(), list);
        let departs =
            case.domain.keep.is_some() || resume.is_some_and(|state| !state.departed.is_empty());
        let of_history = of_history(case, departs);
        let of_departed = [columns(REMOVED), columns(DEPARTURE)].concat();
        let of_gauges = of_gauges(simulation);
        let many = case.measure.gauges.len() >= gauge_records::MANY;
        let has_loads = case.load_names().next().is_some();
        let removes = case.numerical_limits.policy != NumericalFailurePolicy::Stop
            || resume.is_some_and(|state| !state.removed.is_empty());
        let copies = measurements::images(simulation).copies();
        let stating = |path: &Path, columns: &[Column]| {
            open_stating(folder, path, columns, copies, ("time", time))
        };
        Ok(Self {
            history: open_stating(
                folder,
                &folder.history(),
                &of_history,
                copies,
                ("step", step),
            )?,
            contacts: stating(&folder.contacts(), &columns(CONTACTS))?,
            loads: has_loads
                .then(|| stating(&folder.loads(), &columns(LOADS)))
                .transpose()?,
            rigid: (!simulation.state.rigid.is_empty())
                .then(|| stating(&folder.rigid(), &columns(RIGID)))
                .transpose()?,
            removed: removes
                .then(|| stating(&folder.removed(), &columns(REMOVED)))
                .transpose()?,
            departed: departs
                .then(|| stating(&folder.departed(), &of_departed))
                .transpose()?,
            fragments: (case.fragments.is_some())
                .then(|| {
                    let columns = fragments::columns(case.extent());
                    open(folder, &folder.fragments(), &columns, "time", time)
                })
                .transpose()?,
            bodies: (case.measure.bodies)
                .then(|| open(folder, &folder.bodies(), &columns(BODIES), "time", time))
                .transpose()?,
            measures: of_measures(folder, case, time)?,
            gauges: (simulation.gauges().any() && !many)
                .then(|| open(folder, &folder.gauges(), &of_gauges, "step", step))
                .transpose()?,
            gauge_records: many.then(|| records(folder, case, of_gauges)),
            witnesses: (!case.measure.witnesses.is_empty())
                .then(|| {
                    let passed = open(folder, &folder.witness(), &columns(WITNESS), "time", time)?;
                    let crossings = open(
                        folder,
                        &folder.crossings(),
                        &columns(CROSSINGS),
                        "step",
                        step,
                    )?;
                    Ok([passed, crossings])
                })
                .transpose()?,
            performance: open(
                folder,
                &folder.performance(),
                &columns(PERFORMANCE),
                "step",
                step,
            )?,
            ranks: open(folder, &folder.ranks(), &columns(RANKS), "step", step)?,
        })
    }

    /// Writes a row of each, after `wall` seconds; `bodies` are empty where they are not measured.
    pub fn write(
        &mut self,
        simulation: &Simulation,
        whole: &RunState,
        bodies: &[BodyFigures],
        load: &Load,
        wall: f64,
    ) -> Result<(), OutputError> {
        let (case, state) = (&simulation.case, &simulation.state);
        let told = |table: &Table| {
            if table.is_of_whole() { whole } else { state }
        };
        self.write_history(case, told(&self.history))?;
        let pairs = told(&self.contacts).pairs.iter();
        for pair in pairs.filter(|pair| pair.has_met()) {
            let names = pair.bodies.map(|b| case.bodies[b].name.as_str());
            self.contacts.row(&contact(state.time, names, pair))?;
        }
        if let Some(table) = &mut self.loads {
            for (name, load) in case.load_names().zip(&told(table).loads) {
                table.row(&load_row(state.time, name, load))?;
            }
        }
        if let Some(table) = &mut self.rigid {
            for rigid in &told(table).rigid {
                let body = &case.bodies[rigid.body].name;
                table.row(&rigid_row(state.time, body, rigid))?;
            }
        }
        if let Some(table) = &mut self.removed {
            for (body, gone) in case.bodies.iter().zip(&told(table).removed) {
                table.row(&removed(state.time, &body.name, gone))?;
            }
        }
        if let Some(table) = &mut self.departed {
            for (body, gone) in case.bodies.iter().zip(&told(table).departed) {
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
        self.write_passed(case, whole)?;
        let groups = load.by_group();
        self.ranks
            .rows(groups.map(|group| rank_row(state.step, &group)))?;
        self.performance.row(&performance(state.step, wall, load))
    }

    /// Writes a row of fragments.
    pub fn write_fragments(&mut self, row: &[Value]) -> Result<(), OutputError> {
        self.fragments
            .as_mut()
            .map_or(Ok(()), |table| table.row(row))
    }

    fn write_history(&mut self, case: &Case, state: &RunState) -> Result<(), OutputError> {
        let mut row = history(state);
        if case.sph.form != SphForm::Conventional {
            row.push(Value::Count(state.uncorrected.unsigned_abs()));
        }
        if case.may_fail() {
            row.extend(failure(state));
        }
        if case.loads.self_gravity.is_some() {
            row.extend(self_gravity(state));
        }
        if !case.loads.absorbers.is_empty() {
            row.extend(absorbed(state));
        }
        if self.departed.is_some() {
            row.extend(departed(state));
        }
        self.history.row(&row)
    }

    /// Writes sums over the particles that have passed witness planes.
    fn write_passed(&mut self, case: &Case, whole: &RunState) -> Result<(), OutputError> {
        if let Some([table, _]) = &mut self.witnesses {
            let mut passed = whole.passed.iter();
            for plane in &case.measure.witnesses {
                for body in &case.bodies {
                    for (direction, passed) in DIRECTIONS.into_iter().zip(&mut passed) {
                        let names = [&plane.name, &body.name, direction];
                        table.row(&witness_row(whole.time, names, passed))?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Writes the readings of gauges in this step.
    pub fn write_gauges(
        &mut self,
        simulation: &Simulation,
        read: &[GaugeRow],
    ) -> Result<(), OutputError> {
        let state = &simulation.state;
        if let Some(records) = &mut self.gauge_records {
            for gauge in read {
                let values = gauge.values.iter().map(|value| value.unwrap_or(f64::NAN));
                let numbers = gauge.position.into_iter().chain([gauge.coverage]);
                let number = u32::try_from(gauge.gauge).unwrap_or(u32::MAX);
                records.add(state.step, state.time, number, numbers.chain(values));
            }
            return records.write_much();
        }
        let Some(table) = &mut self.gauges else {
            return Ok(());
        };
        let gauges = &simulation.case.measure.gauges;
        table.rows(read.iter().map(|gauge| {
            let mut row = gauge_row(state, &gauges[gauge.gauge].name, gauge);
            let values = gauge.values.iter();
            row.extend(values.map(|value| value.map_or(Value::Word(""), Value::Real)));
            row
        }))
    }

    /// Writes the findings of measures now.
    pub fn write_findings(
        &mut self,
        simulation: &Simulation,
        found: &[Findings],
    ) -> Result<(), OutputError> {
        let Some([figures, distributions]) = &mut self.measures else {
            return Ok(());
        };
        let (case, time) = (&simulation.case, simulation.state.time);
        let all = || case.measure.measures.iter().zip(found);
        figures.rows(measures::figures(time, all(), case.extent()))?;
        distributions.rows(measures::distributions(time, all()))
    }

    /// Writes the particles that have passed witness planes.
    pub fn write_crossings(
        &mut self,
        case: &Case,
        crossings: &[Crossing],
    ) -> Result<(), OutputError> {
        let Some([_, table]) = &mut self.witnesses else {
            return Ok(());
        };
        table.rows(crossings.iter().map(|crossing| {
            let plane = &case.measure.witnesses[crossing.plane].name;
            let body = &case.bodies[crossing.body].name;
            let direction = DIRECTIONS[usize::from(!crossing.forwards)];
            crossing_row(crossing, [plane, body, direction])
        }))
    }

    /// Writes the readings of many gauges that wait in memory, also of a run that fails, since they may show
    /// the cause.
    pub fn write_records(&mut self) -> Result<(), OutputError> {
        self.gauge_records
            .as_mut()
            .map_or(Ok(()), GaugeRecords::write)
    }

    /// Syncs all rows written so far to the disk, and tells what the tables hold.
    pub fn sync(&mut self) -> Result<Vec<TableExtent>, OutputError> {
        self.write_records()?;
        let always = [
            &self.history,
            &self.contacts,
            &self.performance,
            &self.ranks,
        ];
        let some = [
            &self.loads,
            &self.rigid,
            &self.removed,
            &self.departed,
            &self.fragments,
            &self.bodies,
            &self.gauges,
        ];
        let witnesses = self.witnesses.iter().chain(&self.measures).flatten();
        let all = always
            .into_iter()
            .chain(some.into_iter().flatten())
            .chain(witnesses);
        all.map(|table| table.sync().map(|()| table.extent()))
            .collect()
    }
}
