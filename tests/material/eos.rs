//! Equations of state: thermodynamic identity, join of the branches, strong compression.

use material::{
    AfterSpall, Eos, Failure, LANES, Linear, LinearForm, Material, MieGruneisen, PointBatch, Spall,
    Strength, library,
};

/// A batch of one state in all lanes, at rest and without stress.
fn batch(density: f64, specific_energy: f64) -> PointBatch {
    PointBatch {
        density: [density; LANES],
        specific_energy: [specific_energy; LANES],
        pressure: [f64::NAN; LANES],
        sound_speed: [f64::NAN; LANES],
        // Of explosives.
        burn: [1.0; LANES],
        ..PointBatch::ZERO
    }
}

fn fluid(reference_density: f64, eos: Eos) -> Material {
    Material {
        name: "fluid".to_owned(),
        reference_density,
        eos,
        strength: Strength::None,
        failure: Failure::NONE,
        thermal: None,
        porosity: None,
    }
}

/// Pressure and sound speed of one state.
fn state(material: &Material, density: f64, specific_energy: f64) -> (f64, f64) {
    let mut points = batch(density, specific_energy);
    material.update(&mut points, 0.0);
    (points.pressure[3], points.sound_speed[3])
}

fn lead_like() -> MieGruneisen {
    MieGruneisen {
        c0: 2006.0,
        s1: 1.429,
        s2: 0.8506,
        s3: -1.64,
        gamma0: 2.74,
        b: 0.2,
    }
}

fn eos_under_test() -> Vec<Material> {
    let mut materials: Vec<Material> = library::names()
        .into_iter()
        .map(|name| fluid(2785.0, library::find(name).unwrap().eos))
        .collect();
    materials.push(fluid(11340.0, Eos::MieGruneisen(lead_like())));
    for form in [LinearForm::Logarithmic, LinearForm::DensityRatio] {
        let bulk_modulus = 160e9;
        materials.push(fluid(7830.0, Eos::Linear(Linear { bulk_modulus, form })));
    }
    materials
}

#[test]
fn sound_speed_is_the_slope_of_the_isentrope() {
    // Central difference of p along de = p/ρ² dρ: error about δ² + 1e-16/δ relative to c0², with
    // δ = 1e-5, hence 1e-8 of the reference modulus; curvature adds a factor.
    for material in eos_under_test() {
        let rho0 = material.reference_density;
        for ratio in [0.8, 0.95, 1.001, 1.1, 1.3, 1.6, 1.9] {
            for energy in [0.0, 1e5, 2e6] {
                let rho = rho0 * ratio;
                let (p, c) = state(&material, rho, energy);
                let c0_squared = material.p_wave_modulus() / rho0;
                if c * c < 0.02 * c0_squared {
                    continue; // at the floor
                }
                let d_rho = 1e-5 * rho;
                let d_e = p / (rho * rho) * d_rho;
                let (above, _) = state(&material, rho + d_rho, energy + d_e);
                let (below, _) = state(&material, rho - d_rho, energy - d_e);
                let slope = (above - below) / (2.0 * d_rho);
                assert!(
                    (slope - c * c).abs() < 1e-7 * (c * c).max(c0_squared),
                    "{material:?} at ρ/ρ0 = {ratio}, e = {energy}: {slope} and c² = {}",
                    c * c
                );
            }
        }
    }
}

#[test]
fn reference_state_has_no_pressure_and_the_reference_speed() {
    for name in library::names() {
        let material = library::find(name).unwrap();
        let energy = material.eos.reference_energy(material.reference_density);
        let (p, c) = state(&material, material.reference_density, energy);
        let reference = match &material.eos {
            Eos::IdealGas(gas) => gas.reference_pressure,
            // Its reference state is burnt where it stood.
            Eos::Jwl(_) => p,
            _ => 0.0,
        };
        assert!((p - reference).abs() <= 1e-15 * reference, "{name}: {p}");
        let modulus = material.reference_density * c * c;
        assert!((modulus / material.p_wave_modulus() - 1.0).abs() < 1e-14);
    }
}

