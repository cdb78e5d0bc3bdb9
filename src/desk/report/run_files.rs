//! The folder of a run: its texts and tables, and which of them are missing or damaged.

use std::cmp::Reverse;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use files::output::{OutputError, RunFolder, Sheet, Status, read_regular, read_small};
pub use model::readable::with_unit;
use model::readable::{Readable, short};

/// The folder of a run. An unreadable text is a sentence that says so.
#[derive(Debug)]
pub struct Run {
    /// The name of the folder.
    pub name: String,
    /// The folder.
    pub folder: RunFolder,
    /// The resolved input.
    pub case: Result<toml::Table, String>,
    /// The status of the run.
    pub status: Result<Status, String>,
    /// The figures of the whole run.
    pub summary: Result<Map<String, Value>, String>,
}

impl Run {
    /// Reads the texts of a run, whose folder goes by its whole path; tables are read on demand.
    pub fn read(folder: &RunFolder) -> Self {
        Self {
            name: file_name(folder.path()),
            case: read_case(folder),
            status: read_json(&folder.status_file()),
            summary: read_summary(folder),
            folder: folder.clone(),
        }
    }

    /// The title of the case, else the name of the folder.
    pub fn title(&self) -> &str {
        let title = self.case.as_ref().ok().and_then(|case| case.get("title"));
        title.and_then(toml::Value::as_str).unwrap_or(&self.name)
    }

    /// A figure of the summary, of an object in it by a dot: `momentum_error.x`.
    pub fn figure(&self, key: &str) -> Option<&Value> {
        let mut parts = key.split('.');
        let first = self.summary.as_ref().ok()?.get(parts.next()?)?;
        let value = parts.try_fold(first, |value, part| value.get(part))?;
        (!value.is_null()).then_some(value)
    }

    /// The same of a number.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.figure(key)?.as_f64()
    }

    /// The tables of an array of the case, such as `body`.
    pub fn entries(&self, key: &str) -> Vec<&toml::Table> {
        let list = self
            .case
            .as_ref()
            .ok()
            .and_then(|case| case.get(key)?.as_array());
        let all = list.into_iter().flatten();
        all.filter_map(toml::Value::as_table).collect()
    }

    /// An error without the path of the folder, which differs between machines.
    pub fn without_path(&self, error: &impl ToString) -> String {
        without_paths(&[self], error)
    }

    /// The number of images of the model behind planes of symmetry, itself included.
    pub fn copies(&self) -> f64 {
        let planes = self.entries("symmetry").len().min(3);
        f64::from(1_u32 << planes)
    }
}

/// An error of some runs without the paths of their folders.
pub fn without_paths(runs: &[&Run], error: &impl ToString) -> String {
    let way = |run: &&Run| run.folder.path().display().to_string();
    let mut ways: Vec<String> = runs.iter().map(way).collect();
    ways.retain(|way| way != "/");
    // One may be the beginning of another.
    ways.sort_by_key(|way| Reverse(way.len()));
    let mut text = error.to_string();
    for way in &ways {
        text = text.replace(&format!("{way}/"), "");
    }
    for way in &ways {
        text = text.replace(way, "the run");
    }
    text
}

fn read_case(folder: &RunFolder) -> Result<toml::Table, String> {
    let text = read_small(&folder.case()).map_err(|error| lacks(&folder.case(), &error))?;
    let text = String::from_utf8(text).map_err(|error| damaged(&folder.case(), &error))?;
    text.parse()
        .map_err(|error: toml::de::Error| damaged(&folder.case(), &error.message()))
}

fn read_summary(folder: &RunFolder) -> Result<Map<String, Value>, String> {
    let path = folder.summary();
    if !path.exists() {
        return Err("there is no summary.json: the run has not come to its end".to_owned());
    }
    read_json(&path)
}

fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let text = read_small(path).map_err(|error| lacks(path, &error))?;
    serde_json::from_slice(&text).map_err(|error| damaged(path, &error))
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// The message for a file that is not there, without its path, which differs between machines.
fn lacks(path: &Path, error: &OutputError) -> String {
    let name = file_name(path);
    if !path.exists() {
        return format!("the run has no {name}");
    }
    let reason = match error {
        OutputError::Io { source, .. } => source.to_string(),
        OutputError::Damaged { what, .. } => what.clone(),
        other => other.to_string(),
    };
    format!("{name} cannot be read: {reason}")
}

fn damaged(path: &Path, reason: &dyn std::fmt::Display) -> String {
    format!("{} is damaged: {reason}", file_name(path))
}

/// The whole rows of a table.
#[derive(Debug)]
pub struct Rows {
    file: String,
    sheet: Sheet,
}

