//! `whipple sweep` and `whipple converge`: a case at many points.

mod stated;

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::output_format::{self, OutputFormat, wrote};
use super::plot::out::{PictureFormat, write, write_chart};
use super::shell::quoted;
use desk::sweep::{self, Converged, Definition, Launch, Shared, Sweep, SweepError, Tally};
use files::input;
use files::output::{OutputError, RunLock, Sheet, write_atomically};
use files::run::exit::{EXIT_FAILED, EXIT_INPUT, EXIT_STOPPED};
use files::run::say::{counted, say, warn};

/// How the runs of a sweep share the machine.
#[derive(Debug, Clone, clap::Args)]
pub struct Shares {
    /// Folder of the sweep [default: sweeps/NAME, after the case's folder or file]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Change a value of the case for all points, as in spacing=0.05mm; may be given many times
    #[arg(short, long, value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// Answers in the table, by the beginning of their names, as in
    /// history or bodies.sphere [default: those of bodies, fragments and measures]
    #[arg(short, long, value_name = "NAME", value_delimiter = ',')]
    answers: Vec<String>,

    /// Runs at once [default: as many as the cores take]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,

    /// Ranks of each run; more than one start through mpirun
    #[arg(short = 'n', long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    ranks: u16,

    /// Threads of each rank [default: the cores shared out among the runs]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,

    #[command(flatten)]
    format: OutputFormat,
}

/// Run a case at many points: a table of answers, a limit
///
/// Each point has a run in a folder of its own, and what its folder says is all that is known of it: a sweep
/// that was stopped or killed goes on with the same command, runs no point twice, and has the same
/// table in the end. Points are added by more values of the same keys.
///
/// The table is sweep.csv, its chart sweep.png; a bisection has limits.csv and limits.png; with
/// --format svg they are SVG. With --scatter there are bands.csv and bands.png, and effects.csv and
/// effects.png, what each scattered key does to the means.
#[derive(Debug, Clone, clap::Args)]
#[command(
    after_help = "Values: a list (\"3, 5, 7 km/s\"), a range (\"3..9 km/s\", five values,
\"3..9/7 km/s\", seven). A number for a vector, such as a velocity, is its length:
its direction stays.

Examples:
  whipple sweep inputs/quarter-impact --vary body.sphere.velocity=\"3..9/4 km/s\" \\
      --answers history.kinetic_energy
  whipple sweep shield.toml --vary body.bumper.shape.box.size.2=\"1, 2 mm\" \\
      --vary body.sphere.velocity=\"2..8 km/s\" --bisect \"failed wall\"
  whipple sweep shield.toml --scatter seed=1,2,3 --scatter spacing=\"0.2, 0.3 mm\" \\
      --vary body.sphere.shape.sphere.radius=\"1..3 mm\" --bisect \"failed wall\"
  whipple sweep shield.toml --scatter material.wall.failure.spall.pressure=stated
  whipple sweep sweeps/shield                             # goes on

A bisection finds where in the range of the last key its condition changes: an
answer compared, as in \"fragments.largest_mass<1 mg\" or
\"history.interpenetrated==0\".

Exit codes: 0 all points have answers, 1 some have failed, 2 wrong input, 75 some
were stopped."
)]
pub struct SweepArgs {
    /// Case file (TOML), a folder with a case.toml, or the folder of a sweep to go on with
    #[arg(value_name = "CASE_OR_SWEEP")]
    case: PathBuf,

    /// A key and its values; may be given many times
    #[arg(short, long, value_name = "KEY=VALUES")]
    vary: Vec<String>,

    /// A key whose values are repetitions of one question, as seeds and constants within their
    /// uncertainty: answers have means and bands over them. `seed` is that of the fillings of all
    /// bodies, `spacing` takes those of all bodies with it. `stated` in place of values takes the ends of
    /// the range that the library states for the constant, and its own number. May be given many times
    #[arg(long, value_name = "KEY=VALUES")]
    scatter: Vec<String>,

    /// Find where in the range of the last key a condition changes, in place of running all of it
    #[arg(short, long, value_name = "CONDITION")]
    bisect: Option<String>,

    /// Part of the range to which a bisection goes
    #[arg(long, value_name = "PART", default_value_t = sweep::WITHIN)]
    within: f64,

    /// Answer that the chart shows [default: the first one that is a number]
    #[arg(long, value_name = "NAME")]
    chart: Option<String>,

    #[command(flatten)]
    picture: PictureFormat,

    /// Write a job array for SLURM into the folder in place of running here
    #[arg(long, conflicts_with_all = ["bisect", "point"])]
    slurm: bool,

    /// Run the point of this number alone, from 1 on, as an array's task does
    #[arg(long, value_name = "N")]
    point: Option<usize>,

    #[command(flatten)]
    shares: Shares,
}

