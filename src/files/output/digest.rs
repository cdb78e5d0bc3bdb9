//! SHA-256 of a file, block by block, the ranks and their threads sharing the blocks.

use std::fs::File;
use std::io;
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
    size: u64,
    block: u64,
) -> Result<Vec<String>, OutputError> {
    let blocks = usize::try_from(size.div_ceil(block)).expect("blocks fit memory");
    // Four words for each block; zero where another rank has it, so that a sum joins them.
    let mut words = vec![0_u64; 4 * blocks];
    let (digests, _) = words.as_chunks_mut::<4>();
    let mine = digests.iter_mut().enumerate().skip(comm.rank());
    let mine: Vec<_> = mine.step_by(comm.size()).collect();
    let read = open_for_reading(path).and_then(|file| {
        mine.into_par_iter().try_for_each(|(k, words)| {
            let start = k as u64 * block;
            let digest = digest_of(&file, start, block.min(size - start))?;
            let (bytes, _) = digest.as_chunks::<8>();
            for (word, bytes) in words.iter_mut().zip(bytes) {
                *word = u64::from_be_bytes(*bytes);
            }
            Ok(())
        })
    });
    agree(comm, read.map_err(OutputError::io("read", path)))?;
    comm.sum_u64(&mut words);
    let (digests, _) = words.as_chunks::<4>();
    let hexadecimal = |[a, b, c, d]: &[u64; 4]| format!("{a:016x}{b:016x}{c:016x}{d:016x}");
    Ok(digests.iter().map(hexadecimal).collect())
}

/// The digest of `count` bytes from `start` on, where pieces may begin.
fn digest_of(file: &File, start: u64, count: u64) -> io::Result<[u8; 32]> {
    let mut piece = Piece::take();
    let mut digest = Sha256::new();
    let mut offset = start;
    while offset < start + count {
        let length = (start + count - offset).min(PIECE as u64);
        let wanted = usize::try_from(length).unwrap_or(PIECE);
        let mut filled = 0;
        while filled < wanted {
            let rest = &mut piece.blocks(wanted)[filled..];
            match file.read_at(rest, offset + filled as u64)? {
                0 => return Err(io::ErrorKind::UnexpectedEof.into()),
                count => filled += count,
            }
        }
        digest.update(&piece.bytes()[..wanted]);
        offset += length;
    }
    piece.keep();
    Ok(digest.finalize().into())
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
            of_file(&Comm::solo(), &path, 3, block_of(3)).unwrap(),
            [expected]
        );
        assert!(
            of_file(&Comm::solo(), &path, 0, block_of(0))
                .unwrap()
                .is_empty()
        );
        assert!(of_file(&Comm::solo(), &path, 4, block_of(4)).is_err());
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
