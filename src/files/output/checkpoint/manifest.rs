//! The manifest of a checkpoint, which makes a folder one.

use std::path::Path;

use serde::{Deserialize, Serialize};
use uuid::Uuid;

use crate::output::{OutputError, ResultExtents, RunFolder, files};

/// Number of the format.
pub const FORMAT: u64 = 3;
/// The format that a reader takes, too: its blocks have digests of their own.
const BEFORE: u64 = 2;
/// The file that makes a folder a checkpoint.
pub const MANIFEST: &str = "manifest.json";
/// Advice on a damaged checkpoint.
pub(super) const OLDER: &str = "restart from an older checkpoint";

/// `manifest.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Manifest {
    /// [`FORMAT`].
    pub format: u64,
    /// Version of the program that wrote it.
    pub version: String,
    /// Commit of that program.
    pub commit: String,
    /// Id of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub run: Option<Uuid>,
    /// Step number.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// Number of particles.
    pub particles: u64,
    /// Number of ranks that wrote it.
    pub ranks: usize,
    /// Bytes of the state file.
    pub size: u64,
    /// Bytes of a digested block.
    pub block: u64,
    /// Bytes of the leaves whose digests are summed for a block; none if a block has its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaf: Option<u64>,
    /// The digest of each block of the state file: the sum of the SHA-256 of its leaves, or its own.
    pub sha256: Vec<String>,
    /// The results of the run up to here.
    #[serde(default)]
    pub results: ResultExtents,
}

impl Manifest {
    /// Version and commit of the program that wrote it.
    pub(super) fn by(&self) -> String {
        format!("{} ({})", self.version, self.commit)
    }
}

/// Reads a checkpoint's manifest, by one process.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Damaged`], [`OutputError::Format`], [`OutputError::OtherRun`] in
/// the folder of another run.
pub fn manifest(folder: &Path) -> Result<Manifest, OutputError> {
    let path = folder.join(MANIFEST);
    let text = files::read_small(&path)?;
    let manifest = parse_manifest(folder, &text)?;
    if let Some(run) = RunFolder::of_checkpoint(folder) {
        run.refuse_other(folder, manifest.run)?;
    }
    Ok(manifest)
}

/// The run that has written a checkpoint, if it says so.
pub(in crate::output) fn run_of(folder: &Path) -> Option<Uuid> {
    let text = files::read_small(&folder.join(MANIFEST)).ok()?;
    parse_manifest(folder, &text).ok()?.run
}

fn parse_manifest(folder: &Path, text: &[u8]) -> Result<Manifest, OutputError> {
    #[derive(Deserialize)]
    struct Head {
        format: u64,
    }
    let broken = |e: serde_json::Error| {
        let what = format!("{MANIFEST} cannot be read ({e})");
        if !e.is_data() {
            return OutputError::damaged(folder, format!("{what}; {OLDER}"));
        }
        OutputError::OtherVersion {
            path: folder.to_owned(),
            by: "of another version".to_owned(),
            what,
        }
    };
    let head: Head = serde_json::from_slice(text).map_err(broken)?;
    if ![BEFORE, FORMAT].contains(&head.format) {
        return Err(OutputError::Format {
            path: folder.to_owned(),
            found: head.format,
            known: FORMAT,
        });
    }
    let manifest = serde_json::from_slice(text).map_err(broken)?;
    check_manifest(folder, manifest)
}

/// Refuses numbers that no checkpoint has, before anything is done with them.
fn check_manifest(folder: &Path, manifest: Manifest) -> Result<Manifest, OutputError> {
    let Manifest { size, block, .. } = manifest;
    let blocks = size
        .checked_div(block)
        .map(|whole| whole + u64::from(size % block > 0));
    let what = if blocks != Some(manifest.sha256.len() as u64) {
        let n = manifest.sha256.len();
        format!("{n} digests of blocks of {block} bytes for {size} bytes")
    } else if manifest.particles > size / ID_BYTES {
        format!("{} particles in {size} bytes", manifest.particles)
    } else if manifest.ranks == 0 {
        "0 ranks".to_owned()
    } else if !manifest.time.is_finite() || manifest.time < 0.0 {
        format!("a time of {:e} s", manifest.time)
    } else {
        return Ok(manifest);
    };
    Err(OutputError::damaged(
        folder,
        format!("{MANIFEST} tells of {what}; {OLDER}"),
    ))
}

/// Bytes of a particle's id, the least that a checkpoint holds of it.
const ID_BYTES: u64 = 8;
