//! The folder of a run: who may write into it, what a restart takes from it, and that one that
//! cannot begin leaves it as it was.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::program::{
    Ended, Running, WHIPPLE, assert_same, coarse_run, command, end, quarter_impact, ranks, signal,
    start, status, strike,
};

fn info(run: &Path) -> String {
    end(command(WHIPPLE).arg("info").arg(run))
        .with_code(0)
        .stdout
}

fn restart(run: &Path, more: &[&str]) -> Ended {
    end(ranks(2).arg("restart").arg(run).args(more))
}

fn copy(from: &Path, to: &Path) {
    let copied = Command::new("cp").arg("-r").arg(from).arg(to).status();
    assert!(copied.unwrap().success());
}

/// All files of a folder with their content; of a link where it leads to.
fn content(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_symlink() {
            let to = fs::read_link(&path).unwrap().into_os_string();
            found.insert(path, to.into_encoded_bytes());
        } else if path.is_dir() {
            found.extend(content(&path));
        } else {
            let bytes = fs::read(&path).unwrap();
            found.insert(path, bytes);
        }
    }
    found
}

fn newest(run: &Path) -> PathBuf {
    let entries = fs::read_dir(run.join("checkpoints")).unwrap();
    entries.map(|entry| entry.unwrap().path()).max().unwrap()
}

/// A run of two ranks, stopped in its middle.
fn stopped(run: &Path) {
    end(coarse_run(2, run).args(["--until", "0.1us"])).with_code(0);
}

/// Fails unless a restart is refused with this in its message, and the folder is as it was.
#[track_caller]
fn assert_refused(run: &Path, more: &[&str], code: i32, told: &[&str]) {
    let before = content(run);
    let ended = restart(run, more).with_code(code);
    for text in told {
        assert!(
            ended.stderr.contains(text),
            "no {text:?} in {}",
            ended.stderr
        );
    }
    let after = content(run);
    let names = |content: &BTreeMap<PathBuf, _>| content.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&after), names(&before));
    let changed = before.iter().find(|(path, bytes)| after[*path] != **bytes);
    assert!(changed.is_none(), "{:?} has changed", changed.map(|c| c.0));
}

#[test]
fn what_cannot_be_read_now_or_is_of_another_version_ends_a_restart() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    stopped(&run);
    let manifest = newest(&run).join("manifest.json");
    let text = fs::read_to_string(&manifest).unwrap();
    let state = newest(&run).join("state.h5");
    let bytes = fs::read(&state).unwrap();

    // A link to itself is what nobody can read, root neither, and is not missing either.
    for (path, whole) in [(&manifest, text.as_bytes()), (&state, &bytes)] {
        fs::remove_file(path).unwrap();
        std::os::unix::fs::symlink(path, path).unwrap();
        assert_refused(
            &run,
            &[],
            2,
            &["cannot read", "symbolic links", "nothing is changed"],
        );
        fs::remove_file(path).unwrap();
        fs::write(path, whole).unwrap();
    }

    fs::write(&manifest, text.replace("\"format\": 3", "\"format\": 9")).unwrap();
    assert_refused(&run, &[], 2, &["has format 9"]);
    fs::write(
        &manifest,
        text.replace("\"ranks\": 2", "\"ranks\": \"two\""),
    )
    .unwrap();
    assert_refused(
        &run,
        &[],
        2,
        &["another version", "the program that wrote it"],
    );
    fs::write(&manifest, text).unwrap();

    // What goes wrong in the set-up leaves all as it was as well.
    let history = run.join("history.csv");
    let table = fs::read_to_string(&history).unwrap();
    fs::write(&history, table.replace("kinetic", "cynetic")).unwrap();
    assert_refused(&run, &[], 1, &["its columns are not those"]);
    fs::write(&history, table).unwrap();
    let fields = "output.fields=[\"nonsense\"]";
    assert_refused(&run, &["--set", fields], 2, &["unknown field `nonsense`"]);
    restart(&run, &[]).with_code(0);
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_folder_belongs_to_one_run_at_a_time() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let mut first = coarse_run(2, &run);
    strike(&mut first, "pause:0:30");
    let running = start(first.args(["--set", "output.checkpoint_every_steps=10"]));
    running.until_step(&run, 29);
    let holders = running.rank_ids();
    let others = [
        start(coarse_run(1, &run).arg("--force")),
        start(&mut coarse_run(1, &run)),
        start(ranks(1).arg("restart").arg(&run)),
    ];
    let told = info(&run);
    for other in others {
        let ended = other.end().with_code(2);
        assert!(ended.stderr.contains("is in use by"), "{ended:#?}");
        let names = |id: &u32| ended.stderr.contains(&format!("process {id} on "));
        assert!(holders.iter().any(names), "{ended:#?}");
    }
    assert!(told.contains("running (process "), "{told}");
    running.end().with_code(0);
    assert!(!run.join("lock").exists());
    let reference = place.path().join("reference");
    end(coarse_run(1, &reference).args(["--set", "output.checkpoint_every_steps=10"])).with_code(0);
    assert_same(&run, &reference);
}

