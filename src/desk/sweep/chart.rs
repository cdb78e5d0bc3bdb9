//! The chart of a sweep: an answer over the last key that is a number, a curve for each combination
//! of the others; of bisections the limit.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::SweepError;
use files::output::{OutputError, Sheet, read_small};

use model::readable::with_unit;
use plot::{Chart, Curve, Mark, Quantity, colour_of};

/// Columns of a table that are no keys and no answers.
const OWN: &[&str] = &["run", "state"];

/// Draws the tables of a sweep's folder; gives the chart and where its picture goes, but for the ending
/// of its name, or nothing if there is nothing to draw. Of a grid the first answer is drawn, or the one that is named.
///
/// # Errors
/// [`SweepError::Output`] if a table cannot be read, [`SweepError::Typed`] if there is no such answer.
pub fn draw(
    folder: &Path,
    scattered: &[bool],
    answer: Option<&str>,
) -> Result<Option<(Chart, PathBuf)>, SweepError> {
    let keys = scattered.len();
    if scattered.contains(&true) {
        let sheet = read(&folder.join("bands.csv"))?;
        let chart = bands(&sheet, answer)?;
        return Ok(chart.map(|chart| (chart, folder.join("bands"))));
    }
    let limits = folder.join("limits.csv");
    if answer.is_none() && limits.is_file() {
        let sheet = read(&limits)?;
        let chart = chart(&sheet, keys - 1, keys - 1);
        return Ok(chart.map(|chart| (chart, folder.join("limits"))));
    }
    let sheet = read(&folder.join("sweep.csv"))?;
    let answers = keys + OWN.len()..sheet.names.len();
    let at = match answer {
        None => answers
            .into_iter()
            .find(|&k| numbers(&sheet, k).any(|n| n.is_some())),
        Some(name) => {
            let column = answers.into_iter().find(|&k| sheet.names[k] == name);
            let unknown = || SweepError::Typed(format!("the sweep has no answer `{name}`"));
            Some(column.ok_or_else(unknown)?)
        }
    };
    let chart = at.and_then(|at| chart(&sheet, keys, at));
    Ok(chart.map(|chart| (chart, folder.join("sweep"))))
}

/// The chart of an answer's means, the first one's or that of a name, over the last key that is a number: with a band from the least
/// to the largest.
fn bands(sheet: &Sheet, answer: Option<&str>) -> Result<Option<Chart>, SweepError> {
    let column = |name: &str| sheet.names.iter().position(|own| own == name);
    let wanted = ["answer", "unit", "mean", "least", "largest"].map(column);
    let [Some(at), Some(unit), Some(mean), Some(least), Some(largest)] = wanted else {
        return Ok(None);
    };
    let with_mean = |row: &&(usize, Vec<String>)| row.1[mean].parse::<f64>().is_ok();
    let first = sheet.rows.iter().find(with_mean);
    let name = match (answer, first) {
        (Some(name), _) => name.to_owned(),
        (None, Some((_, row))) => row[at].clone(),
        (None, None) => return Ok(None),
    };
    let rows: Vec<(usize, Vec<String>)> = (sheet.rows.iter())
        .filter(|(_, row)| row[at] == name)
        .cloned()
        .collect();
    let Some((_, row)) = rows.first() else {
        return Err(SweepError::Typed(format!(
            "the sweep has no answer `{name}`"
        )));
    };
    // The answer's name and unit stand in its rows.
    let mut own = sheet.clone();
    for y in [mean, least, largest] {
        own.names[y].clone_from(&name);
        own.units[y].clone_from(&row[unit]);
    }
    own.rows.clone_from(&rows);
    let Some(mut whole) = chart(&own, at, mean) else {
        return Ok(None);
    };
    for y in [least, largest] {
        let ends = chart(&own, at, y).map_or_else(Vec::new, |chart| chart.curves);
        let rings = ends.into_iter().filter(|curve| curve.mark == Mark::Rings);
        whole.curves.extend(rings.map(|curve| Curve {
            mark: Mark::Thin,
            ..curve
        }));
    }
    "means, and from the least to the largest".clone_into(&mut whole.subtitle);
    Ok(Some(whole))
}

fn read(path: &Path) -> Result<Sheet, SweepError> {
    let text = String::from_utf8(read_small(path)?);
    let text = text.map_err(|error| OutputError::damaged(path, error.to_string()))?;
    let sheet = Sheet::parse(&text);
    Ok(sheet.map_err(|reason| OutputError::damaged(path, reason))?)
}

fn numbers(sheet: &Sheet, column: usize) -> impl Iterator<Item = Option<f64>> + '_ {
    let cells = sheet.rows.iter().map(move |(_, row)| row.get(column));
    cells.map(|cell| cell?.parse::<f64>().ok())
}

/// A column's name as people write it.
fn words(name: &str) -> String {
    name.replace(['_', '.'], " ")
}

/// A cell as people write it: a number of SI units with one that fits.
fn valued(text: &str, unit: &str) -> String {
    match text.parse() {
        Ok(number) => with_unit(number, unit),
        Err(_) => text.to_owned(),
    }
}

/// The chart of a column over the last of the keys that is a number.
fn chart(sheet: &Sheet, keys: usize, y: usize) -> Option<Chart> {
    let is_number = |&k: &usize| numbers(sheet, k).all(|n| n.is_some());
    let x = (0..keys).rev().find(is_number)?;
    let mut curves: BTreeMap<Vec<(usize, String)>, Vec<[f64; 2]>> = BTreeMap::new();
    let mut order = Vec::new();
    for ((_, row), (a, b)) in sheet
        .rows
        .iter()
        .zip(numbers(sheet, x).zip(numbers(sheet, y)))
    {
        let (Some(a), Some(b)) = (a, b) else {
            continue;
        };
        let others = (0..keys).filter(|&k| k != x);
        let of: Vec<(usize, String)> = others.map(|k| (k, row[k].clone())).collect();
        if !curves.contains_key(&of) {
            order.push(of.clone());
        }
        curves.entry(of).or_default().push([a, b]);
    }
    if curves.is_empty() {
        return None;
    }
    let quantity = |k: usize| Quantity {
        label: words(&sheet.names[k]),
        unit: sheet.units[k].trim_matches('-').to_owned(),
        room: true,
        ..Quantity::default()
    };
    let mut chart = Chart {
        title: quantity(y).label,
        x: quantity(x),
        y: quantity(y),
        ..Chart::default()
    };
    for (k, of) in order.iter().enumerate() {
        let mut points = curves.remove(of).unwrap_or_default();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let named = of.iter().map(|(k, text)| {
            format!(
                "{} {}",
                words(&sheet.names[*k]),
                valued(text, sheet.units[*k].trim_matches('-'))
            )
        });
        let name = named.collect::<Vec<_>>().join(", ");
        let curve = |name: String, mark| Curve {
            name,
            colour: colour_of(k),
            mark,
            points: points.clone(),
            ..Curve::default()
        };
        let both = [curve(name, Mark::Line), curve(String::new(), Mark::Rings)];
        chart.curves.extend(both);
    }
    Some(chart)
}
