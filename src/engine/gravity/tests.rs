//! The tree against the sum over all pairs, and on any ranks.

use proptest::prelude::*;

use super::pull::Pull;
use super::tree::Point;
use super::trees::Trees;
use comm::{Comm, Machine, virtual_ranks};
use model::{Axis, SelfGravity, SymmetryPlane};
use particles::Mirrors;

/// Numbers from zero to one by a seed.
struct Random(u64);

impl Random {
    #[allow(clippy::cast_precision_loss)]
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn in_ball(&mut self, radius: f64) -> [f64; 3] {
        loop {
            let x = [0; 3].map(|_| 2.0 * self.next() - 1.0);
            if x[0] * x[0] + x[1] * x[1] + x[2] * x[2] <= 1.0 {
                return x.map(|x| radius * x);
            }
        }
    }
}

/// Lumps of particles of several sizes.
fn cloud(seed: u64, lumps: usize, count: usize) -> Vec<Point> {
    let mut random = Random(seed);
    let mut points = Vec::new();
    for lump in 0..lumps {
        let (centre, radius) = (random.in_ball(10.0), 0.3 + 3.0 * random.next());
        let share = count / lumps;
        #[allow(clippy::cast_precision_loss)]
        let spacing = radius * (4.2 / share as f64).cbrt();
        for _ in 0..share {
            let x = random.in_ball(radius);
            points.push(Point {
                key: 0,
                id: points.len() as u64,
                position: [0, 1, 2].map(|a| centre[a] + x[a]),
                mass: (0.5 + random.next()) * [1.0, 1e-3, 40.0][lump % 3],
                length: 1.3 * spacing,
                index: points.len() as u64,
            });
        }
    }
    points
}

/// Forces of all pairs.
fn direct(points: &[Point], mirrors: &Mirrors) -> Vec<Pull> {
    let one = |target: &Point| {
        let mut sum = [0.0; 4];
        for source in points {
            for mask in mirrors.masks() {
                if mask.is_own() && source.id == target.id {
                    continue;
                }
                let x = mirrors.reflect_position(&source.position, mask);
                let d = [0, 1, 2].map(|a| x[a] - target.position[a]);
                let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
                let [slope, depth] = pair(r, 0.5 * (source.length + target.length));
                for a in 0..3 {
                    sum[a] += source.mass * slope * d[a];
                }
                sum[3] += source.mass * depth;
            }
        }
        sum
    };
    points.iter().map(one).collect()
}

fn pair(r: f64, length: f64) -> [f64; 2] {
    if r < 2.0 * length {
        super::pull::softened(r, length)
    } else {
        [1.0 / (r * r * r), -1.0 / r]
    }
}

fn by_tree(comm: &Comm, points: &[Point], angle: f64, mirrors: &Mirrors) -> Vec<(u64, Pull)> {
    let options = SelfGravity {
        constant: 1.0,
        opening_angle: angle,
    };
    let mut trees = Trees::default();
    let found = std::sync::Mutex::new(Vec::new());
    // Twice, as memory is kept.
    for _ in 0..2 {
        found.lock().unwrap().clear();
        trees.points().clear();
        trees.points().extend_from_slice(points);
        let cube = trees.grow(comm, &options, mirrors);
        trees.pull(&cube, mirrors, |point, [own, image]| {
            let all = [0, 1, 2, 3].map(|a| own[a] + image[a]);
            found.lock().unwrap().push((point.id, all));
        });
    }
    let mut found = found.into_inner().unwrap();
    found.sort_by_key(|(id, _)| *id);
    found
}

