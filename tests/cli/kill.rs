//! A run that is killed at any of its calls of the system leaves a whole state with its tables:
//! what goes on from there ends in the bits of an untouched run.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crate::program::{WHIPPLE, assert_same, command, end};
use crate::system_calls::{Call, trace};

/// Two bodies of a few particles that meet; 16 steps, a row after each, a checkpoint after each
/// four.
const CASE: &str = r#"
title = "Kill points"
dimension = 2
spacing = "0.25 mm"
run.end_time = "0.3 us"
material.metal.library = "copper"

[output]
snapshot_every = "0.1 us"
checkpoint_every_steps = 4
checkpoints_kept = 1
history_every = 1

[[body]]
name = "a"
material = "metal"
shape.box.size = ["1 mm", "1 mm"]
velocity = [0, "500 m/s"]

[[body]]
name = "b"
material = "metal"
shape.box = { lower = ["-0.5 mm", "0.5 mm"], upper = ["0.5 mm", "1 mm"] }
"#;

/// Time for the samples of `make test`, all scenarios together.
const SHORT: Duration = Duration::from_secs(4);

struct Place {
    folder: tempfile::TempDir,
    case: PathBuf,
}

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let case = folder.path().join("case.toml");
        fs::write(&case, CASE).unwrap();
        Self { folder, case }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, run: &Path, more: &[&str]) -> Command {
        let mut command = command(WHIPPLE);
        command.args(["run", "-t", "1"]).arg(&self.case);
        command.arg("--out").arg(run).args(more);
        command
    }
}

fn restart(from: &Path) -> Command {
    let mut command = command(WHIPPLE);
    command.args(["restart", "-t", "1"]).arg(from);
    command
}

fn copy(from: &Path, to: &Path) {
    let copied = Command::new("cp").arg("-r").arg(from).arg(to).status();
    assert!(copied.unwrap().success());
}

/// The time of a step and a bit less, so that `--until` stops there.
fn until(run: &Path, step: usize) -> String {
    let text = fs::read_to_string(run.join("history.csv")).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let times: Vec<f64> = rows
        .map(|row| row.split(',').nth(1).unwrap().parse().unwrap())
        .collect();
    format!("{:e}s", 0.5 * (times[step - 1] + times[step]))
}

fn snapshots(run: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(run.join("snapshots")).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name());
    names
        .map(|name| name.to_string_lossy().into_owned())
        .collect()
}

/// True if a call gives a checkpoint its name.
fn publishes(call: &Call) -> bool {
    let of_step = |path: &PathBuf| {
        path.parent()
            .is_some_and(|folder| folder.ends_with("checkpoints"))
            && path.extension().is_none()
    };
    call.name == "rename" && call.to.as_ref().is_some_and(of_step)
}

/// Rows of tables are on the disk before the checkpoint after which nobody writes them again; so is
/// the index of snapshots.
fn assert_synced(calls: &[Call]) {
    let mut written = BTreeSet::new();
    let mut published = 0;
    for call in calls {
        let name = call.path.file_name().unwrap_or_default().to_string_lossy();
        let table = name.contains(".csv") || name.contains(".series");
        match call.name {
            "write" if table => drop(written.insert(call.path.clone())),
            "sync" => drop(written.remove(&call.path)),
            _ => {}
        }
        if publishes(call) {
            published += 1;
            assert!(
                written.is_empty(),
                "not synced before {call:?}: {written:?}"
            );
        }
    }
    assert!(published > 0);
}

/// The points to try: all of them, or as many as there is time for, first those that change names.
fn points(calls: &[Call], all: bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..calls.len()).collect();
    if !all {
        let rank = |&n: &usize| {
            let names = matches!(calls[n].name, "rename" | "remove" | "mkdir");
            // Far apart, whatever the number: Knuth's multiplicative hash.
            (!names, n.wrapping_mul(2_654_435_761) & 0xffff_ffff)
        };
        order.sort_by_key(rank);
    }
    order
}

