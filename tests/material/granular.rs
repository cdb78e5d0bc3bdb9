//! Strength that grows with pressure: triaxial paths, friction of failed rock, sand, shear damage, softening by heat.
#![allow(clippy::float_cmp, reason = "where nothing may change, not a bit does")]

use crate::support::{batch, equivalent, material, step, stress};
use material::{
    AfterSpall, Collins, CollinsFailure, Crosses, DruckerPrager, Effect, Eos, Failure, Flaws,
    GradyKipp, Ivanov, LANES, Linear, LinearForm, Lundborg, Material, MohrCoulomb, PointBatch,
    PrincipalStress, Spall, Strength, Thermal, ThermalConstants, VonMises,
};
use nalgebra::{Matrix3, Vector3};

const RHO: f64 = 2650.0;
const K: f64 = 40e9;
const G: f64 = 25e9;

fn eos() -> Eos {
    Eos::Linear(Linear {
        bulk_modulus: K,
        form: LinearForm::Logarithmic,
    })
}

fn of(strength: Strength) -> Material {
    material(RHO, eos(), strength)
}

const CONE: DruckerPrager = DruckerPrager {
    shear_modulus: G,
    cohesion: 10e6,
    friction: 0.6,
    max_strength: 500e6,
};

/// φ = 30°.
const PYRAMID: MohrCoulomb = MohrCoulomb {
    shear_modulus: G,
    cohesion: 20e6,
    friction: 0.577_350_269_189_625_8,
    tensile_strength: 5e6,
};

/// Granite of Collins et al. (2004).
const CURVE: Lundborg = Lundborg {
    shear_modulus: G,
    cohesion: 90e6,
    friction: 2.0,
    max_strength: 1.5e9,
};

const ROCK: Collins = Collins {
    shear_modulus: G,
    cohesion: 90e6,
    friction: 2.0,
    max_strength: 1.5e9,
    damaged_cohesion: 0.0,
    damaged_friction: 0.8,
    damaged_max_strength: 0.0,
    softening: 0.0,
    simon_a: 0.0,
    simon_c: 1.0,
};

/// Rock with a law of failure, which keeps friction.
fn failing(strength: Strength, laws: &Failure) -> Material {
    let mut rock = of(strength);
    rock.failure = *laws;
    rock.failure.options.effect = Effect::FrictionKept;
    rock
}

fn diagonal(x: f64, y: f64, z: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(x, y, z))
}

/// A point at a pressure (Pa) without shear.
fn pressed(rock: &Material, pressure: f64) -> PointBatch {
    let mut points = batch(RHO * libm::exp(pressure / K), 0.0);
    rock.update(&mut points, 0.0);
    points
}

/// Shears by `l` (1/s, traceless) for a second, in steps.
fn shear(rock: &Material, points: &mut PointBatch, l: &Matrix3<f64>, steps: u32) {
    for _ in 0..steps {
        step(rock, points, l, 1.0 / f64::from(steps));
    }
}

/// Stress difference (Pa) of a conventional triaxial test: the lateral pressure (Pa) stays while the axis shortens
/// (`sign` −1) or stretches (+1).
fn triaxial(rock: &Material, lateral: f64, sign: f64) -> f64 {
    let mut points = pressed(rock, lateral);
    let (steps, strain) = (400, 0.02);
    let of = |points: &PointBatch, i: usize| stress(points)[(i, i)] - points.pressure[0];
    for _ in 0..steps {
        let axial = sign * strain / f64::from(steps);
        let (mut low, mut high) = (-0.001, 0.001);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let mut trial = points;
            step(rock, &mut trial, &diagonal(axial, middle, middle), 1.0);
            if of(&trial, 1) > -lateral {
                high = middle;
            } else {
                low = middle;
            }
        }
        step(rock, &mut points, &diagonal(axial, low, low), 1.0);
    }
    assert!((of(&points, 1) / lateral + 1.0).abs() < 1e-6);
    (of(&points, 0) - of(&points, 1)).abs()
}

fn assert_near(found: f64, exact: f64, part: f64, what: &str) {
    assert!(
        (found / exact - 1.0).abs() < part,
        "{what}: {found} instead of {exact}"
    );
}

const ROOT_3: f64 = 1.732_050_807_568_877_2;

