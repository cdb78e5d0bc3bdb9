//! Porous matter: rest, crush curves, elastic lines, derivatives, strength and damage.

use crate::support::{material, step, tillotson};
use material::{
    Compaction, CompactionDamage, Effect, Elastic, Eos, EpsilonAlpha, Failure, GradyKipp,
    HolmquistJohnsonCookCompaction, LANES, Material, PAlpha, PointBatch, Porosity, Rest, Strength,
    StrengthOf, Value, VonMises, library,
};
use nalgebra::Matrix3;

/// Distension of the aluminium foam of Jutzi, Benz & Michel (2008), §5.1.
const ALPHA: f64 = 1.275;
/// Density of its solid (kg/m³).
const SOLID: f64 = 2700.0;

/// Their crush curve, with its elastic sound speed (m/s).
fn p_alpha(sound_speed: f64) -> PAlpha {
    PAlpha {
        elastic_pressure: 80e6,
        solid_pressure: 700e6,
        exponent: 2.0,
        transition_pressure: 0.0,
        transition_distension: 1.0,
        transition_exponent: 2.0,
        sound_speed,
    }
}

/// A steep beginning, as pumice has.
fn steep() -> PAlpha {
    PAlpha {
        exponent: 3.0,
        transition_pressure: 300e6,
        transition_distension: 1.1,
        transition_exponent: 12.0,
        ..p_alpha(4110.0)
    }
}

fn epsilon_alpha(sound_speed: f64) -> EpsilonAlpha {
    EpsilonAlpha {
        elastic_strain: -1e-3,
        transition_strain: -0.15,
        kappa: 0.98,
        sound_speed,
    }
}

/// A straight crush curve of the same pressures, as concrete has.
fn straight(sound_speed: f64) -> HolmquistJohnsonCookCompaction {
    HolmquistJohnsonCookCompaction {
        crush_pressure: 80e6,
        crush_strain: 80e6 * ALPHA / (SOLID * sound_speed * sound_speed),
        lock_pressure: 700e6,
    }
}

fn porous(law: Compaction, strength: Strength) -> Material {
    let eos = Eos::Tillotson(tillotson());
    let pores = Porosity::new(ALPHA, law, SOLID, &eos);
    assert_eq!(pores.law.contradicts(ALPHA, &pores.solid), None);
    Material {
        porosity: Some(pores.clone()),
        ..material(pores.density, eos, strength)
    }
}

/// All laws of compaction, with their names.
fn foams() -> Vec<(&'static str, Material)> {
    let laws = [
        ("rigid P-alpha", Compaction::PAlpha(p_alpha(0.0))),
        ("P-alpha", Compaction::PAlpha(p_alpha(4110.0))),
        ("steep P-alpha", Compaction::PAlpha(steep())),
        (
            "rigid epsilon-alpha",
            Compaction::EpsilonAlpha(epsilon_alpha(0.0)),
        ),
        (
            "epsilon-alpha",
            Compaction::EpsilonAlpha(epsilon_alpha(4110.0)),
        ),
        (
            "concrete",
            Compaction::HolmquistJohnsonCookCompaction(straight(4110.0)),
        ),
    ];
    laws.map(|(name, law)| (name, porous(law, Strength::None)))
        .into()
}

/// A point at this density (kg/m³) over that of the reference state, and specific energy (J/kg), after `before`.
fn at(foam: &Material, before: &PointBatch, ratio: f64, energy: f64) -> PointBatch {
    let mut point = *before;
    point.density = [ratio * foam.reference_density; LANES];
    point.specific_energy = [energy; LANES];
    foam.update(&mut point, 1e-9);
    point
}

/// `p = p_s(α ρ, e)/α` by the equation of state itself.
fn pressure(foam: &Material, point: &PointBatch) -> f64 {
    let alpha = point.distension[2];
    let solid = tillotson().response(
        foam.matter_density(),
        alpha * point.density[2],
        point.specific_energy[2],
    );
    solid.pressure / alpha
}

