//! Writing a checkpoint.

use std::path::{Path, PathBuf};

use super::folder::{folder_name, prune, remove_own, replace};
use super::manifest::{FORMAT, MANIFEST, Manifest};
use super::state_file::{FIELDS, row_type, size_of, state_file};
use crate::output::h5::Writer;
use crate::output::{
    OutputError, ResultExtents, Rows, VERSION, commit, digest, files, on_root, publish_or_remove,
    write_json,
};
use comm::Comm;
use particles::{Life, ParticleStore};
use uuid::Uuid;

/// Metadata of a checkpoint.
#[derive(Debug, Clone, Copy)]
pub struct Meta<'a> {
    /// Id of the run, if it is one in a folder.
    pub run: Option<Uuid>,
    /// Step number.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// The run's own state, as JSON of the caller's making.
    pub state: &'a str,
    /// The resolved input.
    pub input: &'a str,
    /// The results of the run up to here, on rank 0.
    pub results: &'a ResultExtents,
}

/// Writes a checkpoint into `folder` and then removes all but the newest `keep` up to it.
/// Collective. Returns the checkpoint's path.
///
/// # Errors
/// The same on every rank; older checkpoints are then all still there.
pub fn write(
    comm: &Comm,
    folder: &Path,
    particles: &ParticleStore,
    meta: &Meta,
    keep: usize,
    rows: &mut Rows,
) -> Result<PathBuf, OutputError> {
    let path = folder.join(folder_name(meta.step));
    let temporary = files::partial(&path);
    on_root(comm, || {
        remove_own(&temporary)?;
        files::make_folder(&temporary)
    })?;
    let written = write_files(comm, &temporary, particles, meta, rows);
    publish_or_remove(comm, written, &temporary, || {
        replace(&temporary, &path)?;
        prune(folder, meta.step, keep)
    })?;
    Ok(path)
}

fn write_files(
    comm: &Comm,
    folder: &Path,
    particles: &ParticleStore,
    meta: &Meta,
    rows: &mut Rows,
) -> Result<(), OutputError> {
    let state = state_file(folder);
    rows.plan(comm, &particles.id[..particles.owned()])?;
    let mut file = Writer::create_aligned(comm, &state, rows.sharing().alignment)?.hashed();
    file.number("/", "format", &FORMAT)?;
    file.number("/", "step", &meta.step)?;
    file.number("/", "time", &meta.time)?;
    file.text("/state", meta.state)?;
    file.text("/input", meta.input)?;
    file.group(FIELDS)?;
    for field in particles.held(Life::State) {
        let row = row_type(field.kind);
        let path = format!("{FIELDS}/{}", field.name);
        let block = rows.block();
        let gathered = rows.collect(
            comm,
            &particles.bytes(field.id)[..row.bytes() * particles.owned()],
            row.bytes(),
        );
        file.rows_of(&path, row, block, &|rows, bytes| gathered.fill(rows, bytes))?;
        file.note(&path, "unit", field.unit)?;
        file.note(&path, "description", field.description)?;
    }
    let leaves = file.close_hashed()?;

    let size = size_of(comm, &state)?;
    let block = digest::block_of(size);
    let manifest = Manifest {
        format: FORMAT,
        version: VERSION.to_owned(),
        commit: commit().to_owned(),
        run: meta.run,
        step: meta.step,
        time: meta.time,
        particles: rows.block().total,
        ranks: comm.size(),
        size,
        block,
        leaf: Some(digest::LEAF),
        sha256: leaves.finish(comm, &state, (size, block))?,
        results: meta.results.clone(),
    };
    on_root(comm, || write_json(&folder.join(MANIFEST), &manifest))
}
