//! `whipple plot --profile` and `--xy`: what the charts hold, and what they say when they cannot.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::shocks::Shocks;
use exact::finite_strain::Medium;
use material::LinearForm;
use plot::{Along, Columns, Mark, ProfileRequest, Profiles, Source, Tables};
use resvg::tiny_skia::Pixmap;

use crate::fixture::{Case, Particles, plot, write};
use files::FileOpener;

/// Two elastic bars of 4 mm that meet at ±200 m/s, with waves at 6 km/s.
const BARS: &str = r#"
dimension = 1
spacing = "0.1 mm"
run = { end_time = "3 us" }
[material.metal]
density = "7500 kg/m^3"
eos.linear = { bulk_modulus = "150 GPa", form = "logarithmic" }
strength.elastic = { shear_modulus = "90 GPa" }
[[body]]
name = "left"
material = "metal"
shape.box = { lower = ["0 mm"], upper = ["4 mm"] }
velocity = ["200 m/s"]
[[body]]
name = "right"
material = "metal"
shape.box = { lower = ["4 mm"], upper = ["8 mm"] }
velocity = ["-200 m/s"]
"#;

/// The metal of the bars.
const METAL: Medium = Medium {
    reference_density: 7500.0,
    bulk_modulus: 150e9,
    shear_modulus: 90e9,
    form: LinearForm::Logarithmic,
};

const PLATES: &str = r#"
dimension = 1
spacing = "0.1 mm"
run = { end_time = "3 us" }
[material.metal]
library = "aluminium-2024"
strength = "none"
[[body]]
name = "left"
material = "metal"
shape.box = { lower = ["0 mm"], upper = ["4 mm"] }
velocity = ["4 km/s"]
[[body]]
name = "right"
material = "metal"
shape.box = { lower = ["4 mm"], upper = ["8 mm"] }
"#;

/// A run folder with snapshots at some times (µs) of 40 particles in each of two bodies.
fn bars(folder: &Path, name: &str, case: &str, times: &[f64]) -> PathBuf {
    let run = folder.join(name);
    std::fs::create_dir_all(run.join("snapshots")).unwrap();
    std::fs::write(run.join("case.toml"), case).unwrap();
    let mut particles = Particles::default();
    for k in 0..80_u16 {
        particles
            .points
            .push([(f64::from(k) + 0.5) * 1e-4, 0.0, 0.0]);
        particles.body.push(u32::from(k / 40));
    }
    let about = Case {
        title: "Two bars".to_owned(),
        bodies: vec!["left".to_owned(), "right".to_owned()],
        spacings: vec![1e-4; 2],
        symmetry: Vec::new(),
        dimension: 1,
        densities: None,
    };
    for (k, time) in times.iter().enumerate() {
        let path = run.join(format!("snapshots/{k:06}.vtkhdf"));
        write(&path, &about, &particles, time * 1e-6);
    }
    run
}

fn source(run: &Path, snapshots: usize) -> Source {
    let path = |k| run.join(format!("snapshots/{k:06}.vtkhdf"));
    Source {
        name: run.file_name().unwrap().to_string_lossy().into_owned(),
        snapshots: (0..snapshots).map(path).collect(),
    }
}

fn request(field: &str) -> ProfileRequest {
    ProfileRequest {
        field: field.to_owned(),
        along: Along::parse("x").unwrap(),
        through: None,
        thickness: None,
        range: None,
        view: None,
        exact: true,
    }
}

/// Where a curve jumps, and between which values.
fn jumps(points: &[[f64; 2]]) -> Vec<[f64; 3]> {
    let pairs = points.windows(2).filter(|p| p[0][0] == p[1][0]);
    pairs.map(|p| [p[0][0], p[0][1], p[1][1]]).collect()
}

