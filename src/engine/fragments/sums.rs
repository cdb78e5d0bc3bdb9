//! Exact sums over what hangs together: the same bits on any ranks and threads.

use super::matter::Matter;
use comm::read_pod;
use numerics::exact_sum::{ExactSum, LIMBS};

/// Pairs of axes of the second moments.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];

/// Sums over particles of mass m at x with velocity v, in this order: m; m x; m v; m x x by
/// [`PAIRS`]; m x × v; m s² of the size s; m T and m where there is a temperature T; m times the
/// plastic strain; m by body.
#[derive(Debug, Clone)]
pub struct Sums {
    sums: Vec<ExactSum>,
}

/// Index of the first of the masses by body.
const BODIES: usize = 20;

/// Values of [`Sums`].
#[derive(Debug, Clone)]
pub struct Moments {
    pub mass: f64,
    pub position: [f64; 3],
    pub momentum: [f64; 3],
    pub second: [[f64; 3]; 3],
    pub spin: [f64; 3],
    pub size: f64,
    pub heat: [f64; 2],
    pub strain: f64,
    pub by_body: Vec<f64>,
}

impl Sums {
    /// Empty sums over particles of so many bodies.
    pub fn new(bodies: usize) -> Self {
        Self {
            sums: vec![ExactSum::new(); BODIES + bodies],
        }
    }

    /// Adds a particle of this rank.
    pub fn add(&mut self, matter: &Matter, i: usize) {
        let (m, x, v) = (matter.mass[i], &matter.position[i], &matter.velocity[i]);
        let mut terms = [0.0; BODIES];
        terms[0] = m;
        for a in 0..3 {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            terms[1 + a] = m * x[a];
            terms[4 + a] = m * v[a];
            terms[13 + a] = m * (x[b] * v[c] - x[c] * v[b]);
        }
        for (k, [a, b]) in PAIRS.into_iter().enumerate() {
            terms[7 + k] = m * (x[a] * x[b]);
        }
        terms[16] = m * (matter.size[i] * matter.size[i]);
        if !matter.temperature[i].is_nan() {
            terms[17] = m * matter.temperature[i];
            terms[18] = m;
        }
        terms[19] = m * matter.plastic_strain[i];
        for (sum, term) in self.sums.iter_mut().zip(terms) {
            sum.add(term);
        }
        self.sums[BODIES + matter.body[i] as usize].add(m);
    }

    /// Adds the particles of others.
    pub fn merge(&mut self, other: &Self) {
        for (sum, other) in self.sums.iter_mut().zip(&other.sums) {
            sum.merge(other);
        }
    }

    /// Appends the sums to a message: their number; for each a set of limbs that are not zero, and these.
    pub fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&(self.sums.len() as u64).to_ne_bytes());
        for sum in &self.sums {
            let mut sum = sum.clone();
            sum.normalise();
            let limbs = sum.limbs().iter().enumerate();
            let limbs = limbs.filter(|(_, limb)| **limb != 0);
            let set = limbs.clone().fold(0_u128, |set, (k, _)| set | 1 << k);
            bytes.extend_from_slice(&set.to_ne_bytes());
            limbs.for_each(|(_, limb)| bytes.extend_from_slice(&limb.to_ne_bytes()));
        }
    }

    /// Takes what [`Self::write`] wrote from the start of a message.
    pub fn read(bytes: &mut &[u8]) -> Self {
        let count: u64 = read_pod(bytes);
        let sums = (0..count).map(|_| {
            let mut sum = ExactSum::new();
            let set: u128 = read_pod(bytes);
            for k in (0..LIMBS).filter(|k| set >> k & 1 == 1) {
                sum.limbs_mut()[k] = read_pod(bytes);
            }
            sum
        });
        Self {
            sums: sums.collect(),
        }
    }

    /// The sums, each rounded once.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.sums.iter().map(ExactSum::value)
    }
}

impl Moments {
    /// Of the [`Sums::values`].
    pub fn new(values: &[f64]) -> Self {
        let three = |k: usize| [values[k], values[k + 1], values[k + 2]];
        let mut second = [[0.0; 3]; 3];
        for (k, [a, b]) in PAIRS.into_iter().enumerate() {
            second[a][b] = values[7 + k];
            second[b][a] = values[7 + k];
        }
        Self {
            mass: values[0],
            position: three(1),
            momentum: three(4),
            second,
            spin: three(13),
            size: values[16],
            heat: [values[17], values[18]],
            strain: values[19],
            by_body: values[BODIES..].to_vec(),
        }
    }
}
