//! Bodies from files of triangles: volumes, masses, places, what is mended and what is refused.

#![allow(clippy::cast_precision_loss, reason = "few particles")]

use std::path::Path;

use crate::surfaces::{
    Triangles, ball, cuboid, rounded, torus, turned, volume, write_obj, write_stl,
};
use files::input::load;
use files::preflight::{approaches, warnings};
use model::{Axis, Case, Shape, SymmetryPlane, Vec3};

/// A case in a folder of a body at .1 mm.
fn written(folder: &Path, body: &str, more: &str) -> std::path::PathBuf {
    let path = folder.join("case.toml");
    let text = format!(
        "dimension = 3\nspacing = \"0.1 mm\"\n[run]\nend_time = \"1 us\"\n\
         [material.metal]\nlibrary = \"copper\"\n[[body]]\nname = \"one\"\nmaterial = \"metal\"\n\
         {body}\n{more}"
    );
    std::fs::write(&path, text).unwrap();
    path
}

fn case(folder: &Path, body: &str, more: &str) -> Case {
    let path = written(folder, body, more);
    load(&path, &[]).unwrap_or_else(|error| panic!("{body}: {error}"))
}

fn refused(folder: &Path, body: &str) -> String {
    let path = written(folder, body, "");
    load(&path, &[]).unwrap_err().to_string()
}

/// Mass over that of the volume (mm³) of the shape above symmetry planes.
fn mass(case: &Case, volume: f64) -> f64 {
    let body = &case.bodies[0];
    let planes = if populate::moves_sites(body) {
        &case.symmetry[..]
    } else {
        &[]
    };
    let count = populate::count(body, 3, planes, None);
    populate::particle_volume(body, 3) * count as f64 * 1e9 / volume - 1.0
}

/// Parts of about two millimetres, in millimetres.
fn parts() -> Vec<(&'static str, Triangles)> {
    let brick = cuboid([-1.0, -0.8, -0.5], [1.0, 0.9, 0.7]);
    vec![
        ("brick", turned(&brick, [1.0, 2.0, 3.0], 0.7)),
        ("ball", ball(24, 1.0)),
        ("ring", torus(24, 1.0, 0.4)),
    ]
}

#[test]
fn volume_and_mass_are_those_of_the_triangles() {
    let folder = tempfile::tempdir().unwrap();
    for (name, triangles) in parts() {
        let stl = folder.path().join(format!("{name}.stl"));
        let obj = folder.path().join(format!("{name}.obj"));
        write_stl(&stl, &triangles);
        write_obj(&obj, &triangles);
        // What a binary file holds is rounded, what a text holds is not.
        let exact = [volume(&rounded(&triangles)), volume(&triangles)];
        assert!((exact[0] / exact[1] - 1.0).abs() < 1e-6, "{name}");
        for (format, exact) in ["stl", "obj"].into_iter().zip(exact) {
            for lattice in ["cubic", "glass"] {
                let body = format!(
                    "shape.{format} = {{ file = \"{name}.{format}\", unit = \"1 mm\" }}\n\
                     lattice = \"{lattice}\""
                );
                let case = case(folder.path(), &body, "");
                let body = &case.bodies[0];
                let told = body.shape.volume(3) * 1e9;
                assert!(
                    (told / exact - 1.0).abs() < 1e-12,
                    "{name}.{format}: {told} {exact}"
                );
                let error = mass(&case, exact);
                assert!(error.abs() < 1e-12, "{name}.{format}, {lattice}: {error:e}");
                let sites: Vec<_> = populate::sites(body, 3, &[], None).collect();
                let of_cells = sites.len() as f64 * 1e-3 / exact - 1.0;
                assert!(
                    of_cells.abs() < 0.06,
                    "{name}.{format}, {lattice}: {of_cells}"
                );
                for site in &sites {
                    assert!(body.shape.distance(&Vec3::from(site.position), 3) < 0.0);
                }
                assert_eq!(warnings(&case, &approaches(&case)), [""; 0]);
            }
        }
    }
}

