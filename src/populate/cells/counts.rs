//! Numbers and coordinates of sites, tile by tile where these are whole.

use super::laid::{Block, Cells, Level, Lie, each};
use crate::row::Cut;
use crate::{Share, Site};
use model::{Vec3, cube};

/// Sites that are counted together.
enum Piece {
    /// A whole tile, by its place among those of its level.
    Tile(Block),
    /// The part of a block that the shape, the cuts and the spacing leave.
    Block(Block),
}

impl Cells {
    /// All tiles that are whole, and the blocks of the others that may hold sites within the cuts.
    fn pieces(&self, cuts: &[Cut]) -> impl Iterator<Item = Piece> {
        self.all_tiles().flat_map(move |tile| {
            let [first, end] = self.of_tile(tile);
            let lie = self.lie(tile.level, [first, end], cuts);
            let whole = (lie == Lie::Inside).then_some(Piece::Tile(tile));
            let number = if lie == Lie::Between {
                self.tile.blocks
            } else {
                [0; 3]
            };
            let blocks = each(number).map(move |block| {
                Piece::Block(Block {
                    level: tile.level,
                    at: [0, 1, 2].map(|a| first[a] + block[a]),
                })
            });
            whole.into_iter().chain(blocks)
        })
    }

    /// The number of sites.
    pub fn count(&self, cuts: &[Cut]) -> u64 {
        let mut count = 0;
        for piece in self.pieces(cuts) {
            match piece {
                Piece::Tile(_) => count += self.tile.sites.len() as u64,
                Piece::Block(block) => self.emit_sites(block, cuts, |_| count += 1),
            }
        }
        count
    }

    /// The sum of their shares.
    #[allow(clippy::cast_precision_loss)] // a few thousand
    pub fn shares(&self, cuts: &[Cut]) -> f64 {
        let mut sum = 0.0;
        for piece in self.pieces(cuts) {
            match piece {
                Piece::Tile(tile) => {
                    let size = self.levels[tile.level].spacing / self.lattice.spacing;
                    sum += self.tile.sites.len() as f64 * cube(size, self.dimension);
                }
                Piece::Block(block) => self.emit_sites(block, cuts, |site| sum += site.share),
            }
        }
        sum
    }

    /// Passes the sites to `emit` as they are before they are fitted.
    pub fn emit_unfitted(&self, cuts: &[Cut], mut emit: impl FnMut(Site)) {
        for block in self.all_blocks(cuts) {
            self.emit_sites(block, cuts, &mut emit);
        }
    }

    /// Tells the coordinates on an axis (m) of one of several shares of the sites, those of whole
    /// tiles to a rounding error.
    #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
    pub fn tally(&self, cuts: &[Cut], axis: usize, share: Share, mut add: impl FnMut(f64, u64)) {
        let along = |x: Vec3| (self.turn.row(axis) * x)[0];
        let of_tile = |level: &Level| {
            let sites = self.tile.sites.iter();
            sites.map(|x| along(x * level.spacing)).collect::<Vec<_>>()
        };
        let aside: Vec<Vec<f64>> = self.levels.iter().map(of_tile).collect();
        let pieces = self.pieces(cuts).skip(share.part);
        for piece in pieces.step_by(share.parts.max(1)) {
            match piece {
                Piece::Tile(Block { level, at }) => {
                    let Level {
                        spacing, corner, ..
                    } = &self.levels[level];
                    let tile = Vec3::from_fn(|a, _| at[a] as f64 * self.tile.edges[a]);
                    let corner = corner[axis] + along(tile * *spacing);
                    for aside in &aside[level] {
                        add(corner + aside, 1);
                    }
                }
                Piece::Block(block) => {
                    self.emit_sites(block, cuts, |site| add(site.position[axis], 1));
                }
            }
        }
    }
}
