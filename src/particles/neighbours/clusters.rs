//! Lists of the own group's neighbours for clusters of eight receivers.

use std::cell::RefCell;
use std::ops::Range;

use rayon::prelude::*;

use super::close::CloseLists;
use super::cluster::{Among, Cluster, Lists, around};
use super::facts::{HALO, MIRROR, MOVING};
use super::foreign::GroupRanges;
use super::fragments::{Membership, Split};
use super::gather::Gatherer;
use super::near::{INFLATION, near_box, push_places};
use super::pairs::PairList;
use super::sequence::Sequence;
use super::watch::Watch;
use numerics::dispatch::{Vectorised, instructions};
use numerics::lanes::{LANES, Lanes};

/// Clusters and neighbour lists of one task.
#[derive(Debug, Clone, Default)]
pub struct Chunk {
    group: usize,
    /// The part of the sequence whose particles are receivers here.
    indices: Range<usize>,
    gatherer: Gatherer,
    lists: Lists,
    /// Neighbours that [`ClusterLists::part`] has taken out of them; empty without self-contact.
    split: Split,
    /// What each lane itself sums, where [`ClusterLists::list_close`] has listed that.
    close: CloseLists,
}

impl Chunk {
    /// What the lanes of the cluster of this number have to sum, as places in its list, row by row; empty where that is not listed.
    #[inline]
    #[must_use]
    pub fn close(&self, cluster: usize) -> &[[u16; LANES]] {
        self.close.of(cluster)
    }

    /// The clusters, each with its neighbours in canonical order and what is among those.
    pub fn iter(&self) -> impl Iterator<Item = (&Cluster, &[u32], Among)> {
        self.lists.iter()
    }

    /// Receivers whose strangers [`ClusterLists::part`] has taken out of the lists, with these.
    pub(super) fn strangers(&self) -> &PairList {
        &self.split.strangers
    }
}

/// Smoothing lengths of a group.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// Largest smoothing length among its images (m).
    pub longest: f64,
    /// Least range of lists (m): that of self-contact, which does not follow h; else zero.
    pub least: f64,
    /// Range of lists over the sum of both smoothing lengths: more than one for self-contact of
    /// unequal particles, which has no least range.
    pub stretch: f64,
    /// True if all its images have that length.
    pub uniform: bool,
    /// True if it is a rigid body, whose particles need no neighbours of their own.
    pub rigid: bool,
}

impl Lengths {
    /// The longest range of a list (m).
    #[inline(always)]
    pub(super) fn range(&self) -> f64 {
        (2.0 * self.longest).max(self.least) * self.stretch * INFLATION
    }
}

/// Gathers the clusters of a chunk and lists their neighbours.
struct Build<'a> {
    chunk: &'a mut Chunk,
    /// Group of the neighbours.
    sources: usize,
    sequence: &'a Sequence,
    lengths: Lengths,
    ranges: Option<&'a GroupRanges>,
    spared: bool,
}

impl Vectorised for Build<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let Chunk {
            group,
            indices,
            gatherer,
            lists:
                Lists {
                    clusters,
                    ends,
                    neighbours,
                },
            split: _,
            close,
        } = self.chunk;
        close.clear();
        let (sequence, lengths) = (self.sequence, self.lengths);
        let Lengths {
            longest,
            least,
            stretch,
            uniform,
            rigid,
        } = lengths;
        gatherer.gather(sequence, *group, indices.clone(), 2.0 * longest, clusters);
        ends.clear();
        if rigid {
            ends.resize(clusters.len(), (0, Among::default()));
            return;
        }
        let mut lister = Lister {
            sequence,
            sources: self.sources,
            longest,
            least,
            inflation: stretch * INFLATION,
            list: neighbours,
            used: 0,
            hints: [0; 64],
        };
        let (lower, upper) = around(clusters.iter());
        let far = lengths.range();
        let contact = self.ranges.map_or(0.0, GroupRanges::longest) * INFLATION;
        let mut groups = GROUPS.take();
        sequence.list_groups_near((&lower, &upper), 2.0 * far + contact, &mut groups);
        let mut watch = Watch {
            sequence,
            group: *group,
            ranges: self.ranges,
            groups: &groups,
            far,
            hints: [0; 64],
        };
        for run in runs(clusters, LONG * watch.far) {
            let rests = watch.rests::<V>(run);
            for cluster in run {
                let mut among = match (rests && self.spared, uniform) {
                    (true, _) => Among::RESTING,
                    (false, true) => lister.list::<V, true>(cluster),
                    (false, false) => lister.list::<V, false>(cluster),
                };
                among.resting = rests;
                #[allow(clippy::cast_possible_truncation, reason = "a chunk's lists fit u32")]
                ends.push((lister.used as u32, among));
            }
        }
        GROUPS.set(groups);
    }
}