/// What symmetry planes leave is exact as well, however the part is turned.
#[test]
fn a_part_cut_by_symmetry_planes_has_the_mass_of_what_is_left() {
    let folder = tempfile::tempdir().unwrap();
    write_obj(&folder.path().join("ring.obj"), &torus(24, 1.0, 0.4));
    let whole = volume(&torus(24, 1.0, 0.4));
    let body = "shape.obj = { file = \"ring.obj\", unit = \"1 mm\" }\nlattice = \"glass\"\n";
    let planes = "[[symmetry]]\naxis = \"x\"\n[[symmetry]]\naxis = \"z\"\n";
    let quarter = case(folder.path(), body, planes);
    let error = mass(&quarter, 0.25 * whole);
    assert!(error.abs() < 1e-12, "{error:e}");
    let askew = format!("{body}shape.turn = {{ axis = [1, 1, 0], angle = \"90 deg\" }}");
    let half = case(folder.path(), &askew, "[[symmetry]]\naxis = \"z\"\n");
    let error = mass(&half, 0.5 * whole);
    assert!(error.abs() < 1e-12, "{error:e}");
}

/// The particles of a box are those of its mesh.
#[test]
fn the_mesh_of_a_box_is_filled_as_the_box() {
    let folder = tempfile::tempdir().unwrap();
    let (lower, upper) = ([-1.03, -0.77, -0.52], [0.91, 0.84, 0.61]);
    write_obj(&folder.path().join("box.obj"), &cuboid(lower, upper));
    let mesh = "obj = { file = \"box.obj\", unit = \"1 mm\" }";
    let cuboid = "box = { lower = [\"-1.03 mm\", \"-0.77 mm\", \"-0.52 mm\"], \
                  upper = [\"0.91 mm\", \"0.84 mm\", \"0.61 mm\"] }";
    for turn in [
        "",
        "turn = { axis = [1, 2, -1], angle = \"25 deg\" }\nshift = [\"3 mm\", 0, 0]\n",
    ] {
        for lattice in ["cubic", "hexagonal", "face_centred", "glass"] {
            let [a, b] = [mesh, cuboid].map(|form| {
                // Turned by nothing, a box is filled as all other solids are.
                let turn = if turn.is_empty() {
                    "shift = [0, 0, 0]\n"
                } else {
                    turn
                };
                let body = format!("lattice = \"{lattice}\"\n[body.shape]\n{form}\n{turn}");
                let case = case(folder.path(), &body, "");
                populate::sites(&case.bodies[0], 3, &[], None).collect::<Vec<_>>()
            });
            assert_eq!(a.len(), b.len(), "{lattice}");
            let mut most = 0.0_f64;
            for (a, b) in a.iter().zip(&b) {
                assert_eq!(a.index, b.index, "{lattice}");
                for k in 0..3 {
                    most = most.max((a.position[k] - b.position[k]).abs());
                }
            }
            println!("{lattice}: {most:e} m");
            assert!(most < 1e-12, "{lattice}: {most:e} m");
        }
    }
}

#[test]
fn slabs_make_up_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    write_stl(&folder.path().join("ring.stl"), &torus(24, 1.0, 0.4));
    for lattice in ["cubic", "glass"] {
        let body = format!(
            "shape.stl = {{ file = \"ring.stl\", unit = \"1 mm\" }}\nlattice = \"{lattice}\"\n\
             shape.turn = {{ axis = \"x\", angle = \"20 deg\" }}"
        );
        let case = case(folder.path(), &body, "");
        let body = &case.bodies[0];
        let whole: Vec<_> = populate::sites(body, 3, &[], None).collect();
        let mut parts = Vec::new();
        for (lower, upper) in [(-9.0, -2e-4), (-2e-4, 3e-4), (3e-4, 9.0)] {
            let slab = populate::Brick::slab(0, lower, upper);
            parts.extend(populate::sites(body, 3, &[], Some(slab)));
        }
        parts.sort_by_key(|site| site.index);
        let mut sorted = whole.clone();
        sorted.sort_by_key(|site| site.index);
        assert_eq!(parts, sorted, "{lattice}");
    }
}

