//! Takes turns between one thread, two threads and two ranks, each in a process of its own.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::de::DeserializeOwned;
use signal_hook::consts::SIGINT;

use super::BenchArgs;
use super::cases::BenchCase;
use super::machine::cores;
use super::report::{Report, Row};
use files::run::exit::{EXIT_FAILED, EXIT_INTERRUPTED};
use files::run::say::{say, warn};

/// Ranks and the threads of each; the first is what the others are compared with.
pub(super) type Configuration = (usize, usize);
const CONFIGURATIONS: [Configuration; 3] = [(1, 1), (1, 2), (2, 1)];

/// Environment of `mpirun`, names and values: ranks are not to be bound, since they bind their own
/// threads. Names of Open MPI 4 and 5; variables that the caller has set stay.
const LAUNCH: [(&str, &str); 2] = [
    ("OMPI_MCA_hwloc_base_binding_policy", "none"),
    ("PRTE_MCA_hwloc_default_binding_policy", "none"),
];

/// Runs all measurements; returns the exit code.
pub fn run(args: &BenchArgs) -> u8 {
    let interrupted = Arc::new(AtomicBool::new(false));
    // Ctrl-C ends the processes that measure; this one then cleans up.
    let _ = signal_hook::flag::register(SIGINT, Arc::clone(&interrupted));
    match measure_all(args) {
        Ok(()) => 0,
        Err(_) if interrupted.load(Ordering::Relaxed) => {
            u8::try_from(EXIT_INTERRUPTED).unwrap_or(EXIT_FAILED)
        }
        Err(message) => {
            warn(&format!("error: {}", message.trim_start_matches("error: ")));
            EXIT_FAILED
        }
    }
}

fn measure_all(args: &BenchArgs) -> Result<(), String> {
    let mut report = Report::new(args.repeat);
    let possible: Vec<Configuration> = CONFIGURATIONS
        .into_iter()
        .filter(|&configuration| match obstacle(configuration) {
            None => true,
            Some(reason) => {
                let (ranks, threads) = configuration;
                let text = format!("{ranks} x {threads} is skipped: {reason}");
                warn(&text);
                report.skipped.push(text);
                false
            }
        })
        .collect();
    let scratch = Scratch::create()?;
    for case in args.cases() {
        let rows = measure_case(args, case, &possible, &scratch.0)?;
        report.rows.extend(rows);
        report.print_case(case);
    }
    report.print_breakdown();
    report.print_efficiencies();
    report
        .write(args.json.as_deref())
        .map_err(|error| error.to_string())?;
    if let Some(path) = &args.json {
        say(&format!("\nall figures are in {}", path.display()));
    }
    Ok(())
}

/// The rows of a case, whose configurations take turns.
fn measure_case(
    args: &BenchArgs,
    case: &BenchCase,
    configurations: &[Configuration],
    scratch: &Path,
) -> Result<Vec<Row>, String> {
    let state = (case.begin > 0.0).then(|| scratch.join(case.name));
    if let Some(folder) = &state {
        show(case, "stepping to where it begins");
        let mut command = program((1, cores()), case)?;
        launch(command.arg("--save").arg(folder))?;
    }
    let mut repetitions = vec![Vec::new(); configurations.len()];
    for repetition in 1..=args.repeat {
        for (&configuration, rows) in configurations.iter().zip(&mut repetitions) {
            let (ranks, threads) = configuration;
            show(
                case,
                &format!(
                    "{ranks} x {threads}, repetition {repetition} of {}",
                    args.repeat
                ),
            );
            let figures = scratch.join("figures.json");
            let mut command = program(configuration, case)?;
            command.arg("--repeat=1").arg("--json").arg(&figures);
            if let Some(steps) = args.steps {
                command.arg(format!("--steps={steps}"));
            }
            if let Some(folder) = &state {
                command.arg("--from").arg(folder);
            }
            launch(&mut command)?;
            rows.extend(read::<Report>(&figures)?.rows);
        }
    }
    if let Some(folder) = &state {
        let _ = std::fs::remove_dir_all(folder);
    }
    show(case, "");
    let mut rows: Vec<Row> = repetitions.iter().map(|rows| Row::median(rows)).collect();
    let one = rows[0].clone();
    for row in &mut rows {
        row.compare(&one);
    }
    Ok(rows)
}