/// At constant volume, sheared far beyond yield, the stress difference is √3 times the shear strength at the pressure.
#[test]
fn shear_at_a_pressure_has_the_strength_of_the_curve() {
    let axial = diagonal(-0.2, 0.1, 0.1);
    let lundborg = |p: f64| 90e6 + 2.0 * p / (1.0 + 2.0 * p / 1.41e9);
    for p in [1e6, 50e6, 200e6, 1e9, 5e9_f64] {
        let cases: [(Strength, f64); 3] = [
            (
                Strength::DruckerPrager(CONE),
                f64::min(10e6 + 0.6 * p, 500e6) * ROOT_3,
            ),
            (Strength::Lundborg(CURVE), lundborg(p) * ROOT_3),
            (Strength::Collins(ROCK), lundborg(p) * ROOT_3),
        ];
        for (strength, exact) in cases {
            let rock = of(strength);
            let mut points = pressed(&rock, p);
            shear(&rock, &mut points, &axial, 50);
            assert_near(points.pressure[0], p, 1e-8, "pressure");
            assert_near(equivalent(&points), exact, 1e-8, "strength");
            // What strain is not elastic is plastic: ε = 0.2 in compression, and the rest q/3G.
            let plastic = 0.2 - exact / (3.0 * G);
            assert_near(points.plastic_strain[0], plastic, 1e-3, "plastic strain");
        }
    }
}

/// Triaxial compression and extension at a lateral pressure: closed forms of both pyramids and cones.
#[test]
fn triaxial_tests_end_at_the_closed_forms() {
    let (sine, cosine) = (0.5, 0.5 * ROOT_3);
    for lateral in [10e6, 100e6] {
        let cone = of(Strength::DruckerPrager(CONE));
        let (c, m) = (CONE.cohesion, CONE.friction / ROOT_3);
        let exact = ROOT_3 * (c + CONE.friction * lateral) / (1.0 - m);
        assert_near(triaxial(&cone, lateral, -1.0), exact, 1e-4, "cone");
        let pyramid = of(Strength::MohrCoulomb(PYRAMID));
        // σ₁ = σ₃ (1 + sin φ)/(1 − sin φ) + 2 c cos φ/(1 − sin φ) of the pressures.
        let (by_pressure, by_cohesion) = (2.0 * sine * lateral, 2.0 * PYRAMID.cohesion * cosine);
        let exact = (by_pressure + by_cohesion) / (1.0 - sine);
        assert_near(
            triaxial(&pyramid, lateral, -1.0),
            exact,
            1e-4,
            "compression",
        );
        // The axis has the least pressure, the sides the most.
        let exact = (by_pressure + by_cohesion) / (1.0 + sine);
        let within = lateral - exact > -PYRAMID.tensile_strength;
        let exact = if within {
            exact
        } else {
            lateral + PYRAMID.tensile_strength
        };
        assert_near(triaxial(&pyramid, lateral, 1.0), exact, 1e-4, "extension");
        // √3 Y(σ₃ + q/3) = q by bisection.
        let rock = of(Strength::Collins(ROCK));
        let (mut low, mut high) = (0.0, 5e9);
        for _ in 0..100 {
            let q: f64 = 0.5 * (low + high);
            let p = lateral + q / 3.0;
            if ROOT_3 * (90e6 + 2.0 * p / (1.0 + 2.0 * p / 1.41e9)) > q {
                low = q;
            } else {
                high = q;
            }
        }
        if low < 0.02 * 2.0 * G {
            assert_near(triaxial(&rock, lateral, -1.0), low, 1e-4, "granite");
        }
    }
}

/// On the whole hexagon: compression, shear and extension at one pressure.
#[test]
fn the_hexagon_of_mohr_and_coulomb_has_its_corners() {
    let rock = of(Strength::MohrCoulomb(PYRAMID));
    let (sine, cosine) = (0.5, 0.5 * ROOT_3);
    let p = 100e6;
    let radius = PYRAMID.cohesion * cosine + p * sine;
    let skew = Matrix3::new(0.0, 0.2, 0.0, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0);
    let cases = [
        (diagonal(-0.2, 0.1, 0.1), 6.0 * radius / (3.0 - sine)),
        (diagonal(0.2, -0.1, -0.1), 6.0 * radius / (3.0 + sine)),
        (diagonal(0.1, 0.0, -0.1), ROOT_3 * radius),
        (skew, ROOT_3 * radius),
    ];
    for (l, exact) in cases {
        let mut points = pressed(&rock, p);
        shear(&rock, &mut points, &l, 100);
        assert_near(equivalent(&points), exact, 1e-9, "hexagon");
        assert_near(points.pressure[0], p, 1e-12, "pressure");
    }
}

