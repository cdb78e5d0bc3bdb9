//! Glass fitted to the surface of its solid: the sites of the outermost layer are half a spacing
//! below the faces, and those beneath make room. Sites of a graded spacing come to rest, too.

use super::forces::{REACH, Sites};
use super::laid::Cells;
use super::relax::{Wall, step};
use crate::Site;
use crate::row::Cut;
use model::Vec3;

/// Sites that begin no deeper than this move (spacings).
const MOVING: f64 = 3.0;
/// Those that begin no deeper are felt by what moves (spacings).
const DEEPEST: f64 = MOVING + REACH + 1.0;
/// Steps of the relaxation.
const STEPS: usize = 12;
/// Bound of the motion of sites in all steps, for the choice of neighbours (spacings).
const SLACK: f64 = 3.6;
/// Depth of the outermost layer (spacings), and which sites belong to it.
pub(super) const LAYER: f64 = 0.5;
const OF_LAYER: f64 = 1.0;
/// Motion towards the layer, in a step, of its sites that are too deep.
const DRAWN: f64 = 0.3;

/// The sites that have moved, by index.
#[derive(Debug, Default)]
pub(crate) struct Fitted {
    sites: Vec<Site>,
    /// The first of them that no site before has passed.
    next: usize,
}

impl Fitted {
    /// Those that the cuts leave, by their positions before. Their motion depends on others one
    /// reach away for each step: sites outside the cuts move as long as that may matter.
    pub fn new(cells: &Cells, cuts: &[Cut]) -> Self {
        if !cells.is_fitted() {
            return Self::default();
        }
        let coarsest = cells.lattice.coarsest();
        let wide = widened(cuts, STEPS, coarsest);
        let after: Vec<Vec<Cut>> = (0..STEPS).map(|n| widened(cuts, n, coarsest)).collect();
        let (mut sites, mut moving) = (Vec::new(), Vec::new());
        for block in cells.all_blocks(&wide) {
            let (middle, half) = cells.middle(block.level, block.at, block.at.map(|n| n + 1));
            let around = half.norm() + DEEPEST * cells.coarsest(block.level);
            if !is_near(cells, &middle, around) {
                continue;
            }
            for site in cells.sites_of(block, &wide) {
                let position = site.position.into();
                let spacing = cells.lattice.spacing_at(&position);
                if is_near(cells, &position, DEEPEST * spacing) {
                    let is_left =
                        |cuts: &Vec<Cut>| cuts.iter().all(|cut| cut.keeps(&site.position));
                    let spared = after.iter().position(is_left);
                    if let Some(spared) = spared
                        && is_near(cells, &position, MOVING * spacing)
                    {
                        moving.push(Moving {
                            site: u32::try_from(sites.len()).unwrap_or(u32::MAX),
                            spared,
                        });
                    }
                    sites.push(site);
                }
            }
        }
        moving.sort_by_key(|one| one.spared);
        relax(cells, &mut sites, &moving);
        let kept = moving.iter().take_while(|one| one.spared == 0);
        Self {
            sites: kept.map(|one| sites[one.site as usize]).collect(),
            next: 0,
        }
    }

    /// Moves a site to where it ends; sites come in the order of their index.
    pub fn fit_site(&mut self, site: &mut Site) {
        let rest = &self.sites[self.next..];
        self.next += rest.iter().take_while(|s| s.index < site.index).count();
        if let Some(moved) = self.sites.get(self.next)
            && moved.index == site.index
        {
            site.position = moved.position;
        }
    }
}

/// A moving site: its number, and the number of the last steps that it is spared.
struct Moving {
    site: u32,
    spared: usize,
}

/// Cuts with all that may change what they leave in so many steps.
fn widened(cuts: &[Cut], steps: usize, spacing: f64) -> Vec<Cut> {
    #[allow(clippy::cast_precision_loss)] // a few
    let far = match steps {
        0 => 0.0,
        _ => (REACH * steps as f64 + SLACK) * spacing,
    };
    cuts.iter().map(|cut| cut.widened(far)).collect()
}

/// `true` if a position (m) is nearer than `reach` (m) to the surface, or to thinned sites.
fn is_near(cells: &Cells, position: &Vec3, reach: f64) -> bool {
    let lattice = &cells.lattice;
    let is_thinned = lattice.grading.is_some_and(|grading| {
        let distance = grading.from.distance(position) + reach;
        grading.spacing(lattice.spacing, distance) > lattice.spacing
    });
    is_thinned || cells.distance(position) > -reach
}

