//! Where most of each body lies in pictures: what they frame.

use std::collections::BTreeMap;

/// Share of a body beyond either end of an axis that is left out: of both axes 98 % are within.
const SPECKS: f64 = 0.005;

/// What reaches beyond the rest by no more than this share of the rest's width is no speck.
const NEAR: f64 = 0.25;

/// The matter of one snapshot along the two axes of a picture.
#[derive(Debug, Clone, Default)]
pub struct Bulk {
    bodies: BTreeMap<usize, Body>,
}

/// That of a body.
#[derive(Debug, Clone)]
struct Body {
    /// The ends of all of it (m).
    ends: [[f64; 2]; 2],
    /// Places (m) and shares of its matter, in any unit.
    places: Vec<([f64; 2], f64)>,
}

/// Nowhere.
const NONE: [[f64; 2]; 2] = [[f64::INFINITY, f64::NEG_INFINITY]; 2];

impl Bulk {
    /// Adds a particle of a body that reaches so far (m); `matter` is what it holds, in any unit, or nothing if others
    /// stand for it.
    pub fn add(&mut self, body: usize, at: [f64; 2], radii: [f64; 2], matter: Option<f64>) {
        let own = self.bodies.entry(body).or_insert(Body {
            ends: NONE,
            places: Vec::new(),
        });
        for ((span, at), radius) in own.ends.iter_mut().zip(at).zip(radii) {
            *span = joined(*span, [at - radius, at + radius]);
        }
        own.places.extend(matter.map(|matter| (at, matter)));
    }

    /// Adds those of a part of the snapshot.
    pub fn join(&mut self, part: Self) {
        for (body, mut more) in part.bodies {
            match self.bodies.get_mut(&body) {
                Some(own) => {
                    for (span, other) in own.ends.iter_mut().zip(more.ends) {
                        *span = joined(*span, other);
                    }
                    own.places.append(&mut more.places);
                }
                None => drop(self.bodies.insert(body, more)),
            }
        }
    }

    /// The numbers of the bodies.
    pub fn bodies(&self) -> impl Iterator<Item = usize> + '_ {
        self.bodies.keys().copied()
    }

    /// The ends of what a picture frames along both axes (m): of each body all that is near most of it.
    pub fn ends(mut self) -> [[f64; 2]; 2] {
        let mut all = NONE;
        for body in self.bodies.values_mut() {
            for (axis, all) in all.iter_mut().enumerate() {
                *all = joined(*all, body.framed(axis));
            }
        }
        all
    }
}

impl Body {
    fn framed(&mut self, axis: usize) -> [f64; 2] {
        let ends = self.ends[axis];
        self.places.sort_by(|a, b| a.0[axis].total_cmp(&b.0[axis]));
        let whole: f64 = self.places.iter().map(|(_, matter)| matter).sum();
        let low = inner(self.places.iter(), axis, SPECKS * whole);
        let high = inner(self.places.iter().rev(), axis, SPECKS * whole);
        let (Some(low), Some(high)) = (low, high) else {
            return ends;
        };
        // A body of a few particles is as wide as these are.
        let room = NEAR * (high - low);
        let [lower, upper] = [low - room, high + room];
        let is_speck = |gap: f64| gap > 0.0 && high > low;
        [
            if is_speck(lower - ends[0]) {
                lower
            } else {
                ends[0]
            },
            if is_speck(ends[1] - upper) {
                upper
            } else {
                ends[1]
            },
        ]
    }
}

/// The first place along an axis (m) beyond which there is more than so much matter.
fn inner<'a>(
    mut places: impl Iterator<Item = &'a ([f64; 2], f64)>,
    axis: usize,
    specks: f64,
) -> Option<f64> {
    let mut beyond = 0.0;
    let found = places.find(|(_, matter)| {
        beyond += matter;
        beyond > specks
    });
    found.map(|(at, _)| at[axis])
}

/// The span of two.
pub fn joined(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block of 20 × 20 particles of size one.
    fn block() -> Bulk {
        let mut bulk = Bulk::default();
        for k in 0..400 {
            let at = [f64::from(k % 20) + 0.5, f64::from(k / 20) + 0.5];
            bulk.add(0, at, [0.5; 2], Some(1.0));
        }
        bulk
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "sums of halves are exact")]
    fn whole_bodies_are_framed_and_specks_are_not() {
        assert_eq!(block().ends(), [[0.0, 20.0]; 2]);
        let mut specked = block();
        specked.add(0, [500.0, -300.0], [0.5; 2], Some(1.0));
        let [x, y] = specked.ends();
        assert_eq!([x[0], y[1]], [0.0, 20.0]);
        assert!(x[1] < 26.0 && y[0] > -6.0, "{x:?} {y:?}");
        // Bodies are framed, however little they hold.
        let mut two = block();
        two.add(1, [500.0, 10.0], [0.5; 2], Some(1.0));
        assert_eq!(two.ends(), [[0.0, 500.5], [0.0, 20.0]]);
        // A twentieth of a body is no speck.
        let mut cloud = block();
        for k in 0..20 {
            cloud.add(0, [100.0, f64::from(k)], [0.5; 2], Some(1.0));
        }
        assert_eq!(cloud.ends()[0], [0.0, 100.5]);
    }

    #[test]
    fn parts_make_the_whole() {
        let mut bulk = Bulk::default();
        bulk.join(block());
        let mut other = Bulk::default();
        other.add(0, [500.0, 10.0], [0.5; 2], None);
        bulk.join(other);
        assert!(bulk.ends()[0][1] < 26.0);
        assert_eq!(Bulk::default().ends(), NONE);
    }
}
