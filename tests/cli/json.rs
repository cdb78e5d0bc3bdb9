//! Answers as JSON documents, runs that are quiet, and logs as JSON.

use std::fs;

use crate::program::{COARSE, Ended, WHIPPLE, coarse_run, command, end, quarter_impact, ranks};
use serde_json::Value;

/// What a command alone prints, which must be one document.
#[track_caller]
fn document(arguments: &[&str]) -> Value {
    let ended = end(command(WHIPPLE).args(arguments).arg("--json")).with_code(0);
    serde_json::from_str(&ended.stdout).unwrap_or_else(|e| panic!("{e}: {ended:#?}"))
}

fn fragments_and_debris(run: &str) {
    let fragments = document(&["fragments", run, "--include", "all"]);
    let count = fragments["fragments"].as_u64().unwrap();
    // Images behind planes of symmetry are fragments too, and share a row.
    let copies = fragments["rows"].as_array().unwrap().iter();
    let copies = copies.map(|row| row["copies"].as_u64().unwrap());
    assert_eq!(copies.sum::<u64>(), count);
    assert!(fragments["total_mass"].as_f64().unwrap() > 0.0);
    // What is of no body's largest piece, with all that failed.
    let fragments = document(&["fragments", run]);
    let debris = fragments["debris"].as_array().unwrap().iter();
    let of = |one: &Value, key: &str| one[key].as_f64().unwrap();
    let failed: f64 = debris.clone().map(|one| of(one, "failed")).sum();
    assert!(
        (failed - of(&fragments["failed"], "mass")).abs() <= 1e-9 * of(&fragments, "total_mass")
    );
    for one in debris {
        assert!(of(one, "mass") * (1.0 + 1e-9) >= of(one, "failed") + of(one, "in_fragments"));
        assert!(one["body"].is_string() && of(one, "share") <= 1.0);
    }
}

/// A catalogue of what a run has left: its ledger closes, and what hangs together encloses its volume.
#[test]
fn fragments_have_a_catalogue() {
    let place = tempfile::tempdir().unwrap();
    let [run, out] = ["run", "catalogue"].map(|name| place.path().join(name));
    end(&mut coarse_run(1, &run)).with_code(0);
    let mut fragments = command(WHIPPLE);
    fragments
        .arg("fragments")
        .arg(&run)
        .arg("--catalogue")
        .arg(&out);
    let ended = end(&mut fragments).with_code(0);
    assert!(
        ended.stdout.contains("NASA's breakup model: "),
        "{ended:#?}"
    );
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(out.join(name)).unwrap();
        let lines = text.lines().skip(2);
        let cells = |line: &str| {
            line.split(',')
                .map(|cell| cell.parse().unwrap_or(0.0))
                .collect()
        };
        lines.map(cells).collect()
    };
    // Parts and all: mass, momentum along the only axis that is no mirror's, energy.
    let ledger = rows("ledger.csv");
    for column in [1, 4, 5] {
        let parts: f64 = ledger[..3].iter().map(|row| row[column]).sum();
        let all = ledger[3][column];
        assert!(
            (parts / all - 1.0).abs() < 1e-12,
            "{column}: {parts} of {all}"
        );
    }
    let catalogue = rows("catalogue.csv");
    let mass: f64 = catalogue.iter().map(|row| row[2] * row[4]).sum();
    assert!((mass / ledger[0][1] - 1.0).abs() < 1e-12);
    // A plate, not as thick as wide: its volume, and its shadow between that of its edge and of its face.
    let plate = &catalogue[0];
    assert!(
        (plate[4] / plate[14] / 2700.0 - 1.0).abs() < 0.1,
        "{plate:?}"
    );
    assert!(plate[16] < plate[18] * plate[19] && plate[16] > plate[19] * plate[20]);
    let surfaces = fs::read(out.join("catalogue.vtk")).unwrap();
    assert!(surfaces.starts_with(b"# vtk DataFile Version 3.0\n"));
    assert!(out.join("catalogue.png").exists());
}

