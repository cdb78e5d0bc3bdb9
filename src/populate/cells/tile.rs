//! Periodic tiles: unit cells of crystals, and tiles of glass.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::OnceLock;

use model::{LatticeKind, Vec3, rotation};
use numerics::counter::split_mix;

/// Sites of the shipped tiles: 16³ in three dimensions, 64² in two, as 16-bit fractions of an edge;
/// any first ones of them are spread evenly.
const GLASS: [&[u8]; 2] = [include_bytes!("glass2.bin"), include_bytes!("glass3.bin")];
/// Edges of these (spacings).
pub(super) const GLASS_EDGES: [f64; 2] = [64.0, 16.0];

/// A periodic set of sites with one in a unit of volume.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tile {
    /// Edges (spacings).
    pub edges: Vec3,
    /// Number of blocks along each axis.
    pub blocks: [u64; 3],
    /// Sites from the corner on (spacings), block by block.
    pub sites: Vec<Vec3>,
    /// The order in which sites stay when fewer are wanted: any first ones are spread evenly.
    pub ranks: Vec<u32>,
    /// The first site of each block.
    starts: Vec<usize>,
    /// `true` if it has no order.
    pub is_glass: bool,
}

impl Tile {
    /// The tile of a lattice.
    pub fn of(kind: LatticeKind, dimension: usize) -> Cow<'static, Self> {
        if kind == LatticeKind::Glass {
            static TILES: [OnceLock<Tile>; 2] = [OnceLock::new(), OnceLock::new()];
            let n = dimension - 2;
            return Cow::Borrowed(TILES[n].get_or_init(|| Self::glass(GLASS[n], dimension)));
        }
        Cow::Owned(Self::crystal(kind, dimension))
    }

    /// A tile of glass from its bytes.
    fn glass(bytes: &[u8], dimension: usize) -> Self {
        let edge = GLASS_EDGES[dimension - 2];
        let coordinate = |c: &[u8]| f64::from(u16::from_le_bytes([c[0], c[1]])) / 65536.0 * edge;
        let sites = bytes.chunks_exact(2 * dimension).map(|site| {
            let mut x = Vec3::zeros();
            for (a, c) in site.chunks_exact(2).enumerate() {
                x[a] = coordinate(c);
            }
            x
        });
        let blocks = if dimension == 3 { [4; 3] } else { [8, 8, 1] };
        let mut edges = Vec3::repeat(edge);
        if dimension == 2 {
            edges.z = 1.0;
        }
        Self::cut(edges, blocks, sites.collect(), true)
    }

    /// Some unit cells of a crystal, as one block.
    fn crystal(kind: LatticeKind, dimension: usize) -> Self {
        let third = 1.0_f64 / 3.0;
        let (cell, basis, repeat): ([f64; 3], &[[f64; 3]], [u32; 3]) = match (kind, dimension) {
            (LatticeKind::BodyCentred, _) => (scaled([1.0; 3], 2), &[[0.25; 3], [0.75; 3]], [3; 3]),
            (LatticeKind::FaceCentred, _) => (
                scaled([1.0; 3], 4),
                &[
                    [0.25, 0.25, 0.25],
                    [0.75, 0.75, 0.25],
                    [0.75, 0.25, 0.75],
                    [0.25, 0.75, 0.75],
                ],
                [2; 3],
            ),
            (LatticeKind::Hexagonal, 3) => (
                scaled([1.0, 3.0_f64.sqrt(), (8.0 * third).sqrt()], 4),
                &[
                    [0.25, 1.0 / 6.0, 0.25],
                    [0.75, 4.0 / 6.0, 0.25],
                    [0.75, 2.0 / 6.0, 0.75],
                    [0.25, 5.0 / 6.0, 0.75],
                ],
                [3, 2, 2],
            ),
            (LatticeKind::Hexagonal, _) => (
                {
                    let edge = (2.0 / 3.0_f64.sqrt()).sqrt();
                    [edge, 3.0_f64.sqrt() * edge, 1.0]
                },
                &[[0.25, 0.25, 0.0], [0.75, 0.75, 0.0]],
                [6, 4, 1],
            ),
            (_, 3) => ([1.0; 3], &[[0.5; 3]], [4; 3]),
            _ => ([1.0; 3], &[[0.5, 0.5, 0.0]], [8, 8, 1]),
        };
        let mut sites = Vec::new();
        for k in 0..repeat[2] {
            for j in 0..repeat[1] {
                for i in 0..repeat[0] {
                    let at = [i, j, k].map(f64::from);
                    sites.extend(
                        basis
                            .iter()
                            .map(|b| Vec3::from_fn(|a, _| (at[a] + b[a]) * cell[a])),
                    );
                }
            }
        }
        let edges = Vec3::from_fn(|a, _| f64::from(repeat[a]) * cell[a]);
        Self::cut(edges, [1; 3], sites, false)
    }

    /// Sorts sites by their blocks.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss
    )]
    fn cut(edges: Vec3, blocks: [u64; 3], sites: Vec<Vec3>, is_glass: bool) -> Self {
        let block = |x: &Vec3| {
            let at = |a: usize| ((x[a] / edges[a] * blocks[a] as f64) as u64).min(blocks[a] - 1);
            at(0) + blocks[0] * (at(1) + blocks[1] * at(2))
        };
        let mut ranked: Vec<(u32, Vec3)> = (0..).zip(sites).collect();
        ranked.sort_by_key(|(_, x)| block(x));
        let (ranks, sites): (Vec<u32>, Vec<Vec3>) = ranked.into_iter().unzip();
        let count = blocks.iter().product::<u64>();
        let starts = (0..=count).map(|b| sites.partition_point(|x| block(x) < b));
        Self {
            edges,
            blocks,
            starts: starts.collect(),
            ranks,
            sites,
            is_glass,
        }
    }

    /// The sites of a block of the tile.
    #[allow(clippy::cast_possible_truncation)] // a few blocks
    pub fn numbers(&self, [i, j, k]: [u64; 3]) -> Range<usize> {
        let block = (i + self.blocks[0] * (j + self.blocks[1] * k)) as usize;
        self.starts[block]..self.starts[block + 1]
    }
}

