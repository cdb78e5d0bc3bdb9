//! Spacings that grow with the distance from a place.

use super::Vec3;

/// The growth of the spacing of a body: by `growth` of the distance, so that each layer is `1 +
/// growth` times as thick as the one before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grading {
    /// The origin of distances.
    pub from: Focus,
    /// Up to this distance the spacing is the finest (m).
    pub even: f64,
    /// By how much the spacing grows over a distance, without unit.
    pub growth: f64,
    /// The coarsest spacing (m).
    pub coarsest: f64,
}

/// The finest part of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Focus {
    /// About a point (m).
    Point(Vec3),
    /// Along a line: a point of it (m), and its direction as a unit vector.
    Line(Vec3, Vec3),
    /// At a plane: a point of it (m), and its normal as a unit vector.
    Plane(Vec3, Vec3),
}

impl Focus {
    /// Distance (m) of a place.
    #[must_use]
    pub fn distance(&self, x: &Vec3) -> f64 {
        match self {
            Self::Point(at) => (x - at).norm(),
            Self::Line(at, along) => {
                let arm = x - at;
                (arm - along * arm.dot(along)).norm()
            }
            Self::Plane(at, normal) => (x - at).dot(normal).abs(),
        }
    }

    /// Moves it.
    pub fn translate(&mut self, way: &Vec3) {
        let (Self::Point(at) | Self::Line(at, _) | Self::Plane(at, _)) = self;
        *at += way;
    }

    /// Corners of a box around all places within a distance (m); infinite along what has no end.
    #[must_use]
    pub fn around(&self, distance: f64) -> (Vec3, Vec3) {
        let (at, reach) = match self {
            Self::Point(at) => (at, Vec3::repeat(distance)),
            Self::Line(at, along) => (at, along.map(|c| ends(c == 0.0, distance))),
            Self::Plane(at, normal) => (at, normal.map(|c| ends(c.abs() == 1.0, distance))),
        };
        (at - reach, at + reach)
    }
}

fn ends(there: bool, distance: f64) -> f64 {
    if there { distance } else { f64::INFINITY }
}

impl Grading {
    /// Largest growth: what is within reach of a particle is less than twice as large.
    pub const MOST_GROWTH: f64 = 0.3;

    /// Spacing (m) at a distance (m) from the focus, of a body that has `finest` there.
    #[must_use]
    pub fn spacing(&self, finest: f64, distance: f64) -> f64 {
        let farther = (distance - self.even).max(0.0);
        (finest + self.growth * farther).min(self.coarsest)
    }

    /// Largest distance (m) at which the spacing is finer than `spacing` (m).
    #[must_use]
    pub fn distance(&self, finest: f64, spacing: f64) -> f64 {
        if spacing > self.coarsest {
            return f64::INFINITY;
        }
        self.even + (spacing - finest) / self.growth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_layer_is_thicker_by_the_growth() {
        let grading = Grading {
            from: Focus::Point(Vec3::zeros()),
            even: 2.0,
            growth: 0.1,
            coarsest: 3.0,
        };
        let (mut at, mut layer) = (2.0, 1.0);
        for _ in 0..10 {
            let spacing = grading.spacing(1.0, at);
            assert!((spacing / layer - 1.0).abs() < 1e-12);
            assert!((grading.distance(1.0, spacing) - at).abs() < 1e-12);
            (at, layer) = (at + spacing, 1.1 * layer);
        }
        assert_eq!(grading.spacing(1.0, 1.0), 1.0);
        assert_eq!(grading.spacing(1.0, 1e3), 3.0);
        assert_eq!(grading.distance(1.0, 4.0), f64::INFINITY);
    }

    #[test]
    fn distances_count_from_points_lines_and_planes() {
        let (at, x) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(4.0, 4.0, 9.0));
        assert_eq!(Focus::Point(at).distance(&Vec3::new(1.0, 3.0, 4.0)), 5.0);
        let line = Focus::Line(at, Vec3::z());
        assert_eq!(line.distance(&x), 5.0);
        assert_eq!(line.around(2.0).1, Vec3::new(3.0, 2.0, f64::INFINITY));
        let plane = Focus::Plane(at, Vec3::z());
        assert_eq!(plane.distance(&x), 9.0);
        assert_eq!(plane.around(2.0).0.z, -2.0);
        assert_eq!(plane.around(2.0).0.x, f64::NEG_INFINITY);
    }
}