/// A cone has no one angle of friction: that of its Mohr circle is least in triaxial compression and largest in extension, and in
/// plane strain `sin φ = μ`. On a slope of matter that flows down along it the tangent is μ. The hexagon has one angle in all of them.
#[test]
fn a_cone_has_three_angles_of_friction_and_the_hexagon_one() {
    let friction = 0.77;
    let cone = of(Strength::DruckerPrager(DruckerPrager {
        shear_modulus: G,
        cohesion: 0.0,
        friction,
        max_strength: 1e12,
    }));
    let hexagon = of(Strength::MohrCoulomb(MohrCoulomb {
        shear_modulus: G,
        cohesion: 0.0,
        friction,
        tensile_strength: 0.0,
    }));
    let sine = |rock: &Material, l: &Matrix3<f64>| {
        let mut points = pressed(rock, 10e6);
        shear(rock, &mut points, &(0.05 * l), 200);
        let total = stress(&points) - Matrix3::identity() * points.pressure[0];
        let of = total.symmetric_eigenvalues();
        (of.max() - of.min()) / -(of.max() + of.min())
    };
    let root = 3.0_f64.sqrt();
    let closed = |sign: f64| 3.0 * root * friction / (6.0 + sign * root * friction);
    let plane = diagonal(1.0, -1.0, 0.0);
    let simple = Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (l, exact) in [
        (diagonal(-1.0, 0.5, 0.5), closed(1.0)),
        (plane, friction),
        (diagonal(1.0, -0.5, -0.5), closed(-1.0)),
    ] {
        assert_near(sine(&cone, &l), exact, 1e-3, "cone");
        assert_near(
            sine(&hexagon, &l),
            libm::sin(libm::atan(friction)),
            1e-3,
            "hexagon",
        );
    }
    let mut points = pressed(&cone, 10e6);
    shear(&cone, &mut points, &(0.05 * simple), 200);
    let total = stress(&points) - Matrix3::identity() * points.pressure[0];
    assert_near(total[(0, 1)] / -total[(1, 1)], friction, 0.02, "a slope");
}

/// No principal stress exceeds the bound of tension, and no mean tension that of the tip.
#[test]
fn a_bound_of_tension_holds_in_all_directions() {
    let rock = of(Strength::MohrCoulomb(PYRAMID));
    for l in [
        diagonal(0.01, 0.0, 0.0),
        diagonal(0.01, 0.01, 0.0),
        diagonal(0.01, 0.01, 0.01),
        diagonal(0.01, -0.005, 0.0),
    ] {
        let mut points = pressed(&rock, 0.0);
        for _ in 0..100 {
            step(&rock, &mut points, &l, 0.01);
            let sigma = stress(&points) - Matrix3::identity() * points.pressure[0];
            let most = sigma.symmetric_eigen().eigenvalues.max();
            assert!(most <= PYRAMID.tensile_strength * (1.0 + 1e-12), "{most}");
        }
    }
}

/// Sand bears no tension, and friction again as soon as it is pressed.
#[test]
fn sand_bears_friction_and_no_tension() {
    let cohesionless = [
        Strength::DruckerPrager(DruckerPrager {
            cohesion: 0.0,
            ..CONE
        }),
        Strength::MohrCoulomb(MohrCoulomb {
            cohesion: 0.0,
            ..PYRAMID
        }),
        Strength::Lundborg(Lundborg {
            cohesion: 0.0,
            ..CURVE
        }),
        Strength::Collins(Collins {
            cohesion: 0.0,
            ..ROCK
        }),
    ];
    for strength in cohesionless {
        let sand = of(strength);
        let mut points = pressed(&sand, 20e6);
        shear(&sand, &mut points, &diagonal(-0.01, 0.005, 0.005), 50);
        let held = equivalent(&points);
        assert!(held > 15e6, "{held}");
        shear(&sand, &mut points, &diagonal(0.02, 0.02, 0.02), 100);
        assert_eq!(points.pressure, [0.0; LANES]);
        assert_eq!(points.deviatoric_stress, [[0.0; LANES]; 6]);
        assert!(points.density[0] < 0.95 * RHO);
        // It closes before it bears, and then bears as before.
        shear(&sand, &mut points, &diagonal(-0.02, -0.02, -0.02), 100);
        assert_near(points.pressure[0], 20e6, 1e-9, "pressure");
        shear(&sand, &mut points, &diagonal(-0.01, 0.005, 0.005), 50);
        assert_near(equivalent(&points), held, 1e-6, "friction");
        // Spray is no thinner than a tenth.
        shear(&sand, &mut points, &diagonal(3.0, 3.0, 3.0), 1000);
        assert!(points.density[0] >= 0.1 * RHO * (1.0 - 1e-12));
    }
}