#[test]
fn virgin_matter_rests_and_has_the_sound_speed_that_is_stated() {
    for (name, foam) in foams() {
        let rest = Rest::of(&foam).unwrap_or_else(|| panic!("{name} has a pressure at rest"));
        let solid = foam.porosity.as_ref().unwrap().solid.sound_speed();
        let stated = if name.starts_with("rigid") {
            solid
        } else {
            4110.0
        };
        assert!(
            (rest.sound_speed / stated - 1.0).abs() < 1e-9,
            "{name}: {rest:?}"
        );
        assert!((foam.longitudinal_speed() / stated - 1.0).abs() < 1e-12);
        assert!((foam.reference_density * ALPHA / SOLID - 1.0).abs() < 1e-15);
        let point = at(&foam, &PointBatch::ZERO, 1.0, 0.0);
        assert_eq!((point.distension[5], point.compaction[5]), (ALPHA, 0.0));
    }
}

/// On the way the place on the curve is the same whatever the steps, and p, α and ρ satisfy the equation of state
/// and the crush curve.
#[test]
fn crushing_follows_its_curve_in_steps_of_any_size() {
    for (name, foam) in foams() {
        for end in [1.01, 1.05, 1.15, 1.25, 1.4, 1.8] {
            let whole = at(&foam, &PointBatch::ZERO, end, 3e4);
            let mut fine = PointBatch::ZERO;
            for n in 1..=200 {
                fine = at(&foam, &fine, 1.0 + (end - 1.0) * f64::from(n) / 200.0, 3e4);
            }
            for (a, b) in [
                (whole.pressure[2], fine.pressure[2]),
                (whole.distension[2], fine.distension[2]),
                (1.0 + whole.compaction[2], 1.0 + fine.compaction[2]),
            ] {
                assert!((a / b - 1.0).abs() < 1e-11, "{name} {end}: {a} {b}");
            }
            let of_state = pressure(&foam, &whole);
            let p = whole.pressure[2];
            assert!(
                (p / of_state - 1.0).abs() < 1e-11,
                "{name} {end}: {p} {of_state}"
            );
            assert!(whole.distension[2] >= 1.0);
            let pores = foam.porosity.as_ref().unwrap();
            if let (Compaction::PAlpha(law), true) = (&pores.law, name == "rigid P-alpha")
                && whole.compaction[2] > 0.0
            {
                let left = ((law.solid_pressure - p) / (law.solid_pressure - law.elastic_pressure))
                    .max(0.0);
                let alpha = 1.0 + (ALPHA - 1.0) * left * left;
                assert!((whole.distension[2] - alpha).abs() < 1e-9, "{name} {end}");
            }
        }
        // Dense and without pores.
        let dense = at(&foam, &PointBatch::ZERO, 1.8, 0.0);
        assert_eq!(
            (dense.compaction[0], dense.distension[0]),
            (1.0, 1.0),
            "{name}"
        );
    }
}

/// Pumice of the library crushes on the curve of Jutzi et al. (2009) before and beyond its transition, and what is dense has failed.
#[test]
fn pumice_crushes_on_its_curve() {
    let pumice = library::find("pumice").unwrap();
    for end in [1.4, 1.8, 2.2, 2.6, 3.2, 3.8, 4.3] {
        let point = at(&pumice, &PointBatch::ZERO, end, 0.0);
        let (p, alpha) = (point.pressure[2], point.distension[2]);
        let left = |to: f64, exponent: i32| ((to - p) / (to - 1e6)).max(0.0).powi(exponent);
        let exact = 1.0 + (4.64 - 1.9) * left(68e6, 12) + 0.9 * left(213e6, 3);
        assert!((alpha - exact).abs() < 1e-6, "{end}: {p} {alpha} {exact}");
        assert!(p > 1e6 && p < 213e6, "{end}: {p}");
    }
    let dense = at(&pumice, &PointBatch::ZERO, 5.0, 0.0);
    assert_eq!((dense.distension[0], dense.compaction[0]), (1.0, 1.0));
    assert!(dense.damage[0] > 0.999, "{}", dense.damage[0]);
}

