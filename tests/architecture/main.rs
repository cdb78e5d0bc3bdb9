//! Laws that can be read off the source but that neither the compiler nor Cargo holds.
//!
//! Who may import whom stands in the manifests of the crates. The lints here read every file of `src/` but unit tests, and
//! know it by its room.

mod source;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use source::{CRATES_OF_ROOMS, Found, Source, has};

/// Rooms whose results must have the same bits on any ranks, threads and hosts.
const PHYSICS: &str = "numerics populate material particles domain fragments loads contact sph step diagnose \
     measure ballistic exact sums engine";

/// Rooms of physics that have no business with clocks at all (`step` times its phases).
const TIMELESS: &str =
    "numerics populate material particles fragments loads contact sph measure ballistic exact sums";

/// Rooms of the step, where one thread may not go over all particles while others wait.
const STEP: &str = "domain step loads contact sph particles fragments diagnose measure sums engine";

/// Files of those rooms that have no part in a step, with the reason.
const NOT_OF_STEP: &[(&str, &str)] = &[
    ("step/error.rs", "tells of a run that fails"),
    ("step/restored.rs", "checks a restart"),
];

/// Rooms that may start, go on with and step a simulation.
const CALLERS_OF_LOOP: &str = "step run";

/// Functions of `f64` whose bits depend on the host's libm; the `libm` crate has them all.
const HOST_MATHEMATICS: &str = "exp exp2 exp_m1 ln ln_1p log log2 log10 powf sin cos tan asin acos atan atan2 sinh cosh tanh \
     asinh acosh atanh sin_cos cbrt hypot";

/// What a comment beside a parallel reduction must say, with the reason.
const ANY_ORDER: &str = "same bits in any order";

/// What a comment beside a loop of one thread must say, if it is not in the common step.
const NO_STEP: &str = "not in every step";

/// Names and calls that break a law in the room where they stand, each with its line.
fn misplaced_names(source: &Source) -> Vec<Found> {
    let is_in = |rooms| has(rooms, &source.room);
    let drives = is_in(CALLERS_OF_LOOP);
    let name_fault = |name: &str| match name {
        "HashMap" | "HashSet" if is_in(PHYSICS) => "has no order: use a BTreeMap",
        "Instant" | "SystemTime" if is_in(TIMELESS) => "is a clock",
        "rayon" if is_in("comm") => "brings threads to MPI",
        "ParticleStore" if is_in("sums") => "is a store: sums take slices",
        "Case" if is_in("sums") => "is a case: sums take its numbers",
        "Simulation" if !drives => "is for `run` and the bench alone",
        _ => "",
    };
    let call_fault = |name: &str| match name {
        "install" => "moves work off the main thread; build the pool with use_current_thread",
        _ if is_in(PHYSICS) && has(HOST_MATHEMATICS, name) => "has the host's bits: use libm",
        _ => "",
    };
    let mut faults = Vec::new();
    for (found, fault) in [
        (&source.names, &name_fault as &dyn Fn(&str) -> &'static str),
        (&source.calls, &call_fault),
    ] {
        let faulty = found.iter().filter(|(_, name)| !fault(name).is_empty());
        faults.extend(faulty.map(|(line, name)| (*line, format!("{name} {}", fault(name)))));
    }
    faults
}

/// Parallel reductions and loops of one thread without the words that excuse them.
fn unexcused_loops(source: &Source) -> Vec<Found> {
    let mut others = NOT_OF_STEP.iter().map(|(file, _)| *file);
    let is_of_step = has(STEP, &source.room) && !others.any(|file| source.path.ends_with(file));
    let laws = [
        (&source.reductions, has(PHYSICS, &source.room), ANY_ORDER),
        (&source.lone_loops, is_of_step, NO_STEP),
    ];
    let mut faults = Vec::new();
    for (found, _, words) in laws.iter().filter(|(_, holds, _)| *holds) {
        let unexcused = found.iter().filter(|(line, _)| !source.says(*line, words));
        let why = format!("needs a comment that tells why: {words}");
        faults.extend(unexcused.map(|(line, what)| (*line, format!("{what} {why}"))));
    }
    faults
}

/// Calls of MPI that wait and are not timed. So waiting never counts as a rank's work, see `comm/waiting.rs`.
fn untimed_waits(source: &Source) -> Vec<Found> {
    let lines = source.lines.iter().enumerate();
    let is_untimed = |(n, line): &(usize, &String)| {
        let waits = ["_into(", "MPI_Wait", "MPI_All", ".barrier()", ".split_by_"];
        let timed = &source.lines[n.saturating_sub(1)..=*n];
        waits.iter().any(|call| line.contains(call))
            && !timed.iter().any(|line| line.contains("waiting("))
    };
    lines
        .filter(|line| source.room == "comm" && is_untimed(line))
        .map(|(n, _)| (n + 1, "waits outside of `waiting`".to_owned()))
        .collect()
}

/// Where a file breaks a law, and how.
fn faults(source: &Source) -> Vec<Found> {
    let mut faults = misplaced_names(source);
    faults.extend(unexcused_loops(source));
    faults.extend(untimed_waits(source));
    faults.sort();
    faults
}

/// Every file of `src/` but those of unit tests (`tests.rs`, `tests/`).
fn sources() -> &'static [Source] {
    static SOURCES: OnceLock<Vec<Source>> = OnceLock::new();
    SOURCES.get_or_init(|| {
        let mut package = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
        let root = package.find(|folder| folder.join("Cargo.lock").is_file());
        let src = root.expect("a folder with Cargo.lock").join("src");
        let mut paths = Vec::new();
        list(&src, &mut paths);
        paths.sort();
        let read = |path: &PathBuf| {
            let text = fs::read_to_string(path).expect("a source file is read");
            let below = path.strip_prefix(&src).expect("a file of src");
            Source::new(&below.to_string_lossy(), &text)
        };
        paths.iter().map(read).collect()
    })
}

