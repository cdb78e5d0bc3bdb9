//! Distance that bodies may fly in a step without passing through each other unseen, see the page
//! on time integration.
//!
//! In nearly all steps the extents of all places and velocities, which are joined with the sums of each
//! step, show that nothing can. Else pairs of bodies are examined, then those of their particles that can
//! meet, and particles near rigid surfaces.

use rayon::prelude::*;

use crate::contact::ContactTable;
use crate::domain::Span;
use crate::loads::{Loads, Placed};
use comm::Comm;
use model::{Case, RigidSurface};
use numerics::vector::norm;
use particles::{MirrorMask, Mirrors, ParticleStore};

/// Rounds in which particles that can meet are sought among those that could before.
const ROUNDS: usize = 4;

/// The search for a longest step, with memory kept from one to the next.
#[derive(Debug, Default)]
pub(super) struct Flight {
    /// Shortest mean smoothing length of two bodies with contact (m), infinite without.
    shortest: f64,
    search: Search,
    /// Velocities that loads may prescribe in the step (m/s), by ledger and axis.
    prescribed: Vec<[Option<[f64; 2]>; 3]>,
}

/// Particles that fly, and everything that they may fly through.
#[derive(Clone, Copy)]
pub(super) struct FlightInputs<'a> {
    pub case: &'a Case,
    pub particles: &'a ParticleStore,
    pub table: &'a ContactTable,
    pub loads: &'a Loads,
    pub mirrors: &'a Mirrors,
    /// Now (s).
    pub time: f64,
}

/// The search for bodies that meet.
#[derive(Debug, Default)]
struct Search {
    /// By set of particles and thread.
    parts: Vec<Vec<Span>>,
    /// Of bodies and their images, by their lower ends.
    ways: Vec<Way>,
    meetings: Vec<Meeting>,
    /// By body, which sides of meetings are its own.
    sides: Vec<Vec<usize>>,
    words: Vec<u64>,
}

/// Two bodies, of the second one an image behind planes, and the extents of their particles that can meet.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    bodies: [usize; 2],
    mirror_mask: MirrorMask,
    h: f64,
    spans: [Span; 2],
}

/// The part of the x axis within reach of a body, or of an image of it, in a step.
#[derive(Debug, Clone, Copy)]
struct Way {
    body: usize,
    mirror_mask: MirrorMask,
    /// Its ends (m).
    lower: f64,
    upper: f64,
}

impl Way {
    /// Of the extent of a body or an image in a step `dt` (s), with contact of some range (m).
    fn new(body: usize, mirror_mask: MirrorMask, span: &Span, (dt, range): (f64, f64)) -> Self {
        let [lower, upper] = span.bounds();
        let [[slowest, fastest], ..] = span.velocities();
        Self {
            body,
            mirror_mask,
            lower: lower[0] + (slowest * dt).min(0.0) - range,
            upper: upper[0] + (fastest * dt).max(0.0) + range,
        }
    }
}

impl Meeting {
    fn longest_step(&self, mirrors: &Mirrors) -> f64 {
        let image = self.spans[1].reflected(mirrors, self.mirror_mask);
        self.spans[0].longest_step(&image, self.h)
    }

    /// True if a particle of one side can meet the other in a step `dt` (s) unseen.
    fn concerns(&self, mirrors: &Mirrors, side: usize, point: &Span, dt: f64) -> bool {
        let other = self.spans[1 - side].reflected(mirrors, self.mirror_mask);
        point.longest_step(&other, self.h) < dt
    }
}

impl Flight {
    pub fn new(contact: &ContactTable) -> Self {
        Self {
            shortest: contact.shortest(),
            ..Self::default()
        }
    }

    pub fn memory(&self) -> usize {
        self.search.memory() + size_of::<[Option<[f64; 2]>; 3]>() * self.prescribed.capacity()
    }

