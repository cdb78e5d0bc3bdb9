//! `whipple diff`: the first step, particle and field in which two runs differ.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::compare::tables::SINCE_ROW_BEFORE;
use super::compare::{cases, compare};
use super::replay::{Part, RankArgs};
use super::results::ResultsError;
use files::output::{OutputError, RunFolder, checkpoint, from_root, read_sheet, read_small};
use files::run::exit::{EXIT_FAILED, EXIT_INPUT};
use files::run::launch::{Launch, same_options, warn, with_ranks};
use files::run::say::{say, seconds};
use model::readable::one_line;

/// Find the first step, particle and field in which two runs differ
///
/// Keys of the cases and versions of the program that differ are told first. The histories tell between which rows
/// the runs part. That part of both is computed again, with a checkpoint at each step, must agree with
/// its own run to the last bit, and is compared particle by particle.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple diff runs/soft runs/hard
  mpirun -n 4 whipple diff runs/here runs/there --out part

Exit codes: 0 nothing differs; 1 something does; 2 wrong input; 75 stopped
softly.")]
pub struct DiffArgs {
    /// Run folder
    #[arg(value_name = "A")]
    a: PathBuf,

    /// Another one
    #[arg(value_name = "B")]
    b: PathBuf,

    /// Folder of what is computed again [default: replays/diff]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace what is in the folder
    #[arg(short, long)]
    force: bool,

    #[command(flatten)]
    ranks: RankArgs,
}

/// Rows of two histories.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Histories {
    /// Times (s) of the rows that agree, of the same steps from the first on.
    agree: Vec<f64>,
    /// Times (s) of the row after them in each run, if there is one.
    part: Option<[f64; 2]>,
}

/// Runs the command; returns the exit code.
pub fn run(args: &DiffArgs) -> u8 {
    args.ranks.until(None).verbosity().begin();
    with_ranks(|launch| {
        let comm = launch.comm;
        if let Err(error) = same_options(comm, args) {
            return warn(comm, &format!("error: {error}"));
        }
        find(launch, args).unwrap_or_else(|error| warn(comm, &format!("error: {error}")))
    })
}

/// Finds and tells the first difference; returns the exit code. Collective.
fn find(launch: &Launch, args: &DiffArgs) -> Result<u8, OutputError> {
    let comm = launch.comm;
    let told = |text: String| {
        if comm.is_root() {
            say(&one_line(&text));
        }
        comm.barrier();
    };
    let runs = [&args.a, &args.b].map(|run| RunFolder::at(run));
    let histories = from_root(comm, || {
        for line in causes(&runs)? {
            say(&one_line(&line));
        }
        histories(&runs)
    })?;
    let Histories { mut agree, part } = histories;
    let Some(part) = part else {
        told("no row of the histories that both have differs".to_owned());
        return Ok(0);
    };
    if agree.is_empty() {
        return from_root(comm, || first_snapshots(&runs)).map(|()| EXIT_FAILED);
    }
    let out = args.out.clone();
    let out = out.unwrap_or_else(|| Path::new("replays").join("diff"));
    let each_step = [
        "output.checkpoint_every_steps=1",
        "output.checkpoints_kept=1000000",
    ];
    let each_step = each_step.map(str::to_owned);
    let folders = ["a", "b"].map(|name| out.join(name));
    let mut force = args.force;
    // Sums may agree where particles do not.
    while let Some(from) = agree.pop() {
        for ((run, folder), to) in [&args.a, &args.b].into_iter().zip(&folders).zip(part) {
            let part = Part {
                run,
                from,
                to: Some(to),
                out: folder,
                set: &each_step,
                ranks: &args.ranks,
                force,
            };
            let code = match part.compute(launch) {
                0 => part.verify(comm),
                code => code,
            };
            if code != 0 {
                return Ok(code);
            }
        }
        force = true;
        let found = from_root(comm, || first_checkpoint(&folders))?;
        match found {
            Some((step, is_first)) if !is_first || agree.is_empty() => {
                told(format!(
                    "the first step that differs is {step}, after the rows at {}; checkpoints of each step in {}",
                    seconds(from),
                    out.display()
                ));
                return Ok(EXIT_FAILED);
            }
            Some(_) => {}
            None => {
                told("the rows of the histories differ and the particles do not".to_owned());
                return Ok(EXIT_FAILED);
            }
        }
    }
    Ok(EXIT_INPUT)
}

