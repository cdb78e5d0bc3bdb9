//! Decomposition of a case for a number of ranks: particles and messages of each.

use super::outlook::Outlook;
use super::particles::Particles;
use crate::preflight::UNEVEN;
use comm::{Comm, Traffic};
use engine::domain::{
    Balance, EXTENT_MESSAGE, InitialLayout, NestedSlabs, RankSpeeds, Sent, Tally, extent_exchange,
    tally,
};
use engine::step::bytes_of_messages;
use model::Case;
use particles::Mirrors;
use populate;

/// Particles of a rank, and its messages in a step without particles that change ranks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Load {
    /// Particles that it owns and receives.
    pub tally: Tally,
    /// All messages that it sends.
    pub sent: Traffic,
    /// Those that leave its node.
    pub beyond: Traffic,
    /// Bytes of those that come after the motion, while there is work.
    pub late: u64,
}

/// Decomposition of a case for a number of ranks.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Regions of the ranks.
    pub slabs: NestedSlabs,
    /// Particles and messages of each rank.
    pub loads: Vec<Load>,
    /// Most particles of a rank over an even share of all as work is balanced.
    pub uneven: f64,
}

impl Layout {
    /// Of the initial particles, or of those at a time (s), with their prediction, for `ranks` ranks in slabs of `levels`
    /// levels, or of those that the case takes by itself, where `ranks_per_node` consecutive ranks share a node. `None` for
    /// a case without particles.
    #[must_use]
    pub fn new(
        case: &Case,
        particles: &Particles,
        time: Option<f64>,
        outlook: &Outlook,
        ranks: usize,
        levels: Option<usize>,
        ranks_per_node: usize,
    ) -> Option<Self> {
        let cut = if time.is_none() {
            slabs_at_start
        } else {
            slabs_of
        };
        let slabs = cut(case, particles, ranks, levels)?;
        let loads = loads(case, particles, &slabs, ranks_per_node);
        let uneven = uneven(case, particles, &slabs, outlook);
        Some(Self {
            slabs,
            loads,
            uneven,
        })
    }
}

/// The slabs that a run begins with on `ranks` ranks, of `levels` levels or as many as the case takes by itself.
///
/// `None` for a case without particles.
#[must_use]
pub fn slabs_at_start(
    case: &Case,
    particles: &Particles,
    ranks: usize,
    levels: Option<usize>,
) -> Option<NestedSlabs> {
    let (solo, layout) = (Comm::solo(), InitialLayout::new(case)?);
    let mut balance = Balance::default();
    let mut slabs = layout.slabs(case, &solo, (ranks, levels), &mut balance);
    // As a run does after it has distributed particles outside of the slabs that they were made in.
    if ranks > 1 && case.bodies.iter().any(populate::moves_sites) {
        cut(&mut slabs, particles, &mut balance);
    }
    Some(slabs)
}

/// The slabs that a run continues with from some particles.
///
/// `None` for a case without particles.
#[must_use]
pub fn slabs_of(
    case: &Case,
    particles: &Particles,
    ranks: usize,
    levels: Option<usize>,
) -> Option<NestedSlabs> {
    let layout = InitialLayout::new(case)?;
    let (all, balance) = (
        (particles.positions.as_slice(), particles.reach.as_slice()),
        &mut Balance::default(),
    );
    Some(layout.slabs_of(case, &Comm::solo(), (ranks, levels), all, balance))
}

/// Moves faces so that each rank has as many particles.
fn cut(slabs: &mut NestedSlabs, particles: &Particles, balance: &mut Balance) {
    let work = vec![1; particles.positions.len()];
    let all = (particles.positions.as_slice(), work.as_slice());
    balance.cut(&Comm::solo(), slabs, all, &RankSpeeds::default());
}

/// Most particles of a rank over an even share of all, as work is balanced.
#[allow(clippy::cast_precision_loss, reason = "a ratio")]
fn uneven(case: &Case, particles: &Particles, slabs: &NestedSlabs, outlook: &Outlook) -> f64 {
    let ranks = slabs.ranks();
    if case.domain.balance_every == 0 || ranks < 2 {
        return 1.0;
    }
    let Some(works) = outlook.works() else {
        return UNEVEN;
    };
    let (mut slabs, mut balance) = (slabs.clone(), Balance::default());
    let each = particles.positions.len() as f64 / ranks as f64;
    let positions = particles.positions.as_slice();
    let mut last = (Vec::new(), 0.0);
    let most = works.map(|work| {
        if work == last.0 {
            return last.1;
        }
        balance.cut(
            &Comm::solo(),
            &mut slabs,
            (positions, &work),
            &RankSpeeds::default(),
        );
        let mut owned = vec![0_u64; ranks];
        for &owner in balance.owners(&slabs, positions) {
            owned[owner as usize] += 1;
        }
        let most = owned.into_iter().max();
        last = (work, most.unwrap_or(0) as f64 / each);
        last.1
    });
    most.fold(UNEVEN, f64::max)
}

/// Particles and messages of each rank in a step, where `ranks_per_node` consecutive ranks share a node.
#[must_use]
pub fn loads(
    case: &Case,
    particles: &Particles,
    slabs: &NestedSlabs,
    ranks_per_node: usize,
) -> Vec<Load> {
    let bytes = bytes_of_messages(case);
    loads_of(case, particles, slabs, ranks_per_node, &bytes)
}

/// As [`loads`] with messages of `bytes` a halo particle: a search has the first of those of a step alone.
#[must_use]
pub fn loads_of(
    case: &Case,
    particles: &Particles,
    slabs: &NestedSlabs,
    ranks_per_node: usize,
    bytes: &[usize],
) -> Vec<Load> {
    let mirrors = Mirrors::of(case);
    let mut loads = vec![Load::default(); slabs.ranks()];
    let all = (particles.positions.as_slice(), particles.reach.as_slice());
    let mut send = |from: usize, to: usize, traffic: Traffic, late: u64| {
        let load: &mut Load = &mut loads[from];
        load.sent += traffic;
        load.late += late;
        if from / ranks_per_node != to / ranks_per_node {
            load.beyond += traffic;
        }
    };
    let late: usize = bytes[1..].iter().sum();
    let tallies = tally(slabs, &mirrors, all, |sent| {
        let late = sent.particles * late as u64;
        send(sent.from, sent.to, traffic_of(sent, bytes), late);
    });
    let farthest = particles.reach.iter().copied().fold(0.0, f64::max);
    extent_exchange(slabs, farthest, |from, to| {
        send(from, to, Traffic::of(EXTENT_MESSAGE), 0);
    });
    for (load, tally) in loads.iter_mut().zip(tallies) {
        load.tally = tally;
    }
    loads
}

/// Traffic of a rank to a peer in a step: a size, then messages of `bytes` a particle.
fn traffic_of(sent: Sent, bytes: &[usize]) -> Traffic {
    let mut traffic = Traffic::OF_SIZE;
    for &bytes in bytes {
        traffic += Traffic::of(sent.particles * bytes as u64);
    }
    traffic
}
