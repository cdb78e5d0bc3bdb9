//! A restart takes the newest whole checkpoint and says what it passed over, and any number of
//! ranks goes on from that of any other.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::program::{
    WHIPPLE, assert_same, coarse_run, command, end, json, project, ranks, status,
};

fn copy(from: &Path, to: &Path) {
    let copied = Command::new("cp").arg("-r").arg(from).arg(to).status();
    assert!(copied.unwrap().success());
}

fn checkpoints(run: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(run.join("checkpoints")).unwrap();
    let mut found: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    found.sort();
    found
}

#[test]
fn damaged_checkpoints_are_passed_over_with_the_reason() {
    let place = tempfile::tempdir().unwrap();
    let whole = place.path().join("whole");
    end(&mut coarse_run(2, &whole)).with_code(0);
    let all = checkpoints(&whole);
    assert!(all.len() >= 4, "{all:?}");
    let run = place.path().join("run");
    copy(&whole, &run);
    let broken: Vec<PathBuf> = checkpoints(&run);
    let [.., flipped, unlisted, truncated] = &broken[..] else {
        panic!()
    };
    let mut bytes = std::fs::read(flipped.join("state.h5")).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(flipped.join("state.h5"), &bytes).unwrap();
    std::fs::write(unlisted.join("manifest.json"), "{").unwrap();
    std::fs::write(truncated.join("state.h5"), &bytes[..bytes.len() - 7]).unwrap();

    let ended = end(ranks(3).arg("restart").arg(&run)).with_code(0);
    let told = ended.complaints("warning: passed over: ");
    assert_eq!(told.len(), 3, "{ended:#?}");
    for (line, why) in told
        .iter()
        .zip(["instead of", "manifest.json", "do not match"])
    {
        assert!(line.contains(why), "{line}");
    }
    assert_same(&run, &whole);
    // They are still there under another name, which `info` tells.
    let told = end(command(WHIPPLE).arg("info").arg(&run)).with_code(0);
    for path in [flipped, unlisted, truncated] {
        let name = format!("{}.damaged", path.display());
        assert!(Path::new(&name).join("state.h5").is_file(), "{name}");
        assert!(told.stdout.contains(&name), "{told:#?}");
    }

    // With none left it says why of each.
    for path in checkpoints(&run) {
        std::fs::write(path.join("state.h5"), "").unwrap();
    }
    let ended = end(ranks(2).arg("restart").arg(&run)).with_code(2);
    assert!(ended.stderr.contains("no whole checkpoint"), "{ended:#?}");
    assert!(ended.stderr.contains("it has 0 bytes"), "{ended:#?}");
}

#[test]
#[ignore = "slow"]
fn another_schedule_and_checkpoints_by_steps_and_by_the_clock_change_no_bit() {
    let place = tempfile::tempdir().unwrap();
    let reference = place.path().join("reference");
    end(&mut coarse_run(1, &reference)).with_code(0);
    let run = place.path().join("run");
    let mut first = coarse_run(3, &run);
    first.args([
        "--set",
        "output.checkpoint_every_steps=7",
        "--until",
        "0.0999us",
    ]);
    end(&mut first).with_code(0);
    let (_, step, _) = status(&run);
    let steps = checkpoints(&run);
    let name = format!("step-{:08}", step / 7 * 7);
    assert!(steps.iter().any(|path| path.ends_with(&name)), "{steps:?}");
    let mut again = ranks(2);
    again.arg("restart").arg(&run);
    again.args(["--set", "output.snapshot_every=0.05us"]);
    again.args(["--set", "output.checkpoint_every_wall=1 us"]);
    end(&mut again).with_code(0);
    // By the clock, as good as after each step.
    assert_eq!(checkpoints(&run).len(), 9);
    assert_same(&run, &reference);
}

