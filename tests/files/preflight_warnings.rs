//! Mistakes of physics that are told before a run, each beside a case that is free of it.

use files::input::parse;
use files::preflight::{advice, approaches, warnings};

/// A bar flies at a plate, ten spacings away.
const BAR: &str = r#"
dimension = 2
spacing = "0.1 mm"
run.end_time = "20 us"
material.metal.library = "copper"

[[body]]
name = "bar"
material = "metal"
shape.box = { lower = [0, "2 mm"], upper = ["1 mm", "4 mm"] }
velocity = [0, "-100 m/s"]

[[body]]
name = "plate"
material = "metal"
shape.box = { lower = ["-2 mm", 0], upper = ["3 mm", "1 mm"] }
"#;

fn told(set: &[&str]) -> Vec<String> {
    let set: Vec<String> = set.iter().map(ToString::to_string).collect();
    let case = parse("bar", BAR, &set).unwrap_or_else(|error| panic!("{error}"));
    warnings(&case, &approaches(&case))
}

#[track_caller]
fn assert_told(set: &[&str], expected: &[&str]) {
    assert_eq!(told(set), expected, "{set:?}");
}

#[test]
fn when_bodies_meet_follows_from_gap_and_speed() {
    assert_told(&[], &[]);
    let case = parse("bar", BAR, &[]).unwrap();
    let [pair] = approaches(&case)[..] else {
        panic!("one pair")
    };
    assert!((pair.gap - 10.0).abs() < 1e-9, "{pair:?}");
    assert!((pair.time - 1e-5).abs() < 1e-11, "{pair:?}");
}

#[test]
fn bodies_that_meet_without_contact_are_told() {
    let none = "contact.mode=none";
    assert_told(
        &[none],
        &[
            "`bar` and `plate` meet at 10 us and have contact of mode \"none\": they pass \
           through each other",
        ],
    );
    assert_told(
        &[none, "body.bar.velocity=[0, \"100 m/s\"]"],
        &["nothing meets: no body flies towards another"],
    );
}

#[test]
fn an_end_before_the_last_arrival_is_told() {
    let wall = "[[body]]\nname = \"wall\"\nmaterial = \"metal\"\n\
                shape.box = { lower = [\"-2 mm\", \"-3 mm\"], upper = [\"3 mm\", \"-2 mm\"] }\n";
    let said = |end: &str| {
        let set = [format!("run.end_time={end}")];
        let case = parse("bar", &format!("{BAR}\n{wall}"), &set).unwrap();
        warnings(&case, &approaches(&case))
    };
    let late = "`run.end_time` is 20 us, before `bar` can reach `wall` at 40 us: a verdict on what is struck comes later";
    assert_eq!(said("20us"), [late]);
    assert_eq!(said("50us"), [""; 0]);
}

#[test]
fn an_end_before_anything_meets_is_told() {
    assert_told(
        &["run.end_time=5us"],
        &[
            "nothing meets: `bar` reaches `plate`, 10.0 spacings away, at 10 us, after the end \
           at 5 us",
        ],
    );
    // Past the plate.
    assert_told(
        &["body.bar.velocity=[\"100 m/s\", 0]"],
        &["nothing meets: no body flies towards another"],
    );
    // Whatever falls or is driven may meet later on, and bodies at rest have other things to do.
    assert_told(&["run.end_time=5us", "gravity=[0, \"-9.81 m/s^2\"]"], &[]);
    assert_told(&["run.end_time=5us", "plane=[{ normal = \"+y\" }]"], &[]);
    assert_told(&["run.end_time=5us", "body.bar.velocity=[0, 0]"], &[]);
    assert_told(
        &[
            "run.end_time=5us",
            "body.bar.touch={ body = \"plate\", direction = \"-y\" }",
        ],
        &[],
    );
}

#[test]
fn a_slanting_flight_and_a_sphere_are_followed() {
    let sphere = "body.bar.shape={ sphere = { centre = [0, \"3 mm\"], radius = \"1 mm\" } }";
    assert_told(&[sphere], &[]);
    let slanting = "body.bar.velocity=[\"300 m/s\", \"-100 m/s\"]";
    assert_told(
        &[slanting],
        &["nothing meets: no body flies towards another"],
    );
    assert_told(
        &[slanting, "body.plate.shape.box.upper=[\"4 mm\", \"1 mm\"]"],
        &[],
    );
}

