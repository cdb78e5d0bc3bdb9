//! Holds the dependency rules between the modules of `src/` and the laws that can be read off the
//! source.
//!
//! The developer guide (`docs/src/developer/modules.md`) says what each module may know; the tables
//! below are the same in code. The source is read as tokens: comments, strings and unit tests are
//! left out, and `use` trees are unfolded into full paths.

#[path = "architecture/imports.rs"]
mod imports;
#[path = "architecture/source.rs"]
mod source;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;

use source::{Source, sources, src};

/// Every module, in the order in which data flows.
const MODULES: &str = "app run sweep input model preflight plan populate numerics material particles comm domain fragments \
     neighbours loads contact sph step diagnose measure output ballistic exact export plot report";

/// The modules on top, and who may name them.
const ON_TOP: &[(&str, &str)] = &[
    ("app", ""),
    ("run", "app"),
    ("sweep", "app"),
    ("preflight", "app run plan"),
    ("plan", "app run"),
    ("export", "app"),
    ("report", "app"),
];

/// Folders whose files may start, go on with and step a simulation.
const CALLERS_OF_LOOP: &[&str] = &["step/", "run/", "app/bench/"];

/// What a part of `src/` may not name, beside the modules [`ON_TOP`]: modules of this crate
/// (`comm`), or a place in one (`output::h5`).
const FORBIDDEN: &[(&str, &str)] = &[
    ("app", "domain neighbours contact sph diagnose exact"),
    (
        "run",
        "populate material domain neighbours contact sph diagnose exact plot",
    ),
    (
        "sweep",
        "populate numerics material particles comm domain neighbours loads contact sph step diagnose exact",
    ),
    (
        "preflight",
        "input particles neighbours diagnose output exact plot",
    ),
    (
        "plan",
        "input material neighbours contact diagnose exact plot",
    ),
    // But for the names of snapshot fields, which it checks.
    (
        "input",
        "particles::ParticleStore numerics comm domain neighbours sph contact step diagnose \
         output exact plot",
    ),
    (
        "model",
        "particles comm domain sph contact step output input",
    ),
    ("populate", "comm output input step"),
    (
        "numerics",
        "input model populate material particles comm domain neighbours contact sph step \
         diagnose output exact plot",
    ),
    (
        "material",
        "particles comm domain sph contact step output input",
    ),
    ("particles", "comm output input step"),
    (
        "comm",
        "input model populate material particles domain neighbours contact sph step diagnose \
         output exact plot",
    ),
    ("domain", "material output input sph contact step"),
    (
        "neighbours",
        "material comm output input loads contact sph step diagnose",
    ),
    (
        "fragments",
        "material neighbours loads contact sph step diagnose input output plot",
    ),
    (
        "loads",
        "comm output input neighbours contact sph step diagnose",
    ),
    ("contact", "comm output input sph step diagnose"),
    ("sph", "comm output input contact step diagnose"),
    ("diagnose", "output input plot step"),
    ("measure", "loads contact sph output input plot step"),
    ("step", "output input plot"),
    ("output", "sph plot"),
    (
        "ballistic",
        "input model populate numerics material particles comm domain fragments neighbours loads \
         contact sph step diagnose measure output exact plot",
    ),
    ("exact", "particles comm domain output input step"),
    (
        "export",
        "comm input populate numerics material domain fragments neighbours loads contact sph step diagnose measure exact",
    ),
    ("plot", "comm step"),
    (
        "report",
        "input populate numerics material particles comm domain fragments neighbours loads contact sph step \
         diagnose measure exact",
    ),
];

/// What of a forbidden module a part of `src/` may name all the same, with the reason.
const ALLOWED: &[(&str, &str)] = &[
    // Particles of bodies come from snapshots, and HDF5 has one gate.
    ("input", "output::h5::read output::h5::arrays"),
    // First shocks make steps short.
    ("preflight", "exact::hugoniot"),
];

