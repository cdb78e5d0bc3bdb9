//! Differences of the tables of two runs, row by row.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::super::results::ResultsError;
use super::Report;
use files::output::Sheet;

/// Tables of clocks and ranks.
const OF_THE_PROCESS: [&str; 2] = ["performance.csv", "ranks.csv"];

/// Columns with extremes since the row before.
pub const SINCE_ROW_BEFORE: [&str; 7] = [
    "interpenetrated",
    "peak_force",
    "largest_excess",
    "closest_pair",
    "closest_a",
    "closest_b",
    "contact_dt",
];

/// The tables of a run, but for what depends on clocks and ranks.
pub fn names(folder: &Path) -> Result<BTreeSet<String>, ResultsError> {
    let entries = std::fs::read_dir(folder).map_err(|error| ResultsError::Text {
        path: folder.to_owned(),
        reason: error.to_string(),
    })?;
    let names = entries
        .flatten()
        .map(|e| e.file_name().to_string_lossy().into_owned());
    let is_table = |name: &String| {
        let extension = Path::new(name).extension();
        extension.is_some_and(|e| e == "csv") && !OF_THE_PROCESS.contains(&&name[..])
    };
    Ok(names.filter(is_table).collect())
}

struct Table {
    columns: Vec<String>,
    rows: BTreeMap<String, Vec<String>>,
}

/// Compares the rows that both have: rows of the same step (of the same time where there is no
/// step) and the same bodies; columns with extremes since the row before only if `rows_are_same`.
pub fn compare(name: &str, a: &str, b: &str, rows_are_same: bool, report: &mut Report) {
    let (a, b) = match (parse(a), parse(b)) {
        (Ok(a), Ok(b)) => (a, b),
        // A run that never wrote a row has its header still.
        (Err(why), _) | (_, Err(why)) => {
            report.record(name, "", &[format!("no table: {why}")]);
            return;
        }
    };
    if a.columns != b.columns {
        report.record(name, "", &["the columns differ".to_owned()]);
        return;
    }
    let common: Vec<&String> = a
        .rows
        .keys()
        .filter(|key| b.rows.contains_key(*key))
        .collect();
    let mut differences = Vec::new();
    for (k, column) in a.columns.iter().enumerate() {
        if !rows_are_same && SINCE_ROW_BEFORE.contains(&&column[..]) {
            continue;
        }
        let pairs = common
            .iter()
            .map(|&key| (key, a.rows[key].get(k), b.rows[key].get(k)));
        let different: Vec<_> = pairs.filter(|(_, a, b)| a != b).collect();
        if let Some(&(key, a, b)) = different.first() {
            let show = |value: Option<&String>| value.map_or("nothing", String::as_str).to_owned();
            let sizes = different.iter().map(|(_, a, b)| distance(*a, *b));
            let largest = sizes.fold(0.0, f64::max);
            differences.push(format!(
                "{column}: {} rows differ; first at {}: {} against {}; largest difference {largest:e}",
                different.len(),
                key.trim(),
                show(a),
                show(b),
            ));
        }
    }
    let lone = [a.rows.len() - common.len(), b.rows.len() - common.len()];
    if common.is_empty() && lone[0] > 0 && lone[1] > 0 {
        if !rows_are_same {
            // Rows of a part may all come at other steps, and tell nothing then.
            report.note(format!("{name}: no row in common"));
            return;
        }
        differences.push("they have no row in common".to_owned());
    }
    report.record(name, &format!("{} rows agree", common.len()), &differences);
    for (letter, count) in ["A", "B"].into_iter().zip(lone) {
        if count > 0 {
            report.note(format!("{name}: only {letter} has {count} more rows"));
        }
    }
}

fn distance(a: Option<&String>, b: Option<&String>) -> f64 {
    let number = |value: Option<&String>| value.and_then(|value| value.parse::<f64>().ok());
    match (number(a), number(b)) {
        (Some(a), Some(b)) if (a - b).is_finite() => (a - b).abs(),
        _ => f64::INFINITY,
    }
}

/// Columns that distinguish rows of one time, beside those of bodies.
const NAMES: [&str; 9] = [
    "load",
    "gauge",
    "witness",
    "direction",
    "id",
    "measure",
    "figure",
    "distribution",
    "from",
];

fn parse(text: &str) -> Result<Table, String> {
    let sheet = Sheet::parse(text)?;
    let columns = sheet.names;
    let main = if columns.iter().any(|column| column == "step") {
        "step"
    } else {
        "time"
    };
    let is_key =
        |column: &str| column == main || column.starts_with("body") || NAMES.contains(&column);
    let mut rows = BTreeMap::new();
    for (_, values) in sheet.rows {
        let keys = columns
            .iter()
            .zip(&values)
            .filter(|(column, _)| is_key(column));
        // Whole numbers in their own order, so that the first difference is the earliest.
        let key: Vec<String> = keys
            .map(|(column, value)| match value.parse::<u64>() {
                Ok(number) => format!("{column} {number:>12}"),
                Err(_) => format!("{column} {value}"),
            })
            .collect();
        rows.insert(key.join(" "), values);
    }
    Ok(Table { columns, rows })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(a: &str, b: &str) -> Report {
        let mut report = Report::default();
        compare("history.csv", a, b, true, &mut report);
        report
    }

    const A: &str = "# units: -,s,J\nstep,time,energy\n0,0.0,1.0\n9,1e-9,1.5\n10,2e-9,2.0\n";

    #[test]
    fn rows_of_the_same_step_are_compared() {
        let longer = format!("{A}11,3e-9,9.0\n");
        let compared = report(A, &longer);
        assert!(compared.agrees());
        assert_eq!(
            compared.lines,
            [
                "history.csv: 3 rows agree",
                "history.csv: only B has 1 more rows"
            ]
        );
    }

    #[test]
    fn the_first_and_the_largest_difference_are_told() {
        let compared = report(A, &A.replace("1.5", "1.75").replace("2.0", "2.125"));
        assert_eq!(compared.different, 1);
        let expected = "  energy: 2 rows differ; first at step            9: 1.5 against 1.75; \
                        largest difference 2.5e-1";
        assert_eq!(compared.lines[1], expected);
    }

    #[test]
    fn names_with_commas_stay_in_their_columns() {
        let a = "# units: s,-,N\ntime,body_a,force\n0.0,\"bumper, front\",-6902\n0.0,rear,48\n";
        let compared = report(a, &a.replace("48", "47"));
        let expected = "  force: 1 rows differ; first at time 0.0 body_a rear: 48 against 47; \
                        largest difference 1e0";
        assert_eq!(compared.lines[1], expected);
    }

    #[test]
    fn tables_without_common_rows_or_columns_differ() {
        let shifted = A
            .replace("\n0,", "\n1,")
            .replace("\n9,", "\n8,")
            .replace("\n10,", "\n12,");
        assert_eq!(report(A, &shifted).different, 1);
        assert_eq!(report(A, &A.replace("energy", "work")).different, 1);
    }
}
