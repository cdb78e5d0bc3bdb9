//! `whipple replay`: part of a run again, with more output, proved to be the same.

mod watched;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::compare::{Report, tables_and_states};
use super::results::ResultsError;
use super::{restart, run, why};
use comm::Comm;
use files::input;
use files::output::checkpoint;
use files::output::{OutputError, RunFolder, from_root, snapshot};
use files::run::CommonArgs;
use files::run::exit::{EXIT_FAILED, EXIT_INPUT};
use files::run::launch::{Launch, same_options, warn, with_ranks};
use files::run::parse_until;
use files::run::say::{say, seconds};
use files::run::verbosity::LogFormat;
use model::Case;
use model::readable::one_line;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Compute a part of a run again, with more output, and prove that it is the same
///
/// It goes on from the run's newest checkpoint before --from, or starts the case anew where there is
/// none, on any number of ranks, into a folder of its own; the run stays as it is. In the end
/// what both have written of the same steps (rows of tables, snapshots, checkpoints) must agree to the
/// last bit.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple replay runs/impact --from 3us --to 4us --snapshot-every 10ns
  whipple replay runs/impact --from 3us --to 4us --field temperature \\
      --rows-every 1
  mpirun -n 4 whipple replay runs/impact --to 0.1us \\
      --set measure.every=1ns --out runs/impact-measured
  whipple replay runs/impact --why 4711 --gauge 0,0,-2mm
  whipple replay runs/impact --from 3us --to 4us \\
      --watch=-1mm,-1mm,-2mm:1mm,1mm,0mm
  whipple plot replays/impact --movie cloud.gif

Exit codes: 0 it is the same; 1 it differs, or a run failed; 2 wrong input;
75 stopped softly, with a checkpoint.")]
pub struct ReplayArgs {
    /// Run folder
    #[arg(value_name = "RUN")]
    run: PathBuf,

    /// Time of the case from which there is more output, as in 3us [default: the start]
    #[arg(long, value_name = "TIME", value_parser = parse_until)]
    from: Option<f64>,

    /// Time of the case to which it goes [default: the end of the case]
    #[arg(long, value_name = "TIME", value_parser = parse_until)]
    to: Option<f64>,

    /// Time between snapshots, as in 10ns; with --watch those of the boxes
    #[arg(long, value_name = "TIME")]
    snapshot_every: Option<String>,

    /// Steps or time between rows of the histories, as in 1 or 10ns
    #[arg(long, value_name = "STEPS_OR_TIME")]
    rows_every: Option<String>,

    /// A field that snapshots show beside those of the case; may be given many times
    #[arg(long = "field", value_name = "NAME")]
    fields: Vec<String>,

    /// A gauge at X,Y,Z that reads each step, as in 1mm,0,-2mm; may be given many times
    #[arg(long = "gauge", value_name = "PLACE")]
    gauges: Vec<String>,

    /// A box LOWER:UPPER, as in -1mm,-1mm,-2mm:1mm,1mm,0mm, of which there are snapshots of their own, some fifty of the part or
    /// one each --snapshot-every; a side that is left empty is open; may be given many times
    #[arg(long = "watch", value_name = "BOX", allow_hyphen_values = true)]
    watched: Vec<String>,

    /// Tell the history of the particle of an id, as snapshots show it: what it bore, met and lost; may be given many times
    #[arg(long, value_name = "ID")]
    why: Vec<u64>,

    /// Change a value of `output`, `measure`, `gauge` or `fragments`, as in measure.every=1ns; may be given many times
    #[arg(short, long, value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// Folder of the results [default: replays/NAME, after the run's folder]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace an earlier run in the folder of the results
    #[arg(short, long)]
    force: bool,

    #[command(flatten)]
    ranks: RankArgs,
}

/// How the ranks of a replay run.
#[derive(Debug, Clone, clap::Args)]
pub struct RankArgs {
    /// Print neither lines nor a bar: warnings and errors alone
    #[arg(short, long)]
    quiet: bool,

    /// Threads of each rank [default: the cores shared out among the machine's ranks]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,

    /// Start even if the memory that the ranks will take is more than there is
    #[arg(long)]
    ignore_memory: bool,
}

impl RankArgs {
    /// The options of a run that stops at a time (s).
    pub(super) fn until(&self, until: Option<f64>) -> CommonArgs {
        CommonArgs {
            until,
            walltime: None,
            quiet: self.quiet,
            log: LogFormat::default(),
            threads: self.threads,
            ignore_memory: self.ignore_memory,
            ignore_lock: false,
            poison: false,
        }
    }
}

/// Keys that a replay may change: none of them moves a particle.
const SECTIONS: [&str; 4] = ["output", "measure", "gauge", "fragments"];

