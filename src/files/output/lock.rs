//! The lock of a run's folder, so that no second run writes into it.
//!
//! Rank 0 holds an advisory lock on the file `lock` for as long as the run lives; the system drops
//! it when the process ends, in whatever way. The file says who holds it: a run that ends in good
//! order removes it, and one that was killed leaves it behind. Where a file system has no locks, or
//! keeps them on each host for itself, only the content of the file counts.

use std::fs::{self, File, TryLockError};
use std::io::{self, Write as _};
use std::os::fd::AsRawFd as _;
use std::os::unix::fs::{FileExt as _, MetadataExt as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use indicatif::HumanDuration;
use serde::{Deserialize, Serialize};

use super::{OutputError, files};

/// Name of the lock's file in a run's folder.
pub(super) const LOCK: &str = "lock";

/// Attempts to lock: `info` holds the lock for a moment, and `mpirun` may end before a rank that it has
/// killed.
const TRIES: u32 = 20;
const PAUSE: Duration = Duration::from_millis(50);

/// The process that has a folder open: the content of its `lock`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holder {
    /// Host of rank 0.
    pub host: String,
    /// Process id of rank 0.
    pub process: u32,
    /// The batch job that it is part of, where a scheduler started it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub job: Option<String>,
    /// Time of opening the folder (seconds since 1970, UTC).
    pub started: u64,
}

impl Holder {
    /// This process.
    fn here() -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            host: host(),
            process: std::process::id(),
            job: ["SLURM_JOB_ID", "PBS_JOBID"]
                .iter()
                .find_map(|name| std::env::var(name).ok()),
            started: since.map_or(0, |since| since.as_secs()),
        }
    }

    /// Returns whether a process with its id lives, if `here` can know that.
    fn lives(&self, here: &Self) -> Option<bool> {
        if self.host == here.host {
            Some(is_there(self.process))
        } else if self.job.is_some() && self.job == here.job {
            // A job that its scheduler has begun anew: it ended the first one before.
            Some(false)
        } else {
            None
        }
    }
}

/// Returns true if this host has a process of this id.
fn is_there(process: u32) -> bool {
    let Ok(id) = i32::try_from(process) else {
        return false;
    };
    // SAFETY: the signal 0 is none; the system only says whether it could be sent.
    let sent = unsafe { libc::kill(id, 0) } == 0;
    sent || io::Error::last_os_error().raw_os_error() == Some(libc::EPERM)
}

impl std::fmt::Display for Holder {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "process {} on {}", self.process, self.host)?;
        if let Some(job) = &self.job {
            write!(f, " (job {job})")?;
        }
        let began = UNIX_EPOCH + Duration::from_secs(self.started);
        match began.elapsed() {
            Ok(ago) => write!(f, ", begun {} ago", HumanDuration(ago)),
            Err(_) => Ok(()),
        }
    }
}

/// Presence of a run in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Presence {
    /// No run has it open; the last holder, if it did not close the folder.
    Nobody(Option<Holder>),
    /// A run has it open; its holder, if the file names it.
    Held(Option<Holder>),
    /// A run on another host had it open, and may still.
    Unclear(Holder),
}

impl Presence {
    /// Presence in the folder of a run, as far as this host can know.
    #[must_use]
    pub fn of(folder: &Path) -> Self {
        let Ok(file) = File::open(folder.join(LOCK)) else {
            return Self::Nobody(None);
        };
        let verdict = file.try_lock_shared();
        judge(verdict.as_ref().err(), read(&file), &Holder::here())
    }
}

/// Presence from the attempt to lock a file and its content.
fn judge(refused: Option<&TryLockError>, holder: Option<Holder>, here: &Holder) -> Presence {
    let lives = holder.as_ref().and_then(|holder| holder.lives(here));
    match (refused, holder) {
        (Some(TryLockError::WouldBlock), holder) => Presence::Held(holder),
        (_, None) => Presence::Nobody(None),
        // Some file systems keep the locks of each host for themselves.
        (_, Some(holder)) if lives.is_none() => Presence::Unclear(holder),
        (Some(TryLockError::Error(_)), Some(holder)) if lives == Some(true) => {
            Presence::Held(Some(holder))
        }
        (_, holder) => Presence::Nobody(holder),
    }
}

