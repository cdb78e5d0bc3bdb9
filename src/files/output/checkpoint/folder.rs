//! The folder of a run's checkpoints: names, whole and damaged ones, and removal of old ones.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::manifest::MANIFEST;
use super::state_file::STATE;
use crate::output::{OutputError, files};

/// Ending of a checkpoint while a new one of its step takes its name.
const OLD: &str = ".old";
/// Ending of a checkpoint that a restart has passed over as damaged.
pub(in crate::output) const DAMAGED: &str = ".damaged";

/// Folders named like checkpoints but without a manifest, newest first.
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

/// Returns true if a name is that of a checkpoint passed over: its step, `.damaged` and maybe a number.
fn is_damaged(path: &Path) -> bool {
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

/// Returns true if a folder has a manifest, which is written last.
fn is_whole(path: &Path) -> Result<bool, OutputError> {
    let manifest = path.join(MANIFEST);
    let there = manifest.try_exists();
    there.map_err(OutputError::io("read", &manifest))
}

/// The name of the checkpoint of a step.
pub(in crate::output) fn folder_name(step: u64) -> String {
    format!("step-{step:08}")
}

/// The step of a file or folder named `step-NNNNNNNN` and an ending.
pub(in crate::output) fn step_of(path: &Path, ending: &str) -> Option<u64> {
    let name = path.file_name()?.to_str()?;
    let digits = name.strip_prefix("step-")?.strip_suffix(ending)?;
    digits.parse().ok()
}

/// Removes the files of a checkpoint, and its folder unless there is more in it. Links are left alone.
pub(super) fn remove_own(path: &Path) -> Result<(), OutputError> {
    if !is_folder(path) {
        return Ok(());
    }
    // The manifest first, without which it is no checkpoint.
    for name in [MANIFEST, STATE] {
        for file in [path.join(name), files::partial(&path.join(name))] {
            match fs::remove_file(&file) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    return Err(OutputError::io("remove", &file)(error));
                }
                _ => {}
            }
        }
    }
    let _ = fs::remove_dir(path);
    Ok(())
}

/// Returns true if a path is that of a folder, and of no link.
fn is_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|meta| meta.is_dir())
}

/// Gives a finished checkpoint its name, then removes an older one of the same step.
pub(super) fn replace(temporary: &Path, path: &Path) -> Result<(), OutputError> {
    files::sync_folder(temporary)?;
    let mut old = path.as_os_str().to_owned();
    old.push(OLD);
    let old = PathBuf::from(old);
    if is_whole(path)? {
        discard(&old)?;
        fs::rename(path, &old).map_err(OutputError::io("rename", path))?;
    } else {
        remove_own(path)?;
    }
    files::publish(temporary, path)?;
    discard(&old)
}

/// Removes a checkpoint, if it exists; if interrupted, it leaves nothing that looks like one. A folder with
/// more than a checkpoint in it stays without that.
pub(in crate::output) fn discard(path: &Path) -> Result<(), OutputError> {
    let temporary = files::partial(path);
    remove_own(&temporary)?;
    if !is_folder(path) || is_folder(&temporary) {
        return remove_own(path);
    }
    fs::rename(path, &temporary).map_err(OutputError::io("rename", path))?;
    remove_own(&temporary)?;
    if is_folder(&temporary) {
        return fs::rename(&temporary, path).map_err(OutputError::io("rename", path));
    }
    Ok(())
}

/// Removes all but the newest `keep` checkpoints.
///
/// # Errors
/// [`OutputError::Io`].
pub fn keep_newest(folder: &Path, keep: usize) -> Result<(), OutputError> {
    // As if one were about to come.
    prune(folder, u64::MAX, keep.saturating_add(1))
}

/// Removes all but the newest `keep` checkpoints up to `step`, and unfinished ones left by a crash.
pub(super) fn prune(folder: &Path, step: u64, keep: usize) -> Result<(), OutputError> {
    let mut old = list(folder)?;
    old.retain(|&(other, _)| other < step);
    let spare = (old.len() + 1).saturating_sub(keep.max(1));
    for (_, path) in &old[..spare.min(old.len())] {
        discard(path)?;
    }
    for path in files::names_in(folder)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with("step-") && name.ends_with(files::PARTIAL) {
            remove_own(&path)?;
        }
        // Its successor has its name.
        if step_of(&path, OLD).is_some() && is_whole(&path.with_extension(""))? {
            discard(&path)?;
        }
    }
    Ok(())
}
