//! What is said of a file that a stranger has changed, change by change.

use std::fs;

use crate::changes::{Change, Kind, Shape, Store};
use crate::files::{Bench, Recipe, Which};
use files::output::h5::Content;

/// What `info` and what `restart` or `plot` say of a file with one change.
fn said(bench: &Bench, file: Which, change: Change) -> [String; 2] {
    let recipe = Recipe {
        file,
        changes: vec![change],
    };
    let (mut messages, refused) = bench.attempt(&recipe);
    assert_eq!(refused, 0, "{recipe:?}");
    let last = messages.pop().unwrap();
    [messages.swap_remove(0), last]
}

fn name(text: &str) -> String {
    text.to_owned()
}

fn of(dimensions: &[usize]) -> Shape {
    Shape::Of(dimensions.to_vec())
}

#[test]
fn attributes_of_another_type_or_shape_are_refused() {
    let bench = Bench::new();
    let unit = |kind, shape| Change::Note(name("/fields/mass"), name("unit"), kind, shape);
    let step = |kind, shape| Change::Note(name("/"), name("step"), kind, shape);
    for (change, expected) in [
        // As long as 4096 buffers of the size that its type asks for.
        (
            unit(Kind::Text(8), of(&[4096])),
            "no single value: its shape is [4096]",
        ),
        (unit(Kind::Text(8), Shape::Null), "no single value"),
        (
            unit(Kind::LooseText, Shape::Scalar),
            "no text of fixed length",
        ),
        (unit(Kind::U8, of(&[3])), "no text of fixed length"),
        (
            unit(Kind::Record(100), Shape::Scalar),
            "no text of fixed length",
        ),
        (
            step(Kind::U64, of(&[3])),
            "no single value: its shape is [3]",
        ),
        (step(Kind::U64, Shape::Null), "no single value"),
        (step(Kind::F64, Shape::Scalar), "it is no u64"),
        (
            step(Kind::Array(4), Shape::Scalar),
            "none of f64, i64, u64, u32, u8",
        ),
    ] {
        for told in said(&bench, Which::Checkpoint, change.clone()) {
            assert!(told.contains("state.h5: "), "{change:?}: {told}");
            assert!(told.contains(expected), "{change:?}: {told}");
        }
    }
}

#[test]
fn datasets_of_another_type_shape_or_storage_are_refused() {
    let bench = Bench::new();
    let n = bench.rows;
    let mass = |kind, shape: &[usize], particles| {
        Change::Data(name("/fields/mass"), kind, of(shape), particles)
    };
    let elsewhere = "is a link to another place";
    let stored = "not stored in one piece";
    for (change, expected) in [
        (mass(Kind::F64, &[n, 0], Store::Plain), "unexpected shape"),
        (
            mass(Kind::F64, &[0, 1 << 61], Store::Plain),
            "unexpected shape",
        ),
        (
            mass(Kind::F64, &[n, 1, 1], Store::Plain),
            "unexpected shape",
        ),
        (mass(Kind::F64, &[n, 10], Store::Plain), "unexpected shape"),
        (mass(Kind::I16, &[n], Store::Plain), "none of f64"),
        (mass(Kind::Record(9), &[n], Store::Plain), "none of f64"),
        (mass(Kind::LooseList, &[n], Store::Plain), "none of f64"),
        (mass(Kind::Text(8), &[n], Store::Plain), "none of f64"),
        (
            mass(Kind::F64, &[n], Store::Empty),
            "more than the file holds",
        ),
        (
            mass(Kind::F64, &[1 << 40], Store::Empty),
            "more than the file holds",
        ),
        (mass(Kind::F64, &[n], Store::Compact), stored),
        (mass(Kind::F64, &[1 << 50], Store::Chunked), stored),
        (mass(Kind::F64, &[n], Store::Packed), stored),
        (mass(Kind::F64, &[n], Store::External), stored),
        (mass(Kind::F64, &[n], Store::Virtual), stored),
        (
            Change::Outside(name("/fields/mass"), name("other.h5")),
            elsewhere,
        ),
        (
            Change::Outside(name("/fields"), name("/dev/zero")),
            elsewhere,
        ),
        (
            Change::Soft(name("/fields/mass"), name("/fields/density")),
            elsewhere,
        ),
        (
            Change::Hard(name("/fields/mass"), name("/")),
            "cannot read /fields/mass from",
        ),
        (
            Change::Group(name("/fields/mass")),
            "cannot read /fields/mass from",
        ),
        (Change::Crowd(name("/fields"), 300), "more than 256 members"),
        (
            Change::Data(name("/state"), Kind::Text(8), of(&[4096, 0]), Store::Plain),
            "no single value: its shape is [4096, 0]",
        ),
    ] {
        let [info, restart] = said(&bench, Which::Checkpoint, change.clone());
        // `info` does not read the run's own state.
        if !matches!(&change, Change::Data(at, ..) if at == "/state") {
            assert!(info.contains(expected), "{change:?}: {info}");
        }
        assert!(restart.contains(expected), "{change:?}: {restart}");
    }
    let points = |shape: &[usize], particles| {
        Change::Data(name("/VTKHDF/Points"), Kind::F64, of(shape), particles)
    };
    for (change, expected) in [
        (
            points(&[1 << 50, 3], Store::Empty),
            "more than the file holds",
        ),
        (points(&[n, 6], Store::Plain), "it has 6 components, not 3"),
        (points(&[n, 3], Store::Packed), stored),
    ] {
        let [_, plot] = said(&bench, Which::Snapshot, change.clone());
        assert!(plot.contains(expected), "{change:?}: {plot}");
    }
}

