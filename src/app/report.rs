//! `whipple report`: a page on a run, or on two side by side.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::json;

use super::fragments::{FragmentsArgs, evaluate as evaluate_fragments};
use super::output_format::{OutputFormat, wrote};
use super::results::{Results, ResultsError};
use super::which::Which;
use desk::report;
use desk::sweep::Definition;
use files::output::{OutputError, RunFolder, write_atomically};
use files::run::exit::EXIT_INPUT;
use files::run::say::warn;

/// Write one HTML page that tells a run, with a viewer in three dimensions; or two runs side by side, or a sweep
///
/// The page holds all that it shows: verdict on the run's figures, pictures, particles, case, energies, steps,
/// contacts, measures, fragments, load. It opens from disk and asks no network. What a run does not have is
/// named in the page.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple report runs/impact
  whipple report runs/impact --out impact.html --particles 200000 --frames 10
  whipple report runs/coarse runs/fine --out coarse-fine.html
  whipple report sweeps/shield")]
pub struct ReportArgs {
    /// Run folder, two to compare them, or the folder of a sweep
    #[arg(value_name = "RUN", required = true, num_args = 1..=2)]
    pub runs: Vec<PathBuf>,

    /// The page [default: report.html in the run, or report-against-B.html in the first of two]
    #[arg(short, long, value_name = "FILE.html")]
    pub out: Option<PathBuf>,

    /// Most particles that the viewer shows at a time; of more some are chosen by their ids
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=300_000))]
    pub particles: u32,

    /// Snapshots that the viewer shows, the first and the last among them [default: as many as keep the page
    /// below 25 MB]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: Option<u32>,

    /// Form of the output.
    #[command(flatten)]
    pub format: OutputFormat,

    /// Open the page with what the desktop opens pages with
    #[arg(long)]
    pub open: bool,
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
enum ReportError {
    #[error(transparent)]
    Results(#[from] ResultsError),
    #[error("{} is a {kind}: give the folder of a run", path.display())]
    NoRun { path: PathBuf, kind: &'static str },
    #[error("cannot write {}: a page has a name that ends in .html", .0.display())]
    Name(PathBuf),
    #[error("{0}")]
    Sweep(String),
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Runs the command; returns the exit code.
pub fn run(args: &ReportArgs) -> u8 {
    args.format.begin();
    match write(args) {
        Ok(path) => {
            args.format.print(|| json!({ "runs": args.runs }));
            if args.open {
                open(&path);
            }
            0
        }
        Err(error) => {
            warn(&format!("error: {error}"));
            EXIT_INPUT
        }
    }
}

/// Writes the page; gives its path.
fn write(args: &ReportArgs) -> Result<PathBuf, ReportError> {
    let path = target(args)?;
    let page = match &args.runs[..] {
        [a, b] => report::compare(&folder(a)?, &folder(b)?),
        [sweep] if Definition::is_in(sweep) => {
            let whole = sweep.canonicalize().unwrap_or_else(|_| sweep.clone());
            report::swept(&whole).map_err(ReportError::Sweep)?
        }
        runs => {
            let folder = folder(&runs[0])?;
            let options = report::PageOptions {
                particles: args.particles as usize,
                frames: args.frames.map(|frames| frames as usize),
                fragments: fragments(&folder),
            };
            report::render(&folder, &options)
        }
    };
    write_atomically(&path, page.as_bytes())?;
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    let size = page.len() as f64 / 1e6;
    wrote(&path, &format!(" ({size:.1} MB)"));
    Ok(path)
}

/// The path of the page.
fn target(args: &ReportArgs) -> Result<PathBuf, ReportError> {
    let Some(out) = &args.out else {
        let name = match args.runs.get(1) {
            None => "report.html".to_owned(),
            Some(other) => {
                let other = other.canonicalize().unwrap_or_else(|_| other.clone());
                let name = other.file_name().unwrap_or_default().to_string_lossy();
                format!("report-against-{name}.html")
            }
        };
        return Ok(args.runs[0].join(name));
    };
    let ending = out.extension().unwrap_or_default();
    if ending.eq_ignore_ascii_case("html") || ending.eq_ignore_ascii_case("htm") {
        Ok(out.clone())
    } else {
        Err(ReportError::Name(out.clone()))
    }
}

/// The folder of a run by its whole path, which texts of the page then leave out.
fn folder(path: &Path) -> Result<RunFolder, ReportError> {
    match Results::open(path)? {
        Results::Run(folder) => {
            let whole = folder.path().canonicalize();
            let whole = whole.map_err(OutputError::io("find", path))?;
            Ok(RunFolder::at(&whole))
        }
        other => Err(ReportError::NoRun {
            path: path.to_owned(),
            kind: other.kind(),
        }),
    }
}

/// The output of `whipple fragments` for the last snapshot of a run without a table of fragments.
fn fragments(folder: &RunFolder) -> Result<String, String> {
    if folder.fragments().exists() {
        return Ok(String::new());
    }
    let args = FragmentsArgs {
        path: folder.path().to_owned(),
        which: Which::default(),
        link: None,
        include: None,
        bridges: false,
        apart: false,
        min_particles: None,
        format: OutputFormat::default(),
        csv: None,
        hdf5: None,
        catalogue: None,
    };
    evaluate_fragments(&args).map_err(|error| error.to_string())
}

/// Opens the page. A failure is ignored: its path has been printed.
fn open(path: &Path) {
    let opener = if cfg!(target_os = "macos") {
        "open"
    } else {
        "xdg-open"
    };
    let mut opener = Command::new(opener);
    let opener = opener
        .arg(path)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    let _ = opener.spawn();
}
