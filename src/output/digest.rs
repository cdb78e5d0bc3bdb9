//! SHA-256 of a file, block by block, the ranks sharing the blocks.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::comm::Comm;

use super::{OutputError, agree};

/// Bytes of a block; the last one may be shorter.
pub(super) const BLOCK: u64 = 64 << 20;

/// The digests of a file's first `size` bytes in hexadecimal, on every rank. Collective.
///
/// # Errors
/// [`OutputError::Io`] if the file cannot be read or is shorter, the same on every rank.
pub(super) fn of_file(comm: &Comm, path: &Path, size: u64) -> Result<Vec<String>, OutputError> {
    let blocks = usize::try_from(size.div_ceil(BLOCK)).expect("blocks fit memory");
    // Four words for each block; zero where another rank has it, so that a sum joins them.
    let mut words = vec![0_u64; 4 * blocks];
    let mine = (comm.rank()..blocks).step_by(comm.size());
    let read = share(path, size, mine, &mut words).map_err(OutputError::io("read", path));
    agree(comm, read)?;
    comm.sum_u64(&mut words);
    let (digests, _) = words.as_chunks::<4>();
    let hexadecimal = |[a, b, c, d]: &[u64; 4]| format!("{a:016x}{b:016x}{c:016x}{d:016x}");
    Ok(digests.iter().map(hexadecimal).collect())
}

fn share(
    path: &Path,
    size: u64,
    blocks: impl Iterator<Item = usize>,
    words: &mut [u64],
) -> std::io::Result<()> {
    let mut file = File::open(path)?;
    let mut buffer = vec![0; 1 << 20];
    for block in blocks {
        let start = block as u64 * BLOCK;
        file.seek(SeekFrom::Start(start))?;
        let mut left = BLOCK.min(size - start);
        let mut digest = Sha256::new();
        while left > 0 {
            let piece = usize::try_from(left)
                .unwrap_or(usize::MAX)
                .min(buffer.len());
            file.read_exact(&mut buffer[..piece])?;
            digest.update(&buffer[..piece]);
            left -= piece as u64;
        }
        let digest: [u8; 32] = digest.finalize().into();
        let (bytes, _) = digest.as_chunks::<8>();
        for (word, bytes) in words[4 * block..].iter_mut().zip(bytes) {
            *word = u64::from_be_bytes(*bytes);
        }
    }
    Ok(())
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
        assert_eq!(of_file(&Comm::solo(), &path, 3).unwrap(), [expected]);
        assert!(of_file(&Comm::solo(), &path, 0).unwrap().is_empty());
        assert!(of_file(&Comm::solo(), &path, 4).is_err());
    }
}
