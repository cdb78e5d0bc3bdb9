//! Snapshots and checkpoints written and read by real ranks: content never depends on them.

use std::fs;
use std::os::fd::AsRawFd;
use std::path::Path;
use std::process::Command;

use crate::ranks::{is_rank, launch, on_ranks};
use crate::sentinel::{id, sentinel};
use crate::stored::{case, meta, particles, sorted_ids};
use comm::Comm;
use files::output::h5::read::SnapshotFile;
use files::output::h5::{Content, Element, RowType};
use files::output::snapshot::{Portion, SnapshotFormat};
use files::output::{Block, OutputError, ResultExtents, Rows, checkpoint, snapshot};
use model::{Precision, Sharing};
use particles::{FIELDS, Life, ParticleStore, rows};
use results::SnapshotReader as _;

/// None, fewer than ranks, uneven, and enough for many rows to travel.
const TOTALS: [u64; 4] = [0, 1, 7, 1000];

/// Rows of small partitions.
const PARTITIONS: [u64; 3] = [1, 7, 333];

/// Every quantity there is.
fn all_quantities() -> Vec<snapshot::Quantity> {
    let error = snapshot::quantities(&["?".to_owned()]).unwrap_err();
    let OutputError::UnknownField { allowed, .. } = error else {
        panic!("{error}");
    };
    let names: Vec<String> = allowed.split(", ").map(String::from).collect();
    snapshot::quantities(&names).unwrap()
}

fn read_all(file: &Content, path: &str, row: RowType, rows: u64) -> Vec<u8> {
    let block = Block::even(rows, 0, 1);
    let mut bytes = vec![0; block.count * row.bytes()];
    file.rows(path, row, block, &mut bytes).unwrap();
    bytes
}

/// What a field's column should hold; `vtk` for VTK's order of tensor components.
fn expected(field: usize, total: u64, vtk: bool) -> Vec<u8> {
    let size = FIELDS[field].kind.bytes();
    let mut all = Vec::new();
    for id in sorted_ids(total) {
        let mut bytes = vec![0; size];
        sentinel(id, field, &mut bytes);
        if vtk && size == 48 {
            bytes[32..].rotate_left(8);
        }
        all.extend_from_slice(&bytes);
    }
    all
}

/// Checks a snapshot of so many particles in partitions of so many rows.
fn check_snapshot(path: &Path, total: u64, rows: u64) {
    let file = Content::open(path).unwrap();
    // VTK counts in signed numbers.
    let signed = |name: &str| file.all::<i64>(&format!("/VTKHDF/{name}")).unwrap();
    let mut sizes =
        vec![i64::try_from(rows.max(1)).unwrap(); usize::try_from(total / rows.max(1)).unwrap()];
    if total == 0 || !total.is_multiple_of(rows) {
        sizes.push(i64::try_from(total % rows.max(1)).unwrap());
    }
    for name in ["NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"] {
        assert_eq!(signed(name), sizes);
    }
    let all = usize::try_from(total).unwrap();
    let numbers: Vec<i64> = sizes.iter().flat_map(|&n| 0..n).collect();
    assert_eq!(signed("Connectivity"), numbers);
    let offsets: Vec<i64> = sizes.iter().flat_map(|&n| 0..=n).collect();
    assert_eq!(signed("Offsets"), offsets);
    assert_eq!(file.partitions("/VTKHDF").unwrap(), sizes.len() as u64);
    assert_eq!(SnapshotFile::open(path).unwrap().particles(), all);
    assert_eq!(file.all::<u8>("/VTKHDF/Types").unwrap(), vec![1; all]);
    let time = file.all::<f64>("/VTKHDF/FieldData/TimeValue").unwrap();
    assert_eq!(time[0].to_bits(), 3.5e-8_f64.to_bits());
    let arrays = file.arrays("/VTKHDF/PointData").unwrap();
    assert_eq!(arrays.len(), all_quantities().len());
    for (row, field) in FIELDS.iter().enumerate() {
        let path = match field.name {
            "position" => "/VTKHDF/Points".to_owned(),
            name => format!("/VTKHDF/PointData/{name}"),
        };
        if file.has(&path) {
            let array = file.array(&path).unwrap();
            assert_eq!(array.unit, field.unit, "{path}");
            assert!(field.name == "position" || array.description.starts_with(field.description));
            let bytes = read_all(&file, &path, array.row, total);
            assert!(bytes == expected(row, total, true), "{path} of {total}");
        } else {
            assert!(!field.is_shown());
        }
    }
    let case = case();
    assert_eq!(file.note("/whipple", "title").unwrap(), case.title);
    assert_eq!(
        file.note("/whipple", "bodies").unwrap(),
        r#"["sphere","plate"]"#
    );
    assert_eq!(file.note("/whipple", "symmetry").unwrap(), r#"[["y",0.0]]"#);
    assert_eq!(file.text("/whipple/input").unwrap(), case.resolved);
}

/// What has x above zero, or no x: some half of the particles.
fn halves() -> Portion {
    let mut part = Portion::default();
    part.region.above[0] = 0.0;
    part
}

fn part(part: &Portion) -> SnapshotFormat<'_> {
    SnapshotFormat {
        portion: part,
        partition_rows: 7,
        schedule: Some("close"),
        ..SnapshotFormat::of(&[])
    }
}

