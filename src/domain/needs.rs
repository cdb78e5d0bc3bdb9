//! Who needs which particles, and which images of them.

use super::mirrors::{Mirrors, codes};

/// What a rank tells all others before the exchange.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    /// Smallest and largest coordinate of its particles along the slab axis (m).
    pub(super) lower: f64,
    pub(super) upper: f64,
    /// Largest reach of its particles (m).
    pub(super) reach: f64,
}

impl Extent {
    pub(super) const WORDS: usize = 3;
    pub(super) const EMPTY: Self = Self {
        lower: f64::INFINITY,
        upper: f64::NEG_INFINITY,
        reach: 0.0,
    };

    pub(super) fn join(self, other: Self) -> Self {
        Self {
            lower: self.lower.min(other.lower),
            upper: self.upper.max(other.upper),
            reach: self.reach.max(other.reach),
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.lower > self.upper
    }

    fn distance(&self, x: f64) -> f64 {
        (self.lower - x).max(x - self.upper).max(0.0)
    }
}

/// A particle that a rank needs (this rank itself, or the peer of an index), and the codes of the
/// images that it needs of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub(super) particle: u32,
    pub(super) needs: u8,
    pub(super) peer: u16,
}

/// `Found::peer` of this rank itself.
pub(super) const MYSELF: u16 = u16::MAX;
/// Tells who needs a particle.
pub(super) struct Finder<'a> {
    pub(super) axis: usize,
    pub(super) mirrors: &'a Mirrors,
    pub(super) mine: Extent,
    pub(super) theirs: &'a [Extent],
}

impl Finder<'_> {
    /// Notes who needs particle `i` at `position` or its images, within `range` (m).
    #[inline]
    pub(super) fn find(&self, i: usize, position: &[f64; 3], range: f64, found: &mut Vec<Found>) {
        let near = self.mirrors.near(position, range);
        let mut note = |peer: u16, there: &Extent, own: bool| {
            let mut needs = 0;
            for code in codes(near, own) {
                let image = self.mirrors.reflect_position(position, code);
                if there.distance(image[self.axis]) <= range {
                    needs |= 1 << code;
                }
            }
            if needs != 0 {
                #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
                let particle = i as u32;
                found.push(Found {
                    particle,
                    needs,
                    peer,
                });
            }
        };
        if near != 0 {
            note(MYSELF, &self.mine, false);
        }
        for (k, there) in self.theirs.iter().enumerate() {
            #[allow(clippy::cast_possible_truncation, reason = "few ranks are neighbours")]
            note(k as u16, there, true);
        }
    }
}