#[test]
fn partitions_that_are_not_those_of_the_rows_are_refused() {
    let bench = Bench::new();
    let sizes = || name("/VTKHDF/NumberOfPoints");
    let other = |kind, shape: &[usize], store| Change::Data(sizes(), kind, of(shape), store);
    let n = bench.rows as u64;
    for (change, expected) in [
        (Change::Value(sizes(), 0, n - 1), "of the "),
        (Change::Value(sizes(), 0, n + 1), "more than the "),
        (
            Change::Value(sizes(), 0, u64::MAX),
            "a partition of -1 rows",
        ),
        (Change::Unlink(sizes()), "NumberOfPoints"),
        (other(Kind::U64, &[1], Store::Plain), "not of one i64 each"),
        (
            other(Kind::I64, &[1, 3], Store::Plain),
            "not of one i64 each",
        ),
        (other(Kind::I64, &[0], Store::Plain), "0 partitions"),
        (
            other(Kind::I64, &[1 << 40], Store::Empty),
            "more than the file holds",
        ),
        (
            other(Kind::I64, &[1], Store::Packed),
            "not stored in one piece",
        ),
    ] {
        for told in said(&bench, Which::Snapshot, change.clone()) {
            assert!(told.contains(expected), "{change:?}: {told}");
        }
    }
}

#[test]
fn a_manifest_that_cannot_be_is_refused() {
    let bench = Bench::new();
    for (key, value, expected) in [
        ("ranks", "0", "tells of 0 ranks"),
        ("block", "0", "1 digests of blocks of 0 bytes"),
        ("block", "1048577", "has blocks of 1048577 bytes"),
        (
            "block",
            "18446744073709551615",
            "has blocks of 18446744073709551615 bytes",
        ),
        ("leaf", "5", "has leaves of 5 bytes"),
        ("sha256", "[]", "0 digests of blocks of 1048576 bytes"),
        (
            "sha256",
            "[\"\", \"\"]",
            "2 digests of blocks of 1048576 bytes",
        ),
        (
            "size",
            "18446744073709551615",
            "1 digests of blocks of 1048576 bytes",
        ),
        ("particles", "1000000000000", "1000000000000 particles in"),
        ("time", "-1.0", "a time of -1e0 s"),
        ("time", "1e999", "cannot be read"),
    ] {
        // JSON has no such number as the last, so it goes in as it stands.
        let value = serde_json::from_str(value).unwrap_or_else(|_| value.into());
        let change = Change::Manifest(name(key), value);
        let [_, restart] = said(&bench, Which::Checkpoint, change.clone());
        assert!(
            restart.contains("manifest.json") && restart.contains(expected),
            "{restart}"
        );
    }
}

