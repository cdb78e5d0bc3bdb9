//! The sites of a body whose particles a file gives: its rows.

use std::sync::Arc;

use super::parts::Parts;
use super::row::Cut;
use super::{Share, Site};
use model::{Body, Cloud, Vec3};

/// Rows of a node that are looked at one by one.
const FEW: usize = 4;

/// The particles of one body.
#[derive(Debug, Clone)]
pub(super) struct Given {
    cloud: Arc<Cloud>,
    /// The position of their origin (m).
    at: Vec3,
}

impl Given {
    /// Of a body, if a file gives its particles.
    pub fn of(body: &Body) -> Option<Self> {
        let (cloud, at) = body.cloud()?;
        Some(Self {
            cloud: cloud.clone(),
            at: *at,
        })
    }

    fn moved(&self, x: &[f64; 3]) -> [f64; 3] {
        // Unmoved coordinates keep their bits.
        [0, 1, 2].map(|a| {
            if self.at[a] == 0.0 {
                x[a]
            } else {
                x[a] + self.at[a]
            }
        })
    }

    fn position(&self, row: usize) -> [f64; 3] {
        self.moved(&self.cloud.positions()[row])
    }

    /// One more than the largest index.
    pub fn index_end(&self) -> u64 {
        self.cloud.count() as u64
    }

    /// Tells the rows that the cuts leave by runs of their places in the order of the tree.
    fn runs(&self, cuts: &[Cut], mut emit: impl FnMut(usize, usize)) {
        let mut waiting = vec![(0, self.cloud.count())];
        while let Some((first, end)) = waiting.pop() {
            if first == end {
                continue;
            }
            let (lower, upper) = self.around(first, end);
            if cuts.iter().any(|cut| cut.drops(&lower, &upper)) {
                continue;
            }
            let keeps = |cut: &Cut| cut.keeps(&lower) && cut.keeps(&upper);
            if cuts.iter().all(keeps) {
                emit(first, end);
            } else if end - first <= FEW {
                for slot in first..end {
                    let row = self.cloud.order()[slot] as usize;
                    if self.is_left(row, cuts) {
                        emit(slot, slot + 1);
                    }
                }
            } else {
                let half = first + (end - first) / 2;
                waiting.extend([(half, end), (first, half)]);
            }
        }
    }

    fn is_left(&self, row: usize, cuts: &[Cut]) -> bool {
        let position = self.position(row);
        cuts.iter().all(|cut| cut.keeps(&position))
    }

    /// Box (m) around some rows by their places in the order of the tree.
    fn around(&self, first: usize, end: usize) -> ([f64; 3], [f64; 3]) {
        let (lower, upper) = self.cloud.around(first, end);
        (self.moved(&lower), self.moved(&upper))
    }

    /// The rows that the cuts leave, in their order.
    fn rows(&self, cuts: &[Cut]) -> Vec<u32> {
        let mut rows = Vec::new();
        self.runs(cuts, |first, end| {
            rows.extend_from_slice(&self.cloud.order()[first..end]);
        });
        rows.sort_unstable();
        rows
    }

    /// All sites that the cuts leave, of a body whose particles have the volume `each` on average
    /// (m³; m² or m in two or one dimensions).
    pub fn sites(self, cuts: &[Cut], each: f64) -> impl Iterator<Item = Site> + use<> {
        let rows = self.rows(cuts);
        rows.into_iter().map(move |row| Site {
            position: self.position(row as usize),
            index: row.into(),
            share: self.cloud.volumes()[row as usize] / each,
        })
    }

    /// The number of sites.
    pub fn count(&self, cuts: &[Cut]) -> u64 {
        let mut count = 0;
        self.runs(cuts, |first, end| count += (end - first) as u64);
        count
    }

    /// Mean volume of the rows that the cuts leave (m³; m² or m in two or one dimensions).
    #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
    pub fn mean_volume(&self, cuts: &[Cut]) -> Option<f64> {
        let rows = self.rows(cuts);
        let volumes = rows.iter().map(|&row| self.cloud.volumes()[row as usize]);
        let sum = volumes.fold(0.0, |sum, volume| sum + volume);
        (!rows.is_empty()).then(|| sum / rows.len() as f64)
    }

    /// Smallest and largest coordinates (m) of the rows that the cuts leave, if there are any.
    pub fn extremes(&self, cuts: &[Cut]) -> Option<([f64; 3], [f64; 3])> {
        let mut bounds: Option<([f64; 3], [f64; 3])> = None;
        for row in (0..self.cloud.count()).filter(|&row| self.is_left(row, cuts)) {
            let x = self.position(row);
            let (lower, upper) = bounds.get_or_insert((x, x));
            for a in 0..3 {
                (lower[a], upper[a]) = (lower[a].min(x[a]), upper[a].max(x[a]));
            }
        }
        bounds
    }

    /// Tells the coordinates on an axis (m) of one of several shares of the rows.
    pub fn tally(&self, cuts: &[Cut], axis: usize, share: Share, add: &mut impl FnMut(f64, u64)) {
        let rows = (share.part..self.cloud.count()).step_by(share.parts.max(1));
        for row in rows.filter(|&row| self.is_left(row, cuts)) {
            add(self.position(row)[axis], 1);
        }
    }
}

/// The particles of a body within some cuts, by their places in the order of the tree.
pub(super) struct GivenRows<'a> {
    pub given: &'a Given,
    pub cuts: &'a [Cut],
}

impl Parts for GivenRows<'_> {
    fn all(&self) -> [u64; 3] {
        [self.given.index_end(), 1, 1]
    }

    fn longest(&self, _: [u64; 3], _: [u64; 3]) -> usize {
        0
    }

    #[allow(clippy::cast_possible_truncation)] // they count what is in memory
    fn around(&self, first: [u64; 3], end: [u64; 3]) -> Option<([f64; 3], [f64; 3])> {
        let (lower, upper) = self.given.around(first[0] as usize, end[0] as usize);
        let is_cut = self.cuts.iter().any(|cut| cut.drops(&lower, &upper));
        (!is_cut).then_some((lower, upper))
    }

    #[allow(clippy::cast_possible_truncation)] // as above
    fn emit(&self, at: [u64; 3], mut emit: impl FnMut([f64; 3])) {
        let row = self.given.cloud.order()[at[0] as usize] as usize;
        if self.given.is_left(row, self.cuts) {
            emit(self.given.position(row));
        }
    }
}
