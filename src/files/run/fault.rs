//! Injected faults, to test that the failure of one rank ends all ranks: only in builds with
//! debug assertions, as those of tests are.
//!
//! `WHIPPLE_TEST_FAULT=KIND:RANK:STEP` makes that rank fail before that step. KIND is
//! `panic` (on the main thread), `task` (a panic on another thread, where there is one), `nan`
//! (a particle's velocity is NaN), `pause` (all wait for this rank, to be stopped), `kill`
//! (SIGKILL), `kill-in-checkpoint` (SIGKILL while the next checkpoint is written) or `full` (no
//! file of this rank may grow beyond 300 kB, as if the disk were full).

use std::path::Path;
use std::time::Duration;

use engine::step::Simulation;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Panic,
    Task,
    Nan,
    Pause,
    Kill,
    KillInCheckpoint,
    Full,
}

/// Length of a pause: the file `stop` is looked for once a second.
const PAUSE: Duration = Duration::from_millis(1500);

/// The fault of one rank.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Fault {
    kind: Kind,
    step: u64,
}

/// Injects the fault that the environment requests, if it is of this rank and of the next step.
pub fn strike(rank: usize, simulation: &mut Simulation, checkpoints: &Path) {
    let requested = std::env::var("WHIPPLE_TEST_FAULT").ok();
    let fault = requested.and_then(|text| parse(&text, rank));
    if let Some(fault) = fault.filter(|fault| simulation.state.step + 1 == fault.step) {
        fault.strike(simulation, checkpoints);
    }
}

impl Fault {
    #[expect(clippy::manual_assert, reason = "nothing is asserted")]
    fn strike(self, simulation: &mut Simulation, checkpoints: &Path) {
        match self.kind {
            Kind::Panic => panic!("a panic on purpose"),
            Kind::Task => {
                rayon::broadcast(|thread| {
                    if thread.index() + 1 == thread.num_threads() {
                        panic!("a panic on purpose");
                    }
                });
            }
            Kind::Nan => {
                if let Some(velocity) = simulation.particles.velocity.first_mut() {
                    velocity[0] = f64::NAN;
                }
            }
            Kind::Pause => std::thread::sleep(PAUSE),
            Kind::Kill => kill(),
            Kind::KillInCheckpoint => {
                let folder = checkpoints.to_owned();
                std::thread::spawn(move || {
                    while !holds_partial(&folder) {
                        std::hint::spin_loop();
                    }
                    kill();
                });
            }
            Kind::Full => limit_files(),
        }
    }
}

fn kill() {
    let _ = signal_hook::low_level::raise(signal_hook::consts::SIGKILL);
}

/// Returns true while a checkpoint is being written.
fn holds_partial(folder: &Path) -> bool {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names = entries.map(|entry| entry.path());
    names.any(|path| {
        path.extension().is_some_and(|e| e == "partial") && path.join("state.h5").exists()
    })
}

fn limit_files() {
    let limit = libc::rlimit {
        rlim_cur: 300_000,
        rlim_max: 300_000,
    };
    // SAFETY: plain calls of the system; the signal is ignored so that writes return an error.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
        libc::setrlimit(libc::RLIMIT_FSIZE, &raw const limit);
    }
}

fn parse(text: &str, rank: usize) -> Option<Fault> {
    let mut fields = text.split(':');
    let kind = match fields.next()? {
        "panic" => Kind::Panic,
        "task" => Kind::Task,
        "nan" => Kind::Nan,
        "pause" => Kind::Pause,
        "kill" => Kind::Kill,
        "kill-in-checkpoint" => Kind::KillInCheckpoint,
        "full" => Kind::Full,
        _ => return None,
    };
    let here = fields.next()?.parse() == Ok(rank);
    let step = fields.next()?.parse().ok()?;
    here.then_some(Fault { kind, step })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_of_one_rank() {
        let fault = Fault {
            kind: Kind::Task,
            step: 20,
        };
        assert_eq!(parse("task:1:20", 1), Some(fault));
        for other in ["task:2:20", "task:1", "task:1:soon", "hiccup:1:20", ""] {
            assert_eq!(parse(other, 1), None);
        }
    }
}
