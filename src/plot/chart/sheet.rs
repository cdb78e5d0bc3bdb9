//! A chart as a table.

use super::curves::{Chart, Curve, Quantity};
use results::Sheet;

/// The column that names curves.
pub const CURVE: &str = "curve";

impl Chart {
    /// The points of all curves, in SI units: a row for each, with the name of its curve if there are
    /// several. Cells are empty where a line is interrupted. What marks the points of a line again is
    /// left out.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let curves: Vec<&Curve> = self.distinct().collect();
        let named = curves.len() > 1
            || curves
                .iter()
                .any(|curve| !curve.name_in_tables().is_empty());
        let [x, y] = [(&self.x, "x"), (&self.y, "y")].map(|(axis, other)| column(axis, other));
        let y = if x == y { format!("{y}_y") } else { y };
        let name = named.then(|| CURVE.to_owned());
        let mut sheet = Sheet {
            computed_share: None,
            names: name.into_iter().chain([x, y]).collect(),
            units: named.then(String::new).into_iter().collect(),
            rows: Vec::new(),
        };
        sheet
            .units
            .extend([&self.x, &self.y].map(|axis| axis.unit.clone()));
        for curve in curves {
            for point in &curve.points {
                let name = named.then(|| curve.name_in_tables().to_owned());
                let cells = name.into_iter().chain(point.map(cell)).collect();
                sheet.rows.push((sheet.rows.len(), cells));
            }
        }
        sheet
    }

    /// The curves without those that draw the points of an earlier one again.
    fn distinct(&self) -> impl Iterator<Item = &Curve> {
        let again = move |k: usize, curve: &Curve| {
            let mut earlier = self.curves[..k].iter();
            curve.name_in_tables().is_empty() && earlier.any(|other| other.bits().eq(curve.bits()))
        };
        let all = self.curves.iter().enumerate();
        let all = all.filter(|(_, curve)| !curve.points.is_empty());
        all.filter(move |(k, curve)| !again(*k, curve))
            .map(|(_, curve)| curve)
    }
}

impl Curve {
    /// Its name in a table.
    fn name_in_tables(&self) -> &str {
        if self.in_tables.is_empty() {
            &self.name
        } else {
            &self.in_tables
        }
    }

    /// Its points, by their bits: a line is interrupted by NaN, which is not equal to itself.
    fn bits(&self) -> impl Iterator<Item = [u64; 2]> {
        self.points.iter().map(|point| point.map(f64::to_bits))
    }
}

/// The name of an axis as that of a column.
fn column(axis: &Quantity, other: &str) -> String {
    let words: Vec<&str> = axis.label.split_whitespace().collect();
    match &words[..] {
        [] => other.to_owned(),
        words => words.join("_"),
    }
}

fn cell(value: f64) -> String {
    if value.is_finite() {
        format!("{value:?}")
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::header::Mark;

    #[test]
    fn a_table_has_the_points_of_each_curve_once() {
        let axis = |label: &str, unit: &str| Quantity {
            label: label.to_owned(),
            unit: unit.to_owned(),
            ..Quantity::default()
        };
        let curve = |name: &str, points: &[[f64; 2]]| Curve {
            name: name.to_owned(),
            points: points.to_vec(),
            ..Curve::default()
        };
        let line = [[0.0, 1e-9], [f64::NAN, f64::NAN], [2.0, 3.0]];
        let mut chart = Chart {
            x: axis("time", "s"),
            y: axis("kinetic energy", "J"),
            curves: vec![curve("", &line)],
            ..Chart::default()
        };
        let rings = Curve {
            mark: Mark::Rings,
            ..curve("", &line[..1])
        };
        let text = |chart: &Chart| String::from_utf8(chart.sheet().text()).unwrap();
        let alone = "# units: s,J\ntime,kinetic_energy\n0.0,1e-9\n,\n2.0,3.0\n";
        assert_eq!(text(&chart), alone);
        chart.curves.push(Curve {
            in_tables: "a, b".to_owned(),
            ..curve("", &[[5.0, 6.0]])
        });
        chart.curves.push(rings);
        let points = chart.curves[0].points.clone();
        chart.curves[2].points = points;
        let several = "# units: -,s,J\ncurve,time,kinetic_energy\n,0.0,1e-9\n,,\n,2.0,3.0\n\"a, b\",5.0,6.0\n";
        assert_eq!(text(&chart), several);
    }
}
