//! Runs that begin with what another run had computed: the bits of their own whole runs.

use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use crate::program::{WHIPPLE, command, end, ranks};

/// A ball passes a plate and meets a wall after more than half of the time.
const CASE: &str = r#"
title = "two plates"
dimension = 3
spacing = "0.2 mm"
[run]
end_time = "3 us"
[material.ball]
library = "aluminium-2024-ductile"
[material.front]
library = "aluminium-6061-ductile"
[material.wall]
library = "aluminium-2024-ductile"
[[body]]
name = "front"
material = "front"
shape.box = { lower = ["-1.4 mm", "-1.4 mm", "-0.4 mm"], upper = ["1.4 mm", "1.4 mm", 0] }
[[body]]
name = "wall"
material = "wall"
shape.box = { lower = ["-1.4 mm", "-1.4 mm", "-5.6 mm"], upper = ["1.4 mm", "1.4 mm", "-5 mm"] }
[[body]]
name = "ball"
material = "ball"
shape.sphere = { centre = [0, 0, "0.8 mm"], radius = "0.6 mm" }
velocity = [0, 0, "-3 km/s"]
[output]
snapshot_every = "0.5 us"
"#;

const LIMIT: &str = "material.wall.failure.spall.pressure";

fn case(place: &Path) -> String {
    let path = place.join("plates.toml");
    std::fs::write(&path, CASE).unwrap();
    path.display().to_string()
}

fn run(place: &Path, out: &str, set: &[&str]) {
    let mut run = command(WHIPPLE);
    run.args(["run", &case(place), "-q", "--threads", "1", "--out"]);
    run.arg(place.join(out));
    end(with(&mut run, set)).with_code(0);
}

fn with<'a>(command: &'a mut Command, set: &[&str]) -> &'a mut Command {
    set.iter()
        .fold(command, |command, set| command.args(["--set", set]))
}

fn assert_same(a: &Path, b: &Path) {
    let mut compare = command(WHIPPLE);
    let ended = end(compare.arg("compare").arg(a).arg(b)).with_code(0);
    assert!(ended.stdout.contains("agree to the last bit"), "{ended:#?}");
}

/// A fork on two ranks has the bits of the whole run with its constants on one, tables from the start included; what is felt at
/// once is refused, and what is felt before the first checkpoint begins anew.
#[test]
fn a_fork_is_its_own_whole_run() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    let often = [
        "output.checkpoint_every=0.2us",
        "output.checkpoints_kept=100",
    ];
    run(place.path(), "soft", &often);
    let strong = format!("{LIMIT}=-1.7 GPa");
    let changed = [
        &strong[..],
        "material.wall.failure.johnson_cook.d1=0.2",
        "material.wall.failure.scatter=20",
        "output.checkpoints_kept=2",
    ];
    let fork = |out: &str, set: &[&str]| {
        let mut fork = ranks(2);
        fork.arg("fork").arg(at("soft")).arg("--out").arg(at(out));
        end(with(&mut fork, set))
    };
    // Scatter that is not there is another law.
    assert!(
        fork("none", &changed)
            .with_code(2)
            .stderr
            .contains("scatter")
    );
    let changed = [changed[0], changed[1], changed[3]];
    let ended = fork("strong", &changed).with_code(0);
    assert!(ended.stdout.contains("goes on from step"), "{ended:#?}");
    let forked: serde_json::Value =
        serde_json::from_slice(&std::fs::read(at("strong/forked.json")).unwrap()).unwrap();
    assert!(forked["time"].as_f64().unwrap() > 1e-6, "{forked}");
    run(place.path(), "whole", &[&often[..1], &changed].concat());
    assert_same(&at("strong"), &at("whole"));
    assert!(!at("soft/forked.json").exists());

    // Another end cuts another step, and rows come at the same ones.
    let ends = |end: &str, out: &str| {
        let end_time = format!("run.end_time={end}");
        let set = ["output.history_every=10", often[0], often[1], &end_time];
        run(place.path(), out, &[&set[..], &[&strong]].concat());
    };
    ends("1us", "short");
    ends("1.3us", "long");
    let mut again = ranks(1);
    again
        .arg("fork")
        .arg(at("short"))
        .arg("--out")
        .arg(at("longer"));
    end(again.args(["--set", "run.end_time=1.3us"])).with_code(0);
    assert_same(&at("longer"), &at("long"));

    // A fork of a fork has the constants of both, and a run is not its own fork.
    let mut again = ranks(1);
    again
        .arg("fork")
        .arg(at("strong"))
        .arg("--out")
        .arg(at("again"));
    end(again.args(["--set", "material.wall.failure.seed=2"])).with_code(0);
    let text = std::fs::read_to_string(at("again/case.toml")).unwrap();
    assert!(
        text.contains("-1.7 GPa") && text.contains("d1 = 0.2"),
        "{text}"
    );
    let mut same = ranks(1);
    same.arg("fork")
        .arg(at("soft"))
        .args(["--force", "--set", &strong, "--out"]);
    let ended = end(same.arg(at("soft"))).with_code(2);
    assert!(ended.stderr.contains("a folder of its own"), "{ended:#?}");
    assert!(at("soft/checkpoints").is_dir());

    for felt in [
        format!("{LIMIT}=-1 GPa"),
        "body.ball.velocity=2 km/s".to_owned(),
    ] {
        let ended = fork("none", &[&felt]).with_code(2);
        assert!(
            ended.stderr.contains("may matter from the start"),
            "{ended:#?}"
        );
        assert!(!at("none").exists());
    }
    let ended = fork(
        "anew",
        &[
            "material.front.failure.johnson_cook.d1=0",
            "run.end_time=0.1us",
        ],
    );
    assert!(ended.with_code(0).stdout.contains("begins anew"));
}

