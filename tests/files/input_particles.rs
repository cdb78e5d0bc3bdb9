//! Particles of files as bodies: every format that is read, as real programs write it, with units,
//! parts, turns and what is told beside places.
//!
//! The meshes of `tests/particles/` are of Gmsh, meshio, VTK and h5py: eight hexahedra of
//! 1 × ½ × ½ in a box from the origin to (2, 1, 1), or points of a grid.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use files::input::parse;
use model::{Body, Case, Quantity, Sizes};
use particles::neighbours::SizeClasses;
use populate::{self, Brick, Share, Wanted};

/// A case with one body of some particles.
fn text(particles: &str, more: &str) -> String {
    format!(
        "dimension = 3\nrun.end_time = \"1 us\"\nmaterial.metal.library = \"copper\"\n\
         [[body]]\nname = \"it\"\nmaterial = \"metal\"\n{more}\nparticles = {{ {particles} }}\n"
    )
}

/// The case in a folder.
#[track_caller]
fn case_in(folder: &Path, particles: &str, more: &str) -> Case {
    let name = folder.join("case.toml").display().to_string();
    parse(&name, &text(particles, more), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// What is said of a case in a folder.
#[track_caller]
fn refused_in(folder: &Path, particles: &str, more: &str) -> String {
    let name = folder.join("case.toml").display().to_string();
    let read = parse(&name, &text(particles, more), &[]);
    read.expect_err("passed for sound").to_string()
}

fn fixtures() -> std::path::PathBuf {
    crate::project::root().join("tests/particles")
}

fn fixture(file: &str, keys: &str) -> Case {
    case_in(&fixtures(), &format!("file = \"{file}\", {keys}"), "")
}

fn positions(body: &Body) -> Vec<[f64; 3]> {
    populate::sites(body, 3, &[], None)
        .map(|site| site.position)
        .collect()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs().max(1e-12)
}

#[test]
fn elements_of_every_mesh_are_particles_with_their_volumes() {
    for file in [
        "hexes.msh",
        "hexes.inp",
        "hexes.key",
        "meshio-ascii.vtu",
        "meshio-zlib.vtu",
        "vtk-binary.vtu",
        "vtk-binary-zlib.vtu",
        "vtk-raw.vtu",
        "vtk-raw-zlib.vtu",
        "vtk-appended64-zlib.vtu",
    ] {
        let keys = if file.ends_with("vtu") {
            "unit = \"1 cm\", mass_unit = \"1 g\", time_unit = \"1 us\", part = [0, 1]"
        } else {
            "unit = \"1 cm\""
        };
        let case = fixture(file, keys);
        let body = &case.bodies[0];
        let (cloud, _) = body.cloud().unwrap();
        assert_eq!(cloud.count(), 8, "{file}");
        assert!(cloud.volumes().iter().all(|v| close(*v, 0.25e-6)), "{file}");
        assert!(close(body.shape.volume(3), 2e-6), "{file}");
        assert!(close(body.lattice.spacing, 0.25e-6_f64.cbrt()), "{file}");
        let mut found = positions(body);
        found.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert!(
            close(found[0][0], 5e-3) && close(found[0][2], 2.5e-3),
            "{file}: {found:?}"
        );
        assert!(
            close(found[7][0], 15e-3) && close(found[7][1], 7.5e-3),
            "{file}: {found:?}"
        );
        if file.ends_with("vtu") {
            // 2 to 3 g/cm³ in the order of the cells.
            let densities = cloud.all(Quantity::Density).unwrap();
            assert!(
                close(densities[0], 2000.0) && close(densities[7], 3000.0),
                "{file}"
            );
            let masses = cloud.all(Quantity::Mass).unwrap();
            assert!(close(masses[7], 3000.0 * 0.25e-6), "{file}");
        }
    }
}

#[test]
fn nodes_share_the_volume_of_the_elements_around_them() {
    for file in ["hexes.msh", "hexes.inp", "hexes.key", "vtk-raw-zlib.vtu"] {
        let keys = "unit = \"1 mm\", time_unit = \"1 us\", take = \"nodes\"";
        let case = fixture(file, keys);
        let (cloud, _) = case.bodies[0].cloud().unwrap();
        assert_eq!(cloud.count(), 27, "{file}");
        assert!(close(case.bodies[0].shape.volume(3), 2e-9), "{file}");
        let most = cloud
            .volumes()
            .iter()
            .fold(0.0, |most: f64, v| most.max(*v));
        assert!(
            close(most, 0.25e-9),
            "{file}: the middle one has the volume of an element"
        );
        let least = cloud
            .volumes()
            .iter()
            .fold(1.0, |least: f64, v| least.min(*v));
        assert!(
            close(least, 0.25e-9 / 8.0),
            "{file}: a corner has an eighth"
        );
        let velocity = cloud.get(Quantity::Velocity, 3).map(<[f64]>::to_vec);
        let expected = file.ends_with("vtu").then(|| vec![0.0, 0.0, -7000.0]);
        assert_eq!(velocity, expected, "{file}");
    }
}

#[test]
fn parts_are_bodies_by_name_or_number() {
    let of = |part: &str| {
        let keys = format!("unit = \"1 mm\", part = {part}");
        let case = fixture("bricks-2.2.msh", &keys);
        case.bodies[0].shape.volume(3)
    };
    for (part, volume) in [
        ("\"cube\"", 1e-9),
        ("12", 1e-9),
        ("\"long brick\"", 2e-9),
        ("11.0", 2e-9),
        ("[11, \"cube\"]", 3e-9),
    ] {
        assert!(close(of(part), volume), "{part}: {}", of(part));
    }
    let message = refused_in(
        &fixtures(),
        "file = \"bricks-2.2.msh\", unit = \"1 mm\"",
        "",
    );
    let said = "it has several parts, 11 (`long brick`), 12 (`cube`): say with `part`";
    assert!(message.contains(said), "{message}");
    let keys = "file = \"bricks-2.2.msh\", unit = \"1 mm\", part = \"ball\"";
    let message = refused_in(&fixtures(), keys, "");
    assert!(
        message.contains("it has no part `ball`: there is 11 (`long brick`)"),
        "{message}"
    );
    for (file, part) in [("points.h5", "2"), ("points.vtp", "1")] {
        let keys =
            format!("unit = \"1 mm\", mass_unit = \"1 mg\", time_unit = \"1 s\", part = {part}");
        let case = fixture(file, &keys);
        let (cloud, _) = case.bodies[0].cloud().unwrap();
        let (count, z) = if file == "points.h5" {
            (9, 2e-3)
        } else {
            (30, 3e-3)
        };
        assert_eq!(cloud.count(), count, "{file}");
        assert!(close(cloud.positions()[count - 1][2], z), "{file}");
        assert!(
            close(cloud.get(Quantity::Mass, 0).unwrap()[0], 2.5e-6),
            "{file}"
        );
    }
}

#[test]
fn arrays_of_hdf5_are_found_by_their_names() {
    let keys = "unit = \"1 mm\", mass_unit = \"1 mg\", time_unit = \"1 ms\", part = 0, \
                columns = { velocity = \"g/v\" }";
    let case = fixture("points.h5", keys);
    let (cloud, _) = case.bodies[0].cloud().unwrap();
    assert_eq!(cloud.get(Quantity::Velocity, 8), Some(&[1.0, 2.0, 3.0][..]));
    let keys = "file = \"points.h5\", unit = \"1 mm\", mass_unit = \"1 mg\", \
                columns = { velocity = \"g/w\" }";
    let message = refused_in(&fixtures(), keys, "");
    assert!(message.contains("its array `g/w`"), "{message}");
}

const TABLE: &str = "# a comment\n# units: mm,mm,mm,km/s,km/s,km/s,mg,-,kJ/kg\n\
    x,y,z,vx,vy,vz,mass,body,specific_energy\n\
    0,0,0,1,0,-7,8.93,ball,1\n1.5,0,0,1,0,-5,8.93,ball,-2\n\n9,9,9,0,0,0,1,plate,0\n";

#[test]
fn columns_have_units_and_names() {
    let place = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &str| fs::write(place.path().join(name), content).unwrap();
    write("a.csv", TABLE);
    let case = case_in(place.path(), "file = \"a.csv\", part = \"ball\"", "");
    let body = &case.bodies[0];
    let (cloud, _) = body.cloud().unwrap();
    assert_eq!(cloud.positions(), [[0.0; 3], [1.5e-3, 0.0, 0.0]]);
    assert_eq!(
        cloud.get(Quantity::Velocity, 1),
        Some(&[1e3, 0.0, -5e3][..])
    );
    assert_eq!(cloud.get(Quantity::SpecificEnergy, 1), Some(&[-2e3][..]));
    let density = case.materials[0].reference_density;
    assert!(close(cloud.volumes()[0], 8.93e-6 / density));
    // What is told of the body as a whole.
    assert_eq!(body.velocity, model::Vec3::new(1e3, 0.0, -6e3));
    assert_eq!(
        (body.initial.velocity_spread, body.initial.largest_energy),
        (1e3, -2e3)
    );
    assert!(close(case.impact_speed(), 1e3_f64.hypot(6e3) + 1e3));
    // The same without units, with others' names and separators.
    write(
        "b.csv",
        "X [mm];Y [mm];Z [mm];u;v;w;m (mg)\n0;0;0;1;0;-7;8.93\n1.5;0;0;1;0;-5;8.93\n",
    );
    let keys = "file = \"b.csv\", unit = \"1 mm\", time_unit = \"1 us\", \
                columns = { velocity = [\"u\", \"v\", \"w\"], mass = \"m\" }";
    let other = case_in(place.path(), keys, "");
    let (found, _) = other.bodies[0].cloud().unwrap();
    assert_eq!(found.positions(), cloud.positions());
    assert_eq!(found.all(Quantity::Mass), cloud.all(Quantity::Mass));
    let velocities = found.all(Quantity::Velocity).unwrap();
    assert!(close(velocities[5], -5e3), "{velocities:?}");
    // What the body says goes before what the file tells.
    let more = "velocity = [0, 0, 0]\nspecific_energy = \"5 J/kg\"\ndensity = \"8 g/cm^3\"";
    let case = case_in(place.path(), "file = \"a.csv\", part = \"ball\"", more);
    let (cloud, _) = case.bodies[0].cloud().unwrap();
    let held: Vec<Quantity> = cloud.quantities().collect();
    assert_eq!(held, [Quantity::Mass]);
    assert!(close(cloud.volumes()[0], 8.93e-6 / 8000.0));
    // Of places alone the spacing makes volumes.
    write("c.csv", "x,y,z\n0,0,0\n2,0,0\n");
    let keys = "file = \"c.csv\", unit = \"1 mm\"";
    let message = refused_in(place.path(), keys, "");
    assert!(
        message.contains("neither the mass nor the volume"),
        "{message}"
    );
    let case = case_in(place.path(), keys, "spacing = \"2 mm\"");
    assert!(close(case.bodies[0].shape.volume(3), 16e-9));
}

#[test]
fn particles_are_turned_with_all_that_has_directions() {
    let place = tempfile::tempdir().unwrap();
    let table = "# units: mm,mm,mm,m/s,m/s,m/s,g,Pa,Pa,Pa,Pa,Pa,Pa\n\
        x,y,z,vx,vy,vz,mass,deviatoric_stress_xx,deviatoric_stress_yy,deviatoric_stress_zz,\
        deviatoric_stress_xy,deviatoric_stress_xz,deviatoric_stress_yz\n\
        0,0,0,1,2,3,1,5,-2,-3,7,8,9\n2,0,0,1,2,3,1,5,-2,-3,7,8,9\n";
    fs::write(place.path().join("a.csv"), table).unwrap();
    let keys = "file = \"a.csv\", turn = { axis = \"z\", angle = \"90 deg\" }, \
                shift = [0, 0, \"1 mm\"]";
    let case = case_in(place.path(), keys, "");
    let (cloud, _) = case.bodies[0].cloud().unwrap();
    let near = |found: &[f64], wanted: &[f64]| {
        let off = found.iter().zip(wanted).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9, "{found:?} {wanted:?}");
    };
    near(&cloud.positions()[0], &[1e-3, -1e-3, 1e-3]);
    near(cloud.get(Quantity::Velocity, 1).unwrap(), &[-2.0, 1.0, 3.0]);
    let stress = cloud.get(Quantity::DeviatoricStress, 0).unwrap();
    near(stress, &[-2.0, 5.0, -3.0, -7.0, -9.0, 8.0]);
}

#[test]
fn sites_are_those_of_any_slabs_and_planes() {
    let place = tempfile::tempdir().unwrap();
    let mut table = String::from("x (mm),y (mm),z (mm)\n");
    let mut seed = 1_u32;
    for _ in 0..500 {
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24)
        };
        let [x, y, z] = [next(), next(), next()];
        let [x, y, z] = [10.0 * x - 2.0, 10.0 * y, 30.0 * z];
        let _ = writeln!(table, "{x},{y},{z}");
    }
    fs::write(place.path().join("a.csv"), table).unwrap();
    let more = "spacing = \"1 mm\"";
    let mut case = case_in(place.path(), "file = \"a.csv\"", more);
    case.symmetry.push(model::SymmetryPlane {
        axis: model::Axis::X,
        position: 0.0,
    });
    let body = &case.bodies[0];
    let (cloud, _) = body.cloud().unwrap();
    let above = |x: &&[f64; 3]| x[0] > 0.0;
    let expected: Vec<[f64; 3]> = cloud.positions().iter().filter(above).copied().collect();
    let mut found = Vec::new();
    let mut last = None;
    for slab in [[-1.0, 5e-3], [5e-3, 6e-3], [6e-3, 6e-3], [6e-3, 1.0]] {
        let [lower, upper] = slab;
        let slab = Brick::slab(2, lower, upper);
        let sites: Vec<_> = populate::sites(body, 3, &case.symmetry, Some(slab)).collect();
        let count = populate::count(body, 3, &case.symmetry, Some(slab));
        assert_eq!(sites.len() as u64, count);
        assert!(sites.windows(2).all(|pair| pair[0].index < pair[1].index));
        found.extend(sites.iter().map(|site| (site.index, site.position)));
        last = Some(count);
    }
    assert!(last.is_some_and(|count| count > 200));
    found.sort_by_key(|(index, _)| *index);
    let found: Vec<[f64; 3]> = found.into_iter().map(|(_, position)| position).collect();
    assert_eq!(found, expected);
    let mut tallied = 0;
    for part in 0..3 {
        let share = Share { part, parts: 3 };
        populate::tally(body, 3, &case.symmetry, 2, share, |_, n| tallied += n);
    }
    assert_eq!(tallied, expected.len() as u64);
    let point = [3e-3, 5e-3, 15e-3];
    let distance = |x: &[f64; 3]| {
        (0..3)
            .map(|a| (x[a] - point[a]).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    let wanted = Wanted {
        most: 3,
        limit: 1.0,
        any: false,
    };
    let best = populate::search(
        (body, 3, &case.symmetry),
        wanted,
        |lower, upper| distance(&[0, 1, 2].map(|a| point[a].clamp(lower[a], upper[a]))),
        distance,
    );
    let mut by_hand: Vec<f64> = expected.iter().map(distance).collect();
    by_hand.sort_by(f64::total_cmp);
    let best: Vec<f64> = best.into_iter().map(|(value, _)| value).collect();
    assert_eq!(best, by_hand[..3]);
    // The distance from the nearest ball of a spacing.
    let near = cloud.positions().iter().map(distance).fold(1.0, f64::min);
    let found = body.shape.distance(&point.into(), 3);
    assert!(close(found, near - 0.5e-3), "{found} {near}");
}

#[test]
fn a_body_of_a_plane_takes_what_lies_in_it() {
    let place = tempfile::tempdir().unwrap();
    fs::write(
        place.path().join("a.csv"),
        "x (mm),y (mm),z (mm)\n0,0,3\n1,0,3\n",
    )
    .unwrap();
    fs::write(
        place.path().join("b.csv"),
        "x (mm),y (mm),z (mm)\n0,0,3\n1,0,4\n",
    )
    .unwrap();
    fs::write(
        place.path().join("c.csv"),
        "x (mm),y (mm),mass (g)\n0,0,3\n1,0,4\n",
    )
    .unwrap();
    let name = place.path().join("case.toml").display().to_string();
    let read = |file: &str| {
        let text = text(&format!("file = \"{file}\""), "spacing = \"1 mm\"");
        parse(&name, &text.replace("dimension = 3", "dimension = 2"), &[])
    };
    let case = read("a.csv").unwrap();
    let (cloud, _) = case.bodies[0].cloud().unwrap();
    assert_eq!(cloud.positions()[1], [1e-3, 0.0, 0.0]);
    assert!(close(case.bodies[0].shape.volume(2), 2e-6));
    let message = read("b.csv").unwrap_err().to_string();
    assert!(
        message.contains("differ in z, which a 2-dimensional case has not"),
        "{message}"
    );
    let message = read("c.csv").unwrap_err().to_string();
    assert!(
        message.contains("the unit `g` of its column `mass`: it is none of a mass"),
        "{message}"
    );
}

#[test]
fn the_saved_text_names_the_file_and_its_digest() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.csv");
    fs::write(&path, TABLE).unwrap();
    let case = case_in(place.path(), "file = \"a.csv\", part = \"ball\"", "");
    assert!(
        case.resolved.contains(&path.display().to_string()),
        "{}",
        case.resolved
    );
    assert!(case.resolved.contains("sha256"));
    // From anywhere, and as often as wanted.
    let again = parse("elsewhere/case.toml", &case.resolved, &[]).unwrap();
    assert_eq!(again.resolved, case.resolved);
    assert_eq!(again.bodies, case.bodies);
    fs::write(&path, TABLE.replace("1.5", "1.6")).unwrap();
    let message = parse("case.toml", &case.resolved, &[])
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("is no longer the one that the case began with"),
        "{message}"
    );
}

