//! The raw calls that move rows between memory and file.
//!
//! The `hdf5` crate's own writes are independent and skip the call when there are no rows, which
//! would leave the other ranks of a collective write waiting for ever.

use hdf5::{Dataset, Dataspace};
use hdf5_sys::h5::herr_t;
use hdf5_sys::h5d::{H5Dread, H5Dwrite};
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5p::{
    H5FD_mpio_xfer_t, H5P_CLS_DATASET_XFER, H5Pclose, H5Pcreate, H5Pset_dxpl_mpio,
};
use hdf5_sys::h5s::{H5S_seloper_t, H5Sselect_hyperslab, H5Sselect_none};

use crate::output::Block;

use super::RowType;

/// Largest piece of one call: MPI counts bytes in `i32` in places.
const PIECE: u64 = 1 << 30;

/// Makes one call under the library's lock and keeps its return code.
pub(super) fn call(code: impl FnOnce() -> herr_t) -> hdf5::Result<()> {
    hdf5::sync::sync(|| hdf5::h5check(code()).map(|_| ()))
}

/// How to transfer: collectively or by one process alone.
#[derive(Debug)]
pub(super) struct Transfer {
    list: hid_t,
}

impl Transfer {
    pub(super) fn new(collective: bool) -> hdf5::Result<Self> {
        hdf5::sync::sync(|| {
            // SAFETY: creates a list of a predefined class; the lock is held.
            let list = hdf5::h5check(unsafe { H5Pcreate(*H5P_CLS_DATASET_XFER) })?;
            let transfer = Self { list };
            if collective {
                let mode = H5FD_mpio_xfer_t::H5FD_MPIO_COLLECTIVE;
                // SAFETY: the list is open.
                hdf5::h5check(unsafe { H5Pset_dxpl_mpio(list, mode) })?;
            }
            Ok(transfer)
        })
    }

    /// Writes this rank's block of rows; every rank calls, with or without rows.
    pub(super) fn write(
        &self,
        dataset: &Dataset,
        row: RowType,
        block: Block,
        bytes: &[u8],
    ) -> hdf5::Result<()> {
        assert_eq!(bytes.len(), block.count * row.bytes(), "rows of the wrong length");
        let datatype = row.element.datatype()?;
        self.pieces(dataset, row, block, |memory, file, start| {
            // SAFETY: the memory space selects rows that lie in `bytes[start..]`.
            call(|| unsafe {
                let from = bytes.as_ptr().add(start).cast();
                H5Dwrite(dataset.id(), datatype.id(), memory, file, self.list, from)
            })
        })
    }

    /// Reads a block of rows into `bytes`; in a collective transfer every rank calls.
    pub(super) fn read(
        &self,
        dataset: &Dataset,
        row: RowType,
        block: Block,
        bytes: &mut [u8],
    ) -> hdf5::Result<()> {
        assert_eq!(bytes.len(), block.count * row.bytes(), "rows of the wrong length");
        let datatype = row.element.datatype()?;
        self.pieces(dataset, row, block, |memory, file, start| {
            // SAFETY: the memory space selects rows that lie in `bytes[start..]`.
            call(|| unsafe {
                let to = bytes.as_mut_ptr().add(start).cast();
                H5Dread(dataset.id(), datatype.id(), memory, file, self.list, to)
            })
        })
    }

    /// Calls `piece(memory space, file space, first byte)` for each piece of the block, as often
    /// on every rank. Goes on after an error, which other ranks may not have met.
    fn pieces(
        &self,
        dataset: &Dataset,
        row: RowType,
        block: Block,
        mut piece: impl FnMut(hid_t, hid_t, usize) -> hdf5::Result<()>,
    ) -> hdf5::Result<()> {
        let rows = usize::try_from(PIECE / row.bytes() as u64).unwrap_or(1).max(1);
        let mut result = Ok(());
        for k in 0..block.largest.div_ceil(rows).max(1) {
            let start = (k * rows).min(block.count);
            let count = rows.min(block.count - start);
            let file = dataset.space()?;
            let memory = Dataspace::try_new(row.shape(count as u64))?;
            if count == 0 {
                // SAFETY: both spaces are open.
                call(|| unsafe { H5Sselect_none(file.id()) })?;
                call(|| unsafe { H5Sselect_none(memory.id()) })?;
            } else {
                select_rows(&file, row, block.first + start as u64, count as u64)?;
            }
            result = result.and(piece(memory.id(), file.id(), start * row.bytes()));
        }
        result
    }
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

impl Drop for Transfer {
    fn drop(&mut self) {
        // SAFETY: the list is open and closed only here.
        let _ = call(|| unsafe { H5Pclose(self.list) });
    }
}
