//! Connected rest of a body that is struck, where its material has yielded.
//!
//! A window is laid about all material of the body that has flowed. In it the largest piece
//! remains. Material beside the window has not flowed and remains, too.

use rayon::prelude::*;

use super::attached::Attached;
use super::footprint::Footprint;
use super::frame::Frame;
use super::matter::{Matter, raise};
use super::voxels::{Grain, Voxels};
use super::window::Window;
use comm::Comm;
use model::{Include, Slab};
use particles::{MirrorMask, Mirrors};

/// Matter has flowed beyond this plastic strain: some elastic and plastic waves do not count.
const FLOWED: f64 = 0.05;

/// The window reaches this many voxels, and this part of its width, beyond matter that has flowed.
const MARGIN: (f64, f64) = (4.0, 0.1);

/// Lips and bulges are looked for as far from the faces as half the width of the window, at most this many
/// thicknesses and [`MARGIN`].
const LIPS: f64 = 8.0;

/// True if a place belongs to what remains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Belongs {
    /// It lies in it.
    Yes,
    /// It lies beside it, within a voxel.
    Nearly,
    /// It does not.
    No,
}

/// Remains of a slab.
#[derive(Debug)]
pub struct Remains {
    frame: Frame,
    /// Nothing if no matter has flowed.
    attached: Option<Attached>,
    /// Heights (m) between which what lies beside the window remains.
    between: [f64; 2],
    /// Height (m) below which all remains that lies above the rear face, and that face.
    untouched: [f64; 2],
    /// Membership of the particles of the body; of other bodies none belongs to it.
    belongs: Vec<Belongs>,
}

impl Remains {
    /// Finds it. Collective.
    #[must_use]
    pub fn find(slab: &Slab, matter: &Matter, comm: &Comm) -> Self {
        let frame = Frame::new(&slab.normal);
        let halves = Halves::new(&frame, &matter.mirrors);
        let reach = flowed(slab, &frame, &halves, matter, comm);
        let mut remains = Self {
            frame,
            attached: None,
            between: [f64::NEG_INFINITY, f64::INFINITY],
            untouched: [f64::INFINITY, slab.rear],
            belongs: Vec::new(),
        };
        if reach[0].is_finite() {
            let (window, beyond) = window(slab, &halves, &reach);
            let voxels = Voxels::new(window);
            voxels.fill(matter.len(), &halves.mirror_masks, |i, mirror_mask| {
                let counts = matter.body_of(i) == slab.body
                    && (slab.include == Include::All || !matter.has_failed(i));
                counts.then(|| Grain {
                    place: place(&frame, matter, i, mirror_mask),
                    volume: matter.volume(i),
                })
            });
            let fractions = voxels.sum(comm);
            remains.between = [slab.rear - beyond, slab.front + beyond];
            remains.untouched = [window.lower[2], slab.rear];
            remains.attached = Some(Attached::new(
                window,
                fractions,
                &outside(slab, &frame, &window, matter),
            ));
        }
        let particles = (0..matter.len()).into_par_iter();
        let belongs = |i: usize| {
            if matter.body_of(i) == slab.body {
                remains.place(&matter.position[i])
            } else {
                Belongs::No
            }
        };
        remains.belongs = particles.map(belongs).collect();
        remains
    }

    /// Part of it in the window, if material has flowed.
    #[must_use]
    pub fn attached(&self) -> Option<&Attached> {
        self.attached.as_ref()
    }

    /// Section of the body of the slab at the start.
    #[must_use]
    pub fn footprint(&self, slab: &Slab, matter: &Matter) -> Footprint {
        Footprint::new(slab, &self.frame, slab.spacing, matter)
    }

    /// Height (m) of a place (m) along the normal.
    #[must_use]
    pub fn height(&self, x: &[f64; 3]) -> f64 {
        self.frame.turned(x)[2]
    }

    /// True if a place (m) that lies behind the body lies below what remains of it, too.
    #[must_use]
    pub fn is_behind(&self, x: &[f64; 3]) -> bool {
        let place = self.frame.turned(x);
        let there = self.attached.as_ref();
        let voxel = there.and_then(|attached| Some((attached, attached.window.voxel(&place)?)));
        voxel.is_none_or(|(attached, voxel)| attached.is_below(voxel))
    }

    /// True if a particle belongs to it.
    #[must_use]
    pub fn holds(&self, i: usize) -> Belongs {
        self.belongs[i]
    }

