//! Number and bounds of the sites of bodies, counted once for all that asks for them.

use std::num::NonZero;
use std::thread;

use super::filling::Filling;
use super::row::{Cut, cuts};
use super::searched::{Ends, ends, few};
use super::visits;
use model::{Body, Filled, SymmetryPlane};

/// Bodies of which several threads count.
const MANY: usize = 64;

/// Counts the sites of bodies that stand in their final places, above all symmetry planes, where that has not been done.
pub fn fill(bodies: &mut [Body], dimension: usize, symmetry: &[SymmetryPlane]) {
    let count = |bodies: &mut [Body]| {
        for body in bodies.iter_mut().filter(|body| body.filled.is_none()) {
            body.filled = filled(body, dimension, symmetry);
        }
    };
    if bodies.len() < MANY {
        return count(bodies);
    }
    // Threads of their own: a case is read before a program chooses those of its pool.
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let seen: u64 = thread::scope(|scope| {
        let parts = bodies.chunks_mut(bodies.len().div_ceil(threads));
        let tasks: Vec<_> = parts
            .map(|part| scope.spawn(move || visits::of(|| count(part))))
            .collect();
        let seen = tasks.into_iter().map(|task| {
            let seen = task.join();
            seen.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        });
        seen.sum()
    });
    visits::add(seen);
}

/// Rows of a lattice are counted in no time by whoever asks.
fn filled(body: &Body, dimension: usize, symmetry: &[SymmetryPlane]) -> Option<Filled> {
    let filling = Filling::of(body, dimension, symmetry);
    if matches!(filling, Filling::Rows(_)) {
        return None;
    }
    let cuts = cuts(symmetry, None);
    let (count, above) = counted(&filling, &cuts);
    let (_, whole) = if symmetry.is_empty() {
        (count, above)
    } else {
        counted(&Filling::of(body, dimension, &[]), &[])
    };
    Some(Filled {
        symmetry: symmetry.to_vec(),
        count,
        whole,
        above,
    })
}

/// Number of sites, and their smallest and largest coordinates (m).
fn counted(filling: &Filling, cuts: &[Cut]) -> (u64, Option<Ends>) {
    match few(filling, cuts) {
        Some(sites) => (sites.len() as u64, ends(&sites)),
        None => (filling.count(cuts), filling.extremes(cuts)),
    }
}

/// What has been counted of a body above some planes.
pub(super) fn known<'a>(body: &'a Body, symmetry: &[SymmetryPlane]) -> Option<&'a Filled> {
    let filled = body.filled.as_ref();
    filled.filter(|filled| filled.symmetry == symmetry)
}
