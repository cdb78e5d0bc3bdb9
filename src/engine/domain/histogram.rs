//! Work counted by fine planes.

use std::ops::Range;

use comm::Comm;

/// Work by fine planes along an axis, of one slab or of several that are cut at the same time.
#[derive(Debug, Default)]
pub struct Histogram {
    spans: Vec<Span>,
    counts: Vec<u64>,
}

/// The planes of one slab.
#[derive(Debug, Clone, Copy)]
struct Span {
    /// Position of the lowest plane (m).
    lower: f64,
    /// From plane to plane (m).
    width: f64,
    /// First and last place in the counts, less one.
    first: usize,
    last: usize,
}

impl Span {
    /// The place in the counts of a coordinate (m).
    #[inline]
    fn bin(&self, x: f64) -> usize {
        let bin = (x - self.lower) / self.width;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "clamped"
        )]
        let bin = bin.clamp(0.0, (self.last - self.first) as f64) as usize;
        self.first + bin
    }
}

/// Fine planes for each rank.
const BINS_PER_RANK: usize = 2048;
/// Fine planes of a whole level at most, which cuts one slab or more of them.
const MOST_BINS: [usize; 2] = [1 << 18, 1 << 20];

impl Histogram {
    /// Empty bins over `lower..=upper` (m), which must be equal on all ranks, of one slab that is cut
    /// for so many ranks.
    pub fn reset(&mut self, lower: f64, upper: f64, ranks: usize) {
        self.clear();
        self.push((lower, upper), (BINS_PER_RANK * ranks).min(MOST_BINS[0]));
        self.counts.resize(self.bins(), 0);
    }

    /// Empty bins of several slabs over the coordinates of each (m), equal on all ranks, that are cut
    /// for so many ranks each, of `all` together.
    pub fn reset_each(&mut self, slabs: impl Iterator<Item = ((f64, f64), usize)>, all: usize) {
        self.clear();
        let each = (MOST_BINS[1] / all).clamp(1, BINS_PER_RANK);
        for (ends, ranks) in slabs {
            self.push(ends, each * ranks);
        }
        self.counts.resize(self.bins(), 0);
    }

    fn clear(&mut self) {
        self.spans.clear();
        self.counts.clear();
    }

    fn bins(&self) -> usize {
        self.spans.last().map_or(0, |span| span.last + 1)
    }

    #[allow(clippy::cast_precision_loss, reason = "few bins")]
    fn push(&mut self, (lower, upper): (f64, f64), bins: usize) {
        let first = self.bins();
        self.spans.push(Span {
            lower,
            width: ((upper - lower) / bins as f64).max(f64::MIN_POSITIVE),
            first,
            last: first + bins - 1,
        });
    }

    /// Counts `work` at coordinate `x` (m) of the first slab.
    pub fn add(&mut self, x: f64, work: u64) {
        self.add_to(0, x, work);
    }

    /// Counts `work` at coordinate `x` (m) of a slab.
    #[inline]
    pub fn add_to(&mut self, slab: usize, x: f64, work: u64) {
        let bin = self.spans[slab].bin(x);
        self.counts[bin] += work;
    }

    /// The work of all ranks. Collective.
    pub fn sum(&mut self, comm: &Comm) {
        comm.sum_u64(&mut self.counts);
    }

    /// Work of a slab below each plane.
    #[must_use]
    pub fn cumulate(&self, slab: usize) -> Cumulative {
        let span = &self.spans[slab];
        let mut sum = 0;
        let mut below = vec![0];
        below.extend(self.counts[self.places(slab)].iter().map(|count| {
            sum += count;
            sum
        }));
        Cumulative {
            width: span.width,
            below,
        }
    }

    /// All that was counted of a slab.
    #[must_use]
    pub fn total(&self, slab: usize) -> u64 {
        self.counts[self.places(slab)].iter().sum()
    }

    fn places(&self, slab: usize) -> Range<usize> {
        let span = &self.spans[slab];
        span.first..span.last + 1
    }

