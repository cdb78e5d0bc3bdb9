//! Matter with directions of its own at a point.

use crate::support::{batch, equivalent, material, step, stress};
use material::{
    Criterion, Elastic, Eos, Hashin, LANES, Law, Linear, LinearForm, Material, Orthotropic,
    PointBatch, Strength,
};
use nalgebra::{Matrix3, Rotation3, Vector3};
use numerics::principal::principal;

const RHO: f64 = 1600.0;

/// Carbon fibres in epoxy, by order of magnitude.
const LAMINA: Orthotropic = Orthotropic {
    e1: 140e9,
    e2: 10e9,
    e3: 9e9,
    nu12: 0.3,
    nu13: 0.25,
    nu23: 0.45,
    g12: 5e9,
    g13: 4.5e9,
    g23: 3.5e9,
    crush_stress: 0.0,
};

/// A modulus of volume that is not that of the directions (Pa).
const BULK: f64 = 15e9;

fn of(law: Orthotropic) -> Material {
    let eos = Eos::Linear(Linear {
        bulk_modulus: BULK,
        form: LinearForm::Logarithmic,
    });
    material(RHO, eos, Strength::Orthotropic(law))
}

/// A batch whose directions are those of x, y, z after a rotation.
fn turned(rotation: &Rotation3<f64>) -> PointBatch {
    let axis = |a: Vector3<f64>| (rotation * a).data.0[0].map(|component| [component; LANES]);
    PointBatch {
        fibre: axis(Vector3::x()),
        normal: axis(Vector3::z()),
        ..batch(RHO, 0.0)
    }
}

/// Stress with its pressure (Pa).
fn whole(points: &PointBatch) -> Matrix3<f64> {
    stress(points) - Matrix3::identity() * points.pressure[LANES - 1]
}

/// Strain of the lamina in its frame under a stress, by its compliances.
fn compliance(law: &Orthotropic, s: &Matrix3<f64>) -> Matrix3<f64> {
    let [a, b, c] = [s[(0, 0)], s[(1, 1)], s[(2, 2)]];
    let shear = |i: usize, j: usize, g: f64| s[(i, j)] / (2.0 * g);
    let (xy, xz, yz) = (
        shear(0, 1, law.g12),
        shear(0, 2, law.g13),
        shear(1, 2, law.g23),
    );
    let xx = a / law.e1 - law.nu12 / law.e1 * b - law.nu13 / law.e1 * c;
    let yy = -law.nu12 / law.e1 * a + b / law.e2 - law.nu23 / law.e2 * c;
    let zz = -law.nu13 / law.e1 * a - law.nu23 / law.e2 * b + c / law.e3;
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// Off-axis tension: the strain of the closed form gives the stress that it is of, at any angle of the fibres.
#[test]
fn tension_off_the_axes_is_that_of_the_closed_form() {
    let law = LAMINA;
    let lamina = of(law);
    for degrees in [0.0_f64, 10.0, 30.0, 45.0, 60.0, 90.0] {
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), degrees.to_radians());
        let tension = Matrix3::from_diagonal(&Vector3::new(1e6, 0.0, 0.0));
        let inside = turn.matrix().transpose() * tension * turn.matrix();
        let strain = turn.matrix() * compliance(&law, &inside) * turn.matrix().transpose();
        // Young's modulus of a lamina at an angle (Jones 1999, Mechanics of Composite Materials, equation 2.97).
        let (s, c) = degrees.to_radians().sin_cos();
        let modulus = 1.0
            / (c.powi(4) / law.e1
                + (1.0 / law.g12 - 2.0 * law.nu12 / law.e1) * (s * c).powi(2)
                + s.powi(4) / law.e2);
        assert!(
            (1e6 / strain[(0, 0)] / modulus - 1.0).abs() < 1e-12,
            "{degrees}"
        );
        let mut points = turned(&turn);
        for _ in 0..10 {
            step(&lamina, &mut points, &strain, 0.1);
        }
        let error = (whole(&points) - tension).norm() / 1e6;
        assert!(error < 2e-3, "{degrees}: {error:e}");
    }
}