/// A run that is held up in its middle, with checkpoints at steps 10, 20 and 30.
fn paused(run: &Path) -> Running {
    let mut command = coarse_run(2, run);
    strike(&mut command, "pause:0:31");
    let running = start(command.args(["--set", "output.checkpoint_every_steps=10"]));
    running.until_step(run, 30);
    // That step's row stands before its other files do: who takes the folder away while ranks open one together is told of
    // that file.
    std::thread::sleep(std::time::Duration::from_millis(500));
    running
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_run_whose_folder_is_removed_or_moved_makes_nothing_anew() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("removed");
    let running = paused(&run);
    // What the step before still writes may come between.
    while fs::remove_dir_all(&run).is_err() {
        assert!(run.exists());
    }
    let ended = running.end().with_code(1);
    assert!(
        ended
            .stderr
            .contains("it was removed; nothing more is written, and no checkpoint of it is left"),
        "{ended:#?}"
    );
    assert!(!run.exists());

    let [run, there] = ["moved", "there"].map(|name| place.path().join(name));
    let running = paused(&run);
    fs::rename(&run, &there).unwrap();
    let ended = running.end().with_code(1);
    for text in [
        format!("it was moved to {}", there.display()),
        format!("{}/checkpoints/step-00000030", there.display()),
    ] {
        assert!(ended.stderr.contains(&text), "{ended:#?}");
    }
    assert!(!run.exists() && !there.join("lock").exists());
    assert_eq!(status(&there).0, "failed");
    // It goes on there as if nothing had been.
    restart(&there, &[]).with_code(0);
    let reference = place.path().join("reference");
    end(coarse_run(1, &reference).args(["--set", "output.checkpoint_every_steps=10"])).with_code(0);
    assert_same(&there, &reference);
}

#[test]
#[ignore = "slow"]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_second_run_in_a_folder_whose_lock_was_removed_stops_the_first() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let more = ["--force", "--set", "run.end_time=0.1us"];
    for all in [true, false] {
        let first = paused(&run);
        if all {
            fs::remove_dir_all(&run).unwrap();
        } else {
            fs::remove_file(run.join("lock")).unwrap();
        }
        let second = start(coarse_run(1, &run).args(more));
        let ended = first.end().with_code(1);
        let told = ["has taken it", "was removed; nothing more"];
        assert!(
            told.iter().any(|told| ended.stderr.contains(told)),
            "{ended:#?}"
        );
        second.end().with_code(0);
        let reference = place.path().join(format!("reference-{all}"));
        end(coarse_run(1, &reference).args(more)).with_code(0);
        assert_same(&run, &reference);
        fs::remove_dir_all(&run).unwrap();
    }
}

#[test]
fn results_that_a_restart_stands_on_and_that_are_lost_are_told() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    stopped(&run);
    let whole = place.path().join("whole");
    copy(&run, &whole);
    let history = fs::read_to_string(run.join("history.csv")).unwrap();
    let lines: Vec<&str> = history.lines().collect();
    let middle = lines.len() / 2;
    let cut = [&lines[..middle], &lines[middle + 1..], &[""]].concat();
    fs::write(run.join("history.csv"), cut.join("\n")).unwrap();
    fs::remove_file(run.join("contacts.csv")).unwrap();
    fs::remove_file(run.join("snapshots/step-00000000.vtkhdf")).unwrap();
    let rows = lines.iter().filter(|line| !line.starts_with('#')).count() - 1;
    let told = [
        &format!("history.csv has other rows than the {rows} that it had")[..],
        "contacts.csv with ",
        "snapshots/step-00000000.vtkhdf is missing",
    ];
    assert_refused(&run, &["--strict"], 2, &told);
    let ended = restart(&run, &[]).with_code(0);
    assert!(
        told.iter().all(|text| ended.stderr.contains(text)),
        "{ended:#?}"
    );
    let ended = restart(&whole, &["--strict"]).with_code(0);
    assert_eq!(ended.stderr, "");
}

