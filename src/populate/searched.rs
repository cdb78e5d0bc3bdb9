//! Bodies of which sites are searched again and again.

use std::sync::OnceLock;

use super::cells::Seen;
use super::filling::Filling;
use super::parts::Nearest;
use super::row::{Cut, cuts};
use super::{Wanted, visits};
use model::{Body, Case, SymmetryPlane};

/// Sites that a body may have for a search to pass over boxes of them alone.
const FEW: u64 = 1024;

/// Sites in such a box.
const IN_A_BOX: usize = 32;

/// A body of which sites are searched, and those that have been looked at.
pub struct Searched {
    filling: Filling,
    cuts: Vec<Cut>,
    /// All sites of a small body.
    few: Option<Vec<Clump>>,
    /// What has been seen of a large one.
    seen: Vec<Seen>,
}

/// Smallest and largest coordinates (m).
pub(super) type Ends = ([f64; 3], [f64; 3]);

/// Some sites with a box about them (m).
struct Clump {
    lower: [f64; 3],
    upper: [f64; 3],
    sites: Vec<[f64; 3]>,
}

impl Searched {
    /// The sites of a body above all symmetry planes.
    #[must_use]
    pub fn new(body: &Body, dimension: usize, symmetry: &[SymmetryPlane]) -> Self {
        let filling = Filling::of(body, dimension, symmetry);
        let cuts = cuts(symmetry, None);
        let few = few(&filling, &cuts).map(|sites| {
            let clumps = sites.chunks(IN_A_BOX).filter_map(|sites| {
                let (lower, upper) = ends(sites)?;
                let sites = sites.to_vec();
                Some(Clump {
                    lower,
                    upper,
                    sites,
                })
            });
            clumps.collect()
        });
        Self {
            seen: filling.unseen(),
            few,
            cuts,
            filling,
        }
    }

    /// The sites where `value` is smallest, as [`super::search`] finds them.
    pub fn smallest(
        &self,
        wanted: Wanted,
        bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
        value: impl Fn(&[f64; 3]) -> f64,
    ) -> Vec<(f64, [f64; 3])> {
        let Self {
            cuts, seen, few, ..
        } = self;
        match few {
            Some(clumps) => among(clumps, wanted, bound, value),
            None => self.filling.smallest(cuts, seen, wanted, bound, value),
        }
    }
}

/// All sites of a small body, those that are fitted where they end nearly; `None` of a large one, and of one that its
/// filling searches as fast.
pub(super) fn few(filling: &Filling, cuts: &[Cut]) -> Option<Vec<[f64; 3]>> {
    let few = filling.most_sites() <= FEW;
    few.then(|| filling.near_sites(cuts)).flatten()
}

/// Smallest and largest coordinates (m) of some sites, if there are any.
pub(super) fn ends(sites: &[[f64; 3]]) -> Option<Ends> {
    let start = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let wider = |(lower, upper): Ends, x: &[f64; 3]| {
        (
            std::array::from_fn(|a| f64::min(lower[a], x[a])),
            std::array::from_fn(|a| f64::max(upper[a], x[a])),
        )
    };
    (!sites.is_empty()).then(|| sites.iter().fold(start, wider))
}

fn among(
    clumps: &[Clump],
    wanted: Wanted,
    bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
    value: impl Fn(&[f64; 3]) -> f64,
) -> Vec<(f64, [f64; 3])> {
    let mut nearest = Nearest::new(wanted);
    let mut look = |clump: &Clump| {
        visits::add(1);
        for site in &clump.sites {
            nearest.offer(value(site), *site);
        }
        nearest.worst()
    };
    let bounds = clumps.iter().map(|clump| bound(&clump.lower, &clump.upper));
    let first = bounds.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((first, least)) = first else {
        return Vec::new();
    };
    let mut worst = wanted.limit;
    if least < worst {
        worst = look(&clumps[first]);
        for (place, clump) in clumps.iter().enumerate() {
            if place != first && bound(&clump.lower, &clump.upper) < worst {
                worst = look(clump);
            }
        }
    }
    nearest.found()
}

/// The bodies of a case, of which those that are searched are looked at once.
pub struct Searches<'a> {
    /// The case.
    pub case: &'a Case,
    of_bodies: Vec<OnceLock<Searched>>,
}

impl<'a> Searches<'a> {
    /// Nothing looked at.
    #[must_use]
    pub fn new(case: &'a Case) -> Self {
        let of_bodies = case.bodies.iter().map(|_| OnceLock::new()).collect();
        Self { case, of_bodies }
    }

    /// Those of a body, above all symmetry planes.
    #[must_use]
    pub fn of(&self, body: usize) -> &Searched {
        let Case {
            bodies,
            dimension,
            symmetry,
            ..
        } = self.case;
        self.of_bodies[body].get_or_init(|| Searched::new(&bodies[body], *dimension, symmetry))
    }
}
