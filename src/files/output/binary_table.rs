//! Tables as HDF5, for many rows and for programs that read them.
//!
//! The text `/columns` has the names of the columns in their order, one a line, and `/table/NAME` each
//! column, with its `unit`. Words are numbers of the lines of the text `/words`, from zero.

use std::ops::Range;
use std::path::Path;

use super::h5::{Array, Content, Element, RowType, Writer};
use super::{Block, Column, OutputError, Sheet, Value, files, publish_or_remove};
use comm::Comm;

/// The cells of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Cells {
    /// Numbers.
    Reals(Vec<f64>),
    /// Counts.
    Counts(Vec<u64>),
    /// Words by their numbers.
    Words(Vec<u32>),
}

impl Cells {
    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Reals(cells) => cells.len(),
            Self::Counts(cells) => cells.len(),
            Self::Words(cells) => cells.len(),
        }
    }

    /// Returns true if there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn element(&self) -> Element {
        match self {
            Self::Reals(_) => Element::F64,
            Self::Counts(_) => Element::U64,
            Self::Words(_) => Element::U32,
        }
    }

    fn bytes(&self) -> &[u8] {
        match self {
            Self::Reals(cells) => bytemuck::cast_slice(cells),
            Self::Counts(cells) => bytemuck::cast_slice(cells),
            Self::Words(cells) => bytemuck::cast_slice(cells),
        }
    }
}

/// The cells of rows without words, by column.
#[must_use]
pub fn by_column<'a>(columns: usize, rows: impl Iterator<Item = Vec<Value<'a>>>) -> Vec<Cells> {
    let mut all: Vec<Option<Cells>> = vec![None; columns];
    for row in rows {
        for (cells, value) in all.iter_mut().zip(row) {
            match (cells, value) {
                (Some(Cells::Counts(cells)), Value::Count(count)) => cells.push(count),
                (Some(Cells::Reals(cells)), Value::Real(real)) => cells.push(real),
                (cells, Value::Count(count)) => *cells = Some(Cells::Counts(vec![count])),
                (cells, Value::Real(real)) => *cells = Some(Cells::Reals(vec![real])),
                (_, Value::Word(_)) => {}
            }
        }
    }
    let none = || Cells::Reals(Vec::new());
    all.into_iter().map(|c| c.unwrap_or_else(none)).collect()
}

/// Writes a table, which is whole or absent, with as many cells in each column. By one process alone.
///
/// # Errors
/// [`OutputError::Io`], [`OutputError::Hdf5`].
pub fn write(
    path: &Path,
    columns: &[Column],
    cells: &[Cells],
    words: &[String],
) -> Result<(), OutputError> {
    let alone = Comm::solo();
    if let Some(folder) = path.parent() {
        files::make_folder(folder)?;
    }
    let temporary = files::partial(path);
    let written = write_file(&alone, &temporary, columns, cells, words);
    publish_or_remove(&alone, written, &temporary, || {
        files::publish(&temporary, path)
    })
}

fn write_file(
    comm: &Comm,
    path: &Path,
    columns: &[Column],
    cells: &[Cells],
    words: &[String],
) -> Result<(), OutputError> {
    let mut file = Writer::create(comm, path)?;
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    file.text("/columns", &names.join("\n"))?;
    file.text("/words", &words.join("\n"))?;
    file.group("/table")?;
    for (column, cells) in columns.iter().zip(cells) {
        let path = dataset_path(&column.name);
        let block = Block::even(cells.len() as u64, 0, 1);
        let row = RowType::single(cells.element());
        file.rows(&path, row, block, cells.bytes())?;
        if !column.unit.is_empty() {
            file.note(&path, "unit", &column.unit)?;
        }
    }
    file.close()
}

fn dataset_path(name: &str) -> String {
    format!("/table/{name}")
}

/// A binary table, open for reading.
#[derive(Debug)]
pub struct BinaryTable {
    content: Content,
    columns: Vec<Array>,
    words: Vec<String>,
    rows: u64,
}

