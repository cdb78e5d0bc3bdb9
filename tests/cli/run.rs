//! What a run tells: its tables, its summary, its log, and how far it is.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::program::{
    WHIPPLE, assert_same, coarse_run, command, end, json, project, quarter_impact, ranks, start,
    status,
};

/// The columns of a table by name, of numbers.
fn table(path: &Path) -> BTreeMap<String, Vec<f64>> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for line in lines {
        for (name, value) in names.iter().zip(line.split(',')) {
            let column = columns.entry((*name).to_owned()).or_default();
            column.extend(value.parse::<f64>());
        }
    }
    columns
}

#[test]
fn a_summary_has_the_figures_of_the_run() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    end(coarse_run(2, &run).args(["--threads", "2"])).with_code(0);
    let summary = json(&run.join("summary.json"));
    let number = |key: &str| {
        summary[key]
            .as_f64()
            .unwrap_or_else(|| panic!("{key}: {summary:#}"))
    };
    assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"));
    assert!(summary["commit"].is_string());
    let (_, steps, _) = status(&run);
    for (key, value) in [
        ("ranks", 2),
        ("threads", 2),
        ("particles", 3056),
        ("steps", steps),
    ] {
        assert_eq!(summary[key], value, "{key}");
    }

    // The phases are the steps without set-up, and the rate is that of the phases.
    let phases = summary["seconds_by_phase"].as_object().unwrap();
    let stepping: f64 = phases
        .values()
        .map(|seconds| seconds.as_f64().unwrap())
        .sum();
    assert_eq!(phases.len(), 13);
    assert!(
        0.0 < stepping && stepping < number("wall_seconds"),
        "{summary:#}"
    );
    let set_up = number("set_up_seconds");
    assert!(
        0.0 < set_up && set_up + stepping < number("wall_seconds"),
        "{summary:#}"
    );
    let log = std::fs::read_to_string(run.join("log.txt")).unwrap();
    assert!(log.contains(&format!("set up in {set_up:.3} s")), "{log}");
    #[allow(clippy::cast_precision_loss, reason = "small")]
    let updates = 3056e-6 * steps as f64;
    let rate = updates / stepping / 4.0;
    assert!((number("million_updates_per_second_per_core") / rate - 1.0).abs() < 1e-6);

    for sent in ["messages", "bytes_sent"] {
        assert!(number(&format!("{sent}_per_rank_and_step")) > 0.0, "{sent}");
    }

    // At 6 particles across the sphere's radius: the bars of the fine model, times four or so.
    let bound = |key: &str, most: f64| {
        let value = number(key);
        assert!((0.0..=most).contains(&value), "{key}: {value}");
    };
    bound("energy_error_max", 5e-3);
    bound("contact_defect", 4e-3);
    bound("interpenetrated_particles", 0.0);
    bound("closest_foreign_pair", 1.0);
    bound("largest_foreign_fraction", 1.0);
    assert!(number("closest_foreign_pair") > 0.28);
    for axis in ["x", "y", "z"] {
        let error = summary["momentum_error"][axis].as_f64().unwrap();
        assert!(
            (0.0..1e-12).contains(&error),
            "momentum_error.{axis}: {error}"
        );
    }

    // What the summary says is what the tables say.
    let history = table(&run.join("history.csv"));
    let (energy, momentum) = (&history["total_energy"], &history["momentum_z"]);
    let worst = energy
        .iter()
        .map(|e| (e - energy[0]).abs())
        .fold(0.0, f64::max);
    let error = worst / history["kinetic_energy"][0];
    assert!(
        (error / number("energy_error_max") - 1.0).abs() < 1e-9,
        "{error}"
    );
    // A sphere of radius 0.3 mm and 2785 kg/m³ at −7 km/s, as far as lattices go.
    assert!(
        (momentum[0] / -2.204e-3 - 1.0).abs() < 0.02,
        "{} kg m/s",
        momentum[0]
    );
    let performance = table(&run.join("performance.csv"));
    assert_eq!(performance["empty_ranks"].last(), Some(&0.0));
    for name in ["particle_imbalance", "work_imbalance"] {
        let last = performance[name].last().unwrap();
        assert!((1.0..1.5).contains(last), "{name}: {last}");
    }
    assert!((performance["million_updates"].last().unwrap() - updates).abs() < 1e-9);
    let ranks = table(&run.join("ranks.csv"));
    let rows = performance["step"].len();
    assert_eq!(ranks["first_rank"], [0.0, 1.0].repeat(rows));
    for (n, two) in ranks["work_over_mean"].chunks(2).enumerate() {
        // What both do is twice the mean, and the busier one is that of the performance.
        assert!((two[0] + two[1] - 2.0).abs() < 1e-9, "{two:?}");
        assert!((two[0].max(two[1]) - performance["work_imbalance"][n]).abs() < 1e-9);
        let both: f64 = ranks["particles"][2 * n..2 * n + 2].iter().sum();
        assert_eq!(both, performance["particles"][n]);
    }
}

