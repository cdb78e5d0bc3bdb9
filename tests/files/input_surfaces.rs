//! Mistakes in rigid surfaces and their files: one clear message each; and how files are kept.

use comm::Comm;
use engine::step::Simulation;
use files::input::{load, parse};
use files::preflight::{approaches, warnings};
use model::Case;
use populate::{bounds, smallest_gap};

const GOOD: &str = r#"dimension = 3
spacing = "1 mm"
run.end_time = "1 us"
material.metal.library = "copper"

[[body]]
name = "block"
material = "metal"
shape.box = { lower = [0, 0, 0], upper = ["6 mm", "6 mm", "6 mm"] }

[[surface]]
shape.stl = { file = "tests/common/hook.stl", unit = "1 mm", at = ["3 mm", "3 mm", "2 cm"] }
"#;

const STL: &str = "shape.stl = { file = \"tests/common/hook.stl\", unit = \"1 mm\", at = [\"3 mm\", \"3 mm\", \"2 cm\"] }";

fn message(text: &str) -> String {
    crate::project::enter();
    parse("case.toml", text, &[]).unwrap_err().to_string()
}

/// What is replaced by what, the title, and what the caret stands under.
const MISTAKES: &[(&str, &str, &str, &str)] = &[
    (
        "hook.stl",
        "nook.stl",
        "cannot take the surface `tests/common/nook.stl`: No such file",
        "\"tests/common/nook",
    ),
    (
        "hook.stl",
        "loaded.toml",
        "it is no STL file",
        "\"tests/common",
    ),
    (
        ", unit = \"1 mm\"",
        "",
        "the key `unit` is missing",
        "{ file",
    ),
    (
        "unit = \"1 mm\"",
        "unit = 0",
        "`unit` must be positive",
        "0, at",
    ),
    (
        "unit = \"1 mm\"",
        "unit = \"1 mm\", sha256 = \"00\"",
        "is no longer the one that the case began with",
        "\"00\"",
    ),
    (
        "\"2 cm\"]",
        "\"2 mm\"]",
        "the body `block` reaches 0.500 spacings behind the surface",
        "shape.stl =",
    ),
    (
        ", \"2 cm\"]",
        "]",
        "`at` must have 3 components, found 2",
        "[\"3 mm\"",
    ),
    (
        STL,
        "shape = { stl = { file = \"x\", unit = \"1 mm\" }, sphere = { radius = \"1 mm\" } }",
        "`shape` must have exactly one of",
        "{ stl",
    ),
    (
        STL,
        "shape.sphere.radius = 0",
        "`radius` must be positive",
        "0\n",
    ),
    (
        STL,
        "shape.sphere.radius = \"1 mm\"\nside = \"within\"",
        "unknown choice `within`",
        "\"within",
    ),
    (
        STL,
        "shape = { sphere = { radius = \"1 mm\" } }\nside = \"inside\"",
        "spacings behind the surface",
        "{ sphere",
    ),
    (
        STL,
        "shape.cylinder = { radius = \"1 mm\", axis = \"y\", length = \"-1 mm\" }",
        "`length` must be positive",
        "\"-1 mm",
    ),
    (
        STL,
        "shape.sphere.radius = \"1 mm\"\nrotation = { axis = \"x\", rate = \"1 /s\" }",
        "expected an angular rate",
        "\"1 /s",
    ),
    (
        STL,
        "shape.sphere = { radius = \"1 mm\", centre = [0, 0, \"-1 cm\"] }\nbodies = [\"rock\"]",
        "unknown body `rock`",
        "\"rock",
    ),
];