/// The numbers of the curve of strain by hand: elastic, exponential, quadratic, dense.
#[test]
fn strain_tells_the_distension() {
    let foam = porous(Compaction::EpsilonAlpha(epsilon_alpha(0.0)), Strength::None);
    let alpha = |strain: f64| at(&foam, &PointBatch::ZERO, (-strain).exp(), 0.0).distension[0];
    let close = |strain: f64, exact: f64| {
        let found = alpha(strain);
        assert!((found - exact).abs() < 1e-12, "{strain}: {found} {exact}");
    };
    close(-5e-4, ALPHA);
    close(-0.1, ALPHA * (-0.98 * 0.099_f64).exp());
    let middle = ALPHA * (-0.98 * 0.149_f64).exp();
    close(-0.15, middle);
    let end = -0.15 + 2.0 * (1.0 - middle) / (0.98 * middle);
    let halfway = 0.5 * (end - 0.15);
    close(halfway, 1.0 + 0.25 * (middle - 1.0));
    close(end - 0.01, 1.0);
}

/// What is crushed stays so: release and reload run on the same line, and no step of zero changes a bit.
#[test]
fn compaction_is_for_good() {
    for (name, foam) in foams() {
        let crushed = at(&foam, &PointBatch::ZERO, 1.12, 2e4);
        assert!(
            crushed.compaction[1] > 0.0 && crushed.compaction[1] < 1.0,
            "{name}"
        );
        let mut point = crushed;
        for ratio in [1.118, 1.11, 1.1, 1.05, 1.11, 1.118] {
            point = at(&foam, &point, ratio, 2e4);
            assert_eq!(point.compaction, crushed.compaction, "{name} at {ratio}");
            assert!(point.distension[0] >= crushed.distension[0]);
            let mut again = point;
            foam.update(&mut again, 0.0);
            assert_eq!(again.compaction, point.compaction);
            assert_eq!(again.distension, point.distension);
            assert_eq!(again.pressure, point.pressure);
        }
        let back = at(&foam, &point, 1.12, 2e4);
        assert!(
            (back.pressure[0] / crushed.pressure[0] - 1.0).abs() < 1e-9,
            "{name}"
        );
        // Torn apart it keeps its pores, and the distension stays bounded.
        let torn = at(&foam, &point, 0.3, 2e4);
        assert!(torn.compaction == crushed.compaction && torn.pressure[0] < 0.0);
        assert!(
            torn.distension[0] < 2.0 * ALPHA,
            "{name}: {}",
            torn.distension[0]
        );
    }
}

/// The square of the sound speed is the elastic `∂p/∂ρ|ₛ` by differences, and no loading is stiffer.
#[test]
fn sound_is_the_elastic_slope_and_never_below_that_of_loading() {
    for (name, foam) in foams() {
        for (ratio, energy) in [(1.0, 1e3), (1.005, 0.0), (1.1, 4e4), (1.2, 5e4), (1.5, 2e5)] {
            let here = at(&foam, &PointBatch::ZERO, ratio, energy);
            let rho = here.density[0];
            let heat = here.pressure[0] / (rho * rho);
            let moved = |by: f64| {
                let energy = energy + heat * by * rho;
                at(&foam, &here, ratio * (1.0 + by), energy).pressure[0]
            };
            let down = (here.pressure[0] - moved(-1e-6)) / (1e-6 * rho);
            let square = here.sound_speed[0] * here.sound_speed[0];
            assert!(
                (square / down - 1.0).abs() < 1e-4,
                "{name} {ratio}: {square} {down}"
            );
            let up = (moved(1e-6) - here.pressure[0]) / (1e-6 * rho);
            assert!(up <= square * (1.0 + 1e-4), "{name} {ratio}: {square} {up}");
        }
    }
}

/// Elastic limit of the foam of Jutzi et al. (2008): density behind the precursor and its particle velocity,
/// computed from `c_e`, the jump conditions and the elastic line.
#[test]
fn precursor_of_the_published_foam() {
    let foam = porous(Compaction::PAlpha(p_alpha(4110.0)), Strength::None);
    let rho0 = foam.reference_density;
    let (mut low, mut high) = (1.0, 1.1);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let p = at(&foam, &PointBatch::ZERO, middle, 0.0).pressure[0];
        if p < 80e6 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let velocity = (80e6 / rho0 * (1.0 - 1.0 / low)).sqrt();
    assert!((low * rho0 - 2122.4).abs() < 0.1, "{}", low * rho0);
    assert!((velocity - 9.19).abs() < 0.02, "{velocity}");
    let speed = velocity / (1.0 - 1.0 / low);
    assert!((speed / 4110.0 - 1.0).abs() < 5e-3, "{speed}");
}