fn list(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of src is read") {
        let path = entry.expect("an entry of src").path();
        let is_of_tests = path.file_stem().is_some_and(|stem| stem == "tests");
        if path.is_dir() && !is_of_tests {
            list(&path, paths);
        } else if !is_of_tests && path.extension().is_some_and(|extension| extension == "rs") {
            paths.push(path);
        }
    }
}

#[test]
fn the_source_keeps_the_laws() {
    let mut all = String::new();
    for source in sources() {
        for (line, what) in faults(source) {
            writeln!(all, "  src/{}:{line} {what}", source.path).unwrap();
        }
    }
    assert!(all.is_empty(), "the architecture is broken:\n{all}");
}

/// Files that may name a pair term beside its own: its row, where the sums put terms together, its fields, and what it
/// does between the sums.
const FILES_OF_TERMS: &str =
    "model/pair_terms.rs sums/terms.rs particles/fields.rs engine/sph/term_records.rs";

#[test]
fn a_pair_term_is_named_in_few_files() {
    let folder = "sums/terms/";
    let paths = sources().iter().map(|source| source.path.as_str());
    let own = paths.clone().filter_map(|path| path.strip_prefix(folder));
    let terms: Vec<&str> = own.filter_map(|file| file.strip_suffix(".rs")).collect();
    assert!(terms.contains(&"xsph"), "{terms:?}");
    assert!(
        FILES_OF_TERMS
            .split(' ')
            .all(|file| paths.clone().any(|path| path == file))
    );
    let mut all = String::new();
    for source in sources()
        .iter()
        .filter(|source| !has(FILES_OF_TERMS, &source.path))
    {
        for (line, name) in &source.names {
            let term = terms.iter().find(|term| name.eq_ignore_ascii_case(term));
            if term.is_some_and(|term| source.path != format!("{folder}{term}.rs")) {
                writeln!(all, "  src/{}:{line} {name}", source.path).unwrap();
            }
        }
    }
    assert!(
        all.is_empty(),
        "pair terms are named beyond their files:\n{all}"
    );
}

/// In a room that has moved away a lint would find nothing.
#[test]
fn every_room_of_the_tables_is_there() {
    let rooms = [PHYSICS, TIMELESS, STEP, CALLERS_OF_LOOP, "comm"].join(" ");
    for room in rooms.split(' ').filter(|room| !has(CRATES_OF_ROOMS, room)) {
        assert!(sources().iter().any(|source| source.room == room), "{room}");
    }
    for file in NOT_OF_STEP.iter().map(|(file, _)| *file) {
        assert!(
            sources().iter().any(|source| source.path.contains(file)),
            "{file}"
        );
    }
}

/// Holds what the lints must catch in a text, by lines.
fn assert_caught(path: &str, text: &str, lines: &[usize]) {
    let found = faults(&Source::new(path, text));
    let caught: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(caught, lines, "{path}: {found:?}");
}

#[test]
fn finds_names_and_functions_in_code_and_in_macros() {
    let text = "use std::collections::HashMap;\nmacro_rules! m { ($x:ident) => {\n$x(HashSet) } }\n\
                fn f(x: f64) { x.exp() + libm::exp(x) + x.abs() }\n\
                fn g() { assert!(x.powf(2.0),\n\"{}\", y.map(f64::sin)) }\nuse std::time::Instant;";
    assert_caught("sph/mod.rs", text, &[1, 3, 4, 5, 6, 7]);
    assert_caught("engine/contact/a/b.rs", text, &[1, 3, 4, 5, 6, 7]);
    assert_caught("engine/step/mod.rs", text, &[1, 3, 4, 5, 6]);
    assert_caught("model/contact/mod.rs", text, &[]);
}