/// A shear strength (Pa) by pressure (Pa).
type Curve = fn(f64) -> f64;

/// Rock that has failed has the friction of its pieces and no tension.
#[test]
fn failed_rock_keeps_friction() {
    let laws = Failure {
        collins: Some(CollinsFailure {
            brittle_ductile: 2.7e9,
            brittle_plastic: 4.1e9,
        }),
        ..Failure::NONE
    };
    let strengths: [(Strength, Curve); 3] = [
        (Strength::Collins(ROCK), |p| 0.8 * p),
        (Strength::DruckerPrager(CONE), |p| 0.6 * p),
        (Strength::Lundborg(CURVE), |p| {
            2.0 * p / (1.0 + 2.0 * p / 1.41e9)
        }),
    ];
    for (strength, damaged) in strengths {
        let rock = failing(strength, &laws);
        for p in [10e6, 100e6, 500e6] {
            let mut points = pressed(&rock, p);
            shear(&rock, &mut points, &diagonal(-0.2, 0.1, 0.1), 400);
            assert_eq!(points.damage[0], 1.0);
            assert_near(points.pressure[0], p, 1e-9, "pressure");
            assert_near(equivalent(&points), ROOT_3 * damaged(p), 1e-9, "friction");
            let sound = (K + G * (4.0 / 3.0)) / points.density[0];
            assert_near(points.sound_speed[0], sound.sqrt(), 1e-12, "sound");
            // Pulled, it bears nothing.
            shear(&rock, &mut points, &diagonal(0.02, 0.02, 0.02), 100);
            assert_eq!(points.pressure, [0.0; LANES]);
            assert_eq!(points.deviatoric_stress, [[0.0; LANES]; 6]);
        }
    }
    // Without friction it is a fluid, as other materials are.
    let mut rock = failing(Strength::Collins(ROCK), &laws);
    rock.failure.options.effect = Effect::StrengthLost;
    let mut points = pressed(&rock, 100e6);
    shear(&rock, &mut points, &diagonal(-0.2, 0.1, 0.1), 400);
    assert_eq!(points.deviatoric_stress, [[0.0; LANES]; 6]);
}

/// Half damaged, the strength of rock lies half-way between its curves.
#[test]
fn damage_joins_the_curves() {
    for damage in [0.0, 0.3, 0.5, 1.0] {
        let p = 150e6;
        let rock = failing(Strength::Collins(ROCK), &Failure::NONE);
        let mut points = pressed(&rock, p);
        points.damage = [damage; LANES];
        shear(&rock, &mut points, &diagonal(-0.2, 0.1, 0.1), 50);
        let intact = 90e6 + 300e6 / (1.0 + 300e6 / 1.41e9);
        let exact = ROOT_3 * ((1.0 - damage) * intact + damage * 120e6);
        assert_near(equivalent(&points), exact, 1e-12, "strength");
    }
    // The damaged curve is nowhere above the intact one.
    assert_eq!(ROCK.shear_strength(5e9, 1.0), ROCK.shear_strength(5e9, 0.0));
}

