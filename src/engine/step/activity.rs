//! Particles that rest far from all that move are inactive: steps leave them out until moving ones come near (theory
//! page "Smoothed particle hydrodynamics").
//!
//! In a step motion spreads from moving particles to those whose sums see it, two supports far, and those sums need
//! particles two supports around. Clusters that do not rest reach two supports from moving particles. So nothing is
//! inactive within two supports, and the range of contact, of such clusters.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use rayon::prelude::*;

use super::candidate::{Candidate, Criteria, NO_CANDIDATE};
use super::kept_links::{Keeping, KeptLinks};
use super::moving_cells::MovingCells;
use crate::contact::EVERY;
use crate::diagnose::Moved;
use crate::domain::Span;
use crate::fragments::{Labels, Sets};
use crate::sph::SignalSpeed;
use model::Case;
use particles::Mirrors;
use particles::neighbours::Lists;
use particles::{GRAIN, Inactive, PART, ParticleStore};
use populate::Brick;

/// The choice of particles that steps leave out, kept from one step to the next.
#[allow(clippy::struct_excessive_bools, reason = "independent of each other")]
#[derive(Debug)]
pub(super) struct Activity {
    /// The inactive particles.
    pub inactive: Inactive,
    /// Those of them that the last search left out.
    unlisted: Inactive,
    /// First candidate and extent of the inactive particles.
    pub kept_candidate: KeptCandidate,
    /// True if particles may be deactivated after this step.
    may_deactivate: bool,
    /// True if they could be after an earlier step of this process.
    was_tried: bool,
    /// True if the search of this step lists the neighbours of all active particles.
    lists_all: bool,
    /// True if a case allows inactive particles.
    is_enabled: bool,
    /// Places of fixed gauges, which read the particles around them (m).
    gauges: Vec<[f64; 3]>,
    parts: Vec<Part>,
    links: KeptLinks,
    /// By part: particles of clusters that rest.
    resting: Vec<AtomicU32>,
    moving_cells: MovingCells,
    /// Least distance of inactive particles from the faces between ranks (m).
    from_faces: f64,
    /// Least distance of inactive particles from gauges (m).
    from_gauges: f64,
    /// True if pieces of a body may touch that are out of each other's support: contact of unequal particles reaches
    /// farther.
    labels_change: bool,
}

/// First candidate of inactive particles for the next step, and their extent.
#[derive(Debug, Clone, Copy)]
pub(super) struct KeptCandidate {
    pub candidate: Candidate,
    pub span: Span,
}

/// Properties of a part of the store that are kept as long as it is inactive.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// True if it is inactive and has kept links. In a step whose lists name it as a neighbour it keeps them.
    keeping: Keeping,
    kept: KeptCandidate,
    /// Sum of the labels of its particles.
    label: u64,
}

/// Results of a search, by which particles rest far from moving ones.
pub(super) struct Surroundings<'a> {
    pub lists: &'a Lists,
    /// Longest range of contact (m).
    pub contact_range: f64,
    /// This rank's part of space.
    pub region: &'a Brick,
    /// Memory to find links in, if links of inactive particles are kept.
    pub labels: Option<&'a mut Labels>,
}

/// Factor of ranges, with room for rounding.
const ROOM: f64 = 1.0 + 1e-6;

/// Work counted for an inactive particle, in neighbours of the pair sums.
const WORK: u32 = 2;

/// Distances from moving particles at which a part is deactivated, and at which it stays inactive, in widths of cells.
const APART: [f64; 2] = [2.25, 1.5];

impl KeptCandidate {
    const NONE: Self = Self {
        candidate: NO_CANDIDATE,
        span: Span::NONE,
    };

    fn join(mut self, other: Self) -> Self {
        self.span.join(&other.span);
        self.candidate = self.candidate.min(other.candidate);
        self
    }
}

impl Activity {
    /// Of a case. Surfaces and loads move resting particles, gravity moves all, and gauges read the particles around
    /// them.
    pub fn new(case: &Case) -> Self {
        let loads = &case.loads;
        let mirrors = Mirrors::of(case);
        let fixed = case.measure.gauges.iter().filter(|gauge| !gauge.moves);
        let gauges = fixed.flat_map(|gauge| {
            mirrors
                .masks()
                .map(|mirror_mask| mirrors.reflect_position(&gauge.at, mirror_mask))
        });
        Self {
            gauges: gauges.collect(),
            inactive: Inactive::default(),
            unlisted: Inactive::default(),
            kept_candidate: KeptCandidate::NONE,
            may_deactivate: false,
            was_tried: false,
            lists_all: false,
            is_enabled: loads.surfaces.is_empty()
                && loads.velocities.is_empty()
                && loads.pressures.is_empty()
                && !loads.moves_all(),
            parts: Vec::new(),
            links: KeptLinks::default(),
            resting: Vec::new(),
            moving_cells: MovingCells::default(),
            from_faces: 0.0,
            from_gauges: 0.0,
            labels_change: case.self_contact.is_some()
                && case.bodies.iter().any(|body| body.lattice.sizes.is_some()),
        }
    }

