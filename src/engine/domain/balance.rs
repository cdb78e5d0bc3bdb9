//! Faces of the slabs so that counted work is even.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

use super::least::Least;
use super::nested::{Cut, NestedSlabs, Slab};
use super::rank_speed::RankSpeeds;
use comm::{Comm, PlainRecord, Receivers, Relay};
use numerics::ordered::{disordered, ordered};

/// Memory of the balance, kept from one to the next.
///
/// Each slab has an owner, which alone sums what is counted in it and finds its faces: first by coarse planes, then by the
/// fine planes of those coarse ones in which a face lies. A rank tells of planes where it has particles, and of no others.
pub struct Balance {
    /// The slabs that a level cuts.
    slabs: Vec<Slab>,
    /// Their planes.
    spans: Vec<Span>,
    /// By particle where it is: the place of its slab there, or, once coarse planes have been counted, its own of those of all
    /// slabs; from [`OWNED`] on the rank that owns it, if nobody cuts its slab.
    places: Vec<u32>,
    /// How the level before cuts each of its slabs, the first of their parts in `parts`, and the places of those, or owners.
    cuts: Vec<(Cut, usize)>,
    parts: Vec<u32>,
    /// By coarse plane of the level before the part of its particles, as in `parts`, or [`DIVIDED`] and a number of those
    /// in which faces may be: the places of their slabs, and their first and last parts.
    lots: Vec<u32>,
    divided: Vec<(u32, [usize; 2])>,
    /// Smallest and largest coordinates of this rank's particles in each, as words.
    ends: Least,
    /// Work by planes, as threads count it.
    counts: Vec<AtomicU64>,
    tallies: Vec<Tally>,
    relay: Relay<Tally>,
    /// Keys of the coarse planes with particles of this rank in which faces lie, and by coarse plane its number among them, or
    /// [`UNMARKED`].
    marked: Vec<u64>,
    numbers: Vec<u32>,
    /// Faces of the slabs that this rank owns, in the order of slabs and positions.
    sought: Vec<Sought>,
    /// Faces of a level, as bits.
    faces: Vec<u64>,
}

/// The planes of a slab that is cut.
#[derive(Debug, Clone, Copy, Default)]
struct Span {
    /// Position of the lowest plane (m).
    lower: f64,
    /// From fine plane to fine plane (m).
    width: f64,
    /// Number of coarse planes.
    coarse: usize,
    /// The first of its coarse planes and the one after its last, of those of all slabs in which this rank has particles.
    planes: [usize; 2],
    /// The first of its faces, of those of all slabs.
    first_face: usize,
}

/// What is told of a slab, by its place in the upper half of the key.
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Tally {
    key: u64,
    value: u64,
}

/// A face to be found in a coarse plane.
#[derive(Debug, Clone, Copy)]
struct Sought {
    /// Of the coarse plane.
    key: u64,
    /// Its number.
    face: usize,
    /// Work below the plane, and below the face.
    below: u64,
    wanted: u64,
}

/// Coarse planes for each part of a slab, and fine ones for each coarse one.
const COARSE: usize = 32;
const FINE: usize = 256;

/// Bit of the work of a plane that has a face.
const MARK: u64 = 1 << 63;

/// Keys from here on, less the slab, tell the shares of its parts.
const SHARES: u64 = 1 << 31;

/// The mean work of all particles over what one counts at least, so that no rank owns much more than so many even
/// shares because its own take little work: what a rank takes of memory goes by their number.
pub const MOST_UNEVEN: u64 = 2;

/// Places from here on, less this, are ranks: a slab of one rank, which nobody cuts.
const OWNED: u32 = 1 << 31;

/// Lots from here on, less this, are numbers of planes in which faces may be.
const DIVIDED: u32 = 1 << 30;

/// The number of a coarse plane without faces.
const UNMARKED: u32 = u32::MAX;

/// Particles that a task looks at.
const SHARE: usize = 4096;

impl PlainRecord for Tally {
    fn key(&self) -> u64 {
        self.key
    }
}

impl Tally {
    fn new(place: usize, what: u64, value: u64) -> Self {
        let key = key(place, what);
        Self { key, value }
    }

    /// The place of its slab.
    fn place(&self) -> usize {
        usize::try_from(self.key >> 32).unwrap_or(usize::MAX)
    }

