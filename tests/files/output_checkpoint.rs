//! A checkpoint is whole or refused, and the last ones are kept.

use std::fs;
use std::path::{Path, PathBuf};

use crate::stored::{case, particles};
use comm::Comm;
use files::output::h5::{Element, RowType, Writer};
use files::output::{Block, OutputError, ResultExtents, Rows, checkpoint, write_json};
use particles::{FieldKind, Life, ParticleStore, rows};

fn write(folder: &Path, step: u64, keep: usize) -> PathBuf {
    let (comm, case) = (Comm::solo(), case());
    let meta = checkpoint::Meta {
        run: None,
        step,
        time: 1e-9,
        state: "{}",
        input: &case.resolved,
        results: &ResultExtents::default(),
    };
    let particles = particles(&comm, 40);
    checkpoint::write(&comm, folder, &particles, &meta, keep, &mut Rows::default()).unwrap()
}

fn refusal(checkpoint: &Path) -> String {
    let read = checkpoint::read(&Comm::solo(), checkpoint, &mut ParticleStore::default());
    let error = read.expect_err("a damaged checkpoint is refused");
    assert!(
        !matches!(error, OutputError::Hdf5 { .. }),
        "found before HDF5 is: {error}"
    );
    error.to_string()
}

/// Writes the manifest again to fit a changed state file.
fn sign(checkpoint: &Path) {
    use sha2::{Digest, Sha256};
    let state = fs::read(checkpoint::state_file(checkpoint)).unwrap();
    let mut manifest = checkpoint::manifest(checkpoint).unwrap();
    manifest.size = state.len() as u64;
    manifest.leaf = None;
    manifest.sha256 = vec![format!("{:x}", Sha256::digest(&state))];
    write_json(&checkpoint.join(checkpoint::MANIFEST), &manifest).unwrap();
}

#[test]
fn a_flipped_bit_or_a_missing_end_is_told_before_hdf5_sees_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), 3, 1);
    let state = checkpoint::state_file(&path);
    let whole = fs::read(&state).unwrap();

    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 4;
    fs::write(&state, &flipped).unwrap();
    let text = refusal(&path);
    assert!(text.contains("state.h5 is damaged: bytes 0 to "), "{text}");
    assert!(text.contains("restart from an older checkpoint"), "{text}");

    fs::write(&state, &whole[..whole.len() - 1]).unwrap();
    assert!(refusal(&path).contains(&format!("instead of {}", whole.len())));

    fs::remove_file(&state).unwrap();
    assert!(refusal(&path).contains("state.h5 is damaged: it is missing"));

    fs::write(&state, &whole).unwrap();
    sign(&path);
    let comm = Comm::solo();
    assert!(checkpoint::read(&comm, &path, &mut ParticleStore::default()).is_ok());
}

/// A bit in the superblock, and in every stretch of 1/64 of the file: its records, each dataset.
#[test]
fn a_bit_flipped_anywhere_is_told_before_hdf5_sees_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), 3, 1);
    let state = checkpoint::state_file(&path);
    let whole = fs::read(&state).unwrap();
    let mut places: Vec<usize> = (0..64).map(|k| k * whole.len() / 64).collect();
    places.extend([8, 13, whole.len() - 1]);
    // A particle's value of each field, wherever it stands in the file.
    let particles = particles(&Comm::solo(), 40);
    for field in particles.held(Life::State) {
        let bytes = &particles.bytes(field.id)[..field.kind.bytes()];
        let found = whole
            .windows(bytes.len())
            .position(|window| window == bytes);
        places.push(found.unwrap_or_else(|| panic!("no {} in the file", field.name)));
    }
    for (n, &at) in places.iter().enumerate() {
        let mut flipped = whole.clone();
        flipped[at] ^= 1 << (n % 8);
        fs::write(&state, &flipped).unwrap();
        assert!(
            refusal(&path).contains("do not match their digest"),
            "byte {at}"
        );
    }
    fs::write(&state, "").unwrap();
    assert!(refusal(&path).contains("it has 0 bytes"));
}

