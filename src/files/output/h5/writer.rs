//! A file that all ranks write together.

use std::io::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};

use hdf5::plist::dataset_create::{AllocTime, FillTime};
use hdf5::types::{FixedAscii, TypeDescriptor};
use hdf5::{Dataset, File, H5Type, Location};
use hdf5_sys::h5a::H5Awrite;
use hdf5_sys::h5f::{H5F_scope_t, H5Fflush};

use crate::output::digest::Leaves;
use crate::output::{Block, OutputError, agree, files, on_root};
use comm::{Comm, pieces};

use super::direct::Direct;
use super::pieces::{PIECE, Piece};
use super::together::{abandon, during_call, open_together};
use super::transfer::{call, write_rows};
use super::writeback::begin_writeback;
use super::{Element, RowType, access, explain};

/// Fills a buffer with a range of a block's rows.
pub type Fill<'a> = dyn Fn(Range<usize>, &mut [u8]) + 'a;

/// A new file. Every method is collective and gives all ranks the same result; after an error
/// the file is of no use and must be dropped.
pub struct Writer<'a> {
    comm: &'a Comm,
    path: PathBuf,
    /// Present until it is closed.
    file: Option<File>,
    /// Writes long rows, where the file system supports it.
    direct: Option<Direct>,
    /// The file itself, whatever becomes of its name.
    held: std::fs::File,
    /// Digests of what is written, if they are wanted.
    leaves: Option<Leaves>,
}

impl<'a> Writer<'a> {
    /// Creates a file, replacing any old one. Collective.
    ///
    /// # Errors
    /// [`OutputError::Io`] or [`OutputError::Hdf5`].
    pub fn create(comm: &'a Comm, path: &Path) -> Result<Self, OutputError> {
        Self::create_aligned(comm, path, None)
    }

    /// As [`Self::create`], where arrays begin at multiples of `alignment` bytes, if that is given.
    /// Collective.
    ///
    /// # Errors
    /// [`OutputError::Io`] or [`OutputError::Hdf5`].
    pub fn create_aligned(
        comm: &'a Comm,
        path: &Path,
        alignment: Option<u64>,
    ) -> Result<Self, OutputError> {
        // The system's messages ("permission denied", "no space left") are also clearer.
        on_root(comm, || {
            keep_room(path).map_err(OutputError::io("create", path))
        })?;
        let mut builder = access(Some(comm));
        // Texts of many bodies: records of before 1.8 hold none of 64 kB and more.
        builder.with_fapl(|list| list.libver_v18());
        if let Some(bytes) = alignment {
            // Shorter objects lie between.
            builder.with_fapl(|list| list.alignment(bytes, bytes));
        }
        let create = || {
            builder
                .create(path)
                .map_err(|e| refusal("create", path, &e))
        };
        let created = open_together(comm, path, true, create);
        if created.is_err() && comm.is_root() {
            let _ = files::remove(&room(path));
        }
        let (file, held) = created?;
        Ok(Self {
            comm,
            path: path.to_owned(),
            file: Some(file),
            direct: Direct::of(path),
            held,
            leaves: None,
        })
    }

    /// The same, with the digests of what it is given, for [`Self::close_hashed`].
    #[must_use]
    pub fn hashed(mut self) -> Self {
        self.leaves = Some(Leaves::default());
        self
    }

