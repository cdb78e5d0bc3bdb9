//! `whipple measure`: the measures of a case, evaluated on its snapshots by the code of the run
//! itself.

use std::path::{Path, PathBuf};

use super::output_format::{self, OutputFormat, wrote};
use super::results::{ResultsError, only_part};
use super::which::Which;
use comm::Comm;
use engine::measure::{Findings, HeldMatter, Matter, Told, findings, remember};
use files::FileOpener;
use files::input::{self, InputError};
use files::output::h5::Content;
use files::output::h5::read::SnapshotFile;
use files::output::{OutputError, RunFolder, Sheet, measures, write_atomically};
use files::run::exit::EXIT_INPUT;
use files::run::say::{say, seconds, warn};
use model::readable::{one_line, shown};
use model::{Case, Measure, MeasureKind};
use plot::{PlotError, Wanted, choose, snapshots};
use results::{ReadError, SnapshotReader as _};

/// Tell the measures of a run's snapshots: holes, craters, verdicts, debris
///
/// The measures are those of the case, which --set changes. Regions are told by the run alone.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple measure runs/impact
  whipple measure runs/impact --at 5us
  whipple measure runs/impact --all --csv measures.csv
  whipple measure runs/impact \\
      --set 'measure.plate=[{ body = \"wall\", include = \"all\" }]'")]
pub struct MeasureArgs {
    /// Run folder, or snapshot (.vtkhdf)
    #[arg(value_name = "FILE_OR_RUN")]
    pub path: PathBuf,

    /// The snapshot of a run.
    #[command(flatten)]
    pub which: Which,

    /// All snapshots of the run; the last one is shown
    #[arg(long, group = "which")]
    pub all: bool,

    /// Change a key of the case's `measure`
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,

    /// Form of the output.
    #[command(flatten)]
    pub format: OutputFormat,

    /// Write the rows of measures.csv
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
}

/// Why the measures of a snapshot are unknown.
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// No snapshot is found.
    #[error(transparent)]
    Choice(#[from] PlotError),
    /// The path is nothing of ours.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A file cannot be read or written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The snapshot's case cannot be read.
    #[error(transparent)]
    Case(#[from] InputError),
    /// The snapshot's description of itself is inconsistent or incomplete.
    #[error("{} cannot be taken: {reason}", path.display())]
    Snapshot {
        /// The file.
        path: PathBuf,
        /// The fault.
        reason: String,
    },
}

/// Runs the command; returns the exit code.
pub fn run(args: &MeasureArgs) -> u8 {
    args.format.begin();
    match evaluate(args) {
        Ok(text) => {
            say(text.trim_end());
            0
        }
        Err(error) => {
            warn(&format!("error: {error}"));
            EXIT_INPUT
        }
    }
}

fn evaluate(args: &MeasureArgs) -> Result<String, MeasureError> {
    let (first, paths) = chosen(args)?;
    let comm = Comm::solo();
    let mut remembered = match &first {
        Some(path) => {
            let first = Loaded::read(path, &args.set)?;
            remember(&first.particles(), &comm)
        }
        None => Vec::new(),
    };
    let mut evaluated = Vec::new();
    let mut text = String::new();
    for path in &paths {
        let loaded = Loaded::read(path, &args.set)?;
        let measured = findings(
            loaded.time,
            &mut remembered,
            None,
            &loaded.particles(),
            &comm,
        );
        text = report(&loaded, loaded.case.measure.measures.iter().zip(&measured));
        evaluated.push((loaded.case, loaded.time, measured));
    }
    let rows = evaluated.iter().flat_map(|(case, time, measured)| {
        let all = case.measure.measures.iter().zip(measured);
        measures::figures(*time, all, case.extent())
    });
    let table = measures::table(&rows.collect::<Vec<_>>());
    if let Some(path) = &args.csv {
        write_atomically(path, &table)?;
        wrote(path, "");
    }
    args.format.print(|| {
        let sheet = Sheet::parse(&String::from_utf8_lossy(&table));
        let mut document = output_format::table(&sheet.expect("a table that was made here"));
        document["title"] = evaluated
            .last()
            .map(|(case, ..)| case.title.as_str())
            .into();
        document
    });
    Ok(text)
}

/// The first snapshot of a run, and those that are asked for.
fn chosen(args: &MeasureArgs) -> Result<(Option<PathBuf>, Vec<PathBuf>), MeasureError> {
    if !args.path.is_dir() {
        if args.which.any() || args.all {
            let choice = "--at, --snapshot and --all choose among the snapshots of a run: give its \
                          folder";
            return Err(PlotError::Options(choice).into());
        }
        return Ok((None, vec![args.path.clone()]));
    }
    let folder = RunFolder::at(&args.path);
    let available = snapshots(&FileOpener, folder.path())?;
    let first = choose(&available, &Wanted::Indices(vec![0]))?.pop();
    if args.all {
        return Ok((
            first,
            available.into_iter().map(|available| available.1).collect(),
        ));
    }
    Ok((first, choose(&available, &args.which.wanted()?)?))
}

/// A field that the measures of a case need and a snapshot does not have.
fn lacks(case: &Case, has: impl Fn(&str) -> bool) -> Option<&'static str> {
    let mut measures = case.measure.measures.iter();
    let follows = measures.any(|measure| matches!(measure.kind, MeasureKind::Front(_)));
    let needed = [
        ("body", true),
        ("mass", true),
        ("velocity", true),
        ("density", true),
        ("plastic_strain", case.may_yield()),
        ("damage", case.may_fail()),
        ("pressure", follows),
    ];
    let mut missing = needed.iter().filter(|(field, needs)| *needs && !has(field));
    missing.next().map(|(field, _)| *field)
}

