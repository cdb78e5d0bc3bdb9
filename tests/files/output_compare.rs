//! `compare` finds every bit that differs and nothing else; `info` tells what is there.

use std::fs;
use std::path::{Path, PathBuf};

use crate::stored::{case, meta, particles};
use app::compare::{Report, compare};
use app::info::describe;
use comm::Comm;
use files::output::{
    Column, ResultExtents, Rows, RunFolder, Table, Value, checkpoint, series, snapshot, write_json,
};
use particles::{ParticleStore, SCRATCH_WORDS};

/// A run folder of 30 particles with all that a run writes, after `change` of the particles.
fn run(place: &Path, name: &str, change: impl Fn(&mut ParticleStore)) -> PathBuf {
    let (comm, case, mut rows) = (Comm::solo(), case(), Rows::default());
    let mut folder = RunFolder::at(&place.join(name));
    folder.create(&comm, &case.resolved, true).unwrap();
    let mut particles = particles(&comm, 30);
    for k in 0..30 {
        particles.body[k] = u32::try_from(k % 2).unwrap();
    }
    change(&mut particles);
    let path = folder.snapshot(12);
    let fields = snapshot::quantities(&[]).unwrap();
    snapshot::write(
        &comm,
        &path,
        &particles,
        &meta(&case),
        &snapshot::SnapshotFormat::of(&fields),
        &mut rows,
    )
    .unwrap();
    series::add(&folder.series(), &RunFolder::snapshot_name(12), 3.5e-8).unwrap();
    let meta = checkpoint::Meta {
        run: None,
        step: 12,
        time: 3.5e-8,
        state: r#"{"dt":1e-10}"#,
        input: &case.resolved,
        results: &ResultExtents::default(),
    };
    checkpoint::write(
        &comm,
        &folder.checkpoints(),
        &particles,
        &meta,
        1,
        &mut rows,
    )
    .unwrap();
    let columns = [Column::new("step", ""), Column::new("energy", "J")];
    let mut table = Table::create(&folder.history(), &columns, 1).unwrap();
    for step in 0..4 {
        table.row(&[Value::Count(step), Value::Real(0.1)]).unwrap();
    }
    write_json(
        &folder.summary(),
        &serde_json::json!({"ranks": 2, "energy_error_max": 1.5e-6}),
    )
    .unwrap();
    folder.path().to_owned()
}

fn text(report: &Report) -> String {
    report.lines.join("\n")
}

#[test]
fn equal_runs_agree_and_what_only_one_has_is_told() {
    let place = tempfile::tempdir().unwrap();
    let a = run(place.path(), "a", |_| ());
    let b = run(place.path(), "b", |_| ());
    // What depends on ranks, clocks and outputs.
    fs::write(b.join("performance.csv"), "step\n1\n").unwrap();
    fs::write(b.join("ranks.csv"), "step\n1\n").unwrap();
    fs::write(b.join("log.txt"), "x").unwrap();
    fs::write(b.join("summary.json"), "{}").unwrap();
    let resolved = fs::read_to_string(b.join("case.toml")).unwrap();
    fs::write(b.join("case.toml"), resolved.replace("1 us", "2 us")).unwrap();
    let folder = RunFolder::at(&b);
    fs::copy(folder.snapshot(12), folder.snapshot(13)).unwrap();
    let report = compare(&a, &b).unwrap();
    assert!(report.agrees(), "{}", text(&report));
    assert_eq!(report.compared, 4);
    assert!(text(&report).contains("step-00000013.vtkhdf: only B has it"));
    // And positions, and which are frozen, since this store holds every field.
    let fields = snapshot::quantities(&[]).unwrap().len() + 2;
    let told = format!("step-00000012.vtkhdf: 30 particles agree in {fields} fields");
    assert!(text(&report).contains(&told), "{}", text(&report));
}

