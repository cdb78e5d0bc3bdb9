//! Which part of space some matter fills: volume fractions in cubes (voxels).
//!
//! A particle is spread by a quadratic spline as wide as it is large, or as a voxel, so that an even filling
//! gives about one everywhere inside and a half at its faces. Fractions are whole numbers of
//! [`UNIT`]s, which add up to the same in any order: on any ranks and threads.

use std::sync::atomic::{AtomicI64, Ordering::Relaxed};

use rayon::prelude::*;

use crate::comm::Comm;
use crate::particles::GRAIN;

/// A full voxel; four fractions of 16 bits stand in a word, so that 32 times as much matter fits.
pub const UNIT: u16 = 1 << 11;

/// What is at least half full belongs to matter.
pub const HALF: u16 = UNIT / 2;

/// Fractions in a word.
const IN_WORD: usize = 4;

/// Most voxels of a window: 16 MB. Windows that would have more have larger voxels.
const MOST: f64 = (1 << 23) as f64;

/// Most voxels that a particle reaches along an axis; larger particles are spread less.
const REACH: usize = 24;

/// A box cut into voxels, in the coordinates of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Smallest coordinates (m).
    pub lower: [f64; 3],
    /// Edge of a voxel (m).
    pub edge: f64,
    /// Number of voxels along each axis.
    pub counts: [usize; 3],
}

impl Window {
    /// Voxels of an edge (m), or as large as they must be, between two corners (m). The last
    /// coordinate begins exactly at the lower corner.
    #[must_use]
    pub fn new(lower: [f64; 3], upper: [f64; 3], edge: f64) -> Self {
        let sides: [f64; 3] = std::array::from_fn(|a| (upper[a] - lower[a]).max(0.0));
        let counts_of = |edge: f64| sides.map(|side| (side / edge).ceil().max(1.0));
        let fits = |edge: f64| counts_of(edge).iter().product::<f64>() <= MOST;
        let mut edge = edge;
        while !fits(edge) {
            edge *= 1.05;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a product below the most"
        )]
        let counts = counts_of(edge).map(|count| count as usize);
        Self {
            lower,
            edge,
            counts,
        }
    }

    /// Number of voxels.
    #[must_use]
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Voxels of a column along the last coordinate, which stand one after the other.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.counts[2]
    }

    /// The voxel that holds a place (m) along each axis, as far as it is in the window.
    #[must_use]
    pub fn voxel(&self, place: &[f64; 3]) -> Option<[usize; 3]> {
        let mut found = [0; 3];
        for a in 0..3 {
            let at = ((place[a] - self.lower[a]) / self.edge).floor();
            #[expect(clippy::cast_precision_loss, reason = "counts are small")]
            let inside = at >= 0.0 && at < self.counts[a] as f64;
            if !inside {
                return None;
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "within the counts"
            )]
            let at = at as usize;
            found[a] = at;
        }
        Some(found)
    }
}

/// Weights of voxels along one axis, which add up to one: from the first of them.
struct Weights {
    first: i64,
    count: usize,
    values: [f64; REACH],
}

/// The quadratic spline, one unit wide at half its height.
fn spline(u: f64) -> f64 {
    let u = u.abs();
    if u < 0.5 {
        0.75 - u * u
    } else {
        let rest = (1.5 - u).max(0.0);
        0.5 * rest * rest
    }
}

impl Weights {
    /// Of a particle at `at` edges from the beginning, `width` edges wide.
    fn new(at: f64, width: f64) -> Self {
        let reach = 1.5 * width;
        #[expect(clippy::cast_possible_truncation, reason = "a place near the window")]
        let (first, last) = (
            (at - reach - 0.5).ceil() as i64,
            (at + reach - 0.5).floor() as i64,
        );
        let mut values = [0.0; REACH];
        let count = usize::try_from(last - first + 1).unwrap_or(0).min(REACH);
        let mut sum = 0.0;
        for (value, k) in values[..count].iter_mut().zip(first..) {
            #[expect(clippy::cast_precision_loss, reason = "small")]
            let centre = k as f64 + 0.5;
            *value = spline((centre - at) / width);
            sum += *value;
        }
        values[..count].iter_mut().for_each(|value| *value /= sum);
        Self {
            first,
            count,
            values,
        }
    }

    /// The voxels among `0..total` with their weights.
    fn inside(&self, total: usize) -> impl Iterator<Item = (usize, f64)> {
        let all = self.values[..self.count].iter().zip(self.first..);
        all.filter_map(move |(&weight, k)| {
            let k = usize::try_from(k).ok().filter(|&k| k < total)?;
            Some((k, weight))
        })
    }
}

/// Matter to be spread: a place in the window's coordinates (m), volume (m³) and size (m).
#[derive(Debug, Clone, Copy)]
pub struct Grain {
    pub place: [f64; 3],
    pub volume: f64,
    pub size: f64,
}

/// Volume fractions by voxel.
#[derive(Debug)]
pub struct Voxels {
    /// Where they are.
    pub window: Window,
    words: Vec<AtomicI64>,
}

impl Voxels {
    /// Empty ones.
    #[must_use]
    pub fn new(window: Window) -> Self {
        let mut words = Vec::new();
        words.resize_with(window.len().div_ceil(IN_WORD), AtomicI64::default);
        Self { window, words }
    }

