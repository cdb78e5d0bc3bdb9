//! Law 1: the same bits for any ranks and threads, and through a restart, by the real program
//! under the real `mpirun`, compared by `whipple compare` field by field. Every run fills what is
//! not state with NaN between steps.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use crate::program::{WHIPPLE, project};

/// Coarse quarter impact: some 3,000 particles, in contact across slab faces, two symmetry
/// planes, to the end of the case with checkpoints on the way.
const QUARTER: &[&str] = &[
    "inputs/quarter-impact",
    "--set",
    "spacing=0.06mm",
    "--set",
    "output.checkpoint_every=0.04us",
];

/// Stops of a case of half the time, while its shock runs.
const EARLY: [&str; 2] = ["0.03us", "0.06us"];

fn whipple(ranks: usize, arguments: &[&str]) -> Output {
    let script = "source jobs/env.sh; exec mpirun -n \"$0\" \"$@\"";
    Command::new("bash")
        .current_dir(crate::project::root())
        .args(["-c", script, &ranks.to_string()])
        .arg(WHIPPLE)
        .args(arguments)
        .output()
        .expect("bash runs")
}

fn must(output: &Output, code: i32) {
    assert_eq!(
        output.status.code(),
        Some(code),
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
}

/// Runs a case to its end.
fn run(ranks: usize, threads: usize, case: &[&str], more: &[&str], out: &Path) {
    let threads = threads.to_string();
    let mut arguments = vec!["run"];
    arguments.extend(case);
    arguments.extend(more);
    arguments.extend(["--threads", &threads, "--poison", "--force", "--out"]);
    arguments.push(out.to_str().expect("a plain path"));
    must(&whipple(ranks, &arguments), 0);
}

fn assert_same(a: &Path, b: &Path, what: &str) {
    let output = Command::new(WHIPPLE)
        .arg("compare")
        .args([a, b])
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{what}:\n{text}");
    assert!(text.contains("agree to the last bit"), "{what}:\n{text}");
}

/// Runs a case alone on two threads, and holds it to that on two and five ranks, and in legs with stops at two times. Returns
/// the folder of the first.
fn same_anywhere(
    case: &[&str],
    stops: [&str; 2],
    at: impl Fn(&str) -> PathBuf,
    what: &str,
) -> PathBuf {
    let one = at("one");
    run(1, 2, case, &[], &one);
    for ranks in [2, 5] {
        let other = at(&format!("{ranks}"));
        run(ranks, 1, case, &[], &other);
        assert_same(&one, &other, &format!("{what} on {ranks} ranks"));
    }
    assert_same_in_legs(case, &[3, 1, 5], &stops, &one, &at("legs"));
    one
}

/// Runs a case in legs on so many ranks each, with a stop at a time after each but the last, and
/// compares it with an untouched run.
fn assert_same_in_legs(case: &[&str], ranks: &[usize], stops: &[&str], one: &Path, out: &Path) {
    run(ranks[0], 1, case, &["--until", stops[0]], out);
    let path = out.to_str().expect("a plain path");
    for (leg, &number) in ranks.iter().enumerate().skip(1) {
        let threads = if number == 1 { "2" } else { "1" };
        let mut again = vec!["restart", path, "--poison", "-t", threads];
        if let Some(stop) = stops.get(leg) {
            again.extend(["--until", stop]);
        }
        must(&whipple(number, &again), 0);
    }
    assert_same(one, out, &format!("in legs on {ranks:?} ranks"));
}

fn folder() -> (tempfile::TempDir, impl Fn(&str) -> PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().to_owned();
    (folder, move |name: &str| path.join(name))
}

/// Does something with each of these, two at a time: launches wait for much of their time.
fn each<T: Sync>(all: &[T], task: impl Fn(&T) + Sync) {
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(one) = all.get(next.fetch_add(1, Relaxed)) {
            task(one);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        scope.spawn(work);
    });
}

/// [`QUARTER`] to half its time.
fn half_the_time() -> Vec<&'static str> {
    [QUARTER, &["--set", "run.end_time=0.1us"]].concat()
}

#[test]
fn any_ranks_and_threads() {
    let (_keep, at) = folder();
    let reference = at("1x1");
    run(1, 1, QUARTER, &[], &reference);
    let combinations = [(7, 1), (1, 2), (2, 1), (3, 2), (4, 1)];
    each(&combinations, |&(ranks, threads)| {
        let what = format!("{ranks} ranks × {threads} threads");
        let other = at(&what);
        run(ranks, threads, QUARTER, &[], &other);
        assert_same(&reference, &other, &what);
    });
    let history = std::fs::read_to_string(reference.join("history.csv")).expect("the table");
    for name in ["failed_mass", "failure_energy"] {
        let last = column(&history, name).pop().expect("a row");
        assert!(last.parse::<f64>().expect("a number") > 0.0, "{name}");
    }
}

#[test]
#[ignore = "slow"]
fn slabs_along_and_across_the_impact_balanced_or_not() {
    let (_keep, at) = folder();
    let reference = at("reference");
    let case = half_the_time();
    run(1, 1, &case, &[], &reference);
    let ways = ["x", "y", "z"].map(|axis| [(axis, 0), (axis, 7)]);
    each(ways.as_flattened(), |(axis, balance)| {
        let what = format!("axis {axis}, balance every {balance}");
        let other = at(&what);
        let axis = format!("domain.axis={axis}");
        let balance = format!("domain.balance_every={balance}");
        run(3, 1, &case, &["--set", &axis, "--set", &balance], &other);
        assert_same(&reference, &other, &what);
    });
}

