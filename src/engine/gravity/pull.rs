//! What a tree exerts on the particles of a cell: cells afar as quadrupoles, particles near by one by one.

use super::cube::{Bounds, Cube};
use super::moments::Pole;
use super::tree::{Point, Tree};
use numerics::dispatch::{Vectorised, instructions};
use numerics::lanes::{F64x8, LANES, Lanes};

/// Eights of targets that a walk serves.
const EIGHTS: usize = 8;
/// Cells of a kind that act together.
const FOUND: usize = 128;
/// Targets that a walk serves at most.
pub(super) const TARGETS: usize = EIGHTS * LANES;

/// Acceleration (m/s²) and potential (J/kg) over the gravitational constant.
pub(super) type Pull = [f64; 4];

/// Depth of the potential of a particle in its middle, in its mass over its smoothing length.
const DEEPEST: f64 = 1.4;

/// Gravity of a particle with the mass distribution of the kernel: acceleration over the distance, and potential,
/// of unit mass at a distance (m) within the support of a smoothing length (m). Price & Monaghan (2007), MNRAS 374, 1347,
/// appendix A.
pub(super) fn softened(distance: f64, length: f64) -> [f64; 2] {
    let inverse = 1.0 / length;
    let q = distance * inverse;
    let (slope, depth) = if q < 1.0 {
        let q2 = q * q;
        (
            4.0 / 3.0 + q2 * (0.5 * q - 1.2),
            DEEPEST + q2 * (q2 * (0.3 - 0.1 * q) - 2.0 / 3.0),
        )
    } else {
        let q2 = q * q;
        let q3 = q2 * q;
        (
            8.0 / 3.0 - 3.0 * q + 1.2 * q2 - q3 / 6.0 - 1.0 / (15.0 * q3),
            1.6 + q2 * (q - 4.0 / 3.0 - 0.3 * q2 + q3 / 30.0) - 1.0 / (15.0 * q),
        )
    };
    [slope * inverse * inverse * inverse, -depth * inverse]
}

/// Targets in eights, and what they have received.
struct Targets {
    count: usize,
    position: [[F64x8; 3]; EIGHTS],
    length: [F64x8; EIGHTS],
    pull: [[F64x8; 4]; EIGHTS],
}

impl Targets {
    fn new(points: &[Point], image: impl Fn(&[f64; 3]) -> [f64; 3]) -> Self {
        let zero = F64x8([0.0; LANES]);
        let mut targets = Self {
            count: points.len().div_ceil(LANES),
            position: [[zero; 3]; EIGHTS],
            length: [zero; EIGHTS],
            pull: [[zero; 4]; EIGHTS],
        };
        for (n, eight) in points.chunks(LANES).enumerate() {
            for lane in 0..LANES {
                // Lanes without a target repeat the first.
                let point = eight.get(lane).unwrap_or(&eight[0]);
                let position = image(&point.position);
                for a in 0..3 {
                    targets.position[n][a].0[lane] = position[a];
                }
                targets.length[n].0[lane] = point.length;
            }
        }
        targets
    }

    /// Adds what a particle exerts.
    #[inline(always)]
    fn add_point<V: Lanes>(&mut self, point: &Point) {
        let source = splat(&point.position);
        let mass = V::splat(point.mass);
        for n in 0..self.count {
            let (d, r2) = apart::<V>(&source, &self.position[n]);
            let reach = V::load(&self.length[n]).add(V::splat(point.length));
            let near = r2.less_than(reach.mul(reach));
            let inverse = V::splat(1.0).div(r2.sqrt());
            let mut slope = inverse.mul(inverse).mul(inverse);
            let mut depth = V::splat(-1.0).mul(inverse);
            if near != 0 {
                let (mut slopes, mut depths) = (slope.store(), depth.store());
                let (r2, reach) = (r2.store(), reach.store());
                for lane in 0..LANES {
                    if near >> lane & 1 != 0 {
                        // Of the mean of both lengths, so that both attract each other alike.
                        let [s, p] = softened(r2.0[lane].sqrt(), 0.5 * reach.0[lane]);
                        (slopes.0[lane], depths.0[lane]) = (s, p);
                    }
                }
                (slope, depth) = (V::load(&slopes), V::load(&depths));
            }
            let slope = slope.mul(mass);
            let pull = &mut self.pull[n];
            for a in 0..3 {
                pull[a] = d[a].mul_add(slope, V::load(&pull[a])).store();
            }
            pull[3] = depth.mul_add(mass, V::load(&pull[3])).store();
        }
    }

    /// Adds what a cell exerts as one body: `a = M d/r³ − 3 S d/r⁵ + (15/2 d·S d/r² − 3/2 tr S) d/r⁵` and
    /// `φ = −M/r − 3/2 d·S d/r⁵ + 1/2 tr S/r³`, with `d` from the target to the centre of mass.
    #[inline(always)]
    fn add_pole<V: Lanes>(&mut self, pole: &Pole) {
        let source = splat(&pole.centre);
        let mass = V::splat(pole.mass);
        let [xx, yy, zz, xy, xz, yz] = splat(&pole.second);
        let trace = pole.second[0] + pole.second[1] + pole.second[2];
        let (half, rest) = (V::splat(0.5 * trace), V::splat(1.5 * trace));
        for n in 0..self.count {
            let (d, r2) = apart::<V>(&source, &self.position[n]);
            let inverse = V::splat(1.0).div(r2.sqrt());
            let square = inverse.mul(inverse);
            let cube = square.mul(inverse);
            let fifth = cube.mul(square);
            let s = [
                dot([xx, xy, xz], &d),
                dot([xy, yy, yz], &d),
                dot([xz, yz, zz], &d),
            ];
            let quadratic = dot(s, &d);
            let bend = V::splat(7.5).mul(quadratic).mul(square).sub(rest);
            let along = mass.mul(cube).add(bend.mul(fifth));
            let turn = V::splat(3.0).mul(fifth);
            let pull = &mut self.pull[n];
            for a in 0..3 {
                let part = along.mul(d[a]).sub(turn.mul(s[a]));
                pull[a] = V::load(&pull[a]).add(part).store();
            }
            let depth = mass
                .mul(inverse)
                .add(V::splat(1.5).mul(quadratic).mul(fifth))
                .sub(half.mul(cube));
            pull[3] = V::load(&pull[3]).sub(depth).store();
        }
    }
}