/// Moves sites, of which those that are spared least come first.
fn relax(cells: &Cells, sites: &mut [Site], moving: &[Moving]) {
    let scale = Scale::of(cells);
    let spacing = |s: &Site| cells.lattice.spacing_at(&s.position.into()) / scale.spacing;
    let largest = (0..cells.levels.len()).map(|level| cells.coarsest(level) / scale.spacing);
    let mut of = Sites {
        positions: sites.iter().map(|s| scale.down(&s.position)).collect(),
        sizes: sites.iter().map(spacing).collect(),
        largest: largest.collect(),
    };
    let numbers: Vec<u32> = moving.iter().map(|one| one.site).collect();
    let mut velocity = vec![[0.0; 3]; moving.len()];
    let wall = Wall::of(cells.dimension);
    let outside = |position: &[f64; 3], size: f64| {
        let mut force = [0.0; 3];
        scale.faces(cells, position, REACH * size, |depth, normal| {
            let push = wall.force(depth / size);
            for a in 0..3 {
                force[a] -= push * normal[a];
            }
        });
        force
    };
    let hold = |position: &mut [f64; 3], v: &mut [f64; 3], size: f64| {
        scale.take_in(cells, position, LAYER * size);
        let here = *position;
        scale.faces(cells, &here, OF_LAYER * size, |depth, normal| {
            let way = depth - LAYER * size;
            let way = if way < 0.0 { way } else { DRAWN * way };
            let across = v[0] * normal.x + v[1] * normal.y + v[2] * normal.z;
            for a in 0..3 {
                position[a] += way * normal[a];
                v[a] -= across * normal[a];
            }
        });
    };
    for left in (0..STEPS).rev() {
        let end = moving.partition_point(|one| one.spared <= left);
        crate::visits::add(end as u64);
        step(
            &mut of,
            &mut velocity[..end],
            &numbers[..end],
            outside,
            hold,
        );
    }
    for i in numbers {
        let i = i as usize;
        sites[i].position = scale.up(&of.positions[i]);
    }
}

/// The approximate end of a site (m): on the layer, if it begins in it.
pub(super) fn on_layer(cells: &Cells, x: &[f64; 3]) -> [f64; 3] {
    let scale = Scale::of(cells);
    let size = cells.lattice.spacing_at(&(*x).into()) / scale.spacing;
    let mut position = scale.down(x);
    for _ in 0..2 {
        let here = position;
        scale.faces(cells, &here, OF_LAYER * size, |depth, normal| {
            for a in 0..3 {
                position[a] += (depth - LAYER * size) * normal[a];
            }
        });
    }
    scale.up(&position)
}

/// Lengths in finest spacings from the middle of the solid on.
struct Scale {
    origin: Vec3,
    spacing: f64,
}

impl Scale {
    fn of(cells: &Cells) -> Self {
        let (lower, upper) = cells.ends;
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

    /// Takes a place outside the solid to a depth below its surface: faces are those of places inside.
    fn take_in(&self, cells: &Cells, position: &mut [f64; 3], depth: f64) {
        let x = self.up(position).into();
        let beyond = cells.solid.distance(&x) / self.spacing;
        if beyond > 0.0 {
            let normal = cells.solid.outward(&x);
            for a in 0..3 {
                position[a] -= (beyond + depth) * normal[a];
            }
        }
    }

    /// Tells the faces less than `reach` above a place, symmetry planes among them: depth, and the
    /// normal out of the solid.
    fn faces(&self, cells: &Cells, x: &[f64; 3], reach: f64, mut emit: impl FnMut(f64, Vec3)) {
        let x = self.up(x);
        for &(a, at) in &cells.planes {
            let depth = (x[a] - at) / self.spacing;
            if depth < reach {
                let mut normal = Vec3::zeros();
                normal[a] = -1.0;
                emit(depth, normal);
            }
        }
        let mut scaled = |depth: f64, normal: Vec3| emit(depth / self.spacing, normal);
        cells
            .solid
            .faces(&x.into(), reach * self.spacing, &mut scaled);
    }
}