/// Points of a sweep that differ in constants of failure go on from one of them.
#[test]
fn a_sweep_of_constants_of_failure_shares_what_they_have_in_common() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("sweep");
    let mut sweep = command(WHIPPLE);
    sweep.args([
        "sweep",
        &case(place.path()),
        "--jobs",
        "2",
        "--threads",
        "1",
        "--out",
    ]);
    sweep.arg(&out).args(["--answers", "bodies.wall", "--vary"]);
    let ended = end(sweep.arg(format!("{LIMIT}=-1.8, -1.4 GPa"))).with_code(0);
    assert!(
        ended.stdout.contains("1 run went on from others: "),
        "{ended:#?}"
    );
    let folders = std::fs::read_dir(out.join("points")).unwrap();
    let strong = folders
        .map(|entry| entry.unwrap().path())
        .find(|path| path.join("forked.json").exists());
    let strong = strong.unwrap();
    assert!(strong.display().to_string().contains("1.8"));
    assert_eq!(
        std::fs::read_dir(strong.join("checkpoints"))
            .unwrap()
            .count(),
        2
    );
    run(place.path(), "whole", &[&format!("{LIMIT}=-1.8 GPa")]);
    let tables = ["history.csv", "bodies.csv", "measures.csv", "contacts.csv"];
    for table in tables {
        let [a, b] = [&strong, &place.path().join("whole")]
            .map(|run| std::fs::read(run.join(table)).unwrap());
        assert!(a == b, "{table}");
    }
}

/// A sweep whose runs are killed with it, wherever they are, goes on and has the same table.
#[test]
#[ignore = "slow"]
fn a_killed_sweep_of_forks_has_the_same_table() {
    let place = tempfile::tempdir().unwrap();
    let sweep = |out: &str| {
        let mut sweep = command(WHIPPLE);
        sweep.args([
            "sweep",
            &case(place.path()),
            "--jobs",
            "2",
            "--threads",
            "1",
        ]);
        sweep.args(["--answers", "bodies.wall,summary.steps", "--vary"]);
        sweep.arg(format!("{LIMIT}=-1.2, -1.5, -1.8 GPa"));
        sweep.args([
            "--vary",
            "material.wall.failure.johnson_cook.d1=0.1, 0.2",
            "--out",
        ]);
        sweep.arg(place.path().join(out));
        sweep
    };
    let table =
        |out: &str| std::fs::read_to_string(place.path().join(out).join("sweep.csv")).unwrap();
    end(&mut sweep("peace")).with_code(0);
    for tenths in [5, 9, 14, 18, 21, 7, 12, 25] {
        let mut group = sweep("killed").process_group(0).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(100 * tenths));
        // SAFETY: a signal to the group of a process that this test has started and not waited for.
        unsafe { libc::kill(-group.id().cast_signed(), libc::SIGKILL) };
        group.wait().unwrap();
    }
    let ended = end(&mut sweep("killed")).with_code(0);
    assert!(ended.stdout.contains("6 points finished"), "{ended:#?}");
    assert_eq!(table("killed"), table("peace"));
}