#[test]
fn particles_and_shells_of_decks_are_taken() {
    let place = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &str| fs::write(place.path().join(name), content).unwrap();
    // SPH elements with masses of one part, with volumes of the other.
    write(
        "sph.k",
        "*KEYWORD\n*NODE\n1,0,0,0\n2,1,0,0\n3,2,0,0\n*PART\nball\n5,1,1\n*PART\nsand\n6,1,1\n\
         *ELEMENT_SPH\n1,5,8.93e-6\n2,5,8.93e-6\n3,6,-0.5\n*END\n",
    );
    let keys = "file = \"sph.k\", unit = \"1 mm\", mass_unit = \"1 kg\", part = \"ball\"";
    let case = case_in(place.path(), keys, "");
    let (cloud, _) = case.bodies[0].cloud().unwrap();
    assert_eq!(cloud.get(Quantity::Mass, 1), Some(&[8.93e-6][..]));
    let keys = "file = \"sph.k\", unit = \"1 mm\", part = 6";
    let case = case_in(place.path(), keys, "");
    assert!(close(case.bodies[0].shape.volume(3), 0.5e-9));
    let keys = "file = \"sph.k\", unit = \"1 mm\", part = 5";
    let message = refused_in(place.path(), keys, "");
    assert!(
        message.contains("units of its mass: state `mass_unit`"),
        "{message}"
    );
    // Shells of a plane: a square and a triangle.
    write(
        "shells.k",
        "*NODE\n1,0,0,0\n2,2,0,0\n3,2,2,0\n4,0,2,0\n5,4,0,0\n*ELEMENT_SHELL\n1,1,1,2,3,4\n2,1,2,5,3,3\n",
    );
    let text = text("file = \"shells.k\", unit = \"1 mm\"", "");
    let name = place.path().join("case.toml").display().to_string();
    let case = parse(&name, &text.replace("dimension = 3", "dimension = 2"), &[]).unwrap();
    let (cloud, _) = case.bodies[0].cloud().unwrap();
    assert!(close(cloud.volumes()[0], 4e-6) && close(cloud.volumes()[1], 2e-6));
    assert!(close(cloud.positions()[1][0], 8e-3 / 3.0));
    let message = refused_in(place.path(), "file = \"shells.k\", unit = \"1 mm\"", "");
    assert!(message.contains("no elements of 3 dimensions"), "{message}");
}

