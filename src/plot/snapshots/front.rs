//! The front of a body over time: how far the largest fragment of it reaches along an axis.

use std::fmt::Write as _;
use std::path::PathBuf;

use super::field::Drawn;
use super::snapshot::Snapshot;
use crate::PlotError;
use model::Axis;
use particles::connected::components;
use results::Opener;

/// A direction along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Direction {
    /// The axis.
    pub axis: Axis,
    /// `true` if against it, towards its smaller coordinates.
    pub backwards: bool,
}

impl Direction {
    /// Reads `x`, `+x`, `-x` and so on.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] for anything else.
    pub fn parse(text: &str) -> Result<Self, PlotError> {
        let name = text.trim_start_matches(['+', '-']);
        let axis = Axis::named(name);
        match axis {
            Some(axis) if text.len() <= 2 => Ok(Self {
                axis,
                backwards: text.starts_with('-'),
            }),
            _ => Err(PlotError::quantity(
                text,
                "x, y or z for a front, or against them -x, -y or -z",
            )),
        }
    }

    /// `x`, or `minus_x` against it: for names of files and columns.
    #[must_use]
    pub fn name(self) -> String {
        let against = if self.backwards { "minus_" } else { "" };
        format!("{against}{}", self.axis.name())
    }

    /// `+x` or `−x`.
    #[must_use]
    pub fn sign(self) -> String {
        let sign = if self.backwards { '−' } else { '+' };
        format!("{sign}{}", self.axis.name())
    }
}

/// The front of a body in some snapshots, as a table: `time,front_x`, or `front_minus_x` against
/// the axis.
///
/// Each row is a time (s) and the largest coordinate (m) of the body's largest connected fragment
/// ([`largest_reaches`]), or of all of it as long as it has not torn; against the axis the smallest.
///
/// # Errors
/// [`PlotError::Body`] if there is no such body, [`PlotError::Read`] if a snapshot cannot be read.
pub fn front(
    opener: &dyn Opener,
    snapshots: &[PathBuf],
    body: &str,
    direction: Direction,
) -> Result<String, PlotError> {
    let mut table = format!("# units: s,m\ntime,front_{}\n", direction.name());
    let sign = if direction.backwards { -1.0 } else { 1.0 };
    let axis = direction.axis.index();
    for path in snapshots {
        let snapshot = Snapshot::open(opener, path)?;
        let Some(wanted) = snapshot.bodies.iter().position(|name| name == body) else {
            return Err(PlotError::Body {
                name: body.to_owned(),
                known: snapshot.bodies,
            });
        };
        let (mut points, mut whole) = (Vec::new(), Vec::new());
        for rows in snapshot.chunks() {
            let bodies = snapshot.body_of(rows.clone())?;
            let bearers = Drawn::Body.bearers(&snapshot, rows.clone())?;
            let images = snapshot.images(rows.clone(), &bodies)?;
            let all = snapshot.file.points(rows)?.into_iter().zip(images);
            let all = all.zip(bodies).zip(bearers);
            for (((mut point, image), of), bears) in all {
                if bears && of == wanted {
                    point[axis] *= sign;
                    points.push(point);
                    whole.extend(image.map(|image| point[axis] + 0.5 * image.size(axis)));
                }
            }
        }
        let front = if whole.len() == points.len() {
            let finite = whole.into_iter().filter(|x| x.is_finite());
            finite.reduce(f64::max)
        } else {
            largest_reaches(&points, axis, snapshot.spacings[wanted])
        };
        if let Some(front) = front {
            let _ = writeln!(table, "{:?},{:?}", snapshot.time, sign * front);
        }
    }
    Ok(table)
}

/// The largest coordinate (m) along an axis of most of the points, those that hang together, half a
/// `spacing` (m) beyond its outermost centre; points within one and a half spacings hang together.
/// `None` without points.
#[must_use]
pub fn largest_reaches(points: &[[f64; 3]], axis: usize, spacing: f64) -> Option<f64> {
    let bulk = components(points, 1.5 * spacing).into_iter().next()?;
    let outermost = bulk.iter().map(|&i| points[i][axis]).reduce(f64::max);
    outermost.map(|x| x + 0.5 * spacing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_read_and_named() {
        let names = |text: &str| Direction::parse(text).map(|d| (d.name(), d.sign()));
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        assert_eq!(names("x").unwrap(), pair("x", "+x"));
        assert_eq!(names("+y").unwrap(), pair("y", "+y"));
        assert_eq!(names("-z").unwrap(), pair("minus_z", "−z"));
        for wrong in ["r", "--z", "", "-", "xx"] {
            assert!(
                names(wrong)
                    .unwrap_err()
                    .to_string()
                    .contains("-x, -y or -z")
            );
        }
    }

    #[test]
    fn a_splash_is_no_part_of_the_bulk() {
        let mut points: Vec<[f64; 3]> = (0..10).map(|k| [f64::from(k), -0.2, 0.0]).collect();
        points.push([11.0, 0.0, 0.0]);
        points.push([12.0, 0.0, 0.0]);
        points.push([f64::NAN, 0.0, 0.0]);
        let parts = components(&points, 1.5);
        assert_eq!(parts.iter().map(Vec::len).collect::<Vec<_>>(), [10, 2]);
        assert_eq!(largest_reaches(&points, 0, 1.0), Some(9.5));
        points.push([10.0, 0.9, 0.0]);
        assert_eq!(components(&points, 1.5).len(), 1);
        assert_eq!(largest_reaches(&points, 0, 1.0), Some(12.5));
        assert_eq!(largest_reaches(&[], 0, 1.0), None);
    }
}
