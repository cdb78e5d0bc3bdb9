//! Direct I/O of long rows, past the system's page cache, while the next ones are gathered.
//!
//! The cache would keep a second copy of them, and a first use of one of its pages may take longer than the disk
//! does. Here a thread writes pieces that begin and end at blocks of the file system. The rest at both ends of
//! some rows shares its block with others and goes through the cache, which is coherent on one machine. So only
//! file systems of one machine that are known to keep that order are written so, and none that several mount.

use std::fs::{File, OpenOptions};
use std::io;
use std::os::unix::fs::FileExt as _;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use super::pieces::{MOST_BLOCK, PIECE, Piece};

/// A rank's rows of fewer bytes go through the cache: a copy there takes less than the disk's answer.
const LEAST: usize = 1 << 20;

/// A file that takes long rows past the cache.
pub struct Direct {
    past: Arc<File>,
    cached: File,
    /// Bytes of a block.
    block: u64,
    worker: Option<Worker>,
    /// Offset of the next bytes.
    offset: u64,
    /// The piece being filled, and its bytes so far.
    filling: Option<(Piece, usize)>,
}

/// The thread that writes.
struct Worker {
    loads: Sender<Load>,
    /// Pieces that can be filled again, or errors.
    done: Receiver<io::Result<Piece>>,
    thread: JoinHandle<()>,
    /// Number of pieces that it has.
    given: usize,
}

/// Bytes and their offset in the file.
struct Load {
    piece: Piece,
    count: usize,
    offset: u64,
}

/// Pieces in turn: one is written while the other is filled.
const PIECES: usize = 2;

impl Direct {
    /// Of an existing file; `None` if its file system does not support this.
    pub fn of(path: &Path) -> Option<Self> {
        let block = block_of(path)?;
        Some(Self {
            past: Arc::new(past_cache(File::options().write(true)).open(path).ok()?),
            cached: File::options().write(true).open(path).ok()?,
            block,
            worker: None,
            offset: 0,
            filling: None,
        })
    }

    /// Returns true for rows that are long enough (bytes).
    pub fn takes(bytes: usize) -> bool {
        bytes >= LEAST
    }

    /// Begins to write bytes at an offset of the file, best where the last ones ended.
    ///
    /// # Errors
    /// Those of the system, also of earlier writes.
    pub fn write(&mut self, offset: u64, mut bytes: &[u8]) -> io::Result<()> {
        if offset != self.offset {
            self.end()?;
            self.offset = offset;
        }
        while !bytes.is_empty() {
            let before = self.offset.next_multiple_of(self.block) - self.offset;
            if self.filling.is_none() && before > 0 {
                let (first, rest) = bytes.split_at(bytes.len().min(in_memory(before)));
                self.cached.write_all_at(first, self.offset)?;
                self.offset += first.len() as u64;
                bytes = rest;
                continue;
            }
            let (mut piece, filled) = match self.filling.take() {
                Some(filling) => filling,
                None => (self.worker().piece()?, 0),
            };
            let (next, rest) = bytes.split_at(bytes.len().min(PIECE - filled));
            let to = filled + next.len();
            piece.bytes()[filled..to].copy_from_slice(next);
            self.offset += next.len() as u64;
            bytes = rest;
            if to == PIECE {
                self.give(piece, to);
            } else {
                self.filling = Some((piece, to));
            }
        }
        Ok(())
    }

    /// Ends a sequence of consecutive bytes.
    fn end(&mut self) -> io::Result<()> {
        let Some((mut piece, filled)) = self.filling.take() else {
            return Ok(());
        };
        let left = in_memory(self.offset % self.block).min(filled);
        let whole = filled - left;
        let tail = self.offset - left as u64;
        self.cached
            .write_all_at(&piece.bytes()[whole..filled], tail)?;
        self.offset = tail;
        self.give(piece, whole);
        Ok(())
    }

    fn worker(&mut self) -> &mut Worker {
        let past = &self.past;
        self.worker.get_or_insert_with(|| Worker::new(past))
    }

    /// Gives the thread the bytes filled so far.
    fn give(&mut self, piece: Piece, count: usize) {
        let offset = self.offset - count as u64;
        self.worker().give(Load {
            piece,
            count,
            offset,
        });
    }

    /// Waits until all is written.
    ///
    /// # Errors
    /// Those of the system.
    pub fn finish(&mut self) -> io::Result<()> {
        let ended = self.end();
        let written = self.worker.take().map_or(Ok(()), Worker::finish);
        ended.and(written)
    }
}

impl Drop for Direct {
    /// Waits for the thread.
    fn drop(&mut self) {
        let _ = self.finish();
    }
}

