//! Yarns of cloth and walls of cells at a point, in matter with pores.

use crate::support::{batch, material, step, stress};
use material::{
    Compaction, Eos, LANES, Law, Material, MieGruneisen, PAlpha, PointBatch, Porosity, Strength,
    StrengthOf, Uncoupled, UncoupledFailure,
};
use nalgebra::{Matrix3, Rotation3, Vector3};

const SOLID: f64 = 2700.0;
const ALPHA: f64 = 2.5;
const SIZE: f64 = 3e-4;

/// Yarns along 1 and 2; the constants are those of the fibres.
const CLOTH: Uncoupled = Uncoupled {
    e1: 75e9,
    e2: 60e9,
    e3: 0.0,
    g12: 0.1e9,
    g13: 0.1e9,
    g23: 0.1e9,
    c1: 0.0,
    c2: 0.0,
    c3: 0.0,
    s12: 2e6,
    s13: 2e6,
    s23: 2e6,
};

/// Walls along 3, weak across.
const CORE: Uncoupled = Uncoupled {
    e1: 1e6,
    e2: 1e6,
    e3: 500e6,
    g12: 1e6,
    g13: 300e6,
    g23: 150e6,
    c1: 0.05e6,
    c2: 0.05e6,
    c3: 0.9e6,
    s12: 0.1e6,
    s13: 1.4e6,
    s23: 0.9e6,
};

const TEAR: UncoupledFailure = UncoupledFailure {
    t1: 425e6,
    t2: 300e6,
    t3: 0.0,
    gf1: 2e3,
    gf2: 5e3,
    gf3: 0.0,
};

/// Matter of members between which a solid has pores.
fn of(law: Uncoupled, strength: StrengthOf) -> Material {
    assert_eq!(law.contradiction(), None);
    let eos = Eos::MieGruneisen(MieGruneisen {
        c0: 6000.0,
        s1: 1.5,
        s2: 0.0,
        s3: 0.0,
        gamma0: 1.5,
        b: 0.0,
    });
    let crush = Compaction::PAlpha(PAlpha {
        elastic_pressure: 1e6,
        solid_pressure: 300e6,
        exponent: 2.0,
        transition_pressure: 0.0,
        transition_distension: 1.0,
        transition_exponent: 2.0,
        sound_speed: 800.0,
    });
    let mut pores = Porosity::new(ALPHA, crush, SOLID, &eos);
    assert_eq!(pores.law.contradicts(ALPHA, &pores.solid), None);
    pores.strength = strength;
    Material {
        porosity: Some(pores.clone()),
        ..material(pores.density, eos, Strength::Uncoupled(law))
    }
}

fn cloth() -> Material {
    let mut cloth = of(CLOTH, StrengthOf::Matrix);
    cloth.failure.uncoupled = Some(TEAR);
    cloth
}

/// A particle whose directions are those of x, y, z after a rotation.
fn particle(of: &Material, turn: &Rotation3<f64>) -> PointBatch {
    let axis = |a: Vector3<f64>| (turn * a).data.0[0].map(|component| [component; LANES]);
    let rho = of.reference_density;
    PointBatch {
        fibre: axis(Vector3::x()),
        normal: axis(Vector3::z()),
        mass: [rho * SIZE * SIZE * SIZE; LANES],
        pressure: [0.0; LANES],
        ..batch(rho, 0.0)
    }
}

/// Stress with its pressure (Pa).
fn whole(points: &PointBatch) -> Matrix3<f64> {
    stress(points) - Matrix3::identity() * points.pressure[LANES - 1]
}

/// Steps of a strain, and the work (J/kg) that they take; it warms nothing.
fn pull(of: &Material, points: &mut PointBatch, rate: &Matrix3<f64>, steps: u32) -> f64 {
    let mut work = 0.0;
    for _ in 0..steps {
        let (before, thick) = (whole(points), points.density[0]);
        step(of, points, rate, 1.0);
        let (after, thin) = (whole(points), points.density[0]);
        work += 0.5 * (before / thick + after / thin).component_mul(rate).sum();
    }
    work
}

fn along(i: usize, rate: f64) -> Matrix3<f64> {
    let mut l = Matrix3::zeros();
    l[(i, i)] = rate;
    l
}

