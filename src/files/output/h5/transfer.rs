//! The raw calls that move rows between memory and file.
//!
//! Each rank moves its own contiguous block by an independent call. Collective ones do not report
//! errors reliably: in Open MPI 4.1 a full disk makes `MPI_File_write_at_all` return success on every
//! rank (its components `dynamic` and `dynamic_gen2`), or only one rank leaves it and the job hangs
//! (`vulcan`, `two_phase`, ROMIO). An independent call reports to the rank that made it.

use hdf5::{Dataset, Dataspace};
use hdf5_sys::h5::herr_t;
use hdf5_sys::h5d::{H5Dread, H5Dwrite};
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5p::H5P_DEFAULT;
use hdf5_sys::h5s::{H5S_seloper_t, H5Sselect_hyperslab};

use crate::output::Block;
use comm::pieces;

use super::RowType;

/// Largest piece of one call: some calls of MPI count bytes in `i32`.
const PIECE: usize = 1 << 30;

/// Makes one call under the library's lock and checks its return code.
pub(super) fn call(function: impl FnOnce() -> herr_t) -> hdf5::Result<()> {
    hdf5::sync::sync(|| hdf5::h5check(function()).map(|_| ()))
}

/// Writes a block of a dataset's rows.
pub(super) fn write_rows(
    dataset: &Dataset,
    row: RowType,
    block: Block,
    bytes: &[u8],
) -> hdf5::Result<()> {
    assert_eq!(
        bytes.len(),
        block.count * row.bytes(),
        "rows of the wrong length"
    );
    let datatype = row.element.datatype()?;
    in_pieces(dataset, row, block, |memory, file, start| {
        // SAFETY: the memory space has as many rows as lie in `bytes[start..]` or fewer.
        call(|| unsafe {
            let from = bytes.as_ptr().add(start).cast();
            H5Dwrite(dataset.id(), datatype.id(), memory, file, H5P_DEFAULT, from)
        })
    })
}

/// Reads a block of a dataset's rows into `bytes`, unconverted: `row` is what [`super::gate`]
/// found.
pub(super) fn read_rows(
    dataset: &Dataset,
    row: RowType,
    block: Block,
    bytes: &mut [u8],
) -> hdf5::Result<()> {
    assert_eq!(
        bytes.len(),
        block.count * row.bytes(),
        "rows of the wrong length"
    );
    let datatype = dataset.dtype()?;
    in_pieces(dataset, row, block, |memory, file, start| {
        // SAFETY: the memory space has as many rows as lie in `bytes[start..]` or fewer.
        call(|| unsafe {
            let to = bytes.as_mut_ptr().add(start).cast();
            H5Dread(dataset.id(), datatype.id(), memory, file, H5P_DEFAULT, to)
        })
    })
}

/// Calls `piece(memory space, file space, first byte)` for each piece of the block.
fn in_pieces(
    dataset: &Dataset,
    row: RowType,
    block: Block,
    mut piece: impl FnMut(hid_t, hid_t, usize) -> hdf5::Result<()>,
) -> hdf5::Result<()> {
    for segment in segments(row, block) {
        let memory = Dataspace::try_new(row.shape(segment.count))?;
        let file = dataset.space()?;
        select_rows(&file, row, segment.first, segment.count)?;
        piece(memory.id(), file.id(), segment.start)?;
    }
    Ok(())
}

/// The rows of one call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Segment {
    /// The first one in the file.
    first: u64,
    count: u64,
    /// The first byte of the block that belongs to them.
    start: usize,
}

/// The calls that a block takes.
fn segments(row: RowType, block: Block) -> impl Iterator<Item = Segment> {
    let most = (PIECE / row.bytes()).max(1);
    pieces(block.count, most).map(move |rows| Segment {
        first: block.first + rows.start as u64,
        count: rows.len() as u64,
        start: rows.start * row.bytes(),
    })
}

fn select_rows(space: &Dataspace, row: RowType, first: u64, count: u64) -> hdf5::Result<()> {
    let start = [first, 0];
    let counts = [count, row.components as u64];
    // SAFETY: the space has at most two dimensions, and as many numbers are given.
    call(|| unsafe {
        H5Sselect_hyperslab(
            space.id(),
            H5S_seloper_t::H5S_SELECT_SET,
            start.as_ptr(),
            std::ptr::null(),
            counts.as_ptr(),
            std::ptr::null(),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::h5::Element;

    #[test]
    fn blocks_of_more_than_two_thousand_million_rows_take_several_calls() {
        let tensor = RowType {
            element: Element::F64,
            components: 9,
        };
        let block = Block {
            total: 1 << 34,
            first: 1 << 33,
            count: (1 << 31) + 5,
        };
        let (mut first, mut start) = (block.first, 0);
        for segment in segments(tensor, block) {
            assert_eq!((segment.first, segment.start), (first, start));
            let bytes = segment.count * tensor.bytes() as u64;
            assert!(bytes > 0 && bytes <= PIECE as u64);
            first += segment.count;
            start += usize::try_from(bytes).unwrap();
        }
        assert_eq!(first, block.first + block.count as u64);
        assert_eq!(start, block.count * tensor.bytes());
        assert_eq!(segments(tensor, Block { count: 0, ..block }).count(), 0);
        // A row that is longer than a piece goes by itself.
        let long = RowType::single(Element::Text(3 << 30));
        assert_eq!(segments(long, Block::even(2, 0, 1)).count(), 2);
    }
}
