//! Output and its times: `[output]` and its schedules of snapshots.

use toml::Spanned;

use super::check::{Allowed, number};
use super::named::check_listed;
use super::region::KeepReader;
use crate::input::names;
use crate::input::schema::value::Ranged;
use crate::input::schema::{CadenceParams, ClockParams, OutputParams, SnapshotParams};
use crate::input::source::Diagnostic;
use material::Material;
use model::{Cadence, ClockInterval, OutputOptions, Sharing, SnapshotSchedule};
use particles::{FIELDS, FieldId, TEMPERATURE, snapshot_names};

/// A list of names as it is typed.
type Names = Option<Spanned<Vec<Spanned<String>>>>;

/// Inputs of the reading of the table.
pub struct Reader<'a> {
    /// Regions, and the bodies.
    pub boxes: &'a KeepReader<'a>,
    /// The case's own spacing (m), if it has one.
    pub spacing: Option<f64>,
    pub materials: &'a [Material],
}

impl Reader<'_> {
    /// The whole table.
    pub fn read(&self, params: &OutputParams) -> Result<OutputOptions, Diagnostic> {
        let kept = params.checkpoints_kept()?;
        let fields = self.fields(&params.fields)?;
        let mut snapshots: Vec<SnapshotSchedule> = Vec::new();
        for table in &params.snapshot {
            let schedule = self.schedule(table.get_ref(), &fields, &snapshots)?;
            snapshots.push(schedule);
        }
        Ok(OutputOptions {
            snapshot_every: params.snapshot_every()?,
            checkpoint_every: params.checkpoint_every()?,
            checkpoint_every_steps: params.checkpoint_every_steps()?,
            checkpoint_every_wall: clock_interval(params)?,
            checkpoints_kept: usize::try_from(kept).unwrap_or(usize::MAX),
            history_every: history_every(params)?,
            fields,
            snapshots,
            sharing: sharing(params)?,
        })
    }

    /// One of `[[output.snapshot]]`, after others; `usual` are the fields of the usual snapshots.
    fn schedule(
        &self,
        params: &SnapshotParams,
        default: &[String],
        others: &[SnapshotSchedule],
    ) -> Result<SnapshotSchedule, Diagnostic> {
        let name = &params.name;
        check_name(name, others)?;
        let fields = match &params.fields {
            None => default.to_vec(),
            named => self.fields(named)?,
        };
        let region = params.region.as_ref();
        let region = region.map(|table| self.boxes.read_box(table, "region", self.spacing));
        Ok(SnapshotSchedule {
            name: name.get_ref().clone(),
            every: params.every()?,
            fields,
            bodies: self.bodies(&params.bodies)?,
            region: region.transpose()?,
            precision: params.precision(),
        })
    }

    fn bodies(&self, named: &Names) -> Result<Option<Vec<usize>>, Diagnostic> {
        let Some(named) = named else { return Ok(None) };
        let all = self.boxes.bodies;
        let mut bodies = Vec::new();
        let known = || all.iter().map(|body| body.name.as_str());
        for (n, name) in named.get_ref().iter().enumerate() {
            check_listed(named.get_ref(), n, "body", known)?;
            bodies.extend(known().position(|body| body == name.get_ref()));
        }
        if bodies.is_empty() {
            let help = "leave it out for all bodies";
            return Err(Diagnostic::new(named.span(), "`bodies` names no body").help(help));
        }
        bodies.sort_unstable();
        Ok(Some(bodies))
    }

    /// Names of fields, each once and known; none where there is no list.
    fn fields(&self, named: &Names) -> Result<Vec<String>, Diagnostic> {
        let Some(fields) = named else {
            return Ok(Vec::new());
        };
        if fields.get_ref().is_empty() {
            let title = "`fields` names no field";
            let help =
                "leave it out for the usual fields; id, body and position are always written";
            return Err(Diagnostic::new(fields.span(), title).help(help));
        }
        for (n, field) in fields.get_ref().iter().enumerate() {
            check_listed(fields.get_ref(), n, "field", snapshot_names)?;
            self.check_temperature(field)?;
        }
        let names = fields.get_ref().iter();
        Ok(names.map(|field| field.get_ref().clone()).collect())
    }

    fn check_temperature(&self, field: &Spanned<String>) -> Result<(), Diagnostic> {
        let peak = FIELDS[FieldId::peak_temperature as usize].name;
        let asks = [TEMPERATURE, peak].contains(&field.get_ref().as_str());
        if asks && self.materials.iter().all(|m| m.thermal.is_none()) {
            let title = "no material has `thermal` constants that would give it a temperature";
            return Err(Diagnostic::new(field.span(), title));
        }
        Ok(())
    }
}

