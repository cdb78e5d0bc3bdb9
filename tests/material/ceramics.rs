//! Ceramics of Johnson and Holmquist: single elements in uniaxial strain, bulking, strength at rates; concrete of Holmquist,
//! Johnson and Cook; the polynomial equation of state.

use crate::support::{batch, equivalent, material, step, stress};
use material::{
    Effect, Eos, HolmquistJohnsonCook, HolmquistJohnsonCookFailure, JohnsonHolmquist2,
    JohnsonHolmquist2Failure, LANES, Material, PointBatch, Polynomial, Strength, library,
};
use nalgebra::{Matrix3, Vector3};

const RHO: f64 = 3700.0;
const K1: f64 = 130.95e9;
const G: f64 = 90.16e9;

/// The alumina of the single elements of Johnson & Holmquist (1994): `[B, M]` and `[D₁, D₂]` differ between their cases.
fn alumina([b, m]: [f64; 2], [d1, d2]: [f64; 2]) -> Material {
    let eos = Eos::Polynomial(Polynomial {
        k1: K1,
        k2: 0.0,
        k3: 0.0,
        gamma0: 0.0,
    });
    let strength = Strength::JohnsonHolmquist2(JohnsonHolmquist2 {
        shear_modulus: G,
        a: 0.93,
        b,
        c: 0.0,
        m,
        n: 0.6,
        max_tension: 0.2e9,
        hugoniot_limit: 2.79e9,
        hugoniot_pressure: 1.46e9,
        max_fractured: 0.0,
        reference_rate: 1.0,
    });
    let mut alumina = material(RHO, eos, strength);
    alumina.failure.johnson_holmquist_2 = Some(JohnsonHolmquist2Failure {
        d1,
        d2,
        bulking: 1.0,
    });
    alumina.failure.options.effect = Effect::FrictionKept;
    alumina
}

const CASES: [([f64; 2], [f64; 2]); 3] = [
    ([0.0, 0.0], [0.0, 0.0]),
    ([0.31, 0.6], [0.0, 0.0]),
    ([0.31, 0.6], [0.005, 1.0]),
];

const LIMIT: f64 = 1.5 * (2.79e9 - 1.46e9);

fn intact(p: f64) -> f64 {
    LIMIT * 0.93 * libm::pow(((p + 0.2e9) / 1.46e9).max(0.0), 0.6)
}

/// The same element integrated apart from the program, in true strain: pressure, axial stress deviator, bulking, damage.
#[derive(Default)]
struct Element {
    strain: f64,
    deviator: f64,
    bulking: f64,
    damage: f64,
    pressure: f64,
}

impl Element {
    fn advance(&mut self, increment: f64, [b, m]: [f64; 2], [d1, d2]: [f64; 2]) {
        self.strain += increment;
        let mu = libm::exp(-self.strain) - 1.0;
        let mut pressure = (K1 * mu + self.bulking).max(-0.2e9);
        if pressure < 0.0 {
            pressure *= 1.0 - self.damage;
        }
        self.deviator += 4.0 / 3.0 * G * increment;
        let fractured = LIMIT * b * libm::pow((pressure / 1.46e9).max(0.0), m);
        let fractured = if b == 0.0 { 0.0 } else { fractured };
        let at = |damage: f64| intact(pressure) - damage * (intact(pressure) - fractured);
        let q = 1.5 * self.deviator.abs();
        let strength = at(self.damage);
        if q > strength {
            self.deviator *= strength / q;
            let plastic = (q - strength) / (3.0 * G);
            let failure = d1 * libm::pow(((pressure + 0.2e9) / 1.46e9).max(0.0), d2);
            let damage = if self.damage < 1.0 {
                (self.damage + plastic / failure).min(1.0)
            } else {
                1.0
            };
            let lost = (at(self.damage).powi(2) - at(damage).powi(2)) / (6.0 * G);
            if mu >= 0.0 && lost > 0.0 {
                let cold = K1 * mu;
                let square = (cold + self.bulking).powi(2) + 2.0 * K1 * lost;
                let bulking = square.sqrt() - cold;
                pressure += bulking - self.bulking;
                self.bulking = bulking;
            }
            self.damage = damage;
        }
        self.pressure = pressure;
    }
}

/// Axial stress (Pa, compression positive) of the last lane.
fn axial(points: &PointBatch) -> f64 {
    points.pressure[LANES - 1] - stress(points)[(0, 0)]
}

