//! Triangles of a surface that cut through each other.

use super::Mesh;
use super::soup::normal_area;
use numerics::vector::{cross, dot, minus};

/// Volumes below this share of what they could be are rounding: nothing crosses.
const ROUNDING: f64 = 1e-9;

/// Pairs that are looked at for each triangle on the mean, and in all surfaces: of long triangles side by
/// side each may be near to all others.
const MOST_PAIRS: usize = 256;
const LEAST_PAIRS: usize = 1 << 20;

/// Triangles of a surface that cut through each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The number of pairs.
    pub count: usize,
    /// The position of the first (m).
    pub at: [f64; 3],
}

impl Mesh {
    /// Its triangles that cut through each other, if any do, as far as they are looked at. Inside and
    /// outside mean little there.
    #[must_use]
    pub fn crossing(&self) -> Option<Crossing> {
        let mut first: Option<Crossing> = None;
        let mut pairs = LEAST_PAIRS + MOST_PAIRS * self.triangles.len();
        for (n, t) in (0..).zip(&self.triangles) {
            let x = self.at(n);
            let side = |pick: fn(f64, f64) -> f64| -> [f64; 3] {
                std::array::from_fn(|a| pick(pick(x[0][a], x[1][a]), x[2][a]))
            };
            let mut partners = Vec::new();
            self.tree.meeting(&side(f64::min), &side(f64::max), |m| {
                let other = &self.triangles[m as usize];
                if m > n && !other.iter().any(|c| t.contains(c)) {
                    partners.push(m);
                }
            });
            let Some(left) = pairs.checked_sub(partners.len()) else {
                break;
            };
            pairs = left;
            // The tree's order does not count.
            partners.sort_unstable();
            for m in partners {
                let y = self.at(m);
                let Some(at) = pierced(&x, &y).or_else(|| pierced(&y, &x)) else {
                    continue;
                };
                let crossing = first.get_or_insert(Crossing { count: 0, at });
                crossing.count += 1;
            }
        }
        first
    }
}

/// The point where an edge of the second triangle goes through the first.
fn pierced(x: &[[f64; 3]; 3], y: &[[f64; 3]; 3]) -> Option<[f64; 3]> {
    let normal = normal_area(x);
    let area = dot(&normal, &normal).sqrt();
    let heights = y.map(|p| dot(&normal, &minus(&p, &x[0])));
    (0..3).find_map(|k| {
        let l = (k + 1) % 3;
        let (p, way) = (y[k], minus(&y[l], &y[k]));
        let least = ROUNDING * area * dot(&way, &way).sqrt();
        if heights[k].abs() <= least || heights[l].abs() <= least {
            return None;
        }
        if (heights[k] < 0.0) == (heights[l] < 0.0) {
            return None;
        }
        // On which side of each edge of the triangle the line passes.
        let from = x.map(|c| minus(&c, &p));
        let sides: [f64; 3] =
            std::array::from_fn(|e| dot(&way, &cross(&from[e], &from[(e + 1) % 3])));
        let is_inside = sides.iter().all(|&s| s > least) || sides.iter().all(|&s| s < -least);
        let part = heights[k] / (heights[k] - heights[l]);
        is_inside.then(|| std::array::from_fn(|a| p[a] + part * way[a]))
    })
}
