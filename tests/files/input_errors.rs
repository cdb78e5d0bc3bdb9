//! Each kind of mistake gives one clear message with file, line, column and a caret.

use std::path::Path;

use files::input::{InputError, load, parse};
use model::pair_terms;

/// A valid case; mistakes are made by replacing parts of it.
const GOOD: &str = r#"title = "a test"
dimension = 3
spacing = "1 mm"

[run]
end_time = "1 us"

[material.metal]
library = "copper"

[[body]]
name = "ball"
material = "metal"
shape.sphere = { radius = "5 mm" }
velocity = [0, 0, "1 km/s"]

[[body]]
name = "brick"
material = "metal"
shape.box = { lower = [0, 0, "1 cm"], upper = ["1 cm", "1 cm", "2 cm"] }

[[contact.pair]]
bodies = ["ball", "brick"]

[[symmetry]]
axis = "x"
"#;

fn message(text: &str, overrides: &[&str]) -> String {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    parse("case.toml", text, &overrides)
        .unwrap_err()
        .to_string()
}

#[test]
fn the_whole_message() {
    let text = GOOD.replace("\"1 km/s\"", "\"1 km\"");
    let expected = r#"error: expected a velocity with a unit, such as "7 km/s", found a length
  --> case.toml:15:19
   |
15 | velocity = [0, 0, "1 km"]
   |                   ^^^^^^"#;
    assert_eq!(message(&text, &[]), expected);
}

#[test]
fn a_misspelled_key_names_the_nearest() {
    let expected = "error: unknown key `materiel`
  --> case.toml:13:1
   |
13 | materiel = \"metal\"
   | ^^^^^^^^ did you mean `material`?
   |
   = help: the choices are `name`, `material`, `shape`, `particles`, `lattice`, `spacing`, `velocity`, `speed`, `angle`, `angular_velocity`, `density`, `areal_density`, `specific_energy`, `temperature`, `plastic_strain`, `pressure`, `stress`, `overburden`, `form`, `fibres`, `touch`, `rigid`, `free`, `moves`, `turns`, `pivot`, `motion`";
    assert_eq!(
        message(&GOOD.replacen("material = ", "materiel = ", 1), &[]),
        expected
    );
}

#[test]
fn an_override_is_shown_itself() {
    let expected = "error: unknown key `velocty`
 --> --set:1:11
  |
1 | body.ball.velocty=[0, 0, 0]
  |           ^^^^^^^ did you mean `velocity`?
  |
  = help: the choices are `name`, `material`, `shape`, `particles`, `lattice`, `spacing`, `velocity`, `speed`, `angle`, `angular_velocity`, `density`, `areal_density`, `specific_energy`, `temperature`, `plastic_strain`, `pressure`, `stress`, `overburden`, `form`, `fibres`, `touch`, `rigid`, `free`, `moves`, `turns`, `pivot`, `motion`";
    let set = [
        "run.max_steps=1",
        "body.ball.velocty=[0, 0, 0]",
        "spacing=2mm",
    ];
    assert_eq!(message(GOOD, &set), expected);
}

