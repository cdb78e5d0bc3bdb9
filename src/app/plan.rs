//! `whipple plan`: what a case takes on any number of ranks.

mod chart;
mod doubled;
mod job;
mod nodes;
mod source;
mod table;
mod terms;
mod words;

use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;

use super::output_format::OutputFormat;
use super::plot::out::{check_picture, save_text, write_chart};
use files::output::read_small;
use files::plan::{Files, Layout, Load, Machine, Row, Sharing, Weak, computing, work_of_unequal};
use files::preflight::{Costs, memory};
use files::run::exit::{EXIT_FAILED, EXIT_INPUT};
use files::run::say::{counted, say, warn};
use model::Case;
use model::readable::short;
use plot::PlotError;
use source::Source;
pub use table::duration;

/// Plan a run: what a case takes on any number of ranks
///
/// One process cuts the particles of the case for each number of ranks as the run would, in slabs of one to
/// three levels, and counts what each rank owns, hears of others and sends: as much as in the first step of the
/// run, to the unit, but for particles that change ranks. Of a run's folder, a snapshot or a checkpoint it is what a
/// restart from there would begin with. Times follow from that and from what a machine file tells. No MPI.
///
/// Columns: mean and largest number of owned particles; the largest halo, and that over the one which a rank of its
/// size would have in a box filled evenly; the most peers, messages and bytes that a rank sends in a step; memory of
/// the largest rank; a step; efficiency against one core alone; the whole run. A star marks the levels that the
/// case takes by itself.
///
/// With --nodes, layouts that fill the cores of that many nodes are compared instead: each number of threads of a
/// rank that divides the cores of a node. A star marks the fastest of each number of nodes that fits into memory.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple plan inputs/quarter-impact
  whipple plan inputs/quarter-impact --set spacing=0.005mm \\
      --ranks 64,512,4096 --threads 8 --chart plan.png
  whipple plan runs/quarter/checkpoints/step-00000100 \\
      --ranks 16 --machine cluster.toml --doubled
  whipple plan inputs/quarter-impact --nodes 1,2,4 --machine cluster.toml
  whipple plan inputs/quarter-impact --nodes 4 \\
      --machine cluster.toml --job quarter.job
  whipple plan --calibrate here.toml

A machine file holds some of these, in SI units; `whipple plan --ranks 1
--machine FILE` refuses others:
  name, cores_per_node, particle_time, image_time, thread_loss, crowding,
  latency, bandwidth, node_latency, node_bandwidth, agreement_time, overlap,
  disk_bandwidth, memory_per_node, longest_job")]
pub struct PlanArgs {
    /// Case file (TOML), a folder with a case.toml, a run (its last snapshot), a snapshot or a checkpoint
    #[arg(value_name = "CASE_OR_SNAPSHOT", required_unless_present = "calibrate")]
    path: Option<PathBuf>,

    /// Measure this machine by short runs of a few minutes, and write its machine file
    #[arg(long, value_name = "FILE", conflicts_with_all = ["path", "machine"])]
    calibrate: Option<PathBuf>,

    /// Change a value of the case, as in spacing=0.015mm; may be given many times
    #[arg(short, long, value_name = "KEY=VALUE")]
    set: Vec<String>,

    /// Numbers of ranks, as in 16,64 [default: 1, 4, 16 and so on, with 1000 particles each at least]
    #[arg(short = 'n', long, value_name = "N", value_delimiter = ',')]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100_000))]
    ranks: Vec<u32>,

    /// Levels of the slabs: 1, 2 or 3, or auto for those that the case takes [default: all, compared]
    #[arg(long, value_name = "N", value_parser = PossibleValuesParser::new(["1", "2", "3", "auto"]))]
    levels: Option<String>,

    /// Machine file (TOML) [default: an ordinary cluster]
    #[arg(short, long, value_name = "FILE")]
    machine: Option<PathBuf>,

    /// Numbers of nodes, as in 1,2,4: compare ranks and threads that fill their cores, and star the fastest
    #[arg(short = 'N', long, value_name = "N", value_delimiter = ',')]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100_000))]
    #[arg(conflicts_with_all = ["ranks", "levels", "doubled", "terms", "chart", "calibrate"])]
    nodes: Vec<u32>,

    /// Write a batch script for SLURM and PBS: a chain of jobs on the fastest layout of --nodes
    #[arg(short, long, value_name = "FILE", requires = "nodes")]
    job: Option<PathBuf>,

    /// Threads of each rank [default: 1; with --nodes all that divide the cores of a node]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,

    /// Ranks of each node [default: as many as its cores take]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    ranks_per_node: Option<u32>,

    /// Tell the efficiency with each number of the machine doubled in turn, for the most ranks
    #[arg(long)]
    doubled: bool,

