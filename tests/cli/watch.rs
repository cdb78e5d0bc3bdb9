//! A run as it is watched: from its status alone, while it goes on and as it ends.

use std::fs;
use std::path::Path;

use crate::program::{COARSE, Ended, WHIPPLE, command, end, json, quarter_impact, ranks, start};

fn watch(run: &Path, more: &[&str]) -> Ended {
    end(command(WHIPPLE).arg("watch").arg(run).args(more))
}

#[test]
fn a_finished_run_is_told_with_its_energies_and_ranks() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let mut finished = ranks(3);
    finished.args(["run", &quarter_impact()]).args(COARSE);
    end(finished.arg("--out").arg(&run)).with_code(0);
    let status = json(&run.join("status.json"));
    assert_eq!(status["exit_code"], 0);
    let outlook = &status["outlook"];
    assert_eq!(outlook["ranks"], 3);
    assert_eq!(outlook["particles"], 3056);
    let list = |list: &serde_json::Value| list.as_array().unwrap().len();
    assert_eq!(list(&outlook["loads"]), 3);
    for name in ["time", "kinetic", "internal", "contact", "total"] {
        // Some 120 rows.
        let points = list(&outlook["energies"][name]);
        assert!((32..=64).contains(&points), "{name}: {points}");
    }
    // The last ones are those of the tables.
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    let kinetic: f64 = history
        .lines()
        .last()
        .unwrap()
        .split(',')
        .nth(4)
        .unwrap()
        .parse()
        .unwrap();
    let kept = outlook["energies"]["kinetic"]
        .as_array()
        .unwrap()
        .last()
        .unwrap();
    assert!((kept.as_f64().unwrap() / kinetic - 1.0).abs() < 1e-5);

    for more in [&[][..], &["--once"]] {
        let told = watch(&run, more).with_code(0).stdout;
        assert!(
            told.lines().next().unwrap().ends_with("run: finished"),
            "{told}"
        );
        let names: Vec<&str> = told
            .lines()
            .skip(1)
            .map(|l| l.split_once(' ').unwrap().0)
            .collect();
        let expected = [
            "done", "clock", "step", "kinetic", "internal", "contact", "total", "work",
        ];
        assert_eq!(names, expected, "{told}");
        assert!(told.contains(" 100 %, 0.2 us of 0.2 us"), "{told}");
        assert!(
            told.contains("3056 particles on 3 ranks x 1 thread"),
            "{told}"
        );
        assert!(told.lines().all(|line| line.chars().count() < 80), "{told}");
        assert!(!told.contains('\u{1b}'), "{told}");
    }
}

#[test]
fn a_run_is_watched_to_its_stop() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let mut command = ranks(2);
    command.args(["run", &quarter_impact(), "--set", "spacing=0.02mm"]);
    let running = start(command.arg("--out").arg(&run));
    running.until_step(&run, 3);
    let told = watch(&run, &["--once"]).with_code(0).stdout;
    assert!(told.contains("run: running"), "{told}");
    let mut watcher = self::command(WHIPPLE);
    let watcher = start(watcher.arg("watch").arg(&run).args(["--every", "1"]));
    // It tells of itself every other second, also where nothing is written.
    running.until("status", || {
        let outlook = &json(&run.join("status.json"))["outlook"];
        outlook["seconds_left"].as_f64()
    });
    fs::write(run.join("stop"), "").unwrap();
    running.end().with_code(75);
    let watched = watcher.end().with_code(75);
    assert!(
        watched.stdout.contains("run: stopped (the file"),
        "{watched:#?}"
    );

    // A restart goes on with the energies of its past.
    let before = json(&run.join("status.json"));
    let step = before["step"].as_u64().unwrap() + 1;
    let more = format!("run.max_steps={step}");
    end(ranks(1).arg("restart").arg(&run).args(["--set", &more])).with_code(0);
    let after = json(&run.join("status.json"));
    let points = |status: &serde_json::Value| status["outlook"]["energies"]["time"].clone();
    assert_eq!(points(&after)[0], 0.0);
    assert!(points(&after).as_array().unwrap().len() >= points(&before).as_array().unwrap().len());
}

#[test]
fn what_is_no_run_or_none_any_more_is_said() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let missing = watch(&run, &[]).with_code(2);
    assert!(
        missing.stderr.contains("error: cannot read"),
        "{missing:#?}"
    );
    fs::create_dir(&run).unwrap();
    let write = |text: &str| fs::write(run.join("status.json"), text).unwrap();
    for damaged in ["", "{", "[]", r#"{"state": "lost", "step": 1, "time": 0}"#] {
        write(damaged);
        let told = watch(&run, &["--once"]).with_code(2);
        assert!(told.stderr.contains("status.json"), "{told:#?}");
    }
    // As programs wrote it that told no more.
    write(r#"{"state": "failed", "step": 7, "time": 1e-6, "reason": "too fast"}"#);
    let told = watch(&run, &[]).with_code(1);
    assert!(told.stdout.contains("run: failed (too fast)"), "{told:#?}");
    assert!(told.stdout.contains("step 7, 1 us"), "{told:#?}");
    // Nobody holds the folder of a run that is to be running.
    write(r#"{"state": "running", "step": 7, "time": 1e-6}"#);
    let told = watch(&run, &[]).with_code(1);
    assert!(told.stdout.contains("killed or lost"), "{told:#?}");
}
