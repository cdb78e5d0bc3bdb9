//! Digests of a file by blocks, which are sums over leaves: even parts of some kilobytes.
//!
//! A rank knows the digests of the leaves that it has written alone before the disk has them, whoever wrote the others of
//! a block. So a new file is not read back, but for leaves with the rows of several ranks, or with HDF5's records.

use std::fs::File;
use std::io;
use std::ops::Range;
use std::os::unix::fs::FileExt as _;
use std::path::Path;

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use comm::Comm;

use super::h5::{PIECE, Piece, open_for_reading};
use super::{OutputError, agree};

/// Bytes of a block at least and at most.
const BLOCKS: [u64; 2] = [1 << 20, 64 << 20];
/// Blocks of a file, where these limits leave the choice: enough for many ranks to share.
const COUNT: u64 = 256;
/// Bytes of a leaf; the last one of a file may be shorter.
pub(super) const LEAF: u64 = LEAF_BYTES as u64;
const LEAF_BYTES: usize = 16 << 10;

/// A digest, or a sum of some.
type Words = [u64; 4];

/// How the digest of a block follows from its bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// SHA-256.
    Whole,
    /// The sum of the SHA-256 of its leaves, each with its number in the file as eight bytes after its own, low byte
    /// first. A digest is four words, high byte first; each is summed for itself modulo 2⁶⁴.
    Leaves,
}

/// Bytes of a block of a file of `size` bytes; the last one may be shorter.
pub(super) fn block_of(size: u64) -> u64 {
    let [least, most] = BLOCKS;
    (size / COUNT).clamp(least, most).next_power_of_two()
}

/// Returns true if files may have blocks of this many bytes.
pub(super) fn is_block(bytes: u64) -> bool {
    let [least, most] = BLOCKS;
    bytes.is_power_of_two() && (least..=most).contains(&bytes)
}

/// The digests of blocks of a file's first `size` bytes in hexadecimal, on every rank. Collective.
///
/// # Errors
/// [`OutputError::Io`] if the file cannot be read or is shorter, the same on every rank.
pub(super) fn of_file(
    comm: &Comm,
    path: &Path,
    (size, block): (u64, u64),
    kind: Kind,
) -> Result<Vec<String>, OutputError> {
    let mut sums = sums_of(size, block);
    let mine = sums.iter_mut().enumerate().skip(comm.rank());
    let mine: Vec<_> = mine.step_by(comm.size()).collect();
    let read = open_for_reading(path).and_then(|file| {
        mine.into_par_iter().try_for_each(|(k, words)| {
            let start = k as u64 * block;
            *words = digest_of(&file, start..size.min(start + block), kind)?;
            Ok(())
        })
    });
    agree(comm, read.map_err(OutputError::io("read", path)))?;
    Ok(joined(comm, sums))
}

/// Nothing for each block of a file.
fn sums_of(size: u64, block: u64) -> Vec<Words> {
    let blocks = usize::try_from(size.div_ceil(block)).expect("blocks fit memory");
    vec![[0; 4]; blocks]
}

/// What ranks have of blocks, in hexadecimal. Collective.
fn joined(comm: &Comm, mut sums: Vec<Words>) -> Vec<String> {
    comm.sum_u64(sums.as_flattened_mut());
    let hexadecimal = |[a, b, c, d]: &Words| format!("{a:016x}{b:016x}{c:016x}{d:016x}");
    sums.iter().map(hexadecimal).collect()
}

/// Adds a digest to a sum.
fn add(sum: &mut Words, words: Words) {
    for (sum, word) in sum.iter_mut().zip(words) {
        *sum = sum.wrapping_add(word);
    }
}

fn words(digest: Sha256) -> Words {
    let bytes: [u8; 32] = digest.finalize().into();
    let (bytes, _) = bytes.as_chunks::<8>();
    std::array::from_fn(|k| u64::from_be_bytes(bytes[k]))
}

/// The digest of a leaf of which a digest has all bytes.
fn leaf_of(mut digest: Sha256, leaf: u64) -> Words {
    digest.update(leaf.to_le_bytes());
    words(digest)
}