#[test]
fn branches_of_mie_gruneisen_meet_in_value_and_slope() {
    let eos = lead_like();
    let rho0 = 11340.0;
    let (above, below) = (
        eos.response(rho0, rho0 * (1.0 + 1e-12), 1e5),
        eos.response(rho0, rho0 * (1.0 - 1e-12), 1e5),
    );
    assert!((above.pressure / below.pressure - 1.0).abs() < 1e-8);
    assert!((above.dp_drho / below.dp_drho - 1.0).abs() < 1e-10);
}

#[test]
fn thin_matter_has_the_thermal_pressure_of_a_gas() {
    let metals = [library::find("aluminium-2024"), library::find("steel-304")];
    for metal in metals.map(Option::unwrap) {
        let Eos::MieGruneisen(eos) = metal.eos else {
            panic!("not a Mie–Grüneisen metal");
        };
        let rho0 = metal.reference_density;
        let gamma = |ratio: f64| eos.response(rho0, ratio * rho0, 1e6).dp_de / (ratio * rho0);
        assert!((gamma(1e-6) - 2.0 / 3.0).abs() < 1e-4);
        // Between, never below that of the gas, nor far above that of dense matter.
        for n in 1..100 {
            let gamma = gamma(f64::from(n) / 100.0);
            assert!((0.66..1.5 * eos.gamma0).contains(&gamma), "{n} {gamma}");
            // The slope of the pressure is that of the pressure.
            let (rho, d) = (f64::from(n) / 100.0 * rho0, 1e-4 * rho0);
            let at = |rho: f64| eos.response(rho0, rho, 3e6);
            let slope = (at(rho + d).pressure - at(rho - d).pressure) / (2.0 * d);
            // But for the corners.
            if ![75, 99].contains(&n) {
                assert!((slope / at(rho).dp_drho - 1.0).abs() < 1e-6);
            }
        }
        // Dense matter has the law's own.
        for ratio in [0.75, 0.9, 1.0] {
            let found = eos.response(rho0, ratio * rho0, 1e6).dp_de / rho0;
            assert!((found / (eos.gamma0 + (ratio - 1.0) * eos.b) - 1.0).abs() < 1e-14);
        }
    }
}

/// Cold matter that has expanded pulls or bears nothing; it pushes nowhere, whatever the constants of its compression.
#[test]
fn cold_matter_that_has_expanded_does_not_push() {
    for name in library::names() {
        let material = library::find(name).unwrap();
        let (Eos::MieGruneisen(_) | Eos::Tillotson(_)) = material.eos else {
            continue;
        };
        let solid = (material.porosity.as_ref())
            .map_or(material.reference_density, |pores| pores.solid.density);
        for n in 1..100 {
            let p = (material.eos)
                .at(solid, f64::from(n) / 100.0 * solid, 0.0)
                .pressure;
            assert!(p <= 0.0, "{name} at {n} %: {p}");
        }
    }
}

#[test]
fn strong_compression_gives_finite_growing_pressure() {
    // Beyond the Hugoniot's pole (μ = 2.96 for 2024) and the maximum of the cold part (1.18).
    for name in library::names() {
        let mut material = library::find(name).unwrap();
        if let Some(pores) = material.porosity.take() {
            material.reference_density = pores.solid.density;
        }
        if !matches!(material.eos, Eos::MieGruneisen(_) | Eos::Tillotson(_)) {
            continue;
        }
        let mut last = 0.0;
        for i in 1..4000 {
            let rho = material.reference_density * (1.0 + 0.002 * f64::from(i));
            let (p, c) = state(&material, rho, 1e6);
            assert!(p.is_finite() && c.is_finite(), "{name} at {rho}");
            assert!(
                p >= last,
                "{name}: pressure falls from {last} to {p} at {rho}"
            );
            assert!(c > 0.5 * 2000.0, "{name}: {c} m/s at {rho}");
            last = p;
        }
    }
    let aluminium = library::find("aluminium-2024").unwrap();
    let (inside, _) = state(&aluminium, 2785.0 * 2.1, 0.0);
    let expected =
        2785.0 * 5328.0 * 5328.0 * 1.1 * (1.0 - 0.24 * 1.1 * 1.1) / (1.0 - 0.338 * 1.1_f64).powi(2);
    assert!((inside / expected - 1.0).abs() < 1e-13);
}

