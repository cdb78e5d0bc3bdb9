//! The Python package in `python/`: its own tests, the examples in its docstrings and its two scripts read
//! runs of this program, in the environment that `make test` makes.
//!
//! `WHIPPLE_SKIP_CLIENTS=1` leaves them out.

use std::process::Command;

use crate::program::WHIPPLE;
use crate::python::python;

#[test]
fn the_python_package_reads_our_runs() {
    let Some(python) = python() else { return };
    let root = crate::project::root();
    let output = Command::new(python)
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
        .current_dir(root.join("python"))
        .env("WHIPPLE_PROGRAM", WHIPPLE)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .expect("python starts");
    let told = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}\n{errors}");
    eprintln!("{told}");
}
