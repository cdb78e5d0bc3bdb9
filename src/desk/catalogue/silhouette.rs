//! The mean area of the shadows of a surface.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::{cross, difference, dot, norm};
use crate::export::surface::Triangle;

/// Directions, spread evenly over half a sphere.
const DIRECTIONS: u32 = 48;

/// Pixels along the longer side of a shadow.
const PIXELS: usize = 160;

/// The mean (m²) of the areas of all shadows; of what is convex a quarter of its surface (Cauchy).
pub fn mean(triangles: &[Triangle], centre: &[f64; 3]) -> f64 {
    let shadows = (0..DIRECTIONS).into_par_iter();
    let shadows: Vec<f64> = shadows
        .map(|n| shadow(triangles, centre, &direction(n)))
        .collect();
    shadows.iter().sum::<f64>() / f64::from(DIRECTIONS)
}

/// A point of the spiral of Fibonacci on half a sphere.
fn direction(n: u32) -> [f64; 3] {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let z = (f64::from(n) + 0.5) / f64::from(DIRECTIONS);
    let (across, turn) = ((1.0 - z * z).sqrt(), golden * f64::from(n));
    [across * libm::cos(turn), across * libm::sin(turn), z]
}

/// The area (m²) of a shadow.
fn shadow(triangles: &[Triangle], centre: &[f64; 3], along: &[f64; 3]) -> f64 {
    let other = if along[0].abs() < 0.6 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let mut right = cross(along, &other);
    let length = norm(&right);
    right = right.map(|x| x / length);
    let up = cross(along, &right);
    let flat = |corner: &[f64; 3]| {
        let from = difference(corner, centre);
        [dot(&from, &right), dot(&from, &up)]
    };
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in triangles.iter().flatten().map(flat) {
        for a in 0..2 {
            low[a] = low[a].min(corner[a]);
            high[a] = high[a].max(corner[a]);
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "small")]
    let pixel = (high[0] - low[0]).max(high[1] - low[1]) / PIXELS as f64;
    if !(pixel > 0.0 && pixel.is_finite()) {
        return 0.0;
    }
    let mut dark = vec![false; PIXELS * PIXELS];
    for triangle in triangles {
        let corners = triangle.map(|corner| {
            let [x, y] = flat(&corner);
            [(x - low[0]) / pixel, (y - low[1]) / pixel]
        });
        cover(&corners, &mut dark);
    }
    #[expect(clippy::cast_precision_loss, reason = "small")]
    let count = dark.iter().filter(|dark| **dark).count() as f64;
    count * pixel * pixel
}

/// Darkens the pixels whose middles a triangle covers.
fn cover(corners: &[[f64; 2]; 3], dark: &mut [bool]) {
    let ends = |a: usize| {
        let all = corners.map(|corner| corner[a] - 0.5);
        let low = all
            .into_iter()
            .fold(f64::INFINITY, f64::min)
            .ceil()
            .max(0.0);
        let high = all.into_iter().fold(f64::NEG_INFINITY, f64::max).floor();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not below zero, and cut off at the edge"
        )]
        let range = low as usize..(high + 1.0).max(0.0) as usize;
        range.start..range.end.min(PIXELS)
    };
    let side = |[a, b]: [usize; 2], x: f64, y: f64| {
        let ([ax, ay], [bx, by]) = (corners[a], corners[b]);
        (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    };
    for row in ends(1) {
        for column in ends(0) {
            #[expect(clippy::cast_precision_loss, reason = "small")]
            let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
            let sides = [[0, 1], [1, 2], [2, 0]].map(|edge| side(edge, x, y));
            let inside =
                sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0);
            dark[row * PIXELS + column] |= inside;
        }
    }
}
