//! Concrete of Riedel, Hiermaier and Thoma: failure surface, rate, hardening, damage and tension.

use crate::support::{batch, equivalent, material, step};
use material::{
    Effect, Eos, LANES, Material, Polynomial, RiedelHiermaierThoma, RiedelHiermaierThomaFailure,
    Strength, library,
};
use nalgebra::{Matrix3, Vector3};

const RHO: f64 = 2314.0;
const K: f64 = 35.27e9;
const FC: f64 = 35e6;

fn law() -> RiedelHiermaierThoma {
    match library::find("concrete-35").unwrap().strength {
        Strength::RiedelHiermaierThoma(law) => law,
        _ => unreachable!(),
    }
}

/// Without pores, of a law.
fn concrete(law: RiedelHiermaierThoma) -> Material {
    let eos = Eos::Polynomial(Polynomial {
        k1: K,
        k2: 0.0,
        k3: 0.0,
        gamma0: 0.0,
    });
    let mut concrete = material(RHO, eos, Strength::RiedelHiermaierThoma(law));
    concrete.failure.options.effect = Effect::FrictionKept;
    concrete
}

/// Of a slow test, at rates below both references.
fn slow() -> Material {
    concrete(RiedelHiermaierThoma {
        reference_compression: 1e9,
        reference_tension: 1e9,
        ..law()
    })
}

/// Equivalent stress (Pa) that eight points bear at a pressure (Pa), sheared along principal rates far beyond yield.
fn borne(concrete: &Material, pressure: f64, rates: [f64; 3], damage: f64) -> f64 {
    let mut points = batch(RHO * (1.0 + pressure / K), 0.0);
    points.damage = [damage; LANES];
    // All hardening is done.
    points.plastic_strain = [0.1; LANES];
    let l = Matrix3::from_diagonal(&Vector3::from(rates));
    step(concrete, &mut points, &l, 0.05 / l.norm());
    equivalent(&points)
}

const COMPRESSION: [f64; 3] = [-1.0, 0.5, 0.5];
const TENSION: [f64; 3] = [1.0, -0.5, -0.5];
const SHEAR: [f64; 3] = [1.0, -1.0, 0.0];

/// The surface goes through the strengths of the tests that define it, and is continuous where its branches meet.
#[test]
fn the_surface_has_the_strengths_of_its_tests() {
    let concrete = slow();
    let near = |a: f64, b: f64, what: &str| assert!((a / b - 1.0).abs() < 1e-6, "{what}: {a} {b}");
    near(
        borne(&concrete, FC / 3.0, COMPRESSION, 0.0),
        FC,
        "uniaxial compression",
    );
    near(borne(&concrete, 0.0, SHEAR, 0.0), 0.18 * FC, "shear");
    // The third of the uniaxial strength in tension, of the meridian of tension.
    near(
        borne(&concrete, -0.1 * FC / 3.0, TENSION, 0.0),
        0.1 * FC,
        "uniaxial tension",
    );
    for p in [0.0, FC / 3.0] {
        let [below, above] = [-1.0, 1.0].map(|side| borne(&concrete, p + side, COMPRESSION, 0.0));
        assert!((below - above).abs() < 40.0, "{p}: {below} {above}");
    }
    // Far above.
    let p = 10.0 * FC;
    let power = 10.0 - 1.0 / 3.0 + libm::pow(1.6, -1.0 / 0.61);
    let exact = 1.6 * FC * libm::pow(power, 0.61);
    near(borne(&concrete, p, COMPRESSION, 0.0), exact, "compression");
    let q = 0.6805 + 0.0105 * 10.0;
    near(
        borne(&concrete, p, TENSION, 0.0),
        q * exact,
        "tension under pressure",
    );
    let friction = 1.6 * FC * libm::pow(10.0, 0.61);
    near(
        borne(&concrete, p, COMPRESSION, 0.4),
        0.6 * exact + 0.4 * friction,
        "damage",
    );
    near(borne(&concrete, p, TENSION, 1.0), friction, "friction");
}

/// Concretes of the library fail in uniaxial compression at the strengths of their names, and follow the rate by exponents of these.
#[test]
fn concretes_have_the_strengths_of_their_names() {
    for (name, megapascals) in [("concrete-35", 35.0), ("concrete-140", 140.0)] {
        let Strength::RiedelHiermaierThoma(law) = library::find(name).unwrap().strength else {
            unreachable!()
        };
        let strength = 1e6 * megapascals;
        let usual = [4.0 / (20.0 + 3.0 * megapascals), 2.0 / (20.0 + megapascals)];
        for (exponent, usual) in [law.rate_compression, law.rate_tension].iter().zip(usual) {
            assert!(
                (exponent / usual - 1.0).abs() < 0.02,
                "{name}: {exponent} {usual}"
            );
        }
        let slow = concrete(RiedelHiermaierThoma {
            reference_compression: 1e9,
            reference_tension: 1e9,
            ..law
        });
        let found = borne(&slow, strength / 3.0, COMPRESSION, 0.0);
        assert!((found / strength - 1.0).abs() < 1e-6, "{name}: {found}");
    }
}