/// Crates that only one place may name.
const ENTRUSTED: &[(&str, &str)] = &[
    ("mpi", "comm/"),
    ("mpi_sys", "comm/"),
    ("hdf5", "output/h5/"),
    ("hdf5_sys", "output/h5/"),
];

/// The only modules that call `comm`, from the main thread.
const CALLERS_OF_COMM: &str =
    "app run preflight plan domain fragments step output diagnose measure comm";

/// Rooms whose results must have the same bits on any ranks, threads and hosts.
const PHYSICS: &str = "numerics populate material particles domain fragments neighbours loads contact sph step diagnose \
     measure ballistic exact";

/// Physics modules that have no business with clocks at all (`step` times its phases).
const TIMELESS: &str = "numerics populate material particles fragments neighbours loads contact sph measure ballistic exact";

/// Functions of `f64` whose bits depend on the host's libm; the `libm` crate has them all.
const HOST_MATHEMATICS: &str = "exp exp2 exp_m1 ln ln_1p log2 log10 powf sin cos tan asin acos atan atan2 sinh cosh tanh \
     asinh acosh atanh sin_cos cbrt hypot";

/// What a comment beside a parallel reduction must say, with the reason.
const ANY_ORDER: &str = "same bits in any order";

/// Longest file, in lines, unless it stands in [`LONG_FILES`].
const LONGEST: usize = 400;

/// Files that may be longer, each with its reason.
const LONG_FILES: &[(&str, &str)] = &[];

/// Longest function, in lines from `fn` to the closing brace, unless it stands in
/// [`LONG_FUNCTIONS`].
const LONGEST_FUNCTION: usize = 60;

/// Functions that may be longer: file, name, reason.
const LONG_FUNCTIONS: &[(&str, &str, &str)] = &[
    ("sph/corrected/forces.rs", "sum", ONE_FORMULA),
    ("sph/momentum.rs", "sum", ONE_FORMULA),
    ("step/integrate.rs", "finish", ONE_FORMULA),
];

/// The loop over pairs or particles: parts of it would pass all that it has at hand.
const ONE_FORMULA: &str = "is one formula with all that it needs";

/// Files that may import each other, with the reason: a circle among some of them is no fault.
const CIRCLES: &[(&[&str], &str)] = &[];

/// Whether a word stands in a list of words.
fn has(words: &str, word: &str) -> bool {
    words.split(' ').any(|other| other == word)
}

#[test]
fn lib_rs_lists_every_module() {
    let source = &Source::read(&src().join("lib.rs"));
    let listed: BTreeSet<&str> = source
        .tokens
        .windows(4)
        .filter(|w| w[0].text == "pub" && w[1].text == "mod" && w[3].text == ";")
        .map(|w| w[2].text.as_str())
        .collect();
    let folders: BTreeSet<String> = fs::read_dir(src())
        .expect("src is read")
        .map(|entry| entry.expect("an entry of src").path())
        .filter(|path| path.is_dir())
        .map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    let modules: BTreeSet<&str> = MODULES.split(' ').collect();
    assert_eq!(listed, modules, "lib.rs and MODULES of this test differ");
    assert_eq!(
        folders.iter().map(String::as_str).collect::<BTreeSet<_>>(),
        modules
    );
}

#[test]
fn no_module_names_what_it_may_not_know() {
    for_each_source(|source, complain| {
        let module = source.module.as_str();
        let Some((_, forbidden)) = FORBIDDEN.iter().find(|(of, _)| *of == module) else {
            return;
        };
        let top = ON_TOP.iter();
        let above = top.filter(|(top, knowers)| *top != module && !has(knowers, module));
        let rules: Vec<&str> = forbidden
            .split(' ')
            .chain(above.map(|(top, _)| *top))
            .collect();
        let allowed = ALLOWED.iter().filter(|(of, _)| *of == module);
        let allowed: Vec<&str> = allowed.flat_map(|(_, places)| places.split(' ')).collect();
        let is_in =
            |named: &str, rule: &str| named == rule || named.starts_with(&format!("{rule}::"));
        for path in source.paths() {
            let named = path.named();
            if allowed.iter().any(|place| is_in(&named, place)) {
                continue;
            }
            for rule in &rules {
                if is_in(&named, rule) {
                    complain(path.line, &format!("names {named}"));
                }
            }
        }
    });
}

