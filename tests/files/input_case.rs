//! The ready cases, overrides, and the resolved text.

use files::input::{load, output_and_run_only, parse};
use files::preflight::{approaches, warnings};
use material::{AfterSpall, Effect, Failure, Spall, Strength, library};
use model::{
    Axis, Case, ClockInterval, ContactMode, PotentialRange, Precision, Shape, SmoothingLength,
    TermOptions, Vec3,
};

fn ready(name: &str, overrides: &[&str]) -> Case {
    let path = crate::project::root().join(format!("inputs/{name}/case.toml"));
    load(&path, &strings(overrides)).unwrap_or_else(|error| panic!("{error}"))
}

fn strings(words: &[&str]) -> Vec<String> {
    words.iter().map(ToString::to_string).collect()
}

fn particles(case: &Case) -> Vec<u64> {
    let count = |body| populate::count(body, case.dimension, &case.symmetry, None);
    case.bodies.iter().map(count).collect()
}

/// Everything but the resolved text.
fn meaning(case: &Case) -> String {
    let mut case = case.clone();
    case.resolved.clear();
    format!("{case:?}")
}

#[test]
fn the_main_job() {
    let case = ready("quarter-impact", &[]);
    assert_eq!(particles(&case), [44_230, 3_582]);
    assert!(warnings(&case, &approaches(&case)).is_empty());
    let [plate, sphere] = case.bodies.as_slice() else {
        panic!("two bodies")
    };
    assert_eq!(sphere.velocity.as_slice(), [0.0, 0.0, -7e3]);
    assert!((case.impact_speed() - 7e3).abs() < 1e-9);
    assert!((sphere.smoothing_length - 2.6e-5).abs() < 1e-18);
    // The outermost layers are one spacing apart.
    let below = populate::bounds(plate, 3).unwrap().1[2];
    let above = populate::bounds(sphere, 3).unwrap().0[2];
    assert!((above - below - 2e-5).abs() < 1e-18);
    let material = &case.materials[0];
    assert_eq!(
        material.failure.spall.unwrap().pressure.to_bits(),
        (-1.2e9f64).to_bits()
    );
    let Strength::VonMises(strength) = &material.strength else {
        panic!("von Mises")
    };
    assert_eq!(strength.yield_stress.to_bits(), 0.26e9f64.to_bits());
    assert_eq!(
        Some(&material.eos),
        library::find("aluminium-2024").map(|m| m.eos).as_ref()
    );
    assert_eq!(case.run.end_time.to_bits(), 0.2e-6f64.to_bits());
    assert!(matches!(case.default_contact, ContactMode::Overlap(_)));
}