/// Particles of a snapshot, but for frozen ones, and its case.
struct Loaded {
    case: Case,
    /// Time (s).
    time: f64,
    held: HeldMatter,
}

impl Loaded {
    fn read(path: &Path, set: &[String]) -> Result<Self, MeasureError> {
        let wrong = |reason: String| MeasureError::Snapshot {
            path: path.to_owned(),
            reason,
        };
        let text = Content::open(path)?.text("/whipple/input")?;
        let case = input::parse(&path.display().to_string(), &text, set)?;
        let read_error = |error: ReadError| wrong(error.to_string());
        let file = SnapshotFile::open(path).map_err(read_error)?;
        if let Some(part) = file.portion().map_err(read_error)? {
            return Err(wrong(only_part(&part)));
        }
        let names = file.names().map_err(read_error)?;
        let has = |field: &str| names.iter().any(|name| name == field);
        if has("stress_mass") {
            return Err(wrong(
                "it has stress points, which hold the state of the particles".to_owned(),
            ));
        }
        if let Some(field) = lacks(&case, has) {
            return Err(wrong(format!(
                "it does not tell the {field} of its particles: name it in `output.fields` of the \
                 run"
            )));
        }
        let count = file.particles();
        let field = |name: &str, components: usize| {
            if !has(name) {
                return Ok(vec![0.0; count * components]);
            }
            match file.components(name).map_err(read_error)? {
                actual if actual == components => file.values(name, 0..count).map_err(read_error),
                actual => Err(wrong(format!("its field {name} has {actual} components"))),
            }
        };
        let bodies = case.bodies.len();
        let index = |value: f64| {
            let known = (0_u32..).take(bodies).find(|&b| f64::from(b) == value);
            known.ok_or_else(|| wrong(format!("body {value} of {bodies} bodies")))
        };
        let body = field("body", 1)?.into_iter().map(index);
        let mut held = HeldMatter {
            body: body.collect::<Result<_, _>>()?,
            position: file.points(0..count).map_err(read_error)?,
            velocity: field("velocity", 3)?.as_chunks::<3>().0.to_vec(),
            mass: field("mass", 1)?,
            density: field("density", 1)?,
            pressure: field("pressure", 1)?,
            plastic_strain: field("plastic_strain", 1)?,
            damage: field("damage", 1)?,
        };
        leave_out(&mut held, &field("frozen", 1)?);
        Ok(Self {
            time: file.time().map_err(read_error)?,
            case,
            held,
        })
    }

    fn particles(&self) -> Matter<'_> {
        self.held.of(&self.case)
    }
}

/// Frozen particles are of the model no more.
fn leave_out(held: &mut HeldMatter, frozen: &[f64]) {
    if frozen.iter().all(|&is| is == 0.0) {
        return;
    }
    keep(&mut held.body, frozen);
    keep(&mut held.position, frozen);
    keep(&mut held.velocity, frozen);
    for values in [
        &mut held.mass,
        &mut held.density,
        &mut held.pressure,
        &mut held.plastic_strain,
        &mut held.damage,
    ] {
        keep(values, frozen);
    }
}

/// Leaves out what is frozen.
fn keep<T: Copy>(values: &mut Vec<T>, frozen: &[f64]) {
    let kept = values.iter().zip(frozen).filter(|(_, is)| **is == 0.0);
    *values = kept.map(|(&value, _)| value).collect();
}

/// The figures of a snapshot, a line for each.
fn report<'a>(
    loaded: &Loaded,
    findings: impl Iterator<Item = (&'a Measure, &'a Findings)>,
) -> String {
    use std::fmt::Write as _;
    let title = one_line(&loaded.case.title);
    let mut text = format!("{title} at {}\n", seconds(loaded.time));
    for (measure, findings) in findings {
        if findings.figures.is_empty() {
            let _ = writeln!(text, "{}: told by the run alone", measure.name);
            continue;
        }
        let _ = writeln!(text, "{} ({})", measure.name, measure.kind.word());
        for figure in &findings.figures {
            let unit = files::output::unit_of_model(figure.unit, loaded.case.extent());
            let value = match figure.value {
                Told::Number(number) if number.is_nan() => "–".to_owned(),
                Told::Number(number) => shown(number, unit),
                Told::Word(word) => word.to_owned(),
            };
            let doubt = figure.uncertainty.filter(|doubt| doubt.is_finite());
            let doubt = doubt.filter(|_| value != "–");
            let doubt = doubt.map_or(String::new(), |doubt| format!(" ± {}", shown(doubt, unit)));
            let name = figure.name.replace('_', " ");
            let _ = writeln!(text, "  {name:<26} {value}{doubt}");
        }
    }
    text
}
