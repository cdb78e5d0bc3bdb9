//! Fragments of made-up clouds whose answer is known.

#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "small numbers"
)]

use engine::fragments::{Census, Matter, Rule, find_alone};
use model::{Axis, FragmentOptions, SymmetryPlane};
use particles::connected::components;

/// Particles in cubes of a spacing.
#[derive(Default)]
struct Cloud {
    position: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    size: Vec<f64>,
    body: Vec<u32>,
    failed: Vec<usize>,
    deformation: Vec<[f64; 9]>,
}

const DENSITY: f64 = 8000.0;

impl Cloud {
    /// Adds a block of `n` cubes, whose lowest corner is there.
    fn block(&mut self, corner: [f64; 3], n: [usize; 3], spacing: f64) -> &mut Self {
        for k in 0..n[0] * n[1] * n[2] {
            let at = [k % n[0], k / n[0] % n[1], k / (n[0] * n[1])];
            self.add(
                [0, 1, 2].map(|a| corner[a] + (at[a] as f64 + 0.5) * spacing),
                spacing,
            );
        }
        self
    }

    fn add(&mut self, position: [f64; 3], size: f64) {
        self.position.push(position);
        self.velocity.push([0.0; 3]);
        self.size.push(size);
        self.body.push(0);
    }

    fn census(&self, planes: &[SymmetryPlane], options: &FragmentOptions) -> Census {
        let n = self.position.len();
        let ids: Vec<u64> = (0..n as u64).map(|i| 3 * i + 5).collect();
        let mass: Vec<f64> = self.size.iter().map(|s| DENSITY * s * s * s).collect();
        let mut included = vec![true; n];
        self.failed.iter().for_each(|&i| included[i] = false);
        let matter = Matter {
            owned: n,
            bodies: 2,
            ids: &ids,
            body: &self.body,
            position: &self.position,
            size: &self.size,
            deformation: &self.deformation,
            included: &included,
            mass: &mass,
            velocity: &self.velocity,
            temperature: &vec![300.0; n],
            plastic_strain: &vec![0.25; n],
        };
        find_alone(&matter, planes, &Rule::new(options, 3))
    }
}

fn usual() -> FragmentOptions {
    FragmentOptions::default()
}

fn close(a: f64, b: f64, bound: f64) {
    assert!((a - b).abs() <= bound * a.abs().max(b.abs()), "{a} and {b}");
}

