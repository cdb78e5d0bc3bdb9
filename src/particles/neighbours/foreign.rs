//! Lists of neighbours that belong to other bodies, for single receivers: contact works on
//! these, apart from the sums inside a body.

use std::cell::RefCell;

use rayon::prelude::*;

use super::cluster::{Cluster, around};
use super::clusters::{CHUNKS_AT_ONCE, Chunk, ClusterLists};
use super::motion::MotionRecord;
use super::near::{INFLATION, near_box, push_places, splat_each};
use super::pairs::PairList;
use super::sequence::{Eight, Sequence};
use super::size_classes::SizeClasses;
use model::ContactClass;
use numerics::dispatch::{Vectorised, instructions};
use numerics::lanes::{F64x8, LANES, Lanes};

/// For each ordered pair of size classes of particles, the mode of contact and its range.
#[derive(Debug, Clone)]
pub struct ForeignTable {
    /// The size classes.
    pub size_classes: SizeClasses,
    /// `class[a * size_classes + b]`; none where there is nothing beyond the SPH sums.
    pub class: Vec<Option<ContactClass>>,
    /// Squared range of contact (m²), in the same order.
    pub reach2: Vec<f64>,
    /// Largest ranges between bodies of two groups.
    pub ranges: GroupRanges,
    /// Bound where particles of a body are unequal: no pair has a longer range than so many times
    /// the sum of its smoothing lengths.
    pub most: Option<f64>,
}

/// Largest ranges of contact between groups, of which those that are alike are kept once.
#[derive(Debug, Clone)]
pub struct GroupRanges {
    /// The kind of each group.
    kinds: Vec<usize>,
    count: usize,
    /// Range (m) of each ordered pair of kinds; zero without contact.
    ranges: Vec<f64>,
    longest: f64,
}

impl GroupRanges {
    /// Of groups of these kinds, below a number, without contact.
    #[must_use]
    pub fn new(kinds: Vec<usize>, count: usize) -> Self {
        Self {
            kinds,
            count,
            ranges: vec![0.0; count * count],
            longest: 0.0,
        }
    }

    /// Lets groups of the kinds of two groups have contact within a range (m), or more.
    pub fn widen(&mut self, group: usize, other: usize, range: f64) {
        let widest = &mut self.ranges[self.kinds[group] * self.count + self.kinds[other]];
        *widest = widest.max(range);
        self.longest = self.longest.max(range);
    }

    /// Range (m) of contact between two groups; zero without, and of a group with itself.
    #[inline(always)]
    #[must_use]
    pub fn between(&self, group: usize, other: usize) -> f64 {
        if group == other {
            return 0.0;
        }
        self.ranges[self.kinds[group] * self.count + self.kinds[other]]
    }

    /// The longest range (m) of all.
    #[must_use]
    pub fn longest(&self) -> f64 {
        self.longest
    }
}

/// The foreign pairs of one task, one list for each mode of contact.
#[derive(Debug, Clone, Default)]
pub struct ForeignChunk {
    lists: [PairList; ContactClass::COUNT],
}

/// Buffers of a thread, for one chunk after the other.
#[derive(Debug, Default)]
struct Buffers {
    /// Groups of which images are near the chunk.
    groups: Vec<usize>,
    /// Images that are near a cluster.
    near: Candidates,
    /// Strangers of a receiver.
    apart: Candidates,
}

thread_local! {
    static BUFFERS: RefCell<Buffers> = RefCell::default();
}

/// Images that may be in range of a receiver, eight at a time.
#[derive(Debug, Clone, Default)]
struct Candidates {
    indices: Vec<u32>,
    /// Number of these.
    used: usize,
    size_classes: Vec<usize>,
    positions: Vec<[F64x8; 3]>,
    /// Squared range (m²) of receivers of the size class `reached_by`; zero where an eight is not full.
    reach2: Vec<F64x8>,
    reached_by: Option<usize>,
}

/// All foreign pairs of a rank. Buffers are kept from step to step.
#[derive(Debug, Clone, Default)]
pub struct ForeignLists {
    chunks: Vec<ForeignChunk>,
}

impl ForeignLists {
    /// Lists the foreign neighbours of all receivers of `clusters`. `size_class_of` tells the size class of
    /// an image by its place in the sequence.
    pub fn build(
        &mut self,
        clusters: &ClusterLists,
        sequence: &Sequence,
        sources: &[MotionRecord],
        table: &ForeignTable,
        size_class_of: impl Fn(u32) -> usize + Sync,
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
                    size_class_of: &size_class_of,
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
        let lists = self.chunks.iter().flat_map(|chunk| &chunk.lists);
        lists.map(PairList::memory).sum()
    }
}

/// Lists the foreign neighbours of one task's receivers.
struct Find<'a, B> {
    chunk: &'a mut ForeignChunk,
    own: &'a Chunk,
    sequence: &'a Sequence,
    sources: &'a [MotionRecord],
    table: &'a ForeignTable,
    size_class_of: &'a B,
}