/// Each particle has the size of its own volume: contact tells kinds of them apart.
#[test]
fn unequal_volumes_are_unequal_sizes() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |large: f64| {
        let mut text = "x (mm),y (mm),z (mm),volume (mm^3)\n".to_owned();
        for i in 0..8 {
            let volume = if i < 4 { 1.0 } else { large };
            writeln!(text, "{},0,0,{volume}", 2 * i).unwrap();
        }
        fs::write(folder.path().join("row.csv"), text).unwrap();
        case_in(folder.path(), "file = \"row.csv\"", "")
    };
    let case = rows(8.0);
    let [least, most] = case.bodies[0].lattice.sizes.expect("unequal particles");
    assert!(close(most / least, 2.0), "{least} to {most}");
    let sizes = Sizes::new(&case);
    let volume = populate::particle_volume(&case.bodies[0], 3);
    assert!(close(volume, 4.5e-9), "{volume}");
    let density = case.initial_density(&case.bodies[0]);
    for (cell, edge) in [(1e-9, 1e-3), (8e-9, 2e-3)] {
        let length = sizes.of(0, density * cell) * case.bodies[0].smoothing_length;
        assert!(close(length, 1.3 * edge), "{length}");
    }
    let kinds = SizeClasses::new(&case);
    assert!(kinds.count() > 10);
    assert_eq!(kinds.of(0, density * 1e-9), 0);
    assert!(kinds.of(0, density * 8e-9) >= kinds.count() - 2);
    assert_eq!(rows(1.0).bodies[0].lattice.sizes, None);
    assert_eq!(SizeClasses::new(&rows(1.0)).count(), 1);
}