/// Yarns pull along themselves alone; cloth that is pressed bears the pressure of its pores alone, whichever way.
#[test]
fn cloth_pulls_along_its_yarns_and_bears_pressure_alone() {
    let mut plain = cloth();
    plain.failure.uncoupled = None;
    let turn = Rotation3::from_euler_angles(0.3, -0.7, 1.1);
    for (i, modulus) in [(0, 75e9), (1, 60e9), (2, 0.0)] {
        let mut points = particle(&plain, &turn);
        let rate = turn.matrix() * along(i, 1e-5) * turn.matrix().transpose();
        pull(&plain, &mut points, &rate, 100);
        let inside = turn.matrix().transpose() * whole(&points) * turn.matrix();
        let share = points.density[0] / SOLID;
        let wanted = along(i, 1e-3 * modulus * share);
        assert!((inside - wanted).norm() < 1e-5 * 75e6, "{i}: {inside}");
        // Slack, and then taut at the same length again.
        pull(&plain, &mut points, &-rate, 200);
        let (pressed, pressure) = (whole(&points), points.pressure[0]);
        assert!(pressure > 0.0 && (pressed + Matrix3::identity() * pressure).norm() < 1e-3);
        pull(&plain, &mut points, &rate, 200);
        let again = turn.matrix().transpose() * whole(&points) * turn.matrix();
        assert!((again - wanted).norm() < 1e-5 * 75e6, "{i}: {again}");
    }
}

/// Pressed cloth has the pressure of its pores' curve, and a yarn the same force whatever it is pressed to.
#[test]
fn pressing_changes_no_force_of_a_yarn() {
    let mut plain = cloth();
    plain.failure.uncoupled = None;
    let mut points = particle(&plain, &Rotation3::identity());
    pull(&plain, &mut points, &along(0, 1e-5), 100);
    let thin = whole(&points)[(0, 0)] / points.density[0];
    pull(&plain, &mut points, &along(2, -1e-3), 700);
    let alpha = points.distension[0];
    let curve = |p: f64| 1.0 + (ALPHA - 1.0) * ((300e6 - p) / (300e6 - 1e6)).powi(2);
    let pressure = -whole(&points)[(2, 2)];
    assert!(pressure > 10e6, "{pressure:e}");
    assert!((alpha / curve(pressure) - 1.0).abs() < 2e-3, "{alpha}");
    let thick = (whole(&points)[(0, 0)] + pressure) / points.density[0];
    assert!((thick / thin - 1.0).abs() < 1e-9);
}

/// Yarns tear at their strength, take their energy over the size, unload to their first length, and those across stay whole.
#[test]
fn yarns_tear_by_their_energy() {
    let cloth = cloth();
    for (i, strength, energy) in [(0, 425e6, 2e3), (1, 300e6, 5e3)] {
        let mut points = particle(&cloth, &Rotation3::identity());
        let rate = along(i, 2e-5);
        let traction = |points: &PointBatch| whole(points)[(i, i)] * SOLID / points.density[0];
        let (mut work, mut most, mut back) = (0.0, 0.0_f64, false);
        for _ in 0..6000 {
            work += pull(&cloth, &mut points, &rate, 1);
            most = most.max(traction(&points));
            let torn = [points.fibre_damage, points.matrix_damage][i][0];
            if !back && torn > 0.5 {
                back = true;
                let (held, strain) = (traction(&points), points.elastic_strain[i][0]);
                let steps = 50;
                work += pull(&cloth, &mut points, &-rate, steps);
                let slope = (held - traction(&points)) / (f64::from(steps) * 2e-5);
                assert!((slope * strain / held - 1.0).abs() < 1e-6, "to the origin");
                work += pull(&cloth, &mut points, &rate, steps);
            }
        }
        assert!((0.995..1.0 + 1e-9).contains(&(most / strength)), "{most:e}");
        let taken = work * SOLID * SIZE / energy;
        assert!((taken - 1.0).abs() < 2e-2, "{i}: {taken}");
        let booked = points.failure_energy[0] * SOLID * SIZE / energy;
        assert!((booked - 1.0).abs() < 1e-9, "{i}: {booked}");
        assert_eq!(whole(&points)[(i, i)], 0.0);
        assert_eq!(points.damage[0], 0.0);
        // Those across pull as before.
        pull(&cloth, &mut points, &along(1 - i, 1e-5), 100);
        let modulus = [75e9, 60e9][1 - i] * points.density[0] / SOLID;
        let other = whole(&points)[(1 - i, 1 - i)];
        assert!((other / (1e-3 * modulus) - 1.0).abs() < 1e-9);
    }
}

/// Cloth without yarns either way has failed: it bears pressure alone.
#[test]
fn cloth_without_yarns_has_failed() {
    let cloth = cloth();
    let mut points = particle(&cloth, &Rotation3::identity());
    let mut rate = along(0, 1e-4);
    rate[(1, 1)] = 1e-4;
    pull(&cloth, &mut points, &rate, 2000);
    assert_eq!(points.damage[0], 1.0);
    assert_eq!(whole(&points), Matrix3::zeros());
    pull(&cloth, &mut points, &-rate, 3000);
    assert!(points.pressure[0] > 0.0 && stress(&points).norm() == 0.0);
}

