//! Slabs of slabs of space, between faces normal to one axis, then another, then the third.

use std::ops::Range;

use populate::Brick;

/// Division of space among ranks.
pub trait Decomposition {
    /// The rank that owns a position (m).
    fn owner(&self, position: &[f64; 3]) -> usize;

    /// The box of space that a rank owns (m), infinite at the outside.
    fn region(&self, rank: usize) -> Brick;
}

/// Space cut into slabs normal to the axis of level 0, each of these into slabs normal to the axis
/// of level 1, and so on; each rank owns one of the last level, which may be empty.
///
/// The number of ranks alone tells how many slabs a slab is cut into: all levels cut about as often,
/// and ranks are shared out as evenly as integers allow. Ranks are numbered in the
/// order of the slabs, depth first, so those of the last axis follow each other. Between ranks r and
/// r + 1 there is one face, of the level where their slabs part: as many faces as ranks, less one.
#[derive(Debug, Clone, PartialEq)]
pub struct NestedSlabs {
    axes: [usize; 3],
    levels: usize,
    /// How the first level cuts space.
    first: Cut,
    /// The face between ranks r and r + 1 (m) at place r; ascending among those that cut the same
    /// slab. A point on a face belongs to the slab above.
    faces: Vec<f64>,
}

/// A slab of some level: the ranks that share it, and how many levels cut it further.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Slab {
    first: usize,
    end: usize,
    /// Levels that cut it.
    levels: usize,
}

impl Slab {
    /// All of space, cut for so many ranks by so many levels.
    pub(super) fn whole(ranks: usize, levels: usize) -> Self {
        Self {
            first: 0,
            end: ranks,
            levels,
        }
    }

    /// The ranks that share it.
    pub(super) fn ranks(&self) -> Range<usize> {
        self.first..self.end
    }

    /// How the next level cuts it.
    #[inline(always)]
    pub(super) fn cut(self) -> Cut {
        let (ranks, parts) = (self.end - self.first, self.parts());
        Cut {
            slab: self,
            parts,
            each: ranks / parts,
            more: ranks % parts,
        }
    }

    /// Number of slabs into which the next level cuts it: of its last level one for each rank, else
    /// the smallest that, if all levels cut as often, is enough for its ranks.
    #[inline(always)]
    fn parts(&self) -> usize {
        let ranks = self.end - self.first;
        match self.levels {
            2 if ranks > 0 => (ranks - 1).isqrt() + 1,
            3 => {
                #[allow(
                    clippy::cast_possible_truncation,
                    clippy::cast_precision_loss,
                    clippy::cast_sign_loss,
                    reason = "a first guess"
                )]
                let mut parts = libm::cbrt(ranks as f64) as usize;
                while parts * parts * parts < ranks {
                    parts += 1;
                }
                parts.max(1)
            }
            _ => ranks,
        }
    }

    /// True if it is cut: it has more ranks than one.
    #[inline(always)]
    pub(super) fn is_cut(&self) -> bool {
        self.levels > 0 && self.end - self.first > 1
    }
}

/// A slab with more ranks than one, and how they are shared out among its parts: those with one rank more come first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Cut {
    slab: Slab,
    parts: usize,
    /// Ranks of a part at least, and parts with one more.
    each: usize,
    more: usize,
}

impl Cut {
    /// Number of parts.
    #[inline(always)]
    pub(super) fn parts(&self) -> usize {
        self.parts
    }

    /// The first rank of a part, from 0 on; beyond the last part the end.
    #[inline(always)]
    fn start(&self, part: usize) -> usize {
        self.slab.first + part * self.each + part.min(self.more)
    }

    /// A part.
    #[inline(always)]
    pub(super) fn part(&self, part: usize) -> Slab {
        Slab {
            first: self.start(part),
            end: self.start(part + 1),
            levels: self.slab.levels - 1,
        }
    }

    /// All parts.
    pub(super) fn all(self) -> impl Iterator<Item = Slab> {
        (0..self.parts).map(move |part| self.part(part))
    }

    /// The part of a rank.
    pub(super) fn part_of(&self, rank: usize) -> usize {
        let within = rank - self.slab.first;
        let longer = self.more * (self.each + 1);
        if within < longer {
            within / (self.each + 1)
        } else {
            self.more + (within - longer) / self.each
        }
    }

    /// The place of the face below a part, which is not the first.
    #[inline(always)]
    fn place(&self, part: usize) -> usize {
        self.start(part) - 1
    }

    /// The places of the faces between the parts.
    pub(super) fn places(self) -> impl ExactSizeIterator<Item = usize> {
        (1..self.parts).map(move |part| self.place(part))
    }

    /// Sets the ends of a part along an axis in the box of the slab, between these faces (m).
    #[inline(always)]
    pub(super) fn narrow(&self, brick: &mut Brick, axis: usize, part: usize, faces: &[f64]) {
        if part > 0 {
            brick.lower[axis] = faces[self.place(part)];
        }
        if part + 1 < self.parts {
            brick.upper[axis] = faces[self.place(part + 1)];
        }
    }

