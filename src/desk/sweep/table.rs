//! The tables of a sweep: points with their answers, and limits.

use std::collections::BTreeSet;

use super::answers::{Answers, is_wanted};
use super::plan::{Bisection, Plan};
use super::point::{Point, short};
use super::values::Value;
use files::output::Sheet;
use model::units::Powers;

/// The end of the run of a point.
#[derive(Debug, Clone, PartialEq)]
pub enum Ended {
    /// Its answers.
    Answered(Answers),
    /// Why it has no answer.
    Failed(String),
}

impl Ended {
    fn word(&self) -> &'static str {
        match self {
            Self::Answered(_) => "finished",
            Self::Failed(_) => "failed",
        }
    }
}

/// A column of values: SI numbers if all of them are, of one unit, else texts.
struct Column {
    name: String,
    unit: String,
    is_number: bool,
}

impl Column {
    fn new<'a>(key: &str, keys: &[String], values: impl Iterator<Item = &'a Value>) -> Self {
        let powers: Option<BTreeSet<Powers>> = values.map(|v| Some(v.number?.1)).collect();
        let one = powers.and_then(|powers| match powers.len() {
            1 => powers.first().copied(),
            _ => None,
        });
        let is_alone = keys
            .iter()
            .filter(|other| short(other) == short(key))
            .count()
            == 1;
        Self {
            name: if is_alone { short(key) } else { key }.to_owned(),
            unit: one.map_or_else(String::new, |powers| unit(&powers)),
            is_number: one.is_some(),
        }
    }

    fn cell(&self, value: &Value) -> String {
        match value.number {
            Some((number, _)) if self.is_number => format!("{number:?}"),
            _ => value.text.clone(),
        }
    }
}

/// Units that have names of their own.
const NAMED: [(&str, Powers); 2] = [("Pa", [-1, 1, -2, 0, 0]), ("J", [2, 1, -2, 0, 0])];

/// The SI unit of some powers: `m/s`.
fn unit(powers: &Powers) -> String {
    if let Some((name, _)) = NAMED.iter().find(|(_, own)| own == powers) {
        return (*name).to_owned();
    }
    let symbols = ["m", "kg", "s", "K", "rad"];
    let power = |&(symbol, power): &(&str, i32)| match power.abs() {
        1 => symbol.to_owned(),
        n => format!("{symbol}^{n}"),
    };
    let pairs: Vec<(&str, i32)> = symbols.into_iter().zip(*powers).collect();
    let above: Vec<String> = pairs.iter().filter(|p| p.1 > 0).map(power).collect();
    let below: Vec<String> = pairs.iter().filter(|p| p.1 < 0).map(power).collect();
    match (above.is_empty(), below.len()) {
        (_, 0) => above.join(" "),
        (true, _) => format!("1/{}", below.join("/")),
        (false, _) => format!("{}/{}", above.join(" "), below.join("/")),
    }
}

/// Columns of the keys.
fn columns(keys: &[String], points: &[&[Value]]) -> Vec<Column> {
    let of = |k: usize| points.iter().filter_map(move |values| values.get(k));
    let all = keys.iter().enumerate();
    all.map(|(k, key)| Column::new(key, keys, of(k))).collect()
}

/// A row for each point: its run, its values, how it ended, its answers.
#[must_use]
pub fn points(keys: &[String], rows: &[(Point, Option<Ended>)], wanted: &[String]) -> Sheet {
    let values: Vec<&[Value]> = rows.iter().map(|(point, _)| &point.values[..]).collect();
    let columns = columns(keys, &values);
    let mut names: Vec<String> = columns.iter().map(|c| c.name.clone()).collect();
    let mut units: Vec<String> = columns.iter().map(|c| c.unit.clone()).collect();
    names.extend(["run".to_owned(), "state".to_owned()]);
    let mut answered: Vec<(String, String)> = Vec::new();
    let mut seen = BTreeSet::new();
    for (_, ended) in rows {
        let Some(Ended::Answered(answers)) = ended else {
            continue;
        };
        for (name, answer) in answers.iter().filter(|(name, _)| is_wanted(name, wanted)) {
            if seen.insert(name.clone()) {
                answered.push((name.clone(), answer.unit.clone()));
            }
        }
    }
    answered.sort();
    units.resize(names.len(), String::new());
    names.extend(answered.iter().map(|(name, _)| name.clone()));
    units.extend(answered.iter().map(|(_, unit)| unit.clone()));
    let row = |(point, ended): &(Point, Option<Ended>)| {
        let cells = columns.iter().zip(&point.values);
        let mut row: Vec<String> = cells.map(|(column, value)| column.cell(value)).collect();
        row.push(point.name.clone());
        row.push(ended.as_ref().map_or("open", Ended::word).to_owned());
        let own = match ended {
            Some(Ended::Answered(answers)) => Some(answers),
            _ => None,
        };
        row.extend(answered.iter().map(|(name, _)| {
            let answer = own.and_then(|answers| answers.get(name));
            answer.map_or_else(String::new, |answer| answer.text.clone())
        }));
        row
    };
    let rows = rows.iter().map(row).enumerate();
    Sheet {
        computed_share: None,
        names,
        units,
        rows: rows.collect(),
    }
}