impl<B: Fn(u32) -> usize> Vectorised for Find<'_, B> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let chunk = self.chunk;
        chunk.lists.iter_mut().for_each(PairList::clear);
        let mut hints = [0; 64];
        let mut strangers = self.own.strangers().iter().peekable();
        let mut buffers = BUFFERS.take();
        let Buffers {
            groups,
            near,
            apart,
        } = &mut buffers;
        let (lower, upper) = around(self.own.iter().map(|(cluster, ..)| cluster));
        let range = self.table.ranges.longest() * INFLATION;
        self.sequence
            .list_groups_near((&lower, &upper), range, groups);
        for (cluster, _, among) in self.own.iter() {
            if among.resting {
                continue;
            }
            near.find::<V>(cluster, groups, self.sequence, self.table, &mut hints);
            if near.used == 0 && strangers.peek().is_none() {
                continue;
            }
            near.look_up(self.sources, self.size_class_of);
            for &receiver in &cluster.receivers[..cluster.lanes] {
                let here = Receiver {
                    position: &self.sources[receiver as usize].position,
                    size_class: (self.size_class_of)(receiver),
                };
                if let Some((_, list)) = strangers.next_if(|(at, _)| *at == receiver) {
                    apart.take(list);
                    apart.look_up(self.sources, self.size_class_of);
                    chunk.add_near::<V>(&here, apart, self.table);
                }
                chunk.add_near::<V>(&here, near, self.table);
                chunk.close(receiver);
            }
        }
        BUFFERS.set(buffers);
    }
}

struct Receiver<'a> {
    position: &'a [f64; 3],
    size_class: usize,
}

impl Candidates {
    /// Lists what may be in range of any receiver of a cluster, of groups near it. `hints` are as in the lists of
    /// the own group.
    #[inline(always)]
    fn find<V: Lanes>(
        &mut self,
        cluster: &Cluster,
        groups: &[usize],
        sequence: &Sequence,
        table: &ForeignTable,
        hints: &mut [usize; 64],
    ) {
        self.used = 0;
        let range_of = |other| table.ranges.between(cluster.group, other) * INFLATION;
        for &other in groups {
            let range = range_of(other);
            if range == 0.0 {
                continue;
            }
            let mut push = |first, bits, _: &Eight, _| {
                self.used = push_places(&mut self.indices, self.used, first, bits);
            };
            let bounds = (&cluster.lower, &cluster.upper);
            let Some(most) = table.most else {
                let range = |_: &Eight| V::splat(range);
                near_box(
                    sequence,
                    other,
                    bounds,
                    range_of(other),
                    hints,
                    range,
                    &mut push,
                );
                continue;
            };
            let own = cluster.longest(sequence.smoothing_lengths());
            let within = |eight: &Eight| {
                let both = V::read(eight.lengths).add(V::splat(own));
                both.mul(V::splat(most)).min(V::splat(range))
            };
            let reach = |h: f64| ((h + own) * most).min(range);
            let far = sequence.reach(other, bounds, (own, range), reach);
            near_box(sequence, other, bounds, far, hints, within, &mut push);
        }
    }

    /// Takes a list.
    fn take(&mut self, list: &[u32]) {
        self.indices.clear();
        self.indices.extend_from_slice(list);
        self.used = list.len();
    }

    /// Positions and size classes of what is listed.
    #[inline(always)]
    fn look_up(&mut self, sources: &[MotionRecord], size_class_of: &impl Fn(u32) -> usize) {
        let indices = &self.indices[..self.used];
        self.size_classes.clear();
        self.size_classes
            .extend(indices.iter().map(|&index| size_class_of(index)));
        self.positions.clear();
        self.positions.extend(indices.chunks(LANES).map(|eight| {
            let mut positions = [F64x8([0.0; LANES]); 3];
            for (k, &index) in eight.iter().enumerate() {
                let position = &sources[index as usize].position;
                for a in 0..3 {
                    positions[a].0[k] = position[a];
                }
            }
            positions
        }));
        self.reached_by = None;
    }

    /// Ranges for receivers of a size class.
    #[inline(always)]
    fn reach(&mut self, size_class: usize, table: &ForeignTable) {
        if self.reached_by == Some(size_class) {
            return;
        }
        self.reached_by = Some(size_class);
        let row = size_class * table.size_classes.count();
        self.reach2.clear();
        self.reach2
            .extend(self.size_classes.chunks(LANES).map(|eight| {
                let mut reach2 = F64x8([0.0; LANES]);
                for (reach2, other) in reach2.0.iter_mut().zip(eight) {
                    *reach2 = table.reach2[row + other];
                }
                reach2
            }));
    }
}

impl ForeignChunk {
    /// The lists of all modes, by class.
    #[must_use]
    pub fn lists(&self) -> &[PairList; ContactClass::COUNT] {
        &self.lists
    }

    /// Pairs of a class.
    #[must_use]
    pub fn of(&self, class: ContactClass) -> &PairList {
        &self.lists[class as usize]
    }

    /// Adds what is in range of a receiver to its lists.
    #[inline(always)]
    fn add_near<V: Lanes>(
        &mut self,
        receiver: &Receiver,
        candidates: &mut Candidates,
        table: &ForeignTable,
    ) {
        candidates.reach(receiver.size_class, table);
        let classes = &table.class[receiver.size_class * table.size_classes.count()..];
        let here = splat_each::<V>(*receiver.position);
        let eights = candidates.positions.iter().zip(&candidates.reach2);
        for (n, (positions, reach2)) in eights.enumerate() {
            let gap = |a: usize| here[a].sub(V::load(&positions[a]));
            let [x, y, z] = [gap(0), gap(1), gap(2)];
            let square = x.mul(x).add(y.mul(y)).add(z.mul(z));
            let mut bits = square.less_than(V::load(reach2));
            while bits != 0 {
                let k = n * LANES + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let index = candidates.indices[k];
                if let Some(class) = classes[candidates.size_classes[k]] {
                    self.lists[class as usize].sources.push(index);
                }
            }
        }
    }

    fn close(&mut self, receiver: u32) {
        for list in &mut self.lists {
            list.close(receiver);
        }
    }
}