#[test]
fn every_contact_mode_variable_h_and_options() {
    let (_keep, at) = folder();
    let all = [
        ["contact.mode=potential", "run.end_time=0.05us"],
        ["contact.mode=penalty", "run.end_time=0.05us"],
        ["contact.mode=kernel", "run.end_time=0.05us"],
        ["contact.mode=none", "run.end_time=0.05us"],
        ["sph.smoothing_length=variable", "run.end_time=0.1us"],
        [
            "sph={artificial_stress=0.3, conduction=1, xsph=0.5}",
            "run.end_time=0.1us",
        ],
        [
            "output.fields=[\"peak_pressure\", \"peak_pressure_time\", \"peak_tension\", \"peak_temperature\", \"peak_strain_rate\", \"arrival_time\", \"plastic_energy\"]",
            "sph.balsara=true",
        ],
        // Until failed particles are about intact ones.
        ["sph.form=conventional", "run.end_time=0.2us"],
        ["sph.form=normalised", "run.end_time=0.2us"],
        ["sph.form=stress_points", "run.end_time=0.2us"],
        [
            "material.aluminium.failure.spall.after=recompacts",
            "sph.form=corrected",
        ],
    ];
    each(&all, |options| {
        let more = ["--set", options[0], "--set", options[1]];
        let (one, three) = (
            at(&format!("{}1", options[0])),
            at(&format!("{}3", options[0])),
        );
        run(1, 2, QUARTER, &more, &one);
        run(3, 1, QUARTER, &more, &three);
        assert_same(&one, &three, options[0]);
    });
}

/// A rod on an anvil, whose sums are over the neighbours that it began with.
#[test]
fn a_body_of_the_total_form() {
    let (_keep, at) = folder();
    let case = [
        "inputs/taylor-bar",
        "--set",
        "spacing=0.8mm",
        "--set",
        "run.end_time=12us",
    ];
    let (reference, three, legs) = (at("reference"), at("three"), at("legs"));
    run(1, 2, &case, &[], &reference);
    run(3, 1, &case, &[], &three);
    assert_same(&reference, &three, "three ranks");
    assert_same_in_legs(&case, &[2, 1, 3], &["3us", "7us"], &reference, &legs);
    let summary = std::fs::read_to_string(reference.join("summary.json")).expect("a summary");
    assert!(summary.contains("\"left_total_form\": []"), "{summary}");
}

#[test]
fn stop_and_restart_on_other_ranks() {
    let (_keep, at) = folder();
    let (reference, stopped) = (at("reference"), at("stopped"));
    run(1, 2, QUARTER, &[], &reference);
    let stops = ["0.03us", "0.09us"];
    assert_same_in_legs(QUARTER, &[3, 1, 4], &stops, &reference, &stopped);

    // From a checkpoint on the way into a folder of its own.
    let mut checkpoints: Vec<PathBuf> = std::fs::read_dir(reference.join("checkpoints"))
        .expect("checkpoints")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    checkpoints.sort();
    let from = checkpoints[0].to_str().expect("a plain path");
    let elsewhere = at("elsewhere");
    let out = elsewhere.to_str().expect("a plain path");
    must(&whipple(2, &["restart", from, "--poison", "--out", out]), 0);
    let last = |run: &Path| {
        let mut files: Vec<PathBuf> = std::fs::read_dir(run.join("snapshots"))
            .expect("snapshots")
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.extension().is_some_and(|e| e == "vtkhdf"))
            .collect();
        files.sort();
        files.pop().expect("a snapshot")
    };
    assert_same(&last(&reference), &last(&elsewhere), "restart elsewhere");
}

/// Ductile damage that softens and scatters or softens in bands alone, cracks from drawn flaws, lost tension, rock that tears
/// and keeps friction, and ceramics that bulk: mass, damage, flaws and fragments on any ranks, and through restarts in the middle of the break-up.
#[test]
#[ignore = "slow"]
fn failure_on_any_ranks_and_through_restarts() {
    let ductile = "material.aluminium.failure={ spall.pressure = \"-1.2 GPa\", \
        johnson_cook = { d1 = 0.13, d2 = 0.13, d3 = -1.5, d4 = 0.011 }, \
        fracture_energy = \"10 kJ/m^2\", scatter = 20 }";
    let localised = "material.aluminium.failure={ johnson_cook = { d1 = 0.3, d2 = 0, d3 = 0, coupling = \"localised\" }, \
        fracture_energy = \"1 kJ/m^2\" }";
    let flaws = "material.aluminium.failure={ grady_kipp = { k = \"1e32/m^3\", m = 9 }, seed = 3 }";
    let tension = "material.aluminium.failure={ principal_stress.limit = \"1 GPa\", effect = \"tension_lost\" }";
    let elastic = "material.aluminium.strength={ elastic = { shear_modulus = \"28.6 GPa\" } }";
    let yielding = "material.aluminium.strength={ von_mises = { shear_modulus = \"28.6 GPa\", yield_stress = \"0.26 GPa\" } }";
    let rock = "material.aluminium.strength={ collins = { shear_modulus = \"28.6 GPa\", cohesion = \"0.2 GPa\", friction = 1.2, \
        max_strength = \"1.5 GPa\", damaged_friction = 0.6 } }";
    let shear = "material.aluminium.failure={ ivanov = {}, principal_stress.limit = \"0.5 GPa\", fracture_energy = \"10 kJ/m^2\" }";
    let ceramic = "material.aluminium.strength={ johnson_holmquist_2 = { shear_modulus = \"28.6 GPa\", a = 0.93, b = 0.31, m = 0.6, \
        n = 0.6, max_tension = \"0.2 GPa\", hugoniot_limit = \"2.8 GPa\", hugoniot_pressure = \"1.46 GPa\" } }";
    let layers = "material.aluminium.strength={ orthotropic = { e1 = \"140 GPa\", e2 = \"40 GPa\", e3 = \"20 GPa\", \
        nu12 = 0.3, nu13 = 0.3, nu23 = 0.3, g12 = \"10 GPa\", g13 = \"10 GPa\", g23 = \"8 GPa\", crush_stress = \"1 GPa\" } }";
    let laminate = "material.aluminium.failure={ hashin = { t1 = \"2 GPa\", t2 = \"0.3 GPa\", t3 = \"0.1 GPa\", \
        s12 = \"0.2 GPa\", s13 = \"0.2 GPa\", s23 = \"0.1 GPa\", gf1 = \"1 kJ/m^2\", gf2 = \"100 J/m^2\", gf3 = \"50 J/m^2\" } }";
    let yarns = "material.aluminium.strength={ uncoupled = { e1 = \"70 GPa\", e2 = \"40 GPa\", e3 = \"5 GPa\", \
        g12 = \"1 GPa\", g13 = \"1 GPa\", c3 = \"0.2 GPa\", s12 = \"50 MPa\", s13 = \"50 MPa\" } }";
    let cloth = "material.aluminium.failure={ uncoupled = { t1 = \"0.4 GPa\", t2 = \"0.3 GPa\", t3 = \"0.1 GPa\", \
        gf1 = \"1 kJ/m^2\", gf2 = \"100 J/m^2\" } }";
    let bulking = "material.aluminium.failure={ johnson_holmquist_2 = { d1 = 0.005, d2 = 1 } }";
    let fields = |names: &str| format!("output.fields=[\"damage\", \"failure_energy\", {names}]");
    let all = [
        (
            "ductile",
            ductile,
            yielding,
            fields("\"failure_onset\", \"plastic_strain\""),
        ),
        (
            "localised",
            localised,
            yielding,
            fields("\"failure_onset\", \"neighbour_strain\""),
        ),
        ("flaws", flaws, elastic, fields("\"flaws\"")),
        (
            "laminate",
            laminate,
            layers,
            fields(
                "\"fibre_damage\", \"matrix_damage\", \"delamination\", \"opening_3\", \"fibre\", \"normal\"",
            ),
        ),
        (
            "cloth",
            cloth,
            yarns,
            fields("\"fibre_damage\", \"matrix_damage\", \"delamination\", \"fibre\", \"normal\""),
        ),
        (
            "tension",
            tension,
            yielding,
            fields("\"deviatoric_stress\""),
        ),
        (
            "rock",
            shear,
            rock,
            fields("\"failure_onset\", \"plastic_strain\""),
        ),
        (
            "ceramic",
            bulking,
            ceramic,
            fields("\"bulking_pressure\", \"plastic_strain\""),
        ),
    ];
    each(&all, |(name, failure, strength, shown)| {
        let (_keep, at) = folder();
        let mut case = QUARTER.to_vec();
        for set in [
            *failure,
            *strength,
            shown,
            "run.end_time=0.1us",
            "fragments={}",
        ] {
            case.extend(["--set", set]);
        }
        let one = same_anywhere(&case, EARLY, at, name);
        let history = std::fs::read_to_string(one.join("history.csv")).expect("the table");
        let failed = column(&history, "failed_mass").pop().expect("a row");
        assert!(failed.parse::<f64>().expect("a number") > 0.0, "{name}");
    });
}

