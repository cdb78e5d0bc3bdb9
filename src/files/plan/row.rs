//! A row of a plan: a number of ranks in slabs of some levels.

use super::layout::{Layout, Load};
use super::machine::Machine;
use super::model::{StepTime, step_time};
use super::particles::Particles;
use super::sharing::Sharing;
use crate::preflight::Costs;
use engine::domain::{Decomposition, NestedSlabs};
use populate::Brick;

/// Figures of a number of ranks.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Row {
    /// Number of ranks.
    pub ranks: usize,
    /// Their threads and nodes.
    pub sharing: Sharing,
    /// Levels of their slabs.
    pub levels: usize,
    /// Mean and largest number of particles.
    pub owned: [f64; 2],
    /// Most particles of other ranks.
    pub halo: f64,
    /// Number of these if particles as dense filled the model around that rank.
    pub halo_of_box: f64,
    /// Most peers.
    pub peers: f64,
    /// Most messages that a rank sends in a step.
    pub messages: f64,
    /// Most bytes that a rank sends in a step.
    pub bytes: f64,
    /// Bytes that the largest rank takes.
    pub memory: f64,
    /// Time of a step.
    pub time: StepTime,
    /// Time of one core with all particles over the time of all cores.
    pub efficiency: f64,
}

impl Row {
    /// Of particles that are distributed over ranks, all of which are the `work` of one core (s a step).
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    pub fn new(
        particles: &Particles,
        layout: &Layout,
        machine: &Machine,
        sharing: Sharing,
        costs: Costs,
        work: f64,
    ) -> Self {
        let (slabs, loads) = (&layout.slabs, layout.loads.as_slice());
        let ranks = loads.len();
        let most = |value: fn(&Load) -> u64| loads.iter().map(value).max().unwrap_or(0) as f64;
        let mean = particles.positions.len() as f64 / ranks as f64;
        let memory = loads.iter().map(|load| {
            let [owned, halo] = [load.tally.owned, load.tally.halo].map(|count| count as f64);
            costs.of(owned.max(mean * layout.uneven), halo)
        });
        let time = step_time(loads, machine, sharing);
        let halos = loads.iter().map(|load| load.tally.halo).enumerate();
        let largest = halos.max_by_key(|&(rank, halo)| (halo, ranks - rank));
        let (rank, halo) = largest.unwrap_or((0, 0));
        Self {
            ranks,
            sharing,
            levels: slabs.levels(),
            owned: [mean, most(|load| load.tally.owned)],
            halo: halo as f64,
            halo_of_box: halo_of_box(particles, slabs, rank) * loads[rank].tally.owned as f64,
            peers: most(|load| load.tally.peers),
            messages: most(|load| load.sent.messages),
            bytes: most(|load| load.sent.bytes),
            memory: memory.fold(0.0, f64::max),
            time,
            efficiency: work / (time.all * (ranks * sharing.threads) as f64),
        }
    }

    /// Bytes that the ranks of a node take, each as much as the largest.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "few ranks")]
    pub fn memory_of_node(&self) -> f64 {
        self.memory * self.ranks.min(self.sharing.ranks_per_node) as f64
    }

    /// The most particles of a rank over the mean.
    #[must_use]
    pub fn imbalance(&self) -> f64 {
        self.owned[1] / self.owned[0]
    }
}

/// Particles around the region of a rank within the range of two particles, over those in it, in a box
/// around all particles that is filled evenly.
fn halo_of_box(particles: &Particles, slabs: &NestedSlabs, rank: usize) -> f64 {
    let mut all = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for position in &particles.positions {
        for a in 0..3 {
            all.0[a] = all.0[a].min(position[a]);
            all.1[a] = all.1[a].max(position[a]);
        }
    }
    let reach = particles.reach.iter().copied().fold(0.0, f64::max);
    let region = slabs.region(rank);
    // An axis along which there is but one layer does not count.
    let axes = (0..3).filter(|&a| all.1[a] > all.0[a]);
    // A slab has at least one layer.
    let length = |brick: &Brick, a: usize| {
        let length = brick.upper[a].min(all.1[a]) - brick.lower[a].max(all.0[a]);
        length.max(reach)
    };
    let wider = region.widened(2.0 * reach);
    let ratio: f64 = axes
        .map(|a| length(&wider, a) / length(&region, a))
        .product();
    if ratio.is_finite() { ratio - 1.0 } else { 0.0 }
}
