//! Answers as text for people, or as a JSON document for programs.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use serde_json::{Map, Value, json};

use files::output::Sheet;
use files::run::say;
use files::run::verbosity::Verbosity;
use model::readable::one_line;

/// How a command tells its answer.
#[derive(Debug, Clone, Copy, Default, clap::Args)]
#[group(skip)]
pub struct OutputFormat {
    /// Print one JSON document in place of text, with numbers in SI units
    #[arg(long)]
    json: bool,
}

impl OutputFormat {
    /// Text is not printed from now on where a document is asked for.
    pub fn begin(self) {
        if self.json {
            let quiet = Verbosity {
                quiet: true,
                json: false,
            };
            quiet.begin();
        }
    }

    /// `true` if a document is asked for.
    pub fn is_json(self) -> bool {
        self.json
    }

    /// Prints the document if it is asked for, with the files that have been written.
    pub fn print(self, document: impl FnOnce() -> Value) {
        if !self.json {
            return;
        }
        let mut document = document();
        let written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
        if !written.is_empty() {
            document["written"] = written.as_slice().into();
        }
        say::document(&document);
    }
}

/// The files that this process has written for its user.
static WRITTEN: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Says that a file has been written, and what else there is to say of it.
pub fn wrote(path: &Path, more: &str) {
    let name = path.display().to_string();
    say::say(&format!("wrote {}{more}", one_line(&name)));
    let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    written.push(name);
}

/// Columns whose cells are always words.
const WORDS: [&str; 9] = [
    "body",
    "bodies",
    "direction",
    "figure",
    "gauge",
    "kind",
    "measure",
    "run",
    "witness",
];

/// A table: `units` by column, and `rows` by column. What is not a number in a column of numbers is null.
pub fn table(sheet: &Sheet) -> Value {
    let units = sheet.names.iter().zip(&sheet.units);
    let units = units.filter(|(_, unit)| !["", "-"].contains(&unit.as_str()));
    let units: Map<String, Value> = units
        .map(|(name, unit)| (name.clone(), unit.as_str().into()))
        .collect();
    let row = |(_, cells): &(usize, Vec<String>)| -> Value {
        let named = sheet.names.iter().zip(cells);
        let row: Map<String, Value> = named
            .map(|(name, cell)| (name.clone(), value(name, cell)))
            .collect();
        row.into()
    };
    let rows: Vec<Value> = sheet.rows.iter().map(row).collect();
    json!({ "units": units, "rows": rows })
}

/// The cell of a column.
fn value(column: &str, cell: &str) -> Value {
    if WORDS.contains(&column) {
        return cell.into();
    }
    if let Ok(count) = cell.parse::<u64>() {
        return count.into();
    }
    match cell.parse::<f64>() {
        // No number of JSON is infinite or none.
        Ok(number) => json!(number),
        Err(_) if cell.is_empty() => Value::Null,
        Err(_) => cell.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_units_and_rows_by_column() {
        let text =
            "# units: s,-,Pa\ntime,body,pressure\n0.5,7,2e9\n1.0,inf,NaN\n1.5,c,\n2,d,none\n";
        let sheet = Sheet::parse(text).unwrap();
        let expected = json!({
            "units": { "time": "s", "pressure": "Pa" },
            "rows": [
                { "time": 0.5, "body": "7", "pressure": 2e9 },
                { "time": 1.0, "body": "inf", "pressure": null },
                { "time": 1.5, "body": "c", "pressure": null },
                { "time": 2, "body": "d", "pressure": "none" },
            ],
        });
        assert_eq!(table(&sheet), expected);
    }
}
