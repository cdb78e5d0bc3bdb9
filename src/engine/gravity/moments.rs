//! Moments of the masses of cells: sums of whole numbers, which have the same bits in any order and over any
//! ranks, and what they come to as doubles.

use super::cube::Cube;

/// The places of the second moments: xx, yy, zz, xy, xz, yz.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// `Σ m`, `Σ m x` and `Σ m x x` in units of the cube, about its lower corner. Masses are below 2⁶¹ together and places below
/// 2³¹, so that sums and their shifts fit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Moments {
    mass: i128,
    first: [i128; 3],
    second: [i128; 6],
}

/// What a cell exerts as one body: its quadrupole about its centre of mass.
#[derive(Debug, Clone, Copy, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Pole {
    /// Centre of mass (m).
    pub centre: [f64; 3],
    /// Mass (kg).
    pub mass: f64,
    /// `Σ m x x` about the centre of mass (kg m²): xx, yy, zz, xy, xz, yz.
    pub second: [f64; 6],
}

impl Moments {
    /// Of a particle.
    pub fn of(cube: &Cube, position: &[f64; 3], mass: f64) -> Self {
        let mass = cube.mass(mass);
        let first = cube.place(position).map(i128::from);
        Self {
            mass,
            first: first.map(|x| mass * x),
            second: PAIRS.map(|[a, b]| mass * (first[a] * first[b])),
        }
    }

    /// Adds other moments.
    pub fn add(&mut self, other: &Self) {
        self.mass += other.mass;
        for (sum, other) in self.first.iter_mut().zip(other.first) {
            *sum += other;
        }
        for (sum, other) in self.second.iter_mut().zip(other.second) {
            *sum += other;
        }
    }

    /// About the centre of mass, which alone tells the bits: not the cell, of which cells that hold the same differ.
    #[allow(clippy::cast_precision_loss, reason = "rounded at last")]
    pub fn pole(&self, cube: &Cube) -> Pole {
        if self.mass == 0 {
            return Pole::default();
        }
        let mass = self.mass as f64;
        // The place next to the centre, and what is left.
        let near = self.first.map(|first| first / self.mass);
        let left: [f64; 3] = [0, 1, 2].map(|a| (self.first[a] - self.mass * near[a]) as f64 / mass);
        let second = |k: usize| {
            let [a, b] = PAIRS[k];
            let about = self.second[k] - near[a] * self.first[b] - near[b] * self.first[a]
                + self.mass * (near[a] * near[b]);
            (about as f64 - mass * (left[a] * left[b])) * cube.mass_unit * cube.unit * cube.unit
        };
        Pole {
            // A place is the lower end of its unit.
            centre: [0, 1, 2]
                .map(|a| cube.origin[a] + (near[a] as f64 + (left[a] + 0.5)) * cube.unit),
            mass: mass * cube.mass_unit,
            second: [0, 1, 2, 3, 4, 5].map(second),
        }
    }
}
