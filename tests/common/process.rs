//! Tests that need a process of their own, since what they count is counted for a whole process.

use std::process::Command;

const INSIDE: &str = "WHIPPLE_TEST_PROCESS";

/// Runs `task` of the test called `test`, with its module, in a process of its own, as cargo-nextest
/// would anyway.
pub fn in_its_own(test: &str, task: impl FnOnce()) {
    if std::env::var_os(INSIDE).is_some() {
        return task();
    }
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", test, "--include-ignored", "--nocapture"])
        .env(INSIDE, "1")
        .output()
        .expect("the test starts again");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let complained = String::from_utf8_lossy(&output.stderr);
    println!("{said}");
    assert!(output.status.success(), "{said}{complained}");
    assert!(
        said.contains("1 passed"),
        "no test is called {test}: {said}"
    );
}