    /// Tell what a step consists of, for the most ranks, in this model and in weak scaling
    #[arg(long)]
    terms: bool,

    /// Particles of each core in weak scaling: the same model, refined, which the chart shows too
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u32).range(1..))]
    per_core: u32,

    /// Draw strong and weak scaling into this SVG or PNG file
    #[arg(short, long, value_name = "FILE")]
    chart: Option<PathBuf>,

    #[command(flatten)]
    format: OutputFormat,

    /// Write the table, in SI units, into this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,

    /// Width of the chart in pixels
    #[arg(long, value_name = "PIXELS")]
    width: Option<u32>,
}

/// Runs the command; returns the exit code.
pub fn run(args: &PlanArgs) -> u8 {
    args.format.begin();
    let (done, code) = match (&args.calibrate, &args.path) {
        (Some(file), _) => (calibrate(file), EXIT_FAILED),
        (None, path) => {
            let path = path.as_deref().unwrap_or(Path::new("."));
            (plan(args, path), EXIT_INPUT)
        }
    };
    done.map_or_else(
        |message| {
            warn(&message);
            code
        },
        |()| 0,
    )
}

/// Measures this machine and writes its file.
fn calibrate(path: &Path) -> Result<(), String> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let machine = bench::calibrate(folder.unwrap_or(Path::new(".")));
    let machine = machine.map_err(|what| {
        let what = what.trim_start_matches("error: ");
        format!("error: {what}")
    })?;
    let text = machine.text();
    say(text.trim_end());
    write_text(path, text.as_bytes())?;
    say(
        "of messages, memory and jobs it tells what an ordinary cluster has: put what you know of yours in their place",
    );
    Ok(())
}

fn write_text(path: &Path, text: &[u8]) -> Result<(), String> {
    save_text(path, text).map_err(with_prefix)
}

/// Something planned: what ranks have, and what follows.
struct Planned {
    loads: Vec<Load>,
    row: Row,
    weak: Weak,
}

/// The most ranks, in the levels that are fastest.
fn most(all: &[Planned]) -> Option<&Planned> {
    all.iter().max_by(|a, b| {
        let by_ranks = a.row.ranks.cmp(&b.row.ranks);
        by_ranks.then(a.row.efficiency.total_cmp(&b.row.efficiency))
    })
}

fn plan(args: &PlanArgs, path: &Path) -> Result<(), String> {
    if let Some(path) = &args.chart {
        check_picture(path).map_err(with_prefix)?;
    }
    let machine = args
        .machine
        .as_deref()
        .map_or(Ok(Machine::default()), machine)?;
    let source = source::read(path, &args.set)?;
    say(&words::heading(&source));
    say(&words::machine(&machine));
    let share = source.outlook.share_of_work;
    if let Some(line) = words::rest(share) {
        say(&line);
    }
    let unequal = work_of_unequal(&source.case);
    if let Some(line) = words::unequal(unequal) {
        say(&line);
    }
    let machine = machine.at_work(unequal).at_rest(share);
    if !args.nodes.is_empty() {
        return nodes::plan(args, path, &source, &machine);
    }
    let (all, files) = print_ranks(args, &source, &machine)?;
    let rows: Vec<Row> = all.iter().map(|planned| planned.row).collect();
    write_sheet(args, &rows, source.outlook.steps)?;
    if let Some(path) = &args.chart {
        let weak: Vec<Weak> = all.iter().map(|planned| planned.weak).collect();
        let title = format!("{}, {}", source.case.title, machine.name);
        let particles = source.particles.positions.len();
        let chart = chart::chart(&title, particles, args.per_core, &rows, &weak);
        write_chart(&chart, args.width, path).map_err(with_prefix)?;
    }
    args.format
        .print(|| table::document(&source, &machine, &rows, &files));
    Ok(())
}

/// Compares levels for each number of ranks.
fn print_ranks(
    args: &PlanArgs,
    source: &Source,
    machine: &Machine,
) -> Result<(Vec<Planned>, Files), String> {
    let sharing = args.sharing(machine);
    say(&words::sharing(sharing));
    say("");
    say(&table::head());
    let alone = layout_of(source, 1, Some(1), 1)?.loads[0];
    let mut all = Vec::new();
    for ranks in args.ladder(source.particles.positions.len()) {
        let own = layout_of(source, ranks, None, sharing.ranks_per_node)?;
        for levels in args.levels(&source.case, own.slabs.levels(), ranks) {
            let is_own = levels == own.slabs.levels();
            let layout = if is_own {
                own.clone()
            } else {
                layout_of(source, ranks, Some(levels), sharing.ranks_per_node)?
            };
            let row = row_of(source, machine, &layout, sharing, &alone);
            let line = table::line(&row, is_own, source.outlook.steps);
            say(&(line + &table::excess(&row, machine)));
            let each = f64::from(args.per_core) * as_number(sharing.threads);
            let weak = Weak::new(&layout.loads, levels, each, machine, sharing);
            let loads = layout.loads;
            all.push(Planned { loads, row, weak });
        }
    }
    say("");
    let files = print_files(source, machine)?;
    if args.terms {
        terms::print(args, &all);
    }
    if args.doubled {
        doubled::print(args, machine, &alone, &all);
    }
    Ok((all, files))
}

