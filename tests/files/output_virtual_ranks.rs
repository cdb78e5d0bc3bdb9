//! The way of particles to rows in id order, on virtual ranks: what comes where, and in how many
//! messages.

use crate::common::sentinel::{id, mix};
use comm::{Comm, Machine, virtual_ranks};
use files::output::{Block, Rows};
use model::Sharing;

/// Numbers of ranks: one group, primes, squares, many.
const RANKS: [usize; 7] = [1, 2, 3, 7, 16, 64, 300];

/// Bytes of a row.
const ROW: usize = 24;

/// Who owns which particles.
#[derive(Debug, Clone, Copy)]
enum Owners {
    /// Any rank but rank 1.
    Scattered,
    /// Ranks own ids in a row, as slabs do along the axis that ids run along.
    Slabs,
    /// Slabs of slabs where ids run along the second axis.
    Across,
    /// The last rank owns all.
    Lone,
}

impl Owners {
    /// The owner of the k-th particle of so many.
    fn of(self, k: u64, total: u64, ranks: usize) -> usize {
        let ranks = ranks as u64;
        let slab = k * ranks / total;
        let owner = match self {
            Self::Scattered if mix(k) % ranks == 1 => 0,
            Self::Scattered => mix(k) % ranks,
            Self::Slabs => slab,
            Self::Across => {
                let side = ranks.isqrt();
                k % side * side + k * side / total
            }
            Self::Lone => ranks - 1,
        };
        usize::try_from(owner).unwrap()
    }

    /// The id of the k-th particle.
    fn id(self, k: u64) -> u64 {
        match self {
            Self::Scattered | Self::Lone => id(k),
            Self::Slabs | Self::Across => 3 << 40 | k << 8,
        }
    }
}

/// What a field has for a particle.
fn row(id: u64) -> [u8; ROW] {
    bytemuck::cast([id, mix(id), mix(id + 1)])
}

/// Particles of all ranks, and how they are written.
#[derive(Debug, Clone, Copy)]
struct Job {
    owners: Owners,
    total: u64,
    writers: Option<usize>,
    /// One particle of so many has no row.
    left_out: Option<u64>,
}

/// What a rank has sent: messages of a plan, and messages and bytes of a field.
#[derive(Debug, Clone, Copy)]
struct Sent {
    plan: u64,
    field: u64,
    bytes: u64,
}

/// Brings the rows of all ranks to their blocks and compares with what stands there.
fn check(comm: &Comm, rows: &mut Rows, job: Job) -> Sent {
    let Job { owners, total, .. } = job;
    let (me, ranks) = (comm.rank(), comm.size());
    let is_chosen = |k: u64| job.left_out.is_none_or(|every| !k.is_multiple_of(every));
    let mine: Vec<u64> = (0..total)
        .filter(|&k| owners.of(k, total, ranks) == me)
        .collect();
    let ids: Vec<u64> = mine.iter().map(|&k| owners.id(k)).collect();
    let values: Vec<u8> = ids.iter().flat_map(|&id| row(id)).collect();
    let chosen = (0_u32..).zip(&mine).filter(|(_, k)| is_chosen(**k));
    let sent = || {
        let time = comm.virtual_time().unwrap();
        (time.messages, time.bytes)
    };
    let begin = sent();
    rows.plan_of(comm, &ids, chosen.map(|(i, _)| i)).unwrap();
    let planned = sent();
    let mut all: Vec<u64> = (0..total).filter(|&k| is_chosen(k)).collect();
    for k in &mut all {
        *k = owners.id(*k);
    }
    all.sort_unstable();
    let writers = job.writers.unwrap_or(ranks).min(ranks);
    let block = Block::shared(all.len() as u64, me, ranks, writers);
    assert_eq!(rows.block(), block, "{ranks} {job:?}");
    let first = usize::try_from(block.first).unwrap();
    let here = &all[first..first + block.count];
    let expected: Vec<u8> = here.iter().flat_map(|&id| row(id)).collect();
    let collected = rows.collect(comm, &values, ROW);
    assert!(collected.all() == expected, "{ranks} {job:?}");
    let end = sent();
    Sent {
        plan: planned.0 - begin.0,
        field: end.0 - planned.0,
        bytes: end.1 - planned.1,
    }
}

/// Jobs of so many ranks.
fn jobs(ranks: usize) -> Vec<Job> {
    let many = 40 * ranks as u64;
    let job = |owners, total| Job {
        owners,
        total,
        writers: None,
        left_out: None,
    };
    let scattered = |writers, left_out| Job {
        writers: Some(writers),
        left_out,
        ..job(Owners::Scattered, many)
    };
    vec![
        job(Owners::Scattered, 0),
        job(Owners::Scattered, 5),
        job(Owners::Scattered, many),
        job(Owners::Slabs, many),
        job(Owners::Across, many),
        job(Owners::Lone, many),
        scattered(1, None),
        scattered(ranks.div_ceil(3), Some(3)),
    ]
}

#[test]
#[allow(clippy::cast_precision_loss, reason = "small numbers")]
fn all_rows_come_to_their_blocks_in_few_messages() {
    for ranks in RANKS {
        let shares = virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let mut sent = Vec::new();
            let mut kept = Rows::new(Sharing {
                writers: Some(ranks),
                ..Sharing::default()
            });
            for job in jobs(ranks) {
                let mut rows = Rows::new(Sharing {
                    writers: job.writers,
                    ..Sharing::default()
                });
                let rows = if job.writers.is_some() {
                    &mut rows
                } else {
                    &mut kept
                };
                sent.push(check(comm, rows, job));
            }
            sent
        });
        let most = 2.0 * (ranks as f64).sqrt();
        for (k, job) in jobs(ranks).into_iter().enumerate() {
            for sent in shares.iter().map(|share| share[k]) {
                assert!(sent.field as f64 <= most, "{ranks} {job:?}: {sent:?}");
                // It tells how many rows there are, and their ids.
                assert!(sent.plan as f64 <= 2.0 * most, "{ranks} {job:?}: {sent:?}");
            }
            // What passes through a rank is no more than a few times what is its own.
            let bytes = shares.iter().map(|share| share[k].bytes).max().unwrap();
            let own = job.total.div_ceil(ranks as u64) * ROW as u64;
            if matches!(job.owners, Owners::Slabs | Owners::Across) {
                assert!(bytes <= 7 * own, "{ranks} {job:?}: {bytes} of {own}");
            }
        }
    }
}

#[test]
fn ids_of_two_particles_are_refused_by_every_rank() {
    for ranks in [3, 30] {
        virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let me = comm.rank() as u64;
            let ids: Vec<u64> = (0..4).map(|k| id(4 * me + k)).collect();
            let mut twice = ids.clone();
            twice[2] = id(9);
            let mut rows = Rows::default();
            assert!(rows.plan(comm, &ids).is_ok());
            let error = rows.plan(comm, &twice).unwrap_err().to_string();
            assert!(error.starts_with("two particles have the id"), "{error}");
            assert!(rows.plan(comm, &ids).is_ok());
        });
    }
}