/// Constants of the whole act as without pores; those of the solid with 1/α of its stress, on the surface Y/α too.
/// Density of the whole and its modulus, where pores begin to crush, and where none is left.
#[test]
fn porous_materials_of_the_library_are_as_stated() {
    let table = [
        ("aluminium-foam", 2700.0 / 1.275, 4110.0, [80e6, 700e6]),
        ("regolith-jsc-1a", 2700.0 / 1.72, 1200.0, [100.0, 1.3e9]),
    ];
    for (name, density, sound_speed, pressures) in table {
        let material = library::find(name).unwrap();
        assert!((material.reference_density / density - 1.0).abs() < 1e-15);
        let pores = material.porosity.as_ref().unwrap();
        assert_eq!(pores.law.contradicts(pores.distension, &pores.solid), None);
        let modulus = density * sound_speed * sound_speed;
        assert!(
            (material.bulk_modulus() / modulus - 1.0).abs() < 1e-12,
            "{name}"
        );
        let solid = material.porosity.as_ref().unwrap().solid.density;
        for (share, crushes) in [(0.99, false), (1.01, true)] {
            let virgin = at(
                &material,
                &PointBatch::ZERO,
                1.0 + share * pressures[0] / modulus,
                0.0,
            );
            assert_eq!(virgin.compaction[0] > 0.0, crushes, "{name}");
        }
        // The solid has the pressure of the whole as soon as no pore is left.
        let [mut low, mut high] = [1.0, 2.0 * solid / density];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if at(&material, &PointBatch::ZERO, middle, 0.0).distension[0] > 1.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let crushed = at(&material, &PointBatch::ZERO, high, 0.0);
        let found = crushed.pressure[0];
        assert!((found / pressures[1] - 1.0).abs() < 1e-6, "{name}: {found}");
        let exact = material.eos.at(solid, crushed.density[0], 0.0).pressure;
        assert!(
            (found / exact - 1.0).abs() < 1e-6,
            "{name}: {found} {exact}"
        );
    }
    let regolith = library::find("regolith-jsc-1a").unwrap();
    let ratio = regolith.shear_modulus() / regolith.bulk_modulus();
    let poisson = (3.0 - 2.0 * ratio) / (6.0 + 2.0 * ratio);
    assert!((poisson - 0.3).abs() < 1e-3, "{poisson}");
}

