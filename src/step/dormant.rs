//! What rests far from all that does not is left out of steps, until that comes near (theory page "Smoothed particle
//! hydrodynamics").
//!
//! In a step motion spreads from what moves to what sums see of it, two supports far, and those sums need what is two
//! supports around it. Clusters that do not rest reach two supports from what moves, so that nothing sleeps within
//! two supports, and the range of contact, of them.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use rayon::prelude::*;

use super::candidate::{Candidate, Criteria, NO_CANDIDATE};
use crate::diagnose::Moved;
use crate::domain::Span;
use crate::model::Case;
use crate::neighbours::{Chunk, Lists};
use crate::numerics::collector::Collector;
use crate::particles::{Asleep, GRAIN, PART, ParticleStore};
use crate::populate::Brick;
use crate::sph::SignalSpeed;

/// Particles that are left out of steps, kept from one to the next.
#[derive(Debug)]
pub(super) struct Dormant {
    /// Which they are.
    pub asleep: Asleep,
    /// Whether the last search saw all particles.
    pub is_whole: bool,
    /// Whether some may fall asleep in this step, whose search sees all.
    pub is_asked: bool,
    /// The first candidate of what sleeps, and where that is.
    pub told: (Candidate, Span),
    /// Whether a case lets any sleep.
    is_open: bool,
    parts: Vec<Part>,
    /// By part: particles of clusters that rest.
    resting: Vec<AtomicU32>,
    busy: Busy,
}

/// What is known of a part of the store as long as it sleeps.
#[derive(Debug, Clone, Copy)]
struct Part {
    sleeps: bool,
    candidate: Candidate,
    span: Span,
}

/// Where not all rests: cells of space somewhat narrower than what sleeps is away from it.
#[derive(Debug, Default)]
struct Busy {
    /// Edge (m).
    width: f64,
    /// Ascending.
    cells: Vec<[i64; 3]>,
    /// Smallest and largest indices.
    bounds: [[i64; 3]; 2],
    collector: Collector,
}

/// For what rounding takes of ranges.
const ROOM: f64 = 1.0 + 1e-6;

/// How far what falls asleep is from what is busy, and how far it stays, in widths of cells.
const APART: [f64; 2] = [2.25, 1.5];

impl Dormant {
    /// Of a case. Surfaces and loads move what rests, gravity all, and gauges look at particles around them.
    pub fn new(case: &Case) -> Self {
        let loads = &case.loads;
        Self {
            asleep: Asleep::default(),
            is_whole: true,
            is_asked: false,
            told: (NO_CANDIDATE, Span::NONE),
            is_open: loads.surfaces.is_empty()
                && loads.velocities.is_empty()
                && loads.gravity == [0.0; 3]
                && case.measure.gauges.is_empty(),
            parts: Vec::new(),
            resting: Vec::new(),
            busy: Busy::default(),
        }
    }

    pub fn memory(&self) -> usize {
        self.asleep.memory()
            + size_of::<Part>() * self.parts.capacity()
            + size_of::<AtomicU32>() * self.resting.capacity()
            + size_of::<[i64; 3]>() * self.busy.cells.capacity()
            + self.busy.collector.memory()
    }

    /// Wakes all.
    pub fn wake(&mut self) {
        self.asleep.clear();
        self.told = (NO_CANDIDATE, Span::NONE);
    }

    /// Wakes what may stand elsewhere in the store than when it fell asleep.
    pub fn follow(&mut self, particles: &mut ParticleStore) {
        let settled = particles.settled();
        if !self.asleep.is_empty() && settled < self.asleep.end() {
            let is_in_place = |part: usize| (part + 1) * PART <= settled;
            self.asleep.set(particles.owned(), |part, asleep| {
                asleep && is_in_place(part)
            });
            self.tell();
        }
    }

