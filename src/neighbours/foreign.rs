//! Lists of neighbours that belong to other bodies, for single receivers: contact works on
//! these, apart from the sums inside a body.

use rayon::prelude::*;

use super::clusters::{CHUNKS_AT_ONCE, Chunk, Cluster, ClusterLists, INFLATION, distance2};
use super::sequence::Sequence;
use crate::sph::dispatch::{Vectorised, instructions};
use crate::sph::gradient::MotionRecord;
use crate::sph::lanes::Lanes;

/// Which contact algorithm handles a pair of bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactClass {
    /// Nothing beyond the SPH sums, if any.
    None,
    /// Contact potential.
    Potential,
    /// Overlap energy.
    Overlap,
    /// Penalty between boundary particles.
    Penalty,
}

/// For each ordered pair of bodies, the algorithm and its range.
#[derive(Debug, Clone)]
pub struct ForeignTable {
    /// Number of bodies.
    pub bodies: usize,
    /// `class[a * bodies + b]`.
    pub class: Vec<ContactClass>,
    /// Squared range of contact (m²), in the same order.
    pub reach2: Vec<f64>,
    /// `range[g * groups + o]`: largest range (m) between bodies of the groups g and o; zero
    /// where these have no contact.
    pub group_range: Vec<f64>,
}

/// Receivers with their foreign neighbours.
#[derive(Debug, Clone, Default)]
pub struct PairList {
    /// Place of each receiver in the sequence and the end of its neighbours.
    receivers: Vec<(u32, u32)>,
    sources: Vec<u32>,
}

impl PairList {
    /// Receivers that have neighbours, with those, in canonical order.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let mut start = 0;
        self.receivers.iter().map(move |&(receiver, end)| {
            let neighbours = &self.sources[start..end as usize];
            start = end as usize;
            (receiver, neighbours)
        })
    }

    /// Whether no receiver has a neighbour.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.receivers.is_empty()
    }

    pub(super) fn clear(&mut self) {
        self.receivers.clear();
        self.sources.clear();
    }

    /// Adds a receiver, if it has neighbours.
    pub(super) fn add(&mut self, receiver: u32, neighbours: impl Iterator<Item = u32>) {
        self.sources.extend(neighbours);
        self.close(receiver);
    }

    pub(super) fn memory(&self) -> usize {
        8 * self.receivers.capacity() + 4 * self.sources.capacity()
    }

    fn close(&mut self, receiver: u32) {
        let end = self.sources.len();
        let start = self.receivers.last().map_or(0, |&(_, end)| end as usize);
        if end > start {
            #[allow(clippy::cast_possible_truncation, reason = "one task's pairs fit u32")]
            self.receivers.push((receiver, end as u32));
        }
    }
}

/// The foreign pairs of one task, one list for each algorithm.
#[derive(Debug, Clone, Default)]
pub struct ForeignChunk {
    /// Pairs of [`ContactClass::Overlap`].
    pub overlap: PairList,
    /// Pairs of [`ContactClass::Potential`].
    pub potential: PairList,
    /// Pairs of [`ContactClass::Penalty`].
    pub penalty: PairList,
    candidates: Vec<u32>,
}

/// All foreign pairs of a rank. Buffers are kept from step to step.
#[derive(Debug, Clone, Default)]
pub struct ForeignLists {
    chunks: Vec<ForeignChunk>,
}

impl ForeignLists {
    /// Lists the foreign neighbours of all receivers of `clusters`. `body_of` tells the body of
    /// an image by its place in the sequence.
    pub fn build(
        &mut self,
        clusters: &ClusterLists,
        sequence: &Sequence,
        sources: &[MotionRecord],
        table: &ForeignTable,
        body_of: impl Fn(u32) -> usize + Sync,
    ) {
        self.chunks
            .resize_with(clusters.chunks().len(), ForeignChunk::default);
        let set = instructions();
        self.chunks
            .par_iter_mut()
            .zip(clusters.chunks())
            .with_max_len(CHUNKS_AT_ONCE)
            .for_each(|(chunk, own)| {
                set.run(Find {
                    chunk,
                    own,
                    sequence,
                    sources,
                    table,
                    body_of: &body_of,
                });
            });
    }

