//! The one gate through which bytes of untrusted files come in.
//!
//! HDF5 fills a buffer with as much as a file declares, follows links into other files and devices,
//! and unpacks compressed data. So nothing is read but here, and the gate accepts what
//! [`super::Writer`] makes and nothing else: objects behind hard links, datasets that lie in one
//! piece within the file, values of this machine's own types (so that nothing is converted), and
//! attributes of one value. Type, shape and offset are compared with the length of the file before
//! memory is taken.

use std::ffi::{CString, c_int};
use std::path::Path;

use hdf5::{Dataset, Dataspace, Datatype, File, Group, Location};
use hdf5_sys::h5a::{H5Aexists, H5Aread};
use hdf5_sys::h5d::H5D_layout_t;
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5l::H5L_info1_t;
use hdf5_sys::h5p::{H5P_DEFAULT, H5Pget_external_count, H5Pget_layout, H5Pget_nfilters};
use hdf5_sys::h5t::{H5T_class_t, H5Tget_class, H5Tis_variable_str};

use crate::output::{Block, OutputError, files, on_root, partitions};
use comm::Comm;

use super::together::open_together;
use super::transfer::{call, read_rows};
use super::{Element, Number, RowType, access, explain};

/// Longest text in an attribute (bytes): names of a million bodies.
const LONGEST_NOTE: usize = 64 << 20;
/// Members of a group that is listed; a snapshot of all fields has a fifth of them.
const MOST_MEMBERS: usize = 256;
/// Values in a row: those of a tensor.
const MOST_COMPONENTS: usize = 9;

/// A file open for reading.
#[derive(Debug)]
pub(super) struct Gate {
    file: File,
    /// Its length.
    bytes: u64,
}

impl Gate {
    /// Opens a file, by this process alone or by all ranks of `comm` together: rank 0 checks that it
    /// exists and gives its length to all.
    ///
    /// # Errors
    /// [`OutputError::Io`] or [`OutputError::Hdf5`], the same on every rank.
    pub fn open(comm: Option<&Comm>, path: &Path) -> Result<Self, OutputError> {
        let alone = Comm::solo();
        let ranks = comm.unwrap_or(&alone);
        let mut bytes = [0];
        // The system's message ("no such file") is clearer than HDF5's.
        on_root(ranks, || {
            bytes[0] = files::length_of_regular("open", path)?;
            Ok(())
        })?;
        ranks.max_u64(&mut bytes);
        let open = || {
            access(comm).open(path).map_err(|e| OutputError::Hdf5 {
                action: "open as HDF5".to_owned(),
                path: path.to_owned(),
                reason: explain(&e),
            })
        };
        let (file, _) = open_together(ranks, path, false, open)?;
        Ok(Self {
            file,
            bytes: bytes[0],
        })
    }

    /// Returns true if there is a link of this name in the root group.
    pub fn has(&self, name: &str) -> bool {
        self.file.link_exists(name)
    }

    /// A group.
    pub fn group(&self, path: &str) -> hdf5::Result<Group> {
        let mut group = self.file.group("/")?;
        for name in names(path) {
            group = own_link(&group, name)?.group(name)?;
        }
        Ok(group)
    }

    /// The names in a group, in alphabetical order.
    pub fn members(&self, group: &str) -> hdf5::Result<Vec<String>> {
        let mut names = Vec::new();
        self.group(group)?.iter_visit_default(|name, _| {
            if names.len() == MOST_MEMBERS {
                return Err(format!("it has more than {MOST_MEMBERS} members").into());
            }
            names.push(name.to_owned());
            Ok(())
        })?;
        names.sort();
        Ok(names)
    }

    /// A dataset of numbers: of rank 1, or of rank 2 with the components of a field.
    pub fn numbers(&self, path: &str) -> hdf5::Result<Located> {
        let dataset = self.dataset(path)?;
        let (rows, components) = match dataset.shape()[..] {
            [rows] => (rows, 1),
            [rows, components @ 1..=MOST_COMPONENTS] => (rows, components),
            ref shape => return Err(format!("unexpected shape {shape:?}").into()),
        };
        let row = RowType {
            element: number_of(&dataset.dtype()?)?,
            components,
        };
        self.within(dataset, row, rows)
    }