/// The rate multiplies the strength in uniaxial compression and tension by its factors.
#[test]
fn the_rate_multiplies_the_strength() {
    let concrete = concrete(law());
    let shown = |along: [f64; 3], rate: f64| {
        // The equivalent rate of (1, −½, −½) is its first component.
        let rates = along.map(|part| part * rate);
        let (sign, exponent, reference, share) = if along[0] < 0.0 {
            (1.0, 0.032, 3e-5, 1.0)
        } else {
            (-1.0, 0.036, 3e-6, 0.1)
        };
        let factor = libm::pow(rate / reference, exponent);
        let strength = factor * share * FC;
        let found = borne(&concrete, sign * strength / 3.0, rates, 0.0);
        assert!(
            (found / strength - 1.0).abs() < 1e-6,
            "{along:?} {rate}: {found} {strength}"
        );
    };
    for rate in [1e-4, 1.0, 1e3] {
        shown(COMPRESSION, rate);
        shown(TENSION, rate);
    }
}

/// Compression at constant pressure: elastic to 53 % of the strength, then with half of the modulus, then damage.
#[test]
fn it_hardens_and_then_breaks() {
    let mut concrete = slow();
    let law = RiedelHiermaierThomaFailure {
        d1: 0.04,
        d2: 1.0,
        least_strain: 0.01,
    };
    concrete.failure.riedel_hiermaier_thoma = Some(law);
    let p = 2.0 * FC;
    let g = 16.7e9;
    let strength = 1.6 * FC * libm::pow(2.0 - 1.0 / 3.0 + libm::pow(1.6, -1.0 / 0.61), 0.61);
    let begins = 0.53 * strength;
    let friction = 1.6 * FC * libm::pow(2.0, 0.61);
    let hardened = (strength - begins) / (3.0 * g);
    let tip = {
        let q1 = {
            let (c, q) = (0.75_f64.sqrt(), 0.6805);
            let wide = 4.0 * (1.0 - q * q) * c * c;
            (2.0 * (1.0 - q * q) * c + (2.0 * q - 1.0) * (wide + 5.0 * q * q - 4.0 * q).sqrt())
                / (wide + (1.0 - 2.0 * q) * (1.0 - 2.0 * q))
        };
        0.6805 * 0.18 * 0.1 / (3.0 * (q1 * 0.1 - 0.6805 * 0.18))
    };
    let failure = f64::max(0.04 * (2.0 - tip), 0.01);
    let mut points = batch(RHO * (1.0 + p / K), 0.0);
    // Strain e of (−1, ½, ½) has the equivalent stress 3 G e.
    let rate = 1e-6;
    let l = Matrix3::from_diagonal(&Vector3::new(-rate, 0.5 * rate, 0.5 * rate));
    let mut broke = 0;
    for n in 1..=60_000 {
        step(&concrete, &mut points, &l, 2.0);
        let e = f64::from(n) * 2.0 * rate;
        let elastic = 3.0 * g * e;
        let q = equivalent(&points);
        let plastic = points.plastic_strain[0];
        if elastic < begins {
            assert!((q / elastic - 1.0).abs() < 1e-6);
        } else if plastic < hardened {
            let exact = begins + 0.5 * (elastic - begins);
            assert!((q / exact - 1.0).abs() < 1e-4, "{e}: {q} {exact}");
            assert_eq!(points.damage[0], 0.0);
        } else if points.damage[0] < 1.0 {
            let damage = (plastic - hardened) / failure;
            assert!(
                (points.damage[0] - damage).abs() < 1e-3,
                "{} {damage}",
                points.damage[0]
            );
            let exact = strength + (friction - strength) * points.damage[0];
            assert!((q / exact - 1.0).abs() < 1e-3, "{q} {exact}");
        } else {
            broke += 1;
        }
    }
    assert!(broke > 100, "{broke}");
    assert!((equivalent(&points) / friction - 1.0).abs() < 1e-6);
}

/// The tip of the surface bounds the tension, and the rate raises it.
#[test]
fn tension_ends_at_the_tip() {
    let tip = law().tension();
    assert!(tip < -0.05 && tip > -0.1, "{tip}");
    for (concrete, rate, factor) in [
        (slow(), 1e-3, 1.0),
        (concrete(law()), 1e3, libm::pow(1e3 / 3e-6, 0.036)),
    ] {
        let mut points = batch(RHO * 0.99, 0.0);
        let l = Matrix3::from_diagonal(&Vector3::new(rate, -0.5 * rate, -0.5 * rate));
        step(&concrete, &mut points, &l, 1e-9);
        let exact = factor * tip * FC;
        assert!(
            (points.pressure[0] / exact - 1.0).abs() < 1e-6,
            "{} {exact}",
            points.pressure[0]
        );
    }
}