/// Failure of the material of a case.
fn failure(material: &str) -> Failure {
    let text = format!(
        "dimension = 2\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\n[material.m]\n{material}\n\
         [[body]]\nname = \"b\"\nmaterial = \"m\"\nshape.box = {{ lower = [0, 0], upper = [\"9 mm\", \"9 mm\"] }}\n"
    );
    let case = parse("one body", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    case.materials[0].failure
}

/// Without the energy of its cracks a metal of the library loses its strength as it fails, and nothing before.
#[test]
fn metals_without_a_fracture_energy_fail_at_once() {
    let metal = "library = \"aluminium-2024-ductile\"";
    assert_eq!(failure(metal).options.effect, Effect::Scaled);
    let without = failure(&format!("{metal}\nfailure.fracture_energy = \"0 J/m^2\"")).options;
    assert_eq!(without.effect, Effect::StrengthLost);
    assert!(!without.softens());
}

/// What bears no shear and is a liquid cavitates, unless its case says more; a gas needs no limit.
#[test]
fn liquids_cavitate() {
    let tait = "density = \"1 g/cm^3\"\neos.tait.sound_speed = \"1.5 km/s\"\nstrength = \"none\"";
    let water = "library = \"water\"\neos.tait.sound_speed = \"25 m/s\"";
    for material in [tait, water] {
        assert_eq!(failure(material).spall, Failure::CAVITATES.spall);
        assert_eq!(
            failure(&format!("{material}\nfailure = \"none\"")),
            Failure::NONE
        );
        let more = failure(&format!("{material}\nfailure.spall.pressure = \"-5 MPa\""));
        let held = Spall {
            pressure: -5e6,
            after: AfterSpall::Hold,
        };
        assert_eq!(more.spall, Some(held));
    }
    assert_eq!(failure("library = \"air\""), Failure::NONE);
    assert_eq!(failure("library = \"granite-tillotson\""), Failure::NONE);
}

#[test]
fn the_whole_model_is_four_quarters() {
    let quarter = ready("quarter-impact", &["spacing=0.03mm"]);
    let whole = ready("quarter-impact", &["spacing=0.03mm", "symmetry=[]"]);
    for (q, w) in quarter.bodies.iter().zip(&whole.bodies) {
        let part: Vec<_> = populate::sites(w, 3, &[], None)
            .filter(|s| s.position[0] > 0.0 && s.position[1] > 0.0)
            .collect();
        let sites: Vec<_> = populate::sites(q, 3, &quarter.symmetry, None).collect();
        assert_eq!(sites, part);
        assert_eq!(populate::count(w, 3, &[], None), 4 * sites.len() as u64);
    }
}

#[test]
fn the_small_cases() {
    let flyer = ready("flyer-plate", &[]);
    assert_eq!((flyer.dimension, particles(&flyer)), (1, vec![200, 200]));
    assert_eq!(flyer.materials[0].strength, Strength::None);
    assert_eq!(flyer.materials[0].failure.spall, None);
    let elastic = ready("elastic-impact", &[]);
    assert_eq!(particles(&elastic), [2400, 552]);
    for case in [flyer, elastic] {
        assert!(warnings(&case, &approaches(&case)).is_empty());
    }
}

/// Every folder of `inputs/` has a case that can be read, and a README.
#[test]
fn all_ready_cases_are_sound() {
    let inputs = crate::project::root().join("inputs");
    let mut count = 0;
    for entry in std::fs::read_dir(inputs).unwrap() {
        let folder = entry.unwrap().path();
        assert!(folder.join("README.md").is_file(), "{folder:?}");
        load(&folder.join("case.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
        count += 1;
    }
    assert!(count >= 27, "{count}");
}

#[test]
fn impacts_of_plates_and_targets() {
    for (name, expected) in [
        ("hiermaier-1997", &[99_534, 8_371][..]),
        ("crater", &[130_037, 525]),
        ("whipple-shield", &[19_125, 66_225, 3_637]),
    ] {
        let case = ready(name, &[]);
        for (count, about) in particles(&case).iter().zip(expected) {
            assert!(count.abs_diff(*about) * 50 < *about, "{name}: {count}");
        }
        let said = warnings(&case, &approaches(&case));
        assert!(said.is_empty(), "{name}: {said:?}");
    }
}

/// One quantity in place of a vector is its length, as in a sweep.
#[test]
fn a_quantity_in_place_of_a_vector_is_its_length() {
    let velocity = |set: &[&str]| ready("quarter-impact", set).bodies[1].velocity;
    let oblique = "body.sphere.velocity=[0, \"3 km/s\", \"-4 km/s\"]";
    let whole = ["symmetry=[]", oblique];
    for (length, expected) in [
        ("body.sphere.velocity=5 km/s", [0.0, 3e3, -4e3]),
        ("body.1.velocity=\"1e3 m/s\"", [0.0, 600.0, -800.0]),
        ("body.sphere.velocity=-10km/s", [0.0, -6e3, 8e3]),
    ] {
        let found = velocity(&[&whole[..], &[length]].concat());
        assert!((found - Vec3::from(expected)).norm() < 1e-9, "{length}");
    }
    assert_eq!(
        velocity(&["body.sphere.velocity.2=-2 km/s"]).as_slice(),
        [0.0, 0.0, -2e3]
    );
}

#[test]
fn a_speed_flies_along_the_last_axis_at_its_angle_and_a_diameter_is_two_radii() {
    let whole = ["symmetry=[]", "body.sphere.velocity=[0, 0, 0]"];
    let text =
        std::fs::read_to_string(crate::project::root().join("inputs/quarter-impact/case.toml"));
    let text = text.unwrap();
    let line = text
        .lines()
        .find(|line| line.starts_with("velocity ="))
        .unwrap();
    let with =
        |keys: &str| files::input::parse("case", &text.replace(line, keys), &strings(&whole[..1]));
    let straight = with("speed = \"5 km/s\"").unwrap();
    assert_eq!(straight.bodies[1].velocity.as_slice(), [0.0, 0.0, -5e3]);
    let oblique = with("speed = \"2 km/s\"\nangle = \"30 deg\"").unwrap();
    let expected = Vec3::new(1e3, 0.0, -3f64.sqrt() * 1e3);
    assert!((oblique.bodies[1].velocity - expected).norm() < 1e-9);

    let flat = |dimension: usize, shape: &str, keys: &str| {
        let text = format!(
            "dimension = {dimension}\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\n\
             material.m.library = \"copper-taylor-bar\"\n\
             [[body]]\nname = \"b\"\nmaterial = \"m\"\nshape.{shape}\n{keys}\n"
        );
        files::input::parse("case", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
    };
    let box_1 = "box = { size = [\"9 mm\"] }";
    let [down, across, line] = [
        flat(2, "sphere.diameter = \"9 mm\"", "speed = \"1 m/s\""),
        flat(
            2,
            "sphere.radius = \"4.5 mm\"",
            "speed = \"1 m/s\"\nangle = \"-45 deg\"",
        ),
        flat(1, box_1, "speed = \"1 m/s\""),
    ]
    .map(|case| case.bodies[0].clone());
    assert_eq!(down.velocity.as_slice(), [0.0, -1.0, 0.0]);
    let half = 0.5f64.sqrt();
    assert!((across.velocity - Vec3::new(-half, -half, 0.0)).norm() < 1e-12);
    assert_eq!(line.velocity.as_slice(), [-1.0, 0.0, 0.0]);
    assert_eq!(down.shape, across.shape);

    for (diameters, radii) in [
        (
            "cylinder = { diameter = \"9 mm\", inner_diameter = \"4 mm\", length = \"9 mm\" }",
            "cylinder = { radius = \"4.5 mm\", inner_radius = \"2 mm\", length = \"9 mm\" }",
        ),
        (
            "cone = { diameter = \"9 mm\", top_diameter = \"4 mm\", length = \"9 mm\" }",
            "cone = { radius = \"4.5 mm\", top_radius = \"2 mm\", length = \"9 mm\" }",
        ),
        (
            "ogive = { diameter = \"9 mm\", nose = \"9 mm\", length = \"18 mm\" }",
            "ogive = { radius = \"4.5 mm\", nose = \"9 mm\", length = \"18 mm\" }",
        ),
        (
            "torus = { diameter = \"20 mm\", tube_diameter = \"9 mm\" }",
            "torus = { radius = \"10 mm\", tube_radius = \"4.5 mm\" }",
        ),
    ] {
        let [a, b] = [diameters, radii].map(|shape| flat(3, shape, "").bodies[0].clone());
        assert_eq!(a.shape, b.shape, "{diameters}");
    }
}

#[test]
fn overrides_reach_every_place() {
    let case = ready(
        "quarter-impact",
        &[
            "spacing=0.015mm",
            "run.end_time=\"0.1 us\"",
            "run.max_steps = 7",
            "body.sphere.velocity=[0, \"1 cm/us\", 0]",
            "body.0.spacing=0.02 mm",
            "body.sphere.lattice={kind=\"hexagonal\", angle=\"90 deg\"}",
            "contact.mode=potential",
            "contact.potential.exponent=3",
            "contact.pair=[{bodies=[\"sphere\",\"plate\"], potential.range=\"spacing\"}]",
            "sph.smoothing_length=variable",
            "sph.smoothing_length_max=1.5",
            "symmetry=[]",
            "material.aluminium.strength=none",
            "material.aluminium.failure.spall=none",
            "material.aluminium.density=2.8 g/cm^3",
            "domain.axes=[\"y\", \"x\"]",
            "domain.levels=2",
            "time_step.max=1 ns",
            "output.fields=[\"pressure\"]",
            "gauge+={ at = [0, 0, 0] }",
            "gauge+={ particle = 4711 }",
        ],
    );
    assert!((case.bodies[0].lattice.spacing - 2e-5).abs() < 1e-18);
    assert!((case.bodies[1].lattice.spacing - 1.5e-5).abs() < 1e-18);
    assert!((case.bodies[1].lattice.angle - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert_eq!(case.bodies[1].velocity.as_slice(), [0.0, 1e4, 0.0]);
    assert_eq!(case.run.max_steps, Some(7));
    let ContactMode::Potential(potential) = case.contact_between(0, 1) else {
        panic!("potential")
    };
    assert_eq!(
        (potential.exponent, potential.range),
        (3, PotentialRange::Spacing)
    );
    let SmoothingLength::Variable { min, max } = case.sph.smoothing_length else {
        panic!("variable")
    };
    assert_eq!(
        [min.to_bits(), max.to_bits()],
        [0.6f64.to_bits(), 1.5f64.to_bits()]
    );
    assert!(case.symmetry.is_empty());
    assert_eq!(case.materials[0].strength, Strength::None);
    assert_eq!(case.materials[0].failure.spall, None);
    assert_eq!(
        case.materials[0].reference_density.to_bits(),
        2800f64.to_bits()
    );
    assert_eq!(case.domain.axes, [Some(Axis::Y), Some(Axis::X), None]);
    assert_eq!(case.domain.levels, Some(2));
    let usual = ready("quarter-impact", &["domain.axis=y", "domain.levels=auto"]).domain;
    assert_eq!(usual.axes, [Some(Axis::Y), None, None]);
    assert_eq!(usual.levels, None);
    assert_eq!(case.time_step.max.to_bits(), 1e-9f64.to_bits());
    assert_eq!(case.output.fields, ["pressure"]);
    let carried = case.measure.gauges.iter().map(|gauge| gauge.particle);
    assert_eq!(carried.collect::<Vec<_>>(), [None, Some(4711)]);
}

#[test]
fn options_of_the_sums() {
    let off = ready("quarter-impact", &[]).sph.terms;
    assert_eq!(off, TermOptions::default());
    let sets = [
        "sph.artificial_stress=0.3",
        "sph.balsara=true",
        "sph.conduction=1",
        "sph.xsph=0.5",
    ];
    let terms = ready("quarter-impact", &sets).sph.terms;
    assert!(terms.balsara);
    let on = [terms.artificial_stress, terms.conduction, terms.xsph];
    assert_eq!(on.map(f64::to_bits), [0.3, 1.0, 0.5].map(f64::to_bits));
}

#[test]
fn the_resolved_text_gives_the_same_case() {
    let sets: [&[&str]; 5] = [
        &[],
        // Of several lines, as no title can be.
        &["#\ntitle = -0.0 # u = , 97.6 GPa"],
        &["title = \"\"\"\r\n97.6 GPa\"\"\""],
        &["spacing=0.025 mm", "symmetry=[]", "contact.mode=kernel"],
        &[
            "body.sphere.shape={box={size=[\"2 spacing\",\"4 spacing\",\"3 spacing\"]}}",
            "title=\"a \\\"b\\\" κ\"",
        ],
    ];
    for set in sets {
        let case = ready("quarter-impact", set);
        let again = parse("resolved", &case.resolved, &[]).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(meaning(&again), meaning(&case));
        assert_eq!(again.resolved, case.resolved);
        // Overrides on top of resolved text work like on the file.
        let more = parse("resolved", &case.resolved, &strings(&["run.end_time=1us"])).unwrap();
        assert!((more.run.end_time - 1e-6).abs() < 1e-20);
    }
}

#[test]
fn an_inline_material() {
    let text = "
        dimension = 2
        spacing = \"1 mm\"
        run.end_time = \"1 us\"
        [material.steel]
        density = \"7.83 g/cm^3\"
        eos.linear = { bulk_modulus = \"1.59 Mbar\", form = \"density_ratio\" }
        strength.von_mises = { shear_modulus = \"0.82 Mbar\", yield_stress = \"0.003 Mbar\" }
        [[body]]
        name = \"disc\"
        material = \"steel\"
        shape.sphere = { radius = \"10 spacing\", centre = [\"1 cm\", 0] }
    ";
    let case = parse("inline", text, &[]).unwrap_or_else(|e| panic!("{e}"));
    let Shape::Sphere { centre, radius } = case.bodies[0].shape else {
        panic!("a disc")
    };
    assert!((radius - 1e-2).abs() < 1e-17 && (centre.x - 1e-2).abs() < 1e-17);
    let modulus = case.materials[0].p_wave_modulus();
    assert!((modulus / (1.59e11 + 0.82e11 * 4.0 / 3.0) - 1.0).abs() < 1e-15);
    assert_eq!(case.title, "untitled");
}

#[test]
fn a_gas_a_liquid_a_rubber_and_a_hot_metal() {
    let text = r#"
        dimension = 1
        spacing = "1 mm"
        run.end_time = "1 us"
        contact.mode = "none"
        output.fields = ["temperature"]
        sph.smoothing_length = "variable"
        [material.gas]
        density = "1 kg/m^3"
        eos.ideal_gas = { gamma = 1.4, reference_pressure = "1 bar" }
        strength = "none"
        [material.water]
        density = "1 g/cm^3"
        eos.tait = { sound_speed = "24 m/s" }
        strength.viscous = { viscosity = "1 MPa s" }
        [material.rubber]
        density = "1.01 g/cm^3"
        eos.linear = { bulk_modulus = "0.73 GPa" }
        strength.neo_hookean = { shear_modulus = "0.16 GPa" }
        [material.copper]
        library = "copper"
        strength.johnson_cook = { a = "90 MPa", b = "292 MPa", n = 0.31, c = 0.025, m = 1.09 }
        thermal = { specific_heat = "383 J/(kg K)", melting_temperature = "1356 K" }
        failure.spall.pressure = "-1 GPa"
        [[body]]
        name = "left"
        material = "gas"
        shape.box.size = ["10 mm"]
        [[body]]
        name = "right"
        material = "gas"
        density = "0.125 kg/m^3"
        specific_energy = "2 MJ/kg"
        shape.box = { lower = ["5 mm"], upper = ["15 mm"] }
        [[body]]
        name = "pool"
        material = "water"
        shape.box = { lower = ["15 mm"], upper = ["25 mm"] }
    "#;
    let case = parse("inline", text, &[]).unwrap_or_else(|e| panic!("{e}"));
    let [left, right, pool] = &case.bodies[..] else {
        panic!("three bodies")
    };
    let states = [left, right, pool].map(|b| (case.initial_density(b), case.initial_energy(b)));
    // p = 0.4 ρ e = 1 bar.
    assert!((states[0].1 / 2.5e5 - 1.0).abs() < 1e-14 && (states[0].0 - 1.0).abs() < 1e-15);
    assert!((states[1].0 - 0.125).abs() < 1e-16 && (states[1].1 - 2e6).abs() < 1e-8);
    assert!((states[2].0 - 1000.0).abs() < 1e-12 && states[2].1 == 0.0);
    // Viscous diffusion bounds the step, at the smallest smoothing length: h²ρ/(8η).
    let h = 0.6 * 1.3e-3;
    assert!((case.time_step.max / (0.125 * h * h * 1e3 / 1e6) - 1.0).abs() < 1e-13);
    let Strength::JohnsonCook(law) = case.materials[3].strength else {
        panic!("Johnson and Cook's")
    };
    // The library's shear modulus, room temperature and 1/s by default.
    assert!((law.shear_modulus - 47.7e9).abs() < 1.0 && (law.reference_rate - 1.0).abs() < 1e-15);
    let thermal = case.materials[3].thermal.as_ref().unwrap().constants();
    assert!((thermal.reference_temperature - 300.0).abs() < 1e-12);
    assert!(
        (case.materials[3]
            .temperature(8930.0, 38300.0, [0.0, 0.0])
            .unwrap()
            - 400.0)
            .abs()
            < 1e-9
    );
    let again = parse("resolved", &case.resolved, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(meaning(&again), meaning(&case));
}

#[test]
fn bodies_touch_in_any_order() {
    let chain = "
        dimension = 1
        spacing = \"1 mm\"
        run.end_time = \"1 us\"
        material.a.library = \"copper\"
        [[body]]
        name = \"last\"
        material = \"a\"
        spacing = \"3 mm\"
        shape.box.size = [\"9 mm\"]
        touch = { body = \"middle\", direction = \"-x\" }
        [[body]]
        name = \"middle\"
        material = \"a\"
        shape.box.size = [\"4 mm\"]
        touch = { body = \"first\", direction = \"-x\" }
        [[body]]
        name = \"first\"
        material = \"a\"
        shape.box = { lower = [0], upper = [\"5 mm\"] }
    ";
    let case = parse("chain", chain, &[]).unwrap_or_else(|e| panic!("{e}"));
    let places: Vec<f64> = case
        .bodies
        .iter()
        .flat_map(|body| populate::sites(body, 1, &[], None))
        .map(|site| (site.position[0] * 1e5).round())
        .collect();
    // mm/100: three at 3 mm from 2 mm beyond the middle's last, four, five.
    let expected = [
        1050., 1350., 1650., 550., 650., 750., 850., 50., 150., 250., 350., 450.,
    ];
    assert_eq!(places, expected);
}

#[test]
fn overlapping_bodies_and_crooked_lattices_are_doubted() {
    let deep = ready(
        "elastic-impact",
        &["body.sphere.touch={body=\"block\",direction=\"-x\"}"],
    );
    assert!(
        warnings(&deep, &approaches(&deep))[0].starts_with("nothing meets"),
        "beside the block"
    );
    let text = ready("elastic-impact", &[]).resolved;
    let text = text.replace("touch = { body = \"block\", direction = \"-z\" }", "");
    let near = text.replace("\"1 mm\"]", "\"0.77 mm\"]");
    let case = parse("overlap", &near, &[]).unwrap();
    assert!(
        warnings(&case, &approaches(&case))[0].contains("begin 0.30 spacings within each other")
    );
    let text = text.replace("\"1 mm\"]", "\"0.5 mm\"]");
    let error = parse("overlap", &text, &[]).unwrap_err().to_string();
    assert!(
        error.contains("`sphere` begins 3.0 spacings within `block`"),
        "{error}"
    );
    let silent = parse("overlap", &text, &strings(&["contact.mode=none"])).unwrap();
    assert!(warnings(&silent, &approaches(&silent))[0].contains("they pass through each other"));
    let crooked = ready("quarter-impact", &["body.plate.lattice=hexagonal"]);
    assert!(warnings(&crooked, &approaches(&crooked))[0].contains("is not its own mirror image"));
}

#[test]
fn a_restart_changes_only_run_output_and_domain() {
    let fine = [
        "run.end_time=1us",
        "output.fields=[]",
        "domain.balance_every=3",
    ];
    output_and_run_only(&strings(&fine)).unwrap();
    for (set, message) in [
        ("spacing=1mm", "`spacing` cannot change on a restart"),
        (
            "body.sphere.velocity=[0]",
            "`body` cannot change on a restart",
        ),
        ("run", "an override needs a `=`"),
    ] {
        let error = output_and_run_only(&strings(&["run.max_steps=1", set])).unwrap_err();
        let text = error.to_string();
        assert!(
            text.contains(message) && text.contains("--> --set:1:1"),
            "{text}"
        );
    }
}

/// Inches, feet, pounds and degrees Celsius say what metres, kilograms and kelvins say.
#[test]
fn a_case_in_inches_and_degrees_is_the_one_in_metres_and_kelvins() {
    let case = |units: &[&str; 7]| {
        let [spacing, time, modulus, heat, warm, edge, speed] = units;
        let text = format!(
            "dimension = 2\nspacing = \"{spacing}\"\n[run]\nend_time = \"{time}\"\n\
             [material.metal]\nlibrary = \"copper\"\nstrength.elastic.shear_modulus = \"{modulus}\"\n\
             thermal = {{ specific_heat = \"{heat}\", reference_temperature = \"{warm}\" }}\n\
             [[body]]\nname = \"plate\"\nmaterial = \"metal\"\n\
             shape.box.size = [\"{edge}\", \"{edge}\"]\nvelocity = [\"{speed}\", 0]\n"
        );
        parse("case.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
    };
    let inches = case(&[
        "0.02 in",
        "0.5 min",
        "6 Mpsi",
        "383 J/(kg °C)",
        "20 °C",
        "1 ft",
        "250 ft/s",
    ]);
    let metres = case(&[
        "0.508 mm",
        "30 s",
        "41368543759.01016 Pa",
        "383 J/(kg K)",
        "293.15 K",
        "304.8 mm",
        "76.2 m/s",
    ]);
    assert_eq!(inches.bodies, metres.bodies);
    assert_eq!(inches.materials, metres.materials);
    assert_eq!(inches.run.end_time.to_bits(), metres.run.end_time.to_bits());
    assert_eq!(inches.length_unit.name, "in");
}

#[test]
fn snapshots_may_have_schedules_of_their_own() {
    let case = |more: &str| {
        let text = include_str!("../bad_inputs/case.toml");
        let text = text.replace(
            "[[output.snapshot]] # far",
            &format!("{more}\n[[output.snapshot]]"),
        );
        parse("case", &text, &[]).unwrap()
    };
    let output = case("").output;
    let names: Vec<_> = output
        .snapshots
        .iter()
        .map(|s| (&s.name[..], s.every))
        .collect();
    assert_eq!(names, [("close", Some(1e-8)), ("far", None)]);
    let output = case(
        r#"fields = ["pressure"]
        bodies = ["brick", "ball"]
        region.above.z = "2 spacing"
        precision = "single"
        "#,
    )
    .output;
    let [close, far] = &output.snapshots[..] else {
        panic!()
    };
    assert_eq!(close.fields, ["pressure"]);
    assert_eq!(close.bodies, Some(vec![0, 1]));
    assert_eq!(
        close.region.unwrap().above,
        [f64::NEG_INFINITY, f64::NEG_INFINITY, 2e-3]
    );
    assert_eq!(close.precision, Precision::Single);
    assert_eq!(
        (far.precision, far.region, &far.bodies),
        (Precision::Double, None, &None)
    );
    assert_eq!(output.all_fields().count(), 1);
}

#[test]
fn checkpoints_may_come_by_what_they_cost() {
    let every = |more: &[&str]| ready("quarter-impact", more).output.checkpoint_every_wall;
    assert_eq!(every(&[]), None);
    let wall = "output.checkpoint_every_wall=";
    let minutes = format!("{wall}30 min");
    assert_eq!(every(&[&minutes]), Some(ClockInterval::Fixed(1800.0)));
    let auto = format!("{wall}auto");
    let failures = 6.0 * 3600.0;
    assert_eq!(every(&[&auto]), Some(ClockInterval::Auto { failures }));
    let day = "output.mean_time_between_failures=24 h";
    let failures = 24.0 * 3600.0;
    assert_eq!(every(&[&auto, day]), Some(ClockInterval::Auto { failures }));
}

/// The resolved text of a case with a table of states names the file from everywhere, with its digest; a file that has changed
/// since is refused.
#[test]
fn a_table_of_states_is_that_with_which_the_case_began() {
    let folder = tempfile::tempdir().unwrap();
    let table = std::fs::read(crate::project::root().join("tests/common/gas.table")).unwrap();
    std::fs::write(folder.path().join("gas.table"), &table).unwrap();
    let text = "dimension = 1\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\n\
        [material.gas]\ndensity = \"1 kg/m^3\"\neos.table.file = \"gas.table\"\nstrength = \"none\"\n\
        [[body]]\nname = \"gas\"\nmaterial = \"gas\"\nshape.box = { lower = [0], upper = [\"9 mm\"] }\n";
    let path = folder.path().join("case.toml");
    std::fs::write(&path, text).unwrap();
    let case = files::input::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
    let energy = case.initial_energy(&case.bodies[0]);
    assert!((energy / (717.63 * 300.0) - 1.0).abs() < 1e-12, "{energy}");
    assert!(case.resolved.contains("sha256"), "{}", case.resolved);
    let again = files::input::parse("resolved.toml", &case.resolved, &[]);
    assert_eq!(
        again.unwrap_or_else(|error| panic!("{error}")).materials,
        case.materials
    );
    let mut changed = table;
    changed.push(b'\n');
    std::fs::write(folder.path().join("gas.table"), changed).unwrap();
    let refused = files::input::parse("resolved.toml", &case.resolved, &[]);
    let message = refused.expect_err("another file").to_string();
    assert!(message.contains("no longer the one"), "{message}");
}

/// Cloth lies in the plane of its plate, and has the pores with which it has its mass for an area.
#[test]
fn cloth_needs_its_mass_for_an_area_alone() {
    let case = parse(
        "case.toml",
        r#"
dimension = 3
spacing = "0.3 mm"
[run]
end_time = "1 us"
[material.cloth]
library = "kevlar-fabric"
[[body]]
name = "floor"
material = "cloth"
areal_density = "1 kg/m^2"
shape.box = { lower = ["-9 mm", "-9 mm", 0], upper = ["9 mm", "9 mm", "1.2 mm"] }
[[body]]
name = "side"
material = "cloth"
shape.box = { lower = ["20 mm", "-9 mm", 0], upper = ["21.2 mm", "9 mm", "9 mm"] }
[[body]]
name = "ceiling"
material = "cloth"
areal_density = "1 kg/m^2"
shape.cylinder = { axis = "z", radius = "9 mm", length = "1.2 mm", centre = [0, 0, "9 mm"] }
"#,
        &[],
    )
    .unwrap_or_else(|error| panic!("{error}"));
    let [floor, side, ceiling] = case.bodies.as_slice() else {
        panic!("three bodies")
    };
    let density = |body: &model::Body| case.initial_density(body);
    assert!((density(floor) * 1.2e-3 - 1.0).abs() < 1e-12);
    assert_eq!(floor.material, ceiling.material);
    assert!((density(side) - 1440.0 / 1.9).abs() < 1e-9);
    let of = |body: &model::Body| {
        let fibres = body.initial.fibres.as_ref().unwrap();
        (fibres.along, fibres.normal)
    };
    assert_eq!(of(floor), (Vec3::x(), Vec3::z()));
    assert_eq!(of(side), (Vec3::y(), Vec3::x()));
    let count = f64::from(u32::try_from(particles(&case)[0]).unwrap());
    let mass = case.particle_mass(floor) * count;
    assert!((mass / (324e-6) - 1.0).abs() < 1e-9, "{mass}");
}

/// A layer lies across its thinnest side, however thick it is, also where only two directions are.
#[test]
fn a_thick_layer_in_two_dimensions_has_its_mass_for_an_area() {
    let case = parse(
        "case.toml",
        r#"
dimension = 2
axisymmetric = true
spacing = "0.1 mm"
run.end_time = "1 us"
material.cloth.library = "kevlar-fabric"
[[body]]
name = "blanket"
material = "cloth"
areal_density = "2 kg/m^2"
shape.box = { lower = [0, "-4 mm"], upper = ["6 mm", 0] }
"#,
        &[],
    )
    .unwrap_or_else(|error| panic!("{error}"));
    let [blanket] = case.bodies.as_slice() else {
        panic!("a body")
    };
    assert!((case.initial_density(blanket) * 4e-3 - 2.0).abs() < 1e-12);
    assert_eq!(blanket.initial.fibres.as_ref().unwrap().normal, Vec3::y());
}
