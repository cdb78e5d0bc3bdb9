//! Which particles a plane cuts, and where they lie in it.

use super::PlotError;
use super::field::Shown;
use super::snapshot::{Extent, Snapshot};
use super::units::{self, Readable};
use crate::model::{Axis, SymmetryPlane};

/// Shift of the slice's faces in spacings: far above the round-off of positions, far below what
/// the eye sees.
const NUDGE: f64 = 1e-6;

/// A plane normal to an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Normal.
    pub axis: Axis,
    /// Where it cuts its axis (m).
    pub position: f64,
}

impl Plane {
    /// The axes that point right and up in the picture.
    pub fn picture_axes(&self) -> [Axis; 2] {
        match self.axis {
            Axis::X => [Axis::Y, Axis::Z],
            Axis::Y => [Axis::X, Axis::Z],
            Axis::Z => [Axis::X, Axis::Y],
        }
    }

    /// Reads `y=0.1mm`; without a position the plane of symmetry or the middle of the model.
    pub fn parse(text: &str, snapshot: &Snapshot) -> Result<Self, PlotError> {
        let (name, position) = match text.split_once('=') {
            Some((name, position)) => (name, Some(position)),
            None => (text, None),
        };
        let axis = Axis::ALL.into_iter().find(|a| a.name() == name.trim());
        let axis = axis.ok_or_else(|| PlotError::Section {
            text: text.to_owned(),
        })?;
        match position {
            Some(position) => Ok(Self {
                axis,
                position: units::parse(position, "m")?,
            }),
            None => Ok(Self::through(axis, snapshot, &snapshot.extent()?)),
        }
    }

    /// The plane that shows most of a model: z of a flat model, else a plane of symmetry, else
    /// the middle of y.
    pub fn best(snapshot: &Snapshot) -> Result<Self, PlotError> {
        let extent = snapshot.extent()?;
        let depth = extent[Axis::Z.index()];
        let flat = depth.highest - depth.lowest <= NUDGE * snapshot.finest();
        let symmetric = |axis: &Axis| snapshot.symmetry.iter().any(|plane| plane.axis == *axis);
        let axis = if flat {
            Axis::Z
        } else {
            let preferred = [Axis::Y, Axis::Z, Axis::X];
            preferred.into_iter().find(symmetric).unwrap_or(Axis::Y)
        };
        Ok(Self::through(axis, snapshot, &extent))
    }

    /// The plane of symmetry, or through the middle of the model.
    pub fn through(axis: Axis, snapshot: &Snapshot, extent: &[Extent; 3]) -> Self {
        let plane = snapshot.symmetry.iter().find(|plane| plane.axis == axis);
        // Without the round-off of a mean.
        let step = 1e-3 * snapshot.finest();
        let middle = (extent[axis.index()].mean() / step).round() * step;
        Self {
            axis,
            position: plane.map_or(middle, |plane| plane.position),
        }
    }
}

/// A particle in a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Position along the picture's axes (m).
    pub at: [f64; 2],
    /// Distance from the plane (m).
    depth: f64,
    /// Index of its body.
    pub body: usize,
    /// The shown field in its own unit; rigid bodies show none.
    pub value: Option<f64>,
}

/// What a plane shows of one snapshot.
#[derive(Debug, Clone)]
pub struct Section {
    /// Time of the snapshot (s).
    pub time: f64,
    /// Particles, the nearest to the plane last, so that they are drawn on top.
    pub discs: Vec<Disc>,
}

/// How a section is taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// The plane.
    pub plane: Plane,
    /// Thickness of the slice (m); if absent the spacing of each body, or twice that on a symmetry
    /// plane, where the layer next to it and its image are the same.
    pub thickness: Option<f64>,
    /// Whether to reflect the model at its planes of symmetry.
    pub mirror: bool,
    /// What is shown.
    pub shown: Shown,
}

impl Cut {
    /// Collects the particles of a slice about the plane.
    ///
    /// A particle belongs to it if its distance d along the axis has −t/2 < d ≤ t/2. With t one
    /// spacing, a cubic lattice shows exactly one layer wherever the plane lies; with two on a
    /// symmetry plane, which is half-way between a layer and its image, too, and goes on to show it
    /// when the material expands.
    pub fn take(&self, snapshot: &Snapshot) -> Result<Section, PlotError> {
        let mut discs = Vec::new();
        let mut images = Vec::new();
        for rows in snapshot.chunks() {
            let points = snapshot.file.points(rows.clone())?;
            let bodies = snapshot.body_of(rows.clone())?;
            let values = self.shown.values(snapshot, rows.clone())?;
            let bearers = self.shown.bearers(snapshot, rows)?;
            let all = points.into_iter().zip(bodies).zip(values).zip(bearers);
            for (((point, body), value), _) in all.filter(|(_, bears)| *bears) {
                let spacing = snapshot.spacings[body];
                self.reflect(&point, &snapshot.symmetry, &mut images);
                let half = self.half_thickness(spacing, &snapshot.symmetry);
                let value = (!snapshot.rigid[body]).then_some(value);
                let found = images
                    .iter()
                    .filter_map(|p| self.disc(p, half, spacing, body, value));
                discs.extend(found);
            }
        }
        // Stable: equally deep particles stay in the order of their ids.
        discs.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        Ok(Section {
            time: snapshot.time,
            discs,
        })
    }