    /// The longest step, of no more than `dt` (s), in which nothing flies through anything else
    /// unseen, given the extent of all particles. Collective.
    pub fn longest_step(
        &mut self,
        comm: &Comm,
        inputs: &FlightInputs,
        span: &Span,
        dt: f64,
    ) -> f64 {
        let mut all = *span;
        let from = inputs.time;
        let to = inputs.case.run.end_time.min(from + dt);
        if all.is_empty() || !inputs.table.is_active() || to.is_infinite() {
            return dt;
        }
        self.prescribed.clear();
        self.prescribed.extend(prescribed(inputs.case, from, to));
        for ranges in &self.prescribed {
            for (a, range) in ranges.iter().enumerate() {
                if let Some(range) = *range {
                    all.widen(a, range);
                }
            }
        }
        let mut images = all;
        for mirror_mask in inputs.mirrors.masks().skip(1) {
            images.join(&all.reflected(inputs.mirrors, mirror_mask));
        }
        let flyers = Flyers {
            particles: inputs.particles,
            prescribed: &self.prescribed,
        };
        let mut longest = dt;
        if norm(&images.against(&images.velocities())) * dt > self.shortest {
            longest = self.search.of_bodies(comm, inputs, &flyers, dt);
        }
        let near = |surface: &RigidSurface, placed: &Placed| {
            let speed = placed.closing_speed(&all, from, to);
            let bodies = inputs.case.bodies.iter().zip(&surface.bodies);
            let h = bodies
                .filter(|(_, acts)| **acts)
                .map(|(body, _)| body.smoothing_length);
            2.0 * speed * dt > h.fold(f64::INFINITY, f64::min)
        };
        let surfaces = inputs
            .case
            .loads
            .surfaces
            .iter()
            .zip(&inputs.loads.surfaces);
        let mut placed = surfaces.map(|(surface, step)| Placed { surface, step });
        if placed.any(|placed| near(placed.surface, &placed)) {
            longest = comm.min_f64(to_surfaces(inputs, &flyers, longest));
        }
        longest
    }
}

impl Search {
    fn memory(&self) -> usize {
        let parts = self.parts.iter().map(Vec::capacity).sum::<usize>();
        let sides = self.sides.iter().map(Vec::capacity).sum::<usize>();
        size_of::<Span>() * parts
            + size_of::<Way>() * self.ways.capacity()
            + size_of::<Meeting>() * self.meetings.capacity()
            + size_of::<usize>() * sides
            + size_of::<u64>() * self.words.capacity()
    }

    /// Joins `sets` spans over all particles and ranks, to which `book` adds a particle, into the
    /// first of `parts`. Collective.
    fn join(
        &mut self,
        comm: &Comm,
        sets: usize,
        owned: usize,
        book: impl Fn(usize, &mut [Span], &[Meeting], &[Vec<usize>]) + Sync,
    ) {
        let threads = rayon::current_num_threads();
        self.parts.resize_with(threads, Vec::new);
        let share = owned.div_ceil(threads);
        let (meetings, sides) = (&self.meetings, &self.sides);
        let parts = self.parts.par_iter_mut().enumerate().with_max_len(1);
        parts.for_each(|(thread, part)| {
            part.clear();
            part.resize(sets, Span::NONE);
            for i in thread * share..((thread + 1) * share).min(owned) {
                book(i, part, meetings, sides);
            }
        });
        let (all, others) = self.parts.split_at_mut(1);
        for part in others {
            for (span, other) in all[0].iter_mut().zip(part) {
                span.join(other);
            }
        }
        self.words.clear();
        all[0].iter().for_each(|span| span.write(&mut self.words));
        comm.min_u64(&mut self.words);
        for (span, words) in all[0].iter_mut().zip(self.words.chunks_exact(Span::WORDS)) {
            *span = Span::read(words);
        }
    }

    /// Keeps the meetings that limit a step `dt` (s); gives the longest step that they allow.
    fn sift(&mut self, mirrors: &Mirrors, dt: f64) -> f64 {
        let mut longest = dt;
        self.meetings.retain(|meeting| {
            let step = meeting.longest_step(mirrors);
            longest = longest.min(step);
            step < dt
        });
        self.sides.iter_mut().for_each(Vec::clear);
        for (m, meeting) in self.meetings.iter().enumerate() {
            for (side, &body) in meeting.bodies.iter().enumerate() {
                self.sides[body].push(2 * m + side);
            }
        }
        longest
    }

    /// The longest step, of no more than `dt` (s), of bodies that fly towards each other.
    /// Collective.
    fn of_bodies(&mut self, comm: &Comm, inputs: &FlightInputs, flyers: &Flyers, dt: f64) -> f64 {
        let (particles, bodies) = (inputs.particles, inputs.case.bodies.len());
        let mirrors = inputs.mirrors;
        self.join(comm, bodies, particles.owned(), |i, spans, _, _| {
            // Stress points meet nothing.
            if particles.mass[i] > 0.0 {
                spans[particles.body[i] as usize].join(&flyers.point(i));
            }
        });
        self.sides.resize_with(bodies, Vec::new);
        self.pair(inputs, dt);
        let mut longest = self.sift(mirrors, dt);
        for _ in 0..ROUNDS {
            if self.meetings.is_empty() {
                break;
            }
            let sets = 2 * self.meetings.len();
            self.join(
                comm,
                sets,
                particles.owned(),
                |i, spans, meetings, sides| {
                    let sides = &sides[particles.body[i] as usize];
                    if sides.is_empty() || particles.mass[i] == 0.0 {
                        return;
                    }
                    let point = flyers.point(i);
                    for &side in sides {
                        if meetings[side / 2].concerns(mirrors, side % 2, &point, dt) {
                            spans[side].join(&point);
                        }
                    }
                },
            );
            let (spans, meetings) = (&self.parts[0], &mut self.meetings);
            for (meeting, spans) in meetings.iter_mut().zip(spans.chunks_exact(2)) {
                meeting.spans = [spans[0], spans[1]];
            }
            let before = longest;
            longest = self.sift(mirrors, dt);
            if longest <= before {
                break;
            }
        }
        longest
    }

