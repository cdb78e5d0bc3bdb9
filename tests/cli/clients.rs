//! Snapshots opened by the programs that our users have: h5py, VTK's own reader, `PyVista`, and
//! Debian's older VTK where it is installed; and the recipes of the book.
//!
//! `make test` makes the Python environment. `WHIPPLE_SKIP_CLIENTS=1` leaves these tests out.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::program::WHIPPLE;
use crate::python::python;

use comm::Comm;
use files::output::Rows;
use files::output::snapshot::{self, SnapshotFormat};
use particles::ParticleStore;

fn root() -> &'static Path {
    crate::project::root()
}

/// Runs a script of `tests/clients/` and returns what it printed.
fn script(python: &Path, name: &str, arguments: &[&Path]) -> Result<String, String> {
    script_in(Path::new("."), python, name, arguments)
}

/// The same in a folder.
fn script_in(
    folder: &Path,
    python: &Path,
    name: &str,
    arguments: &[&Path],
) -> Result<String, String> {
    let Output {
        status,
        stdout,
        stderr,
    } = Command::new(python)
        .arg(root().join("tests/clients").join(name))
        .args(arguments)
        .env("PYTHONPATH", root().join("python/src"))
        .current_dir(folder)
        .output()
        .expect("python starts");
    if status.success() {
        Ok(String::from_utf8_lossy(&stdout).into_owned())
    } else {
        Err(String::from_utf8_lossy(&stderr).into_owned())
    }
}

/// The system's Python if its VTK can open snapshots by itself (Debian's python3-vtk9).
fn python_with_older_vtk() -> Option<&'static Path> {
    let python = Path::new("/usr/bin/python3");
    let works = Command::new(python)
        .args(["-c", "import numpy, vtkmodules.vtkIOHDF"])
        .output()
        .is_ok_and(|output| output.status.success());
    works.then_some(python)
}

/// Fails unless every client sees the same points, ids, fields, cells and time in `snapshot`;
/// returns the line that says who did.
fn opens_everywhere(python: &Path, snapshot: &Path) -> String {
    let dump = snapshot.with_extension("npz");
    let mut arguments = vec![snapshot];
    if let Some(older) = python_with_older_vtk() {
        script(older, "dump.py", &[snapshot, &dump])
            .unwrap_or_else(|error| panic!("{} in the older VTK:\n{error}", snapshot.display()));
        arguments.push(&dump);
    }
    script(python, "check.py", &arguments)
        .unwrap_or_else(|error| panic!("{}:\n{error}", snapshot.display()))
}

/// Runs a case of `inputs/` on some ranks into a folder.
fn simulate(ranks: &str, case: &str, options: &[&str], out: &Path) {
    let program = WHIPPLE;
    let output = Command::new("timeout")
        .args(["120", "mpirun", "-n", ranks, program, "run"])
        .arg(root().join("inputs").join(case))
        .args(options)
        .args(["--threads", "1", "--out"])
        .arg(out)
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_hwloc_base_binding_policy", "none")
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
        .env("PRTE_MCA_hwloc_default_binding_policy", "none")
        .env("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe")
        .env("OMPI_MCA_mpi_yield_when_idle", "1")
        .output()
        .expect("mpirun starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}\n{errors}", output.status);
}

#[test]
fn every_client_opens_the_form_that_we_document() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let snapshot = folder.path().join("sample.vtkhdf");
    script(&python, "sample.py", &[&snapshot]).expect("the sample is written");

    let seen = opens_everywhere(&python, &snapshot);

    assert!(
        seen.starts_with("27 points, 5 fields, t = 1.25e-08 s"),
        "{seen}"
    );
    eprintln!("{seen}");
}