    /// True if a particle of the body at a place (m) belongs to it.
    fn place(&self, x: &[f64; 3]) -> Belongs {
        let Some(attached) = &self.attached else {
            return Belongs::Yes;
        };
        let place = self.frame.turned(x);
        if let Some(voxel) = attached.window.voxel(&place) {
            return if attached.holds(voxel) {
                Belongs::Yes
            } else if attached.holds_near(voxel) {
                Belongs::Nearly
            } else {
                Belongs::No
            };
        }
        let window = &attached.window;
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        let beside = (0..2).any(|a| {
            let at = (place[a] - window.lower[a]) / window.edge;
            at < 0.0 || at >= window.counts[a] as f64
        });
        let [low, high] = self.between;
        let [top, rear] = self.untouched;
        let below = rear <= place[2] && place[2] < top;
        if below || beside && low <= place[2] && place[2] <= high {
            Belongs::Yes
        } else {
            Belongs::No
        }
    }
}

/// Symmetry planes that run along the normal, across one of the axes of its frame: what is behind them is not
/// looked at.
struct Halves {
    /// Their places on the first two axes (m).
    planes: [Option<f64>; 2],
    /// Mirror masks of the particle itself and of its images behind other planes.
    mirror_masks: Vec<MirrorMask>,
}

impl Halves {
    fn new(frame: &Frame, mirrors: &Mirrors) -> Self {
        let (planes, along) = frame.planes(mirrors);
        Self {
            planes,
            mirror_masks: mirrors
                .masks()
                .filter(|mirror_mask| mirror_mask.is_disjoint(along))
                .collect(),
        }
    }
}

/// Coordinates (m) of a particle's image.
fn place(frame: &Frame, matter: &Matter, i: usize, mirror_mask: MirrorMask) -> [f64; 3] {
    frame.turned(
        &matter
            .mirrors
            .reflect_position(&matter.position[i], mirror_mask),
    )
}

/// Reach (m) of flowed material of the body between its faces, along the axes of the frame and
/// against them; −∞ if none has flowed. Of a body whose plastic strain does not show it all has flowed. Collective.
fn flowed(slab: &Slab, frame: &Frame, halves: &Halves, matter: &Matter, comm: &Comm) -> [f64; 6] {
    let material = matter.case.bodies[slab.body].material;
    let shows_flow = matter.case.materials[material].shows_flow();
    let (low, high) = (slab.rear - slab.spacing, slab.front + slab.spacing);
    let mut reach = matter.largest::<6>(comm, |i, most| {
        let flowed = !shows_flow || matter.plastic_strain[i] >= FLOWED || matter.has_failed(i);
        if matter.body_of(i) != slab.body || !flowed {
            return;
        }
        for &mirror_mask in &halves.mirror_masks {
            let place = place(frame, matter, i, mirror_mask);
            if low <= place[2] && place[2] <= high {
                for a in 0..3 {
                    raise(&mut most[a], place[a]);
                    raise(&mut most[3 + a], -place[a]);
                }
            }
        }
    });
    for (a, plane) in halves.planes.iter().enumerate() {
        if let Some(plane) = plane {
            let farthest = (reach[a] - plane).max(reach[3 + a] + plane);
            (reach[a], reach[3 + a]) = (plane + farthest, farthest - plane);
        }
    }
    reach
}

/// Flags of kept columns of a window in which the body has not been at the start.
fn outside(slab: &Slab, frame: &Frame, window: &Window, matter: &Matter) -> Vec<bool> {
    let footprint = Footprint::new(slab, frame, window.edge, matter);
    let columns = (0..window.kept().iter().product()).into_par_iter();
    let is_outside = |column: usize| !footprint.holds(window.middle(column));
    columns.map(is_outside).collect()
}

/// The window about matter that has flowed within some reach (m), and how far it goes beyond the
/// faces (m).
fn window(slab: &Slab, halves: &Halves, reach: &[f64; 6]) -> (Window, f64) {
    let (voxels, part) = MARGIN;
    let width = (0..2).fold(0.0, |most: f64, a| most.max(reach[a] + reach[3 + a]));
    let margin = voxels * slab.spacing + part * width;
    let beyond = (0.5 * width).min(LIPS * slab.thickness()) + margin;
    let (mut lower, mut upper) = ([0.0; 3], [0.0; 3]);
    for a in 0..2 {
        (lower[a], upper[a]) = (-reach[3 + a] - margin, reach[a] + margin);
    }
    upper[2] = slab.front + beyond;
    // A thick target has nothing to tell below what has flowed.
    let deepest = -reach[5] - margin;
    lower[2] = if deepest > slab.rear {
        deepest
    } else {
        slab.rear - beyond
    };
    // A face between two voxels.
    let depth = ((slab.front - lower[2]) / slab.spacing).ceil();
    lower[2] = slab.front - depth * slab.spacing;
    let window = Window::new(lower, upper, slab.spacing, halves.planes);
    (window, beyond)
}