/// Run a case with several spacings and tell what its answers converge to
///
/// The spacings of bodies that have their own go with that of the case. Of each answer: its value at the finest
/// spacing, the limit (Richardson), the half width of the band (Roache's index) and the order of convergence.
/// Three spacings give the order and a factor of 1.25; two assume the first order, with a factor of 3. What
/// goes to and fro has its range as band, and what does not approach a limit has none. The runs are those of a
/// sweep: they go on after a kill.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple converge inputs/quarter-impact --spacings \"0.04, 0.03, 0.02 mm\" \\
      --answers history.kinetic_energy")]
pub struct ConvergeArgs {
    /// Case file (TOML), or a folder with a case.toml
    #[arg(value_name = "CASE")]
    case: PathBuf,

    /// Spacings of the case, two or more, as in \"0.04, 0.03, 0.02 mm\"
    #[arg(long, value_name = "LIST")]
    spacings: String,

    #[command(flatten)]
    shares: Shares,
}

/// Runs `whipple sweep`; returns the exit code.
#[must_use]
pub fn run(args: &SweepArgs) -> u8 {
    args.shares.format.begin();
    exit_code(sweep(args))
}

/// Runs `whipple converge`; returns the exit code.
#[must_use]
pub fn converge(args: &ConvergeArgs) -> u8 {
    args.shares.format.begin();
    exit_code(converged(args))
}

fn exit_code(result: Result<u8, SweepError>) -> u8 {
    result.unwrap_or_else(|error| {
        warn(&error.to_string());
        match error {
            SweepError::Typed(_) | SweepError::Case(_) => EXIT_INPUT,
            SweepError::Output(_) => EXIT_FAILED,
        }
    })
}

fn sweep(args: &SweepArgs) -> Result<u8, SweepError> {
    let definition = if Definition::is_in(&args.case) {
        let has_keys = !args.vary.is_empty() || !args.scatter.is_empty();
        if has_keys || !args.shares.set.is_empty() || args.bisect.is_some() {
            let title = "a sweep that goes on has its keys: name its case to give others";
            return Err(SweepError::Typed(title.to_owned()));
        }
        let mut definition = Definition::read(&args.case)?;
        if !args.shares.answers.is_empty() {
            definition.answers.clone_from(&args.shares.answers);
        }
        definition
    } else {
        let mut definition = args.shares.definition(&args.case, args.vary.clone())?;
        definition.scatter.clone_from(&args.scatter);
        definition.bisect.clone_from(&args.bisect);
        definition.within = args.within;
        definition.scatter = stated::with_values(&definition)?;
        definition
    };
    let folder = definition.folder.clone();
    let scattered = definition.scattered();
    let (mut sweep, jobs) = args.shares.sweep(definition.clone())?;
    if let Some(number) = args.point {
        let is_finished = sweep.run_one(number, say)?;
        return Ok(if is_finished { 0 } else { EXIT_FAILED });
    }
    let _lock = hold(definition)?;
    if args.slurm {
        let path = folder.join("sweep.sbatch");
        write_atomically(&path, &script(&folder, &args.shares, sweep.count()?))?;
        wrote(&path, ": give it to sbatch, then run");
        say(&format!("  whipple sweep {}", folder.display()));
        args.shares.format.print(|| json!({}));
        return Ok(0);
    }
    let tally = sweep.run(jobs, say)?;
    let Shared { runs, steps, all } = sweep.shared()?;
    if runs > 0 {
        say(&format!(
            "{} went on from others: {steps} of {all} steps were not computed again",
            counted(runs as u64, "run")
        ));
    }
    let table = folder.join("sweep.csv");
    wrote(&table, "");
    if scattered.contains(&true) {
        wrote(
            &folder.join("bands.csv"),
            ": means and bands over what is scattered",
        );
        wrote(
            &folder.join("effects.csv"),
            ": what each scattered key does",
        );
    }
    if let Some((chart, path)) = sweep::draw(&folder, &scattered, args.chart.as_deref())? {
        let path = path.with_extension(args.picture.ending());
        if let Err(error) = write_chart(&chart, None, &path) {
            warn(&format!("warning: {error}"));
        }
    }
    if scattered.contains(&true)
        && let Some((chart, path)) = sweep::draw_effects(&folder, args.chart.as_deref())?
    {
        let path = path.with_extension(args.picture.ending());
        let drawn = chart.draw(None).and_then(|canvas| write(&canvas, &path));
        if let Err(error) = drawn {
            warn(&format!("warning: {error}"));
        }
    }
    args.shares.ended(&table, tally)
}