/// Compression to 5 % of volume and release: at each of 100 strains the program, in steps ten times as long, and the
/// integration apart from it agree within one per cent of the largest stress.
#[test]
fn single_elements_follow_the_integration() {
    for (fractured, damage) in CASES {
        let ceramic = alumina(fractured, damage);
        let mut points = batch(RHO, 0.0);
        let mut element = Element::default();
        let (most, steps) = (0.05, 2000);
        let mut largest = 0.0_f64;
        for n in 0..2 * steps {
            let sign = if n < steps { -1.0 } else { 1.0 };
            let increment = sign * most / f64::from(steps);
            let l = Matrix3::from_diagonal(&Vector3::new(increment, 0.0, 0.0));
            step(&ceramic, &mut points, &l, 1.0);
            for _ in 0..10 {
                element.advance(0.1 * increment, fractured, damage);
            }
            let exact = element.pressure - element.deviator;
            largest = largest.max(exact);
            if n % 40 == 39 {
                let found = axial(&points);
                assert!(
                    (found - exact).abs() < 0.01 * largest,
                    "{fractured:?} {damage:?} {n}: {found} {exact}"
                );
                assert!((points.pressure[0] - element.pressure).abs() < 0.01 * largest);
                assert!((points.damage[0] - element.damage).abs() < 0.02);
            }
        }
        assert!(element.bulking > 0.0 && points.damage[0] > 0.1);
    }
}

/// Failure at once: what shear held presses from then on, by the energy of the yield point.
#[test]
fn bulking_is_that_of_the_energy_lost() {
    // q = 2 G ε = σ_i(K₁ μ) by bisection.
    let (mut low, mut high) = (0.0, 0.05);
    for _ in 0..100 {
        let strain: f64 = 0.5 * (low + high);
        if 2.0 * G * strain > intact(K1 * (libm::exp(strain) - 1.0)) {
            high = strain;
        } else {
            low = strain;
        }
    }
    let (q, cold) = (2.0 * G * low, K1 * (libm::exp(low) - 1.0));
    let exact = (cold * cold + 2.0 * K1 * q * q / (6.0 * G)).sqrt() - cold;
    let ceramic = alumina([0.0, 0.0], [0.0, 0.0]);
    let mut points = batch(RHO, 0.0);
    let l = Matrix3::from_diagonal(&Vector3::new(-1e-5, 0.0, 0.0));
    let mut most = 0.0_f64;
    for _ in 0..2000 {
        step(&ceramic, &mut points, &l, 1.0);
        most = most.max(equivalent(&points));
    }
    assert!((most / q - 1.0).abs() < 2e-3, "{most} {q}");
    assert!((points.bulking_pressure[0] / exact - 1.0).abs() < 5e-3);
    assert!(equivalent(&points) < 1.0);
    let mu = points.density[0] / RHO - 1.0;
    let pressure = K1 * mu + points.bulking_pressure[0];
    assert!((points.pressure[0] / pressure - 1.0).abs() < 1e-12);
    // A state read again has the same pressure.
    let before = points;
    ceramic.update(&mut points, 0.0);
    assert_eq!(points.pressure[0].to_bits(), before.pressure[0].to_bits());
    // Pulled, what is broken bears nothing, though it takes more room.
    let l = Matrix3::identity() * 1e-4;
    for _ in 0..1000 {
        step(&ceramic, &mut points, &l, 1.0);
    }
    assert!(points.pressure[0] == 0.0 && equivalent(&points) == 0.0);
}

/// Intact and fractured strength at pressures and rates, with the limit of the fractured one.
#[test]
fn strengths_are_those_of_the_card() {
    let mut carbide = library::find("boron-carbide").unwrap();
    carbide.failure.johnson_holmquist_2 = None;
    let limit = 1.5 * (19e9 - 8.71e9);
    for p in [1e9, 5e9, 20e9] {
        for rate in [1e-3, 1.0, 1e5] {
            let fast = 1.0 + 0.005 * libm::log(f64::max(rate, 1.0));
            let intact = limit * 0.927 * libm::pow((p + 0.26e9) / 8.71e9, 0.67) * fast;
            let broken = limit * f64::min(0.7 * libm::pow(p / 8.71e9, 0.85) * fast, 0.2);
            for (damage, exact) in [(0.0, intact), (0.5, 0.5 * (intact + broken)), (1.0, broken)] {
                let Eos::Polynomial(eos) = &carbide.eos else {
                    panic!("another equation of state");
                };
                // The compression at this pressure.
                let mut mu: f64 = 0.0;
                for _ in 0..60 {
                    let slope = eos.k1 + mu * (2.0 * eos.k2 + 3.0 * eos.k3 * mu);
                    let at = mu * (eos.k1 + mu * (eos.k2 + mu * eos.k3));
                    mu -= (at - p) / slope;
                }
                let mut points = batch(2510.0 * (1.0 + mu), 0.0);
                points.damage = [damage; LANES];
                let l = Matrix3::from_diagonal(&Vector3::new(-rate, 0.5 * rate, 0.5 * rate));
                step(&carbide, &mut points, &l, 0.2 / rate);
                assert!(
                    (equivalent(&points) / exact - 1.0).abs() < 1e-6,
                    "{p} {rate} {damage}"
                );
            }
        }
    }
}