/// Walls crush at a plateau along the cells, are dense at the end, and weak across.
#[test]
fn walls_crush_at_a_plateau_until_they_are_dense() {
    let core = of(CORE, StrengthOf::Whole);
    let crush = |i: usize, steps: u32| {
        let mut points = particle(&core, &Rotation3::identity());
        pull(&core, &mut points, &along(i, -1e-4), steps);
        points
    };
    for (i, plateau) in [(2, 0.9e6), (0, 0.05e6)] {
        let points = crush(i, 3000);
        let pressure = points.compaction[0] * 299e6 + 1e6;
        let borne = -whole(&points)[(i, i)];
        let wanted = plateau + pressure;
        assert!(
            (borne / wanted - 1.0).abs() < 1e-6,
            "{i}: {borne:e} {wanted:e}"
        );
        assert!(points.plastic_strain[0] > 0.0);
    }
    // Beyond the solid's density, the solid's own stiffness.
    let dense = crush(2, 11_000);
    assert_eq!(dense.compaction[0], 1.0);
    assert!(dense.pressure[0] > 10e9, "{:e}", dense.pressure[0]);
}

/// Strain that ends where it began takes work and never gives any: tears, slack, crushing of walls and pores on the way.
#[test]
fn no_closed_path_gives_energy() {
    let mut walls = of(CORE, StrengthOf::Whole);
    walls.failure.uncoupled = Some(UncoupledFailure {
        t1: 0.1e6,
        t2: 0.1e6,
        t3: 2e6,
        gf1: 10.0,
        gf2: 10.0,
        gf3: 500.0,
    });
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(seed >> 33).unwrap()) / f64::from(1_u32 << 31) * 2.0 - 1.0
    };
    for matter in [cloth(), walls] {
        for size in [1e-5, 1e-5, 1e-4, 1e-4, 1e-3, 1e-3] {
            let mut points = particle(&matter, &Rotation3::identity());
            let (mut work, mut least) = (0.0, 0.0_f64);
            for _ in 0..8 {
                let mut rate = Matrix3::from_fn(|_, _| random() * size);
                rate = (rate + rate.transpose()) * 0.5;
                for there in [1.0, -1.0] {
                    work += pull(&matter, &mut points, &(rate * there), 200);
                    least = least.min(work);
                }
            }
            assert!(
                work > 0.0 && least > -1e-3 * work,
                "{size}: {work:e} {least:e}"
            );
        }
    }
}

/// Yarns that are stretched in thin cloth and let go in thick cloth, or the other way round, give back what they took.
#[test]
fn a_cycle_of_stretch_and_thickness_gives_nothing() {
    let mut plain = cloth();
    plain.failure.uncoupled = None;
    for sense in [1.0, -1.0] {
        let mut points = particle(&plain, &Rotation3::identity());
        // Pores crush once and for all.
        pull(&plain, &mut points, &along(2, -1e-3), 500);
        let (stretch, press) = (along(0, 2e-5), along(2, 2e-4));
        let mut work = 0.0;
        let mut most = 0.0_f64;
        for _ in 0..3 {
            if sense < 0.0 {
                work += pull(&plain, &mut points, &press, 500);
            }
            work += pull(&plain, &mut points, &stretch, 200);
            most = most.max(work.abs());
            work += pull(&plain, &mut points, &(press * sense), 500);
            work += pull(&plain, &mut points, &-stretch, 200);
            if sense > 0.0 {
                work += pull(&plain, &mut points, &-press, 500);
            }
        }
        let yarns = 0.5 * 75e9 * 4e-3_f64.powi(2) / SOLID;
        assert!(work.abs() < 2e-3 * yarns, "{work:e} of {yarns:e} {most:e}");
    }
}

/// Sound along the yarns is that of their stiffness beside the pores'.
#[test]
fn sound_runs_along_the_yarns() {
    let cloth = cloth();
    let mut points = particle(&cloth, &Rotation3::identity());
    step(&cloth, &mut points, &Matrix3::zeros(), 1.0);
    let wanted = (75e9_f64 / SOLID + 800.0_f64.powi(2)).sqrt();
    assert!((points.sound_speed[0] / wanted - 1.0).abs() < 1e-9);
    assert!((cloth.longitudinal_speed() / wanted - 1.0).abs() < 1e-9);
}

/// Contradictions are told by their keys.
#[test]
fn strengths_need_moduli() {
    let crush = Uncoupled { c3: 1e6, ..CLOTH };
    assert_eq!(crush.contradiction().unwrap().keys, ["c3"]);
    let slip = Uncoupled { g13: 0.0, ..CLOTH };
    assert_eq!(slip.contradiction().unwrap().keys, ["s13"]);
}