    /// Number of partitions of a grid, if they are those of this many points. Rows are in one array
    /// all the same, so that readers of rows need not know which partition a row is in.
    pub fn partitions(&self, grid: &str, points: u64) -> hdf5::Result<u64> {
        let dataset = self.numbers(&format!("{grid}/NumberOfPoints"))?;
        if dataset.row != RowType::single(Element::I64) {
            return Err("its rows are not of one i64 each".into());
        }
        partitions::check_count(dataset.rows)?;
        let mut sizes = vec![0_i64; dataset.count()];
        let all = Block::even(dataset.rows, 0, 1);
        dataset.read(all, bytemuck::cast_slice_mut(&mut sizes))?;
        partitions::check(&sizes, points)?;
        Ok(dataset.rows)
    }

    /// All of a dataset of one text, without the zeros at its end.
    pub fn text(&self, path: &str) -> hdf5::Result<Vec<u8>> {
        let dataset = self.dataset(path)?;
        let length = text_length(&dataset.dtype()?)?;
        require_one(&dataset.space()?)?;
        if dataset.ndim() != 1 {
            return Err("it is no text as the program writes".into());
        }
        let row = RowType::single(Element::Text(length));
        let rows = self.within(dataset, row, 1)?;
        Ok(without_padding(rows.bytes(Block::even(1, 0, 1))?))
    }

    /// A dataset behind hard links that lies in one piece. A virtual one opens other files when it
    /// is asked for its shape, so this comes first.
    fn dataset(&self, path: &str) -> hdf5::Result<Dataset> {
        let (parent, name) = path.rsplit_once('/').unwrap_or(("", path));
        let group = self.group(parent)?;
        let dataset = own_link(&group, name)?.dataset(name)?;
        let made = dataset.create_plist()?;
        // SAFETY: the property list is open and is one of a dataset's creation.
        let (layout, filters, files) = hdf5::sync::sync(|| unsafe {
            (
                H5Pget_layout(made.id()),
                H5Pget_nfilters(made.id()),
                H5Pget_external_count(made.id()),
            )
        });
        let plain = match layout {
            H5D_layout_t::H5D_CONTIGUOUS => filters == 0 && files == 0,
            // Datasets without rows are written so.
            H5D_layout_t::H5D_CHUNKED => filters == 0 && dataset.size() == 0,
            _ => false,
        };
        if plain {
            Ok(dataset)
        } else {
            Err(
                "it is not stored in one piece, plain and in this file, as the program writes"
                    .into(),
            )
        }
    }

    /// The rows, if they lie within the file.
    fn within(&self, dataset: Dataset, row: RowType, rows: usize) -> hdf5::Result<Located> {
        let rows = rows as u64;
        let length = rows.checked_mul(row.bytes() as u64);
        let end = length.and_then(|length| match dataset.offset() {
            _ if length == 0 => Some(0),
            Some(first) => first.checked_add(length),
            None => None,
        });
        if end.is_none_or(|end| end > self.bytes) {
            return Err(format!("{rows} rows are more than the file holds").into());
        }
        Ok(Located { dataset, row, rows })
    }
}

/// A dataset that lies within its file.
pub(super) struct Located {
    dataset: Dataset,
    pub row: RowType,
    pub rows: u64,
}

impl Located {
    /// Number of rows, which fit an address since they fit the file.
    pub fn count(&self) -> usize {
        usize::try_from(self.rows).unwrap_or(usize::MAX)
    }

    /// Reads a block of rows into `bytes`, which is as long.
    pub fn read(&self, block: Block, bytes: &mut [u8]) -> hdf5::Result<()> {
        self.require(block)?;
        read_rows(&self.dataset, self.row, block, bytes)
    }

    /// Reads a block of rows.
    pub fn bytes(&self, block: Block) -> hdf5::Result<Vec<u8>> {
        self.require(block)?;
        let mut bytes = vec![0; block.count * self.row.bytes()];
        read_rows(&self.dataset, self.row, block, &mut bytes)?;
        Ok(bytes)
    }

    fn require(&self, block: Block) -> hdf5::Result<()> {
        let end = block.first.checked_add(block.count as u64);
        if end.is_none_or(|end| end > self.rows) {
            return Err(format!("it has {} rows only", self.rows).into());
        }
        Ok(())
    }

    /// A text attached to it; empty where there is none.
    pub fn note_if_any(&self, name: &str) -> hdf5::Result<String> {
        Ok(note_if_any(&self.dataset, name)?.unwrap_or_default())
    }

    /// A text attached to it.
    pub fn note(&self, name: &str) -> hdf5::Result<String> {
        note(&self.dataset, name)
    }
}

