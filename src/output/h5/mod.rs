//! HDF5 files: written and read by all ranks together, or read by one process.

mod content;
pub mod read;
mod transfer;
mod writer;

pub use content::{Array, Content};
pub use writer::{Writer, abandoned};

use hdf5::Datatype;
use hdf5::file::FileBuilder;
use hdf5::types::{FloatSize, IntSize, TypeDescriptor};

use crate::comm::Comm;

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
    /// UTF-8 text of so many bytes, padded with zeros.
    Text(usize),
}

impl Element {
    /// Bytes of one value.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::F64 | Self::I64 | Self::U64 => 8,
            Self::U32 => 4,
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
            Self::Text(bytes) => TypeDescriptor::FixedUnicode(bytes),
        }
    }

    /// This machine's HDF5 type.
    fn datatype(self) -> hdf5::Result<Datatype> {
        Datatype::from_descriptor(&self.descriptor())
    }

    /// The element that a file's type reads as.
    fn of(datatype: &Datatype) -> hdf5::Result<Self> {
        let descriptor = datatype.to_descriptor()?;
        if let TypeDescriptor::FixedUnicode(bytes) = descriptor {
            return Ok(Self::Text(bytes));
        }
        let numbers = [Self::F64, Self::I64, Self::U64, Self::U32, Self::U8];
        let found = numbers.into_iter().find(|e| e.descriptor() == descriptor);
        found.ok_or_else(|| format!("unexpected type {descriptor}").into())
    }
}

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

/// How to open a file: all ranks of `comm` together with collective metadata, or this process
/// alone. Without locks, which some file systems refuse and which nobody needs here: a file has
/// its final name only when it is whole.
fn access(comm: Option<&Comm>) -> FileBuilder {
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

/// What HDF5 says, with advice where file systems without locks make it refuse.
fn explain(error: &hdf5::Error) -> String {
    let text = error.to_string();
    if text.contains("lock") {
        format!("{text} (this file system refuses locks: set HDF5_USE_FILE_LOCKING=FALSE)")
    } else {
        text
    }
}
