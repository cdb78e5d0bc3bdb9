//! Images near a point.

use super::facts::IMAGE;
use super::lists::Lists;
use super::near::{INFLATION, near_box, push_numbers, push_places};
use super::sequence::Eight;
use numerics::dispatch::{Vectorised, instructions};
use numerics::kernel::SUPPORT;
use numerics::lanes::{LANES, Lanes as Vector};

/// Memory of searches, and what they have found.
#[derive(Debug, Clone)]
pub struct PointSearch {
    places: Vec<u32>,
    /// Squares of their distances (m²).
    squares: Vec<f64>,
    used: usize,
    hints: [usize; 64],
}

impl Default for PointSearch {
    fn default() -> Self {
        Self {
            places: Vec::new(),
            squares: Vec::new(),
            used: 0,
            hints: [0; 64],
        }
    }
}

struct Work<'a> {
    lists: &'a Lists,
    group: usize,
    point: &'a [f64; 3],
    search: &'a mut PointSearch,
}

impl PointSearch {
    /// Forgets what was found.
    pub fn begin(&mut self) {
        self.used = 0;
    }

    /// Places in the lists of what was found, in canonical order search after search.
    #[must_use]
    pub fn found(&self) -> &[u32] {
        &self.places[..self.used]
    }

    /// Squares of the distances (m²) of eight of what was found from `first` on, beyond the last one whatever.
    ///
    /// # Panics
    /// If nothing stands at `first`.
    #[inline(always)]
    #[must_use]
    pub fn squares(&self, first: usize) -> &[f64; LANES] {
        let squares = self.squares[first..].first_chunk();
        squares.expect("the array is padded")
    }

    /// Finds those particles of this rank and group, and no others, in whose support a point (m) may be.
    pub fn own(&mut self, lists: &Lists, group: usize, point: &[f64; 3]) {
        self.used = instructions().run(Work {
            lists,
            group,
            point,
            search: self,
        });
    }

    /// Keeps those found from `begin` on whose places are `wanted`.
    pub fn keep(&mut self, begin: usize, wanted: impl Fn(u32) -> bool) {
        let mut end = begin;
        for at in begin..self.used {
            if wanted(self.places[at]) {
                self.places[end] = self.places[at];
                self.squares[end] = self.squares[at];
                end += 1;
            }
        }
        self.used = end;
    }
}

impl Vectorised for Work<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<V: Vector>(self) -> usize {
        let PointSearch {
            places,
            squares,
            used,
            hints,
        } = self.search;
        let sequence = self.lists.sequence();
        let (longest, uniform) = self.lists.support(self.group);
        let far = V::splat(longest * INFLATION);
        let range = |eight: &Eight| {
            if uniform {
                far
            } else {
                V::read(eight.lengths).mul(V::splat(SUPPORT * INFLATION))
            }
        };
        let mut used = *used;
        let found = |first: usize, bits: u8, eight: &Eight, square: V| {
            let own = bits & own(eight.special);
            if own != 0 {
                push_numbers(squares, used, &square.store().0, own);
                used = push_places(places, used, first, own);
            }
        };
        let bounds = (self.point, self.point);
        near_box(
            sequence,
            self.group,
            bounds,
            longest * INFLATION,
            hints,
            range,
            found,
        );
        used
    }
}

/// A bit for each of eight images that is a particle of this rank itself.
#[inline(always)]
fn own(special: &[u8; LANES]) -> u8 {
    if u64::from_le_bytes(*special) & u64::from_le_bytes([IMAGE; LANES]) == 0 {
        return u8::MAX;
    }
    let bit = |k: usize| u8::from(special[k] & IMAGE == 0) << k;
    (0..LANES).fold(0, |bits, k| bits | bit(k))
}
