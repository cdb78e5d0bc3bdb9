//! What contact does to the receivers of one task.

use super::hold::{self, Bearing, Hold};
use super::overlap::{self, Fraction};
use super::{BodyReaction, ContactView, Reaction, penalty, potential};
use crate::neighbours::{Chunk, ForeignChunk};

/// A particle whose foreign fraction with current volumes exceeds this is enclosed.
const ENCLOSED_FRACTION: f64 = 0.5;

/// Results of a task before they go into the store, kept from step to step.
#[derive(Default)]
pub(super) struct Task {
    pub fractions: Vec<Weighed>,
    pub normals: Vec<(usize, [f64; 3])>,
    pub holds: Vec<(usize, Hold)>,
    /// Of `penalty` contact, see [`penalty::boundary`].
    pub boundary: Vec<(usize, [f64; 3])>,
    pub reactions: Vec<Booked>,
    /// Receiving particle and its body, and what another body does to it.
    pub by_body: Vec<(usize, usize, BodyReaction)>,
    reaction: Reaction,
}

/// The foreign fraction of one particle, and for how long it has been enclosed after this step (s).
pub(super) struct Weighed {
    pub base: usize,
    pub fraction: Fraction,
    pub enclosed: f64,
}

/// What contact does to one particle.
#[derive(Clone, Copy)]
pub(super) struct Booked {
    pub base: usize,
    pub force: [f64; 3],
    pub from_mirrors: [f64; 3],
    pub energy: f64,
    pub stiffness: f64,
    pub dashpot: f64,
    pub heat: f64,
    pub closest: f64,
    pub approach: f64,
    /// Number of foreign neighbours.
    pub neighbours: usize,
}

impl Task {
    pub fn memory(&self) -> usize {
        size_of::<Weighed>() * self.fractions.capacity()
            + size_of::<(usize, [f64; 3])>() * self.normals.capacity()
            + size_of::<(usize, Hold)>() * self.holds.capacity()
            + size_of::<(usize, [f64; 3])>() * self.boundary.capacity()
            + size_of::<Booked>() * self.reactions.capacity()
            + size_of::<(usize, usize, BodyReaction)>() * self.by_body.capacity()
            + size_of::<BodyReaction>() * self.reaction.by_body.capacity()
    }

    /// Foreign fractions of one chunk's receivers after a step of `dt` (s).
    pub fn weigh(&mut self, view: &ContactView, chunk: &ForeignChunk, friction: bool, dt: f64) {
        self.fractions.clear();
        self.normals.clear();
        for (place, neighbours) in chunk.overlap.iter() {
            let base = view.images[place as usize].base();
            let relief = view.store.touch_relief[base];
            let fraction = overlap::fraction(view, place, neighbours, relief);
            let mut enclosed = 0.0;
            if fraction.current > ENCLOSED_FRACTION {
                enclosed = view.store.enclosed_time[base] + dt;
            }
            if friction {
                let normal = overlap::normal(view, place, neighbours, &fraction);
                self.normals.push((base, normal));
            }
            self.fractions.push(Weighed {
                base,
                fraction,
                enclosed,
            });
        }
    }

    /// Receivers of both lists stand in the same order.
    pub fn find_boundaries(&mut self, view: &ContactView, foreign: &ForeignChunk, own: &Chunk) {
        self.boundary.clear();
        let mut wanted = foreign.penalty.iter().map(|(place, _)| place).peekable();
        for (cluster, neighbours, _) in own.iter() {
            for &place in &cluster.receivers[..cluster.lanes] {
                if wanted.next_if_eq(&place).is_some() {
                    let normal = penalty::boundary(view, place, neighbours);
                    self.boundary
                        .push((view.images[place as usize].base(), normal));
                }
            }
        }
    }

    /// Friction and damping of one chunk's receivers, which stand in the same order in all lists.
    pub fn hold(&mut self, view: &ContactView, foreign: &ForeignChunk, own: &Chunk) {
        self.holds.clear();
        let mut overlap = foreign.overlap.iter().peekable();
        let mut penalty = foreign.penalty.iter().peekable();
        for (cluster, _, _) in own.iter() {
            for &place in &cluster.receivers[..cluster.lanes] {
                let mine = overlap.next_if(|(at, _)| *at == place);
                let theirs = penalty.next_if(|(at, _)| *at == place);
                if mine.is_none() && theirs.is_none() {
                    continue;
                }
                let [mine, theirs] = [mine, theirs].map(|list| list.map_or(&[][..], |(_, n)| n));
                let i = view.party(place);
                let mut bearing = Bearing::default();
                overlap::bear(view, &i, mine, &mut bearing);
                penalty::bear(view, &i, theirs, &mut bearing);
                let hold = hold::hold(view, &i, &bearing);
                self.holds.push((i.base, hold));
            }
        }
    }

    /// Reactions of one chunk's receivers, mode after mode.
    pub fn react<const FRICTION: bool>(&mut self, view: &ContactView, chunk: &ForeignChunk) {
        self.reactions.clear();
        self.by_body.clear();
        for (place, neighbours) in chunk.overlap.iter() {
            self.reaction.clear();
            overlap::react::<FRICTION>(view, place, neighbours, &mut self.reaction);
            self.keep(view, place, neighbours.len());
        }
        for (place, neighbours) in chunk.potential.iter() {
            self.reaction.clear();
            potential::react(view, place, neighbours, &mut self.reaction);
            self.keep(view, place, neighbours.len());
        }
        for (place, neighbours) in chunk.penalty.iter() {
            self.reaction.clear();
            penalty::react::<FRICTION>(view, place, neighbours, &mut self.reaction);
            self.keep(view, place, neighbours.len());
        }
    }

    fn keep(&mut self, view: &ContactView, place: u32, neighbours: usize) {
        let base = view.images[place as usize].base();
        let body = view.store.body[base] as usize;
        let reaction = &self.reaction;
        self.reactions.push(Booked {
            base,
            force: reaction.force,
            from_mirrors: reaction.from_mirrors,
            energy: reaction.energy,
            stiffness: reaction.stiffness,
            dashpot: reaction.dashpot,
            heat: reaction.heat,
            closest: reaction.closest,
            approach: reaction.approach,
            neighbours,
        });
        self.by_body
            .extend(reaction.by_body.iter().map(|&entry| (base, body, entry)));
    }
}
