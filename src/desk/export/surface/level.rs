//! The level of a body at the nodes of a block.

use plot::{REACH, weight};

/// A particle as far as it fills space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its place (m).
    pub centre: [f64; 3],
    /// Its size s (m).
    pub size: f64,
    /// Number of its body.
    pub body: u32,
}

impl Ball {
    /// Reach of its weight (m).
    pub fn reach(&self) -> f64 {
        REACH * self.size
    }
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

/// Adds the weights of a particle to the nodes.
pub fn add(ball: &Ball, coordinates: &Coordinates, sums: &mut [f64]) {
    let square = |axis: usize, n: usize| {
        let distance = (coordinates[axis][n] - ball.centre[axis]) / ball.size;
        distance * distance
    };
    let most = REACH * REACH;
    for k in 0..NODES {
        let z = square(2, k);
        if z >= most {
            continue;
        }
        for j in 0..NODES {
            let yz = z + square(1, j);
            if yz >= most {
                continue;
            }
            for i in 0..NODES {
                sums[node(i, j, k)] += weight(yz + square(0, i));
            }
        }
    }
}

/// The level of each body from the sums of all, node by node: of the fourth roots of these, which are
/// nearly linear near a surface where the sums are steep.
pub fn levels(mut sums: Vec<Nodes>) -> Vec<Nodes> {
    for sum in sums.iter_mut().flatten() {
        *sum = sum.sqrt().sqrt();
    }
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