#[test]
fn shapes_of_all_kinds_go_together_with_meshes() {
    let folder = tempfile::tempdir().unwrap();
    write_obj(&folder.path().join("ball.obj"), &ball(40, 0.5));
    let hole = volume(&ball(40, 0.5));
    let body = "[body.shape]\ndifference = [\n\
        { box = { size = [\"2 mm\", \"2 mm\", \"1.2 mm\"] } },\n\
        { union = [{ obj = { file = \"ball.obj\", unit = \"1 mm\" } },\n\
          { obj = { file = \"ball.obj\", unit = \"0.4 mm\", at = [\"0.7 mm\", \"0.7 mm\", 0] } }] } ]\n\
        turn = { axis = \"z\", angle = \"30 deg\" }\nshift = [0, 0, \"5 mm\"]";
    let case = case(folder.path(), body, "");
    let shape = &case.bodies[0].shape;
    let volume = 4.8 - hole * (1.0 + 0.4_f64.powi(3));
    let told = shape.volume(3) * 1e9;
    assert!((told / volume - 1.0).abs() < 1e-5, "{told} for {volume}");
    let at = |x: f64, y: f64, z: f64| {
        let (s, c) = 30_f64.to_radians().sin_cos();
        shape.distance(
            &(Vec3::new(c * x - s * y, s * x + c * y, z + 5.0) * 1e-3),
            3,
        ) * 1e3
    };
    assert!((at(0.0, 0.0, 0.0) - 0.5).abs() < 5e-3);
    assert!((at(0.7, 0.7, 0.0) - 0.2).abs() < 5e-3);
    assert!(at(0.0, 0.7, 0.0) < -0.19);
    assert_eq!(case.meshes().len(), 2);
}

/// Each face of a turned part lies where its corners do.
#[test]
fn extents_of_turned_parts_are_exact() {
    let folder = tempfile::tempdir().unwrap();
    let ring = torus(24, 1.0, 0.4);
    write_obj(&folder.path().join("ring.obj"), &ring);
    let body = "shape.obj = { file = \"ring.obj\", unit = \"1 mm\" }\n\
                shape.turn = { axis = [1, 2, 3], angle = \"40 deg\", about = [0, 0, 0] }";
    let case = case(folder.path(), body, "");
    let there = turned(&ring, [1.0, 2.0, 3.0], 40_f64.to_radians());
    for normal in [
        Vec3::x(),
        -Vec3::z(),
        Vec3::new(0.6, 0.0, -0.8),
        Vec3::new(0.48, 0.6, 0.64),
    ] {
        let lowest = there.iter().flatten().map(|x| normal.dot(&Vec3::from(*x)));
        let lowest = lowest.fold(f64::INFINITY, f64::min) * 1e-3;
        let told = case.bodies[0].shape.lowest(&normal);
        assert!((told - lowest).abs() < 1e-15, "{normal}: {told} {lowest}");
    }
    let Shape::Solid(solid) = &case.bodies[0].shape else {
        panic!("a solid")
    };
    let (lower, _) = solid.bounds();
    let lowest = there
        .iter()
        .flatten()
        .map(|x| x[1])
        .fold(f64::INFINITY, f64::min);
    assert!((lower.y - 1e-3 * lowest).abs() < 1e-15);
}

