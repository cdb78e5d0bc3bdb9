//! What rests far from all that does not is left out of steps, until that comes near (theory page "Smoothed particle
//! hydrodynamics").
//!
//! In a step motion spreads from what moves to what sums see of it, two supports far, and those sums need what is two
//! supports around it. Clusters that do not rest reach two supports from what moves, so that nothing sleeps within
//! two supports, and the range of contact, of them.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use rayon::prelude::*;

use super::busy::Busy;
use super::candidate::{Candidate, Criteria, NO_CANDIDATE};
use super::kept_links::{Keeping, KeptLinks};
use crate::contact::EVERY;
use crate::diagnose::Moved;
use crate::domain::Span;
use crate::fragments::{Labels, Sets};
use crate::sph::SignalSpeed;
use model::Case;
use particles::Mirrors;
use particles::neighbours::Lists;
use particles::{Asleep, GRAIN, PART, ParticleStore};
use populate::Brick;

/// Particles that are left out of steps, kept from one to the next.
#[allow(clippy::struct_excessive_bools, reason = "independent of each other")]
#[derive(Debug)]
pub(super) struct Dormant {
    /// Which they are.
    pub asleep: Asleep,
    /// Those of them that the last search left out.
    unlisted: Asleep,
    /// Whether some may fall asleep in this step, whose search lists all that are awake.
    is_asked: bool,
    /// Whether this has been asked since the start.
    was_asked: bool,
    /// The first candidate of what sleeps, and where that is.
    pub told: (Candidate, Span),
    /// Whether a case lets any sleep.
    is_open: bool,
    /// Where gauges look at what is there (m).
    looks: Vec<[f64; 3]>,
    parts: Vec<Part>,
    links: KeptLinks,
    /// By part: particles of clusters that rest.
    resting: Vec<AtomicU32>,
    busy: Busy,
    /// How far from faces between ranks it all is (m), and from where gauges look.
    inside: f64,
    seen: f64,
    /// Whether pieces of a body may touch that are out of each other's support: contact of unequal particles reaches farther.
    labels_change: bool,
}

/// What is known of a part of the store as long as it sleeps.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// Whether it does, but for steps in which its neighbours need it in their lists.
    keeping: Keeping,
    candidate: Candidate,
    span: Span,
    /// Sum of the labels of its particles.
    label: u64,
}

/// For what rounding takes of ranges.
const ROOM: f64 = 1.0 + 1e-6;

/// Work for a particle that sleeps, in neighbours of the pair sums.
const WORK: u32 = 2;

/// How far what falls asleep is from what is busy, and how far it stays, in widths of cells.
const APART: [f64; 2] = [2.25, 1.5];

impl Dormant {
    /// Of a case. Surfaces and loads move what rests, gravity all, and gauges look at particles around them.
    pub fn new(case: &Case) -> Self {
        let loads = &case.loads;
        let mirrors = Mirrors::new(&case.symmetry);
        let fixed = case.measure.gauges.iter().filter(|gauge| !gauge.moves);
        let looks = fixed.flat_map(|gauge| {
            let codes = std::iter::once(0).chain(mirrors.codes());
            codes.map(|code| mirrors.reflect_position(&gauge.at, code))
        });
        Self {
            looks: looks.collect(),
            asleep: Asleep::default(),
            unlisted: Asleep::default(),
            is_asked: false,
            was_asked: false,
            told: (NO_CANDIDATE, Span::NONE),
            is_open: loads.surfaces.is_empty()
                && loads.velocities.is_empty()
                && loads.gravity == [0.0; 3],
            parts: Vec::new(),
            links: KeptLinks::default(),
            resting: Vec::new(),
            busy: Busy::default(),
            inside: 0.0,
            seen: 0.0,
            labels_change: case.self_contact.is_some()
                && case.bodies.iter().any(|body| body.lattice.sizes.is_some()),
        }
    }

