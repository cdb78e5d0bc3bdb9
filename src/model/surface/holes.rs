//! Holes of a surface, and triangles that fill them; polygons as triangles.

use std::collections::{BTreeMap, BTreeSet};

use super::closed::{MeshError, edges, location};
use super::soup::{Soup, normal_area, number};
use crate::readable::shown;
use numerics::vector::{cross, dot, minus};

/// Most corners of a hole that is filled, and of a polygon.
const MOST_CORNERS: usize = 2000;

/// The closed holes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Closed {
    pub count: usize,
    /// Width of the widest (m), and its middle (m).
    pub width: f64,
    pub at: [f64; 3],
}

/// Closes all holes of triangles that are turned alike. The width of a hole is four times its area
/// over its rim, which is the diameter of a round one and twice the width of a crack.
///
/// # Errors
/// If one is wider than `widest` (m).
pub(super) fn close(soup: &mut Soup, widest: f64) -> Result<Closed, MeshError> {
    let known = edges(&soup.triangles);
    let open: Vec<(u32, u32)> = (known.keys().copied())
        .filter(|&(a, b)| !known.contains_key(&(b, a)))
        .collect();
    let mut known: BTreeSet<(u32, u32)> = known.into_keys().collect();
    let mut closed = Closed::default();
    let mut worst: Option<(f64, [f64; 3])> = None;
    for rim in rims(&open) {
        let (width, at) = width(soup, &rim);
        if width > widest || rim.len() > MOST_CORNERS {
            if worst.is_none_or(|(other, _)| width > other) {
                worst = Some((width, at));
            }
            continue;
        }
        let patch = zip(soup, &rim, &known);
        let area = patch.iter().map(|t| {
            let area = normal_area(&soup.at(t));
            0.5 * dot(&area, &area).sqrt()
        });
        let width = 4.0 * area.fold(0.0, |sum, part| sum + part) / length(soup, &rim);
        if width > widest && worst.is_none_or(|(other, _)| width > other) {
            worst = Some((width, at));
        }
        for t in &patch {
            known.extend((0..3).map(|k| (t[k], t[(k + 1) % 3])));
        }
        soup.triangles.extend(patch);
        if closed.count == 0 || width > closed.width {
            (closed.width, closed.at) = (width, at);
        }
        closed.count += 1;
    }
    match worst {
        None => Ok(closed),
        Some((width, at)) => Err(MeshError::Hole {
            edges: open.len(),
            width: shown(width, "m"),
            widest: shown(widest, "m"),
            location: location(&at),
        }),
    }
}

/// Rings of edges that would close what is open.
fn rims(open: &[(u32, u32)]) -> Vec<Vec<u32>> {
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &(a, b) in open {
        next.entry(b).or_default().push(a);
    }
    let mut rims = Vec::new();
    for start in next.keys().copied().collect::<Vec<_>>() {
        let mut path = vec![start];
        let mut slots = BTreeMap::from([(start, 0)]);
        while let Some(&here) = path.last() {
            let Some(there) = next.get_mut(&here).and_then(Vec::pop) else {
                break;
            };
            // A ring that meets itself in a corner is several.
            if let Some(&at) = slots.get(&there) {
                let rim = path.split_off(at);
                for corner in &rim {
                    slots.remove(corner);
                }
                rims.push(rim);
            }
            slots.insert(there, path.len());
            path.push(there);
        }
    }
    rims
}

fn length(soup: &Soup, rim: &[u32]) -> f64 {
    let edges = rim.iter().zip(rim.iter().cycle().skip(1)).map(|(a, b)| {
        let r = minus(&soup.corners[*b as usize], &soup.corners[*a as usize]);
        dot(&r, &r).sqrt()
    });
    edges.fold(0.0, |sum, edge| sum + edge)
}