    /// What it tells of its slab.
    fn what(&self) -> u64 {
        self.key & u64::from(u32::MAX)
    }
}

fn key(place: usize, what: u64) -> u64 {
    (place as u64) << 32 | what
}

impl Span {
    /// The fine plane of a coordinate (m).
    #[inline]
    fn plane(&self, x: f64) -> usize {
        let plane = (x - self.lower) / self.width;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "clamped"
        )]
        let plane = plane.clamp(0.0, (self.coarse * FINE - 1) as f64) as usize;
        plane
    }

    /// The lower end of a fine plane (m).
    #[inline]
    fn edge(&self, plane: f64) -> f64 {
        self.lower + self.width * plane
    }

    /// Sets the ends (m).
    #[allow(clippy::cast_precision_loss, reason = "few planes")]
    fn reach(&mut self, lower: f64, upper: f64) {
        self.lower = lower;
        self.width = ((upper - lower) / (self.coarse * FINE) as f64).max(f64::MIN_POSITIVE);
    }
}

impl Default for Balance {
    fn default() -> Self {
        Self {
            slabs: Vec::new(),
            spans: Vec::new(),
            places: Vec::new(),
            cuts: Vec::new(),
            parts: Vec::new(),
            lots: Vec::new(),
            divided: Vec::new(),
            ends: Least::default(),
            counts: Vec::new(),
            tallies: Vec::new(),
            relay: Relay::new(Receivers::OwnersByUpperHalf),
            marked: Vec::new(),
            numbers: Vec::new(),
            sought: Vec::new(),
            faces: Vec::new(),
        }
    }
}

impl Balance {
    /// Moves the faces of `slabs` for owned particles at `positions` (m) with counted `work`, so that
    /// each rank gets its share by `rank_speeds`, level by level. A particle counts the mean work over [`MOST_UNEVEN`]
    /// at least. Slabs without particles keep their faces. Gives the seconds that it has taken since all ranks had
    /// begun. Collective.
    pub fn cut(
        &mut self,
        comm: &Comm,
        slabs: &mut NestedSlabs,
        (positions, work): (&[[f64; 3]], &[u32]),
        rank_speeds: &RankSpeeds,
    ) -> f64 {
        let floor = floor(comm, work);
        let begun = comm.seconds();
        self.slabs.clear();
        self.slabs.extend(Some(slabs.whole()).filter(Slab::is_cut));
        self.places.clear();
        let place = if self.slabs.is_empty() { OWNED } else { 0 };
        self.places.resize(positions.len(), place);
        for level in 0..slabs.levels() {
            if level > 0 {
                self.descend(slabs, level, positions);
            }
            if self.slabs.is_empty() {
                break;
            }
            let axis = slabs.axis(level);
            self.find_ends(comm, positions, axis);
            // Who stands for other ranks too has all of them alike.
            let share = (comm.size() == slabs.ranks()).then(|| rank_speeds.share());
            self.look_coarsely(comm, (positions, axis), |i| work[i].max(floor), share);
            self.look_finely(comm, (positions, axis), |i| work[i].max(floor));
            comm.min_u64(&mut self.faces);
            let places = self.slabs.iter().flat_map(|slab| slab.cut().places());
            for (place, &bits) in places.zip(&self.faces) {
                if bits != u64::MAX {
                    slabs.faces_mut()[place] = f64::from_bits(bits);
                }
            }
        }
        comm.seconds() - begun
    }