    pub fn memory(&self) -> usize {
        self.asleep.memory()
            + self.unlisted.memory()
            + size_of::<Part>() * self.parts.capacity()
            + size_of::<[f64; 3]>() * self.looks.capacity()
            + self.links.memory()
            + size_of::<AtomicU32>() * self.resting.capacity()
            + self.busy.memory()
    }

    /// Wakes what may stand elsewhere in the store than when it fell asleep.
    pub fn follow(&mut self, particles: &mut ParticleStore) {
        let settled = particles.settled();
        if settled < self.asleep.end() {
            self.keep(particles.owned(), |p, _| (p + 1) * PART <= settled);
        }
    }

    /// Wakes what is near the faces of this rank's region, which have moved.
    pub fn withdraw(&mut self, owned: usize, region: &Brick) {
        let far = self.inside;
        self.keep(owned, |_, part| is_inside(&part.span, region, far));
    }

    /// Wakes what does not stay.
    fn keep(&mut self, owned: usize, stays: impl Fn(usize, &Part) -> bool + Sync) {
        if self.asleep.is_empty() {
            return;
        }
        self.parts.resize(owned / PART, Part::AWAKE);
        let parts = self.parts.par_iter_mut().enumerate();
        parts.for_each(|(p, part)| {
            if !stays(p, part) {
                part.keeping = Keeping::No;
            }
        });
        self.lie_down(owned);
    }

    /// Leaves out of steps what sleeps.
    fn lie_down(&mut self, owned: usize) {
        let parts = &self.parts;
        self.asleep.set(owned, |p, _| parts[p].sleeps());
        self.tell();
    }

    /// Before the search of a step: gives what it leaves out, and whether all else needs lists, since some may fall asleep
    /// after it whose `links` are kept. Then what sleeps beside it is among that.
    pub fn leave_out(&mut self, step: u64, owned: usize, links: bool) -> (&Asleep, bool) {
        self.is_asked = self.is_open && step > 0 && (step.is_multiple_of(EVERY) || !self.was_asked);
        self.was_asked |= self.is_asked;
        let all_listed = self.is_asked && links;
        let asleep = &self.asleep;
        if all_listed {
            self.links.forget(|p| asleep.has(p));
        }
        let links = &self.links;
        if asleep.is_empty() {
            self.unlisted.clear();
        } else {
            self.unlisted.set(owned, |p, _| {
                asleep.has(p) && !(all_listed && links.is_border(p))
            });
        }
        (&self.unlisted, all_listed)
    }

    /// What stands in the store where it did in the last search, as it slept then or sleeps now.
    pub fn fixed(&mut self, owned: usize) -> &Asleep {
        let asleep = &self.asleep;
        self.unlisted
            .set(owned, |p, was_unlisted| was_unlisted || asleep.has(p));
        &self.unlisted
    }

    /// Joins what hangs together in what sleeps.
    pub fn join(&self, sets: &Sets) {
        if !self.asleep.is_empty() {
            self.links.join(|p| self.asleep.has(p), sets);
        }
    }