/// A file of a folder with what it is made of, and the case that reads it.
fn cube(folder: &Path, name: &str, content: &str) {
    fs::write(folder.join(name), content).unwrap();
}

const NODES: &str = "1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n";

#[test]
fn decks_include_files_below_their_folder() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("case");
    fs::create_dir_all(folder.join("parts")).unwrap();
    cube(place.path(), "outside", NODES);
    cube(&folder, "parts/nodes.k", &format!("*NODE\n{NODES}*END\n"));
    cube(&folder, "parts/nodes.inp", NODES);
    let solid = "1,1,1,2,3,4,5,6,7,8\n";
    let keys = |file: &str| format!("file = \"{file}\", unit = \"1 mm\"");
    cube(
        &folder,
        "deck.k",
        &format!("*KEYWORD\n*INCLUDE\nparts/nodes.k\n*ELEMENT_SOLID\n{solid}"),
    );
    cube(
        &folder,
        "deck.inp",
        "*NODE,\nINPUT=parts/nodes.inp\n*ELEMENT, TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n",
    );
    for deck in ["deck.k", "deck.inp"] {
        let case = case_in(&folder, &keys(deck), "");
        let (cloud, _) = case.bodies[0].cloud().unwrap();
        assert_eq!(cloud.count(), 1, "{deck}");
        // A restart needs what was included, too.
        let nodes = folder.join("parts/nodes").with_extension(&deck[5..]);
        let before = fs::read_to_string(&nodes).unwrap();
        fs::write(&nodes, before.replace("7,1,1,1", "7,1,1,2")).unwrap();
        let digest = &cloud.file.sha256;
        let message = refused_in(
            &folder,
            &format!("{}, sha256 = \"{digest}\"", keys(deck)),
            "",
        );
        assert!(message.contains("is no longer the one"), "{message}");
    }
    std::os::unix::fs::symlink("../outside", folder.join("link")).unwrap();
    let twice = "*INCLUDE\nparts/nodes.k\nparts/nodes.k\n";
    let itself = "*INCLUDE\ndeck.k\n";
    for (content, said) in [
        ("*INCLUDE\n../outside\n", "it is not below the folder"),
        ("*INCLUDE\nlink\n", "it is not below the folder"),
        ("*INCLUDE\n/etc/passwd\n", "it is not below the folder"),
        (
            "*INCLUDE\nnowhere\n",
            "line 2: cannot include `nowhere`: No such",
        ),
        ("*INCLUDE\nparts\n", "it is a folder, not a regular file"),
        (
            twice,
            "line 3: cannot include `parts/nodes.k`: it is included twice",
        ),
        (
            itself,
            "line 2: in `deck.k`, line 2: cannot include `deck.k`",
        ),
        (
            "*INCLUDE\nparts/nodes.inp\n",
            "line 2: in `parts/nodes.inp`, line 1: it does not begin with a keyword",
        ),
    ] {
        cube(&folder, "deck.k", content);
        let message = refused_in(&folder, &keys("deck.k"), "");
        assert!(message.contains(said), "{content}: {message}");
    }
}

