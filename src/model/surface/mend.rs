//! Mends nearly closed surfaces: corners a hair apart, triangles that occur twice or are turned the
//! other way, small holes.

use std::collections::{BTreeMap, BTreeSet};

use super::closed::{MeshError, edges};
use super::holes;
use super::shells::{align, drop_doubles, swap_flat};
use super::soup::{Soup, is_needle, number, undirected};
use crate::readable::{shown, shown_vector};
use numerics::vector::{dot, minus};

/// Corners as near as this share of the size are one: files hold six digits or so.
const ROUNDING: f64 = 1e-6;
/// Triangles as low as this share of the size have no area.
const FLAT: f64 = 1e-10;
/// Corners of open edges as near as this (spacings) are one, as those of faces that were cut into
/// triangles by themselves.
const GAP: f64 = 0.1;
/// But not farther apart than this share of the size, where spacings are coarse.
const WIDEST_GAP: f64 = 0.01;

/// The repairs of a surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mended {
    /// Corners that were laid onto others, and the widest gap that this closed (m).
    pub joined: (usize, f64),
    /// Triangles that occurred twice.
    pub doubled: usize,
    /// Triangles without area.
    pub flat: usize,
    /// Triangles that were turned the other way than those around them.
    pub turned: usize,
    /// Shells that pointed the other way than others.
    pub shells: usize,
    /// Holes that were closed.
    pub holes: usize,
    /// Width of the widest of them (m), and its middle (m).
    pub widest: (f64, [f64; 3]),
}

impl Mended {
    /// The repairs, for people; nothing if the surface was whole.
    #[must_use]
    pub fn words(&self) -> Option<String> {
        let mut done = Vec::new();
        let mut report = |count: usize, one: &str, many: &str, more: String| match count {
            0 => {}
            1 => done.push(format!("1 {one}{more}")),
            _ => done.push(format!("{count} {many}{more}")),
        };
        let (width, at) = self.widest;
        let size = if self.holes == 1 { "" } else { "the widest " };
        let at = shown_vector(&at, "m");
        let size = format!(", {size}{} wide, near {at}", shown(width, "m"));
        report(self.holes, "hole closed", "holes closed", size);
        let (joined, gap) = self.joined;
        let gap = format!(" across gaps of up to {}", shown(gap, "m"));
        report(joined, "corner joined", "corners joined", gap);
        let none = String::new;
        report(
            self.turned,
            "triangle turned as those around it",
            "triangles turned as those around them",
            none(),
        );
        report(
            self.shells,
            "shell turned inside out",
            "shells turned inside out",
            none(),
        );
        report(
            self.doubled,
            "double triangle left out",
            "double triangles left out",
            none(),
        );
        report(
            self.flat,
            "triangle without area left out",
            "triangles without area left out",
            none(),
        );
        (!done.is_empty()).then(|| done.join("; "))
    }
}

/// Makes a closed surface of triangles for particles of a spacing (m). Holes up to a spacing wide
/// are closed, and gaps up to a tenth of one.
///
/// # Errors
/// The first defect that cannot be mended, with its place.
pub(super) fn mend(soup: &mut Soup, spacing: f64) -> Result<Mended, MeshError> {
    let size = soup.size();
    let mut mended = Mended::default();
    let all = vec![true; soup.corners.len()];
    mended.joined = join(soup, ROUNDING * size, &all, &BTreeSet::new());
    mended.doubled = drop_doubles(soup);
    mended.turned = align(soup)?;
    let gap = (GAP * spacing).min(WIDEST_GAP * size);
    if let Some(at_rim) = at_rim(soup) {
        // The ends of an edge stay apart.
        let apart = soup
            .triangles
            .iter()
            .flat_map(|t| [0, 1, 2].map(|k| undirected(t[k], t[(k + 1) % 3])));
        let apart = apart.collect();
        let (joined, widest) = join(soup, gap, &at_rim, &apart);
        if joined > 0 {
            mended.joined.0 += joined;
            mended.joined.1 = mended.joined.1.max(widest);
            mended.doubled += drop_doubles(soup);
            mended.turned += align(soup)?;
        }
        let closed = holes::close(soup, spacing)?;
        mended.holes = closed.count;
        mended.widest = (closed.width, closed.at);
    }
    mended.flat = swap_flat(soup, FLAT * size);
    soup.check()?;
    Ok(mended)
}

/// `true` for corners that are ends of open edges, if there are any.
fn at_rim(soup: &Soup) -> Option<Vec<bool>> {
    let edges = edges(&soup.triangles);
    let mut is_at = vec![false; soup.corners.len()];
    for &(a, b) in edges.keys().filter(|(a, b)| !edges.contains_key(&(*b, *a))) {
        is_at[a as usize] = true;
        is_at[b as usize] = true;
    }
    is_at.contains(&true).then_some(is_at)
}

/// Lays corners onto others that come before them and are no farther away than `reach` (m), of those
/// that `may` be joined and are not ends of one of the edges `apart`. Gives how many, and the longest
/// way (m).
fn join(soup: &mut Soup, reach: f64, may: &[bool], apart: &BTreeSet<(u32, u32)>) -> (usize, f64) {
    let mut done = (0, 0.0_f64);
    if reach.is_nan() || reach <= 0.0 {
        return done;
    }
    // Cubes of four reaches: most corners have their neighbours in one.
    #[allow(clippy::cast_possible_truncation)] // saturating is meant
    let cube = |c: f64| (c / (4.0 * reach)).floor() as i64;
    let mut cubes: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    let mut onto: Vec<u32> = (0..number(soup.corners.len())).collect();
    for n in (0..soup.corners.len()).filter(|&n| may[n]) {
        let x = &soup.corners[n];
        let [low, high] = [-reach, reach].map(|by| x.map(|c| cube(c + by)));
        let mut best: Option<(f64, u32)> = None;
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                for k in low[2]..=high[2] {
                    for &other in cubes.get(&[i, j, k]).into_iter().flatten() {
                        let r = minus(x, &soup.corners[other as usize]);
                        let way = dot(&r, &r).sqrt();
                        if way <= reach
                            && best.is_none_or(|(least, _)| way < least)
                            && !apart.contains(&undirected(other, number(n)))
                        {
                            best = Some((way, other));
                        }
                    }
                }
            }
        }
        match best {
            Some((way, other)) => {
                onto[n] = other;
                done = (done.0 + 1, done.1.max(way));
            }
            None => cubes.entry(x.map(cube)).or_default().push(number(n)),
        }
    }
    if done.0 > 0 {
        for t in &mut soup.triangles {
            *t = t.map(|c| onto[c as usize]);
        }
        soup.triangles.retain(|t| !is_needle(t));
    }
    done
}

#[cfg(test)]
mod tests;
