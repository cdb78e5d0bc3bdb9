//! Particles from files that other programs, or this one, have written.
//!
//! Each format has a file of its own that makes a [`Table`] or a [`mesh::Mesh`] of bytes which
//! anybody may have written: what is wrong is told with its place, and nothing is believed before it
//! is checked.

mod abaqus;
mod arrays;
mod budget;
mod columns;
mod csv;
mod deck;
mod dyna;
mod frames;
mod gmsh;
mod h5;
mod mesh;
mod names;
mod part;
mod snapshot;
mod table;
mod text;
mod units;
mod vtu;

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use ::sha2::{Digest, Sha256};

use super::schema::{FormatName, TakeName};
use deck::Deck;
use model::SurfaceFile;
use results::regular;

pub use part::Wanted;
pub use table::{Columns, Table};
pub use units::UnitSystem;

/// Longest file of text that is read (bytes).
const LONGEST: u64 = 4_000_000_000;
/// Most particles, nodes or elements of a file.
const MOST: usize = 1_000_000_000;

/// Endings of the formats.
const ENDINGS: &[(&str, FormatName)] = &[
    ("csv", FormatName::Csv),
    ("vtkhdf", FormatName::Snapshot),
    ("h5", FormatName::Hdf5),
    ("hdf5", FormatName::Hdf5),
    ("vtu", FormatName::Vtu),
    ("vtp", FormatName::Vtu),
    ("k", FormatName::Dyna),
    ("key", FormatName::Dyna),
    ("dyn", FormatName::Dyna),
    ("inp", FormatName::Abaqus),
    ("msh", FormatName::Gmsh),
    ("lammpstrj", FormatName::Lammps),
    ("dump", FormatName::Lammps),
    ("xyz", FormatName::Xyz),
    ("extxyz", FormatName::Xyz),
];

/// Request for the content of a file.
#[derive(Debug)]
pub struct Request {
    /// Dimensions of the case.
    pub dimension: usize,
    /// Units of the numbers of the file.
    pub units: UnitSystem,
    /// Names of the file's columns or arrays.
    pub columns: Columns,
    /// Parts that the body is of; all of a file that has one.
    pub parts: Vec<Wanted>,
    /// Parts of a mesh that become particles.
    pub take: TakeName,
}

/// A fault, and the key of the input that it is about.
#[derive(Debug)]
pub struct Fault {
    /// `file`, or the key that would have to say something else.
    pub key: &'static str,
    /// The fault in words.
    pub words: String,
    /// True if there is no such file.
    pub is_missing: bool,
}

impl Fault {
    /// About a key.
    pub fn of(key: &'static str, words: impl Into<String>) -> Self {
        Self {
            key,
            words: words.into(),
            is_missing: false,
        }
    }
}

impl From<String> for Fault {
    fn from(words: String) -> Self {
        Self::of("file", words)
    }
}

impl From<&str> for Fault {
    fn from(words: &str) -> Self {
        Self::of("file", words)
    }
}

impl From<io::Error> for Fault {
    fn from(cause: io::Error) -> Self {
        Self {
            is_missing: cause.kind() == io::ErrorKind::NotFound,
            ..Self::of("file", cause.to_string())
        }
    }
}

/// The format of a file, by its ending.
pub fn format_of(path: &Path) -> Option<FormatName> {
    let ending = path.extension()?.to_str()?.to_lowercase();
    let known = ENDINGS.iter().find(|(known, _)| *known == ending);
    known.map(|(_, format)| *format)
}

/// The file of a path, which of a run folder, or of its snapshots, is the last snapshot.
pub fn resolve(path: &Path) -> PathBuf {
    if !path.is_dir() {
        return path.to_owned();
    }
    let inner = path.join("snapshots");
    let folder = if inner.is_dir() { &inner } else { path };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let snapshots = entries.map(|entry| entry.path()).filter(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        // A name with a dot in front is a file that is still being written.
        !name.starts_with('.') && path.extension().is_some_and(|e| e == "vtkhdf")
    });
    snapshots.max().unwrap_or_else(|| path.to_owned())
}

/// Reads particles of a file.
///
/// # Errors
/// A fault of the file, or of what is asked of it.
pub fn read(
    path: &Path,
    format: FormatName,
    request: &Request,
) -> Result<(Table, SurfaceFile), Fault> {
    let mut sha256 = digest(path)?;
    let text = || regular::content(path, LONGEST, "a file of particles").map_err(Fault::from);
    let mut deck = |read: fn(&str, &mut Deck) -> Result<mesh::Mesh, Fault>| {
        let content = text()?;
        let mut deck = Deck::of(path, &content);
        let mesh = read(&text::of(&content), &mut deck)?;
        sha256 = deck.sha256();
        mesh.table(request)
    };
    let table = match format {
        FormatName::Snapshot => snapshot::read(path, request)?,
        FormatName::Hdf5 => h5::read(path, request)?,
        FormatName::Csv => csv::read(&text()?, request)?,
        FormatName::Vtu => vtu::read(&text()?, request)?,
        FormatName::Dyna => deck(dyna::read)?,
        FormatName::Abaqus => deck(abaqus::read)?,
        FormatName::Gmsh => gmsh::read(&text()?)?.table(request)?,
        FormatName::Lammps => frames::lammps(&text::of(&text()?), request)?,
        FormatName::Xyz => frames::xyz(&text::of(&text()?), request)?,
    };
    table.check(request.dimension)?;
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let path = path.to_string_lossy().into_owned();
    Ok((table, SurfaceFile { path, sha256 }))
}

/// The SHA-256 of a regular file of any length, in hexadecimal digits.
fn digest(path: &Path) -> io::Result<String> {
    let (mut file, _) = regular::open_regular(path)?;
    let mut digest = Sha256::new();
    let mut piece = vec![0; 1 << 20];
    loop {
        match file.read(&mut piece)? {
            0 => return Ok(format!("{:x}", digest.finalize())),
            read => digest.update(&piece[..read]),
        }
    }
}