/// A part read from a file goes on from its own file alone.
#[test]
fn another_part_in_the_place_of_a_file_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let (part, run) = (place.path().join("part.obj"), place.path().join("run"));
    let cube = std::fs::read_to_string(project("tests/common/cube.obj")).unwrap();
    std::fs::write(&part, &cube).unwrap();
    let case = place.path().join("case.toml");
    let text = "dimension = 3\nspacing = \"0.1 mm\"\nrun.end_time = \"0.2 us\"\n\
                material.metal.library = \"copper\"\n[[body]]\nname = \"part\"\nmaterial = \"metal\"\n\
                velocity = [0, 0, \"1 km/s\"]\n\
                shape.union = [{ obj = { file = \"part.obj\", unit = \"0.1 mm\" } }]\n\
                [[plane]]\nnormal = \"-z\"\npoint = [0, 0, \"0.4 mm\"]\n";
    std::fs::write(&case, text).unwrap();
    let mut begin = ranks(1);
    begin
        .arg("run")
        .arg(&case)
        .args(["--until", "0.1us", "--out"]);
    end(begin.arg(&run)).with_code(0);
    std::fs::write(&part, cube.replace("v 0 0 0", "v 0 0 0.1")).unwrap();
    let mut again = ranks(1);
    let refused = end(again.arg("restart").arg(&run)).with_code(2);
    let said = "part.obj is no longer the one that the case began with";
    assert!(refused.stderr.contains(said), "{refused:#?}");
    std::fs::write(&part, cube).unwrap();
    let mut again = ranks(1);
    end(again.arg("restart").arg(&run)).with_code(0);
}

/// Contact across slab faces and two symmetry planes, from one and four ranks to two others each.
#[test]
fn from_any_ranks_to_others() {
    restart_on(&[1, 4], |n| vec![n % 5 + 1, (n + 2) % 5 + 1]);
}

/// The same from every number of ranks to every number.
#[test]
#[ignore = "slow: half a minute of launches"]
fn from_any_ranks_to_any_ranks_validation() {
    restart_on(&[1, 2, 3, 4, 5], |_| (1..=5).collect());
}

fn restart_on(from: &[usize], others: impl Fn(usize) -> Vec<usize>) {
    let place = tempfile::tempdir().unwrap();
    let reference = place.path().join("reference");
    end(&mut coarse_run(1, &reference)).with_code(0);
    for &n in from {
        let stopped = place.path().join(format!("{n}"));
        end(coarse_run(n, &stopped).args(["--until", "0.06us"])).with_code(0);
        for m in others(n) {
            let run = place.path().join(format!("{n}-{m}"));
            copy(&stopped, &run);
            end(ranks(m).arg("restart").arg(&run)).with_code(0);
            assert_same(&run, &reference);
        }
    }
}

/// A column of a table as numbers.
fn column(table: &Path, name: &str) -> Vec<f64> {
    let text = std::fs::read_to_string(table).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = header.iter().position(|found| *found == name).unwrap();
    let value = |line: &str| line.split(',').nth(at).unwrap().parse().unwrap();
    lines.map(value).collect()
}

fn snapshots(run: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(run.join("snapshots")).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .filter(|name| name.starts_with("step-"))
        .collect();
    names.sort();
    names
}

#[test]
#[ignore = "slow"]
fn a_stop_in_the_step_before_a_snapshot_or_in_its_own_loses_none() {
    let place = tempfile::tempdir().unwrap();
    let reference = place.path().join("reference");
    end(&mut coarse_run(1, &reference)).with_code(0);
    let names = snapshots(&reference);
    let due: usize = names[1][5..13].parse().unwrap();
    let times = column(&reference.join("history.csv"), "time");
    for last in [due - 1, due] {
        let run = place.path().join(format!("{last}"));
        // The first step at or after the middle of the last one.
        let until = format!("{:e}s", 0.5 * (times[last - 1] + times[last]));
        end(coarse_run(3, &run).args(["--until", &until])).with_code(0);
        assert_eq!(status(&run).1, last as u64);
        // One that no schedule asked for shows where the run stopped.
        assert_eq!(snapshots(&run).len(), 2);
        assert!(snapshots(&run)[1].contains(&format!("{last:08}")));
        end(ranks(2).arg("restart").arg(&run)).with_code(0);
        assert_eq!(snapshots(&run), names);
        assert_same(&run, &reference);
    }
}

/// All that is hard at once: more than half of the particles fly along a row of cubes, past them
/// and into them, across faces of slabs that never move, so that the last slab runs empty; half of
/// each cube is behind a symmetry plane, a splinter crosses the plane, and particles leave their
/// range and are taken out.
const HARD: &str = r#"
title = "A flyer along a row of cubes"
dimension = 3
spacing = "0.1 mm"

[run]
end_time = "3 us"

# Steps that end before the splinter is at the plane.
[time_step]
courant = 0.5
force = 0.25
contact = 0.8