#[test]
fn ranks_without_particles_are_counted() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    // 45 particles in six layers: more ranks than layers to share out.
    let mut command = ranks(7);
    command.args([
        "run",
        &quarter_impact(),
        "--set",
        "spacing=0.2mm",
        "--set",
        "domain.axis=z",
    ]);
    end(command.arg("--out").arg(&run)).with_code(0);
    let performance = table(&run.join("performance.csv"));
    let empty = &performance["empty_ranks"];
    assert!((1.0..=6.0).contains(&empty[0]), "{empty:?}");
    // Later layers are no more.
    assert!(empty.iter().all(|&n| (0.0..=6.0).contains(&n)), "{empty:?}");
}

/// What tests ask for by the environment, the program that users build does not have.
#[cfg(not(debug_assertions))]
#[test]
fn a_users_program_has_no_faults_on_purpose() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    end(coarse_run(1, &run).env("WHIPPLE_TEST_FAULT", "panic:0:5")).with_code(0);
    let program = fs::read(WHIPPLE).unwrap();
    let name = b"WHIPPLE_TEST_FAULT";
    assert!(!program.windows(name.len()).any(|bytes| bytes == name));
}

/// Levels and axes of the slabs are told as a run begins, when they change and at its end.
#[test]
fn a_run_tells_how_space_is_cut() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let case = project("tests/common/spreading.toml");
    let mut started = ranks(8);
    started.args(["run", &case, "--threads", "1", "--out"]);
    let ended = end(started.arg(&run)).with_code(0);
    let lines = ended.stdout.lines();
    let about = |line: &&str| line.starts_with("decomposition");
    let lines: Vec<&str> = lines.filter(about).collect();
    // Where cuts lie hangs on the clock too, and so may how often they change.
    let [begun, changes @ ..] = &lines[..] else {
        panic!("{ended:#?}");
    };
    assert_eq!(
        *begun,
        "decomposition: 8 ranks in 3 levels of slabs along x, y, z"
    );
    assert!(!changes.is_empty(), "{ended:#?}");
    let log = fs::read_to_string(run.join("log.txt")).unwrap();
    let mut last = "";
    for line in changes {
        let told = line.strip_prefix("decomposition from step ");
        let (step, how) = told.and_then(|told| told.split_once(" on: ")).unwrap();
        // Slabs are looked at anew at every eighth balance.
        assert_eq!(step.parse::<u64>().unwrap() % 8, 1, "{line}");
        assert!(log.contains(line), "{log}");
        last = how;
    }
    let told = &json(&run.join("summary.json"))["decomposition"];
    assert_eq!(told["changes"], changes.len());
    assert_eq!(told["axes"][0], "z");
    let levels = told["levels"].as_u64().unwrap();
    let levels = match levels {
        1 => String::new(),
        _ => format!("{levels} levels of "),
    };
    assert!(
        last.starts_with(&format!("8 ranks in {levels}slabs along z")),
        "{last}"
    );
    let about = end(command(WHIPPLE).arg("info").arg(&run)).with_code(0);
    assert!(about.stdout.contains("decomposition"), "{about:#?}");
}

