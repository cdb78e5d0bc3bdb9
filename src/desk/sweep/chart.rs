//! The charts of a sweep: an answer over the last key that is a number, a curve for each combination
//! of the others; of bisections the limit; what each scattered key does.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::SweepError;
use super::definition::Definition;
use files::output::{OutputError, Sheet, read_small};

use model::readable::with_unit;
use plot::{Bar, Chart, Curve, Group, Mark, Quantity, Tornado, colour_of};

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

/// Groups of bars that a picture has.
const GROUPS: usize = 8;

/// Draws what each scattered key does to the answer of the bands, the first one or the one that is named: bars about the mean, a group
/// for each combination of the other keys. Gives the chart and where its picture goes, but for the ending of its name; nothing if no key
/// has values with means.
///
/// # Errors
/// [`SweepError::Output`] if a table cannot be read, [`SweepError::Typed`] if there is no such answer.
pub fn draw_effects(
    folder: &Path,
    answer: Option<&str>,
) -> Result<Option<(Tornado, PathBuf)>, SweepError> {
    let plan = Definition::read(folder)?.plan();
    let keys = plan.map_err(SweepError::Typed)?.keys;
    let [points, bands, effects] =
        ["sweep.csv", "bands.csv", "effects.csv"].map(|name| read(&folder.join(name)));
    let chart = effects_about_means(&keys, [&points?, &bands?, &effects?], answer)?;
    Ok(chart.map(|chart| (chart, folder.join("effects"))))
}

/// The same of the keys of a sweep, and its tables of points, bands and effects.
fn effects_about_means(
    keys: &[String],
    [points, bands, effects]: [&Sheet; 3],
    answer: Option<&str>,
) -> Result<Option<Tornado>, SweepError> {
    let Some(name) = answer_of(bands, answer)? else {
        return Ok(None);
    };
    let wanted = ["answer", "unit", "mean"].map(|name| column(bands, name));
    let of_effects = ["answer", "key", "least", "at", "largest", "at_largest"];
    let of_effects = of_effects.map(|name| column(effects, name));
    let (
        [Some(at), Some(unit), Some(mean)],
        [
            Some(of),
            Some(key),
            Some(least),
            Some(low),
            Some(largest),
            Some(high),
        ],
    ) = (wanted, of_effects)
    else {
        return Ok(None);
    };
    let number = |row: &[String], column: usize| row.get(column)?.parse::<f64>().ok();
    // Tables have the shortest names of keys, the first columns of points.
    let key_of = |name: &str| column(points, name).filter(|&k| k < keys.len());
    let unit_of = |name: &str| key_of(name).map_or("", |k| points.units[k].trim_matches('-'));
    let label_of =
        |name: &str| key_of(name).map_or_else(|| words(name), |k| short_among(&keys[k], keys));
    let mut groups = Vec::new();
    let mut own_unit = String::new();
    for (_, row) in bands.rows.iter().filter(|(_, row)| row[at] == name) {
        let Some(mean) = number(row, mean) else {
            continue;
        };
        own_unit.clone_from(&row[unit]);
        let same =
            |other: &&(usize, Vec<String>)| other.1[of] == name && other.1[..of] == row[..at];
        let bars = effects.rows.iter().filter(same).filter_map(|(_, effect)| {
            let ends = [
                number(effect, least)? - mean,
                number(effect, largest)? - mean,
            ];
            let value = |column: usize| valued(&effect[column], unit_of(&effect[key]));
            let values = if ends[0] < ends[1] {
                [low, high].map(value)
            } else {
                [String::new(), "no difference".to_owned()]
            };
            let name = label_of(&effect[key]);
            Some(Bar { name, ends, values })
        });
        let bars: Vec<Bar> = bars.collect();
        if bars.is_empty() {
            continue;
        }
        let others = (0..at).map(|k| named(bands, k, &row[k]));
        let others: Vec<String> = others.collect();
        let about = format!("mean {}", with_unit(mean, &row[unit]));
        let title = [others.join(", "), about]
            .into_iter()
            .filter(|part| !part.is_empty());
        let title = title.collect::<Vec<_>>().join(": ");
        groups.push(Group { title, bars });
    }
    if groups.is_empty() {
        return Ok(None);
    }
    let mut subtitle =
        "means at the values of each scattered key, less the mean of all runs".to_owned();
    if groups.len() > GROUPS {
        let _ = write!(
            subtitle,
            "; the first {GROUPS} of {} combinations",
            groups.len()
        );
        groups.truncate(GROUPS);
    }
    Ok(Some(Tornado {
        title: format!("what moves {}", words(&name)),
        subtitle,
        x: Quantity {
            label: format!("{} less its mean", words(&name)),
            unit: own_unit,
            ..Quantity::default()
        },
        groups,
    }))
}