fn short() -> SnapshotFormat<'static> {
    SnapshotFormat {
        precision: Precision::Single,
        ..SnapshotFormat::of(&[])
    }
}

/// Checks a snapshot of a part, and one of short numbers, against the whole.
fn check_part(folder: &Path, total: u64) {
    let open = |ending: &str| Content::open(&folder.join(format!("{total}{ending}"))).unwrap();
    let [whole, part, short] = [".vtkhdf", "-part.vtkhdf", "-short.vtkhdf"].map(open);
    let vector = whole.array("/VTKHDF/Points").unwrap().row;
    let points = read_all(&whole, "/VTKHDF/Points", vector, total);
    let x = points
        .chunks(24)
        .map(|point| f64::from_ne_bytes(point[..8].try_into().unwrap()));
    let kept: Vec<bool> = x.map(|x| x.is_nan() || x >= 0.0).collect();
    let count = kept.iter().filter(|kept| **kept).count() as u64;
    assert!(total < 1000 || (300..700).contains(&count), "{count}");
    assert_eq!(part.note("/whipple", "part").unwrap(), "above x = 0 m");
    assert_eq!(part.note("/whipple", "schedule").unwrap(), "close");
    assert_eq!(whole.note_if_any("/whipple", "part").unwrap(), None);
    assert_eq!(
        part.partitions("/VTKHDF").unwrap(),
        count.div_ceil(7).max(1)
    );
    let names = whole.arrays("/VTKHDF/PointData").unwrap().into_iter();
    let names = names.map(|array| format!("/VTKHDF/PointData/{}", array.name));
    for path in names.chain(["/VTKHDF/Points".to_owned()]) {
        let (array, some) = (whole.array(&path).unwrap(), part.array(&path).unwrap());
        assert_eq!((some.row, some.rows), (array.row, count), "{path}");
        let all = read_all(&whole, &path, array.row, total);
        let rows = all.chunks(array.row.bytes()).zip(&kept);
        let expected: Vec<u8> = rows
            .filter(|(_, kept)| **kept)
            .flat_map(|(row, _)| row.to_vec())
            .collect();
        assert!(
            read_all(&part, &path, array.row, count) == expected,
            "{path} of {total}"
        );

        let other = short.array(&path).unwrap();
        assert_eq!(other.unit, array.unit);
        let bytes = read_all(&short, &path, other.row, total);
        if array.row.element == Element::F64 {
            assert_eq!(other.row.element, Element::F32);
            let long = bytemuck::pod_collect_to_vec::<u8, f64>(&all).into_iter();
            #[allow(clippy::cast_possible_truncation, reason = "as it is written")]
            let long = long.map(|value| {
                if value.is_nan() {
                    f32::NAN
                } else {
                    value as f32
                }
            });
            assert!(
                bytes == bytemuck::cast_slice::<f32, u8>(&long.collect::<Vec<_>>()),
                "{path}"
            );
        } else {
            assert_eq!(bytes, all);
        }
    }
    let file = SnapshotFile::open(part.path()).unwrap();
    assert_eq!(file.portion().unwrap().as_deref(), Some("above x = 0 m"));
    assert_eq!(
        file.points(0..file.particles()).unwrap().len() as u64,
        count
    );
}

/// A state of any characters and some size.
fn state() -> String {
    format!("{{\"ρ\": \"{}\"}}", "x".repeat(100_000))
}

