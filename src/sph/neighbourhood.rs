//! The receivers of one cluster with their neighbours: what all sums over pairs begin with.

use crate::neighbours::MotionRecord;
use crate::numerics::kernel::{PairKernel, PairScale};
use crate::numerics::lanes::{LANES, Lanes};

/// Squares of distances are never smaller than this (m²), so that a particle meeting itself
/// divides by something: it then adds an exact zero since its `r_ij` is zero.
pub const SMALLEST_SQUARE: f64 = 1e-60;

/// What a sweep sees of all particles and images.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a, S> {
    /// Their motion.
    pub records: &'a [MotionRecord],
    /// Their smoothing lengths (m); empty where the scale is constant.
    pub lengths: &'a [f64],
    /// Smoothing length of pairs.
    pub scale: S,
}

impl<'a, S: PairScale> Sources<'a, S> {
    /// Eight receivers, of which unused lanes repeat a valid one, with the neighbours of all of
    /// them together, in canonical order.
    #[inline(always)]
    #[must_use]
    pub fn around(self, receivers: [u32; LANES], neighbours: &'a [u32]) -> Neighbourhood<'a, S> {
        Neighbourhood {
            sources: self,
            receivers,
            neighbours,
        }
    }
}

/// The receivers of one cluster with their neighbours; sums go in the order of `neighbours`.
#[derive(Debug, Clone, Copy)]
pub struct Neighbourhood<'a, S> {
    pub(super) sources: Sources<'a, S>,
    pub(super) receivers: [u32; LANES],
    pub(super) neighbours: &'a [u32],
}

impl<'a, S: PairScale> Neighbourhood<'a, S> {
    /// Position (m) and velocity (m/s) of the receivers.
    #[inline(always)]
    pub(super) fn motion<V: Lanes>(&self) -> ([V; 3], [V; 3]) {
        let receivers = records(self.sources.records, &self.receivers);
        (
            gather_all(&receivers, |record, a| record.position[a]),
            gather_all(&receivers, |record, a| record.velocity[a]),
        )
    }

    /// Smoothing lengths of the receivers (m), whatever if the scale is constant.
    #[inline(always)]
    pub(super) fn h<V: Lanes>(&self) -> V {
        let at = |k: usize| length::<S>(self.sources.lengths, self.receivers[k] as usize);
        V::read(&[at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)])
    }

    /// The receivers, which stand at `position` (m), with one neighbour after the other. A particle
    /// whose position is NaN has none, not even itself.
    #[inline(always)]
    pub(super) fn pairs<V: Lanes>(&self, position: &[V; 3]) -> Pairs<'a, V, S> {
        let first = self.neighbours.first().copied().unwrap_or_default();
        let first = &self.sources.records[first as usize];
        Pairs {
            around: *self,
            position: *position,
            h: self.h(),
            done: 0,
            next: Separation::begin(position, &first.position),
        }
    }
}

/// Eight receivers and one neighbour.
pub(super) struct Pair<'a, V> {
    /// Index of the neighbour among all sources.
    pub(super) index: usize,
    /// The neighbour.
    pub(super) source: &'a MotionRecord,
    /// How they stand.
    pub(super) separation: Separation<V>,
    /// The kernel.
    pub(super) kernel: PairKernel<V>,
}

/// Pairs of eight receivers, neighbour after neighbour. The next one is begun before the last is
/// given: its root takes long.
pub(super) struct Pairs<'a, V, S> {
    around: Neighbourhood<'a, S>,
    position: [V; 3],
    h: V,
    done: usize,
    next: Separation<V>,
}

impl<'a, V: Lanes, S: PairScale> Iterator for Pairs<'a, V, S> {
    type Item = Pair<'a, V>;

    #[inline(always)]
    fn next(&mut self) -> Option<Pair<'a, V>> {
        let Sources {
            records,
            lengths,
            scale,
        } = self.around.sources;
        let neighbours = self.around.neighbours;
        let count = neighbours.len();
        if self.done == count {
            return None;
        }
        let (index, separation) = (neighbours[self.done] as usize, self.next);
        self.done += 1;
        let following = neighbours[self.done.min(count - 1)] as usize;
        self.next = Separation::begin(&self.position, &records[following].position);
        Some(Pair {
            index,
            source: &records[index],
            separation,
            kernel: scale.kernel(separation.distance, self.h, length::<S>(lengths, index)),
        })
    }
}

/// The records of eight receivers. (Written out, since what array methods call may be compiled
/// apart from the vector code.)
#[inline(always)]
pub(super) fn records<'a, R>(sources: &'a [R], indices: &[u32; LANES]) -> [&'a R; LANES] {
    let at = |k: usize| &sources[indices[k] as usize];
    [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]
}

/// One number of each of eight records.
#[inline(always)]
pub(super) fn gather<V: Lanes, R>(records: &[&R; LANES], number: impl Fn(&R) -> f64) -> V {
    let at = |k: usize| number(records[k]);
    V::read(&[at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)])
}

/// `N` numbers of each of eight records.
#[inline(always)]
pub(super) fn gather_all<V: Lanes, R, const N: usize>(
    records: &[&R; LANES],
    number: impl Fn(&R, usize) -> f64,
) -> [V; N] {
    let mut all = [V::splat(0.0); N];
    for c in 0..N {
        all[c] = gather(records, |record| number(record, c));
    }
    all
}

/// Smoothing length of a neighbour (m), whatever if the scale is constant.
#[inline(always)]
fn length<S: PairScale>(lengths: &[f64], index: usize) -> f64 {
    if S::VARIABLE { lengths[index] } else { 0.0 }
}

/// Where eight receivers stand seen from one neighbour, with the distances.
#[derive(Clone, Copy)]
pub(super) struct Separation<V> {
    /// `x_i − x_j` (m).
    pub(super) r: [V; 3],
    /// Its square (m²), not below [`SMALLEST_SQUARE`].
    pub(super) square: V,
    /// `r` (m).
    pub(super) distance: V,
    /// `1/r` (1/m).
    pub(super) inverse: V,
}

impl<V: Lanes> Separation<V> {
    #[inline(always)]
    fn begin(position: &[V; 3], source: &[f64; 3]) -> Self {
        let along = |a: usize| position[a].sub(V::splat(source[a]));
        let r = [along(0), along(1), along(2)];
        let square = r[2].mul_add(r[2], r[1].mul_add(r[1], r[0].mul(r[0])));
        let square = square.max(V::splat(SMALLEST_SQUARE));
        let distance = square.sqrt();
        Self {
            r,
            square,
            distance,
            inverse: V::splat(1.0).div(distance),
        }
    }
}