/// The last parts of a key, two at least, that no other one ends with.
fn short_among(key: &str, all: &[String]) -> String {
    let last = |key: &str, count: usize| {
        let parts: Vec<&str> = key.split('.').collect();
        parts[parts.len().saturating_sub(count)..].join(".")
    };
    let parts = key.split('.').count();
    let is_alone = |count: &usize| {
        let own = last(key, *count);
        all.iter()
            .all(|other| other == key || last(other, *count) != own)
    };
    let count = (2..parts).find(is_alone).unwrap_or(parts);
    words(&last(key, count))
}

/// The chart of an answer's means, the first one's or that of a name, over the last key that is a number: with a band from the least
/// to the largest.
fn bands(sheet: &Sheet, answer: Option<&str>) -> Result<Option<Chart>, SweepError> {
    let Some(name) = answer_of(sheet, answer)? else {
        return Ok(None);
    };
    let wanted = ["answer", "unit", "mean", "least", "largest"].map(|name| column(sheet, name));
    let [Some(at), Some(unit), Some(mean), Some(least), Some(largest)] = wanted else {
        return Ok(None);
    };
    let rows: Vec<(usize, Vec<String>)> = (sheet.rows.iter())
        .filter(|(_, row)| row[at] == name)
        .cloned()
        .collect();
    let Some((_, row)) = rows.first() else {
        return Ok(None);
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

/// The answer of a table of bands that is drawn: the one that is named, or the first with a mean.
fn answer_of(bands: &Sheet, answer: Option<&str>) -> Result<Option<String>, SweepError> {
    let (Some(at), Some(mean)) = (column(bands, "answer"), column(bands, "mean")) else {
        return Ok(None);
    };
    let Some(name) = answer else {
        let with_mean = |row: &&(usize, Vec<String>)| row.1[mean].parse::<f64>().is_ok();
        return Ok(bands
            .rows
            .iter()
            .find(with_mean)
            .map(|(_, row)| row[at].clone()));
    };
    if bands.rows.iter().any(|(_, row)| row[at] == name) {
        return Ok(Some(name.to_owned()));
    }
    Err(SweepError::Typed(format!(
        "the sweep has no answer `{name}`"
    )))
}

fn column(sheet: &Sheet, name: &str) -> Option<usize> {
    sheet.names.iter().position(|own| own == name)
}

/// A key and its value as people write them: `velocity 5 km/s`.
fn named(sheet: &Sheet, key: usize, text: &str) -> String {
    let unit = sheet.units[key].trim_matches('-');
    format!("{} {}", words(&sheet.names[key]), valued(text, unit))
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
        let all = of.iter().map(|(k, text)| named(sheet, *k, text));
        let name = all.collect::<Vec<_>>().join(", ");
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

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(text: &str) -> Sheet {
        Sheet::parse(text).unwrap()
    }

    /// Bars are differences from the mean of their combination, with values in units of people.
    #[test]
    fn effects_are_bars_about_means() {
        let points = sheet(
            "# units: m/s,Pa,-,-,-,m\n\
             v,pressure,seed,run,state,hole\n",
        );
        let bands = sheet(
            "# units: m/s,-,-,-,-\n\
             v,answer,unit,runs,mean\n\
             3000.0,verdict,,4,\n\
             3000.0,hole,m,4,2.5\n\
             5000.0,hole,m,4,7.0\n",
        );
        let effects = sheet(
            "# units: m/s,-,-,-,-,-,-,-,-\n\
             v,answer,unit,key,least,at,largest,at_largest,effect\n\
             3000.0,hole,m,seed,1.5,1,3.5,2,2.0\n\
             3000.0,hole,m,pressure,2.0,-1.7e9,3.0,-1.1e9,1.0\n\
             3000.0,hole,m,alpha,2.5,1,2.5,2,0.0\n",
        );
        let keys = ["v", "material.wall.failure.spall.pressure", "seed"].map(str::to_owned);
        let draw = |answer| effects_about_means(&keys, [&points, &bands, &effects], answer);
        let tornado = draw(None).unwrap().unwrap();
        assert_eq!((&tornado.x.unit[..], tornado.groups.len()), ("m", 1));
        let group = &tornado.groups[0];
        assert_eq!(group.title, "v 3 km/s: mean 2.5 m");
        assert_eq!(group.bars[0].ends, [-1.0, 1.0]);
        assert_eq!(group.bars[0].values, ["1", "2"]);
        assert_eq!(group.bars[1].name, "spall pressure");
        assert_eq!(group.bars[1].values, ["-1.7 GPa", "-1.1 GPa"]);
        assert_eq!(group.bars[2].values, ["", "no difference"]);
        assert_eq!(draw(Some("verdict")).unwrap(), None);
        assert!(draw(Some("nothing")).is_err());
    }

    #[test]
    fn keys_that_end_alike_are_told_apart() {
        let all = ["a.wall.spall.pressure", "a.sphere.spall.pressure", "seed"].map(str::to_owned);
        assert_eq!(short_among(&all[0], &all), "wall spall pressure");
        assert_eq!(short_among(&all[2], &all), "seed");
    }
}