/// Keys and versions in which two runs differ.
fn causes(runs: &[RunFolder; 2]) -> Result<Vec<String>, OutputError> {
    let mut texts = Vec::new();
    let mut versions = Vec::new();
    for run in runs {
        if !RunFolder::is_run(run.path()) {
            let path = run.path().to_owned();
            return Err(OutputError::OutsideRun { path });
        }
        texts.push(text(&run.case())?);
        let newest = run.checkpoint_folders()?.into_iter().next();
        versions.push(newest.map(|path| checkpoint::manifest(&path)).transpose()?);
    }
    let mut lines: Vec<String> = cases(&texts[0], &texts[1])
        .into_iter()
        .map(|line| format!("key {line}"))
        .collect();
    if let [Some(a), Some(b)] = &versions[..]
        && (&a.version, &a.commit) != (&b.version, &b.commit)
    {
        lines.push(format!(
            "version {} ({}) against {} ({})",
            a.version, a.commit, b.version, b.commit
        ));
    }
    Ok(lines)
}

fn text(path: &Path) -> Result<String, OutputError> {
    let content = read_small(path)?;
    String::from_utf8(content).map_err(|error| OutputError::damaged(path, error.to_string()))
}

/// The rows of two histories, by step.
fn histories(runs: &[RunFolder; 2]) -> Result<Histories, OutputError> {
    let mut sheets = Vec::new();
    for run in runs {
        sheets.push(read_sheet(&run.path().join("history.csv"))?);
    }
    let [a, b] = &sheets[..] else {
        unreachable!("two runs");
    };
    let place = |name: &str| a.names.iter().position(|own| own == name);
    let (step, time) = (place("step"), place("time"));
    let time_of = |cells: &[String]| -> Option<f64> { cells.get(time?)?.parse().ok() };
    let step_of = |cells: &[String]| -> Option<u64> { cells.get(step?)?.parse().ok() };
    let mut found = Histories {
        agree: Vec::new(),
        part: None,
    };
    let is_of_step = |(name, _): &(&String, &String)| !SINCE_ROW_BEFORE.contains(&name.as_str());
    let same = |mine: &[String], theirs: &[String]| {
        let of = |cells: &[String]| -> Vec<String> {
            let cells = a.names.iter().zip(cells).filter(is_of_step);
            cells.map(|(_, cell)| cell.clone()).collect()
        };
        a.names == b.names && of(mine) == of(theirs)
    };
    // Rows of steps that only one of them has tell nothing.
    let theirs: BTreeMap<Option<u64>, &Vec<String>> = (b.rows.iter())
        .map(|(_, cells)| (step_of(cells), cells))
        .collect();
    let both = a.rows.iter().filter_map(|(_, mine)| {
        let own = step_of(mine)?;
        Some((mine, *theirs.get(&Some(own))?))
    });
    for (mine, theirs) in both {
        let (Some(one), Some(other)) = (time_of(mine), time_of(theirs)) else {
            break;
        };
        if same(mine, theirs) {
            found.agree.push(one);
        } else {
            found.part = Some([one, other]);
            break;
        }
    }
    Ok(found)
}

/// Tells how the first snapshots of two runs differ.
fn first_snapshots(runs: &[RunFolder; 2]) -> Result<(), OutputError> {
    say("they differ from the start:");
    let [a, b] = runs.each_ref().map(|run| run.snapshot(0));
    tell(&a, &b).map(|_| ())
}

/// The first step of which two folders have different checkpoints, told, and whether it is the first that both have.
fn first_checkpoint(folders: &[PathBuf; 2]) -> Result<Option<(u64, bool)>, OutputError> {
    let list = |folder: &PathBuf| checkpoint::list(&RunFolder::at(folder).checkpoints());
    let (mine, theirs) = (list(&folders[0])?, list(&folders[1])?);
    let pairs = mine.into_iter().filter_map(|(step, path)| {
        let other = theirs.iter().find(|(other, _)| *other == step);
        Some((step, path, other?.1.clone()))
    });
    for (k, (step, a, b)) in pairs.enumerate() {
        if tell(&a, &b)? {
            return Ok(Some((step, k == 0)));
        }
    }
    Ok(None)
}

/// Tells how the particles of two snapshots or checkpoints differ, first in what the fewest of them differ; returns true if
/// they do.
fn tell(a: &Path, b: &Path) -> Result<bool, OutputError> {
    let other = |error: ResultsError| OutputError::OtherRank(error.to_string());
    let report = compare(a, b).map_err(other)?;
    // The cases have been told, and sums follow from particles.
    let lines = report.lines.iter().map(|line| line.trim());
    let mut of_particles = lines.skip_while(|line| *line != "particles: differs");
    let differs = of_particles.next().is_some();
    let count = |line: &&str| -> Option<u64> {
        let (_, rest) = line.split_once(": ")?;
        rest.split_once(" particles differ")?.0.parse().ok()
    };
    let (mut fields, others): (Vec<&str>, Vec<&str>) = of_particles
        .filter(|line| !line.starts_with("state ") && !line.starts_with("first difference"))
        .partition(|line| count(line).is_some());
    fields.sort_by_key(count);
    (others.into_iter().chain(fields)).for_each(|line| say(&one_line(line)));
    Ok(differs)
}
