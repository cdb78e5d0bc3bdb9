//! Glass fitted to the surface of its solid: the sites of the outermost layer stand half a spacing
//! below the faces, and those beneath make room. Where the spacing is graded, all that is thinned
//! out comes to rest, too.

use super::laid::Cells;
use super::relax::{REACH, Sites, Wall, step};
use crate::model::Vec3;
use crate::populate::Site;
use crate::populate::row::Cut;

/// Sites that begin no deeper than this move (spacings).
const MOVING: f64 = 3.0;
/// Those that begin no deeper are felt by what moves (spacings).
const DEEPEST: f64 = MOVING + REACH + 1.0;
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
        let coarsest = cells.lattice.coarsest();
        let wide: Vec<Cut> = cuts
            .iter()
            .map(|cut| cut.widened(MARGIN * coarsest))
            .collect();
        let (mut sites, mut moving) = (Vec::new(), Vec::new());
        for block in cells.all_blocks(&wide) {
            let (middle, half) = cells.middle(block.level, block.at, block.at.map(|n| n + 1));
            let around = half.norm() + DEEPEST * cells.coarsest(block.level);
            if !is_near(cells, &middle, around) {
                continue;
            }
            for site in cells.sites_of(block, &wide) {
                let place = site.position.into();
                let spacing = cells.lattice.spacing_at(&place);
                if is_near(cells, &place, DEEPEST * spacing) {
                    if is_near(cells, &place, MOVING * spacing) {
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

/// Whether a place (m) is nearer than `reach` (m) to the surface, or to where sites are thinned.
fn is_near(cells: &Cells, place: &Vec3, reach: f64) -> bool {
    let lattice = &cells.lattice;
    let is_thinned = lattice.grading.is_some_and(|grading| {
        let distance = grading.from.distance(place) + reach;
        grading.spacing(lattice.spacing, distance) > lattice.spacing
    });
    is_thinned || cells.distance(place) > -reach
}

fn relax(cells: &Cells, sites: &mut [Site], moving: &[u32]) {
    let scale = Scale::of(cells);
    let spacing = |s: &Site| cells.lattice.spacing_at(&s.position.into()) / scale.spacing;
    let largest = (0..cells.levels.len()).map(|level| cells.coarsest(level) / scale.spacing);
    let mut of = Sites {
        places: sites.iter().map(|s| scale.down(&s.position)).collect(),
        sizes: sites.iter().map(spacing).collect(),
        largest: largest.collect(),
    };
    let mut velocity = vec![[0.0; 3]; moving.len()];
    let wall = Wall::new(cells.dimension);
    let outside = |place: &[f64; 3], size: f64| {
        let mut force = [0.0; 3];
        scale.faces(cells, place, REACH * size, |depth, normal| {
            let push = wall.force(depth / size);
            for a in 0..3 {
                force[a] -= push * normal[a];
            }
        });
        force
    };
    let hold = |place: &mut [f64; 3], v: &mut [f64; 3], size: f64| {
        let here = *place;
        scale.faces(cells, &here, OF_LAYER * size, |depth, normal| {
            let way = depth - LAYER * size;
            let way = if way < 0.0 { way } else { DRAWN * way };
            let across = v[0] * normal.x + v[1] * normal.y + v[2] * normal.z;
            for a in 0..3 {
                place[a] += way * normal[a];
                v[a] -= across * normal[a];
            }
        });
    };
    for _ in 0..STEPS {
        step(&mut of, &mut velocity, moving, outside, hold);
    }
    for &i in moving {
        let i = i as usize;
        sites[i].position = scale.up(&of.places[i]);
    }
}

/// Where a site (m) ends, nearly: on the layer, if it begins in it.
pub(super) fn settled(cells: &Cells, x: &[f64; 3]) -> [f64; 3] {
    let scale = Scale::of(cells);
    let size = cells.lattice.spacing_at(&(*x).into()) / scale.spacing;
    let mut place = scale.down(x);
    for _ in 0..2 {
        let here = place;
        scale.faces(cells, &here, OF_LAYER * size, |depth, normal| {
            for a in 0..3 {
                place[a] += (depth - LAYER * size) * normal[a];
            }
        });
    }
    scale.up(&place)
}

/// Lengths in finest spacings from the middle of the solid on.
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
            spacing: cells.lattice.spacing,
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