/// Pores that crush, by all laws, with strength of the matrix and damage: the same on any ranks, and through restarts
/// while they crush.
#[test]
#[ignore = "slow"]
fn pores_crush_alike_on_any_ranks_and_through_restarts() {
    let strength = "material.aluminium.strength={ von_mises = { shear_modulus = \"28.6 GPa\", yield_stress = \"0.26 GPa\" } }";
    let failure = "material.aluminium.failure.spall.pressure=\"-0.5 GPa\"";
    let laws = [
        "p_alpha = { elastic_pressure = \"80 MPa\", solid_pressure = \"7 GPa\", sound_speed = \"4 km/s\" }",
        "epsilon_alpha = { transition_strain = -0.2, kappa = 0.98, sound_speed = \"4 km/s\" }",
        "holmquist_johnson_cook = { crush_pressure = \"80 MPa\", crush_strain = 0.002, lock_pressure = \"7 GPa\" }",
    ];
    each(&laws, |law| {
        let (_keep, at) = folder();
        let mut case = half_the_time();
        let pores = format!(
            "material.aluminium.porosity={{ porosity = 0.25, strength = \"matrix\", damage = \"crushed\", {law} }}"
        );
        let shown =
            "output.fields=[\"compaction\", \"distension\", \"deviatoric_stress\", \"damage\"]";
        for set in [&*pores, strength, failure, shown] {
            case.extend(["--set", set]);
        }
        same_anywhere(&case, EARLY, at, law);
    });
}

/// A charge of TNT on a plate, lit at its top: burnt shares and lighting times on any ranks, and through restarts while the
/// detonation runs.
#[test]
#[ignore = "slow"]
fn a_charge_burns_alike_on_any_ranks_and_through_restarts() {
    let (_keep, at) = folder();
    let mut case = half_the_time();
    for set in [
        "material.charge={ library = \"tnt\" }",
        "body.sphere.material=charge",
        "body.sphere.velocity=[0, 0, 0]",
        "detonate=[{ at = [0, 0, \"0.8 mm\"] }]",
        "output.fields=[\"burn\", \"lighting_time\", \"specific_energy\"]",
    ] {
        case.extend(["--set", set]);
    }
    same_anywhere(&case, EARLY, at, "a charge");
}

/// A plate under its weight and a pressure on its rear, which relaxes before the sphere starts, and a sphere under pressure:
/// the same on any ranks, and through restarts while it relaxes and after.
#[test]
fn a_gentle_start_on_any_ranks_and_through_restarts() {
    let (_keep, at) = folder();
    let mut case = QUARTER.to_vec();
    for set in [
        "gravity=[0, 0, \"-1e9 m/s^2\"]",
        "body.plate.overburden={ lateral = 0.8 }",
        "body.plate.lattice=glass",
        "body.sphere.pressure=0.2 GPa * exp(-(r / 0.2 mm)^2)",
        "pressure=[{ body = \"plate\", below = { z = 0 }, times = [0, \"0.1 us\"], value = [\"1 GPa\", 0] }]",
        "relaxation={ until = \"0.05 us\", waiting = [\"sphere\"] }",
        "run.end_time=0.1us",
    ] {
        case.extend(["--set", set]);
    }
    let one = same_anywhere(&case, ["0.02us", "0.07us"], at, "a gentle start");
    let loads = std::fs::read_to_string(one.join("loads.csv")).expect("the table");
    for name in ["relaxation", "pressure-1", "sphere waits"] {
        assert!(loads.contains(&format!(",{name},")), "{name}: {loads}");
    }
}

/// Rings about an axis, with friction between a sphere and a plate that meet.
#[test]
fn rings_on_any_ranks_and_through_restarts() {
    let (_keep, at) = folder();
    let case = [
        "inputs/axisymmetric-impact",
        "--set",
        "spacing=0.04mm",
        "--set",
        "contact.friction=0.2",
        "--set",
        "output.checkpoint_every=0.04us",
    ];
    same_anywhere(&case, ["0.02us", "0.07us"], at, "rings");
}

