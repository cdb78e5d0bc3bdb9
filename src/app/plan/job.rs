//! The batch script of a layout, for SLURM and for PBS: a chain of jobs.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::source::Source;
use crate::run::default_folder;
use crate::shell::quoted;
use files::output::RunFolder;
use files::plan::{Machine, Row};
use model::readable::one_line;

/// Requested time of a job over the predicted time.
const MARGIN: f64 = 2.0;
/// The least time that a job requests (minutes), and how long before its end the run stops: PBS
/// sends no signal, and ranks begin some time after the job.
const LEAST: f64 = 10.0;
const EARLIER: f64 = 5.0;

/// The resources that a job requests.
pub struct Job<'a> {
    row: &'a Row,
    nodes: usize,
    /// Minutes, a whole number.
    minutes: f64,
    /// Of a node (MB of 2²⁰ bytes), if it is in the machine file.
    memory: Option<u64>,
    /// The predicted number of such jobs.
    jobs: Option<f64>,
}

/// The run that a chain from this path goes on with or begins.
///
/// # Errors
/// The whole message, if there cannot be one.
pub fn run_of(path: &Path, source: &Source) -> Result<PathBuf, String> {
    if RunFolder::is_run(path) {
        return Ok(path.to_owned());
    }
    if source.time.is_some() {
        return Err(format!(
            "error: {}: --job takes a case or the folder of a run",
            one_line(&path.display().to_string())
        ));
    }
    Ok(default_folder(path))
}

impl<'a> Job<'a> {
    /// For a layout of a machine, where so many seconds are foreseen.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "in the ranges of a machine"
    )]
    pub fn new(row: &'a Row, machine: &Machine, wanted: Option<f64>) -> Self {
        let most = (machine.longest_job / 60.0).floor();
        let minutes = wanted.map_or(most, |wanted| {
            (MARGIN * wanted / 60.0).ceil().clamp(LEAST, most)
        });
        let memory = Some(machine.memory_per_node).filter(|memory| memory.is_finite());
        let of_one = 60.0 * (minutes - EARLIER);
        Self {
            row,
            nodes: row.ranks / row.sharing.ranks_per_node,
            minutes,
            memory: memory.map(|memory| (memory / 1_048_576.0) as u64),
            jobs: wanted.map(|wanted| (wanted / of_one).ceil().max(1.0)),
        }
    }

    /// The script, which is to be `file`, of a case and its run.
    pub fn text(&self, file: &Path, [case, run]: [&Path; 2], set: &[String]) -> Vec<u8> {
        let (nodes, sharing) = (self.nodes, self.row.sharing);
        let (ranks, threads) = (sharing.ranks_per_node, sharing.threads);
        let cores = ranks * threads;
        let time = clock(self.minutes);
        let [slurm, pbs] = self.memory.map_or_else(Default::default, |memory| {
            [
                format!("#SBATCH --mem={memory}M\n"),
                format!(":mem={memory}mb"),
            ]
        });
        let mut text = format!(
            "\
#!/usr/bin/env bash
#SBATCH --job-name=whipple
#SBATCH --nodes={nodes}
#SBATCH --ntasks-per-node={ranks}
#SBATCH --cpus-per-task={threads}
{slurm}#SBATCH --exclusive
#SBATCH --time={time}
#SBATCH --signal=B:USR1@120
#SBATCH --ignore-pbs
#PBS -N whipple
#PBS -l select={nodes}:ncpus={cores}:mpiprocs={ranks}:ompthreads={threads}{pbs}
#PBS -l place=scatter:excl
#PBS -l walltime={time}
# Written by whipple plan. Submit it with sbatch or qsub from the folder in which it was written and
# jobs/ is: each job submits the next one until the run is at its end (jobs/chain.sh). Account and
# queue belong above this line, modules below.
set -euo pipefail
cd \"${{PBS_O_WORKDIR:-.}}\"
export WHIPPLE_JOB="
        )
        .into_bytes();
        text.extend(quoted(file.as_os_str()));
        text.extend(b"\nexec jobs/chain.sh");
        let set = set.iter().flat_map(|value| ["--set", value]);
        let time = clock(self.minutes - EARLIER);
        let options = set.chain(["--walltime", &time]).map(OsStr::new);
        for word in [case.as_os_str(), run.as_os_str()]
            .into_iter()
            .chain(options)
        {
            text.push(b' ');
            text.extend(quoted(word));
        }
        text.push(b'\n');
        text
    }

    /// The requested resources, and how to submit the job.
    pub fn summary(&self, file: &Path) -> String {
        let sharing = self.row.sharing;
        let plural = |count: usize| if count == 1 { "" } else { "s" };
        let jobs = match self.jobs {
            Some(jobs) if jobs > 1.0 => format!(", some {jobs} such jobs"),
            _ => String::new(),
        };
        let file = String::from_utf8_lossy(&quoted(file.as_os_str())).into_owned();
        format!(
            "it asks for {} node{} of {} rank{} of {} thread{}, for {}{jobs}; submit it: sbatch {file}, or qsub {file}",
            self.nodes,
            plural(self.nodes),
            sharing.ranks_per_node,
            plural(sharing.ranks_per_node),
            sharing.threads,
            plural(sharing.threads),
            clock(self.minutes),
            file = one_line(&file),
        )
    }
}

/// Whole minutes as hours:minutes:seconds.
fn clock(minutes: f64) -> String {
    format!("{}:{:02}:00", (minutes / 60.0).floor(), minutes % 60.0)
}