#[test]
fn mistakes_in_surfaces() {
    crate::project::enter();
    parse("case.toml", GOOD, &[]).unwrap_or_else(|error| panic!("{error}"));
    for (old, new, title, caret) in MISTAKES {
        assert!(GOOD.contains(old), "{old}");
        let text = GOOD.replacen(old, new, 1);
        let message = message(&text);
        assert!(message.contains(title), "{new}: {message}");
        let change = GOOD.find(old).expect("there");
        let line_start = GOOD[..change].rfind('\n').map_or(0, |n| n + 1);
        let at = line_start + text[line_start..].find(caret).expect("there");
        let line = text[..at].matches('\n').count() + 1;
        let column = at - text[..at].rfind('\n').map_or(0, |n| n + 1) + 1;
        let place = format!("--> case.toml:{line}:{column}\n");
        assert!(message.contains(&place), "{new}, {place}: {message}");
    }
}

#[test]
fn a_surface_must_be_closed() {
    crate::project::enter();
    let folder = tempfile::tempdir().expect("a folder");
    let stl = std::fs::read_to_string("tests/common/hook.stl").expect("the hook");
    let cut = stl.find("facet").expect("a facet");
    let next = cut + 5 + stl[cut + 5..].find("\nfacet").expect("another") + 1;
    let open = format!("{}{}", &stl[..cut], &stl[next..]);
    std::fs::write(folder.path().join("open.stl"), open).expect("written");
    let text = GOOD.replace("tests/common/hook.stl", "open.stl");
    let path = folder.path().join("case.toml");
    std::fs::write(&path, &text).expect("written");
    let message = load(&path, &[]).unwrap_err().to_string();
    assert!(
        message.contains("it is not closed: 3 edges have no second triangle"),
        "{message}"
    );
    assert!(message.contains("closed solids"), "{message}");
}

/// The resolved text names the file wherever it is read from, and its digest.
#[test]
fn the_resolved_case_finds_its_files() {
    let path = crate::project::root().join("inputs/punch/case.toml");
    for overrides in [vec![], vec!["spacing=\"0.5 mm\"".to_owned()]] {
        let case = load(&path, &overrides).unwrap_or_else(|error| panic!("{error}"));
        let again = parse("elsewhere/case.toml", &case.resolved, &[]);
        let again = again.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(again.loads, case.loads);
        assert_eq!(again.resolved, case.resolved);
        assert!(case.resolved.contains("sha256"));
    }
}