/// Rigid bodies that forces move, which share particles among ranks: a ball, a brick and a bar on a pivot; and a sphere that
/// two symmetry planes cut.
#[test]
fn free_rigid_bodies_on_any_ranks_and_through_restarts() {
    let (_keep, at) = folder();
    let case = ["tests/common/tumbling.toml"];
    let one = same_anywhere(
        &case,
        ["0.35us", "0.58us"],
        |name| at(&format!("free-{name}")),
        "what tumbles",
    );
    let table = std::fs::read_to_string(one.join("rigid.csv")).expect("the table");
    for name in ["ball", "brick", "bar"] {
        assert!(table.contains(&format!(",{name},")), "{name}: {table}");
    }
    let mut case = QUARTER.to_vec();
    for set in [
        "body.sphere.rigid=true",
        "body.sphere.free=true",
        "run.end_time=0.1us",
    ] {
        case.extend(["--set", set]);
    }
    same_anywhere(
        &case,
        ["0.02us", "0.07us"],
        |name| at(&format!("quarter-{name}")),
        "a quarter of a sphere",
    );
}

/// Gauges that are fixed, on a plane of symmetry, in the void, carried; planes that the sphere and the
/// plate pass; measures of a plate, its debris, regions, a front and a bar: every table on any ranks and through restarts between their rows.
#[test]
#[ignore = "slow"]
fn gauges_and_witness_planes_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    let mut case = QUARTER.to_vec();
    for set in [
        "run.end_time=0.1us",
        "gauge=[{ at = [0, 0, 0], along = \"+z\", fields = [\"stress\", \"velocity\"] }, \
         { at = [\"0.12 mm\", \"0.3 mm\", \"0.05 mm\"], every = \"0.01 us\" }, \
         { at = [\"1 mm\", \"1 mm\", \"2 mm\"], every_steps = 3 }, \
         { at = [0, 0, \"0.5 mm\"], moves = true, body = \"sphere\", fields = [\"peak_pressure\", \"temperature\"] }]",
        "witness=[{ normal = \"-z\" }, { normal = \"-z\", point = [0, 0, \"-0.12 mm\"] }]",
        "measure.every=0.01us",
        "measure.region=[{ below = { z = \"-0.05 mm\" }, moves = true }, { centre = [0, 0, 0], radius = \"0.2 mm\" }]",
        "measure.front=[{ from = [0, 0, \"0.5 mm\"], to = [0, 0, \"-0.2 mm\"] }]",
        "measure.bar=[{ body = \"sphere\", foot = \"-z\" }]",
    ] {
        case.extend(["--set", set]);
    }
    let (one, stopped) = (at("one"), at("stopped"));
    run(1, 2, &case, &[], &one);
    for (ranks, axis) in [(1, "z"), (2, "x"), (3, "z"), (5, "x")] {
        let other = at(&format!("{ranks}{axis}"));
        let axis = format!("domain.axis={axis}");
        run(
            ranks,
            1,
            &case,
            &["--set", &axis, "--set", "domain.balance_every=7"],
            &other,
        );
        assert_same(&one, &other, &format!("{ranks} ranks, {axis}"));
    }
    assert_same_in_legs(&case, &[2, 1, 3], &["0.03us", "0.07us"], &one, &stopped);
    for table in [
        "gauges.csv",
        "witness.csv",
        "crossings.csv",
        "bodies.csv",
        "measures.csv",
        "distributions.csv",
    ] {
        let [a, b] = [&one, &stopped].map(|run| std::fs::read(run.join(table)).expect("a table"));
        assert!(a == b && a.len() > 1000, "{table}");
    }
}

/// Gauges in so many places that some read particles of several ranks, and that their readings go into
/// files of their own, which restarts cut elsewhere.
#[test]
fn many_gauges_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    let place = |k: i32| {
        let [x, y, z] = [
            0.012 * f64::from(k),
            0.03 * f64::from(k % 4),
            0.1 - 0.05 * f64::from(k % 5),
        ];
        let every = 1 + k % 3;
        format!("{{ at = [\"{x} mm\", \"{y} mm\", \"{z} mm\"], every_steps = {every} }}")
    };
    let gauges: Vec<String> = (0..120).map(place).collect();
    let gauges = format!("gauge=[{}]", gauges.join(", "));
    let mut case = QUARTER.to_vec();
    for set in ["run.end_time=0.06us", &gauges] {
        case.extend(["--set", set]);
    }
    let (one, stopped) = (at("one"), at("stopped"));
    run(1, 2, &case, &[], &one);
    for (ranks, axis) in [(2, "x"), (3, "z"), (5, "x")] {
        let other = at(&format!("{ranks}{axis}"));
        let axis = format!("domain.axis={axis}");
        run(ranks, 1, &case, &["--set", &axis], &other);
        assert_same(&one, &other, &format!("{ranks} ranks, {axis}"));
    }
    assert_same_in_legs(&case, &[2, 3], &["0.03us"], &one, &stopped);
    let [a, b] = [&one, &stopped].map(|run| {
        assert!(!run.join("gauges.csv").exists());
        let run = files::output::RunFolder::at(run);
        let sheet = files::output::gauge_records::sheet(&run, None);
        sheet.expect("files").expect("readings")
    });
    assert!(a.rows.len() > 1000, "{}", a.rows.len());
    assert_eq!(a.text(), b.text());
}

#[test]
fn penalty_with_friction_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    let mut case = QUARTER.to_vec();
    for set in [
        "contact.mode=penalty",
        "contact.friction={static=0.4, kinetic=0.3}",
        "contact.damping=0.1",
        "run.end_time=0.06us",
    ] {
        case.extend(["--set", set]);
    }
    let (one, three, stopped) = (at("one"), at("three"), at("stopped"));
    run(1, 2, &case, &[], &one);
    run(3, 1, &case, &["--set", "domain.balance_every=7"], &three);
    assert_same(&one, &three, "three ranks");
    assert_same_in_legs(&case, &[2, 3], &["0.03us"], &one, &stopped);
    let history = std::fs::read_to_string(one.join("contacts.csv")).expect("the table");
    let last: Vec<&str> = history.lines().last().expect("a row").split(',').collect();
    assert!(last[10].parse::<f64>().expect("heat") > 0.0, "{last:?}");
}