#[test]
fn leaves_out_comments_strings_and_unit_tests() {
    let text = "/// HashMap\n/* /* HashMap */ */ const S: &str = r#\"HashMap\"#;\n\
                #[cfg(test)]\nmod tests { use a::HashMap; fn f() { if true {} } }\n\
                struct A {}\n/// It.\n#[cfg(test)]\nuse a::{HashMap, B};\n\
                fn f() { #[cfg(test)] g(HashMap::new());\nlet m: HashMap; }";
    assert_caught("sph/mod.rs", text, &[10]);
}

#[test]
fn tells_parallel_reductions_from_sums_inside_a_closure() {
    let text = "fn f() { let a = x.par_iter().map(|v| { let s = v.iter().sum::<f64>(); s }).collect();\n\
                // the minimum has the same bits in any order\n\
                let b = x.par_iter().copied().reduce(f64::NAN, min);\n\
                let c = x\n    .into_par_iter()\n    .fold(zero, |a, b| { let c = a; c + b })\n    .sum::<f64>();\n\
                m!(x.par_iter().map(|v| v.iter().sum()).sum()); }\n\
                macro_rules! m { ($($x:ident)*) => {\n$(let y = $x.par_iter().sum();)* z } }";
    assert_caught("sph/mod.rs", text, &[6, 7, 8, 10]);
}

#[test]
fn tells_lone_loops_from_shared_ones() {
    let text = "fn f() { for i in 0..owned {}\n\
                // At the start, not in every step.\nfor i in 0..particles.owned() {}\n\
                let all = (0..owned)\n    .into_par_iter();\n\
                let most = particles\n    .reach\n    .iter().max();\n\
                let all = self.particles.reach.par_iter();\nlet chunks = 0..owned.div_ceil(GRAIN);\n\
                m!((0..owned).into_par_iter());\nm!(particles.reach.iter());\n\
                m!(for i in 0..owned {}); }\nmacro_rules! m { ($($x:ident)*) => {\n$(0..owned $x)* } }";
    assert_caught("engine/contact/mod.rs", text, &[1, 6, 12, 13, 15]);
    assert_caught("engine/step/restored.rs", text, &[]);
}

#[test]
fn finds_threads_at_mpi_waits_without_a_clock_and_loops_of_others() {
    let text = "fn f() { waiting(|| world.all_gather_into(a, b));\n\nworld.all_gather_into(a, b);\n\
                ffi::MPI_Waitall(n);\nwaiting(|| unsafe {\nffi::MPI_Waitall(n) }); }";
    assert_caught("comm/mod.rs", text, &[3, 4]);
    let text = "use rayon::prelude::*;\nfn f() { pool.install(g); install(g) }";
    assert_caught("comm/mod.rs", text, &[1, 2]);
    assert_caught("plot/mod.rs", text, &[2]);
    let text = "use engine::step::Simulation;";
    assert_caught("desk/report/mod.rs", text, &[1]);
    assert_caught("files/run/mod.rs", text, &[]);
}

/// Crates whose unit tests build neither MPI nor HDF5.
const LIGHT: &str = "numerics material exact model populate particles results plot";

/// All packages that a package of `Cargo.lock` depends on, with itself. Those of its tests are among them.
fn built_with(lock: &toml::Table, package: &str) -> BTreeSet<String> {
    let packages = lock["package"].as_array().expect("packages of Cargo.lock");
    let mut found = BTreeSet::new();
    let mut open = vec![package.to_owned()];
    while let Some(name) = open.pop() {
        let own = packages
            .iter()
            .filter(|own| own["name"].as_str() == Some(&name));
        let dependencies = own.filter_map(|own| own.get("dependencies")?.as_array());
        // `NAME`, or `NAME VERSION` where there are several.
        let names = dependencies
            .flatten()
            .filter_map(|other| other.as_str()?.split(' ').next());
        let names: Vec<String> = names.map(str::to_owned).collect();
        if found.insert(name) {
            open.extend(names);
        }
    }
    found
}

#[test]
fn neither_mpi_nor_hdf5_is_built_for_plots_and_below() {
    let lock = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.lock"));
    let lock: toml::Table = toml::from_str(&lock.expect("Cargo.lock is read")).expect("TOML");
    let is_heavy = |name: &String| {
        let heavy = ["mpi", "hdf5"].iter().any(|part| name.starts_with(part));
        heavy
            || ["engine", "comm", "files"]
                .iter()
                .any(|room| *name == format!("whipple-{room}"))
    };
    for room in LIGHT.split(' ') {
        let built = built_with(&lock, &format!("whipple-{room}"));
        assert!(
            built.len() > 1,
            "{room} is no package that depends on others"
        );
        let heavy: Vec<&String> = built.iter().filter(|name| is_heavy(name)).collect();
        assert!(heavy.is_empty(), "{room} builds {heavy:?}");
    }
    let files = built_with(&lock, "whipple-files");
    assert!(files.contains("mpi") && files.contains("hdf5-metno"));
}