/// What contact forces carry is part of the stress, and not of that of the material.
#[test]
fn stress_has_that_by_contact() {
    let folder = tempfile::tempdir().unwrap();
    let run = bars(folder.path(), "bars", BARS, &[0.5]);
    for (component, by_contact) in [("xx", -3e7), ("yy", 0.0), ("xy", 1e7)] {
        let values = |field: &str| {
            let mut request = request(&format!("{field}.{component}"));
            request.exact = false;
            let profiles = Profiles::new(&FileOpener, &[source(&run, 1)], &request).unwrap();
            let curves = &profiles.chart().curves;
            let values = curves.iter().flat_map(|curve| &curve.points);
            values.map(|point| point[1]).collect::<Vec<_>>()
        };
        let (all, own) = (values("stress"), values("material_stress"));
        assert_eq!((all.len(), own.len()), (80, 80));
        for (all, own) in all.iter().zip(own) {
            assert!((all - own - by_contact).abs() < 1e-3);
        }
    }
}

#[test]
fn dots_are_the_particles_and_the_line_the_exact_answer() {
    let folder = tempfile::tempdir().unwrap();
    let run = bars(folder.path(), "bars", BARS, &[0.5]);
    let profiles = Profiles::new(&FileOpener, &[source(&run, 1)], &request("stress.xx")).unwrap();
    let curves = &profiles.chart().curves;
    // Two bodies, the answer, and its name.
    assert_eq!(curves.len(), 4);
    assert_eq!([&*curves[0].name, &*curves[1].name], ["left", "right"]);
    assert!(
        curves[..2]
            .iter()
            .all(|c| c.points.len() == 40 && c.mark == Mark::Dots)
    );
    // Fronts from the interface, which stays at 4 mm; the undisturbed parts have moved by 0.1 mm.
    let exact = &curves[2].points;
    let found = jumps(exact);
    let shock = METAL.shock(200.0);
    let way = 0.5e-6 * shock.speed - 0.1e-3;
    let expected = [
        [4e-3 - way, 0.0, shock.stress],
        [4e-3 + way, shock.stress, 0.0],
    ];
    assert_eq!(found.len(), 2, "{exact:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found[0] - expected[0]).abs() < 1e-9, "{found:?}");
        assert!((found[1] - expected[1]).abs() < 1.0 && (found[2] - expected[2]).abs() < 1.0);
    }
    assert!((exact[0][0] - 1e-4).abs() < 1e-12);
    // K/M = 5/9 of the stress is pressure.
    let pressure = Profiles::new(&FileOpener, &[source(&run, 1)], &request("pressure")).unwrap();
    let found = jumps(&pressure.chart().curves[2].points);
    let expected = -5.0 / 9.0 * shock.stress;
    assert!((found[0][2] - expected).abs() < 1.0, "{found:?}");
}

#[test]
fn moved_ends_and_symmetry_planes_are_known() {
    let folder = tempfile::tempdir().unwrap();
    let moved = |velocity: &str| {
        let rest = BARS.replace("200 m/s", "0 m/s");
        let case =
            format!("{rest}\n[[load]]\nbody = \"left\"\nbelow.x = \"1 spacing\"\n{velocity}");
        bars(folder.path(), "moved", &case, &[0.5])
    };
    let pulse = moved(
        "velocity = { times = [0, \"0.3 us\", \"0.3 us\"], x = [\"10 m/s\", \"10 m/s\", 0] }",
    );
    let profiles =
        Profiles::new(&FileOpener, &[source(&pulse, 1)], &request("velocity.x")).unwrap();
    // From the first particle, half a spacing from the end; the tail of the pulse is a fan.
    let points = &profiles.chart().curves[2].points;
    let found = jumps(points);
    let expected = [0.05e-3 + 0.5e-6 * METAL.shock(10.0).speed, 10.0, 0.0];
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        (0..3).all(|k| (found[0][k] - expected[k]).abs() < 1e-9),
        "{found:?}"
    );
    // Within it velocities from 0 to 10 m/s; what it has passed is 3 um on.
    let fan: Vec<_> = points.iter().filter(|p| p[1] > 0.5 && p[1] < 9.5).collect();
    assert!(fan.len() > 50 && fan.windows(2).all(|p| p[0][1] < p[1][1]));
    assert!(
        fan.iter().all(|p| (p[0] - 1.253e-3).abs() < 3e-6),
        "{fan:?}"
    );
    let complaint = |run: &Path| plot(run, "--profile velocity.x --exact").unwrap_err();
    let ramp = moved("velocity = { times = [0, \"1 us\"], x = [0, \"10 m/s\"] }");
    assert!(complaint(&ramp).contains("has a ramp"));
    let inside = moved("above.x = \"2 mm\"\nvelocity.x = \"1 m/s\"").join("case.toml");
    let text = std::fs::read_to_string(&inside).unwrap();
    std::fs::write(&inside, text.replace("1 spacing", "3 mm")).unwrap();
    assert!(complaint(inside.parent().unwrap()).contains("more than an outer end"));

    // The left half of the model behind a symmetry plane: a wall.
    let rest = BARS.replace("[\"200 m/s\"]", "[\"0 m/s\"]");
    let case = format!("{rest}\n[[symmetry]]\naxis = \"x\"\nposition = \"2 mm\"");
    let wall = bars(folder.path(), "wall", &case, &[0.1]);
    let profiles = Profiles::new(&FileOpener, &[source(&wall, 1)], &request("velocity.x")).unwrap();
    let points = &profiles.chart().curves[2].points;
    assert!((points[0][0] - 2e-3).abs() < 1e-12 && points[0][1].abs() < 1e-9);
}

