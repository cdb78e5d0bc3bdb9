//! The least list of words of all ranks, in one reduction.

use std::ffi::{c_int, c_void};

use mpi::collective::UnsafeUserOperation;
use mpi::datatype::{MutView, UserDatatype, View};
use mpi::ffi;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{CommunicatorCollectives, Equivalence};

use super::waiting::waiting;

/// Words of a list, and one with bits.
pub type Words = [u64; 4];

/// The list that comes first by its first words, and the bits of both.
pub fn least(a: Words, b: Words) -> Words {
    let first = if a[..3] <= b[..3] { a } else { b };
    [first[0], first[1], first[2], a[3] | b[3]]
}

/// What MPI needs to know of it.
pub struct LeastByMpi {
    datatype: UserDatatype,
    operation: UnsafeUserOperation,
}

impl LeastByMpi {
    pub fn new() -> Self {
        Self {
            datatype: UserDatatype::contiguous(4, &u64::equivalent_datatype()),
            // SAFETY: it is used with that type alone, below.
            operation: unsafe { UnsafeUserOperation::commutative(combine) },
        }
    }

    /// Replaces the words by what they are of all ranks together. Collective.
    pub fn reduce(&self, world: &SimpleCommunicator, words: &mut Words) {
        let mine = *words;
        // SAFETY: the type has as many words as each buffer.
        let (mine, mut all) = unsafe {
            (
                View::with_count_and_datatype(&mine, 1, &self.datatype),
                MutView::with_count_and_datatype(words, 1, &self.datatype),
            )
        };
        waiting(|| world.all_reduce_into(&mine, &mut all, &self.operation));
    }
}

/// [`least`] as MPI calls it, for `length` pairs of lists.
unsafe extern "C" fn combine(
    from: *mut c_void,
    into: *mut c_void,
    length: *mut c_int,
    _: *mut ffi::MPI_Datatype,
) {
    let (from, into) = (from.cast::<Words>(), into.cast::<Words>());
    // SAFETY: MPI gives so many lists of its own in both places, which may stand anywhere.
    unsafe {
        for k in 0..usize::try_from(*length).unwrap_or(0) {
            let both = least(from.add(k).read_unaligned(), into.add(k).read_unaligned());
            into.add(k).write_unaligned(both);
        }
    }
}