/// Runs the command; returns the exit code.
pub fn run(args: &ReplayArgs) -> u8 {
    args.ranks.until(None).verbosity().begin();
    with_ranks(|launch| {
        let comm = launch.comm;
        if let Err(error) = same_options(comm, args) {
            return warn(comm, &format!("error: {error}"));
        }
        let set = match overrides(comm, args) {
            Ok(set) => set,
            Err(message) => return warn(comm, &message),
        };
        let out = args.out.clone();
        let part = Part {
            run: &args.run,
            from: args.from.unwrap_or(0.0),
            to: args.to,
            out: &out.unwrap_or_else(|| default_folder("replays", &args.run, "")),
            set: &set,
            ranks: &args.ranks,
            force: args.force,
        };
        match part.compute(launch) {
            0 => match part.verify(comm) {
                0 => tell_why(comm, &args.why, part.out),
                code => code,
            },
            code => code,
        }
    })
}

/// Tells the history of particles in a replay; returns the exit code. Collective.
fn tell_why(comm: &Comm, ids: &[u64], out: &Path) -> u8 {
    let told = from_root(comm, || {
        ids.iter()
            .try_fold(true, |all, id| Ok(why::tell(out, *id)? && all))
    });
    match told {
        Ok(true) => 0,
        Ok(false) => EXIT_INPUT,
        Err(error) => {
            warn(comm, &format!("error: {error}"));
            EXIT_FAILED
        }
    }
}

/// A folder, and in it the name of a run's folder with an ending.
pub(super) fn default_folder(parent: &str, run: &Path, ending: &str) -> PathBuf {
    let whole = run.canonicalize().unwrap_or_else(|_| run.to_owned());
    let mut name = whole.file_name().unwrap_or_default().to_owned();
    name.push(ending);
    Path::new(parent).join(name)
}

/// The keys that the options change. Collective.
fn overrides(comm: &Comm, args: &ReplayArgs) -> Result<Vec<String>, String> {
    let mut set = Vec::new();
    // Where boxes are watched, snapshots of all else come as before.
    let of_all = args
        .snapshot_every
        .as_ref()
        .filter(|_| args.watched.is_empty());
    let asked = [
        ("output.snapshot_every", of_all),
        ("output.history_every", args.rows_every.as_ref()),
    ];
    for (key, value) in asked {
        set.extend(value.map(|value| format!("{key}={value}")));
    }
    if !args.watched.is_empty() {
        let (taken, end) = of_case(comm, args, |case| {
            let names = case.output.snapshots.iter().map(|own| own.name.clone());
            (names.collect::<Vec<_>>(), case.run.end_time)
        })?;
        let asked = watched::Asked {
            taken: &taken,
            every: args.snapshot_every.as_deref(),
            part: [args.from.unwrap_or(0.0), args.to.unwrap_or(end)],
        };
        set.extend(watched::schedules(&args.watched, &asked)?);
    }
    if !args.fields.is_empty() {
        snapshot::quantities(&args.fields).map_err(|error| format!("error: {error}"))?;
        let own = of_case(comm, args, |case| case.output.fields)?;
        // Those that none names are the usual ones.
        let usual = snapshot::quantities(&own).map_err(|error| format!("error: {error}"))?;
        let mut all: Vec<String> = usual.iter().map(|shown| shown.name().to_owned()).collect();
        let more = args.fields.iter().filter(|field| !all.contains(field));
        let more: Vec<String> = more.cloned().collect();
        all.extend(more);
        set.push(format!("output.fields={all:?}"));
    }
    let other = |key: &&String| {
        let section = key.split(['.', '=', '+']).next().map(str::trim);
        !SECTIONS.iter().any(|own| section == Some(own))
    };
    if let Some(key) = args.set.iter().find(other) {
        return Err(format!(
            "error: {key}: a replay changes keys of `output`, `measure`, `gauge` and `fragments` alone"
        ));
    }
    for place in &args.gauges {
        let at: Vec<&str> = place.split(',').map(str::trim).collect();
        set.push(format!("gauge+={{ at = {at:?} }}"));
    }
    set.extend(args.why.iter().map(|id| why::gauge(*id)));
    set.extend_from_slice(&args.set);
    Ok(set)
}

/// Something of the run's case. Collective.
fn of_case<T: Serialize + DeserializeOwned>(
    comm: &Comm,
    args: &ReplayArgs,
    take: impl FnOnce(Case) -> T,
) -> Result<T, String> {
    let taken = from_root(comm, || {
        let case = input::load(&RunFolder::at(&args.run).case(), &[]);
        case.map(take)
            .map_err(|error| OutputError::OtherRank(error.to_string()))
    });
    taken.map_err(|error| error.to_string())
}