#[test]
fn several_times_and_runs_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let first = bars(folder.path(), "first", BARS, &[0.25, 0.5]);
    let second = bars(folder.path(), "second", BARS, &[0.25, 0.5]);
    let sources = [source(&first, 2), source(&second, 2)];
    let names = |sources: &[Source]| -> Vec<String> {
        let profiles = Profiles::new(&FileOpener, sources, &request("velocity.x")).unwrap();
        let named = profiles.chart().curves.iter().map(|c| c.name.clone());
        named.filter(|name| !name.is_empty()).collect()
    };
    let exact = "exact";
    assert_eq!(names(&sources[..1]), ["0.25 µs", "0.50 µs", exact]);
    let both = names(&sources);
    assert_eq!(both[..2], ["first, 0.25 µs", "first, 0.50 µs"]);
    assert_eq!(both[3..], ["second, 0.50 µs", exact]);

    plot(&first, "--profile velocity.x --at 0.5us --with missing").unwrap_err();
    let with = format!(
        "--profile velocity.x --all --exact --with {}",
        second.display()
    );
    plot(&first, &with).unwrap();
    let picture = Pixmap::load_png(first.join("pictures/profile-velocity.x.png")).unwrap();
    assert_eq!(picture.width(), 1200);
    plot(
        &first,
        &format!("--panels --field pressure --with {}", second.display()),
    )
    .unwrap();
    assert!(plot(&first, &with.replace("--profile", "--field")).is_err());
}

#[test]
fn plates_are_known_until_a_shock_is_released() {
    let folder = tempfile::tempdir().unwrap();
    let run = bars(folder.path(), "plates", PLATES, &[0.2, 2.0]);
    let early = Profiles::new(&FileOpener, &[source(&run, 1)], &request("pressure")).unwrap();
    let found = jumps(&early.chart().curves[2].points);
    assert_eq!(found.len(), 2);
    assert!((found[0][2] - 44.6e9).abs() < 0.05e9, "{found:?}");
    let late = plot(&run, "--profile pressure --exact").unwrap_err();
    assert!(
        late.contains("free face at 0.") && late.contains("elastic bars"),
        "{late}"
    );
}

