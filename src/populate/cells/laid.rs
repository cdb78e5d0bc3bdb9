//! Tiles laid through a solid: which blocks and sites belong to it.

use std::borrow::Cow;
use std::ops::Range;

use super::tile::{self, Tile};
use crate::model::{Body, LatticeKind, Shape, Solid, SymmetryPlane, Vec3, rotation};
use crate::populate::row::Cut;
use crate::populate::{Share, Site};

/// Sites as near to the surface as this (spacings) are outside: whether a lattice point on a face
/// belongs to the body must not hang on rounding.
const FACE: f64 = 1e-9;

/// The sites of one body that is not filled by rows.
#[derive(Debug, Clone)]
pub(in crate::populate) struct Cells {
    pub(super) solid: Solid,
    /// Lower sides by axis that symmetry planes cut off (m).
    pub(super) planes: Vec<(usize, f64)>,
    pub(super) dimension: usize,
    pub(super) spacing: f64,
    tile: Cow<'static, Tile>,
    pub(super) turn: nalgebra::Matrix3<f64>,
    /// Where the corner of the first tile lies (m).
    corner: Vec3,
    /// Number of tiles along each axis.
    tiles: [u64; 3],
}

/// A block by its place among all blocks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    pub at: [u64; 3],
}

impl Cells {
    /// Of a body, if it is not filled by rows.
    pub fn of(body: &Body, dimension: usize, symmetry: &[SymmetryPlane]) -> Option<Self> {
        let lattice = &body.lattice;
        let has_rows = match lattice.kind {
            LatticeKind::Rings => true,
            LatticeKind::Cubic | LatticeKind::Hexagonal => {
                lattice.axis.is_none() && !matches!(body.shape, Shape::Solid(_))
            }
            LatticeKind::BodyCentred | LatticeKind::FaceCentred | LatticeKind::Glass => false,
        };
        if has_rows {
            return None;
        }
        let tile = Tile::of(lattice.kind, dimension);
        let (turn, shift) = if lattice.kind == LatticeKind::Glass {
            tile::drawn(lattice.seed, dimension)
        } else {
            let axis = lattice.axis.unwrap_or_else(Vec3::z);
            (rotation(&axis, lattice.angle), Vec3::zeros())
        };
        let mut cells = Self {
            planes: symmetry
                .iter()
                .map(|plane| (plane.axis.index(), plane.position))
                .collect(),
            dimension,
            spacing: lattice.spacing,
            tile,
            turn,
            corner: Vec3::zeros(),
            tiles: [1; 3],
            solid: body.shape.solid(dimension),
        };
        cells.lay(body.shape.centre(), shift);
        Some(cells)
    }

    /// Lays tiles about a centre (m), moved by a shift (tiles), until they cover the solid.
    fn lay(&mut self, centre: Vec3, shift: Vec3) {
        let (lower, upper) = self.solid.bounds();
        let edges = self.tile.edges * self.spacing;
        let mut first = Vec3::zeros();
        for a in 0..self.dimension {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for corner in 0..8_u8 {
                let x = Vec3::from_fn(|b, _| {
                    let end = if corner >> b & 1 == 1 { upper } else { lower };
                    if b < self.dimension {
                        end[b] - centre[b]
                    } else {
                        0.0
                    }
                });
                let along = self.turn.column(a).dot(&x) / edges[a] - shift[a];
                (low, high) = (low.min(along), high.max(along));
            }
            first[a] = low.floor();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            // saturating is meant
            {
                self.tiles[a] = (high.ceil() - first[a]).max(1.0) as u64;
            }
        }
        let along = (first + shift).component_mul(&edges);
        self.corner = centre + self.turn * along;
    }

    /// One more than the largest index.
    pub fn index_end(&self) -> u64 {
        let tiles = self.tiles.iter().fold(1_u64, |n, &m| n.saturating_mul(m));
        tiles.saturating_mul(self.tile.sites.len() as u64)
    }

    /// Whether sites are moved to fit the surface.
    pub fn is_fitted(&self) -> bool {
        self.tile.is_glass
    }

    /// Distance (m) from the surface and the symmetry planes, negative inside and above.
    pub(super) fn distance(&self, x: &Vec3) -> f64 {
        let beyond = self.planes.iter().map(|&(a, at)| at - x[a]);
        beyond.fold(self.solid.distance(x), f64::max)
    }

    /// Numbers of blocks along each axis.
    pub(super) fn blocks(&self) -> [u64; 3] {
        [0, 1, 2].map(|a| self.tiles[a] * self.tile.blocks[a])
    }

