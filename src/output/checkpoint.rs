//! Checkpoints: the whole state of a run, bit for bit, in a folder that is whole or absent.
//!
//! `step-NNNNNNNN/` holds `state.h5` (each state field in id order, the caller's own state and
//! the resolved input as text) and `manifest.json` (sizes and digests). It is written under
//! another name and renamed at the end; an older one of the same step is called `.old` meanwhile, and
//! counts as long as there is no other. Any number of ranks may read it.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::comm::Comm;
use crate::particles::{FieldInfo, FieldKind, Life, ParticleStore, rows};

use super::h5::{Content, Element, RowType, Writer};
use super::{
    Block, COMMIT, OutputError, Rows, VERSION, agree, digest, files, from_root, on_root, write_json,
};

/// Number of the format; a reader takes its own only.
pub const FORMAT: u64 = 1;

const STATE: &str = "state.h5";
/// The file that makes a folder a checkpoint.
pub const MANIFEST: &str = "manifest.json";
/// What a checkpoint ends with while a new one of its step takes its name.
const OLD: &str = ".old";
/// What a checkpoint ends with that a restart has passed over as damaged.
pub(super) const DAMAGED: &str = ".damaged";
/// Group of the fields in the state file.
pub const FIELDS: &str = "/fields";

/// What a checkpoint says beside the particles.
#[derive(Debug, Clone, Copy)]
pub struct Meta<'a> {
    /// Step number.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// The run's own state, as JSON of the caller's making.
    pub state: &'a str,
    /// The resolved input.
    pub input: &'a str,
}

/// `manifest.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Manifest {
    /// [`FORMAT`].
    pub format: u64,
    /// Version of the program that wrote it.
    pub version: String,
    /// Commit of that program.
    pub commit: String,
    /// Step number.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// Number of particles.
    pub particles: u64,
    /// How many ranks wrote it.
    pub ranks: usize,
    /// Bytes of the state file.
    pub size: u64,
    /// Bytes of a digested block.
    pub block: u64,
    /// SHA-256 of each block of the state file.
    pub sha256: Vec<String>,
}

impl Manifest {
    /// Version and commit of the program that wrote it.
    fn by(&self) -> String {
        format!("{} ({})", self.version, self.commit)
    }
}

/// What [`read`] gives beside the particles.
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

/// Writes a checkpoint into `folder` and then removes all but the newest `keep` up to it.
/// Collective. Gives the checkpoint's path.
///
/// # Errors
/// The same on every rank; older checkpoints are then all still there.
pub fn write(
    comm: &Comm,
    folder: &Path,
    store: &ParticleStore,
    meta: &Meta,
    keep: usize,
    rows: &mut Rows,
) -> Result<PathBuf, OutputError> {
    let path = folder.join(folder_name(meta.step));
    let temporary = files::partial(&path);
    on_root(comm, || {
        files::remove(&temporary)?;
        fs::create_dir_all(&temporary).map_err(OutputError::io("create the folder", &temporary))
    })?;
    let written = write_parts(comm, &temporary, store, meta, rows);
    on_root(comm, || {
        if written.is_ok() {
            return replace(&temporary, &path).and_then(|()| prune(folder, meta.step, keep));
        }
        // What went wrong is told below; half a checkpoint only takes room.
        let _ = files::remove(&temporary);
        Ok(())
    })?;
    written.map(|()| path)
}

fn write_parts(
    comm: &Comm,
    folder: &Path,
    store: &ParticleStore,
    meta: &Meta,
    rows: &mut Rows,
) -> Result<(), OutputError> {
    let state = folder.join(STATE);
    rows.plan(comm, &store.id[..store.owned()])?;
    let file = Writer::create(comm, &state)?;
    file.number("/", "format", &FORMAT)?;
    file.number("/", "step", &meta.step)?;
    file.number("/", "time", &meta.time)?;
    file.text("/state", meta.state)?;
    file.text("/input", meta.input)?;
    file.group(FIELDS)?;
    for field in store.held(Life::State) {
        let row = row_type(field.kind);
        let path = format!("{FIELDS}/{}", field.name);
        let block = rows.block();
        let bytes = rows.collect(
            comm,
            &store.bytes(field.id)[..row.bytes() * store.owned()],
            row.bytes(),
        );
        file.rows(&path, row, block, bytes)?;
        file.note(&path, "unit", field.unit)?;
        file.note(&path, "description", field.description)?;
    }
    file.close()?;

    let size = size_of(comm, &state)?;
    let manifest = Manifest {
        format: FORMAT,
        version: VERSION.to_owned(),
        commit: COMMIT.to_owned(),
        step: meta.step,
        time: meta.time,
        particles: rows.block().total,
        ranks: comm.size(),
        size,
        block: digest::BLOCK,
        sha256: digest::of_file(comm, &state, size)?,
    };
    on_root(comm, || write_json(&folder.join(MANIFEST), &manifest))
}

