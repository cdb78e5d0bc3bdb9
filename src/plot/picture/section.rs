//! The particles that a plane cuts, and their positions in it.

use std::collections::BTreeSet;
use std::ops::Range;

use super::cells::Cell;
use super::view::View;
use crate::PlotError;
use crate::snapshots::bulk::{Bulk, joined};
use crate::snapshots::field::Drawn;
use crate::snapshots::images::{Image, Mirrors};
use crate::snapshots::plane::Plane;
use crate::snapshots::shape::Shape;
use crate::snapshots::slice::{NUDGE, mirrored, slice};
use crate::snapshots::snapshot::Snapshot;
use crate::units::Readable;
use model::{Axis, SymmetryPlane};

/// The way the particles of a section are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawnAs {
    /// As the cells that they fill, cut by the plane.
    Cut,
    /// As discs of the particle spacing: all that lie in a slice about the plane.
    Particles,
}

/// The section of one snapshot.
#[derive(Debug, Clone)]
pub struct Section {
    /// Time of the snapshot (s).
    pub time: f64,
    /// Particles: of a cut all that reach the plane, body by body; of a slice the nearest to the
    /// plane last, so that they are drawn on top.
    pub cells: Vec<Cell>,
    /// What of it a picture frames along both axes (m).
    ends: [[f64; 2]; 2],
}

/// The definition of a section.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// The plane.
    pub plane: Plane,
    /// The way particles are drawn.
    pub drawn_as: DrawnAs,
    /// Thickness of the slice (m); if absent the spacing of each body, or twice that on a symmetry
    /// plane, where the layer next to it and its image are the same.
    pub thickness: Option<f64>,
    /// `true` to reflect the model at its planes of symmetry.
    pub mirror: bool,
    /// The drawn quantity.
    pub drawn: Drawn,
}

impl Cut {
    /// Collects the particles near the plane; `names` is the number in the picture of each of the
    /// snapshot's bodies.
    ///
    /// A slice holds a particle if its distance d along the axis has −t/2 < d ≤ t/2. With t one
    /// spacing, a cubic lattice shows exactly one layer wherever the plane lies; with two on a
    /// symmetry plane, which is half-way between a layer and its image, too, and goes on to show it
    /// when the material expands.
    pub fn take(&self, snapshot: &Snapshot, names: &[usize]) -> Result<Section, PlotError> {
        let planes = self.mirrors(snapshot);
        let mirrors = Mirrors::new(planes.clone(), &self.drawn);
        let coarsest = snapshot.coarsest();
        let axes = self.plane.axes();
        let reach = match self.drawn_as {
            DrawnAs::Cut => snapshot.reach(),
            DrawnAs::Particles => self.thickness.unwrap_or(2.0 * coarsest),
        };
        let mut cells = Vec::new();
        let mut bulk = Bulk::default();
        let mut images = Vec::new();
        for chunk in snapshot.chunks() {
            let points = snapshot.file.points(chunk.clone())?;
            let near = self.near(&points, &planes, reach);
            if near.is_empty() {
                continue;
            }
            let rows = chunk.start + near.start..chunk.start + near.end;
            let bodies = snapshot.body_of(rows.clone())?;
            let sizes = snapshot.first_sizes(rows.clone(), &bodies)?;
            let shapes = match self.drawn_as {
                DrawnAs::Cut => snapshot.shapes(rows.clone(), &bodies)?,
                DrawnAs::Particles => sizes.iter().copied().map(Shape::ball).collect(),
            };
            let values = self.drawn.values(snapshot, rows.clone())?;
            let bearers = self.drawn.bearers(snapshot, rows)?;
            let all = points[near]
                .iter()
                .zip(bodies)
                .zip(sizes.into_iter().zip(shapes))
                .zip(values)
                .zip(bearers);
            for ((((point, body), (size, shape)), value), _) in all.filter(|(_, bears)| *bears) {
                mirrors.reflect(point, &shape, &mut images);
                let cell = |image: &Image| {
                    let shape = image.shape.along(&axes);
                    let half = match self.drawn_as {
                        DrawnAs::Cut => shape.reach(2),
                        DrawnAs::Particles => self.half_thickness(size, &snapshot.symmetry),
                    };
                    let at = self.flatten(&image.point, half, size)?;
                    let bears = self.drawn != Drawn::Body && !snapshot.rigid[body];
                    Some(Cell {
                        at: [at[0], at[1]],
                        depth: at[2],
                        shape,
                        body: names[body],
                        value: bears.then_some(image.signed(value)),
                    })
                };
                for cell in images.iter().filter_map(cell) {
                    if cell.is_cut() {
                        bulk.add(cell.body, cell.at, cell.radii(), Some(size * size));
                    }
                    cells.push(cell);
                }
            }
        }
        self.arrange(&mut cells);
        Ok(Section {
            time: snapshot.time,
            cells,
            ends: bulk.ends(),
        })
    }

    /// Sorts cells in the order in which they are drawn. Stable: equals stay in the order of their
    /// ids.
    fn arrange(&self, cells: &mut [Cell]) {
        match self.drawn_as {
            DrawnAs::Cut => cells.sort_by_key(|cell| cell.body),
            DrawnAs::Particles => {
                cells.sort_by(|a, b| b.depth.abs().total_cmp(&a.depth.abs()));
                for cell in cells {
                    cell.depth = 0.0;
                }
            }
        }
    }