impl Rows {
    /// Reads a table of the run; without rows that are cut off.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = read_regular(path).map_err(|error| lacks(path, &error))?;
        let text = String::from_utf8(text).map_err(|error| damaged(path, &error))?;
        let mut sheet = Sheet::parse(&text).map_err(|reason| damaged(path, &reason))?;
        let columns = sheet.names.len();
        sheet.rows.retain(|(_, cells)| cells.len() == columns);
        let file = file_name(path);
        if sheet.rows.is_empty() {
            return Err(format!("{file} has no rows yet"));
        }
        Ok(Self { file, sheet })
    }

    /// True if the table states the share of the model that was computed, so that it is of the whole.
    pub fn states_share(&self) -> bool {
        self.sheet.computed_share.is_some()
    }

    /// Number of rows, at least one.
    pub fn len(&self) -> usize {
        self.sheet.rows.len()
    }

    /// The place of a column.
    pub fn column(&self, name: &str) -> Result<usize, String> {
        let column = self.sheet.names.iter().position(|own| own == name);
        column.ok_or_else(|| format!("{} has no column {name}", self.file))
    }

    /// A cell.
    pub fn text(&self, row: usize, column: usize) -> &str {
        &self.sheet.rows[row].1[column]
    }

    /// The same as a number; NaN if it is none.
    pub fn number(&self, row: usize, column: usize) -> f64 {
        self.text(row, column).parse().unwrap_or(f64::NAN)
    }

    /// A cell with its unit, for people; `–` if it is NaN, or if there is no such column.
    pub fn cell(&self, row: usize, name: &str) -> String {
        let Ok(column) = self.column(name) else {
            return "–".to_owned();
        };
        with_unit(self.number(row, column), self.unit(column))
    }

    /// A vector with its unit, for people, from the columns of its components.
    pub fn vector(&self, row: usize, stem: &str) -> String {
        let columns = ["x", "y", "z"].map(|axis| self.column(&format!("{stem}_{axis}")));
        let [Ok(x), Ok(y), Ok(z)] = columns else {
            return "–".to_owned();
        };
        let components = [x, y, z].map(|column| self.number(row, column));
        vector_with_unit(&components, self.unit(x))
    }

    /// SI unit of a column; empty for none.
    pub fn unit(&self, column: usize) -> &str {
        self.sheet.units[column].trim_matches('-')
    }

    /// The rows with the same cell as the last one, of its time say.
    pub fn like_last(&self, column: usize) -> impl Iterator<Item = usize> {
        self.like(self.len() - 1, column)
    }

    /// The rows with the same cell as a row.
    pub fn like(&self, row: usize, column: usize) -> impl Iterator<Item = usize> {
        let wanted = self.text(row, column);
        (0..self.len()).filter(move |&other| self.text(other, column) == wanted)
    }
}

/// A vector with one unit, for people.
pub fn vector_with_unit(components: &[f64], unit: &str) -> String {
    let largest = components
        .iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let unit = Readable::new(unit, largest);
    let numbers: Vec<String> = components.iter().map(|x| short(x / unit.size)).collect();
    format!("[{}]{}", numbers.join(", "), unit.behind())
}

/// A value of a case as people read it: texts as typed, tables as `key value, key value`.
pub fn in_words(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) => text.clone(),
        toml::Value::Array(list) => {
            let all: Vec<String> = list.iter().map(in_words).collect();
            format!("[{}]", all.join(", "))
        }
        toml::Value::Table(table) => {
            let entry = |(key, value): (&String, &toml::Value)| {
                let key = key.replace('_', " ");
                match value {
                    toml::Value::Table(_) => format!("{key}: {}", in_words(value)),
                    value => format!("{key} {}", in_words(value)),
                }
            };
            let all: Vec<String> = table.iter().map(entry).collect();
            all.join(", ")
        }
        other => other.to_string(),
    }
}

/// A figure of a summary as people read it.
pub fn figure_in_words(value: &Value) -> String {
    match value {
        Value::Null => "–".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) => match (number.as_u64(), number.as_f64()) {
            (Some(count), _) => count.to_string(),
            (None, Some(value)) => short(value),
            (None, None) => number.to_string(),
        },
        Value::Array(list) => {
            let all: Vec<String> = list.iter().map(figure_in_words).collect();
            all.join(", ")
        }
        Value::Object(parts) => {
            let part = |(name, value): (&String, &Value)| {
                format!("{} {}", name.replace('_', " "), figure_in_words(value))
            };
            parts.iter().map(part).collect::<Vec<_>>().join(", ")
        }
        Value::Bool(_) => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_has_the_way_to_a_folder() {
        let run = |path: &str| Run::read(&RunFolder::at(Path::new(path)));
        let (one, other) = (run("/nowhere/run"), run("/nowhere/run-b"));
        let text =
            "cannot open /nowhere/run-b/a.csv, /nowhere/run/b.csv, /nowhere/run-b or /nowhere/run";
        assert_eq!(
            without_paths(&[&one, &other], &text),
            "cannot open a.csv, b.csv, the run or the run"
        );
        assert_eq!(other.name, "run-b");
        assert_eq!(other.status.unwrap_err(), "the run has no status.json");
    }

    #[test]
    fn what_cannot_be_read_is_told_without_its_path() {
        let dir = tempfile::tempdir().unwrap();
        std::fs::create_dir(dir.path().join("bodies.csv")).unwrap();
        std::fs::write(dir.path().join("status.json"), "{}").unwrap();
        let run = Run::read(&RunFolder::at(dir.path()));
        let of_rows = Rows::read(&run.folder.bodies()).unwrap_err();
        let of_status = run.status.unwrap_err();
        let way = dir.path().display().to_string();
        for (text, start) in [
            (of_rows, "bodies.csv cannot be read: "),
            (of_status, "status.json is damaged: "),
        ] {
            assert!(text.starts_with(start) && !text.contains(&way), "{text}");
        }
    }
}