#[test]
fn strength_of_the_matrix_is_spread_over_the_whole() {
    let (g, y) = (27e9, 0.29e9);
    let flow = Strength::VonMises(VonMises {
        shear_modulus: g,
        yield_stress: y,
        hardening_modulus: 0.0,
    });
    let shear = |rate: f64| Matrix3::new(0.0, rate, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (of, share) in [(StrengthOf::Whole, 1.0), (StrengthOf::Matrix, 1.0 / ALPHA)] {
        let mut foam = porous(Compaction::PAlpha(p_alpha(0.0)), flow.clone());
        foam.porosity.as_mut().unwrap().strength = of;
        assert!((foam.shear_modulus() / (g * share) - 1.0).abs() < 1e-15);
        let mut point = PointBatch {
            density: [foam.reference_density; LANES],
            ..PointBatch::ZERO
        };
        step(&foam, &mut point, &shear(1e-4), 1.0);
        let stress = point.deviatoric_stress[3][0];
        assert!((stress / (g * share * 1e-4) - 1.0).abs() < 1e-7, "{stress}");
        let square = foam.longitudinal_speed().powi(2);
        assert!((point.sound_speed[0].powi(2) / square - 1.0).abs() < 1e-9);
        step(&foam, &mut point, &shear(0.1), 1.0);
        let stress = point.deviatoric_stress[3][0];
        let s: f64 = (0..6)
            .map(|c| point.deviatoric_stress[c][0].powi(2) * if c < 3 { 1.0 } else { 2.0 })
            .sum();
        let q = (1.5 * s).sqrt();
        assert!((q / (y * share) - 1.0).abs() < 1e-9, "{stress} {q}");
        let before = point;
        foam.update(&mut point, 0.0);
        assert_eq!(point.deviatoric_stress, before.deviatoric_stress);
        // Uniaxial crushing strains the solid by less than the whole.
        let mut crushed = PointBatch {
            density: [foam.reference_density; LANES],
            ..PointBatch::ZERO
        };
        let squeeze = Matrix3::new(-1e-2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        step(&foam, &mut crushed, &squeeze, 1.0);
        step(&foam, &mut crushed, &squeeze, 1.0);
        assert!(crushed.compaction[0] > 0.0 && crushed.deviatoric_stress[0][0] < 0.0);
    }
}

/// Damage by crushing is 1 − (α − 1)/(α₀ − 1) but near its beginning, adds to other damage and ends at one.
#[test]
fn crushing_damages() {
    let elastic = Strength::Elastic(Elastic {
        shear_modulus: 20e9,
    });
    let mut foam = porous(Compaction::PAlpha(p_alpha(0.0)), elastic);
    foam.porosity.as_mut().unwrap().damage = CompactionDamage::Crushed;
    foam.failure.options.effect = Effect::Scaled;
    foam.failure = Failure {
        grady_kipp: Some(GradyKipp {
            k: 4e35,
            m: 9.0,
            crack_speed: 0.4,
            crosses: material::Crosses::Particle,
            flaws: material::Flaws::Drawn,
            most_flaws: 0.0,
            least_size: 0.0,
        }),
        ..foam.failure
    };
    let mut point = PointBatch::ZERO;
    let mut last = 0.0;
    for n in 1..=40 {
        point = at(&foam, &point, 1.0 + 0.01 * f64::from(n), 0.0);
        let damage = point.damage[0];
        assert!(damage >= last && damage <= 1.0);
        last = damage;
        let crushed = 1.0 - (point.distension[0] - 1.0) / (ALPHA - 1.0);
        let delta = 0.01_f64;
        let edge =
            ((crushed + delta).cbrt() - delta.cbrt()) / ((1.0 + delta).cbrt() - delta.cbrt());
        assert!((damage - edge.powi(3)).abs() < 1e-9, "{crushed}: {damage}");
    }
    assert_eq!(last, 1.0);
    let released = at(&foam, &point, 1.2, 0.0);
    assert_eq!(released.damage[0], 1.0);
}

#[test]
fn constants_are_listed_by_their_keys() {
    let foam = porous(Compaction::PAlpha(steep()), Strength::None);
    let constants = foam.constants();
    let found = |key: &str| constants.iter().find(|c| c.key == key).map(|c| c.value);
    assert_eq!(found("porosity.distension"), Some(Value::Number(ALPHA, "")));
    assert_eq!(
        found("porosity.p_alpha.solid_pressure"),
        Some(Value::Number(700e6, "Pa"))
    );
    let Some(Value::Number(density, _)) = found("density") else {
        panic!()
    };
    assert!((density / SOLID - 1.0).abs() < 1e-15);
}

#[test]
fn contradictions_are_found() {
    let eos = Eos::Tillotson(tillotson());
    let contradicts = |law: Compaction| {
        let pores = Porosity::new(ALPHA, law, SOLID, &eos);
        pores
            .law
            .contradicts(ALPHA, &pores.solid)
            .map(|c| c.keys[0])
    };
    assert_eq!(
        contradicts(Compaction::PAlpha(p_alpha(6000.0))),
        Some("sound_speed")
    );
    assert_eq!(
        contradicts(Compaction::PAlpha(p_alpha(300.0))),
        Some("sound_speed")
    );
    let far = PAlpha {
        transition_distension: 2.0,
        ..steep()
    };
    assert_eq!(
        contradicts(Compaction::PAlpha(far)),
        Some("transition_distension")
    );
    let early = EpsilonAlpha {
        transition_strain: -2.0,
        ..epsilon_alpha(0.0)
    };
    assert_eq!(
        contradicts(Compaction::EpsilonAlpha(early)),
        Some("transition_strain")
    );
}
