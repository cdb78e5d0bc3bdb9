//! HDF5 files: written and read by all ranks together, or read by one process.

pub mod arrays;
mod content;
mod direct;
mod gate;
mod pieces;
pub mod read;
mod together;
mod transfer;
mod writeback;
mod writer;

pub use content::{Array, Content};
pub use direct::open_for_reading;
pub use pieces::{PIECE, Piece};
pub use together::abandoned;
pub use writer::{Fill, Writer};

use hdf5::Datatype;
use hdf5::file::FileBuilder;
use hdf5::types::{FloatSize, IntSize, TypeDescriptor};

use comm::Comm;

/// Version of the HDF5 library.
#[must_use]
pub fn library() -> String {
    let (major, minor, release) = hdf5::library_version();
    format!("{major}.{minor}.{release}")
}

/// One value of a dataset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Element {
    /// `f64`.
    F64,
    /// `i64`.
    I64,
    /// `u64`.
    U64,
    /// `u32`.
    U32,
    /// `u8`.
    U8,
    /// `f32`.
    F32,
    /// UTF-8 text of this many bytes, padded with zeros.
    Text(usize),
}

impl Element {
    /// All that are numbers.
    const NUMBERS: [Self; 6] = [
        Self::F64,
        Self::I64,
        Self::U64,
        Self::U32,
        Self::U8,
        Self::F32,
    ];

    /// Its name in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::I64 => "i64",
            Self::U64 => "u64",
            Self::U32 => "u32",
            Self::U8 => "u8",
            Self::F32 => "f32",
            Self::Text(_) => "text",
        }
    }

    /// Values in `bytes` as `f64`, those of integers rounded beyond 2⁵³; of text its bytes.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "for pictures and for people")]
    pub fn reals(self, bytes: &[u8]) -> Vec<f64> {
        fn all<T: bytemuck::Pod>(bytes: &[u8], real: impl Fn(T) -> f64) -> Vec<f64> {
            let values = bytes.chunks_exact(size_of::<T>());
            values
                .map(|value| real(bytemuck::pod_read_unaligned(value)))
                .collect()
        }
        match self {
            Self::F64 => all(bytes, |value: f64| value),
            Self::I64 => all(bytes, |value: i64| value as f64),
            Self::U64 => all(bytes, |value: u64| value as f64),
            Self::U32 => all(bytes, |value: u32| value.into()),
            Self::F32 => all(bytes, |value: f32| value.into()),
            Self::U8 | Self::Text(_) => all(bytes, |value: u8| value.into()),
        }
    }

    /// Bytes of one value.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::F64 | Self::I64 | Self::U64 => 8,
            Self::U32 | Self::F32 => 4,
            Self::U8 => 1,
            Self::Text(bytes) => bytes,
        }
    }

    fn descriptor(self) -> TypeDescriptor {
        match self {
            Self::F64 => TypeDescriptor::Float(FloatSize::U8),
            Self::I64 => TypeDescriptor::Integer(IntSize::U8),
            Self::U64 => TypeDescriptor::Unsigned(IntSize::U8),
            Self::U32 => TypeDescriptor::Unsigned(IntSize::U4),
            Self::U8 => TypeDescriptor::Unsigned(IntSize::U1),
            Self::F32 => TypeDescriptor::Float(FloatSize::U4),
            Self::Text(bytes) => TypeDescriptor::FixedUnicode(bytes),
        }
    }

    /// This machine's HDF5 type.
    fn datatype(self) -> hdf5::Result<Datatype> {
        Datatype::from_descriptor(&self.descriptor())
    }
}

/// A number that files hold.
pub trait Number: bytemuck::Pod {
    /// Its type.
    const ELEMENT: Element;
}

macro_rules! numbers {
    ($($element:ident: $type:ty),*) => {
        $(impl Number for $type {
            const ELEMENT: Element = Element::$element;
        })*
    };
}

numbers!(F64: f64, I64: i64, U64: u64, U32: u32, U8: u8, F32: f32);

/// The type of a dataset's rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowType {
    /// Each value.
    pub element: Element,
    /// Values in a row; a dataset of single values has one dimension, others have two.
    pub components: usize,
}

impl RowType {
    /// Rows of one value.
    #[must_use]
    pub fn single(element: Element) -> Self {
        Self {
            element,
            components: 1,
        }
    }

    /// Bytes of one row.
    #[must_use]
    pub fn bytes(self) -> usize {
        self.element.bytes() * self.components
    }

    fn shape(self, rows: u64) -> Vec<usize> {
        let rows = usize::try_from(rows).expect("rows fit an address");
        if self.components == 1 {
            vec![rows]
        } else {
            vec![rows, self.components]
        }
    }
}

/// Access properties of a file: for all ranks of `comm` together with collective metadata, or for this
/// process alone. Without locks, which some file systems refuse and which are not needed here: a file has
/// its final name only when it is whole.
///
/// # Panics
/// If several ranks without MPI would write over each other.
fn access(comm: Option<&Comm>) -> FileBuilder {
    let can_share = |comm: &Comm| comm.raw().is_some() || comm.size() == 1;
    assert!(comm.is_none_or(can_share), "virtual ranks have no files");
    let mut builder = FileBuilder::new();
    // Records in few large blocks, not scattered between the arrays.
    builder.with_fapl(|list| list.meta_block_size(64 << 10));
    match comm.and_then(Comm::raw) {
        Some(raw) => builder.with_fapl(|list| {
            list.mpio(raw, None)
                .all_coll_metadata_ops(true)
                .coll_metadata_write(true)
        }),
        None => builder.with_fapl(|list| list.file_locking(false)),
    };
    builder
}

/// The message of HDF5, with advice where file systems without locks make it refuse.
fn explain(error: &hdf5::Error) -> String {
    let text = error.to_string();
    if text.contains("unable to lock") {
        format!("{text} (this file system refuses locks: set HDF5_USE_FILE_LOCKING=FALSE)")
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_on_locks_is_for_locks() {
        let said = |text: &str| explain(&hdf5::Error::from(text));
        assert!(said("unable to lock file, errno = 37").contains("HDF5_USE_FILE_LOCKING"));
        for other in [
            "unable to read superblock",
            "truncated file: eof = 9, sblock->base_addr = 0",
        ] {
            assert_eq!(said(other), other);
        }
    }

    #[test]
    fn integers_are_read_as_reals() {
        let ids = [7_i64, -1];
        assert_eq!(Element::I64.reals(bytemuck::cast_slice(&ids)), [7.0, -1.0]);
        assert_eq!(Element::U32.reals(&[1, 0, 0, 0, 2, 1, 0, 0]), [1.0, 258.0]);
        assert_eq!(Element::U8.reals(&[0, 255]), [0.0, 255.0]);
        let single = [0.5_f32, f32::MAX];
        let reals = Element::F32.reals(bytemuck::cast_slice(&single));
        assert_eq!(reals, [0.5, f64::from(f32::MAX)]);
    }
}
