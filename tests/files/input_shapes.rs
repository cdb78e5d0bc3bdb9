//! Shapes and fillings as they are typed: volumes, masses, counts, places.

#![allow(clippy::cast_precision_loss, reason = "few particles")]

use std::f64::consts::PI;

use files::input::parse;
use model::{Case, SymmetryPlane, Vec3};

fn case(dimension: usize, body: &str, more: &str) -> Case {
    let text = format!(
        "dimension = {dimension}\nspacing = \"0.1 mm\"\n[run]\nend_time = \"1 us\"\n\
         [material.metal]\nlibrary = \"copper\"\n[[body]]\nname = \"one\"\nmaterial = \"metal\"\n\
         {body}\n{more}"
    );
    parse("case.toml", &text, &[]).unwrap_or_else(|error| panic!("{body}: {error}"))
}

/// Shapes of about a millimetre, with their volumes (mm³).
fn shapes() -> Vec<(&'static str, f64)> {
    let (r, n) = (0.5_f64, 1.2_f64);
    let arc = (r * r + n * n) / (2.0 * r);
    let off = arc - r;
    let wedge = 0.5 * (n * (arc * arc - n * n).sqrt() + arc * arc * (n / arc).asin());
    let nose = PI * ((arc * arc + off * off) * n - n.powi(3) / 3.0 - 2.0 * off * wedge);
    vec![
        ("shape.box.size = [\"1 mm\", \"1 mm\", \"0.97 mm\"]", 0.97),
        ("shape.sphere.radius = \"0.5 mm\"", PI / 6.0),
        (
            "shape.sphere = { radius = \"1 mm\", inner_radius = \"0.5 mm\" }",
            7.0 / 6.0 * PI,
        ),
        (
            "shape.cylinder = { radius = \"0.5 mm\", length = \"2 mm\", axis = [1, 1, 0] }",
            0.5 * PI,
        ),
        (
            "shape.cylinder = { radius = \"1 mm\", inner_radius = \"0.5 mm\", length = \"2 mm\" }",
            1.5 * PI,
        ),
        (
            "shape.ellipsoid.semi_axes = [\"1 mm\", \"0.8 mm\", \"0.6 mm\"]",
            0.64 * PI,
        ),
        (
            "shape.cone = { radius = \"0.6 mm\", length = \"2 mm\", axis = \"-x\" }",
            0.24 * PI,
        ),
        (
            "shape.cone = { radius = \"1 mm\", top_radius = \"0.5 mm\", length = \"1.2 mm\" }",
            0.7 * PI,
        ),
        (
            "shape.ogive = { radius = \"0.5 mm\", nose = \"1.2 mm\", length = \"3.2 mm\" }",
            nose + 0.5 * PI,
        ),
        (
            "shape.torus = { radius = \"1 mm\", tube_radius = \"0.3 mm\", axis = \"y\" }",
            0.18 * PI * PI,
        ),
        (
            "shape.prism = { corners = [[0, 0], [\"2 mm\", 0], [0, \"1 mm\"]], length = \"1 mm\" }",
            1.0,
        ),
        (
            "shape.box.size = [\"1 mm\", \"1 mm\", \"1 mm\"]\n\
             shape.turn = { axis = [1, 2, 3], angle = \"40 deg\" }",
            1.0,
        ),
    ]
}

#[test]
fn every_shape_has_the_mass_of_its_volume_in_every_filling() {
    for (shape, volume) in shapes() {
        for lattice in [
            "cubic",
            "hexagonal",
            "body_centred",
            "face_centred",
            "glass",
        ] {
            let case = case(3, &format!("{shape}\nlattice = \"{lattice}\""), "");
            let body = &case.bodies[0];
            let count = populate::count(body, 3, &[], None);
            let filled = populate::particle_volume(body, 3) * count as f64 * 1e9;
            assert!(
                (filled / volume - 1.0).abs() < 1e-12,
                "{shape}, {lattice}: {filled} for {volume}"
            );
            let by_spacing = count as f64 * 1e-3;
            assert!(
                (by_spacing / volume - 1.0).abs() < 0.12,
                "{shape}, {lattice}: {count} particles"
            );
            let sites: Vec<_> = populate::sites(body, 3, &[], None).collect();
            assert_eq!(sites.len() as u64, count);
            for site in &sites {
                let depth = -body.shape.distance(&Vec3::from(site.position), 3);
                assert!(depth > 0.0 || lattice == "cubic" || lattice == "hexagonal");
            }
        }
    }
}