#[test]
fn a_small_overlap_is_told_in_spacings() {
    let set = ["body.bar.shape.box.lower=[0, \"0.96 mm\"]"];
    assert!(told(&set)[0].starts_with("`bar` and `plate` begin 0.40 spacings within each other"));
    let touching = ["body.bar.shape.box.lower=[0, \"1 mm\"]"];
    assert_told(&touching, &[]);
    let deeper = ["body.bar.shape.box.lower=[0, \"0.9 mm\"]".to_owned()];
    let error = parse("bar", BAR, &deeper).unwrap_err().to_string();
    assert!(
        error.contains("`plate` begins 1.0 spacings within `bar`"),
        "{error}"
    );
}

#[test]
fn thin_bodies_are_told() {
    let thin = |set: &[String]| {
        let case = parse("bar", BAR, set).unwrap();
        advice(&case, &approaches(&case))
    };
    assert!(thin(&[]).is_empty());
    let set = ["body.plate.shape.box.lower=[\"-2 mm\", \"0.5 mm\"]".to_owned()];
    assert_eq!(thin(&set).len(), 1);
    assert!(thin(&set)[0].starts_with("`plate` has 5.0 particles across its thinnest part"));
    // Half of it stands behind the mirror.
    let [a, b] = [
        "body.plate.shape.box.lower=[\"-2 mm\", 0]",
        "body.plate.shape.box.upper=[\"3 mm\", \"0.5 mm\"]",
    ];
    let mirror = "symmetry=[{ axis = \"y\" }]";
    assert!(thin(&[a, b, mirror].map(str::to_owned)).is_empty());
    assert_eq!(thin(&[a, b].map(str::to_owned)).len(), 1);
}

/// 8 particles across do for a body at rest and in the plane, not for what strikes in three dimensions.
#[test]
fn coarse_projectiles_are_told() {
    let sphere = "body.bar.shape={ sphere = { centre = [0, \"3 mm\"], radius = \"0.4 mm\" } }";
    let thin = |set: &[&str]| {
        let set: Vec<String> = set.iter().map(ToString::to_string).collect();
        let case = parse("bar", BAR, &set).unwrap();
        advice(&case, &approaches(&case))
    };
    assert!(thin(&[sphere]).is_empty(), "{:?}", thin(&[sphere]));
    let solid = [
        "dimension=3",
        "body.bar.shape={ sphere = { centre = [0, \"3 mm\", 0], radius = \"0.4 mm\" } }",
        "body.plate.shape={ box = { lower = [\"-2 mm\", 0, \"-2 mm\"], upper = [\"3 mm\", \"0.8 mm\", \"2 mm\"] } }",
        "body.bar.velocity=[0, \"-1 km/s\", 0]",
    ];
    let told = thin(&solid);
    assert_eq!(told.len(), 1, "{told:?}");
    let said = "`bar` has 8.0 particles across its thinnest part; fewer than 10 of what strikes give rough figures";
    assert!(told[0].starts_with(said), "{told:?}");
    let away = [&solid[..3], &["body.bar.velocity=[0, \"1 km/s\", 0]"]].concat();
    assert!(thin(&away).is_empty());
}

#[test]
fn contact_far_from_the_stiffness_of_the_materials_is_told() {
    for (set, said) in [
        (
            "contact={mode=\"potential\",potential={stiffness=50}}",
            "`contact.potential.stiffness` is 50, 50 times its default of 1: contact is stiffer",
        ),
        (
            "contact={mode=\"potential\",potential={stiffness=0.01}}",
            "`contact.potential.stiffness` is 0.01, 100 times below its default of 1: contact is softer",
        ),
        (
            "contact.overlap.stiffness=100",
            "`contact.overlap.stiffness` is 100, 25 times its default of 4",
        ),
    ] {
        let told = told(&[set]);
        assert!(told.len() == 1 && told[0].starts_with(said), "{told:?}");
    }
    assert_told(
        &["contact={mode=\"potential\",potential={stiffness=3}}"],
        &[],
    );
    // Not in use.
    assert_told(&["contact.potential.stiffness=50"], &[]);
}