    /// After [`Self::sum`] tells the faces (m) that split the work of a slab, lowest first, so that
    /// the parts of the whole below them are those given.
    pub fn split(&self, slab: usize, parts: impl Iterator<Item = f64>, mut emit: impl FnMut(f64)) {
        let span = &self.spans[slab];
        let total = self.total(slab);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "a part of the total"
        )]
        let mut targets = parts.map(|part| (part * total as f64) as u64);
        let mut target = targets.next();
        let mut below = 0;
        for (bin, &count) in self.counts[self.places(slab)].iter().enumerate() {
            // A face goes to whichever side of this bin is nearer to its share.
            while let Some(wanted) = target {
                if below + count < wanted {
                    break;
                }
                let over = below + count - wanted;
                let under = wanted.saturating_sub(below);
                let at = if under < over { bin } else { bin + 1 };
                #[allow(clippy::cast_precision_loss, reason = "few bins")]
                emit(span.lower + span.width * at as f64);
                target = targets.next();
            }
            below += count;
        }
        while target.is_some() {
            emit(f64::INFINITY);
            target = targets.next();
        }
    }
}

/// Work of a [`Histogram`] below each of its planes, which are numbered from its lower end.
#[derive(Debug, Clone)]
pub struct Cumulative {
    width: f64,
    below: Vec<u64>,
}

impl Cumulative {
    /// All that was counted.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.below.last().copied().unwrap_or(0)
    }

    /// The number of the last plane.
    #[must_use]
    pub fn last(&self) -> usize {
        self.below.len() - 1
    }

    /// The lowest plane with at least so much below it, or the last one.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "counts stay far below 2^52")]
    pub fn plane(&self, count: f64) -> usize {
        let plane = self.below.partition_point(|&below| (below as f64) < count);
        plane.min(self.below.len() - 1)
    }

    /// The planes nearest to each other between which all lies that is between two others.
    #[must_use]
    pub fn filled(&self, [lower, upper]: [usize; 2]) -> [usize; 2] {
        let (none, all) = (self.below[lower], self.below[upper]);
        let first = self.below.partition_point(|&below| below <= none) - 1;
        let last = self.below.partition_point(|&below| below < all);
        [first.max(lower).min(upper), last.min(upper).max(lower)]
    }

    /// Work below the last plane that is not farther than `way` (m, signed) from another.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        reason = "few planes"
    )]
    pub fn below(&self, plane: usize, way: f64) -> u64 {
        // Rounding must not lose a plane that is just there.
        let planes = (way / self.width + 1e-6).floor() as i64;
        let last = self.below.len() as i64 - 1;
        let there = planes.saturating_add(plane as i64).clamp(0, last);
        self.below[there as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_below_a_plane_is_all_that_was_added_there() {
        let mut histogram = Histogram::default();
        histogram.reset(0.0, 2048.0, 1);
        for (x, count) in [(0.5, 3), (7.0, 2), (7.5, 1), (2048.0, 4)] {
            histogram.add(x, count);
        }
        let cumulative = histogram.cumulate(0);
        assert_eq!(cumulative.total(), 10);
        let below = [(0, 0.0), (1, 0.0), (7, 0.0), (8, 0.0), (5, 2.9), (8, -0.1)];
        let found = below.map(|(plane, way)| cumulative.below(plane, way));
        assert_eq!(found, [0, 3, 3, 6, 3, 3]);
        assert_eq!(cumulative.below(9, f64::INFINITY), 10);
        let between = [[0, 2048], [1, 2047], [1, 7], [2, 5]];
        let filled = between.map(|planes| cumulative.filled(planes));
        assert_eq!(filled, [[0, 2048], [7, 8], [7, 1], [5, 2]]);
        assert_eq!(
            [0.0, 3.0, 3.5, 9.0, 99.0].map(|n| cumulative.plane(n)),
            [0, 1, 8, 2048, 2048]
        );
    }

    /// Slabs that are cut at the same time do not know each other.
    #[test]
    fn slabs_are_split_each_for_itself() {
        let mut histogram = Histogram::default();
        histogram.reset_each([((0.0, 8.0), 4), ((-1.0, 1.0), 2)].into_iter(), 6);
        for x in 0..8 {
            histogram.add_to(0, f64::from(x) + 0.5, 3);
        }
        for (x, work) in [(-1.0, 1), (0.2, 2), (1.0, 1)] {
            histogram.add_to(1, x, work);
        }
        assert_eq!([0, 1].map(|slab| histogram.total(slab)), [24, 4]);
        let faces = |slab, parts: &[f64]| {
            let mut faces = Vec::new();
            histogram.split(slab, parts.iter().copied(), |face| faces.push(face));
            faces
        };
        let near = |a: &[f64], b: &[f64]| {
            assert_eq!(a.len(), b.len());
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.01), "{a:?}");
        };
        near(&faces(0, &[0.25, 0.5, 0.75]), &[1.5, 3.5, 5.5]);
        near(&faces(1, &[0.75, 1.0]), &[0.2, 1.0]);
    }
}