/// Kills a command at its calls, and lets `recover` go on from each, on all cores; says how many
/// points were tried.
fn kill_at_each(
    name: &str,
    time: Option<Duration>,
    prepare: impl Fn(&Path) + Sync,
    work: impl Fn(&Path) -> Command + Sync,
    place: &Place,
    recover: impl Fn(&Path, &[Call], &str) + Sync,
) {
    let whole = place.path(&format!("{name}-whole"));
    prepare(&whole);
    let traced = match trace(&mut work(&whole), &whole, None) {
        Ok(traced) => traced,
        Err(error) => return eprintln!("skipped: nobody may trace a process here ({error})"),
    };
    assert_eq!(traced.code, Some(0), "{name}");
    assert_synced(&traced.calls);
    let try_point = |n: usize| {
        let run = place.path(&format!("{name}-{n}"));
        prepare(&run);
        let killed = trace(&mut work(&run), &run, Some(n)).unwrap();
        // Lines of the log come by the clock, so that there may be one less.
        if let (None, [made @ .., last]) = (killed.code, &killed.calls[..]) {
            recover(&run, made, &format!("{name} {n}, {last:?}"));
        } else {
            assert_eq!(killed.code, Some(0), "{name} {n}");
        }
        fs::remove_dir_all(&run).unwrap();
    };
    let order = points(&traced.calls, time.is_none());
    let (started, next, tried) = (Instant::now(), AtomicUsize::new(0), AtomicUsize::new(0));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while time.is_none_or(|time| started.elapsed() < time)
                    && let Some(&n) = order.get(next.fetch_add(1, Ordering::Relaxed))
                {
                    try_point(n);
                    tried.fetch_add(1, Ordering::Relaxed);
                }
            });
        }
    });
    eprintln!("{name}: {tried:?} of {} kill points", order.len());
}

/// All that is below a folder.
fn below(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        all.push(entry.path());
        all.extend(below(&entry.path()));
    }
    all
}

fn kill_points(time: Option<Duration>) {
    let place = Place::new();
    let time = time.map(|time| time / 4);
    let reference = place.path("reference");
    end(&mut place.run(&reference, &[])).with_code(0);
    let goes_on = |run: &Path, point: &str| {
        let ended = end(&mut restart(run));
        assert_eq!(ended.code, Some(0), "{point}: {ended:#?}");
        assert_same(run, &reference);
        assert_eq!(snapshots(run), snapshots(&reference), "{point}");
        let aside = run.join("set-aside");
        assert!(
            !run.join("lock").exists() && !aside.exists(),
            "{point}: {:?}",
            below(&aside)
        );
    };
    let begins_anew = |run: &Path, point: &str| {
        let ended = end(&mut restart(run)).with_code(2);
        let expected = ["has no", "is neither a run", "cannot restart"];
        assert!(
            expected.iter().any(|text| ended.stderr.contains(text)),
            "{point}: {ended:#?}"
        );
        let mut again = place.run(run, &["--force"]);
        assert_eq!(end(&mut again).code, Some(0), "{point}");
        assert_same(run, &reference);
    };

    // A run that writes a checkpoint twice after one step: when it is due, and as it stops.
    let step_8 = until(&reference, 8);
    let nothing = |_: &Path| {};
    let stops = |run: &Path| place.run(run, &["--until", &step_8]);
    kill_at_each("run", time, nothing, stops, &place, |run, made, point| {
        if made.iter().any(publishes) {
            goes_on(run, point);
        } else {
            begins_anew(run, point);
        }
    });

    // A restart after a kill: rows and snapshots later than the checkpoint, and a damaged one.
    let killed = place.path("killed");
    let keep = ["--set", "output.checkpoints_kept=2"];
    let step_11 = until(&reference, 11);
    let more = [&keep[..], &["--until", &step_11]].concat();
    end(&mut place.run(&killed, &more)).with_code(0);
    fs::write(killed.join("checkpoints/step-00000011/state.h5"), "").unwrap();
    let prepare = |run: &Path| copy(&killed, run);
    kill_at_each(
        "restart",
        time,
        prepare,
        restart,
        &place,
        |run, _, point| {
            goes_on(run, point);
        },
    );

    // A restart from an older checkpoint than there are.
    let keep = ["--set", "output.checkpoints_kept=9"];
    let longer = place.path("longer");
    end(&mut place.run(&longer, &keep)).with_code(0);
    let named = |run: &Path| restart(&run.join("checkpoints/step-00000008"));
    let prepare = |run: &Path| copy(&longer, run);
    kill_at_each("older", time, prepare, named, &place, |run, _, point| {
        let ended = end(&mut restart(run));
        assert_eq!(ended.code, Some(0), "{point}: {ended:#?}");
        assert_same(run, &longer);
        assert_eq!(snapshots(run), snapshots(&longer), "{point}");
    });

    // A run that replaces another.
    let prepare = |run: &Path| copy(&reference, run);
    let force = |run: &Path| place.run(run, &["--force"]);
    kill_at_each("force", time, prepare, force, &place, |run, _, point| {
        if end(&mut restart(run)).code != Some(0) {
            begins_anew(run, point);
        }
        assert_same(run, &reference);
    });
}

#[test]
#[ignore = "slow"]
fn a_kill_at_some_calls_of_the_system_loses_nothing() {
    kill_points(Some(SHORT));
}

#[test]
#[ignore = "some minutes; part of make validation"]
fn a_kill_at_any_call_of_the_system_loses_nothing_validation() {
    kill_points(None);
}
