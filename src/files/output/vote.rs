//! One verdict for all ranks.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};

use comm::{Comm, Exchange};

use super::{OutputError, files};

/// Gives every rank an error with the same text if any rank has one: that of the lowest such
/// rank. Collective.
///
/// # Errors
/// The given error, or [`OutputError::OtherRank`].
pub fn agree<T>(comm: &Comm, result: Result<T, OutputError>) -> Result<T, OutputError> {
    let size = comm.size();
    let mut first = [if result.is_err() { comm.rank() } else { size } as u64];
    comm.min_u64(&mut first);
    let Ok(first) = usize::try_from(first[0]) else {
        return result;
    };
    if first >= size {
        return result;
    }
    let mut exchange = Exchange::default();
    if comm.rank() == first {
        let text = result.as_ref().err().map(ToString::to_string);
        exchange.set_peers((0..size).filter(|&rank| rank != first));
        for peer in 0..exchange.peers() {
            let message = exchange.outgoing(peer);
            message.extend_from_slice(text.as_deref().unwrap_or_default().as_bytes());
        }
        exchange.post_with_sizes(comm);
        exchange.wait();
        result
    } else {
        exchange.set_peers(std::iter::once(first));
        exchange.post_with_sizes(comm);
        exchange.wait();
        let text = String::from_utf8_lossy(exchange.incoming(0)).into_owned();
        Err(OutputError::OtherRank(text))
    }
}

/// Runs `task` on rank 0 and gives its verdict to every rank. Collective.
///
/// # Errors
/// The error of `task`, with the same text on every rank.
pub fn on_root(
    comm: &Comm,
    task: impl FnOnce() -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    agree(comm, if comm.is_root() { task() } else { Ok(()) })
}

/// Fails on every rank unless all have the text of rank 0; `what` is said of one that has another. Collective.
///
/// # Errors
/// [`OutputError::OtherRank`].
pub fn same_on_all(comm: &Comm, what: &str, text: &str) -> Result<(), OutputError> {
    let digest = Sha256::digest(text).to_vec();
    let mut first = digest.clone();
    comm.broadcast(&mut first);
    let other = || OutputError::OtherRank(format!("rank {} {what} than rank 0", comm.rank()));
    agree(comm, (first == digest).then_some(()).ok_or_else(other))
}

/// Rank 0 publishes the temporary file that all ranks have `written` if it is whole, else removes it.
/// Collective.
///
/// # Errors
/// The error of writing or of publishing, with the same text on every rank.
pub(super) fn publish_or_remove(
    comm: &Comm,
    written: Result<(), OutputError>,
    temporary: &Path,
    publish: impl FnOnce() -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    on_root(comm, || {
        if written.is_ok() {
            return publish();
        }
        // The error is returned below; half a file only takes space.
        let _ = files::remove(temporary);
        Ok(())
    })?;
    written
}

/// Runs `task` on rank 0 and gives its result to every rank: collective calls must not depend on what each
/// rank sees of a file system by itself. Collective.
///
/// # Errors
/// The error of `task`, with the same text on every rank.
///
/// # Panics
/// If the result is no plain data.
pub fn from_root<T: Serialize + DeserializeOwned>(
    comm: &Comm,
    task: impl FnOnce() -> Result<T, OutputError>,
) -> Result<T, OutputError> {
    let mut result = Vec::new();
    on_root(comm, || {
        result = serde_json::to_vec(&task()?).expect("plain data");
        Ok(())
    })?;
    comm.broadcast(&mut result);
    Ok(serde_json::from_slice(&result).expect("what rank 0 has written"))
}