/// Edges of a cell of the given shape that holds some sites of unit volume.
fn scaled(edges: [f64; 3], sites: u32) -> [f64; 3] {
    let volume: f64 = edges.iter().product();
    edges.map(|edge| edge * libm::cbrt(f64::from(sites) / volume))
}

/// Random rotation and shift (tiles) of a seed: any rotation in space (about z in two dimensions)
/// and any shift are as likely.
pub(crate) fn drawn(seed: u64, dimension: usize) -> (nalgebra::Matrix3<f64>, Vec3) {
    let mut state = seed;
    let mut draw = || {
        let word = split_mix(&mut state);
        #[allow(clippy::cast_precision_loss)] // 53 bits
        let fraction = (word >> 11) as f64 / (1_u64 << 53) as f64;
        fraction
    };
    let mut shift = Vec3::from_fn(|_, _| draw());
    let angle = std::f64::consts::TAU * draw();
    if dimension == 2 {
        shift.z = 0.0;
        return (rotation(&Vec3::z(), angle), shift);
    }
    // About z, and then z to anywhere on the sphere (Arvo 1992, "Fast random rotation matrices").
    let (around, up) = (std::f64::consts::TAU * draw(), draw());
    let v = Vec3::new(
        libm::cos(around) * up.sqrt(),
        libm::sin(around) * up.sqrt(),
        (1.0 - up).sqrt(),
    );
    let mirror = v * v.transpose() * 2.0 - nalgebra::Matrix3::identity();
    (mirror * rotation(&Vec3::z(), angle), shift)
}