    /// Finds between which ends the particles of each slab are, of those that this rank has some of or owns.
    /// Collective.
    fn find_ends(&mut self, comm: &Comm, positions: &[[f64; 3]], axis: usize) {
        self.spans.clear();
        let mut next = Span::default();
        for slab in &self.slabs {
            next.coarse = COARSE * slab.cut().parts();
            self.spans.push(next);
            next.first_face += slab.cut().parts() - 1;
        }
        self.faces.clear();
        self.faces.resize(next.first_face, u64::MAX);
        self.ends.begin(2 * self.slabs.len());
        let (ends, places) = (&self.ends, &self.places);
        let tasks = positions.par_chunks(SHARE).zip(places.par_chunks(SHARE));
        tasks.for_each(|(positions, places)| {
            // Those of one slab follow each other: each run is told once.
            let mut run = (OWNED, [u64::MAX; 2]);
            for (position, &place) in positions.iter().zip(places) {
                if place != run.0 {
                    tell_ends(ends, run);
                    run = (place, [u64::MAX; 2]);
                }
                let x = ordered(position[axis]);
                run.1 = [run.1[0].min(x), run.1[1].min(!x)];
            }
            tell_ends(ends, run);
        });
        let (tallies, mut end) = (&mut self.tallies, 0);
        tallies.clear();
        let all = self.ends.here().chunks_exact(2).zip(&mut self.spans);
        for (place, (ends, span)) in all.enumerate() {
            span.planes = [end; 2];
            if ends[0] != u64::MAX {
                tallies.extend([0, 1].map(|k| Tally::new(place, k as u64, ends[k])));
                end += span.coarse;
                span.planes[1] = end;
            }
        }
        let join = |all: &mut Tally, one: &Tally| all.value = all.value.min(one.value);
        set_ends(&mut self.spans, self.relay.send(comm, tallies, join));
        self.relay.come_back(comm, tallies);
        set_ends(&mut self.spans, tallies);
    }

    /// Finds the coarse planes in which the faces lie, and what is below each of these, of the slabs that this rank owns;
    /// and the planes of this rank's particles among those. Each rank may tell its `share`. Collective.
    fn look_coarsely(
        &mut self,
        comm: &Comm,
        (positions, axis): (&[[f64; 3]], usize),
        work: impl Fn(usize) -> u32 + Sync,
        share: Option<u64>,
    ) {
        let spans = &self.spans;
        let counts = empty(
            &mut self.counts,
            spans.last().map_or(0, |span| span.planes[1]),
        );
        let tasks = self.places.par_chunks_mut(SHARE);
        let tasks = tasks.zip(positions.par_chunks(SHARE)).enumerate();
        // same bits in any order: whole numbers
        tasks.for_each(|(task, (places, positions))| {
            let (mut run, mut last) = (Run::new(counts), (OWNED, 0.0, 0));
            for (k, (place, position)) in places.iter_mut().zip(positions).enumerate() {
                if let Some(span) = spans.get(*place as usize) {
                    let x = position[axis];
                    // Many of a lattice lie in a row.
                    if (*place, x) != (last.0, last.1) {
                        last = (*place, x, span.planes[0] + span.plane(x) / FINE);
                    }
                    *place = u32::try_from(last.2).unwrap_or(OWNED);
                    run.add(last.2, work(task * SHARE + k));
                }
            }
            run.tell();
        });
        let tallies = &mut self.tallies;
        tallies.clear();
        for (place, span) in spans.iter().enumerate() {
            let [first, end] = span.planes;
            tell_counts(tallies, (place, 0), &mut self.counts[first..end]);
        }
        let rank = comm.rank();
        let mine = self
            .slabs
            .iter()
            .position(|slab| slab.ranks().contains(&rank));
        if let (Some(share), Some(place)) = (share, mine) {
            let part = self.slabs[place].cut().part_of(rank);
            tallies.push(Tally::new(place, SHARES + part as u64, share));
        }
        self.sought.clear();
        let all = self.relay.send(comm, tallies, add);
        for told in all.chunk_by_mut(|a, b| a.place() == b.place()) {
            let place = told[0].place();
            let (planes, shares) = told.split_at_mut(told.partition_point(|of| of.what() < SHARES));
            let faces = &mut self.faces[spans[place].first_face..];
            seek(
                self.slabs[place],
                (planes, shares),
                |part, found| match found {
                    Some(found) => self.sought.push(Sought {
                        face: spans[place].first_face + part - 1,
                        ..found
                    }),
                    None => faces[part - 1] = f64::INFINITY.to_bits(),
                },
            );
        }
        self.relay.come_back(comm, tallies);
        self.marked.clear();
        let marked = tallies
            .iter()
            .filter(|of| of.what() < SHARES && of.value > 0);
        self.marked.extend(marked.map(|of| of.key));
    }