#[test]
#[ignore = "slow"]
fn stress_points_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    let case = [
        "inputs/tension-strip",
        "--set",
        "run.end_time=100us",
        "--set",
        "output.snapshot_every=25us",
    ];
    let (one, stopped) = (at("one"), at("stopped"));
    run(1, 2, &case, &[], &one);
    for (ranks, axis) in [(2, "x"), (3, "x"), (3, "y")] {
        let other = at(&format!("{ranks}{axis}"));
        let axis = format!("domain.axis={axis}");
        let more = ["--set", &axis, "--set", "domain.balance_every=7"];
        run(ranks, 1, &case, &more, &other);
        assert_same(&one, &other, &format!("{ranks} ranks, {axis}"));
    }
    run(2, 1, &case, &["--until", "40us"], &stopped);
    let path = stopped.to_str().expect("a plain path");
    must(&whipple(3, &["restart", path, "--poison", "-t", "1"]), 0);
    assert_same(&one, &stopped, "restart on 3 ranks");
}

/// A bar of two that are joined, in a quarter, which a third tears apart.
#[test]
fn joints_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    let one = same_anywhere(&["tests/common/joined.toml"], ["3us", "9us"], at, "joints");
    let contacts = std::fs::read_to_string(one.join("contacts.csv")).expect("the table");
    let mut rows = contacts
        .lines()
        .rev()
        .map(|row| row.split(',').collect::<Vec<_>>());
    let last = rows
        .find(|row| row[1..3] == ["left", "right"])
        .expect("a row");
    assert!(last[10].parse::<f64>().expect("heat") > 0.0, "{last:?}");
}

#[test]
#[ignore = "slow"]
fn self_contact_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    let case = ["tests/common/torn.toml"];
    let (one, stopped) = (at("one"), at("stopped"));
    run(1, 2, &case, &[], &one);
    for (ranks, axis) in [(2, "x"), (3, "x"), (3, "y")] {
        let other = at(&format!("{ranks}{axis}"));
        let axis = format!("domain.axis={axis}");
        run(ranks, 1, &case, &["--set", &axis], &other);
        assert_same(&one, &other, &format!("{ranks} ranks, {axis}"));
    }
    assert_same_in_legs(&case, &[2, 1, 3], &["1.1ms", "1.9ms"], &one, &stopped);
    let contacts = std::fs::read_to_string(one.join("contacts.csv")).expect("the table");
    let last: Vec<&str> = contacts.lines().last().expect("a row").split(',').collect();
    assert_eq!(last[1..3], ["bar", "bar"]);
    assert!(last[10].parse::<f64>().expect("heat") > 0.0, "{last:?}");
}

/// Halves of a sphere and a plate that attract each other, and their images, as strongly as the impact is fast.
#[test]
#[ignore = "slow"]
fn self_gravity_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    let mut case = half_the_time();
    for set in [
        "self_gravity.constant=\"1e7 m^3/(kg s^2)\"",
        "output.fields=[\"gravity_acceleration\", \"gravity_potential\"]",
    ] {
        case.extend(["--set", set]);
    }
    let one = same_anywhere(&case, EARLY, at, "self-gravity");
    let history = std::fs::read_to_string(one.join("history.csv")).expect("the table");
    let energy = column(&history, "self_gravity_energy");
    let energy: f64 = energy.last().expect("a row").parse().expect("an energy");
    assert!(energy < 0.0, "{energy}");
}

/// The columns of a table by name.
fn column(table: &str, name: &str) -> Vec<String> {
    let mut rows = table.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = rows.next().expect("names").split(',').collect();
    let at = names.iter().position(|n| *n == name).expect("a column");
    rows.map(|row| row.split(',').nth(at).expect("a cell").to_owned())
        .collect()
}

/// Steps that flight limits, bodies that first meet on some rank, and extremes between rows, which
/// stops come between: the smallest of all rows is that of all steps.
#[test]
#[ignore = "slow"]
fn flights_and_extremes_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    let case = ["tests/common/flight.toml"];
    let (one, stopped) = (at("one"), at("stopped"));
    run(1, 2, &case, &[], &one);
    for (ranks, axis) in [(2, "x"), (3, "y")] {
        let other = at(&format!("{ranks}{axis}"));
        let axis = format!("domain.axis={axis}");
        run(ranks, 1, &case, &["--set", &axis], &other);
        assert_same(&one, &other, &format!("{ranks} ranks, {axis}"));
    }
    assert_same_in_legs(&case, &[2, 1, 3], &["0.33ms", "1.27ms"], &one, &stopped);
    let read = |name: &str| std::fs::read_to_string(one.join(name)).expect("the file");
    let every = at("every");
    run(1, 1, &case, &["--set", "output.history_every=1"], &every);
    let history = std::fs::read_to_string(every.join("history.csv")).expect("the table");
    assert!(
        column(&history, "dt_reason")
            .iter()
            .any(|reason| reason == "flight")
    );
    let contacts = read("contacts.csv");
    let [times, distances, a, b, bodies] =
        ["time", "closest_pair", "closest_a", "closest_b", "body_b"]
            .map(|name| column(&contacts, name));
    let row = (0..distances.len())
        .filter(|&row| times[row] != "0.0")
        .min_by(|&i, &j| {
            let number = |k: usize| distances[k].parse::<f64>().expect("a number");
            number(i).total_cmp(&number(j))
        })
        .expect("rows");
    let summary: serde_json::Value =
        serde_json::from_str(&read("summary.json")).expect("it is JSON");
    assert_eq!(
        Some(distances[row].parse().expect("a number")),
        summary["closest_foreign_pair"].as_f64()
    );
    let nearest = &summary["closest_foreign_particles"];
    assert_eq!(nearest["ids"][0].to_string(), a[row]);
    assert_eq!(nearest["ids"][1].to_string(), b[row]);
    assert_eq!(nearest["bodies"][1], bodies[row]);
}