#[test]
fn two_gases_in_touch_are_known_until_their_waves_meet_the_ends() {
    let folder = tempfile::tempdir().unwrap();
    // Sod's problem in SI units: the left side at 1 kg/m³ and 1 Pa.
    let case = r#"
dimension = 1
spacing = "0.1 mm"
run = { end_time = "3 ms" }
[material.gas]
density = "1 kg/m^3"
eos.ideal_gas = { gamma = 1.4, reference_pressure = "1 Pa" }
strength = "none"
[[body]]
name = "left"
material = "gas"
shape.box = { lower = ["0 mm"], upper = ["4 mm"] }
[[body]]
name = "right"
material = "gas"
density = "0.125 kg/m^3"
specific_energy = "2 J/kg"
shape.box = { lower = ["4 mm"], upper = ["8 mm"] }
[contact]
mode = "kernel"
"#;
    let run = bars(folder.path(), "sod", case, &[1e3, 3e3]);
    let profiles = Profiles::new(&FileOpener, &[source(&run, 1)], &request("density")).unwrap();
    let found = jumps(&profiles.chart().curves[2].points);
    // The contact at u* = 0.92745 m/s, the shock at 1.75216 m/s.
    let expected = [[4.92745e-3, 0.42632, 0.26557], [5.75216e-3, 0.26557, 0.125]];
    let steep: Vec<_> = found
        .iter()
        .filter(|j| (j[1] - j[2]).abs() > 1e-6)
        .collect();
    assert_eq!(steep.len(), 2, "{found:?}");
    for (found, expected) in steep.iter().zip(expected) {
        assert!((found[0] - expected[0]).abs() < 1e-8, "{found:?}");
        assert!((found[1] - expected[1]).abs() < 1e-5 && (found[2] - expected[2]).abs() < 1e-5);
    }
    let late = plot(&run, "--profile density --exact").unwrap_err();
    assert!(late.contains("has met an end"), "{late}");
    // Held ends send no waves: at 2 ms those of free ends would have met the shock.
    let held = format!(
        "{case}\n[[symmetry]]\naxis = \"x\"\n[[load]]\nbody = \"right\"\nabove.x = \"7.9 mm\"\nvelocity.x = 0"
    );
    let tube = bars(folder.path(), "held", &held, &[2.0e3]);
    let profiles = Profiles::new(&FileOpener, &[source(&tube, 1)], &request("density")).unwrap();
    let points = &profiles.chart().curves[2].points;
    let ends = [points[0][0], points[points.len() - 2][0]];
    assert!(
        ends[0].abs() < 1e-12 && (ends[1] - 7.95e-3).abs() < 1e-9,
        "{ends:?}"
    );
    let moved = held.replace("velocity.x = 0", "velocity.x = \"1 m/s\"");
    let moved = bars(folder.path(), "moved", &moved, &[1e3]);
    let complaint = plot(&moved, "--profile density --exact").unwrap_err();
    assert!(complaint.contains("unlike the gas"), "{complaint}");
}

#[test]
fn unknown_cases_say_which_are_known() {
    let folder = tempfile::tempdir().unwrap();
    let complaint = |case: &str, options: &str| {
        let run = bars(folder.path(), "unknown", case, &[0.1]);
        plot(&run, &format!("--profile {options} --exact")).unwrap_err()
    };
    let strong = PLATES.replace("strength = \"none\"", "");
    let message = complaint(&strong, "pressure");
    assert!(
        message.contains("\"left\" has more") && message.contains("elastic bars"),
        "{message}"
    );
    let ignored = format!("{BARS}\n[contact]\nmode = \"none\"");
    assert!(complaint(&ignored, "pressure").contains("do not see each other"));
    let broken = complaint("dimension = 1", "pressure");
    assert!(broken.contains("case.toml"), "{broken}");
    assert!(complaint(BARS, "id").contains("velocity.x, density"));
    assert!(complaint(BARS, "pressure --along r").contains("along r"));
}

#[test]
fn lines_and_fields_that_are_not_there_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let run = bars(folder.path(), "bars", BARS, &[0.1]);
    let complaint = |options: &str| plot(&run, options).unwrap_err();
    assert!(complaint("--profile body").contains("--profile pressure"));
    assert!(complaint("--profile presure").contains("did you mean \"pressure\""));
    assert!(complaint("--profile stress.w").contains("field \"stress\" has no component \"w\""));
    assert!(complaint("--profile pressure --along w").contains("x, y, z, or r"));
    let missed = complaint("--profile pressure --through y=1mm");
    assert!(missed.contains("--through"), "{missed}");
    assert!(complaint("--profile pressure --range 2:1GPa").contains("LOW < HIGH"));
    assert!(complaint("--along y").contains("--profile"));
    assert!(complaint("--exact").contains("--profile"));
    assert!(complaint("--with elsewhere").contains("--panels"));
    plot(
        &run,
        "--profile density --range 2600:3000kg/m3 --view -1:9mm",
    )
    .unwrap();
    plot(&run, "--profile velocity --along r --through x=4mm").unwrap();
}

