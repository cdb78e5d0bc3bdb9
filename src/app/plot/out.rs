//! Where pictures and tables go.

use std::path::{Path, PathBuf};

use super::PlotArgs;
use crate::model::readable::one_line;
use crate::plot::{Canvas, PlotError};
use crate::run::say::say;

/// Refuses a name that is neither that of a PNG picture nor of a folder, before anything is drawn.
///
/// # Errors [`PlotError::Ending`] for a name with an ending of letters, as `x.svg`, unless it is a
/// folder, or a slash says that it is to be one.
pub fn check(args: &PlotArgs) -> Result<(), PlotError> {
    let Some(out) = args.out.as_deref().filter(|out| !is_png(out)) else {
        return Ok(());
    };
    let folder = out.is_dir() || out.as_os_str().to_string_lossy().ends_with(['/', '\\']);
    let ending = out.extension().map(|e| e.to_string_lossy().into_owned());
    match ending {
        Some(ending) if !folder && ending.starts_with(char::is_alphabetic) => {
            Err(PlotError::Ending {
                path: out.to_owned(),
                ending,
            })
        }
        _ => Ok(()),
    }
}

/// The path of a picture that is called `name` unless `--out` calls it otherwise.
pub fn target(args: &PlotArgs, name: &str) -> PathBuf {
    match &args.out {
        Some(out) if is_png(out) => out.clone(),
        Some(out) => out.join(name),
        None if args.source.is_dir() => args.source.join("pictures").join(name),
        None => args.source.with_file_name(name),
    }
}

pub fn is_png(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("png"))
}

pub fn write(canvas: &Canvas, path: &Path) -> Result<(), PlotError> {
    save(path, |path| canvas.save(path))
}

/// Writes a file, whose folder is made if it lacks, and says so.
pub fn save(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), PlotError>,
) -> Result<(), PlotError> {
    if let Some(folder) = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
    {
        std::fs::create_dir_all(folder).map_err(|e| unsaved(path, &e))?;
    }
    write(path)?;
    say(&format!("wrote {}", one_line(&path.display().to_string())));
    Ok(())
}

pub fn unsaved(path: &Path, error: &std::io::Error) -> PlotError {
    PlotError::Save {
        path: path.to_owned(),
        reason: error.to_string(),
    }
}