    /// The tasks, in the order of the clusters' chunks.
    #[must_use]
    pub fn chunks(&self) -> &[ForeignChunk] {
        &self.chunks
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.chunks
            .iter()
            .map(|chunk| {
                4 * chunk.candidates.capacity()
                    + [&chunk.overlap, &chunk.potential, &chunk.penalty]
                        .map(PairList::memory)
                        .iter()
                        .sum::<usize>()
            })
            .sum()
    }
}

/// Lists the foreign neighbours of one task's receivers.
struct Find<'a, B> {
    chunk: &'a mut ForeignChunk,
    own: &'a Chunk,
    sequence: &'a Sequence,
    sources: &'a [MotionRecord],
    table: &'a ForeignTable,
    body_of: &'a B,
}

impl<B: Fn(u32) -> usize> Vectorised for Find<'_, B> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let chunk = self.chunk;
        chunk.overlap.clear();
        chunk.potential.clear();
        chunk.penalty.clear();
        let mut hints = [0; 64];
        let mut strangers = self.own.parted.strangers.iter().peekable();
        for (cluster, _, _) in self.own.iter() {
            chunk.find_candidates::<V>(cluster, self.sequence, self.table, &mut hints);
            if chunk.candidates.is_empty() && strangers.peek().is_none() {
                continue;
            }
            let candidates = std::mem::take(&mut chunk.candidates);
            for &receiver in &cluster.receivers[..cluster.lanes] {
                let parted = strangers.next_if(|(at, _)| *at == receiver);
                for list in [parted.map_or(&[][..], |(_, list)| list), &candidates] {
                    chunk.test_candidates(receiver, list, self.sources, self.table, self.body_of);
                }
                chunk.close(receiver);
            }
            chunk.candidates = candidates;
        }
    }
}

impl ForeignChunk {
    /// Lists what may be in range of any receiver of a cluster. `hints` are as in the lists of
    /// the own group.
    #[inline(always)]
    fn find_candidates<V: Lanes>(
        &mut self,
        cluster: &Cluster,
        sequence: &Sequence,
        table: &ForeignTable,
        hints: &mut [usize; 64],
    ) {
        self.candidates.clear();
        let (lower, upper) = (&cluster.lower, &cluster.upper);
        let groups = sequence.groups();
        for other in 0..groups {
            let range = table.group_range[cluster.group * groups + other] * INFLATION;
            if range == 0.0 {
                continue;
            }
            let along = sequence.along(other);
            let (from, to) = (lower[along] - range, upper[along] + range);
            let position = |place: usize| sequence.coordinates(along, place)[0];
            sequence.columns_near(other, lower, upper, range, |[a, b], column| {
                if position(column.start) > to || position(column.end - 1) < from {
                    return;
                }
                let hint = &mut hints[(a & 7) << 3 | b & 7];
                *hint = sequence.seek::<V>(other, &column, from, *hint);
                for place in *hint..column.end {
                    let point = std::array::from_fn(|a| sequence.coordinates(a, place)[0]);
                    if point[along] > to {
                        break;
                    }
                    if distance2(lower, upper, &point) < range * range {
                        #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
                        self.candidates.push(place as u32);
                    }
                }
            });
        }
    }

    fn test_candidates(
        &mut self,
        receiver: u32,
        candidates: &[u32],
        sources: &[MotionRecord],
        table: &ForeignTable,
        body_of: &impl Fn(u32) -> usize,
    ) {
        let here = &sources[receiver as usize].position;
        let row = body_of(receiver) * table.bodies;
        for &place in candidates {
            let there = &sources[place as usize].position;
            let r = [here[0] - there[0], here[1] - there[1], here[2] - there[2]];
            let pair = row + body_of(place);
            if r[0] * r[0] + r[1] * r[1] + r[2] * r[2] < table.reach2[pair] {
                match table.class[pair] {
                    ContactClass::None => {}
                    ContactClass::Overlap => self.overlap.sources.push(place),
                    ContactClass::Potential => self.potential.sources.push(place),
                    ContactClass::Penalty => self.penalty.sources.push(place),
                }
            }
        }
    }

    fn close(&mut self, receiver: u32) {
        self.overlap.close(receiver);
        self.potential.close(receiver);
        self.penalty.close(receiver);
    }
}
