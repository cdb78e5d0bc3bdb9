//! Part of space that some material fills: volume fractions in cubes (voxels).
//!
//! A particle is spread by a quadratic spline as wide as it is large, or as a voxel, so that an even filling
//! gives about one everywhere inside and a half at its faces. Fractions are whole numbers of
//! [`UNIT`]s, which add up to the same in any order: on any ranks and threads.
//!
//! Behind a symmetry plane that runs along the columns there is the image of what lies before it: half of the window
//! is kept, and what of a particle reaches beyond the plane is what its image gives on this side.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

use super::window::Window;
use comm::Comm;
use numerics::dispatch::{Vectorised, instructions};
use numerics::lanes::{LANES, Lanes};
use particles::{GRAIN, MirrorMask};

/// A full voxel; four fractions of 16 bits stand in a word, so that 32 times as much matter fits.
pub const UNIT: u16 = 1 << 11;

/// Least fraction of a voxel that belongs to the material.
pub const HALF: u16 = UNIT / 2;

/// Fractions in a word.
const IN_WORD: usize = 4;

/// Most voxels that a particle reaches along an axis; larger particles are spread less.
const REACH: usize = 3 * LANES;

/// Most words that a particle reaches along a column.
const WORDS: usize = REACH / IN_WORD + 1;

/// Doubles from here on have no fraction, up to twice as much: what is added to it is rounded to a whole number, in
/// the last bits.
const WHOLE: f64 = 4_503_599_627_370_496.0;

/// Weights of voxels along one axis, which add up to one: from the first of them.
struct Weights {
    first: i64,
    count: usize,
    values: [f64; REACH],
}

/// 0 to 7.
const RAMP: [f64; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

impl Weights {
    /// Of a particle at `at` edges from the beginning, `width` edges wide: of the quadratic spline, one unit wide at
    /// half its height, `½ ⟨3/2 − |u|⟩₊² − 3/2 ⟨1/2 − |u|⟩₊²`.
    #[inline(always)]
    fn new<V: Lanes>(at: f64, width: f64) -> Self {
        let reach = 1.5 * width;
        #[expect(clippy::cast_possible_truncation, reason = "a place near the window")]
        let (first, last) = (
            (at - reach - 0.5).ceil() as i64,
            (at + reach - 0.5).floor() as i64,
        );
        let count = usize::try_from(last - first + 1).unwrap_or(0).min(REACH);
        let mut values = [0.0; REACH];
        #[expect(clippy::cast_precision_loss, reason = "small")]
        let mut centre = V::read(&RAMP).add(V::splat(first as f64 + 0.5 - at));
        let (zero, scale) = (V::splat(0.0), V::splat(1.0 / width));
        let (inner, outer, half) = (V::splat(1.5), V::splat(0.5), V::splat(0.5));
        let mut all = zero;
        let eights = values.as_chunks_mut::<LANES>().0;
        for eight in &mut eights[..count.div_ceil(LANES)] {
            let u = centre.mul(scale);
            let u = u.max(zero.sub(u));
            let (a, b) = (inner.sub(u).max(zero), half.sub(u).max(zero));
            let weights = outer.mul(a).mul(a).sub(inner.mul(b).mul(b));
            all = all.add(weights);
            *eight = weights.store().0;
            centre = centre.add(V::splat(8.0));
        }
        let scale = V::splat(1.0 / all.store().0.iter().sum::<f64>());
        for eight in &mut eights[..count.div_ceil(LANES)] {
            *eight = V::read(eight).mul(scale).store().0;
        }
        Self {
            first,
            count,
            values,
        }
    }

    /// Puts those before a symmetry plane at the beginning on its other side.
    #[inline(always)]
    fn fold(&mut self) {
        let before = usize::try_from(-self.first).unwrap_or(0).min(self.count);
        if before == 0 {
            return;
        }
        let mut values = [0.0; REACH];
        let after = self.count - before;
        values[..after].copy_from_slice(&self.values[before..self.count]);
        for (value, other) in values.iter_mut().zip(self.values[..before].iter().rev()) {
            *value += other;
        }
        self.values = values;
        (self.first, self.count) = (0, after.max(before));
    }

    /// The voxels among `0..total` with their weights.
    #[inline(always)]
    fn inside(&self, total: usize) -> impl Iterator<Item = (usize, f64)> {
        let all = self.values[..self.count].iter().zip(self.first..);
        all.filter_map(move |(&weight, k)| {
            let k = usize::try_from(k).ok().filter(|&k| k < total)?;
            Some((k, weight))
        })
    }

    /// The same by words, and the first of these.
    #[inline(always)]
    fn words(&self, total: usize) -> (usize, [[f64; IN_WORD]; WORDS], usize) {
        let mut words = [[0.0; IN_WORD]; WORDS];
        let (mut begin, mut count) = (0, 0);
        for (k, weight) in self.inside(total) {
            if count == 0 {
                begin = k / IN_WORD;
            }
            let word = k / IN_WORD - begin;
            words[word][k % IN_WORD] = weight;
            count = word + 1;
        }
        (begin, words, count)
    }
}

/// Matter to be spread: a place in the window's coordinates (m) and its volume (m³).
#[derive(Debug, Clone, Copy)]
pub struct Grain {
    pub place: [f64; 3],
    pub volume: f64,
}

/// Volume fractions by voxel.
#[derive(Debug)]
pub struct Voxels {
    /// Their window.
    pub window: Window,
    /// Words of a column.
    deep: usize,
    words: Vec<AtomicU64>,
    /// True if one thread alone fills them.
    alone: bool,
}

/// Spreads some particles.
struct Fill<'a, F> {
    voxels: &'a Voxels,
    particles: std::ops::Range<usize>,
    mirror_masks: &'a [MirrorMask],
    grain: &'a F,
}