    /// Finds the faces of the slabs that this rank owns. Collective.
    fn look_finely(
        &mut self,
        comm: &Comm,
        (positions, axis): (&[[f64; 3]], usize),
        work: impl Fn(usize) -> u32 + Sync,
    ) {
        let (spans, places, marked) = (&self.spans, &self.places, &self.marked);
        let coarse = spans.last().map_or(0, |span| span.planes[1]);
        self.numbers.clear();
        self.numbers.resize(coarse, UNMARKED);
        for (number, &key) in (0..).zip(marked) {
            let coarse = Tally { key, value: 0 };
            let plane = usize::try_from(coarse.what()).unwrap_or(0);
            self.numbers[spans[coarse.place()].planes[0] + plane] = number;
        }
        let numbers = &self.numbers;
        let counts = empty(&mut self.counts, FINE * marked.len());
        let tasks = places.par_chunks(SHARE).zip(positions.par_chunks(SHARE));
        // same bits in any order: whole numbers
        tasks.enumerate().for_each(|(task, (places, positions))| {
            let (mut run, mut last) = (Run::new(counts), (OWNED, 0.0, 0));
            for (k, (&place, position)) in places.iter().zip(positions).enumerate() {
                let number = numbers.get(place as usize).copied().unwrap_or(UNMARKED);
                if let Some(&key) = marked.get(number as usize) {
                    let x = position[axis];
                    if (place, x) != (last.0, last.1) {
                        let coarse = Tally { key, value: 0 };
                        let plane = spans[coarse.place()].plane(x) % FINE;
                        last = (place, x, FINE * number as usize + plane);
                    }
                    run.add(last.2, work(task * SHARE + k));
                }
            }
            run.tell();
        });
        let tallies = &mut self.tallies;
        tallies.clear();
        for (&key, counts) in marked.iter().zip(self.counts.chunks_exact_mut(FINE)) {
            let coarse = Tally { key, value: 0 };
            tell_counts(
                tallies,
                (coarse.place(), FINE as u64 * coarse.what()),
                counts,
            );
        }
        let all = &*self.relay.send(comm, tallies, add);
        for sought in &self.sought {
            let coarse = Tally {
                key: sought.key,
                value: 0,
            };
            let (place, plane) = (coarse.place(), FINE as u64 * coarse.what());
            let [from, to] = [plane, plane + FINE as u64].map(|plane| {
                let key = key(place, plane);
                all.partition_point(|of| of.key < key)
            });
            let (mut at, mut below) = (plane, sought.below);
            for of in &all[from..to] {
                let over = (below + of.value).checked_sub(sought.wanted);
                // A face goes to whichever side of this plane is nearer to its share.
                let under = sought.wanted.saturating_sub(below);
                at = of.what() + u64::from(over.is_none_or(|over| over <= under));
                below += of.value;
                if over.is_some() {
                    break;
                }
            }
            #[allow(clippy::cast_precision_loss, reason = "few planes")]
            let face = spans[place].lower + spans[place].width * at as f64;
            self.faces[sought.face] = face.to_bits();
        }
    }

    /// On to the slabs that a level cuts, which are parts of those that the level before has cut.
    #[allow(clippy::cast_precision_loss, reason = "few planes")]
    fn descend(&mut self, slabs: &NestedSlabs, level: usize, positions: &[[f64; 3]]) {
        self.cuts.clear();
        self.parts.clear();
        let before = self.slabs.len();
        for place in 0..before {
            let cut = self.slabs[place].cut();
            self.cuts.push((cut, self.parts.len()));
            for part in cut.all() {
                let place = if part.is_cut() {
                    self.slabs.push(part);
                    self.slabs.len() - before - 1
                } else {
                    OWNED as usize + part.ranks().start
                };
                self.parts.push(u32::try_from(place).unwrap_or(u32::MAX));
            }
        }
        self.slabs.drain(..before);
        let (cuts, parts, faces) = (&self.cuts, &self.parts, slabs.faces());
        self.lots.clear();
        self.divided.clear();
        for (place, (&(cut, first), span)) in (0..).zip(cuts.iter().zip(&self.spans)) {
            let mut ends = [0, 0];
            for plane in 0..span.planes[1] - span.planes[0] {
                // Rounding takes no particle beyond the fine planes beside its own.
                let lower = span.edge(plane as f64 * FINE as f64 - 1.0);
                let upper = span.edge((plane + 1) as f64 * FINE as f64 + 1.0);
                ends = [(ends[0], lower), (ends[1], upper)]
                    .map(|(part, x)| cut.part_from(part, x, faces));
                self.lots.push(if ends[0] == ends[1] {
                    parts[first + ends[0]]
                } else {
                    self.divided.push((place, ends));
                    DIVIDED - 1 + u32::try_from(self.divided.len()).unwrap_or(0)
                });
            }
        }
        let (lots, divided, axis) = (&self.lots, &self.divided, slabs.axis(level - 1));
        let tasks = self.places.par_chunks_mut(SHARE);
        let tasks = tasks.zip(positions.par_chunks(SHARE));
        tasks.for_each(|(places, positions)| {
            let mut last = (OWNED, 0.0, 0);
            for (place, position) in places.iter_mut().zip(positions) {
                if let Some(&lot) = lots.get(*place as usize) {
                    *place = lot;
                    if (DIVIDED..OWNED).contains(&lot) {
                        let x = position[axis];
                        if (lot, x) != (last.0, last.1) {
                            let (slab, ends) = divided[(lot - DIVIDED) as usize];
                            let (cut, first) = &cuts[slab as usize];
                            last = (lot, x, parts[first + cut.part_between(ends, x, faces)]);
                        }
                        *place = last.2;
                    }
                }
            }
        });
    }

