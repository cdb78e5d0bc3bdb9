//! Reduction of all that ranks agree on in a step, in one call.
//!
//! MPI combines words of one type by one operation. A step needs four: sums, minima, the first of some
//! entries, and a set of bits. Few words are one element of a type of their own, many some elements of equal length, each
//! of which tells the operation the meaning of its words: MPI may cut a message anywhere between elements.

use std::ffi::{c_int, c_void};
use std::mem::MaybeUninit;

use mpi::ffi;
use mpi::traits::AsRaw;

use super::waiting::waiting;
use super::{Comm, RawComm, Transport};

/// Words before those of an element: their number, the number of minima, the bits, and the first entry.
const HEAD: usize = 6;

/// Words of an element at most. MPI may cut what is more between elements, and send some while it combines others.
const MOST: usize = 2048;

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

    /// Words of an element, but for its head, and the number of elements.
    fn elements(&self) -> [usize; 2] {
        let all = self.least.len() + self.sums.len();
        let count = all.div_ceil(MOST).max(1);
        [all.div_ceil(count), count]
    }

    fn pack(&mut self) {
        let [each, count] = self.elements();
        let [a, b, c] = self.first;
        self.words.clear();
        for k in 0..count {
            let least = part(&self.least, k * each, each);
            let head = [each as u64, least.len() as u64, self.bits, a, b, c];
            self.words.extend(head);
            self.words.extend_from_slice(least);
            let before = (k * each + least.len()).saturating_sub(self.least.len());
            let sums = part(&self.sums, before, each - least.len());
            self.words.extend_from_slice(bytemuck::cast_slice(sums));
            // The last one may be shorter.
            self.words.resize((k + 1) * (HEAD + each), 0);
        }
    }

    fn unpack(&mut self) {
        let [each, _] = self.elements();
        self.bits = self.words[2];
        self.first.copy_from_slice(&self.words[3..HEAD]);
        let (mut least, mut sums) = (self.least.as_mut_slice(), self.sums.as_mut_slice());
        for element in self.words.chunks_exact(HEAD + each) {
            let (minima, rest) = element[HEAD..].split_at(least.len().min(each));
            let here;
            (here, least) = std::mem::take(&mut least).split_at_mut(minima.len());
            here.copy_from_slice(minima);
            let here;
            let count = sums.len().min(rest.len());
            (here, sums) = std::mem::take(&mut sums).split_at_mut(count);
            here.copy_from_slice(bytemuck::cast_slice(&rest[..count]));
        }
    }
}

/// So many of some words from a place on, or as many as there are.
fn part<T>(words: &[T], from: usize, count: usize) -> &[T] {
    let rest = words.get(from..).unwrap_or_default();
    &rest[..count.min(rest.len())]
}

impl Comm {
    /// Joins what all ranks have.
    ///
    /// # Panics
    /// If ranks have not as many sums and smallest numbers.
    #[track_caller]
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
                let [each, _] = joint.elements();
                join_by_mpi(world.as_raw(), HEAD + each, &mine, &mut joint.words);
            }
            Transport::Virtual(rank) => {
                let [each, _] = joint.elements();
                rank.reduce(&mut joint.words, |all, mine| {
                    let elements = mine.chunks_exact(HEAD + each);
                    let all = all.chunks_exact_mut(HEAD + each);
                    all.zip(elements).for_each(|(all, mine)| combine(all, mine));
                });
            }
        }
        joint.unpack();
    }
}

/// Joins a rank's element with that of all.
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
    // SAFETY: MPI passes `count` elements each, as its types say: words, of which the first counts those after the head.
    unsafe {
        for _ in 0..*count {
            let length = HEAD + usize::try_from(*all).unwrap_or(0);
            let my_words = std::slice::from_raw_parts(mine, length);
            combine(std::slice::from_raw_parts_mut(all, length), my_words);
            (mine, all) = (mine.add(length), all.add(length));
        }
    }
}

fn join_by_mpi(world: RawComm, each: usize, mine: &[u64], all: &mut [u64]) {
    let number = |words| c_int::try_from(words).expect("few words");
    let (length, count) = (number(each), number(mine.len() / each));
    // SAFETY: both buffers hold so many elements of the type, which lives until the call is over, as the
    // operation does; `combine_elements` has the signature of an MPI operation.
    unsafe {
        let mut element = ffi::RSMPI_DATATYPE_NULL;
        let mut operation = MaybeUninit::uninit();
        ffi::MPI_Type_contiguous(length, ffi::RSMPI_UINT64_T, &raw mut element);
        ffi::MPI_Type_commit(&raw mut element);
        ffi::MPI_Op_create(Some(combine_elements), 1, operation.as_mut_ptr());
        let mut operation = operation.assume_init();
        let (mine, all) = (mine.as_ptr().cast(), all.as_mut_ptr().cast());
        waiting(|| ffi::MPI_Allreduce(mine, all, count, element, operation, world));
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

    #[test]
    fn any_number_of_words_is_joined_in_pieces() {
        let counts = [0, 1, 7, MOST - 1, MOST, MOST + 1, 2 * MOST + 5];
        for (least, sums) in counts.iter().flat_map(|&a| counts.map(|b| (a, b))) {
            let found = super::super::virtual_ranks(3, super::super::Machine::IDEAL, |comm| {
                let rank = comm.rank() as u64;
                let mut joint = Joint {
                    sums: (0..).map(|k| k << rank).take(sums).collect(),
                    least: (0..).map(|k| (k + rank) % 3).take(least).collect(),
                    first: [7, 2 - rank, rank],
                    bits: 1 << rank,
                    ..Joint::default()
                };
                comm.join(&mut joint);
                joint
            });
            for joint in found {
                assert!(
                    joint
                        .sums
                        .iter()
                        .copied()
                        .eq((0..).map(|k| 7 * k).take(sums))
                );
                assert_eq!(joint.least, vec![0; least]);
                assert_eq!((joint.first, joint.bits), ([7, 0, 2], 7));
                assert_eq!(joint.words.len() % joint.elements()[1], 0);
            }
        }
    }
}
