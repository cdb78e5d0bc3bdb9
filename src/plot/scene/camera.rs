//! From where a model is seen.

use crate::PlotError;
use crate::snapshots::shape::Shape;
use numerics::vector::dot;

/// The names of views, with the azimuth and the elevation of the viewer (degrees).
const NAMES: [(&str, [f64; 2]); 7] = [
    ("isometric", [-45.0, ISOMETRIC]),
    ("front", [0.0, 0.0]),
    ("right", [90.0, 0.0]),
    ("back", [180.0, 0.0]),
    ("left", [270.0, 0.0]),
    ("top", [0.0, 90.0]),
    ("bottom", [0.0, -90.0]),
];

/// Elevation from which all three axes look equally long: atan(1/√2).
const ISOMETRIC: f64 = 35.264_389_682_754_654;

/// A viewer far away: parallel rays.
///
/// Seen from the front x runs to the right and z upwards. The azimuth turns the viewer about z
/// from there to the right, the elevation lifts it.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// The name of the view in captions.
    pub name: String,
    /// Unit vector to the right of the picture.
    pub right: [f64; 3],
    /// Unit vector upwards in the picture.
    pub up: [f64; 3],
    /// Unit vector towards the viewer.
    pub towards: [f64; 3],
}

impl Camera {
    /// Reads the name of a view, or `AZIMUTH,ELEVATION` in degrees.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] for anything else.
    pub fn parse(text: &str) -> Result<Self, PlotError> {
        let text = text.trim();
        if let Some(&(name, [azimuth, elevation])) = NAMES.iter().find(|(name, _)| *name == text) {
            let caption = match name {
                "isometric" => "isometric view".to_owned(),
                "top" => "seen from above".to_owned(),
                "bottom" => "seen from below".to_owned(),
                side => format!("seen from the {side}"),
            };
            return Ok(Self::at(azimuth, elevation, caption));
        }
        let wrong = || {
            PlotError::quantity(
                text,
                format!(
                    "a view: {}, or AZIMUTH,ELEVATION in degrees, as in -30,20",
                    NAMES.map(|(name, _)| name).join(", ")
                ),
            )
        };
        let number = |text: &str| {
            let text = text.trim().trim_end_matches('°');
            text.parse().ok().filter(|n: &f64| n.abs() <= 360.0)
        };
        let (azimuth, elevation) = text.split_once(',').ok_or_else(wrong)?;
        match (number(azimuth), number(elevation)) {
            (Some(azimuth), Some(elevation)) if elevation.abs() <= 90.0 => {
                let caption = format!("seen from azimuth {azimuth}°, elevation {elevation}°");
                Ok(Self::at(azimuth, elevation, caption.replace('-', "−")))
            }
            _ => Err(wrong()),
        }
    }

    /// `true` if a text that may be a part of the plane is a view: it has no range in it.
    #[must_use]
    pub fn is_view(text: &str) -> bool {
        !text.contains(':')
    }

    fn at(azimuth: f64, elevation: f64, name: String) -> Self {
        let ([sin, cos], [rise, level]) = (sine_and_cosine(azimuth), sine_and_cosine(elevation));
        let ahead = [sin, -cos];
        Self {
            name,
            right: [cos, sin, 0.0],
            up: [-rise * ahead[0], -rise * ahead[1], level],
            towards: [level * ahead[0], level * ahead[1], rise],
        }
    }

    /// A point (m) along the picture's axes: to the right, upwards, towards the viewer.
    #[must_use]
    pub fn project(&self, point: &[f64; 3]) -> [f64; 3] {
        [&self.right, &self.up, &self.towards].map(|axis| dot(axis, point))
    }

    /// A shape along the same axes.
    #[must_use]
    pub fn shape(&self, shape: &Shape) -> Shape {
        shape.along(&[self.right, self.up, self.towards])
    }
}

/// Sine and cosine of an angle (degrees), without round-off at right angles.
fn sine_and_cosine(degrees: f64) -> [f64; 2] {
    let quarters = (degrees / 90.0).round();
    let (sin, cos) = (degrees - 90.0 * quarters).to_radians().sin_cos();
    match quarters.rem_euclid(4.0) {
        0.0 => [sin, cos],
        1.0 => [cos, -sin],
        2.0 => [-sin, -cos],
        _ => [-cos, sin],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_views_lie_along_the_axes() {
        for (name, right, up) in [
            ("front", [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
            ("back", [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
            ("right", [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
            ("left", [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]),
            ("top", [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            ("bottom", [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
        ] {
            let camera = Camera::parse(name).unwrap();
            assert_eq!((camera.right, camera.up), (right, up), "{name}");
        }
        assert_eq!(
            Camera::parse("90,0").unwrap().towards,
            Camera::parse("right").unwrap().towards
        );
    }

    #[test]
    fn axes_are_those_of_a_right_hand_and_equal_from_the_isometric_view() {
        for text in ["isometric", "33,-12", "-170,71.5"] {
            let Camera {
                right, up, towards, ..
            } = Camera::parse(text).unwrap();
            let cross = [
                right[1] * up[2] - right[2] * up[1],
                right[2] * up[0] - right[0] * up[2],
                right[0] * up[1] - right[1] * up[0],
            ];
            for k in 0..3 {
                assert!((cross[k] - towards[k]).abs() < 1e-15, "{text}");
            }
        }
        let towards = Camera::parse("isometric").unwrap().towards;
        assert!(
            towards
                .iter()
                .all(|t| (t.abs() - 3_f64.sqrt().recip()).abs() < 1e-15)
        );
    }

    #[test]
    fn other_words_are_refused() {
        for text in ["above", "1", "1,2,3", "0,91", "nan,0", ""] {
            let complaint = Camera::parse(text).unwrap_err().to_string();
            assert!(complaint.contains("isometric"), "{complaint}");
        }
    }
}
