//! Defects that are mended, and others.

use super::*;
use crate::Mesh;

type Triangle = [[f64; 3]; 3];
type Triangles = Vec<Triangle>;

/// A torus about z with a tube of a third of its radius, of 2 `n` by `n` quads.
fn torus(n: u32, radius: f64) -> Triangles {
    let corner = |i: u32, j: u32| {
        let turn = |k: u32, of: u32| std::f64::consts::TAU * f64::from(k % of) / f64::from(of);
        let (u, v) = (turn(i, 2 * n), turn(j, n));
        let r = radius * (1.0 + libm::cos(v) / 3.0);
        [
            r * libm::cos(u),
            r * libm::sin(u),
            radius * libm::sin(v) / 3.0,
        ]
    };
    let quads = (0..2 * n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let triangles = quads.flat_map(|(i, j)| {
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
        [[a, b, c], [a, c, d]]
    });
    triangles.collect()
}

/// A box between two corners.
fn cuboid(lower: [f64; 3], upper: [f64; 3]) -> Triangles {
    let x = |n: usize| std::array::from_fn(|a| if n >> a & 1 == 1 { upper[a] } else { lower[a] });
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    triangles.map(|t| t.map(x)).collect()
}

fn whole(triangles: &[Triangle]) -> f64 {
    Mesh::new(triangles).expect("closed").volume()
}

#[test]
fn corners_a_hair_apart_are_joined() {
    let mut torn = torus(24, 1.0);
    let volume = whole(&torn);
    // As six digits leave them: each triangle by itself.
    for (n, t) in torn.iter_mut().enumerate() {
        for x in t.iter_mut().flatten() {
            #[allow(clippy::cast_precision_loss)] // few triangles
            let noise = libm::sin(n as f64 * 12.9 + *x * 78.2);
            *x += 2e-7 * noise;
        }
    }
    assert!(Mesh::new(&torn).is_err());
    let mesh = Mesh::mend(&torn, 0.01).unwrap();
    assert!((mesh.volume() / volume - 1.0).abs() < 2e-6);
    let words = mesh.mended().words().unwrap();
    assert!(
        words.contains("corners joined across gaps of up to"),
        "{words}"
    );
    assert_eq!(mesh.mended().holes, 0, "{words}");
    assert!(mesh.mended().joined.1 < 1e-6, "{words}");
}

#[test]
fn triangles_that_run_the_other_way_are_turned_and_doubles_left_out() {
    let sound = torus(12, 1.0);
    let volume = whole(&sound);
    let mut wrong = sound.clone();
    for t in wrong.iter_mut().step_by(3) {
        t.swap(0, 1);
    }
    let mesh = Mesh::mend(&wrong, 0.01).unwrap();
    assert!((mesh.volume() / volume - 1.0).abs() < 1e-12);
    assert_eq!(mesh.mended().turned, sound.len().div_ceil(3));
    let mut twice = sound.clone();
    twice.extend_from_slice(&sound[40..55]);
    let mesh = Mesh::mend(&twice, 0.01).unwrap();
    assert_eq!(mesh.mended().doubled, 15);
    assert_eq!(
        mesh.mended().words().unwrap(),
        "15 double triangles left out"
    );
    assert!((mesh.volume() / volume - 1.0).abs() < 1e-12);
    // Two boxes with a face in common are one.
    let mut pair = cuboid([0.0; 3], [1.0; 3]);
    pair.extend(cuboid([1.0, 0.0, 0.0], [3.0, 1.0, 1.0]));
    let mesh = Mesh::mend(&pair, 0.01).unwrap();
    assert!((mesh.volume() - 3.0).abs() < 1e-12);
    assert!(mesh.distance(&[1.0, 0.5, 0.5]) < -0.4);
}

#[test]
fn small_holes_are_closed_and_wide_ones_told_with_their_place() {
    let sound = torus(48, 1.0);
    let volume = whole(&sound);
    let mut holed = sound.clone();
    holed.drain(300..302);
    holed.remove(100);
    let mesh = Mesh::mend(&holed, 0.06).unwrap();
    assert_eq!(mesh.mended().holes, 2);
    assert!((mesh.volume() / volume - 1.0).abs() < 1e-4);
    let words = mesh.mended().words().unwrap();
    assert!(words.starts_with("2 holes closed, the widest "), "{words}");
    let gone = sound[300][0];
    let near = minus(&mesh.mended().widest.1, &gone);
    assert!(dot(&near, &near) < 0.1 * 0.1, "{words}");

    let error = Mesh::mend(&holed, 0.01).unwrap_err().to_string();
    assert!(
        error.starts_with("it is not closed: 7 edges have no second triangle"),
        "{error}"
    );
    assert!(
        error.contains("only those up to one spacing (10 mm) are closed"),
        "{error}"
    );
    // A box without a lid.
    let mut open = cuboid([0.0; 3], [1.0; 3]);
    open.drain(2..4);
    let error = Mesh::mend(&open, 0.1).unwrap_err().to_string();
    let place = "near [0.5, 0.5, 1] m, is 1 m wide";
    assert!(error.contains(place), "{error}");
}

/// Two faces that were cut into triangles by themselves leave a crack along their edge.
#[test]
fn a_crack_closes_like_a_zip() {
    let sound = cuboid([0.0; 3], [1.0; 3]);
    let volume = 1.0;
    // The edge from (0, 0, 1) to (1, 0, 1) has corners of its own in the top face.
    let [a, b] = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
    let is_split = |t: &Triangle| t.contains(&a) && t.contains(&b) && t.iter().all(|x| x[2] == 1.0);
    let mut cracked: Triangles = sound.iter().filter(|t| !is_split(t)).copied().collect();
    assert_eq!(cracked.len(), 11);
    let apex = sound.iter().find(|t| is_split(t)).unwrap();
    let apex = *apex.iter().find(|x| **x != a && **x != b).unwrap();
    let parts = 7;
    let on_edge = |k: u32| {
        [
            f64::from(k) / f64::from(parts),
            1e-3 * f64::from(k % 2),
            1.0,
        ]
    };
    cracked.extend((0..parts).map(|k| [on_edge(k), on_edge(k + 1), apex]));
    let mesh = Mesh::mend(&cracked, 0.02).unwrap();
    assert_eq!(mesh.mended().holes, 1, "{:?}", mesh.mended());
    assert!((mesh.volume() - volume).abs() < 1e-3);
    assert!((mesh.distance(&[0.5, 0.5, 0.9]) + 0.1).abs() < 1e-9);
    // Exactly on the edge: triangles without area give way.
    for x in cracked
        .iter_mut()
        .flatten()
        .filter(|x| x[1] > 0.0 && x[1] < 0.01)
    {
        x[1] = 0.0;
    }
    let mesh = Mesh::mend(&cracked, 0.02).unwrap();
    assert!((mesh.volume() - volume).abs() < 1e-12);
    assert!(mesh.mended().flat > 0, "{:?}", mesh.mended());
    for x in [[0.3, -0.1, 1.1], [0.4, 0.1, 1.1], [0.2, -0.1, 0.9]] {
        assert!(mesh.distance(&x) > 0.0, "{x:?}");
    }
    assert!(mesh.distance(&[0.45, 0.01, 0.98]) < 0.0);
}

#[test]
fn shells_are_turned_as_they_nest() {
    let outer = cuboid([-2.0; 3], [2.0; 3]);
    let hollow = cuboid([-1.0; 3], [1.0; 3]);
    let core = cuboid([-0.5; 3], [0.5; 3]);
    let beside = cuboid([3.0; 3], [4.0; 3]);
    let turned = |t: &[Triangle]| -> Triangles { t.iter().map(|t| [t[0], t[2], t[1]]).collect() };
    let volume = 64.0 - 8.0 + 1.0 + 1.0;
    for (hollow, shells) in [(hollow.clone(), 1), (turned(&hollow), 0)] {
        let all = [outer.clone(), hollow, core.clone(), beside.clone()].concat();
        let mesh = Mesh::mend(&all, 0.1).unwrap();
        assert!((mesh.volume() - volume).abs() < 1e-12);
        assert_eq!(mesh.mended().shells, shells);
        assert!(mesh.distance(&[0.75, 0.0, 0.0]) > 0.0);
        assert!(mesh.distance(&[0.0; 3]) < 0.0);
        assert!(mesh.distance(&[1.5, 0.0, 0.0]) < 0.0);
        assert!(mesh.distance(&[3.5; 3]) < 0.0);
    }
    // A whole file inside out needs no report.
    let mesh = Mesh::mend(&turned(&outer), 0.1).unwrap();
    assert_eq!(mesh.mended().words(), None);
    assert!((mesh.volume() - 64.0).abs() < 1e-12);
}

#[test]
fn triangles_that_cut_through_each_other_are_found() {
    let mut apart = cuboid([0.0; 3], [1.0; 3]);
    apart.extend(cuboid([1.5, 0.0, 0.0], [2.0, 1.0, 1.0]));
    assert_eq!(Mesh::new(&apart).unwrap().crossing(), None);
    assert_eq!(Mesh::new(&torus(20, 1.0)).unwrap().crossing(), None);
    let mut across = cuboid([0.0; 3], [1.0; 3]);
    across.extend(cuboid([0.5, 0.3, 0.2], [2.0, 0.7, 0.6]));
    let crossing = Mesh::new(&across).unwrap().crossing().expect("they cross");
    assert!(crossing.count >= 4, "{crossing:?}");
    assert!((crossing.at[0] - 1.0).abs() < 1e-12, "{crossing:?}");
}

#[test]
fn parts_that_overlap_are_refused() {
    let cube = cuboid([0.0; 3], [10.0; 3]);
    let with = |lower: [f64; 3], upper: [f64; 3]| {
        let all = [cube.clone(), cuboid(lower, upper)].concat();
        Mesh::mend(&all, 1.0).map(|mesh| mesh.volume())
    };
    for (lower, upper) in [
        // Faces in one plane, of a larger part and of one of the same size.
        ([5.0, 0.0, 0.0], [15.0, 10.0, 10.0]),
        ([1.0, 0.0, 0.0], [11.0, 10.0, 10.0]),
        // Within, at the faces.
        ([0.0; 3], [5.0; 3]),
        // Edges through faces.
        ([5.0, 2.0, 2.0], [15.0, 8.0, 8.0]),
    ] {
        let error = with(lower, upper).unwrap_err().to_string();
        assert!(error.contains("its parts overlap"), "{error}");
    }
    // A cavity, a part beside it, and one that touches it within rounding.
    assert!((with([2.0; 3], [8.0; 3]).unwrap() - 1000.0 + 216.0).abs() < 1e-9);
    for edge in [11.0, 10.0, 10.0 - 1e-6] {
        let volume = with([edge, 1.0, 1.0], [15.0, 5.0, 5.0]).unwrap();
        assert!(
            (volume - 1000.0 - 16.0 * (15.0 - edge)).abs() < 1e-9,
            "{edge}"
        );
    }
    // Many in one another.
    let nested = (0..100).flat_map(|n| cuboid([-1.0 - f64::from(n); 3], [1.0 + f64::from(n); 3]));
    let error = Mesh::mend(&nested.collect::<Vec<_>>(), 0.1).unwrap_err();
    assert!(
        error.to_string().contains("more than 64 of its parts"),
        "{error}"
    );
}

/// Against the counts of a grid.
#[test]
fn volumes_above_planes_are_those_of_what_is_left() {
    let mesh = Mesh::new(&torus(96, 1.0)).unwrap();
    let half = mesh.volume_above(&[([0.0, 0.0, 1.0], 0.0)]);
    assert!((half / mesh.volume() - 0.5).abs() < 1e-12);
    let s = 0.5_f64.sqrt();
    let planes = [
        ([s, s, 0.0], 0.2),
        ([s, -s, 0.0], -0.3),
        ([0.0, 0.0, 1.0], 0.05),
    ];
    for used in 1..=3 {
        let computed = mesh.volume_above(&planes[..used]);
        let cells = 120_u32;
        let edge = 2.8 / f64::from(cells);
        let mut counted = 0.0;
        for n in 0..cells * cells * cells / 2 {
            let [i, j, k] = [n % cells, n / cells % cells, n / cells / cells];
            let at = |i: u32| (f64::from(i) + 0.5) * edge - 1.4;
            let x = [at(i), at(j), at(k) + 0.7];
            let above = planes[..used].iter().all(|(n, at)| dot(n, &x) >= *at);
            // Of this torus: exact enough, and quick.
            let r = x[0].hypot(x[1]) - 1.0;
            if above && r.hypot(x[2]) < 1.0 / 3.0 {
                counted += edge * edge * edge;
            }
        }
        assert!(
            (computed / counted - 1.0).abs() < 0.02,
            "{used}: {computed} for {counted}"
        );
    }
}

/// Whatever the triangles, nothing panics, and what is taken is a closed surface.
#[test]
fn random_damage_is_mended_or_refused() {
    let mut state = 7_u64;
    let mut draw = |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).unwrap() % below
    };
    let (mut taken, mut refused) = (0, 0);
    for round in 0..300 {
        let mut damaged = if round % 2 == 0 {
            torus(6, 1.0)
        } else {
            cuboid([0.0; 3], [1.0; 3])
        };
        for _ in 0..=draw(6) {
            let (n, m) = (draw(damaged.len()), draw(damaged.len()));
            match draw(6) {
                0 => {
                    damaged.remove(n);
                }
                1 => damaged[n].swap(0, 1),
                2 => damaged.push(damaged[m]),
                3 => damaged[n][draw(3)] = damaged[m][draw(3)],
                4 => damaged[n][draw(3)][draw(3)] += 0.01,
                _ => damaged.extend(cuboid(damaged[n][0], damaged[m][1])),
            }
        }
        let spacing = [1e-3, 0.1, 10.0][draw(3)];
        match Mesh::mend(&damaged, spacing) {
            Ok(mesh) => {
                taken += 1;
                assert!(mesh.volume().is_finite());
                let _ = mesh.crossing();
                let _ = mesh.distance(&[0.3, 0.1, 0.2]);
            }
            Err(error) => {
                refused += 1;
                assert!(!error.to_string().is_empty());
            }
        }
    }
    assert!(taken > 50 && refused > 50, "{taken} {refused}");
}