    /// The rank that owns each of the particles at `positions` (m), right after these have cut `slabs`.
    pub fn owners(&mut self, slabs: &NestedSlabs, positions: &[[f64; 3]]) -> &[u32] {
        if !self.slabs.is_empty() {
            self.descend(slabs, slabs.levels(), positions);
        }
        let places = self.places.par_iter_mut().with_min_len(SHARE);
        places.for_each(|place| *place &= !OWNED);
        &self.places
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of::<Slab>() * self.slabs.capacity()
            + size_of::<Span>() * self.spans.capacity()
            + 4 * (self.places.capacity() + self.parts.capacity())
            + 4 * (self.lots.capacity() + self.numbers.capacity())
            + size_of::<(u32, [usize; 2])>() * self.divided.capacity()
            + size_of::<(Cut, usize)>() * self.cuts.capacity()
            + self.ends.memory()
            + 8 * (self.counts.capacity() + self.marked.capacity() + self.faces.capacity())
            + size_of::<Tally>() * self.tallies.capacity()
            + self.relay.memory()
            + size_of::<Sought>() * self.sought.capacity()
    }
}

fn add(all: &mut Tally, one: &Tally) {
    all.value += one.value;
}

/// Sets the ends of slabs by what is told of them, a pair for each.
fn set_ends(spans: &mut [Span], told: &[Tally]) {
    for ends in told.chunks_exact(2) {
        let [lower, upper] = [ends[0].value, !ends[1].value].map(disordered);
        spans[ends[0].place()].reach(lower, upper);
    }
}

/// So many counts of nothing.
fn empty(counts: &mut Vec<AtomicU64>, count: usize) -> &[AtomicU64] {
    counts.clear();
    counts.resize_with(count, AtomicU64::default);
    counts
}

/// Work that a task counts in one place after another. That of particles which follow each other in one place is told at
/// once.
struct Run<'a> {
    counts: &'a [AtomicU64],
    place: usize,
    work: u64,
}

impl<'a> Run<'a> {
    fn new(counts: &'a [AtomicU64]) -> Self {
        let (place, work) = (0, 0);
        Self {
            counts,
            place,
            work,
        }
    }

    #[inline]
    fn add(&mut self, place: usize, work: u32) {
        if place != self.place {
            self.tell();
            (self.place, self.work) = (place, 0);
        }
        self.work += u64::from(work);
    }

    /// To be called at the end.
    #[inline]
    fn tell(&self) {
        if self.work > 0 {
            self.counts[self.place].fetch_add(self.work, Relaxed);
        }
    }
}

/// Tells of the planes of a slab where something was counted, from one on.
#[inline]
fn tell_counts(tallies: &mut Vec<Tally>, (place, first): (usize, u64), counts: &mut [AtomicU64]) {
    for (plane, count) in (first..).zip(counts) {
        let count = *count.get_mut();
        if count > 0 {
            tallies.push(Tally::new(place, plane, count));
        }
    }
}