/// A part of a run that is computed again.
pub(super) struct Part<'a> {
    /// Folder of the run.
    pub run: &'a Path,
    /// Time (s) from which keys are changed.
    pub from: f64,
    /// Time (s) to which it goes; to the end of the case without one.
    pub to: Option<f64>,
    /// Folder of the results.
    pub out: &'a Path,
    /// Keys that are changed.
    pub set: &'a [String],
    /// Options of the ranks.
    pub ranks: &'a RankArgs,
    /// True if an earlier run in the folder is replaced.
    pub force: bool,
}

/// A checkpoint, and whether it is of the time that is asked for.
type Found = Option<(OsString, bool)>;

impl Part<'_> {
    /// Runs it: to its beginning as the run was, from there on with changed keys. Returns the exit code. Collective.
    pub fn compute(&self, launch: &Launch) -> u8 {
        let comm = launch.comm;
        let found = match from_root(comm, || self.checkpoint()) {
            Ok(found) => found,
            Err(error) => return warn(comm, &format!("error: {error}")),
        };
        let is_there = found.as_ref().map_or(self.from <= 0.0, |(_, exact)| *exact);
        let begin = |set: &[String], until| match &found {
            Some((checkpoint, _)) => self.go_on(launch, checkpoint, true, set, until),
            None => self.start(launch, set, until),
        };
        if is_there {
            return begin(self.set, self.to);
        }
        match begin(&[], Some(self.from)) {
            0 if self.to.is_none_or(|to| to > self.from) => self.further(launch, self.to),
            code => code,
        }
    }

    /// Goes on in the folder of the results, to a time (s) or to the end of the case, with changed keys. Returns the exit code.
    /// Collective.
    pub fn further(&self, launch: &Launch, to: Option<f64>) -> u8 {
        self.go_on(launch, self.out.as_os_str(), false, self.set, to)
    }

    /// The newest checkpoint that is no later than the beginning.
    fn checkpoint(&self) -> Result<Found, OutputError> {
        let run = RunFolder::at(self.run);
        if !RunFolder::is_run(self.run) {
            let path = self.run.to_owned();
            return Err(OutputError::OutsideRun { path });
        }
        for path in run.checkpoint_folders()? {
            let time = checkpoint::manifest(&path)?.time;
            if time <= self.from {
                return Ok(Some((path.into(), time >= self.from)));
            }
        }
        Ok(None)
    }

    fn start(&self, launch: &Launch, set: &[String], until: Option<f64>) -> u8 {
        let args = run::RunArgs {
            case: RunFolder::at(self.run).case(),
            out: Some(self.out.to_owned()),
            set: set.to_owned(),
            common: self.ranks.until(until),
            force: self.force,
        };
        run::go(launch, &args)
    }

    fn go_on(
        &self,
        launch: &Launch,
        from: impl AsRef<Path>,
        elsewhere: bool,
        set: &[String],
        until: Option<f64>,
    ) -> u8 {
        let args = restart::RestartArgs {
            from: from.as_ref().to_owned(),
            out: elsewhere.then(|| self.out.to_owned()),
            set: set.to_owned(),
            accept_case: false,
            strict: false,
            common: self.ranks.until(until),
            force: elsewhere && self.force,
        };
        restart::go(launch, &args)
    }

    /// Compares what was computed with the run and tells it; returns the exit code. Collective.
    pub fn verify(&self, comm: &Comm) -> u8 {
        let told = from_root(comm, || {
            let other = |error: ResultsError| OutputError::OtherRank(error.to_string());
            let report = self.compared().map_err(other)?;
            Ok(self.tell(&report))
        });
        match told {
            Ok(true) => 0,
            Ok(false) => EXIT_FAILED,
            Err(error) => {
                warn(comm, &format!("error: {error}"));
                EXIT_INPUT
            }
        }
    }

    fn compared(&self) -> Result<Report, ResultsError> {
        let mut report = Report::default();
        // Other rows have extremes of other times.
        let more_rows =
            |key: &String| key.starts_with("output.history_every") || key.starts_with("measure");
        let (run, out) = (RunFolder::at(self.run), RunFolder::at(self.out));
        let rows_are_same = !self.set.iter().any(more_rows);
        tables_and_states(&run, &out, rows_are_same, &mut report)?;
        Ok(report)
    }

    /// Prints the outcome; returns true if nothing differs.
    fn tell(&self, report: &Report) -> bool {
        let (run, out) = (self.run.display(), self.out.display());
        match (report.compared, report.different) {
            (0, _) => say(&format!(
                "{run} has nothing of these steps to compare with; results in {out}"
            )),
            (all, 0) => {
                let until = self
                    .to
                    .map_or(String::new(), |to| format!(" to {}", seconds(to)));
                say(&format!(
                    "same: {all} tables, snapshots and checkpoints of both{until} agree with {run} to the last \
                     bit; results in {out}"
                ));
            }
            _ => {
                for line in &report.lines {
                    say(&one_line(line));
                }
                say(&format!("different: this is not the run in {run}"));
            }
        }
        report.different == 0
    }
}