/// What is replaced by what, the title and the place.
const IN_FILE: &[(&str, &str, &str, &str)] = &[
    (
        "title = \"a test\"",
        "title = ",
        "string values must be quoted",
        ":1:9",
    ),
    (
        "dimension = 3\n",
        "",
        "the key `dimension` is missing",
        ":1:1",
    ),
    (
        "dimension = 3",
        "dimension = 4",
        "`dimension` must be 1 (uniaxial strain)",
        ":2:13",
    ),
    (
        "dimension = 3",
        "dimension = 2",
        "`velocity` must have 2 components, found 3",
        ":15:12",
    ),
    (
        "spacing = \"1 mm\"\n",
        "",
        "the body `ball` has no `spacing`",
        ":11:8",
    ),
    ("\"1 mm\"", "1", "expected a length with a unit", ":3:11"),
    (
        "\"1 mm\"",
        "\"-1 mm\"",
        "`spacing` must be positive",
        ":3:11",
    ),
    (
        "\"1 mm\"",
        "\"1 nm\"",
        "the body `ball` would have more than",
        ":3:11",
    ),
    ("end_time", "endtime", "unknown key `endtime`", ":6:1"),
    (
        "\"1 us\"",
        "\"1 um\"",
        "such as \"0.2 us\", found a length",
        ":6:12",
    ),
    ("\"1 us\"", "0", "`end_time` must be positive", ":6:12"),
    (
        "library = \"copper\"",
        "library = \"coper\"",
        "unknown material `coper`",
        ":9:11",
    ),
    (
        "library = \"copper\"",
        "",
        "the material `metal` has no `density`",
        ":8:11",
    ),
    (
        "library = \"copper\"",
        "density = \"1 g/cm^3\"",
        "has no `eos`",
        ":8:11",
    ),
    (
        "library = \"copper\"",
        "library = 3",
        "expected a string, found integer `3`",
        ":9:11",
    ),
    (
        "name = \"ball\"\n",
        "",
        "the key `name` is missing",
        ":11:1",
    ),
    (
        "name = \"ball\"",
        "name = \"brick\"",
        "a second body is named `brick`",
        ":18:8",
    ),
    (
        "name = \"ball\"",
        "name = \"7\"",
        "a body's name must have a letter",
        ":12:8",
    ),
    (
        "material = \"metal\"",
        "material = \"mettle\"",
        "unknown material `mettle`",
        ":13:12",
    ),
    (
        "shape.sphere = {",
        "shape.ball = {",
        "unknown key `ball`",
        ":14:7",
    ),
    (
        "{ radius = \"5 mm\" }",
        "{}",
        "the key `radius` is missing",
        ":14:16",
    ),
    (
        "\"5 mm\"",
        "\"0 mm\"",
        "`radius` must be positive",
        ":14:27",
    ),
    (
        "\"5 mm\" }",
        "\"0.4 mm\" }\nlattice = \"cubic\"",
        "the body `ball` is too thin",
        ":14:1",
    ),
    (
        "[0, 0, \"1 km/s\"]",
        "[0, \"1 km/s\"]",
        "must have 3 components, found 2",
        ":15:12",
    ),
    (
        "[0, 0, \"1 km/s\"]",
        "\"1 km/s\"",
        "expected an array, found string",
        ":15:12",
    ),
    (
        "upper = [\"1 cm\"",
        "upper = [0",
        "every edge of a box must be positive",
        ":20:47",
    ),
    (
        "upper =",
        "size =",
        "a box must have `lower` and `upper`",
        ":20:13",
    ),
    (
        "lower = [0, 0, \"1 cm\"], upper = [\"1 cm\", \"1 cm\", \"2 cm\"] }",
        "lower = [\"-0.5 mm\", 0, \"1 cm\"], upper = [\"10.5 mm\", \"1 cm\", \"2 cm\"] }\nlattice = \"cubic\"",
        "does not lie between two layers",
        "",
    ),
    (
        "[\"ball\", \"brick\"]",
        "[\"ball\"]",
        "`bodies` must name two different",
        ":23:10",
    ),
    (
        "[\"ball\", \"brick\"]",
        "[\"ball\", \"bric\"]",
        "unknown body `bric`",
        ":23:19",
    ),
    (
        "[[symmetry]]",
        "[[symetry]]",
        "unknown key `symetry`",
        ":25:3",
    ),
    (
        "axis = \"x\"",
        "axis = \"w\"",
        "unknown choice `w`",
        ":26:8",
    ),
    (
        "axis = \"x\"",
        "axis = \"x\"\nposition = \"1 m\"",
        "has no particle above",
        "",
    ),
    (
        "axis = \"x\"",
        "axis = \"x\"\naxis = \"y\"",
        "duplicate key",
        ":27:1",
    ),
    (
        "axis = \"x\"",
        "axis = \"x\"\n[[symmetry]]\naxis = \"x\"",
        "a second symmetry plane normal to x",
        ":28:8",
    ),
];

#[test]
fn mistakes_in_the_file() {
    assert!(parse("case.toml", GOOD, &[]).is_ok());
    for (from, to, title, place) in IN_FILE {
        let text = GOOD.replacen(from, to, 1);
        assert_ne!(text, GOOD, "{from}");
        let message = message(&text, &[]);
        assert!(message.contains(title), "{to}: {message}");
        assert!(
            message.contains(&format!("--> case.toml{place}")),
            "{to}: {message}"
        );
        assert!(
            message.starts_with("error: ") && message.contains('^'),
            "{message}"
        );
    }
}

