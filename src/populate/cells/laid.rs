//! Tiles laid through a solid: which blocks and sites belong to it.

use std::borrow::Cow;
use std::ops::Range;

use super::tile::{self, Tile};
use crate::Site;
use crate::row::Cut;
use model::{Body, Lattice, LatticeKind, Shape, Solid, SymmetryPlane, Vec3, cube, rotation};

/// Sites as near to the surface as this (spacings) are outside: whether a lattice point on a face
/// belongs to the body must not hang on rounding.
const FACE: f64 = 1e-9;

/// The sites of one body that is not filled by rows.
#[derive(Debug, Clone)]
pub(crate) struct Cells {
    pub(super) solid: Solid,
    /// Corners of a box about it (m).
    pub(super) ends: (Vec3, Vec3),
    /// Lower sides by axis that symmetry planes cut off (m).
    pub(super) planes: Vec<(usize, f64)>,
    pub(super) dimension: usize,
    /// The finest spacing, and how it grows (m).
    pub(super) lattice: Lattice,
    pub(super) tile: Cow<'static, Tile>,
    pub(super) turn: nalgebra::Matrix3<f64>,
    /// Tiles of the spacing; where that is graded, also of twice the spacing, four times, and so
    /// on, of which each fills the places with spacings up to twice its own.
    pub(super) levels: Vec<Level>,
}

/// Tiles of one size.
#[derive(Debug, Clone)]
pub(super) struct Level {
    /// Spacing of its full tiles (m).
    pub spacing: f64,
    /// Beyond all spacings that it fills (m).
    end: f64,
    /// The corner of the first tile (m).
    pub corner: Vec3,
    /// Number of tiles along each axis.
    tiles: [u64; 3],
    /// The first index of its sites.
    first: u64,
}

/// A block by its level and its place among all blocks of that.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    pub level: usize,
    pub at: [u64; 3],
}

impl Cells {
    /// Of a body, if it is filled neither by rows nor by shells.
    pub fn of(body: &Body, dimension: usize, symmetry: &[SymmetryPlane]) -> Option<Self> {
        if has_rows(body) || body.lattice.kind == LatticeKind::Shells {
            return None;
        }
        let lattice = &body.lattice;
        let tile = Tile::of(lattice.kind, dimension);
        let (turn, shift) = if lattice.kind == LatticeKind::Glass {
            tile::drawn(lattice.seed, dimension)
        } else {
            let axis = lattice.axis.unwrap_or_else(Vec3::z);
            (rotation(&axis, lattice.angle), Vec3::zeros())
        };
        let solid = body.shape.solid(dimension);
        let mut cells = Self {
            ends: solid.bounds(),
            planes: symmetry
                .iter()
                .map(|plane| (plane.axis.index(), plane.position))
                .collect(),
            dimension,
            lattice: lattice.clone(),
            tile,
            turn,
            levels: Vec::new(),
            solid,
        };
        let (mut spacing, mut first) = (lattice.spacing, 0);
        while spacing <= lattice.coarsest() {
            let coarser = 2.0 * spacing;
            let end = if coarser > lattice.coarsest() {
                f64::INFINITY
            } else {
                coarser
            };
            let level = cells.lay(body.shape.centre(), shift, [spacing, end], first);
            first = first.saturating_add(cells.sites_in(&level));
            cells.levels.push(level);
            spacing = coarser;
        }
        Some(cells)
    }