fn write_checkpoint(comm: &Comm, folder: &Path, total: u64, step: u64) -> Result<(), OutputError> {
    // A checkpoint makes its own folder alone; on a full disk this one is missing too.
    if comm.is_root() {
        let _ = fs::create_dir_all(folder);
    }
    let (particles, case, state) = (particles(comm, total), case(), state());
    let meta = checkpoint::Meta {
        run: None,
        step,
        time: f64::MIN_POSITIVE / 4.0,
        state: &state,
        input: &case.resolved,
        results: &ResultExtents::default(),
    };
    let mut rows = Rows::default();
    checkpoint::write(comm, folder, &particles, &meta, 2, &mut rows).map(drop)
}

fn check_restored(comm: &Comm, folder: &Path, total: u64) {
    let mut particles = ParticleStore::default();
    let restored = checkpoint::read(comm, folder, &mut particles).unwrap();
    assert_eq!(restored.particles, total);
    assert_eq!(restored.state, state());
    assert_eq!(restored.input, case().resolved);
    assert_eq!(restored.time.to_bits(), (f64::MIN_POSITIVE / 4.0).to_bits());
    let block = Block::even(total, comm.rank(), comm.size());
    assert_eq!(particles.owned(), block.count);
    for (row, field) in FIELDS.iter().enumerate() {
        if field.life == Life::State {
            let all = expected(row, total, false);
            let start = usize::try_from(block.first).unwrap() * field.kind.bytes();
            let here = &all[start..start + block.count * field.kind.bytes()];
            assert!(
                particles.bytes(field.id) == here,
                "{} of {total}",
                field.name
            );
        }
    }
}

#[test]
fn snapshots_hold_every_field_in_id_order_on_any_ranks() {
    for ranks in [1, 2, 3, 5] {
        let folder = tempfile::tempdir().unwrap();
        let name = "output::snapshots_hold_every_field_in_id_order_on_any_ranks";
        on_ranks(name, ranks, folder.path(), |comm, folder| {
            let (case, mut rows) = (case(), Rows::default());
            for total in TOTALS {
                let path = folder.join(format!("{total}.vtkhdf"));
                let particles = particles(comm, total);
                let quantities = all_quantities();
                snapshot::write(
                    comm,
                    &path,
                    &particles,
                    &meta(&case),
                    &SnapshotFormat::of(&quantities),
                    &mut rows,
                )
                .unwrap();
                for partition_rows in PARTITIONS {
                    let path = folder.join(format!("{total}-{partition_rows}.vtkhdf"));
                    let form = SnapshotFormat {
                        partition_rows,
                        ..SnapshotFormat::of(&quantities)
                    };
                    snapshot::write(comm, &path, &particles, &meta(&case), &form, &mut rows)
                        .unwrap();
                }
                for (name, form) in [("part", part(&halves())), ("short", short())] {
                    let path = folder.join(format!("{total}-{name}.vtkhdf"));
                    let form = SnapshotFormat {
                        quantities: &quantities,
                        ..form
                    };
                    snapshot::write(comm, &path, &particles, &meta(&case), &form, &mut rows)
                        .unwrap();
                }
            }
        });
        if is_rank() {
            return;
        }
        for total in TOTALS {
            check_snapshot(&folder.path().join(format!("{total}.vtkhdf")), total, total);
            for rows in PARTITIONS {
                let path = folder.path().join(format!("{total}-{rows}.vtkhdf"));
                check_snapshot(&path, total, rows);
            }
            check_part(folder.path(), total);
        }
        let files = TOTALS.len() * (3 + PARTITIONS.len());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), files);
    }
}

