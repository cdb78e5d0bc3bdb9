//! The formats, and which files they make of some snapshots.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::frame::Frame;
pub use super::frame::Wish;
use super::surface::surfaces;
use super::{ExportError, csv, lammps, npz, paraview, ply, stl, vtu, xyz};
use files::output::NewFile;
use model::readable::one_line;

/// What others read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
#[expect(
    clippy::doc_markdown,
    reason = "the comments are the command line's help"
)]
pub enum Format {
    /// LAMMPS dump, a text with all snapshots: OVITO, VMD, LAMMPS
    Lammps,
    /// Extended XYZ, a text with all snapshots: OVITO, ASE
    Xyz,
    /// VTK's unstructured grid, with a .pvd of a series: ParaView, VTK, PyVista
    Vtu,
    /// Cloud of points with the colours of bodies: MeshLab, CloudCompare, Open3D
    Ply,
    /// Surface of each body: Blender, MeshLab, CAD
    Stl,
    /// Comma-separated values, a row for each particle
    Csv,
    /// NumPy arrays, one for each field
    #[value(alias = "npy")]
    Npz,
    /// Script that opens the run in ParaView, coloured by body and mirrored
    Paraview,
}

/// The destination of files.
#[derive(Debug, Clone)]
pub struct Destination {
    /// The folder.
    pub folder: PathBuf,
    /// The only file, if it has a name of its own.
    pub file: Option<PathBuf>,
}

impl Format {
    /// The ending of its files.
    #[must_use]
    pub fn ending(self) -> &'static str {
        match self {
            Self::Lammps => "lammpstrj",
            Self::Xyz => "xyz",
            Self::Vtu => "vtu",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Csv => "csv",
            Self::Npz => "npz",
            Self::Paraview => "py",
        }
    }

    /// `true` if one file holds all snapshots.
    #[must_use]
    pub fn is_series(self) -> bool {
        matches!(self, Self::Lammps | Self::Xyz)
    }

    /// `true` if bodies have numbers without names.
    #[must_use]
    pub fn numbers_bodies(self) -> bool {
        matches!(self, Self::Lammps)
    }
}

/// Writes snapshots, at least one, and passes the path of each file that is there to `on_file`.
///
/// # Errors
/// [`ExportError`] if a snapshot cannot be read or lacks a column of `wish`, or if a file cannot be
/// written.
pub fn export(
    snapshots: &[PathBuf],
    format: Format,
    wish: &Wish,
    destination: &Destination,
    on_file: &mut dyn FnMut(&Path),
) -> Result<(), ExportError> {
    if format.is_series() {
        return write_series(snapshots, format, wish, destination, on_file);
    }
    let ending = format.ending();
    if destination.file.is_some() && snapshots.len() > 1 {
        return Err(several(&format!("{} snapshots", snapshots.len())));
    }
    let mut written = Vec::new();
    for snapshot in snapshots {
        let frame = Frame::open(snapshot, wish)?;
        let name = stem(snapshot);
        if format == Format::Stl {
            write_surfaces(&frame, wish, &name, destination, on_file)?;
            continue;
        }
        let path = target(destination, &format!("{name}.{ending}"));
        file(&path, on_file, |out| write(&frame, format, out))?;
        written.push((frame.snapshot.time, format!("{name}.{ending}")));
    }
    if format == Format::Vtu && snapshots.len() > 1 {
        let path = destination.folder.join(format!("{SERIES}.pvd"));
        file(&path, on_file, |out| {
            Ok(out.put(vtu::index(&written).as_bytes())?)
        })?;
    }
    Ok(())
}

/// Writes the script that opens a run, of which `snapshot` is one, or a snapshot alone.
///
/// # Errors
/// As [`export`].
pub fn script(
    run: Option<&Path>,
    snapshot: &Path,
    destination: &Destination,
    on_file: &mut dyn FnMut(&Path),
) -> Result<(), ExportError> {
    let path = target(destination, paraview::NAME);
    file(&path, on_file, |out| paraview::write(run, snapshot, out))
}

/// Writes a file and passes its path to `on_file`.
fn file(
    path: &Path,
    on_file: &mut dyn FnMut(&Path),
    write: impl FnOnce(&mut NewFile) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    let mut out = NewFile::create(path)?;
    write(&mut out)?;
    out.finish()?;
    on_file(path);
    Ok(())
}

