//! Changes of a sound HDF5 file into one that no run writes, as data: a file is told by a line.

use std::fs;
use std::path::Path;

use hdf5::dataset::Layout;
use hdf5::types::{CompoundField, CompoundType, FloatSize, IntSize, TypeDescriptor};
use hdf5::{Extents, File, Location};
use hdf5_sys::h5a::H5Awrite;
use hdf5_sys::h5d::H5Dwrite;
use hdf5_sys::h5p::H5P_DEFAULT;
use hdf5_sys::h5s::H5S_ALL;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// A type of values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    F64,
    I64,
    U64,
    U32,
    U8,
    F32,
    I16,
    Bool,
    /// UTF-8 of so many bytes.
    Text(usize),
    /// ASCII of so many bytes.
    Ascii(usize),
    /// Text that lies elsewhere in the file.
    LooseText,
    /// Lists that lie elsewhere in the file.
    LooseList,
    /// So many numbers as one value.
    Array(usize),
    /// Records in records, so deep.
    Record(usize),
}

/// The shape of an attribute or a dataset.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// No values.
    Null,
    /// One value, without dimensions.
    Scalar,
    /// Dimensions.
    Of(Vec<usize>),
}

/// Where a dataset's values lie.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Store {
    /// In one piece.
    Plain,
    /// In one piece that is written never.
    Empty,
    /// In the dataset's own record.
    Compact,
    /// In pieces.
    Chunked,
    /// Compressed.
    Packed,
    /// In another file.
    External,
    /// In datasets of other files.
    Virtual,
}

/// One change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// Another attribute in place of one.
    Note(String, String, Kind, Shape),
    /// An attribute of one text.
    Say(String, String, String),
    /// An attribute less.
    Silence(String, String),
    /// Another dataset in place of one.
    Data(String, Kind, Shape, Store),
    /// A group in place of a dataset.
    Group(String),
    /// An object less.
    Unlink(String),
    /// Another name.
    Rename(String, String),
    /// A link of this file by name.
    Soft(String, String),
    /// A second link to an object.
    Hard(String, String),
    /// A link into another file.
    Outside(String, String),
    /// So many groups in a group.
    Crowd(String, usize),
    /// Other bits of a value.
    Value(String, usize, u64),
    /// A part of a text replaced; the place counts round.
    Text(String, usize, usize, String),
    /// A value of the manifest.
    Manifest(String, serde_json::Value),
    /// The manifest ends there.
    Cut(usize),
    /// The file ends there, or goes on with zeros.
    Length(u64),
}

/// Largest dataset or attribute whose values are written (bytes).
const MOST_WRITTEN: usize = 1 << 20;

impl Kind {
    fn descriptor(self) -> TypeDescriptor {
        let number = TypeDescriptor::Float(FloatSize::U8);
        match self {
            Self::I64 => TypeDescriptor::Integer(IntSize::U8),
            Self::U64 => TypeDescriptor::Unsigned(IntSize::U8),
            Self::U32 => TypeDescriptor::Unsigned(IntSize::U4),
            Self::U8 => TypeDescriptor::Unsigned(IntSize::U1),
            Self::F32 => TypeDescriptor::Float(FloatSize::U4),
            Self::I16 => TypeDescriptor::Integer(IntSize::U2),
            Self::Bool => TypeDescriptor::Boolean,
            Self::Text(bytes) => TypeDescriptor::FixedUnicode(bytes),
            Self::Ascii(bytes) => TypeDescriptor::FixedAscii(bytes),
            Self::LooseText => TypeDescriptor::VarLenUnicode,
            Self::LooseList => TypeDescriptor::VarLenArray(Box::new(number)),
            Self::Array(length) => TypeDescriptor::FixedArray(Box::new(number), length),
            Self::F64 | Self::Record(0) => number,
            Self::Record(depth) => {
                let ty = Self::Record(depth - 1).descriptor();
                let field = CompoundField::new("x", ty, 0, 0);
                let (fields, size) = (vec![field], 8);
                TypeDescriptor::Compound(CompoundType { fields, size })
            }
        }
    }

    fn is_loose(self) -> bool {
        matches!(self, Self::LooseText | Self::LooseList)
    }
}

impl Shape {
    /// As HDF5's bindings take it, which multiply the dimensions.
    fn extents(&self) -> hdf5::Result<Extents> {
        match self {
            Self::Null => Ok(Extents::Null),
            Self::Scalar => Ok(Extents::Scalar),
            Self::Of(dimensions) => {
                let mut all = dimensions.iter();
                let values = all.try_fold(1_usize, |n, &d| n.checked_mul(d));
                values.ok_or("too many values")?;
                Ok(Extents::from(dimensions.clone()))
            }
        }
    }

