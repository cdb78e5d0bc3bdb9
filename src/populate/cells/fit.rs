//! Glass fitted to the surface of its solid: the sites of the outermost layer stand half a spacing
//! below the faces, and those beneath make room.

use super::laid::Cells;
use super::relax::{REACH, Wall, step};
use crate::model::Vec3;
use crate::populate::Site;
use crate::populate::row::Cut;

/// Sites that begin no deeper than this move (spacings).
const MOVING: f64 = 3.0;
/// Steps of the relaxation.
const STEPS: usize = 12;
/// How far from a site others may change where it ends (spacings): by one reach in each step.
const MARGIN: f64 = 30.0;
/// Depth of the outermost layer (spacings), and which sites belong to it.
const LAYER: f64 = 0.5;
const OF_LAYER: f64 = 1.0;
/// How far sites of the layer that stand too deep are drawn to it in a step.
const DRAWN: f64 = 0.3;

/// The sites that have moved, by index.
#[derive(Debug, Default)]
pub(in crate::populate) struct Fitted {
    sites: Vec<Site>,
}

impl Fitted {
    /// Those that the cuts leave, by where they stood before.
    pub fn new(cells: &Cells, cuts: &[Cut]) -> Self {
        if !cells.is_fitted() {
            return Self::default();
        }
        let spacing = cells.spacing;
        let wide: Vec<Cut> = cuts
            .iter()
            .map(|cut| cut.widened(MARGIN * spacing))
            .collect();
        let deepest = (MOVING + REACH + 1.0) * spacing;
        let (mut sites, mut moving) = (Vec::new(), Vec::new());
        for block in cells.all_blocks() {
            let (middle, half) = cells.middle(block.at, block.at.map(|n| n + 1));
            if cells.distance(&middle) < -deepest - half.norm() {
                continue;
            }
            for site in cells.sites_of(block, &wide) {
                let depth = -cells.distance(&site.position.into());
                if depth < deepest {
                    if depth < MOVING * spacing {
                        moving.push(u32::try_from(sites.len()).unwrap_or(u32::MAX));
                    }
                    sites.push(site);
                }
            }
        }
        relax(cells, &mut sites, &moving);
        let kept = moving.into_iter().map(|i| sites[i as usize]);
        Self {
            sites: kept.collect(),
        }
    }

    /// Moves a site to where it ends.
    pub fn place(&self, site: &mut Site) {
        if let Ok(at) = self.sites.binary_search_by_key(&site.index, |s| s.index) {
            site.position = self.sites[at].position;
        }
    }
}

fn relax(cells: &Cells, sites: &mut [Site], moving: &[u32]) {
    let scale = Scale::of(cells);
    let mut x: Vec<[f64; 3]> = sites.iter().map(|s| scale.down(&s.position)).collect();
    let mut velocity = vec![[0.0; 3]; moving.len()];
    let wall = Wall::new(cells.dimension);
    let outside = |place: &[f64; 3]| {
        let mut force = [0.0; 3];
        scale.faces(cells, place, REACH, |depth, normal| {
            let push = wall.force(depth);
            for a in 0..3 {
                force[a] -= push * normal[a];
            }
        });
        force
    };
    let hold = |place: &mut [f64; 3], v: &mut [f64; 3]| {
        let here = *place;
        scale.faces(cells, &here, OF_LAYER, |depth, normal| {
            let way = depth - LAYER;
            let way = if way < 0.0 { way } else { DRAWN * way };
            let across = v[0] * normal.x + v[1] * normal.y + v[2] * normal.z;
            for a in 0..3 {
                place[a] += way * normal[a];
                v[a] -= across * normal[a];
            }
        });
    };
    for _ in 0..STEPS {
        step(&mut x, &mut velocity, moving, outside, hold);
    }
    for &i in moving {
        let i = i as usize;
        sites[i].position = scale.up(&x[i]);
    }
}

/// Where a site (m) ends, nearly: on the layer, if it begins in it.
pub(super) fn settled(cells: &Cells, x: &[f64; 3]) -> [f64; 3] {
    let scale = Scale::of(cells);
    let mut place = scale.down(x);
    for _ in 0..2 {
        let here = place;
        scale.faces(cells, &here, OF_LAYER, |depth, normal| {
            for a in 0..3 {
                place[a] += (depth - LAYER) * normal[a];
            }
        });
    }
    scale.up(&place)
}

/// Lengths in spacings from the middle of the solid on.
struct Scale {
    origin: Vec3,
    spacing: f64,
}

impl Scale {
    fn of(cells: &Cells) -> Self {
        let (lower, upper) = cells.solid.bounds();
        let mut origin = (lower + upper) * 0.5;
        for a in cells.dimension..3 {
            origin[a] = 0.0;
        }
        Self {
            origin,
            spacing: cells.spacing,
        }
    }

    fn down(&self, x: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| (x[a] - self.origin[a]) / self.spacing)
    }

    fn up(&self, x: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| self.origin[a] + x[a] * self.spacing)
    }

    /// Tells the faces less than `reach` above a place, symmetry planes among them: depth, and the
    /// normal out of the solid.
    fn faces(&self, cells: &Cells, x: &[f64; 3], reach: f64, mut tell: impl FnMut(f64, Vec3)) {
        let x = self.up(x);
        for &(a, at) in &cells.planes {
            let depth = (x[a] - at) / self.spacing;
            if depth < reach {
                let mut normal = Vec3::zeros();
                normal[a] = -1.0;
                tell(depth, normal);
            }
        }
        let mut scaled = |depth: f64, normal: Vec3| tell(depth / self.spacing, normal);
        cells
            .solid
            .faces(&x.into(), reach * self.spacing, &mut scaled);
    }
}
