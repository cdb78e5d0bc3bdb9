//! Lists of the own group's neighbours for clusters of eight receivers.

use std::ops::Range;

use rayon::prelude::*;

use super::gather::Gatherer;
use super::parts::Parted;
use super::sequence::{Eight, HALO, MIRROR, MOVING, Sequence};
use crate::numerics::dispatch::{Vectorised, instructions};
use crate::numerics::lanes::{LANES, Lanes};

/// Up to eight owned particles of one group that stand side by side.
#[derive(Debug, Clone, Copy)]
pub struct Cluster {
    /// Places in the sequence, ascending; unused lanes repeat the last valid one.
    pub receivers: [u32; LANES],
    /// Valid lanes.
    pub lanes: usize,
    /// Group of bodies.
    pub group: usize,
    /// Box around the receivers (m).
    pub lower: [f64; 3],
    /// Upper end of the box (m).
    pub upper: [f64; 3],
}

/// What is among the neighbours of a cluster.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Among {
    /// Images behind symmetry planes.
    pub mirrors: bool,
    /// Particles of other ranks.
    pub halo: bool,
    /// Anything that is not at the group's common velocity.
    pub moving: bool,
}

/// Clusters and neighbour lists of one task.
#[derive(Debug, Clone, Default)]
pub struct Chunk {
    group: usize,
    /// The part of the sequence whose particles are receivers here.
    places: Range<usize>,
    gatherer: Gatherer,
    clusters: Vec<Cluster>,
    /// End of each cluster's neighbours in `neighbours`, and what is among them.
    ends: Vec<(u32, Among)>,
    /// The lists one after the other, and unused space.
    neighbours: Vec<u32>,
    /// What [`ClusterLists::part`] has taken out of them; empty without self-contact.
    pub(super) parted: Parted,
}

impl Chunk {
    /// Exchanges the lists for others.
    pub(super) fn swap(
        &mut self,
        clusters: &mut Vec<Cluster>,
        ends: &mut Vec<(u32, Among)>,
        neighbours: &mut Vec<u32>,
    ) {
        std::mem::swap(&mut self.clusters, clusters);
        std::mem::swap(&mut self.ends, ends);
        std::mem::swap(&mut self.neighbours, neighbours);
    }

    /// The clusters, each with its neighbours in canonical order and what is among those.
    pub fn iter(&self) -> impl Iterator<Item = (&Cluster, &[u32], Among)> {
        self.clusters.iter().enumerate().map(|(k, cluster)| {
            let start = if k == 0 { 0 } else { self.ends[k - 1].0 };
            let (end, among) = self.ends[k];
            (
                cluster,
                &self.neighbours[start as usize..end as usize],
                among,
            )
        })
    }
}

/// Smoothing lengths of a group.
#[derive(Debug, Clone, Copy, Default)]
pub struct Lengths {
    /// Largest smoothing length among its images (m).
    pub longest: f64,
    /// Least range of lists (m): that of self-contact, which does not follow h; else zero.
    pub least: f64,
    /// Whether all its images have that length.
    pub uniform: bool,
    /// Whether it is a rigid body, whose particles need no neighbours of their own.
    pub rigid: bool,
}

/// Gathers the clusters of a chunk and lists their neighbours.
struct Build<'a> {
    chunk: &'a mut Chunk,
    /// Group of the neighbours.
    sources: usize,
    sequence: &'a Sequence,
    lengths: Lengths,
}

impl Vectorised for Build<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let Chunk {
            group,
            places,
            gatherer,
            clusters,
            ends,
            neighbours,
            parted: _,
        } = self.chunk;
        let (sequence, lengths) = (self.sequence, self.lengths);
        let Lengths {
            longest,
            least,
            uniform,
            rigid,
        } = lengths;
        gatherer.gather(sequence, *group, places.clone(), 2.0 * longest, clusters);
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
            list: neighbours,
            used: 0,
            hints: [0; 64],
        };
        for cluster in clusters.iter() {
            let among = if uniform {
                lister.list::<V, true>(cluster)
            } else {
                lister.list::<V, false>(cluster)
            };
            #[allow(clippy::cast_possible_truncation, reason = "a chunk's lists fit u32")]
            ends.push((lister.used as u32, among));
        }
    }
}

/// Writes the lists of a chunk one after the other.
struct Lister<'a> {
    sequence: &'a Sequence,
    sources: usize,
    longest: f64,
    least: f64,
    list: &'a mut Vec<u32>,
    used: usize,
    /// Where the last cluster began to read a column, by the last bits of the column's indices:
    /// the next one begins near it.
    hints: [usize; 64],
}

impl Lister<'_> {
    #[inline(always)]
    fn list<V: Lanes, const UNIFORM: bool>(&mut self, cluster: &Cluster) -> Among {
        let lengths = self.sequence.smoothing_lengths();
        let own = if UNIFORM {
            self.longest
        } else {
            let longer = |h, &i: &u32| f64::max(h, lengths[i as usize]);
            cluster.receivers.iter().fold(0.0, longer)
        };
        let far = (own + self.longest).max(self.least) * INFLATION;
        let mut special = 0;
        near_box(
            self.sequence,
            self.sources,
            (&cluster.lower, &cluster.upper),
            far,
            &mut self.hints,
            |eight| {
                if UNIFORM {
                    return V::splat(far);
                }
                let both = V::read(eight.lengths).add(V::splat(own));
                both.max(V::splat(self.least)).mul(V::splat(INFLATION))
            },
            |first, bits, eight| {
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
        }
    }
}