#[test]
fn particles_and_a_state_that_are_none_of_the_case_are_refused() {
    let bench = Bench::new();
    let value = |field: &str, bits| Change::Value(format!("/fields/{field}"), 5, bits);
    let state = Content::open(&bench.sound_state())
        .unwrap()
        .text("/state")
        .unwrap();
    let own = |key: &str, by: &str| {
        let from = state.find(&format!("\"{key}\":")).unwrap() + key.len() + 3;
        let length = state[from..].find([',', '}']).unwrap();
        Change::Text(name("/state"), from, length, name(by))
    };
    for (change, expected) in [
        (value("body", u64::MAX), "particles of another body"),
        (value("load", 1 << 31), "particles under another load"),
        (value("velocity", f64::NAN.to_bits()), "not finite"),
        (value("position", f64::INFINITY.to_bits()), "not finite"),
        (value("id", 0), "order of their ids"),
        (own("dt", "-1.0"), "its times are none"),
        (own("dt", "0.0"), "its times are none"),
        (own("capped_reliefs", "-1"), "its counts are none"),
        (
            own("plane_crossings", "9223372036854775807"),
            "its counts are none",
        ),
    ] {
        let [info, restart] = said(&bench, Which::Checkpoint, change.clone());
        assert!(restart.contains(expected), "{change:?}: {restart}");
        assert_eq!(info, "told", "{change:?}");
    }
}

#[test]
fn a_body_without_a_name_and_a_title_that_commands_a_terminal_are_shown() {
    let bench = Bench::new();
    let describe = |change| {
        let [told, _] = said(&bench, Which::Snapshot, change);
        assert_eq!(told, "told");
        app::info::describe(&bench.changed("state.vtkhdf")).unwrap()
    };
    let body = name("/VTKHDF/PointData/body");
    let text = describe(Change::Value(body, 0, u64::from(u32::MAX)));
    assert!(
        text.contains("of other bodies") && text.lines().count() < 60,
        "{text}"
    );
    let title = name("\u{1b}]0;owned\u{7}\nerror: \u{202e}");
    let text = describe(Change::Say(name("/whipple"), name("title"), title));
    assert!(
        text.contains("\\u{1b}]0;owned\\u{7}\\u{a}error: \\u{202e}"),
        "{text}"
    );
    assert!(
        !text.contains(|c: char| c.is_control() && c != '\n'),
        "{text}"
    );
}

#[test]
fn a_file_that_ends_early_is_no_matter_of_locks() {
    let bench = Bench::new();
    for length in [0, 100, 4096] {
        let [told, _] = said(&bench, Which::Snapshot, Change::Length(length));
        assert!(told.contains("cannot open as HDF5"), "{told}");
        assert!(!told.contains("HDF5_USE_FILE_LOCKING"), "{told}");
    }
    let path = bench.changed("pipe.vtkhdf");
    let text = std::ffi::CString::new(path.to_str().unwrap()).unwrap();
    // SAFETY: the path ends with a zero.
    assert_eq!(unsafe { libc::mkfifo(text.as_ptr(), 0o600) }, 0);
    let told = app::info::describe(&path).unwrap_err().to_string();
    assert!(told.contains("it is a pipe"), "{told}");
    fs::remove_file(path).unwrap();
}

/// The program itself, without MPI's launcher: what it says on its error stream.
fn program(arguments: &[&str]) -> (Option<i32>, String) {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_whipple"))
        .args(arguments)
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), said)
}

#[test]
fn the_program_ends_with_one_message() {
    let bench = Bench::new();
    let unit = name("/fields/mass");
    for change in [
        Change::Note(unit, name("unit"), Kind::Text(8), of(&[4096])),
        Change::Data(name("/state"), Kind::Text(8), of(&[4096, 0]), Store::Plain),
        Change::Data(
            name("/fields/id"),
            Kind::F64,
            of(&[0, 1 << 61]),
            Store::Plain,
        ),
    ] {
        said(&bench, Which::Checkpoint, change.clone());
        let folder = bench.changed("");
        let folder = folder.to_str().unwrap().trim_end_matches('/');
        let out = bench.changed("run");
        let restart = [
            "restart",
            folder,
            "--out",
            out.to_str().unwrap(),
            "--threads=1",
        ];
        let commands: [&[&str]; 3] = [&["info", folder], &["compare", folder, folder], &restart];
        for arguments in commands {
            let (code, told) = program(arguments);
            if arguments[0] == "info" && code == Some(0) {
                // It does not read the run's own state.
                assert!(matches!(&change, Change::Data(at, ..) if at == "/state"));
                continue;
            }
            assert_eq!(code, Some(2), "{change:?} {arguments:?}: {told}");
            assert!(told.starts_with("error: cannot read "), "{told}");
            assert_eq!(told.lines().count(), 1, "{told}");
        }
        assert!(!out.exists(), "nothing is begun");
    }
}