/// A text attached to an object, if there is one of this name.
pub(super) fn note_if_any(object: &Location, name: &str) -> hdf5::Result<Option<String>> {
    let text = CString::new(name).map_err(|e| e.to_string())?;
    // SAFETY: the object is open, and the name ends with a zero.
    let there = hdf5::sync::sync(|| unsafe { H5Aexists(object.id(), text.as_ptr()) });
    (there > 0).then(|| note(object, name)).transpose()
}

/// A text attached to an object.
pub(super) fn note(object: &Location, name: &str) -> hdf5::Result<String> {
    let attribute = object.attr(name)?;
    let datatype = attribute.dtype()?;
    let length = text_length(&datatype)?;
    if length > LONGEST_NOTE {
        return Err(format!("a text of {length} bytes is too long").into());
    }
    require_one(&attribute.space()?)?;
    let mut bytes = vec![0_u8; length];
    // SAFETY: the attribute has one value, and the buffer is as long as its type.
    call(|| unsafe { H5Aread(attribute.id(), datatype.id(), bytes.as_mut_ptr().cast()) })?;
    String::from_utf8(without_padding(bytes)).map_err(|e| e.to_string().into())
}

/// A number attached to an object.
pub(super) fn number<T: Number>(object: &Location, name: &str) -> hdf5::Result<T> {
    let attribute = object.attr(name)?;
    let datatype = attribute.dtype()?;
    if number_of(&datatype)? != T::ELEMENT {
        return Err(format!("it is no {}", T::ELEMENT.name()).into());
    }
    require_one(&attribute.space()?)?;
    let mut value = T::zeroed();
    let bytes = bytemuck::bytes_of_mut(&mut value);
    // SAFETY: the attribute has one value, and the type is that of `value`.
    call(|| unsafe { H5Aread(attribute.id(), datatype.id(), bytes.as_mut_ptr().cast()) })?;
    Ok(value)
}

fn names(path: &str) -> impl Iterator<Item = &str> {
    path.split('/').filter(|name| !name.is_empty())
}

/// The group, if a hard link of it has this name: other links lead to objects of any name and into
/// other files.
fn own_link<'a>(group: &'a Group, name: &str) -> hdf5::Result<&'a Group> {
    #[allow(deprecated, reason = "the call that all versions of HDF5 have")]
    use hdf5_sys::h5l::H5Lget_info1;

    const HARD: c_int = 0;
    let text = CString::new(name).map_err(|e| e.to_string())?;
    let mut link = H5L_info1_t::default();
    // SAFETY: the group is open, the name ends with a zero, and the record is the call's own.
    call(|| unsafe { H5Lget_info1(group.id(), text.as_ptr(), &raw mut link, H5P_DEFAULT) })?;
    // SAFETY: the type is a C enumeration and comes first; a file may hold types that the Rust one
    // does not name.
    let link_type = unsafe { (&raw const link).cast::<c_int>().read() };
    if link_type == HARD {
        Ok(group)
    } else {
        Err(format!("{name} is a link to another place").into())
    }
}

/// The number that a type is, exactly.
fn number_of(datatype: &Datatype) -> hdf5::Result<Element> {
    for element in Element::NUMBERS {
        if *datatype == element.datatype()? {
            return Ok(element);
        }
    }
    let names = Element::NUMBERS.map(Element::name).join(", ");
    Err(format!("its values are none of {names}").into())
}

/// Bytes of a type of text of fixed length.
fn text_length(datatype: &Datatype) -> hdf5::Result<usize> {
    let id: hid_t = datatype.id();
    // SAFETY: the type is open.
    let plain = hdf5::sync::sync(|| unsafe {
        H5Tget_class(id) == H5T_class_t::H5T_STRING && H5Tis_variable_str(id) == 0
    });
    match datatype.size() {
        length @ 1.. if plain => Ok(length),
        _ => Err("it is no text of fixed length".into()),
    }
}

/// Refuses a space of none or of many values.
fn require_one(space: &Dataspace) -> hdf5::Result<()> {
    let shape = space.shape();
    if space.is_null() || shape.iter().any(|&n| n != 1) {
        return Err(format!("it is no single value: its shape is {shape:?}").into());
    }
    Ok(())
}

fn without_padding(mut bytes: Vec<u8>) -> Vec<u8> {
    let end = bytes.iter().rposition(|&byte| byte != 0);
    bytes.truncate(end.map_or(0, |last| last + 1));
    bytes
}
