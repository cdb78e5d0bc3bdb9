//! A process that is killed at a chosen call of the system. Its main thread is traced, which is the
//! one that writes files, and of its calls those count that may change a given folder: between two
//! of them the folder stands still, so that a kill before each of them is a kill anywhere.

use std::ffi::CStr;
use std::io;
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A call that may change the folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Call {
    pub name: &'static str,
    pub path: PathBuf,
    /// The new name, of a rename.
    pub to: Option<PathBuf>,
}

/// What a traced command has done.
#[derive(Debug)]
pub struct Traced {
    /// Calls that it has made; but for the last one, if it was killed there.
    pub calls: Vec<Call>,
    /// Exit code; `None` after a signal.
    pub code: Option<i32>,
}

/// Runs a command, to its end or up to the call of this number, counted from 0, at which it is
/// killed.
///
/// # Errors
/// If the system lets nobody trace.
pub fn trace(command: &mut Command, folder: &Path, kill_at: Option<usize>) -> io::Result<Traced> {
    let streams = [(); 3].map(|()| Stdio::null());
    let [stdin, stdout, stderr] = streams;
    command.stdin(stdin).stdout(stdout).stderr(stderr);
    // SAFETY: one plain call between fork and exec.
    unsafe {
        command.pre_exec(|| succeeded(libc::ptrace(libc::PTRACE_TRACEME)));
    }
    let mut child = command.spawn()?;
    let id = i32::try_from(child.id()).unwrap();
    let mut tracee = Tracee {
        id,
        calls: Vec::new(),
    };
    let status = tracee.follow(folder, kill_at);
    // The system has told its end here already.
    let _ = child.try_wait();
    let code = libc::WIFEXITED(status).then(|| libc::WEXITSTATUS(status));
    Ok(Traced {
        calls: tracee.calls,
        code,
    })
}

struct Tracee {
    id: i32,
    calls: Vec<Call>,
}

impl Tracee {
    /// Follows it to its end; gives its status.
    fn follow(&mut self, folder: &Path, kill_at: Option<usize>) -> i32 {
        let mut status = self.wait();
        assert!(libc::WIFSTOPPED(status), "it stops at its exec");
        let options = libc::PTRACE_O_TRACESYSGOOD | libc::PTRACE_O_EXITKILL;
        // SAFETY: the process is ours and stopped.
        succeeded(unsafe {
            libc::ptrace(libc::PTRACE_SETOPTIONS, self.id, 0_usize, options as usize)
        })
        .unwrap();
        let mut signal = 0_i32;
        loop {
            // SAFETY: as above.
            if unsafe { libc::ptrace(libc::PTRACE_SYSCALL, self.id, 0_usize, signal as usize) } != 0
            {
                return self.wait();
            }
            status = self.wait();
            if !libc::WIFSTOPPED(status) {
                return status;
            }
            signal = 0;
            match libc::WSTOPSIG(status) {
                stop if stop == libc::SIGTRAP | 0x80 => {
                    let Some(call) = self.call(folder) else {
                        continue;
                    };
                    self.calls.push(call);
                    if kill_at == Some(self.calls.len() - 1) {
                        // SAFETY: as above; the call that it is about to make is then not made.
                        unsafe { libc::kill(self.id, libc::SIGKILL) };
                        return self.wait();
                    }
                }
                libc::SIGTRAP => {}
                other => signal = other,
            }
        }
    }

    fn wait(&self) -> i32 {
        let mut status = 0;
        // SAFETY: the process is ours.
        let id = unsafe { libc::waitpid(self.id, &raw mut status, 0) };
        assert_eq!(id, self.id, "{}", io::Error::last_os_error());
        status
    }

    /// The call that it is about to make, if it may change something below the folder.
    fn call(&self, folder: &Path) -> Option<Call> {
        // SAFETY: plain numbers.
        let mut info: libc::ptrace_syscall_info = unsafe { std::mem::zeroed() };
        let size = size_of_val(&info);
        // SAFETY: the place is as long as it says.
        unsafe {
            libc::ptrace(libc::PTRACE_GET_SYSCALL_INFO, self.id, size, &raw mut info);
        }
        if info.op != libc::PTRACE_SYSCALL_INFO_ENTRY {
            return None;
        }
        // SAFETY: it is an entry.
        let entry = unsafe { info.u.entry };
        let number = i64::try_from(entry.nr).unwrap();
        let [a, b, c, d, ..] = entry.args;
        let here = libc::AT_FDCWD as u64;
        let writes = |flags: u64| {
            let flags = i32::try_from(flags & 0x7fff_ffff).unwrap();
            flags & (libc::O_WRONLY | libc::O_RDWR | libc::O_CREAT | libc::O_TRUNC) != 0
        };
        let (name, path, to) = match number {
            libc::SYS_open if writes(b) => ("open", self.path(here, a), None),
            libc::SYS_openat if writes(c) => ("open", self.path(a, b), None),
            libc::SYS_creat => ("open", self.path(here, a), None),
            libc::SYS_write | libc::SYS_writev | libc::SYS_pwrite64 | libc::SYS_pwritev => {
                ("write", self.file(a), None)
            }
            libc::SYS_copy_file_range => ("write", self.file(c), None),
            libc::SYS_sendfile => ("write", self.file(a), None),
            libc::SYS_fsync | libc::SYS_fdatasync => ("sync", self.file(a), None),
            libc::SYS_ftruncate | libc::SYS_fallocate => ("resize", self.file(a), None),
            libc::SYS_truncate => ("resize", self.path(here, a), None),
            libc::SYS_flock => ("lock", self.file(a), None),
            libc::SYS_fchmod => ("mode", self.file(a), None),
            libc::SYS_mkdir => ("mkdir", self.path(here, a), None),
            libc::SYS_mkdirat => ("mkdir", self.path(a, b), None),
            libc::SYS_rmdir | libc::SYS_unlink => ("remove", self.path(here, a), None),
            libc::SYS_unlinkat => ("remove", self.path(a, b), None),
            libc::SYS_rename => ("rename", self.path(here, a), self.path(here, b)),
            libc::SYS_renameat | libc::SYS_renameat2 => {
                ("rename", self.path(a, b), self.path(c, d))
            }
            _ => return None,
        };
        let path = path?;
        path.starts_with(folder).then_some(Call { name, path, to })
    }

    /// The path of an open file.
    fn file(&self, descriptor: u64) -> Option<PathBuf> {
        let number = descriptor as u32 as i32;
        std::fs::read_link(format!("/proc/{}/fd/{number}", self.id)).ok()
    }

    /// The path that a call names in its memory, from a folder that it has open.
    fn path(&self, folder: u64, address: u64) -> Option<PathBuf> {
        use std::os::unix::fs::FileExt as _;
        let memory = std::fs::File::open(format!("/proc/{}/mem", self.id)).ok()?;
        let mut bytes = vec![0; 4096];
        let count = memory.read_at(&mut bytes, address).ok()?;
        let text = CStr::from_bytes_until_nul(&bytes[..count])
            .ok()?
            .to_str()
            .ok()?;
        if folder as u32 as i32 == libc::AT_FDCWD {
            let place = std::fs::read_link(format!("/proc/{}/cwd", self.id)).ok()?;
            Some(place.join(text))
        } else {
            Some(self.file(folder)?.join(text))
        }
    }
}

fn succeeded(code: libc::c_long) -> io::Result<()> {
    if code < 0 {
        Err(io::Error::last_os_error())
    } else {
        Ok(())
    }
}
