//! The cube around all particles, and the whole numbers by which it tells places and masses: the same on
//! all ranks, whatever they own.

use rayon::prelude::*;

use super::tree::Point;
use comm::Comm;
use model::SelfGravity;

/// Levels of cells below the cube.
pub(super) const DEPTH: u32 = 19;
/// Bits of a coordinate in the cube.
const BITS: u32 = 31;
/// Words that a rank tells of its particles.
const WORDS: usize = 9;
/// Bits of a level in a [`Key`].
const LEVEL_BITS: u32 = 5;

/// A cell: the Morton code of its lower corner, then its level. Keys order cells depth first, each before those in it.
pub(super) type Key = u64;

/// Level of the cell of a key.
pub(super) fn level_of(key: Key) -> u32 {
    (key & ((1 << LEVEL_BITS) - 1)) as u32
}

/// The cell of a level that holds the cell of a key.
pub(super) fn ancestor(key: Key, level: u32) -> Key {
    let below = LEVEL_BITS + 3 * (DEPTH - level);
    key >> below << below | Key::from(level)
}

/// Level of the smallest cell that holds the cells of two keys.
pub(super) fn common_level(a: Key, b: Key) -> u32 {
    let differ = (a ^ b) >> LEVEL_BITS;
    let shared = (differ.leading_zeros() - (64 - 3 * DEPTH)) / 3;
    shared.min(DEPTH).min(level_of(a)).min(level_of(b))
}

/// The eighth of a cell of `level` that holds the cell of a key.
pub(super) fn eighth(key: Key, level: u32) -> u64 {
    key >> (LEVEL_BITS + 3 * (DEPTH - level - 1)) & 7
}

/// A box in units of the cube, which doubles hold.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub lower: [f64; 3],
    pub upper: [f64; 3],
}

impl Bounds {
    /// Square of its distance from another box.
    #[inline(always)]
    pub fn gap2(&self, other: &Self) -> f64 {
        let mut sum = 0.0;
        for a in 0..3 {
            let before = self.lower[a] - other.upper[a];
            let beyond = other.lower[a] - self.upper[a];
            let gap = before.max(beyond).max(0.0);
            sum += gap * gap;
        }
        sum
    }
}

/// Side of a cell (units of the cube).
pub(super) fn side(level: u32) -> f64 {
    f64::from(1_u32 << (BITS - level))
}

/// The cell of a key (units of the cube).
#[inline(always)]
pub(super) fn cell(key: Key) -> Bounds {
    let side = side(level_of(key));
    let lower =
        [0, 1, 2].map(|axis| f64::from(gathered(key >> LEVEL_BITS >> axis) << (BITS - DEPTH)));
    Bounds {
        lower,
        upper: lower.map(|x| x + side),
    }
}

/// The cube.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cube {
    /// Lower corner (m).
    pub origin: [f64; 3],
    /// Unit of places (m), a power of two.
    pub unit: f64,
    /// Unit of masses (kg), a power of two.
    pub mass_unit: f64,
    /// Least distance from a cell that counts as one body, over the side of the larger cell.
    apart: f64,
}

/// What a rank tells of its particles.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facts {
    pub lower: [f64; 3],
    pub upper: [f64; 3],
    pub count: u64,
    most_mass: f64,
    /// The longest smoothing length (m).
    longest: f64,
}

impl Facts {
    const NONE: Self = Self {
        lower: [f64::INFINITY; 3],
        upper: [f64::NEG_INFINITY; 3],
        count: 0,
        most_mass: 0.0,
        longest: 0.0,
    };

    /// Of this rank's particles.
    fn of(points: &[Point]) -> Self {
        points
            .par_iter()
            .with_min_len(particles::GRAIN)
            .map(|point| Self {
                lower: point.position,
                upper: point.position,
                count: 1,
                most_mass: point.mass,
                longest: point.length,
            })
            // same bits in any order: counts, and largest and smallest numbers
            .reduce(|| Self::NONE, Self::join)
    }