[domain]
axis = "x"
balance_every = 0

[trouble]
policy = "remove"
density_max = 1.16

[output]
snapshot_every = "0.5 us"
checkpoints_kept = 1
history_every = 5

[material.aluminium]
library = "aluminium-2024"

[[body]]
name = "flyer"
material = "aluminium"
shape.box = { size = ["0.6 mm", "0.6 mm", "1 mm"], centre = ["6 mm", "0 mm", "0.2 mm"] }
velocity = ["-4 km/s", "0 km/s", "0 km/s"]

[[body]]
name = "gate"
material = "aluminium"
shape.box = { size = ["0.5 mm", "0.6 mm", "0.5 mm"], centre = ["5.3 mm", "0 mm", "0 mm"] }

[[body]]
name = "post"
material = "aluminium"
shape.box = { size = ["0.5 mm", "0.6 mm", "0.5 mm"], centre = ["0 mm", "0 mm", "-0.55 mm"] }

[[body]]
name = "block"
material = "aluminium"
shape.box = { size = ["0.5 mm", "0.6 mm", "0.5 mm"], centre = ["-2 mm", "0 mm", "0.2 mm"] }

[[body]]
name = "wall"
material = "aluminium"
shape.box = { size = ["0.5 mm", "0.6 mm", "0.5 mm"], centre = ["-4 mm", "0 mm", "0.4 mm"] }

[[body]]
name = "splinter"
material = "aluminium"
lattice = "cubic"
shape.box = { lower = ["-3 mm", "0.2955 mm", "-2 mm"], upper = ["-2.9 mm", "0.3955 mm", "-1.9 mm"] }
velocity = ["0 km/s", "-1 km/s", "0 km/s"]

# Viscosity would stop it before the plane.
[[load]]
body = "splinter"
velocity = { y = "-1 km/s" }
until = "0.345 us"

[[symmetry]]
axis = "y"
"#;

#[test]
fn all_that_is_hard_from_some_ranks_to_others() {
    hard(&[(3, &[4])]);
}

#[test]
#[ignore = "a minute and a half; part of make validation"]
fn all_that_is_hard_from_any_ranks_to_any_ranks_validation() {
    let all = &[1, 2, 3, 4, 5];
    hard(&all.map(|n| (n, &all[..])));
}

/// Stops the hard case on some ranks, restarts each stop on some, and compares with one rank.
fn hard(matrix: &[(usize, &[usize])]) {
    let place = tempfile::tempdir().unwrap();
    let case = place.path().join("hard.toml");
    std::fs::write(&case, HARD).unwrap();
    let must = |mut command: Command, more: &[&str]| {
        end(command.args(["--poison", "-t", "1"]).args(more)).with_code(0);
    };
    let start = |number: usize, run: &Path, more: &[&str]| {
        let mut command = ranks(number);
        command.arg("run").arg(&case).arg("--out").arg(run);
        must(command, more);
    };
    let reference = place.path().join("reference");
    start(1, &reference, &[]);
    let summary = json(&reference.join("summary.json"));
    let counted = |run: &Path, name: &str| json(&run.join("summary.json"))[name].as_u64().unwrap();
    for &(n, others) in matrix {
        let stopped = place.path().join(format!("{n}"));
        start(n, &stopped, &["--until", "0.5us"]);
        let gone = [&stopped, &reference].map(|run| counted(run, "removed_particles"));
        assert!(0 < gone[0] && gone[0] < gone[1], "{gone:?}");
        assert!(counted(&stopped, "plane_crossings") > 0);
        let mut is_any_empty = false;
        for &m in others {
            let run = place.path().join(format!("{n}-{m}"));
            copy(&stopped, &run);
            let mut restart = ranks(m);
            restart.arg("restart").arg(&run);
            must(restart, &[]);
            assert_same(&run, &reference);
            let empty = column(&run.join("performance.csv"), "empty_ranks");
            let last = *empty.last().unwrap();
            is_any_empty |= last > 0.0;
            eprintln!("{n} to {m}: same bits, {last} ranks empty at the end");
        }
        assert!(is_any_empty, "from {n}");
    }
    for axis in ["x", "y", "z"] {
        let error = summary["momentum_error"][axis].as_f64().unwrap();
        assert!(error < 1e-12, "momentum {axis}: {error}");
    }
}