/// A row for each bisection: the values of the grid, between which values the condition changes.
#[must_use]
pub fn limits(plan: &Plan, bisections: &[(Vec<Value>, Bisection)]) -> Option<Sheet> {
    let bisected = plan.bisected.as_ref()?;
    let (last, others) = plan.keys.split_last()?;
    let values: Vec<&[Value]> = bisections.iter().map(|(values, _)| &values[..]).collect();
    let columns = columns(others, &values);
    let ends = bisected.range.ends.map(|end| bisected.range.value(end));
    let column = Column::new(last, &plan.keys, ends.iter());
    let mut names: Vec<String> = columns.iter().map(|c| c.name.clone()).collect();
    let mut units: Vec<String> = columns.iter().map(|c| c.unit.clone()).collect();
    for name in ["limit", "without", "with"] {
        names.push(format!("{}_{name}", column.name));
        units.push(column.unit.clone());
    }
    names.push("state".to_owned());
    units.push(String::new());
    let row = |(values, bisection): &(Vec<Value>, Bisection)| {
        let mut row: Vec<String> = columns.iter().zip(values).map(|(c, v)| c.cell(v)).collect();
        let (between, state) = match bisection {
            Bisection::Open => (None, "open"),
            Bisection::Between(values) => (Some(values), "found"),
            Bisection::Nowhere(true) => (None, "always"),
            Bisection::Nowhere(false) => (None, "never"),
            Bisection::Failed => (None, "failed"),
        };
        let middle = between.and_then(|[a, b]| Some(0.5 * (a.number?.0 + b.number?.0)));
        row.push(middle.map_or_else(String::new, |middle| format!("{middle:?}")));
        for k in 0..2 {
            row.push(between.map_or_else(String::new, |values| column.cell(&values[k])));
        }
        row.push(state.to_owned());
        row
    };
    let rows = bisections.iter().map(row).enumerate();
    Some(Sheet {
        computed_share: None,
        names,
        units,
        rows: rows.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::answers::Answer;
    use super::*;

    fn point(values: &[&str]) -> Point {
        let keys: Vec<String> = (0..values.len()).map(|k| format!("a.k{k}")).collect();
        let values = values.iter().map(|v| Value::new(v)).collect();
        Point::new(&keys, values)
    }

    #[test]
    fn points_have_rows_of_si_numbers_and_answers() {
        let answer = |text: &str| Answer {
            text: text.to_owned(),
            unit: "m".to_owned(),
            ..Answer::default()
        };
        let answers = |name: &str| Ended::Answered(Answers::from([(name.to_owned(), answer("7"))]));
        let rows = [
            (point(&["3 km/s", "x"]), Some(answers("fragments.b"))),
            (point(&["5 km/s", "2"]), Some(answers("fragments.a"))),
            (
                point(&["7 km/s", "y"]),
                Some(Ended::Failed("why".to_owned())),
            ),
            (point(&["9 km/s", "y"]), None),
        ];
        let keys = ["a.k0".to_owned(), "a.k1".to_owned()];
        let sheet = points(&keys, &rows, &[]);
        assert_eq!(
            sheet.names,
            ["k0", "k1", "run", "state", "fragments.a", "fragments.b"]
        );
        assert_eq!(sheet.units, ["m/s", "", "", "", "m", "m"]);
        let states: Vec<&str> = sheet.rows.iter().map(|row| row.1[3].as_str()).collect();
        assert_eq!(states, ["finished", "finished", "failed", "open"]);
        assert_eq!(sheet.rows[0].1[0], "3000.0");
        assert_eq!(sheet.rows[0].1[1], "x");
        assert_eq!(sheet.rows[0].1[4..], ["", "7"]);
        assert_eq!(sheet.rows[1].1[4..], ["7", ""]);
    }

    #[test]
    fn units_are_written_as_inputs_take_them() {
        assert_eq!(unit(&[1, 0, -1, 0, 0]), "m/s");
        assert_eq!(unit(&[-1, 1, -2, 0, 0]), "Pa");
        assert_eq!(unit(&[-1, 1, -3, 0, 0]), "kg/m/s^3");
        assert_eq!(unit(&[0, 0, -1, 0, 0]), "1/s");
        assert_eq!(unit(&[0; 5]), "");
    }
}