/// Each number in all lanes.
#[inline(always)]
fn splat<V: Lanes, const N: usize>(values: &[f64; N]) -> [V; N] {
    let mut all = [V::splat(0.0); N];
    for k in 0..N {
        all[k] = V::splat(values[k]);
    }
    all
}

#[inline(always)]
fn dot<V: Lanes>(a: [V; 3], b: &[V; 3]) -> V {
    a[0].mul(b[0]).add(a[1].mul(b[1])).add(a[2].mul(b[2]))
}

/// From targets to a source (m), and the square of the distance (m²).
#[inline(always)]
fn apart<V: Lanes>(source: &[V; 3], target: &[F64x8; 3]) -> ([V; 3], V) {
    let mut d = *source;
    for a in 0..3 {
        d[a] = source[a].sub(V::load(&target[a]));
    }
    let r2 = d[0].mul_add(d[0], d[1].mul_add(d[1], d[2].mul(d[2])));
    (d, r2)
}

/// The pull of a tree on the images of up to [`TARGETS`] particles of a cell.
pub(super) struct OnCell<'a, F> {
    pub cube: &'a Cube,
    pub tree: &'a Tree,
    /// The particles.
    pub points: &'a [Point],
    /// The image of their cell, and its side (units of the cube).
    pub bounds: Bounds,
    pub side: f64,
    /// The image of a place (m).
    pub image: F,
    /// True if they are no images, but the particles themselves.
    pub is_own: bool,
    /// Receives what acts on the images.
    pub pulls: &'a mut [Pull],
}

/// Cells that a walk has found, up to a number.
struct Found {
    cells: [u32; FOUND],
    count: usize,
}

impl Found {
    const NONE: Self = Self {
        cells: [0; FOUND],
        count: 0,
    };

    /// True if it is full with this cell.
    fn add(&mut self, cell: u32) -> bool {
        self.cells[self.count] = cell;
        self.count += 1;
        self.count == FOUND
    }
}

/// Cells that act on targets: as one body, or by the particles that lie in them.
struct Acting<'a> {
    tree: &'a Tree,
    targets: &'a mut Targets,
    found: &'a mut Found,
    as_one: bool,
}

impl Vectorised for Acting<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for &at in &self.found.cells[..self.found.count] {
            let at = at as usize;
            if self.as_one {
                self.targets.add_pole::<V>(&self.tree.poles[at]);
            } else {
                let [first, end] = self.tree.cells[at].points;
                for point in &self.tree.points[first as usize..end as usize] {
                    self.targets.add_point::<V>(point);
                }
            }
        }
        self.found.count = 0;
    }
}

impl<F: Fn(&[f64; 3]) -> [f64; 3]> OnCell<'_, F> {
    /// Walks the tree, and lets what it finds act, some cells at a time.
    pub fn run(self) {
        let Self { tree, points, .. } = self;
        let mut targets = Targets::new(points, &self.image);
        let target = (&self.bounds, self.side);
        let mut found = [Found::NONE, Found::NONE];
        let mut act = |found: &mut Found, as_one: bool| {
            instructions().run(Acting {
                tree,
                targets: &mut targets,
                found,
                as_one,
            });
        };
        tree.walk(
            |bounds, side| self.cube.is_apart((bounds, side), target),
            |at, as_one| {
                let [first, end] = tree.cells[at].points;
                if !as_one && first == end {
                    return;
                }
                let of_kind = &mut found[usize::from(as_one)];
                #[allow(clippy::cast_possible_truncation)] // cells are counted by u32
                if of_kind.add(at as u32) {
                    act(of_kind, as_one);
                }
            },
        );
        for (of_kind, as_one) in found.iter_mut().zip([false, true]) {
            act(of_kind, as_one);
        }
        for (k, (pull, point)) in self.pulls.iter_mut().zip(points).enumerate() {
            let received = &targets.pull[k / LANES];
            for a in 0..4 {
                pull[a] = received[a].0[k % LANES];
            }
            if self.is_own {
                // Nothing attracts itself.
                pull[3] += DEEPEST * point.mass / point.length;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pull_of_a_particle_is_that_of_its_kernel() {
        let kernel = numerics::kernel::Kernel::new(3);
        let length = 0.7;
        let steps = 20_000;
        let width = 2.0 * length / f64::from(steps);
        let mut mass = 0.0;
        for k in 0..steps {
            let r = (f64::from(k) + 0.5) * width;
            mass += 4.0 * std::f64::consts::PI * r * r * kernel.value(r, length) * width;
            let end = r + 0.5 * width;
            let [slope, depth] = softened(end, length);
            assert!((slope * end * end * end - mass).abs() < 1e-7, "{end}");
            let [_, before] = softened(end - width, length);
            assert!(((depth - before) / width - slope * (end - 0.5 * width)).abs() < 1e-4);
        }
        let [slope, depth] = softened(2.0 * length, length);
        assert!((slope * 8.0 * length.powi(3) - 1.0).abs() < 1e-12);
        assert!((depth * 2.0 * length + 1.0).abs() < 1e-12);
    }
}
