//! How far bodies may fly in a step without passing through each other unseen, see the page on time
//! integration.
//!
//! The velocities of all particles together, which ride along with the sums of each step, tell for
//! nearly all steps that nothing can. Else bodies are looked at by pairs, then those of their
//! particles that can meet; and the particles near rigid surfaces.

use rayon::prelude::*;

use super::simulation::Simulation;
use super::span::Span;
use super::surface_motion::Placed;
use crate::comm::Comm;
use crate::contact::ContactTable;
use crate::domain::Mirrors;
use crate::model::{Case, RigidSurface};
use crate::neighbours::ContactClass;
use crate::numerics::vector::norm;
use crate::particles::ParticleStore;

/// How often those that can meet are looked for among those that could before.
const ROUNDS: usize = 4;

/// What the search for a longest step works with, kept from one to the next.
#[derive(Debug, Default)]
pub(super) struct Flight {
    /// Shortest mean smoothing length of two bodies with contact (m), infinite without.
    shortest: f64,
    /// By set of particles and thread.
    parts: Vec<Vec<Span>>,
    meetings: Vec<Meeting>,
    /// By body, which sides of meetings are its own.
    sides: Vec<Vec<usize>>,
    words: Vec<u64>,
    /// Velocities that loads may prescribe in the step (m/s), by ledger and axis.
    prescribed: Vec<[Option<[f64; 2]>; 3]>,
}

/// Two bodies, the second one's image behind planes, and what of them can meet.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    bodies: [usize; 2],
    code: u8,
    h: f64,
    spans: [Span; 2],
}

impl Meeting {
    fn longest_step(&self, mirrors: &Mirrors) -> f64 {
        let image = self.spans[1].reflected(mirrors, self.code);
        self.spans[0].longest_step(&image, self.h)
    }

    /// Whether a particle of one side can meet the other in a step `dt` (s) unseen.
    fn concerns(&self, mirrors: &Mirrors, side: usize, point: &Span, dt: f64) -> bool {
        let other = self.spans[1 - side].reflected(mirrors, self.code);
        point.longest_step(&other, self.h) < dt
    }
}

impl Flight {
    pub fn new(contact: &ContactTable) -> Self {
        let pairs = contact.active_pairs().into_iter();
        let apart = pairs.filter(|[a, b]| a != b);
        Self {
            shortest: apart.fold(f64::INFINITY, |h, [a, b]| h.min(contact.pair(a, b).h)),
            ..Self::default()
        }
    }

    pub fn memory(&self) -> usize {
        let parts = self.parts.iter().map(Vec::capacity).sum::<usize>();
        let sides = self.sides.iter().map(Vec::capacity).sum::<usize>();
        size_of::<Span>() * parts
            + size_of::<Meeting>() * self.meetings.capacity()
            + size_of::<usize>() * sides
            + size_of::<u64>() * self.words.capacity()
            + size_of::<[Option<[f64; 2]>; 3]>() * self.prescribed.capacity()
    }

    /// Joins `sets` spans over all particles and ranks, to which `book` adds a particle, into the first
    /// of `parts`. Collective.
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
}

/// What tells the velocities of a particle in the next step.
struct Flyers<'a> {
    store: &'a ParticleStore,
    prescribed: &'a [[Option<[f64; 2]>; 3]],
}

