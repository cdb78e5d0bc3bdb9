//! Faces of the slabs so that counted work is even.

use rayon::prelude::*;

use super::histogram::Histogram;
use super::least::Least;
use super::nested::{Cut, NestedSlabs, Slab};
use super::rank_speed::RankSpeeds;
use comm::Comm;
use numerics::ordered::{disordered, ordered};

/// Memory of the balance, kept from one to the next.
#[derive(Debug, Default)]
pub struct Balance {
    /// Counted work.
    pub histogram: Histogram,
    /// The slabs that a level cuts.
    slabs: Vec<Slab>,
    /// By particle the place of its slab there, or [`UNCUT`].
    places: Vec<u32>,
    /// How the level before cuts each of its slabs, the first of their parts in `parts`, and the places of those.
    cuts: Vec<(Cut, usize)>,
    parts: Vec<u32>,
    /// Smallest and largest coordinates of each, as words.
    ends: Least,
}

/// The mean work of all particles over what one counts at least, so that no rank owns much more than so many even
/// shares because its own take little work: what a rank takes of memory goes by their number.
pub const MOST_UNEVEN: u64 = 2;

/// The place of a slab of one rank, which nobody cuts.
const UNCUT: u32 = u32::MAX;

/// Particles that a task looks at.
const SHARE: usize = 4096;

impl Balance {
    /// Moves the faces of `slabs` for owned particles at `positions` (m) with counted `work`, so that
    /// each rank gets its share by `rank_speeds`, level by level. A particle counts the mean work over [`MOST_UNEVEN`]
    /// at least. Slabs without particles keep their faces. Collective.
    pub fn cut(
        &mut self,
        comm: &Comm,
        slabs: &mut NestedSlabs,
        (positions, work): (&[[f64; 3]], &[u32]),
        rank_speeds: &RankSpeeds,
    ) {
        let floor = floor(comm, work);
        self.slabs.clear();
        self.slabs.extend(Some(slabs.whole()).filter(Slab::is_cut));
        self.places.clear();
        self.places.resize(positions.len(), 0);
        for level in 0..slabs.levels() {
            if level > 0 {
                self.descend(slabs, level, positions);
            }
            if self.slabs.is_empty() {
                break;
            }
            self.count(comm, slabs, level, (positions, work, floor));
            self.split(slabs, rank_speeds);
        }
    }

    /// Counts all work, that of a particle at least `floor`, in the slabs that are cut by a level, by planes normal to
    /// its axis. Collective.
    fn count(
        &mut self,
        comm: &Comm,
        slabs: &NestedSlabs,
        level: usize,
        (positions, work, floor): (&[[f64; 3]], &[u32], u32),
    ) {
        let (ranks, axis) = (slabs.ranks(), slabs.axis(level));
        self.ends.begin(2 * self.slabs.len());
        let (ends, places) = (&self.ends, &self.places);
        let tasks = positions.par_chunks(SHARE).zip(places.par_chunks(SHARE));
        tasks.for_each(|(positions, places)| {
            // Those of one slab follow each other: each run is told once.
            let mut run = (UNCUT, [u64::MAX; 2]);
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
        self.ends.join(comm);
        let words = self.ends.words();
        let ends = words.chunks_exact(2).map(ends_of);
        if level == 0 {
            let (lower, upper) = ends_of(words);
            self.histogram.reset(lower, upper, ranks);
        } else {
            let cuts = self.slabs.iter().map(|slab| slab.ranks().len());
            self.histogram.reset_each(ends.zip(cuts), ranks);
        }
        self.histogram.add_all(positions.len(), |i| {
            let work = u64::from(work[i].max(floor));
            (places[i] != UNCUT).then(|| (places[i] as usize, positions[i][axis], work))
        });
        self.histogram.sum(comm);
    }

    /// Cuts each slab that has particles.
    fn split(&self, slabs: &mut NestedSlabs, rank_speeds: &RankSpeeds) {
        let ranks = slabs.ranks();
        for (place, slab) in self.slabs.iter().enumerate() {
            let (lower, upper) = ends_of(&self.ends.words()[2 * place..]);
            if lower <= upper {
                split_slab(&self.histogram, (place, *slab), slabs.faces_mut(), |rank| {
                    rank_speeds.below(rank, ranks)
                });
            }
        }
    }

    /// On to the slabs that a level cuts, which are parts of those that the level before has cut.
    fn descend(&mut self, slabs: &NestedSlabs, level: usize, positions: &[[f64; 3]]) {
        self.cuts.clear();
        self.parts.clear();
        let before = self.slabs.len();
        for place in 0..before {
            let cut = self.slabs[place].cut();
            self.cuts.push((cut, self.parts.len()));
            for part in cut.all() {
                if part.is_cut() {
                    let place = u32::try_from(self.slabs.len() - before).unwrap_or(UNCUT);
                    self.parts.push(place);
                    self.slabs.push(part);
                } else {
                    self.parts.push(UNCUT);
                }
            }
        }
        self.slabs.drain(..before);
        let (cuts, parts, axis) = (&self.cuts, &self.parts, slabs.axis(level - 1));
        let places = self.places.par_iter_mut().zip(positions);
        places.with_min_len(SHARE).for_each(|(place, position)| {
            if *place != UNCUT {
                let (cut, first) = &cuts[*place as usize];
                *place = parts[first + cut.part_at(position[axis], slabs.faces())];
            }
        });
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.histogram.memory()
            + size_of::<Slab>() * self.slabs.capacity()
            + 4 * (self.places.capacity() + self.parts.capacity())
            + size_of::<(Cut, usize)>() * self.cuts.capacity()
            + self.ends.memory()
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
    if place != UNCUT {
        all.lower(2 * place as usize, ends);
    }
}

/// Smallest and largest coordinate (m), from words.
fn ends_of(words: &[u64]) -> (f64, f64) {
    if words[0] == u64::MAX {
        return (f64::INFINITY, f64::NEG_INFINITY);
    }
    (disordered(words[0]), disordered(!words[1]))
}

/// Sets the faces of a slab so that the work counted at a place of a histogram is split as the part of
/// the whole that ranks below one are to have.
pub(super) fn split_slab(
    histogram: &Histogram,
    (place, slab): (usize, Slab),
    faces: &mut [f64],
    below: impl Fn(usize) -> f64,
) {
    let ranks = slab.ranks();
    let (first, all) = (below(ranks.start), below(ranks.end) - below(ranks.start));
    let mut places = slab.cut().places();
    let parts = slab.cut().places();
    let parts = parts.map(|face| (below(face + 1) - first) / all);
    histogram.split(place, parts, |face| {
        let place = places.next().expect("a place for each face");
        faces[place] = face;
    });
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
                for position in &positions {
                    counts[slabs.owner(position)] += 1;
                }
                let even = positions.len() as f64 / ranks as f64;
                let most = f64::from(*counts.iter().max().unwrap());
                assert!(most < 1.02 * even + 10.0, "{ranks} {levels}: {counts:?}");
            }
        }
    }
}
