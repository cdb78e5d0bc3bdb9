//! Convergence of the answers of a case with its spacing.

use super::answers::{Answer, Answers, is_wanted};
use super::richardson::{Basis, Estimate};
use super::table::Ended;
use super::{Sweep, SweepError};
use files::output::{Sheet, write_atomically};

/// Columns of `converge.csv` before and after those of the spacings.
const BEFORE: [&str; 2] = ["answer", "unit"];
const AFTER: [&str; 5] = ["order", "limit", "uncertainty", "basis", "remarks"];

/// A table of answers by spacing: a row for each answer, a column for each spacing (m), then order, limit and
/// uncertainty in the answer's unit, what these rest on, and remarks.
#[derive(Debug)]
pub struct Converged(Sheet);

/// A run: its spacing (m) and its answers.
type Run<'a> = (f64, &'a Answers);

impl Converged {
    /// Reads the ends of a sweep over spacings: of each answer its values, coarsest first, and the
    /// estimate of its limit by Richardson's rule.
    ///
    /// # Errors
    /// Those of [`Sweep::run`].
    pub fn of(sweep: &Sweep) -> Result<Self, SweepError> {
        let rows = sweep.rows()?;
        let mut runs = Vec::new();
        for (point, ended) in &rows {
            let spacing = point.values.first().and_then(|value| value.number);
            if let (Some((spacing, _)), Some(Ended::Answered(answers))) = (spacing, ended) {
                runs.push((spacing, answers));
            }
        }
        Ok(Self::new(runs, &sweep.definition.answers))
    }

    fn new(mut runs: Vec<Run>, wanted: &[String]) -> Self {
        runs.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut names: Vec<String> = BEFORE.map(str::to_owned).to_vec();
        names.extend(runs.iter().map(|(spacing, _)| format!("{spacing:?}")));
        names.extend(AFTER.map(str::to_owned));
        let mut answers: Vec<&String> = runs.iter().flat_map(|(_, own)| own.keys()).collect();
        answers.sort_unstable();
        answers.dedup();
        let wanted = answers.into_iter().filter(|name| is_wanted(name, wanted));
        let rows = wanted.filter_map(|name| row(name, &runs));
        Self(Sheet {
            computed_share: None,
            units: vec![String::new(); names.len()],
            rows: rows.enumerate().collect(),
            names,
        })
    }

    /// Writes `converge.csv`.
    ///
    /// # Errors
    /// [`SweepError::Output`].
    pub fn write(&self, sweep: &Sweep) -> Result<(), SweepError> {
        let path = sweep.definition.folder.join("converge.csv");
        Ok(write_atomically(&path, &self.0.text())?)
    }

    /// Lines for people: a header, then each answer with its finest value, its limit, the half width of the band,
    /// the order and remarks.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let n = self.0.names.len();
        let short = |text: &str| match text.parse::<f64>() {
            Ok(value) => format!("{value:.5e}"),
            Err(_) if text.is_empty() => "-".to_owned(),
            Err(_) => text.to_owned(),
        };
        let header = ["answer", "unit", "finest", "limit", "±", "order", ""];
        let mut cells = vec![header.map(str::to_owned)];
        for (_, row) in &self.0.rows {
            let [finest, order, limit, band, basis, remarks] =
                [n - 6, n - 5, n - 4, n - 3, n - 2, n - 1].map(|k| &row[k]);
            let order = order
                .parse::<f64>()
                .map_or("-".to_owned(), |p| format!("{p:.2}"));
            let said = match basis.as_str() {
                "observed" => remarks.clone(),
                _ if remarks.is_empty() => basis.clone(),
                _ => format!("{basis}; {remarks}"),
            };
            let unit = if row[1].is_empty() { "-" } else { &row[1] };
            cells.push([
                row[0].clone(),
                unit.to_owned(),
                short(finest),
                short(limit),
                short(band),
                order,
                said,
            ]);
        }
        let widths: [usize; 7] = std::array::from_fn(|k| {
            let lengths = cells.iter().map(|row| row[k].chars().count());
            lengths.max().unwrap_or_default()
        });
        let line = |row: &[String; 7]| {
            let padded = row.iter().zip(widths);
            let padded: Vec<String> = padded.map(|(cell, w)| format!("{cell:<w$}")).collect();
            padded.join("  ").trim_end().to_owned()
        };
        cells.iter().map(line).collect()
    }
}