    /// After a step: wakes what others come near to, and, if it is asked to, lets sleep what is far from them
    /// and from the faces of this rank's region. Keeps the links of that if it has `labels` to work in.
    pub fn settle<F: SignalSpeed>(
        &mut self,
        particles: &ParticleStore,
        (lists, range): (&Lists, f64),
        (region, labels): (&Brick, Option<&mut Labels>),
        criteria: &Criteria<F>,
    ) {
        let owned = particles.owned();
        if !lists.spare_quiescent {
            return self.keep(owned, |_, _| false);
        }
        let is_asked = self.is_asked;
        let any_rest = is_asked && self.count_resting(lists, owned / PART);
        if !any_rest && self.asleep.is_empty() {
            return;
        }
        self.parts.resize(owned / PART, Part::AWAKE);
        let apart = ROOM * (2.0 * lists.farthest() + range);
        self.inside = 2.0 * apart;
        let is_farther = apart > self.seen;
        self.seen = apart;
        self.busy.find(lists, apart / APART[1]);
        let (busy, resting, inside) = (&self.busy, &self.resting, self.inside);
        let labels_change = self.labels_change;
        let is_seen = |span: &Span| self.looks.iter().any(|at| is_around(span, at, apart));
        let parts = self.parts.par_iter_mut().enumerate();
        parts.for_each(|(p, part)| {
            part.keeping = if part.sleeps() {
                let is_seen = is_farther && is_seen(&part.span);
                let is_another = is_asked && labels_change && part.has_new_label(particles, p);
                let is_near = is_seen || is_another || busy.is_near(&part.span, APART[1]);
                Keeping::Old.only_if(!is_near)
            } else {
                let rests = any_rest && resting[p].load(Relaxed) as usize == PART;
                Keeping::New.only_if(
                    rests
                        && part.is_still(particles, p, criteria)
                        && is_inside(&part.span, region, inside)
                        && !is_seen(&part.span)
                        && !busy.is_near(&part.span, APART[0]),
                )
            };
        });
        self.lie_down(owned);
        if let Some(labels) = labels.filter(|_| is_asked) {
            labels.begin(owned);
            let parts = &self.parts;
            self.links.note(lists, |p| parts[p].keeping, labels.sets());
        }
    }

    /// Has what sleeps count as next to no work, after steps that may have counted some.
    pub fn count_work(&self, work: &mut [u32]) {
        if self.is_asked {
            let parts = self.parts.par_iter().zip(work.par_chunks_exact_mut(PART));
            let asleep = parts.filter(|(part, _)| part.sleeps());
            asleep.for_each(|(_, work)| work.fill(WORK));
        }
    }

    /// Sums up what sleeps.
    fn tell(&mut self) {
        let none = || (NO_CANDIDATE, Span::NONE);
        let join = |(first, mut span): (Candidate, Span), (other, beyond): (Candidate, Span)| {
            span.join(&beyond);
            (first.min(other), span)
        };
        let asleep = &self.asleep;
        let parts = self.parts.par_iter().enumerate().with_min_len(GRAIN);
        let all = parts.filter(|(p, _)| asleep.has(*p));
        // same bits in any order: smallest and largest numbers
        self.told = all
            .map(|(_, part)| (part.candidate, part.span))
            .reduce(none, join);
    }

    /// Counts by part what rests without motion; gives whether any of so many parts does as a whole.
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
                        let part = images[place as usize].base() / PART;
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
    const AWAKE: Self = Self {
        keeping: Keeping::No,
        candidate: NO_CANDIDATE,
        span: Span::NONE,
        label: 0,
    };

    fn sleeps(&self) -> bool {
        self.keeping != Keeping::No
    }

    /// Sees whether all particles of a part stand still, and what they ask for.
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
        (self.candidate, self.span) = (best.candidate(), span);
        self.label = label(particles, part);
        true
    }

    /// Whether its particles have been told to be of another part of a body.
    fn has_new_label(&self, particles: &ParticleStore, part: usize) -> bool {
        self.label != label(particles, part)
    }
}

fn label(particles: &ParticleStore, part: usize) -> u64 {
    let labels = particles.part.get(part * PART..(part + 1) * PART);
    let labels = labels.unwrap_or_default().iter();
    labels.fold(0, |sum, &label| sum.wrapping_add(label))
}

/// Whether particles are so far (m) within the faces of a region.
fn is_inside(span: &Span, region: &Brick, far: f64) -> bool {
    let [lower, upper] = span.bounds();
    (0..3).all(|a| lower[a] - far >= region.lower[a] && upper[a] + far <= region.upper[a])
}

/// Whether a point is so near (m) to particles.
fn is_around(span: &Span, point: &[f64; 3], far: f64) -> bool {
    let [lower, upper] = span.bounds();
    (0..3).all(|a| (lower[a] - far..=upper[a] + far).contains(&point[a]))
}
