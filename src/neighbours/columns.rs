//! The grid of thin columns that orders particles in memory.
//!
//! The grid is fixed at the start of a case and depends on the case alone, never on ranks, so
//! the order of neighbours is a pure function of their current positions.

/// Columns of one group of bodies, along one axis and square across it.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnGrid {
    /// Axis along the columns (0, 1, 2).
    pub along: usize,
    /// The two axes across.
    pub across: [usize; 2],
    /// Lower corner across (m).
    origin: [f64; 2],
    /// Number of columns along each axis across; positions beyond share the outermost ones.
    counts: [u32; 2],
    inverse_width: f64,
}

/// Particle spacings across a column.
const WIDTH_IN_SPACINGS: f64 = 2.0;
/// Where a column begins, in particle spacings before the first site.
const PHASE: f64 = 0.25;
/// How far beyond its initial box a group has columns of its own, in sizes of that box.
const MARGIN: f64 = 4.0;
/// Columns along an axis across, at most: runaways in opposite corners make a rank lay out all of
/// them.
const MAX_COUNT: f64 = 4096.0;

impl ColumnGrid {
    /// Grid for a group that starts in the box `lower..upper` (m) with particle spacing
    /// `spacing` (m), columns along the longest side of the model `along`.
    #[must_use]
    pub fn new(lower: [f64; 3], upper: [f64; 3], spacing: f64, along: usize) -> Self {
        let across = match along {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        };
        let width = WIDTH_IN_SPACINGS * spacing;
        let size = (0..3).map(|a| upper[a] - lower[a]).fold(spacing, f64::max);
        let mut origin = [0.0; 2];
        let mut counts = [1; 2];
        for k in 0..2 {
            let (low, high) = (lower[across[k]], upper[across[k]]);
            let inside = ((high - low) / width + 1.0).ceil();
            let margin = (MARGIN * size / width).ceil();
            let margin = margin.min((0.5 * (MAX_COUNT - inside)).floor()).max(0.0);
            let count = (inside + 2.0 * margin).clamp(1.0, MAX_COUNT);
            // Sites stand at `low` and whole or half spacings from it: no column begins there.
            origin[k] = low - PHASE * spacing - margin * width;
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "clamped"
            )]
            {
                counts[k] = count as u32;
            }
        }
        Self {
            along,
            across,
            origin,
            counts,
            inverse_width: 1.0 / width,
        }
    }

    /// Index along the k-th axis across of the column that holds coordinate `x` (m).
    #[inline]
    #[must_use]
    pub fn index(&self, k: usize, x: f64) -> u32 {
        let cell = (x - self.origin[k]) * self.inverse_width;
        let last = f64::from(self.counts[k] - 1);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped"
        )]
        {
            cell.clamp(0.0, last) as u32
        }
    }

    /// Both indices of the column that holds a position.
    #[inline]
    #[must_use]
    pub fn column(&self, position: &[f64; 3]) -> [u32; 2] {
        [
            self.index(0, position[self.across[0]]),
            self.index(1, position[self.across[1]]),
        ]
    }
}
