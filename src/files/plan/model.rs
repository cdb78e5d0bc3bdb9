//! Time of a step.
//!
//! A rank with n particles and m images takes `n t_p + m t_i` of one core, shared by its threads. Its
//! messages take their latencies, and the bytes of all ranks of a node take its bandwidth, except for
//! messages after the motion, as far as these overlap with computing. The slowest rank and the collective calls determine the step.

use super::layout::Load;
use super::machine::Machine;
use super::sharing::Sharing;
use comm::Traffic;

/// Times of a step (s).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StepTime {
    /// Computing of the slowest rank.
    pub computing: f64,
    /// The whole step.
    pub all: f64,
    /// What the whole step consists of.
    pub terms: Terms,
}

/// What a step consists of (s), by the rank that makes it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Terms {
    /// An even share of all particles on cores that have nothing to share.
    pub even: f64,
    /// What the rank has more than an even share.
    pub uneven: f64,
    /// Particles of other ranks and images behind symmetry planes.
    pub images: f64,
    /// What threads lose, and cores of which all of a node work.
    pub sharing: f64,
    /// Bytes that no computing hides.
    pub bytes: f64,
    /// Latencies of messages.
    pub messages: f64,
    /// Collective calls.
    pub agreements: f64,
}

impl Terms {
    /// All of them, with what they are.
    #[must_use]
    pub fn named(&self) -> [(&'static str, f64); 7] {
        [
            ("an even share of the particles", self.even),
            ("uneven shares", self.uneven),
            ("particles of others, and images", self.images),
            ("threads, and cores of a busy node", self.sharing),
            ("bytes of messages", self.bytes),
            ("latencies of messages", self.messages),
            ("collective calls", self.agreements),
        ]
    }

    fn sum(&self) -> f64 {
        self.named().iter().map(|(_, time)| time).sum()
    }
}

/// Times of a step on ranks with these loads.
#[must_use]
#[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
pub fn step_time(loads: &[Load], machine: &Machine, sharing: Sharing) -> StepTime {
    let (slower, threads) = (
        crowded(loads.len(), machine, sharing),
        sharing.threads as f64,
    );
    let particles: u64 = loads.iter().map(|load| load.tally.owned).sum();
    let even = particles as f64 / loads.len() as f64 * machine.particle_time / threads;
    let agreements = machine.agreement_time * (loads.len() as f64).log2();
    let mut time = StepTime::default();
    for node in loads.chunks(sharing.ranks_per_node) {
        let (mut within, mut beyond, mut late) = (0.0, 0.0, 0.0);
        for load in node {
            beyond += load.beyond.bytes as f64;
            within += load.within().bytes as f64;
            late += load.late as f64;
        }
        let flight = beyond / machine.bandwidth + within / machine.node_bandwidth;
        // Nothing hides the motion.
        let late = flight * late / (within + beyond).max(1.0);
        for load in node {
            let alone = computing(load, machine);
            let images = load.tally.images as f64 * machine.image_time / threads;
            let terms = Terms {
                even,
                uneven: alone / threads - images - even,
                images,
                sharing: (slower - 1.0 / threads) * alone,
                bytes: flight - late.min(machine.overlap * slower * alone),
                messages: load.beyond.messages as f64 * machine.latency
                    + load.within().messages as f64 * machine.node_latency,
                agreements,
            };
            time.computing = time.computing.max(slower * alone);
            if terms.sum() > time.all {
                (time.all, time.terms) = (terms.sum(), terms);
            }
        }
    }
    time
}

/// Time (s) of one core alone for a step of a rank.
#[must_use]
#[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
pub fn computing(load: &Load, machine: &Machine) -> f64 {
    let tally = &load.tally;
    tally.owned as f64 * machine.particle_time + tally.images as f64 * machine.image_time
}

/// Computing time of a rank over that of one core alone.
#[allow(clippy::cast_precision_loss, reason = "few cores")]
fn crowded(ranks: usize, machine: &Machine, sharing: Sharing) -> f64 {
    let threads = sharing.threads as f64;
    let busy = ranks.min(sharing.ranks_per_node) as f64 * threads;
    let others = (machine.cores_per_node - 1.0).max(1.0);
    let crowding = 1.0 + machine.crowding * ((busy - 1.0) / others).min(1.0);
    crowding * (1.0 + machine.thread_loss * (threads - 1.0)) / threads
}

impl Load {
    /// Traffic to ranks of its own node.
    #[must_use]
    pub fn within(&self) -> Traffic {
        self.sent - self.beyond
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::domain::Tally;

    fn load(owned: u64, images: u64, [sent, beyond]: [u64; 2]) -> Load {
        let traffic = |bytes| Traffic { messages: 3, bytes };
        Load {
            tally: Tally {
                owned,
                halo: images,
                images,
                peers: 1,
            },
            sent: traffic(sent),
            beyond: traffic(beyond),
            late: sent,
        }
    }

    /// Two ranks, each a node of one core, by hand.
    #[test]
    fn the_slowest_rank_makes_the_step() {
        let machine = Machine {
            cores_per_node: 1.0,
            particle_time: 1e-6,
            image_time: 1e-7,
            crowding: 0.0,
            latency: 1e-3,
            bandwidth: 1e6,
            agreement_time: 0.5,
            ..Machine::default()
        };
        let sharing = Sharing {
            threads: 1,
            ranks_per_node: 1,
        };
        let loads = [load(1000, 100, [5000; 2]), load(2000, 0, [1000; 2])];
        let time = step_time(&loads, &machine, sharing);
        assert!((time.computing - 2e-3).abs() < 1e-12);
        assert!((time.all - (0.5 + 1.01e-3 + 5e-3 + 3e-3)).abs() < 1e-12);
        // The first rank sends most, and has less than an even share.
        let told = time.terms.named().map(|(_, time)| time);
        let wanted = [1.5e-3, -0.5e-3, 1e-5, 0.0, 5e-3, 3e-3, 0.5];
        assert!(told.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12));
        let hidden = Machine {
            overlap: 1.0,
            ..machine.clone()
        };
        let time = step_time(&loads, &hidden, sharing);
        assert!((time.all - (0.5 + 5e-3 + 3e-3)).abs() < 1e-12);
        // One node of both shares the bandwidth within it, and sends nothing beyond.
        let loads = loads.map(|load| Load {
            beyond: Traffic::default(),
            ..load
        });
        let node = Machine {
            node_latency: 0.0,
            node_bandwidth: 1e6,
            ..machine
        };
        let sharing = Sharing {
            ranks_per_node: 2,
            ..sharing
        };
        let time = step_time(&loads, &node, sharing);
        assert!((time.all - (0.5 + 2e-3 + 6e-3)).abs() < 1e-12);
    }

    #[test]
    fn threads_share_the_work_with_a_loss() {
        let machine = Machine {
            cores_per_node: 2.0,
            thread_loss: 0.1,
            crowding: 0.2,
            agreement_time: 0.0,
            ..Machine::default()
        };
        let loads = [load(1000, 0, [0; 2])];
        let at = |threads| {
            let sharing = Sharing {
                threads,
                ranks_per_node: 1,
            };
            step_time(&loads, &machine, sharing).computing
        };
        assert!((at(2) / at(1) - 1.1 * 1.2 / 2.0).abs() < 1e-12);
    }
}
