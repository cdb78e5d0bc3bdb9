//! `whipple export`: results as files that other programs open.

use std::path::{Path, PathBuf};

use serde_json::json;

use super::output_format::{OutputFormat, wrote};
use super::which::Several;
use desk::export::{self, Destination, ExportError, Format, Wish};
use files::FileOpener;
use files::run::exit::EXIT_INPUT;
use files::run::say::{say, warn};
use model::readable::one_line;
use plot::{Wanted, bodies, parse_quantity};

/// Write snapshots in the formats of other programs
///
/// A run's last snapshot is written unless others are asked for. Numbers are those of the snapshot
/// to the last bit, in SI units; vectors and tensors are told by components, as velocity_x and
/// deviatoric_stress_xx.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple export runs/impact --to vtu --all                  for ParaView, with an index
  whipple export runs/impact --to xyz --time 0us,0.1us --fields pressure,velocity
  whipple export runs/impact --to lammps --all --mirror --out impact.lammpstrj
  whipple export runs/impact --to npz --fields stress,von_mises,displacement
  whipple export runs/impact --to stl --bodies plate --mirror
  whipple export state.vtkhdf --to csv --out tables/
  whipple export runs/impact --to paraview                   a script that opens the run there")]
#[expect(
    clippy::doc_markdown,
    reason = "the comments are the command line's help"
)]
pub struct ExportArgs {
    /// Snapshot file (.vtkhdf) or run folder
    #[arg(value_name = "FILE_OR_RUN")]
    pub source: PathBuf,

    /// Format
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub to: Format,

    /// File to write if its name has the format's ending, else the folder to write into [default:
    /// beside the snapshot, or RUN/export]
    #[arg(short, long, value_name = "FILE_OR_FOLDER")]
    pub out: Option<PathBuf>,

    /// The snapshots of a run.
    #[command(flatten)]
    pub which: Several,

    /// Fields, by the names that `whipple plot` knows, as in velocity, stress.xx, von_mises; whole
    /// vectors and tensors by their own; radius, and displacement since the start [default: all
    /// that the snapshot holds]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub fields: Vec<String>,

    /// Bodies [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub bodies: Vec<String>,

    /// Add the images behind planes of symmetry
    #[arg(long)]
    pub mirror: bool,

    /// Edge of the cells that surfaces are found in, as in 0.02mm [default: half the finest particle
    /// spacing]
    #[arg(long, value_name = "LENGTH")]
    pub cell: Option<String>,

    /// Form of the output.
    #[command(flatten)]
    pub format: OutputFormat,
}

/// Runs the command; returns the exit code.
#[must_use]
pub fn run(args: &ExportArgs) -> u8 {
    args.format.begin();
    match write(args) {
        Ok(bodies) => {
            args.format.print(|| json!({ "types": bodies }));
            0
        }
        Err(error) => {
            warn(&format!("error: {error}"));
            EXIT_INPUT
        }
    }
}

/// Writes the files and says which; gives the names of bodies that are numbers there, from 1 on.
///
/// # Errors
/// [`ExportError`] if there is no such snapshot, if it has not what is asked for, or if a file
/// cannot be written.
pub fn write(args: &ExportArgs) -> Result<Vec<String>, ExportError> {
    check(args)?;
    let wish = Wish {
        fields: args.fields.clone(),
        bodies: args.bodies.clone(),
        mirror: args.mirror,
        cell: args.cell.as_deref().map(cell).transpose()?,
    };
    let snapshots = args.which.at(&args.source, Wanted::Last)?;
    let destination = destination(args)?;
    let mut on_written = |path: &Path| wrote(path, "");
    if args.to == Format::Paraview {
        let run = args.source.is_dir().then_some(args.source.as_path());
        export::script(run, &snapshots[0], &destination, &mut on_written)?;
        return Ok(Vec::new());
    }
    export::export(&snapshots, args.to, &wish, &destination, &mut on_written)?;
    let numbered = args.to.numbers_bodies();
    let names = numbered
        .then(|| bodies(&FileOpener, &snapshots[0]))
        .transpose()?;
    let names = names.unwrap_or_default();
    for (number, name) in (1..).zip(&names) {
        say(&format!("type {number} is {}", one_line(name)));
    }
    Ok(names)
}

/// Refuses options that the format has no use for.
fn check(args: &ExportArgs) -> Result<(), ExportError> {
    let chosen = args.which.any();
    let filtered = !args.fields.is_empty() || !args.bodies.is_empty() || args.mirror;
    let what = match args.to {
        Format::Stl if !args.fields.is_empty() => "surfaces have no --fields",
        Format::Paraview if chosen || filtered => {
            "the script for ParaView opens all snapshots with all that they hold: no other options"
        }
        format if format != Format::Stl && args.cell.is_some() => "--cell belongs to --to stl",
        _ => return Ok(()),
    };
    Err(ExportError::Options(what.to_owned()))
}

fn cell(text: &str) -> Result<f64, ExportError> {
    let length = parse_quantity(text, "m")?;
    if length > 0.0 && length.is_finite() {
        return Ok(length);
    }
    Err(ExportError::Options("--cell must be positive".to_owned()))
}

/// The destination of the files: a name with the format's ending is that of the only one.
fn destination(args: &ExportArgs) -> Result<Destination, ExportError> {
    let ending = args.to.ending();
    let Some(out) = &args.out else {
        let folder = match (args.to, args.source.is_dir()) {
            (Format::Paraview, true) => args.source.clone(),
            (_, true) => args.source.join("export"),
            (_, false) => args.source.parent().unwrap_or(Path::new("")).to_owned(),
        };
        return Ok(Destination { folder, file: None });
    };
    let is_folder = out.is_dir() || out.as_os_str().to_string_lossy().ends_with('/');
    let given = out.extension().map(|e| e.to_string_lossy().into_owned());
    match given {
        Some(given) if !is_folder && given.eq_ignore_ascii_case(ending) => Ok(Destination {
            folder: out.parent().unwrap_or(Path::new("")).to_owned(),
            file: Some(out.clone()),
        }),
        Some(given) if !is_folder && given.starts_with(char::is_alphabetic) => {
            let path = out.display();
            Err(ExportError::Options(format!(
                "cannot write {path}: give a name that ends in .{ending}, or a folder with / at its end"
            )))
        }
        _ => Ok(Destination {
            folder: out.clone(),
            file: None,
        }),
    }
}
