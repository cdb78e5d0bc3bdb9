//! Mistakes in rigid surfaces and their files: one clear message each; and how files are kept.

use std::path::Path;

use whipple::input::{load, parse};

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
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/punch/case.toml");
    for overrides in [vec![], vec!["spacing=\"0.5 mm\"".to_owned()]] {
        let case = load(&path, &overrides).unwrap_or_else(|error| panic!("{error}"));
        let again = parse("elsewhere/case.toml", &case.resolved, &[]);
        let again = again.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(again.loads, case.loads);
        assert_eq!(again.resolved, case.resolved);
        assert!(case.resolved.contains("sha256"));
    }
}
