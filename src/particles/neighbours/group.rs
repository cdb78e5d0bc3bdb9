//! The window of columns that a group of bodies meets on this rank.

use std::ops::Range;

use super::columns::ColumnGrid;

/// One group's part of the sequence: its columns among those that this rank meets.
#[derive(Debug, Clone)]
pub(super) struct Group {
    pub(super) grid: ColumnGrid,
    /// Box around all images (m); empty if there are none.
    pub(super) lower: [f64; 3],
    pub(super) upper: [f64; 3],
    /// First and last cells across of the window in use, and how many columns it has across.
    pub(super) first: [u32; 2],
    pub(super) last: [u32; 2],
    pub(super) size: [usize; 2],
    /// The window's columns in `Sequence::starts`.
    pub(super) columns: Range<usize>,
    pub(super) images: Range<usize>,
}

impl Group {
    /// Index of the column of a cell among all columns of the sequence; of a cell, a whole number of periods from it
    /// is enough.
    #[inline(always)]
    pub(super) fn index(&self, cells: [u32; 2]) -> usize {
        let index = |k: usize| {
            let last = self.size[k].saturating_sub(1);
            self.grid.after(k, self.first[k], cells[k]).min(last)
        };
        self.columns.start + index(0) * self.size[1] + index(1)
    }
}

/// Windows of columns by group; returns the number of columns of all.
pub(super) fn lay_out(groups: &mut [Group]) -> usize {
    let mut columns = 0;
    for group in groups {
        (group.first, group.last, group.size) = ([0; 2], [0; 2], [1; 2]);
        if group.lower[0] <= group.upper[0] {
            for k in 0..2 {
                let axis = group.grid.across[k];
                group.first[k] = group.grid.cell(k, group.lower[axis]);
                group.last[k] = group.grid.cell(k, group.upper[axis]);
                let period = group.grid.period(k);
                let beyond = (group.last[k] - group.first[k]).min(period - 1);
                group.size[k] = beyond as usize + 1;
            }
        }
        group.columns = columns..columns + group.size[0] * group.size[1];
        columns = group.columns.end;
    }
    columns
}