/// Arrays of a file are many, and before each there may be a hole.
const LARGEST_ALIGNMENT: u64 = 1 << 30;

fn sharing(params: &OutputParams) -> Result<Sharing, Diagnostic> {
    let (writers, bytes) = (params.writers()?, params.alignment()?);
    if let (Some(at), Some(bytes)) = (&params.alignment, bytes)
        && (!bytes.is_power_of_two() || bytes > LARGEST_ALIGNMENT)
    {
        let title = format!(
            "`alignment` must be a power of two of at most {LARGEST_ALIGNMENT} bytes, as 4194304"
        );
        return Err(Diagnostic::new(at.span(), title).label("out of range"));
    }
    Ok(Sharing {
        writers: writers.map(|n| usize::try_from(n).unwrap_or(usize::MAX)),
        alignment: bytes,
    })
}

fn clock_interval(params: &OutputParams) -> Result<Option<ClockInterval>, Diagnostic> {
    let failures = params.mean_time_between_failures()?;
    let every = params.checkpoint_every_wall.as_ref();
    let auto = matches!(every.map(Spanned::get_ref), Some(ClockParams::Auto));
    if let (Some(given), false) = (&params.mean_time_between_failures, auto) {
        let title = "`mean_time_between_failures` is for `checkpoint_every_wall = \"auto\"` alone";
        return Err(Diagnostic::new(given.span(), title));
    }
    let Some(every) = every else { return Ok(None) };
    Ok(Some(match every.get_ref() {
        ClockParams::Auto => ClockInterval::Auto { failures },
        ClockParams::Every(time) => {
            let time = Spanned::new(every.span(), *time);
            let key = "checkpoint_every_wall";
            ClockInterval::Fixed(number(&time, key, Allowed::Positive)?)
        }
    }))
}

fn history_every(params: &OutputParams) -> Result<Option<Cadence>, Diagnostic> {
    let Some(every) = &params.history_every else {
        return Ok(None);
    };
    let key = "history_every";
    Ok(Some(match every.get_ref() {
        CadenceParams::Steps(steps) => {
            let steps = Spanned::new(every.span(), *steps);
            Cadence::Steps(steps.within(key, Allowed::AtLeast(1))?)
        }
        CadenceParams::Time(time) => {
            let time = Spanned::new(every.span(), *time);
            Cadence::Time(number(&time, key, Allowed::Positive)?)
        }
    }))
}

/// The name of a folder among snapshots, which begin with `step-` and have endings.
fn check_name(name: &Spanned<String>, others: &[SnapshotSchedule]) -> Result<(), Diagnostic> {
    names::check(name, "schedule")?;
    let text = name.get_ref();
    let title = if text.contains('.') || text.starts_with("step-") {
        format!("`{text}` could be a snapshot's own name")
    } else if others.iter().any(|other| other.name == *text) {
        format!("a second schedule `{text}`")
    } else {
        return Ok(());
    };
    Err(Diagnostic::new(name.span(), title)
        .help("its snapshots stand in a folder of that name: no dots, no `step-` in front"))
}