/// The digest of a range of a file, where pieces may begin, and leaves if these are summed.
fn digest_of(file: &File, range: Range<u64>, kind: Kind) -> io::Result<Words> {
    let mut piece = Piece::take();
    let (mut whole, mut sum) = (Sha256::new(), [0; 4]);
    let mut offset = range.start;
    while offset < range.end {
        let length = (range.end - offset).min(PIECE as u64);
        let wanted = usize::try_from(length).unwrap_or(PIECE);
        let mut filled = 0;
        while filled < wanted {
            let rest = &mut piece.blocks(wanted)[filled..];
            match file.read_at(rest, offset + filled as u64)? {
                0 => return Err(io::ErrorKind::UnexpectedEof.into()),
                count => filled += count,
            }
        }
        let bytes = &piece.bytes()[..wanted];
        match kind {
            Kind::Whole => whole.update(bytes),
            Kind::Leaves => {
                let leaves = (offset / LEAF..).zip(bytes.chunks(LEAF_BYTES));
                for (leaf, bytes) in leaves {
                    add(&mut sum, leaf_of(Sha256::new_with_prefix(bytes), leaf));
                }
            }
        }
        offset += length;
    }
    piece.keep();
    Ok(match kind {
        Kind::Whole => words(whole),
        Kind::Leaves => sum,
    })
}

/// What a rank knows of the leaves of a new file while its ranks write it.
#[derive(Debug, Default)]
pub struct Leaves {
    /// Leaves that this rank has written alone.
    known: Vec<(u64, Words)>,
    /// Leaves within an array that begin in this rank's rows and end in those of others.
    shared: Vec<u64>,
    /// Leaves within arrays, of all ranks.
    arrays: Vec<Range<u64>>,
    /// Where the next byte of this rank is in the file, and its leaf so far, if that has begun in its rows.
    next: u64,
    begun: Option<Sha256>,
}

impl Leaves {
    /// Begins an array, and this rank's rows of it, by their bytes in the file.
    pub fn begin(&mut self, array: Range<u64>, mine: Range<u64>) {
        let leaves = array.start.div_ceil(LEAF)..array.end / LEAF;
        // The leaf that this rank's rows end in.
        let last = mine.end / LEAF;
        if leaves.contains(&last) && mine.start <= last * LEAF && mine.end > last * LEAF {
            self.shared.push(last);
        }
        self.arrays.push(leaves);
        (self.next, self.begun) = (mine.start, None);
    }

    /// Takes the next bytes of this rank's rows.
    pub fn take(&mut self, mut bytes: &[u8]) {
        let split = |bytes: &[u8], next: u64| {
            let left = next.next_multiple_of(LEAF) - next;
            bytes.len().min(usize::try_from(left).unwrap_or(usize::MAX))
        };
        let (first, rest) = bytes.split_at(split(bytes, self.next));
        self.next += first.len() as u64;
        bytes = rest;
        if let Some(mut digest) = self.begun.take() {
            digest.update(first);
            if self.next.is_multiple_of(LEAF) {
                let leaf = self.next / LEAF - 1;
                self.known.push((leaf, leaf_of(digest, leaf)));
            } else {
                self.begun = Some(digest);
            }
        }
        if bytes.is_empty() {
            return;
        }
        let (first, leaves) = (self.next / LEAF, bytes.par_chunks_exact(LEAF_BYTES));
        let rest = leaves.remainder();
        let digests = leaves.enumerate().map(|(k, bytes)| {
            let leaf = first + k as u64;
            (leaf, leaf_of(Sha256::new_with_prefix(bytes), leaf))
        });
        self.known.par_extend(digests);
        self.next += bytes.len() as u64;
        self.begun = (!rest.is_empty()).then(|| Sha256::new_with_prefix(rest));
    }

