//! Bars: length, foot and profile.

use std::f64::consts::PI;

use super::figure::{Distribution, Figure, Findings};
use super::frame::Frame;
use super::matter::{Matter, raise};
use comm::Comm;
use model::Bar;

/// Most slices of a bar; longer ones have thicker slices.
const MOST: f64 = 512.0;

/// The foot is this many slices thick.
const FOOT: usize = 2;

/// Whole numbers in which volume is counted: so many in a cube of the spacing.
const UNIT: f64 = 1_073_741_824.0;

/// Diameters (m) of circles with the areas of slices, from the head to the foot.
fn diameters(
    bar: &Bar,
    matter: &Matter,
    comm: &Comm,
    frame: &Frame,
    [low, high]: [f64; 2],
) -> (f64, Vec<f64>) {
    let count = ((high - low) / bar.spacing).ceil().clamp(1.0, MOST);
    let thickness = (high - low) / count;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within the most"
    )]
    let slices = count as usize;
    let scale = UNIT / (bar.spacing * bar.spacing * bar.spacing);
    let counts = matter.counts(comm, slices, |i, counts| {
        if matter.body_of(i) != bar.body {
            return;
        }
        let (volume, size) = (matter.volume(i), matter.size(i));
        for (x, _) in matter.images(i) {
            let at = frame.turned(&x)[2];
            let (begin, end) = (at - 0.5 * size, at + 0.5 * size);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "no less than zero and cut at the last slice"
            )]
            let slice =
                |height: f64| (((height - low) / thickness).max(0.0) as usize).min(slices - 1);
            let (first, last) = (slice(begin), slice(end));
            for (k, count) in counts.iter_mut().enumerate().take(last + 1).skip(first) {
                #[expect(clippy::cast_precision_loss, reason = "counts are small")]
                let floor = low + k as f64 * thickness;
                let inside = end.min(floor + thickness) - begin.max(floor);
                #[expect(clippy::cast_possible_truncation, reason = "a fraction of a cube")]
                let share = (inside.max(0.0) / size * volume * scale).round() as i64;
                *count += share;
            }
        }
    });
    #[expect(clippy::cast_precision_loss, reason = "rounded once")]
    let diameter = |count: &i64| {
        (4.0 * (*count as f64 / scale / thickness) / PI)
            .max(0.0)
            .sqrt()
    };
    (thickness, counts.iter().map(diameter).collect())
}

/// The measures of a bar. Collective.
pub fn bar(bar: &Bar, matter: &Matter, comm: &Comm) -> Findings {
    let frame = Frame::new(&bar.foot);
    let [high, low] = matter.largest::<2>(comm, |i, most| {
        if matter.body_of(i) == bar.body {
            let half = 0.5 * matter.size(i);
            for (x, _) in matter.images(i) {
                let at = frame.turned(&x)[2];
                raise(&mut most[0], at + half);
                raise(&mut most[1], half - at);
            }
        }
    });
    let number = |name, value: f64| Figure::number(name, value, "m").within(bar.spacing);
    if !high.is_finite() {
        let names = ["length", "foot_diameter", "largest_diameter", "largest_at"];
        return Findings {
            figures: names.map(|name| number(name, f64::NAN)).to_vec(),
            distributions: Vec::new(),
        };
    }
    let low = -low;
    let (thickness, profile) = diameters(bar, matter, comm, &frame, [low, high]);
    // The mean area of the last slices.
    let foot = &profile[profile.len().saturating_sub(FOOT)..];
    #[expect(clippy::cast_precision_loss, reason = "one or two")]
    let area = foot.iter().map(|d| d * d).sum::<f64>() / foot.len() as f64;
    let from_foot = |slice: usize| {
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        let slices = (profile.len() - 1 - slice) as f64;
        slices * thickness
    };
    let largest =
        profile.iter().enumerate().fold(
            (0, 0.0),
            |best, (k, &d)| {
                if d >= best.1 { (k, d) } else { best }
            },
        );
    let bins = profile.iter().enumerate().rev();
    let bins = bins.map(|(k, &d)| [from_foot(k), from_foot(k) + thickness, d]);
    Findings {
        figures: vec![
            number("length", high - low),
            number("foot_diameter", area.sqrt()),
            number("largest_diameter", largest.1),
            number("largest_at", from_foot(largest.0) + 0.5 * thickness),
        ],
        distributions: vec![Distribution {
            name: "diameter_from_foot",
            along: "m",
            unit: "m",
            bins: bins.collect(),
        }],
    }
}