/// The width of a hole, by the area within its rim, and its middle (m).
fn width(soup: &Soup, rim: &[u32]) -> (f64, [f64; 3]) {
    let mut middle = [0.0; 3];
    #[allow(clippy::cast_precision_loss)] // few corners
    let share = 1.0 / rim.len() as f64;
    for &corner in rim {
        for a in 0..3 {
            middle[a] += share * soup.corners[corner as usize][a];
        }
    }
    let mut area = [0.0; 3];
    for (a, b) in rim.iter().zip(rim.iter().cycle().skip(1)) {
        let [a, b] = [a, b].map(|c| minus(&soup.corners[*c as usize], &middle));
        let part = cross(&a, &b);
        for k in 0..3 {
            area[k] += 0.5 * part[k];
        }
    }
    (4.0 * dot(&area, &area).sqrt() / length(soup, rim), middle)
}

/// Triangles that fill a small hole: corner by corner across the shortest way that is no edge yet,
/// so that a crack closes like a zip.
fn zip(soup: &mut Soup, rim: &[u32], known: &BTreeSet<(u32, u32)>) -> Vec<[u32; 3]> {
    let mut rim = rim.to_vec();
    let mut patch = Vec::new();
    let mut drawn: BTreeSet<(u32, u32)> = BTreeSet::new();
    while rim.len() > 3 {
        let n = rim.len();
        let around = |k: usize| (rim[(k + n - 1) % n], rim[(k + 1) % n]);
        let is_free = |(a, b): (u32, u32)| {
            let edges = [(a, b), (b, a)];
            edges
                .iter()
                .all(|e| !known.contains(e) && !drawn.contains(e))
        };
        let square = |(a, b): (u32, u32)| {
            let r = minus(&soup.corners[b as usize], &soup.corners[a as usize]);
            dot(&r, &r)
        };
        let best = (0..n)
            .filter(|&k| is_free(around(k)))
            .min_by(|&j, &k| square(around(j)).total_cmp(&square(around(k))));
        let Some(k) = best else { break };
        let (a, b) = around(k);
        patch.push([a, rim[k], b]);
        drawn.insert((a, b));
        rim.remove(k);
    }
    if let [a, b, c] = rim[..] {
        patch.push([a, b, c]);
        return patch;
    }
    // No way across is free: through the middle.
    let (_, middle) = width(soup, &rim);
    soup.corners.push(middle);
    let middle = number(soup.corners.len() - 1);
    let edges = rim.iter().zip(rim.iter().cycle().skip(1));
    patch.extend(edges.map(|(a, b)| [*a, *b, middle]));
    patch
}

/// The triangles of a polygon in space, by the numbers of its corners: none of the corners is lost,
/// and the triangles run as the polygon does. `None` if its edges cross, if it has no area, or more
/// than 2000 corners.
#[must_use]
pub fn triangulate(corners: &[[f64; 3]]) -> Option<Vec<[usize; 3]>> {
    if corners.len() == 3 {
        return Some(vec![[0, 1, 2]]);
    }
    if corners.len() < 3 || corners.len() > MOST_CORNERS {
        return None;
    }
    // Along its mean normal (Newell) it is a plane polygon.
    let mut normal = [0.0; 3];
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let [a, b] = [a, b].map(|x| minus(x, &corners[0]));
        let part = cross(&a, &b);
        normal = std::array::from_fn(|k| normal[k] + part[k]);
    }
    let axis = (1..3).fold(0, |best, k| {
        if normal[k].abs() > normal[best].abs() {
            k
        } else {
            best
        }
    });
    if normal[axis] == 0.0 || !normal[axis].is_finite() {
        return None;
    }
    let (mut u, mut v) = ((axis + 1) % 3, (axis + 2) % 3);
    if normal[axis] < 0.0 {
        (u, v) = (v, u);
    }
    let flat: Vec<[f64; 2]> = corners.iter().map(|x| [x[u], x[v]]).collect();
    cut_ears(&flat)
}