#[test]
fn impacts_beyond_an_equation_of_state_are_told() {
    let spall = "material.metal.failure.spall.pressure=\"-1.5 GPa\"";
    let fast = "body.bar.velocity=[0, \"-9 km/s\"]";
    let said = told(&[fast, spall]);
    assert_eq!(said.len(), 1, "once for a material: {said:?}");
    assert!(
        said[0].contains("drives `metal` to 1.14 of its sound speed"),
        "{said:?}"
    );
    assert!(said[0].contains("take `tillotson`"));
    assert_told(&["body.bar.velocity=[0, \"-7 km/s\"]", spall], &[]);

    let linear = [
        "material.spring={ density = \"8.9 g/cm^3\", eos.linear.bulk_modulus = \"138 GPa\", \
         strength = \"none\" }",
        "body.bar.material=spring",
        "body.bar.velocity=[0, \"-2 km/s\"]",
    ];
    assert!(told(&linear)[0].contains("`eos.linear` knows no shocks"));
    assert_told(&linear[..2], &[]);
    let drop = [
        "material.water={ density = \"1 g/cm^3\", eos.tait.sound_speed = \"1.5 km/s\", \
         strength = \"none\" }",
        "body.bar.material=water",
        "body.bar.velocity=[0, \"-2 km/s\"]",
    ];
    assert!(told(&drop)[0].contains("`eos.tait` stands for liquids"));
    // Nothing meets, nothing is shocked.
    let past = told(&["body.bar.velocity=[\"9 km/s\", 0]"]);
    assert_eq!(past, ["nothing meets: no body flies towards another"]);
}

#[test]
fn a_shock_through_what_cannot_fail_is_told() {
    let said = told(&["body.bar.velocity=[0, \"-1 km/s\"]"]);
    assert_eq!(said.len(), 1, "once for a material: {said:?}");
    assert!(
        said[0].contains("`metal` cannot fail: what the release of a shock of 21 GPa would tear"),
        "{said:?}"
    );
    let fast = "body.bar.velocity=[0, \"-1 km/s\"]";
    assert_told(&[fast, "material.metal.library=copper-ductile"], &[]);
    assert_told(&[fast, "material.metal.strength=none"], &[]);
    assert_told(&["body.bar.velocity=[0, \"-500 m/s\"]"], &[]);
}

/// The pressure is that of both Hugoniots: an acoustic one would be 52 `GPa`.
#[test]
fn the_shock_that_is_named_is_that_of_the_hugoniots() {
    let fast = "body.bar.velocity=[0, \"-7 km/s\"]";
    let said = told(&[
        fast,
        "material.metal.library=aluminium-2024",
        "material.metal.failure=none",
    ]);
    assert!(
        said.iter().any(|line| line.contains("a shock of 98 GPa")),
        "{said:?}"
    );
}

/// A gas needs a pressure by which rigid surfaces could push it.
#[test]
fn gas_without_pressure_is_told() {
    let set = [
        "contact.mode=none",
        "plane=[{ normal = \"+y\", point = [0, \"-1 mm\"] }]",
        "material.gas={ density = \"1 kg/m^3\", eos.ideal_gas.gamma = 1.4, strength = \"none\" }",
        "body.bar.material=gas",
    ];
    let is_told = |said: &[String]| {
        said.iter()
            .any(|line| line.contains("gas without pressure"))
    };
    assert!(is_told(&told(&set)));
    let hot = [&set[..], &["body.bar.specific_energy=\"1 MJ/kg\""]].concat();
    assert!(!is_told(&told(&hot)));
}

#[test]
fn viscosity_that_acts_as_strength_is_told() {
    let slow = "body.bar.velocity=[0, \"-100 m/s\"]";
    let conventional = "sph.form=conventional";
    let said = told(&[slow, conventional]);
    assert_eq!(said.len(), 1, "once for a material: {said:?}");
    assert!(
        said[0]
            .starts_with("`bar` meets `plate` at 100 m/s: artificial viscosity resists its flow"),
        "{said:?}"
    );
    assert_told(&[slow], &[]);
    assert_told(&[slow, conventional, "sph.alpha=0.1"], &[]);
    assert_told(&[slow, conventional, "material.metal.strength=none"], &[]);
}