#[test]
fn few_writers_and_aligned_arrays_write_the_same_rows() {
    let name = "output::few_writers_and_aligned_arrays_write_the_same_rows";
    for (ranks, writers) in [(1, 9), (3, 1), (5, 2)] {
        let folder = tempfile::tempdir().unwrap();
        on_ranks(name, ranks, folder.path(), |comm, folder| {
            let case = case();
            let mut rows = Rows::new(Sharing {
                writers: Some(writers),
                alignment: Some(4096),
            });
            for total in TOTALS {
                let quantities = all_quantities();
                let form = SnapshotFormat {
                    partition_rows: 7,
                    ..SnapshotFormat::of(&quantities)
                };
                let path = folder.join(format!("{total}.vtkhdf"));
                let particles = particles(comm, total);
                snapshot::write(comm, &path, &particles, &meta(&case), &form, &mut rows).unwrap();
                assert_eq!(
                    rows.block().count == 0,
                    total == 0 || !writes(comm, writers, total)
                );
                let state = state();
                let meta = checkpoint::Meta {
                    run: None,
                    step: total,
                    time: f64::MIN_POSITIVE / 4.0,
                    state: &state,
                    input: &case.resolved,
                    results: &ResultExtents::default(),
                };
                let path = checkpoint::write(comm, folder, &particles, &meta, 9, &mut rows);
                check_restored(comm, &path.unwrap(), total);
            }
        });
        if is_rank() {
            return;
        }
        for total in TOTALS {
            check_snapshot(&folder.path().join(format!("{total}.vtkhdf")), total, 7);
            let path = folder.path().join(format!("step-{total:08}/state.h5"));
            let file = hdf5::File::open(path).unwrap();
            let place = file.dataset("/fields/velocity").unwrap().offset();
            assert!(
                total < 1000 || place.unwrap().is_multiple_of(4096),
                "{place:?}"
            );
        }
    }
}

/// True if a rank has rows where so many are spread evenly over some of the ranks.
fn writes(comm: &Comm, writers: usize, total: u64) -> bool {
    Block::shared(total, comm.rank(), comm.size(), writers.min(comm.size())).count > 0
}

#[test]
fn a_lone_rank_without_mpi_writes_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let (comm, case, mut rows) = (Comm::solo(), case(), Rows::default());
    for total in TOTALS {
        let path = folder.path().join("snapshot.vtkhdf");
        let particles = particles(&comm, total);
        snapshot::write(
            &comm,
            &path,
            &particles,
            &meta(&case),
            &SnapshotFormat::of(&all_quantities()),
            &mut rows,
        )
        .unwrap();
        check_snapshot(&path, total, total);
        write_checkpoint(&comm, folder.path(), total, total).unwrap();
        check_restored(
            &comm,
            &folder.path().join(format!("step-{total:08}")),
            total,
        );
    }
}

#[test]
fn any_ranks_restore_what_any_ranks_wrote() {
    let name = "output::any_ranks_restore_what_any_ranks_wrote";
    let folder = tempfile::tempdir().unwrap();
    for (writers, readers) in [(3, 2), (1, 5), (5, 1), (2, 3)] {
        for ranks in [writers, readers] {
            on_ranks(name, ranks, folder.path(), |comm, folder| {
                // The first of the two launches finds no checkpoint and writes it.
                for total in TOTALS {
                    let folder = folder.join(total.to_string());
                    let checkpoint = folder.join("step-00000007");
                    let there = checkpoint.exists();
                    comm.barrier();
                    if there {
                        check_restored(comm, &checkpoint, total);
                    } else {
                        write_checkpoint(comm, &folder, total, 7).unwrap();
                    }
                }
            });
            if is_rank() {
                return;
            }
        }
        for total in TOTALS {
            let checkpoint = folder.path().join(format!("{total}/step-00000007"));
            let manifest = checkpoint::manifest(&checkpoint).unwrap();
            assert_eq!((manifest.ranks, manifest.particles), (writers, total));
            fs::remove_dir_all(checkpoint).unwrap();
        }
    }
}

#[test]
fn equal_ids_are_refused_by_every_rank() {
    let name = "output::equal_ids_are_refused_by_every_rank";
    let folder = tempfile::tempdir().unwrap();
    on_ranks(name, 3, folder.path(), |comm, _| {
        let ids: Vec<u64> = (0..4).map(|k| id(k * 3 + comm.rank() as u64)).collect();
        let mut twice = ids.clone();
        twice[2] = id(5);
        assert!(Rows::default().plan(comm, &ids).is_ok());
        let error = Rows::default().plan(comm, &twice).unwrap_err();
        assert!(
            error.to_string().starts_with("two particles have the id"),
            "{error}"
        );
    });
}

/// Runs `task` on a file system of so many bytes, as root only.
fn on_small_disk(bytes: u64, task: impl FnOnce(&Path)) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let options = format!("size={bytes}");
    let mount = Command::new("mount")
        .args(["-t", "tmpfs", "-o", &options, "tmpfs"])
        .arg(folder.path())
        .output();
    if !mount.is_ok_and(|mount| mount.status.success()) {
        return false;
    }
    let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| task(folder.path())));
    let unmounted = Command::new("umount").arg("-l").arg(folder.path()).status();
    assert!(unmounted.is_ok_and(|status| status.success()));
    if let Err(panic) = result {
        std::panic::resume_unwind(panic);
    }
    true
}

