//! Answers of a run: last rows of its tables, and its summary.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value as Json;

use files::output::{OutputError, RunFolder, Sheet, read_sheet, read_small};

/// Columns that say what a row is of, if a table has several rows of one time.
const KEYS: &[&str] = &[
    "name",
    "witness",
    "direction",
    "body",
    "body_a",
    "body_b",
    "gauge",
    "measure",
    "distribution",
    "from",
];
/// Columns that are no answers.
const OF_THE_ROW: &[&str] = &["step", "time"];
/// Tables whose last rows are answers by default.
const DEFAULT_TABLES: &[&str] = &["bodies", "fragments", "measures"];

/// An answer as it is in the table, its unit, and what the table says of its uncertainty; empty for none.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Answer {
    /// A number, a word or nothing.
    pub text: String,
    /// SI unit.
    pub unit: String,
    /// Half width of the band about a number, in the same unit.
    pub uncertainty: String,
}

/// Answers by name: `history.kinetic_energy`, `bodies.sphere.mass`, `summary.energy_error_max`.
pub type Answers = BTreeMap<String, Answer>;

/// All answers of a finished run.
///
/// # Errors
/// [`OutputError`] if a table cannot be read.
pub fn of_run(folder: &RunFolder) -> Result<Answers, OutputError> {
    let mut answers = Answers::new();
    let entries = fs::read_dir(folder.path()).map_err(OutputError::io("read", folder.path()))?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    for path in paths.filter(|path| path.extension().is_some_and(|e| e == "csv")) {
        let stem = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let sheet = read_sheet(&path)?;
        let uncertainties = uncertainties(&sheet);
        add_rows(&mut answers, &stem, &sheet.widened());
        for (figure, uncertainty) in uncertainties {
            if let Some(answer) = answers.get_mut(&format!("{stem}.{figure}")) {
                answer.uncertainty = uncertainty;
            }
        }
    }
    let path = folder.summary();
    let summary: Json = serde_json::from_slice(&read_small(&path)?)
        .map_err(|error| OutputError::damaged(&path, error.to_string()))?;
    add_values(&mut answers, "summary", &summary);
    Ok(answers)
}

/// Answers of a table at a time (s).
#[derive(Debug)]
pub struct Row {
    /// The time.
    pub time: f64,
    /// The answers.
    pub answers: Answers,
}

/// The answers of a table of a run, `history` or `measures`, at each of its times.
///
/// # Errors
/// [`OutputError`] if there is no such table, or it cannot be read.
pub fn rows_of(folder: &RunFolder, table: &str) -> Result<Vec<Row>, OutputError> {
    let path = folder.path().join(table).with_extension("csv");
    let damaged = |reason: String| OutputError::damaged(&path, reason);
    let mut sheet = read_sheet(&path)?.widened();
    let time = sheet.names.iter().position(|name| name == "time");
    let time = time.ok_or_else(|| damaged("it has no times".to_owned()))?;
    let all = std::mem::take(&mut sheet.rows);
    let mut rows: Vec<Row> = Vec::new();
    for of_time in all.chunk_by(|(_, a), (_, b)| a.get(time) == b.get(time)) {
        let value = of_time[0].1.get(time).and_then(|time| time.parse().ok());
        let Some(value) = value else {
            continue;
        };
        sheet.rows = of_time.to_vec();
        let mut answers = Answers::new();
        add_rows(&mut answers, table, &sheet);
        rows.push(Row {
            time: value,
            answers,
        });
    }
    Ok(rows)
}

