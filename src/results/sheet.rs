//! Comma-separated values: lines to write, and tables read.

use std::collections::HashMap;

use csv::{Reader, ReaderBuilder, StringRecord, Trim, WriterBuilder};

/// Beginning of the line with the units of the columns.
const UNITS: &str = "# units:";
/// Beginning of the line with the share of the whole that was computed.
const SHARE: &str = "# computed_share:";
/// Beginning of a comment.
const COMMENT: u8 = b'#';

/// Values as one line with its end; those with commas, quotes or line ends are quoted.
///
/// # Panics
/// If there is no memory left.
pub fn line<T: AsRef<[u8]>>(values: impl IntoIterator<Item = T>) -> Vec<u8> {
    lines([values])
}

/// Records as lines.
///
/// # Panics
/// If there is no memory left.
pub fn lines<T: AsRef<[u8]>>(
    records: impl IntoIterator<Item = impl IntoIterator<Item = T>>,
) -> Vec<u8> {
    let mut lines = Vec::new();
    let mut writer = WriterBuilder::new()
        .comment(Some(COMMENT))
        .flexible(true)
        .from_writer(&mut lines);
    for values in records {
        writer.write_record(values).expect("memory takes it");
    }
    writer.flush().expect("memory takes it");
    drop(writer);
    lines
}

/// The line of units that a table begins with.
pub fn units_line<T: AsRef<[u8]>>(units: impl IntoIterator<Item = T>) -> Vec<u8> {
    let mut text = format!("{UNITS} ").into_bytes();
    text.extend(line(units));
    text
}

/// The line below that of a table of a whole model of which this share was computed.
#[must_use]
pub fn share_line(share: f64) -> Vec<u8> {
    format!("{SHARE} {share}\n").into_bytes()
}

/// True for such a line.
#[must_use]
pub fn is_share_line(line: &str) -> bool {
    line.starts_with(SHARE)
}

/// Reads records that all have as many values as the header.
#[must_use]
pub fn rows(content: &[u8]) -> Reader<&[u8]> {
    ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .from_reader(content)
}

/// A table read from text.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Names of the columns.
    pub names: Vec<String>,
    /// SI units of the columns; empty for none or where the table does not say.
    pub units: Vec<String>,
    /// Share of the model that was computed, of a table that reports the whole of one with symmetry planes.
    pub computed_share: Option<f64>,
    /// The number of the line that each row begins in, and its cells, without the blanks around
    /// them; a row may be cut off.
    pub rows: Vec<(usize, Vec<String>)>,
}

impl Sheet {
    /// Parses a table: lines of `#` are comments, of which `# units: s,m,-` gives the units;
    /// the first other line names the columns.
    ///
    /// # Errors
    /// A message if it is not such a table.
    pub fn parse(text: &str) -> Result<Self, String> {
        let units = text.lines().find_map(|line| line.strip_prefix(UNITS));
        let share = text.lines().find_map(|line| line.strip_prefix(SHARE));
        let share = share.and_then(|share| share.trim().parse::<f64>().ok());
        let mut records = records(text)?.into_iter();
        let (_, names) = records.next().ok_or("it is empty")?;
        let units = units.map_or_else(|| Ok(Vec::new()), records_of_line)?;
        let mut sheet = Self {
            units,
            computed_share: share.filter(|share| *share > 0.0 && *share <= 1.0),
            rows: records.collect(),
            names,
        };
        sheet.units.resize(sheet.names.len(), String::new());
        Ok(sheet)
    }

    /// Converts a table with a figure in each row (`time, measure, …, figure, value, …, unit`) to one with
    /// a row for each time and a column `MEASURE.FIGURE` for each figure; returns any other one as it is.
    #[must_use]
    pub fn widened(self) -> Self {
        let wanted = ["time", "measure", "figure", "value", "unit"];
        let indices = wanted.map(|name| self.names.iter().position(|own| own == name));
        let [
            Some(time),
            Some(measure),
            Some(figure),
            Some(value),
            Some(unit),
        ] = indices
        else {
            return self;
        };
        let mut wide = Self {
            names: vec![self.names[time].clone()],
            units: vec![self.units[time].clone()],
            computed_share: self.computed_share,
            rows: Vec::new(),
        };
        let mut columns = HashMap::new();
        for (line, cells) in &self.rows {
            if cells.len() < self.names.len() {
                continue;
            }
            let name = format!("{}.{}", cells[measure], cells[figure]);
            let at = *columns.entry(name).or_insert_with_key(|name| {
                wide.names.push(name.clone());
                wide.units.push(cells[unit].clone());
                wide.names.len() - 1
            });
            let is_new = |last: &(usize, Vec<String>)| last.1[0] != cells[time];
            if wide.rows.last().is_none_or(is_new) {
                wide.rows.push((*line, vec![cells[time].clone()]));
            }
            if let Some((_, row)) = wide.rows.last_mut() {
                row.resize(row.len().max(at + 1), String::new());
                row[at].clone_from(&cells[value]);
            }
        }
        let columns = wide.names.len();
        let rows = wide.rows.iter_mut();
        rows.for_each(|(_, row)| row.resize(columns, String::new()));
        wide
    }