/// A whole turn in steps of some degrees, about an axis that is none of its directions.
#[test]
fn a_turn_brings_stress_and_directions_back() {
    let lamina = of(LAMINA);
    let start = Rotation3::from_euler_angles(0.3, -0.7, 1.1);
    let mut points = turned(&start);
    let strain = Matrix3::new(1e-2, 2e-3, -3e-3, 1e-3, -4e-3, 5e-3, 2e-3, 0.0, 3e-3);
    step(&lamina, &mut points, &strain, 1.0);
    let (before, fibre) = (whole(&points), points.fibre);
    let axis = Vector3::new(1.0, 2.0, -0.5).normalize();
    let steps = 90_u32;
    // The rotation of a step is that of Cayley.
    let rate = 2.0 * (std::f64::consts::PI / f64::from(steps)).tan();
    let spin = axis.cross_matrix() * rate;
    for _ in 0..steps {
        step(&lamina, &mut points, &spin, 1.0);
        let [f, n] = [points.fibre, points.normal].map(|a| Vector3::from(a.map(|c| c[0])));
        let off = [f.norm() - 1.0, n.norm() - 1.0, f.dot(&n)];
        assert!(off.iter().all(|off| off.abs() < 1e-15), "{off:?}");
    }
    let error = (whole(&points) - before).norm() / before.norm();
    assert!(error < 1e-12, "{error:e}");
    for (a, b) in points.fibre.iter().zip(fibre) {
        assert!((a[0] - b[0]).abs() < 1e-12);
    }
}

/// Three equal directions are isotropic elasticity.
#[test]
fn equal_directions_are_isotropic() {
    let (e, nu) = (70e9, 0.33);
    let g = e / (2.0 * (1.0 + nu));
    let law = Orthotropic {
        e1: e,
        e2: e,
        e3: e,
        nu12: nu,
        nu13: nu,
        nu23: nu,
        g12: g,
        g13: g,
        g23: g,
        crush_stress: 0.0,
    };
    let bulk = e / (3.0 * (1.0 - 2.0 * nu));
    assert!((law.shear_modulus() / g - 1.0).abs() < 1e-13);
    let eos = Eos::Linear(Linear {
        bulk_modulus: bulk,
        form: LinearForm::Logarithmic,
    });
    let same = material(RHO, eos, Strength::Elastic(Elastic { shear_modulus: g }));
    let l = Matrix3::new(1.0, 2.0, -3.0, 0.5, -4.0, 1.0, 2.0, 0.0, 3.0);
    let mut points = [
        turned(&Rotation3::from_euler_angles(0.4, 0.2, -0.3)),
        batch(RHO, 0.0),
    ];
    for _ in 0..20 {
        step(&of(law), &mut points[0], &l, 1e-9);
        step(&same, &mut points[1], &l, 1e-9);
    }
    let [directed, isotropic] = [&points[0], &points[1]].map(whole);
    // Lines turn otherwise than the spin, by the strain itself.
    let error = (directed - isotropic).norm() / isotropic.norm();
    assert!(error < 1e-6, "{error:e}");
    assert!((points[0].sound_speed[0] / points[1].sound_speed[0] - 1.0).abs() < 1e-12);
}

/// The stiffest wave of all directions, by an independent search.
#[test]
fn no_wave_is_stiffer() {
    let woven = Orthotropic {
        e1: 18e9,
        e2: 18e9,
        e3: 2e9,
        nu12: 0.08,
        nu13: 0.3,
        nu23: 0.3,
        g12: 12e9,
        g13: 1.9e9,
        g23: 1.9e9,
        crush_stress: 0.0,
    };
    for law in [LAMINA, woven] {
        let stiffness = law.stiffness(BULK);
        let mut largest = 0.0_f64;
        for polar in 0..=90 {
            for about in 0..=90 {
                let [p, a] = [polar, about].map(|d| f64::from(d).to_radians());
                let n = [p.sin() * a.cos(), p.sin() * a.sin(), p.cos()];
                let (values, _) = principal(&stiffness.acoustic(&n));
                largest = values.into_iter().fold(largest, f64::max);
            }
        }
        let ratio = stiffness.wave_modulus() / largest;
        assert!((1.0 - 1e-9..1.0 + 1e-9).contains(&ratio), "{ratio}");
    }
}

/// Change of shape alone gives pressure, change of volume alone a deviator; what flows does work, and keeps its limit.
#[test]
fn shape_and_volume_are_coupled_up_to_the_limit() {
    let lamina = of(LAMINA);
    let mut points = turned(&Rotation3::identity());
    let shape = Matrix3::from_diagonal(&Vector3::new(2e-3, -1e-3, -1e-3));
    step(&lamina, &mut points, &shape, 1.0);
    let c = LAMINA.stiffness(BULK).stretch;
    let row = |i: usize| 2.0 * c[i][0] - c[i][1] - c[i][2];
    let pressure = -1e-3 * (row(0) + row(1) + row(2)) / 3.0;
    assert!((points.pressure[0] / pressure - 1.0).abs() < 1e-12);

    let bounded = Orthotropic {
        crush_stress: 20e6,
        ..LAMINA
    };
    let mut points = turned(&Rotation3::from_euler_angles(0.1, 0.2, 0.3));
    let mut work = 0.0;
    let rate = Matrix3::new(-3.0, 1.0, 0.0, 1.0, 2.0, 0.5, 0.0, 0.5, 1.0);
    let dt = 1e-5;
    for _ in 0..2000 {
        let before = whole(&points);
        step(&of(bounded), &mut points, &rate, dt);
        let middle = if work == 0.0 {
            whole(&points) * 0.5
        } else {
            (before + whole(&points)) * 0.5
        };
        work += middle.component_mul(&rate).sum() * dt;
        assert!(equivalent(&points) < 20e6 * (1.0 + 1e-12));
    }
    let plastic = points.plastic_strain[0] * 20e6;
    assert!((0.95..1.0).contains(&(plastic / work)), "{plastic} {work}");
}