#[test]
fn a_row_of_a_solid_stays_one_row() {
    // A square lattice, stretched by a tenth across the line: the rows beside the axis stay.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.vtkhdf");
    let mut particles = Particles::default();
    for k in 0..100 {
        let at = |k: i32| (f64::from(k) + 0.5) * 1e-3;
        particles
            .points
            .push([at(k % 10), 1.1 * (at(k / 10) - 5e-3), 0.0]);
        particles.body.push(0);
    }
    let about = Case {
        title: "Block".to_owned(),
        bodies: vec!["block".to_owned()],
        spacings: vec![1e-3],
        symmetry: Vec::new(),
        dimension: 3,
        densities: None,
    };
    write(&path, &about, &particles, 0.0);
    let count = |through: Option<&str>| {
        let request = ProfileRequest {
            exact: false,
            through: through.map(str::to_owned),
            ..request("pressure")
        };
        let source = Source {
            name: String::new(),
            snapshots: vec![path.clone()],
        };
        Profiles::new(&FileOpener, &[source], &request)
            .unwrap()
            .chart()
            .curves[0]
            .points
            .len()
    };
    assert_eq!(count(None), 20);
    assert_eq!(count(Some("y=0.55mm")), 10);
}

#[test]
fn tables_are_drawn_with_measured_points() {
    let folder = tempfile::tempdir().unwrap();
    let table = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let mut rows = String::from("# units: s,m,-\ntime,front,error\n");
    for k in 1..50 {
        writeln!(
            rows,
            "{},{},{}",
            0.01 * f64::from(k),
            0.1 * f64::from(k),
            1.0 / f64::from(k)
        )
        .unwrap();
    }
    let run = table("run.csv", &rows);
    let measured = table("measured.csv", "T,Z\n0.1,1.0\n0.3,2.9\n");
    plot(
        &run,
        &format!("--xy time:front --points {}:T:Z", measured.display()),
    )
    .unwrap();
    let picture = Pixmap::load_png(folder.path().join("xy-time-front.png")).unwrap();
    // The rings of the second colour, in the picture and in the legend.
    let orange = |pixel: &resvg::tiny_skia::PremultipliedColorU8| {
        [pixel.red(), pixel.green(), pixel.blue()] == [230, 159, 0]
    };
    assert!(picture.pixels().iter().filter(|p| orange(p)).count() > 100);
    plot(&run, "--xy time:front,error --log xy").unwrap();
    assert!(
        plot(&run, "--xy time:tail")
            .unwrap_err()
            .contains("time, front, error")
    );
    assert!(plot(&run, "--xy time").unwrap_err().contains("X:Y"));
    assert!(plot(&run, "--points a.csv").unwrap_err().contains("--xy"));
    assert!(plot(&run, "--history").unwrap_err().contains("no column"));
    plot(&run, "--xy time:front --view 0:0.2s --range 0:2m").unwrap();
    assert!(
        plot(&run, "--xy time:front --range 0:2s")
            .unwrap_err()
            .contains("0:2s")
    );
}

