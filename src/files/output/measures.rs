//! Tables of measures: `measures.csv`, a row for each figure, and `distributions.csv`, one for each bin.

use super::{Column, Table, Value, unit_of_model};
use engine::measure::{Distribution, Figure, Findings, Told};
use model::Measure;

fn columns(known: &[(&str, &str)]) -> Vec<Column> {
    let column = |(name, unit): &(&str, &str)| Column::new(name, unit);
    known.iter().map(column).collect()
}

/// The columns of `measures.csv`.
#[must_use]
pub fn of_figures() -> Vec<Column> {
    columns(&[
        ("time", "s"),
        ("measure", ""),
        ("kind", ""),
        ("figure", ""),
        ("value", ""),
        ("uncertainty", ""),
        ("unit", ""),
    ])
}

/// The columns of `distributions.csv`.
#[must_use]
pub fn of_distributions() -> Vec<Column> {
    columns(&[
        ("time", "s"),
        ("measure", ""),
        ("distribution", ""),
        ("from", ""),
        ("to", ""),
        ("unit_along", ""),
        ("value", ""),
        ("unit", ""),
    ])
}

/// Rows of `measures.csv` at a time (s) in a model of `dimension` dimensions.
pub fn figures<'a>(
    time: f64,
    found: impl Iterator<Item = (&'a Measure, &'a Findings)>,
    dimension: usize,
) -> impl Iterator<Item = Vec<Value<'a>>> {
    found.flat_map(move |(measure, found)| {
        let row = move |figure: &'a Figure| {
            vec![
                Value::Real(time),
                Value::Word(&measure.name),
                Value::Word(measure.kind.word()),
                Value::Word(&figure.name),
                match figure.value {
                    Told::Number(number) => Value::Real(number),
                    Told::Word(word) => Value::Word(word),
                },
                figure.uncertainty.map_or(Value::Word(""), Value::Real),
                Value::Word(unit_of_model(figure.unit, dimension)),
            ]
        };
        found.figures.iter().map(row)
    })
}

/// Rows of `distributions.csv` at a time (s).
pub fn distributions<'a>(
    time: f64,
    found: impl Iterator<Item = (&'a Measure, &'a Findings)>,
) -> impl Iterator<Item = Vec<Value<'a>>> {
    found.flat_map(move |(measure, found)| {
        let rows = move |all: &'a Distribution| {
            let row = move |[from, to, value]: &[f64; 3]| {
                vec![
                    Value::Real(time),
                    Value::Word(&measure.name),
                    Value::Word(all.name),
                    Value::Real(*from),
                    Value::Real(*to),
                    Value::Word(all.along),
                    Value::Real(*value),
                    Value::Word(all.unit),
                ]
            };
            all.bins.iter().map(row)
        };
        found.distributions.iter().flat_map(rows)
    })
}

/// `measures.csv` of all rows, as its file holds it.
#[must_use]
pub fn table(rows: &[Vec<Value>]) -> Vec<u8> {
    Table::whole(&of_figures(), rows)
}