fn square(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

/// Root mean square and largest error of the acceleration, over its root mean square, and the largest of
/// the potential over it.
fn errors(points: &[Point], found: &[(u64, Pull)], mirrors: &Mirrors) -> [f64; 3] {
    let exact = direct(points, mirrors);
    let (mut all, mut sum, mut most, mut depth) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for (exact, (_, found)) in exact.iter().zip(found) {
        let error = [0, 1, 2].map(|a| found[a] - exact[a]);
        all += square(&exact[..3]);
        sum += square(&error);
        most = most.max(square(&error));
        depth = depth.max((found[3] / exact[3] - 1.0).abs());
    }
    #[allow(clippy::cast_precision_loss)]
    let mean = all / points.len() as f64;
    [(sum / all).sqrt(), (most / mean).sqrt(), depth]
}

fn planes() -> Mirrors {
    let plane = |axis, position| SymmetryPlane { axis, position };
    Mirrors::new(&[plane(Axis::X, -10.7), plane(Axis::Z, -13.1)])
}

/// Errors of the acceleration over its mean in a ball, as the book states them for 20,000 particles.
#[test]
fn errors_follow_the_opening_angle() {
    let points = cloud(1, 1, 4_000);
    let none = Mirrors::default();
    for (angle, rms, most) in [
        (0.3, 1e-4, 5e-4),
        (0.5, 5e-4, 2e-3),
        (0.7, 2e-3, 1e-2),
        (1.0, 1e-2, 5e-2),
    ] {
        let found = by_tree(&Comm::solo(), &points, angle, &none);
        let errors = errors(&points, &found, &none);
        assert!(errors[0] < rms && errors[1] < most, "{angle}: {errors:?}");
    }
}

#[test]
fn two_particles_attract_each_other_alike() {
    let point = |id, x: f64, mass| Point {
        key: 0,
        id,
        position: [x, 0.3, -0.1 * x],
        mass,
        length: 0.2 * mass,
        index: id,
    };
    // Afar each is a body in a place of whole units of the cube.
    for (apart, most) in [(1e-3, 4e-15), (0.3, 4e-15), (0.7, 4e-15), (1e6, 1e-8)] {
        let points = [point(0, -apart, 1.0), point(1, apart, 3.0)];
        let none = Mirrors::default();
        let found = by_tree(&Comm::solo(), &points, 0.5, &none);
        let exact = direct(&points, &none);
        for ((_, found), exact) in found.iter().zip(&exact) {
            for a in 0..4 {
                assert!(
                    (found[a] - exact[a]).abs() <= most * exact[a].abs().max(exact[0].abs()),
                    "{apart}: {a}"
                );
            }
        }
        let sum = found[0].1[0] + 3.0 * found[1].1[0];
        assert!(sum.abs() <= most * found[0].1[0].abs(), "{sum:e}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// At the default angle a tree errs by less than a thousandth.
    #[test]
    fn a_tree_agrees_with_all_pairs(seed in 0_u64.., lumps in 1_usize..9, mirrored: bool) {
        let points = cloud(seed, lumps, 900);
        let mirrors = if mirrored { planes() } else { Mirrors::default() };
        let found = by_tree(&Comm::solo(), &points, 0.5, &mirrors);
        let [rms, most, depth] = errors(&points, &found, &mirrors);
        prop_assert!(rms < 1e-3 && most < 1e-2 && depth < 1e-3, "{rms:e} {most:e} {depth:e}");
    }

    /// However ranks share particles, the bits are those of one rank.
    #[test]
    fn ranks_change_no_bit(seed in 0_u64.., lumps in 1_usize..6, ranks in 2_usize..6, by_place: bool, mirrored: bool) {
        let points = cloud(seed, lumps, 700);
        let mirrors = if mirrored { planes() } else { Mirrors::default() };
        let wanted = by_tree(&Comm::solo(), &points, 0.6, &mirrors);
        let shares = virtual_ranks(ranks, Machine::IDEAL, |comm| {
            let owner = |point: &Point| {
                let place = (point.position[0] + 15.0) * 0.2;
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let place = place.max(0.0) as usize;
                let chance = usize::try_from(point.id).unwrap() / 7;
                [chance, place][usize::from(by_place)] % ranks
            };
            let own: Vec<Point> = points.iter().copied().filter(|p| owner(p) == comm.rank()).collect();
            by_tree(comm, &own, 0.6, &mirrors)
        });
        let mut found: Vec<_> = shares.into_iter().flatten().collect();
        found.sort_by_key(|(id, _)| *id);
        let bits = |all: &[(u64, Pull)]| -> Vec<(u64, [u64; 4])> {
            all.iter().map(|(id, pull)| (*id, pull.map(f64::to_bits))).collect()
        };
        prop_assert_eq!(bits(&wanted), bits(&found));
    }
}
