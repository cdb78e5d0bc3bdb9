//! The built program, as a user starts it: alone, under a real `mpirun`, or through `jobs/`.

use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::LazyLock;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// The program.
pub const WHIPPLE: &str = env!("CARGO_BIN_EXE_whipple");

/// Time that a command may take before it counts as hanging; a coarse run takes a second.
const PATIENCE: Duration = Duration::from_secs(100);

/// A quarter impact of 3,056 particles and some 120 steps that takes well under a second: two
/// bodies in contact, two planes of symmetry, checkpoints on the way.
pub const COARSE: [&str; 8] = [
    "--set",
    "spacing=0.05mm",
    "--set",
    "output.snapshot_every=0.1us",
    "--set",
    "output.history_every=1",
    "--set",
    "output.checkpoints_kept=9",
];

/// A file of the project.
pub fn project(path: &str) -> String {
    crate::project::root().join(path).display().to_string()
}

/// The case of [`COARSE`].
pub fn quarter_impact() -> String {
    project("inputs/quarter-impact")
}

/// What `jobs/env.sh` sets.
static ENVIRONMENT: LazyLock<Vec<(String, String)>> = LazyLock::new(|| {
    let script = format!("source '{}' && env -0", project("jobs/env.sh"));
    let output = Command::new("bash").args(["-c", &script]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    text.split('\0')
        .filter_map(|entry| entry.split_once('='))
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .collect()
});

/// A command in the environment of `jobs/env.sh`, and in nothing of the test's own.
pub fn command(program: &str) -> Command {
    let mut command = Command::new(program);
    command.envs(ENVIRONMENT.iter().map(|(name, value)| (name, value)));
    for name in ["RUST_BACKTRACE", "RAYON_NUM_THREADS", "WHIPPLE_TEST_FAULT"] {
        command.env_remove(name);
    }
    command.env("WHIPPLE_PROGRAM", WHIPPLE);
    command
}

/// Lets a rank of a command meet a fault, see `src/files/run/fault.rs`.
#[track_caller]
pub fn strike<'a>(command: &'a mut Command, fault: &str) -> &'a mut Command {
    let built = cfg!(debug_assertions);
    assert!(built, "the program is built without debug assertions");
    command.env("WHIPPLE_TEST_FAULT", fault)
}

/// The program on so many ranks.
pub fn ranks(number: usize) -> Command {
    let mut command = command("mpirun");
    command.args(["-n", &number.to_string(), WHIPPLE]);
    command
}

/// A coarse run on so many ranks into a folder.
pub fn coarse_run(number: usize, folder: &Path) -> Command {
    let mut command = ranks(number);
    command.args(["run", &quarter_impact()]);
    command.args(COARSE).arg("--out").arg(folder);
    command
}

/// What a command has left.
#[derive(Debug)]
pub struct Ended {
    /// Exit code; `None` after a signal.
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
    pub took: Duration,
}

impl Ended {
    /// Fails, with all that was said, unless the exit code is this.
    #[track_caller]
    pub fn with_code(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:#?}");
        self
    }

    /// The lines of the error stream that begin so.
    pub fn complaints(&self, begin: &str) -> Vec<&str> {
        self.stderr
            .lines()
            .filter(|line| line.starts_with(begin))
            .collect()
    }
}

/// A command that runs.
pub struct Running {
    child: Child,
    started: Instant,
    streams: [JoinHandle<String>; 2],
}

/// Starts a command.
pub fn start(command: &mut Command) -> Running {
    let started = Instant::now();
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let stdout = read(child.stdout.take().unwrap());
    let stderr = read(child.stderr.take().unwrap());
    Running {
        child,
        started,
        streams: [stdout, stderr],
    }
}

fn read(mut stream: impl Read + Send + 'static) -> JoinHandle<String> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).unwrap();
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// Runs a command to its end.
pub fn end(command: &mut Command) -> Ended {
    start(command).end()
}

impl Running {
    /// Process id of the command itself.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Process ids of the ranks, if the command is mpirun.
    pub fn rank_ids(&self) -> Vec<u32> {
        let output = Command::new("pgrep")
            .args(["-P", &self.id().to_string()])
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        text.lines().map(|line| line.parse().unwrap()).collect()
    }

    /// Waits for the end.
    pub fn end(mut self) -> Ended {
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            if self.started.elapsed() > PATIENCE {
                self.child.kill().unwrap();
                panic!("it hangs");
            }
            std::thread::sleep(Duration::from_millis(5));
        };
        let took = self.started.elapsed();
        let [stdout, stderr] = self.streams.map(|stream| stream.join().unwrap());
        Ended {
            code: status.code(),
            stdout,
            stderr,
            took,
        }
    }

    /// Waits until `there` gives something.
    #[track_caller]
    pub fn until<T>(&self, what: &str, there: impl Fn() -> Option<T>) -> T {
        while self.started.elapsed() < PATIENCE {
            if let Some(found) = there() {
                return found;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        panic!("no {what} after {PATIENCE:?}");
    }

    /// Waits until the run in `folder` has written the row of a step.
    #[track_caller]
    pub fn until_step(&self, folder: &Path, step: u64) {
        self.until("such step", || (last_step(folder)? >= step).then_some(()));
    }
}

/// Sends a signal, such as `USR1`.
pub fn signal(name: &str, process: u32) {
    let sent = Command::new("kill")
        .args([format!("-{name}"), process.to_string()])
        .status();
    assert!(sent.unwrap().success(), "kill -{name} {process}");
}

/// The last whole row of the history of the run in `folder`.
fn last_step(folder: &Path) -> Option<u64> {
    let text = std::fs::read_to_string(folder.join("history.csv")).ok()?;
    let (whole, _) = text.rsplit_once('\n')?;
    whole.lines().last()?.split(',').next()?.parse().ok()
}

/// A JSON file of a run.
pub fn json(path: &Path) -> serde_json::Value {
    let text = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_slice(&text).unwrap()
}

/// `status.json`: state, step and reason.
pub fn status(folder: &Path) -> (String, u64, String) {
    let status = json(&folder.join("status.json"));
    let text = |key: &str| status[key].as_str().unwrap_or_default().to_owned();
    (
        text("state"),
        status["step"].as_u64().unwrap(),
        text("reason"),
    )
}

/// Fails unless `compare` finds the same bits in two runs.
#[track_caller]
pub fn assert_same(a: &Path, b: &Path) {
    let ended = end(command(WHIPPLE).arg("compare").arg(a).arg(b)).with_code(0);
    assert!(
        ended.stdout.lines().last().unwrap().starts_with("same: "),
        "{}",
        ended.stdout
    );
}