/// Reads a checkpoint: each rank gets an even share of the particles in id order into `store`, in
/// the fields that the file holds and no others; the caller sizes what else its case uses
/// ([`ParticleStore::resize_owned`]) and moves the particles to their owners. Collective. Digests
/// are checked before HDF5 sees the file, so that what HDF5 meets afterwards is no damage.
///
/// # Errors
/// The same text on every rank: [`OutputError::Damaged`] if it is not what was written,
/// [`OutputError::Format`] or [`OutputError::OtherVersion`] if another version wrote it,
/// [`OutputError::Io`] or [`OutputError::Hdf5`] if it cannot be read now.
pub fn read(
    comm: &Comm,
    folder: &Path,
    store: &mut ParticleStore,
) -> Result<Restored, OutputError> {
    let manifest = from_root(comm, || manifest(folder))?;
    let state = folder.join(STATE);
    verify(comm, &state, &manifest)?;

    let file = agree(comm, Content::open_shared(comm, &state))?;
    let fields = agree(comm, check_content(&file, &manifest))?;
    let block = Block::even(manifest.particles, comm.rank(), comm.size());
    store.resize_owned_in(&fields, block.count);
    for field in fields {
        let row = row_type(field.kind);
        let path = format!("{FIELDS}/{}", field.name);
        let bytes = &mut store.bytes_mut(field.id)[..block.count * row.bytes()];
        agree(comm, file.rows(&path, row, block, bytes))?;
    }
    check_ids(comm, &state, &store.id)?;
    Ok(Restored {
        step: manifest.step,
        time: manifest.time,
        state: agree(comm, file.text("/state"))?,
        input: agree(comm, file.text("/input"))?,
        particles: manifest.particles,
        by: manifest.by(),
    })
}

/// Reads a checkpoint's manifest, by one process.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Damaged`], [`OutputError::Format`].
pub fn manifest(folder: &Path) -> Result<Manifest, OutputError> {
    let path = folder.join(MANIFEST);
    let text = files::read_small(&path)?;
    parse_manifest(folder, &text)
}

/// The resolved input of a checkpoint, by one process and without reading all of it.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Hdf5`].
pub fn input(folder: &Path) -> Result<String, OutputError> {
    Content::open(&state_file(folder))?.text("/input")
}

/// The state file of a checkpoint.
#[must_use]
pub fn state_file(folder: &Path) -> PathBuf {
    folder.join(STATE)
}

/// Folders named like checkpoints that are none, since they lack a manifest, newest first.
///
/// # Errors
/// [`OutputError::Io`].
pub fn list_broken(folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let mut found = Vec::new();
    for path in files::names_in(folder)? {
        if step_of(&path, "").is_some() && !is_whole(&path)? {
            found.push(path);
        }
    }
    found.sort();
    found.reverse();
    Ok(found)
}

/// Checkpoints that restarts have passed over as damaged, in the order of names.
///
/// # Errors
/// [`OutputError::Io`].
pub fn list_damaged(folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let mut found = files::names_in(folder)?;
    found.retain(|path| is_damaged(path));
    found.sort();
    Ok(found)
}

/// Whether a name is that of a checkpoint passed over: its step, `.damaged` and maybe a number.
pub(super) fn is_damaged(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let step = name.rsplit_once(DAMAGED).map(|(step, _)| Path::new(step));
    step.is_some_and(|step| {
        ["", OLD]
            .iter()
            .any(|ending| step_of(step, ending).is_some())
    })
}

/// The whole checkpoints in a folder with their steps, oldest first.
///
/// # Errors
/// [`OutputError::Io`].
pub fn list(folder: &Path) -> Result<Vec<(u64, PathBuf)>, OutputError> {
    let names = files::names_in(folder)?;
    let mut found = BTreeMap::new();
    for ending in ["", OLD] {
        for path in &names {
            if let Some(step) = step_of(path, ending)
                && is_whole(path)?
            {
                found.entry(step).or_insert_with(|| path.clone());
            }
        }
    }
    Ok(found.into_iter().collect())
}