#[test]
#[ignore = "slow"]
fn loads_and_rigid_bodies_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    let case = ["tests/common/loaded.toml"];
    let (one, three, stopped) = (at("one"), at("three"), at("stopped"));
    run(1, 2, &case, &[], &one);
    run(3, 1, &case, &["--set", "domain.axis=y"], &three);
    assert_same(&one, &three, "three ranks");
    assert_same_in_legs(&case, &[2, 1, 2], &["0.35us", "0.58us"], &one, &stopped);
    let loads = std::fs::read_to_string(one.join("loads.csv")).expect("the table");
    for name in [
        "load-1", "corner", "floor", "punch", "plane-1", "hook", "pipe",
    ] {
        assert!(loads.contains(&format!(",{name},")), "{name} in loads.csv");
    }
}

#[test]
#[ignore = "slow"]
fn absorbing_zones_on_any_ranks_and_through_a_restart() {
    let (_keep, at) = folder();
    for form in ["corrected", "stress_points"] {
        let form = format!("sph.form={form}");
        let case = ["tests/common/absorbed.toml", "--set", &form];
        let (one, three, stopped) = (at("one"), at("three"), at("stopped"));
        run(1, 2, &case, &[], &one);
        run(3, 1, &case, &["--set", "domain.axis=x"], &three);
        assert_same(&one, &three, "three ranks");
        assert_same_in_legs(&case, &[2, 1], &["0.17us"], &one, &stopped);
        let loads = std::fs::read_to_string(one.join("loads.csv")).expect("the table");
        assert!(loads.contains(",absorb-1,"), "the zone in loads.csv");
        let summary = std::fs::read_to_string(one.join("summary.json")).expect("it is there");
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("it is JSON");
        let zones = &summary["absorbing_zones"];
        assert!(zones["absorbed_energy"].as_f64() > Some(0.0), "{zones}");
        std::fs::remove_dir_all(&stopped).expect("room for the next");
    }
}

/// One cube of each law, in a row of collisions.
fn zoo() -> String {
    let mut text = r#"
title = "A row of cubes of different materials"
dimension = 3
spacing = "0.1 mm"
[run]
end_time = "1.5 us"
[domain]
axis = "x"
balance_every = 9
[output]
snapshot_every = "0.5 us"
checkpoint_every = "0.5 us"
history_every = 5
fields = ["temperature", "pressure", "deviatoric_stress", "plastic_strain"]
"#
    .to_owned();
    let materials = [
        "copper-johnson-cook",
        "water",
        "aluminium-6061-steinberg-guinan",
        "rubber",
        "iron-tillotson",
        "carbon-epoxy",
        "kevlar-fabric",
        "air",
    ];
    for (n, name) in (0_u32..).zip(materials) {
        let x = 0.6 * f64::from(n);
        let speed = if n % 2 == 0 { "400 m/s" } else { "-400 m/s" };
        let cube = format!(
            r#"
[material.{name}]
library = "{name}"
[[body]]
name = "{name}"
material = "{name}"
shape.box = {{ size = ["0.5 mm", "0.5 mm", "0.5 mm"], centre = ["{x} mm", 0, 0] }}
velocity = ["{speed}", 0, 0]
"#
        );
        text += &cube;
    }
    // A thin hot cloud rather than air at rest.
    text + "density = \"10 kg/m^3\"\nspecific_energy = \"0.3 MJ/kg\"\n"
}

#[test]
fn every_material() {
    let (_keep, at) = folder();
    let case = at("zoo.toml");
    std::fs::write(&case, zoo()).expect("the case is written");
    let case = [case.to_str().expect("a plain path")];
    let (one, three, stopped) = (at("one"), at("three"), at("stopped"));
    run(1, 2, &case, &[], &one);
    run(3, 1, &case, &[], &three);
    assert_same(&one, &three, "three ranks");
    assert_same_in_legs(&case, &[2, 3], &["0.7us"], &one, &stopped);
}

/// A disc on a bar in two dimensions and a hammer on a rod in one, with all options of the sums and
/// a symmetry plane each.
const DISC: &str = r#"
title = "A disc hits a bar"
dimension = 2
spacing = "0.1 mm"

[run]
end_time = "1 us"

[sph]
smoothing_length = "variable"
artificial_stress = 0.3
balsara = true
conduction = 1.0
xsph = 0.5

[output]
checkpoint_every = "0.3 us"

[material.aluminium]
library = "aluminium-2024"
failure.spall.pressure = "-1.2 GPa"

[[body]]
name = "bar"
material = "aluminium"
shape.box = { lower = ["-2 mm", "-3 mm"], upper = ["0 mm", "3 mm"] }

[[body]]
name = "disc"
material = "aluminium"
shape.sphere = { radius = "1 mm", centre = ["0 mm", "0 mm"] }
velocity = ["-4 km/s", "0 km/s"]
touch = { body = "bar", direction = "-x" }

[[symmetry]]
axis = "y"
"#;

const RODS: &str = r#"
title = "A hammer hits a rod whose far end is a plane"
dimension = 1
spacing = "0.1 mm"

[run]
end_time = "3 us"

[sph]
artificial_stress = 0.3
balsara = true
conduction = 1.0
xsph = 0.5

[output]
checkpoint_every = "1 us"

[material.aluminium]
library = "aluminium-2024"

[[body]]
name = "rod"
material = "aluminium"
shape.box = { lower = ["0 mm"], upper = ["10 mm"] }

[[body]]
name = "hammer"
material = "aluminium"
shape.box = { lower = ["10 mm"], upper = ["14 mm"] }
velocity = ["-1 km/s"]

[[symmetry]]
axis = "x"
"#;

#[test]
fn one_and_two_dimensions_with_all_options() {
    let (_keep, at) = folder();
    for (name, text) in [("disc", DISC), ("rods", RODS)] {
        let case = at(&format!("{name}.toml"));
        std::fs::write(&case, text).expect("the case is written");
        let case = [case.to_str().expect("a plain path")];
        let one = at(&format!("{name}1"));
        run(1, 2, &case, &[], &one);
        for (ranks, balance) in [(2, 0), (3, 5)] {
            let what = format!("{name} on {ranks} ranks");
            let balance = format!("domain.balance_every={balance}");
            run(ranks, 1, &case, &["--set", &balance], &at(&what));
            assert_same(&one, &at(&what), &what);
        }
        let stopped = at(&format!("{name} stopped"));
        let until = if name == "disc" { "0.5us" } else { "1.5us" };
        assert_same_in_legs(&case, &[2, 1], &[until], &one, &stopped);
    }
}

