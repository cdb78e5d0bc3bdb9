//! Faults on purpose, to test that one rank's trouble ends all ranks.
//!
//! `WHIPPLE_TEST_FAULT=KIND:RANK:STEP` lets that rank meet the trouble before that step. KIND is
//! `panic` (on the main thread), `task` (a panic on another thread, where there is one), `nan`
//! (a particle's velocity is no number) or `pause` (all wait for this rank, to be stopped).

use std::time::Duration;

use crate::step::Simulation;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Panic,
    Task,
    Nan,
    Pause,
}

/// How long a pause takes: the file `stop` is looked for once a second.
const PAUSE: Duration = Duration::from_millis(1500);

/// The fault of this rank, if it is to have one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fault {
    kind: Kind,
    step: u64,
}

impl Fault {
    /// Reads the environment; anything but a fault of this rank means none.
    pub fn of_rank(rank: usize) -> Option<Self> {
        parse(&std::env::var("WHIPPLE_TEST_FAULT").ok()?, rank)
    }

    /// Makes the trouble if it is time for it.
    #[expect(clippy::manual_assert, reason = "nothing is asserted")]
    pub fn strike(self, simulation: &mut Simulation) {
        if simulation.state.step + 1 != self.step {
            return;
        }
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
                if let Some(velocity) = simulation.store.velocity.first_mut() {
                    velocity[0] = f64::NAN;
                }
            }
            Kind::Pause => std::thread::sleep(PAUSE),
        }
    }
}

fn parse(text: &str, rank: usize) -> Option<Fault> {
    let mut parts = text.split(':');
    let kind = match parts.next()? {
        "panic" => Kind::Panic,
        "task" => Kind::Task,
        "nan" => Kind::Nan,
        "pause" => Kind::Pause,
        _ => return None,
    };
    let here = parts.next()?.parse() == Ok(rank);
    let step = parts.next()?.parse().ok()?;
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