#[test]
fn shapes_go_together() {
    let plate = "lattice = \"glass\"\n[body.shape]\ndifference = [\n\
        { box = { size = [\"2 mm\", \"2 mm\", \"0.5 mm\"] } },\n\
        { cylinder = { radius = \"0.4 mm\", length = \"1 mm\" } } ]\n\
        turn = [{ axis = \"y\", angle = \"30 deg\" }, { axis = \"z\", angle = \"-90 deg\", about = [\"1 mm\", 0, 0] }]\n\
        shift = [0, 0, \"3 mm\"]";
    let case = case(3, plate, "");
    let body = &case.bodies[0];
    let volume = 2.0 - 0.08 * PI;
    let told = body.shape.volume(3) * 1e9;
    assert!((told / volume - 1.0).abs() < 1e-4, "{told} for {volume}");
    // Turned about z by −90° about (1, 0, 0) mm its middle goes to (1, 1, 3) mm.
    let centre = body.shape.centre() * 1e3;
    assert!(
        (centre - Vec3::new(1.0, 1.0, 3.0)).norm() < 1e-9,
        "{centre}"
    );
    let normal = Vec3::new(0.0, -0.5, 0.75_f64.sqrt());
    for site in populate::sites(body, 3, &[], None) {
        let x = Vec3::from(site.position) * 1e3 - centre;
        let along = x.dot(&normal);
        assert!(along.abs() < 0.21, "beyond a face: {along}");
        assert!((x - normal * along).norm() > 0.44, "in the hole");
    }
}

/// A core of hexagonal cells is a box without a hexagon at each point of a lattice.
#[test]
fn a_honeycomb_is_a_box_without_hexagons() {
    let core = "lattice = \"glass\"\n[body.shape]\ndifference = [\n\
        { box = { size = [\"6 mm\", \"5.196152 mm\", \"2 mm\"] } },\n\
        { repeat = { unit = { prism = { sides = 6, across_flats = \"2.4 mm\", length = \"3 mm\" } }, \
        lattice = \"hexagonal\", cell = \"3 mm\", lower = [\"-6 mm\", \"-6 mm\", 0], upper = [\"6 mm\", \"6 mm\", 0] } } ]";
    let case = case(3, core, "");
    let body = &case.bodies[0];
    let volume = 6.0 * 5.196_152 * 2.0 * (1.0 - 0.8 * 0.8);
    let told = body.shape.volume(3) * 1e9;
    assert!((told / volume - 1.0).abs() < 2e-3, "{told} for {volume}");
    let sites: Vec<_> = populate::sites(body, 3, &[], None).collect();
    assert!(sites.len() > 300, "{}", sites.len());
    for site in sites {
        let x = Vec3::from(site.position);
        assert!(body.shape.distance(&x, 3) < 0.0, "{x}");
    }
}

#[test]
fn flat_shapes_are_sections() {
    for (shape, area) in [
        (
            "shape.ellipsoid.semi_axes = [\"1 mm\", \"0.5 mm\"]",
            0.5 * PI,
        ),
        (
            "shape.prism.corners = [[0, 0], [\"2 mm\", 0], [\"1 mm\", \"2 mm\"]]",
            2.0,
        ),
        (
            "shape.box.size = [\"2 mm\", \"1 mm\"]\nshape.turn = { axis = \"z\", angle = \"30 deg\" }",
            2.0,
        ),
        ("shape.sphere.radius = \"1 mm\"", PI),
    ] {
        let case = case(2, &format!("{shape}\nlattice = \"glass\""), "");
        let body = &case.bodies[0];
        let count = populate::count(body, 2, &[], None) as f64;
        let filled = populate::particle_volume(body, 2) * count * 1e6;
        assert!(
            (filled / area - 1.0).abs() < 1e-12,
            "{shape}: {filled} for {area}"
        );
        assert!(
            (count * 1e-2 / area - 1.0).abs() < 0.1,
            "{shape}: {count} particles"
        );
        for site in populate::sites(body, 2, &[], None) {
            let depth = -body.shape.distance(&Vec3::from(site.position), 2);
            assert!(depth > 0.04e-3, "{shape}: {depth}");
        }
    }
}

#[test]
fn glass_of_another_seed_is_another_glass() {
    let sites = |seed: u64| {
        let lattice = format!("lattice = {{ kind = \"glass\", seed = {seed} }}");
        let case = case(3, &format!("shape.sphere.radius = \"1 mm\"\n{lattice}"), "");
        populate::sites(&case.bodies[0], 3, &[], None).collect::<Vec<_>>()
    };
    assert!(sites(1) == sites(1));
    assert!(sites(1) != sites(2));
}

#[test]
fn bodies_of_glass_in_touch_are_a_spacing_apart() {
    let more = "lattice = \"glass\"\n[[body]]\nname = \"two\"\nmaterial = \"metal\"\nlattice = \"glass\"\n\
        shape.box.size = [\"1 mm\", \"1 mm\", \"1 mm\"]\ntouch = { body = \"one\", direction = \"-z\" }";
    let case = case(3, "shape.box.size = [\"2 mm\", \"2 mm\", \"1 mm\"]", more);
    let z = |b: usize| {
        let sites = populate::sites(&case.bodies[b], 3, &[] as &[SymmetryPlane], None);
        sites
            .map(|site| site.position[2] * 1e4)
            .collect::<Vec<f64>>()
    };
    let top = z(0).into_iter().fold(f64::NEG_INFINITY, f64::max);
    let bottom = z(1).into_iter().fold(f64::INFINITY, f64::min);
    assert!((bottom - top - 1.0).abs() < 0.05, "{top} to {bottom}");
}