    /// After a step: wakes what others come near to, and, if it is asked to, lets sleep what is far from them
    /// and from the faces of this rank's region.
    pub fn settle<F: SignalSpeed>(
        &mut self,
        particles: &ParticleStore,
        (lists, range): (&Lists, f64),
        region: &Brick,
        criteria: &Criteria<F>,
    ) {
        let owned = particles.owned();
        let is_asked = self.is_asked && self.is_open && lists.spare_quiescent;
        let any_rest = is_asked && self.count_resting(lists, owned / PART);
        if !any_rest && self.asleep.is_empty() {
            return;
        }
        let none = Part {
            sleeps: false,
            candidate: NO_CANDIDATE,
            span: Span::NONE,
        };
        self.parts.resize(owned / PART, none);
        let apart = ROOM * (2.0 * lists.farthest() + range);
        self.busy.find(lists, apart / APART[1]);
        let (asleep, busy, resting) = (&self.asleep, &self.busy, &self.resting);
        let parts = self.parts.par_iter_mut().enumerate();
        parts.for_each(|(p, part)| {
            if asleep.has(p) {
                part.sleeps = !busy.is_near(&part.span, APART[1]);
            } else {
                part.sleeps = any_rest && resting[p].load(Relaxed) as usize == PART;
                part.sleeps = part.sleeps && part.lie_down(particles, p, criteria);
                part.sleeps = part.sleeps
                    && is_inside(&part.span, region, 2.0 * apart)
                    && !busy.is_near(&part.span, APART[0]);
            }
        });
        let parts = &self.parts;
        self.asleep.set(owned, |p, _| parts[p].sleeps);
        self.tell();
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
    /// Sees whether all particles of a part stand still, and what they ask for.
    fn lie_down<F: SignalSpeed>(
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
        true
    }
}

/// Whether particles are so far (m) within the faces of a region.
fn is_inside(span: &Span, region: &Brick, far: f64) -> bool {
    let [lower, upper] = span.bounds();
    (0..3).all(|a| lower[a] - far >= region.lower[a] && upper[a] + far <= region.upper[a])
}

impl Busy {
    /// Finds the cells of a width (m) in which not all rests.
    fn find(&mut self, lists: &Lists, width: f64) {
        self.width = width;
        self.cells.clear();
        let chunks = lists.chunks();
        self.collector
            .extend(&mut self.cells, (chunks.len(), 1), |k| {
                cells_of(&chunks[k], lists, width)
            });
        self.cells.par_sort_unstable();
        self.cells.dedup();
        self.bounds = [[i64::MAX; 3], [i64::MIN; 3]];
        let [least, most] = &mut self.bounds;
        for cell in &self.cells {
            for a in 0..3 {
                least[a] = least[a].min(cell[a]);
                most[a] = most[a].max(cell[a]);
            }
        }
    }

    /// Whether any of them is within so many widths of particles.
    fn is_near(&self, span: &Span, widths: f64) -> bool {
        let [lower, upper] = span.bounds();
        let cell = |x: f64, way: f64| index(x + way * widths * self.width, self.width);
        let least: [i64; 3] = std::array::from_fn(|a| cell(lower[a], -1.0).max(self.bounds[0][a]));
        let most: [i64; 3] = std::array::from_fn(|a| cell(upper[a], 1.0).min(self.bounds[1][a]));
        (least[0]..=most[0]).any(|x| {
            (least[1]..=most[1]).any(|y| {
                let first = [x, y, least[2]];
                let at = self.cells.partition_point(|busy| *busy < first);
                let next = self.cells.get(at);
                next.is_some_and(|next| *next <= [x, y, most[2]])
            })
        })
    }
}

#[allow(clippy::cast_possible_truncation, reason = "far cells are one")]
fn index(x: f64, width: f64) -> i64 {
    (x / width).floor() as i64
}

/// The cells of clusters of a task that do not rest, or fly.
fn cells_of(chunk: &Chunk, lists: &Lists, width: f64) -> impl Iterator<Item = [i64; 3]> {
    let busy = chunk
        .iter()
        .filter(|(cluster, _, among)| !among.resting || !lists.is_still(cluster.group));
    // Clusters of a column stand in the same few cells.
    let (mut recent, mut next) = ([[i64::MAX; 3]; 16], 0);
    let cells = busy.flat_map(move |(cluster, ..)| {
        let along = |a: usize| index(cluster.lower[a], width)..=index(cluster.upper[a], width);
        let (y, z) = (along(1), along(2));
        along(0).flat_map(move |x| {
            let z = z.clone();
            y.clone()
                .flat_map(move |y| z.clone().map(move |z| [x, y, z]))
        })
    });
    cells.filter(move |cell| {
        let is_new = !recent.contains(cell);
        if is_new {
            recent[next] = *cell;
            next = (next + 1) % recent.len();
        }
        is_new
    })
}