#[test]
fn only_comm_names_mpi_and_only_output_h5_names_hdf5() {
    for_each_source(|source, complain| {
        for path in source.paths() {
            for (name, place) in ENTRUSTED {
                if path.is_of_crate(name) && !source.name.starts_with(place) {
                    complain(path.line, &format!("names the crate {name}"));
                }
            }
        }
    });
}

#[test]
fn only_the_modules_of_the_main_thread_call_comm() {
    for_each_source(|source, complain| {
        if has(CALLERS_OF_COMM, &source.module) {
            return;
        }
        for path in source
            .paths()
            .iter()
            .filter(|path| path.names_module("comm"))
        {
            complain(path.line, "names comm");
        }
    });
}

#[test]
fn only_run_and_the_bench_call_the_loop() {
    for_each_source(|source, complain| {
        let is_caller = |place: &&str| source.name.starts_with(*place);
        if CALLERS_OF_LOOP.iter().any(is_caller) {
            return;
        }
        for path in source.paths() {
            if path.named().starts_with("step::Simulation") {
                complain(path.line, "names the simulation");
            }
        }
    });
}

#[test]
fn threads_never_meet_mpi() {
    for_each_source(|source, complain| {
        for path in source.paths() {
            if source.module == "comm" && path.is_of_crate("rayon") {
                complain(path.line, "names rayon");
            }
        }
        for (line, name) in source.methods() {
            if name == "install" {
                complain(
                    line,
                    "moves work off the main thread; build the pool with use_current_thread",
                );
            }
        }
    });
}

/// So that waiting never counts as a rank's work, see `comm/waiting.rs`.
#[test]
fn calls_of_mpi_that_wait_are_timed() {
    for_each_source(|source, complain| {
        if source.module != "comm" {
            return;
        }
        let lines: Vec<&str> = source.text.lines().collect();
        for (n, line) in lines.iter().enumerate() {
            let waits = ["_into(", "MPI_Wait", ".barrier()"];
            let timed = lines[n.saturating_sub(1)..=n]
                .iter()
                .any(|line| line.contains("waiting("));
            if waits.iter().any(|call| line.contains(call)) && !timed {
                complain(n + 1, "waits outside of `waiting`");
            }
        }
    });
}

#[test]
fn physics_has_no_unordered_maps_clocks_or_host_mathematics() {
    for_each_source(|source, complain| {
        if !has(PHYSICS, &source.module) {
            return;
        }
        for token in &source.tokens {
            let unordered = ["HashMap", "HashSet"].contains(&token.text.as_str());
            let clock = ["Instant", "SystemTime"].contains(&token.text.as_str());
            if unordered {
                complain(token.line, "HashMap has no order: use BTreeMap");
            } else if clock && has(TIMELESS, &source.module) {
                complain(token.line, "reads a clock");
            }
        }
        for (line, name) in source
            .methods()
            .into_iter()
            .chain(source.functions_of_f64())
        {
            if has(HOST_MATHEMATICS, name) {
                complain(
                    line,
                    &format!("{name} has the host's bits: use the libm crate"),
                );
            }
        }
    });
}

#[test]
fn no_sum_depends_on_threads() {
    for_each_source(|source, complain| {
        if !has(PHYSICS, &source.module) {
            return;
        }
        for (line, what) in source.parallel_reductions() {
            if !source.says(line, ANY_ORDER) {
                let why = format!("{what}; if it has the {ANY_ORDER}, say why in a comment");
                complain(line, &why);
            }
        }
    });
}

