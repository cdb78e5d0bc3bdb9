//! Checkpoints that are sound as HDF5 files and as their digests say, with content that no run
//! writes.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::random::Random;
use crate::{Budget, Met, random};
use whipple::comm::Comm;
use whipple::input::parse;
use whipple::output::{Rows, checkpoint};
use whipple::particles::ParticleStore;
use whipple::step::{RunState, Simulation};

const CASE: &str = r#"
dimension = 2
spacing = "1 mm"
run.end_time = "1 us"
material.metal.library = "copper"
body = [
    { name = "a", material = "metal", shape.box.size = ["4 mm", "4 mm"], velocity = [0, "1 m/s"] },
    { name = "b", material = "metal", shape.box = { lower = ["-2 mm", "3 mm"], upper = ["2 mm", "5 mm"] } },
]
"#;

/// Writes a sound checkpoint; gives the number of its particles.
fn write(folder: &Path) -> usize {
    let (comm, case) = (Comm::solo(), parse("case", CASE, &[]).unwrap());
    let input = case.resolved.clone();
    let simulation = Simulation::start(case, &comm).unwrap();
    let meta = checkpoint::Meta {
        step: 0,
        time: 0.0,
        state: &serde_json::to_string(&simulation.state).unwrap(),
        input: &input,
    };
    let store = &simulation.store;
    checkpoint::write(&comm, folder, store, &meta, 1, &mut Rows::default()).unwrap();
    store.owned()
}

/// Reads a checkpoint as `restart` does; gives the message.
fn attempt(path: &Path) -> String {
    let comm = Comm::solo();
    let mut store = ParticleStore::default();
    let restored = match checkpoint::read(&comm, path, &mut store) {
        Ok(restored) => restored,
        Err(error) => return error.to_string(),
    };
    let case = match parse("saved", &restored.input, &[]) {
        Ok(case) => case,
        Err(error) => return error.to_string(),
    };
    let state: RunState = match serde_json::from_str(&restored.state) {
        Ok(state) => state,
        Err(error) => return error.to_string(),
    };
    match Simulation::resume(case, &comm, state, store) {
        Ok(_) => "sound".to_owned(),
        Err(error) => error.to_string(),
    }
}

/// Writes size and digest of the state file into the manifest, and changes a word of it or not.
fn sign(path: &Path, whole: &str, random: &mut Random) {
    let state = fs::read(path.join("state.h5")).unwrap();
    let mut manifest: serde_json::Value = serde_json::from_str(whole).unwrap();
    manifest["size"] = state.len().into();
    manifest["sha256"] = vec![format!("{:x}", Sha256::digest(&state))].into();
    let keys = [
        "format",
        "step",
        "time",
        "particles",
        "ranks",
        "size",
        "block",
        "sha256",
        "x",
    ];
    let values = [
        "0",
        "-1",
        "40",
        "1e300",
        "18446744073709551615",
        "null",
        "\"\"",
        "[]",
        "{}",
    ];
    if random.below(6) == 0 {
        let value = serde_json::from_str(values[random.below(values.len())]).unwrap();
        manifest[keys[random.below(keys.len())]] = value;
    }
    let mut text = manifest.to_string();
    if random.below(20) == 0 {
        text.truncate(random.below(text.len()));
    }
    fs::write(path.join("manifest.json"), text).unwrap();
}

/// Changes something in a sound HDF5 file.
fn change(file: &hdf5::File, count: usize, random: &mut Random) -> hdf5::Result<()> {
    let fields = file.group("fields")?;
    let names = fields.member_names()?;
    let name = &names[random.below(names.len())];
    match random.below(10) {
        0 => fields.unlink(name),
        1 => file.unlink(["state", "input", "fields"][random.below(3)]),
        2 => fields.relink(name, ["porosity", "density", "x", "id"][random.below(4)]),
        3 => replace(&fields, name, count, random),
        4 | 5 => values(&fields.dataset(name)?, random),
        6 => {
            let name = ["state", "input"][random.below(2)];
            let mut text = file.dataset(name)?.read_raw::<u8>()?;
            for _ in 0..=random.below(3) {
                let at = random.below(text.len());
                text[at] = b"0199-e.\"{}[],\xff\n"[random.below(15)];
            }
            text.truncate(text.len() - random.below(2) * random.below(text.len()));
            file.unlink(name)?;
            file.new_dataset_builder()
                .with_data(&text)
                .create(name)
                .map(drop)
        }
        7 => {
            let name = ["step", "time", "format"][random.below(3)];
            file.delete_attr(name)?;
            match random.below(4) {
                0 => Ok(()),
                1 => file.new_attr::<f64>().create(name)?.write_scalar(&f64::NAN),
                2 => file
                    .new_attr::<u64>()
                    .create(name)?
                    .write_scalar(&random.bits()),
                _ => file
                    .new_attr::<u8>()
                    .shape(3)
                    .create(name)?
                    .write_raw(&[1_u8, 2, 3]),
            }
        }
        8 => file
            .create_group(&format!("fields/g{}", random.below(9)))
            .map(drop),
        _ => Ok(()),
    }
}

