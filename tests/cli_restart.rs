//! A restart takes the newest whole checkpoint and says what it passed over, and any number of ranks
//! goes on from that of any other.

mod cli_support;

use std::path::{Path, PathBuf};
use std::process::Command;

use cli_support::{assert_same, coarse_run, end, ranks, status};

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

    // With none left it says why of each.
    for path in checkpoints(&run) {
        std::fs::write(path.join("state.h5"), "").unwrap();
    }
    let ended = end(ranks(2).arg("restart").arg(&run)).with_code(2);
    assert!(ended.stderr.contains("no whole checkpoint"), "{ended:#?}");
    assert!(ended.stderr.contains("it has 0 bytes"), "{ended:#?}");
}

#[test]
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

/// Contact across slab faces and two symmetry planes, from every number of ranks to every other.
#[test]
fn from_any_ranks_to_any_ranks() {
    let place = tempfile::tempdir().unwrap();
    let reference = place.path().join("reference");
    end(&mut coarse_run(1, &reference)).with_code(0);
    for n in 1..=5 {
        let stopped = place.path().join(format!("{n}"));
        end(coarse_run(n, &stopped).args(["--until", "0.06us"])).with_code(0);
        for m in 1..=5 {
            let run = place.path().join(format!("{n}-{m}"));
            copy(&stopped, &run);
            end(ranks(m).arg("restart").arg(&run)).with_code(0);
            assert_same(&run, &reference);
        }
    }
}
