//! `whipple plot` on synthetic snapshots: what the pictures show and what it says when it cannot.

use std::path::{Path, PathBuf};
use std::time::Instant;

use files::output::h5::read::SnapshotFile;
use resvg::tiny_skia::Pixmap;

use crate::fixture::{self, Case, Particles, impact, plot, write};
use results::SnapshotReader as _;

/// Colours of the first two bodies.
const SPHERE: [u8; 3] = [0, 114, 178];
const PLATE: [u8; 3] = [230, 159, 0];

/// Draws one picture of a snapshot and reads it back.
fn picture(snapshot: &Path, options: &str) -> Pixmap {
    let out = snapshot.with_extension("png");
    plot(snapshot, &format!("{options} --out {}", out.display())).unwrap();
    Pixmap::load_png(out).unwrap()
}

fn quarter(folder: &Path, stage: f64) -> PathBuf {
    let path = folder.join("state.vtkhdf");
    write(&path, &Case::quarter(), &impact(stage), 2e-7 * stage);
    path
}

/// Pixels of a colour below the legend: columns, rows and how many.
struct Patch {
    columns: [u32; 2],
    rows: [u32; 2],
    count: u32,
}

fn patch(picture: &Pixmap, colour: [u8; 3]) -> Patch {
    let mut found = Patch {
        columns: [u32::MAX, 0],
        rows: [u32::MAX, 0],
        count: 0,
    };
    for row in 130..picture.height() {
        for column in 0..picture.width() {
            let pixel = picture.pixel(column, row).unwrap();
            if [pixel.red(), pixel.green(), pixel.blue()] == colour {
                found.columns = [found.columns[0].min(column), found.columns[1].max(column)];
                found.rows = [found.rows[0].min(row), found.rows[1].max(row)];
                found.count += 1;
            }
        }
    }
    found
}

fn length([first, last]: [u32; 2]) -> f64 {
    f64::from(last) - f64::from(first) + 1.0
}

#[test]
fn a_mirrored_section_is_to_scale_and_symmetric() {
    let folder = tempfile::tempdir().unwrap();
    let picture = picture(&quarter(folder.path(), 0.0), "");
    assert_eq!(picture.width(), 1200);
    let (sphere, plate) = (patch(&picture, SPHERE), patch(&picture, PLATE));
    let (ball, sheet) = (
        [length(sphere.columns), length(sphere.rows)],
        length(plate.columns),
    );
    // Edges are mixed with the paper and the outline: two pixels each.
    assert!((ball[0] - ball[1]).abs() <= 3.0, "{ball:?}");
    assert!(
        (sheet / ball[0] - 3.0 / 0.6).abs() < 0.06,
        "{sheet} {ball:?}"
    );
    assert!((length(plate.columns) / length(plate.rows) - 15.0).abs() < 0.5);
    let middles = [sphere, plate].map(|p| p.columns[0] + p.columns[1]);
    assert!(middles[0].abs_diff(middles[1]) <= 2);
}

#[test]
fn without_mirror_only_the_quarter_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let snapshot = quarter(folder.path(), 0.0);
    let half = patch(&picture(&snapshot, "--no-mirror"), SPHERE);
    let aspect = length(half.columns) / length(half.rows);
    assert!((aspect - 0.5).abs() < 0.02, "{aspect}");
}

#[test]
fn a_section_shows_one_layer() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.vtkhdf");
    // Layers of different bodies, one spacing apart: any plane shows exactly one of them.
    let mut particles = Particles::default();
    for layer in 0..2_u8 {
        for k in 0..10 {
            let at = |k: i32| (f64::from(k) + 0.5) * 1e-3;
            particles.points.push([at(k), at(i32::from(layer)), 0.0]);
            particles.points.push([at(k), at(i32::from(layer)), 1e-3]);
            particles.body.extend([u32::from(layer); 2]);
        }
    }
    let case = Case {
        spacings: vec![1e-3; 2],
        symmetry: Vec::new(),
        ..Case::quarter()
    };
    write(&path, &case, &particles, 0.0);
    for (position, shown, hidden) in [
        ("y=0", SPHERE, PLATE),
        ("y=0.7mm", SPHERE, PLATE),
        ("y=1mm", PLATE, SPHERE),
        ("y=1.9mm", PLATE, SPHERE),
    ] {
        let picture = picture(&path, &format!("--as particles --section {position}"));
        assert!(patch(&picture, shown).count > 1000, "{position}");
        assert_eq!(patch(&picture, hidden).count, 0, "{position}");
    }
    let both = picture(&path, "--section y=1mm --thickness 3mm");
    assert!(patch(&both, SPHERE).count + patch(&both, PLATE).count > 1000);
    let complaint = plot(&path, "--section y=5mm").unwrap_err();
    assert!(complaint.contains("y = 5.000 mm"), "{complaint}");
    assert!(complaint.contains("0.500 mm to 1.500 mm"), "{complaint}");
}