#[test]
fn impossible_ratios_are_refused() {
    assert!(LAMINA.contradiction().is_none());
    for law in [
        Orthotropic {
            nu12: 4.0,
            ..LAMINA
        },
        Orthotropic {
            nu23: 0.96,
            nu12: 1.0,
            nu13: 1.5,
            ..LAMINA
        },
    ] {
        assert!(law.contradiction().is_some(), "{law:?}");
    }
}

/// The lamina with strengths; a particle of 1 mm.
fn cracking() -> Material {
    let mut lamina = of(LAMINA);
    lamina.failure.hashin = Some(STRENGTHS);
    lamina
}

const SIZE: f64 = 1e-3;
const STRENGTHS: Hashin = Hashin {
    t1: 2e9,
    t2: 60e6,
    t3: 50e6,
    s12: 80e6,
    s13: 80e6,
    s23: 40e6,
    gf1: 80e3,
    gf2: 500.0,
    gf3: 300.0,
    criterion: Criterion::Hashin,
};

/// Damage of fibres, of the matrix, between layers.
fn damages(points: &PointBatch) -> [f64; 3] {
    [
        points.fibre_damage,
        points.matrix_damage,
        points.delamination,
    ]
    .map(|lanes| lanes[0])
}

fn particle() -> PointBatch {
    PointBatch {
        mass: [RHO * SIZE * SIZE * SIZE; LANES],
        ..turned(&Rotation3::identity())
    }
}

/// Strains a point along a direction by `rate` a step, and returns the work (J/m³) of it.
fn pull(lamina: &Material, points: &mut PointBatch, rate: &Matrix3<f64>, steps: u32) -> f64 {
    let mut work = 0.0;
    for _ in 0..steps {
        let before = if points.pressure[0].is_nan() {
            Matrix3::zeros()
        } else {
            whole(points)
        };
        step(lamina, points, rate, 1.0);
        work += (before + whole(points)).component_mul(rate).sum() * 0.5;
    }
    work
}

/// A crack across a direction opens at its strength, takes its energy over the size, and bears nothing from then on; along
/// the fibres the matter is as strong as before.
#[test]
fn a_crack_takes_its_energy_whatever_the_size() {
    let lamina = cracking();
    for (i, strength, energy) in [(2, 50e6, 300.0), (1, 60e6, 500.0), (0, 2e9, 80e3)] {
        let mut points = particle();
        let mut rate = Matrix3::zeros();
        rate[(i, i)] = 1e-5;
        let (mut work, mut most) = (0.0, 0.0_f64);
        for _ in 0..12_000 {
            work += pull(&lamina, &mut points, &rate, 1);
            most = most.max(whole(&points)[(i, i)]);
        }
        assert!(
            (0.98..1.0 + 1e-9).contains(&(most / strength)),
            "{i}: {most:e}"
        );
        assert!(whole(&points)[(i, i)].abs() < 1e-6 * strength, "{i}");
        let released = points.failure_energy[0] * RHO * SIZE / energy;
        assert!((released - 1.0).abs() < 0.05, "{i}: {released}");
        // Beside it, what is held across by the strain that is kept there.
        assert!((work * SIZE / energy - 1.0).abs() < 0.08, "{i}: {work:e}");
        assert_eq!(damages(&points)[i], 1.0);
        // Fibres break at a stretch at which what is held across begins to split.
        assert!(i == 0 || points.damage[0] == 0.0);
        if i == 2 {
            let mut along = Matrix3::zeros();
            along[(0, 0)] = 1e-5;
            pull(&lamina, &mut points, &along, 100);
            let stress = whole(&points);
            // Parted layers fill .89 of the volume.
            assert!(stress[(0, 0)] > 0.88e-3 * LAMINA.e1 && stress[(2, 2)].abs() < 1e3);
        }
    }
}