#[test]
fn values_that_no_run_has_a_use_for_are_told() {
    assert_told(
        &["material.spare.library=\"copper\""],
        &["no body is of the material `spare`"],
    );
    assert_told(
        &["contact.friction=100"],
        &["`friction` is 100: dry rubber has about 1, and clean metals in vacuum weld beyond 2"],
    );
    assert_told(&["contact.friction=1"], &[]);
    let spall = "material.metal.failure.spall.pressure=\"0 Pa\"";
    assert_told(
        &[spall],
        &[
            "`metal` bears no tension and fails for good at the first of it: give `failure.spall.pressure` \
             what it bears, or `failure.spall.after` as \"recompacts\" or \"hold\"",
        ],
    );
    assert_told(&[spall, "material.metal.failure.spall.after=hold"], &[]);
    assert_told(&["material.metal.failure.spall.pressure=\"-1 GPa\""], &[]);
    assert_told(
        &["sph.alpha=0.05"],
        &[
            "`alpha` is 0.05: so little viscosity leaves short waves to grow, and energy with them, in \
             steps of `courant` = 0.5; take 0.31",
        ],
    );
    assert_told(&["sph.alpha=0.05", "time_step.courant=0.31"], &[]);
    assert!(told(&["sph.alpha=0.1"])[0].ends_with("take 0.39"));
    assert_told(&["sph.alpha=0.1", "time_step.courant=0.39"], &[]);
    assert_told(&["sph.alpha=0.05", "sph.form=conventional"], &[]);
    assert_told(&["sph.alpha=0", "time_step.courant=0.25"], &[]);
    assert_told(&["sph.alpha=0.2"], &[]);
    assert!(told(&["sph.alpha=50"])[0].starts_with("`alpha` is 50: with more than 10"));
    assert_told(
        &["body.plate.shape.box.lower=[\"-2 mm\", \"0.13 mm\"]"],
        &[
            "the box of `plate` is no whole number of spacings of 0.1 mm: in place of [5, 0.87] mm \
             it gets [5, 0.9] mm; `lattice = { kind = \"cubic\", fit = true }` stretches the lattice to \
             fill it",
        ],
    );
    assert_told(&["spacing=\"100 um\""], &[]);
    let long = told(&["run.end_time=\"1e5 s\""]);
    assert!(
        long.len() == 1 && long[0].starts_with("`end_time` is 100000 s, "),
        "{long:?}"
    );
    assert_told(&["run.end_time=\"1e5 s\"", "run.max_steps=100"], &[]);
    let each = told(&["output.snapshot_every=\"1 ps\""]);
    assert!(
        each.len() == 1
            && each[0].starts_with("`snapshot_every` is 1 ps, less than a step of about "),
        "{each:?}"
    );
    assert_told(&["output.snapshot_every=\"1 us\""], &[]);
}

#[test]
fn gentle_starts_that_are_none_are_told() {
    for (sound, doubtful, said) in [
        (
            "body.plate.pressure=1 GPa",
            "body.plate.pressure=300 GPa",
            "the `pressure` that `plate` begins under brings its material to 1.",
        ),
        (
            "relaxation.until=10 us",
            "relaxation.until=2 us",
            "the relaxation leaves ",
        ),
    ] {
        assert_told(&[sound], &[]);
        let told = told(&[doubtful]);
        assert!(told.len() == 1 && told[0].starts_with(said), "{told:#?}");
    }
}

#[test]
fn contact_of_very_different_spacings_is_told() {
    let fine = told(&["body.plate.spacing=\"0.005 mm\""]);
    assert!(
        fine.len() == 1 && fine[0].starts_with("the spacing of `bar` is 20 times that of `plate`"),
        "{fine:?}"
    );
    assert_told(&["body.plate.spacing=\"0.05 mm\""], &[]);
    // What never meets may be as different as it likes.
    let past = [
        "body.plate.spacing=\"0.005 mm\"",
        "body.bar.velocity=[\"100 m/s\", 0]",
    ];
    assert_told(&past, &["nothing meets: no body flies towards another"]);
}

#[test]
fn bodies_that_leave_what_they_touch_are_told() {
    let touch = "body.bar.touch={ body = \"plate\", direction = \"-y\" }";
    assert_told(&[touch], &[]);
    assert_told(
        &[touch, "body.bar.velocity=[0, \"100 m/s\"]"],
        &[
            "`bar` and `plate` begin in touch and fly apart at 100 m/s: is a `velocity` or a `touch` \
             the wrong way round?",
        ],
    );
    // Sliding is no leaving.
    assert_told(&[touch, "body.bar.velocity=[\"100 m/s\", 0]"], &[]);
}

#[test]
fn clouds_of_rings_are_told() {
    let text = |more: &str| {
        format!(
            "dimension = 2\naxisymmetric = true\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\n\
             material.metal.library = \"aluminium-2024-ductile\"\n\
             [[body]]\nname = \"plate\"\nmaterial = \"metal\"\n\
             shape.box = {{ lower = [0, 0], upper = [\"60 mm\", \"10 mm\"] }}\n\
             [[body]]\nname = \"ball\"\nmaterial = \"metal\"\nvelocity = [0, \"-5 km/s\"]\n\
             shape.sphere = {{ radius = \"6 mm\", centre = [0, \"18 mm\"] }}\n{more}"
        )
    };
    let wall = "[[body]]\nname = \"wall\"\nmaterial = \"metal\"\n\
                shape.box = { lower = [0, \"-60 mm\"], upper = [\"60 mm\", \"-50 mm\"] }\n";
    let drills = |text: &str| {
        let case = parse("test.toml", text, &[]).expect("a case");
        let said = warnings(&case, &approaches(&case));
        said.iter().any(|line| line.contains("one of rings"))
    };
    assert!(!drills(&text("")) && drills(&text(wall)));
}