/// Writes where there may be too little room: all ranks say so, or all of it is there.
fn fill_disk(comm: &Comm, folder: &Path) {
    let (case, total) = (case(), 3000);
    let particles = particles(comm, total);
    let path = folder.join("snapshot.vtkhdf");
    let checkpoints = folder.join("checkpoints");
    let checkpoint = checkpoints.join("step-00000001");
    let (meta, mut rows) = (meta(&case), Rows::default());
    let snapshot = snapshot::write(
        comm,
        &path,
        &particles,
        &meta,
        &SnapshotFormat::of(&all_quantities()),
        &mut rows,
    );
    if snapshot.is_ok() && comm.is_root() {
        check_snapshot(&path, total, total);
        fs::remove_file(&path).unwrap();
    }
    comm.barrier();
    let written = write_checkpoint(comm, &checkpoints, total, 1);
    if written.is_ok() {
        check_restored(comm, &checkpoint, total);
    }
    for (result, path) in [(snapshot, path), (written, checkpoint)] {
        let text = result.err().map(|e| e.to_string()).unwrap_or_default();
        let mut first = text.clone().into_bytes();
        comm.broadcast(&mut first);
        assert_eq!(text.as_bytes(), first, "the same verdict everywhere");
        assert!(text.is_empty() || !path.exists());
        if comm.is_root() {
            println!("verdict: {text}");
        }
    }
}

#[test]
fn a_full_disk_is_an_error_on_every_rank() {
    let name = "output::a_full_disk_is_an_error_on_every_rank";
    if is_rank() {
        on_ranks(name, 0, Path::new(""), fill_disk);
        return;
    }
    // Where the room ends decides which call meets it; the files need 2 MB, and 8 MB is enough.
    for kilobytes in [0, 100, 300, 900, 8192] {
        let ran = on_small_disk(4096 + (kilobytes << 10), |folder| {
            for ranks in [1, 3] {
                let said = on_ranks(name, ranks, folder, fill_disk);
                let errors = said.matches("verdict: cannot").count();
                let enough = kilobytes == 8192;
                assert_eq!(errors, if enough { 0 } else { 2 }, "{kilobytes} kB: {said}");
            }
        });
        if !ran {
            eprintln!("skipped: cannot mount a small file system (not root?)");
            return;
        }
    }
}

/// Fails unless all ranks have an error, with the same text.
fn assert_all_refused(comm: &Comm, error: Option<OutputError>) {
    let text = error.expect("it is refused").to_string();
    let mut first = text.clone().into_bytes();
    comm.broadcast(&mut first);
    assert_eq!(text.as_bytes(), first, "the same verdict everywhere");
    assert!(text.contains("No such file"), "{text}");
}

/// The last rank has another folder below it, without the one of the files: as if that had been removed just before.
#[test]
fn a_folder_that_one_rank_misses_is_an_error_on_every_rank() {
    let name = "output::a_folder_that_one_rank_misses_is_an_error_on_every_rank";
    let folder = tempfile::tempdir().unwrap();
    on_ranks(name, 3, folder.path(), |comm, folder| {
        let [here, elsewhere] = ["here", "elsewhere"].map(|name| folder.join(name));
        if comm.is_root() {
            fs::create_dir_all(here.join("files")).unwrap();
            fs::create_dir(&elsewhere).unwrap();
        }
        comm.barrier();
        let (case, particles) = (case(), particles(comm, 1000));
        let write = |path: &Path| {
            let quantities = all_quantities();
            let (meta, format) = (meta(&case), SnapshotFormat::of(&quantities));
            snapshot::write(comm, path, &particles, &meta, &format, &mut Rows::default())
        };
        write(&here.join("files/whole")).unwrap();
        let last = comm.rank() + 1 == comm.size();
        std::env::set_current_dir(if last { elsewhere } else { here }).unwrap();
        assert_all_refused(comm, write(Path::new("files/new")).err());
        assert_all_refused(
            comm,
            Content::open_shared(comm, Path::new("files/whole")).err(),
        );
        if !last {
            let left = fs::read_dir("files").unwrap();
            assert_eq!(left.count(), 1, "the whole file alone");
        }
    });
}