thread_local! {
    /// Groups of which images are near a chunk, for one after the other.
    static GROUPS: RefCell<Vec<usize>> = RefCell::default();
}

/// Clusters in a row that are looked at together, whether they rest.
const RUN: usize = 8;
/// Longest extent of a run, in ranges of lists: columns have gaps where some are inactive.
const LONG: f64 = 5.0;

/// Such runs of clusters, no longer (m) than that along any axis if there is more than one in them.
#[inline(always)]
fn runs(mut left: &[Cluster], longest: f64) -> impl Iterator<Item = &[Cluster]> {
    std::iter::from_fn(move || {
        left.first()?;
        let (run, others) = left.split_at(run_of(left, longest));
        left = others;
        Some(run)
    })
}

/// Number of the first clusters that make a run.
#[inline(always)]
fn run_of(clusters: &[Cluster], longest: f64) -> usize {
    let (mut lower, mut upper) = (clusters[0].lower, clusters[0].upper);
    let fits = |cluster: &&Cluster| {
        for a in 0..3 {
            lower[a] = lower[a].min(cluster.lower[a]);
            upper[a] = upper[a].max(cluster.upper[a]);
        }
        (0..3).all(|a| upper[a] - lower[a] <= longest)
    };
    1 + clusters[1..].iter().take(RUN - 1).take_while(fits).count()
}

/// Writes the lists of a chunk one after the other.
struct Lister<'a> {
    sequence: &'a Sequence,
    sources: usize,
    longest: f64,
    least: f64,
    inflation: f64,
    list: &'a mut Vec<u32>,
    used: usize,
    /// Place at which the last cluster began to read a column, by the last bits of the column's
    /// indices: the next one begins near it.
    hints: [usize; 64],
}

impl Lister<'_> {
    #[inline(always)]
    fn list<V: Lanes, const UNIFORM: bool>(&mut self, cluster: &Cluster) -> Among {
        let own = if UNIFORM {
            self.longest
        } else {
            cluster.longest(self.sequence.smoothing_lengths())
        };
        let range = |h: f64| (own + h).max(self.least) * self.inflation;
        let bounds = (&cluster.lower, &cluster.upper);
        let far = if UNIFORM {
            range(self.longest)
        } else {
            let all = range(self.longest);
            self.sequence.reach(self.sources, bounds, (own, all), range)
        };
        let mut special = 0;
        near_box(
            self.sequence,
            self.sources,
            bounds,
            far,
            &mut self.hints,
            |eight| {
                if UNIFORM {
                    return V::splat(far);
                }
                let both = V::read(eight.lengths).add(V::splat(own));
                both.max(V::splat(self.least)).mul(V::splat(self.inflation))
            },
            |first, bits, eight, _| {
                special |= u64::from_le_bytes(*eight.special) & SPREAD[bits as usize];
                self.used = push_places(self.list, self.used, first, bits);
            },
        );
        // The flags of eight lanes into one byte.
        let special = special | special >> 32;
        let special = special | special >> 16;
        let special = special | special >> 8;
        Among {
            mirrors: special & u64::from(MIRROR) != 0,
            halo: special & u64::from(HALO) != 0,
            moving: special & u64::from(MOVING) != 0,
            parted: false,
            resting: false,
        }
    }
}

/// For each set of bits, a full byte for each member.
static SPREAD: [u64; 256] = {
    let mut table = [0; 256];
    let mut bits = 0;
    while bits < 256 {
        let mut k = 0;
        while k < 8 {
            if bits >> k & 1 == 1 {
                table[bits] |= 0xff << (8 * k);
            }
            k += 1;
        }
        bits += 1;
    }
    table
};