#[test]
fn answers_are_documents_in_si_units() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    end(&mut coarse_run(1, &folder)).with_code(0);
    let run = folder.to_str().unwrap();
    let case = quarter_impact();

    let checked = document(&["check", &case, "--set", "spacing=0.05mm"]);
    assert_eq!(checked["particles"], 3056);
    let sphere = &checked["bodies"][1];
    assert_eq!(sphere["body"], "sphere");
    assert_eq!(sphere["spacing"][0], 5e-5);
    assert!(sphere["mass"].as_f64().unwrap() > 0.0);
    assert_eq!(checked["units"]["mass"], "kg");

    let planned = document(&["plan", &case, "--set", "spacing=0.05mm", "--ranks", "1,4"]);
    let rows = planned["rows"].as_array().unwrap();
    assert!(rows.len() > 2 && rows[0]["ranks"] == 1, "{planned:#}");
    assert_eq!(planned["units"]["step_time"], "s");
    assert!(planned["files"]["disk_bytes"].as_f64().unwrap() > 0.0);

    let told = document(&["info", run]);
    assert_eq!(told["status"], "finished");
    assert_eq!(told["summary"]["particles"], 3056);
    assert_eq!(told["last"]["bodies"]["rows"][0]["body"], "plate");
    assert_eq!(told["snapshots"][0]["times_s"].as_array().unwrap().len(), 3);
    let snapshots = fs::read_dir(folder.join("snapshots")).unwrap();
    let snapshots = snapshots.map(|entry| entry.unwrap().path());
    let mut snapshots: Vec<_> = snapshots
        .filter(|path| path.extension().is_some_and(|ending| ending == "vtkhdf"))
        .collect();
    snapshots.sort();
    let told = document(&["info", snapshots[0].to_str().unwrap()]);
    assert_eq!(told["bodies"][1]["body"], "sphere");
    let fields = told["fields"].as_array().unwrap();
    let velocity = fields
        .iter()
        .find(|field| field["field"] == "velocity z")
        .unwrap();
    assert_eq!(velocity["unit"], "m/s");
    assert_eq!(velocity["min"], -7000.0);

    let measured = document(&["measure", run]);
    let row = &measured["rows"][0];
    assert!(
        row["measure"].is_string() && row["figure"].is_string(),
        "{row}"
    );
    assert_eq!(measured["units"]["time"], "s");

    fragments_and_debris(run);

    let same = document(&["compare", run, run]);
    assert_eq!(same["agrees"], true);
    let copper = document(&["materials", "copper"]);
    assert_eq!(copper["name"], "copper");
    let shield = "limit nno --bumper 1.2mm --wall 3.2mm --gap 100mm --yield 40ksi --speeds";
    let shield: Vec<&str> = shield.split(' ').chain(["5 km/s"]).collect();
    let limit = document(&shield);
    assert_eq!(limit["rows"][0]["speed"], 5000.0);
    assert_eq!(limit["units"]["critical_diameter"], "m");

    let at = |name: &str| place.path().join(name).display().to_string();
    let picture = at("energies.svg");
    let drawn = document(&["plot", run, "--history", "--out", &picture]);
    assert_eq!(drawn["written"], serde_json::json!([picture]));
    let (made, page) = (at("made"), at("page.html"));
    let made = document(&["new", &made, "--from", "quarter"]);
    assert!(made["written"][0].as_str().unwrap().ends_with("case.toml"));
    let told = document(&["report", run, "--out", &page]);
    assert_eq!(
        (&told["runs"][0], &told["written"][0]),
        (&run.into(), &page.as_str().into())
    );
    let exported = document(&["export", run, "--to", "xyz", "--out", &at("last.xyz")]);
    assert_eq!(exported["written"][0], at("last.xyz"));
    let exported = document(&[
        "export",
        run,
        "--to",
        "lammps",
        "--out",
        &at("last.lammpstrj"),
    ]);
    assert_eq!(exported["types"][1], "sphere");
    let (sweep, vary) = (at("sweep"), ["--vary", "body.sphere.velocity=6, 7 km/s"]);
    let coarse = ["--set", "spacing=0.06mm", "--set", "run.end_time=0.02us"];
    let swept = [&["sweep", &case, "--out", &sweep], &vary[..], &coarse].concat();
    let swept = document(&[swept, vec!["--answers", "history.kinetic_energy"]].concat());
    assert_eq!(swept["points"]["finished"], 2);
    assert!(
        swept["rows"][1]["history.kinetic_energy"].as_f64().unwrap() > 0.0,
        "{swept:#}"
    );

    // What is wrong is told as ever.
    let ended = end(command(WHIPPLE).args(["info", "nowhere", "--json"])).with_code(2);
    assert!(
        ended.stdout.is_empty() && ended.stderr.starts_with("error: "),
        "{ended:#?}"
    );
}

/// Each line of a log is an object with the same keys.
#[track_caller]
fn events(ended: &Ended) -> Vec<Value> {
    let parse =
        |line: &str| serde_json::from_str::<Value>(line).unwrap_or_else(|e| panic!("{e}: {line}"));
    let events: Vec<Value> = ended.stdout.lines().map(parse).collect();
    for event in &events {
        let keys: Vec<&String> = event.as_object().unwrap().keys().collect();
        assert_eq!(keys, ["fields", "level", "message", "time"], "{event}");
        assert!(event["fields"].is_object() && event["time"].as_str().unwrap().ends_with('Z'));
    }
    events
}

#[test]
fn a_run_is_quiet_or_speaks_json() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    let run = |name: &str, more: &[&str]| {
        let mut command = ranks(2);
        command
            .args(["run", &quarter_impact()])
            .args(COARSE)
            .args(more);
        end(command.arg("--out").arg(at(name)))
    };
    let quiet = run("quiet", &["--quiet"]).with_code(0);
    assert_eq!((&quiet.stdout[..], &quiet.stderr[..]), ("", ""));

    let told = run("json", &["--log", "json", "--until", "0.1us"]).with_code(0);
    assert_eq!(told.stderr, "");
    let said = events(&told);
    let has = |part: &str| {
        said.iter()
            .any(|event| event["message"].as_str().unwrap().contains(part))
    };
    for part in [
        "3056 particles, 2 ranks",
        "set up in",
        "checkpoint ",
        "output took",
        "stopped",
    ] {
        assert!(has(part), "{part}: {told:#?}");
    }
    assert!(
        said.iter().all(|event| event["level"] == "info"),
        "{told:#?}"
    );
    // What the log has is told, each line once.
    let log = fs::read_to_string(at("json").join("log.txt")).unwrap();
    assert_eq!(log.lines().count(), said.len(), "{log}\n{told:#?}");
    let mut restart = ranks(1);
    restart
        .arg("restart")
        .arg(at("json"))
        .args(["--log", "json", "-q"]);
    let silent = end(&mut restart).with_code(0);
    assert_eq!((&silent.stdout[..], &silent.stderr[..]), ("", ""));

    let wrong = run("wrong", &["--log", "json", "--set", "spacing=2"]).with_code(2);
    let said = events(&wrong);
    assert_eq!(said.len(), 1);
    assert_eq!(said[0]["level"], "error");
    assert!(
        said[0]["message"]
            .as_str()
            .unwrap()
            .starts_with("expected a length")
    );
}
