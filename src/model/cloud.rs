//! Particles that a file gives: a body that is no filled shape.

use super::surface::Tree;
use super::units::Powers;
use super::{SurfaceFile, Vec3};
use nalgebra::Matrix3;

macro_rules! quantities {
    ($($(#[$doc:meta])+ $quantity:ident = $name:literal, $components:literal, $powers:expr;)+) => {
        /// A quantity that a file may give of its particles.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Quantity { $($(#[$doc])+ $quantity,)+ }

        impl Quantity {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$quantity,)+];

            /// Its name in files and in an input.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$quantity => $name,)+ }
            }

            /// The number of components.
            #[must_use]
            pub fn components(self) -> usize {
                match self { $(Self::$quantity => $components,)+ }
            }

            /// Its dimension in a case of three dimensions.
            fn powers(self) -> Powers {
                match self { $(Self::$quantity => $powers,)+ }
            }
        }
    };
}

quantities! {
    /// Position (m).
    Position = "position", 3, [1, 0, 0, 0, 0];
    /// Mass (kg; kg/m or kg/m² in two or one dimensions).
    Mass = "mass", 1, [0, 1, 0, 0, 0];
    /// Volume (m³; m² or m in two or one dimensions).
    Volume = "volume", 1, [3, 0, 0, 0, 0];
    /// Density (kg/m³).
    Density = "density", 1, [-3, 1, 0, 0, 0];
    /// Velocity (m/s).
    Velocity = "velocity", 3, [1, 0, -1, 0, 0];
    /// Specific energy (J/kg).
    SpecificEnergy = "specific_energy", 1, [2, 0, -2, 0, 0];
    /// Temperature (K).
    Temperature = "temperature", 1, [0, 0, 0, 1, 0];
    /// Deviatoric stress (Pa) xx, yy, zz, xy, xz, yz, tension positive.
    DeviatoricStress = "deviatoric_stress", 6, [-1, 1, -2, 0, 0];
    /// Equivalent plastic strain.
    PlasticStrain = "plastic_strain", 1, [0; 5];
    /// Damage.
    Damage = "damage", 1, [0; 5];
    /// Elastic energy that was held when the material failed (J/kg).
    FailureEnergy = "failure_energy", 1, [2, 0, -2, 0, 0];
    /// How far pores have been crushed.
    Compaction = "compaction", 1, [0; 5];
    /// Share of an explosive that has burnt.
    Burn = "burn", 1, [0; 5];
    /// Elastic displacement that no linear field explains (m).
    HourglassDisplacement = "hourglass_displacement", 3, [1, 0, 0, 0, 0];
}

impl Quantity {
    /// Its dimension in a case of so many dimensions: of what is missing, a metre has one.
    #[must_use]
    pub fn powers_in(self, dimension: usize) -> Powers {
        let mut powers = self.powers();
        let missing = if dimension == 3 {
            0
        } else if dimension == 2 {
            1
        } else {
            2
        };
        if matches!(self, Self::Mass | Self::Volume) {
            powers[0] -= missing;
        }
        powers
    }

    /// The quantity of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|q| q.name() == name)
    }
}

/// Sizes of particles that differ by no more than this are the same but for rounding.
const ALIKE: f64 = 1e-6;

/// Particles in rows, with the quantities of a file beside their positions and volumes.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloud {
    /// Their file.
    pub file: SurfaceFile,
    dimension: usize,
    positions: Vec<[f64; 3]>,
    volumes: Vec<f64>,
    held: Vec<(Quantity, Vec<f64>)>,
    tree: Tree,
}

impl Cloud {
    /// Of positions (m), whose components beyond the dimension are zero, of as many volumes (m³; m²
    /// or m in two or one dimensions), and of other quantities, row after row, in SI units.
    #[must_use]
    pub fn new(
        file: SurfaceFile,
        dimension: usize,
        positions: Vec<[f64; 3]>,
        volumes: Vec<f64>,
        held: Vec<(Quantity, Vec<f64>)>,
    ) -> Self {
        let around = |(x, volume): (&[f64; 3], &f64)| {
            let half = 0.5 * edge(*volume, dimension);
            (x.map(|c| c - half), x.map(|c| c + half))
        };
        let boxes: Vec<_> = positions.iter().zip(&volumes).map(around).collect();
        let tree = Tree::new(&boxes);
        Self {
            file,
            dimension,
            positions,
            volumes,
            held,
            tree,
        }
    }

    /// Number of particles.
    #[must_use]
    pub fn count(&self) -> usize {
        self.positions.len()
    }

    /// Their places (m), before the body is moved into touch.
    #[must_use]
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Their volumes (m³; m² or m in two or one dimensions).
    #[must_use]
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    /// Smallest and largest size of particles against one of the mean volume, unless all are alike.
    #[must_use]
    pub fn sizes(&self) -> Option<[f64; 2]> {
        #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
        let mean = self.volumes.iter().sum::<f64>() / self.count() as f64;
        let of = |pick: fn(f64, f64) -> f64, start: f64| {
            edge(
                self.volumes.iter().copied().fold(start, pick) / mean,
                self.dimension,
            )
        };
        let (least, most) = (of(f64::min, f64::INFINITY), of(f64::max, 0.0));
        (most / least > 1.0 + ALIKE).then_some([least, most])
    }