/// Seeks the faces of a slab, given the work in its coarse planes and the shares of its parts, if these are known: else
/// all ranks have the same. Marks the planes that have faces, and no others; `emit` takes the part above each face and where
/// the face is, if not above all.
fn seek(
    slab: Slab,
    (planes, shares): (&mut [Tally], &[Tally]),
    mut emit: impl FnMut(usize, Option<Sought>),
) {
    if planes.is_empty() {
        return;
    }
    let cut = slab.cut();
    let share = |part: usize| match shares.get(part) {
        Some(told) => told.value,
        None => cut.part(part).ranks().len() as u64,
    };
    let total: u64 = planes.iter().map(|of| of.value).sum();
    let all: u64 = (0..cut.parts()).map(share).sum();
    let (mut at, mut below, mut lower) = (0, 0, 0);
    for part in 1..cut.parts() {
        lower += share(part - 1);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "a part of the total"
        )]
        let wanted = (lower as f64 / all as f64 * total as f64) as u64;
        let work = |of: &Tally| of.value & !MARK;
        while below + work(&planes[at]) < wanted && at + 1 < planes.len() {
            below += work(&planes[at]);
            at += 1;
        }
        let plane = &mut planes[at];
        let is_found = below + work(plane) >= wanted;
        if is_found {
            plane.value |= MARK;
        }
        let key = plane.key;
        emit(
            part,
            is_found.then_some(Sought {
                key,
                face: 0,
                below,
                wanted,
            }),
        );
    }
    for plane in planes {
        plane.value &= MARK;
    }
}

/// Least work that a particle counts, by the work of all. Collective.
fn floor(comm: &Comm, work: &[u32]) -> u32 {
    // same bits in any order: whole numbers
    let all = work.par_iter().map(|&work| u64::from(work)).sum();
    let mut sums = [all, work.len() as u64];
    comm.sum_u64(&mut sums);
    let [all, particles] = sums;
    let floor = all / (MOST_UNEVEN * particles.max(1));
    u32::try_from(floor).unwrap_or(u32::MAX).max(1)
}