/// The number that an answer is, unless it is undefined.
fn number(answer: Option<&Answer>) -> Option<f64> {
    let number = answer?.text.parse::<f64>().ok();
    number.filter(|number| number.is_finite())
}

/// The row of an answer; nothing if no run has it.
fn row(name: &str, runs: &[Run]) -> Option<Vec<String>> {
    let answers: Vec<Option<&Answer>> = runs.iter().map(|(_, all)| all.get(name)).collect();
    let text = |answer: Option<&Answer>| answer.map_or_else(String::new, |a| a.text.clone());
    let texts: Vec<String> = answers.iter().copied().map(text).collect();
    if texts.iter().all(String::is_empty) {
        return None;
    }
    let mut unit = answers.iter().flatten().map(|answer| answer.unit.clone());
    let mut row = vec![name.to_owned(), unit.next_back().unwrap_or_default()];
    row.extend(texts.iter().cloned());
    let numbers: Vec<Option<f64>> = answers.iter().map(|answer| number(*answer)).collect();
    let is_word = |text: &String| !text.is_empty() && text.parse::<f64>().is_err();
    row.extend(if texts.iter().any(is_word) {
        words(&texts)
    } else {
        numbers_told(runs, &answers, &numbers)
    });
    Some(row)
}

/// What the last columns say of an answer that is a word.
fn words(texts: &[String]) -> [String; 5] {
    let basis = if texts.windows(2).all(|pair| pair[0] == pair[1]) {
        ("same", "")
    } else {
        ("differs", "no number, and not the same at all spacings")
    };
    let [none, basis, remark] = ["", basis.0, basis.1].map(str::to_owned);
    [none.clone(), none.clone(), none, basis, remark]
}