    /// Fills `images` with a particle and its reflections at all planes of symmetry.
    fn reflect(&self, point: &[f64; 3], symmetry: &[SymmetryPlane], images: &mut Vec<[f64; 3]>) {
        images.clear();
        images.push(*point);
        for plane in symmetry.iter().filter(|_| self.mirror) {
            let k = plane.axis.index();
            for n in 0..images.len() {
                let mut image = images[n];
                image[k] = 2.0 * plane.position - image[k];
                images.push(image);
            }
        }
    }

    /// Half the thickness of the slice for a body of a spacing (m).
    fn half_thickness(&self, spacing: f64, symmetry: &[SymmetryPlane]) -> f64 {
        let on_mirror = self.mirror
            && symmetry.iter().any(|mirror| {
                mirror.axis == self.plane.axis
                    && (mirror.position - self.plane.position).abs() < NUDGE * spacing
            });
        let default = if on_mirror { 2.0 * spacing } else { spacing };
        0.5 * self.thickness.unwrap_or(default)
    }

    /// The particle at `point` if the slice of that half thickness holds it.
    fn disc(
        &self,
        point: &[f64; 3],
        half: f64,
        spacing: f64,
        body: usize,
        value: Option<f64>,
    ) -> Option<Disc> {
        let distance = point[self.plane.axis.index()] - self.plane.position;
        let [right, up] = self.plane.picture_axes();
        let at = [point[right.index()], point[up.index()]];
        (slice(distance, half, spacing) && at.iter().all(|c| c.is_finite())).then_some(Disc {
            at,
            depth: distance.abs(),
            body,
            value,
        })
    }

    /// The error that no particle lies in the section.
    pub fn miss(&self, snapshot: &Snapshot) -> PlotError {
        let mut extent = snapshot.extent().unwrap_or_default()[self.plane.axis.index()];
        for plane in snapshot
            .symmetry
            .iter()
            .filter(|p| self.mirror && p.axis == self.plane.axis)
        {
            extent.lowest = extent.lowest.min(2.0 * plane.position - extent.highest);
            extent.highest = extent.highest.max(2.0 * plane.position - extent.lowest);
        }
        let reach = extent.lowest.abs().max(extent.highest.abs());
        let unit = Readable::new("m", reach.max(self.plane.position.abs()));
        let show = |position: f64| format!("{} {}", unit.number(position, 3), unit.name);
        PlotError::Empty {
            axis: self.plane.axis.name(),
            position: show(self.plane.position),
            lowest: show(extent.lowest),
            highest: show(extent.highest),
        }
    }
}

/// Whether a slice of a half thickness holds a distance from its middle: −half < d ≤ half but
/// for round-off, so that a lattice shows exactly one layer.
pub fn slice(distance: f64, half: f64, spacing: f64) -> bool {
    let nudge = NUDGE * spacing;
    distance > nudge - half && distance <= half + nudge
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(position: f64, mirror: bool) -> Cut {
        Cut {
            plane: Plane {
                axis: Axis::Y,
                position,
            },
            thickness: None,
            mirror,
            shown: Shown::Body,
        }
    }

    #[test]
    fn a_lattice_shows_one_layer_wherever_the_plane_lies() {
        let spacing = 2e-5;
        for k in -40..=40 {
            let cut = cut(f64::from(k) * spacing / 8.0, false);
            // Layers half a spacing from y = 0, as beside a symmetry plane, with round-off.
            for shift in [-1e-21, 0.0, 1e-21] {
                let layers = (-10..10)
                    .map(|n| (f64::from(n) + 0.5) * spacing + shift)
                    .filter(|&y| {
                        cut.disc(&[0.0, y, 0.0], 0.5 * spacing, spacing, 0, None)
                            .is_some()
                    });
                assert_eq!(layers.count(), 1, "plane at {k}/8 spacings");
            }
        }
    }

    #[test]
    fn a_quarter_model_has_four_images() {
        let plane = |axis| SymmetryPlane {
            axis,
            position: 1.0,
        };
        let symmetry = [plane(Axis::X), plane(Axis::Y)];
        let mut images = Vec::new();
        cut(1.0, true).reflect(&[1.5, 1.25, 3.0], &symmetry, &mut images);
        let expected = [
            [1.5, 1.25, 3.0],
            [0.5, 1.25, 3.0],
            [1.5, 0.75, 3.0],
            [0.5, 0.75, 3.0],
        ];
        assert_eq!(images, expected);
        cut(1.0, false).reflect(&[1.5, 1.25, 3.0], &symmetry, &mut images);
        assert_eq!(images, [[1.5, 1.25, 3.0]]);
    }

    #[test]
    fn lost_positions_are_left_out() {
        let point = [f64::NAN, 0.0, 0.0];
        assert_eq!(cut(0.0, false).disc(&point, 0.5, 1.0, 0, None), None);
    }
}