/// An override, the title and the column.
const IN_OVERRIDES: &[(&str, &str, usize)] = &[
    ("spacing", "an override needs a `=`", 1),
    ("spacing=", "an override needs a value", 9),
    ("=1", "this is not a dotted key", 1),
    ("spacing=1 kn", "unknown unit `kn`", 9),
    ("spacng=1 mm", "unknown key `spacng`", 1),
    ("spacing.x=1", "there are no keys below a plain value", 9),
    ("body.bal.velocity=[0, 0, 0]", "unknown element `bal`", 6),
    (
        "symmetry.1.axis=x",
        "there is no element `1` in this list",
        10,
    ),
    ("body.ball.velocity=[0, 0", "unclosed array", 25),
    ("contact.mode=overlp", "unknown choice `overlp`", 14),
    (
        "contact.overlap.core_radius=2",
        "`core_radius` must be between 0 and 1",
        29,
    ),
    (
        "contact.potential.exponent=0",
        "`exponent` must be between 1 and 100",
        28,
    ),
    ("run.max_steps=-1", "`max_steps` must be 1 or more", 15),
    (
        "time_step.courant=1.5",
        "`courant` must be above 0 and at most 1",
        19,
    ),
    ("sph.alpha=nan", "`alpha` must be zero or positive", 11),
    (
        "sph.alpha=much",
        "expected a number, found string \"much\"",
        11,
    ),
    (
        "sph.artificial_stress=3",
        "`artificial_stress` must be between 0 and 1",
        23,
    ),
    (
        "sph.conduction=-1",
        "`conduction` must be between 0 and 2",
        16,
    ),
    ("sph.xsph=1.1", "`xsph` must be between 0 and 1", 10),
    ("sph.balsara=1", "expected `true` or `false`", 13),
    ("output.fields=[\"presure\"]", "unknown field `presure`", 16),
    ("output.fields=[\"body\", \"body\"]", "is listed twice", 24),
    (
        "output.checkpoints_kept=0",
        "`checkpoints_kept` must be 1 or more",
        25,
    ),
    (
        "material.metal.failure.spall={}",
        "the key `pressure` is missing",
        30,
    ),
    (
        "material.metal.failure.spall.pressure=1 GPa",
        "`pressure` must be zero or negative",
        39,
    ),
    (
        "material.metal.eos={linear={}}",
        "the key `bulk_modulus` is missing",
        20,
    ),
    (
        "material.metal.strength={}",
        "`strength` must have exactly one of",
        25,
    ),
    (
        "material.metal.eos={tait={gamma=7}, linear={}}",
        "`eos` must have exactly one of",
        20,
    ),
    (
        "material.metal.eos={tait={gamma=7}}",
        "`eos.tait` needs `sound_speed` or `b`",
        20,
    ),
    (
        "material.metal.eos={tait={b=\"3 kbar\", sound_speed=\"20 m/s\"}}",
        "`b` and `sound_speed` say the same twice",
        51,
    ),
    (
        "material.metal.eos={ideal_gas={gamma=1}}",
        "`gamma` must be above 1",
        38,
    ),
    (
        "material.metal.eos={tillotson={a=0.5}}",
        "the key `b` is missing",
        20,
    ),
    (
        "material.metal.strength={viscous={viscosity=\"1 mPa\"}}",
        "expected a dynamic viscosity with a unit, such as \"1 mPa s\", found a pressure",
        45,
    ),
    (
        "material.metal.thermal={specific_heat=\"383 J/kg\"}",
        "expected a specific heat with a unit, such as \"896 J/(kg K)\", found a specific energy",
        39,
    ),
    (
        "material.metal.thermal={specific_heat=\"383 J/(kg K)\", melting_temperature=\"200 K\"}",
        "`melting_temperature` must be above `reference_temperature`",
        75,
    ),
    (
        "body.ball.density=-1 g/cm^3",
        "`density` must be positive",
        19,
    ),
    ("spacing+=1 mm", "only a list gets one more element", 1),
    (
        "body.ball.specific_energy=1 J",
        "expected a specific energy with a unit",
        27,
    ),
    (
        "body.ball.touch={body=\"ball\",direction=\"+x\"}",
        "unknown body `ball`",
        23,
    ),
    (
        "body.ball.lattice={kind=\"cubic\",angle=\"1 m\"}",
        "expected an angle",
        39,
    ),
];