impl BinaryTable {
    /// Opens a table, which is not trusted.
    ///
    /// # Errors
    /// [`OutputError::Io`], [`OutputError::Hdf5`], [`OutputError::Damaged`].
    pub fn open(path: &Path) -> Result<Self, OutputError> {
        let content = Content::open(path)?;
        let names = content.text("/columns")?;
        let columns = names.lines().map(|name| content.array(&dataset_path(name)));
        let columns: Vec<Array> = columns.collect::<Result<_, _>>()?;
        let words = content.text("/words")?;
        let rows = columns.first().map_or(0, |column| column.rows);
        let known = [Element::F64, Element::U64, Element::U32].map(RowType::single);
        if let Some(odd) = (columns.iter()).find(|c| c.rows != rows || !known.contains(&c.row)) {
            let reason = format!("column {} is not one of {rows} cells", odd.name);
            return Err(OutputError::damaged(path, reason));
        }
        Ok(Self {
            content,
            columns,
            words: words.lines().map(str::to_owned).collect(),
            rows,
        })
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// The words that its rows refer to.
    #[must_use]
    pub fn words(&self) -> &[String] {
        &self.words
    }

    /// A range of its rows as text; only those whose words are all among `only`, if that is given.
    ///
    /// # Errors
    /// [`OutputError::Hdf5`], [`OutputError::Damaged`].
    pub fn sheet(&self, rows: Range<u64>, only: Option<&[String]>) -> Result<Sheet, OutputError> {
        let block = Block {
            total: self.rows,
            first: rows.start,
            count: usize::try_from(rows.end.saturating_sub(rows.start)).unwrap_or(usize::MAX),
        };
        let mut columns = Vec::new();
        let mut kept = vec![true; block.count];
        for column in &self.columns {
            let cells = self.cells(column, block)?;
            if let (Cells::Words(numbers), Some(only)) = (&cells, only) {
                let wanted: Vec<bool> = self.words.iter().map(|w| only.contains(w)).collect();
                for (kept, &number) in kept.iter_mut().zip(numbers) {
                    *kept &= wanted.get(number as usize).is_some_and(|wanted| *wanted);
                }
            }
            columns.push(cells);
        }
        let mut sheet = Sheet {
            computed_share: None,
            names: self.columns.iter().map(|c| c.name.clone()).collect(),
            units: self.columns.iter().map(|c| c.unit.clone()).collect(),
            rows: Vec::new(),
        };
        for row in (0..block.count).filter(|&row| kept[row]) {
            let cells = columns.iter().map(|cells| match cells {
                Cells::Reals(cells) => Ok(format!("{:?}", cells[row])),
                Cells::Counts(cells) => Ok(cells[row].to_string()),
                Cells::Words(cells) => self.word(cells[row]),
            });
            let number = row + usize::try_from(rows.start).unwrap_or(0);
            sheet.rows.push((number, cells.collect::<Result<_, _>>()?));
        }
        Ok(sheet)
    }

    fn word(&self, number: u32) -> Result<String, OutputError> {
        let word = self.words.get(number as usize).cloned();
        word.ok_or_else(|| {
            let reason = format!("there is no word {number}");
            OutputError::damaged(self.content.path(), reason)
        })
    }

    fn cells(&self, column: &Array, block: Block) -> Result<Cells, OutputError> {
        let mut cells = match column.row.element {
            Element::F64 => Cells::Reals(vec![0.0; block.count]),
            Element::U64 => Cells::Counts(vec![0; block.count]),
            _ => Cells::Words(vec![0; block.count]),
        };
        let bytes = match &mut cells {
            Cells::Reals(cells) => bytemuck::cast_slice_mut(cells),
            Cells::Counts(cells) => bytemuck::cast_slice_mut(cells),
            Cells::Words(cells) => bytemuck::cast_slice_mut(cells),
        };
        let path = dataset_path(&column.name);
        self.content.rows(&path, column.row, block, bytes)?;
        Ok(cells)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns() -> Vec<Column> {
        let names = [("step", ""), ("gauge", ""), ("pressure", "Pa")];
        names.map(|(name, unit)| Column::new(name, unit)).to_vec()
    }

    #[test]
    fn a_table_comes_back_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/step-00000007.h5");
        let words = ["front".to_owned(), "rear, \"b\"".to_owned()];
        let cells = [
            Cells::Counts(vec![1, 1, 2, 2]),
            Cells::Words(vec![0, 1, 0, 1]),
            Cells::Reals(vec![1.0 / 3.0, f64::NAN, -0.0, 1e-300]),
        ];
        write(&path, &columns(), &cells, &words).unwrap();
        let table = BinaryTable::open(&path).unwrap();
        let sheet = table.sheet(0..table.rows(), None).unwrap();
        assert_eq!(sheet.names, ["step", "gauge", "pressure"]);
        assert_eq!(sheet.units, ["", "", "Pa"]);
        assert_eq!(sheet.rows[1].1, ["1", "rear, \"b\"", "NaN"]);
        assert_eq!(sheet.rows[0].1[2].parse(), Ok(1.0 / 3.0));
        let last = table.sheet(2..4, Some(&words[..1])).unwrap();
        assert_eq!(
            last.rows,
            [(2, ["2", "front", "-0.0"].map(str::to_owned).to_vec())]
        );
    }

    #[test]
    fn a_table_without_rows_is_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("empty.h5");
        let none = by_column(3, std::iter::empty());
        write(&path, &columns(), &none, &[]).unwrap();
        let table = BinaryTable::open(&path).unwrap();
        assert_eq!((table.rows(), table.words().len()), (0, 0));
        assert!(table.sheet(0..0, None).unwrap().rows.is_empty());
    }

    #[test]
    fn words_that_are_none_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("odd.h5");
        let cells = [
            Cells::Counts(vec![1]),
            Cells::Words(vec![3]),
            Cells::Reals(vec![0.0]),
        ];
        write(&path, &columns(), &cells, &["front".to_owned()]).unwrap();
        let table = BinaryTable::open(&path).unwrap();
        let error = table.sheet(0..1, None).unwrap_err();
        assert!(error.to_string().contains("no word 3"), "{error}");
    }
}