#[test]
fn small_leaks_are_mended_and_said_and_large_ones_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.stl");
    let body = "shape.stl = { file = \"part.stl\", unit = \"1 mm\" }\nlattice = \"glass\"";
    let sound = torus(48, 1.0, 0.4);
    let mut leaky = sound.clone();
    leaky.swap_remove(1000);
    for t in leaky.iter_mut().skip(200).step_by(17) {
        t.swap(1, 2);
    }
    write_stl(&path, &leaky);
    let mended = case(folder.path(), body, "");
    let told = warnings(&mended, &approaches(&mended));
    let line = told
        .iter()
        .find(|line| line.contains("mended"))
        .expect("it is told");
    let begin = "`part.stl` of `one` was mended: 1 hole closed, ";
    assert!(line.starts_with(begin), "{line}");
    assert!(
        line.contains("triangles turned as those around them"),
        "{line}"
    );
    let error = mended.bodies[0].shape.volume(3) * 1e9 / volume(&sound) - 1.0;
    assert!(error.abs() < 1e-5, "{error:e}");

    let mut open = cuboid([0.0; 3], [2.0; 3]);
    open.drain(2..4);
    write_stl(&path, &open);
    let message = refused(folder.path(), body);
    assert!(
        message.contains("cannot take the surface `part.stl`: it is not closed: 4 edges"),
        "{message}"
    );
    assert!(
        message.contains("near [1, 1, 2] mm, is 2 mm wide"),
        "{message}"
    );
    assert!(
        message.contains("only those up to one spacing (0.1 mm) are closed"),
        "{message}"
    );
    assert!(
        message.contains("a body must be one or more closed solids"),
        "{message}"
    );

    let mut fin = cuboid([0.0; 3], [2.0; 3]);
    fin.push([[0.0; 3], [2.0, 0.0, 0.0], [1.0, -1.0, -1.0]]);
    write_stl(&path, &fin);
    let message = refused(folder.path(), body);
    assert!(
        message.contains("more than two meet in an edge"),
        "{message}"
    );

    let sheet = vec![cuboid([0.0; 3], [2.0; 3])[0]];
    write_stl(&path, &sheet);
    assert!(refused(folder.path(), body).contains("it is not closed: 3 edges"));

    write_stl(&path, &[]);
    assert!(refused(folder.path(), body).contains("it has no triangles"));

    let mut across = cuboid([0.0; 3], [2.0; 3]);
    across.extend(cuboid([1.0, 0.5, 0.5], [3.0, 1.5, 1.5]));
    write_stl(&path, &across);
    assert!(refused(folder.path(), body).contains("its parts overlap, as near ["));
    // Through and through.
    let mut across = cuboid([0.0; 3], [2.0; 3]);
    across.extend(cuboid([-9.0, 0.8, 0.8], [11.0, 1.2, 1.2]));
    write_stl(&path, &across);
    let case = case(folder.path(), body, "");
    let told = warnings(&case, &approaches(&case));
    let is_told = told
        .iter()
        .any(|line| line.contains("cut through each other, as near ["));
    assert!(is_told, "{told:?}");
}

/// A cavity is empty, and what floats in it is not.
#[test]
fn shells_within_each_other_are_cavities() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.stl");
    let all = [
        cuboid([-1.0; 3], [1.0; 3]),
        cuboid([-0.5; 3], [0.5; 3]),
        cuboid([-0.25; 3], [0.25; 3]),
        cuboid([2.0, 0.0, 0.0], [3.0, 1.0, 1.0]),
    ];
    write_stl(&path, &all.concat());
    let case = case(
        folder.path(),
        "shape.stl = { file = \"part.stl\", unit = \"1 mm\" }",
        "",
    );
    let error = mass(&case, 8.0 - 1.0 + 0.125 + 1.0);
    assert!(error.abs() < 1e-12, "{error:e}");
    assert!(
        warnings(&case, &approaches(&case))
            .iter()
            .any(|line| line.contains("1 shell turned inside out"))
    );
    let planes = [SymmetryPlane {
        axis: Axis::X,
        position: 0.0,
    }];
    let above = populate::count(&case.bodies[0], 3, &planes, None);
    let below = populate::count(&case.bodies[0], 3, &[], None) - above;
    assert!(above > below, "{above} {below}");
}

#[test]
fn quads_of_an_obj_file_make_a_body_and_a_surface() {
    let root = crate::project::root();
    let file = root.join("tests/common/cube.obj");
    let file = file.display();
    let folder = tempfile::tempdir().unwrap();
    let body =
        format!("shape.obj = {{ file = \"{file}\", unit = \"0.5 mm\" }}\nlattice = \"cubic\"");
    let floor = format!(
        "[[surface]]\nshape.obj = {{ file = \"{file}\", unit = \"1 mm\", at = [\"-1 mm\", \"-1 mm\", \"-5 mm\"] }}"
    );
    let case = case(folder.path(), &body, &floor);
    let error = mass(&case, 8.0);
    assert!(error.abs() < 1e-12, "{error:e}");
    assert_eq!(populate::count(&case.bodies[0], 3, &[], None), 8000);
    let gap = populate::smallest_gap(&case.bodies[0], 3, &[], &case.loads.surfaces[0]);
    assert!(gap.is_infinite(), "{gap}");
    assert_eq!(case.meshes().len(), 2);
}

