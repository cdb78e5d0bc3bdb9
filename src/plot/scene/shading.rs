//! From what is seen to colours: soft light from the upper left, on white paper.

use super::buffer::{NOBODY, Seen};
use crate::canvas::{PAPER, Rgb};

/// Direction of the light: to the right, up, towards the viewer; of length one.
const LIGHT: [f32; 3] = [-0.445, 0.593, 0.671];

/// Brightness of what the light does not reach, and what it adds where it falls straight on.
const AROUND: f32 = 0.56;
const DIRECT: f32 = 0.52;

/// The light of the most hidden point.
const DARKEST: f32 = 0.28;

/// Share of the light behind that a transparent body takes away.
const OPACITY: f32 = 0.35;

/// The colour of a sample of a body of a colour, of which a share of the sky is open.
pub fn shade(seen: &Seen, open: f32, colour: Rgb) -> [f32; 3] {
    let normal = seen.normal();
    let facing: f32 = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum();
    // Light from a wide source goes round edges.
    let direct = (0.75 * facing + 0.25).max(0.0);
    let light = (AROUND + DIRECT * direct) * (DARKEST + (1.0 - DARKEST) * open);
    colour.map(|c| {
        let c = f32::from(c);
        if light <= 1.0 {
            c * light
        } else {
            // Light beyond the colour itself goes towards white.
            c + (255.0 - c) * (light - 1.0)
        }
    })
}

/// A layer of the picture: opaque bodies, or one transparent body.
pub struct Layer<'a> {
    pub seen: &'a [Seen],
    pub open: &'a [f32],
}

/// The colour of a sample through all layers, of which the first is opaque.
pub fn through(
    layers: &[Layer],
    index: usize,
    colour: &impl Fn(&Seen) -> Rgb,
    order: &mut Vec<(f32, usize)>,
) -> [f32; 3] {
    let at = |layer: &Layer| {
        let seen = &layer.seen[index];
        (seen.body != NOBODY).then(|| shade(seen, layer.open[index], colour(seen)))
    };
    let behind = layers.first().and_then(at);
    let mut mixed = behind.unwrap_or(PAPER.map(f32::from));
    if layers.len() < 2 {
        return mixed;
    }
    let back = layers[0].seen[index].depth;
    order.clear();
    let others = layers.iter().enumerate().skip(1);
    order.extend(
        others
            .map(|(k, layer)| (layer.seen[index].depth, k))
            .filter(|(depth, _)| *depth > back),
    );
    // The farthest first; of equals in the order of bodies.
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for &(_, k) in order.iter() {
        if let Some(front) = at(&layers[k]) {
            for (mixed, front) in mixed.iter_mut().zip(front) {
                *mixed += OPACITY * (front - *mixed);
            }
        }
    }
    mixed
}