/// The mass of a graded body is that of its shape, whatever it is finest at; far fewer particles
/// bear it.
#[test]
fn graded_bodies_have_their_mass() {
    let spacing = "{ inner = \"0.1 mm\", outer = \"0.4 mm\", within = \"0.5 mm\"";
    for (focus, shape) in [
        (
            "at = [0, 0, \"3 mm\"]",
            "shape.box.size = [\"6 mm\", \"6 mm\", \"6 mm\"]",
        ),
        (
            "face = \"+z\"",
            "shape.cylinder = { radius = \"3 mm\", length = \"6 mm\" }",
        ),
        ("face = [1, 1, 0]", "shape.sphere.radius = \"3 mm\""),
        (
            "at = [0, 0, 0], axis = [1, 0, 1]",
            "shape.ellipsoid.semi_axes = [\"3 mm\", \"2 mm\", \"4 mm\"]",
        ),
    ] {
        for more in ["", "[[symmetry]]\naxis = \"x\""] {
            let body = format!("{shape}\nspacing = {spacing}, {focus} }}");
            let case = case(3, &body, more);
            let body = &case.bodies[0];
            let sites: Vec<_> = populate::sites(body, 3, &case.symmetry, None).collect();
            let shares: f64 = sites.iter().map(|site| site.share).sum();
            let volume = populate::particle_volume(body, 3) * shares;
            let asked = body.shape.volume_above(&case.symmetry, 3);
            assert!((volume / asked - 1.0).abs() < 1e-11, "{focus}: {volume}");
            // Cells are close to the cubes of their spacings.
            let cell = populate::particle_volume(body, 3) * 1e12;
            assert!((cell - 1.0).abs() < 0.02, "{focus}: {cell}");
            let fewer = asked * 1e12 / sites.len() as f64;
            assert!(fewer > 3.0, "{focus}: {} particles", sites.len());
            let end = populate::index_end(body, 3);
            assert!(sites.iter().all(|site| site.index < end));
            assert!(sites.windows(2).all(|pair| pair[0].index < pair[1].index));
        }
    }
}

/// In every case that is shipped, graded or not, each particle begins inside its body, and on this side
/// of the symmetry planes.
#[test]
#[ignore = "slow"]
fn no_particle_begins_outside_its_body() {
    crate::project::enter();
    let mut graded = 0;
    for entry in std::fs::read_dir("inputs").unwrap() {
        let path = entry.unwrap().path().join("case.toml");
        if !path.exists() {
            continue;
        }
        let case = files::input::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        for body in &case.bodies {
            let solid = body.shape.solid(case.dimension);
            graded += usize::from(body.lattice.grading.is_some());
            for site in populate::sites(body, case.dimension, &case.symmetry, None) {
                let x = Vec3::from(site.position);
                let out = solid.distance(&x) / body.lattice.spacing;
                assert!(
                    out < 1e-6,
                    "{} {}: {x:?} by {out} spacings",
                    path.display(),
                    body.name
                );
                for plane in &case.symmetry {
                    assert!(x[plane.axis.index()] >= plane.position);
                }
            }
        }
    }
    assert!(graded > 3, "{graded}");
}

/// Where the whole body is as fine, nothing is graded.
#[test]
fn a_grading_beyond_the_body_is_none() {
    let even = case(3, "shape.sphere.radius = \"1 mm\"\nlattice = \"glass\"", "");
    let spacing =
        "spacing = { inner = \"0.1 mm\", outer = \"1 mm\", at = [0, 0, 0], within = \"2 mm\" }";
    let graded = case(3, &format!("shape.sphere.radius = \"1 mm\"\n{spacing}"), "");
    let sites = |case: &Case| populate::sites(&case.bodies[0], 3, &[], None).collect::<Vec<_>>();
    assert!(sites(&even) == sites(&graded));
}

/// A sample of a graded body stands on one lattice, however its shape is made.
#[test]
fn samples_of_graded_bodies_are_even() {
    let spacing = "spacing = { inner = \"0.1 mm\", outer = \"0.4 mm\", at = [0, 0, 0] }";
    let turned = "shape = { sphere = { radius = \"2 mm\" }, shift = [\"1 mm\", 0, 0] }";
    let case = case(3, &format!("{turned}\n{spacing}"), "");
    let body = &case.bodies[0];
    let most = 200;
    assert!(populate::count(body, 3, &[], None) > most);
    let (sites, is_all) = populate::sample(body, 3, &[], most);
    let sites: Vec<_> = sites.collect();
    assert!(!is_all && sites.len() as u64 <= most, "{}", sites.len());
    for (n, site) in sites.iter().enumerate() {
        let x = Vec3::from(site.position);
        let apart = |other: &populate::Site| (x - Vec3::from(other.position)).norm();
        let nearest = sites[..n].iter().map(apart).fold(f64::INFINITY, f64::min);
        assert!(nearest > 0.3e-3, "{nearest}");
        assert_eq!(site.share, 1.0);
    }
}