#[test]
fn parts_are_found_in_large_and_small_letters() {
    let case = |part: &str| format!("file = \"hexes.inp\", unit = \"1 mm\", part = \"{part}\"");
    assert_eq!(case_in(&fixtures(), &case("VOLUME1"), "").bodies.len(), 1);
    let message = refused_in(&fixtures(), &case("VOLUME"), "");
    assert!(message.contains("it has no part `VOLUME`"), "{message}");
}

/// Files of few bytes that name very much.
#[test]
fn small_files_take_little_memory_and_time() {
    let place = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &str| fs::write(place.path().join(name), content).unwrap();
    let keys = |file: &str| format!("file = \"{file}\", unit = \"1 mm\"");
    let solid = "*ELEMENT, TYPE=C3D8, ELSET=A\n1,1,2,3,4,5,6,7,8\n";
    // A set within itself is itself.
    let itself = format!(
        "*NODE\n{NODES}{solid}{}",
        "*ELSET, ELSET=a\nA, A\n".repeat(40)
    );
    write("a.inp", &itself);
    let case = case_in(place.path(), &keys("a.inp"), "");
    assert_eq!(case.bodies[0].cloud().unwrap().0.count(), 1);
    let most = "it takes more than 32 times its length and 64 MiB of memory";
    let in_turns = "*ELSET, ELSET=B\nA\n*ELSET, ELSET=A\nB\n".repeat(40);
    write("b.inp", &format!("*NODE\n{NODES}{solid}{in_turns}"));
    let mut instances = format!("*PART, NAME=P\n*NODE\n{NODES}*ELEMENT, TYPE=C3D8\n");
    for n in 1..3000 {
        let _ = writeln!(instances, "{n},1,2,3,4,5,6,7,8");
    }
    instances += "*END PART\n*ASSEMBLY, NAME=X\n";
    for n in 1..1000 {
        let _ = writeln!(instances, "*INSTANCE, NAME=I{n}, PART=P\n{n},0,0");
    }
    write("c.inp", &instances);
    let numbers: Vec<String> = (1..=3000).map(|n| format!("{n} ")).collect();
    let numbers = numbers.concat();
    let mut groups = format!(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 3000 {numbers}0\n\
         $EndEntities\n$Elements\n1 3000 1 3000\n3 1 5 3000\n"
    );
    for n in 1..=3000 {
        let _ = writeln!(groups, "{n} 1 2 3 4 5 6 7 8");
    }
    write("d.msh", &groups);
    for file in ["b.inp", "c.inp", "d.msh"] {
        let message = refused_in(place.path(), &keys(file), "");
        assert!(message.contains(most), "{file}: {message}");
    }
}