impl Worker {
    fn new(past: &Arc<File>) -> Self {
        let (loads, to_write) = channel::<Load>();
        let (back, done) = channel();
        let past = Arc::clone(past);
        let thread = std::thread::spawn(move || {
            for Load {
                mut piece,
                count,
                offset,
            } in to_write
            {
                let written = past.write_all_at(&piece.bytes()[..count], offset);
                if back.send(written.map(|()| piece)).is_err() {
                    break;
                }
            }
        });
        Self {
            loads,
            done,
            thread,
            given: 0,
        }
    }

    /// A piece that can be filled.
    fn piece(&mut self) -> io::Result<Piece> {
        if self.given < PIECES {
            return Ok(Piece::take());
        }
        let done = self.done.recv().map_err(|_| lost())?;
        self.given -= 1;
        done
    }

    fn give(&mut self, load: Load) {
        // A thread that is gone shows when a piece is waited for.
        let _ = self.loads.send(load);
        self.given += 1;
    }

    fn finish(self) -> io::Result<()> {
        drop(self.loads);
        let mut result = Ok(());
        for _ in 0..self.given {
            let done = self.done.recv().unwrap_or_else(|_| Err(lost()));
            result = result.and(done.map(Piece::keep));
        }
        self.thread.join().map_err(|_| lost()).and(result)
    }
}

fn lost() -> io::Error {
    io::Error::other("the thread that writes is gone")
}

fn in_memory(bytes: u64) -> usize {
    usize::try_from(bytes).expect("rows fit memory")
}

/// Opens a file to be read by whole [`PIECE`]s, past the cache where its file system takes that.
///
/// # Errors
/// Those of the system.
pub fn open_for_reading(path: &Path) -> io::Result<File> {
    let mut options = File::options();
    options.read(true);
    if block_of(path).is_some()
        && let Ok(file) = past_cache(&mut options).open(path)
    {
        return Ok(file);
    }
    File::open(path)
}

/// Makes an opened file bypass the cache.
fn past_cache(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(target_os = "linux")]
    std::os::unix::fs::OpenOptionsExt::custom_flags(options, libc::O_DIRECT);
    options
}

/// Bytes of the blocks of a file system, which are whole pages of the cache; `None` if it is not known to take
/// direct writes beside cached ones.
#[cfg(target_os = "linux")]
fn block_of(path: &Path) -> Option<u64> {
    use std::mem::MaybeUninit;
    use std::os::unix::ffi::OsStrExt as _;

    let path = std::ffi::CString::new(path.as_os_str().as_bytes()).ok()?;
    let mut about = MaybeUninit::<libc::statfs>::uninit();
    // SAFETY: the path ends with a zero, and `about` has the type of the result.
    let about = unsafe {
        (libc::statfs(path.as_ptr(), about.as_mut_ptr()) == 0).then(|| about.assume_init())
    }?;
    // SAFETY: a question about the system.
    let page = u64::try_from(unsafe { libc::sysconf(libc::_SC_PAGESIZE) }).ok()?;
    let block = u64::try_from(about.f_bsize).ok()?.max(page);
    let known = [libc::EXT4_SUPER_MAGIC, libc::XFS_SUPER_MAGIC];
    let fits = block.is_power_of_two() && block <= MOST_BLOCK as u64;
    (fits && known.contains(&about.f_type)).then_some(block)
}

#[cfg(not(target_os = "linux"))]
fn block_of(_: &Path) -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    /// An empty file, if its file system takes direct writes.
    fn new_file(folder: &Path) -> Option<(PathBuf, Direct)> {
        let path = folder.join("rows");
        File::create(&path).unwrap();
        Direct::of(&path).map(|direct| (path, direct))
    }

    /// Rows that begin and end anywhere, among others that go through the cache, are all there.
    #[test]
    fn rows_of_any_place_and_length_are_written() {
        let folder = tempfile::tempdir().unwrap();
        let Some((path, mut direct)) = new_file(folder.path()) else {
            return;
        };
        let offsets = [0, 5, 4090, 70_000, 70_001 + PIECE, 4 * PIECE + 3];
        let whole: Vec<u8> = (0..offsets[5])
            .map(|k| (k * 7 + k / 251).to_le_bytes()[0])
            .collect();
        for pair in offsets.windows(2) {
            let mut offset = pair[0] as u64;
            for chunk in whole[pair[0]..pair[1]].chunks(70_003) {
                direct.write(offset, chunk).unwrap();
                offset += chunk.len() as u64;
            }
        }
        direct.finish().unwrap();
        assert!(std::fs::read(&path).unwrap() == whole);
    }

    #[test]
    fn what_the_disk_refuses_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let Some((_, mut direct)) = new_file(folder.path()) else {
            return;
        };
        // Beyond the longest file.
        let offset = u64::MAX / 2 - PIECE as u64;
        let rows = vec![0; 4 * PIECE];
        let written = direct.write(offset, &rows);
        assert!(written.and_then(|()| direct.finish()).is_err());
    }
}