#[test]
fn mistakes_in_overrides() {
    for (set, title, column) in IN_OVERRIDES {
        let message = message(GOOD, &[set]);
        assert!(message.contains(title), "{set}: {message}");
        let place = match column {
            0 => "--> case.toml:".to_owned(),
            _ => format!("--> --set:1:{column}\n"),
        };
        assert!(message.contains(&place), "{set}: {message}");
    }
}

/// A case with loads.
const LOADED: &str = r#"dimension = 2
spacing = "1 mm"
gravity = [0, "-9.81 m/s^2"]
run.end_time = "1 us"
material.metal.library = "copper"

[[body]]
name = "block"
material = "metal"
shape.box = { lower = [0, 0], upper = ["5 mm", "5 mm"] }

[[body]]
name = "tool"
rigid = true
shape.box = { lower = [0, "-5 mm"], upper = ["5 mm", 0] }
motion = { times = [0, "1 us"], y = [0, "1 m/s"] }

[[load]]
name = "grip"
body = "block"
below = { x = "1 spacing" }
velocity = { x = "1 m/s" }
until = "1 us"

[[plane]]
normal = "+x"

[[symmetry]]
axis = "x"
"#;

/// What is replaced by what in [`LOADED`], the title and the place.
const IN_LOADS: &[(&str, &str, &str, &str)] = &[
    (
        "\"-9.81 m/s^2\"",
        "\"-9.81 m/s\"",
        "expected an acceleration with a unit, such as \"9.81 m/s^2\", found a velocity",
        ":3:15",
    ),
    (
        "gravity = [0, ",
        "gravity = [",
        "`gravity` must have 2 components, found 1",
        ":3:11",
    ),
    (
        "gravity = [0, \"-9.81 m/s^2\"]",
        "gravity = [\"1 m/s2\", 0]",
        "gravity along x is not its own mirror image",
        ":3:12",
    ),
    (
        "material = \"metal\"\n",
        "",
        "the key `material` is missing",
        ":7:1",
    ),
    (
        "rigid = true\n",
        "material = \"metal\"\n",
        "only a rigid body has a `motion`",
        ":16:10",
    ),
    (
        "rigid = true\n",
        "rigid = true\nvelocity = [0, \"1 m/s\"]\n",
        "a rigid body has a `velocity` or a `motion`, not both",
        ":17:10",
    ),
    (
        "name = \"block\"",
        "name = \"block\"\nrigid = true",
        "every body is rigid",
        ":7:1",
    ),
    (
        "y = [0, \"1 m/s\"]",
        "y = [0]",
        "`y` must have 2 values as `times` has, found 1",
        ":16:37",
    ),
    (
        "times = [0, \"1 us\"], ",
        "",
        "`y` is a table of time without `times`",
        ":16:16",
    ),
    (
        "times = [0, \"1 us\"]",
        "times = [\"1 us\", 0]",
        "never fall",
        ":16:29",
    ),
    (
        "motion = { times = [0, \"1 us\"], y",
        "motion = { times = [0, \"1 us\"], z",
        "a 2-dimensional case has no z axis",
        ":16:37",
    ),
    (
        "{ x = \"1 m/s\" }",
        "{}",
        "a velocity must be given along at least one of `x`, `y`, `z`",
        ":22:12",
    ),
    (
        "{ x = \"1 m/s\" }",
        "{ x = true }",
        "expected a velocity with a unit, such as \"7 km/s\", or an array of such",
        ":22:18",
    ),
    (
        "body = \"block\"",
        "body = \"blok\"",
        "unknown body `blok`",
        ":20:8",
    ),
    (
        "body = \"block\"",
        "body = \"tool\"",
        "the body `tool` is rigid",
        ":20:8",
    ),
    (
        "below = { x = \"1 spacing\" }",
        "below = { x = \"-1 mm\" }",
        "the region holds no particle of `block`",
        ":21:9",
    ),
    (
        "below = { x = \"1 spacing\" }",
        "below = { z = \"1 mm\" }",
        "a 2-dimensional case has no z axis",
        ":21:15",
    ),
    (
        "until = \"1 us\"",
        "until = 0",
        "`until` must be positive",
        ":23:9",
    ),
    (
        "name = \"grip\"",
        "name = \"tool\"",
        "the name `tool` is taken already",
        ":19:8",
    ),
    (
        "\"+x\"",
        "\"+z\"",
        "a 2-dimensional case has no z axis",
        ":26:10",
    ),
    (
        "\"+x\"",
        "[1, 0, 0]",
        "`normal` must have 2 components, found 3",
        ":26:10",
    ),
    (
        "\"+x\"",
        "[0, 0]",
        "`normal` must be a vector of some length",
        ":26:10",
    ),
    (
        "\"+x\"",
        "\"-x\"",
        "the body `block` reaches 4.500 spacings behind the plane",
        ":26:10",
    ),
    (
        "normal = \"+x\"",
        "normal = \"+x\"\nbodies = [\"tool\"]",
        "the body `tool` is rigid: no surface moves it",
        ":27:11",
    ),
    (
        "normal = \"+x\"",
        "normal = \"+x\"\nstiffness = 0",
        "`stiffness` must be positive",
        ":27:13",
    ),
    (
        "[[symmetry]]",
        "[contact]\nmode = \"kernel\"\n\n[[symmetry]]",
        "the rigid body `tool` cannot have contact of mode `kernel`",
        ":13:8",
    ),
    (
        "[[symmetry]]",
        "[[contact.pair]]\nbodies = [\"block\", \"tool\"]\nmode = \"kernel\"\n\n[[symmetry]]",
        "the rigid body `tool` cannot have contact of mode `kernel`",
        ":29:20",
    ),
    (
        "[[symmetry]]",
        "[[contact.pair]]\nbodies = [\"block\", \"tool\"]\nmode = \"penalty\"\n\n[[symmetry]]",
        "the rigid body `tool` cannot have contact of mode `penalty`",
        ":29:20",
    ),
];