    /// The digests of all blocks of the finished file of `size` bytes, as [`of_file`] finds them of what was to be
    /// written. Ranks read the leaves that nobody knows. Collective.
    ///
    /// # Errors
    /// As [`of_file`].
    pub(super) fn finish(
        self,
        comm: &Comm,
        path: &Path,
        (size, block): (u64, u64),
    ) -> Result<Vec<String>, OutputError> {
        let mut sums = sums_of(size, block);
        let place = |leaf: u64| usize::try_from(leaf * LEAF / block).expect("blocks fit memory");
        let mut unknown = self.shared;
        if comm.is_root() {
            let mut arrays = self.arrays;
            arrays.retain(|array| !array.is_empty());
            arrays.sort_unstable_by_key(|array| array.start);
            let mut next = 0;
            for array in arrays {
                unknown.extend(next..array.start);
                next = array.end;
            }
            unknown.extend(next..size.div_ceil(LEAF));
        }
        let read = File::open(path).and_then(|file| {
            let mut bytes = vec![0; LEAF_BYTES];
            for &leaf in &unknown {
                let start = leaf * LEAF;
                let count = usize::try_from((size - start).min(LEAF)).unwrap_or(0);
                file.read_exact_at(&mut bytes[..count], start)?;
                let digest = Sha256::new_with_prefix(&bytes[..count]);
                add(&mut sums[place(leaf)], leaf_of(digest, leaf));
            }
            Ok(())
        });
        agree(comm, read.map_err(OutputError::io("read", path)))?;
        for (leaf, words) in self.known {
            add(&mut sums[place(leaf)], words);
        }
        Ok(joined(comm, sums))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_is_sha_256() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, b"abc").unwrap();
        // FIPS 180-2, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(
            of_file(&Comm::solo(), &path, (3, block_of(3)), Kind::Whole).unwrap(),
            [expected]
        );
        assert!(
            of_file(&Comm::solo(), &path, (0, block_of(0)), Kind::Whole)
                .unwrap()
                .is_empty()
        );
        for kind in [Kind::Whole, Kind::Leaves] {
            assert!(of_file(&Comm::solo(), &path, (4, block_of(4)), kind).is_err());
        }
        // With eight zeros: it is leaf 0.
        let leaf = Sha256::digest(b"abc\0\0\0\0\0\0\0\0");
        assert_eq!(
            of_file(&Comm::solo(), &path, (3, block_of(3)), Kind::Leaves).unwrap(),
            [format!("{leaf:x}")]
        );
    }

    /// What ranks know of arrays that they write, with the little that they read, is what the file's own bytes tell,
    /// wherever arrays and rows begin, and in whatever pieces rows come.
    #[test]
    fn what_is_written_has_the_digests_of_what_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let size = 5 << 20;
        let file: Vec<u8> = (0_u32..size)
            .map(|k| (k.wrapping_mul(k) / 977).to_le_bytes()[0])
            .collect();
        std::fs::write(&path, &file).unwrap();
        let (size, block) = (u64::from(size), 1 << 20);
        let wanted = of_file(&Comm::solo(), &path, (size, block), Kind::Leaves).unwrap();
        let arrays = [
            (2048, 700_000, 24),
            (702_048, 0, 8),
            (720_896, 9, 8),
            (786_432, 3_000_008, 8),
            (3_800_000, 16_384, 8),
            (3_900_000, 1_342_880, 32),
        ];
        for ranks in [1, 2, 7, 200] {
            for piece in [100, 16_384, 70_008, PIECE] {
                let found = comm::virtual_ranks(ranks, comm::Machine::IDEAL, |comm| {
                    let mut leaves = Leaves::default();
                    for (start, bytes, row) in arrays {
                        let rows = bytes / row;
                        let of = |rank: u64| start + rows * rank / ranks as u64 * row;
                        let mine = of(comm.rank() as u64)..of(comm.rank() as u64 + 1);
                        leaves.begin(start..start + rows * row, mine.clone());
                        let [from, to] =
                            [mine.start, mine.end].map(|at| usize::try_from(at).unwrap());
                        file[from..to]
                            .chunks(piece)
                            .for_each(|bytes| leaves.take(bytes));
                    }
                    // Few leaves are read: those where an array or a rank's rows begin or end.
                    let read = leaves.shared.len();
                    assert!(read <= arrays.len(), "{read}");
                    leaves.finish(comm, &path, (size, block)).unwrap()
                });
                assert!(
                    found.iter().all(|found| *found == wanted),
                    "{ranks} {piece}"
                );
            }
        }
    }

    #[test]
    fn blocks_are_enough_to_share_and_not_too_many() {
        for size in [0, 1, 5 << 20, 1 << 30, (1 << 30) + 1, 60 << 40] {
            let block = block_of(size);
            assert!(is_block(block), "{size}: {block}");
        }
        assert_eq!(block_of(16 << 20), 1 << 20);
        assert_eq!(block_of(1 << 30), 4 << 20);
        assert_eq!(block_of(60 << 40), 64 << 20);
        assert!(!is_block(0) && !is_block(3 << 20) && !is_block(128 << 20));
    }
}