    /// Spreads all matter of this rank: `tell` gives what there is of particle `i` of `0..count`, image by
    /// image.
    pub fn fill(&self, count: usize, tell: impl Fn(usize, &mut dyn FnMut(Grain)) + Sync) {
        let chunks = (0..count.div_ceil(GRAIN)).into_par_iter();
        // same bits in any order: whole numbers
        chunks.for_each(|chunk| {
            for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(count) {
                tell(i, &mut |grain| self.add(&grain));
            }
        });
    }

    fn add(&self, grain: &Grain) {
        let Window {
            lower,
            edge,
            counts,
        } = self.window;
        let near = 2.0 * grain.size.max(edge);
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        let beyond = |a: usize| {
            let at = grain.place[a] - lower[a];
            !(at > -near && at < counts[a] as f64 * edge + near)
        };
        if (0..3).any(beyond) {
            return;
        }
        #[expect(clippy::cast_precision_loss, reason = "small")]
        let most = (REACH as f64 - 2.0) / 3.0;
        let width = (grain.size / edge).clamp(1.0, most);
        let along: [Weights; 3] =
            std::array::from_fn(|a| Weights::new((grain.place[a] - lower[a]) / edge, width));
        let full = grain.volume / (edge * edge * edge) * f64::from(UNIT);
        for (i, u) in along[0].inside(counts[0]) {
            for (j, w) in along[1].inside(counts[1]) {
                let column = (i * counts[1] + j) * counts[2];
                let across = full * u * w;
                // Those that share a word go out together.
                let (mut at, mut all) = (usize::MAX, 0);
                for (k, n) in along[2].inside(counts[2]) {
                    #[expect(clippy::cast_possible_truncation, reason = "16 bits")]
                    let share = (across * n + 0.5).min(f64::from(u16::MAX)) as i64;
                    let (word, place) = ((column + k) / IN_WORD, (column + k) % IN_WORD);
                    if word != at {
                        self.put(at, all);
                        (at, all) = (word, 0);
                    }
                    all += share << (16 * place);
                }
                self.put(at, all);
            }
        }
    }

    fn put(&self, word: usize, shares: i64) {
        if shares != 0 {
            self.words[word].fetch_add(shares, Relaxed);
        }
    }

    /// The fractions of all ranks, in [`UNIT`]s. Collective.
    #[must_use]
    pub fn sum(self, comm: &Comm) -> Vec<u16> {
        let mut words: Vec<i64> = self.words.into_iter().map(AtomicI64::into_inner).collect();
        comm.sum_i64(&mut words);
        let mut all = Vec::with_capacity(IN_WORD * words.len());
        for word in words {
            let word = word.cast_unsigned();
            #[expect(clippy::cast_possible_truncation, reason = "16 bits each")]
            all.extend((0..IN_WORD).map(|k| (word >> (16 * k)) as u16));
        }
        all.truncate(self.window.len());
        all
    }
}

#[cfg(test)]
#[allow(clippy::cast_precision_loss, reason = "small numbers")]
mod tests {
    use super::*;

    #[test]
    fn an_even_filling_is_full_inside_and_half_at_its_faces() {
        let window = Window::new([0.0; 3], [10.0; 3], 1.0);
        let voxels = Voxels::new(window);
        // Three spacings to two voxels, and a face at z = 6.5, in the middle of a voxel.
        let (spacing, layers) = (2.0 / 3.0, 13_usize);
        let places = |k: usize| (k as f64 + 0.5) * spacing - 13.0 / 6.0;
        let count = 21 * 21 * layers;
        voxels.fill(count, |i, tell| {
            let [x, y, z] = [i % 21, i / 21 % 21, i / 441].map(places);
            let volume = spacing * spacing * spacing;
            tell(Grain {
                place: [x, y, z],
                volume,
                size: spacing,
            });
        });
        let all = voxels.sum(&Comm::solo());
        let at =
            |i: usize, j: usize, k: usize| f64::from(all[(i * 10 + j) * 10 + k]) / f64::from(UNIT);
        for i in 3..8 {
            assert!((at(i, 4, 3) - 1.0).abs() < 0.04, "{}", at(i, 4, 3));
            assert!((at(4, i, 6) - 0.5).abs() < 0.04, "{}", at(4, i, 6));
            assert!(at(i, 4, 8) < 0.1);
        }
    }

    #[test]
    fn voxels_grow_where_there_would_be_too_many() {
        let window = Window::new([-1.0, 0.0, 0.0], [1.0, 4.0, 0.5], 1e-3);
        assert!(window.len() <= 1 << 23 && window.edge > 1e-3);
        assert_eq!(window.voxel(&[-1.0, 0.0, 0.0]), Some([0; 3]));
        assert_eq!(window.voxel(&[-1.1, 0.0, 0.0]), None);
        let nowhere = Window::new([0.0; 3], [-1.0; 3], 1.0);
        assert_eq!(nowhere.counts, [1; 3]);
    }

    #[test]
    fn large_particles_keep_their_volume() {
        let window = Window::new([0.0; 3], [20.0; 3], 1.0);
        for size in [1.0, 2.7, 40.0] {
            let voxels = Voxels::new(window);
            voxels.fill(1, |_, tell| {
                tell(Grain {
                    place: [10.2, 9.7, 10.0],
                    volume: 30.0,
                    size,
                });
            });
            let sum: f64 = voxels.sum(&Comm::solo()).into_iter().map(f64::from).sum();
            let filled = sum / f64::from(UNIT);
            assert!((filled - 30.0).abs() < 1.5, "{size}: {filled}");
        }
    }
}