    /// Makes a group.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn group(&self, name: &str) -> Result<(), OutputError> {
        self.attempt(name, || self.file()?.create_group(name).map(drop))
    }

    /// Attaches a number to a group.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn number<T: H5Type>(&self, group: &str, name: &str, value: &T) -> Result<(), OutputError> {
        self.attempt(name, || {
            let attribute = self.object(group)?.new_attr::<T>().create(name)?;
            attribute.write_scalar(value)
        })
    }

    /// Attaches text to a group or dataset, as UTF-8 of fixed length.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn note(&self, object: &str, name: &str, text: &str) -> Result<(), OutputError> {
        self.attempt(name, || {
            let element = Element::Text(text.len().max(1));
            let (bytes, datatype) = (padded(text), element.datatype()?);
            let parent = self.object(object)?;
            let attribute = parent.new_attr_builder().empty_as(&datatype).create(name)?;
            // SAFETY: the buffer is as long as the type says.
            call(|| unsafe { H5Awrite(attribute.id(), datatype.id(), bytes.as_ptr().cast()) })
        })
    }

    /// Writes the two attributes by which VTK recognises its files.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn vtk_header(
        &self,
        group: &str,
        grid_type: &str,
        version: [i64; 2],
    ) -> Result<(), OutputError> {
        self.attempt("the VTK header", || {
            let parent = self.object(group)?;
            let attribute = parent.new_attr::<i64>().shape(2).create("Version")?;
            attribute.write_raw(&version)?;
            let datatype = TypeDescriptor::FixedAscii(grid_type.len());
            let attribute = parent
                .new_attr_builder()
                .empty_as(&datatype)
                .create("Type")?;
            let text = FixedAscii::<32>::from_ascii(grid_type).map_err(|e| e.to_string())?;
            attribute.as_writer().write_scalar(&text)
        })
    }

    /// Writes a dataset: `block.total` rows, of which this rank gives its block.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] or [`OutputError::Io`].
    pub fn rows(
        &mut self,
        name: &str,
        row: RowType,
        block: Block,
        bytes: &[u8],
    ) -> Result<(), OutputError> {
        let dataset = self.agreed_dataset(name, row, block.total)?;
        let offset = self.direct_offset(&dataset, row, block);
        let written = self.write(name, &dataset, row, offset, block, bytes);
        agree(self.comm, written)
    }

    /// As [`Self::rows`], of rows that `fill` makes when they are written: it takes a range of the
    /// block and a buffer for its rows.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] or [`OutputError::Io`].
    pub fn rows_of(
        &mut self,
        name: &str,
        row: RowType,
        block: Block,
        fill: &Fill,
    ) -> Result<(), OutputError> {
        let dataset = self.agreed_dataset(name, row, block.total)?;
        let offset = self.direct_offset(&dataset, row, block);
        // What has no place in the file yet is read once it is whole.
        let place = dataset.offset();
        let mut leaves = self.leaves.take();
        if let (Some(leaves), Some(place)) = (&mut leaves, place) {
            let at = |rows: u64| place + rows * row.bytes() as u64;
            let mine = at(block.first)..at(block.first + block.count as u64);
            leaves.begin(place..at(block.total), mine);
        }
        let mut piece = Piece::take();
        let mut ranges = pieces(block.count, PIECE / row.bytes());
        let written = ranges.try_for_each(|rows| {
            let bytes = &mut piece.bytes()[..rows.len() * row.bytes()];
            fill(rows.clone(), bytes);
            if let (Some(leaves), true) = (&mut leaves, place.is_some()) {
                leaves.take(bytes);
            }
            let chunk = Block {
                first: block.first + rows.start as u64,
                count: rows.len(),
                ..block
            };
            let offset = offset.map(|offset| offset + (rows.start * row.bytes()) as u64);
            self.write(name, &dataset, row, offset, chunk, bytes)
        });
        piece.keep();
        self.leaves = leaves;
        agree(self.comm, written)
    }

    /// Offset in the file of this rank's rows of a dataset, if they go there past the cache.
    fn direct_offset(&self, dataset: &Dataset, row: RowType, block: Block) -> Option<u64> {
        let takes = self.direct.is_some() && Direct::takes(block.count * row.bytes());
        let begin = takes.then(|| dataset.offset())??;
        Some(begin + block.first * row.bytes() as u64)
    }

    /// Writes some of this rank's rows of a dataset, to an offset in the file or as HDF5 does.
    fn write(
        &mut self,
        name: &str,
        dataset: &Dataset,
        row: RowType,
        offset: Option<u64>,
        block: Block,
        bytes: &[u8],
    ) -> Result<(), OutputError> {
        if let (Some(direct), Some(offset)) = (&mut self.direct, offset) {
            let written = direct.write(offset, bytes);
            return written.map_err(OutputError::io("write", &self.path));
        }
        let written = write_rows(dataset, row, block, bytes);
        if !bytes.is_empty() {
            begin_writeback(&self.held);
        }
        written.map_err(|e| self.refusal(name, &e))
    }

    /// Writes a dataset of a few numbers that all ranks have.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn numbers<T: bytemuck::Pod>(
        &mut self,
        name: &str,
        element: Element,
        values: &[T],
    ) -> Result<(), OutputError> {
        let block = Block::on_root(values.len(), self.comm);
        let bytes = bytemuck::cast_slice(&values[..block.count]);
        self.rows(name, RowType::single(element), block, bytes)
    }

    /// Writes a dataset of one text of any length that all ranks have.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`].
    pub fn text(&mut self, name: &str, text: &str) -> Result<(), OutputError> {
        let bytes = padded(text);
        let row = RowType::single(Element::Text(bytes.len()));
        let block = Block::on_root(1, self.comm);
        self.rows(name, row, block, &bytes[..block.count * bytes.len()])
    }

    /// Syncs the file and closes it.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`] or [`OutputError::Io`].
    pub fn close(mut self) -> Result<(), OutputError> {
        self.end()
    }

    /// As [`Self::close`]; gives what [`Self::hashed`] knows of the file.
    ///
    /// # Errors
    /// As [`Self::close`].
    pub fn close_hashed(mut self) -> Result<Leaves, OutputError> {
        self.end()?;
        Ok(self.leaves.take().unwrap_or_default())
    }

    fn end(&mut self) -> Result<(), OutputError> {
        let rest = self
            .direct
            .take()
            .map_or(Ok(()), |mut direct| direct.finish());
        agree(
            self.comm,
            rest.map_err(OutputError::io("write", &self.path)),
        )?;
        on_root(self.comm, || files::remove(&room(&self.path)))?;
        self.attempt("the records of", || {
            let file = self.file()?;
            // SAFETY: the file is open.
            call(|| unsafe { H5Fflush(file.id(), H5F_scope_t::H5F_SCOPE_GLOBAL) })
        })?;
        let file = self.file.take();
        let close = || file.map_or(Ok(()), File::close);
        let closed = during_call(self.comm, &self.path, &self.held, close);
        agree(
            self.comm,
            closed.map_err(|e| refusal("close", &self.path, &e)),
        )?;
        on_root(self.comm, || files::sync_file(&self.path))
    }

    fn file(&self) -> hdf5::Result<&File> {
        self.file
            .as_ref()
            .ok_or_else(|| "the file is closed".into())
    }

    fn agreed_dataset(&self, name: &str, row: RowType, rows: u64) -> Result<Dataset, OutputError> {
        let made = self.new_dataset(name, row, rows);
        agree(self.comm, made.map_err(|e| self.refusal(name, &e)))
    }

    fn new_dataset(&self, name: &str, row: RowType, rows: u64) -> hdf5::Result<Dataset> {
        self.file()?
            .new_dataset_builder()
            .empty_as(&row.element.datatype()?)
            .shape(row.shape(rows))
            .alloc_time(Some(AllocTime::Early))
            .fill_time(FillTime::Never)
            .obj_track_times(false)
            .create(name)
    }

    /// A dataset or group, which holds attributes.
    fn object(&self, name: &str) -> hdf5::Result<Location> {
        let file = self.file()?;
        match file.group(name) {
            Ok(group) => group.as_location(),
            Err(_) => file.dataset(name)?.as_location(),
        }
    }

    fn attempt(
        &self,
        what: &str,
        task: impl FnOnce() -> hdf5::Result<()>,
    ) -> Result<(), OutputError> {
        agree(self.comm, task().map_err(|e| self.refusal(what, &e)))
    }

    /// The error of a failed write. HDF5 gives no cause; a write without it may show one.
    fn refusal(&self, what: &str, error: &hdf5::Error) -> OutputError {
        let mut reason = explain(error);
        let probe = self
            .path
            .with_extension(format!("probe{}", self.comm.rank()));
        if let Err(cause) = std::fs::write(&probe, vec![0; 64 << 10]) {
            reason = format!("{cause} ({reason})");
        }
        let _ = files::remove(&probe);
        OutputError::Hdf5 {
            action: format!("write {what} to"),
            path: self.path.clone(),
            reason,
        }
    }
}

