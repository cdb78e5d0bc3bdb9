//! Law 4: a step allocates nothing once it is warmed up; and what is allocated is counted.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

use crate::common::process::in_its_own;
use crate::project;
use comm::Comm;
use engine::step::Simulation;
use files::input;

/// Counts allocations of all threads, once it is told to.
struct Counting;

static ON: AtomicBool = AtomicBool::new(false);
static COUNT: AtomicU64 = AtomicU64::new(0);
/// Bytes in use, but for a constant, and modulo 2⁶⁴.
static HELD: AtomicUsize = AtomicUsize::new(0);

fn count(calls: u64, taken: usize, given: usize) {
    if ON.load(Ordering::Relaxed) {
        COUNT.fetch_add(calls, Ordering::Relaxed);
        HELD.fetch_add(taken.wrapping_sub(given), Ordering::Relaxed);
    }
}

// SAFETY: hands every call to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(1, layout.size(), 0);
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(0, 0, layout.size());
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(1, size, layout.size());
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Two blocks in touch on a plane, at rest but for a breath of gravity: contact, mirrors, loads and
/// lists are busy, and their sizes stay.
const CASE: &str = r#"
title = "Two blocks in touch"
dimension = 3
spacing = "0.1 mm"

gravity = [0, 0, "-9.81 m/s^2"]

[run]
end_time = "1 ms"

[material.aluminium]
library = "aluminium-2024"
failure.spall.pressure = "-1 kPa"

[[body]]
name = "below"
material = "aluminium"
shape.box = { lower = ["0 mm", "0 mm", "-0.8 mm"], upper = ["2 mm", "2 mm", "0 mm"] }
lattice = "cubic"

[[body]]
name = "above"
material = "aluminium"
shape.box = { lower = ["0 mm", "0 mm", "0 mm"], upper = ["1 mm", "1 mm", "0.8 mm"] }
lattice = "cubic"

[[body]]
name = "rigid"
rigid = true
shape.box = { lower = ["0 mm", "0 mm", "0.8 mm"], upper = ["1 mm", "1 mm", "1.2 mm"] }
lattice = "cubic"

[[load]]
body = "below"
above.x = "1.8 mm"
velocity = { x = 0, y = 0 }

[relaxation]
until = "0.5 ms"

[[pressure]]
body = "above"
above.z = "0.4 mm"
value = "1 Pa"

[[absorb]]
body = "below"
faces = ["+y"]
depth = "8 spacing"

[[plane]]
normal = "+z"
point = [0, 0, "-0.8 mm"]

[[surface]]
shape.stl = { file = "tests/common/hook.stl", unit = "0.1 mm", at = ["1.35 mm", 0, "0.42 mm"] }
rotation = { axis = "z", rate = "1e-6 rad/s" }

[[surface]]
shape.cylinder = { radius = "4 mm", length = "1.6 mm" }
side = "inside"

[[symmetry]]
axis = "x"
position = 0

[[symmetry]]
axis = "y"
position = 0
"#;

/// One test in a process of its own, since the counters are those of the whole process.
#[test]
fn a_warm_step_allocates_nothing_and_all_that_is_held_is_told() {
    let name = "no_allocation::a_warm_step_allocates_nothing_and_all_that_is_held_is_told";
    in_its_own(name, check_all);
}

fn check_all() {
    project::enter();
    ON.store(true, Ordering::Relaxed);
    let comm = Comm::solo();
    // As `whipple run` has it: the thread that calls is one of the pool's, so that its jobs do not
    // pass a queue that allocates. Two on any machine, so that what is held has one size.
    (rayon::ThreadPoolBuilder::new().num_threads(2))
        .use_current_thread()
        .build_global()
        .expect("the first pool of this process");
    rayon::join(|| (), || ());
    check(&comm, CASE, &[]);
    let free = CASE
        .replace(
            "rigid = true",
            "rigid = true\nfree = true\nmaterial = \"aluminium\"",
        )
        .replace("length = \"1.6 mm\"", "length = \"4 mm\"");
    check(&comm, &free, &[]);
    let options = [
        "artificial_stress=0.3",
        "balsara=true",
        "conduction=1",
        "xsph=0.5",
    ];
    check(&comm, CASE, &options.map(|option| format!("sph.{option}")));
    let contact = ["self_contact={folds=8}", "friction=0.3"];
    check(
        &comm,
        CASE,
        &contact.map(|option| format!("contact.{option}")),
    );
    // Nothing that is rigid or has no end attracts.
    let without = |text: &str, begin: &str, end: &str| {
        let (before, rest) = text.split_once(begin).expect("its begin");
        let (_, after) = rest.split_once(end).expect("its end");
        format!("{before}{end}{after}")
    };
    let soft = without(CASE, "[[body]]\nname = \"rigid\"", "[[load]]");
    let soft = without(&soft, "[[absorb]]", "[[plane]]");
    let gravity = "self_gravity.constant=1 m^3/(kg s^2)".to_owned();
    check(&comm, &soft, &[gravity]);
}

fn check(comm: &Comm, text: &str, set: &[String]) {
    let held_before = HELD.load(Ordering::Relaxed);
    let case = input::parse("case", text, set).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::start(case, comm).expect("it starts");
    // With the first search for folds of a body that a pressure acts on.
    for _ in 0..40 {
        simulation.advance(comm).expect("a step");
    }
    let before = COUNT.load(Ordering::Relaxed);
    for _ in 0..20 {
        simulation.advance(comm).expect("a step");
    }
    let allocations = COUNT.load(Ordering::Relaxed) - before;
    // The pool's queues now and then grow or shrink where its threads wait for a core; nothing else may.
    assert!(allocations < 20, "{allocations} allocations in 20 steps");

    #[allow(clippy::cast_precision_loss, reason = "small")]
    let told =
        simulation.memory() as f64 / HELD.load(Ordering::Relaxed).wrapping_sub(held_before) as f64;
    // The rest is the case, its tables, and the heads of lists.
    assert!((0.98..=1.0).contains(&told), "{told} of what is held");
}