/// Damage is the plastic strain over the failure strain of the pressure.
#[test]
fn shear_damages_by_pressure() {
    let ivanov = Ivanov {
        least_strain: 1e-4,
        slope: 1e-11,
        pressure: 300e6,
    };
    let collins = CollinsFailure {
        brittle_ductile: 2.7e9,
        brittle_plastic: 4.1e9,
    };
    let cases = [
        (0.1e9, 1e-4, 0.01 + 0.04 / 27.0),
        (1.0e9, 7e-3, 0.01 + 0.4 / 27.0),
        (3.4e9, 3.1e-2, 0.075),
        (8.2e9, 7.9e-2, 0.6),
    ];
    for (p, by_ivanov, by_collins) in cases {
        assert_near(ivanov.failure_strain(p), by_ivanov, 1e-12, "Ivanov");
        assert_near(collins.failure_strain(p), by_collins, 1e-12, "Collins");
        let laws = [
            Failure {
                ivanov: Some(ivanov),
                ..Failure::NONE
            },
            Failure {
                collins: Some(collins),
                ..Failure::NONE
            },
        ];
        for (laws, strain) in laws.into_iter().zip([by_ivanov, by_collins]) {
            // A strength that damage leaves alone: else what is elastic becomes plastic at once.
            let mut rock = of(Strength::VonMises(VonMises {
                shear_modulus: G,
                yield_stress: 100e6,
                hardening_modulus: 0.0,
            }));
            rock.failure = laws;
            let mut points = pressed(&rock, p);
            // Elastic up to yield, and then half of the failure strain.
            let elastic = 100e6 / (3.0 * G);
            let l = diagonal(-elastic, 0.5 * elastic, 0.5 * elastic);
            shear(&rock, &mut points, &l, 100);
            assert!(points.damage[0] < 1e-6);
            let half = 0.5 * strain;
            shear(
                &rock,
                &mut points,
                &diagonal(-half, 0.5 * half, 0.5 * half),
                400,
            );
            let plastic = points.plastic_strain[0];
            assert_near(points.damage[0], plastic / strain, 1e-9, "damage");
            assert!((points.damage[0] - 0.5).abs() < 5e-3);
        }
    }
}

fn equivalent_at_yield(p: f64) -> f64 {
    ROOT_3 * (90e6 + 2.0 * p / (1.0 + 2.0 * p / 1.41e9))
}

/// Rock softens by Ohnaka's law, and its melting temperature grows by Simon's.
#[test]
fn heat_softens_rock() {
    let law = Collins {
        softening: 1.2,
        simon_a: 6e9,
        simon_c: 3.0,
        ..ROCK
    };
    let mut rock = of(Strength::Collins(law));
    let constants = ThermalConstants {
        specific_heat: 1000.0,
        reference_temperature: 300.0,
        melting_temperature: Some(1673.0),
        taylor_quinney: 1.0,
    };
    rock.thermal = Some(Thermal::new(constants, RHO, &rock.eos));
    for p in [0.5e9, 6e9] {
        let melting = 1673.0 * libm::cbrt(1.0 + p / 6e9);
        assert_near(law.melting_at(1673.0, p), melting, 1e-14, "melting");
        for temperature in [300.0, 1000.0, 1600.0, 2500.0_f64] {
            let mut points = pressed(&rock, p);
            let density = points.density[0];
            let energy = rock.energy(density, temperature).unwrap();
            points.specific_energy = [energy; LANES];
            shear(&rock, &mut points, &diagonal(-0.2, 0.1, 0.1), 50);
            let soft = libm::tanh(1.2 * (melting / temperature - 1.0)).max(0.0);
            let exact = soft * equivalent_at_yield(p);
            let found = equivalent(&points);
            assert!(
                (found - exact).abs() < 1e-6 * equivalent_at_yield(p),
                "{found} {exact}"
            );
        }
    }
}

/// A spall limit opens rock by its fracture energy, and what has opened keeps friction.
#[test]
fn rock_tears_by_its_fracture_energy() {
    let mut laws = Failure {
        spall: Some(Spall {
            pressure: -10e6,
            after: AfterSpall::Failed,
        }),
        ..Failure::NONE
    };
    laws.options.fracture_energy = 50.0;
    let rock = failing(Strength::Collins(ROCK), &laws);
    let size: f64 = 1e-3;
    let mut points = pressed(&rock, 0.0);
    points.mass = [RHO * size * size * size; LANES];
    let (mut work, dt) = (0.0, 1e-9);
    for _ in 0..20_000 {
        let before = points.pressure[0];
        step(&rock, &mut points, &(Matrix3::identity() * 4e3), dt);
        work -= 0.5 * (before + points.pressure[0]) * 3.0 * 4e3 * dt;
    }
    assert_eq!(points.damage[0], 1.0);
    // What was elastic at the onset is spent besides.
    let elastic = 0.5 * 10e6 * 10e6 / K;
    assert_near(work - elastic, 50.0 / size, 0.01, "fracture energy");
    points.density = [RHO * libm::exp(100e6 / K); LANES];
    shear(&rock, &mut points, &diagonal(-0.2, 0.1, 0.1), 50);
    assert_near(equivalent(&points), ROOT_3 * 80e6, 1e-9, "friction");
}

