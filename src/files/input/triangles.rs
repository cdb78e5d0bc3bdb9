//! Surfaces of triangles from files.

use std::io;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::{obj, stl};
use model::SurfaceFile;
use results::regular;

/// Longest file that is read as a surface (bytes): 20 million triangles of a binary STL file.
const LONGEST: u64 = 1_000_000_000;

/// Format of a file of triangles; named as the keys are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Stereolithography.
    Stl,
    /// Wavefront.
    Obj,
}

impl Format {
    /// The keys of tables that name such files.
    pub const KEYS: [&str; 2] = ["stl", "obj"];
}

/// Reads the triangles of a file, in its own units.
///
/// # Errors
/// The fault, as the end of "cannot take the surface `file`: …"; of
/// [`io::ErrorKind::NotFound`] if there is no such file.
pub fn read(path: &Path, format: Format) -> io::Result<(Vec<[[f64; 3]; 3]>, SurfaceFile)> {
    let bytes = regular::content(path, LONGEST, "a surface")?;
    let digest = Sha256::digest(&bytes);
    let file = SurfaceFile {
        path: absolute(path),
        sha256: format!("{digest:x}"),
    };
    let soup = match format {
        Format::Stl => stl::triangles(bytes),
        Format::Obj => obj::triangles(&bytes),
    };
    Ok((soup.map_err(io::Error::other)?, file))
}

/// A path as it is from everywhere.
pub fn absolute(path: &Path) -> String {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    path.to_string_lossy().into_owned()
}
