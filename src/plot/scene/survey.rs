//! Positions and values of particles in a view: the frame and the colours of all pictures rest on
//! them.

use std::collections::BTreeSet;
use std::path::PathBuf;

use rayon::prelude::*;

use super::camera::Camera;
use super::cut::{Cuts, takes};
use crate::PlotError;
use crate::picture::view::View;
use crate::snapshots::bulk::{Bulk, joined};
use crate::snapshots::field::Drawn;
use crate::snapshots::grains::{Grain, PORTION, Selection};
use crate::snapshots::sample::{Sampled, every};
use crate::snapshots::snapshot::Snapshot;
use crate::snapshots::source::Source;
use results::Opener;

/// The extent and values of some snapshots.
#[derive(Debug)]
pub struct Survey {
    /// Reach of a particle, in its own sizes.
    sizes: f64,
    /// Lowest and highest place of what is framed along the picture's axes (m): to the right, upwards.
    ends: [[f64; 2]; 2],
    /// Lowest and highest place towards the viewer (m).
    depth: [f64; 2],
    /// The values.
    pub values: Sampled,
    /// The bodies that there are.
    bodies: BTreeSet<usize>,
    /// Times of the snapshots (s).
    pub times: Vec<f64>,
    /// The snapshots, each with the numbers of its bodies in the picture.
    pub snapshots: Vec<Numbered>,
}

/// A snapshot with the numbers of its bodies in the picture.
pub type Numbered = (PathBuf, Vec<usize>);

/// Nowhere.
const NONE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

impl Survey {
    /// Of no snapshot, whose particles reach `sizes` of their sizes far.
    pub fn new(sizes: f64) -> Self {
        Self {
            sizes,
            ends: [NONE; 2],
            depth: NONE,
            values: Sampled::default(),
            bodies: BTreeSet::new(),
            times: Vec::new(),
            snapshots: Vec::new(),
        }
    }

    /// Looks at all snapshots of some runs; `flat` is what is said of a flat model.
    ///
    /// # Errors
    /// [`PlotError::Read`] if one cannot be read, [`PlotError::Options`] if one is flat,
    /// [`PlotError::Body`] if none has a body that is wanted.
    pub fn look(
        &mut self,
        opener: &dyn Opener,
        sources: &[Source],
        selection: &mut Selection,
        camera: &Camera,
        cuts: &Cuts,
        flat: &'static str,
    ) -> Result<(), PlotError> {
        for path in sources.iter().flat_map(|source| &source.snapshots) {
            let snapshot = Snapshot::open(opener, path)?;
            if snapshot.dimension < 3 {
                return Err(PlotError::Options(flat));
            }
            let numbers = selection.bodies.add(&snapshot);
            self.add(&snapshot, &numbers, selection, camera, cuts)?;
            self.times.push(snapshot.time);
            self.snapshots.push((path.clone(), numbers));
        }
        selection.bodies.check()
    }

    /// Looks at a snapshot; `numbers` are those of its bodies in the picture.
    fn add(
        &mut self,
        snapshot: &Snapshot,
        numbers: &[usize],
        selection: &Selection,
        camera: &Camera,
        cuts: &Cuts,
    ) -> Result<(), PlotError> {
        let mirrors = selection.mirrors(snapshot);
        let slopes = cuts.slopes(camera);
        let particles = snapshot.file.particles();
        let every = every(particles);
        let mut bulk = Bulk::default();
        let mut values = Vec::new();
        for rows in snapshot.chunks() {
            let grains = selection.grains(snapshot, numbers, rows)?;
            let portion = |(first, part): (usize, &[Grain])| {
                let mut images = Vec::new();
                let (mut bulk, mut depth) = (Bulk::default(), NONE);
                let mut values = Vec::new();
                for (k, grain) in (first * PORTION..).zip(part) {
                    mirrors.reflect(&grain.point, &grain.shape, &mut images);
                    let bears =
                        selection.drawn != Drawn::Body && !selection.bodies.rigid[grain.body];
                    let matter = k.is_multiple_of(every).then(|| grain.first.powi(3));
                    for image in &images {
                        let [x, y, z] = camera.project(&image.point);
                        if takes(&slopes, &[x, y, z]) {
                            continue;
                        }
                        let shape = camera.shape(&image.shape);
                        let radius = |axis| self.sizes * shape.size(axis);
                        bulk.add(grain.body, [x, y], [radius(0), radius(1)], matter);
                        depth = joined(depth, [z - radius(2), z + radius(2)]);
                        if bears {
                            values.push(image.signed(grain.value));
                        }
                    }
                }
                (bulk, depth, values)
            };
            let portions = grains.par_chunks(PORTION).enumerate().map(portion);
            for (part, depth, own) in portions.collect::<Vec<_>>() {
                bulk.join(part);
                self.depth = joined(self.depth, depth);
                values.extend(own);
            }
            self.values.extend(values.drain(..), particles);
        }
        self.bodies.extend(bulk.bodies());
        for (own, other) in self.ends.iter_mut().zip(bulk.ends()) {
            *own = joined(*own, other);
        }
        Ok(())
    }

    /// The bodies, without single specks, with a small border; none if there is nothing.
    pub fn view(&self) -> Option<View> {
        let [x, y] = self.ends;
        let longest = (x[1] - x[0]).max(y[1] - y[0]);
        let border = 0.02 * longest;
        let [x, y] = [x, y].map(|span| [span[0] - border, span[1] + border]);
        longest.is_finite().then_some(View { x, y })
    }

    /// Numbers of the bodies that there are, in ascending order.
    pub fn bodies(&self) -> Vec<usize> {
        self.bodies.iter().copied().collect()
    }

    /// The middle along the line of sight (m).
    pub fn depth(&self) -> f64 {
        0.5 * (self.depth[0] + self.depth[1])
    }
}