impl Drop for Writer<'_> {
    /// Frees the disk space of a file after an error, but leaves it open on all ranks. HDF5 may
    /// not be able to write its records, and then crashes, at once or when MPI and with it HDF5 is
    /// finalised: so no rank closes the file, and the job must end without finalising MPI, see
    /// [`abandoned`](super::abandoned).
    fn drop(&mut self) {
        let Some(file) = self.file.take() else { return };
        self.direct = None;
        if self.comm.is_root() {
            let _ = files::remove(&room(&self.path));
            let _ = self.held.set_len(0);
        }
        abandon(self.comm, Some(file));
    }
}

/// Bytes that HDF5's own records of one of our files need at most.
const RECORDS: usize = 256 << 10;

/// The file that reserves those bytes.
fn room(path: &Path) -> PathBuf {
    files::partial(path)
}

/// Makes an empty file, and beside it one that reserves space for HDF5's records until all data are
/// written. A full disk then shows with the data, whose errors each rank sees and ranks can agree
/// on; an error in the records would leave ranks in a collective call for ever.
fn keep_room(path: &Path) -> std::io::Result<()> {
    std::fs::File::create(path)?;
    let mut file = std::fs::File::create(room(path))?;
    file.write_all(&vec![0; RECORDS])?;
    file.sync_all()
}

fn refusal(action: &str, path: &Path, error: &hdf5::Error) -> OutputError {
    OutputError::Hdf5 {
        action: action.to_owned(),
        path: path.to_owned(),
        reason: explain(error),
    }
}

/// Text for a type of fixed length, which cannot be empty.
fn padded(text: &str) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    if bytes.is_empty() {
        bytes.push(0);
    }
    bytes
}