/// What they say of a number.
fn numbers_told(runs: &[Run], answers: &[Option<&Answer>], numbers: &[Option<f64>]) -> [String; 5] {
    let defined = runs.iter().zip(numbers);
    let defined = defined.filter_map(|((spacing, _), number)| Some((*spacing, (*number)?)));
    let (spacings, values): (Vec<f64>, Vec<f64>) = defined.unzip();
    let mut remarks = Vec::new();
    let absent = runs
        .iter()
        .zip(numbers)
        .filter(|(_, number)| number.is_none());
    let absent: Vec<String> = absent.map(|((h, _), _)| format!("{h:?}")).collect();
    if !absent.is_empty() && absent.len() < runs.len() {
        remarks.push(format!("undefined at {} m", absent.join(" m, ")));
    }
    let Some(Some(finest)) = numbers.last() else {
        let [none, basis] = ["", "undefined"].map(str::to_owned);
        return [none.clone(), none.clone(), none, basis, remarks.join("; ")];
    };
    let mut estimate = Estimate::new(&spacings, &values);
    match (estimate.basis, estimate.order) {
        (Basis::Clamped, Some(order)) => {
            let beyond = if order > 1.0 { "above" } else { "below" };
            remarks.push(format!("observed order {beyond} {order}"));
        }
        (Basis::Oscillates, _) => remarks.push("no limit; ± is the range".to_owned()),
        (Basis::Diverges, _) => remarks.push("no limit: differences grow".to_owned()),
        _ => {}
    }
    // What a run says of its own figure holds at any order.
    let own = answers.last().copied().flatten();
    let own = own.and_then(|answer| answer.uncertainty.parse::<f64>().ok());
    if let (Some(band), Some(own)) = (&mut estimate.uncertainty, own)
        && own > *band
    {
        *band = own;
        remarks.push("± is the figure's own".to_owned());
    }
    let used = &values[values.len().saturating_sub(3)..];
    let has = |negative: bool| used.iter().any(|v| *v != 0.0 && (*v < 0.0) == negative);
    let within = |band: f64| *finest != 0.0 && finest.abs() <= band;
    if has(true) && has(false) {
        remarks.push("values differ in sign".to_owned());
    } else if estimate.uncertainty.is_some_and(within) {
        remarks.push("± reaches zero".to_owned());
    }
    let told = [estimate.order, estimate.limit, estimate.uncertainty];
    let [order, limit, uncertainty] =
        told.map(|v| v.map_or_else(String::new, |v| format!("{v:?}")));
    let basis = estimate.basis.word().to_owned();
    [order, limit, uncertainty, basis, remarks.join("; ")]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answers(all: &[(&str, &str, &str)]) -> Answers {
        let answer = |(name, text, uncertainty): &(&str, &str, &str)| {
            let answer = Answer {
                text: (*text).to_owned(),
                unit: "m".to_owned(),
                uncertainty: (*uncertainty).to_owned(),
            };
            (format!("measures.{name}"), answer)
        };
        all.iter().map(answer).collect()
    }

    /// The last columns by answer, of runs at spacings of 4, 1 and 2.
    fn told(coarse: &Answers, fine: &Answers, middle: &Answers) -> Vec<Vec<String>> {
        let runs = vec![(4.0, coarse), (1.0, fine), (2.0, middle)];
        let Converged(sheet) = Converged::new(runs, &[]);
        let spacings = ["answer", "unit", "4.0", "2.0", "1.0"];
        assert_eq!(sheet.names[..5], spacings);
        sheet.rows.into_iter().map(|(_, row)| row).collect()
    }

    #[test]
    fn answers_tell_their_limits_or_why_there_is_none() {
        let coarse = [
            ("a", "9.0", ""),
            ("b", "1.0", "0.1"),
            ("c", "NaN", ""),
            ("d", "pinhole", ""),
            ("e", "3.0", "0.5"),
            ("f", "2.0", ""),
            ("g", "1.0", ""),
        ];
        let middle = [
            ("a", "7.0", ""),
            ("b", "-2.0", "0.1"),
            ("c", "4.0", ""),
            ("d", "perforated", ""),
            ("e", "3.0", "0.3"),
            ("f", "2.0", ""),
            ("g", "2.0", ""),
        ];
        let fine = [
            ("a", "6.0", ""),
            ("b", "1.0", "0.1"),
            ("c", "3.0", ""),
            ("d", "perforated", ""),
            ("e", "3.0", "0.2"),
            ("f", "NaN", ""),
            ("g", "4.0", ""),
        ];
        let rows = told(&answers(&coarse), &answers(&fine), &answers(&middle));
        let short = |text: &String| match text.parse::<f64>() {
            Ok(number) => format!("{number:.6}"),
            Err(_) => text.clone(),
        };
        let last = rows.iter().map(|row| row[5..].iter().map(short));
        let last: Vec<String> = last.map(|row| row.collect::<Vec<_>>().join("|")).collect();
        assert_eq!(
            last,
            [
                "1.000000|5.000000|1.250000|observed|",
                "||3.000000|oscillates|no limit; ± is the range; values differ in sign",
                "1.000000|2.000000|3.000000|assumed|undefined at 4.0 m; ± reaches zero",
                "|||differs|no number, and not the same at all spacings",
                "|3.000000|0.200000|same|± is the figure's own",
                "|||undefined|undefined at 1.0 m",
                "|||diverges|no limit: differences grow",
            ]
        );
    }

    #[test]
    fn lines_stand_in_columns() {
        let run = |text| answers(&[("long_name", text, ""), ("x", "1", "")]);
        let runs = [run("9"), run("7"), run("6")];
        let runs = vec![(4.0, &runs[0]), (2.0, &runs[1]), (1.0, &runs[2])];
        let lines = Converged::new(runs, &[]).lines();
        let expected = [
            "answer              unit  finest     limit      ±          order",
            "measures.long_name  m     6.00000e0  5.00000e0  1.25000e0  1.00",
            "measures.x          m     1.00000e0  1.00000e0  0.00000e0  -      same",
        ];
        assert_eq!(lines, expected);
    }
}
