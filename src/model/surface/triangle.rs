//! The closest point of a triangle (Ericson 2005, *Real-Time Collision Detection*, section 5.1.5).

use numerics::vector::{dot, minus};

/// Part of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// Its inside.
    Face,
    /// The edge from this corner to the next one.
    Edge(usize),
    /// A corner.
    Corner(usize),
}

/// The point of the triangle `[a, b, c]` (m) that is closest to `x` (m), and where on it.
#[must_use]
pub fn closest_on_triangle(corners: &[[f64; 3]; 3], x: &[f64; 3]) -> ([f64; 3], Feature) {
    let [a, b, c] = corners;
    let (ab, ac) = (minus(b, a), minus(c, a));
    let to = |from: &[f64; 3]| {
        let r = minus(x, from);
        (dot(&ab, &r), dot(&ac, &r))
    };
    let on = |from: &[f64; 3], edge: &[f64; 3], part: f64| -> [f64; 3] {
        std::array::from_fn(|k| from[k] + part * edge[k])
    };
    let (d1, d2) = to(a);
    if d1 <= 0.0 && d2 <= 0.0 {
        return (*a, Feature::Corner(0));
    }
    let (d3, d4) = to(b);
    if d3 >= 0.0 && d4 <= d3 {
        return (*b, Feature::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (on(a, &ab, d1 / (d1 - d3)), Feature::Edge(0));
    }
    let (d5, d6) = to(c);
    if d6 >= 0.0 && d5 <= d6 {
        return (*c, Feature::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (on(a, &ac, d2 / (d2 - d6)), Feature::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let part = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (on(b, &minus(c, b), part), Feature::Edge(1));
    }
    let sum = va + vb + vc;
    let (v, w) = (vb / sum, vc / sum);
    let point = std::array::from_fn(|k| a[k] + v * ab[k] + w * ac[k]);
    (point, Feature::Face)
}

#[cfg(test)]
mod tests {
    use super::*;

    const T: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];

    #[test]
    fn faces_edges_and_corners() {
        for (x, point, feature) in [
            ([0.5, 0.5, 3.0], [0.5, 0.5, 0.0], Feature::Face),
            ([0.5, 0.5, -1.0], [0.5, 0.5, 0.0], Feature::Face),
            ([1.0, -1.0, 1.0], [1.0, 0.0, 0.0], Feature::Edge(0)),
            ([2.0, 2.0, 5.0], [1.0, 1.0, 0.0], Feature::Edge(1)),
            ([-1.0, 0.5, 0.0], [0.0, 0.5, 0.0], Feature::Edge(2)),
            ([-1.0, -1.0, 1.0], [0.0, 0.0, 0.0], Feature::Corner(0)),
            ([4.0, 0.5, 0.0], [2.0, 0.0, 0.0], Feature::Corner(1)),
            ([0.5, 9.0, 0.0], [0.0, 2.0, 0.0], Feature::Corner(2)),
        ] {
            assert_eq!(closest_on_triangle(&T, &x), (point, feature), "{x:?}");
        }
    }

    /// None of many other points of the triangle is closer.
    #[test]
    fn nothing_is_closer() {
        let corners = [[0.3, -0.2, 0.9], [1.4, 0.1, -0.3], [-0.2, 1.1, 0.4]];
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24)
        };
        for _ in 0..500 {
            let x: [f64; 3] = std::array::from_fn(|_| 4.0 * random() - 2.0);
            let (point, _) = closest_on_triangle(&corners, &x);
            let distance = |p: &[f64; 3]| dot(&minus(p, &x), &minus(p, &x));
            for k in 0..=20 {
                for l in 0..=20 - k {
                    let (v, w) = (f64::from(k) / 20.0, f64::from(l) / 20.0);
                    let p = std::array::from_fn(|a| {
                        corners[0][a]
                            + v * (corners[1][a] - corners[0][a])
                            + w * (corners[2][a] - corners[0][a])
                    });
                    assert!(distance(&point) <= distance(&p) + 1e-12);
                }
            }
        }
    }
}
