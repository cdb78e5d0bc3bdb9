//! Runs as processes of their own, some at once.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use super::forks::Beginning;
use super::point::Point;
use files::output::{OutputError, Phase, Presence, RunFolder, RunLock, checkpoint};

/// The way to start runs.
#[derive(Debug, Clone)]
pub struct Launch {
    /// This program.
    pub program: PathBuf,
    /// The case.
    pub case: PathBuf,
    /// Settings of all points.
    pub settings: Vec<String>,
    /// Folder of the runs.
    pub folder: PathBuf,
    /// Ranks of a run: 1 starts no `mpirun`.
    pub ranks: usize,
    /// Threads of a rank.
    pub threads: usize,
}

/// The state of a point.
#[derive(Debug, Clone, PartialEq)]
pub enum PointState {
    /// It has not been run, or not to its end.
    Open,
    /// A process that is not ours runs it.
    Held,
    /// Its run has finished.
    Finished,
    /// Its run has failed; why.
    Failed(String),
}

/// A run that goes on.
#[derive(Debug)]
pub struct Running {
    /// The name of its point.
    pub name: String,
    child: Child,
}

impl Launch {
    /// The folder of a point's run.
    #[must_use]
    pub fn run_folder(&self, point: &Point) -> RunFolder {
        RunFolder::at(&self.folder.join(&point.name))
    }

    /// The state of a point, by its folder.
    #[must_use]
    pub fn state(&self, point: &Point) -> PointState {
        let folder = self.run_folder(point);
        if matches!(Presence::of(folder.path()), Presence::Held(_)) {
            return PointState::Held;
        }
        match folder.status() {
            Ok(status) if status.state == Phase::Finished => PointState::Finished,
            Ok(status) if status.state == Phase::Failed => {
                PointState::Failed(status.reason.unwrap_or_default())
            }
            _ => PointState::Open,
        }
    }

    /// How many checkpoints the run of a point has.
    pub(super) fn checkpoints(&self, point: &Point) -> usize {
        let all = self.run_folder(point).checkpoint_folders();
        all.map_or(0, |all| all.len())
    }

    /// Removes all but so many newest checkpoints of a point's run, unless somebody holds it.
    pub(super) fn keep_checkpoints(&self, point: &Point, kept: usize) -> Result<(), OutputError> {
        if self.checkpoints(point) <= kept {
            return Ok(());
        }
        let folder = self.run_folder(point);
        match RunLock::take(folder.path(), false) {
            Ok(_lock) => checkpoint::keep_newest(&folder.checkpoints(), kept),
            Err(_) => Ok(()),
        }
    }

    /// Starts or continues the run of a point, which nobody holds. What it says goes to a file beside
    /// its folder.
    ///
    /// # Errors
    /// [`OutputError::Io`].
    pub(super) fn start(
        &self,
        point: &Point,
        beginning: &Beginning,
    ) -> Result<Running, OutputError> {
        fs::create_dir_all(&self.folder).map_err(OutputError::io("create", &self.folder))?;
        let folder = self.run_folder(point);
        let path = self.folder.join(format!("{}.log", point.name));
        let log = OpenOptions::new().create(true).append(true).open(&path);
        let log = log.map_err(OutputError::io("open", &path))?;
        let mut command = self.command(point, &folder, beginning);
        let child = spawn(&mut command, &log);
        let program = command.get_program().to_owned();
        let child = child.map_err(OutputError::io("start", Path::new(&program)))?;
        let name = point.name.clone();
        Ok(Running { name, child })
    }

    fn command(&self, point: &Point, folder: &RunFolder, beginning: &Beginning) -> Command {
        let mut command = if self.ranks == 1 {
            Command::new(&self.program)
        } else {
            let mut command = Command::new("mpirun");
            command.args(["-n", &self.ranks.to_string()]);
            command.arg(&self.program);
            command
        };
        let mut checkpoints = folder.checkpoint_folders().unwrap_or_default();
        // What a fork has taken over is none of its own yet.
        if let Ok(Some(forked)) = folder.forked() {
            let is_own =
                |path: &PathBuf| checkpoint::manifest(path).is_ok_and(|m| m.step > forked.step);
            checkpoints.retain(is_own);
        }
        let (mut begins, settings): (_, &[String]) = match beginning {
            _ if !checkpoints.is_empty() => (command.arg("restart").arg(folder.path()), &[]),
            Beginning::Fork { from, settings } => {
                (command.arg("fork").arg(self.folder.join(from)), settings)
            }
            Beginning::Start(more) => {
                let mut command = command.arg("run").arg(&self.case);
                for setting in self.settings.iter().chain(&point.settings) {
                    command = command.arg("--set").arg(setting);
                }
                (command, more)
            }
            Beginning::Later => return command,
        };
        for setting in settings {
            begins = begins.arg("--set").arg(setting);
        }
        if checkpoints.is_empty() {
            begins.arg("--out").arg(folder.path()).arg("--force");
        }
        command.args(["--threads", &self.threads.to_string()]);
        command
    }
}

/// Starts a process that is asked to stop when this one ends, however that comes.
fn spawn(command: &mut Command, log: &File) -> io::Result<Child> {
    command.stdin(Stdio::null());
    command.stdout(log.try_clone()?).stderr(log.try_clone()?);
    // SAFETY: the call of the system is safe between fork and exec.
    unsafe {
        command.pre_exec(|| {
            if libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGTERM) == 0 {
                Ok(())
            } else {
                Err(io::Error::last_os_error())
            }
        });
    }
    command.spawn()
}

impl Running {
    /// Its exit code, once it has ended; -1 if a signal ended it.
    ///
    /// # Errors
    /// The error of the system.
    pub fn ended(&mut self) -> io::Result<Option<i32>> {
        let status = self.child.try_wait()?;
        Ok(status.map(|status| status.code().unwrap_or(-1)))
    }
}
