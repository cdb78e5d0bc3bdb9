//! Files that ranks open and close together, and those that they have to leave open.

use std::io::ErrorKind;
use std::os::unix::fs::MetadataExt as _;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use hdf5::File;
use results::regular::open_regular;

use crate::output::{OutputError, agree};
use crate::run::exit::EXIT_FAILED;
use crate::run::say;
use comm::{Comm, abort_job};

/// Opens an existing file by `open` on all ranks together; gives the file for HDF5, and the file itself, whatever becomes
/// of its name.
///
/// Open MPI tells that a file cannot be opened to the one rank that cannot, and neither that rank nor any other leaves the
/// call. So each rank opens the file by itself before, and ranks vote. MPI opens it by its path all the same, not by
/// that descriptor: it makes files beside it, and drivers of file systems look at its folder for its stripes. If the path is gone meanwhile, the job
/// ends. Collective.
///
/// # Errors
/// [`OutputError::Io`] or that of `open`, the same on every rank.
pub fn open_together(
    comm: &Comm,
    path: &Path,
    to_write: bool,
    open: impl FnOnce() -> Result<File, OutputError>,
) -> Result<(File, std::fs::File), OutputError> {
    let alone = || {
        if to_write {
            std::fs::File::options().read(true).write(true).open(path)
        } else {
            open_regular(path).map(|(file, _)| file)
        }
    };
    let with_room = || {
        let held = alone()?;
        let room: Vec<_> = (0..ROOM).map(|_| alone()).collect::<Result<_, _>>()?;
        Ok((held, room))
    };
    let (held, room) = agree(comm, with_room().map_err(OutputError::io("open", path)))?;
    drop(room);
    let (file, opened) = match during_call(comm, path, &held, open) {
        Ok(file) => (Some(file), Ok(())),
        Err(error) => (None, Err(error)),
    };
    match (file, agree(comm, opened)) {
        (Some(file), Ok(())) => Ok((file, held)),
        (file, opened) => {
            if comm.any(file.is_some()) {
                abandon(comm, file);
            }
            Err(opened.err().unwrap_or_else(|| {
                OutputError::OtherRank(format!("{} is not open", path.display()))
            }))
        }
    }
}

/// Descriptors that MPI takes of a rank: of the file, and in Open MPI of two beside it for pointers that ranks share.
const ROOM: usize = 4;

/// Time between two looks at the path of a file that ranks open.
const LOOK: Duration = Duration::from_secs(1);

/// Runs a collective call that opens or closes a file, which this rank holds, and ends the job with a message if the path
/// of the file is gone before the call returns on rank 0.
pub fn during_call<T>(
    comm: &Comm,
    path: &Path,
    held: &std::fs::File,
    call: impl FnOnce() -> T,
) -> T {
    let watches = comm.is_root() && comm.raw().is_some() && comm.size() > 1;
    let watch = watches.then(|| end_if_gone(path, held));
    let result = call();
    drop(watch);
    result
}

/// Prints an error and ends the job once a path names this file no more, unless what is returned is dropped before.
fn end_if_gone(path: &Path, held: &std::fs::File) -> Sender<()> {
    let (calling, called) = channel();
    let path = path.to_owned();
    let identity = |of: std::fs::Metadata| (of.dev(), of.ino());
    let known = held.metadata().map(identity).ok();
    std::thread::spawn(move || {
        while called.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
            let gone = match std::fs::metadata(&path) {
                Ok(now) => known.is_some_and(|known| known != identity(now)),
                Err(error) => {
                    matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory)
                }
            };
            if gone {
                say::warn(&format!(
                    "error: {} was removed or moved while the ranks opened or closed it",
                    path.display()
                ));
                abort_job(EXIT_FAILED.into());
            }
        }
    });
    calling
}

/// Leaves a file of several ranks open, which is of no use after an error: closing it is a collective call.
pub fn abandon(comm: &Comm, file: Option<File>) {
    if comm.raw().is_some() {
        ABANDONED.store(true, Ordering::Relaxed);
        std::mem::forget(file);
    }
}

/// Set when a file of several ranks was left open after an error.
static ABANDONED: AtomicBool = AtomicBool::new(false);

/// Returns true if this process has a file that it can neither write nor close: MPI must not be
/// finalised, since HDF5 would try to. The same on every rank.
#[must_use]
pub fn abandoned() -> bool {
    ABANDONED.load(Ordering::Relaxed)
}
