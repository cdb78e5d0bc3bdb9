//! Cases to begin with, and what editors, shells and man know of the program.

use std::fs;
use std::process::Command;

use crate::program::{Ended, WHIPPLE, command, end};
use crate::python::python;
use tempfile::tempdir;

fn whipple(arguments: &[&str]) -> Ended {
    end(command(WHIPPLE).args(arguments))
}

const KINDS: [&str; 13] = [
    "shield",
    "stuffed",
    "honeycomb",
    "tile",
    "crater",
    "plate",
    "oblique",
    "penetration",
    "spall",
    "taylor",
    "rings",
    "drop",
    "quarter",
];

#[test]
fn every_kind_makes_a_sound_case() {
    let folder = tempdir().unwrap();
    for kind in KINDS {
        let case = folder.path().join(kind);
        let made = whipple(&["new", case.to_str().unwrap(), "--from", kind]);
        made.with_code(0);
        let checked = whipple(&["check", case.to_str().unwrap()]).with_code(0);
        // Coarse enough to be paid for: `check` warns.
        let is_coarse = ["stuffed", "honeycomb"].contains(&kind);
        let word = if is_coarse { "can run" } else { "sound" };
        assert!(checked.stdout.contains(word), "{kind}");
    }
}

#[test]
fn nothing_is_overwritten() {
    let folder = tempdir().unwrap();
    let case = folder.path().join("mine");
    fs::create_dir(&case).unwrap();
    fs::write(case.join("case.toml"), "mine").unwrap();
    let made = whipple(&["new", case.to_str().unwrap(), "--from", "taylor"]).with_code(2);
    assert!(made.stderr.contains("is there already"), "{made:?}");
    assert_eq!(fs::read_to_string(case.join("case.toml")).unwrap(), "mine");
    assert_eq!(fs::read_dir(&case).unwrap().count(), 1);
}

#[test]
fn completions_and_pages_know_all_commands() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let text = whipple(&["generate", "completions", shell])
            .with_code(0)
            .stdout;
        assert!(
            text.contains("fragments") && text.contains("whipple"),
            "{shell}"
        );
    }
    // Keys of cases, of which a restart changes few.
    let bash = whipple(&["generate", "completions", "bash"])
        .with_code(0)
        .stdout;
    let keys = |line: &&str| line.contains("run.end_time=");
    let lists: Vec<&str> = bash.lines().filter(keys).collect();
    assert!(lists.len() > 4, "{lists:?}");
    let all = |key: &str| lists.iter().all(|line| line.contains(key));
    let some = |key: &str| lists.iter().any(|line| line.contains(key));
    assert!(all(" output.history_every=") && !all(" body.0.velocity="));
    assert!(some(" body.0.velocity=") && some(" sph.alpha="));
    let folder = tempdir().unwrap();
    let pages = folder.path().join("man1");
    whipple(&["generate", "man", pages.to_str().unwrap()]).with_code(0);
    for page in ["whipple", "whipple-run", "whipple-limit-nno", "whipple-new"] {
        let text = fs::read_to_string(pages.join(format!("{page}.1"))).unwrap();
        assert!(text.contains(".SH NAME"), "{page}");
    }
    assert!(!pages.join("whipple-bench.1").exists());
}

/// The schema takes all cases of the program and of its tests, and refuses what the program does.
#[test]
fn the_schema_knows_cases() {
    let Some(python) = python() else { return };
    let root = crate::project::root();
    let folder = tempdir().unwrap();
    let schema = folder.path().join("schema.json");
    fs::write(
        &schema,
        whipple(&["generate", "schema"]).with_code(0).stdout,
    )
    .unwrap();
    let output = Command::new(python)
        .arg(root.join("tests/clients/schema.py"))
        .args([&schema, root])
        .output()
        .expect("python starts");
    let (told, errors) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success(), "{told}\n{errors}");
    eprintln!("{told}");
}