    /// Bytes to write it, if these are few.
    fn pattern(&self, size: usize) -> Option<Vec<u8>> {
        let values = match self {
            Self::Null => 0,
            Self::Scalar => 1,
            Self::Of(dimensions) => {
                let all = dimensions
                    .iter()
                    .try_fold(1_usize, |n, &d| n.checked_mul(d));
                all?
            }
        };
        let bytes = values.checked_mul(size)?;
        (0 < bytes && bytes <= MOST_WRITTEN).then(|| vec![b'x'; bytes])
    }
}

impl Change {
    /// Changes a file; HDF5 refuses some.
    fn apply(&self, file: &File) -> hdf5::Result<()> {
        match self {
            Self::Note(at, name, kind, shape) => attribute(file, at, name, *kind, shape, None),
            Self::Say(at, name, text) => {
                let kind = Kind::Text(text.len().max(1));
                attribute(file, at, name, kind, &Shape::Scalar, Some(text))
            }
            Self::Silence(at, name) => object(file, at)?.delete_attr(name),
            Self::Data(at, kind, shape, particles) => dataset(file, at, *kind, shape, *particles),
            Self::Group(at) => {
                let _ = file.unlink(at);
                file.create_group(at).map(drop)
            }
            Self::Unlink(at) => file.unlink(at),
            Self::Rename(at, to) => {
                let _ = file.unlink(to);
                file.relink(at, to)
            }
            Self::Soft(at, to) => {
                let _ = file.unlink(at);
                file.link_soft(to, at)
            }
            Self::Hard(at, to) => {
                let _ = file.unlink(at);
                file.link_hard(to, at)
            }
            Self::Outside(at, other) => {
                let _ = file.unlink(at);
                file.link_external(other, at, at)
            }
            Self::Crowd(at, count) => {
                let group = file.group(at)?;
                (0..*count).try_for_each(|k| group.create_group(&format!("g{k}")).map(drop))
            }
            Self::Value(at, place, bits) => value(file, at, *place, *bits),
            Self::Text(at, place, length, by) => {
                let dataset = file.dataset(at)?;
                let mut text = match dataset.size().checked_mul(dataset.dtype()?.size()) {
                    Some(0..=MOST_WRITTEN) => read(&dataset)?,
                    _ => return Ok(()),
                };
                let from = place % text.len().max(1);
                let to = (from + length).min(text.len());
                text.splice(from..to, by.bytes());
                drop(dataset);
                file.unlink(at)?;
                let datatype = TypeDescriptor::FixedUnicode(text.len().max(1));
                let builder = file.new_dataset_builder().empty_as(&datatype);
                write(&builder.shape(1).create(at.as_str())?, &text)
            }
            Self::Manifest(..) | Self::Cut(_) | Self::Length(_) => Ok(()),
        }
    }
}

/// Changes a file and, where it is the state of a checkpoint, renews size and digests of its
/// manifest. Gives how many changes HDF5 refused.
pub fn apply(changes: &[Change], path: &Path) -> usize {
    let file = File::open_rw(path).expect("a sound file");
    let refused = changes.iter().filter(|change| change.apply(&file).is_err());
    let refused = refused.count();
    file.close().expect("it can be closed");
    for change in changes {
        if let Change::Length(length) = change {
            let file = fs::File::options().write(true).open(path).unwrap();
            file.set_len(*length).unwrap();
        }
    }
    let manifest = path.with_file_name("manifest.json");
    if let Ok(text) = fs::read_to_string(&manifest) {
        fs::write(&manifest, signed(&text, path, changes)).unwrap();
    }
    refused
}

fn signed(manifest: &str, state: &Path, changes: &[Change]) -> String {
    let state = fs::read(state).unwrap();
    let mut manifest: serde_json::Value = serde_json::from_str(manifest).unwrap();
    manifest["size"] = state.len().into();
    manifest.as_object_mut().unwrap().remove("leaf");
    manifest["sha256"] = vec![format!("{:x}", Sha256::digest(&state))].into();
    for change in changes {
        if let Change::Manifest(key, value) = change {
            manifest[key] = value.clone();
        }
    }
    let mut text = manifest.to_string();
    for change in changes {
        if let Change::Cut(length) = change {
            text.truncate(*length);
        }
    }
    text
}