/// Numbers in [0, 1) without an order.
fn draws() -> impl FnMut() -> f64 {
    let mut state = 11_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A block of a body that has not torn is one fragment however far it is stretched, also with its image behind a plane; what is
/// farther than its deformation says is another one. By distance alone each layer is one.
#[test]
fn what_is_stretched_hangs_together_by_its_deformation_gradient() {
    let mut cloud = Cloud::default();
    cloud.block([0.0; 3], [6, 4, 4], 1.0);
    cloud.block([6.8, 0.0, 0.0], [3, 4, 4], 1.0);
    let stretches = [2.5, 0.7, 0.6];
    for x in &mut cloud.position {
        *x = [0, 1, 2].map(|a| stretches[a] * x[a]);
    }
    let planes = [SymmetryPlane {
        axis: Axis::X,
        position: 0.0,
    }];
    assert_eq!(cloud.census(&planes, &usual()).fragments.len(), 9);
    let gradient = [2.5, 0.0, 0.0, 0.0, 0.7, 0.0, 0.0, 0.0, 0.6];
    cloud.deformation = vec![gradient; cloud.position.len()];
    let found = cloud.census(&planes, &usual()).fragments;
    let counts: Vec<_> = found.iter().map(|f| (f.particles, f.copies)).collect();
    assert_eq!(counts, [(2 * 96, 1), (48, 2)]);
}

#[test]
fn a_single_particle_joins_no_blocks_unless_asked_to() {
    let mut cloud = Cloud::default();
    cloud.block([0.0; 3], [5, 5, 5], 1.0);
    cloud.add([5.5, 2.4, 2.5], 1.0);
    cloud.block([6.0, 0.0, 0.0], [5, 5, 4], 1.0);
    let apart = cloud.census(&[], &usual());
    let counts: Vec<_> = apart.fragments.iter().map(|f| f.particles).collect();
    // The bridge goes with the block that it is nearest to; of equals with the smaller id.
    assert_eq!(counts, [126, 100]);
    assert_eq!(apart.fragments[0].label, 5);
    assert_eq!(apart.labels[125], 5);
    let joined = cloud.census(
        &[],
        &FragmentOptions {
            bridges: true,
            ..usual()
        },
    );
    assert_eq!(joined.fragments.len(), 1);
    assert_eq!(joined.fragments[0].particles, 226);
    // Two particles side by side are no bridge of one.
    cloud.add([5.5, 3.4, 2.5], 1.0);
    assert_eq!(cloud.census(&[], &usual()).fragments.len(), 1);
}

#[test]
fn what_failed_parts_what_is_intact() {
    let mut cloud = Cloud::default();
    cloud.block([0.0; 3], [12, 4, 4], 0.5);
    let failed = |i: &usize| [5, 6].contains(&(i % 12));
    cloud.failed = (0..cloud.position.len()).filter(failed).collect();
    let census = cloud.census(&[], &usual());
    let counts: Vec<_> = census.fragments.iter().map(|f| f.particles).collect();
    assert_eq!(counts, [80, 80]);
    assert_eq!(census.excluded.particles, 32);
    assert_eq!(census.labels[5], u64::MAX);
    let [total, fragments, failed] = [census.total, census.in_fragments, census.excluded];
    assert_eq!(
        total.mass.to_bits(),
        (192.0 * DENSITY * 0.125_f64).to_bits()
    );
    close(total.mass, fragments.mass + failed.mass, 1e-15);
}

#[test]
fn dust_is_what_has_too_few_particles_and_bodies_may_stay_apart() {
    let mut cloud = Cloud::default();
    cloud
        .block([0.0; 3], [4, 4, 4], 1.0)
        .block([4.0, 0.0, 0.0], [4, 4, 4], 1.0);
    cloud.body[64..].fill(1);
    cloud.block([20.0, 0.0, 0.0], [7, 1, 1], 1.0);
    let census = cloud.census(&[], &usual());
    assert_eq!((census.count(), census.dust.particles), (1, 7));
    let masses = &census.fragments[0].mass_of;
    assert_eq!(masses, &[64.0 * DENSITY, 64.0 * DENSITY]);
    let apart = FragmentOptions {
        across_bodies: false,
        ..usual()
    };
    assert_eq!(cloud.census(&[], &apart).count(), 2);
}

/// An ellipsoid of 20 × 14 × 10 spacings that turns and flies, turned itself.
#[test]
fn a_spinning_ellipsoid_has_its_sizes_and_its_spin() {
    let (axes, spacing): ([f64; 3], f64) = ([0.010, 0.007, 0.005], 0.001);
    let turn = model::rotation(&[1.0, 2.0, 0.5].into(), 0.7);
    let (centre, flight, spin) = ([0.3, -0.2, 0.1], [5000.0, -300.0, 40.0], [2e3, -7e3, 4e3]);
    let mut cloud = Cloud::default();
    for k in 0..24_usize.pow(3) {
        let at = [k % 24, k / 24 % 24, k / 576].map(|i| (i as f64 - 11.5) * spacing);
        if (0..3).map(|a| (at[a] / axes[a]).powi(2)).sum::<f64>() >= 1.0 {
            continue;
        }
        let r = turn * model::Vec3::from(at);
        let v = model::Vec3::from(spin).cross(&r);
        cloud.add([0, 1, 2].map(|a| centre[a] + r[a]), spacing);
        *cloud.velocity.last_mut().unwrap() = [0, 1, 2].map(|a| flight[a] + v[a]);
    }
    let census = cloud.census(&[], &usual());
    let [fragment] = &census.fragments[..] else {
        panic!("{} fragments", census.fragments.len())
    };
    for a in 0..3 {
        // Lattice cells at the face are in or out: a hundredth; sums of 500 m/s at 0.3 m over
        // 10 m/s at 1 cm keep ten digits.
        close(fragment.sizes[a], 2.0 * axes[a], 0.015);
        close(fragment.spin[a], spin[a], 1e-8);
        close(fragment.velocity[a], flight[a], 1e-12);
        assert!((fragment.centre[a] - centre[a]).abs() < 1e-12);
    }
    close(fragment.temperature, 300.0, 1e-14);
    close(fragment.plastic_strain, 0.25, 1e-14);
    let sphere = 2.0 * (axes[0] * axes[1] * axes[2]).cbrt();
    close(fragment.diameter(), sphere, 0.01);
}

/// A quarter model reports the whole: fragments on both planes, on one and on none.
#[test]
fn a_quarter_reports_the_whole() {
    let plane = |axis, position| SymmetryPlane { axis, position };
    let planes = [plane(Axis::X, 0.3), plane(Axis::Y, -0.1)];
    let mut draw = draws();
    let mut quarter = Cloud::default();
    // On both planes, on x, on y, on none, and one that comes near a plane without reaching it.
    quarter.block([0.3, -0.1, 0.0], [4, 3, 5], 0.01);
    quarter.block([0.3, 0.1, 0.0], [4, 4, 4], 0.01);
    quarter.block([0.4, -0.1, 0.2], [3, 5, 4], 0.01);
    quarter.block([0.5, 0.3, 0.2], [6, 4, 4], 0.01);
    quarter.block([0.316, 0.5, 0.2], [4, 4, 4], 0.01);
    for (x, v) in quarter.position.iter_mut().zip(&mut quarter.velocity) {
        *v = [0, 1, 2].map(|a| 1000.0 * x[a] + 50.0 * draw());
        for x in x {
            *x += 1e-3 * (draw() - 0.5);
        }
    }
    let mut whole = Cloud::default();
    for [x, y] in [[false, false], [true, false], [false, true], [true, true]] {
        for (position, velocity) in quarter.position.iter().zip(&quarter.velocity) {
            let (mut position, mut velocity) = (*position, *velocity);
            for (a, plane, is) in [(0, 0.3, x), (1, -0.1, y)] {
                if is {
                    position[a] = 2.0 * plane - position[a];
                    velocity[a] = -velocity[a];
                }
            }
            whole.add(position, 0.01);
            *whole.velocity.last_mut().unwrap() = velocity;
        }
    }
    let [part, whole] = [
        quarter.census(&planes, &usual()),
        whole.census(&[], &usual()),
    ];
    assert_eq!((part.count(), whole.count()), (1 + 2 + 2 + 4 + 4, 13));
    close(part.total.mass, whole.total.mass, 1e-14);
    for fragment in &part.fragments {
        let equal: Vec<_> = whole
            .fragments
            .iter()
            .filter(|f| f.particles == fragment.particles)
            .filter(|f| (f.sizes[0] / fragment.sizes[0] - 1.0).abs() < 1e-6)
            .collect();
        assert_eq!(equal.len() as u64, fragment.copies);
        let same = |f: &&&engine::fragments::Fragment| {
            (0..3).all(|a| (f.centre[a] - fragment.centre[a]).abs() < 1e-9)
        };
        let one = equal.iter().find(same).expect("it stands where it stood");
        close(one.mass, fragment.mass, 1e-13);
        for a in 0..3 {
            close(one.sizes[a], fragment.sizes[a], 1e-8);
            assert!((one.velocity[a] - fragment.velocity[a]).abs() < 1e-9);
            assert!((one.spin[a] - fragment.spin[a]).abs() < 1e-5 * 1000.0);
        }
    }
}

/// Particles of sizes that differ by thirty, against all pairs.
#[test]
fn links_are_those_of_all_pairs_whatever_the_sizes() {
    let mut draw = draws();
    for density in [2.0, 4.0, 7.0] {
        let mut cloud = Cloud::default();
        for _ in 0..1500 {
            let size = 0.03_f64 * 30_f64.powf(draw().powi(3));
            cloud.add([0, 1, 2].map(|_| density * (draw() - 0.5)), size);
        }
        let n = cloud.position.len();
        let options = FragmentOptions {
            bridges: true,
            min_particles: 1,
            ..usual()
        };
        let mut label: Vec<usize> = (0..n).collect();
        loop {
            let before = label.clone();
            for i in 0..n {
                for j in 0..n {
                    let r: f64 = (0..3)
                        .map(|a| (cloud.position[i][a] - cloud.position[j][a]).powi(2))
                        .sum();
                    let range = 0.75 * (cloud.size[i] + cloud.size[j]);
                    if r < range * range {
                        label[i] = label[i].min(label[j]);
                    }
                }
            }
            if label == before {
                break;
            }
        }
        let census = cloud.census(&[], &options);
        let found = census.labels.iter().map(|label| (*label as usize - 5) / 3);
        assert!(found.eq(label.iter().copied()), "at {density}");
        assert_eq!(census.dust.particles, 0);
    }
}

#[test]
fn bridges_are_those_of_all_pairs_in_a_thin_cloud() {
    let mut draw = draws();
    let mut cloud = Cloud::default();
    for _ in 0..1200 {
        cloud.add([0, 1, 2].map(|_| 13.0 * draw()), 1.0);
    }
    let n = cloud.position.len();
    let distance = |i: usize, j: usize| -> f64 {
        let r = (0..3).map(|a| (cloud.position[i][a] - cloud.position[j][a]).powi(2));
        r.sum()
    };
    let linked = |i: usize, j: usize| i != j && distance(i, j) < 2.25;
    let near = |i: usize| (0..n).filter(move |&j| linked(i, j)).collect::<Vec<_>>();
    let bridge = |i: usize| {
        let near = near(i);
        let points: Vec<_> = near.iter().map(|&j| cloud.position[j]).collect();
        points.len() > 1 && components(&points, 1.5).len() > 1
    };
    let bridges: Vec<bool> = (0..n).map(bridge).collect();
    assert!(bridges.iter().filter(|is| **is).count() > 100);
    let mut label: Vec<usize> = (0..n).collect();
    let host = |i: usize| {
        let firm = near(i).into_iter().filter(|&j| !bridges[j]);
        firm.min_by(|&a, &b| distance(i, a).total_cmp(&distance(i, b)))
    };
    loop {
        let before = label.clone();
        for i in 0..n {
            let with = if bridges[i] {
                host(i).into_iter().collect()
            } else {
                near(i)
                    .into_iter()
                    .filter(|&j| !bridges[j])
                    .collect::<Vec<_>>()
            };
            for j in with {
                let least = label[i].min(label[j]);
                (label[i], label[j]) = (least, least);
            }
        }
        if label == before {
            break;
        }
    }
    let options = FragmentOptions {
        min_particles: 1,
        ..usual()
    };
    let census = cloud.census(&[], &options);
    let found = census.labels.iter().map(|label| (*label as usize - 5) / 3);
    assert!(found.eq(label.iter().copied()));
}
