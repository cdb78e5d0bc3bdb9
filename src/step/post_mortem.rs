//! What is about a particle in trouble: its neighbours on this rank, and the last votes.

use super::simulation::Simulation;
use super::trouble::PastVote;

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
    /// The last votes, oldest first.
    pub votes: Vec<PastVote>,
}

impl Simulation {
    /// What is about the particle `id`, on the rank `rank` that owns it; nothing on others.
    #[must_use]
    pub fn post_mortem(&self, id: u64, rank: usize) -> Option<PostMortem> {
        let store = &self.store;
        let i = store.id[..store.owned()].iter().position(|&x| x == id)?;
        let here = store.position[i];
        let distance = |there: &[f64; 3]| {
            let d: [f64; 3] = std::array::from_fn(|a| here[a] - there[a]);
            (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
        };
        let reach = 4.0
            * self
                .reference_h
                .iter()
                .fold(0.0_f64, |most, &h| most.max(h));
        let all = (0_u32..).zip(store.position.iter().map(distance));
        let mut others: Vec<(u32, f64)> = all
            .filter(|&(k, r)| k as usize != i && r <= reach)
            .collect();
        let order = |k: u32| store.id[k as usize];
        others.sort_by(|a, b| a.1.total_cmp(&b.1).then(order(a.0).cmp(&order(b.0))));
        others.truncate(NEIGHBOURS);
        let (members, distances) = std::iter::once((u32::try_from(i).unwrap_or(0), 0.0))
            .chain(others)
            .unzip();
        Some(PostMortem {
            step: self.state.step,
            time: self.state.time,
            id,
            rank,
            members,
            distances,
            votes: self.votes.iter().copied().collect(),
        })
    }
}
