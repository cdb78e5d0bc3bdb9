//! Convergence of the answers of a case with its spacing.

use super::answers::is_wanted;
use super::richardson::extrapolate;
use super::table::Ended;
use super::{Sweep, SweepError};
use files::output::{Sheet, write_atomically};

/// A table of answers by spacing.
#[derive(Debug)]
pub struct Converged(Sheet);

impl Converged {
    /// Reads the ends of a sweep over spacings, coarsest first: of each answer that is a number its
    /// values, and from the three finest rate, limit and uncertainty.
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
        runs.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut names: Vec<String> = vec!["answer".to_owned(), "unit".to_owned()];
        names.extend(runs.iter().map(|(spacing, _)| format!("{spacing:?}")));
        names.extend(["rate", "limit", "uncertainty"].map(str::to_owned));
        let mut table = Vec::new();
        let wanted = &sweep.definition.answers;
        let of_finest = runs.last().into_iter().flat_map(|(_, answers)| *answers);
        for (name, answer) in of_finest.filter(|(name, _)| is_wanted(name, wanted)) {
            let values = runs
                .iter()
                .map(|(_, answers)| answers.get(name)?.text.parse::<f64>().ok());
            let values: Vec<Option<f64>> = values.collect();
            if values.iter().all(Option::is_none) {
                continue;
            }
            let mut row = vec![name.clone(), answer.unit.clone()];
            let text = |value: &Option<f64>| value.map_or_else(String::new, |v| format!("{v:?}"));
            row.extend(values.iter().map(text));
            let extrapolated = finest(&runs.iter().map(|run| run.0).collect::<Vec<_>>(), &values)
                .and_then(|(spacings, values)| extrapolate(spacings, values));
            let extrapolated = extrapolated.map(|f| [f.rate, f.limit, f.uncertainty]);
            row.extend(
                (0..3).map(|k| extrapolated.map_or_else(String::new, |f| format!("{:?}", f[k]))),
            );
            table.push(row);
        }
        Ok(Self(Sheet {
            units: vec![String::new(); names.len()],
            names,
            rows: table.into_iter().enumerate().collect(),
        }))
    }

    /// Writes `converge.csv`.
    ///
    /// # Errors
    /// [`SweepError::Output`].
    pub fn write(&self, sweep: &Sweep) -> Result<(), SweepError> {
        let path = sweep.definition.folder.join("converge.csv");
        Ok(write_atomically(&path, &self.0.text())?)
    }

    /// Lines for people: each answer, its finest value, its limit with the uncertainty, its rate.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let n = self.0.names.len();
        let mut lines = Vec::new();
        for (_, row) in &self.0.rows {
            let [finest, rate, limit, uncertainty] = [n - 4, n - 3, n - 2, n - 1].map(|k| &row[k]);
            let short = |text: &str| {
                text.parse::<f64>()
                    .map_or(String::new(), |v| format!("{v:.5e}"))
            };
            let unit = &row[1];
            lines.push(if rate.is_empty() {
                format!("{:<40} {} {unit}; no limit", row[0], short(finest))
            } else {
                let order: f64 = rate.parse().unwrap_or(f64::NAN);
                let (limit, around) = (short(limit), short(uncertainty));
                let finest = short(finest);
                format!(
                    "{:<40} {finest} {unit}; limit {limit} ± {around}, order {order:.2}",
                    row[0]
                )
            });
        }
        lines
    }
}

/// The last three spacings with their values.
fn finest(spacings: &[f64], values: &[Option<f64>]) -> Option<([f64; 3], [f64; 3])> {
    let first = spacings.len().checked_sub(3)?;
    let values: Option<Vec<f64>> = values[first..].iter().copied().collect();
    Some((spacings[first..].try_into().ok()?, values?.try_into().ok()?))
}