    /// The rows of some points between the first and the last that may lie within `reach` (m) of
    /// the plane, by themselves or by an image: the rest need not be read.
    fn near(&self, points: &[[f64; 3]], planes: &[SymmetryPlane], reach: f64) -> Range<usize> {
        let k = self.plane.axis.index();
        let along = planes.iter().find(|plane| plane.axis == self.plane.axis);
        let near = |point: &[f64; 3]| {
            let distance = |x: f64| (x - self.plane.position).abs() <= reach;
            distance(point[k]) || along.is_some_and(|p| distance(2.0 * p.position - point[k]))
        };
        let first = points.iter().position(near).unwrap_or(points.len());
        let end = points.iter().rposition(near).map_or(first, |last| last + 1);
        first..end
    }

    /// The planes of symmetry with images: all of them; without mirror images only one that is the
    /// plane of the section, where half of the particles about it are not in the model.
    fn mirrors(&self, snapshot: &Snapshot) -> Vec<SymmetryPlane> {
        let planes = snapshot.symmetry.iter().copied();
        planes
            .filter(|plane| self.mirror || self.is_on(plane, snapshot.finest()))
            .collect()
    }

    /// `true` if the section is at a plane of symmetry.
    fn is_on(&self, mirror: &SymmetryPlane, spacing: f64) -> bool {
        mirror.axis == self.plane.axis
            && (mirror.position - self.plane.position).abs() < NUDGE * spacing
    }

    /// Half the thickness of the slice for a body of a spacing (m).
    fn half_thickness(&self, spacing: f64, symmetry: &[SymmetryPlane]) -> f64 {
        let on_mirror = self.mirror && symmetry.iter().any(|plane| self.is_on(plane, spacing));
        let default = if on_mirror { 2.0 * spacing } else { spacing };
        0.5 * self.thickness.unwrap_or(default)
    }

    /// Position along the picture's axes and distance from the plane (m) of a point that lies
    /// within `half` (m) of it.
    fn flatten(&self, point: &[f64; 3], half: f64, spacing: f64) -> Option<[f64; 3]> {
        let distance = point[self.plane.axis.index()] - self.plane.position;
        let [right, up] = self.plane.picture_axes();
        let at = [point[right.index()], point[up.index()], distance];
        (slice(distance, half, spacing) && at.iter().all(|c| c.is_finite())).then_some(at)
    }

    /// The error that no particle lies in the section.
    pub fn miss(&self, snapshot: &Snapshot) -> PlotError {
        let mut extent = snapshot.extent().unwrap_or_default()[self.plane.axis.index()];
        if extent.lowest > extent.highest {
            return PlotError::Options("the snapshot holds no matter: all has left the model");
        }
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

    /// The position of the section: `"section y = 0, mirrored at x = 0"`; a flat model has none.
    /// `position_text` writes a position on an axis, `length` a length.
    pub fn caption(
        &self,
        snapshot: &Snapshot,
        position_text: impl Fn(Axis, f64) -> String,
        length: impl Fn(f64) -> String,
    ) -> String {
        let at = position_text(self.plane.axis, self.plane.position);
        let section = match (self.drawn_as, self.thickness) {
            (DrawnAs::Cut, _) => format!("section {at}"),
            (DrawnAs::Particles, None) => format!("one layer of particles about {at}"),
            (DrawnAs::Particles, Some(thickness)) => {
                format!("slice of {} about {at}", length(thickness))
            }
        };
        let seen = |p: &&SymmetryPlane| self.mirror && p.axis != self.plane.axis;
        let planes = snapshot.symmetry.iter().filter(seen);
        let section = (snapshot.dimension == 3).then_some(section);
        let mirrored = mirrored(planes.map(|p| position_text(p.axis, p.position)));
        let texts: Vec<String> = section.into_iter().chain(mirrored).collect();
        texts.join(",  ")
    }
}

/// A view of the bodies of some sections, without single specks, with a small border.
pub fn view(sections: &[Section]) -> View {
    let ends = sections.iter().map(|section| section.ends);
    let reach = ends.reduce(|a, b| [joined(a[0], b[0]), joined(a[1], b[1])]);
    let reach = reach.unwrap_or_default();
    let longest = reach.iter().map(|s| s[1] - s[0]).fold(0.0, f64::max);
    let border = 0.03 * longest;
    let [x, y] = reach.map(|span| [span[0] - border, span[1] + border]);
    View { x, y }
}

/// Numbers of the bodies that a view of some sections shows, in ascending order.
pub fn bodies(sections: &[Section], view: &View) -> Vec<usize> {
    let cells = sections.iter().flat_map(|s| &s.cells);
    let visible = cells.filter(|c| c.is_cut() && view.shows(c.at, c.radii()));
    let bodies: BTreeSet<usize> = visible.map(|cell| cell.body).collect();
    bodies.into_iter().collect()
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
            drawn_as: DrawnAs::Particles,
            thickness: None,
            mirror,
            drawn: Drawn::Body,
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
                        cut.flatten(&[0.0, y, 0.0], 0.5 * spacing, spacing)
                            .is_some()
                    });
                assert_eq!(layers.count(), 1, "plane at {k}/8 spacings");
            }
        }
    }

    #[test]
    fn lost_positions_are_left_out() {
        let point = [f64::NAN, 0.0, 0.0];
        assert_eq!(cut(0.0, false).flatten(&point, 0.5, 1.0), None);
    }

    #[test]
    fn rows_far_from_the_plane_are_not_read() {
        let points: Vec<[f64; 3]> = (0..100).map(|k| [0.0, f64::from(k), 0.0]).collect();
        assert_eq!(cut(50.2, false).near(&points, &[], 2.0), 49..53);
        assert!(cut(-5.0, false).near(&points, &[], 2.0).is_empty());
        let mirror = SymmetryPlane {
            axis: Axis::Y,
            position: 0.0,
        };
        assert_eq!(cut(-5.0, true).near(&points, &[mirror], 1.0), 4..7);
    }
}