/// Slope and sound speed of the polynomial are those of its pressure, and it is linear in tension.
#[test]
fn the_polynomial_is_its_own_slope() {
    let eos = Eos::Polynomial(Polynomial {
        k1: 45.4e9,
        k2: -138e9,
        k3: 290e9,
        gamma0: 0.5,
    });
    for mu in [-0.05, 0.0, 0.02, 0.3] {
        let at = |mu: f64, e: f64| eos.at(2530.0, 2530.0 * (1.0 + mu), e);
        let slope = (at(mu + 1e-6, 1e5).pressure - at(mu - 1e-6, 1e5).pressure) / (2e-6 * 2530.0);
        assert!((at(mu, 1e5).dp_drho / slope - 1.0).abs() < 1e-5);
        let by_energy = (at(mu, 2e5).pressure - at(mu, 1e5).pressure) / 1e5;
        assert!((by_energy / (0.5 * 2530.0) - 1.0).abs() < 1e-9);
    }
    assert!((eos.at(2530.0, 2530.0 * 0.95, 0.0).pressure / (-0.05 * 45.4e9) - 1.0).abs() < 1e-12);
    let cubic = 0.1 * 45.4e9 - 0.01 * 138e9 + 0.001 * 290e9;
    assert!((eos.at(2530.0, 2530.0 * 1.1, 0.0).pressure / cubic - 1.0).abs() < 1e-12);
}

/// Concrete of 48 `MPa` of Holmquist, Johnson & Cook (1993), without pores: strength at pressures, rates and damages, its
/// limit, failure strains, and what is left of it.
#[test]
fn concrete_has_the_strength_of_its_card() {
    let eos = Eos::Polynomial(Polynomial {
        k1: 85e9,
        k2: 0.0,
        k3: 0.0,
        gamma0: 0.0,
    });
    let strength = Strength::HolmquistJohnsonCook(HolmquistJohnsonCook {
        shear_modulus: 14.86e9,
        a: 0.79,
        b: 1.6,
        c: 0.007,
        n: 0.61,
        compressive_strength: 48e6,
        max_tension: 4e6,
        max_strength: 7.0,
        reference_rate: 1.0,
    });
    let mut concrete = material(2440.0, eos, strength);
    concrete.failure.options.effect = Effect::FrictionKept;
    for p in [-2e6, 0.0, 10e6, 100e6, 1e9] {
        for rate in [0.1, 1e4] {
            for damage in [0.0, 0.4, 1.0] {
                let fast = 1.0 + 0.007 * libm::log(f64::max(rate, 1.0));
                let share = 0.79 * (1.0 - damage) * (1.0 + f64::min(p, 0.0) / 4e6);
                let power = 1.6 * libm::pow(f64::max(p, 0.0) / 48e6, 0.61);
                let exact = 48e6 * f64::min((share + power) * fast, 7.0);
                let mut points = batch(2440.0 * (1.0 + p / 85e9), 0.0);
                points.damage = [damage; LANES];
                let l = Matrix3::from_diagonal(&Vector3::new(-rate, 0.5 * rate, 0.5 * rate));
                step(&concrete, &mut points, &l, 0.05 / rate);
                assert!(
                    (equivalent(&points) - exact).abs() < 1e-6 * 48e6,
                    "{p} {rate} {damage}"
                );
            }
        }
    }
    let law = HolmquistJohnsonCookFailure {
        d1: 0.04,
        d2: 1.0,
        least_strain: 0.01,
    };
    concrete.failure.holmquist_johnson_cook = Some(law);
    assert!((law.failure_strain(52.0 / 48.0) - 0.04 * 52.0 / 48.0).abs() < 1e-15);
    assert!((law.failure_strain(0.05) - 0.01).abs() < 1e-15);
    // At 96 MPa: elastic up to yield, then damage by what is plastic, then the friction of what is broken.
    let p = 96e6;
    let mut points = batch(2440.0 * (1.0 + p / 85e9), 0.0);
    let l = Matrix3::from_diagonal(&Vector3::new(-1e-4, 0.5e-4, 0.5e-4));
    let mut last = 0.0;
    for _ in 0..2000 {
        step(&concrete, &mut points, &l, 1.0);
        let plastic = points.plastic_strain[0];
        let exact = f64::min(plastic / law.failure_strain(100.0 / 48.0), 1.0);
        assert!((points.damage[0] - exact).abs() < 1e-6);
        last = exact;
    }
    assert!((last - 1.0).abs() < 1e-12);
    let friction = 48e6 * 1.6 * libm::pow(2.0, 0.61);
    assert!((equivalent(&points) / friction - 1.0).abs() < 1e-6);
}
