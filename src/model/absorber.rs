//! Absorbing zones: outer parts of bodies that take up waves, as if the body went on for ever.

use super::Axis;
use numerics::vector::dot;

/// `½ (n + 1) ln(1/R)` with the exponent n = 2 of the profile and R = .01, the amplitude of a
/// longitudinal wave that comes back from the end of a zone that it meets at a right angle.
const STRENGTH: f64 = 6.907_755_278_982_137;

/// A zone along outer faces of a body in which particles are slowed down and their stress relaxes
/// at the same rate.
#[derive(Debug, Clone, PartialEq)]
pub struct Absorber {
    /// Name in reports.
    pub name: String,
    /// Index into [`super::Case::bodies`]; no other zone has the same.
    pub body: usize,
    /// Depth of the zone below each face (m).
    pub depth: f64,
    /// Outer faces.
    pub faces: Vec<OuterFace>,
}

/// A face where a body ends for the model alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OuterFace {
    /// A plane.
    Plane {
        /// Unit vector out of the body.
        normal: [f64; 3],
        /// `n·x` of its points (m).
        position: f64,
    },
    /// All points as far from a line, or from a point.
    Round {
        /// The point, or one of the line (m).
        centre: [f64; 3],
        /// Direction of the line.
        axis: Option<Axis>,
        /// Its radius (m).
        radius: f64,
    },
}

impl OuterFace {
    /// Least and largest depth (m) below the face of the points of a box between two corners (m).
    fn depths(&self, lower: &[f64; 3], upper: &[f64; 3]) -> [f64; 2] {
        match self {
            Self::Plane { normal, position } => [true, false].map(|foremost| {
                let is_upper = |a: usize| (normal[a] > 0.0) == foremost;
                let corner = |a: usize| if is_upper(a) { upper[a] } else { lower[a] };
                position - dot(normal, &std::array::from_fn(corner))
            }),
            Self::Round {
                centre,
                axis,
                radius,
            } => {
                let across = |a: usize| axis.is_none_or(|axis| axis.index() != a);
                let arm = |of: &dyn Fn(usize) -> f64| {
                    let arm = std::array::from_fn(|a| if across(a) { of(a) } else { 0.0 });
                    radius - dot(&arm, &arm).sqrt()
                };
                let least = arm(&|a| {
                    (centre[a] - lower[a])
                        .abs()
                        .max((upper[a] - centre[a]).abs())
                });
                let most = arm(&|a| centre[a].clamp(lower[a], upper[a]) - centre[a]);
                [least, most]
            }
        }
    }
}

impl Absorber {
    /// Depth of a zone that states none, in spacings.
    pub const DEPTH: f64 = 30.0;
    /// Smallest depth in spacings: fewer layers are no smooth profile.
    pub const LEAST_DEPTH: f64 = 8.0;

    /// Rate of the zone (1/s) at a place (m) where longitudinal waves have this speed (m/s); zero
    /// outside of it.
    #[must_use]
    pub fn rate(&self, place: &[f64; 3], speed: f64) -> f64 {
        let profile = self.faces.iter().map(|face| {
            let within = 1.0 - face.depths(place, place)[0] / self.depth;
            let within = within.clamp(0.0, 1.0);
            within * within
        });
        let profile = profile.fold(0.0, |sum, part| sum + part);
        STRENGTH * speed / self.depth * profile
    }

    /// `true` if a point of the box between two corners (m) may lie outside of the zone.
    #[must_use]
    pub fn may_spare(&self, lower: &[f64; 3], upper: &[f64; 3]) -> bool {
        let mut faces = self.faces.iter();
        faces.all(|face| face.depths(lower, upper)[1] >= self.depth)
    }

    /// `true` if a point of the box between two corners (m) may lie in the zone.
    #[must_use]
    pub fn may_hold(&self, lower: &[f64; 3], upper: &[f64; 3]) -> bool {
        let mut faces = self.faces.iter();
        faces.any(|face| face.depths(lower, upper)[0] < self.depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RETURNED: f64 = 0.01;

    fn zone(face: OuterFace) -> Absorber {
        Absorber {
            name: String::new(),
            body: 0,
            depth: 2.0,
            faces: vec![face],
        }
    }

    /// The mean of the rate over the depth is what lets a hundredth through and back.
    #[test]
    fn a_hundredth_of_a_wave_comes_back() {
        assert!((STRENGTH - 1.5 * (1.0 / RETURNED).ln()).abs() < 1e-14);
        let end = OuterFace::Plane {
            normal: [0.0, -1.0, 0.0],
            position: -3.0,
        };
        let zone = zone(end);
        let (n, c) = (1000, 5.0);
        let rates = (0..n).map(|k| {
            let y = 3.0 + 2.0 * (f64::from(k) + 0.5) / f64::from(n);
            zone.rate(&[7.0, y, 1.0], c)
        });
        let along = rates.sum::<f64>() * 2.0 / f64::from(n);
        let back = (-2.0 * along / c).exp();
        assert!((back / RETURNED - 1.0).abs() < 1e-5, "{back}");
        assert_eq!(zone.rate(&[0.0, 5.0, 0.0], c), 0.0);
    }

    #[test]
    fn faces_are_planes_cylinders_and_spheres() {
        let round = |axis| {
            zone(OuterFace::Round {
                centre: [1.0, 0.0, 0.0],
                axis,
                radius: 5.0,
            })
        };
        let (rod, ball) = (round(Some(Axis::Z)), round(None));
        let full = STRENGTH / 2.0;
        for (zone, place, share) in [
            (&rod, [1.0, 3.0, 9.0], 0.0),
            (&rod, [1.0, 4.0, 9.0], 0.25),
            (&rod, [-4.0, 0.0, -9.0], 1.0),
            (&ball, [1.0, 0.0, -4.0], 0.25),
            (&ball, [1.0, 0.0, 9.0], 1.0),
        ] {
            assert_eq!(zone.rate(&place, 1.0), share * full, "{place:?}");
        }
        assert!(rod.may_spare(&[0.0, 2.9, 0.0], &[9.0, 9.0, 9.0]));
        assert!(!rod.may_spare(&[0.0, 3.1, 0.0], &[9.0, 9.0, 9.0]));
        assert!(!ball.may_spare(&[0.0, 2.0, 2.5], &[9.0, 9.0, 9.0]));
    }
}
