//! Tables of comma-separated values: a run's histories, or measured points.

use std::path::Path;

use crate::PlotError;
use results::{Opener, Sheet, regular};

/// Longest file that is read as a table (bytes).
const LONGEST: u64 = 4_000_000_000;

/// A table in columns of numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    names: Vec<String>,
    /// SI units of the columns; empty for none or where the table does not say.
    units: Vec<String>,
    /// Number in the file and cells of each row.
    rows: Vec<(usize, Vec<String>)>,
}

impl Table {
    /// Reads a table: lines of `#` are comments, of which `# units: s,m,-` gives the units; the
    /// first other line names the columns.
    ///
    /// # Errors
    /// [`PlotError::Table`] if the file cannot be read or is no table.
    pub fn read(path: &Path) -> Result<Self, PlotError> {
        let content = regular::content(path, LONGEST, "a table");
        let content = content.map_err(|e| wrong(path, e.to_string()))?;
        let text = String::from_utf8(content).map_err(|e| wrong(path, e.to_string()))?;
        Self::parse(&text).map_err(|reason| wrong(path, reason))
    }

    /// Reads a table, of which the rows of some gauges alone count if any are named; of a folder what many
    /// gauges have read.
    ///
    /// # Errors
    /// As [`Self::read`], and for gauges that it does not know.
    pub fn read_of(opener: &dyn Opener, path: &Path, gauges: &[String]) -> Result<Self, PlotError> {
        let failed = |reason: String| wrong(path, reason);
        let only = (!gauges.is_empty()).then_some(gauges);
        let mut table = if path.is_dir() {
            let read = opener.gauges(path.parent().unwrap_or(path), only);
            let sheet = read.map_err(|e| failed(e.to_string()))?;
            let sheet = sheet.ok_or_else(|| failed("no gauges have read into it".to_owned()))?;
            Self::of(sheet)
        } else {
            Self::read(path)?
        };
        if let Some(gauges) = only {
            let at = table.index("gauge").map_err(failed)?;
            let known =
                |gauge: &&String| table.rows.iter().any(|(_, row)| row.get(at) == Some(gauge));
            if let Some(unknown) = gauges.iter().find(|gauge| !known(gauge)) {
                return Err(failed(format!("it has no gauge {unknown}")));
            }
            let is_wanted = |cell: &String| gauges.contains(cell);
            table
                .rows
                .retain(|(_, row)| row.get(at).is_some_and(is_wanted));
        }
        Ok(table)
    }

    /// Parses a table.
    ///
    /// # Errors
    /// A message with the line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let sheet = Sheet::parse(text)?.widened();
        if sheet.rows.is_empty() {
            return Err("it has no rows yet".to_owned());
        }
        Ok(Self::of(sheet))
    }

    fn of(
        Sheet {
            names, units, rows, ..
        }: Sheet,
    ) -> Self {
        Self { names, units, rows }
    }

    /// The numbers of a column; NaN for an empty cell.
    ///
    /// # Errors
    /// A message with the line.
    pub fn column(&self, name: &str) -> Result<Vec<f64>, String> {
        let at = self.index(name)?;
        let value = |(number, row): &(usize, Vec<String>)| {
            let cell = row.get(at).ok_or(format!("line {number} is cut off"))?;
            if cell.is_empty() {
                // Nothing was read there.
                return Ok(f64::NAN);
            }
            cell.parse::<f64>()
                .map_err(|_| format!("line {number}: \"{cell}\" is no number"))
        };
        self.rows.iter().map(value).collect()
    }

    /// The text of a column.
    ///
    /// # Errors
    /// A message with the line.
    pub fn texts(&self, name: &str) -> Result<Vec<&str>, String> {
        let at = self.index(name)?;
        let mut texts = Vec::with_capacity(self.rows.len());
        for (number, row) in &self.rows {
            let cell = row.get(at).ok_or(format!("line {number} is cut off"))?;
            texts.push(cell.as_str());
        }
        Ok(texts)
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// `true` if there is a column of this name.
    pub fn has(&self, name: &str) -> bool {
        self.names.iter().any(|n| n == name)
    }

    /// The SI unit of a column; empty for none.
    ///
    /// # Errors
    /// A message if there is no such column.
    pub fn unit(&self, name: &str) -> Result<&str, String> {
        Ok(&self.units[self.index(name)?])
    }

    fn index(&self, name: &str) -> Result<usize, String> {
        let index = self.names.iter().position(|n| n == name);
        index.ok_or_else(|| {
            let known = self.names.join(", ");
            format!("it has no column {name}; it has {known}")
        })
    }
}

/// The error of a table at `path`.
pub fn wrong(path: &Path, reason: String) -> PlotError {
    PlotError::Table {
        path: path.to_owned(),
        reason,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_columns_by_name() {
        let text = "# measured\n# units: -,s,m\nstep, time, front\n0,0.0,3\n\n5,1e-8,4\n";
        let table = Table::parse(text).unwrap();
        assert_eq!(table.column("time").unwrap(), [0.0, 1e-8]);
        assert_eq!(table.column("front").unwrap(), [3.0, 4.0]);
        assert_eq!(table.unit("front").unwrap(), "m");
        let bare = Table::parse("a,b\n1,2\n").unwrap();
        assert_eq!(bare.unit("b").unwrap(), "");
    }

    #[test]
    fn complaints_name_the_line_or_the_column() {
        let message = |text: &str, name: &str| {
            Table::parse(text)
                .and_then(|table| table.column(name))
                .unwrap_err()
        };
        assert!(message("time,b\n1,2\n", "c").contains("no column c; it has time, b"));
        assert!(message("time,b\n1,x\n", "b").contains("line 2: \"x\""));
        assert!(message("time,b\n1,2\n3\n", "b").contains("line 3 is cut off"));
        assert!(message("time,b\n", "b").contains("no rows"));
        assert!(message("", "b").contains("empty"));
    }
}
