//! The memory that `check` foretells against what a rank takes, where a case has all options.

use std::process::Stdio;

use crate::program::{WHIPPLE, command, end};

/// A block of 36,000 particles on a plate, with every option that holds arrays of its own, beside a
/// rigid plane and a rigid ball.
const CASE: &str = r#"
title = "A block slides on a plate"
dimension = 3
spacing = "1 mm"
gravity = ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]

[run]
end_time = "1 ms"
max_steps = 5

[sph]
form = "normalised"
artificial_stress = 0.3
balsara = true
conduction = 1.0
xsph = 0.5

[contact]
friction = 0.3
damping = 0.1

[material.metal]
library = "aluminium-2024"

[[body]]
name = "plate"
material = "metal"
shape.box = { lower = [0, 0, 0], upper = ["60 mm", "40 mm", "10 mm"] }

[[body]]
name = "block"
material = "metal"
shape.box = { lower = ["5 mm", "5 mm", "10 mm"], upper = ["35 mm", "35 mm", "23 mm"] }
velocity = ["10 m/s", "0 m/s", "0 m/s"]

[[load]]
body = "plate"
below = { z = "1 mm" }
velocity = { z = "0 m/s" }

[[plane]]
normal = "+z"

[[surface]]
shape.sphere = { centre = ["20 mm", "20 mm", "28 mm"], radius = "5 mm" }
"#;

/// Largest resident memory (bytes) of a command that must end well.
#[allow(clippy::zombie_processes, reason = "wait4 waits for it")]
#[allow(clippy::cast_precision_loss, reason = "far below 2^53")]
fn peak(mut command: std::process::Command) -> f64 {
    let child = command.stdout(Stdio::null()).spawn().unwrap();
    let id = libc::pid_t::try_from(child.id()).unwrap();
    let (mut status, mut usage) = (0, unsafe { std::mem::zeroed::<libc::rusage>() });
    // SAFETY: both are written by the call, and nobody else waits for the child.
    let ended = unsafe { libc::wait4(id, &raw mut status, 0, &raw mut usage) };
    assert_eq!((ended, status), (id, 0));
    1024.0 * usage.ru_maxrss as f64
}

/// Megabytes in the report of `check`.
fn foretold(case: &str, options: &[&str]) -> f64 {
    let mut check = command(WHIPPLE);
    check.args(["check", case]).args(options);
    let ended = end(&mut check).with_code(0);
    let text = ended.stdout.split("about ").nth(1).unwrap();
    text.split(' ').next().unwrap().parse().unwrap()
}

#[test]
#[ignore = "slow"]
fn what_options_take_is_foretold() {
    let place = tempfile::tempdir().unwrap();
    let case = place.path().join("case.toml");
    std::fs::write(&case, CASE).unwrap();
    let case = case.to_str().unwrap();
    let plain: &[&str] = &[
        "--set",
        "sph.form=conventional",
        "--set",
        "sph.artificial_stress=0",
        "--set",
        "sph.balsara=false",
        "--set",
        "sph.conduction=0",
        "--set",
        "sph.xsph=0",
        "--set",
        "contact.friction=0",
        "--set",
        "contact.damping=0",
    ];
    let sets: [(&str, &[&str]); 2] = [("plain", plain), ("options", &[])];
    for (name, options) in sets {
        let folder = place.path().join(name);
        let mut run = command(WHIPPLE);
        run.args(["run", case, "-t", "1", "--out"])
            .arg(&folder)
            .args(options);
        let mut restart = command(WHIPPLE);
        restart.args(["restart", "-t", "1", "--set", "run.max_steps=10"]);
        restart.arg(&folder);
        let foretold = foretold(case, options);
        for (what, command) in [("run", run), ("restart", restart)] {
            let taken = peak(command) * 1e-6;
            eprintln!("{name}, {what}: {foretold} MB foretold, {taken:.1} MB taken");
            assert!(
                (foretold / taken - 1.0).abs() < 0.15,
                "{name}, {what}: {foretold} of {taken} MB"
            );
        }
    }
}