    /// Lays tiles about a centre (m), moved by a shift (tiles), until they cover those places in the
    /// solid where spacings lie in a range (m).
    fn lay(&self, centre: Vec3, shift: Vec3, [spacing, end]: [f64; 2], first: u64) -> Level {
        let (mut lower, mut upper) = self.ends;
        if let Some(grading) = &self.lattice.grading {
            let farthest = grading.distance(self.lattice.spacing, end);
            let (nearest_lower, nearest_upper) = grading.from.around(farthest);
            (lower, upper) = (lower.sup(&nearest_lower), upper.inf(&nearest_upper));
        }
        let edges = self.tile.edges * spacing;
        let (mut begin, mut tiles) = (Vec3::zeros(), [1; 3]);
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
            begin[a] = low.floor();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            // saturating is meant
            {
                tiles[a] = (high.ceil() - begin[a]).max(1.0) as u64;
            }
        }
        if (0..self.dimension).any(|a| lower[a] > upper[a]) {
            tiles = [0; 3];
        }
        let along = (begin + shift).component_mul(&edges);
        Level {
            spacing,
            end,
            corner: centre + self.turn * along,
            tiles,
            first,
        }
    }

    /// The number of indices of the tiles of a level.
    fn sites_in(&self, level: &Level) -> u64 {
        let tiles = level.tiles.iter().fold(1_u64, |n, &m| n.saturating_mul(m));
        tiles.saturating_mul(self.tile.sites.len() as u64)
    }

    /// Sites that a box about the solid would have at the finest spacing.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    pub fn most_sites(&self) -> u64 {
        let (lower, upper) = self.ends;
        let along = |a: usize| ((upper[a] - lower[a]) / self.lattice.spacing).max(1.0);
        (0..self.dimension).fold(1.0, |n, a| n * along(a)).ceil() as u64
    }

    /// One more than the largest index.
    pub fn index_end(&self) -> u64 {
        let levels = self.levels.iter().map(|level| self.sites_in(level));
        levels.fold(0, u64::saturating_add)
    }

    /// `true` if sites are moved to fit the surface.
    pub fn is_fitted(&self) -> bool {
        self.tile.is_glass
    }

    /// `true` if the spacing grows.
    pub fn is_graded(&self) -> bool {
        self.lattice.grading.is_some()
    }

    /// The coarsest spacing (m) of a level.
    pub(super) fn coarsest(&self, level: usize) -> f64 {
        self.levels[level].end.min(self.lattice.coarsest())
    }

    /// Distance (m) from the surface and the symmetry planes, negative inside and above.
    pub(super) fn distance(&self, x: &Vec3) -> f64 {
        let beyond = self.planes.iter().map(|&(a, at)| at - x[a]);
        beyond.fold(self.solid.distance(x), f64::max)
    }

    /// Numbers of blocks of a level along each axis.
    pub(super) fn blocks(&self, level: usize) -> [u64; 3] {
        [0, 1, 2].map(|a| self.levels[level].tiles[a] * self.tile.blocks[a])
    }

    /// Middle of a range of blocks and half its edges, along the axes of the tile (m).
    #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
    pub(super) fn middle(&self, level: usize, first: [u64; 3], end: [u64; 3]) -> (Vec3, Vec3) {
        let Level {
            spacing, corner, ..
        } = self.levels[level];
        let size = |a: usize| self.tile.edges[a] * spacing / self.tile.blocks[a] as f64;
        let mut half = Vec3::from_fn(|a, _| 0.5 * (end[a] - first[a]) as f64 * size(a));
        let mut along = Vec3::from_fn(|a, _| 0.5 * (end[a] + first[a]) as f64 * size(a));
        for a in self.dimension..3 {
            (half[a], along[a]) = (0.0, 0.0);
        }
        (corner + self.turn * along, half)
    }

    /// All tiles in order, level by level.
    pub(super) fn all_tiles(&self) -> impl Iterator<Item = Block> + use<> {
        let tiles: Vec<[u64; 3]> = self.levels.iter().map(|level| level.tiles).collect();
        let tiles = tiles.into_iter().enumerate();
        tiles.flat_map(|(level, n)| each(n).map(move |at| Block { level, at }))
    }

    /// All blocks in order, tile by tile, of the tiles that may hold sites within the cuts.
    pub(super) fn all_blocks(&self, cuts: &[Cut]) -> impl Iterator<Item = Block> + use<> {
        let held = |tile: &Block| self.lie(tile.level, self.of_tile(*tile), cuts) != Lie::Outside;
        let tiles: Vec<Block> = self.all_tiles().filter(held).collect();
        let blocks = self.tile.blocks;
        tiles.into_iter().flat_map(move |tile| {
            each(blocks).map(move |block| Block {
                level: tile.level,
                at: [0, 1, 2].map(|a| tile.at[a] * blocks[a] + block[a]),
            })
        })
    }

    /// The first block of a tile, and the end of its blocks.
    pub(super) fn of_tile(&self, tile: Block) -> [[u64; 3]; 2] {
        let corner = |more: u64| [0, 1, 2].map(|a| (tile.at[a] + more) * self.tile.blocks[a]);
        [corner(0), corner(1)]
    }

    /// The site of a number in a block's tile: its index and its position before it is fitted (m).
    fn site(&self, block: Block, number: usize) -> Site {
        let level = &self.levels[block.level];
        let tile = [0, 1, 2].map(|a| block.at[a] / self.tile.blocks[a]);
        let linear = tile[0] + level.tiles[0] * (tile[1] + level.tiles[1] * tile[2]);
        #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
        let along = Vec3::from_fn(|a, _| {
            (tile[a] as f64 * self.tile.edges[a] + self.tile.sites[number][a]) * level.spacing
        });
        let position = level.corner + self.turn * along;
        let size = self.lattice.spacing_at(&position) / self.lattice.spacing;
        Site {
            position: position.into(),
            index: level.first + linear * self.tile.sites.len() as u64 + number as u64,
            share: cube(size, self.dimension),
        }
    }

    /// `true` if the site of a number in a tile is one of those that a spacing (m) leaves of a
    /// level.
    #[allow(clippy::cast_precision_loss)] // a few thousand
    fn is_left(&self, level: &Level, number: usize, spacing: f64) -> bool {
        let size = level.spacing / spacing;
        let share = cube(size, self.dimension);
        let is_of_level = level.spacing <= spacing && spacing < level.end;
        is_of_level && f64::from(self.tile.ranks[number]) < share * self.tile.sites.len() as f64
    }

    /// The sites of a block by their numbers in its tile.
    fn numbers(&self, block: Block) -> Range<usize> {
        self.tile
            .numbers([0, 1, 2].map(|a| block.at[a] % self.tile.blocks[a]))
    }

    /// The part of a range of blocks of a level that the solid, the cuts and the spacing leave.
    pub(super) fn lie(&self, level: usize, [first, end]: [[u64; 3]; 2], cuts: &[Cut]) -> Lie {
        let (middle, half) = self.middle(level, first, end);
        let reach = half.norm() + FACE * self.lattice.spacing;
        let thinned = self.lie_in_grading(&self.levels[level], &middle, reach);
        if thinned == Lie::Outside {
            return Lie::Outside;
        }
        let (lower, upper) = (middle.add_scalar(-reach), middle.add_scalar(reach));
        let (lower, upper) = (lower.into(), upper.into());
        if cuts.iter().any(|cut| cut.drops(&lower, &upper)) {
            return Lie::Outside;
        }
        if self.is_beyond(&middle, reach) {
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
            thinned
        } else {
            Lie::Between
        }
    }

    /// The part of the sites of a level that is left as near to a position as `reach` (m).
    fn lie_in_grading(&self, level: &Level, middle: &Vec3, reach: f64) -> Lie {
        let Some(grading) = &self.lattice.grading else {
            return Lie::Inside;
        };
        let distance = grading.from.distance(middle);
        let spacing = |distance| grading.spacing(self.lattice.spacing, distance);
        let (finest, coarsest) = (spacing(distance - reach), spacing(distance + reach));
        if coarsest < level.spacing || finest >= level.end {
            Lie::Outside
        } else if finest == level.spacing && coarsest == level.spacing {
            Lie::Inside
        } else {
            Lie::Between
        }
    }

    /// `true` if all as near to a position as `reach` (m) is outside the box about the solid.
    fn is_beyond(&self, x: &Vec3, reach: f64) -> bool {
        let (lower, upper) = &self.ends;
        (0..self.dimension).any(|a| x[a] + reach < lower[a] || x[a] - reach > upper[a])
    }

    fn holds(&self, x: &[f64; 3], cuts: &[Cut]) -> bool {
        cuts.iter().all(|cut| cut.keeps(x))
            && !self.is_beyond(&Vec3::from(*x), 0.0)
            && self.solid.distance(&Vec3::from(*x)) < -FACE * self.lattice.spacing
    }

    /// Its sites before they are fitted, in the order of their index within a block.
    pub(super) fn sites_of(&self, block: Block, cuts: &[Cut]) -> Vec<Site> {
        let mut sites = Vec::new();
        self.emit_sites(block, cuts, |site| sites.push(site));
        sites
    }

    /// Tells its sites before they are fitted, in the order of their index within a block.
    pub(super) fn emit_sites(&self, block: Block, cuts: &[Cut], mut emit: impl FnMut(Site)) {
        let lie = self.lie(block.level, [block.at, block.at.map(|n| n + 1)], cuts);
        if lie == Lie::Outside {
            return;
        }
        crate::visits::add(1);
        let level = &self.levels[block.level];
        for number in self.numbers(block) {
            let site = self.site(block, number);
            let is_one = lie == Lie::Inside || {
                let spacing = self.lattice.spacing_at(&site.position.into());
                self.is_left(level, number, spacing) && self.holds(&site.position, cuts)
            };
            if is_one {
                emit(site);
            }
        }
    }
}

/// All triples of indices below some numbers, the first one fastest.
pub(super) fn each(n: [u64; 3]) -> impl Iterator<Item = [u64; 3]> {
    (0..n[2]).flat_map(move |k| (0..n[1]).flat_map(move |j| (0..n[0]).map(move |i| [i, j, k])))
}

/// `true` if rows of a lattice fill a body.
pub(crate) fn has_rows(body: &Body) -> bool {
    let lattice = &body.lattice;
    match lattice.kind {
        LatticeKind::Rings => true,
        LatticeKind::Cubic | LatticeKind::Hexagonal => {
            lattice.axis.is_none() && !matches!(body.shape, Shape::Solid(_))
        }
        LatticeKind::BodyCentred
        | LatticeKind::FaceCentred
        | LatticeKind::Shells
        | LatticeKind::Glass => false,
    }
}

/// The part of a block that is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lie {
    Outside,
    Inside,
    Between,
}
