//! The matter that a picture of a whole model shows, some rows of a snapshot at a time.

use std::ops::Range;

use rayon::prelude::*;

use super::bodies::Bodies;
use super::field::Shown;
use super::images::Mirrors;
use super::slice::{mirrored, place};
use super::snapshot::Snapshot;
use crate::PlotError;

/// Particles that one task takes.
pub const PORTION: usize = 8192;

/// A particle that is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grain {
    /// Where (m).
    pub point: [f64; 3],
    /// Its size s, the spacing of the volume that it has now (m).
    pub size: f64,
    /// Number of its body in the picture.
    pub body: usize,
    /// The shown number in its own unit; that of a body is 0.
    pub value: f64,
}

/// What of snapshots is shown.
#[derive(Debug)]
pub struct Wanted {
    /// The bodies.
    pub bodies: Bodies,
    /// The number of each particle.
    pub shown: Shown,
    /// Whether to reflect the model at its planes of symmetry.
    pub mirror: bool,
}

impl Wanted {
    /// The planes at which a snapshot is reflected.
    pub fn mirrors(&self, snapshot: &Snapshot) -> Mirrors {
        let planes = if self.mirror {
            snapshot.symmetry.clone()
        } else {
            Vec::new()
        };
        Mirrors::new(planes, &self.shown)
    }

    /// `"mirrored at x = 0 and y = 0"`, and which bodies alone are shown, if not all.
    pub fn caption(&self, snapshot: &Snapshot) -> String {
        let mirrors = self.mirrors(snapshot);
        let planes = mirrors
            .planes()
            .map(|plane| place(plane.axis.name(), plane.position, snapshot.finest()));
        let mirrored = mirrored(planes);
        let alone = self
            .bodies
            .alone()
            .map(|names| format!("{} alone", names.join(", ")));
        let texts: Vec<String> = mirrored.into_iter().chain(alone).collect();
        texts.join(",  ")
    }

    /// Particles of some rows that are shown: those of its bodies that bear the number, at places
    /// that are known; `numbers` are those of the snapshot's bodies.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read.
    pub fn grains(
        &self,
        snapshot: &Snapshot,
        numbers: &[usize],
        rows: Range<usize>,
    ) -> Result<Vec<Grain>, PlotError> {
        let values = self.shown.values(snapshot, rows.clone())?;
        self.bearing(snapshot, numbers, rows, &values)
    }

    /// The same with their masses (kg) as values.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if it does not
    /// tell masses.
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
        let sizes = snapshot.sizes(rows.clone(), &bodies)?;
        let bearers = self.shown.bearers(snapshot, rows)?;
        let is_shown: Vec<bool> = numbers.iter().map(|&n| self.bodies.shows(n)).collect();
        let grain = |k: usize| {
            let (point, body) = (points[k], bodies[k]);
            let known = point.iter().all(|c| c.is_finite());
            (bearers[k] && is_shown[body] && known).then(|| Grain {
                point,
                size: sizes[k],
                body: numbers[body],
                value: values[k],
            })
        };
        let rows = (0..points.len()).into_par_iter();
        Ok(rows.filter_map(grain).collect())
    }
}
