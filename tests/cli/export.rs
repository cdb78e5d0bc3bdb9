//! `whipple export`: what other programs read of its files is what the snapshots hold.
//!
//! `make test` makes the Python environment with these programs. `WHIPPLE_SKIP_CLIENTS=1` leaves them out.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::program::{Ended, WHIPPLE, coarse_run, command, end, project};
use crate::python::python;
use tempfile::{TempDir, tempdir};

/// A quarter impact after its bodies have met, of which the first snapshot is there, too.
fn impact() -> (TempDir, PathBuf) {
    let place = tempdir().unwrap();
    let run = place.path().join("run");
    let more = [
        "--set",
        "run.max_steps=20",
        "--set",
        "output.snapshot_every=0.02us",
    ];
    end(coarse_run(1, &run).args(more)).with_code(0);
    (place, run)
}

fn export(source: &Path, arguments: &[&str]) -> Ended {
    end(command(WHIPPLE).arg("export").arg(source).args(arguments))
}

/// The names that a folder holds.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Runs a part of `tests/clients/export.py` and tells what it said.
fn check(part: &str, paths: [&Path; 2]) {
    let Some(python) = python() else { return };
    let output = Command::new(python)
        .arg(project("tests/clients/export.py"))
        .arg(part)
        .args(paths)
        .env("PYTHONPATH", project("python/src"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .expect("python starts");
    let said = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}\n{errors}");
    eprintln!("{said}");
}

#[test]
fn every_format_holds_what_the_snapshots_do() {
    let (_place, run) = impact();
    for format in ["lammps", "xyz", "vtu"] {
        export(&run, &["--to", format, "--all"]).with_code(0);
    }
    for format in ["csv", "npz", "ply"] {
        export(&run, &["--to", format]).with_code(0);
    }
    check("formats", [&run, &run.join("export")]);
}

/// As bodies of another case, by their number and places.
#[test]
fn exported_particles_are_read_again() {
    let (place, run) = impact();
    let told = |particles: &str| {
        let text = format!(
            "dimension = 3\nrun.end_time = \"1 us\"\nmaterial.metal.library = \"copper\"\n\
             [[body]]\nname = \"it\"\nmaterial = \"metal\"\nparticles = {{ {particles} }}\n"
        );
        let path = place.path().join("again.toml");
        fs::write(&path, text).unwrap();
        let told = end(command(WHIPPLE).arg("check").arg(&path))
            .with_code(0)
            .stdout;
        let lines = told.lines().filter(|line| !line.contains(" from "));
        lines.skip(1).take(2).collect::<Vec<_>>().join("\n")
    };
    let expected = told("file = \"run\", part = \"sphere\"");
    assert!(expected.contains("particles of metal"), "{expected}");
    assert!(expected.contains("spans"), "{expected}");
    for (format, ending, keys) in [
        ("lammps", "lammpstrj", "part = 2"),
        ("xyz", "xyz", "part = \"sphere\""),
        ("csv", "csv", "part = \"sphere\""),
    ] {
        let file = format!("last.{ending}");
        let out = place.path().join(&file);
        export(&run, &["--to", format, "--out", out.to_str().unwrap()]).with_code(0);
        assert_eq!(
            told(&format!("file = \"{file}\", {keys}")),
            expected,
            "{format}"
        );
    }
}

#[test]
fn images_have_their_signs_and_fields_are_made_as_plots_make_them() {
    let (place, run) = impact();
    let out = place.path().join("mirrored.npz");
    let fields =
        "pressure,velocity,velocity.z,deviatoric_stress,stress,von_mises,displacement,radius";
    let out_text = out.to_str().unwrap();
    let arguments = [
        "--to", "npz", "--mirror", "--fields", fields, "--out", out_text,
    ];
    let ended = export(&run, &arguments).with_code(0);
    assert_eq!(ended.stdout, format!("wrote {out_text}\n"));
    check("mirror", [&run, &out]);

    // Readers of dumps want each id once.
    let out = place.path().join("mirrored.lammpstrj");
    let arguments = ["--to", "lammps", "--mirror", "--out", out.to_str().unwrap()];
    export(&run, &arguments).with_code(0);
    let text = fs::read_to_string(&out).unwrap();
    let rows = text
        .lines()
        .skip_while(|line| !line.starts_with("ITEM: ATOMS"));
    let ids = rows.skip(1).filter_map(|row| row.split(' ').next());
    assert_eq!(ids.collect::<BTreeSet<_>>().len(), 4 * 3056);
}

#[test]
fn surfaces_are_closed_and_stand_where_pictures_draw_them() {
    let (_place, run) = impact();
    let ended = export(&run, &["--to", "stl", "--mirror"]).with_code(0);
    assert_eq!(ended.stdout.lines().count(), 2, "{ended:?}");
    check("surfaces", [&run, &run.join("export")]);
}

#[test]
#[ignore = "slow"]
fn the_script_for_paraview_finds_and_mirrors_the_run() {
    let (place, run) = impact();
    let ended = export(&run, &["--to", "paraview"]).with_code(0);
    let script = run.join("open_in_paraview.py");
    assert_eq!(ended.stdout, format!("wrote {}\n", script.display()));
    check("paraview", [&run, &script]);
    // A script elsewhere knows where the run was, one in it goes along with it.
    let moved = place.path().join("moved");
    fs::rename(&run, &moved).unwrap();
    check("paraview", [&moved, &moved.join("open_in_paraview.py")]);
    let elsewhere = place.path().join("macros/");
    let out = elsewhere.to_str().unwrap();
    export(&moved, &["--to", "paraview", "--out", out]).with_code(0);
    check("paraview", [&moved, &elsewhere.join("open_in_paraview.py")]);
}

#[test]
fn snapshots_fields_and_bodies_are_chosen() {
    let (place, run) = impact();
    let out = place.path().join("out/");
    let out_text = out.to_str().unwrap();
    let arguments = ["--to", "lammps", "--index", "0,1", "--bodies", "sphere"];
    let ended = export(
        &run,
        &[
            &arguments[..],
            &["--fields", "stress.xx", "--out", out_text],
        ]
        .concat(),
    );
    let said = ended.with_code(0).stdout;
    let path = out.join("snapshots.lammpstrj");
    let expected = format!(
        "wrote {}\ntype 1 is plate\ntype 2 is sphere\n",
        path.display()
    );
    assert_eq!(said, expected);
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(
        text.matches("ITEM: ATOMS id type x y z radius stress_xx\n")
            .count(),
        2
    );
    assert_eq!(text.matches("ITEM: NUMBER OF ATOMS\n228\n").count(), 2);

    let arguments = [
        "--to", "csv", "--time", "0us,1s", "--out", out_text, "--fields", "id",
    ];
    export(&run, &arguments).with_code(0);
    let tables: Vec<_> = names(&out)
        .into_iter()
        .filter(|name| {
            Path::new(name)
                .extension()
                .is_some_and(|ending| ending == "csv")
        })
        .collect();
    assert_eq!(tables.len(), 2, "{tables:?}");
    assert_eq!(tables[0], "step-00000000.csv");
    let text = fs::read_to_string(out.join(&tables[0])).unwrap();
    assert!(
        text.starts_with("# units: m,m,m,-,-\nx,y,z,id,body\n# time: 0.0 s\n"),
        "{text:.99}"
    );
    assert_eq!(text.lines().count(), 3 + 3056);
}

#[test]
fn what_cannot_be_exported_leaves_nothing_behind() {
    let (place, run) = impact();
    let out = place.path().join("out");
    fs::create_dir(&out).unwrap();
    let last = run.join("snapshots/step-00000020.vtkhdf");
    let folder = out.to_str().unwrap();
    let name = out.join("x.npz");
    let name = name.to_str().unwrap();
    let copy = place.path().join("alone.vtkhdf");
    fs::copy(&last, &copy).unwrap();
    for (source, arguments, told) in [
        (
            &run,
            &["--to", "npz", "--fields", "presure"][..],
            "did you mean \"pressure\"",
        ),
        (
            &run,
            &["--to", "npz", "--fields", "rank"],
            "no field \"rank\"",
        ),
        (
            &run,
            &["--to", "csv", "--bodies", "plat"],
            "no body \"plat\"",
        ),
        (&run, &["--to", "csv", "--index", "99"], "no snapshot 99"),
        (&last, &["--to", "csv", "--all"], "give its folder"),
        (&run, &["--to", "stl", "--fields", "mass"], "no --fields"),
        (&run, &["--to", "stl", "--cell", "1e-12m"], "--cell"),
        (&run, &["--to", "vtu", "--cell", "1mm"], "--to stl"),
        (&run, &["--to", "paraview", "--mirror"], "no other options"),
        (
            &copy,
            &["--to", "csv", "--fields", "displacement"],
            "step-00000000.vtkhdf",
        ),
    ] {
        let all = [arguments, &["--out", folder]].concat();
        let ended = export(source, &all).with_code(2);
        assert_eq!(ended.complaints("error: ").len(), 1, "{ended:#?}");
        assert!(ended.stderr.contains(told), "{ended:#?}");
        assert!(names(&out).is_empty(), "{:?}", names(&out));
    }
    let ended = export(&run, &["--to", "npz", "--all", "--out", name]).with_code(2);
    assert!(ended.stderr.contains("cannot have one name"), "{ended:#?}");
    let ended = export(&run, &["--to", "csv", "--out", name]).with_code(2);
    assert!(ended.stderr.contains("ends in .csv"), "{ended:#?}");
    assert!(names(&out).is_empty());
}
