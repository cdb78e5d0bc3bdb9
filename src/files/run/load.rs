//! Distribution of a run's work over its ranks.

use rayon::prelude::*;

use comm::Comm;
use engine::step::Simulation;
use particles::GRAIN;

/// Loads of the ranks, and their traffic.
pub struct Load {
    ranks: usize,
    /// Particles of all ranks, and of the one with the most.
    pub particles: [u64; 2],
    /// Load-balance weights of all ranks, and of the one with the most.
    pub work: [u64; 2],
    /// Ranks without particles.
    pub empty_ranks: u64,
    /// Messages sent so far.
    pub messages: u64,
    /// Bytes sent so far.
    pub bytes: u64,
    /// Updates of particles since the start of the process.
    pub updates: u64,
    /// Particles and work of each group of ranks, of single ones if there are few.
    groups: Vec<[u64; 2]>,
}

/// The load of consecutive ranks.
pub(super) struct Group {
    /// The first and the last of them.
    pub ranks: [u64; 2],
    /// Particles of all of them.
    pub particles: u64,
    /// Mean work of a rank of them over the mean of all ranks.
    pub work: f64,
}

/// Most groups of ranks.
const GROUPS: usize = 64;

impl Load {
    /// The largest value of a rank over the mean.
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    pub(super) fn imbalance(&self, [sum, most]: [u64; 2]) -> f64 {
        most as f64 * self.ranks as f64 / (sum as f64).max(1.0)
    }

    /// Number of ranks.
    pub(super) fn ranks(&self) -> usize {
        self.ranks
    }

    /// Groups of ranks in their order, [`GROUPS`] at most.
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    pub(super) fn by_group(&self) -> impl Iterator<Item = Group> {
        let groups = self.groups.len();
        let begin = move |group: usize| (group * self.ranks).div_ceil(groups);
        let mean = (self.work[0] as f64).max(1.0) / self.ranks as f64;
        let all = self.groups.iter().enumerate();
        all.map(move |(group, &[particles, work])| {
            let [first, end] = [begin(group), begin(group + 1)];
            Group {
                ranks: [first as u64, end as u64 - 1],
                particles,
                work: work as f64 / ((end - first) as f64 * mean),
            }
        })
    }

    /// Of ranks with equal work.
    #[cfg(test)]
    pub(super) fn of_equals(ranks: usize, work: u64) -> Self {
        let total = work * ranks as u64;
        Self {
            ranks,
            particles: [total, work],
            work: [total, work],
            empty_ranks: 0,
            messages: 0,
            bytes: 0,
            updates: 0,
            groups: vec![[work; 2]; ranks],
        }
    }
}

/// The load of all ranks. Collective.
pub fn load(comm: &Comm, simulation: &Simulation) -> Load {
    let particles = simulation.particles.owned() as u64;
    let work = &simulation.particles.work[..simulation.particles.owned()];
    let work = work.par_iter().with_min_len(GRAIN);
    // Whole numbers: the same bits in any order.
    let work: u64 = work.map(|&work| u64::from(work)).sum();
    let (messages, bytes) = simulation.traffic();
    let empty = u64::from(particles == 0);
    let groups = comm.size().min(GROUPS);
    let mut sums = vec![
        particles,
        work,
        messages,
        bytes,
        simulation.timers.updates,
        empty,
    ];
    let others = sums.len();
    sums.resize(others + 2 * groups, 0);
    let own = others + 2 * (comm.rank() * groups / comm.size());
    sums[own..own + 2].copy_from_slice(&[particles, work]);
    comm.sum_u64(&mut sums);
    let mut most = [particles, work];
    comm.max_u64(&mut most);
    Load {
        ranks: comm.size(),
        particles: [sums[0], most[0]],
        work: [sums[1], most[1]],
        messages: sums[2],
        bytes: sums[3],
        updates: sums[4],
        empty_ranks: sums[5],
        groups: sums[others..].as_chunks().0.to_vec(),
    }
}