fn object(file: &File, at: &str) -> hdf5::Result<Location> {
    match file.group(at) {
        Ok(group) => group.as_location(),
        Err(_) => file.dataset(at)?.as_location(),
    }
}

fn attribute(
    file: &File,
    at: &str,
    name: &str,
    kind: Kind,
    shape: &Shape,
    text: Option<&str>,
) -> hdf5::Result<()> {
    let object = object(file, at)?;
    let _ = object.delete_attr(name);
    let builder = object.new_attr_builder().empty_as(kind.descriptor());
    let attribute = builder.shape(shape.extents()?).create(name)?;
    let datatype = attribute.dtype()?;
    if kind.is_loose() {
        return Ok(());
    }
    let pattern = shape.pattern(datatype.size());
    let bytes = text.map(|text| padded(text.as_bytes())).or(pattern);
    let Some(bytes) = bytes else { return Ok(()) };
    // SAFETY: there are as many bytes as the type has in all.
    hdf5::sync::sync(|| unsafe {
        hdf5::h5check(H5Awrite(
            attribute.id(),
            datatype.id(),
            bytes.as_ptr().cast(),
        ))
        .map(drop)
    })
}

fn padded(text: &[u8]) -> Vec<u8> {
    if text.is_empty() {
        vec![0]
    } else {
        text.to_vec()
    }
}

fn dataset(file: &File, at: &str, kind: Kind, shape: &Shape, particles: Store) -> hdf5::Result<()> {
    let _ = file.unlink(at);
    let descriptor = kind.descriptor();
    let mut builder = file
        .new_dataset_builder()
        .empty_as(&descriptor)
        .shape(shape.extents()?);
    // In small pieces, so that none exists that is not written.
    let piece = match shape {
        Shape::Of(dimensions) => dimensions.iter().map(|n| (*n).clamp(1, 64)).collect(),
        _ => vec![1],
    };
    match particles {
        Store::Plain | Store::Empty => {}
        Store::Compact => builder = builder.layout(Layout::Compact),
        Store::Chunked => builder = builder.chunk(&piece[..]),
        Store::Packed => builder = builder.chunk(&piece[..]).deflate(9),
        Store::External => builder = builder.external("manifest.json", 0, 1 << 40),
        Store::Virtual => {
            let all = shape.extents()?;
            builder = builder.virtual_map("other.h5", at, all.clone(), .., all, ..);
        }
    }
    let dataset = builder.create(at)?;
    let written = matches!(
        particles,
        Store::Plain | Store::Compact | Store::Chunked | Store::Packed
    );
    match shape.pattern(dataset.dtype()?.size()) {
        Some(bytes) if written && !kind.is_loose() => write(&dataset, &bytes),
        _ => Ok(()),
    }
}

/// All of a dataset's values as they are.
fn read(dataset: &hdf5::Dataset) -> hdf5::Result<Vec<u8>> {
    let datatype = dataset.dtype()?;
    let mut bytes = vec![0; dataset.size() * datatype.size()];
    // SAFETY: the buffer is as long as all values.
    hdf5::sync::sync(|| unsafe {
        hdf5::h5check(hdf5_sys::h5d::H5Dread(
            dataset.id(),
            datatype.id(),
            H5S_ALL,
            H5S_ALL,
            H5P_DEFAULT,
            bytes.as_mut_ptr().cast(),
        ))
    })?;
    Ok(bytes)
}

fn write(dataset: &hdf5::Dataset, bytes: &[u8]) -> hdf5::Result<()> {
    let datatype = dataset.dtype()?;
    assert!(bytes.len() >= dataset.size() * datatype.size());
    // SAFETY: the buffer is as long as all values.
    hdf5::sync::sync(|| unsafe {
        hdf5::h5check(H5Dwrite(
            dataset.id(),
            datatype.id(),
            H5S_ALL,
            H5S_ALL,
            H5P_DEFAULT,
            bytes.as_ptr().cast(),
        ))
        .map(drop)
    })
}

fn value(file: &File, at: &str, place: usize, bits: u64) -> hdf5::Result<()> {
    let dataset = file.dataset(at)?;
    let size = dataset.dtype()?.size();
    let few = dataset
        .size()
        .checked_mul(size)
        .is_some_and(|n| n <= MOST_WRITTEN);
    if !few || !matches!(size, 1 | 4 | 8) || dataset.size() == 0 {
        return Ok(());
    }
    let mut bytes = read(&dataset)?;
    let first = place % dataset.size() * size;
    bytes[first..first + size].copy_from_slice(&bits.to_le_bytes()[..size]);
    write(&dataset, &bytes)
}
