//! Targets: the crater.

use std::f64::consts::PI;

use super::attached::Attached;
use super::figure::{Distribution, Figure, Findings};
use super::mask::{Mask, diameter};
use super::matter::Matter;
use super::remains::{Belongs, Remains};
use comm::Comm;
use model::Slab;

/// Rings of a profile reach this many radii of the crater.
const PROFILE: f64 = 3.0;

/// The crater of what remains of a target.
struct Crater {
    /// Greatest depth (m) below the face.
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

    fn of(slab: &Slab, attached: &Attached) -> Self {
        let edge = attached.window.edge;
        // A column of the target without matter is as deep as it.
        let depth = |(column, ends): (usize, Option<[f64; 2]>)| match ends {
            _ if !attached.is_of_body(column) => 0.0,
            Some([_, top]) => slab.front - top,
            None => slab.thickness(),
        };
        let depths: Vec<f64> = attached.ends().enumerate().map(depth).collect();
        let deepest = depths
            .iter()
            .enumerate()
            .fold(None, |best, (cell, &depth)| match best {
                Some((_, most)) if depth <= most => best,
                _ => Some((cell, depth)),
            });
        let rim = depths.iter().fold(0.0, |most: f64, depth| most.max(-depth));
        let Some((cell, depth)) = deepest.filter(|(_, depth)| *depth > 0.5 * edge) else {
            return Self { rim, ..Self::NONE };
        };
        let counts = [attached.window.counts[0], attached.window.counts[1]];
        let below = Mask::new(counts, depths.iter().map(|&d| d > 0.5 * edge).collect());
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
        Some(attached) => (Crater::of(slab, attached), attached.window.edge),
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