/// `true` if an answer is asked for, by its whole name, or if nothing is and it is one of the
/// default ones.
#[must_use]
pub fn is_wanted(name: &str, wanted: &[String]) -> bool {
    let begins = |with: &str| {
        let rest = name.strip_prefix(with);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    if wanted.is_empty() {
        DEFAULT_TABLES.iter().any(|table| begins(table))
    } else {
        wanted.iter().any(|w| begins(w))
    }
}

/// The last uncertainties of a table with a row for each figure, by `MEASURE.FIGURE`.
fn uncertainties(sheet: &Sheet) -> BTreeMap<String, String> {
    let column = |name: &str| sheet.names.iter().position(|n| n == name);
    let wanted = ["measure", "figure", "uncertainty"].map(column);
    let [Some(measure), Some(figure), Some(uncertainty)] = wanted else {
        return BTreeMap::new();
    };
    let whole = |row: &&(usize, Vec<String>)| row.1.len() == sheet.names.len();
    let rows = sheet.rows.iter().filter(whole);
    rows.map(|(_, row)| {
        let name = format!("{}.{}", row[measure], row[figure]);
        (name, row[uncertainty].clone())
    })
    .collect()
}

/// Adds the rows of the last time of a table.
fn add_rows(answers: &mut Answers, table: &str, sheet: &Sheet) {
    let column = |name: &str| sheet.names.iter().position(|n| n == name);
    let whole = |row: &&(usize, Vec<String>)| row.1.len() == sheet.names.len();
    let rows: Vec<&Vec<String>> = sheet.rows.iter().filter(whole).map(|row| &row.1).collect();
    let Some(last) = rows.last() else {
        return;
    };
    let keys: Vec<usize> = KEYS.iter().filter_map(|key| column(key)).collect();
    let time = column("time");
    let is_of_end = |row: &&Vec<String>| time.is_none_or(|t| row[t] == last[t]);
    let of_end = rows.iter().copied().filter(is_of_end);
    let chosen: Vec<&Vec<String>> = if keys.is_empty() {
        vec![last]
    } else {
        of_end.collect()
    };
    for row in chosen {
        let whose: Vec<&str> = keys.iter().map(|&k| row[k].as_str()).collect();
        let whose = whose.join("-");
        for (column, name) in sheet.names.iter().enumerate() {
            if keys.contains(&column) || OF_THE_ROW.contains(&name.as_str()) {
                continue;
            }
            let name = if whose.is_empty() {
                format!("{table}.{name}")
            } else {
                format!("{table}.{whose}.{name}")
            };
            let unit = match sheet.units[column].as_str() {
                "-" => String::new(),
                unit => unit.to_owned(),
            };
            let text = row[column].clone();
            let uncertainty = String::new();
            let answer = Answer {
                text,
                unit,
                uncertainty,
            };
            answers.insert(name, answer);
        }
    }
}

/// Adds the values of a JSON object, by dotted names.
fn add_values(answers: &mut Answers, name: &str, value: &Json) {
    let text = match value {
        Json::Object(map) => {
            for (key, value) in map {
                add_values(answers, &format!("{name}.{key}"), value);
            }
            return;
        }
        Json::Array(list) => {
            for (k, value) in list.iter().enumerate() {
                add_values(answers, &format!("{name}.{k}"), value);
            }
            return;
        }
        Json::Null => String::new(),
        Json::String(text) => text.clone(),
        Json::Bool(_) | Json::Number(_) => value.to_string(),
    };
    let answer = Answer {
        text,
        ..Answer::default()
    };
    answers.insert(name.to_owned(), answer);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_the_last_time_are_answers() {
        let text =
            "# units: -,s,-,kg\nstep,time,body,mass\n0,0.0,a,1\n0,0.0,b,2\n9,1.0,a,3\n9,1.0,b,4\n9";
        let mut answers = Answers::new();
        add_rows(&mut answers, "bodies", &Sheet::parse(text).unwrap());
        let names: Vec<&str> = answers.keys().map(String::as_str).collect();
        assert_eq!(names, ["bodies.a.mass", "bodies.b.mass"]);
        assert_eq!(answers["bodies.b.mass"].text, "4");
        assert_eq!(answers["bodies.b.mass"].unit, "kg");
        let text = "time,energy\n0,5\n1,6\n";
        add_rows(&mut answers, "history", &Sheet::parse(text).unwrap());
        assert_eq!(answers["history.energy"].text, "6");
    }

    #[test]
    fn figures_keep_their_last_uncertainties() {
        let text = "time,measure,kind,figure,value,uncertainty,unit\n\
            0,p,plate,hole,1,0.5,m\n1,p,plate,hole,2,0.25,m\n1,p,plate,verdict,held,,\n1,q";
        let sheet = Sheet::parse(text).unwrap();
        let found = uncertainties(&sheet);
        assert_eq!(found["p.hole"], "0.25");
        assert_eq!(found["p.verdict"], "");
        let other = Sheet::parse("time,energy\n0,5\n").unwrap();
        assert!(uncertainties(&other).is_empty());
    }

    #[test]
    fn summaries_have_dotted_names() {
        let json = serde_json::json!({"a": {"b": [1, "x", null]}, "c": true});
        let mut answers = Answers::new();
        add_values(&mut answers, "summary", &json);
        assert_eq!(answers["summary.a.b.0"].text, "1");
        assert_eq!(answers["summary.a.b.2"].text, "");
        assert_eq!(answers["summary.c"].text, "true");
    }

    #[test]
    fn the_usual_answers_are_those_of_bodies_and_fragments() {
        assert!(is_wanted("bodies.sphere.mass", &[]));
        assert!(!is_wanted("history.kinetic_energy", &[]));
        let wanted = ["bodies.sphere".to_owned()];
        assert!(is_wanted("bodies.sphere.mass", &wanted));
        assert!(!is_wanted("bodies.spheres.mass", &wanted));
    }
}
