//! The particles in a picture of a whole model, some rows of a snapshot at a time.

use std::ops::Range;

use rayon::prelude::*;

use super::bodies::Bodies;
use super::field::Drawn;
use super::images::{Image, Mirrors};
use super::shape::Shape;
use super::slice::{mirrored, position_text};
use super::snapshot::Snapshot;
use crate::PlotError;

/// Particles that one task takes.
pub const PORTION: usize = 8192;

/// A particle that is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    /// Position (m).
    pub point: [f64; 3],
    /// Its shape.
    pub shape: Shape,
    /// Its size at the start (m).
    pub first: f64,
    /// Number of its body in the picture.
    pub body: usize,
    /// The drawn number in its own unit; that of a body is 0.
    pub value: f64,
}

/// What `make` makes of particles and their images, in their order.
pub fn of_images<T: Send>(
    grains: &[Grain],
    mirrors: &Mirrors,
    make: impl Fn(&Grain, &Image) -> Option<T> + Sync,
) -> Vec<T> {
    let portion = |part: &[Grain]| {
        let (mut images, mut made) = (Vec::new(), Vec::new());
        for grain in part {
            mirrors.reflect(&grain.point, &grain.shape, &mut images);
            made.extend(images.iter().filter_map(|image| make(grain, image)));
        }
        made
    };
    grains.par_chunks(PORTION).flat_map_iter(portion).collect()
}

/// The bodies and the quantity that are drawn.
#[derive(Debug)]
pub struct Selection {
    /// The bodies.
    pub bodies: Bodies,
    /// The number of each particle.
    pub drawn: Drawn,
    /// `true` to reflect the model at its planes of symmetry.
    pub mirror: bool,
}

impl Selection {
    /// The planes at which a snapshot is reflected.
    #[must_use]
    pub fn mirrors(&self, snapshot: &Snapshot) -> Mirrors {
        let planes = if self.mirror {
            snapshot.symmetry.clone()
        } else {
            Vec::new()
        };
        Mirrors::new(planes, &self.drawn)
    }

    /// `"mirrored at x = 0 and y = 0"`, and the bodies that alone are drawn, if not all.
    #[must_use]
    pub fn caption(&self, snapshot: &Snapshot) -> String {
        let mirrors = self.mirrors(snapshot);
        let planes = mirrors
            .planes()
            .map(|plane| position_text(plane.axis.name(), plane.position, snapshot.finest()));
        let mirrored = mirrored(planes);
        let alone = self
            .bodies
            .alone()
            .map(|names| format!("{} alone", names.join(", ")));
        let texts: Vec<String> = mirrored.into_iter().chain(alone).collect();
        texts.join(",  ")
    }

    /// Particles of some rows that are drawn: those of its bodies that have the number, at finite
    /// positions; `numbers` are those of the snapshot's bodies.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read.
    pub fn grains(
        &self,
        snapshot: &Snapshot,
        numbers: &[usize],
        rows: Range<usize>,
    ) -> Result<Vec<Grain>, PlotError> {
        let values = self.drawn.values(snapshot, rows.clone())?;
        self.bearing(snapshot, numbers, rows, &values)
    }

    /// The same with their masses (kg) as values.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if it has no
    /// masses.
    pub fn masses(
        &self,
        snapshot: &Snapshot,
        numbers: &[usize],
        rows: Range<usize>,
    ) -> Result<Vec<Grain>, PlotError> {
        let masses = snapshot.masses(rows.clone())?;
        self.bearing(snapshot, numbers, rows, &masses)
    }

    fn bearing(
        &self,
        snapshot: &Snapshot,
        numbers: &[usize],
        rows: Range<usize>,
        values: &[f64],
    ) -> Result<Vec<Grain>, PlotError> {
        let points = snapshot.file.points(rows.clone())?;
        let bodies = snapshot.body_of(rows.clone())?;
        let shapes = snapshot.shapes(rows.clone(), &bodies)?;
        let sizes = snapshot.first_sizes(rows.clone(), &bodies)?;
        let bearers = self.drawn.bearers(snapshot, rows)?;
        let is_drawn: Vec<bool> = numbers.iter().map(|&n| self.bodies.shows(n)).collect();
        let grain = |k: usize| {
            let (point, body) = (points[k], bodies[k]);
            let known = point.iter().all(|c| c.is_finite());
            (bearers[k] && is_drawn[body] && known).then(|| Grain {
                point,
                shape: shapes[k],
                first: sizes[k],
                body: numbers[body],
                value: values[k],
            })
        };
        let rows = (0..points.len()).into_par_iter();
        Ok(rows.filter_map(grain).collect())
    }
}