/// Rooms of the step, where one thread may not go over all particles while others wait.
const STEP: &str = "domain step loads contact sph neighbours particles fragments diagnose measure";

/// What a comment beside such a loop must say, if it is not in the common step.
const NO_STEP: &str = "not in every step";

#[test]
fn no_thread_goes_over_all_particles_alone() {
    for_each_source(|source, complain| {
        if !has(STEP, &source.module) {
            return;
        }
        for line in source.lone_loops() {
            if !source.says(line, NO_STEP) {
                let why = format!("one thread alone; if it is {NO_STEP}, say so in a comment");
                complain(line, &why);
            }
        }
    });
}

#[test]
fn files_are_short_or_have_a_reason() {
    for_each_source(|source, complain| {
        let lines = source.text.lines().count();
        let excused = LONG_FILES.iter().any(|(name, _)| *name == source.name);
        if lines > LONGEST && !excused {
            complain(lines, "is too long: split it, or give the reason");
        }
    });
}

#[test]
fn functions_are_short_or_have_a_reason() {
    for_each_source(|source, complain| {
        for (name, line, lines) in source.functions() {
            let excused = LONG_FUNCTIONS
                .iter()
                .any(|(file, function, _)| *file == source.name && *function == name);
            if lines > LONGEST_FUNCTION && !excused {
                let what = format!("{name} has {lines} lines: split it, or give the reason");
                complain(line, &what);
            }
        }
    });
}

/// Two files that import each other are one file in two places, and neither can be read first.
///
/// A file imports another if it names what the other declares, by a `use` or by a path from
/// `crate`, `super` or a child. What is merely passed on (`pub use`) is followed to where it is
/// declared, and is no import. A parent may take from the files of its own folder, which it
/// gathers: such imports do not count, those of the children from the parent do. Unit tests are
/// left out.
#[test]
fn no_files_import_each_other_in_a_circle() {
    let mut complaints = String::new();
    let imports = imports::imports(&sources());
    for circle in imports::circles(&imports) {
        let excused = |(files, _): &(&[&str], &str)| circle.iter().all(|file| files.contains(file));
        if CIRCLES.iter().any(excused) {
            continue;
        }
        writeln!(complaints, "  these {} files form a circle:", circle.len()).unwrap();
        for file in &circle {
            for (other, line) in &imports[*file] {
                if circle.contains(other.as_str()) {
                    writeln!(complaints, "    src/{file}:{line} takes from {other}").unwrap();
                }
            }
        }
    }
    assert_silent(&complaints);
}

/// Lets a rule complain of each file with a line and what is wrong there, and fails with all of it.
fn for_each_source(rule: impl Fn(&Source, &mut dyn FnMut(usize, &str))) {
    let mut complaints = String::new();
    for source in sources() {
        rule(&source, &mut |line, what| {
            writeln!(complaints, "  src/{}:{line} {what}", source.name).unwrap();
        });
    }
    assert_silent(&complaints);
}

fn assert_silent(complaints: &str) {
    assert!(
        complaints.is_empty(),
        "the architecture is broken:\n{complaints}"
    );
}

/// Kernels are compiled for an instruction set only where all of them lands inside one function: a closure,
/// or what an array method calls, may be compiled apart, and then each operation on vectors is a call.
#[test]
fn no_vector_instruction_is_called_as_a_function() {
    let listed = std::process::Command::new("nm")
        .args(["--demangle", env!("CARGO_BIN_EXE_whipple")])
        .output()
        .expect("nm, which comes with the linker");
    assert!(listed.status.success(), "{listed:?}");
    let symbols = String::from_utf8_lossy(&listed.stdout);
    assert!(symbols.contains("whipple::"), "a program without symbols");
    // What asks the processor for its instruction sets is a function.
    let called: Vec<&str> = symbols
        .lines()
        .filter(|line| line.contains("core_arch::") && !line.ends_with("_xgetbv"))
        .collect();
    assert!(called.is_empty(), "{}", called.join("\n"));
}
