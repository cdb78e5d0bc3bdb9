//! Fragments that particles hang together in, and where the front of the largest is.

/// The sets of points that hang together: each is nearer than `reach` (m) to another of its set.
/// As indices, the largest set first, equals in the order of their first points; points that are
/// not finite are left out.
///
/// # Panics
/// If `reach` is not positive.
#[must_use]
pub fn fragments(points: &[[f64; 3]], reach: f64) -> Vec<Vec<usize>> {
    assert!(reach > 0.0, "a reach of {reach} m");
    let cells = Cells::new(points, reach);
    let mut reached = vec![false; points.len()];
    let mut found = Vec::new();
    for first in 0..points.len() {
        if reached[first] || !points[first].iter().all(|c| c.is_finite()) {
            continue;
        }
        reached[first] = true;
        let mut fragment = vec![first];
        let mut next = 0;
        while let Some(&i) = fragment.get(next) {
            next += 1;
            cells.about(&points[i], |j| {
                if !reached[j] && distance_squared(&points[i], &points[j]) < reach * reach {
                    reached[j] = true;
                    fragment.push(j);
                }
            });
        }
        found.push(fragment);
    }
    found.sort_by_key(|fragment| std::cmp::Reverse(fragment.len()));
    found
}

/// The largest coordinate (m) along an axis of the largest of the [`fragments`], half a `spacing`
/// (m) beyond its outermost centre; points within one and a half spacings hang together. `None`
/// without points.
#[must_use]
pub fn front(points: &[[f64; 3]], axis: usize, spacing: f64) -> Option<f64> {
    let bulk = fragments(points, 1.5 * spacing).into_iter().next()?;
    let outermost = bulk.iter().map(|&i| points[i][axis]).reduce(f64::max);
    outermost.map(|x| x + 0.5 * spacing)
}

/// Points sorted by the cubes of the reach that they lie in.
struct Cells {
    reach: f64,
    sorted: Vec<([i64; 3], usize)>,
}

impl Cells {
    fn new(points: &[[f64; 3]], reach: f64) -> Self {
        let finite = points
            .iter()
            .enumerate()
            .filter(|(_, p)| p.iter().all(|c| c.is_finite()));
        let mut sorted: Vec<_> = finite.map(|(i, p)| (cell(p, reach), i)).collect();
        sorted.sort_unstable();
        Self { reach, sorted }
    }

    /// Visits all points of the cell of a point and of the cells about it.
    fn about(&self, point: &[f64; 3], mut visit: impl FnMut(usize)) {
        let [x, y, z] = cell(point, self.reach);
        for i in x - 1..=x + 1 {
            for j in y - 1..=y + 1 {
                let from = self.sorted.partition_point(|(c, _)| *c < [i, j, z - 1]);
                let row = self.sorted[from..].iter();
                for (_, k) in row.take_while(|(c, _)| *c <= [i, j, z + 1]) {
                    visit(*k);
                }
            }
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "saturates far beyond any model"
)]
fn cell(point: &[f64; 3], reach: f64) -> [i64; 3] {
    point.map(|c| (c / reach).floor() as i64)
}

fn distance_squared(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_splash_is_no_part_of_the_bulk() {
        let mut points: Vec<[f64; 3]> = (0..10).map(|k| [f64::from(k), -0.2, 0.0]).collect();
        points.push([11.0, 0.0, 0.0]);
        points.push([12.0, 0.0, 0.0]);
        points.push([f64::NAN, 0.0, 0.0]);
        let found = fragments(&points, 1.5);
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [10, 2]);
        assert_eq!(front(&points, 0, 1.0), Some(9.5));
        points.push([10.0, 0.9, 0.0]);
        assert_eq!(fragments(&points, 1.5).len(), 1);
        assert_eq!(front(&points, 0, 1.0), Some(12.5));
        assert_eq!(front(&[], 0, 1.0), None);
    }
}