/// A joint of what begins ten spacings from each other holds nothing; one of less energy than its bonds store needs finer particles.
#[test]
fn joints_that_the_spacing_does_not_fit_are_told() {
    let joined = |strength: &str| {
        format!("contact.pair=[{{ bodies = ['bar', 'plate'], joint = {strength} }}]")
    };
    let tough = joined("{ strength = '200 MPa', energy = '10 J/m^2' }");
    let [told_far] = &told(&[&tough])[..] else {
        panic!("{:?}", told(&[&tough]));
    };
    assert_eq!(
        told_far,
        "the joint of `bar` and `plate` holds nothing: they begin 10.5 spacings from each other or more"
    );
    let near = [
        "body.plate.shape.box.upper=['3 mm', '2 mm']",
        "body.bar.velocity=[0, 0]",
    ];
    let [told_tough] = &told(&[near[0], near[1], &tough])[..] else {
        panic!("{:?}", told(&[near[0], near[1], &tough]));
    };
    assert!(
        told_tough.contains("J/m^2 at this spacing, not 10: it stores as much"),
        "{told_tough}"
    );
    assert_told(
        &[
            near[0],
            near[1],
            &joined("{ strength = '20 MPa', energy = '10 J/m^2' }"),
        ],
        &[],
    );
}

/// A sphere, a bumper and a wall: fragments that are few particles wide, and one that planes of symmetry split.
#[test]
fn spheres_too_coarse_for_their_fragments_are_told() {
    let told = |set: &[&str]| {
        let text = "dimension = 3\nspacing = \"0.15 mm\"\nrun.end_time = \"30 us\"\n\
            material.2024.library = \"aluminium-2024-ductile\"\n\
            [[body]]\nname = \"bumper\"\nmaterial = \"2024\"\n\
            shape.cylinder = { axis = \"z\", radius = \"9 mm\", length = \"0.787 mm\" }\n\
            [[body]]\nname = \"wall\"\nmaterial = \"2024\"\n\
            shape.cylinder = { axis = \"z\", radius = \"9 mm\", length = \"2 mm\", centre = [0, 0, \"-52 mm\"] }\n\
            [[body]]\nname = \"sphere\"\nmaterial = \"2024\"\n\
            shape.sphere = { centre = [0, 0, \"3 mm\"], diameter = \"3.175 mm\" }\nspeed = \"4.4 km/s\"\n\
            touch = { body = \"bumper\", direction = \"-z\" }\n";
        let set: Vec<String> = set.iter().map(ToString::to_string).collect();
        let case = parse("shield", text, &set).unwrap_or_else(|error| panic!("{error}"));
        let mut said = advice(&case, &approaches(&case));
        said.retain(|line| line.starts_with("`sphere`"));
        said
    };
    let said = told(&[]);
    assert_eq!(said.len(), 1, "{said:?}");
    let fragments = "`sphere` breaks in `bumper` into fragments of some 825 um, 5.5 particles across; fewer than 8 are dust";
    assert!(said[0].starts_with(fragments), "{said:?}");
    assert!(said[0].contains("a verdict takes a spacing of"));
    let quarter = "symmetry=[{ axis = \"x\" }, { axis = \"y\" }]";
    let fine = "spacing=0.1mm";
    assert!(told(&[fine]).is_empty());
    assert!(told(&[fine, quarter]).is_empty());
    // At 3 km/s a fragment stays on the axis.
    let slow = told(&[fine, quarter, "body.sphere.speed=3km/s"]);
    assert_eq!(slow.len(), 1, "{slow:?}");
    assert!(slow[0].contains("planes of symmetry split the one on the axis"));
    assert!(told(&[fine, "body.sphere.speed=3km/s"]).is_empty());
    // At 7 km/s drops are left, and without an energy of cracks nothing tells their size.
    assert!(told(&["body.sphere.speed=7km/s"]).is_empty());
    assert!(told(&["material.2024.failure.fracture_energy=0 J/m^2"]).is_empty());
}