/// Writes a snapshot in a format of particles.
fn write(frame: &Frame, format: Format, out: &mut NewFile) -> Result<(), ExportError> {
    match format {
        Format::Lammps => lammps::write(frame, out),
        Format::Xyz => xyz::write(frame, out),
        Format::Vtu => vtu::write(frame, out),
        Format::Ply => ply::write(frame, out),
        Format::Csv => csv::write(frame, out),
        Format::Npz => npz::write(frame, out),
        Format::Stl | Format::Paraview => {
            Err(frame.wrong(format!(".{} tells of no particles", format.ending())))
        }
    }
}

/// The name of a file of several snapshots.
const SERIES: &str = "snapshots";

/// All snapshots in one file.
fn write_series(
    snapshots: &[PathBuf],
    format: Format,
    wish: &Wish,
    destination: &Destination,
    on_file: &mut dyn FnMut(&Path),
) -> Result<(), ExportError> {
    let ending = format.ending();
    let name = match snapshots {
        [only] => stem(only),
        _ => SERIES.to_owned(),
    };
    let path = target(destination, &format!("{name}.{ending}"));
    file(&path, on_file, |out| {
        let mut apart = None;
        for snapshot in snapshots {
            let mut frame = Frame::open(snapshot, wish)?;
            // The first has all particles that the others have.
            frame.apart = match apart {
                Some(apart) => apart,
                None => *apart.insert(frame.distance_of_ids()?),
            };
            write(&frame, format, out)?;
        }
        Ok(())
    })
}

fn write_surfaces(
    frame: &Frame,
    wish: &Wish,
    name: &str,
    destination: &Destination,
    on_file: &mut dyn FnMut(&Path),
) -> Result<(), ExportError> {
    let surfaces = surfaces(frame, wish)?;
    let bodies = &frame.snapshot.bodies;
    let all = bodies.iter().zip(file_names(bodies)).zip(surfaces);
    let wanted = |body: &String| wish.bodies.is_empty() || wish.bodies.contains(body);
    let there = all.filter(|((body, _), surface)| wanted(body) && !surface.is_empty());
    let there: Vec<_> = there.collect();
    if there.is_empty() {
        return Err(frame.wrong("no particles of the bodies are there"));
    }
    if destination.file.is_some() && there.len() > 1 {
        return Err(several(&format!("the surfaces of {} bodies", there.len())));
    }
    for ((body, own), surface) in there {
        let path = target(destination, &format!("{name}-{own}.stl"));
        file(&path, on_file, |out| {
            stl::write(body, frame.snapshot.time, &surface, out)
        })?;
    }
    Ok(())
}

fn several(what: &str) -> ExportError {
    ExportError::Options(format!(
        "{what} cannot have one name: give --out a folder, with / at its end"
    ))
}

fn target(destination: &Destination, name: &str) -> PathBuf {
    destination
        .file
        .clone()
        .unwrap_or_else(|| destination.folder.join(name))
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// The names of bodies as parts of those of files; those that would share one have numbers.
fn file_names(bodies: &[String]) -> Vec<String> {
    let plain: Vec<String> = bodies.iter().map(|body| file_name(body)).collect();
    let mut sharing: BTreeMap<&str, usize> = BTreeMap::new();
    for name in &plain {
        *sharing.entry(name).or_default() += 1;
    }
    let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
    let own = plain.iter().map(|name| {
        if sharing[name.as_str()] == 1 {
            return name.clone();
        }
        let number = numbers.entry(name.as_str()).or_default();
        loop {
            *number += 1;
            let numbered = format!("{name}-{number}");
            if !sharing.contains_key(numbered.as_str()) {
                return numbered;
            }
        }
    });
    own.collect()
}

/// A body's name as a part of that of a file.
fn file_name(body: &str) -> String {
    let sound = |c: char| {
        if c.is_alphanumeric() || "-_".contains(c) {
            c
        } else {
            '_'
        }
    };
    one_line(body).chars().map(sound).collect()
}

#[cfg(test)]
mod tests {
    use super::file_names;

    #[test]
    fn no_two_bodies_share_a_file() {
        let names = ["a b", "plate", "a/b", "a_b-1", "a_b"].map(str::to_owned);
        let files = ["a_b-2", "plate", "a_b-3", "a_b-1", "a_b-4"];
        assert_eq!(file_names(&names), files);
    }
}
