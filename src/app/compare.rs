//! `whipple compare`: whether two results are the same to the last bit.

mod content;
pub(super) mod tables;
mod text;

pub(super) use text::cases;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::output_format::OutputFormat;
use super::results::{Results, ResultsError};
use files::output::checkpoint;
use files::output::h5::Content;
use files::output::{RunFolder, gauge_records, read_regular};
use files::run::exit::EXIT_INPUT;
use files::run::say::{say, warn};
use model::readable::one_line;

/// Tell whether two results agree to the last bit
///
/// Particles are matched by id. Of two runs, the cases (but for the tables output, run and
/// domain), the histories, the contact ledgers, and every snapshot and checkpoint that both have
/// are compared; what only one has is told. Whatever depends on ranks or clocks is left out.
/// Exits with 0 if all that both have agrees, with 1 if anything differs.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple compare runs/two-ranks runs/four-ranks
  whipple compare a/snapshots/step-00000100.vtkhdf \\
      b/snapshots/step-00000100.vtkhdf
  whipple compare a/checkpoints/step-00000100 b/checkpoints/step-00000100")]
pub struct CompareArgs {
    /// Run folder, snapshot (.vtkhdf) or checkpoint
    #[arg(value_name = "A")]
    pub a: PathBuf,

    /// Another of the same kind
    #[arg(value_name = "B")]
    pub b: PathBuf,

    /// Form of the output.
    #[command(flatten)]
    pub format: OutputFormat,
}

/// Exit code when something differs.
const EXIT_DIFFERENT: u8 = 1;

/// Runs the command; returns the exit code.
#[must_use]
pub fn run(args: &CompareArgs) -> u8 {
    args.format.begin();
    match compare(&args.a, &args.b) {
        Ok(report) => {
            for line in &report.lines {
                say(&one_line(line));
            }
            say(&report.verdict());
            args.format.print(|| {
                json!({
                    "agrees": report.agrees(),
                    "compared": report.compared,
                    "different": report.different,
                    "lines": report.lines,
                })
            });
            if report.agrees() { 0 } else { EXIT_DIFFERENT }
        }
        Err(error) => {
            warn(&format!("error: {error}"));
            EXIT_INPUT
        }
    }
}

/// The result of a comparison.
#[derive(Debug, Default)]
pub struct Report {
    /// One line for each thing compared, and more for each difference.
    pub lines: Vec<String>,
    /// Things that both have.
    pub compared: usize,
    /// Things that differ.
    pub different: usize,
}

impl Report {
    /// `true` if there was something to compare and all of it agrees.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.compared > 0 && self.different == 0
    }

    fn verdict(&self) -> String {
        match (self.compared, self.different) {
            (0, _) => "nothing to compare: they have nothing in common".to_owned(),
            (all, 0) => format!("same: {all} of {all} agree to the last bit"),
            (all, n) => format!("different: {n} of {all} differ"),
        }
    }

    /// Records a thing that both have: it agrees (and `agreement` says how much there is) unless
    /// there are differences.
    fn record(&mut self, what: &str, agreement: &str, differences: &[String]) {
        self.compared += 1;
        if differences.is_empty() {
            self.lines.push(format!("{what}: {agreement}"));
        } else {
            self.different += 1;
            self.lines.push(format!("{what}: differs"));
            let indented = differences.iter().map(|line| format!("  {line}"));
            self.lines.extend(indented);
        }
    }

    fn note(&mut self, line: String) {
        self.lines.push(line);
    }
}

/// Compares two results.
///
/// # Errors
/// [`ResultsError`] if one cannot be read or they are of different kinds.
pub fn compare(a: &Path, b: &Path) -> Result<Report, ResultsError> {
    let mut report = Report::default();
    match (Results::open(a)?, Results::open(b)?) {
        (Results::Run(a), Results::Run(b)) => runs(&a, &b, &mut report)?,
        (Results::Snapshot(a), Results::Snapshot(b)) => {
            let input = "/whipple/input";
            case(&a.text(input)?, &b.text(input)?, &mut report);
            content::snapshots(&a, &b, "particles", &mut report)?;
        }
        (Results::Checkpoint(a), Results::Checkpoint(b)) => {
            case(&a.text("/input")?, &b.text("/input")?, &mut report);
            content::checkpoints(&a, &b, "particles", true, &mut report)?;
        }
        (one, other) => {
            return Err(ResultsError::Kinds {
                a: a.display().to_string(),
                a_kind: one.kind(),
                b: b.display().to_string(),
                b_kind: other.kind(),
            });
        }
    }
    Ok(report)
}

