//! Faces of the slabs so that counted work is even.

use super::rank_speed::RankSpeeds;
use super::slabs::Slabs;
use crate::comm::Comm;

/// Work by fine planes along the slab axis.
#[derive(Debug, Clone, Default)]
pub struct Histogram {
    lower: f64,
    width: f64,
    counts: Vec<u64>,
}

/// Fine planes for each rank.
const BINS_PER_RANK: usize = 2048;

impl Histogram {
    /// Empty bins over `lower..=upper` (m), which must be equal on all ranks.
    pub fn reset(&mut self, lower: f64, upper: f64, ranks: usize) {
        let bins = (BINS_PER_RANK * ranks).min(1 << 18);
        self.lower = lower;
        #[allow(clippy::cast_precision_loss, reason = "few bins")]
        {
            self.width = ((upper - lower) / bins as f64).max(f64::MIN_POSITIVE);
        }
        self.counts.clear();
        self.counts.resize(bins, 0);
    }

    /// Counts `work` at coordinate `x` (m).
    pub fn add(&mut self, x: f64, work: u64) {
        let bin = (x - self.lower) / self.width;
        let last = self.counts.len() - 1;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "clamped"
        )]
        let bin = bin.clamp(0.0, last as f64) as usize;
        self.counts[bin] += work;
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        8 * self.counts.capacity()
    }

    /// The work of all ranks. Collective.
    pub fn sum(&mut self, comm: &Comm) {
        comm.sum_u64(&mut self.counts);
    }

    /// How much lies below each plane.
    #[must_use]
    pub fn cumulate(&self) -> Cumulative {
        let mut sum = 0;
        let mut below = vec![0];
        below.extend(self.counts.iter().map(|count| {
            sum += count;
            sum
        }));
        Cumulative {
            width: self.width,
            below,
        }
    }

    /// Faces that split the work of all ranks by their shares. Collective.
    pub fn split(&mut self, comm: &Comm, rank_speeds: &RankSpeeds) -> Vec<f64> {
        self.sum(comm);
        let ranks = comm.size();
        let total: u64 = self.counts.iter().sum();
        let mut faces = Vec::with_capacity(ranks - 1);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "a part of the total"
        )]
        let target_of = |face: usize| (rank_speeds.up_to(face, ranks) * total as f64) as u64;
        let mut target = target_of(0);
        let mut below = 0;
        for (bin, &count) in self.counts.iter().enumerate() {
            // A face goes to whichever side of this bin is nearer to its share.
            while faces.len() + 1 < ranks {
                if below + count < target {
                    break;
                }
                let over = below + count - target;
                let under = target.saturating_sub(below);
                let at = if under < over { bin } else { bin + 1 };
                #[allow(clippy::cast_precision_loss, reason = "few bins")]
                faces.push(self.lower + self.width * at as f64);
                target = target_of(faces.len());
            }
            below += count;
        }
        while faces.len() + 1 < ranks {
            faces.push(f64::INFINITY);
        }
        faces
    }
}

/// What a [`Histogram`] has below each of its planes, which are numbered from its lower end.
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

    /// The lowest plane with at least so much below it, or the last one.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "counts stay far below 2^52")]
    pub fn plane(&self, count: f64) -> usize {
        let plane = self.below.partition_point(|&below| (below as f64) < count);
        plane.min(self.below.len() - 1)
    }

    /// What lies below the last plane that is not farther than `way` (m, signed) from another.
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

/// New slabs along the same axis for owned particles at `positions` with counted `work`, of which
/// each rank gets its share by `paces`.
/// Particles whose work is unknown count as one.
pub fn balance(
    comm: &Comm,
    slabs: &Slabs,
    positions: &[[f64; 3]],
    work: &[u32],
    histogram: &mut Histogram,
    rank_speeds: &RankSpeeds,
) -> Slabs {
    let along = |p: &[f64; 3]| p[slabs.axis];
    let lower = positions.iter().map(along).fold(f64::INFINITY, f64::min);
    let upper = positions
        .iter()
        .map(along)
        .fold(f64::NEG_INFINITY, f64::max);
    let (lower, upper) = (comm.min_f64(lower), comm.max_f64(upper));
    if lower > upper {
        return slabs.clone();
    }
    histogram.reset(lower, upper, comm.size());
    for (position, &work) in positions.iter().zip(work) {
        histogram.add(along(position), u64::from(work.max(1)));
    }
    Slabs::new(slabs.axis, histogram.split(comm, rank_speeds))
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
        let cumulative = histogram.cumulate();
        assert_eq!(cumulative.total(), 10);
        let below = [(0, 0.0), (1, 0.0), (7, 0.0), (8, 0.0), (5, 2.9), (8, -0.1)];
        let found = below.map(|(plane, way)| cumulative.below(plane, way));
        assert_eq!(found, [0, 3, 3, 6, 3, 3]);
        assert_eq!(cumulative.below(9, f64::INFINITY), 10);
        assert_eq!(
            [0.0, 3.0, 3.5, 9.0, 99.0].map(|n| cumulative.plane(n)),
            [0, 1, 8, 2048, 2048]
        );
    }

    #[test]
    fn one_rank_has_no_faces_and_all_work_in_one_place_is_legal() {
        let comm = Comm::solo();
        let slabs = Slabs::new(1, Vec::new());
        let mut histogram = Histogram::default();
        let positions = [[0.0, 2.0, 0.0]; 3];
        let new = balance(
            &comm,
            &slabs,
            &positions,
            &[5, 5, 5],
            &mut histogram,
            &RankSpeeds::default(),
        );
        assert_eq!(new, slabs);
    }
}