impl<F: Fn(usize, MirrorMask) -> Option<Grain>> Vectorised for Fill<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for i in self.particles {
            for &mirror_mask in self.mirror_masks {
                if let Some(grain) = (self.grain)(i, mirror_mask) {
                    self.voxels.add::<V>(&grain);
                }
            }
        }
    }
}

impl Voxels {
    /// Empty ones.
    #[must_use]
    pub fn new(window: Window) -> Self {
        let deep = window.depth().div_ceil(IN_WORD);
        let [rows, across] = window.kept();
        let mut words = Vec::new();
        words.resize_with(rows * across * deep, AtomicU64::default);
        Self {
            window,
            deep,
            words,
            alone: rayon::current_num_threads() == 1,
        }
    }

    /// Spreads all matter of this rank: `grain` gives what there is of particle `i` of `0..count` behind planes of a
    /// mirror mask.
    pub fn fill(
        &self,
        count: usize,
        mirror_masks: &[MirrorMask],
        grain: impl Fn(usize, MirrorMask) -> Option<Grain> + Sync,
    ) {
        let chunks = (0..count.div_ceil(GRAIN)).into_par_iter();
        // same bits in any order: whole numbers
        chunks.for_each(|chunk| {
            instructions().run(Fill {
                voxels: self,
                particles: chunk * GRAIN..((chunk + 1) * GRAIN).min(count),
                mirror_masks,
                grain: &grain,
            });
        });
    }

    #[inline(always)]
    fn add<V: Lanes>(&self, grain: &Grain) {
        let at = self.window.place(&grain.place);
        let [rows, across] = self.window.kept();
        let depth = self.window.depth();
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        let ends = [rows as f64, across as f64, depth as f64];
        let mut gap = 0.0_f64;
        for a in 0..3 {
            gap = gap.max(-at[a]).max(at[a] - ends[a]);
        }
        let edge = self.window.edge;
        let volume = grain.volume / (edge * edge * edge);
        // It reaches less than twice as far as it is large.
        if gap > 2.0 && gap * gap * gap > 8.0 * volume {
            return;
        }
        #[expect(clippy::cast_precision_loss, reason = "small")]
        let most = (REACH as f64 - 2.0) / 3.0;
        let width = libm::cbrt(volume).clamp(1.0, most);
        let [mut first, mut second] = [
            Weights::new::<V>(at[0], width),
            Weights::new::<V>(at[1], width),
        ];
        if self.window.halved[0] {
            first.fold();
        }
        if self.window.halved[1] {
            second.fold();
        }
        let (begin, words, count) = Weights::new::<V>(at[2], width).words(depth);
        let full = volume * f64::from(UNIT);
        for (i, u) in first.inside(rows) {
            for (j, w) in second.inside(across) {
                let column = (i * across + j) * self.deep + begin;
                let share = full * u * w;
                for (word, fractions) in words[..count].iter().enumerate() {
                    let mut shares = 0;
                    for (k, fraction) in fractions.iter().enumerate() {
                        let share = (share * fraction).min(f64::from(u16::MAX));
                        shares |= ((share + WHOLE).to_bits() & u64::from(u16::MAX)) << (16 * k);
                    }
                    self.put(column + word, shares);
                }
            }
        }
    }

