//! A unit over and over at the points of a lattice: one form in memory, whatever their number.

use super::{Faces, Solid};
use crate::Vec3;

/// Share of a step by which points at a side of the region count as within.
const WITHIN: f64 = 1e-9;

/// Most points of a lattice to look at, and units that may hold one place.
const MOST_POINTS: u64 = 100_000;
const MOST_TOGETHER: f64 = 64.0;

/// Units at all points of a lattice through the origin that lie in a box.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeat {
    /// The unit whose point is the origin.
    unit: Solid,
    /// Ways (m) from point to point.
    steps: Vec<Vec3>,
    /// Rows that tell how many steps a place is (1/m).
    counts: [Vec3; 3],
    /// Box of the region (m).
    region: (Vec3, Vec3),
    /// Smallest box of the points in it (m).
    points: (Vec3, Vec3),
    /// First and last number of steps of a point in it.
    numbers: [[i64; 2]; 3],
    /// Middle of the unit's box, and half its edges (m).
    middle: Vec3,
    half: Vec3,
}

impl Repeat {
    /// Units at the points `Σ n_k steps_k` of a box (m), one to three steps (m) that are no sums of each other. Along axes along which no
    /// step goes, the box has no sides.
    ///
    /// # Errors
    /// Says that there is no such point or too many, or that a place is in too many units.
    pub fn new(unit: Solid, steps: Vec<Vec3>, region: (Vec3, Vec3)) -> Result<Self, &'static str> {
        let mut all = steps.clone();
        if all.len() == 1 {
            let aside = if all[0].x.abs() > 0.5 * all[0].norm() {
                Vec3::y()
            } else {
                Vec3::x()
            };
            all.push(all[0].cross(&aside));
        }
        if all.len() == 2 {
            all.push(all[0].cross(&all[1]));
        }
        let inverse = nalgebra::Matrix3::from_columns(&all).try_inverse();
        let inverse = inverse.ok_or("steps from point to point are sums of each other")?;
        let counts = [0, 1, 2].map(|k| inverse.row(k).transpose());
        let (mut lower, mut upper) = region;
        for a in 0..3 {
            if steps.iter().all(|step| step[a] == 0.0) {
                (lower[a], upper[a]) = (f64::NEG_INFINITY, f64::INFINITY);
            }
        }
        let edge = |from: f64, to: f64, part: f64| {
            if part == 0.0 {
                0.0
            } else {
                (part * from).max(part * to)
            }
        };
        let numbers = [0, 1, 2].map(|k| {
            if k >= steps.len() {
                return [0, 0];
            }
            let most = |sign: f64| {
                (0..3)
                    .map(|a| edge(lower[a], upper[a], sign * counts[k][a]))
                    .sum::<f64>()
            };
            [whole(-most(-1.0) - WITHIN), whole(most(1.0) + WITHIN)]
        });
        let spans = numbers.map(|[first, last]| u64::try_from(last - first + 1).unwrap_or(0));
        let looked_at = spans
            .iter()
            .fold(1_u64, |all, span| all.saturating_mul(*span));
        if looked_at > MOST_POINTS {
            return Err("a shape is repeated a hundred thousand times at most");
        }
        let (low, high) = unit.bounds();
        let half = (high - low) * 0.5;
        let across = (0..steps.len()).map(|k| 2.0 * counts[k].abs().dot(&half) + 1.0);
        if across.product::<f64>() > MOST_TOGETHER || unit.repeats() {
            return Err(
                "a shape that is repeated is some cells wide at most, and repeats none itself",
            );
        }
        let mut made = Self {
            middle: (low + high) * 0.5,
            half,
            unit,
            steps,
            counts,
            region: (lower, upper),
            points: (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)),
            numbers,
        };
        let mut points = made.points;
        made.each(&numbers, |point| {
            points = (points.0.inf(&point), points.1.sup(&point));
        });
        made.points = points;
        if points.0.x <= points.1.x {
            Ok(made)
        } else {
            Err("no point of the lattice lies from `lower` to `upper`")
        }
    }

    /// The unit.
    #[must_use]
    pub fn unit(&self) -> &Solid {
        &self.unit
    }

    /// Calls `then` with each point (m) of the region whose numbers of steps are in these ranges.
    fn each(&self, numbers: &[[i64; 2]; 3], mut then: impl FnMut(Vec3)) {
        let way = |k: usize, n: i64| self.steps.get(k).map_or(Vec3::zeros(), |s| s * real(n));
        for a in numbers[0][0]..=numbers[0][1] {
            for b in numbers[1][0]..=numbers[1][1] {
                for c in numbers[2][0]..=numbers[2][1] {
                    let point = way(0, a) + way(1, b) + way(2, c);
                    if self.holds(&point) {
                        then(point);
                    }
                }
            }
        }
    }

    /// True if a point (m) is in the region.
    fn holds(&self, point: &Vec3) -> bool {
        let slack = WITHIN * self.steps[0].norm();
        let (lower, upper) = &self.region;
        (0..3).all(|a| lower[a] - slack <= point[a] && point[a] <= upper[a] + slack)
    }

    /// Distance (m) of a place from the nearest unit, negative inside, and that unit's point (m).
    fn nearest(&self, x: &Vec3) -> (f64, Vec3) {
        let from = x - self.middle;
        let mut best = (f64::INFINITY, Vec3::zeros());
        let mut look = |point: Vec3| {
            if box_distance(&(from - point), &self.half) < best.0 {
                let distance = self.unit.distance(&(x - point));
                if distance < best.0 {
                    best = (distance, point);
                }
            }
            best.0
        };
        // Most places are next to the point with their own number of steps.
        let own = [0, 1, 2].map(|k| {
            let [first, last] = self.numbers[k];
            [whole(self.counts[k].dot(&from) + 0.5).clamp(first, last); 2]
        });
        let mut least = f64::INFINITY;
        self.each(&own, |point| least = look(point));
        let held = from.zip_zip_map(&self.points.0, &self.points.1, f64::clamp);
        let mut reach = if least.is_finite() {
            least.max(0.0)
        } else {
            (from - held).norm() + self.steps[0].norm()
        };
        loop {
            let mut numbers = self.numbers;
            for k in 0..self.steps.len() {
                let row = &self.counts[k];
                let (at, aside) = (
                    row.dot(&from),
                    reach * row.norm() + row.abs().dot(&self.half),
                );
                numbers[k][0] = numbers[k][0].max(whole(at - aside));
                numbers[k][1] = numbers[k][1].min(whole(at + aside + 1.0));
            }
            self.each(&numbers, |point| least = look(point));
            if least <= reach {
                return best;
            }
            reach = if least.is_finite() {
                least
            } else {
                2.0 * reach
            };
        }
    }

    /// Distance (m) of a place from the surface, negative inside.
    pub(super) fn distance(&self, x: &Vec3) -> f64 {
        self.nearest(x).0
    }

    /// Faces of the unit that holds a place deepest.
    pub(super) fn faces(&self, x: &Vec3, reach: f64, emit: Faces) {
        let (_, point) = self.nearest(x);
        self.unit.faces(&(x - point), reach, emit);
    }

    /// Unit vector along which the distance grows.
    pub(super) fn outward(&self, x: &Vec3) -> Vec3 {
        let (_, point) = self.nearest(x);
        self.unit.outward(&(x - point))
    }

    /// No less than the largest `n·x` (m); exact along axes.
    pub(super) fn support(&self, n: &Vec3) -> f64 {
        let (first, last) = &self.points;
        let most = |a: usize| (n[a] * first[a]).max(n[a] * last[a]);
        self.unit.support(n) + most(0) + most(1) + most(2)
    }

    /// Corners of its box (m).
    pub(super) fn bounds(&self) -> (Vec3, Vec3) {
        let (lower, upper) = self.unit.bounds();
        (lower + self.points.0, upper + self.points.1)
    }
}

/// Least distance (m) that a form in a box of half edges has from a place beside its middle.
fn box_distance(place: &Vec3, half: &Vec3) -> f64 {
    let beyond = place.abs() - half;
    let most = beyond.max();
    if most > 0.0 {
        beyond.map(|b| b.max(0.0)).norm()
    } else {
        most
    }
}

/// The largest whole number that is no larger.
fn whole(number: f64) -> i64 {
    #[allow(clippy::cast_possible_truncation, reason = "saturates")]
    let whole = number.floor() as i64;
    whole.clamp(-MOST, MOST)
}

/// More steps than any lattice has.
const MOST: i64 = 1 << 40;

fn real(number: i64) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "far fewer than 2^52")]
    let real = number as f64;
    real
}