/// Joins the ends that a task has found of a slab, if any, with those of the others.
fn tell_ends(all: &Least, (place, ends): (u32, [u64; 2])) {
    if place < OWNED {
        all.lower(2 * place as usize, ends);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One half takes no work: it is shared out all the same, as far as memory has to.
    #[test]
    fn no_rank_gets_much_more_than_its_even_share() {
        use super::super::nested::Decomposition;
        let positions: Vec<[f64; 3]> = (0..8000).map(|k| [f64::from(k), 0.0, 0.0]).collect();
        let work: Vec<u32> = (0..8000).map(|k| if k < 4000 { 210 } else { 1 }).collect();
        let mut slabs = NestedSlabs::on_first([0, 1, 2], 1, 8);
        let all = (positions.as_slice(), work.as_slice());
        Balance::default().cut(&Comm::solo(), &mut slabs, all, &RankSpeeds::default());
        let mut counts = [0; 8];
        for position in &positions {
            counts[slabs.owner(position)] += 1;
        }
        // Each counts 52 at least, so that all is 8 x 131,000.
        let expected = [624, 624, 624, 623, 624, 624, 1738, 2519];
        for (count, expected) in counts.into_iter().zip(expected) {
            assert!(i32::abs(count - expected) < 40, "{counts:?}");
        }
    }

    #[test]
    fn one_rank_has_no_faces_and_all_work_in_one_place_is_legal() {
        let comm = Comm::solo();
        let mut slabs = NestedSlabs::new(1, Vec::new());
        let before = slabs.clone();
        let positions = [[0.0, 2.0, 0.0]; 3];
        let mut balance = Balance::default();
        balance.cut(
            &comm,
            &mut slabs,
            (&positions, &[5, 5, 5]),
            &RankSpeeds::default(),
        );
        assert_eq!(slabs, before);
    }

    /// Ranks that hold any of the particles find the faces that one process finds, which has all.
    #[test]
    fn any_ranks_find_the_same_faces() {
        let positions: Vec<[f64; 3]> = (0..6000_u32)
            .map(|k| [7919, 104_729, 1_299_709].map(|p: u32| f64::from(k.wrapping_mul(p) % 997)))
            .collect();
        let work: Vec<u32> = (0..6000).map(|k| k % 7).collect();
        for ranks in [2, 3, 12, 30] {
            for levels in 1..=3 {
                let begun = || NestedSlabs::on_first([1, 2, 0], levels, ranks);
                let mut alone = begun();
                let (even, all) = (RankSpeeds::default(), (&*positions, &*work));
                Balance::default().cut(&Comm::solo(), &mut alone, all, &even);
                let found = comm::virtual_ranks(ranks, comm::Machine::IDEAL, |comm| {
                    let mine = |i: &usize| (i * i / 7) % ranks == comm.rank();
                    let mine: Vec<usize> = (0..positions.len()).filter(mine).collect();
                    let positions: Vec<[f64; 3]> = mine.iter().map(|&i| positions[i]).collect();
                    let work: Vec<u32> = mine.iter().map(|&i| work[i]).collect();
                    let mut slabs = begun();
                    let mut balance = Balance::default();
                    for _ in 0..2 {
                        balance.cut(comm, &mut slabs, (&positions, &work), &even);
                    }
                    slabs
                });
                assert!(
                    found.iter().all(|found| *found == alone),
                    "{ranks} {levels}"
                );
            }
        }
    }

    /// What a balance says of owners is what the slabs say, also of layers on which faces lie, and of slabs so thin that
    /// planes are nearer to each other than numbers.
    #[test]
    fn owners_are_those_of_the_slabs() {
        use super::super::nested::Decomposition;
        let mut balance = Balance::default();
        for (side, first, spacing) in [(1_u32, 0.0, 1.0), (12, 0.0, 0.1), (9, 1.0, f64::EPSILON)] {
            let at = |k: u32| first + spacing * f64::from(k);
            let all = 0..side.pow(3);
            let positions: Vec<[f64; 3]> = all
                .map(|k| [k % side, k / side % side, k / (side * side)].map(at))
                .collect();
            let work: Vec<u32> = (0..side.pow(3)).map(|k| k % 5).collect();
            for (ranks, levels) in [1, 2, 7, 64, 900, 5000]
                .into_iter()
                .flat_map(|ranks| (1..=3).map(move |levels| (ranks, levels)))
            {
                let mut slabs = NestedSlabs::on_first([2, 0, 1], levels, ranks);
                let all = (positions.as_slice(), work.as_slice());
                balance.cut(&Comm::solo(), &mut slabs, all, &RankSpeeds::default());
                for _ in 0..2 {
                    let found = balance.owners(&slabs, &positions).iter();
                    let wanted = positions.iter().map(|position| slabs.owner(position));
                    assert!(
                        found.map(|&owner| owner as usize).eq(wanted),
                        "{side} {ranks} {levels}"
                    );
                }
            }
        }
    }

    /// One process cuts as many would: each rank gets its share, whatever the levels.
    #[test]
    #[allow(clippy::cast_precision_loss, reason = "few particles")]
    fn all_levels_share_out_the_work() {
        use super::super::nested::Decomposition;
        let positions: Vec<[f64; 3]> = (0..30_000_u32)
            .map(|k| [7919, 104_729, 1_299_709].map(|p: u32| f64::from(k.wrapping_mul(p) % 9973)))
            .collect();
        let work = vec![2; positions.len()];
        for ranks in [2, 3, 5, 8, 13, 30] {
            for levels in 1..=3 {
                let mut slabs = NestedSlabs::on_first([2, 0, 1], levels, ranks);
                let mut balance = Balance::default();
                let all = (positions.as_slice(), work.as_slice());
                balance.cut(&Comm::solo(), &mut slabs, all, &RankSpeeds::default());
                assert!(slabs.is_sorted());
                let mut counts = vec![0; ranks];
                for (position, &owner) in positions.iter().zip(balance.owners(&slabs, &positions)) {
                    assert_eq!(owner as usize, slabs.owner(position));
                    counts[slabs.owner(position)] += 1;
                }
                let even = positions.len() as f64 / ranks as f64;
                let most = f64::from(*counts.iter().max().unwrap());
                assert!(most < 1.02 * even + 10.0, "{ranks} {levels}: {counts:?}");
            }
        }
    }
}