#[test]
fn a_log_tells_the_story_of_a_run() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let ended = end(coarse_run(2, &run).args(["--threads", "1"])).with_code(0);
    let lines: Vec<&str> = ended.stdout.lines().collect();
    let [first, cut, last] = lines[..] else {
        panic!("{ended:#?}");
    };
    assert_eq!(cut, "decomposition: 2 ranks in slabs along x");
    let title = "Aluminium sphere at 7 km/s on an aluminium plate";
    let begin = format!("{title}: 3056 particles, 2 ranks with 1 thread each (");
    assert!(first.starts_with(&begin), "{first}");
    let (_, step, _) = status(&run);
    let finished = format!("finished at step {step}, time 0.2 us, after ");
    assert!(last.starts_with(&finished), "{last}");
    assert!(
        last.ends_with(&format!("results in {}", run.display())),
        "{last}"
    );
    assert_eq!(ended.stderr, "");

    let log = fs::read_to_string(run.join("log.txt")).unwrap();
    let told: Vec<&str> = log
        .lines()
        .map(|line| line.split_once("] rank 0: ").unwrap().1)
        .collect();
    assert!(told[0].starts_with("whipple 0."), "{log}");
    assert!(told[1].starts_with(&begin), "{log}");
    assert!(told[2].starts_with("set up in "), "{log}");
    assert_eq!(told[3], cut, "{log}");
    assert!(told[4].ends_with("snapshots/step-00000000.vtkhdf"), "{log}");
    assert!(
        told.iter().any(|line| line.starts_with("checkpoint ")),
        "{log}"
    );
    assert!(last.starts_with(told.last().unwrap()), "{log}");

    // A restart goes on with it.
    let before = told.len();
    let end_time = ["--set", "run.end_time=0.21us"];
    let ended = end(ranks(3).arg("restart").arg(&run).args(end_time)).with_code(0);
    let warning = format!("warning: step {step} was shortened");
    assert_eq!(ended.complaints(&warning).len(), 1, "{ended:#?}");
    assert_eq!(ended.stderr.lines().count(), 1, "{ended:#?}");
    let log = fs::read_to_string(run.join("log.txt")).unwrap();
    assert!(log.lines().count() > before + 2, "{log}");
    assert!(
        log.contains(&format!("checkpoints/step-{step:08} at 0.2 us")),
        "{log}"
    );
    assert_eq!(status(&run).0, "finished");
}

#[test]
fn a_finished_run_is_left_alone() {
    let place = tempfile::tempdir().unwrap();
    let [run, copy] = ["run", "copy"].map(|name| place.path().join(name));
    end(&mut coarse_run(1, &run)).with_code(0);
    let summary = json(&run.join("summary.json"));
    let ended = end(ranks(2).arg("restart").arg(&run)).with_code(0);
    assert!(ended.stdout.starts_with("nothing to do: "), "{ended:#?}");
    assert_eq!(json(&run.join("summary.json")), summary);

    // From an earlier checkpoint into a folder of its own, and into its own by name.
    let checkpoint = fs::read_dir(run.join("checkpoints")).unwrap();
    let mut checkpoints: Vec<_> = checkpoint.map(|entry| entry.unwrap().path()).collect();
    checkpoints.sort();
    let first = &checkpoints[0];
    end(ranks(2).arg("restart").arg(first).arg("--out").arg(&copy)).with_code(0);
    assert_same(&copy, &run);
    assert_eq!(json(&run.join("summary.json")), summary);
    end(ranks(2).arg("restart").arg(first).arg("--out").arg(&run)).with_code(0);
    assert_same(&copy, &run);
}

#[test]
fn a_terminal_gets_a_bar_and_a_pipe_gets_lines() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("terminal");
    let line = format!(
        "mpirun -n 2 {WHIPPLE} run {} --set spacing=0.05mm --threads 1 --out {}",
        quarter_impact(),
        run.display()
    );
    let mut script = command("script");
    script.args(["-qec", &line, "/dev/null"]);
    if start(command("which").arg("script")).end().code == Some(0) {
        let ended = end(&mut script).with_code(0);
        assert!(
            ended.stdout.contains('█') && ended.stdout.contains(" %  step "),
            "{ended:#?}"
        );
        let last = ended.stdout.lines().last().unwrap();
        assert!(last.contains("finished at step "), "{ended:#?}");
    } else {
        eprintln!("skipped: no terminal without script(1)");
    }

    // A line every ten seconds would be too long a wait here; none comes early.
    let run = place.path().join("pipe");
    let ended = end(&mut coarse_run(2, &run)).with_code(0);
    assert_eq!(ended.complaints("").len(), 0, "{ended:#?}");
    assert!(!ended.stdout.contains('█'), "{ended:#?}");
}