    /// Bytes allocated.
    pub fn memory(&self) -> usize {
        self.inactive.memory()
            + self.unlisted.memory()
            + size_of::<Part>() * self.parts.capacity()
            + size_of::<[f64; 3]>() * self.gauges.capacity()
            + self.links.memory()
            + size_of::<AtomicU32>() * self.resting.capacity()
            + self.moving_cells.memory()
    }

    /// Reactivates parts whose particles may stand elsewhere in the store than when they were deactivated.
    pub fn reactivate_moved(&mut self, particles: &mut ParticleStore) {
        let unmoved = particles.take_unmoved();
        if unmoved < self.inactive.end() {
            self.keep_only(particles.owned(), |p, _| (p + 1) * PART <= unmoved);
        }
    }

    /// Reactivates parts near the faces of this rank's region, after these have moved.
    pub fn reactivate_near(&mut self, region: &Brick, owned: usize) {
        let far = self.from_faces;
        self.keep_only(owned, |_, part| is_inside(&part.kept.span, region, far));
    }

    /// Reactivates the parts for which `stays` does not hold.
    fn keep_only(&mut self, owned: usize, stays: impl Fn(usize, &Part) -> bool + Sync) {
        if self.inactive.is_empty() {
            return;
        }
        self.parts.resize(owned / PART, Part::ACTIVE);
        let parts = self.parts.par_iter_mut().enumerate();
        parts.for_each(|(p, part)| {
            if !stays(p, part) {
                part.keeping = Keeping::No;
            }
        });
        self.deactivate(owned);
    }

    /// Leaves the inactive parts out of steps, and joins their candidates and extents.
    fn deactivate(&mut self, owned: usize) {
        let parts = &self.parts;
        self.inactive.set(owned, |p, _| parts[p].is_inactive());
        let inactive = &self.inactive;
        let parts = parts.par_iter().enumerate().with_min_len(GRAIN);
        let all = parts.filter(|(p, _)| inactive.has(*p));
        // same bits in any order: smallest and largest numbers
        self.kept_candidate = all
            .map(|(_, part)| part.kept)
            .reduce(|| KeptCandidate::NONE, KeptCandidate::join);
    }

    /// Before the search of a step: chooses the particles that it leaves out ([`Self::unlisted`]). Where particles may be
    /// deactivated after the step and their `links` are kept, the search lists the neighbours of all others, also of
    /// inactive particles beside them.
    pub fn begin_search(&mut self, step: u64, owned: usize, links: bool) {
        self.may_deactivate =
            self.is_enabled && step > 0 && (step.is_multiple_of(EVERY) || !self.was_tried);
        self.was_tried |= self.may_deactivate;
        self.lists_all = self.may_deactivate && links;
        let (inactive, lists_all) = (&self.inactive, self.lists_all);
        if lists_all {
            self.links.forget(|p| inactive.has(p));
        }
        let links = &self.links;
        if inactive.is_empty() {
            self.unlisted.clear();
        } else {
            self.unlisted.set(owned, |p, _| {
                inactive.has(p) && !(lists_all && links.is_border(p))
            });
        }
    }

    /// Particles that the search of this step leaves out.
    pub fn unlisted(&self) -> &Inactive {
        &self.unlisted
    }

    /// True if the search of this step lists the neighbours of all active particles.
    pub fn lists_all(&self) -> bool {
        self.lists_all
    }

    /// Particles that stand in the store where they did in the last search, as they were inactive then or are now.
    pub fn fixed(&mut self, owned: usize) -> &Inactive {
        let inactive = &self.inactive;
        self.unlisted
            .set(owned, |p, was_unlisted| was_unlisted || inactive.has(p));
        &self.unlisted
    }

    /// Joins inactive particles that hang together.
    pub fn join_links(&self, sets: &Sets) {
        if !self.inactive.is_empty() {
            self.links.join(|p| self.inactive.has(p), sets);
        }
    }

