//! Distances between eight receivers and one neighbour after another.

use super::gradient::MotionRecord;
use super::lanes::Lanes;

/// Squares of distances are never smaller than this (m²), so that a particle meeting itself
/// divides by something: it then adds an exact zero since its `r_ij` is zero.
const SMALLEST_SQUARE: f64 = 1e-60;

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
    pub(super) fn begin(position: &[V; 3], source: &[f64; 3]) -> Self {
        let r = apart(position, source);
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

/// `x_i − x_j` (m).
#[inline(always)]
fn apart<V: Lanes>(position: &[V; 3], source: &[f64; 3]) -> [V; 3] {
    let along = |a: usize| position[a].sub(V::splat(source[a]));
    [along(0), along(1), along(2)]
}

/// The neighbours of a cluster one after the other. Roots and quotients take longer than a
/// processor looks ahead: they are begun seven neighbours before they are wanted, and wait in memory.
pub(super) struct Separations<'a, V> {
    position: [V; 3],
    sources: &'a [MotionRecord],
    neighbours: &'a [u32],
    /// Square, distance and inverse of the neighbour k at `k % AHEAD`.
    roots: [[V; 3]; AHEAD],
}

/// A power of two.
const AHEAD: usize = 8;

impl<'a, V: Lanes> Separations<'a, V> {
    /// Of receivers at `position` (m); there must be neighbours.
    #[inline(always)]
    pub(super) fn new(
        position: [V; 3],
        sources: &'a [MotionRecord],
        neighbours: &'a [u32],
    ) -> Self {
        let mut all = Self {
            position,
            sources,
            neighbours,
            roots: [[V::splat(0.0); 3]; AHEAD],
        };
        for k in 0..AHEAD - 1 {
            all.begin(k);
        }
        all
    }

    #[inline(always)]
    fn begin(&mut self, k: usize) {
        let place = self.neighbours[k.min(self.neighbours.len() - 1)] as usize;
        let begun = Separation::begin(&self.position, &self.sources[place].position);
        self.roots[k % AHEAD] = [begun.square, begun.distance, begun.inverse];
    }

    /// The neighbour k, which comes after the neighbour k − 1: its place, its record, and where the
    /// receivers are.
    #[inline(always)]
    pub(super) fn get(&mut self, k: usize) -> (usize, &'a MotionRecord, Separation<V>) {
        self.begin(k + AHEAD - 1);
        let place = self.neighbours[k] as usize;
        let source = &self.sources[place];
        let [square, distance, inverse] = self.roots[k % AHEAD];
        let separation = Separation {
            r: apart(&self.position, &source.position),
            square,
            distance,
            inverse,
        };
        (place, source, separation)
    }
}