    /// Index of the part, between these faces (m), that holds a coordinate.
    #[inline(always)]
    pub(super) fn part_at(&self, x: f64, faces: &[f64]) -> usize {
        self.part_between([0, self.parts - 1], x, faces)
    }

    /// The same, known to be between two parts.
    #[inline(always)]
    pub(super) fn part_between(
        &self,
        [mut least, mut end]: [usize; 2],
        x: f64,
        faces: &[f64],
    ) -> usize {
        // The first part whose upper face is above.
        while least < end {
            let middle = usize::midpoint(least, end);
            if faces[self.place(middle + 1)] <= x {
                least = middle + 1;
            } else {
                end = middle;
            }
        }
        least
    }

    /// As [`Self::part_at`], sought from a part on that is not beyond.
    #[inline(always)]
    pub(super) fn part_from(&self, mut part: usize, x: f64, faces: &[f64]) -> usize {
        while part + 1 < self.parts && faces[self.place(part + 1)] <= x {
            part += 1;
        }
        part
    }
}

impl NestedSlabs {
    /// Slabs of one level between ascending `faces` (m), one fewer than ranks.
    #[must_use]
    pub fn new(axis: usize, faces: Vec<f64>) -> Self {
        Self::nested([axis, (axis + 1) % 3, (axis + 2) % 3], 1, faces)
    }

    /// Slabs of one, two or three levels along the first of `axes` (0, 1, 2) between `faces` (m):
    /// at place r that between ranks r and r + 1, one fewer than ranks.
    #[must_use]
    pub fn nested(axes: [usize; 3], levels: usize, faces: Vec<f64>) -> Self {
        debug_assert!((1..=3).contains(&levels));
        let slabs = Self {
            axes,
            levels,
            first: Slab::whole(faces.len() + 1, levels).cut(),
            faces,
        };
        debug_assert!(slabs.are_sorted(slabs.whole()));
        slabs
    }

    /// The same between any faces (m): those that cut the same slab are put in order.
    #[must_use]
    pub fn of_any(axes: [usize; 3], levels: usize, faces: Vec<f64>) -> Self {
        let mut slabs = Self {
            axes,
            levels,
            first: Slab::whole(faces.len() + 1, levels).cut(),
            faces,
        };
        slabs.sort(slabs.whole());
        slabs
    }

    /// Everything in the first slab at each level, for so many ranks.
    #[must_use]
    pub fn on_first(axes: [usize; 3], levels: usize, ranks: usize) -> Self {
        Self::nested(axes, levels, vec![f64::INFINITY; ranks - 1])
    }

    /// Becomes [`Self::on_first`] for so many ranks in place.
    pub(super) fn reset(&mut self, axes: [usize; 3], levels: usize, ranks: usize) {
        (self.axes, self.levels) = (axes, levels);
        self.first = Slab::whole(ranks, levels).cut();
        self.faces.clear();
        self.faces.resize(ranks - 1, f64::INFINITY);
    }

    /// The faces (m), one fewer than ranks: at place r that between ranks r and r + 1.
    #[must_use]
    pub fn faces(&self) -> &[f64] {
        &self.faces
    }

    /// Number of levels.
    #[must_use]
    pub fn levels(&self) -> usize {
        self.levels
    }

    /// Axis normal to the faces of a level (0, 1, 2), from level 0 on.
    #[must_use]
    pub fn axis(&self, level: usize) -> usize {
        self.axes[level]
    }

    /// Axes of all levels (0, 1, 2), those that cut nothing last.
    #[must_use]
    pub fn axes(&self) -> [usize; 3] {
        self.axes
    }

    /// Number of ranks.
    #[must_use]
    pub fn ranks(&self) -> usize {
        self.faces.len() + 1
    }

    /// True if the faces that cut the same slab ascend.
    #[must_use]
    pub fn is_sorted(&self) -> bool {
        self.are_sorted(self.whole())
    }

    /// All of space.
    pub(super) fn whole(&self) -> Slab {
        Slab::whole(self.ranks(), self.levels)
    }

    /// The axis across which a slab is cut.
    pub(super) fn axis_of(&self, slab: Slab) -> usize {
        self.axes[self.levels - slab.levels]
    }

    /// The faces (m) to be moved.
    pub(super) fn faces_mut(&mut self) -> &mut [f64] {
        &mut self.faces
    }

    fn sort(&mut self, slab: Slab) {
        if !slab.is_cut() {
            return;
        }
        let cut = slab.cut();
        let mut faces: Vec<f64> = cut.places().map(|place| self.faces[place]).collect();
        faces.sort_by(f64::total_cmp);
        for (place, face) in cut.places().zip(faces) {
            self.faces[place] = face;
        }
        cut.all().for_each(|part| self.sort(part));
    }

