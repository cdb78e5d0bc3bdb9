//! A box cut into cubes (voxels).
//!
//! Behind a symmetry plane that runs along the columns there is the image of what lies before it: half of the window
//! is kept.

/// Most voxels of a window: 16 MB. Windows that would have more have larger voxels.
const MOST: f64 = (1 << 23) as f64;

/// A box cut into voxels, in the coordinates of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Smallest coordinates (m).
    pub lower: [f64; 3],
    /// Edge of a voxel (m).
    pub edge: f64,
    /// Number of voxels along each axis.
    pub counts: [usize; 3],
    /// True if its halves along the first two are images of each other.
    pub halved: [bool; 2],
}

impl Window {
    /// Voxels of an edge (m), or as large as they must be, between two corners (m). The last
    /// coordinate begins exactly at the lower corner, and symmetry planes across the others (m) are its middles.
    #[must_use]
    pub fn new(lower: [f64; 3], upper: [f64; 3], edge: f64, planes: [Option<f64>; 2]) -> Self {
        let [first, second] = planes;
        let planes = [first, second, None];
        let sides: [f64; 3] = std::array::from_fn(|a| match planes[a] {
            Some(plane) => (upper[a] - plane).max(plane - lower[a]).max(0.0),
            None => (upper[a] - lower[a]).max(0.0),
        });
        let halves = planes.map(|plane| if plane.is_some() { 2.0 } else { 1.0 });
        let counts_of = |edge: f64| -> [f64; 3] {
            std::array::from_fn(|a| halves[a] * (sides[a] / edge).ceil().max(1.0))
        };
        let fits = |edge: f64| counts_of(edge).iter().product::<f64>() <= MOST;
        let mut edge = edge;
        while !fits(edge) {
            edge *= 1.05;
        }
        let counts = counts_of(edge);
        let lower = std::array::from_fn(|a| match planes[a] {
            Some(plane) => plane - 0.5 * counts[a] * edge,
            None => lower[a],
        });
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a product below the most"
        )]
        let counts = counts.map(|count| count as usize);
        Self {
            lower,
            edge,
            counts,
            halved: [first.is_some(), second.is_some()],
        }
    }

    /// Voxels of a column along the last coordinate, which stand one after the other.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.counts[2]
    }

    /// Columns along the first two axes that are kept: of images of each other one, from the middle outwards.
    #[must_use]
    pub fn kept(&self) -> [usize; 2] {
        std::array::from_fn(|a| self.counts[a] / (1 + usize::from(self.halved[a])))
    }

    /// The kept column that each column is or is the image of, in the order of columns.
    pub fn images(&self) -> impl Iterator<Item = usize> {
        let kept = self.kept();
        let image = move |a: usize, at: usize| match self.counts[a] - kept[a] {
            0 => at,
            half if at < half => half - 1 - at,
            half => at - half,
        };
        let row =
            move |i: usize| (0..self.counts[1]).map(move |j| image(0, i) * kept[1] + image(1, j));
        (0..self.counts[0]).flat_map(row)
    }

    /// Coordinates (m) of the middle of a kept column.
    #[must_use]
    pub fn middle(&self, column: usize) -> [f64; 2] {
        let [rows, across] = self.kept();
        let at = [
            column / across + self.counts[0] - rows,
            column % across + self.counts[1] - across,
        ];
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        std::array::from_fn(|a| self.lower[a] + (at[a] as f64 + 0.5) * self.edge)
    }

    /// A place (m) in edges from the first voxel that is kept.
    #[inline(always)]
    #[must_use]
    pub fn place(&self, place: &[f64; 3]) -> [f64; 3] {
        let mut at = [0.0; 3];
        for a in 0..3 {
            at[a] = (place[a] - self.lower[a]) / self.edge;
        }
        for a in 0..2 {
            #[expect(clippy::cast_precision_loss, reason = "counts are small")]
            let middle = 0.5 * self.counts[a] as f64;
            if self.halved[a] {
                at[a] = (at[a] - middle).abs();
            }
        }
        at
    }

    /// The voxel that holds a place (m) along each axis, as far as it is in the window.
    #[must_use]
    pub fn voxel(&self, place: &[f64; 3]) -> Option<[usize; 3]> {
        let mut found = [0; 3];
        for a in 0..3 {
            let at = (place[a] - self.lower[a]) / self.edge;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn voxels_grow_where_there_would_be_too_many() {
        let window = Window::new([-1.0, 0.0, 0.0], [1.0, 4.0, 0.5], 1e-3, [None; 2]);
        assert!(window.counts.iter().product::<usize>() <= 1 << 23 && window.edge > 1e-3);
        assert_eq!(window.voxel(&[-1.0, 0.0, 0.0]), Some([0; 3]));
        assert_eq!(window.voxel(&[-1.1, 0.0, 0.0]), None);
        let nowhere = Window::new([0.0; 3], [-1.0; 3], 1.0, [None; 2]);
        assert_eq!(nowhere.counts, [1; 3]);
    }
}
