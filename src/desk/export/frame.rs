//! A snapshot as it is exported.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::ExportError;
use super::column::{Column, Source, columns};
use super::images::{Images, flips};
use super::start::Start;
use super::values::Values;
use files::FileOpener;
use files::output::Block;
use files::output::h5::Content;
use files::output::h5::RowType;
use model::Axis;
use plot::{Drawn, PlotError, Snapshot};

/// Rows in memory at a time.
const PIECE: usize = 1 << 17;

/// The columns and particles to be exported.
#[derive(Debug, Clone, Default)]
pub struct Wish {
    /// Names of fields; all that the snapshot holds if there are none.
    pub fields: Vec<String>,
    /// Names of bodies; all if there are none.
    pub bodies: Vec<String>,
    /// `true` if images behind symmetry planes are added.
    pub mirror: bool,
    /// Edge of the cells that surfaces are found in (m); half the finest spacing if it is not said.
    pub cell: Option<f64>,
}

/// Some rows of a snapshot, or their images.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Piece {
    pub rows: Range<usize>,
    /// See [`Images`].
    pub image: u8,
}

/// A snapshot and its columns.
#[derive(Debug)]
pub struct Frame {
    pub path: PathBuf,
    pub snapshot: Snapshot,
    /// Number of the step, if it is stored.
    pub step: Option<u64>,
    pub position: Column,
    /// All columns beside the position; first `id`, `body` and, with images, `image`.
    pub columns: Vec<Column>,
    pub images: Images,
    /// Difference between the ids of a particle and of its images, for formats with unique ids.
    pub apart: i64,
    content: Content,
    start: Option<Start>,
    /// Rows of the bodies that are wanted, in pieces.
    ranges: Vec<Range<usize>>,
}

impl Frame {
    /// Opens a snapshot.
    pub fn open(path: &Path, wish: &Wish) -> Result<Self, ExportError> {
        let snapshot = Snapshot::open(&FileOpener, path)?;
        let content = Content::open(path)?;
        let images = Images::new(&snapshot.symmetry, wish.mirror);
        let mut columns = columns(&snapshot, &content, &wish.fields)?;
        if images.any() {
            let first = |column: &Column| ["id", "body"].contains(&column.name.as_str());
            let slot = columns.iter().take_while(|column| first(column)).count();
            columns.insert(slot, Column::image());
        }
        let moves = |column: &Column| matches!(column.source, Source::Displacement);
        let start = columns.iter().any(moves).then(|| Start::beside(path));
        Ok(Self {
            start: start.transpose()?,
            step: snapshot.file.number("/whipple", "step").ok(),
            position: Column::positions(&content)?,
            ranges: ranges(&snapshot, &wish.bodies)?,
            path: path.to_owned(),
            snapshot,
            columns,
            apart: 0,
            images,
            content,
        })
    }

    /// Rows of all pieces.
    pub fn rows(&self) -> u64 {
        let rows: usize = self.ranges.iter().map(ExactSizeIterator::len).sum();
        rows as u64 * self.images.numbers().len() as u64
    }

    /// All rows in pieces: those of the snapshot, then those of each image.
    pub fn pieces(&self) -> impl Iterator<Item = Piece> {
        let images = self.images.numbers().iter();
        images.flat_map(|&image| {
            let rows = self.ranges.iter().cloned();
            rows.map(move |rows| Piece { rows, image })
        })
    }

    /// The column of a name, if there is one.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The values of a column, row after row.
    pub fn read(&self, column: &Column, piece: &Piece) -> Result<Values, ExportError> {
        let (rows, image) = (piece.rows.clone(), piece.image);
        let count = rows.len();
        let width = column.components.len();
        let mut values = match &column.source {
            Source::Position(row) => self.stored("/VTKHDF/Points", *row, rows)?,
            Source::Stored { path, row } => self.stored(path, *row, rows)?,
            Source::Image => return Ok(Values::U8(vec![image; count])),
            Source::Radius => {
                let bodies = self.snapshot.body_of(rows.clone())?;
                let sizes = self.snapshot.sizes(rows, &bodies)?;
                return Ok(Values::F64(
                    sizes.into_iter().map(|size| 0.5 * size).collect(),
                ));
            }
            Source::Displacement => Values::F64(self.displacement(rows)?),
            Source::Made(parts) => Values::F64(self.made(parts, &rows)?),
        };
        match &column.source {
            _ if image == 0 => {}
            _ if column.name == "id" => values.shift(i64::from(image) * self.apart),
            Source::Position(_) => {
                values.change(3, |axis, value| self.images.coordinate(image, axis, value));
            }
            source => {
                let turned: Vec<bool> = (0..width)
                    .map(|k| match source {
                        Source::Made(parts) => turns(&parts[k], image),
                        _ => flips(image, column.components[k]),
                    })
                    .collect();
                values.change(width, |k, value| if turned[k] { -value } else { value });
            }
        }
        Ok(values)
    }