/// Flaws and the largest principal stress break rock in tension; shear under pressure is still that of the curves.
#[test]
fn cracks_and_tension_go_with_friction() {
    let cracks = Failure {
        grady_kipp: Some(GradyKipp {
            k: 4e35,
            m: 9.0,
            crack_speed: 0.4,
            crosses: Crosses::Particle,
            flaws: Flaws::Continuous,
            most_flaws: 0.0,
            least_size: 0.0,
        }),
        ..Failure::NONE
    };
    let tension = Failure {
        principal_stress: Some(PrincipalStress { limit: 20e6 }),
        ..Failure::NONE
    };
    for laws in [cracks, tension] {
        let rock = failing(Strength::Collins(ROCK), &laws);
        let mut points = pressed(&rock, 0.0);
        points.mass = [RHO * 1e-9; LANES];
        let (mut most, dt) = (0.0_f64, 1e-9);
        for _ in 0..40_000 {
            step(&rock, &mut points, &diagonal(100.0, -20.0, -20.0), dt);
            most = most.max(stress(&points)[(0, 0)] - points.pressure[0]);
        }
        assert_eq!(points.damage[0], 1.0);
        assert!(most > 15e6 && most < 60e6, "{most}");
        assert_eq!(points.pressure, [0.0; LANES]);
        assert_eq!(points.deviatoric_stress, [[0.0; LANES]; 6]);
        points.density = [RHO * libm::exp(100e6 / K); LANES];
        shear(&rock, &mut points, &diagonal(-0.2, 0.1, 0.1), 50);
        assert_near(equivalent(&points), ROOT_3 * 80e6, 1e-9, "friction");
    }
}

/// A step of no time changes no state.
#[test]
fn a_step_of_no_time_keeps_every_bit() {
    for strength in [
        Strength::DruckerPrager(CONE),
        Strength::MohrCoulomb(PYRAMID),
        Strength::Lundborg(CURVE),
        Strength::Collins(ROCK),
    ] {
        let rock = of(strength);
        let mut points = pressed(&rock, 10e6);
        points.deviatoric_stress[0] = [1e9; LANES];
        points.deviatoric_stress[1] = [-1e9; LANES];
        let before = points;
        rock.update(&mut points, 0.0);
        assert_eq!(points.deviatoric_stress, before.deviatoric_stress);
        assert_eq!(points.plastic_strain, before.plastic_strain);
    }
}

/// Lanes do not see each other: a batch of eight states gives what each gives alone.
#[test]
fn points_of_a_batch_are_apart() {
    let law = Collins {
        softening: 1.2,
        simon_a: 6e9,
        simon_c: 3.0,
        ..ROCK
    };
    let heat = ThermalConstants {
        specific_heat: 1000.0,
        reference_temperature: 300.0,
        melting_temperature: Some(1673.0),
        taylor_quinney: 1.0,
    };
    for strength in [
        Strength::DruckerPrager(CONE),
        Strength::MohrCoulomb(PYRAMID),
        Strength::Lundborg(CURVE),
        Strength::Collins(law),
    ] {
        let mut rock = of(strength);
        rock.thermal = Some(Thermal::new(heat, RHO, &rock.eos));
        let mut all = batch(RHO, 0.0);
        for (k, strain) in [-0.01, -0.001, 0.0, 1e-4, 0.001, 0.01, 0.1, 0.3]
            .into_iter()
            .enumerate()
        {
            all.density[k] = RHO * (1.0 + strain);
            all.specific_energy[k] = 1e5 * strain.abs();
            all.damage[k] = strain.abs();
            all.deviatoric_stress[3][k] = 1e9 * (strain + 0.01);
        }
        let alone: Vec<PointBatch> = (0..LANES)
            .map(|k| {
                let mut one = batch(all.density[k], all.specific_energy[k]);
                one.damage = [all.damage[k]; LANES];
                one.deviatoric_stress[3] = [all.deviatoric_stress[3][k]; LANES];
                step(&rock, &mut one, &diagonal(1.0, -2.0, 0.5), 1e-3);
                one
            })
            .collect();
        step(&rock, &mut all, &diagonal(1.0, -2.0, 0.5), 1e-3);
        for (k, one) in alone.iter().enumerate() {
            assert_eq!(all.pressure[k], one.pressure[0]);
            assert_eq!(all.plastic_strain[k], one.plastic_strain[0]);
            for c in 0..6 {
                assert_eq!(all.deviatoric_stress[c][k], one.deviatoric_stress[c][0]);
            }
        }
    }
}
