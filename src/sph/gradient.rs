//! Velocity gradient `L_i = −Σ_j V_j v_ij ⊗ ∇W_ij` (physics page, section 2).

use super::dispatch::Vectorised;
use super::kernel::PairScale;
use super::lanes::{F64x8, LANES, Lanes};

/// What a particle shows to its neighbours of its motion: one cache line.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub struct MotionRecord {
    /// Position (m).
    pub position: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Volume m/ρ (m^d).
    pub volume: f64,
    /// Mass (kg).
    pub mass: f64,
}

/// Squares of distances are never smaller than this (m²), so that a particle meeting itself
/// divides by something: it then adds an exact zero since its `r_ij` is zero.
pub const SMALLEST_SQUARE: f64 = 1e-60;

/// The receivers of one cluster with their neighbours; sums in the order of `neighbours`.
pub struct VelocityGradient<'a, S> {
    /// All particles and images.
    pub sources: &'a [MotionRecord],
    /// Smoothing lengths (m) of these; empty where the scale is constant.
    pub lengths: &'a [f64],
    /// Receivers; unused lanes repeat a valid one.
    pub receivers: [u32; LANES],
    /// Neighbours, in canonical order, those of all receivers together.
    pub neighbours: &'a [u32],
    /// Smoothing length of pairs.
    pub scale: S,
}

impl<S: PairScale> Vectorised for VelocityGradient<'_, S> {
    /// Row-major `L` (1/s).
    type Output = [F64x8; 9];

    #[inline(always)]
    fn run<V: Lanes>(self) -> [F64x8; 9] {
        let receivers = records(self.sources, &self.receivers);
        let position = gather3::<V, _>(&receivers, |record, a| record.position[a]);
        let velocity = gather3::<V, _>(&receivers, |record, a| record.velocity[a]);
        let h_i = lengths::<V, S>(self.lengths, &self.receivers);
        let mut gradient = [V::splat(0.0); 9];
        // A particle whose position is no number has no neighbours, not even itself.
        let count = self.neighbours.len();
        if count == 0 {
            return [F64x8([0.0; LANES]); 9];
        }
        let begin = |k: usize| {
            let place = self.neighbours[k.min(count - 1)] as usize;
            (place, &self.sources[place])
        };
        let mut following = begin(0);
        let mut next = Separation::begin(&position, &following.1.position);
        for k in 0..count {
            let ((place, here), now) = (following, next);
            following = begin(k + 1);
            next = Separation::begin(&position, &following.1.position);
            let kernel = self
                .scale
                .kernel(now.distance, h_i, length::<S>(self.lengths, place));
            let factor = now.inverse.mul(V::splat(here.volume)).mul(kernel.slope);
            for a in 0..3 {
                let v_a = V::splat(here.velocity[a]).sub(velocity[a]).mul(factor);
                for b in 0..3 {
                    gradient[3 * a + b] = v_a.mul_add(now.r[b], gradient[3 * a + b]);
                }
            }
        }
        gradient.map(V::store)
    }
}

/// The records of eight receivers. (Written out, since what array methods call may be compiled
/// apart from the vector code.)
#[inline(always)]
pub(super) fn records<'a, R>(sources: &'a [R], places: &[u32; LANES]) -> [&'a R; LANES] {
    let at = |k: usize| &sources[places[k] as usize];
    [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]
}

/// One number of each of eight records.
#[inline(always)]
pub(super) fn gather<V: Lanes, R>(records: &[&R; LANES], number: impl Fn(&R) -> f64) -> V {
    let at = |k: usize| number(records[k]);
    V::read(&[at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)])
}

/// Three numbers of each of eight records.
#[inline(always)]
pub(super) fn gather3<V: Lanes, R>(
    records: &[&R; LANES],
    number: impl Fn(&R, usize) -> f64,
) -> [V; 3] {
    [
        gather(records, |record| number(record, 0)),
        gather(records, |record| number(record, 1)),
        gather(records, |record| number(record, 2)),
    ]
}

/// Smoothing length of a neighbour (m), whatever if the scale is constant.
#[inline(always)]
pub(super) fn length<S: PairScale>(lengths: &[f64], place: usize) -> f64 {
    if S::VARIABLE { lengths[place] } else { 0.0 }
}

/// Smoothing lengths of eight receivers (m), whatever if the scale is constant.
#[inline(always)]
pub(super) fn lengths<V: Lanes, S: PairScale>(lengths: &[f64], places: &[u32; LANES]) -> V {
    let at = |k: usize| length::<S>(lengths, places[k] as usize);
    V::read(&[at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)])
}

/// Where eight receivers stand seen from one neighbour, with the distances. The sweeps
/// begin the next neighbour before they finish the last: its root takes long.
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
