//! Positions and values of particles in a view: the frame and the colours of all pictures rest on
//! them.

use std::collections::BTreeSet;
use std::path::PathBuf;

use rayon::prelude::*;

use super::camera::Camera;
use super::cut::{Cuts, takes};
use crate::PlotError;
use crate::picture::view::View;
use crate::snapshots::field::Drawn;
use crate::snapshots::grains::{Grain, PORTION, Selection};
use crate::snapshots::sample::Sampled;
use crate::snapshots::snapshot::Snapshot;
use crate::snapshots::source::Source;
use results::Opener;

/// The extent and values of some snapshots.
#[derive(Debug)]
pub struct Survey {
    /// Reach of a particle, in its own sizes.
    sizes: f64,
    /// Lowest and highest place along the picture's axes: to the right, upwards, towards the viewer
    /// (m).
    reach: [[f64; 2]; 3],
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
const NONE: [[f64; 2]; 3] = [[f64::INFINITY, f64::NEG_INFINITY]; 3];

impl Survey {
    /// Of no snapshot, whose particles reach `sizes` of their sizes far.
    pub fn new(sizes: f64) -> Self {
        Self {
            sizes,
            reach: NONE,
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
        for rows in snapshot.chunks() {
            let grains = selection.grains(snapshot, numbers, rows)?;
            let portion = |part: &[Grain]| {
                let mut images = Vec::new();
                let mut reach = NONE;
                let mut values = Vec::new();
                let mut bodies = BTreeSet::new();
                for grain in part {
                    mirrors.reflect(&grain.point, &grain.shape, &mut images);
                    let bears =
                        selection.drawn != Drawn::Body && !selection.bodies.rigid[grain.body];
                    for image in &images {
                        let at = camera.project(&image.point);
                        if takes(&slopes, &at) {
                            continue;
                        }
                        bodies.insert(grain.body);
                        let shape = camera.shape(&image.shape);
                        for (k, (reach, at)) in reach.iter_mut().zip(at).enumerate() {
                            let radius = self.sizes * shape.size(k);
                            *reach = [reach[0].min(at - radius), reach[1].max(at + radius)];
                        }
                        if bears {
                            values.push(image.signed(grain.value));
                        }
                    }
                }
                (reach, values, bodies)
            };
            let portions: Vec<_> = grains.par_chunks(PORTION).map(portion).collect();
            for (reach, _, bodies) in &portions {
                self.bodies.extend(bodies);
                for (own, other) in self.reach.iter_mut().zip(reach) {
                    *own = [own[0].min(other[0]), own[1].max(other[1])];
                }
            }
            let values = portions.into_iter().flat_map(|(_, values, _)| values);
            self.values.extend(values, particles);
        }
        Ok(())
    }

    /// All that there is with a small border; none if there is nothing.
    pub fn view(&self) -> Option<View> {
        let [x, y, _] = self.reach;
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
        0.5 * (self.reach[2][0] + self.reach[2][1])
    }
}
