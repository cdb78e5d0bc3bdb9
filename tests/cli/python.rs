//! The Python environment that `make test` makes. `WHIPPLE_SKIP_CLIENTS=1` leaves out what needs it.

use std::path::PathBuf;

/// The environment's Python, or nothing if what needs it is to be skipped.
pub fn python() -> Option<PathBuf> {
    if std::env::var("WHIPPLE_SKIP_CLIENTS").is_ok_and(|value| value == "1") {
        eprintln!("skipped: WHIPPLE_SKIP_CLIENTS=1");
        return None;
    }
    let python = crate::project::root().join("target/venv/bin/python");
    assert!(
        python.exists(),
        "{} is missing: `make test` makes it (or set WHIPPLE_SKIP_CLIENTS=1)",
        python.display()
    );
    Some(python)
}