    fn are_sorted(&self, slab: Slab) -> bool {
        if !slab.is_cut() {
            return true;
        }
        let cut = slab.cut();
        cut.places().map(|place| self.faces[place]).is_sorted()
            && cut.all().all(|part| self.are_sorted(part))
    }
}

impl Decomposition for NestedSlabs {
    #[inline]
    fn owner(&self, position: &[f64; 3]) -> usize {
        let (mut slab, mut cut) = (self.whole(), self.first);
        for (level, &axis) in self.axes[..self.levels].iter().enumerate() {
            if !slab.is_cut() {
                break;
            }
            if level > 0 {
                cut = slab.cut();
            }
            slab = cut.part(cut.part_at(position[axis], &self.faces));
        }
        slab.first
    }

    fn region(&self, rank: usize) -> Brick {
        let mut brick = Brick::OPEN;
        let mut slab = self.whole();
        while slab.is_cut() {
            let axis = self.axis_of(slab);
            let cut = slab.cut();
            let part = cut.part_of(rank);
            cut.narrow(&mut brick, axis, part, &self.faces);
            slab = cut.part(part);
        }
        brick
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_face_belongs_to_the_slab_above_and_slabs_may_be_empty() {
        let slabs = NestedSlabs::new(0, vec![1.0, 2.0, 2.0]);
        let owner = |x: f64| slabs.owner(&[x, 0.0, 0.0]);
        assert_eq!([-9.0, 1.0, 1.5, 2.0, 7.0].map(owner), [0, 1, 1, 3, 3]);
        assert_eq!(slabs.region(2), Brick::slab(0, 2.0, 2.0));
        assert_eq!(slabs.region(0), Brick::slab(0, f64::NEG_INFINITY, 1.0));
    }

    /// Ranks of the slabs that a slab of so many levels is cut into.
    fn shares(ranks: usize, levels: usize) -> Vec<usize> {
        let parts = Slab::whole(ranks, levels).cut().all();
        parts.map(|part| part.ranks().len()).collect()
    }

    #[test]
    fn ranks_are_shared_out_evenly() {
        assert_eq!(shares(7, 1), [1; 7]);
        assert_eq!(shares(7, 2), [3, 2, 2]);
        assert_eq!(shares(7, 3), [4, 3]);
        assert_eq!(shares(2, 3), [1, 1]);
        assert_eq!(shares(8, 3), [4, 4]);
        assert_eq!(shares(9, 2), [3, 3, 3]);
        assert_eq!(shares(10, 2), [3, 3, 2, 2]);
        assert_eq!(
            shares(10_000, 3),
            [[455; 12].as_slice(), &[454; 10]].concat()
        );
        assert_eq!(shares(10_000, 2), [100; 100]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        /// Each place, on faces too, has one owner, and it is in the region of its owner alone.
        #[test]
        fn owners_and_regions_agree(
            faces in prop::collection::vec(
                prop_oneof![8 => -3_i8..=3, 1 => Just(i8::MIN), 1 => Just(i8::MAX)], 0..40),
            levels in 1_usize..=3,
            first in 0_usize..3,
            back in any::<bool>(),
            places in prop::collection::vec(prop::array::uniform3(-8_i8..=8), 1..30),
        ) {
            let (second, third) = ((first + 1) % 3, (first + 2) % 3);
            let axes = if back { [first, third, second] } else { [first, second, third] };
            let face = |&face: &i8| match face {
                i8::MIN => f64::NEG_INFINITY,
                i8::MAX => f64::INFINITY,
                face => f64::from(face),
            };
            let slabs = NestedSlabs::of_any(axes, levels, faces.iter().map(face).collect());
            prop_assert!(slabs.is_sorted());
            for place in places {
                let x = place.map(|x| 0.5 * f64::from(x));
                let owner = slabs.owner(&x);
                for rank in 0..slabs.ranks() {
                    prop_assert_eq!(slabs.region(rank).holds(&x), rank == owner, "{:?} {}", x, rank);
                }
            }
        }

        /// For any ranks and levels every place of a face is that of one slab, and slabs of all levels
        /// end with one rank each.
        #[test]
        fn there_is_a_face_between_any_two_ranks(ranks in 1_usize..3000, levels in 1_usize..=3) {
            let mut places = Vec::new();
            let mut slabs = vec![Slab::whole(ranks, levels)];
            let mut lone = Vec::new();
            while let Some(slab) = slabs.pop() {
                if slab.is_cut() {
                    places.extend(slab.cut().places());
                    slabs.extend(slab.cut().all());
                } else {
                    prop_assert_eq!(slab.ranks().len(), 1);
                    lone.push(slab.first);
                }
            }
            places.sort_unstable();
            lone.sort_unstable();
            prop_assert!(places.into_iter().eq(0..ranks - 1));
            prop_assert!(lone.into_iter().eq(0..ranks));
        }
    }
}
