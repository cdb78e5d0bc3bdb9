//! `whipple bench`: how fast this program steps on this machine, on fixed cases.

mod calibrate;
mod cases;
mod driver;
mod machine;
mod measure;
mod memory;
mod messages;
mod neighbours;
mod pin;
mod report;

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;

pub use calibrate::calibrate;
use cases::{BenchCase, CASES};
use comm::{Comm, Session};
use files::output::on_root;
use files::run::exit::{EXIT_FAILED, EXIT_INPUT};
use files::run::{launch, say};
use report::{Report, Row};

/// Measure how fast this program steps on this machine, on fixed cases
///
/// Alone, it compares one thread, two threads and two ranks (through mpirun) in turn, each in a
/// process of its own with its threads bound to cores, and prints million particle updates a second
/// for each core, efficiencies, memory, messages and nanoseconds a particle by phase. Figures are
/// medians of the repetitions; an efficiency is the median of the ratios within them. Under mpirun,
/// or with --threads, it measures just that number of ranks and threads. Whole steps count, with
/// the sums of history.csv but without writing files.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("Cases:\n{}

Examples:
  whipple bench --json bench.json
  whipple bench --case quarter-400k --repeat 5
  whipple bench --case block-1m --threads 8
  mpirun -n 4 whipple bench --case quarter-400k --threads 1
  mpirun -n 2 --map-by node whipple bench --messages", cases::table()))]
pub struct BenchArgs {
    /// Case to measure; may be given many times [default: all but the small ones of --quick and those that are to be named]
    #[arg(
        short,
        long = "case",
        value_name = "NAME",
        value_parser = PossibleValuesParser::new(CASES.iter().map(|case| case.name)),
        hide_possible_values = true
    )]
    cases: Vec<String>,

    /// Repetitions of each measurement
    #[arg(short, long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..))]
    repeat: u32,

    /// Steps of each measurement [default: the case's own]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    steps: Option<u64>,

    /// Measure one configuration alone, with so many threads on each rank
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,

    /// Small cases only, to try the command: seconds instead of minutes
    #[arg(long, conflicts_with = "cases")]
    quick: bool,

    /// Measure messages between the ranks of mpirun in place of cases, as a plan's machine file tells them
    #[arg(long, conflicts_with_all = ["cases", "quick", "steps", "threads", "repeat"])]
    messages: bool,

    /// Write all figures, with the facts of the machine, to this file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// Folder with the state that the case begins from
    #[arg(long, value_name = "DIR", hide = true)]
    from: Option<PathBuf>,

    /// Step to the state that the case begins from, and write it into this folder
    #[arg(long, value_name = "DIR", hide = true)]
    save: Option<PathBuf>,
}

impl BenchArgs {
    fn cases(&self) -> Vec<&'static BenchCase> {
        let named = |case: &BenchCase| self.cases.iter().any(|name| name == case.name);
        let wanted = |case: &&BenchCase| {
            if self.cases.is_empty() {
                case.quick == self.quick && !case.on_demand
            } else {
                named(case)
            }
        };
        CASES.iter().filter(wanted).collect()
    }
}

/// Runs the command; returns the exit code.
#[must_use]
pub fn run(args: &BenchArgs) -> u8 {
    if launch::by_mpi() || args.threads.is_some() || args.messages {
        return one_configuration(args);
    }
    if let Err(message) = writable(args) {
        say::warn(&message);
        return EXIT_INPUT;
    }
    driver::run(args)
}

/// Measures this job's ranks with their threads.
fn one_configuration(args: &BenchArgs) -> u8 {
    let (_session, comm) = if launch::by_mpi() {
        let Some((session, comm)) = Session::start() else {
            say::warn("error: MPI does not start; is this the mpirun that it was built with?");
            return EXIT_FAILED;
        };
        launch::abort_on_panic(comm.rank());
        (Some(session), comm)
    } else {
        (None, Comm::solo())
    };
    if let Err(message) = pin::start_threads(args.threads.map_or(1, usize::from), &comm) {
        return launch::warn(&comm, &message);
    }
    let ready = if comm.is_root() {
        writable(args)
    } else {
        Ok(())
    };
    if comm.any(ready.is_err()) {
        return launch::warn(&comm, &ready.err().unwrap_or_default());
    }
    let done = match &args.save {
        _ if args.messages => messages::run(&comm, args.json.as_deref()),
        Some(folder) => args
            .cases()
            .into_iter()
            .try_for_each(|case| measure::prepare(&comm, case, folder)),
        None => measure_cases(args, &comm),
    };
    match done {
        Ok(()) => 0,
        Err(message) => {
            launch::warn(&comm, &format!("error: {message}"));
            EXIT_FAILED
        }
    }
}

fn measure_cases(args: &BenchArgs, comm: &Comm) -> Result<(), String> {
    let mut report = Report::new(args.repeat);
    for case in args.cases() {
        let repetitions = (0..args.repeat)
            .map(|_| measure::measure(comm, case, args.steps, args.from.as_deref()))
            .collect::<Result<Vec<Row>, String>>()?;
        let mut row = Row::median(&repetitions);
        if !report.rows.is_empty() {
            // Memory that the last case has left to the allocator would hide that of this one.
            row.peak_bytes_per_particle = None;
        }
        report.rows.push(row);
        if comm.is_root() {
            report.print_case(case);
        }
    }
    if comm.is_root() {
        report.print_breakdown();
    }
    on_root(comm, || report.write(args.json.as_deref())).map_err(|error| error.to_string())
}

/// Checks before the work that the file of the figures can be written.
fn writable(args: &BenchArgs) -> Result<(), String> {
    let Some(path) = &args.json else {
        return Ok(());
    };
    // Its content stays until the end.
    std::fs::OpenOptions::new()
        .append(true)
        .create(true)
        .open(path)
        .map(drop)
        .map_err(|error| format!("error: cannot write {}: {error}", path.display()))
}