#[test]
fn one_bit_is_found_with_its_particle_and_component() {
    let place = tempfile::tempdir().unwrap();
    let a = run(place.path(), "a", |particles| {
        particles.velocity[7] = [1.0, 0.0, 2.0];
    });
    let b = run(place.path(), "b", |particles| {
        particles.velocity[7] = [1.0, -0.0, 2.5];
    });
    let id = particles(&Comm::solo(), 30).id[7];
    let report = compare(&a, &b).unwrap();
    assert_eq!(report.different, 2, "the snapshot and the checkpoint");
    let told = text(&report);
    assert!(
        told.contains(&format!(
            "first difference: id {id} velocity y: 0.0 against -0.0"
        )),
        "{told}"
    );
    let largest = format!("largest difference 5e-1 m/s at id {id} velocity z");
    assert!(
        told.contains(&format!("velocity: 1 particles differ; first id {id}")),
        "{told}"
    );
    assert!(told.contains(&largest), "{told}");

    let files = [&a, &b].map(|run| RunFolder::at(run).snapshot(12));
    assert_eq!(compare(&files[0], &files[1]).unwrap().different, 1);
    assert!(compare(&files[0], &files[0]).unwrap().agrees());
    let error = compare(&a, &files[1]).unwrap_err().to_string();
    assert!(error.contains("is a run and"), "{error}");
}

#[test]
fn tensor_components_have_their_own_names_in_both_orders() {
    let place = tempfile::tempdir().unwrap();
    let xz = |value| {
        move |particles: &mut ParticleStore| {
            particles.deviatoric_stress[3] = [1.0, 2.0, 3.0, 4.0, value, 6.0];
        }
    };
    let (a, b) = (
        run(place.path(), "a", xz(5.0)),
        run(place.path(), "b", xz(8.0)),
    );
    let told = text(&compare(&a, &b).unwrap());
    assert_eq!(
        told.matches("deviatoric_stress xz: 5.0 against 8.0")
            .count(),
        4,
        "{told}"
    );
}

#[test]
fn other_particles_are_told_and_the_common_ones_compared() {
    let place = tempfile::tempdir().unwrap();
    let a = run(place.path(), "a", |_| ());
    let b = run(place.path(), "b", |particles| {
        let order: Vec<u32> = (0..30).filter(|k| k % 7 != 3).collect();
        particles.keep(&order, &mut vec![0; SCRATCH_WORDS * order.len()]);
        particles.pressure[2] = f64::from_bits(0x7ff8_0000_0000_0001);
    });
    let told = text(&compare(&a, &b).unwrap());
    assert!(
        told.contains("only A has 4 particles; the first has id"),
        "{told}"
    );
    assert!(told.contains("pressure: 1 particles differ"), "{told}");
    assert!(
        told.contains("NaN (0x7ff8000000000001); largest difference inf Pa"),
        "{told}"
    );
    assert!(!told.contains("velocity: "), "{told}");
}

#[test]
fn info_tells_what_is_there() {
    let place = tempfile::tempdir().unwrap();
    let path = run(place.path(), "a", |particles| {
        for (k, velocity) in particles.velocity.iter_mut().enumerate() {
            *velocity = [f64::from(u8::try_from(k).unwrap()), -7e3, f64::NAN];
        }
    });
    let folder = RunFolder::at(&path);
    let told = describe(&path).unwrap();
    for part in [
        "⌀ 0.6 mm",
        "running",
        "1, the newest of step 12",
        "energy error max",
        "1.5000e-6",
    ] {
        assert!(told.contains(part), "{part} in\n{told}");
    }
    let told = describe(&folder.snapshot(12)).unwrap();
    for part in [
        "body 1                             15         plate",
        "velocity y                   m/s         -7.00000e3    -7.00000e3",
        "30 of its values are not finite",
        "ranks x threads                      1 x 2",
    ] {
        assert!(told.contains(part), "{part} in\n{told}");
    }
    let checkpoint = folder.checkpoint_folders().unwrap().remove(0);
    assert!(describe(&checkpoint).unwrap().contains("format 3"));
    let unknown = describe(place.path()).unwrap_err().to_string();
    assert!(unknown.contains("is neither a run folder"), "{unknown}");
}
