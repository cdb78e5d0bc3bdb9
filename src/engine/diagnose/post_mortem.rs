//! Surroundings of a particle that failed numerically: its neighbours on this rank, and the last
//! choices of steps.

use std::collections::VecDeque;

use super::ledger::RunState;
use numerics::vector::{minus, norm};
use particles::ParticleStore;

/// Neighbours told of.
const NEIGHBOURS: usize = 60;

/// A particle and what is about it, as the rank that owns it sees them.
#[derive(Debug, Clone, PartialEq)]
pub struct PostMortem {
    /// Steps done.
    pub step: u64,
    /// Time (s).
    pub time: f64,
    /// Identity of the particle.
    pub id: u64,
    /// The rank that owns it.
    pub rank: usize,
    /// The particle itself, then those nearest to it, by index into the store (halo particles come
    /// after owned ones).
    pub members: Vec<u32>,
    /// Their distances from it (m); not a number if its place is none.
    pub distances: Vec<f64>,
    /// The last choices of steps, oldest first.
    pub past_steps: Vec<PastStep>,
}

/// Choice of a step, for post-mortems.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PastStep {
    /// Steps done.
    pub step: u64,
    /// Step chosen (s).
    pub dt: f64,
    /// Limit that sets it.
    pub reason: &'static str,
    /// Id of the particle that requires it.
    pub id: u64,
}

/// Choices kept for post-mortems.
pub(crate) const PAST_STEPS: usize = 16;

impl PostMortem {
    /// Surroundings of the particle `id`, on the rank `rank` that owns it; nothing on others.
    /// Neighbours are looked for within `reach` (m).
    pub(crate) fn of(
        id: u64,
        rank: usize,
        particles: &ParticleStore,
        reach: f64,
        state: &RunState,
        past_steps: &VecDeque<PastStep>,
    ) -> Option<Self> {
        let owned = &particles.id[..particles.owned()];
        let i = owned.iter().position(|&x| x == id)?;
        let here = particles.position[i];
        let distance = |there: &[f64; 3]| norm(&minus(&here, there));
        // After a failure, not in every step.
        let all = (0_u32..).zip(particles.position.iter().map(distance));
        let mut others: Vec<(u32, f64)> = all
            .filter(|&(k, r)| k as usize != i && r <= reach)
            .collect();
        let order = |k: u32| particles.id[k as usize];
        others.sort_by(|a, b| a.1.total_cmp(&b.1).then(order(a.0).cmp(&order(b.0))));
        others.truncate(NEIGHBOURS);
        let (members, distances) = std::iter::once((u32::try_from(i).unwrap_or(0), 0.0))
            .chain(others)
            .unzip();
        Some(Self {
            step: state.step,
            time: state.time,
            id,
            rank,
            members,
            distances,
            past_steps: past_steps.iter().copied().collect(),
        })
    }
}