    /// Lists the bodies that limit a step `dt` (s), given the extent of each of them.
    fn pair(&mut self, inputs: &FlightInputs, dt: f64) {
        let (mirrors, bodies) = (inputs.mirrors, inputs.case.bodies.len());
        let (spans, meetings) = (&self.parts[0][..bodies], &mut self.meetings);
        let ways = &mut self.ways;
        ways.clear();
        let range = inputs.table.longest_range();
        let flying = spans
            .iter()
            .enumerate()
            .filter(|(_, span)| !span.is_empty());
        for (body, span) in flying {
            ways.extend(mirrors.masks().map(|mirror_mask| {
                let image = span.reflected(mirrors, mirror_mask);
                Way::new(body, mirror_mask, &image, (dt, range))
            }));
        }
        ways.sort_unstable_by(|one, next| {
            let by_place = one.lower.total_cmp(&next.lower);
            by_place
                .then((one.body, one.mirror_mask.bits()).cmp(&(next.body, next.mirror_mask.bits())))
        });
        meetings.clear();
        for (k, one) in ways.iter().enumerate() {
            let near = ways[k + 1..]
                .iter()
                .take_while(|other| other.lower <= one.upper);
            for other in near {
                // The first body itself, and the second one or an image of it.
                let (own, image) = if one.body < other.body {
                    (one, other)
                } else {
                    (other, one)
                };
                if own.body == image.body || !own.mirror_mask.is_own() {
                    continue;
                }
                let Some(pair) = inputs.table.between(own.body, image.body) else {
                    continue;
                };
                let meeting = Meeting {
                    bodies: [own.body, image.body],
                    mirror_mask: image.mirror_mask,
                    h: pair.h,
                    spans: [spans[own.body], spans[image.body]],
                };
                if meeting.longest_step(mirrors) < dt {
                    meetings.push(meeting);
                }
            }
        }
    }
}

/// Velocities of particles in the next step.
struct Flyers<'a> {
    particles: &'a ParticleStore,
    prescribed: &'a [[Option<[f64; 2]>; 3]],
}

impl Flyers<'_> {
    fn point(&self, i: usize) -> Span {
        let particles = self.particles;
        let mut point = Span::point(&particles.position[i], &particles.velocity[i]);
        let mut bits = particles.load.get(i).copied().unwrap_or(0);
        while bits != 0 {
            let ranges = &self.prescribed[bits.trailing_zeros() as usize];
            bits &= bits - 1;
            for (a, range) in ranges.iter().enumerate() {
                if let Some(range) = *range {
                    point.widen(a, range);
                }
            }
        }
        point
    }
}

/// Velocities that loads may prescribe between two times (s), in the order of the loads' bits.
fn prescribed(case: &Case, from: f64, to: f64) -> impl Iterator<Item = [Option<[f64; 2]>; 3]> {
    let loads = case.loads.velocities.iter();
    let held = loads.map(move |load| (from < load.until).then_some(&load.motion));
    let rigid = case.bodies.iter().filter_map(|body| body.rigid.as_ref());
    held.chain(rigid.map(Some)).map(move |motion| {
        std::array::from_fn(|a| motion.and_then(|motion| motion.range(a, from, to)))
    })
}

/// The longest step, of no more than `dt` (s), of this rank's particles that fly towards rigid
/// surfaces.
fn to_surfaces(inputs: &FlightInputs, flyers: &Flyers, dt: f64) -> f64 {
    let (from, to) = (inputs.time, inputs.time + dt);
    let (particles, case) = (inputs.particles, inputs.case);
    let surfaces = case.loads.surfaces.iter().zip(&inputs.loads.surfaces);
    surfaces.fold(dt, |longest, (surface, step)| {
        let placed = Placed { surface, step };
        let step = |i: usize| {
            let body = particles.body[i] as usize;
            if !surface.bodies[body] || particles.mass[i] == 0.0 {
                return longest;
            }
            let h = case.bodies[body].smoothing_length;
            let (x, point) = (&particles.position[i], flyers.point(i));
            let speed = placed.closing_speed(&point, from, to);
            let local = placed.local(x);
            // Contact sees particles nearer than h.
            match surface.foot(&local, 0.5 * h + speed * longest) {
                Some(foot) if foot.gap >= h => (foot.gap - 0.5 * h) / speed,
                _ => longest,
            }
        };
        let owned = (0..particles.owned()).into_par_iter();
        // same bits in any order: a smallest number
        owned.map(step).reduce(|| longest, f64::min)
    })
}