    fn stored(&self, path: &str, row: RowType, rows: Range<usize>) -> Result<Values, ExportError> {
        let block = Block {
            total: self.snapshot.file.particles() as u64,
            first: rows.start as u64,
            count: rows.len(),
        };
        let mut values = Values::zeros(row.element, rows.len() * row.components);
        self.content.rows(path, row, block, values.bytes_mut())?;
        Ok(values)
    }

    /// Fields of plots, component by component.
    fn made(&self, parts: &[Drawn], rows: &Range<usize>) -> Result<Vec<f64>, ExportError> {
        let mut values = vec![0.0; rows.len() * parts.len()];
        for (k, part) in parts.iter().enumerate() {
            let all = part.values(&self.snapshot, rows.clone())?;
            let slots = values.iter_mut().skip(k).step_by(parts.len());
            slots.zip(all).for_each(|(slot, value)| *slot = value);
        }
        Ok(values)
    }

    fn displacement(&self, rows: Range<usize>) -> Result<Vec<f64>, ExportError> {
        let points = self.snapshot.file.points(rows.clone())?;
        let row = self.content.array(ID)?.row;
        let ids: Vec<u64> = bytemuck::pod_collect_to_vec(self.stored(ID, row, rows)?.bytes());
        let Some(start) = &self.start else {
            return Ok(vec![f64::NAN; 3 * points.len()]);
        };
        if ids.len() != points.len() {
            return Err(self.wrong("its ids are none"));
        }
        let ways = points.iter().zip(start.positions(&ids)?);
        let ways = ways.flat_map(|(now, then)| [0, 1, 2].map(|k| now[k] - then[k]));
        Ok(ways.collect())
    }

    /// The difference between the ids of images that makes all of them unique, from the last row,
    /// which has the largest id; nothing if there are no images, or no room for it.
    pub fn distance_of_ids(&self) -> Result<i64, ExportError> {
        let last = self.snapshot.file.particles();
        let (Some(id), true, 1..) = (self.column("id"), self.images.any(), last) else {
            return Ok(0);
        };
        let (rows, image) = (last - 1..last, 0);
        let largest = match self.read(id, &Piece { rows, image })? {
            Values::I64(ids) => ids[0],
            _ => -1,
        };
        let room = (0..i64::MAX / 8).contains(&largest);
        Ok(if room { largest + 1 } else { 0 })
    }

    /// Smallest and largest finite coordinates (m) of all rows, zero where there are none.
    pub fn bounds(&self) -> Result<[[f64; 2]; 3], ExportError> {
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for rows in &self.ranges {
            for point in self.snapshot.file.points(rows.clone())? {
                for (bound, x) in bounds.iter_mut().zip(point) {
                    if x.is_finite() {
                        *bound = [bound[0].min(x), bound[1].max(x)];
                    }
                }
            }
        }
        let whole = |axis: usize| {
            let own = bounds[axis];
            if own[0] > own[1] {
                return [0.0; 2];
            }
            let images = self.images.numbers().iter();
            let all = images.flat_map(|&n| own.map(|x| self.images.coordinate(n, axis, x)));
            all.fold(own, |[low, high], x| [low.min(x), high.max(x)])
        };
        Ok([whole(0), whole(1), whole(2)])
    }

    /// That a snapshot cannot be exported, and why.
    pub fn wrong(&self, reason: impl Into<String>) -> ExportError {
        ExportError::Snapshot {
            path: self.path.clone(),
            reason: reason.into(),
        }
    }
}

/// Each particle's id.
const ID: &str = "/VTKHDF/PointData/id";

/// `true` if a field of plots changes its sign in an image.
fn turns(part: &Drawn, image: u8) -> bool {
    let Drawn::Field(field) = part else {
        return false;
    };
    let behind = Axis::ALL
        .iter()
        .filter(|axis| image >> axis.index() & 1 == 1);
    behind.filter(|axis| field.flips(**axis)).count() % 2 == 1
}

/// Rows of some bodies, in pieces.
fn ranges(snapshot: &Snapshot, names: &[String]) -> Result<Vec<Range<usize>>, ExportError> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    let cut = |rows: Range<usize>| {
        let (first, end) = (rows.start, rows.end);
        let starts = (first..end).step_by(PIECE);
        starts.map(move |start| start..end.min(start + PIECE))
    };
    if names.is_empty() {
        ranges.extend(cut(0..snapshot.file.particles()));
        return Ok(ranges);
    }
    let mut wanted = vec![false; snapshot.bodies.len()];
    for name in names {
        let index = snapshot.bodies.iter().position(|body| body == name);
        let index = index.ok_or_else(|| PlotError::Body {
            name: name.clone(),
            known: snapshot.bodies.clone(),
        })?;
        wanted[index] = true;
    }
    for chunk in snapshot.chunks() {
        let bodies = snapshot.body_of(chunk.clone())?;
        let mut first = 0;
        for group in bodies.chunk_by(|a, b| wanted[*a] == wanted[*b]) {
            let rows = chunk.start + first..chunk.start + first + group.len();
            first += group.len();
            if wanted[group[0]] {
                ranges.extend(cut(rows));
            }
        }
    }
    Ok(ranges)
}