/// The format before had a digest of each block alone.
#[test]
fn a_checkpoint_of_the_format_before_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), 3, 1);
    sign(&path);
    let manifest = path.join(checkpoint::MANIFEST);
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(&manifest, text.replace("\"format\": 3", "\"format\": 2")).unwrap();
    let mut particles = ParticleStore::default();
    let restored = checkpoint::read(&Comm::solo(), &path, &mut particles).unwrap();
    assert_eq!((restored.step, restored.particles), (3, 40));
    flip(&checkpoint::state_file(&path));
    assert!(refusal(&path).contains("state.h5 is damaged: bytes 0 to "));
}

fn flip(state: &Path) {
    let mut bytes = fs::read(state).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    fs::write(state, &bytes).unwrap();
}

#[test]
fn a_broken_manifest_or_another_format_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), 3, 1);
    let manifest = path.join(checkpoint::MANIFEST);
    let text = fs::read_to_string(&manifest).unwrap();

    fs::write(&manifest, text.replace("\"format\": 3", "\"format\": 4")).unwrap();
    assert!(refusal(&path).contains("has format 4, this program reads format 3"));

    fs::write(&manifest, text.replace("\"step\": 3", "\"step\": 4")).unwrap();
    assert!(refusal(&path).contains("it is of step 3, manifest.json of step 4"));

    fs::write(&manifest, &text[..text.len() / 2]).unwrap();
    assert!(refusal(&path).contains("manifest.json cannot be read"));

    fs::remove_file(&manifest).unwrap();
    assert!(refusal(&path).contains("cannot read"));
    assert!(checkpoint::list(folder.path()).unwrap().is_empty());
}

#[test]
fn fields_that_the_program_does_not_share_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let comm = Comm::solo();
    for (skip, extra, message) in [
        ("density", "", "it lacks the field density"),
        ("", "porosity", "it has an unknown field porosity"),
    ] {
        let path = write(folder.path(), 3, 1);
        let mut file = Writer::create(&comm, &checkpoint::state_file(&path)).unwrap();
        file.number("/", "step", &3_u64).unwrap();
        file.number("/", "time", &1e-9).unwrap();
        file.group(checkpoint::FIELDS).unwrap();
        let mut add = |name: &str, row: RowType| {
            let path = format!("{}/{name}", checkpoint::FIELDS);
            let bytes = vec![0; 40 * row.bytes()];
            file.rows(&path, row, Block::even(40, 0, 1), &bytes)
                .unwrap();
        };
        for field in rows(Life::State).filter(|field| field.name != skip) {
            let element = match field.kind {
                FieldKind::Id => Element::U64,
                FieldKind::Index => Element::U32,
                _ => Element::F64,
            };
            let components = field.kind.components();
            add(
                field.name,
                RowType {
                    element,
                    components,
                },
            );
        }
        if !extra.is_empty() {
            add(extra, RowType::single(Element::F64));
        }
        file.close().unwrap();
        sign(&path);
        let text = refusal(&path);
        assert!(text.contains(message), "{text}");
        assert!(
            text.contains("restart it with the program that wrote it"),
            "{text}"
        );
    }
}

/// The older one of a step has another name while the new one takes its own.
#[test]
fn a_checkpoint_that_is_being_replaced_is_still_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), 3, 1);
    let old = folder.path().join("step-00000003.old");
    fs::rename(&path, &old).unwrap();
    let list = || checkpoint::list(folder.path()).unwrap();
    assert_eq!(list(), [(3, old.clone())]);
    let mut particles = ParticleStore::default();
    assert!(checkpoint::read(&Comm::solo(), &old, &mut particles).is_ok());
    write(folder.path(), 3, 1);
    assert_eq!(list(), [(3, path)]);
    assert!(!old.exists());
}

#[test]
fn the_newest_are_kept_and_half_written_ones_go() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("step-00000001.partial")).unwrap();
    fs::write(folder.path().join("notes.txt"), "").unwrap();
    for step in [2, 4, 6, 6, 8] {
        write(folder.path(), step, 2);
    }
    let steps: Vec<u64> = checkpoint::list(folder.path())
        .unwrap()
        .iter()
        .map(|c| c.0)
        .collect();
    assert_eq!(steps, [6, 8]);
    // A later one, left by a run that went on and was then restarted from before, stays.
    write(folder.path(), 7, 1);
    let steps: Vec<u64> = checkpoint::list(folder.path())
        .unwrap()
        .iter()
        .map(|c| c.0)
        .collect();
    assert_eq!(steps, [7, 8]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
}