/// As [`IN_OVERRIDES`], of a material without heat.
const WITHOUT_HEAT: &[(&str, &str, usize)] = &[
    (
        "material.metal.strength={johnson_cook={a=\"90 MPa\",b=\"292 MPa\",n=0.31,c=0.025,m=1.09}}",
        "this strength follows the temperature and needs `thermal.specific_heat`",
        25,
    ),
    (
        "material.metal.thermal={}",
        "the key `specific_heat` is missing",
        24,
    ),
    (
        "output.fields=[\"temperature\"]",
        "no material has `thermal` constants",
        16,
    ),
];

#[test]
fn mistakes_in_loads() {
    parse("case.toml", LOADED, &[]).unwrap_or_else(|error| panic!("{error}"));
    for (old, new, title, place) in IN_LOADS {
        assert!(LOADED.contains(old), "{old}");
        let message = message(&LOADED.replacen(old, new, 1), &[]);
        assert!(message.contains(title), "{new}: {message}");
        let place = format!("--> case.toml{place}\n");
        assert!(message.contains(&place), "{new}: {message}");
    }
    let one = LOADED[LOADED.find("[[load]]").unwrap()..LOADED.find("[[plane]]").unwrap()]
        .replace("name = \"grip\"\n", "");
    let message = message(&(LOADED.to_owned() + &one.repeat(31)), &[]);
    assert!(
        message.contains("at most 32 loads and rigid bodies together"),
        "{message}"
    );
}

#[test]
fn heat_is_asked_for() {
    let cold = GOOD.replace("\"copper\"", "\"steel-bar\"");
    for (set, title, column) in WITHOUT_HEAT {
        let message = message(&cold, &[set]);
        assert!(message.contains(title), "{set}: {message}");
        assert!(
            message.contains(&format!("--> --set:1:{column}\n")),
            "{set}: {message}"
        );
    }
}