    fn join(self, other: Self) -> Self {
        Self {
            lower: [0, 1, 2].map(|a| self.lower[a].min(other.lower[a])),
            upper: [0, 1, 2].map(|a| self.upper[a].max(other.upper[a])),
            count: self.count + other.count,
            most_mass: self.most_mass.max(other.most_mass),
            longest: self.longest.max(other.longest),
        }
    }

    fn words(&self) -> [u64; WORDS] {
        let [a, b, c] = self.lower.map(f64::to_bits);
        let [d, e, f] = self.upper.map(f64::to_bits);
        let [mass, longest] = [self.most_mass, self.longest].map(f64::to_bits);
        [a, b, c, d, e, f, self.count, mass, longest]
    }

    fn read(words: &[u64]) -> Self {
        let real = |k: usize| f64::from_bits(words[k]);
        Self {
            lower: [0, 1, 2].map(real),
            upper: [3, 4, 5].map(real),
            count: words[6],
            most_mass: real(7),
            longest: real(8),
        }
    }
}

/// A power of two above a number, and neither so small nor so large that its powers were.
fn above(x: f64) -> f64 {
    let x = x.clamp(1e-60, 1e60);
    f64::from_bits(((x.to_bits() >> 52) + 1) << 52)
}

impl Cube {
    /// Around the particles of all ranks; `told` receives what each rank tells of its `points`. Collective.
    pub fn around_all(
        comm: &Comm,
        points: &[Point],
        options: &SelfGravity,
        (words, told): (&mut Vec<u64>, &mut Vec<Facts>),
    ) -> Self {
        let mine = Facts::of(points);
        comm.all_gather_u64(&mine.words(), words);
        told.clear();
        told.extend(words.chunks_exact(WORDS).map(Facts::read));
        Self::new(told.iter().copied().fold(Facts::NONE, Facts::join), options)
    }

    fn new(all: Facts, options: &SelfGravity) -> Self {
        let apart = 1.0 / options.opening_angle - 0.5;
        let extent = (0..3).map(|a| all.upper[a] - all.lower[a]);
        let widest = extent.fold(2.0 * all.longest / apart, f64::max);
        #[allow(clippy::cast_precision_loss, reason = "a bound with room")]
        let mass = all.count as f64 * all.most_mass;
        Self {
            origin: all.lower,
            unit: above(widest) / side(0),
            // The sum of all is below 2⁶¹ units.
            mass_unit: above(mass) / side(0) / side(1),
            apart,
        }
    }

    /// A coordinate in units, in the cube.
    fn coordinate(&self, axis: usize, x: f64) -> u32 {
        let units = (x - self.origin[axis]) / self.unit;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped, and NaN is zero"
        )]
        let whole = units.clamp(0.0, side(0) - 1.0) as u32;
        whole
    }

    /// A place (m) in units.
    pub fn place(&self, position: &[f64; 3]) -> [u32; 3] {
        [0, 1, 2].map(|axis| self.coordinate(axis, position[axis]))
    }

    /// A mass (kg) in units.
    pub fn mass(&self, mass: f64) -> i128 {
        #[allow(clippy::cast_possible_truncation, reason = "below 2⁶¹")]
        let units = (mass / self.mass_unit) as i64;
        i128::from(units)
    }

    /// Level of the smallest cells whose distance from what counts as one body is beyond the support of a
    /// smoothing length (m).
    fn level(&self, length: f64) -> u32 {
        let ratio = side(0) * self.unit * self.apart / (2.0 * length);
        let exponent = (ratio.max(1.0).to_bits() >> 52) - 1023;
        #[allow(clippy::cast_possible_truncation, reason = "at most the depth")]
        let level = exponent.min(u64::from(DEPTH)) as u32;
        level
    }

    /// The cell that a particle at a place (m) with a smoothing length (m) lies in.
    pub fn key(&self, position: &[f64; 3], length: f64) -> Key {
        let level = self.level(length);
        let place = self.place(position).map(|x| spread(x >> (BITS - DEPTH)));
        let code = place[0] | place[1] << 1 | place[2] << 2;
        ancestor(code << LEVEL_BITS, level)
    }

    /// The box around the cells of a rank's particles (units), and their longest side.
    pub fn around(&self, facts: &Facts) -> (Bounds, f64) {
        let side = side(self.level(facts.longest));
        let whole = |x: u32| (f64::from(x) / side).floor() * side;
        (
            Bounds {
                lower: self.place(&facts.lower).map(whole),
                upper: self.place(&facts.upper).map(|x| whole(x) + side),
            },
            side,
        )
    }

    /// True if what lies in a cell of a `side` counts as one body for all in a box of cells of at most `others` (units):
    /// the distance of box and cell over the longer side tells, so that a cell in a cell that does so does.
    #[inline(always)]
    pub fn is_apart(&self, (cell, side): (&Bounds, f64), (target, other): (&Bounds, f64)) -> bool {
        let least = self.apart * side.max(other);
        cell.gap2(target) >= least * least
    }

    /// A coordinate (m) in units, which need not be whole nor in the cube.
    pub fn units(&self, axis: usize, x: f64) -> f64 {
        (x - self.origin[axis]) / self.unit
    }
}