impl Flyers<'_> {
    fn point(&self, i: usize) -> Span {
        let store = self.store;
        let mut point = Span::point(&store.position[i], &store.velocity[i]);
        let mut bits = store.load.get(i).copied().unwrap_or(0);
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

impl Simulation {
    /// The longest step, of no more than `dt` (s), in which nothing flies through anything else
    /// unseen. Collective.
    pub(super) fn longest_flight(&mut self, comm: &Comm, dt: f64) -> f64 {
        let mut all = self.sums.span;
        let from = self.state.time;
        let to = self.case.run.end_time.min(from + dt);
        if all.is_empty() || !self.contact.is_active() || to.is_infinite() {
            return dt;
        }
        let mut flight = std::mem::take(&mut self.flight);
        flight.prescribed.clear();
        flight.prescribed.extend(prescribed(&self.case, from, to));
        for ranges in &flight.prescribed {
            for (a, range) in ranges.iter().enumerate() {
                if let Some(range) = *range {
                    all.widen(a, range);
                }
            }
        }
        let mirrors = *self.halo.mirrors();
        let mut images = all;
        for code in mirrors.codes() {
            images.join(&all.reflected(&mirrors, code));
        }
        let mut longest = dt;
        if norm(&images.against(&images.velocities())) * dt > flight.shortest {
            longest = self.flight_of_bodies(comm, &mut flight, dt);
        }
        let near = |surface: &RigidSurface, placed: &Placed| {
            let speed = placed.closing_speed(&all, from, to);
            let bodies = self.case.bodies.iter().zip(&surface.bodies);
            let h = bodies
                .filter(|(_, acts)| **acts)
                .map(|(body, _)| body.smoothing_length);
            2.0 * speed * dt > h.fold(f64::INFINITY, f64::min)
        };
        let surfaces = self.case.loads.surfaces.iter().zip(&self.loads.surfaces);
        let mut placed = surfaces.map(|(surface, step)| Placed { surface, step });
        if placed.any(|placed| near(placed.surface, &placed)) {
            longest = comm.min_f64(self.flight_to_surfaces(&flight, longest));
        }
        self.flight = flight;
        longest
    }

    /// The same of bodies that fly towards each other. Collective.
    fn flight_of_bodies(&self, comm: &Comm, flight: &mut Flight, dt: f64) -> f64 {
        let (store, bodies) = (&self.store, self.case.bodies.len());
        let prescribed = std::mem::take(&mut flight.prescribed);
        let flyers = Flyers {
            store,
            prescribed: &prescribed,
        };
        let mirrors = *self.halo.mirrors();
        flight.join(comm, bodies, store.owned(), |i, spans, _, _| {
            // Stress points meet nothing.
            if store.mass[i] > 0.0 {
                spans[store.body[i] as usize].join(&flyers.point(i));
            }
        });
        flight.sides.resize_with(bodies, Vec::new);
        self.pair_bodies(flight, dt);
        let mut longest = flight.sift(&mirrors, dt);
        for _ in 0..ROUNDS {
            if flight.meetings.is_empty() {
                break;
            }
            let sets = 2 * flight.meetings.len();
            flight.join(comm, sets, store.owned(), |i, spans, meetings, sides| {
                let sides = &sides[store.body[i] as usize];
                if sides.is_empty() || store.mass[i] == 0.0 {
                    return;
                }
                let point = flyers.point(i);
                for &side in sides {
                    if meetings[side / 2].concerns(&mirrors, side % 2, &point, dt) {
                        spans[side].join(&point);
                    }
                }
            });
            let (spans, meetings) = (&flight.parts[0], &mut flight.meetings);
            for (meeting, spans) in meetings.iter_mut().zip(spans.chunks_exact(2)) {
                meeting.spans = [spans[0], spans[1]];
            }
            let before = longest;
            longest = flight.sift(&mirrors, dt);
            if longest <= before {
                break;
            }
        }
        flight.prescribed = prescribed;
        longest
    }

    /// Lists the bodies that limit a step `dt` (s), given what each of them spans.
    fn pair_bodies(&self, flight: &mut Flight, dt: f64) {
        let (mirrors, bodies) = (*self.halo.mirrors(), self.case.bodies.len());
        let (spans, meetings) = (&flight.parts[0], &mut flight.meetings);
        meetings.clear();
        for a in 0..bodies {
            for b in a + 1..bodies {
                if self.contact.foreign.class[a * bodies + b] == ContactClass::None {
                    continue;
                }
                let meet = |code| Meeting {
                    bodies: [a, b],
                    code,
                    h: self.contact.pair(a, b).h,
                    spans: [spans[a], spans[b]],
                };
                let all = std::iter::once(0).chain(mirrors.codes()).map(meet);
                meetings.extend(all.filter(|meeting| meeting.longest_step(&mirrors) < dt));
            }
        }
    }

    /// The same of this rank's particles that fly towards rigid surfaces.
    fn flight_to_surfaces(&self, flight: &Flight, dt: f64) -> f64 {
        let (from, to) = (self.state.time, self.state.time + dt);
        let flyers = Flyers {
            store: &self.store,
            prescribed: &flight.prescribed,
        };
        let (store, case) = (&self.store, &self.case);
        let surfaces = case.loads.surfaces.iter().zip(&self.loads.surfaces);
        surfaces.fold(dt, |longest, (surface, step)| {
            let placed = Placed { surface, step };
            let step = |i: usize| {
                let body = store.body[i] as usize;
                if !surface.bodies[body] || store.mass[i] == 0.0 {
                    return longest;
                }
                let h = case.bodies[body].smoothing_length;
                let (x, point) = (&store.position[i], flyers.point(i));
                let speed = placed.closing_speed(&point, from, to);
                let local = placed.local(x);
                // What is nearer than h has been seen.
                match surface.foot(&local, 0.5 * h + speed * longest) {
                    Some(foot) if foot.gap >= h => (foot.gap - 0.5 * h) / speed,
                    _ => longest,
                }
            };
            let owned = (0..store.owned()).into_par_iter();
            // same bits in any order: a smallest number
            owned.map(step).reduce(|| longest, f64::min)
        })
    }
}