#[test]
#[ignore = "slow"]
fn every_client_opens_partitions_and_two_processes_share_them() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let sample = folder.path().join("sample.vtkhdf");
    let points = ["27", "10"].map(Path::new);
    script(&python, "sample.py", &[&sample, points[0], points[1]]).expect("the sample is written");
    eprintln!("{}", opens_everywhere(&python, &sample));

    for (total, partition_rows) in [(100, 7), (100, 50), (100, 99), (1, 1), (12, 4)] {
        let snapshot = folder.path().join("ours.vtkhdf");
        write_ours(&snapshot, total, partition_rows);
        eprintln!("{}", opens_everywhere(&python, &snapshot));
    }
}

/// Writes a snapshot of so many particles in partitions of so many rows.
fn write_ours(path: &Path, total: u32, partition_rows: u64) {
    let case = crate::stored::case();
    let mut particles = ParticleStore::default();
    particles.resize_owned(total as usize);
    for k in 0..total {
        // In no order of ids, with gaps.
        let (row, id) = (k as usize, (k * 37 + 5) % 101);
        particles.id[row] = id.into();
        particles.position[row] = [id.into(), -1.5 * f64::from(id), 0.1];
        particles.density[row] = 1000.0 + f64::from(k);
    }
    let quantities = snapshot::quantities(&[]).expect("the usual ones");
    let form = SnapshotFormat {
        partition_rows,
        ..SnapshotFormat::of(&quantities)
    };
    let (comm, meta) = (Comm::solo(), crate::stored::meta(&case));
    let mut rows = Rows::default();
    snapshot::write(&comm, path, &particles, &meta, &form, &mut rows).expect("it is written");
}

#[test]
fn every_client_opens_the_snapshots_of_a_run_on_two_ranks() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = folder.path().join("run");
    simulate("2", "elastic-impact", &["--until", "0.06us"], &run);

    let mut snapshots: Vec<PathBuf> = std::fs::read_dir(run.join("snapshots"))
        .expect("the run has snapshots")
        .map(|entry| entry.expect("an entry of snapshots/").path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "vtkhdf")
        })
        .collect();
    snapshots.sort();

    assert!(snapshots.len() >= 2, "{snapshots:?}");
    for snapshot in snapshots {
        eprintln!("{}", opens_everywhere(&python, &snapshot));
    }
}

#[test]
#[ignore = "slow"]
fn the_recipes_of_the_book_draw_something() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = folder.path().join("runs/quarter-impact");
    let sets = ["--set", "spacing=0.05 mm", "--set", "fragments={}"];
    let options = [&sets[..], &["--until", "0.04us"]].concat();
    simulate("1", "quarter-impact", &options, &run);
    // Pages that begin with a case of one's own call it otherwise.
    let other = folder.path().join("runs/impact");
    std::os::unix::fs::symlink("quarter-impact", other).expect("a second name");

    let exported = Command::new(WHIPPLE)
        .arg("export")
        .arg(&run)
        .args(["--to", "npz"])
        .status();
    assert!(exported.expect("the program starts").success());

    let book = root().join("docs/src");
    let drawn = script_in(folder.path(), &python, "recipes.py", &[&book])
        .unwrap_or_else(|error| panic!("{error}"));

    eprintln!("{drawn}");
    assert!(
        drawn.contains("guide/first-run.md") && drawn.contains("% drawn"),
        "{drawn}"
    );
}

#[test]
fn an_empty_window_is_noticed() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let page = "```python\nimport pyvista\nplotter = pyvista.Plotter()\nplotter.show()\n```\n";
    std::fs::write(folder.path().join("page.md"), page).expect("a page is written");

    let error = script(&python, "recipes.py", &[folder.path()]).unwrap_err();

    assert!(error.contains("page.md:2: an empty window"), "{error}");
}

#[test]
fn the_check_notices_a_snapshot_that_is_cut_off() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let snapshot = folder.path().join("sample.vtkhdf");
    script(&python, "sample.py", &[&snapshot]).expect("the sample is written");
    let whole = std::fs::read(&snapshot).expect("the sample is read");
    std::fs::write(&snapshot, &whole[..whole.len() / 2]).expect("half of it is written");

    assert!(script(&python, "check.py", &[&snapshot]).is_err());
}
