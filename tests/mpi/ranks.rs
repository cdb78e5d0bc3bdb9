//! Tests that run themselves again on several ranks under a real `mpirun`.

use std::path::Path;
use std::process::{Command, Output};

use comm::{Comm, Session, abort_job};

const FOLDER: &str = "WHIPPLE_TEST_FOLDER";

/// Runs `task(comm, folder)` of the test called `test`, with its module, on so many ranks, all in one
/// folder, and gives what they print.
pub fn on_ranks(test: &str, ranks: usize, folder: &Path, task: impl Fn(&Comm, &Path)) -> String {
    if let Some(folder) = std::env::var_os(FOLDER) {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            before(info);
            abort_job(101);
        }));
        let (_session, comm) = Session::start().expect("MPI starts");
        task(&comm, Path::new(&folder));
        drop(comm);
        return String::new();
    }
    let output = launch(test, ranks, folder);
    assert!(
        output.status.success(),
        "{test} on {ranks} ranks: {}\n{}{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        said.contains("1 passed"),
        "no test is called {test}: {said}"
    );
    said
}

/// Runs the test called `test`, with its module, on so many ranks, all in one folder; its ranks may end the job.
pub fn launch(test: &str, ranks: usize, folder: &Path) -> Output {
    Command::new("timeout")
        .args(["120", "mpirun", "-n", &ranks.to_string()])
        .arg(std::env::current_exe().unwrap())
        .args(["--exact", test, "--include-ignored"])
        .args(["--nocapture", "--test-threads=1"])
        .env(FOLDER, folder)
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_hwloc_base_binding_policy", "none")
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
        .env("OMPI_MCA_mpi_yield_when_idle", "1")
        .env("OMPI_MCA_orte_execute_quiet", "1")
        .output()
        .expect("mpirun starts")
}

/// Runs `task` of the test called `test` on each of these numbers of ranks in turn.
pub fn on_each(test: &str, ranks: &[usize], task: impl Fn(&Comm)) {
    // A rank does the task once.
    let ranks = if is_rank() { &[0] } else { ranks };
    for &ranks in ranks {
        on_ranks(test, ranks, Path::new(""), |comm, _| task(comm));
    }
}

/// True if this process is a rank that [`on_ranks`] started.
pub fn is_rank() -> bool {
    std::env::var_os(FOLDER).is_some()
}
