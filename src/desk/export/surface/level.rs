//! The level of a body at the nodes of a block.

use numerics::ellipsoid::square;
use plot::{Fill, Shape};

/// A particle as far as it fills space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its place (m).
    pub centre: [f64; 3],
    /// Its shape.
    pub shape: Shape,
    /// Number of its body.
    pub body: u32,
}

/// Cells along an edge of a block.
pub const CELLS: usize = 16;
/// Nodes along an edge of a block, of which the last are the first of the next block.
pub const NODES: usize = CELLS + 1;

/// The nodes of a block: their coordinates (m) along each axis.
pub type Coordinates = [[f64; NODES]; 3];

/// Numbers at the nodes of a block, x first.
pub type Nodes = Vec<f64>;

/// Place of a node in [`Nodes`].
pub fn node(i: usize, j: usize, k: usize) -> usize {
    (k * NODES + j) * NODES + i
}

/// Adds a particle to what fills the nodes.
pub fn add(ball: &Ball, coordinates: &Coordinates, fills: &mut [Fill]) {
    let metric = ball.shape.ellipsoid.metric();
    let from = |axis: usize, n: usize| coordinates[axis][n] - ball.centre[axis];
    let near =
        |axis: usize| (0..NODES).filter(move |&n| from(axis, n).abs() < ball.shape.reach(axis));
    for k in near(2) {
        for j in near(1) {
            for i in near(0) {
                let from = [from(0, i), from(1, j), from(2, k)];
                fills[node(i, j, k)].add(&ball.shape, square(&metric, &from));
            }
        }
    }
}

/// The level of each body from the sums of all, node by node: of the fourth roots of these, which are
/// nearly linear near a surface where the sums are steep.
pub fn levels(fills: &[Vec<Fill>]) -> Vec<Nodes> {
    let root = |fill: &Fill| fill.level().sqrt().sqrt();
    let roots = fills.iter().map(|fills| fills.iter().map(root).collect());
    let sums: Vec<Nodes> = roots.collect();
    let level = |body: usize| {
        let at = |n: usize| {
            let others = sums.iter().enumerate().filter(|(other, _)| *other != body);
            let most = others.map(|(_, sums)| sums[n]).fold(1.0, f64::max);
            sums[body][n] - most
        };
        (0..sums[body].len()).map(at).collect()
    };
    (0..sums.len()).map(level).collect()
}