/// Five cubes of as many particles each, one to a slab of faces that never move. Two of them fly
/// along the row, graze what they pass and hit the last: slabs lose all particles and get others.
const FLYBY: &str = r#"
title = "Two cubes fly along a row of three"
dimension = 3
spacing = "0.1 mm"

[run]
end_time = "4 us"

[domain]
axis = "x"
balance_every = 0

[output]
snapshot_every = "0.5 us"
checkpoint_every = "2 us"
history_every = 5

[material.aluminium]
library = "aluminium-2024"

[[body]]
name = "second"
material = "aluminium"
shape.box = { size = ["0.5 mm", "0.5 mm", "0.5 mm"], centre = ["-3 mm", "0 mm", "0.56 mm"] }
velocity = ["4 km/s", "0 km/s", "-0.1 km/s"]

[[body]]
name = "post"
material = "aluminium"
shape.box = { size = ["0.5 mm", "0.5 mm", "0.5 mm"], centre = ["0 mm", "0 mm", "0 mm"] }

[[body]]
name = "first"
material = "aluminium"
shape.box = { size = ["0.5 mm", "0.5 mm", "0.5 mm"], centre = ["2 mm", "0 mm", "0.5 mm"] }
velocity = ["3 km/s", "0 km/s", "0 km/s"]

[[body]]
name = "block"
material = "aluminium"
shape.box = { size = ["0.5 mm", "0.5 mm", "0.5 mm"], centre = ["5 mm", "0 mm", "0 mm"] }

[[body]]
name = "wall"
material = "aluminium"
shape.box = { size = ["0.5 mm", "0.5 mm", "0.5 mm"], centre = ["12 mm", "0 mm", "0.3 mm"] }
"#;

#[test]
#[ignore = "slow"]
fn fragments_that_cross_slabs_and_ranks_that_run_empty() {
    let (_keep, at) = folder();
    let case = at("flyby.toml");
    std::fs::write(&case, FLYBY).expect("the case is written");
    let case = [case.to_str().expect("a plain path")];
    let (one, five) = (at("one"), at("five"));
    run(1, 2, &case, &[], &one);
    run(5, 1, &case, &[], &five);
    assert_same(&one, &five, "five ranks with fixed faces");

    let table = std::fs::read_to_string(five.join("performance.csv")).expect("the table");
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let column = header.iter().position(|name| *name == "empty_ranks");
    let column = column.expect("the column empty_ranks");
    let empty: Vec<u32> = lines
        .map(|line| line.split(',').nth(column).expect("a value"))
        .map(|value| value.parse().expect("a count"))
        .collect();
    let fills = empty.windows(2).any(|pair| pair[1] < pair[0]);
    let empties = empty.windows(2).any(|pair| pair[1] > pair[0]);
    assert!(empties && fills, "empty ranks by row: {empty:?}");

    let balanced = at("balanced");
    run(4, 1, &case, &["--set", "domain.balance_every=3"], &balanced);
    assert_same(&one, &balanced, "four ranks with moving faces");
}

/// Glass in a part read from a file, out of which another is cut, in contact with a plate.
#[test]
#[ignore = "slow"]
fn parts_from_files_of_triangles() {
    let (_keep, at) = folder();
    let file = project("tests/common/cube.obj");
    let shape = format!(
        "body.sphere.shape={{ difference = [{{ obj = {{ file = \"{file}\", unit = \"0.2 mm\", at = [\"-0.4 mm\", \"-0.4 mm\", 0] }} }}, \
         {{ obj = {{ file = \"{file}\", unit = \"0.1 mm\", at = [\"0.1 mm\", \"0.1 mm\", \"0.5 mm\"] }} }}], \
         turn = {{ axis = [1, 1, 0], angle = \"10 deg\" }} }}"
    );
    let part = [
        QUARTER,
        &["--set", "body.sphere.lattice=glass", "--set", &shape],
    ]
    .concat();
    let (one, two, stopped) = (at("one"), at("two"), at("stopped"));
    run(1, 2, &part, &[], &one);
    run(2, 1, &part, &[], &two);
    assert_same(&one, &two, "two ranks");
    assert_same_in_legs(&part, &[2, 1], &["0.1us"], &one, &stopped);
}

/// Glass whose faces are fitted by each rank for its slab, in a turned and pierced plate and at
/// symmetry planes.
#[test]
#[ignore = "slow"]
fn glass_in_shapes_of_any_form() {
    let (_keep, at) = folder();
    let glass = [
        QUARTER,
        &[
            "--set",
            "body.sphere.lattice=glass",
            "--set",
            "body.plate.lattice={ kind = \"glass\", seed = 7 }",
            "--set",
            "body.plate.shape={ difference = [{ cylinder = { radius = \"1.5 mm\", length = \"0.2 mm\" } }, \
             { sphere = { centre = [\"1 mm\", \"0.5 mm\", 0], radius = \"0.25 mm\" } }], \
             turn = { axis = \"x\", angle = \"1 deg\" } }",
        ],
    ]
    .concat();
    let (one, three, stopped) = (at("one"), at("three"), at("stopped"));
    run(1, 2, &glass, &[], &one);
    run(3, 1, &glass, &[], &three);
    assert_same(&one, &three, "three ranks");
    assert_same_in_legs(&glass, &[2, 3], &["0.1us"], &one, &stopped);
}

/// A plate whose spacing grows with the distance from where a sphere strikes: sizes, kinds of
/// contact, fillings of several levels.
#[test]
#[ignore = "slow"]
fn a_graded_plate() {
    let (_keep, at) = folder();
    let graded = [
        QUARTER,
        &[
            "--set",
            "body.plate.spacing={ inner = \"0.05 mm\", outer = \"0.12 mm\", at = [0, 0, 0], within = \"0.3 mm\" }",
            "--set",
            "body.plate.lattice=glass",
        ],
    ]
    .concat();
    let (one, three, stopped) = (at("one"), at("three"), at("stopped"));
    run(1, 2, &graded, &[], &one);
    run(3, 1, &graded, &[], &three);
    assert_same(&one, &three, "three ranks");
    assert_same_in_legs(&graded, &[2, 3], &["0.1us"], &one, &stopped);
}