/// Whether a folder has a manifest, which is written last.
fn is_whole(path: &Path) -> Result<bool, OutputError> {
    let manifest = path.join(MANIFEST);
    let there = manifest.try_exists();
    there.map_err(OutputError::io("read", &manifest))
}

fn folder_name(step: u64) -> String {
    format!("step-{step:08}")
}

/// The step of a file or folder named `step-NNNNNNNN` and an ending.
pub(super) fn step_of(path: &Path, ending: &str) -> Option<u64> {
    let name = path.file_name()?.to_str()?;
    let digits = name.strip_prefix("step-")?.strip_suffix(ending)?;
    digits.parse().ok()
}

pub(super) fn row_type(kind: FieldKind) -> RowType {
    let element = match kind {
        FieldKind::Id => Element::U64,
        FieldKind::Index => Element::U32,
        _ => Element::F64,
    };
    RowType {
        element,
        components: kind.components(),
    }
}

/// The size of a state file as rank 0 sees it. Collective.
fn size_of(comm: &Comm, path: &Path) -> Result<u64, OutputError> {
    from_root(comm, || match fs::metadata(path) {
        Ok(meta) => Ok(meta.len()),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(OutputError::damaged(
            path,
            format!("it is missing; {OLDER}"),
        )),
        Err(error) => Err(OutputError::io("read", path)(error)),
    })
}

/// Gives a finished checkpoint its name; an older one of the same step goes once it has.
fn replace(temporary: &Path, path: &Path) -> Result<(), OutputError> {
    files::sync_folder(temporary)?;
    let mut old = path.as_os_str().to_owned();
    old.push(OLD);
    let old = PathBuf::from(old);
    if is_whole(path)? {
        discard(&old)?;
        fs::rename(path, &old).map_err(OutputError::io("rename", path))?;
    } else {
        files::remove(path)?;
    }
    files::publish(temporary, path)?;
    discard(&old)
}

/// Removes a checkpoint, if it exists; cut short it leaves nothing that looks like one.
pub(super) fn discard(path: &Path) -> Result<(), OutputError> {
    let temporary = files::partial(path);
    files::remove(&temporary)?;
    match fs::rename(path, &temporary) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        Err(error) => Err(OutputError::io("rename", path)(error)),
        Ok(()) => files::remove(&temporary),
    }
}

/// Removes all but the newest `keep` checkpoints up to `step`, and what a crash left half done.
fn prune(folder: &Path, step: u64, keep: usize) -> Result<(), OutputError> {
    let mut old = list(folder)?;
    old.retain(|&(other, _)| other < step);
    let spare = (old.len() + 1).saturating_sub(keep.max(1));
    for (_, path) in &old[..spare.min(old.len())] {
        discard(path)?;
    }
    for path in files::names_in(folder)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with("step-") && name.ends_with(files::PARTIAL) {
            files::remove(&path)?;
        }
        // Its successor has its name.
        if step_of(&path, OLD).is_some() && is_whole(&path.with_extension(""))? {
            discard(&path)?;
        }
    }
    Ok(())
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
    if head.format != FORMAT {
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

const OLDER: &str = "restart from an older checkpoint";

/// Compares size and digests with the manifest. Collective.
fn verify(comm: &Comm, state: &Path, manifest: &Manifest) -> Result<(), OutputError> {
    let size = size_of(comm, state)?;
    if size != manifest.size {
        let what = format!("it has {size} bytes instead of {}; {OLDER}", manifest.size);
        return Err(OutputError::damaged(state, what));
    }
    if manifest.block != digest::BLOCK {
        let what = format!("{MANIFEST} has blocks of {} bytes; {OLDER}", manifest.block);
        return Err(OutputError::damaged(state, what));
    }
    let digests = digest::of_file(comm, state, size)?;
    if digests == manifest.sha256 {
        return Ok(());
    }
    let pairs = digests.iter().zip(&manifest.sha256);
    let block = pairs.take_while(|(found, known)| found == known).count() as u64;
    let (first, last) = (
        block * digest::BLOCK,
        ((block + 1) * digest::BLOCK).min(size),
    );
    let what = format!("bytes {first} to {last} do not match their digest; {OLDER}");
    Err(OutputError::damaged(state, what))
}

/// The fields in the file, if it holds this program's state, no less (but for what the case had no
/// use for, which is zero) and no more.
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

/// Refuses rows that do not stand in the order of their ids, each rank having its block. Collective.
fn check_ids(comm: &Comm, state: &Path, ids: &[u64]) -> Result<(), OutputError> {
    // The last id before each rank's block, if any stands there.
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
