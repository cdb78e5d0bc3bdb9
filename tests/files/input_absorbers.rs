//! Absorbing zones as they are typed; more mistakes stand in the table of bad inputs.

use files::input::parse;
use files::preflight::{approaches, warnings};
use model::{Absorber, Axis, Case, OuterFace};

/// A can about z, a quarter of a block and a zone.
fn case(zone: &str) -> Result<Case, String> {
    let text = format!(
        r#"
dimension = 3
spacing = "0.1 mm"
gravity = [0, 0, "-1 m/s^2"]
run.end_time = "1 us"
material.a.library = "copper"
[[symmetry]]
axis = "x"
[[body]]
name = "can"
material = "a"
shape.cylinder = {{ radius = "4 mm", length = "2 mm", centre = ["20 mm", 0, 0] }}
[[body]]
name = "block"
material = "a"
shape.box = {{ lower = ["-4 mm", "-4 mm", "-4 mm"], upper = ["4 mm", "4 mm", "4 mm"] }}
[[body]]
name = "top"
material = "a"
shape.box = {{ lower = ["-1 mm", "-1 mm", "10 mm"], upper = ["1 mm", "1 mm", "12 mm"] }}
angular_velocity = ["1 rad/s", 0, 0]
[[absorb]]
{zone}
"#
    );
    parse("zones", &text, &[]).map_err(|error| error.to_string())
}

fn zone(text: &str) -> Absorber {
    let case = case(text).unwrap_or_else(|error| panic!("{error}"));
    let sinks = "which bears no weight";
    assert!(
        warnings(&case, &approaches(&case))
            .iter()
            .any(|warning| warning.ends_with(sinks))
    );
    case.loads.absorbers[0].clone()
}

#[test]
fn faces_follow_the_shape() {
    let round = zone("body = \"can\"\nround = true\ndepth = \"1 mm\"");
    let rim = OuterFace::Round {
        centre: [20e-3, 0.0, 0.0],
        axis: Some(Axis::Z),
        radius: 4e-3,
    };
    assert_eq!((round.name.as_str(), round.body), ("absorb-1", 0));
    assert_eq!((round.depth, round.faces), (1e-3, vec![rim]));
    let block = zone("body = \"block\"\nfaces = [\"+x\", [0, -3, 0], [0, 0.6, -0.8]]");
    // 30 spacings.
    assert!((block.depth - 3e-3).abs() < 1e-15);
    let planes = [
        ([1.0, 0.0, 0.0], 4e-3),
        ([0.0, -1.0, 0.0], 4e-3),
        ([0.0, 0.6, -0.8], 5.6e-3),
    ];
    for (face, (direction, at)) in block.faces.iter().zip(planes) {
        let OuterFace::Plane { normal, position } = face else {
            panic!("a plane")
        };
        assert!((0..3).all(|a| (normal[a] - direction[a]).abs() < 1e-15));
        assert!((position - at).abs() < 1e-15, "{position}");
    }
    let own = zone("body = \"block\"\nround = { radius = \"4 mm\" }\ndepth = \"1 mm\"");
    let ball = OuterFace::Round {
        centre: [0.0; 3],
        axis: None,
        radius: 4e-3,
    };
    assert_eq!(own.faces, [ball]);
}

#[test]
fn mistakes_are_told() {
    for (zone, said) in [
        (
            "body = \"block\"\nfaces = [\"-x\"]",
            "this face of `block` lies at or behind the symmetry plane of x",
        ),
        (
            "body = \"top\"\nfaces = [\"-z\"]",
            "the body `top` turns, which an absorbing zone would stop",
        ),
        ("body = \"can\"\nround = true", ""),
        (
            "body = \"can\"\nround = false",
            "an absorbing zone must have a face",
        ),
        (
            "body = \"can\"\nround = true\ndepth = \"4 mm\"",
            "the absorbing zone leaves nothing of `can`",
        ),
    ] {
        match case(zone) {
            Ok(_) => assert_eq!(said, "", "{zone}"),
            Err(error) => assert!(!said.is_empty() && error.contains(said), "{zone}: {error}"),
        }
    }
    let one = r#"
dimension = 1
spacing = "1 mm"
run.end_time = "1 us"
material.a.eos.ideal_gas = { gamma = 1.4 }
material.a.density = "1 kg/m^3"
material.a.strength = "none"
material.b.library = "copper"
[[body]]
name = "bar"
material = "b"
shape.box = { size = ["100 mm"] }
[[body]]
name = "gas"
material = "a"
shape.box = { size = ["100 mm"], centre = ["200 mm"] }
[contact]
mode = "none"
[[absorb]]
"#;
    for (zone, said) in [
        (
            "body = \"bar\"\nround = true",
            "in one dimension nothing is round",
        ),
        (
            "body = \"bar\"\nfaces = [\"+y\"]",
            "a 1-dimensional case has no y axis",
        ),
        ("body = \"gas\"\nfaces = [\"+x\"]", "has no modulus"),
    ] {
        let error = parse("bar", &format!("{one}{zone}\n"), &[])
            .unwrap_err()
            .to_string();
        assert!(error.contains(said), "{zone}: {error}");
    }
}