fn write_sheet(args: &PlanArgs, rows: &[Row], steps: Option<f64>) -> Result<(), String> {
    let Some(path) = &args.csv else { return Ok(()) };
    write_text(path, &table::sheet(rows, steps).text())
}

impl PlanArgs {
    #[allow(
        clippy::cast_possible_truncation,
        reason = "a hundred thousand at most"
    )]
    fn ladder(&self, particles: usize) -> Vec<usize> {
        if !self.ranks.is_empty() {
            return self.ranks.iter().map(|&ranks| ranks as usize).collect();
        }
        let most = (particles / 1000).clamp(1, 100_000);
        let powers = (0..).map(|k| 4_usize.pow(k));
        powers.take_while(|&ranks| ranks <= most).collect()
    }

    fn levels(&self, case: &Case, own: usize, ranks: usize) -> Vec<usize> {
        match self.levels.as_deref() {
            Some("auto") => vec![own],
            Some(text) => text.parse().into_iter().collect(),
            None if ranks == 1 => vec![own],
            None => (1..=case.dimension).collect(),
        }
    }

    fn sharing(&self, machine: &Machine) -> Sharing {
        let threads = self.threads.map_or(1, usize::from);
        let named = self.ranks_per_node.map(|ranks| ranks as usize);
        Sharing {
            threads,
            ranks_per_node: named.unwrap_or_else(|| machine.ranks_per_node(threads)),
        }
    }
}

#[allow(clippy::needless_pass_by_value, reason = "to map errors by")]
fn with_prefix(error: PlotError) -> String {
    format!("error: {error}")
}

fn machine(path: &Path) -> Result<Machine, String> {
    let bytes = read_small(path).map_err(|error| format!("error: {error}"))?;
    let wrong = |what: &str| format!("error: {}: {what}", path.display());
    let text = std::str::from_utf8(&bytes).map_err(|_| wrong("it is no text"))?;
    Machine::parse(text).map_err(|what| wrong(&what))
}

fn layout_of(
    source: &Source,
    ranks: usize,
    levels: Option<usize>,
    ranks_per_node: usize,
) -> Result<Layout, String> {
    let layout = Layout::new(
        &source.case,
        &source.particles,
        source.time,
        &source.outlook,
        ranks,
        levels,
        ranks_per_node,
    );
    layout.ok_or_else(|| "error: the case has no particles".to_owned())
}

/// The plan for a number of ranks in slabs of some levels, and its row of the table.
fn row_of(
    source: &Source,
    machine: &Machine,
    layout: &Layout,
    sharing: Sharing,
    alone: &Load,
) -> Row {
    let costs = Costs::of_case(&source.case);
    let work = computing(alone, machine);
    Row::new(&source.particles, layout, machine, sharing, costs, work)
}

fn print_files(source: &Source, machine: &Machine) -> Result<Files, String> {
    let count = as_number(source.particles.positions.len());
    let outlook = &source.outlook;
    let steps = outlook.steps.unwrap_or(0.0);
    let files = Files::new(&source.case, &outlook.approaches, count, steps);
    let files = files.map_err(|error| format!("error: {error}"))?;
    for line in file_lines(&files, machine) {
        say(&format!("  {line}"));
    }
    Ok(files)
}

#[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
fn as_number(count: usize) -> f64 {
    count as f64
}

/// The files that there will be.
pub fn file_lines(files: &Files, machine: &Machine) -> Vec<String> {
    let size = memory::in_words;
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole numbers"
    )]
    let many = |count: f64, word: &str| counted(count as u64, word);
    vec![
        format!(
            "{} of {}; {} of {}, of which {} stay; tables of {}",
            many(files.snapshots, "snapshot"),
            size(files.snapshot),
            many(files.checkpoints, "checkpoint"),
            size(files.checkpoint),
            short(files.kept),
            size(files.tables),
        ),
        format!(
            "{} on the disk at the end; {} to write all, at {} a second",
            size(files.disk()),
            duration(files.written() / machine.disk_bandwidth),
            size(machine.disk_bandwidth),
        ),
    ]
}
