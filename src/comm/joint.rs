//! Reduction of all that ranks agree on in a step, in one call.
//!
//! MPI combines words of one type by one operation. A step needs four: sums, minima, the first of some
//! entries, and a set of bits. All of them together are one element of a type of their own, since MPI may cut
//! a message anywhere between elements, and the operation must know the meaning of each word.

use std::ffi::{c_int, c_void};
use std::mem::MaybeUninit;

use mpi::ffi;
use mpi::traits::AsRaw;

use super::waiting::waiting;
use super::{Comm, RawComm, Transport};

/// Words before the minima: the number of all words, the number of minima, the bits, and the first entry.
const HEAD: usize = 6;

/// Values that ranks reduce together. All ranks have as many sums and minima. Buffers are kept from step
/// to step.
#[derive(Debug, Default)]
pub struct Joint {
    /// Become their sums over ranks (wrapping is the caller's concern).
    pub sums: Vec<i64>,
    /// Become the smallest over ranks.
    pub least: Vec<u64>,
    /// Becomes the first of all ranks' entries, word by word.
    pub first: [u64; 3],
    /// Becomes the union of all ranks' bits.
    pub bits: u64,
    words: Vec<u64>,
}

impl Joint {
    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let words = self.sums.capacity() + self.least.capacity();
        8 * (words + self.words.capacity())
    }

    fn pack(&mut self) {
        let [a, b, c] = self.first;
        let (least, sums) = (self.least.len(), self.sums.len());
        self.words.clear();
        self.words
            .extend([(HEAD + least + sums) as u64, least as u64, self.bits]);
        self.words.extend([a, b, c]);
        self.words.extend_from_slice(&self.least);
        self.words
            .extend_from_slice(bytemuck::cast_slice(&self.sums));
    }

    fn unpack(&mut self) {
        let (head, rest) = self.words.split_at(HEAD);
        let (least, sums) = rest.split_at(self.least.len());
        self.bits = head[2];
        self.first.copy_from_slice(&head[3..]);
        self.least.copy_from_slice(least);
        self.sums.copy_from_slice(bytemuck::cast_slice(sums));
    }
}

impl Comm {
    /// Joins what all ranks have.
    ///
    /// # Panics
    /// If ranks have not as many sums and smallest numbers.
    pub fn join(&self, joint: &mut Joint) {
        if self.size() == 1 {
            return;
        }
        joint.pack();
        match &self.transport {
            Transport::Solo => {}
            Transport::Mpi(world) => {
                let mut mine = self.scratch.borrow_mut();
                mine.clone_from(&joint.words);
                join_by_mpi(world.as_raw(), &mine, &mut joint.words);
            }
            Transport::Virtual(rank) => rank.reduce(&mut joint.words, combine),
        }
        joint.unpack();
    }
}

/// Joins a rank's words with those of all.
fn combine(all: &mut [u64], mine: &[u64]) {
    let (head, rest) = all.split_at_mut(HEAD);
    let (my_head, my_rest) = mine.split_at(HEAD);
    assert_eq!(head[..2], my_head[..2], "all ranks join as many words");
    head[2] |= my_head[2];
    if my_head[3..] < head[3..] {
        head[3..].copy_from_slice(&my_head[3..]);
    }
    let least = usize::try_from(head[1]).expect("a length fits memory");
    for (k, (all, &mine)) in rest.iter_mut().zip(my_rest).enumerate() {
        *all = if k < least {
            mine.min(*all)
        } else {
            all.wrapping_add(mine)
        };
    }
}

/// [`combine`] with the signature of an MPI operation.
unsafe extern "C" fn combine_elements(
    mine: *mut c_void,
    all: *mut c_void,
    count: *mut c_int,
    _: *mut ffi::MPI_Datatype,
) {
    let (mut mine, mut all) = (mine.cast::<u64>(), all.cast::<u64>());
    // SAFETY: MPI passes `count` elements each, as its types say: words, of which the first counts all.
    unsafe {
        for _ in 0..*count {
            let length = usize::try_from(*all).unwrap_or(HEAD);
            let my_words = std::slice::from_raw_parts(mine, length);
            combine(std::slice::from_raw_parts_mut(all, length), my_words);
            (mine, all) = (mine.add(length), all.add(length));
        }
    }
}

fn join_by_mpi(world: RawComm, mine: &[u64], all: &mut [u64]) {
    let length = c_int::try_from(mine.len()).expect("few words");
    // SAFETY: both buffers hold one element of the type, which lives until the call is over, as the
    // operation does; `combine_elements` has the signature of an MPI operation.
    unsafe {
        let mut element = ffi::RSMPI_DATATYPE_NULL;
        let mut operation = MaybeUninit::uninit();
        ffi::MPI_Type_contiguous(length, ffi::RSMPI_UINT64_T, &raw mut element);
        ffi::MPI_Type_commit(&raw mut element);
        ffi::MPI_Op_create(Some(combine_elements), 1, operation.as_mut_ptr());
        let mut operation = operation.assume_init();
        let (mine, all) = (mine.as_ptr().cast(), all.as_mut_ptr().cast());
        waiting(|| ffi::MPI_Allreduce(mine, all, 1, element, operation, world));
        ffi::MPI_Op_free(&raw mut operation);
        ffi::MPI_Type_free(&raw mut element);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_combined_by_what_they_are() {
        let packed = |first, bits, least: [u64; 2], sums: [i64; 3]| {
            let (least, sums) = (least.to_vec(), sums.to_vec());
            let mut joint = Joint {
                sums,
                least,
                first,
                bits,
                ..Joint::default()
            };
            joint.pack();
            joint
        };
        let mut all = packed([5, 0, 9], 1, [4, u64::MAX], [i64::MAX, -2, 1]);
        let mine = packed([5, 0, 8], 6, [7, 0], [1, -3, 0]);
        combine(&mut all.words, &mine.words);
        all.unpack();
        assert_eq!((all.first, all.bits), ([5, 0, 8], 7));
        assert_eq!(all.least, [4, 0]);
        assert_eq!(all.sums, [i64::MIN, -5, 1]);
        // Two elements in a row, as MPI may pass them.
        let words = |joint: &Joint| [joint.words.clone(), joint.words.clone()].concat();
        let (mut two, mut added, mut count) = (words(&all), words(&mine), 2);
        // SAFETY: two elements each.
        unsafe {
            let (mine, all) = (added.as_mut_ptr().cast(), two.as_mut_ptr().cast());
            combine_elements(mine, all, &raw mut count, std::ptr::null_mut());
        }
        combine(&mut all.words, &mine.words);
        assert_eq!(two, words(&all));
    }
}