/// Another type or shape for a field, with values or without.
fn replace(
    fields: &hdf5::Group,
    name: &str,
    count: usize,
    random: &mut Random,
) -> hdf5::Result<()> {
    fields.unlink(name)?;
    let rows = [count, 0, 1, count + 1, 1 << 40, 1 << 50][random.below(6)];
    let wide = [1, 3, 6, 9, 0, 1 << 10][random.below(6)];
    let shape = match random.below(4) {
        0 => vec![],
        1 => vec![rows],
        2 => vec![rows, wide],
        _ => vec![rows.min(1 << 20), wide, 2],
    };
    // In pieces, so that none exists that is not written.
    let piece: Vec<usize> = shape.iter().map(|n| (*n).clamp(1, 64)).collect();
    macro_rules! create {
        ($type:ty) => {{
            let builder = fields.new_dataset::<$type>().shape(&shape[..]);
            let builder = if shape.is_empty() || shape.contains(&0) {
                builder
            } else {
                builder.chunk(&piece[..])
            };
            builder.create(name).map(drop)
        }};
    }
    match random.below(7) {
        0 | 1 => create!(f64),
        2 => create!(u64),
        3 => create!(u32),
        4 => create!(f32),
        5 => create!(bool),
        _ => create!(hdf5::types::VarLenUnicode),
    }
}

/// Other bits in a field.
fn values(dataset: &hdf5::Dataset, random: &mut Random) -> hdf5::Result<()> {
    let odd = [
        0,
        u64::MAX,
        1,
        f64::NAN.to_bits(),
        f64::INFINITY.to_bits(),
        (-1.0_f64).to_bits(),
        1e308_f64.to_bits(),
        random.bits(),
    ];
    macro_rules! change {
        ($type:ty, $of:expr) => {{
            let mut all = dataset.read_raw::<$type>()?;
            for _ in 0..=random.below(3) {
                if !all.is_empty() {
                    let at = random.below(all.len());
                    all[at] = $of(odd[random.below(odd.len())]);
                }
            }
            dataset.write_raw(&all[..])
        }};
    }
    if dataset.dtype()?.is::<f64>() {
        change!(f64, f64::from_bits)
    } else if dataset.dtype()?.is::<u64>() {
        change!(u64, |bits| bits)
    } else {
        #[allow(clippy::cast_possible_truncation, reason = "any bits")]
        let low = |bits: u64| bits as u32;
        change!(u32, low)
    }
}

#[test]
fn no_checkpoint_makes_the_reader_panic() {
    let budget = Budget::new(300);
    let mut random = random(&budget);
    let place = tempfile::tempdir().unwrap();
    let count = write(place.path());
    let [(_, path)] = &checkpoint::list(place.path()).unwrap()[..] else {
        panic!("one checkpoint");
    };
    let state = fs::read(path.join("state.h5")).unwrap();
    let manifest = fs::read_to_string(path.join("manifest.json")).unwrap();
    assert_eq!(attempt(path), "sound");
    let (mut met, mut done, mut not_made) = (Met::default(), 0, 0);
    while budget.allows(done) {
        fs::write(path.join("state.h5"), &state).unwrap();
        let before = random.bits();
        let mut own = Random::new(before);
        let file = hdf5::File::open_rw(path.join("state.h5")).unwrap();
        for _ in 0..=own.below(3) {
            // HDF5 refuses some of these itself.
            not_made += usize::from(change(&file, count, &mut own).is_err());
        }
        file.close().unwrap();
        sign(path, &manifest, &mut own);
        done += 1;
        match catch_unwind(AssertUnwindSafe(|| attempt(path))) {
            Ok(message) => met.is_new(&message),
            Err(_) => panic!("the checkpoint of the random numbers {before:#x}"),
        };
    }
    eprintln!(
        "{done} checkpoints, {} messages, {not_made} changes refused by HDF5",
        met.count()
    );
}
