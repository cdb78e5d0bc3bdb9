//! The commands of the program.

mod check;
pub mod compare;
mod diff;
mod export;
mod fork;
pub mod fragments;
mod generate;
pub mod info;
mod limit;
mod materials;
mod measure;
pub mod memory;
mod new;
mod output_format;
mod plan;
pub mod plot;
mod replay;
mod report;
mod restart;
pub mod results;
mod run;
mod shell;
mod sweep;
mod version;
mod watch;
mod when;
pub mod which;
mod why;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use files::output::set_commit;
use files::run::exit::EXIT_INPUT;
use files::run::{launch, say};
use model::readable::is_printable;

/// MPI-parallel smoothed particle hydrodynamics for large 3-D impacts of solids
#[derive(Debug, Parser)]
#[command(
    name = "whipple",
    version,
    after_help = "Examples:
  whipple new my-shield --from shield
  whipple check inputs/quarter-impact
  whipple plan inputs/quarter-impact --ranks 16,64
  mpirun -n 2 whipple run inputs/quarter-impact --out runs/quarter
  whipple watch runs/quarter
  whipple info runs/quarter
  whipple plot runs/quarter --panels
  whipple export runs/quarter --to vtu --all
  whipple fragments runs/quarter
  whipple measure runs/quarter
  whipple report runs/quarter
  mpirun -n 4 whipple restart runs/quarter --set run.end_time=0.3us
  whipple replay runs/quarter --from 50ns --to 60ns --snapshot-every 1ns
  whipple when \"failed plate\" runs/quarter
  whipple fork runs/quarter --set material.aluminium.failure.spall.pressure=\"-1.6 GPa\"
  whipple sweep inputs/quarter-impact --vary body.sphere.velocity=\"3..9 km/s\"
  whipple limit nno --bumper 1.2mm --wall 3.2mm --gap 100mm --yield 40ksi

For work on the program itself: `whipple compare` tells whether two results
agree to the last bit, `whipple bench` measures how fast it steps here.

`whipple COMMAND --help` says more, `whipple --version` which MPI and HDF5 it
runs with. Only `run`, `restart`, `replay`, `when`, `diff`, `fork` and `bench` use MPI. Exit codes: 0 done,
1 failed (or `compare` found differences), 2 wrong input, 75 stopped softly with
a checkpoint."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    New(new::NewArgs),
    Run(run::RunArgs),
    Restart(restart::RestartArgs),
    Replay(replay::ReplayArgs),
    When(when::WhenArgs),
    Diff(diff::DiffArgs),
    Fork(fork::ForkArgs),
    Check(check::CheckArgs),
    Plan(plan::PlanArgs),
    Plot(Box<plot::PlotArgs>),
    Report(report::ReportArgs),
    Export(export::ExportArgs),
    Watch(watch::WatchArgs),
    Info(info::InfoArgs),
    Fragments(fragments::FragmentsArgs),
    Measure(measure::MeasureArgs),
    Materials(materials::MaterialsArgs),
    Limit(limit::LimitArgs),
    Generate(generate::GenerateArgs),
    Sweep(sweep::SweepArgs),
    Converge(sweep::ConvergeArgs),
    #[command(hide = true)]
    Compare(compare::CompareArgs),
    #[command(hide = true)]
    Bench(bench::BenchArgs),
}

impl Command {
    /// True of what runs a case itself, on the ranks of its job.
    fn has_ranks(&self) -> bool {
        matches!(
            self,
            Self::Run(_)
                | Self::Restart(_)
                | Self::Replay(_)
                | Self::When(_)
                | Self::Diff(_)
                | Self::Fork(_)
        )
    }
}

/// Runs the program, built from `commit`: its command line, its exit code.
#[must_use]
pub fn main(commit: &'static str) -> ExitCode {
    set_commit(commit);
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            launch::once(|| match version::asked(&error) {
                Some(text) => say::say(&text),
                None => print_error(&error),
            });
            let code = if error.use_stderr() { EXIT_INPUT } else { 0 };
            return ExitCode::from(say::exit_code(code));
        }
    };
    if !cli.command.has_ranks() {
        end_with_the_pipe();
        exit_on_panic();
    }
    // The others start their own threads.
    if !cli.command.has_ranks() && !matches!(cli.command, Command::Bench(_)) {
        launch::bound_threads();
    }
    let code = match cli.command {
        Command::New(args) => new::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Restart(args) => restart::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::When(args) => when::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Fork(args) => fork::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Plot(args) => plot::run(&args).map_or_else(
            |error| {
                say::warn(&format!("error: {error}"));
                EXIT_INPUT
            },
            |()| 0,
        ),
        Command::Report(args) => report::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Watch(args) => watch::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Fragments(args) => fragments::run(&args),
        Command::Measure(args) => measure::run(&args),
        Command::Materials(args) => materials::run(&args),
        Command::Limit(args) => limit::run(&args),
        Command::Generate(args) => generate::run(&args, Cli::command()),
        Command::Sweep(args) => sweep::run(&args),
        Command::Converge(args) => sweep::converge(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Bench(args) => bench::run(&args),
    };
    ExitCode::from(say::exit_code(code))
}

/// Says what is wrong with the command line, or the help; in colours, unless the words that it
/// repeats would do more than that to the terminal.
fn print_error(error: &clap::Error) {
    let hostile = |word: OsString| !word.to_string_lossy().chars().all(is_printable);
    if std::env::args_os().any(hostile) {
        say::warn(&error.to_string());
    } else {
        say::note_loss(error.print());
    }
}

/// Lets a closed pipe (`whipple info … | head`) end the process quietly, as it ends other tools.
fn end_with_the_pipe() {
    // SAFETY: there is no other thread yet, and the handler is the system's own.
    unsafe { libc::signal(libc::SIGPIPE, libc::SIG_DFL) };
}

/// Ends the process with the code of a panic, after the message: a build that does not unwind would raise a signal.
fn exit_on_panic() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        print(info);
        std::process::exit(launch::EXIT_PANIC);
    }));
}
