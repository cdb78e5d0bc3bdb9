//! Reading snapshots back: one VTKHDF file, opened by a single process without MPI.

use std::ops::Range;
use std::path::{Path, PathBuf};

use uuid::Uuid;

use crate::output::{Block, RunFolder};
use results::{ReadError, SnapshotReader};

use super::explain;
use super::gate::{self, Gate, Located};

/// Group of the grid.
const GRID: &str = "/VTKHDF";

/// Attribute of `/whipple` that describes the portion of the model in a snapshot, if it is not all of it.
pub const PORTION: &str = "part";

/// Attribute of `/run`: the id of the run.
pub const RUN: &str = "id";

/// An open snapshot. Rows are particles in the order of their ids.
#[derive(Debug)]
pub struct SnapshotFile {
    gate: Gate,
    path: PathBuf,
    particles: usize,
}

impl SnapshotFile {
    /// Opens a snapshot for reading.
    ///
    /// # Errors
    /// [`ReadError::Open`] if it is no HDF5 file, [`ReadError::Layout`] if it holds no points, or
    /// partitions that are not theirs; [`results::OutputError::OtherRun`] if it lies in the folder of another run.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let mut snapshot = Self {
            gate: Gate::open(None, path)?,
            path: path.to_owned(),
            particles: 0,
        };
        let points = snapshot.rows("/VTKHDF/Points")?;
        if points.row.components != 3 {
            let reason = format!("it has {} components, not 3", points.row.components);
            return Err(snapshot.layout("/VTKHDF/Points", &reason));
        }
        snapshot.particles = points.count();
        let partitions = snapshot.gate.partitions(GRID, points.rows);
        snapshot.converted(&format!("{GRID}/NumberOfPoints"), partitions)?;
        if let Some(folder) = RunFolder::of_snapshot(path) {
            folder.refuse_other(path, snapshot.run())?;
        }
        Ok(snapshot)
    }

    /// The id of the run that has written it, if it says so.
    fn run(&self) -> Option<Uuid> {
        let group = self.gate.group("/run").ok()?;
        gate::note_if_any(&group, RUN).ok()??.parse().ok()
    }

    /// The portion of the model that it holds, if it does not hold all particles.
    ///
    /// # Errors
    /// [`ReadError::Layout`] if that cannot be read.
    pub fn portion(&self) -> Result<Option<String>, ReadError> {
        let group = "/whipple";
        let portion = self
            .gate
            .group(group)
            .and_then(|g| gate::note_if_any(&g, PORTION));
        self.converted(&format!("attribute {PORTION} of {group}"), portion)
    }

    /// Some rows of a dataset, value after value.
    fn read(&self, name: &str, rows: Range<usize>) -> Result<Vec<f64>, ReadError> {
        let found = self.rows(name)?;
        let block = Block {
            total: found.rows,
            first: rows.start as u64,
            count: rows.len(),
        };
        let bytes = self.converted(name, found.bytes(block))?;
        Ok(found.row.element.reals(&bytes))
    }

    fn rows(&self, name: &str) -> Result<Located, ReadError> {
        self.converted(name, self.gate.numbers(name))
    }

    fn converted<T>(&self, what: &str, result: hdf5::Result<T>) -> Result<T, ReadError> {
        result.map_err(|e| self.layout(what, &explain(&e)))
    }

    fn layout(&self, what: &str, reason: &dyn ToString) -> ReadError {
        ReadError::Layout {
            path: self.path.clone(),
            what: what.to_owned(),
            reason: reason.to_string(),
        }
    }
}

impl SnapshotReader for SnapshotFile {
    fn path(&self) -> &Path {
        &self.path
    }

    fn particles(&self) -> usize {
        self.particles
    }

    fn time(&self) -> Result<f64, ReadError> {
        let name = "/VTKHDF/FieldData/TimeValue";
        let first = self.read(name, 0..1)?.first().copied();
        first.ok_or_else(|| self.layout(name, &"it is empty"))
    }

    fn points(&self, rows: Range<usize>) -> Result<Vec<[f64; 3]>, ReadError> {
        let flat = self.read("/VTKHDF/Points", rows)?;
        let (points, _) = flat.as_chunks::<3>();
        Ok(points.to_vec())
    }

    fn names(&self) -> Result<Vec<String>, ReadError> {
        let name = "/VTKHDF/PointData";
        self.converted(name, self.gate.members(name))
    }

    fn components(&self, field: &str) -> Result<usize, ReadError> {
        let name = field_path(field);
        let rows = self.rows(&name)?;
        if rows.count() == self.particles {
            return Ok(rows.row.components);
        }
        let (found, n) = (rows.count(), self.particles);
        let reason = format!("its {found} rows do not fit {n} particles");
        Err(self.layout(&name, &reason))
    }

    fn values(&self, field: &str, rows: Range<usize>) -> Result<Vec<f64>, ReadError> {
        self.read(&field_path(field), rows)
    }

    fn scalar(
        &self,
        field: &str,
        component: usize,
        rows: Range<usize>,
    ) -> Result<Vec<f64>, ReadError> {
        let width = self.components(field)?;
        if component >= width {
            let reason = format!("it has {width} components, {component} was asked for");
            return Err(self.layout(&field_path(field), &reason));
        }
        let mut values = self.values(field, rows)?;
        if width > 1 {
            values = values.into_iter().skip(component).step_by(width).collect();
        }
        Ok(values)
    }

    fn field_attribute(&self, field: &str, name: &str) -> Result<String, ReadError> {
        let path = field_path(field);
        let rows = self.rows(&path)?;
        self.converted(&format!("attribute {name} of {path}"), rows.note(name))
    }

    fn attribute(&self, group: &str, name: &str) -> Result<String, ReadError> {
        let text = self.gate.group(group).and_then(|g| gate::note(&g, name));
        self.converted(&format!("attribute {name} of {group}"), text)
    }

    fn number(&self, group: &str, name: &str) -> Result<u64, ReadError> {
        let number = self.gate.group(group).and_then(|g| gate::number(&g, name));
        self.converted(&format!("attribute {name} of {group}"), number)
    }
}

fn field_path(field: &str) -> String {
    format!("/VTKHDF/PointData/{field}")
}