    /// The table as a file holds it: units, names, rows.
    #[must_use]
    pub fn text(&self) -> Vec<u8> {
        let unit = |unit: &String| if unit.is_empty() { "-" } else { unit }.to_owned();
        let mut text = units_line(self.units.iter().map(unit));
        text.extend(self.computed_share.into_iter().flat_map(share_line));
        text.extend(line(&self.names));
        for (_, cells) in &self.rows {
            text.extend(line(cells));
        }
        text
    }
}

/// The only record of a line.
fn records_of_line(line: &str) -> Result<Vec<String>, String> {
    let first = records(line)?.into_iter().next();
    Ok(first.map_or_else(Vec::new, |(_, cells)| cells))
}

/// Line numbers and cells of all records that are neither comments nor blank.
fn records(text: &str) -> Result<Vec<(usize, Vec<String>)>, String> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(COMMENT))
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let mut records = Vec::new();
    let mut record = StringRecord::new();
    while (reader.read_record(&mut record)).map_err(|error| error.to_string())? {
        if record.len() == 1 && record[0].is_empty() {
            continue;
        }
        let number = record.position().map_or(0, |at| first_line(text, at));
        records.push((number, record.iter().map(str::to_owned).collect()));
    }
    Ok(records)
}

/// The line in which the next record after a position begins.
fn first_line(text: &str, at: &csv::Position) -> usize {
    let begin = usize::try_from(at.byte()).unwrap_or(usize::MAX);
    let rest = text.get(begin..).unwrap_or_default();
    let passed = |line: &&str| line.trim().is_empty() || line.as_bytes().starts_with(&[COMMENT]);
    let lines = usize::try_from(at.line()).unwrap_or(usize::MAX);
    lines + rest.lines().take_while(passed).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let values = [
            "bumper, front",
            "a \"b\"",
            "two\nlines",
            "# no comment",
            "κ",
            "",
        ];
        let mut text = units_line(["s", "kg/(m s)", "-", "-", "-", "-"]);
        text.extend(line(["a", "b", "c", "d", "e", "f"]));
        text.extend(line(values));
        text.extend(line(["1", "2", "3", "4", "5", "6"]));
        let sheet = Sheet::parse(std::str::from_utf8(&text).unwrap()).unwrap();
        assert_eq!(sheet.units, ["s", "kg/(m s)", "-", "-", "-", "-"]);
        assert_eq!(sheet.names, ["a", "b", "c", "d", "e", "f"]);
        assert_eq!(sheet.rows[0], (3, values.map(str::to_owned).to_vec()));
        assert_eq!(sheet.rows[1].0, 5);
    }

    #[test]
    fn comments_and_blank_lines_count_as_lines() {
        let text = "# measured\r\n\r\na, b\r\n# more\r\n\r\n 1 ,\"2\"\r\n  \r\n3\r\n";
        let sheet = Sheet::parse(text).unwrap();
        let rows = [(6, vec!["1", "2"]), (8, vec!["3"])];
        let rows = rows.map(|(line, cells)| (line, cells.into_iter().map(str::to_owned).collect()));
        assert_eq!(sheet.rows, rows);
        assert!(Sheet::parse("# only this\n").unwrap_err().contains("empty"));
    }

    #[test]
    fn figures_in_rows_become_columns() {
        let text = "# units: s,-,-,-,-,-\ntime,measure,kind,figure,value,unit\n\
            0,p,plate,hole,1,m\n0,p,plate,verdict,held,\n1,p,plate,hole,2,m\n1,q,bar,length,3,m\n1";
        let wide = Sheet::parse(text).unwrap().widened();
        assert_eq!(wide.names, ["time", "p.hole", "p.verdict", "q.length"]);
        assert_eq!(wide.units, ["s", "m", "", "m"]);
        let rows: Vec<_> = wide.rows.iter().map(|(_, row)| row.join("|")).collect();
        assert_eq!(rows, ["0|1|held|", "1|2||3"]);
        let other = Sheet::parse("time,a\n0,1\n").unwrap();
        assert_eq!(other.clone().widened(), other);
    }
}