/// A short run has a row of each step; by time or by steps, and through a restart between rows, they are those
/// that the case asks for.
#[test]
#[ignore = "slow"]
fn rows_are_dense_enough_for_a_curve_or_as_the_case_says() {
    let place = tempfile::tempdir().unwrap();
    let run = |name: &str, number: usize, more: &[&str]| {
        let folder = place.path().join(name);
        let mut command = ranks(number);
        command.args(["run", &quarter_impact(), "--set", "spacing=0.05mm"]);
        end(command.args(more).arg("--out").arg(&folder)).with_code(0);
        folder
    };
    let steps = |folder: &Path, name: &str| {
        let rows = table(&folder.join(name));
        let key = if name == "bodies.csv" { "time" } else { "step" };
        rows[key].len()
    };
    let usual = run("usual", 2, &[]);
    let (_, last, _) = status(&usual);
    assert!((60..250).contains(&last), "{last}");
    let rows = usize::try_from(last).unwrap() + 1;
    assert_eq!(steps(&usual, "history.csv"), rows);
    assert_eq!(steps(&usual, "performance.csv"), rows);
    // Of two bodies.
    let bodies = steps(&usual, "bodies.csv");
    assert!((2 * 35..=2 * 51).contains(&bodies), "{bodies}");

    let short = run("short", 1, &["--set", "run.max_steps=7"]);
    assert_eq!(steps(&short, "history.csv"), 8);

    // At 0, 0.05, 0.1, 0.15 us and at the end.
    let every = ["--set", "output.history_every=0.05us"];
    let timed = run("timed", 1, &every);
    assert_eq!(steps(&timed, "history.csv"), 5);
    for (at, due) in table(&timed.join("history.csv"))["time"].iter().zip(0_u8..) {
        let late = at - f64::from(due) * 0.05e-6;
        assert!((-1e-20..5e-9).contains(&late), "{at}");
    }
    let legs = run("legs", 3, &[&every[..], &["--until", "0.07us"]].concat());
    end(ranks(2).arg("restart").arg(&legs)).with_code(0);
    assert_same(&legs, &timed);

    let few = run("few", 1, &["--set", "output.history_every=50"]);
    let end = u32::try_from(last).unwrap();
    let due = (0..end).step_by(50).chain([end]);
    let expected: Vec<f64> = due.map(f64::from).collect();
    assert_eq!(table(&few.join("history.csv"))["step"], expected);
}

/// Output that a full disk loses is a failure, whatever the command.
#[test]
fn output_that_is_lost_is_a_failure() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let case = quarter_impact();
    end(coarse_run(1, &run).args(["--until", "5ns"])).with_code(0);
    let at = run.display().to_string();
    let other = place.path().join("other").display().to_string();
    let commands: &[&[&str]] = &[
        &["--help"],
        &["--version"],
        &["check", &case],
        &["check", &case, "--explain"],
        &["plan", &case, "--ranks", "2"],
        &["info", &at],
        &["info", &at, "--json"],
        &["watch", &at, "--once"],
        &["compare", &at, &at],
        &["fragments", &at],
        &["measure", &at],
        &["materials"],
        &[
            "limit",
            "sizing",
            "--diameter",
            "1cm",
            "--gap",
            "30cm",
            "--yield",
            "40ksi",
        ],
        &["generate", "schema"],
        &[
            "run",
            &case,
            "--set",
            "run.max_steps=2",
            "--set",
            "spacing=0.1mm",
            "--out",
            &other,
        ],
    ];
    for words in commands {
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let mut program = command(WHIPPLE);
        let output = program.args(*words).stdout(full).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{words:?}: {said}");
        assert!(
            said.contains("error: cannot write to the standard output: "),
            "{words:?}: {said}"
        );
    }
}