#[test]
fn expansion_keeps_a_real_sound_speed() {
    let mut material = library::find("aluminium-2024").unwrap();
    material.strength = Strength::None;
    let floor = 0.1 * 5328.0;
    for cut in [None, Some(spall(-1.2e9))] {
        material.failure.spall = cut;
        for ratio in [1e-3, 0.05, 0.3, 0.6, 0.9] {
            for energy in [0.0, 1e6, 1e7] {
                let (p, c) = state(&material, 2785.0 * ratio, energy);
                assert!(c >= floor * (1.0 - 1e-14), "{c} m/s at ρ/ρ0 = {ratio}");
                assert!(cut.is_none_or(|cut| p >= cut.pressure));
            }
        }
    }
}

#[test]
fn linear_forms_are_what_they_say() {
    let bulk_modulus = 75e9;
    let of = |form| fluid(2700.0, Eos::Linear(Linear { bulk_modulus, form }));
    let rho = 2700.0 * 1.02;
    let (log, c_log) = state(&of(LinearForm::Logarithmic), rho, 1e9);
    assert!((log / (bulk_modulus * libm::log(1.02)) - 1.0).abs() < 1e-13);
    assert!((c_log * c_log / (bulk_modulus / rho) - 1.0).abs() < 1e-14);
    let (ratio, c_ratio) = state(&of(LinearForm::DensityRatio), rho, 0.0);
    assert!((ratio / (bulk_modulus * 0.02) - 1.0).abs() < 1e-13);
    assert!((c_ratio * c_ratio / (bulk_modulus / 2700.0) - 1.0).abs() < 1e-14);
}

/// A cut-off without memory.
fn spall(pressure: f64) -> Spall {
    let after = AfterSpall::Hold;
    Spall { pressure, after }
}

#[test]
fn spall_limits_tension_only() {
    let mut material = library::find("aluminium-6061").unwrap();
    material.failure.spall = Some(spall(-1.2e9));
    let (p, _) = state(&material, 2703.0 * 0.95, 0.0);
    assert_eq!(p.to_bits(), (-1.2e9_f64).to_bits());
    let (p, _) = state(&material, 2703.0 * 0.999, 0.0);
    assert!((p / (-0.001 * 2703.0 * 5240.0 * 5240.0) - 1.0).abs() < 1e-12);
}

#[test]
fn not_a_number_stays_one_and_stays_in_its_lane() {
    let mut material = library::find("aluminium-2024").unwrap();
    material.failure.spall = Some(spall(-1.2e9));
    let mut points = batch(2785.0, 0.0);
    points.density[2] = f64::NAN;
    points.specific_energy[5] = f64::NAN;
    points.deviatoric_stress[3][6] = f64::NAN;
    material.update(&mut points, 1e-9);
    for k in 0..LANES {
        assert_eq!(points.pressure[k].is_nan(), k == 2 || k == 5, "lane {k}");
        assert_eq!(points.sound_speed[k].is_nan(), k == 2 || k == 5, "lane {k}");
        assert_eq!(points.deviatoric_stress[3][k].is_nan(), k == 6, "lane {k}");
    }
}

#[test]
fn library_is_sorted_complete_and_sourced() {
    let names = library::names();
    assert!(names.is_sorted());
    for name in [
        "aluminium-2024",
        "aluminium-6061",
        "copper",
        "steel-304",
        "tungsten",
    ] {
        assert!(names.contains(&name));
    }
    for name in names {
        let material = library::find(name).unwrap();
        assert_eq!(material.name, name);
        assert!(!library::title(name).unwrap().is_empty());
        for constant in material.constants() {
            assert!(library::source(name, &constant.key).is_some());
        }
    }
    let source = |key| library::source("copper-johnson-cook", key).unwrap();
    assert!(source("strength.johnson_cook.a").contains("Johnson & Cook"));
    assert!(source("eos.mie_gruneisen.c0").contains("Steinberg"));
    assert!(library::find("aluminum").is_none());
    let Strength::VonMises(law) = library::find("aluminium-2024").unwrap().strength else {
        panic!("aluminium 2024 is elastic-plastic");
    };
    assert!((law.yield_stress - 0.26e9).abs() < 1.0);
}
