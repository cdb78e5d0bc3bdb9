//! Time of a step from counts along the axes alone, which is fast for any number of particles.

use super::layout::Load;
use super::machine::Machine;
use super::model::step_time;
use super::sharing::Sharing;
use crate::preflight::memory;
use comm::{Comm, Traffic};
use engine::domain::Tally;
use engine::step::bytes_of_messages;
use model::Case;

/// Peers of a rank in boxes: those around a box of three axes.
const PEERS: u64 = 26;

/// Seconds of a mean step on `ranks` ranks of a machine, each with one thread and an even share of the work.
#[must_use]
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "counts of particles"
)]
pub fn rough_step(case: &Case, ranks: usize, machine: &Machine) -> f64 {
    let solo = Comm::solo();
    let owned = (memory::fullest_of(case, &solo, 1).owned / ranks as f64) as u64;
    let halo = memory::fullest_of(case, &solo, ranks).halo as u64;
    let sharing = Sharing {
        threads: 1,
        ranks_per_node: machine.ranks_per_node(1),
    };
    let bytes = bytes_of_messages(case);
    let peers = PEERS.min(ranks as u64 - 1);
    let sent = Traffic {
        messages: peers * (1 + bytes.len() as u64),
        bytes: halo * bytes.iter().sum::<usize>() as u64,
    };
    let beyond = if ranks > sharing.ranks_per_node {
        sent
    } else {
        Traffic::default()
    };
    let load = Load {
        tally: Tally {
            owned,
            halo,
            images: halo,
            peers,
        },
        sent,
        beyond,
        late: halo * bytes[1..].iter().sum::<usize>() as u64,
    };
    step_time(&vec![load; ranks], machine, sharing).all
}