/// All clusters of a rank with their lists. Buffers are kept from step to step.
#[derive(Debug, Clone, Default)]
pub struct ClusterLists {
    chunks: Vec<Chunk>,
    used: usize,
    /// Number of groups that the bodies form, if there are stress points.
    body_groups: Option<usize>,
    /// By group: whether its particles are no receivers; empty where all are.
    left_out: Vec<bool>,
}

/// Images whose clusters one task handles: many enough that the tasks cost nothing, few enough
/// that they are even.
const PLACES_PER_CHUNK: usize = 512;
/// Chunks that a thread takes at once, at most: their work differs.
pub const CHUNKS_AT_ONCE: usize = 4;

impl ClusterLists {
    /// Lists of neighbours of the own group; where there are stress points, which come in as many
    /// groups after `body_groups` of bodies, those of the other set of the same bodies.
    #[must_use]
    pub fn new(body_groups: Option<usize>) -> Self {
        Self {
            body_groups,
            ..Self::default()
        }
    }

    /// Particles of these groups are no receivers, from the next call of [`Self::build`] on.
    pub(super) fn leave_out(&mut self, groups: &[bool]) {
        self.left_out.resize(groups.len(), false);
        self.left_out.copy_from_slice(groups);
    }

    /// Groups this rank's own particles into clusters and lists the neighbours of each.
    /// `lengths` are the smoothing lengths of each group. Clusters rest that are among what
    /// rests and far from other groups, by the `ranges` of contact, if there is any contact. They get empty lists if these
    /// are `spared`.
    pub fn build(
        &mut self,
        sequence: &Sequence,
        lengths: &[Lengths],
        (ranges, spared): (Option<&GroupRanges>, bool),
    ) {
        let set = instructions();
        self.lay_out(sequence);
        let sources_of = |group: usize| match self.body_groups {
            None => group,
            Some(count) if group < count => group + count,
            Some(count) => group - count,
        };
        let chunks = self.chunks[..self.used].par_iter_mut();
        chunks.with_max_len(CHUNKS_AT_ONCE).for_each(|chunk| {
            set.run(Build {
                lengths: lengths[chunk.group],
                sources: sources_of(chunk.group),
                chunk: &mut *chunk,
                sequence,
                ranges,
                spared,
            });
            chunk.lists.fit();
        });
    }

    /// Lists for each receiver by itself which of its cluster's neighbours it sums: `near` writes for each neighbour of a
    /// cluster a byte with a bit for each lane that does.
    pub(super) fn list_close(&mut self, near: impl Fn(&Cluster, &[u32], &mut Vec<u8>) + Sync) {
        let chunks = self.chunks[..self.used].par_iter_mut();
        chunks.with_max_len(CHUNKS_AT_ONCE).for_each(|chunk| {
            let Chunk { lists, close, .. } = chunk;
            close.clear();
            for (cluster, list, _) in lists.iter() {
                close.push(cluster, list, &near);
            }
            close.fit();
        });
    }

    /// Takes strangers out of the lists. They become foreign neighbours.
    pub fn part(&mut self, membership: &Membership) {
        let chunks = self.chunks[..self.used].par_iter_mut();
        chunks
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|chunk| chunk.split.part(membership, &mut chunk.lists));
    }

    /// Lets clusters of sparse matter share their lanes; after [`Self::part`].
    pub fn join(&mut self) {
        let chunks = self.chunks[..self.used].par_iter_mut();
        chunks
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|chunk| chunk.lists.join());
    }

    /// The tasks, for parallel iteration.
    #[must_use]
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks[..self.used]
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.chunks
            .iter()
            .map(|chunk| {
                size_of::<Chunk>()
                    + chunk.lists.memory()
                    + chunk.gatherer.memory()
                    + chunk.split.memory()
                    + chunk.close.memory()
            })
            .sum()
    }

    fn lay_out(&mut self, sequence: &Sequence) {
        self.used = 0;
        for group in 0..sequence.groups() {
            if self.left_out.get(group).is_some_and(|&left_out| left_out) {
                continue;
            }
            let Range { start, end } = sequence.group(group);
            for first in (start..end).step_by(PLACES_PER_CHUNK) {
                if self.used == self.chunks.len() {
                    self.chunks.push(Chunk::default());
                }
                let chunk = &mut self.chunks[self.used];
                chunk.group = group;
                chunk.indices = first..end.min(first + PLACES_PER_CHUNK);
                self.used += 1;
            }
        }
    }
}
