//! TOML → a validated [`Case`]; every diagnostic with file, line and a caret.
//!
//! The text becomes a document (`document`) over which `--set` overrides are laid, the
//! document becomes typed tables (`schema`), and these become the [`Case`]
//! (`validate`). The first thing that is wrong ends the reading with one message.

mod case_file;
mod cloud;
mod difference;
mod document;
mod explain;
mod forms;
mod formula;
mod keys;
mod names;
mod obj;
mod overrides;
mod profile;
mod quantity;
mod resolved;
mod schema;
mod source;
mod stl;
mod title;
mod triangles;
mod validate;

use std::path::{Path, PathBuf};

use model::{Case, SphOptions, units};
use source::{Diagnostic, Sources};

pub use case_file::text;
pub use difference::{Compared, Difference, differences};
pub use explain::{Explained, explain};
pub use keys::{keys, restartable_keys};
pub use schema::describe::{ABSENT, referred};

/// The JSON schema of cases.
#[must_use]
pub fn schema() -> serde_json::Value {
    schema::describe::published(described())
}

/// The same, with what holds without a key as a text of its own, [`ABSENT`].
#[must_use]
pub fn described() -> serde_json::Value {
    schema::describe::schema::<schema::CaseParams>("A case of whipple")
}

/// Why a case cannot be read. `Display` is the whole message for the user, several lines long.
#[derive(Debug, thiserror::Error)]
pub enum InputError {
    /// The path of the case is no text.
    #[error("error: the path of the case, {path:?}, is no UTF-8 text: rename the file or folder")]
    Name {
        /// The path.
        path: PathBuf,
    },
    /// The file itself cannot be read.
    #[error("error: cannot read the case {}: {cause}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the system, or that it is no regular file or too long.
        cause: std::io::Error,
    },
    /// The file is no text.
    #[error(
        "error: the case {} is no UTF-8 text: the byte {byte:#04x} in line {line}; save it as UTF-8",
        path.display()
    )]
    NoText {
        /// The file.
        path: PathBuf,
        /// Number of the first line with such a byte.
        line: usize,
        /// The byte.
        byte: u8,
    },
    /// Something in the file or in an override is wrong: title, place, caret, help.
    #[error("{0}")]
    Invalid(String),
}

/// Reads a case from a file or from the `case.toml` of a folder, with `--set` overrides
/// (`key=value`).
///
/// # Errors
/// Those of [`text`], and [`InputError::Invalid`] for the first thing in the file or in an override
/// that is wrong.
pub fn load(path: &Path, overrides: &[String]) -> Result<Case, InputError> {
    let (path, text) = text(path)?;
    parse(&path.display().to_string(), &text, overrides)
}

/// Reads a case from a text; `name` stands for the file in messages, and the files that the case
/// names are looked for in its folder.
///
/// # Errors
/// [`InputError::Invalid`] for the first thing in the text or in an override that is wrong.
pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Case, InputError> {
    with_sources(Some((name, text)), overrides, |places| {
        let (params, mut resolved) = document::read(text, overrides, places)?;
        let folder = Path::new(name).parent().unwrap_or(Path::new(""));
        let mut case = validate::case(&params, folder)?;
        if let Some((title, text)) = title::filled(&resolved) {
            names::check_title(&title, params.title.as_ref())?;
            (case.title, resolved) = (title, text);
        }
        case.resolved = resolved::with_files(resolved, folder, &case)?;
        Ok(case)
    })
}

/// Checks that overrides change nothing but `run`, `output` and `domain`, as a restart demands.
///
/// # Errors
/// [`InputError::Invalid`] for the first override that is malformed or changes anything else.
pub fn output_and_run_only(overrides: &[String]) -> Result<(), InputError> {
    with_sources(None, overrides, |places| {
        for (text, &start) in overrides.iter().zip(places) {
            overrides::Override::parse(text, start)?.restartable()?;
        }
        Ok(())
    })
}

/// Reads a time such as `0.1us` from a command line (s).
///
/// # Errors
/// A message that says what was expected.
pub fn time(text: &str) -> Result<f64, String> {
    use quantity::{Kind, Time};
    let expected = || format!("expected {}, as in {}", Time::NAME, Time::EXAMPLE);
    match units::parse(text) {
        Ok((si, powers)) if powers == Time::POWERS => Ok(si),
        Ok(_) => Err(format!("`{text}`: {}", expected())),
        Err(cause) => Err(format!("`{text}`: {cause}; {}", expected())),
    }
}

/// The options of the SPH sums of a case that says nothing of them.
#[must_use]
pub fn usual_sph() -> SphOptions {
    let read = validate::sph(&schema::SphParams::default(), std::iter::empty());
    read.map_or_else(|_| unreachable!("nothing is typed"), |(options, _)| options)
}

/// Does some reading in an address space of the text and the overrides, whose first addresses it
/// is given, and renders its diagnostic.
fn with_sources<T>(
    text: Option<(&str, &str)>,
    overrides: &[String],
    read: impl FnOnce(&[usize]) -> Result<T, Diagnostic>,
) -> Result<T, InputError> {
    let mut sources = Sources::default();
    if let Some((name, text)) = text {
        sources.add(name, text);
    }
    let places: Vec<usize> = overrides
        .iter()
        .map(|text| sources.add("--set", text))
        .collect();
    read(&places).map_err(|diagnostic| InputError::Invalid(sources.render(&diagnostic)))
}
