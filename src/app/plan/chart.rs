//! Strong and weak scaling in one chart.

use files::plan::{Row, Weak};
use plot::{Chart, Curve, Mark, Quantity, Rgb, colour_of};

/// Efficiency over the number of ranks: of the model as it is, and of one that is refined as ranks
/// become more, so that each core has as many particles.
pub fn chart(title: &str, particles: usize, per_core: u32, rows: &[Row], weak: &[Weak]) -> Chart {
    let mut curves = Vec::new();
    for levels in 1..=3 {
        let strong = rows.iter().filter(|row| row.levels == levels);
        let strong = strong.map(|row| (row.ranks, row.efficiency));
        let weak = weak.iter().filter(|weak| weak.levels == levels);
        let weak = weak.map(|weak| (weak.ranks, weak.efficiency));
        let colour = colour_of(levels - 1);
        let plural = if levels == 1 { "" } else { "s" };
        for (kind, mark, points) in [
            ("strong", Mark::Line, points(strong)),
            ("weak", Mark::Thin, points(weak)),
        ] {
            if !points.is_empty() {
                let name = format!("{kind}, {levels} level{plural}");
                curves.extend(with_dots(name, colour, mark, points));
            }
        }
    }
    let quantity = |label: &str, logarithmic| Quantity {
        label: label.to_owned(),
        logarithmic,
        ..Quantity::default()
    };
    Chart {
        title: title.to_owned(),
        subtitle: format!(
            "strong: {particles} particles; weak: the same model refined, {per_core} particles a core"
        ),
        x: quantity("ranks", true),
        y: Quantity {
            span: Some([0.0, 1.05]),
            ..quantity("efficiency against one core alone", false)
        },
        curves,
    }
}

#[allow(clippy::cast_precision_loss, reason = "few ranks")]
fn points(rows: impl Iterator<Item = (usize, f64)>) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = rows.map(|(ranks, value)| [ranks as f64, value]).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// A curve and its points themselves.
fn with_dots(name: String, colour: Rgb, mark: Mark, points: Vec<[f64; 2]>) -> [Curve; 2] {
    let curve = |name: String, mark, points| Curve {
        name,
        colour,
        mark,
        points,
        ..Curve::default()
    };
    [
        curve(name, mark, points.clone()),
        curve(String::new(), Mark::Dots, points),
    ]
}