/// A body on one plane or more, to be completed.
fn on_planes(dimension: usize, body: &str, rest: &str) -> Case {
    let text = format!(
        "dimension = {dimension}\nspacing = \"0.3 mm\"\nrun.end_time = \"1 us\"\n\
         material.metal.library = \"copper\"\n[[body]]\nname = \"rod\"\nmaterial = \"metal\"\n\
         {body}\n{rest}"
    );
    parse("case.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// How far the first body begins from each plane, in spacings.
fn gaps(case: &Case) -> Vec<f64> {
    let body = &case.bodies[0];
    let gap = |plane| smallest_gap(body, case.dimension, &case.symmetry, plane);
    let planes = case.loads.surfaces.iter();
    planes
        .map(|plane| gap(plane) / body.lattice.spacing)
        .collect()
}

/// What no force is on, and what is told of it: nothing of planes.
fn assert_in_touch(case: Case, name: &str) {
    for gap in gaps(&case) {
        assert!((gap - 0.5).abs() < 2e-9, "{name}: {gap}");
    }
    let told = warnings(&case, &approaches(&case));
    assert!(told.iter().all(|line| !line.contains("pushes")), "{told:?}");
    let mut simulation = Simulation::start(case, &Comm::solo()).unwrap();
    let still = |s: &Simulation| {
        s.particles
            .contact_acceleration
            .iter()
            .all(|a| *a == [0.0; 3])
    };
    assert!(still(&simulation), "{name}");
    assert_eq!(simulation.state.contact_energy.to_bits(), 0, "{name}");
    // No gap either: the first step leads into the plane.
    for (v, x) in simulation
        .particles
        .velocity
        .iter_mut()
        .zip(&simulation.particles.position)
    {
        *v = x.map(|x| -1e6 * x);
    }
    simulation.advance(&Comm::solo()).unwrap();
    assert!(!still(&simulation), "{name}");
}

const FLOOR: &str = "[[plane]]\nnormal = \"+z\"";
const WALLS: &str = "[[plane]]\nnormal = \"+x\"\n[[plane]]\nnormal = \"+y\"";

/// A body whose shape rests on planes begins in touch with them, whatever its lattice leaves
/// between its outermost layer and its shape.
#[test]
fn bodies_that_rest_on_planes_begin_in_touch() {
    let rod = |lattice: &str, length: f64| {
        let middle = 0.5 * length;
        format!(
            "lattice = {lattice}\nshape.cylinder = {{ radius = \"1 mm\", length = \"{length} mm\", \
             centre = [0, 0, \"{middle} mm\"] }}"
        )
    };
    for length in [3.0, 3.24, 3.3, 3.5] {
        for lattice in ["\"cubic\"", "\"hexagonal\"", "\"rings\""] {
            let name = format!("{lattice}, {length} mm");
            assert_in_touch(on_planes(3, &rod(lattice, length), FLOOR), &name);
        }
    }
    let turned = "lattice = { kind = \"hexagonal\", angle = \"20 deg\" }\n\
                  shape.box = { lower = [0, 0], upper = [\"3 mm\", \"2 mm\"] }";
    assert_in_touch(on_planes(2, turned, WALLS), "a turned lattice in a corner");
    let disc = |lattice: &str| {
        let height = "\"1.4142135623730951 mm\"";
        format!(
            "lattice = {lattice}\nshape.sphere = {{ radius = \"1 mm\", centre = [0, {height}] }}"
        )
    };
    let slope = "[[plane]]\nnormal = [1, 1]";
    assert_in_touch(on_planes(2, &disc("\"rings\""), slope), "rings on a slope");
    assert_in_touch(on_planes(2, &disc("\"cubic\""), slope), "a disc on a slope");
}

/// What stays where it is: between two plates, cut by a symmetry plane, off the plane; and a body
/// that touches another one moves with that.
#[test]
fn bodies_on_planes_move_no_further_than_into_touch() {
    let block = "lattice = \"hexagonal\"\n\
                 shape.box = { lower = [0, 0, 0], upper = [\"2 mm\", \"2 mm\", \"3.3 mm\"] }";
    let plates = format!("{FLOOR}\n[[plane]]\nnormal = \"-z\"\npoint = [0, 0, \"3.3 mm\"]");
    let [lower, upper] = gaps(&on_planes(3, block, &plates))[..] else {
        panic!("two plates")
    };
    assert!(
        (lower - upper).abs() < 1e-9 && (lower - 0.5).abs() > 0.01,
        "{lower} {upper}"
    );

    let cut = "lattice = \"hexagonal\"\n\
               shape.box = { lower = [\"-1 mm\", 0], upper = [\"1 mm\", \"2 mm\"] }";
    let slope = "[[symmetry]]\naxis = \"x\"\n[[plane]]\nnormal = \"-x\"\npoint = [\"1 mm\", 0]";
    let free = gaps(&on_planes(2, cut, slope))[0];
    assert!((free - 0.5).abs() > 0.01, "{free}");

    let above = block.replace("0, 0, 0]", "0, 0, \"0.01 mm\"]");
    let apart = gaps(&on_planes(3, &above, FLOOR))[0];
    assert!((apart - 0.5).abs() > 0.01, "{apart}");

    let second = format!(
        "[[body]]\nname = \"lid\"\nmaterial = \"metal\"\n\
         shape.box = {{ size = [\"2 mm\", \"2 mm\", \"2 mm\"] }}\n\
         touch = {{ body = \"rod\", direction = \"-z\" }}\n{FLOOR}\nbodies = [\"rod\"]"
    );
    let case = on_planes(3, block, &second);
    let [rod, lid] = [0, 1].map(|body| bounds(&case.bodies[body], 3).unwrap());
    let gap = (lid.0[2] - rod.1[2]) / case.bodies[0].lattice.spacing;
    assert!((gap - 1.0).abs() < 1e-9, "{gap}");
    assert_in_touch(case, "two bodies");
}