    /// The other quantities, in the order of [`Quantity::ALL`].
    pub fn quantities(&self) -> impl Iterator<Item = Quantity> {
        self.held.iter().map(|(quantity, _)| *quantity)
    }

    /// The components of a quantity of a row, if it is held.
    #[must_use]
    pub fn get(&self, quantity: Quantity, row: usize) -> Option<&[f64]> {
        let (_, values) = self.held.iter().find(|(held, _)| *held == quantity)?;
        let n = quantity.components();
        values.get(row * n..(row + 1) * n)
    }

    /// All values of a quantity, row after row, if it is held.
    #[must_use]
    pub fn all(&self, quantity: Quantity) -> Option<&[f64]> {
        let mut held = self.held.iter();
        held.find(|(held, _)| *held == quantity)
            .map(|(_, values)| values.as_slice())
    }

    /// Rows in the order of the tree: neighbours are near each other, and halves of halves down to
    /// a few rows are its nodes.
    #[must_use]
    pub fn order(&self) -> &[u32] {
        self.tree.order()
    }

    /// Box around the volumes of some rows by their places in [`Self::order`], which are all or a
    /// half of a half (m).
    #[must_use]
    pub fn around(&self, first: usize, end: usize) -> ([f64; 3], [f64; 3]) {
        self.tree.around(first, end).unwrap_or_else(|| {
            let mut ends = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
            for &row in &self.order()[first..end] {
                let x = self.positions[row as usize];
                let half = 0.5 * edge(self.volumes[row as usize], self.dimension);
                for a in 0..3 {
                    ends.0[a] = ends.0[a].min(x[a] - half);
                    ends.1[a] = ends.1[a].max(x[a] + half);
                }
            }
            ends
        })
    }

    /// Distance (m) of a point from the nearest of balls as wide as the particles, negative inside.
    #[must_use]
    pub fn distance(&self, p: &Vec3) -> f64 {
        let point = [0, 1, 2].map(|a| if a < self.dimension { p[a] } else { 0.0 });
        let mut nearest = f64::INFINITY;
        self.tree.near(&point, f64::INFINITY, |row| {
            let x = &self.positions[row as usize];
            let square = (0..3).fold(0.0, |sum, a| sum + (x[a] - point[a]).powi(2));
            let half = 0.5 * edge(self.volumes[row as usize], self.dimension);
            nearest = nearest.min(square.sqrt() - half);
            let beyond = nearest.max(0.0);
            beyond * beyond
        });
        nearest
    }

    /// The largest `n·x` (m) of the cubes as large as the particles, for a vector n.
    #[must_use]
    pub fn support(&self, n: &Vec3) -> f64 {
        let across = (0..self.dimension).fold(0.0, |sum, a| sum + n[a].abs());
        self.tree.farthest(&(*n).into(), |row| {
            let x = Vec3::from(self.positions[row as usize]);
            let half = 0.5 * edge(self.volumes[row as usize], self.dimension);
            n.dot(&x) + half * across
        })
    }

    /// Volume of all (m³; m² or m in two or one dimensions).
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.volumes.iter().fold(0.0, |sum, v| sum + v)
    }

    /// Covariance of the places of their volumes (m²).
    #[must_use]
    pub fn covariance(&self) -> Matrix3<f64> {
        let (lower, upper) = self.bounds();
        let middle = (Vec3::from(lower) + Vec3::from(upper)) * 0.5;
        let (mut first, mut second) = (Vec3::zeros(), Matrix3::zeros());
        for (x, volume) in self.positions.iter().zip(&self.volumes) {
            let x = Vec3::from(*x) - middle;
            first += x * *volume;
            second += x * x.transpose() * *volume;
        }
        let mean = first / self.volume();
        second / self.volume() - mean * mean.transpose()
    }

    /// Corners of a box around all (m).
    #[must_use]
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let (mut lower, mut upper) = self.tree.bounds();
        for a in self.dimension..3 {
            (lower[a], upper[a]) = (0.0, 0.0);
        }
        (lower, upper)
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn memory(&self) -> usize {
        let held = self.held.iter().map(|(_, values)| size_of_val(&values[..]));
        size_of_val(&self.positions[..])
            + size_of_val(&self.volumes[..])
            + held.sum::<usize>()
            + self.tree.memory()
    }
}

/// Volume of a cube, a square or an interval of an edge (m).
#[must_use]
pub fn cube(edge: f64, dimension: usize) -> f64 {
    (1..dimension).fold(edge, |volume, _| volume * edge)
}

/// Edge (m) of a cube, a square or an interval of a volume.
#[must_use]
pub fn edge(volume: f64, dimension: usize) -> f64 {
    match dimension {
        1 => volume,
        2 => volume.sqrt(),
        _ => libm::cbrt(volume),
    }
}