/// A block that has been stretched to three times its length, and squeezed to a third of its height, is solid by its
/// deformation gradient; where that is zero, there are gaps.
#[test]
fn what_is_stretched_is_solid_by_its_deformation_gradient() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.vtkhdf");
    let mut particles = Particles::default();
    for k in 0..8_i32.pow(3) {
        let at = |k: i32| (f64::from(k % 8) + 0.5) * 1e-3;
        let point = [3.0 * at(k), at(k / 8), at(k / 64) / 3.0];
        particles.points.push(point);
        particles.body.push(0);
    }
    let case = Case {
        spacings: vec![1e-3; 2],
        symmetry: Vec::new(),
        ..Case::quarter()
    };
    let stretch = [3.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 / 3.0];
    for (gradient, solid) in [(stretch, true), ([0.0; 9], false)] {
        write(&path, &case, &particles, 0.0);
        let gradients = gradient.repeat(particles.body.len());
        fixture::add_field(&path, "deformation_gradient", &gradients, 9);
        let patch = patch(&picture(&path, "--section y"), SPHERE);
        let [long, high] = [patch.columns, patch.rows].map(length);
        let share = f64::from(patch.count) / (long * high);
        assert_eq!(share > 0.98, solid, "{share}");
        assert!(!solid || (long / high / 9.0 - 1.0).abs() < 0.02);
    }
}

#[test]
fn fields_ranges_and_views_are_drawn_in_their_colours() {
    let folder = tempfile::tempdir().unwrap();
    let snapshot = quarter(folder.path(), 0.0);
    // The plate far from the axis moves at 0.9 km/s, beyond the red end of this range.
    let options = "--field velocity.z --range=-0.5:0.5km/s --view=1:1.4,-0.3:0.1mm";
    let picture = picture(&snapshot, options);
    assert!(patch(&picture, [180, 4, 38]).count > 20_000);
    for field in [
        "pressure",
        "velocity",
        "deviatoric_stress.xy",
        "von_mises",
        "id",
        "density",
    ] {
        plot(&snapshot, &format!("--field {field}")).unwrap();
        let name = format!("state-{field}.png");
        assert!(folder.path().join(name).is_file());
    }
}

#[test]
fn a_run_gives_its_last_snapshot_panels_all_and_history() {
    let folder = tempfile::tempdir().unwrap();
    let run = fixture::run(folder.path());
    let has = |name: &str| run.join("pictures").join(name).is_file();
    let started = Instant::now();
    plot(&run, "").unwrap();
    assert!(has("000002-body.png") && !has("000001-body.png"));
    plot(&run, "--time 0.11us --field pressure").unwrap();
    assert!(has("000001-pressure.png"));
    plot(&run, "--all").unwrap();
    assert!(has("000000-body.png") && has("000001-body.png"));
    plot(&run, "--panels").unwrap();
    let panels = Pixmap::load_png(run.join("pictures/panels-body.png")).unwrap();
    assert_eq!(panels.width(), 1800);
    plot(&run, "--history").unwrap();
    assert!(has("history.png"));
    // Ten sections of 48,000 particles; the bar is two seconds for one.
    assert!(started.elapsed().as_secs_f64() < 10.0);

    let complaint = plot(&run, "--index 7").unwrap_err();
    assert!(complaint.contains("snapshots 0 to 2"), "{complaint}");
    let complaint = plot(&run, "--all --out one.png").unwrap_err();
    assert!(complaint.contains("folder"), "{complaint}");
    assert!(plot(&run, "--all --time 0").is_err());
}

