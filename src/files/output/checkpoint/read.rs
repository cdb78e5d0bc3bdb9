//! Reading a checkpoint, by any number of ranks.

use std::path::Path;

use super::manifest::{MANIFEST, Manifest, OLDER, manifest};
use super::state_file::{FIELDS, row_type, size_of, state_file};
use crate::output::digest::{Kind, LEAF};
use crate::output::h5::Content;
use crate::output::{Block, OutputError, agree, digest, from_root};
use comm::Comm;
use particles::{FieldInfo, Life, ParticleStore, rows};

/// The result of [`read`] beside the particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Restored {
    /// Step number.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// The run's own state as it was given.
    pub state: String,
    /// The resolved input.
    pub input: String,
    /// Particles of all ranks.
    pub particles: u64,
    /// Version and commit of the program that wrote it.
    pub by: String,
}

/// Reads a checkpoint: each rank gets an even share of the particles in id order into `particles`,
/// in the fields that the file holds and no others; the caller sizes the other fields of its case
/// ([`ParticleStore::resize_owned`]) and moves the particles to their owners. Collective. Digests
/// are checked before HDF5 sees the file, so that a later error of HDF5 is no damage.
///
/// # Errors
/// The same text on every rank: [`OutputError::Damaged`] if it is not what was written,
/// [`OutputError::Format`] or [`OutputError::OtherVersion`] if another version wrote it,
/// [`OutputError::Io`] or [`OutputError::Hdf5`] if it cannot be read now.
pub fn read(
    comm: &Comm,
    folder: &Path,
    particles: &mut ParticleStore,
) -> Result<Restored, OutputError> {
    let manifest = from_root(comm, || manifest(folder))?;
    let state = state_file(folder);
    verify(comm, &state, &manifest)?;

    let file = Content::open_shared(comm, &state)?;
    let fields = agree(comm, check_content(&file, &manifest))?;
    let block = Block::even(manifest.particles, comm.rank(), comm.size());
    particles.resize_owned_in(&fields, block.count);
    for field in fields {
        let row = row_type(field.kind);
        let path = format!("{FIELDS}/{}", field.name);
        let bytes = &mut particles.bytes_mut(field.id)[..block.count * row.bytes()];
        agree(comm, file.rows(&path, row, block, bytes))?;
    }
    check_ids(comm, &state, &particles.id)?;
    Ok(Restored {
        step: manifest.step,
        time: manifest.time,
        state: agree(comm, file.text("/state"))?,
        input: agree(comm, file.text("/input"))?,
        particles: manifest.particles,
        by: manifest.by(),
    })
}

/// Compares size and digests with the manifest. Collective.
fn verify(comm: &Comm, state: &Path, manifest: &Manifest) -> Result<(), OutputError> {
    let size = size_of(comm, state)?;
    if size != manifest.size {
        let what = format!("it has {size} bytes instead of {}; {OLDER}", manifest.size);
        return Err(OutputError::damaged(state, what));
    }
    if !digest::is_block(manifest.block) {
        let what = format!("{MANIFEST} has blocks of {} bytes; {OLDER}", manifest.block);
        return Err(OutputError::damaged(state, what));
    }
    let kind = match manifest.leaf {
        None => Kind::Whole,
        Some(LEAF) => Kind::Leaves,
        Some(bytes) => {
            let what = format!("{MANIFEST} has leaves of {bytes} bytes; {OLDER}");
            return Err(OutputError::damaged(state, what));
        }
    };
    let digests = digest::of_file(comm, state, (size, manifest.block), kind)?;
    if digests == manifest.sha256 {
        return Ok(());
    }
    let pairs = digests.iter().zip(&manifest.sha256);
    let block = pairs.take_while(|(found, known)| found == known).count() as u64;
    let (first, last) = (
        block * manifest.block,
        ((block + 1) * manifest.block).min(size),
    );
    let what = format!("bytes {first} to {last} do not match their digest; {OLDER}");
    Err(OutputError::damaged(state, what))
}

/// The fields in the file, if it holds this program's state, no less (but for optional fields, which are
/// zero) and no more.
fn check_content(
    file: &Content,
    manifest: &Manifest,
) -> Result<Vec<&'static FieldInfo>, OutputError> {
    let other = |what: String| {
        Err(OutputError::OtherVersion {
            path: file.path().to_owned(),
            by: manifest.by(),
            what,
        })
    };
    let step: u64 = file.number("/", "step")?;
    let time: f64 = file.number("/", "time")?;
    if step != manifest.step || time.to_bits() != manifest.time.to_bits() {
        let known = manifest.step;
        let what = format!("it is of step {step}, {MANIFEST} of step {known}; {OLDER}");
        return Err(OutputError::damaged(file.path(), what));
    }
    let arrays = file.arrays(FIELDS)?;
    let mut fields = Vec::new();
    for field in rows(Life::State) {
        let Some(array) = arrays.iter().find(|array| array.name == field.name) else {
            if field.is_optional() {
                continue;
            }
            return other(format!("it lacks the field {}", field.name));
        };
        if array.row != row_type(field.kind) || array.rows != manifest.particles {
            return other(format!("the field {} has another shape", field.name));
        }
        fields.push(field);
    }
    let known = |name: &str| rows(Life::State).any(|f: &FieldInfo| f.name == name);
    match arrays.iter().find(|array| !known(&array.name)) {
        Some(array) => other(format!("it has an unknown field {}", array.name)),
        None => Ok(fields),
    }
}

/// Refuses rows that are not in the order of their ids, each rank having its block. Collective.
fn check_ids(comm: &Comm, state: &Path, ids: &[u64]) -> Result<(), OutputError> {
    // The last id before each rank's block, if there is one.
    let mut lasts = Vec::new();
    let last = ids.last().copied();
    comm.all_gather_u64(
        &[u64::from(last.is_some()), last.unwrap_or_default()],
        &mut lasts,
    );
    let (before, _) = lasts[..2 * comm.rank()].as_chunks::<2>();
    let before = before.iter().rev().find(|[some, _]| *some == 1);
    let begins = before.is_none_or(|[_, last]| ids.first().is_none_or(|first| last < first));
    let sound = begins && ids.is_sorted_by(|a, b| a < b);
    let what = "its particles do not stand in the order of their ids";
    let wrong = || OutputError::damaged(state, format!("{what}; {OLDER}"));
    agree(comm, sound.then_some(()).ok_or_else(wrong))
}
