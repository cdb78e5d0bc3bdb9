//! The paths and formats of pictures and tables, for all commands that draw.

use std::path::{Path, PathBuf};

use clap::builder::{PossibleValuesParser, TypedValueParser};

use super::PlotArgs;
use crate::output_format::wrote;
use plot::{self, Canvas, Chart, Format, PlotError, movie};

/// The endings of movies.
pub const MOVIES: &str =
    "a movie has a name that ends in .apng, .png or .gif, behind --movie or --out";

/// What pictures are where no name of one tells.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct PictureFormat {
    /// What pictures are where the name of none tells: "svg" has lines and text, which stay sharp in
    /// papers, "png" the pixels of the same [default: png]
    #[arg(long, value_name = "svg|png", value_parser = picture_format())]
    pub format: Option<Format>,
}

fn picture_format() -> impl TypedValueParser<Value = Format> {
    let read = |text: String| Format::of(Path::new(&format!("picture.{text}")));
    PossibleValuesParser::new(["svg", "png"]).map(move |text| read(text).unwrap_or_default())
}

impl PictureFormat {
    /// The ending of a picture's name.
    pub fn ending(self) -> &'static str {
        self.format.unwrap_or_default().ending()
    }
}

/// Refuses a name that is neither that of a picture, a movie, a table nor a folder, before anything is
/// drawn.
///
/// # Errors
/// [`PlotError::Ending`] for a name with an ending of letters, as `x.pdf`, unless it is a folder, or a
/// slash says that it is to be one; [`PlotError::Options`] if another option asks for something else.
pub fn check(args: &PlotArgs) -> Result<(), PlotError> {
    let Some(out) = args.out.as_deref() else {
        return Ok(());
    };
    if args.movie.is_wanted() && is_file(args, out) {
        return Ok(());
    }
    if let Some(format) = named(args).filter(|_| !args.movie.is_wanted()) {
        let asked = if args.csv {
            Some(Format::Csv)
        } else {
            args.picture.format
        };
        if asked.is_some_and(|asked| asked != format) {
            return Err(PlotError::Options(
                "--out names another kind of file than --format or --csv asks for",
            ));
        }
        return Ok(());
    }
    let folder = out.is_dir() || out.as_os_str().to_string_lossy().ends_with(['/', '\\']);
    let ending = out.extension().map(|e| e.to_string_lossy());
    match ending {
        Some(ending) if !folder && ending.starts_with(char::is_alphabetic) => {
            if args.movie.is_wanted() {
                return Err(PlotError::Options(MOVIES));
            }
            Err(PlotError::Ending {
                path: out.to_owned(),
                expected: ".png, .svg or .csv, or a folder with / at its end",
            })
        }
        _ => Ok(()),
    }
}

/// The format that `--out` names, if that is a file.
pub fn named(args: &PlotArgs) -> Option<Format> {
    args.out.as_deref().and_then(Format::of)
}

/// The path of a picture, or of a movie or table in its place, that is called `stem` unless `--out` calls it
/// otherwise.
pub fn target(args: &PlotArgs, stem: &str) -> PathBuf {
    let ending = if args.movie.is_wanted() {
        "apng"
    } else if args.csv {
        Format::Csv.ending()
    } else {
        args.picture.ending()
    };
    let name = format!("{stem}.{ending}");
    match &args.out {
        Some(out) if is_file(args, out) => out.clone(),
        Some(out) => out.join(name),
        None if args.source.is_dir() => args.source.join("pictures").join(name),
        None => args.source.with_file_name(name),
    }
}

/// `true` if a name is that of a file: of a movie if one is drawn, else of a picture or a table.
fn is_file(args: &PlotArgs, out: &Path) -> bool {
    if args.movie.is_wanted() {
        movie::Format::of(out).is_some()
    } else {
        Format::of(out).is_some()
    }
}

/// Refuses a name that is not that of a picture.
///
/// # Errors
/// [`PlotError::Ending`].
pub fn check_picture(path: &Path) -> Result<(), PlotError> {
    match Format::of(path) {
        Some(Format::Png | Format::Svg) => Ok(()),
        _ => Err(PlotError::Ending {
            path: path.to_owned(),
            expected: ".png or .svg",
        }),
    }
}

/// Writes a picture and says so.
pub fn write(canvas: &Canvas, path: &Path) -> Result<(), PlotError> {
    save(path, |path| canvas.save(path))
}

/// Writes a chart as what its name says, of a width in pixels, and says so.
pub fn write_chart(chart: &Chart, width: Option<u32>, path: &Path) -> Result<(), PlotError> {
    if Format::of(path) == Some(Format::Csv) {
        return save_text(path, &chart.sheet().text());
    }
    write(&chart.draw(width)?, path)
}

/// Writes a text, whose folder is made if it does not exist, and says so.
pub fn save_text(path: &Path, text: &[u8]) -> Result<(), PlotError> {
    save(path, |path| plot::save(path, text))
}

/// Writes a file and says so.
pub fn save(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), PlotError>,
) -> Result<(), PlotError> {
    write(path)?;
    wrote(path, "");
    Ok(())
}