fn converged(args: &ConvergeArgs) -> Result<u8, SweepError> {
    let vary = vec![format!("spacing={}", args.spacings)];
    let mut definition = args.shares.definition(&args.case, vary)?;
    if args.shares.out.is_none() {
        definition
            .folder
            .set_file_name(format!("{}-converge", name(&args.case)));
    }
    definition.converges = true;
    let (mut sweep, jobs) = args.shares.sweep(definition.clone())?;
    let folder = definition.folder.clone();
    let _lock = hold(definition)?;
    let tally = sweep.run(jobs, say)?;
    let converged = Converged::of(&sweep)?;
    converged.write(&sweep)?;
    for line in converged.lines() {
        say(&line);
    }
    let table = folder.join("converge.csv");
    wrote(&table, "");
    args.shares.ended(&table, tally)
}

/// Takes the folder of a sweep, which is made if it lacks, and keeps its definition there.
fn hold(mut definition: Definition) -> Result<RunLock, SweepError> {
    let folder = &definition.folder;
    fs::create_dir_all(folder).map_err(OutputError::io("create", folder))?;
    let lock = RunLock::take(folder, false)?;
    definition.keep()?;
    Ok(lock)
}

/// The name of a case: that of its file, or of its folder for a `case.toml`.
fn name(case: &Path) -> String {
    let stem = case.file_stem().unwrap_or_default();
    let folder = case.parent().and_then(Path::file_name);
    let name = if stem == "case" {
        folder.unwrap_or(stem)
    } else {
        stem
    };
    name.to_string_lossy().into_owned()
}

impl Shares {
    /// Tells how a sweep with a table ended; gives the exit code.
    fn ended(&self, table: &Path, tally: Tally) -> Result<u8, SweepError> {
        let Tally {
            answered,
            failed,
            open,
        } = tally;
        let mut parts = vec![format!("{} finished", counted(answered as u64, "point"))];
        if failed > 0 {
            parts.push(format!("{failed} failed"));
        }
        if open > 0 {
            parts.push(format!("{open} open"));
        }
        say(&parts.join(", "));
        if self.format.is_json() {
            let text = fs::read_to_string(table).map_err(OutputError::io("read", table))?;
            let sheet = Sheet::parse(&text).map_err(SweepError::Typed)?;
            self.format.print(|| {
                let mut document = output_format::table(&sheet);
                document["points"] =
                    json!({ "finished": answered, "failed": failed, "open": open });
                document
            });
        }
        Ok(match (failed, open) {
            (0, 0) => 0,
            (0, _) => EXIT_STOPPED,
            _ => EXIT_FAILED,
        })
    }

    fn definition(&self, case: &Path, vary: Vec<String>) -> Result<Definition, SweepError> {
        let (path, _) = input::text(case)?;
        let path = fs::canonicalize(&path).map_err(OutputError::io("find", &path))?;
        let folder = self.out.clone();
        Ok(Definition {
            folder: folder.unwrap_or_else(|| Path::new("sweeps").join(name(&path))),
            case: path,
            digest: String::new(),
            settings: self.set.clone(),
            vary,
            scatter: Vec::new(),
            converges: false,
            bisect: None,
            within: sweep::WITHIN,
            answers: self.answers.clone(),
        })
    }

    /// The sweep and how many runs go at once.
    fn sweep(&self, definition: Definition) -> Result<(Sweep, usize), SweepError> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let ranks = usize::from(self.ranks);
        let threads = self.threads.map(usize::from);
        let program = std::env::current_exe();
        let mut launch = Launch {
            program: program.map_err(OutputError::io("find", Path::new("this program")))?,
            case: definition.case.clone(),
            settings: definition.settings.clone(),
            folder: definition.folder.join("points"),
            ranks,
            threads: threads.unwrap_or(1),
        };
        let sweep = Sweep::new(definition, launch.clone())?;
        let fit = (cores / (ranks * launch.threads)).max(1);
        let jobs = self
            .jobs
            .map_or(fit.min(sweep.count()?.max(1)), usize::from);
        if threads.is_none() {
            launch.threads = (cores / (ranks * jobs)).max(1);
        }
        Ok((sweep.with_launch(launch), jobs))
    }
}

/// A job array with a task for each point.
fn script(folder: &Path, shares: &Shares, points: usize) -> Vec<u8> {
    let program = std::env::current_exe().unwrap_or_else(|_| PathBuf::from("whipple"));
    let (ranks, threads) = (shares.ranks, shares.threads.unwrap_or(1));
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let mut text = format!(
        "#!/bin/bash\n#SBATCH --array=1-{points}\n#SBATCH --ntasks={ranks}\n\
         #SBATCH --cpus-per-task={threads}\n#SBATCH --output=%A_%a.log\n\
         exec "
    )
    .into_bytes();
    text.extend(quoted(program.as_os_str()));
    text.extend(b" sweep ");
    text.extend(quoted(folder.as_os_str()));
    let rest = format!(" --point \"$SLURM_ARRAY_TASK_ID\" --ranks {ranks} --threads {threads}\n");
    text.extend(rest.into_bytes());
    text
}