    #[inline(always)]
    fn put(&self, word: usize, shares: u64) {
        let word = &self.words[word];
        if self.alone {
            word.store(word.load(Relaxed).wrapping_add(shares), Relaxed);
        } else if shares != 0 {
            word.fetch_add(shares, Relaxed);
        }
    }

    /// The fractions of all ranks in the columns that are kept, in [`UNIT`]s. Collective.
    #[must_use]
    pub fn sum(self, comm: &Comm) -> Vec<u16> {
        let mut words: Vec<u64> = self.words.into_iter().map(AtomicU64::into_inner).collect();
        comm.sum_u64(&mut words);
        let depth = self.window.depth();
        let mut all = Vec::with_capacity(IN_WORD * words.len());
        for column in words.chunks_exact(self.deep) {
            let end = all.len() + depth;
            for word in column {
                #[expect(clippy::cast_possible_truncation, reason = "16 bits each")]
                all.extend([0, 16, 32, 48].map(|shift| (word >> shift) as u16));
            }
            all.truncate(end);
        }
        all
    }
}

#[cfg(test)]
#[allow(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::*;

    /// Spreads grains one after the other.
    fn spread(window: Window, grains: &[Grain]) -> Vec<u16> {
        let voxels = Voxels::new(window);
        voxels.fill(grains.len(), &[MirrorMask::OWN], |i, _| Some(grains[i]));
        voxels.sum(&Comm::solo())
    }

    #[test]
    fn an_even_filling_is_full_inside_and_half_at_its_faces() {
        let window = Window::new([0.0; 3], [10.0; 3], 1.0, [None; 2]);
        // Three spacings to two voxels, and a face at z = 6.5, in the middle of a voxel.
        let (spacing, layers) = (2.0 / 3.0, 13_usize);
        let places = |k: usize| (k as f64 + 0.5) * spacing - 13.0 / 6.0;
        let grain = |i: usize| Grain {
            place: [i % 21, i / 21 % 21, i / 441].map(places),
            volume: spacing * spacing * spacing,
        };
        let grains: Vec<Grain> = (0..21 * 21 * layers).map(grain).collect();
        let all = spread(window, &grains);
        let at =
            |i: usize, j: usize, k: usize| f64::from(all[(i * 10 + j) * 10 + k]) / f64::from(UNIT);
        for i in 3..8 {
            assert!((at(i, 4, 3) - 1.0).abs() < 0.04, "{}", at(i, 4, 3));
            assert!((at(4, i, 6) - 0.5).abs() < 0.04, "{}", at(4, i, 6));
            assert!(at(i, 4, 8) < 0.1);
        }
    }

    /// Fractions before symmetry planes are those of a particle and its images, to one unit each.
    #[test]
    fn halves_are_images_of_each_other() {
        let places = [
            [0.2, 3.1, 2.0],
            [2.9, 0.4, 7.3],
            [4.0, 4.4, 4.4],
            [1.6, 0.7, 0.1],
        ];
        for width in [1.0, 3.4_f64] {
            let grain = |place: [f64; 3]| Grain {
                place,
                volume: width.powi(3),
            };
            let part: Vec<Grain> = places.map(grain).to_vec();
            let images = |g: &Grain| {
                let [x, y, z] = g.place;
                [[x, y, z], [-x, y, z], [x, 2.0 - y, z], [-x, 2.0 - y, z]].map(grain)
            };
            let whole: Vec<Grain> = part.iter().flat_map(images).collect();
            let (lower, upper) = ([-5.0, -4.0, 0.0], [5.0, 6.0, 9.0]);
            let halved = Window::new(lower, upper, 1.0, [Some(0.0), Some(1.0)]);
            let full = Window::new(lower, upper, 1.0, [None; 2]);
            assert_eq!((halved.counts, halved.lower), (full.counts, full.lower));
            assert_eq!(halved.kept(), [5, 5]);
            let (kept, all) = (spread(halved, &part), spread(full, &whole));
            for (column, image) in halved.images().enumerate() {
                for k in 0..9 {
                    let (a, b) = (all[column * 9 + k], kept[image * 9 + k]);
                    assert!(a.abs_diff(b) <= 8, "{column} {k}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn large_particles_keep_their_volume() {
        let window = Window::new([0.0; 3], [40.0; 3], 1.0, [None; 2]);
        for size in [1.0, 2.7, 7.0_f64] {
            let place = [20.2, 19.7, 20.0];
            let volume = size.powi(3);
            let sum: f64 = spread(window, &[Grain { place, volume }])
                .into_iter()
                .map(f64::from)
                .sum();
            let filled = sum / f64::from(UNIT);
            assert!((filled / volume - 1.0).abs() < 0.03, "{size}: {filled}");
        }
    }
}