/// A number of threads beyond the cores is not taken at its word.
#[test]
fn threads_are_bounded_by_the_cores() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let most = std::thread::available_parallelism().unwrap().get() as u64;
    let mut program = command(WHIPPLE);
    program.env("RAYON_NUM_THREADS", "999999");
    program.args(["run", &quarter_impact(), "--set", "run.max_steps=2"]);
    let ended = end(program.args(["--set", "spacing=0.1mm", "--out"]).arg(&run)).with_code(0);
    assert_eq!(
        ended
            .complaints("warning: RAYON_NUM_THREADS is 999999")
            .len(),
        1,
        "{ended:#?}"
    );
    assert_eq!(json(&run.join("summary.json"))["threads"], most);
    let mut check = command(WHIPPLE);
    check.env("RAYON_NUM_THREADS", "999999");
    let ended = end(check.args(["check", &quarter_impact()])).with_code(0);
    assert_eq!(
        ended
            .complaints("warning: RAYON_NUM_THREADS is 999999")
            .len(),
        1,
        "{ended:#?}"
    );
}

/// Without memory a run ends with one message, also where a backtrace is asked for.
#[test]
fn without_memory_there_is_one_message() {
    let place = tempfile::tempdir().unwrap();
    let mut program = command("bash");
    program.env("RUST_BACKTRACE", "1");
    program.args(["-c", "ulimit -v 600000; exec \"$0\" \"$@\"", WHIPPLE]);
    program.args([
        "run",
        &quarter_impact(),
        "--threads",
        "2",
        "--set",
        "spacing=0.006mm",
    ]);
    let ended = end(program.arg("--out").arg(place.path().join("run"))).with_code(1);
    assert_eq!(
        ended.complaints("error: out of memory: ").len(),
        1,
        "{ended:#?}"
    );
}

/// Fails unless all columns of a table of two runs are the same to rounding, which is relative to the largest values of
/// the columns that share a stem.
#[track_caller]
fn assert_alike(name: &str, runs: [&Path; 2]) {
    let [a, b] = runs.map(|run| table(&run.join(name)));
    assert!(a.keys().eq(b.keys()) && !a["time"].is_empty());
    let stem = |name: &str| match name.rsplit_once('_') {
        Some((stem, "x" | "y" | "z")) => stem.to_owned(),
        _ => name.to_owned(),
    };
    for (column, values) in &a {
        // Which of the images is nearest is not the same.
        if ["closest_a", "closest_b"].contains(&&column[..]) {
            continue;
        }
        let alike = a.iter().filter(|(name, _)| stem(name) == stem(column));
        let of_stem = alike.flat_map(|(_, values)| values);
        let finite = of_stem.filter(|value| value.is_finite());
        let scale = finite.fold(0.0, |most: f64, value| most.max(value.abs()));
        // Work and heat are small beside the energies.
        let scale = match &column[..] {
            "contact_work" | "contact_heat" | "contact_energy" | "load_work" => {
                scale.max(a.get("total_energy").map_or(0.0, |all| all[0]))
            }
            "angular_momentum_x" | "angular_momentum_y" | "angular_momentum_z"
            | "angular_impulse_x" | "angular_impulse_y" | "angular_impulse_z" => {
                scale.max(1e-3 * a["momentum_z"][0].abs())
            }
            "plane_impulse_x" | "plane_impulse_y" | "plane_impulse_z" => {
                scale.max(a["momentum_z"][0].abs())
            }
            _ => scale,
        };
        assert_eq!(values.len(), b[column].len(), "{name} {column}");
        for (row, (a, b)) in values.iter().zip(&b[column]).enumerate() {
            let same = a == b || (a - b).abs() <= 1e-9 * scale;
            assert!(same, "{name} {column} row {row}: {a:e} {b:e} of {scale:e}");
        }
    }
}

