//! The Python package in `python/`: its own tests, the examples in its docstrings and its two scripts read
//! runs of this program, in the environment that `make test` makes.
//!
//! `WHIPPLE_SKIP_CLIENTS=1` leaves them out.

mod python_support;

use std::path::Path;
use std::process::Command;

use python_support::python;

#[test]
fn the_python_package_reads_our_runs() {
    let Some(python) = python() else { return };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = Command::new(python)
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
        .current_dir(root.join("python"))
        .env("WHIPPLE_PROGRAM", env!("CARGO_BIN_EXE_whipple"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .expect("python starts");
    let told = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}\n{errors}");
    eprintln!("{told}");
}