/// The resolved text names all files wherever they stand, and their digests; another content is told.
#[test]
fn the_resolved_case_finds_its_files_and_knows_them() {
    let folder = tempfile::tempdir().unwrap();
    write_obj(&folder.path().join("ball.obj"), &ball(2, 0.5));
    write_stl(&folder.path().join("part.stl"), &torus(3, 1.0, 0.4));
    let body = "[body.shape]\nunion = [\n\
        { stl = { file = \"part.stl\", unit = \"1 mm\" } },\n\
        { difference = [{ box = { size = [\"1 mm\", \"1 mm\", \"1 mm\"] } },\n\
          { obj = { file = \"ball.obj\", unit = \"1 mm\" }, shift = [\"0.1 mm\", 0, 0] }] } ]";
    let path = written(folder.path(), body, "");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replacen("0.1 mm", "0.25 mm", 1)).unwrap();
    for overrides in [vec![], vec!["spacing=\"0.3 mm\"".to_owned()]] {
        let case = load(&path, &overrides).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(case.resolved.matches("sha256").count(), 2);
        let again = files::input::parse("elsewhere/case.toml", &case.resolved, &[]);
        let again = again.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(again.bodies, case.bodies);
        assert_eq!(again.resolved, case.resolved);
        let saved = std::fs::read(folder.path().join("ball.obj")).unwrap();
        write_obj(&folder.path().join("ball.obj"), &ball(4, 0.5));
        let error = files::input::parse("elsewhere/case.toml", &case.resolved, &[]).unwrap_err();
        let said = "ball.obj is no longer the one that the case began with";
        assert!(error.to_string().contains(said), "{error}");
        std::fs::write(folder.path().join("ball.obj"), saved).unwrap();
    }
}

#[test]
fn fewer_dimensions_have_no_surfaces_of_triangles() {
    crate::project::enter();
    let text = |dimension: usize| {
        format!(
            "dimension = {dimension}\nspacing = \"0.1 mm\"\n[run]\nend_time = \"1 us\"\n\
             [material.metal]\nlibrary = \"copper\"\n[[body]]\nname = \"one\"\nmaterial = \"metal\"\n\
             shape.obj = {{ file = \"tests/common/cube.obj\", unit = \"1 mm\" }}\n"
        )
    };
    for dimension in [1, 2] {
        let error = files::input::parse("case.toml", &text(dimension), &[]).unwrap_err();
        let said = format!("a {dimension}-dimensional case has no obj");
        assert!(error.to_string().contains(&said), "{error}");
        assert!(error.to_string().contains("take a "), "{error}");
    }
}

/// A quarter of a bar from a program that keeps the other sides.
#[test]
fn a_mesh_behind_symmetry_planes_is_mirrored_and_measured_as_a_bar() {
    let folder = tempfile::tempdir().unwrap();
    write_stl(
        &folder.path().join("bar.stl"),
        &cuboid([-1.0, 0.0, 0.0], [0.0, 1.0, 8.0]),
    );
    let body = |mirror: &str| {
        format!(
            "shape.stl = {{ file = \"bar.stl\", unit = \"1 mm\"{mirror} }}\nvelocity = [0, 0, \"-9 m/s\"]"
        )
    };
    let planes = "[[symmetry]]\naxis = \"x\"\n[[symmetry]]\naxis = \"y\"\n";
    let path = written(folder.path(), &body(""), planes);
    let message = load(&path, &[]).unwrap_err().to_string();
    assert!(
        message.contains("`mirror` of the file puts it there"),
        "{message}"
    );
    let case = case(folder.path(), &body(", mirror = \"x\""), planes);
    let error = mass(&case, 8.0);
    assert!(error.abs() < 1e-12, "{error:e}");
    let kinds = case.measure.measures.iter().map(|measure| &measure.kind);
    let feet = kinds.filter_map(|kind| match kind {
        model::MeasureKind::Bar(bar) => Some(bar.foot),
        _ => None,
    });
    assert_eq!(feet.collect::<Vec<_>>(), [[0.0, 0.0, -1.0]]);
}
