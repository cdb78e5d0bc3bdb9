//! Answers over scattered keys: means, bands, and what each key does to them.
//!
//! Points that differ in scattered keys alone (seeds, spacings, constants within their uncertainty) are repetitions
//! of one question.

use std::collections::BTreeMap;

use files::output::Sheet;

/// What a table of bands is made of.
#[derive(Debug)]
pub struct Layout {
    /// For each key, a column from the first on, whether it is scattered.
    pub scattered: Vec<bool>,
    /// First column of answers.
    pub answers: usize,
}

impl Layout {
    /// Columns of keys that are scattered, or not.
    fn columns(&self, scattered: bool) -> impl Iterator<Item = usize> + '_ {
        let all = self.scattered.iter().enumerate();
        all.filter(move |(_, is)| **is == scattered).map(|(k, _)| k)
    }

    /// The rows of each combination of keys that are not scattered, in the order of the first of each.
    fn groups<'a>(&self, sheet: &'a Sheet) -> Vec<(Vec<String>, Vec<&'a [String]>)> {
        let mut groups: Vec<(Vec<String>, Vec<&[String]>)> = Vec::new();
        for (_, row) in &sheet.rows {
            let own: Vec<String> = self.columns(false).map(|k| row[k].clone()).collect();
            match groups.iter_mut().find(|(keys, _)| *keys == own) {
                Some((_, rows)) => rows.push(row),
                None => groups.push((own, vec![row])),
            }
        }
        groups
    }
}

/// Numbers of repetitions.
struct Spread {
    count: usize,
    mean: f64,
    /// Standard deviation of one of them (n − 1).
    deviation: f64,
    least: f64,
    largest: f64,
}

impl Spread {
    fn of(values: &[f64]) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Some(Self {
            count: values.len(),
            mean,
            deviation: (squares / (count - 1.0).max(1.0)).sqrt(),
            least: values.iter().copied().fold(f64::INFINITY, f64::min),
            largest: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        })
    }
}