#[test]
fn mirrored_particles_have_mirrored_velocities_and_stresses() {
    let place = tempfile::tempdir().unwrap();
    let table = "# units: mm,mm,mm,m/s,m/s,m/s,g,Pa,Pa,Pa,Pa,Pa,Pa\n\
        x,y,z,vx,vy,vz,mass,deviatoric_stress_xx,deviatoric_stress_yy,deviatoric_stress_zz,\
        deviatoric_stress_xy,deviatoric_stress_xz,deviatoric_stress_yz\n\
        -1,0,0,1,2,3,1,5,-2,-3,7,8,9\n-2,0,0,1,2,3,1,5,-2,-3,7,8,9\n";
    fs::write(place.path().join("a.csv"), table).unwrap();
    let plane = "\n[[symmetry]]\naxis = \"x\"\n";
    let input = |mirror: &str| text(&format!("file = \"a.csv\"{mirror}"), "") + plane;
    let name = place.path().join("case.toml").display().to_string();
    let message = parse(&name, &input(""), &[]).unwrap_err().to_string();
    assert!(
        message.contains("has no particle above the symmetry planes"),
        "{message}"
    );
    assert!(
        message.contains("`mirror` of the file puts it there"),
        "{message}"
    );
    let case = parse(&name, &input(", mirror = \"x\""), &[]).unwrap();
    let (cloud, _) = case.bodies[0].cloud().unwrap();
    assert_eq!(cloud.positions()[1], [2e-3, 0.0, 0.0]);
    assert_eq!(
        cloud.get(Quantity::Velocity, 0),
        Some(&[-1.0, 2.0, 3.0][..])
    );
    let stress = cloud.get(Quantity::DeviatoricStress, 0);
    assert_eq!(stress, Some(&[5.0, -2.0, -3.0, -7.0, -8.0, 9.0][..]));
}

