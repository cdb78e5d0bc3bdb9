//! What is near a point.

use super::facts::IMAGE;
use super::lists::Lists;
use super::near::{INFLATION, near_box, push_places};
use super::sequence::Eight;
use crate::numerics::dispatch::{Vectorised, instructions};
use crate::numerics::kernel::SUPPORT;
use crate::numerics::lanes::{LANES, Lanes as Vector};

/// Memory of searches.
#[derive(Debug, Clone)]
pub struct PointSearch {
    places: Vec<u32>,
    hints: [usize; 64],
}

impl Default for PointSearch {
    fn default() -> Self {
        Self {
            places: Vec::new(),
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
    /// The places in the lists, in canonical order, of those particles of this rank and group, and no others,
    /// in whose support a point (m) may be.
    pub fn own(&mut self, lists: &Lists, group: usize, point: &[f64; 3]) -> &[u32] {
        let used = instructions().run(Work {
            lists,
            group,
            point,
            search: self,
        });
        &self.places[..used]
    }
}

impl Vectorised for Work<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<V: Vector>(self) -> usize {
        let PointSearch { places, hints } = self.search;
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
        let mut used = 0;
        let found = |first: usize, bits: u8, eight: &Eight| {
            let own = bits & own(eight.special);
            used = push_places(places, used, first, own);
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
