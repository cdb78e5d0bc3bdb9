//! `whipple new`: a case to begin with.

use std::fs;
use std::io;
use std::path::PathBuf;

use clap::ValueEnum;
use serde_json::json;

use super::output_format::{OutputFormat, wrote};
use files::input;
use files::output::{OutputError, write_atomically};
use files::run::exit::EXIT_INPUT;
use files::run::say::{say, warn};

/// Write a commented case to begin with
///
/// Makes a folder with a `case.toml`, one of the program's ready inputs, and with the JSON schema that lets
/// editors complete and check it.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple new my-shield --from shield
  whipple new my-crater --from crater && \\
      whipple check my-crater --picture model.png")]
pub struct NewArgs {
    /// Folder of the case
    #[arg(value_name = "NAME")]
    folder: PathBuf,

    /// What the case is like
    #[arg(long, value_name = "KIND")]
    from: Kind,

    #[command(flatten)]
    format: OutputFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// A sphere through a bumper, its debris on a rear wall
    Shield,
    /// The same with cloth half way between them
    Stuffed,
    /// A sphere on a panel of honeycomb between sheets of carbon fibres
    Honeycomb,
    /// A rod on a tile of ceramic and what is behind it
    Tile,
    /// A sphere on a thick target, which absorbing zones let go on for ever
    Crater,
    /// A sphere through a thin plate: how large a hole it makes
    Plate,
    /// The same at an angle: half of the model
    Oblique,
    /// An ogive of hard steel through a steel plate
    Penetration,
    /// A plate that hits another one and tears it: uniaxial strain
    Spall,
    /// A copper rod on a rigid anvil
    Taylor,
    /// Two rubber rings that meet: two dimensions
    Rings,
    /// A raindrop on a plate: erosion; a minute on two ranks
    Drop,
    /// The paper's sphere through a plate: seconds on two ranks
    Quarter,
}

impl Kind {
    fn text(self) -> &'static str {
        macro_rules! ready {
            ($name:literal) => {
                include_str!(concat!("../../inputs/", $name, "/case.toml"))
            };
        }
        match self {
            Self::Shield => ready!("whipple-shield"),
            Self::Stuffed => ready!("stuffed-shield"),
            Self::Honeycomb => ready!("honeycomb-panel"),
            Self::Tile => ready!("ceramic-tile"),
            Self::Crater => ready!("crater"),
            Self::Plate => ready!("bumper-hole"),
            Self::Oblique => ready!("oblique-30"),
            Self::Penetration => ready!("ogive-on-weldox"),
            Self::Spall => ready!("flyer-spall"),
            Self::Taylor => ready!("taylor-bar"),
            Self::Rings => ready!("rubber-rings"),
            Self::Drop => ready!("raindrop"),
            Self::Quarter => ready!("quarter-impact"),
        }
    }
}

/// Name of the schema beside a case.
const SCHEMA: &str = "whipple.schema.json";

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
enum NewError {
    #[error("{} is there already: take another name, or remove it", .0.display())]
    Exists(PathBuf),
    #[error("the path {0:?} is no UTF-8 text: take another name")]
    Name(PathBuf),
    #[error("cannot make {}: {cause}", path.display())]
    Folder { path: PathBuf, cause: io::Error },
    #[error("{0}")]
    Output(OutputError),
}

/// Runs the command; returns the exit code.
pub fn run(args: &NewArgs) -> u8 {
    args.format.begin();
    match write(args) {
        Ok(()) => {
            args.format
                .print(|| json!({ "schema": args.folder.join(SCHEMA) }));
            0
        }
        Err(error) => {
            warn(&format!("error: {error}"));
            EXIT_INPUT
        }
    }
}

fn write(args: &NewArgs) -> Result<(), NewError> {
    let folder = &args.folder;
    if folder.to_str().is_none() {
        return Err(NewError::Name(folder.clone()));
    }
    let case = folder.join("case.toml");
    for path in [&case, &folder.join(SCHEMA)] {
        if fs::symlink_metadata(path).is_ok() {
            return Err(NewError::Exists(path.clone()));
        }
    }
    fs::create_dir_all(folder).map_err(|cause| NewError::Folder {
        path: folder.clone(),
        cause,
    })?;
    let schema = format!("{:#}\n", input::schema());
    write_atomically(&folder.join(SCHEMA), schema.as_bytes()).map_err(NewError::Output)?;
    let text = format!("#:schema ./{SCHEMA}\n{}", args.from.text());
    write_atomically(&case, text.as_bytes()).map_err(NewError::Output)?;
    let name = folder.display();
    wrote(&case, "");
    say(&format!(
        "look at it: whipple check {name} --picture {name}/model.png"
    ));
    say(&format!("run it:     mpirun -n 2 whipple run {name}"));
    Ok(())
}