#[test]
fn contact_needs_a_modulus() {
    let gas = "material.metal={density=\"1 g/cm^3\",eos={ideal_gas={gamma=1.4}},strength=\"none\"}";
    let message = message(GOOD, &[gas]);
    assert!(
        message.contains("the gas `metal` has no modulus"),
        "{message}"
    );
    assert!(message.contains("--> case.toml:13:12\n"), "{message}");
    assert!(
        parse(
            "none",
            GOOD,
            &[gas, "contact.pair=[]", "contact.mode=kernel"].map(String::from)
        )
        .is_ok()
    );
}

#[test]
fn bodies_may_not_touch_in_a_circle() {
    let set = [
        "body.ball.touch={body=\"brick\",direction=\"+x\"}",
        "body.brick.touch={body=\"ball\",direction=\"+x\"}",
    ];
    assert!(message(GOOD, &set).contains("bodies touch each other in a circle"));
}

#[test]
fn shapes_fit_the_dimension() {
    let flat = r#"
        dimension = 1
        spacing = "1 mm"
        run.end_time = "1 us"
        material.a.library = "copper"
        [[body]]
        name = "a"
        material = "a"
        shape.sphere.radius = "1 cm"
    "#;
    assert!(message(flat, &[]).contains("a 1-dimensional case has no sphere"));
    let row = flat.replace("sphere.radius = \"1 cm\"", "box.size = [\"1 cm\"]");
    assert!(parse("row", &row, &[]).is_ok());
    let hexagonal = message(&row, &["body.a.lattice=hexagonal"]);
    assert!(hexagonal.contains("`lattice` must be \"cubic\""));
    assert!(message(&row, &["domain.axis=y"]).contains("a 1-dimensional case has no y axis"));
    let both = ["domain.axis=x", "domain.axes=[\"x\"]"];
    assert!(message(&row, &both).contains("`axis` and `axes` both say"));
    let two = message(&row, &["domain.levels=2"]);
    assert!(two.contains("`levels` must be \"auto\" or a whole number from 1 to 1"));
}

#[test]
fn a_missing_file_is_named() {
    let error = load(Path::new("no/such/case.toml"), &[]).unwrap_err();
    assert!(matches!(error, InputError::Read { .. }));
    assert!(
        error
            .to_string()
            .contains("cannot read the case no/such/case.toml")
    );
}

/// What stress points do not go with is refused where the form is asked for.
#[test]
fn stress_points_say_what_they_do_not_go_with() {
    let form = "[sph]\nform = \"stress_points\"\n";
    for (more, expected) in [
        ("xsph = 0.5", "`xsph` could act in"),
        ("[contact]\nmode = \"kernel\"", "contact of mode `kernel`"),
        ("[contact]\nmode = \"penalty\"", "contact of mode `penalty`"),
    ] {
        let text = GOOD.replace("[run]", &format!("{form}{more}\n\n[run]"));
        let message = message(&text, &[]);
        assert!(message.contains(expected), "{message}");
        assert!(message.contains("case.toml:6:8"), "{message}");
    }
    let text = GOOD.replace("[run]", &format!("{form}\n[run]"));
    let hexagonal = text
        .replace(
            "material = \"metal\"",
            "material = \"metal\"\nlattice = \"hexagonal\"",
        )
        .replace("[[symmetry]]\naxis = \"x\"\n", "");
    let message = message(&hexagonal, &[]);
    assert!(message.contains("that of `ball` is hexagonal"), "{message}");
}

