//! The chart of an equation, with the shots of a sweep.

use super::laws::Law;
use super::table::{TAIL, onset_of};
use desk::sweep::{Onset, Shot};
use model::readable::tidy;
use plot::{Chart, Curve, Mark, Quantity, Rgb, colour_of};

/// Points of a curve, enough for sharp corners.
const POINTS: u32 = 800;
/// Colours of shots that failed and of those that did not.
const SHOTS: [(bool, &str, Rgb); 2] = [
    (true, "failed", [205, 60, 50]),
    (false, "held", [70, 160, 90]),
];

/// Where half of the runs fail, and 5 and 95 % of them, over the speeds of rows.
fn onset_curves(law: &Law, shots: &[Shot], rows: &[(f64, Vec<f64>)]) -> Vec<Curve> {
    let (Onset::Curve { middle, scale, .. }, Some(limit)) = (onset_of(law, shots), law.limit)
    else {
        return Vec::new();
    };
    let curve = |(share, name): (f64, &str)| {
        let ratio = libm::exp(middle + share * scale * TAIL);
        let points = rows
            .iter()
            .map(|(speed, values)| [*speed, ratio * values[limit]]);
        Curve {
            name: name.to_owned(),
            colour: if share == 0.0 {
                colour_of(1)
            } else {
                [170, 170, 170]
            },
            mark: Mark::Line,
            points: points.collect(),
            ..Curve::default()
        }
    };
    [
        (-1.0, "5 % of the runs fail"),
        (1.0, "95 %"),
        (0.0, "half of the runs fail"),
    ]
    .map(curve)
    .into()
}

/// The curves of all values over the speeds from the least to the greatest, shots among them.
pub(super) fn chart(law: &Law, speeds: &[f64], shots: &[Shot], axes: [Quantity; 2]) -> Chart {
    let all = || speeds.iter().copied().chain(shots.iter().map(|s| s.speed));
    let [from, to] = [
        all().fold(f64::INFINITY, f64::min),
        all().fold(0.0, f64::max),
    ];
    let step = (to - from) / f64::from(POINTS);
    let rows: Vec<(f64, Vec<f64>)> = (0..=POINTS)
        .map(|k| from + step * f64::from(k))
        .map(|speed| (speed, (law.at)(speed).values))
        .collect();
    let mut curves: Vec<Curve> = law
        .names
        .iter()
        .enumerate()
        .map(|(k, name)| Curve {
            name: (*name).to_owned(),
            colour: colour_of(k),
            mark: Mark::Line,
            points: rows
                .iter()
                .map(|(speed, values)| [*speed, values[k]])
                .collect(),
            ..Curve::default()
        })
        .collect();
    curves.extend(onset_curves(law, shots, &rows));
    for (failed, name, colour) in SHOTS {
        let those = shots.iter().filter(|shot| shot.failed == failed);
        let points: Vec<[f64; 2]> = those.map(|shot| [shot.speed, shot.diameter]).collect();
        if !points.is_empty() {
            curves.push(Curve {
                name: name.to_owned(),
                colour,
                mark: Mark::Rings,
                points,
                ..Curve::default()
            });
        }
    }
    let [x, y] = axes;
    Chart {
        title: law.title.clone(),
        subtitle: tidy(&law.subtitle),
        x,
        y,
        curves,
    }
}
