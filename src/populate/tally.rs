//! The number of sites at each coordinate of an axis, counted row by row and not site by site.

use super::Share;
use super::lattice::Stack;
use super::row::{Cut, layers, runs};

/// Layers from which shape and cuts leave the same rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct LikeLayers {
    pub first: u64,
    /// One more than the last.
    end: u64,
    stride: u64,
}

impl LikeLayers {
    /// All layers that the cuts leave, like with like.
    pub fn of(stack: &Stack, cuts: &[Cut]) -> impl Iterator<Item = Self> + use<> {
        let (layers, kinds) = (layers(stack, cuts), stack.layer_kinds());
        let (groups, stride) = if stack.has_layers_alike() {
            (layers.start..layers.end.min(layers.start + kinds), kinds)
        } else {
            (layers.clone(), u64::MAX)
        };
        groups.map(move |first| Self {
            first,
            end: layers.end,
            stride,
        })
    }

    pub fn count(self) -> u64 {
        (self.end - self.first).div_ceil(self.stride)
    }

    fn each(self) -> impl Iterator<Item = u64> {
        let Self { first, stride, .. } = self;
        (0..self.count()).map(move |n| first + n * stride)
    }
}

/// Passes the coordinates on an axis (m) of a share of the rows to `add`, with the number of sites
/// there.
pub(super) fn tally_rows(
    stack: &Stack,
    cuts: &[Cut],
    axis: usize,
    share: Share,
    mut add: impl FnMut(f64, u64),
) {
    let like: Vec<LikeLayers> = LikeLayers::of(stack, cuts).collect();
    let rows = || (share.part as u64..stack.counts[1]).step_by(share.parts.max(1));
    let length = |j, k| -> u64 {
        let runs = runs(stack, cuts, j, k);
        runs.iter().map(|run| run.end - run.first).sum()
    };
    if axis == 2 {
        for like in like {
            let count = rows().map(|j| length(j, like.first)).sum();
            like.each()
                .for_each(|k| add(stack.position(0, 0, k)[2], count));
        }
        return;
    }
    if axis == 1 && stack.is_along_x() {
        for j in rows() {
            for like in &like {
                let count = like.count() * length(j, like.first);
                add(stack.position(0, j, like.first)[1], count);
            }
        }
        return;
    }
    // Sites with the same index in rows with the same shift are at the same x, those of one row in
    // layers of one kind at the same coordinate across.
    let is_along_x = stack.is_along_x();
    let mut columns = [0, 1].map(|_| Columns::new(stack));
    for j in rows() {
        for like in &like {
            let k = like.first;
            let is_other = if is_along_x {
                stack.shift(j, k) > 0.0
            } else {
                k % stack.layer_kinds() == 1
            };
            let columns = &mut columns[usize::from(is_other)];
            columns.row = [j, k];
            for run in runs(stack, cuts, j, k) {
                columns.add(run.first, run.end, like.count());
            }
        }
        if !is_along_x {
            for columns in &mut columns {
                columns.emit(stack, axis, &mut add);
            }
        }
    }
    for columns in &mut columns {
        columns.emit(stack, axis, &mut add);
    }
}

/// Sites by their index in rows that have the same coordinates.
struct Columns {
    /// Any one of the rows.
    row: [u64; 2],
    /// By how much the number of sites differs from that of the index before.
    steps: Vec<i64>,
    /// `true` if anything was added.
    has_any: bool,
}

impl Columns {
    fn new(stack: &Stack) -> Self {
        let sites = usize::try_from(stack.counts[0]).unwrap_or(0);
        Self {
            row: [0; 2],
            steps: vec![0; sites + 1],
            has_any: false,
        }
    }

    #[allow(
        clippy::cast_possible_wrap,
        clippy::cast_possible_truncation,
        reason = "far fewer than 2^63"
    )]
    fn add(&mut self, first: u64, end: u64, times: u64) {
        if first < end {
            self.steps[first as usize] += times as i64;
            self.steps[end as usize] -= times as i64;
            self.has_any = true;
        }
    }

    /// Tells what was added, and forgets it.
    #[allow(clippy::cast_sign_loss, reason = "counts are positive")]
    fn emit(&mut self, stack: &Stack, axis: usize, add: &mut impl FnMut(f64, u64)) {
        if !std::mem::take(&mut self.has_any) {
            return;
        }
        let [j, k] = self.row;
        let mut count = 0;
        for (i, step) in (0..stack.counts[0]).zip(&mut self.steps) {
            count += std::mem::take(step);
            if count > 0 {
                add(stack.position(i, j, k)[axis], count as u64);
            }
        }
        // Runs up to the end of the row took back what they had added behind it.
        *self.steps.last_mut().expect("one more than sites") = 0;
    }
}