#[test]
fn a_quarter_and_the_whole_model_tell_the_same() {
    let place = tempfile::tempdir().unwrap();
    let [quarter, whole] = ["quarter", "whole"].map(|name| place.path().join(name));
    let steps = ["--set", "run.max_steps=24"];
    end(coarse_run(1, &quarter).args(steps)).with_code(0);
    end(coarse_run(1, &whole)
        .args(steps)
        .args(["--set", "symmetry=[]"]))
    .with_code(0);
    for name in ["history.csv", "contacts.csv"] {
        let text = fs::read_to_string(quarter.join(name)).unwrap();
        assert!(text.contains("\n# computed_share: 0.25\n"), "{text}");
        assert_alike(name, [&quarter, &whole]);
    }
    let [a, b] = [&quarter, &whole].map(|run| json(&run.join("summary.json")));
    assert_eq!(
        (&a["computed_share"], &b["computed_share"]),
        (&0.25.into(), &1.0.into())
    );
    assert_eq!(
        a["interpenetrated_particles"],
        b["interpenetrated_particles"]
    );
    let told = |run: &Path| {
        let told = end(command(WHIPPLE).arg("info").arg(run).arg("--json")).with_code(0);
        serde_json::from_str::<serde_json::Value>(&told.stdout).unwrap()
    };
    let of_history = |told: &serde_json::Value| told["last"]["history"]["rows"][0].clone();
    let [a, b] = [told(&quarter), told(&whole)].map(|told| of_history(&told));
    for name in [
        "kinetic_energy",
        "internal_energy",
        "contact_energy",
        "momentum_z",
    ] {
        let [a, b] = [&a, &b].map(|row| row[name].as_f64().unwrap());
        assert!((a / b - 1.0).abs() < 1e-9, "{name}: {a:e} {b:e}");
    }

    // A table of a version that told what was computed.
    let path = quarter.join("history.csv");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("# computed_share: 0.25\n", "")).unwrap();
    let note = "history.csv of an earlier version is of what was computed, 1/4 of the whole";
    assert_eq!(told(&quarter)["note on history.csv"], note);
    let compared = end(command(WHIPPLE).arg("compare").arg(&quarter).arg(&whole));
    assert!(
        compared.stdout.contains(&format!("A: {note}")),
        "{compared:#?}"
    );
    let drawn = end(command(WHIPPLE).arg("plot").arg(&quarter).arg("--history")).with_code(0);
    assert!(drawn.stderr.contains(note), "{drawn:#?}");
}

/// Names of so many bodies are a text of more than 64 kB, which attributes of older files could not hold. Ranks share bodies, and
/// each of these has more of them than a task holds at once.
#[test]
fn many_bodies_are_written_and_read() {
    let place = tempfile::tempdir().unwrap();
    let case = place.path().join("discs.toml");
    let mut text = "dimension = 2\nspacing = \"0.5 mm\"\nrun.end_time = \"0.1 us\"\n\
                    material.metal.library = \"copper\"\nmeasure.bodies = true\n"
        .to_owned();
    let name = |k: u32| format!("disc-{k:04}-{}", "of-a-row-of-discs-".repeat(2));
    for k in 0..1400 {
        let [x, y] = [k % 40, k / 40].map(|n| 3 * n);
        let _ = write!(
            text,
            "[[body]]\nname = \"{}\"\nmaterial = \"metal\"\nvelocity = [\"{k} m/s\", 0]\n\
             shape.sphere = {{ centre = [\"{x} mm\", \"{y} mm\"], radius = \"1 mm\" }}\n",
            name(k)
        );
    }
    fs::write(&case, text).unwrap();
    let [alone, two] = ["alone", "two"].map(|name| place.path().join(name));
    for (number, run) in [(1, &alone), (2, &two)] {
        end(ranks(number).arg("run").arg(&case).arg("--out").arg(run)).with_code(0);
    }
    assert_same(&alone, &two);
    let rows = fs::read_to_string(alone.join("bodies.csv")).unwrap();
    assert_eq!(rows, fs::read_to_string(two.join("bodies.csv")).unwrap());
    let of_last = rows.lines().filter(|line| line.contains(&name(1399)));
    let velocities = of_last.map(|line| line.split(',').nth(13).unwrap());
    assert!(
        velocities
            .map(|v| v.parse::<f64>().unwrap())
            .all(|v| (v - 1399.0).abs() < 1e-9)
    );
    let newest = fs::read_dir(alone.join("snapshots")).unwrap();
    let newest = (newest.map(|entry| entry.unwrap().path()))
        .filter(|path| path.extension().is_some_and(|e| e == "vtkhdf"))
        .max()
        .unwrap();
    let told = end(command(WHIPPLE).arg("info").arg(newest)).with_code(0);
    assert!(told.stdout.contains(&name(1399)));
}