/// Writes `first + k` for each set bit k at `list[used..]`; returns the new end.
#[inline(always)]
pub(super) fn push_places(list: &mut Vec<u32>, used: usize, first: usize, bits: u8) -> usize {
    if list.len() < used + LANES {
        grow(list, used + LANES);
    }
    let offsets = OFFSETS[bits as usize];
    #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
    let first = first as u32;
    let mut places = [first; LANES];
    for k in 0..LANES {
        places[k] += u32::from(offsets[k]);
    }
    list[used..used + LANES].copy_from_slice(&places);
    used + bits.count_ones() as usize
}

/// Lists fill most of a rank's memory beside the particles: they grow by a quarter only.
#[cold]
fn grow(list: &mut Vec<u32>, length: usize) {
    let wanted = (length + length / 4).max(1 << 12);
    list.reserve_exact(wanted - list.len());
    list.resize(wanted, 0);
}

/// For each set of bits, its members in ascending order, and whatever.
static OFFSETS: [[u8; LANES]; 256] = {
    let mut table = [[0; LANES]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut k, mut next) = (0, 0);
        while k < 8 {
            if bits >> k & 1 == 1 {
                table[bits][next] = k;
                next += 1;
            }
            k += 1;
        }
        bits += 1;
    }
    table
};

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

/// Box tests reach this much farther than the kernel, so that rounding
/// never drops a pair with a contribution.
pub(super) const INFLATION: f64 = 1.0 + 1e-9;

/// All clusters of a rank with their lists. Buffers are kept from step to step.
#[derive(Debug, Clone, Default)]
pub struct ClusterLists {
    chunks: Vec<Chunk>,
    used: usize,
    /// Where there are stress points, how many groups the bodies form.
    body_groups: Option<usize>,
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

    /// Groups this rank's own particles into clusters and lists the neighbours of each.
    /// `lengths` are the smoothing lengths of each group.
    pub fn build(&mut self, sequence: &Sequence, lengths: &[Lengths]) {
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
                chunk,
                sequence,
            });
        });
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
                    + 4 * chunk.neighbours.capacity()
                    + 8 * chunk.ends.capacity()
                    + size_of::<Cluster>() * chunk.clusters.capacity()
                    + chunk.gatherer.memory()
                    + chunk.parted.memory()
            })
            .sum()
    }

    pub(super) fn chunks_mut(&mut self) -> &mut [Chunk] {
        &mut self.chunks[..self.used]
    }

    fn lay_out(&mut self, sequence: &Sequence) {
        self.used = 0;
        for group in 0..sequence.groups() {
            let Range { start, end } = sequence.group(group);
            for first in (start..end).step_by(PLACES_PER_CHUNK) {
                if self.used == self.chunks.len() {
                    self.chunks.push(Chunk::default());
                }
                let chunk = &mut self.chunks[self.used];
                chunk.group = group;
                chunk.places = first..end.min(first + PLACES_PER_CHUNK);
                self.used += 1;
            }
        }
    }
}

/// Calls `found` with each eight images of a group that stand by a box, the place of the first, and a bit
/// for each of them that is nearer than `range` (m), which is nowhere more than `far`. `hints` are where the
/// last box nearby began to read columns, by the last bits of their indices.
#[inline(always)]
pub(super) fn near_box<V: Lanes>(
    sequence: &Sequence,
    group: usize,
    (lower, upper): (&[f64; 3], &[f64; 3]),
    far: f64,
    hints: &mut [usize; 64],
    range: impl Fn(&Eight) -> V,
    mut found: impl FnMut(usize, u8, &Eight),
) {
    let (low, high) = (lower.map(V::splat), upper.map(V::splat));
    let along = sequence.along(group);
    let (from, to) = (lower[along] - far, upper[along] + far);
    sequence.columns_near(group, lower, upper, far, |[a, b], column| {
        let hint = &mut hints[(a & 7) << 3 | b & 7];
        *hint = sequence.seek::<V>(group, &column, from, *hint);
        let mut first = *hint;
        for eight in sequence.eights(first..column.end) {
            if eight.coordinates[along][0] > to {
                break;
            }
            let gap = |a: usize| {
                let x = V::read(eight.coordinates[a]);
                low[a].sub(x).max(x.sub(high[a])).max(V::splat(0.0))
            };
            let [x, y, z] = [gap(0), gap(1), gap(2)];
            let square = z.mul_add(z, y.mul_add(y, x.mul(x)));
            let range = range(&eight);
            let mut bits = square.less_than(range.mul(range));
            let left = column.end - first;
            if left < LANES {
                bits &= (1 << left) - 1;
            }
            found(first, bits, &eight);
            first += LANES;
        }
    });
}
