//! Sites of a tile that repeats itself along three axes, at any orientation, in a solid of any
//! shape.
//!
//! A tile is cut into blocks of some fifty sites. A block that lies inside the solid belongs to it
//! whole, one outside not at all, as one distance shows; of the others each site is tested.

mod counts;
mod fit;
mod forces;
mod laid;
mod relax;
mod search;
mod tile;

#[cfg(test)]
mod tests;

use super::Site;
use super::row::Cut;
use fit::Fitted;

pub(super) use laid::{Cells, has_rows};
pub(super) use search::{Seen, extremes, near_sites, smallest, unseen};
pub(super) use tile::drawn;

/// All sites that the cuts leave, by their positions before they are fitted.
pub(super) fn sites(cells: Cells, cuts: Vec<Cut>) -> impl Iterator<Item = Site> + use<> {
    let mut fitted = Fitted::new(&cells, &cuts);
    cells.all_blocks(&cuts).flat_map(move |block| {
        let mut sites = cells.sites_of(block, &cuts);
        for site in &mut sites {
            fitted.fit_site(site);
        }
        sites
    })
}
