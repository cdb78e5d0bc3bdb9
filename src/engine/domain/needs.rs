//! Particles that ranks need, and the images of them.

use numerics::ordered::{disordered, ordered};
use particles::{MirrorMask, Mirrors};

/// The box around a rank's particles, and how far these reach: what it tells those that are near before the
/// exchange.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Extent {
    /// Smallest and largest coordinates of its particles (m).
    pub(super) lower: [f64; 3],
    pub(super) upper: [f64; 3],
    /// Largest reach of its particles (m).
    pub(super) reach: f64,
}

/// Distances that differ by this factor are the same but for rounding.
pub(super) const ROUNDING: f64 = 1.0 + 1e-12;

impl Extent {
    pub(super) const EMPTY: Self = Self {
        lower: [f64::INFINITY; 3],
        upper: [f64::NEG_INFINITY; 3],
        reach: 0.0,
    };

    /// Number of words of one.
    pub(super) const WORDS: usize = 7;

    #[inline]
    pub(super) fn add(&mut self, position: &[f64; 3], reach: f64) {
        for (a, &x) in position.iter().enumerate() {
            self.lower[a] = self.lower[a].min(x);
            self.upper[a] = self.upper[a].max(x);
        }
        self.reach = self.reach.max(reach);
    }

    pub(super) fn join(self, other: Self) -> Self {
        Self {
            lower: std::array::from_fn(|a| self.lower[a].min(other.lower[a])),
            upper: std::array::from_fn(|a| self.upper[a].max(other.upper[a])),
            reach: self.reach.max(other.reach),
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.lower[0] > self.upper[0]
    }

    /// Words whose smallest over some extents are those of all of them together.
    pub(super) fn words(&self) -> [u64; Self::WORDS] {
        let [a, b, c] = self.lower.map(ordered);
        let [d, e, f] = self.upper.map(|x| !ordered(x));
        [a, b, c, d, e, f, !ordered(self.reach)]
    }

    /// Takes [`Self::words`], or what is larger than any.
    pub(super) fn of_words(words: &[u64]) -> Self {
        if words[0] == u64::MAX {
            return Self::EMPTY;
        }
        let most = |k: usize| disordered(!words[k]);
        Self {
            lower: std::array::from_fn(|a| disordered(words[a])),
            upper: std::array::from_fn(|a| most(3 + a)),
            reach: most(6),
        }
    }

    /// True if particles of the two may be within each other's reach; whoever asks gets the same
    /// answer. Images behind planes are never nearer than their particles.
    pub(super) fn may_need(&self, other: &Self) -> bool {
        if self.is_empty() || other.is_empty() {
            return false;
        }
        self.is_near((&other.lower, &other.upper), self.reach + other.reach)
    }

    /// True if another box between two corners (m), which may be a place, is within a range (m) of this one.
    #[inline]
    pub(super) fn is_near(&self, (lower, upper): (&[f64; 3], &[f64; 3]), range: f64) -> bool {
        let square = |a: usize| {
            let gap = (lower[a] - self.upper[a]).max(self.lower[a] - upper[a]);
            gap.max(0.0) * gap.max(0.0)
        };
        square(0) + square(1) + square(2) <= range * range * ROUNDING
    }
}

/// A particle that a rank needs (this rank itself, or the peer of an index), and the mirror masks of the
/// images that it needs of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Needed {
    pub(super) particle: u32,
    pub(super) needs: u8,
    pub(super) peer: u16,
}

/// `Needed::peer` of this rank itself.
pub(super) const MYSELF: u16 = u16::MAX;

/// Tells who needs a particle.
pub(super) struct Finder<'a> {
    mirrors: &'a Mirrors,
    mine: Extent,
    theirs: &'a [Extent],
    /// Largest reach of all ranks that may need a particle, this one too (m).
    farthest: f64,
    /// The box between the peers: along each axis those beside it begin there (m), infinite where
    /// there are none.
    between: [[f64; 3]; 2],
}

impl<'a> Finder<'a> {
    pub(super) fn new(mirrors: &'a Mirrors, mine: Extent, theirs: &'a [Extent]) -> Self {
        let mut between = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
        let mut farthest = mine.reach;
        for there in theirs {
            farthest = farthest.max(there.reach);
            let before = |a: usize| (mine.lower[a] - there.upper[a], 0, a);
            let beyond = |a: usize| (there.lower[a] - mine.upper[a], 1, a);
            let sides = (0..3).flat_map(|a| [before(a), beyond(a)]);
            let (_, side, a) = sides
                .max_by(|(gap, ..), (other, ..)| gap.total_cmp(other))
                .expect("there are six sides");
            // Its particles are not nearer than this side of them.
            if side == 0 {
                between[0][a] = between[0][a].max(there.upper[a]);
            } else {
                between[1][a] = between[1][a].min(there.lower[a]);
            }
        }
        Self {
            mirrors,
            mine,
            theirs,
            farthest,
            between,
        }
    }

    /// Notes who needs particle `i` at `position` (m) or its images, which reaches so far (m).
    #[inline]
    pub(super) fn find(&self, i: usize, position: &[f64; 3], reach: f64, found: &mut Vec<Needed>) {
        let range = reach + self.farthest;
        let near = self.mirrors.near(position, range);
        if !near.is_own() {
            note(
                self,
                (i, position),
                (MYSELF, &self.mine),
                (near, reach),
                found,
            );
        }
        let [lower, upper] = &self.between;
        let is_deep = |a: usize| {
            let depth = (position[a] - lower[a]).min(upper[a] - position[a]);
            depth > range * ROUNDING
        };
        if (0..3).all(is_deep) {
            return;
        }
        if near.is_own() {
            // It has no images.
            for (peer, there) in (0..).zip(self.theirs) {
                if there.is_near((position, position), reach + there.reach) {
                    found.push(needed(i, peer, 1));
                }
            }
            return;
        }
        for (peer, there) in (0..).zip(self.theirs) {
            note(self, (i, position), (peer, there), (near, reach), found);
        }
    }
}

/// Notes which images of a particle a rank needs, if any.
#[inline]
fn note(
    finder: &Finder,
    (i, position): (usize, &[f64; 3]),
    (peer, there): (u16, &Extent),
    (near, reach): (MirrorMask, f64),
    found: &mut Vec<Needed>,
) {
    let mut needs = 0;
    for mirror_mask in near.subsets(peer != MYSELF) {
        let image = finder.mirrors.reflect_position(position, mirror_mask);
        if there.is_near((&image, &image), reach + there.reach) {
            needs |= 1 << mirror_mask.bits();
        }
    }
    if needs != 0 {
        found.push(needed(i, peer, needs));
    }
}

fn needed(i: usize, peer: u16, needs: u8) -> Needed {
    #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
    let particle = i as u32;
    Needed {
        particle,
        needs,
        peer,
    }
}
