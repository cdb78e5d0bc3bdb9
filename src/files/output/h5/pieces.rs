//! Buffers from which the system takes bytes without a copy.

use std::sync::Mutex;

/// Bytes of a piece.
pub const PIECE: usize = 2 << 20;

/// Bytes of a file system's block at most, where direct I/O is asked for.
pub const MOST_BLOCK: usize = 64 << 10;

/// Bytes that begin where a block may.
#[repr(C, align(65536))]
#[derive(Clone, Copy)]
struct Block([u8; MOST_BLOCK]);

// SAFETY: bytes without room between them, any of which may be zero or anything else.
unsafe impl bytemuck::Zeroable for Block {}
// SAFETY: as above.
unsafe impl bytemuck::Pod for Block {}

/// Memory of [`PIECE`] bytes, aligned as direct I/O needs it.
pub struct Piece(Box<[Block]>);

/// Unused pieces, kept for the next file: a first use of memory costs more than a copy.
static KEPT: Mutex<Vec<Piece>> = Mutex::new(Vec::new());

impl Piece {
    /// A kept piece, or a new one.
    pub fn take() -> Self {
        let kept = KEPT.lock().ok().and_then(|mut kept| kept.pop());
        kept.unwrap_or_else(|| Self(bytemuck::zeroed_slice_box(PIECE / MOST_BLOCK)))
    }

    /// Keeps it for the next use.
    pub fn keep(self) {
        if let Ok(mut kept) = KEPT.lock() {
            kept.push(self);
        }
    }

    /// Its beginning, enough for `bytes` in whole blocks of a file, as direct reads need it.
    pub fn blocks(&mut self, bytes: usize) -> &mut [u8] {
        let whole = bytes.next_multiple_of(MOST_BLOCK).min(PIECE);
        &mut self.bytes()[..whole]
    }

    /// All its bytes.
    pub fn bytes(&mut self) -> &mut [u8] {
        bytemuck::cast_slice_mut(&mut self.0)
    }
}