/// A folder held by this process, until it is dropped.
#[derive(Debug)]
pub struct RunLock {
    path: PathBuf,
    file: File,
    /// What this process has written into it.
    holder: Holder,
    /// Set if the folder is removed as well when nothing is in it.
    of_new: bool,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

impl RunLock {
    /// Takes the folder of a run, or names its holder in an error; `ignore` takes it all the same. By
    /// one process.
    ///
    /// # Errors
    /// [`OutputError::Held`], [`OutputError::Unclear`], [`OutputError::Io`].
    pub fn take(folder: &Path, ignore: bool) -> Result<Self, OutputError> {
        let path = folder.join(LOCK);
        let (mut file, verdict) = open(&path).map_err(OutputError::io("open", &path))?;
        let here = Holder::here();
        let mut warnings = Vec::new();
        if let Err(TryLockError::Error(error)) = &verdict {
            warnings.push(format!(
                "{} cannot be locked ({error}): a second run in this folder may not be noticed",
                path.display()
            ));
        }
        let presence = judge(verdict.as_ref().err(), read(&file), &here);
        let describe = |who: &Option<Holder>| {
            let nameless = "a process that has not said its name".to_owned();
            who.as_ref().map_or(nameless, ToString::to_string)
        };
        match presence {
            Presence::Nobody(None) => {}
            Presence::Nobody(before) => warnings.push(format!(
                "the run before ({}) did not close the folder: it was killed or lost",
                describe(&before)
            )),
            Presence::Held(who) if !ignore => {
                return Err(OutputError::Held {
                    path: folder.to_owned(),
                    who: describe(&who),
                });
            }
            Presence::Unclear(who) if !ignore => {
                return Err(OutputError::Unclear {
                    path: folder.to_owned(),
                    who: who.to_string(),
                    here: here.host,
                });
            }
            Presence::Held(who) => {
                warnings.push(format!("the lock of {} is ignored", describe(&who)));
                // That lock stays with the old file.
                file = replace(&path).map_err(OutputError::io("replace", &path))?;
            }
            Presence::Unclear(who) => warnings.push(format!("the lock of {who} is ignored")),
        }
        if let Err(error) = sign(&mut file, &here) {
            // A lock without a name, as on a full disk, would tell the next run of a process that there is not.
            let _ = fs::remove_file(&path);
            return Err(OutputError::io("write", &path)(error));
        }
        Ok(Self {
            path,
            file,
            holder: here,
            of_new: false,
            warnings,
        })
    }

    /// The same lock of a folder that was made for it.
    pub(super) fn of_new_folder(mut self) -> Self {
        self.of_new = true;
        self
    }

    /// The folder that this process holds, where it is now; `None` if it is gone, its lock was removed,
    /// or another process has taken it.
    pub(super) fn place(&self) -> Option<PathBuf> {
        // Where the system says so, also that of a folder that has been moved.
        let moved = fs::read_link(format!("/proc/self/fd/{}", self.file.as_raw_fd()));
        let mut known = std::iter::once(self.path.clone()).chain(moved);
        let path = known.find(|path| {
            // Opened anew, since a network's file system renews what it knows of a file then.
            let file = File::open(path).ok();
            file.is_some_and(|file| {
                is_same(&file, &self.file) && read(&file).as_ref() == Some(&self.holder)
            })
        })?;
        Some(path.parent()?.to_owned())
    }