/// An open crack closes without stress, and bears pressure from then on.
#[test]
fn a_crack_closes_before_it_bears_pressure() {
    let lamina = cracking();
    let mut points = particle();
    let mut rate = Matrix3::zeros();
    rate[(2, 2)] = 1e-5;
    pull(&lamina, &mut points, &rate, 5000);
    let work = pull(&lamina, &mut points, &-rate, 4900);
    assert!(work.abs() < 1.0, "{work}");
    assert!(points.opening_3[0] > 0.0);
    pull(&lamina, &mut points, &-rate, 400);
    assert_eq!(points.opening_3[0], 0.0);
    let pressed = whole(&points)[(2, 2)];
    let wanted = LAMINA
        .stiffness(BULK)
        .stress(&[0.0, 0.0, -3e-3, 0.0, 0.0, 0.0])[2]
        - BULK * 3e-3;
    assert!(
        (pressed / wanted - 1.0).abs() < 0.02,
        "{pressed:e} {wanted:e}"
    );
}

/// Shear of layers delaminates them at its strength; with tension beside it, on the ellipse of both.
#[test]
fn tension_and_shear_go_together() {
    for (criterion, both) in [(Criterion::Hashin, 1.0), (Criterion::MaximumStress, 2.0)] {
        let mut lamina = cracking();
        lamina.failure.hashin = Some(Hashin {
            criterion,
            ..STRENGTHS
        });
        let [c33, g23] = [LAMINA.stiffness(BULK).stretch[2][2], LAMINA.g23];
        let mut points = particle();
        // Both reach their strength at once, each for itself.
        let (normal, shear) = (50e6 / c33 / 4000.0, 40e6 / (2.0 * g23) / 4000.0);
        let mut rate = Matrix3::zeros();
        rate[(2, 2)] = normal;
        rate[(1, 2)] = shear;
        rate[(2, 1)] = shear;
        let mut most = 0.0_f64;
        for _ in 0..6000 {
            pull(&lamina, &mut points, &rate, 1);
            let stress = whole(&points);
            let sum = (stress[(2, 2)] / 50e6).powi(2) + (stress[(1, 2)] / 40e6).powi(2);
            most = most.max(sum);
        }
        assert!((most / both - 1.0).abs() < 5e-3, "{most}");
        assert!(damages(&points)[2] > 0.0 && damages(&points)[0] == 0.0);
    }
}

/// Cracks across all directions are failure.
#[test]
fn cracks_across_all_directions_are_failure() {
    let lamina = cracking();
    let mut points = particle();
    let rate = Matrix3::identity() * 1e-4;
    pull(&lamina, &mut points, &rate, 3000);
    assert_eq!(points.damage[0], 1.0);
    assert!(whole(&points).norm() == 0.0, "{}", whole(&points));
    pull(&lamina, &mut points, &-rate, 3200);
    assert!(points.pressure[0] > 0.0 && equivalent(&points) == 0.0);
}

/// Strain that ends where it began, with cracks, crushing and turns on the way, takes work and never gives any.
#[test]
fn no_closed_path_gives_energy() {
    let strong = Orthotropic {
        crush_stress: 1.2e9,
        ..LAMINA
    };
    let mut lamina = of(strong);
    lamina.failure.hashin = Some(STRENGTHS);
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(seed >> 33).unwrap()) / f64::from(1_u32 << 31) * 2.0 - 1.0
    };
    for (path, size) in [1e-4, 1e-4, 1e-3, 1e-3, 1e-3, 3e-3, 3e-3, 3e-3]
        .into_iter()
        .enumerate()
    {
        let mut points = particle();
        let (mut work, mut least) = (0.0, 0.0_f64);
        // To places of strain, and from each back to none.
        for _ in 0..8 {
            let mut rate = Matrix3::from_fn(|_, _| random() * size);
            rate = (rate + rate.transpose()) * 0.5;
            for there in [1.0, -1.0] {
                work += pull(&lamina, &mut points, &(rate * there), 100);
                least = least.min(work);
            }
        }
        assert!(
            work > 0.0 && least > -1e-3 * work,
            "{path}: {work:e} {least:e}"
        );
    }
}

/// Layers that slide over each other keep the directions of their fibres; fibres that are sheared across turn with the lines of
/// the matter.
#[test]
fn fibres_are_lines_of_the_matter() {
    let lamina = of(LAMINA);
    let run = |l: Matrix3<f64>| {
        let mut points = turned(&Rotation3::identity());
        for _ in 0..100 {
            step(&lamina, &mut points, &l, 0.01);
        }
        [points.fibre, points.normal].map(|axis| Vector3::from(axis.map(|c| c[0])))
    };
    let mut slides = Matrix3::zeros();
    slides[(0, 2)] = 1.5;
    assert_eq!(run(slides), [Vector3::x(), Vector3::z()]);
    let [fibre, normal] = run(slides.transpose());
    let (turned, across) = (
        Vector3::new(1.0, 0.0, 1.5).normalize(),
        Vector3::new(-1.5, 0.0, 1.0).normalize(),
    );
    assert!((fibre - turned).norm() < 1e-12 && (normal - across).norm() < 1e-12);
}