/// Spreads the bits of a number so that two zeros lie between any two.
fn spread(x: u32) -> u64 {
    let mut x = u64::from(x) & 0x1f_ffff;
    for (shift, mask) in SPREADS {
        x = (x | x << shift) & mask;
    }
    x
}

/// The inverse of [`spread`].
fn gathered(x: u64) -> u32 {
    let mut x = x & SPREADS[4].1;
    for k in [3, 2, 1, 0] {
        x = (x | x >> SPREADS[k + 1].0) & SPREADS[k].1;
    }
    ((x | x >> SPREADS[0].0) & 0x1f_ffff) as u32
}

/// Shifts and masks that double the distance of bits.
const SPREADS: [(u32, u64); 5] = [
    (32, 0x001f_0000_0000_ffff),
    (16, 0x001f_0000_ff00_00ff),
    (8, 0x100f_00f0_0f00_f00f),
    (4, 0x10c3_0c30_c30c_30c3),
    (2, 0x1249_2492_4924_9249),
];

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Cube {
        let all = Facts {
            lower: [-3.0, 2.0, 0.0],
            upper: [5.0, 4.0, 1.0],
            count: 9,
            most_mass: 2.0,
            longest: 0.1,
        };
        let options = SelfGravity {
            constant: 1.0,
            opening_angle: 0.5,
        };
        Cube::new(all, &options)
    }

    #[test]
    fn keys_tell_cells_that_hold_their_particles() {
        let cube = cube();
        for (length, level) in [(0.1, 6), (1e-9, DEPTH), (20.0, 0)] {
            for position in [[-3.0, 2.0, 0.0], [5.0, 4.0, 1.0], [0.3, 3.7, 0.9]] {
                let key = cube.key(&position, length);
                assert_eq!(level_of(key), level);
                let Bounds { lower, upper } = cell(key);
                let place = cube.place(&position).map(f64::from);
                assert!((0..3).all(|a| lower[a] <= place[a] && place[a] < upper[a]));
                assert_eq!(upper[1] - lower[1], side(level));
                let parent = ancestor(key, level / 2);
                assert_eq!(common_level(parent, key), level / 2);
                assert_eq!(cell(parent).gap2(&cell(key)), 0.0);
            }
        }
        let keys = [[0.0, 3.0, 0.0], [0.0, 3.0, 0.9]].map(|x| cube.key(&x, 0.1));
        let level = common_level(keys[0], keys[1]);
        assert_eq!(ancestor(keys[0], level), ancestor(keys[1], level));
        assert_ne!(eighth(keys[0], level), eighth(keys[1], level));
    }

    #[test]
    fn a_cell_that_counts_as_one_body_is_beyond_the_support() {
        let cube = cube();
        for length in [0.1, 0.03, 0.0071] {
            let side = side(cube.level(length)) * cube.unit;
            assert!(side * cube.apart >= 2.0 * length);
            assert!(side * cube.apart < 4.0 * length);
        }
    }
}
