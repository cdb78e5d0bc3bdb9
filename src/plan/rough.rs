//! What a run takes, from counts along the axes alone: soon told of any number of particles.

use super::layout::Load;
use super::machine::Machine;
use super::model::step_time;
use super::sharing::Sharing;
use crate::comm::{Comm, Traffic};
use crate::domain::Tally;
use crate::model::Case;
use crate::preflight::{self, Waves, memory};
use crate::step::bytes_of_messages;

/// Peers of a rank in boxes: those around a box of three axes.
const PEERS: u64 = 26;

/// Steps of a case from a time (s) on, as far as they are foreseen.
#[must_use]
#[allow(clippy::cast_precision_loss, reason = "for people")]
pub fn expected_steps(case: &Case, time: f64) -> Option<f64> {
    let by_time = preflight::expected_steps(case, time)?;
    let most = case.run.max_steps.map_or(f64::INFINITY, |most| most as f64);
    Some(by_time.min(most).round())
}

/// Work of the steps from a time (s) on, over what it would be if all matter moved.
#[must_use]
pub fn share_of_work(case: &Case, time: f64) -> f64 {
    Waves::new(case).map_or(1.0, |waves| waves.share_of_work(case, time))
}

/// Seconds of a mean step on so many ranks of a machine, each with one thread and as much to do.
#[must_use]
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "counts of particles"
)]
pub fn rough_step(case: &Case, ranks: usize, machine: &Machine) -> f64 {
    let machine = machine.clone().sparing(share_of_work(case, 0.0));
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
    };
    step_time(&vec![load; ranks], &machine, sharing).all
}
