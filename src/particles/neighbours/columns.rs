//! The grid of thin columns that orders particles in memory.
//!
//! The grid is fixed at the start of a case and depends on the case alone, never on ranks, so
//! the order of neighbours is a pure function of their current positions.

/// Columns of one group of bodies, along one axis and square across it.
///
/// Space across is cut into cells without end; cells that are a whole number of [periods](Self::period) apart
/// share a column, so that debris which spreads takes no more columns than the bodies that it comes from. Whoever
/// looks for what is near visits cells, not columns, so results do not depend on the periods.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnGrid {
    /// Axis along the columns (0, 1, 2).
    pub along: usize,
    /// The two axes across.
    pub across: [usize; 2],
    /// Beginning of the cell [`MIDDLE`] (m).
    origin: [f64; 2],
    /// One less than the periods, which are powers of two.
    masks: [u32; 2],
    inverse_width: f64,
}

/// Particle spacings across a column.
const WIDTH_IN_SPACINGS: f64 = 2.0;
/// Beginning of a column, in particle spacings before the first site.
const PHASE: f64 = 0.25;
/// The cell in which a group begins; positions more than so many away share the outermost cells.
const MIDDLE: f64 = 2_147_483_648.0;
/// A period is this many times as wide as the group at the start, at least.
const PERIOD: f64 = 4.0;
/// Fewest and most columns of a period: many more than a support and a cluster reach over, and few
/// enough that all of them fit a [`u16`].
const COLUMNS: (f64, f64) = (256.0, 4096.0);

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
        let period = |axis: usize| {
            let inside = (upper[axis] - lower[axis]) / width + 1.0;
            let columns = (PERIOD * inside).clamp(COLUMNS.0, COLUMNS.1);
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "clamped"
            )]
            (columns as u32).next_power_of_two()
        };
        Self {
            along,
            across,
            // Sites stand at `lower` and whole or half spacings from it: no column begins there.
            origin: across.map(|axis| lower[axis] - PHASE * spacing),
            masks: across.map(|axis| period(axis) - 1),
            inverse_width: 1.0 / width,
        }
    }

    /// Columns along the k-th axis across, after which they come again.
    #[inline(always)]
    #[must_use]
    pub fn period(&self, k: usize) -> u32 {
        self.masks[k] + 1
    }

    /// Columns from that of the cell `first` to that of another cell, along the k-th axis across.
    #[inline(always)]
    #[must_use]
    pub fn after(&self, k: usize, first: u32, cell: u32) -> usize {
        (cell.wrapping_sub(first) & self.masks[k]) as usize
    }

    /// Index along the k-th axis across of the cell that holds coordinate `x` (m); it never falls with `x`.
    #[inline(always)]
    #[must_use]
    pub fn cell(&self, k: usize, x: f64) -> u32 {
        let place = (x - self.origin[k]) * self.inverse_width + MIDDLE;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "casts saturate"
        )]
        {
            place as u32
        }
    }

    /// Both indices of the cell that holds a position (m).
    #[inline(always)]
    #[must_use]
    pub fn cells(&self, position: &[f64; 3]) -> [u32; 2] {
        [
            self.cell(0, position[self.across[0]]),
            self.cell(1, position[self.across[1]]),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_do_not_end_and_columns_come_again() {
        let grid = ColumnGrid::new([0.0; 3], [0.1, 1.0, 9.0], 0.01, 2);
        assert_eq!([grid.period(0), grid.period(1)], [256, 256]);
        assert_eq!(ColumnGrid::new([0.0; 3], [9.0; 3], 0.01, 2).period(0), 2048);
        let first = grid.cell(0, 0.0);
        assert_eq!(grid.cell(0, 0.0174), first);
        assert_eq!(grid.cell(0, 0.0176), first + 1);
        assert_eq!(grid.cell(0, -0.0026), first - 1);
        assert_eq!(grid.cell(0, -0.0025 + 256.5 * 0.02), first + 256);
        assert_eq!(grid.after(0, first, first + 259), 3);
        assert_eq!(grid.after(0, first, first - 1), 255);
        for far in [1e9, 1e300, f64::INFINITY] {
            assert_eq!(grid.cell(0, far), u32::MAX);
            assert_eq!(grid.cell(0, -far), 0);
        }
        assert_eq!(grid.cell(0, f64::NAN), 0);
    }
}