    /// Who has taken the folder from this process, if somebody has.
    pub(super) fn successor(&self) -> Option<Holder> {
        let holder = read(&File::open(&self.path).ok()?)?;
        Some(holder).filter(|holder| *holder != self.holder)
    }
}

impl Drop for RunLock {
    /// Removes the file, if it is still this process's, and with it the lock; also a folder that was
    /// made for a run which then did not begin.
    fn drop(&mut self) {
        if let Some(folder) = self.place() {
            let _ = fs::remove_file(folder.join(LOCK));
            if self.of_new {
                // Refused where something is in it.
                let _ = fs::remove_dir(folder);
            }
        }
    }
}

/// Opens the file and tries to lock it.
fn open(path: &Path) -> io::Result<(File, Result<(), TryLockError>)> {
    let mut tries = 0;
    loop {
        let mut options = File::options();
        let file = options.read(true).write(true).create(true).open(path)?;
        let verdict = file.try_lock();
        tries += 1;
        // A file that has just been removed is locked in vain.
        let again = matches!(verdict, Err(TryLockError::WouldBlock))
            || !File::open(path).is_ok_and(|there| is_same(&file, &there));
        if !again || tries == TRIES {
            return Ok((file, verdict));
        }
        std::thread::sleep(PAUSE);
    }
}

/// Replaces a file by a new, locked one.
fn replace(path: &Path) -> io::Result<File> {
    let temporary = files::partial(path);
    let file = File::create(&temporary)?;
    let _ = file.try_lock();
    fs::rename(&temporary, path)?;
    Ok(file)
}

/// Returns true if two open files are one.
fn is_same(a: &File, b: &File) -> bool {
    let inode = |file: &File| file.metadata().map(|meta| (meta.dev(), meta.ino()));
    matches!((inode(a), inode(b)), (Ok(a), Ok(b)) if a == b)
}

fn read(file: &File) -> Option<Holder> {
    let mut text = [0; 1 << 12];
    let length = file.read_at(&mut text, 0).ok()?;
    serde_json::from_slice(&text[..length]).ok()
}

fn sign(file: &mut File, holder: &Holder) -> io::Result<()> {
    let mut text = serde_json::to_vec_pretty(holder)?;
    text.push(b'\n');
    file.set_len(0)?;
    io::Seek::rewind(file)?;
    file.write_all(&text)?;
    file.sync_all()
}

fn host() -> String {
    let mut name = [0_u8; 256];
    // SAFETY: the buffer is as long as it says; the last byte stays zero.
    let status = unsafe { libc::gethostname(name.as_mut_ptr().cast(), name.len() - 1) };
    let end = name.iter().position(|&byte| byte == 0).unwrap_or(0);
    let name = String::from_utf8_lossy(&name[..end]);
    if status == 0 && !name.is_empty() {
        name.into_owned()
    } else {
        "an unknown host".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holder(host: &str, process: u32) -> Holder {
        Holder {
            host: host.to_owned(),
            process,
            job: None,
            started: 0,
        }
    }

    #[test]
    fn a_second_run_is_refused_and_a_closed_folder_is_free() {
        let folder = tempfile::tempdir().unwrap();
        let first = RunLock::take(folder.path(), false).unwrap();
        assert!(first.warnings.is_empty());
        let error = RunLock::take(folder.path(), false).unwrap_err();
        let mine = format!("process {}", std::process::id());
        let held = matches!(error, OutputError::Held { .. });
        assert!(held && error.to_string().contains(&mine));
        assert!(matches!(
            Presence::of(folder.path()),
            Presence::Held(Some(_))
        ));

        let second = RunLock::take(folder.path(), true).unwrap();
        assert!(second.warnings[0].contains("is ignored"));
        // The first one's end leaves the second one's lock alone.
        drop(first);
        assert!(RunLock::take(folder.path(), false).is_err());
        drop(second);
        assert_eq!(Presence::of(folder.path()), Presence::Nobody(None));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        assert!(
            RunLock::take(folder.path(), false)
                .unwrap()
                .warnings
                .is_empty()
        );
    }

    #[test]
    fn a_lock_that_was_left_behind_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let leave = |holder: &Holder| {
            fs::write(
                folder.path().join(LOCK),
                serde_json::to_vec(holder).unwrap(),
            )
            .unwrap();
        };
        leave(&holder(&host(), 1));
        assert!(matches!(
            Presence::of(folder.path()),
            Presence::Nobody(Some(_))
        ));
        let lock = RunLock::take(folder.path(), false).unwrap();
        assert!(lock.warnings[0].contains("killed or lost"));
        drop(lock);

        leave(&holder("elsewhere", 1));
        assert!(matches!(Presence::of(folder.path()), Presence::Unclear(_)));
        let error = RunLock::take(folder.path(), false).unwrap_err();
        assert!(error.to_string().contains("--ignore-lock"), "{error}");
        let lock = RunLock::take(folder.path(), true).unwrap();
        assert!(lock.warnings[0].contains("elsewhere"));
    }

    /// The process id decides on a file system without locks.
    #[test]
    fn without_locks_the_file_decides() {
        let here = holder("a", 1);
        let refused = TryLockError::Error(io::ErrorKind::Unsupported.into());
        let presence = |holder: Option<Holder>| judge(Some(&refused), holder, &here);
        let (me, gone) = (holder("a", std::process::id()), holder("a", 0x7fff_fff0));
        assert_eq!(presence(None), Presence::Nobody(None));
        assert_eq!(presence(Some(me.clone())), Presence::Held(Some(me)));
        assert_eq!(presence(Some(gone.clone())), Presence::Nobody(Some(gone)));
        let other = holder("b", 1);
        assert_eq!(presence(Some(other.clone())), Presence::Unclear(other));

        // A batch job that was begun anew on another host.
        let mut again = holder("b", 1);
        again.job = Some("7".to_owned());
        let mut here = here;
        here.job = again.job.clone();
        assert_eq!(
            judge(None, Some(again.clone()), &here),
            Presence::Nobody(Some(again))
        );
    }
}
