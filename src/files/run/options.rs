//! Options of a run beside its case.

use std::time::Duration;

use super::stop::{parse_until, parse_walltime};
use super::verbosity::{LogFormat, Verbosity};
use crate::preflight::memory;
use comm::Comm;
use model::Case;

/// Options that `run` and `restart` share.
#[derive(Debug, Clone, clap::Args)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is an option of its own"
)]
pub struct CommonArgs {
    /// Stop with a checkpoint at the first step at or after this time of the case, as in 0.1us
    #[arg(short, long, value_name = "TIME", value_parser = parse_until)]
    pub until: Option<f64>,

    /// Stop with a checkpoint after this much time of the clock, as in 90s, 2h or 1:30:00
    #[arg(short, long, value_name = "TIME", value_parser = parse_walltime)]
    pub walltime: Option<Duration>,

    /// Print neither lines nor a bar: warnings and errors alone
    #[arg(short, long)]
    pub quiet: bool,

    /// Form of what is printed: lines of text, or a JSON object a line, with the lines of log.txt
    #[arg(long, value_name = "FORM", value_enum, default_value_t)]
    pub log: LogFormat,

    /// Threads of each rank [default: the cores shared out among the machine's ranks]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,

    /// Start even if the memory that the ranks will take is more than there is
    #[arg(long)]
    pub ignore_memory: bool,

    /// Take the folder of the results even if another process seems to write into it
    #[arg(long)]
    pub ignore_lock: bool,

    /// Fill all that is not state with NaN between steps, to find what a checkpoint forgets
    #[arg(long, hide = true)]
    pub poison: bool,
}

impl CommonArgs {
    /// Verbosity of this process.
    #[must_use]
    pub fn verbosity(&self) -> Verbosity {
        Verbosity {
            quiet: self.quiet,
            json: self.log == LogFormat::Json,
        }
    }

    /// An error message if there is not enough memory for a case, unless that is ignored. Collective.
    pub fn shortage(&self, comm: &Comm, case: &Case) -> Option<String> {
        let shortage = (!self.ignore_memory).then(|| memory::shortage(comm, case));
        shortage.flatten().map(|why| format!("error: {why}"))
    }
}