/// Elements, and points of a dump, in the form of a bar along the diagonal of x and y.
#[test]
fn a_bar_of_a_file_has_the_measure_of_a_bar() {
    let place = tempfile::tempdir().unwrap();
    let mut dump = String::from(
        "ITEM: UNITS\nsi\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n250\nITEM: BOX BOUNDS ff ff ff\n\
         0 1\n0 1\n0 1\nITEM: ATOMS id type x y z\n",
    );
    for n in 0..250 {
        let [along, across, up] = [n / 25, n / 5 % 5, n % 5].map(|k| 1e-3 * f64::from(k));
        let along = 2.0 * along;
        let [x, y] = [along - across, along + across].map(|x| x * 0.5_f64.sqrt());
        let _ = writeln!(dump, "{n} 1 {x} {y} {up}");
    }
    fs::write(place.path().join("a.dump"), dump).unwrap();
    let more = "spacing = \"1 mm\"\nvelocity = [\"9 m/s\", 0, 0]";
    let case = case_in(place.path(), "file = \"a.dump\"", more);
    let [measure] = &case.measure.measures[..] else {
        panic!("{:?}", case.measure.measures)
    };
    let model::MeasureKind::Bar(bar) = &measure.kind else {
        panic!("{measure:?}")
    };
    let half = 0.5_f64.sqrt();
    let off = bar
        .foot
        .iter()
        .zip([half, half, 0.0])
        .map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-9, "{:?}", bar.foot);
}