fn case(a: &str, b: &str, report: &mut Report) {
    let differences = text::cases(a, b);
    report.record(
        "case",
        "agrees, but for output, run and domain",
        &differences,
    );
}

fn runs(a: &RunFolder, b: &RunFolder, report: &mut Report) -> Result<(), ResultsError> {
    case(&read(&a.case())?, &read(&b.case())?, report);
    tables_and_states(a, b, true, report)?;
    // Cases alone are no results.
    if report.compared == 1 {
        report.compared = 0;
    }
    Ok(())
}

/// Compares the tables, snapshots and checkpoints that two runs have of the same steps; columns with extremes since the row
/// before only if `rows_are_same`.
pub(super) fn tables_and_states(
    a: &RunFolder,
    b: &RunFolder,
    rows_are_same: bool,
    report: &mut Report,
) -> Result<(), ResultsError> {
    let names = |folder: &RunFolder| tables::names(folder.path());
    for name in in_both(&names(a)?, &names(b)?, report) {
        let of_part = match [a, b].map(|run| run.note_of_part(&name)) {
            [Some(note), None] => Some(format!("A: {note}")),
            [None, Some(note)] => Some(format!("B: {note}")),
            _ => None,
        };
        if let Some(note) = of_part {
            report.record(&name, "", &[note]);
            continue;
        }
        let (a, b) = (a.path().join(&name), b.path().join(&name));
        tables::compare(&name, &read(&a)?, &read(&b)?, rows_are_same, report);
    }
    if let (Some(a), Some(b)) = (records(a)?, records(b)?) {
        tables::compare("gauges", &a, &b, rows_are_same, report);
    }
    let names = |folder: &RunFolder| -> Result<BTreeSet<String>, ResultsError> {
        let unscheduled = folder.snapshot_files()?;
        let mut all: BTreeSet<String> = unscheduled.iter().map(|path| name_of(path)).collect();
        for schedule in folder.schedules()? {
            let own = folder.snapshot_files_of(Some(&schedule))?;
            all.extend(
                own.iter()
                    .map(|path| format!("{schedule}/{}", name_of(path))),
            );
        }
        Ok(all)
    };
    for name in in_both(&names(a)?, &names(b)?, report) {
        let open = |folder: &RunFolder| Content::open(&folder.snapshots().join(&name));
        content::snapshots(&open(a)?, &open(b)?, &name, report)?;
    }
    let names = |folder: &RunFolder| -> Result<BTreeSet<String>, ResultsError> {
        let listed = checkpoint::list(&folder.checkpoints())?;
        Ok(listed.iter().map(|(_, path)| name_of(path)).collect())
    };
    for name in in_both(&names(a)?, &names(b)?, report) {
        let open = |folder: &RunFolder| {
            Content::open(&checkpoint::state_file(&folder.checkpoints().join(&name)))
        };
        let what = format!("checkpoint {name}");
        content::checkpoints(&open(a)?, &open(b)?, &what, rows_are_same, report)?;
    }
    Ok(())
}

/// The names in both sets; tells of the others.
fn in_both(a: &BTreeSet<String>, b: &BTreeSet<String>, report: &mut Report) -> Vec<String> {
    for (one, other, letter) in [(a, b, "A"), (b, a, "B")] {
        for name in one.difference(other) {
            report.note(format!("{name}: only {letter} has it"));
        }
    }
    a.intersection(b).cloned().collect()
}

/// What many gauges have read, as the table that a few would have, however it is cut into files.
fn records(folder: &RunFolder) -> Result<Option<String>, ResultsError> {
    let sheet = gauge_records::sheet(folder, None)?;
    Ok(sheet.map(|sheet| String::from_utf8_lossy(&sheet.text()).into_owned()))
}

fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn read(path: &Path) -> Result<String, ResultsError> {
    let text = String::from_utf8(read_regular(path)?);
    text.map_err(|error| ResultsError::Text {
        path: path.to_owned(),
        reason: error.to_string(),
    })
}