/// Numbers in a column of some rows.
fn numbers<'a>(rows: &'a [&'a [String]], column: usize) -> impl Iterator<Item = f64> + 'a {
    let cells = rows.iter().filter_map(move |row| row.get(column));
    cells.filter_map(|cell| cell.parse::<f64>().ok().filter(|value| value.is_finite()))
}

/// Words in a column of some rows, with their counts: `held 3, perforated 1`; and how many they are.
fn words(rows: &[&[String]], column: usize) -> (String, usize) {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let cells = rows.iter().filter_map(|row| row.get(column));
    for cell in cells.filter(|cell| !cell.is_empty() && cell.parse::<f64>().is_err()) {
        *counts.entry(cell).or_default() += 1;
    }
    let texts = counts.iter().map(|(word, count)| format!("{word} {count}"));
    (texts.collect::<Vec<_>>().join(", "), counts.values().sum())
}

fn text(value: f64) -> String {
    format!("{value:?}")
}

/// A row for each combination of the other keys and each answer: of how many runs, mean, standard deviation, least and largest
/// number, words with their counts.
#[must_use]
pub fn bands(sheet: &Sheet, layout: &Layout) -> Sheet {
    let mut all = begin(sheet, layout);
    let more = [
        "answer",
        "unit",
        "runs",
        "mean",
        "deviation",
        "least",
        "largest",
        "words",
    ];
    all.names.extend(more.map(str::to_owned));
    for (keys, rows) in layout.groups(sheet) {
        for column in layout.answers..sheet.names.len() {
            let values: Vec<f64> = numbers(&rows, column).collect();
            let (spread, (words, of_words)) = (Spread::of(&values), words(&rows, column));
            let runs = of_words + spread.as_ref().map_or(0, |spread| spread.count);
            if runs == 0 {
                continue;
            }
            let mut row = keys.clone();
            let numbers = spread.map_or_else(Default::default, |s| {
                [s.mean, s.deviation, s.least, s.largest].map(text)
            });
            row.extend([
                sheet.names[column].clone(),
                sheet.units[column].trim_matches('-').to_owned(),
                runs.to_string(),
            ]);
            row.extend(numbers);
            row.push(words);
            all.rows.push((0, row));
        }
    }
    finish(all)
}

/// A row for each combination of the other keys, each answer and each scattered key: between which means the values of the key
/// move it.
#[must_use]
pub fn effects(sheet: &Sheet, layout: &Layout) -> Sheet {
    let mut all = begin(sheet, layout);
    let more = [
        "answer",
        "unit",
        "key",
        "least",
        "at",
        "largest",
        "at_largest",
        "effect",
    ];
    all.names.extend(more.map(str::to_owned));
    for (keys, rows) in layout.groups(sheet) {
        for column in layout.answers..sheet.names.len() {
            for key in layout.columns(true) {
                let mut means: Vec<(f64, &str)> = Vec::new();
                let mut of_value: BTreeMap<&str, Vec<&[String]>> = BTreeMap::new();
                for row in &rows {
                    of_value.entry(&row[key]).or_default().push(row);
                }
                for (value, rows) in &of_value {
                    let values: Vec<f64> = numbers(rows, column).collect();
                    means.extend(Spread::of(&values).map(|spread| (spread.mean, *value)));
                }
                means.sort_by(|a, b| a.0.total_cmp(&b.0));
                let (Some(first), Some(last)) = (means.first(), means.last()) else {
                    continue;
                };
                if means.len() < 2 {
                    continue;
                }
                let mut row = keys.clone();
                row.extend([
                    sheet.names[column].clone(),
                    sheet.units[column].trim_matches('-').to_owned(),
                    sheet.names[key].clone(),
                    text(first.0),
                    first.1.to_owned(),
                    text(last.0),
                    last.1.to_owned(),
                    text(last.0 - first.0),
                ]);
                all.rows.push((0, row));
            }
        }
    }
    finish(all)
}

/// A table with the columns of keys that are not scattered.
fn begin(sheet: &Sheet, layout: &Layout) -> Sheet {
    Sheet {
        computed_share: None,
        names: layout
            .columns(false)
            .map(|k| sheet.names[k].clone())
            .collect(),
        units: layout
            .columns(false)
            .map(|k| sheet.units[k].clone())
            .collect(),
        rows: Vec::new(),
    }
}

fn finish(mut sheet: Sheet) -> Sheet {
    sheet.units.resize(sheet.names.len(), String::new());
    for (k, (number, _)) in sheet.rows.iter_mut().enumerate() {
        *number = k;
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(text: &str) -> Sheet {
        Sheet::parse(text).unwrap()
    }

    const TABLE: &str = "# units: m/s,-,-,-,-,m,-\n\
        v,seed,k,run,state,hole,verdict\n\
        3000.0,1,a,r,finished,1.0,held\n\
        3000.0,2,a,r,finished,3.0,perforated\n\
        3000.0,1,b,r,finished,2.0,held\n\
        3000.0,2,b,r,finished,4.0,held\n\
        5000.0,1,a,r,finished,7.0,held\n\
        5000.0,2,a,r,failed,,\n";

    fn layout() -> Layout {
        Layout {
            scattered: vec![false, true, true],
            answers: 5,
        }
    }

    #[test]
    fn repetitions_have_means_and_bands() {
        let bands = bands(&sheet(TABLE), &layout());
        let rows: Vec<&Vec<String>> = bands.rows.iter().map(|row| &row.1).collect();
        let names = [
            "v",
            "answer",
            "unit",
            "runs",
            "mean",
            "deviation",
            "least",
            "largest",
            "words",
        ];
        assert_eq!(bands.names, names);
        let deviation = format!("{:?}", (5.0_f64 / 3.0).sqrt());
        assert_eq!(
            rows[0][..],
            [
                "3000.0", "hole", "m", "4", "2.5", &deviation, "1.0", "4.0", ""
            ]
        );
        assert_eq!(rows[1][8], "held 3, perforated 1");
        assert_eq!(rows[2][3..8], ["1", "7.0", "0.0", "7.0", "7.0"]);
    }

    #[test]
    fn effects_are_differences_of_means() {
        let effects = effects(&sheet(TABLE), &layout());
        let rows: Vec<&Vec<String>> = effects.rows.iter().map(|row| &row.1).collect();
        assert_eq!(
            rows[0][1..],
            ["hole", "m", "seed", "1.5", "1", "3.5", "2", "2.0"]
        );
        assert_eq!(rows[1][3..], ["k", "2.0", "a", "3.0", "b", "1.0"]);
        // One seed alone has an answer at the other speed.
        assert_eq!(rows.len(), 2);
    }
}