/// Each pair term of the table is refused by its key where it cannot act.
#[test]
fn pair_terms_are_refused_where_they_cannot_act() {
    macro_rules! switched_on {
        ($( $(#[$doc:meta])+ $term:ident { $key:ident: $typed:ident $($more:tt)+ } )+) => {
            [$( (stringify!($key), if stringify!($typed) == "bool" { "true" } else { "0.5" }) ),+]
        };
    }
    for (key, value) in pair_terms!(switched_on) {
        let term = format!("sph.{key}={value}");
        assert!(parse("good", GOOD, std::slice::from_ref(&term)).is_ok());
        for (other, said) in [
            (
                "sph.form=stress_points",
                format!("stress points have no pairs of particles that `{key}` could act in"),
            ),
            (
                "body.ball.form=total",
                format!(
                    "the body `ball` cannot have the total form: `sph.{key}` needs the neighbours of each step"
                ),
            ),
        ] {
            let message = message(GOOD, &[&term, other]);
            assert!(message.contains(&said), "{message}");
        }
    }
}

/// What a symmetry plane cuts does not move across it; what comes from afar, or begins at it, may.
#[test]
fn what_a_plane_cuts_does_not_move_across_it() {
    let ball = |more: &str| GOOD.replace("velocity = [0, 0, \"1 km/s\"]", more);
    let and = |more: &str| format!("{GOOD}{more}");
    let rigid = |more: &str| {
        let text = ball(more).replacen("material = \"metal\"\n", "", 1);
        text.replace("name = \"ball\"\n", "name = \"ball\"\nrigid = true\n")
    };
    let load = |more: &str| {
        and(&format!(
            "[[load]]\nname = \"grip\"\nbody = \"ball\"\n{more}\n"
        ))
    };
    let table = |more: &str| {
        and(&format!(
            "[[plane]]\nname = \"lid\"\npoint = [0, 0, \"5 cm\"]\n{more}\n"
        ))
    };
    let roll = |more: &str| {
        and(&format!(
            "[[surface]]\nname = \"roll\"\nshape.sphere = {{ centre = [0, 0, \"-3 cm\"], radius = \"1 cm\" }}\n{more}\n"
        ))
    };
    for (text, what) in [
        (ball("velocity = [\"1 m/s\", 0, \"1 km/s\"]"), "`ball`"),
        (
            ball("velocity = [\"1 m/s + 1 m/s * x / 1 mm\", 0, 0]"),
            "`ball`",
        ),
        (rigid("velocity = [\"-1 m/s\", 0, 0]"), "`ball`"),
        (
            rigid("motion = { times = [0, \"1 us\"], x = [0, \"1 m/s\"] }"),
            "`ball`",
        ),
        (load("velocity = { x = \"1 m/s\" }"), "what `grip` drives"),
        (
            load("below = { z = 0 }\nvelocity = { x = \"1 m/s\" }"),
            "what `grip` drives",
        ),
        (
            table("normal = \"-z\"\nmotion = { x = \"1 m/s\" }"),
            "`lid`",
        ),
        (roll("motion = { x = \"1 m/s\" }"), "`roll`"),
        (
            roll("rotation = { axis = \"z\", rate = \"1 rad/s\" }"),
            "`roll`",
        ),
    ] {
        let message = message(&text, &[]);
        let expected = format!("error: {what} moves across the symmetry plane of x that cuts it");
        assert!(message.starts_with(&expected), "{message}");
    }
    for text in [
        ball("velocity = [\"1 m/s * x / 1 mm\", 0, 0]"),
        ball("angular_velocity = [\"1 rad/s\", 0, 0]"),
        ball("velocity = [\"-1 km/s\", 0, 0]").replace(
            "shape.sphere = { radius",
            "shape.sphere = { centre = [\"9 mm\", 0, 0], radius",
        ),
        GOOD.replace("\"2 cm\"] }", "\"2 cm\"] }\nvelocity = [\"-1 m/s\", 0, 0]"),
        load("above = { x = \"3 mm\" }\nvelocity = { x = \"1 m/s\" }"),
        table("normal = \"-z\"\nmotion = { z = \"-1 m/s\" }"),
        roll("rotation = { axis = \"x\", rate = \"1 rad/s\" }"),
    ] {
        parse("case.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// A pivot is of a free rigid body that can turn about it, and has no other velocity.
#[test]
fn a_pivot_has_a_spin_alone() {
    let wheel = |dimension: usize, more: &str| {
        let sides = vec!["\"8 mm\""; dimension].join(", ");
        format!(
            "dimension = {dimension}\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\n\
             material.metal.library = \"copper\"\n[[body]]\nname = \"wheel\"\nrigid = true\nfree = true\n\
             material = \"metal\"\nshape.box.size = [{sides}]\n{more}\n"
        )
    };
    let symmetry = |axis: &str| format!("[[symmetry]]\naxis = \"{axis}\"\n");
    let pivot = "pivot = [0, 0, \"9 mm\"]\n";
    let planes = format!("{pivot}{}", symmetry("x"));
    for (text, said) in [
        (
            wheel(1, "pivot = [0]"),
            "in one dimension nothing turns about a `pivot`",
        ),
        (
            wheel(2, &format!("pivot = [0, 0]\n{}", symmetry("x"))),
            "a body with a `pivot` would turn through the symmetry planes of the case",
        ),
        (
            wheel(3, &format!("{planes}{}", symmetry("y"))),
            "a body with a `pivot` would turn through the symmetry planes of the case",
        ),
        (
            wheel(3, &format!("{pivot}velocity = [\"1 m/s\", 0, 0]")),
            "a body with a `pivot` turns, and does nothing else",
        ),
        (
            wheel(3, &format!("{pivot}moves = [\"x\"]")),
            "a body with a `pivot` turns, and does nothing else",
        ),
        (
            wheel(
                3,
                &format!("{pivot}angular_velocity = {{ rate = [0, 0, 0], about = [0, 0, 0] }}"),
            ),
            "a body with a `pivot` turns about that",
        ),
    ] {
        let message = message(&text, &[]);
        assert!(
            message.starts_with(&format!("error: {said}\n")),
            "{message}"
        );
    }
    for text in [
        wheel(2, "pivot = [0, 0]\nangular_velocity = [\"1 rad/s\"]"),
        wheel(3, &planes),
    ] {
        parse("case.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// What has no mass, no end or no pairs of particles does not attract.
#[test]
fn self_gravity_refuses_what_does_not_attract() {
    let text = GOOD.to_owned() + "\n[self_gravity]\n";
    assert!(parse("case.toml", &text, &[]).is_ok());
    let absorb = "absorb = [{ body = \"brick\", faces = [\"+z\"], depth = \"5 mm\" }]";
    for (change, said) in [
        (
            "body.brick.rigid=true",
            "`brick` has no mass that could attract",
        ),
        (absorb, "absorbing zones stand for matter without end"),
        (
            "sph.form=\"stress_points\"",
            "stress points do not know self-gravity",
        ),
    ] {
        let changes: Vec<&str> = if change.contains("stress_points") {
            vec![
                change,
                "body.ball.lattice=\"cubic\"",
                "body.brick.lattice=\"cubic\"",
            ]
        } else {
            vec![change]
        };
        let found = message(&text, &changes);
        assert!(found.contains(said), "{found}");
    }
    let flat = r#"
dimension = 2
spacing = "1 mm"
run.end_time = "1 us"
self_gravity = {}
material.metal.library = "copper"
[[body]]
name = "disc"
material = "metal"
shape.sphere.radius = "5 mm"
"#;
    let found = message(flat, &[]);
    assert!(
        found.contains("bodies in 2 dimensions are infinite, and so is their gravity"),
        "{found}"
    );
}

#[test]
fn rings_refuse_what_they_do_not_have() {
    let text = r#"
dimension = 2
axisymmetric = true
spacing = "1 mm"
run.end_time = "1 us"
material.metal.library = "copper"
[[body]]
name = "disc"
material = "metal"
shape.box = { lower = [0, 0], upper = ["5 mm", "2 mm"] }
"#;
    for (change, said) in [
        (
            "symmetry=[{ axis = \"x\" }]",
            "no other plane is normal to x",
        ),
        ("sph.form=conventional", "`sph.form` must be \"corrected\""),
        ("sph.xsph=0.1", "`sph.xsph` is not theirs"),
        ("fragments={}", "`fragments` does not tell them apart"),
        ("contact.mode=penalty", "`contact.mode` must be"),
        (
            "gravity=[\"1 m/s^2\", 0]",
            "gravity along x is not its own mirror image",
        ),
        (
            "body.disc.velocity=[\"1 m/s\", 0]",
            "it can move along y alone",
        ),
        (
            "body.disc.form=total",
            "its particles are rings about an axis",
        ),
        (
            "body.disc.spacing={ inner = \"1 mm\", outer = \"2 mm\", at = [0, 0], within = \"1 mm\" }",
            "its `spacing` must be the same everywhere",
        ),
        (
            "pressure=[{ body = \"disc\", value = \"1 GPa\" }]",
            "`[[pressure]]` does not act on them",
        ),
    ] {
        let found = message(text, &[change]);
        assert!(found.contains(said), "{change}: {found}");
    }
}