/// Cuts ears off a polygon that runs counter-clockwise, the best ones first (Meisters 1975).
fn cut_ears(x: &[[f64; 2]]) -> Option<Vec<[usize; 3]>> {
    let turn = |a: usize, b: usize, c: usize| {
        (x[b][0] - x[a][0]) * (x[c][1] - x[a][1]) - (x[b][1] - x[a][1]) * (x[c][0] - x[a][0])
    };
    let square = |a: usize, b: usize| (x[b][0] - x[a][0]).powi(2) + (x[b][1] - x[a][1]).powi(2);
    let ear = |left: &[usize], k: usize| {
        let n = left.len();
        [left[(k + n - 1) % n], left[k], left[(k + 1) % n]]
    };
    // Width over length of an ear that holds no other corner, else zero.
    let quality = |left: &[usize], k: usize| {
        let [a, b, c] = ear(left, k);
        let longest = square(a, b).max(square(b, c)).max(square(c, a));
        let quality = turn(a, b, c) / longest;
        let is_outside = |&p: &usize| {
            [a, b, c].contains(&p)
                || turn(a, b, p) < 0.0
                || turn(b, c, p) < 0.0
                || turn(c, a, p) < 0.0
        };
        let is_ear = quality > 0.0 && left.iter().all(is_outside);
        if is_ear { quality } else { 0.0 }
    };
    let all = |left: &[usize]| -> Vec<f64> { (0..left.len()).map(|k| quality(left, k)).collect() };
    let best = |qualities: &[f64]| {
        let better = |best: usize, k: usize| {
            if qualities[k] > qualities[best] {
                k
            } else {
                best
            }
        };
        let best = (1..qualities.len()).fold(0, better);
        (qualities[best] > 0.0).then_some(best)
    };
    let mut left: Vec<usize> = (0..x.len()).collect();
    let mut qualities = all(&left);
    let mut ears = Vec::new();
    while left.len() > 3 {
        // A cut changes the ears beside it alone, but where corners lie on edges.
        let k = best(&qualities).or_else(|| {
            qualities = all(&left);
            best(&qualities)
        })?;
        ears.push(ear(&left, k));
        left.remove(k);
        qualities.remove(k);
        let n = left.len();
        for beside in [(k + n - 1) % n, k % n] {
            qualities[beside] = quality(&left, beside);
        }
    }
    let last = [left[0], left[1], left[2]];
    (turn(last[0], last[1], last[2]) > 0.0).then(|| ears.push(last))?;
    Some(ears)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[[f64; 3]], triangles: &[[usize; 3]]) -> f64 {
        let parts = triangles.iter().map(|t| {
            let area = normal_area(&t.map(|c| corners[c]));
            0.5 * dot(&area, &area).sqrt()
        });
        parts.fold(0.0, |sum, part| sum + part)
    }

    #[test]
    fn polygons_are_cut_into_as_many_triangles_as_they_have_corners_less_two() {
        // An L with a corner in the middle of an edge, on a slope.
        let outline = [
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        for turned in [false, true] {
            let mut corners: Vec<[f64; 3]> = outline.map(|[x, y]| [x, 0.6 * y, 0.8 * y]).to_vec();
            if turned {
                corners.reverse();
            }
            let triangles = triangulate(&corners).unwrap();
            assert_eq!(triangles.len(), 5);
            assert!((area(&corners, &triangles) - 3.0).abs() < 1e-12);
            let sign = if turned { -1.0 } else { 1.0 };
            for t in &triangles {
                assert!(sign * normal_area(&t.map(|c| corners[c]))[2] > 0.0);
            }
        }
    }

    #[test]
    fn polygons_that_are_none_are_refused() {
        let bow = [
            [0.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.5, 0.0],
        ];
        assert_eq!(triangulate(&bow), None);
        let line = [0.0, 1.0, 2.0, 3.0].map(|x| [x, 0.0, 0.0]);
        assert_eq!(triangulate(&line), None);
        assert_eq!(triangulate(&line[..2]), None);
        let wild = [[f64::MAX; 3], [0.0; 3], [f64::MIN; 3], [1.0, 0.0, 0.0]];
        assert_eq!(triangulate(&wild), None);
    }
}