    /// Middle of a range of blocks and half its edges, along the axes of the tile (m).
    #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
    pub(super) fn middle(&self, first: [u64; 3], end: [u64; 3]) -> (Vec3, Vec3) {
        let size = |a: usize| self.tile.edges[a] * self.spacing / self.tile.blocks[a] as f64;
        let mut half = Vec3::from_fn(|a, _| 0.5 * (end[a] - first[a]) as f64 * size(a));
        let mut along = Vec3::from_fn(|a, _| 0.5 * (end[a] + first[a]) as f64 * size(a));
        for a in self.dimension..3 {
            (half[a], along[a]) = (0.0, 0.0);
        }
        (self.corner + self.turn * along, half)
    }

    /// All blocks in order, tile by tile, that may hold sites within the cuts.
    pub(super) fn all_blocks(&self) -> impl Iterator<Item = Block> + use<> {
        let (tiles, blocks) = (self.tiles, self.tile.blocks);
        let each = |n: [u64; 3]| {
            (0..n[2])
                .flat_map(move |k| (0..n[1]).flat_map(move |j| (0..n[0]).map(move |i| [i, j, k])))
        };
        each(tiles).flat_map(move |tile| {
            each(blocks).map(move |block| Block {
                at: [0, 1, 2].map(|a| tile[a] * blocks[a] + block[a]),
            })
        })
    }

    /// The site of a number in a block's tile: its index and where it stands before it is fitted
    /// (m).
    fn site(&self, block: Block, number: usize) -> Site {
        let tile = [0, 1, 2].map(|a| block.at[a] / self.tile.blocks[a]);
        let linear = tile[0] + self.tiles[0] * (tile[1] + self.tiles[1] * tile[2]);
        #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
        let along = Vec3::from_fn(|a, _| {
            (tile[a] as f64 * self.tile.edges[a] + self.tile.sites[number][a]) * self.spacing
        });
        Site {
            position: (self.corner + self.turn * along).into(),
            index: linear * self.tile.sites.len() as u64 + number as u64,
            share: 1.0,
        }
    }

    /// The sites of a block by their numbers in its tile.
    fn numbers(&self, block: Block) -> Range<usize> {
        self.tile
            .numbers([0, 1, 2].map(|a| block.at[a] % self.tile.blocks[a]))
    }

    /// Where the solid and the cuts leave a block.
    fn lie(&self, block: Block, cuts: &[Cut]) -> Lie {
        let end = block.at.map(|n| n + 1);
        let (middle, half) = self.middle(block.at, end);
        let reach = half.norm() + FACE * self.spacing;
        let (lower, upper) = (middle.add_scalar(-reach), middle.add_scalar(reach));
        let (lower, upper) = (lower.into(), upper.into());
        if cuts.iter().any(|cut| cut.drops(&lower, &upper)) {
            return Lie::Outside;
        }
        let distance = self.solid.distance(&middle);
        if distance >= reach {
            return Lie::Outside;
        }
        let is_kept = cuts
            .iter()
            .all(|cut| cut.keeps(&lower) && cut.keeps(&upper));
        if distance <= -reach && is_kept {
            Lie::Inside
        } else {
            Lie::Between
        }
    }

    fn holds(&self, x: &[f64; 3], cuts: &[Cut]) -> bool {
        cuts.iter().all(|cut| cut.keeps(x))
            && self.solid.distance(&Vec3::from(*x)) < -FACE * self.spacing
    }

    /// Its sites before they are fitted, in the order of their index within a block.
    pub(super) fn sites_of(&self, block: Block, cuts: &[Cut]) -> Vec<Site> {
        let lie = self.lie(block, cuts);
        if lie == Lie::Outside {
            return Vec::new();
        }
        let sites = self.numbers(block).map(|number| self.site(block, number));
        sites
            .filter(|site| lie == Lie::Inside || self.holds(&site.position, cuts))
            .collect()
    }

    /// How many there are.
    pub fn count(&self, cuts: &[Cut]) -> u64 {
        let of_block = |block| match self.lie(block, cuts) {
            Lie::Outside => 0,
            Lie::Inside => self.numbers(block).len() as u64,
            Lie::Between => self.sites_of(block, cuts).len() as u64,
        };
        self.all_blocks().map(of_block).sum()
    }

    /// Tells the coordinates on an axis (m) of one of several shares of the sites.
    pub fn tally(&self, cuts: &[Cut], axis: usize, share: Share, mut add: impl FnMut(f64, u64)) {
        for block in self
            .all_blocks()
            .skip(share.part)
            .step_by(share.parts.max(1))
        {
            for site in self.sites_of(block, cuts) {
                add(site.position[axis], 1);
            }
        }
    }
}

/// Where a block lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lie {
    Outside,
    Inside,
    Between,
}