#[test]
fn results_of_another_run_in_a_folder_are_refused_by_name() {
    let place = tempfile::tempdir().unwrap();
    let [run, other] = ["run", "other"].map(|name| place.path().join(name));
    stopped(&run);
    stopped(&other);
    let [ours, theirs] = [&run, &other].map(|run| newest(run));
    fs::remove_dir_all(&ours).unwrap();
    copy(&theirs, &ours);
    assert_refused(
        &run,
        &[],
        2,
        &["is of the run ", "two runs have written there"],
    );

    let first = "snapshots/step-00000000.vtkhdf";
    fs::copy(other.join(first), run.join(first)).unwrap();
    let picture = place.path().join("picture.png");
    let mut plot = command(WHIPPLE);
    let ended = end(plot
        .arg("plot")
        .arg(run.join(first))
        .arg("--out")
        .arg(&picture));
    assert_ne!(ended.code, Some(0));
    assert!(
        ended.stderr.contains("step-00000000.vtkhdf is of the run "),
        "{ended:#?}"
    );
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "needs debug assertions")]
fn a_killed_run_is_told_from_one_that_runs() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("run");
    let mut alone = command(WHIPPLE);
    alone
        .args(["run", &quarter_impact()])
        .args(crate::program::COARSE);
    alone.args(["--set", "output.checkpoint_every_steps=10"]);
    strike(alone.arg("--out").arg(&run), "pause:0:30");
    let running = start(&mut alone);
    running.until_step(&run, 29);
    signal("KILL", running.id());
    running.end();
    assert_eq!(status(&run).0, "running");
    let told = info(&run);
    assert!(
        told.contains("was running; killed or lost (no process holds the folder)"),
        "{told}"
    );
    let ended = restart(&run, &[]).with_code(0);
    let stale = "warning: the run before (process ";
    assert_eq!(ended.complaints(stale).len(), 1, "{ended:#?}");
    assert!(!run.join("lock").exists() && !run.join("set-aside").exists());

    // One of another host may run or not; the user must say.
    let holder = r#"{"host": "elsewhere", "process": 1, "started": 0}"#;
    fs::write(run.join("lock"), holder).unwrap();
    let more = ["--set", "run.end_time=0.3us"];
    assert_refused(&run, &more, 2, &["process 1 on elsewhere", "--ignore-lock"]);
    restart(&run, &[&more[..], &["--ignore-lock"]].concat()).with_code(0);
}

#[test]
fn an_edited_case_is_refused_or_taken() {
    let place = tempfile::tempdir().unwrap();
    let whole = place.path().join("whole");
    stopped(&whole);
    let case = fs::read_to_string(whole.join("case.toml")).unwrap();
    let edited = |name: &str, text: &str| {
        let run = place.path().join(name);
        copy(&whole, &run);
        fs::write(run.join("case.toml"), text).unwrap();
        run
    };
    let longer = case.replace("history_every = 1", "history_every = 2");
    assert_ne!(longer, case);
    let run = edited("output", &longer);
    let told = ["output.history_every: 2 (saved: 1)", "--accept-case"];
    assert_refused(&run, &[], 2, &told);
    let ended = restart(&run, &["--accept-case"]).with_code(0);
    assert_eq!(ended.complaints("warning: ").len(), 1, "{ended:#?}");
    let rows = |run: &Path| {
        fs::read_to_string(run.join("history.csv"))
            .unwrap()
            .lines()
            .count()
    };
    let taken = fs::read_to_string(run.join("case.toml")).unwrap();
    assert!(taken.contains("history_every = 2"), "{taken}");

    // The same by --set is no difference, as when a chain repeats its options.
    let run = edited("set", &longer);
    restart(&run, &["--set", "output.history_every=2"]).with_code(0);

    let run = edited(
        "velocity",
        &case.replace("spacing = \"0.05mm\"", "spacing = \"0.06mm\""),
    );
    for more in [&[][..], &["--accept-case"]] {
        let told = [
            "spacing: \"0.06mm\" (saved: \"0.05mm\")",
            "run the case anew",
        ];
        assert_refused(&run, more, 2, &told);
    }
    let run = edited("broken", &format!("{case}\n[run"));
    assert_refused(&run, &[], 2, &["case.toml"]);

    // Comments and formatting are none, and stay.
    let text = format!(
        "# mine\n{}",
        case.replace("history_every = 1", "history_every=1")
    );
    let run = edited("comment", &text);
    restart(&run, &[]).with_code(0);
    assert_eq!(fs::read_to_string(run.join("case.toml")).unwrap(), text);
    let reference = place.path().join("reference");
    end(&mut coarse_run(1, &reference)).with_code(0);
    assert_same(&run, &reference);
    assert!(rows(&run) > rows(&whole));
}

#[test]
fn a_folder_may_have_a_long_path() {
    let place = tempfile::tempdir().unwrap();
    let run = place.path().join("a".repeat(180)).join("b".repeat(180));
    end(&mut coarse_run(2, &run)).with_code(0);
    end(command(WHIPPLE).arg("info").arg(&run)).with_code(0);
}