    /// After a step: reactivates parts that moving particles come near to. Every few steps deactivates parts that rest
    /// far from those and from the faces of this rank's region, and keeps their links.
    pub fn update<F: SignalSpeed>(
        &mut self,
        particles: &ParticleStore,
        surroundings: Surroundings,
        criteria: &Criteria<F>,
    ) {
        let Surroundings {
            lists,
            contact_range,
            region,
            labels,
        } = surroundings;
        let owned = particles.owned();
        if !lists.spare_quiescent {
            return self.keep_only(owned, |_, _| false);
        }
        let may_deactivate = self.may_deactivate;
        let any_rest = may_deactivate && self.count_resting(lists, owned / PART);
        if !any_rest && self.inactive.is_empty() {
            return;
        }
        self.parts.resize(owned / PART, Part::ACTIVE);
        let apart = ROOM * (2.0 * lists.farthest() + contact_range);
        self.from_faces = 2.0 * apart;
        let is_farther = apart > self.from_gauges;
        self.from_gauges = apart;
        self.moving_cells.find(lists, apart / APART[1]);
        let (moving, resting, from_faces) = (&self.moving_cells, &self.resting, self.from_faces);
        let labels_change = self.labels_change;
        let is_read = |span: &Span| self.gauges.iter().any(|at| is_around(span, at, apart));
        let parts = self.parts.par_iter_mut().enumerate();
        parts.for_each(|(p, part)| {
            part.keeping = if part.is_inactive() {
                let span = &part.kept.span;
                let is_read = is_farther && is_read(span);
                let is_renamed =
                    may_deactivate && labels_change && part.has_new_label(particles, p);
                let is_near = is_read || is_renamed || moving.is_near(span, APART[1]);
                Keeping::Old.only_if(!is_near)
            } else {
                let rests = any_rest && resting[p].load(Relaxed) as usize == PART;
                Keeping::New.only_if(
                    rests
                        && part.is_still(particles, p, criteria)
                        && is_inside(&part.kept.span, region, from_faces)
                        && !is_read(&part.kept.span)
                        && !moving.is_near(&part.kept.span, APART[0]),
                )
            };
        });
        self.deactivate(owned);
        if let Some(labels) = labels.filter(|_| may_deactivate) {
            labels.begin(owned);
            let parts = &self.parts;
            self.links.note(lists, |p| parts[p].keeping, labels.sets());
        }
    }

    /// Counts next to no work for inactive particles, after steps that may have counted some.
    pub fn count_work(&self, work: &mut [u32]) {
        if self.may_deactivate {
            let parts = self.parts.par_iter().zip(work.par_chunks_exact_mut(PART));
            let inactive = parts.filter(|(part, _)| part.is_inactive());
            inactive.for_each(|(_, work)| work.fill(WORK));
        }
    }

    /// Counts by part the particles that rest without motion. Returns whether all particles of any of the first `whole`
    /// parts do.
    fn count_resting(&mut self, lists: &Lists, whole: usize) -> bool {
        self.resting.resize_with(whole + 1, AtomicU32::default);
        self.resting
            .iter_mut()
            .for_each(|count| *count.get_mut() = 0);
        let (images, resting) = (lists.images(), &self.resting);
        lists.chunks().par_iter().for_each(|chunk| {
            for (cluster, _, among) in chunk.iter() {
                if among.resting && lists.is_still(cluster.group) {
                    for &place in cluster.valid() {
                        let part = images[place as usize].slot() / PART;
                        resting[part].fetch_add(1, Relaxed);
                    }
                }
            }
        });
        let counts = self.resting[..whole].iter_mut();
        counts
            .map(AtomicU32::get_mut)
            .any(|count| *count as usize == PART)
    }
}

impl Part {
    const ACTIVE: Self = Self {
        keeping: Keeping::No,
        kept: KeptCandidate::NONE,
        label: 0,
    };

    fn is_inactive(&self) -> bool {
        self.keeping != Keeping::No
    }

    /// True if all particles of a part stand still; if so, keeps their first candidate, extent and labels.
    fn is_still<F: SignalSpeed>(
        &mut self,
        particles: &ParticleStore,
        part: usize,
        criteria: &Criteria<F>,
    ) -> bool {
        let (mut best, mut span) = (criteria.best(), Span::NONE);
        for i in part * PART..(part + 1) * PART {
            let velocity = particles.velocity[i];
            let contact = particles.contact_acceleration.get(i);
            let contact = contact.copied().unwrap_or_default();
            let is_free = particles.load.get(i).is_none_or(|&load| load == 0);
            let still = [velocity, particles.acceleration[i], contact] == [[0.0; 3]; 3];
            if !(still && is_free) {
                return false;
            }
            let energy = particles.specific_energy[i];
            let moved = Moved {
                velocity,
                energy,
                contact,
            };
            criteria.ask(i, &moved, &mut best);
            span.add(&particles.position[i], &velocity);
        }
        let candidate = best.candidate();
        self.kept = KeptCandidate { candidate, span };
        self.label = label(particles, part);
        true
    }

    /// True if its particles have been labelled anew, as another part of a body.
    fn has_new_label(&self, particles: &ParticleStore, part: usize) -> bool {
        self.label != label(particles, part)
    }
}

/// Sum of the labels of the particles of a part.
fn label(particles: &ParticleStore, part: usize) -> u64 {
    let labels = particles.part.get(part * PART..(part + 1) * PART);
    let labels = labels.unwrap_or_default().iter();
    labels.fold(0, |sum, &label| sum.wrapping_add(label))
}

/// True if particles are so far (m) within the faces of a region.
fn is_inside(span: &Span, region: &Brick, far: f64) -> bool {
    let [lower, upper] = span.bounds();
    (0..3).all(|a| lower[a] - far >= region.lower[a] && upper[a] + far <= region.upper[a])
}

/// True if a point is so near (m) to particles.
fn is_around(span: &Span, point: &[f64; 3], far: f64) -> bool {
    let [lower, upper] = span.bounds();
    (0..3).all(|a| (lower[a] - far..=upper[a] + far).contains(&point[a]))
}
