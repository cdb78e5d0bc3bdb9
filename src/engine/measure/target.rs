//! Targets: the crater.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::attached::Attached;
use super::figure::{Distribution, Figure, Findings};
use super::footprint::Footprint;
use super::mask::{Mask, diameter};
use super::matter::Matter;
use super::remains::{Belongs, Remains};
use comm::Comm;
use model::Slab;

/// Rings of a profile reach this many radii of the crater.
const PROFILE: f64 = 3.0;

/// Where the surface of the start is steeper than this cosine of its slope, a depth along the normal tells little.
const STEEPEST: f64 = 0.5;

/// The crater of what remains of a target, against its own surface of the start.
struct Crater {
    /// Greatest depth (m) below that surface.
    depth: f64,
    /// Diameter (m) of a circle with its area in the face.
    diameter: f64,
    /// Volume (m³) below the face.
    volume: f64,
    /// Greatest height (m) of the rim above the face.
    rim: f64,
    /// Mean depth (m, above the face negative) by distance (m) from its middle.
    profile: Vec<[f64; 3]>,
}

impl Crater {
    const NONE: Self = Self {
        depth: 0.0,
        diameter: 0.0,
        volume: 0.0,
        rim: 0.0,
        profile: Vec::new(),
    };

    fn of(attached: &Attached, footprint: &Footprint) -> Self {
        let (window, edge) = (&attached.window, attached.window.edge);
        let columns = (0..window.kept().iter().product()).into_par_iter();
        let faces: Vec<Option<(f64, f64)>> = columns
            .map(|column| {
                let face = footprint.front(window.middle(column));
                face.filter(|(_, cosine)| *cosine >= STEEPEST)
            })
            .collect();
        let columns = || window.images().zip(attached.ends()).enumerate();
        let depths: Vec<f64> = columns()
            .map(|(column, (image, ends))| match (faces[image], ends) {
                (Some((face, _)), Some([_, top])) if attached.is_of_body(column) => face - top,
                // A column of the target without matter is as deep as it.
                (Some((face, _)), None) if attached.is_of_body(column) => {
                    let rear = footprint.rear(window.middle(image));
                    rear.map_or(0.0, |rear| face - rear)
                }
                _ => 0.0,
            })
            .collect();
        // The ends of a column are certain to half a voxel normal to the surface.
        let is_below = |(&depth, image): (&f64, usize)| {
            faces[image].is_some_and(|(_, cosine)| depth > 0.5 * edge / cosine)
        };
        let below: Vec<bool> = depths.iter().zip(window.images()).map(is_below).collect();
        let deepest = (depths.iter().enumerate())
            .filter(|(cell, _)| below[*cell])
            .fold(None, |best, (cell, &depth)| match best {
                Some((_, most)) if depth <= most => best,
                _ => Some((cell, depth)),
            });
        let rim = depths.iter().fold(0.0, |most: f64, depth| most.max(-depth));
        let Some((cell, depth)) = deepest else {
            return Self { rim, ..Self::NONE };
        };
        let counts = [window.counts[0], window.counts[1]];
        let below = Mask::new(counts, below);
        let crater = below.part_of(cell);
        let volume: f64 = crater.cells().map(|cell| depths[cell]).sum();
        let mut crater = Self {
            depth,
            diameter: diameter(crater.count(), edge),
            volume: volume * edge * edge,
            rim,
            profile: rings(&crater, &depths, counts, edge),
        };
        let farthest = PROFILE * 0.5 * crater.diameter;
        crater.profile.retain(|[from, ..]| *from < farthest);
        crater
    }
}

/// Means by rings as wide as a cell about the middle of some cells.
fn rings(cells: &Mask, values: &[f64], [rows, across]: [usize; 2], edge: f64) -> Vec<[f64; 3]> {
    #[expect(clippy::cast_precision_loss, reason = "counts are small")]
    let place = |cell: usize| [(cell / across) as f64, (cell % across) as f64];
    #[expect(clippy::cast_precision_loss, reason = "counts are small")]
    let count = cells.count() as f64;
    let middle: [f64; 2] =
        std::array::from_fn(|a| cells.cells().map(|cell| place(cell)[a]).sum::<f64>() / count);
    let mut sums = vec![[0.0; 2]; rows + across];
    for (cell, value) in values.iter().enumerate() {
        let [x, y] = place(cell);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least zero, at most the diagonal"
        )]
        let ring = libm::hypot(x - middle[0], y - middle[1]) as usize;
        if let Some([sum, number]) = sums.get_mut(ring) {
            *sum += value;
            *number += 1.0;
        }
    }
    let rings = (0_u32..).zip(sums).filter(|(_, [_, number])| *number > 0.0);
    rings
        .map(|(ring, [sum, number])| {
            [
                f64::from(ring) * edge,
                f64::from(ring + 1) * edge,
                sum / number,
            ]
        })
        .collect()
}

/// Volume (m³) that is uncertain: half a voxel over the area of the crater's bowl, that of a half
/// ellipsoid.
fn uncertain_volume(crater: &Crater, edge: f64) -> f64 {
    let radius = 0.5 * crater.diameter;
    let bowl = PI * radius * (radius + crater.depth);
    0.5 * edge * bowl
}

/// The measures of a target. Collective.
pub fn target(slab: &Slab, remains: &Remains, matter: &Matter, comm: &Comm) -> Findings {
    let (crater, edge) = match remains.attached() {
        Some(attached) => {
            let footprint = remains.footprint(slab, matter);
            (Crater::of(attached, &footprint), attached.window.edge)
        }
        None => (Crater::NONE, slab.spacing),
    };
    let [loose, doubtful] = matter.sums::<2>(comm, |i, sums| {
        if matter.body_of(i) == slab.body {
            match remains.holds(i) {
                Belongs::Yes => {}
                Belongs::Nearly => sums.add(&[0.0, matter.mass[i]]),
                Belongs::No => sums.add(&[matter.mass[i], 0.0]),
            }
        }
    });
    let whole = super::Whole::new(&matter.mirrors);
    let length = |name, value: f64| Figure::number(name, value, "m");
    Findings {
        figures: vec![
            length("crater_depth", crater.depth).within(0.5 * edge),
            length("crater_diameter", crater.diameter).within(edge),
            Figure::number("crater_volume", crater.volume, "m^3")
                .within(uncertain_volume(&crater, edge)),
            length("rim_height", crater.rim).within(0.5 * edge),
            Figure::number("removed_mass", whole.sum(loose), "kg").within(whole.sum(doubtful)),
        ],
        distributions: vec![Distribution {
            name: "crater_profile",
            along: "m",
            unit: "m",
            bins: crater.profile,
        }],
    }
}