/// Contact takes sizes of classes, which may be larger than a particle of a graded body is: halos reach as far, so that foreign
/// fractions have the same bits.
#[test]
fn graded_bodies_that_lie_on_each_other() {
    let (_keep, at) = folder();
    let case = [
        "inputs/ceramic-tile",
        "--set",
        "spacing=1mm",
        "--set",
        "body.tile.spacing.inner=1mm",
        "--set",
        "body.back.spacing.inner=1mm",
        "--set",
        "run.max_steps=1",
    ];
    let one = at("one");
    run(1, 2, &case, &[], &one);
    for ranks in [2, 3] {
        let other = at(&format!("{ranks}"));
        run(ranks, 1, &case, &[], &other);
        assert_same(&one, &other, &format!("{ranks} ranks"));
    }
}

/// Slabs of slabs of any levels and axes, balanced or not.
#[test]
fn slabs_of_slabs_on_any_ranks() {
    let (_keep, at) = folder();
    let reference = at("reference");
    let case = half_the_time();
    run(1, 2, &case, &[], &reference);
    // On two ranks all levels are the same.
    let ways = [
        (8, 2, "[\"z\", \"y\"]"),
        (8, 3, "[]"),
        (5, 3, "[\"x\", \"y\", \"z\"]"),
        (3, 2, "[\"y\"]"),
        (3, 3, "[\"z\", \"x\"]"),
        (2, 3, "[]"),
    ];
    each(&ways, |(ranks, levels, axes)| {
        let what = format!("{ranks} ranks, {levels} levels along {axes}");
        let other = at(&what);
        let levels = format!("domain.levels={levels}");
        let axes = format!("domain.axes={axes}");
        let balance = format!("domain.balance_every={}", 7 * (ranks % 2));
        let more = ["--set", &levels, "--set", &axes, "--set", &balance];
        run(*ranks, 1, &case, &more, &other);
        assert_same(&reference, &other, &what);
    });
}

/// What rests far from what moves sleeps, but where all that is no state is poisoned in each step.
#[test]
#[ignore = "slow"]
fn what_sleeps_on_any_ranks_and_through_a_restart() {
    let wide = "body.plate.shape.cylinder.radius=3mm";
    let quarter = [QUARTER, &["--set", wide, "--set", "run.end_time=0.16us"]].concat();
    let bridge = ["tests/common/bridge.toml", "--set", "run.end_time=0.5us"];
    let all = [(&quarter[..], "0.07us"), (&bridge, "0.2us")];
    each(&all, |&(case, until)| {
        let (_keep, at) = folder();
        let (reference, stopped) = (at("reference"), at("stopped"));
        run(1, 2, case, &[], &reference);
        for (ranks, threads, axis) in [(1, "2", "x"), (2, "1", "x"), (3, "1", "y")] {
            let other = at(&format!("{ranks} ranks"));
            let axis = format!("domain.axis={axis}");
            let more = ["--set", &axis, "--threads", threads, "--out"];
            let path = other.to_str().expect("a plain path");
            must(
                &whipple(ranks, &[&["run"], case, &more, &[path]].concat()),
                0,
            );
            assert_same(&reference, &other, &format!("{ranks} ranks"));
        }
        let path = stopped.to_str().expect("a plain path");
        let more = ["--until", until, "--out", path];
        must(&whipple(2, &[&["run"], case, &more].concat()), 0);
        must(&whipple(1, &["restart", path]), 0);
        assert_same(&reference, &stopped, "a restart");
    });
}

/// From slabs of slabs to others, and to slabs.
#[test]
#[ignore = "slow"]
fn a_restart_onto_another_decomposition() {
    let (_keep, at) = folder();
    let (reference, stopped) = (at("reference"), at("stopped"));
    run(1, 2, QUARTER, &[], &reference);
    let more = ["--set", "domain.levels=3", "--until", "0.05us"];
    run(8, 1, QUARTER, &more, &stopped);
    let path = stopped.to_str().expect("a plain path");
    for (ranks, set, stop) in [
        (3, "domain.levels=2", Some("0.1us")),
        (5, "domain.axes=[\"x\", \"z\"]", Some("0.15us")),
        (2, "domain.levels=1", None),
    ] {
        let mut again = vec!["restart", path, "--poison", "-t", "1", "--set", set];
        again.extend(stop.into_iter().flat_map(|stop| ["--until", stop]));
        must(&whipple(ranks, &again), 0);
    }
    assert_same(&reference, &stopped, "three restarts");
}

/// Cubes that fly past others, and glass, in slabs of slabs: some run empty, and sites are fitted by
/// the ranks whose boxes they are in.
#[test]
#[ignore = "slow"]
fn debris_and_glass_in_slabs_of_slabs() {
    let (_keep, at) = folder();
    let case = at("flyby.toml");
    std::fs::write(&case, FLYBY).expect("the case is written");
    let flyby = vec![case.to_str().expect("a plain path")];
    let mut glass = QUARTER.to_vec();
    for set in [
        "body.sphere.lattice=glass",
        "body.plate.lattice=glass",
        "run.end_time=0.05us",
    ] {
        glass.extend(["--set", set]);
    }
    each(&[("flyby", flyby), ("glass", glass)], |(name, case)| {
        let one = at(&format!("{name} 1"));
        run(1, 2, case, &[], &one);
        for (ranks, levels, balance) in [(5, 2, 0), (8, 3, 3)] {
            let what = format!("{name} on {ranks} ranks, {levels} levels");
            let other = at(&what);
            let levels = format!("domain.levels={levels}");
            let balance = format!("domain.balance_every={balance}");
            run(
                ranks,
                1,
                case,
                &["--set", &levels, "--set", &balance],
                &other,
            );
            assert_same(&one, &other, &what);
        }
    });
}