/// The reason why a configuration cannot be measured here, if there is one.
pub(super) fn obstacle((ranks, threads): Configuration) -> Option<String> {
    let (needed, cores) = (ranks * threads, cores());
    if needed > cores {
        return Some(format!(
            "it needs {needed} cores and this process may use {cores}"
        ));
    }
    if ranks == 1 {
        return None;
    }
    match launch(mpirun(ranks).arg("true")) {
        Ok(()) => None,
        Err(message) => Some(refusal(&message)),
    }
}

/// The reason why `mpirun` does not start ranks, from its message, with advice.
fn refusal(message: &str) -> String {
    // Both the option and the variables that Open MPI's essay of many lines names.
    if message.contains("allow-run-as-root") {
        return "mpirun refuses to run as root; `source jobs/env.sh` first, or set \
                OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"
            .to_owned();
    }
    // Open MPI sets lines of dashes around its messages.
    let is_rule = |line: &str| line.bytes().all(|byte| byte == b'-');
    let mut lines = message.lines().map(str::trim);
    let first = lines.find(|line| line.len() > 1 && !is_rule(line));
    format!(
        "mpirun does not work here ({})",
        first.unwrap_or("it says nothing")
    )
}

/// This program measuring one case on one configuration.
pub(super) fn program(
    (ranks, threads): Configuration,
    case: &BenchCase,
) -> Result<Command, String> {
    let mut command = bench_on(ranks)?;
    command
        .args(["--case", case.name])
        .arg(format!("--threads={threads}"));
    Ok(command)
}

/// `whipple bench` of this program on `ranks` ranks.
pub(super) fn bench_on(ranks: usize) -> Result<Command, String> {
    let own = std::env::current_exe().map_err(|e| format!("this program is not found: {e}"))?;
    let mut command = if ranks == 1 {
        Command::new(own)
    } else {
        let mut command = mpirun(ranks);
        command.arg(own);
        command
    };
    command.arg("bench");
    Ok(command)
}

fn mpirun(ranks: usize) -> Command {
    let mut command = Command::new("mpirun");
    command.arg("-n").arg(ranks.to_string());
    for (name, value) in LAUNCH {
        if std::env::var_os(name).is_none() {
            command.env(name, value);
        }
    }
    command
}

/// Runs a command to its end.
///
/// # Errors
/// Its message, if it does not start or fails.
pub(super) fn launch(command: &mut Command) -> Result<(), String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("{program} does not start: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(if message.trim().is_empty() {
        format!("{program} ended with {}", output.status)
    } else {
        message
    })
}

/// Reads the results of a measuring process.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let wrong = |error: &dyn std::fmt::Display| format!("cannot read {}: {error}", path.display());
    let text = std::fs::read(path).map_err(|e| wrong(&e))?;
    serde_json::from_slice(&text).map_err(|e| wrong(&e))
}

/// Shows on a terminal what is being measured, over the last such line.
fn show(case: &BenchCase, what: &str) {
    if std::io::stderr().is_terminal() {
        let text = if what.is_empty() {
            String::new()
        } else {
            format!("{}: {what}", case.name)
        };
        eprint!("\r\x1b[2K{text}");
    }
}

/// A folder for states and figures, removed when dropped.
pub(super) struct Scratch(pub(super) PathBuf);

impl Scratch {
    pub(super) fn create() -> Result<Self, String> {
        let path = std::env::temp_dir().join(format!("whipple-bench-{}", std::process::id()));
        std::fs::create_dir_all(&path)
            .map_err(|error| format!("cannot make the folder {}: {error}", path.display()))?;
        Ok(Self(path))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::refusal;

    #[test]
    fn who_is_root_is_told_what_to_do() {
        let rule = "-".repeat(74);
        let essay = format!(
            "{rule}\nmpirun has detected an attempt to run as root.\n\nYou can override this \
             protection by adding the --allow-run-as-root option\n{rule}\n"
        );
        assert!(refusal(&essay).contains("source jobs/env.sh"));
        let other = format!("{rule}\nThere are not enough slots.\n{rule}\n");
        assert!(refusal(&other).ends_with("(There are not enough slots.)"));
    }
}