#[test]
fn complaints_say_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let snapshot = quarter(folder.path(), 0.0);
    let complaint = |options: &str| plot(&snapshot, options).unwrap_err();
    let unknown = complaint("--field presure");
    assert!(unknown.contains("did you mean \"pressure\""), "{unknown}");
    assert!(unknown.contains("density"), "{unknown}");
    assert!(complaint("--field velocity.w").contains("x, y, z, magnitude"));
    assert!(complaint("--field deviatoric_stress").contains("needs a component"));
    assert!(complaint("--field pressure.x").contains("scalar"));
    assert!(complaint("--section w=1mm").contains("y=0"));
    assert!(complaint("--section y=0.1").contains("unit of m"));
    assert!(complaint("--thickness 0").contains("above zero"));
    assert!(complaint("--range 0:1GPa").contains("--field"));
    assert!(complaint("--field pressure --range 3:1GPa").contains("LOW < HIGH"));
    assert!(complaint("--view 1:2mm").contains("BOTTOM:TOP"));
    assert!(complaint("--index 0").contains("folder"));
    assert!(complaint("--width 10").contains("400"));
    let text = folder.path().join("case.toml");
    std::fs::write(&text, "title = 'no snapshot'").unwrap();
    assert!(plot(&text, "").unwrap_err().contains("HDF5"));
    assert!(
        plot(&folder.path().join("gone"), "")
            .unwrap_err()
            .contains("No such file")
    );
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    let empty = plot(&folder.path().join("empty"), "").unwrap_err();
    assert!(empty.contains("no snapshots"), "{empty}");
}

#[test]
fn values_that_are_not_finite_are_pink_and_lost_positions_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.vtkhdf");
    let mut particles = impact(0.0);
    particles.points[0] = [f64::NAN; 3];
    write(&path, &Case::quarter(), &particles, 0.0);
    {
        let file = hdf5::File::open_rw(&path).unwrap();
        let pressure = file.dataset("VTKHDF/PointData/pressure").unwrap();
        let mut values = pressure.read_raw::<f64>().unwrap();
        values.fill(1e9);
        values[1] = f64::NAN;
        pressure.as_writer().write_raw(&values).unwrap();
    }
    let options = "--field pressure --view=-0.2:0.2,-0.2:0mm";
    // One particle beside the axis and its image, each a disc of 26 pixels.
    let pink = patch(&picture(&path, options), [255, 0, 255]).count;
    assert!((2 * 500..2 * 3000).contains(&pink), "{pink}");
}

#[test]
fn a_snapshot_file_gives_its_fields() {
    let folder = tempfile::tempdir().unwrap();
    let file = SnapshotFile::open(&quarter(folder.path(), 1.0)).unwrap();
    let n = file.particles();
    assert!(n > 45_000);
    let names = [
        "body",
        "contact_stress",
        "density",
        "deviatoric_stress",
        "id",
        "pressure",
        "velocity",
    ];
    assert_eq!(file.names().unwrap(), names);
    assert!((file.time().unwrap() - 2e-7).abs() < 1e-20);
    assert_eq!(file.components("deviatoric_stress").unwrap(), 6);
    assert_eq!(file.scalar("id", 0, 7..9).unwrap(), [7.0, 8.0]);
    let velocity = file.values("velocity", 10..12).unwrap();
    assert_eq!(
        file.scalar("velocity", 2, 10..12).unwrap(),
        [velocity[2], velocity[5]]
    );
    assert_eq!(file.points(0..n).unwrap().len(), n);
    assert!(file.points(n..n).unwrap().is_empty());
    assert_eq!(file.field_attribute("density", "unit").unwrap(), "kg/m^3");
    assert_eq!(file.field_attribute("id", "unit").unwrap(), "1");
    assert!(
        file.attribute("/whipple", "title")
            .unwrap()
            .contains("sphere")
    );
    let missing = file
        .attribute("/whipple", "colour")
        .unwrap_err()
        .to_string();
    assert!(
        missing.contains("attribute colour of /whipple"),
        "{missing}"
    );
    assert!(file.scalar("velocity", 3, 0..1).is_err());
    assert!(file.values("velocity", n..n + 1).is_err());
}