#[test]
fn a_front_is_a_table_and_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let run = bars(folder.path(), "bars", BARS, &[0.0, 0.5]);
    // Along the axis and against it: the outer end, and the one that was at 4 mm.
    let ends = [("x", "x", 8e-3), ("-x", "minus-x", 4e-3)];
    for (along, name, end) in ends {
        plot(&run, &format!("--front right --along {along}")).unwrap();
        let table = run.join(format!("pictures/front-right-{name}.csv"));
        let table = std::fs::read_to_string(table).unwrap();
        let lines: Vec<&str> = table.lines().collect();
        let head = format!("time,front_{}", name.replace('-', "_"));
        assert_eq!(lines[..2], ["# units: s,m", head.as_str()]);
        assert_eq!(lines.len(), 4, "{table}");
        let [time, front] = lines[3]
            .split(',')
            .map(|cell| cell.parse::<f64>().unwrap())
            .collect::<Vec<_>>()[..]
        else {
            panic!("{table}");
        };
        assert!(
            (time - 0.5e-6).abs() < 1e-15 && (front - end).abs() < 1e-12,
            "{front}"
        );
        assert!(
            run.join(format!("pictures/front-right-{name}.png"))
                .exists()
        );
    }
    let measured = folder.path().join("measured.csv");
    std::fs::write(&measured, "# units: s,m\ntime,front\n1e-7,8e-3\n").unwrap();
    plot(
        &run,
        &format!("--front right --points {}", measured.display()),
    )
    .unwrap();
    let unknown = plot(&run, "--front middle").unwrap_err();
    assert!(unknown.contains("left, right"), "{unknown}");
    assert!(
        plot(&run, "--front left --along r")
            .unwrap_err()
            .contains("x, y or z")
    );
}

#[test]
fn forces_are_drawn_for_each_pair_or_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("contacts.csv");
    let mut rows =
        String::from("# units: s,-,-,N,N,N\ntime,body_a,body_b,force_x,force_y,force_z\n");
    for k in 0..=20 {
        let t = f64::from(k) * 1e-7;
        // One pair presses, one pulls half as much, one does not meet.
        let (push, pull) = (-6000.0 * t / 2e-6, 3000.0 * t / 2e-6);
        writeln!(rows, "{t:e},bumper,sphere,0,0,{push}").unwrap();
        writeln!(rows, "{t:e},wall,sphere,{pull},0,0").unwrap();
        writeln!(rows, "{t:e},bumper,wall,0,0,0").unwrap();
    }
    std::fs::write(&path, rows).unwrap();
    let chart = |pair: Option<[&str; 2]>, y: &str| {
        let tables = Tables {
            gauges: Vec::new(),
            title: String::new(),
            tables: vec![("contacts".to_owned(), path.clone())],
            columns: Columns::parse(&format!("time:{y}")).unwrap(),
            pair: pair.map(|names| names.map(str::to_owned)),
            label: None,
            points: Vec::new(),
            spans: [None, None],
            logarithmic: [false; 2],
            dots: false,
        };
        tables.chart(&FileOpener).unwrap()
    };
    let all = chart(None, "force");
    let names: Vec<&str> = all.curves.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(
        names,
        ["bumper – sphere", "wall – sphere"],
        "those that meet"
    );
    assert_eq!(all.curves[0].points[20], [2e-6, 6000.0]);
    assert_eq!(all.curves[1].points[20], [2e-6, 3000.0]);
    assert!(all.curves.iter().all(|curve| curve.points.len() == 21));
    assert_eq!(all.y.unit, "N");
    let one = chart(Some(["sphere", "bumper"]), "force_x,force_z");
    assert_eq!(one.subtitle, "bumper – sphere");
    let names: Vec<&str> = one.curves.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["force x", "force z"]);
    assert_eq!(one.curves[1].points[20], [2e-6, -6000.0]);

    plot(&path, "").unwrap();
    plot(&path, "--pair bumper,sphere").unwrap();
    plot(folder.path(), "--pair wall,sphere --xy time:force").unwrap();
    for name in [
        "xy-time-force.png",
        "xy-time-force_x-force_y-force_z-bumper-sphere.png",
        "pictures/xy-time-force-wall-sphere.png",
    ] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
    let complaint = plot(&path, "--pair bumper,plate").unwrap_err();
    assert!(
        complaint.contains("bumper – sphere, wall – sphere, bumper – wall"),
        "{complaint}"
    );
    assert!(
        plot(&path, "--pair bumper")
            .unwrap_err()
            .contains("two bodies")
    );
    let other = folder.path().join("other.csv");
    std::fs::write(&other, "a,b\n1,2\n").unwrap();
    assert!(plot(&other, "").unwrap_err().contains("--xy"));
    assert!(plot(&other, "--pair a,b").unwrap_err().contains("no pairs"));
}
