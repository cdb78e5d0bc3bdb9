//! The filling of a body: rows of a file, layers, tiles or rows of a lattice.

use super::cells::{self, Cells, Seen};
use super::extremes;
use super::given::{Given, GivenRows};
use super::lattice::Stack;
use super::parts::best;
use super::row::{Cut, rows, rows_of_layer};
use super::search::Rows;
use super::shells::Shells;
use super::tally::{LikeLayers, tally_rows};
use super::{Share, Site, Wanted};
use model::{Body, SymmetryPlane};

/// The sites of one body, by what they come from.
pub(super) enum Filling {
    /// Rows of a file.
    Given(Given),
    /// Concentric layers.
    Shells(Shells),
    /// Tiles that repeat themselves.
    Cells(Box<Cells>),
    /// Rows of a lattice.
    Rows(Box<Stack>),
}

impl Filling {
    /// Of a body; glass is fitted to the symmetry planes.
    pub fn of(body: &Body, dimension: usize, symmetry: &[SymmetryPlane]) -> Self {
        if let Some(given) = Given::of(body) {
            return Self::Given(given);
        }
        if let Some(shells) = Shells::of(body) {
            return Self::Shells(shells);
        }
        match Cells::of(body, dimension, symmetry) {
            Some(cells) => Self::Cells(Box::new(cells)),
            None => Self::Rows(Box::new(Stack::new(body, dimension))),
        }
    }

    /// All sites that the cuts leave, of a body whose particles have the volume `each` on average
    /// (m³; m² or m in two or one dimensions).
    pub fn sites(self, cuts: Vec<Cut>, each: f64) -> Box<dyn Iterator<Item = Site>> {
        match self {
            Self::Given(given) => Box::new(given.sites(&cuts, each)),
            Self::Shells(shells) => Box::new(shells.sites(cuts)),
            Self::Cells(cells) => Box::new(cells::sites(*cells, cuts)),
            Self::Rows(stack) => Box::new(rows(*stack, cuts).flat_map(move |row| {
                let stack = *stack;
                row.range().map(move |i| Site {
                    position: stack.position(i, row.j, row.k),
                    index: stack.index(i, row.j, row.k),
                    share: 1.0,
                })
            })),
        }
    }

    /// Passes the sites to `emit` as they are before they are fitted; `each` as for
    /// [`Self::sites`].
    pub fn emit_unfitted(self, cuts: Vec<Cut>, each: f64, emit: impl FnMut(Site)) {
        match self {
            Self::Cells(cells) => cells.emit_unfitted(&cuts, emit),
            _ => self.sites(cuts, each).for_each(emit),
        }
    }

    /// The number of sites.
    pub fn count(&self, cuts: &[Cut]) -> u64 {
        match self {
            Self::Given(given) => given.count(cuts),
            Self::Shells(shells) => shells.count(cuts),
            Self::Cells(cells) => cells.count(cuts),
            Self::Rows(stack) => {
                let of_layer = |k| -> u64 {
                    let rows = rows_of_layer(stack, cuts, k);
                    rows.map(|row| row.end - row.first).sum()
                };
                let layers = LikeLayers::of(stack, cuts);
                layers.map(|like| like.count() * of_layer(like.first)).sum()
            }
        }
    }

    /// The sum of their shares; of rows of a file their number.
    pub fn shares(&self, cuts: &[Cut]) -> f64 {
        #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
        match self {
            Self::Cells(cells) if cells.is_graded() => cells.shares(cuts),
            _ => self.count(cuts) as f64,
        }
    }

    /// Smallest and largest coordinates (m), if there are any.
    pub fn extremes(&self, cuts: &[Cut]) -> Option<([f64; 3], [f64; 3])> {
        match self {
            Self::Given(given) => given.extremes(cuts),
            Self::Shells(shells) => shells.extremes(cuts),
            Self::Cells(cells) => cells::extremes(cells, cuts),
            Self::Rows(stack) => extremes::extremes(stack, cuts),
        }
    }

    /// Tells the coordinates on an axis (m) of one of several shares of them.
    pub fn tally(&self, cuts: &[Cut], axis: usize, share: Share, mut add: impl FnMut(f64, u64)) {
        match self {
            Self::Given(given) => given.tally(cuts, axis, share, &mut add),
            Self::Shells(shells) => shells.tally(cuts, axis, share, add),
            Self::Cells(cells) => cells.tally(cuts, axis, share, add),
            Self::Rows(stack) => tally_rows(stack, cuts, axis, share, &mut add),
        }
    }

    /// All sites (m), those that are fitted where they end nearly; `None` of rows of a file and of shells.
    pub fn near_sites(&self, cuts: &[Cut]) -> Option<Vec<[f64; 3]>> {
        match self {
            Self::Given(_) | Self::Shells(_) => None,
            Self::Cells(cells) => Some(cells::near_sites(cells, cuts)),
            Self::Rows(stack) => {
                let rows = rows(**stack, cuts.to_vec());
                let sites =
                    rows.flat_map(|row| row.range().map(move |i| stack.position(i, row.j, row.k)));
                Some(sites.collect())
            }
        }
    }

    /// What has been looked at before a first search.
    pub fn unseen(&self) -> Vec<Seen> {
        match self {
            Self::Cells(cells) => cells::unseen(cells),
            _ => Vec::new(),
        }
    }

    /// Those where `value` is smallest, smallest first: see [`super::search()`].
    pub fn smallest(
        &self,
        cuts: &[Cut],
        seen: &[Seen],
        wanted: Wanted,
        bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
        value: impl Fn(&[f64; 3]) -> f64,
    ) -> Vec<(f64, [f64; 3])> {
        match self {
            Self::Given(given) => best(&GivenRows { given, cuts }, wanted, bound, value),
            Self::Shells(shells) => shells.smallest(cuts, wanted, bound, value),
            Self::Cells(cells) => cells::smallest(cells, cuts, seen, wanted, bound, value),
            Self::Rows(stack) => best(&Rows { stack, cuts }, wanted, bound, value),
        }
    }

    /// One more than the largest index; saturates at `u64::MAX`.
    pub fn index_end(&self) -> u64 {
        match self {
            Self::Given(given) => given.index_end(),
            Self::Shells(shells) => shells.index_end(),
            Self::Cells(cells) => cells.index_end(),
            Self::Rows(stack) => stack.index_end(),
        }
    }

    /// No fewer sites than there are; saturates at `u64::MAX`.
    pub fn most_sites(&self) -> u64 {
        match self {
            Self::Cells(cells) => cells.most_sites(),
            _ => self.index_end(),
        }
    }
}