/// Leaves this process so many files that it may open; gives those that it must hold for that, and the last descriptor.
fn leave(count: usize) -> (Vec<fs::File>, i32) {
    let limit = libc::rlimit {
        rlim_cur: 256,
        rlim_max: 256,
    };
    // SAFETY: the limit is read from a valid place.
    assert_eq!(
        unsafe { libc::setrlimit(libc::RLIMIT_NOFILE, &raw const limit) },
        0
    );
    let mut held: Vec<fs::File> = (0..256)
        .map_while(|_| fs::File::open("/dev/null").ok())
        .collect();
    let last = held.last().map_or(0, AsRawFd::as_raw_fd);
    held.truncate(held.len() - count);
    (held, last)
}

/// Takes the descriptors that this process frees once it has opened and freed this one, and then renames a folder.
fn take(descriptor: i32, folder: &Path) {
    // SAFETY: a question about a number.
    let is_open = || unsafe { libc::fcntl(descriptor, libc::F_GETFD) } >= 0;
    while !is_open() {}
    while is_open() {}
    while let Ok(taken) = fs::File::open("/dev/null") {
        std::mem::forget(taken);
    }
    // By now the others have the file.
    std::thread::sleep(std::time::Duration::from_millis(200));
    // To remove it would take a descriptor.
    fs::rename(folder, folder.with_extension("gone")).unwrap();
}

/// Descriptors that a rank needs to open a file with others: that which it holds, and room for MPI's own.
const ENOUGH: usize = 5;

/// Rank 1 may open so many files as the folder's file says; with just enough somebody takes what it frees for MPI, and the
/// folder.
#[test]
fn a_file_that_mpi_cannot_open_on_one_rank_ends_all() {
    let name = "output::a_file_that_mpi_cannot_open_on_one_rank_ends_all";
    if is_rank() {
        on_ranks(name, 0, Path::new(""), |comm, folder| {
            let left = fs::read_to_string(folder.join("left"))
                .unwrap()
                .parse()
                .unwrap();
            let (case, particles) = (case(), particles(comm, 1000));
            let quantities = all_quantities();
            let (meta, format) = (meta(&case), SnapshotFormat::of(&quantities));
            let mut rows = Rows::default();
            let mut write = |name: &str| {
                let path = folder.join(name);
                snapshot::write(comm, &path, &particles, &meta, &format, &mut rows)
            };
            write("files/before").unwrap();
            let held = (comm.rank() == 1).then(|| leave(left));
            if let Some((_, last)) = held
                && left == ENOUGH
            {
                let folder = folder.join("files");
                std::thread::spawn(move || take(last, &folder));
            }
            let written = write("files/new").map_err(|error| error.to_string());
            drop(held);
            if comm.is_root() {
                println!("verdict: {}", written.err().unwrap_or_default());
            }
        });
        return;
    }
    if comm::library().starts_with("MPICH") {
        eprintln!("skipped: it counts the descriptors that Open MPI takes");
        return;
    }
    let told = |left: usize| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("left"), left.to_string()).unwrap();
        fs::create_dir(folder.path().join("files")).unwrap();
        let begun = std::time::Instant::now();
        let output = launch(name, 3, folder.path());
        assert!(begun.elapsed().as_secs() < 60, "{left}: {output:?}");
        let said = [output.stdout, output.stderr].map(|said| String::from_utf8(said).unwrap());
        (output.status.code(), said.concat())
    };
    for (left, verdict) in [
        (0, "Too many open files"),
        (ENOUGH - 1, "Too many open files"),
        (ENOUGH + 5, "verdict: \n"),
    ] {
        let (code, said) = told(left);
        assert!(code == Some(0) && said.contains(verdict), "{left}: {said}");
    }
    // Who takes the descriptor may come too late.
    let ended = (0..20)
        .map(|_| told(ENOUGH))
        .find(|(code, _)| *code == Some(1));
    let (_, said) = ended.expect("MPI does not open the file");
    let told = said.matches("was removed or moved while the ranks").count();
    assert_eq!(told, 1, "{said}");
    assert!(!said.contains("verdict"), "{said}");
}

#[test]
fn the_state_is_what_the_table_says() {
    assert!(rows(Life::State).count() > 10);
    assert_eq!(Element::Text(3).bytes(), 3);
}
