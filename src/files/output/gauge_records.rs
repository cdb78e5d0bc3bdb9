//! Readings of many gauges: HDF5 tables of a few megabytes each, one after the other.
//!
//! A file `gauges/step-NNNNNNNN.h5` holds all readings after those of the file before it, up to that
//! step. It is whole or absent, and one ends with each checkpoint, so that a restart drops the later
//! files and nothing within one.

use std::path::PathBuf;

use super::binary_table::{self, BinaryTable, Cells};
use super::{Column, OutputError, RunFolder, Sheet};

/// Gauges from which on their readings go into such files, in place of `gauges.csv`.
pub const MANY: usize = 101;

/// Numbers that wait in memory until they are written: 16 MB.
const WAITING: usize = 2 << 20;

/// Readings on their way to files; rank 0's alone.
#[derive(Debug)]
pub struct GaugeRecords {
    folder: RunFolder,
    columns: Vec<Column>,
    gauges: Vec<String>,
    steps: Vec<u64>,
    times: Vec<f64>,
    /// Gauge of each row.
    rows: Vec<u32>,
    /// The other columns.
    numbers: Vec<Vec<f64>>,
}

impl GaugeRecords {
    /// For named gauges; the columns are step, time, gauge and numbers.
    #[must_use]
    pub fn new(folder: &RunFolder, columns: Vec<Column>, gauges: Vec<String>) -> Self {
        Self {
            folder: folder.clone(),
            numbers: vec![Vec::new(); columns.len().saturating_sub(3)],
            columns,
            gauges,
            steps: Vec::new(),
            times: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// Adds the readings of a gauge at a step and a time (s).
    pub fn add(&mut self, step: u64, time: f64, gauge: u32, numbers: impl Iterator<Item = f64>) {
        self.steps.push(step);
        self.times.push(time);
        self.rows.push(gauge);
        for (column, number) in self.numbers.iter_mut().zip(numbers) {
            column.push(number);
        }
    }

    /// Writes the waiting readings if they are many.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Hdf5`].
    pub fn write_much(&mut self) -> Result<(), OutputError> {
        if self.rows.len() * self.columns.len() < WAITING {
            return Ok(());
        }
        self.write()
    }

    /// Writes all waiting readings.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Hdf5`].
    pub fn write(&mut self) -> Result<(), OutputError> {
        let Some(&last) = self.steps.last() else {
            return Ok(());
        };
        let mut cells = vec![
            Cells::Counts(std::mem::take(&mut self.steps)),
            Cells::Reals(std::mem::take(&mut self.times)),
            Cells::Words(std::mem::take(&mut self.rows)),
        ];
        cells.extend(
            self.numbers
                .iter_mut()
                .map(|n| Cells::Reals(std::mem::take(n))),
        );
        let path = self.folder.gauge_record(last);
        self.folder.list(&path)?;
        binary_table::write(&path, &self.columns, &cells, &self.gauges)
    }
}

/// All readings of a run with many gauges, in the form of `gauges.csv`; of the gauges `only`, if these are
/// given. `None` if there are no such files.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Hdf5`], [`OutputError::Damaged`].
pub fn sheet(folder: &RunFolder, only: Option<&[String]>) -> Result<Option<Sheet>, OutputError> {
    let mut all: Option<Sheet> = None;
    for path in files(folder)? {
        let table = BinaryTable::open(&path)?;
        let sheet = table.sheet(0..table.rows(), only)?;
        match &mut all {
            None => all = Some(sheet),
            Some(all) if all.names == sheet.names => all.rows.extend(sheet.rows),
            Some(_) => {
                let reason = "its columns are others than those of the file before".to_owned();
                return Err(OutputError::damaged(&path, reason));
            }
        }
    }
    Ok(all)
}

/// The last rows: those of all gauges at the last time.
///
/// # Errors
/// As [`sheet`].
pub fn last_rows(folder: &RunFolder) -> Result<Option<Sheet>, OutputError> {
    let Some(path) = files(folder)?.pop() else {
        return Ok(None);
    };
    let table = BinaryTable::open(&path)?;
    let first = table.rows().saturating_sub(table.words().len() as u64);
    table.sheet(first..table.rows(), None).map(Some)
}

fn files(folder: &RunFolder) -> Result<Vec<PathBuf>, OutputError> {
    let found = folder.gauge_files()?.into_iter();
    Ok(found.map(|(_, path)| path).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_come_back_in_order_from_several_files() {
        let root = tempfile::tempdir().unwrap();
        let folder = RunFolder::at(root.path());
        assert_eq!(sheet(&folder, None).unwrap(), None);
        let names = ["step", "time", "gauge", "coverage", "pressure"];
        let columns = names.map(|name| Column::new(name, "")).to_vec();
        let gauges = ["front", "rear"].map(str::to_owned);
        let mut records = GaugeRecords::new(&folder, columns, gauges.to_vec());
        records.write().unwrap();
        for step in 0..7_u32 {
            let time = 0.5 * f64::from(step);
            for gauge in 0..2 {
                let numbers = [1.0, f64::from(10 * step + gauge)];
                records.add(step.into(), time, gauge, numbers.into_iter());
            }
            records.write_much().unwrap();
            if step == 3 {
                records.write().unwrap();
            }
        }
        assert_eq!(folder.gauge_files().unwrap().len(), 1);
        records.write().unwrap();
        let steps = folder.gauge_files().unwrap().into_iter().map(|file| file.0);
        assert_eq!(steps.collect::<Vec<_>>(), [3, 6]);
        let all = sheet(&folder, None).unwrap().unwrap();
        assert_eq!(all.rows.len(), 14);
        assert_eq!(all.rows[9].1, ["4", "2.0", "rear", "1.0", "41.0"]);
        let rear = sheet(&folder, Some(&gauges[1..])).unwrap().unwrap();
        assert!(rear.rows.len() == 7 && rear.rows[6].1[4] == "61.0");
        let last = last_rows(&folder).unwrap().unwrap();
        assert_eq!(last.rows.len(), 2);
        assert_eq!(last.rows[1].1[4], "61.0");
    }
}
