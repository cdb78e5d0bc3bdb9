//! The raw calls that move rows between memory and file.
//!
//! Each rank moves its own contiguous block by an independent call. Collective ones are not to
//! be trusted with results: in Open MPI 4.1 a full disk makes `MPI_File_write_at_all` return
//! success on every rank (its parts `dynamic` and `dynamic_gen2`), or only one rank leaves it and
//! the job hangs (`vulcan`, `two_phase`, ROMIO). An independent call tells the rank that made it.

use hdf5::{Dataset, Dataspace};
use hdf5_sys::h5::herr_t;
use hdf5_sys::h5d::{H5Dread, H5Dwrite};
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5p::H5P_DEFAULT;
use hdf5_sys::h5s::{H5S_seloper_t, H5Sselect_hyperslab};

use crate::output::Block;

use super::RowType;

/// Largest piece of one call: MPI counts bytes in `i32` in places.
const PIECE: usize = 1 << 30;

/// Makes one call under the library's lock and keeps its return code.
pub(super) fn call(code: impl FnOnce() -> herr_t) -> hdf5::Result<()> {
    hdf5::sync::sync(|| hdf5::h5check(code()).map(|_| ()))
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
    let most = (PIECE / row.bytes()).max(1);
    for start in (0..block.count).step_by(most) {
        let count = most.min(block.count - start) as u64;
        let memory = Dataspace::try_new(row.shape(count))?;
        let file = dataset.space()?;
        select_rows(&file, row, block.first + start as u64, count)?;
        piece(memory.id(), file.id(), start * row.bytes())?;
    }
    Ok(())
}

fn select_rows(space: &Dataspace, row: RowType, first: u64, count: u64) -> hdf5::Result<()> {
    let start = [first, 0];
    let counts = [count, row.components as u64];
    // SAFETY: the space has at most two dimensions, and so many numbers are given.
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
