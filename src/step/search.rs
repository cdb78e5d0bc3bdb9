//! From owned and halo particles to sorted images, their records and neighbour lists.

use rayon::prelude::*;

use super::simulation::Simulation;
use crate::contact::ContactTable;
use crate::domain::Mirrors;
use crate::model::{Case, SmoothingLength};
use crate::neighbours::{ClusterLists, ColumnGrid, ForeignLists, ImageFacts, Lengths, Sequence};
use crate::particles::{Image, Scatter, resize};
use crate::sph::neighbourhood::{MotionRecord, Sources};

/// The sequence of images, their motion records and the lists, kept from step to step.
pub struct Search {
    pub(super) sequence: Sequence,
    pub(super) motion: Vec<MotionRecord>,
    pub(super) clusters: ClusterLists,
    pub(super) foreign: ForeignLists,
    /// Smoothing lengths of each group.
    lengths: Vec<Lengths>,
    /// Velocity of each group's first body at the start (m/s): where all move so and there is no
    /// stress, sums are zero to the bit and need not be made.
    common_velocity: Vec<[f64; 3]>,
}

impl Search {
    pub(super) fn new(case: &Case, contact: &ContactTable, grids: Vec<ColumnGrid>) -> Self {
        let lengths = group_lengths(case, contact);
        let (first, rest) = lengths.split_first().expect("a case has bodies");
        let same =
            |group: &Lengths| group.uniform && group.longest.to_bits() == first.longest.to_bits();
        let uniform = first.uniform && rest.iter().all(same);
        Self {
            lengths,
            common_velocity: (0..contact.group_count())
                .map(|group| {
                    let first = contact.members(group).next();
                    first.map_or([0.0; 3], |body| case.bodies[body].velocity.into())
                })
                .collect(),
            sequence: Sequence::new(grids, uniform),
            motion: Vec::new(),
            clusters: ClusterLists::new(
                (contact.group_count() > contact.body_groups).then_some(contact.body_groups),
            ),
            foreign: ForeignLists::default(),
        }
    }

    /// What the sums over pairs see of all particles and images.
    pub(super) fn sources<S>(&self, scale: S) -> Sources<'_, S> {
        Sources {
            records: &self.motion,
            lengths: self.sequence.smoothing_lengths(),
            scale,
        }
    }

    /// Whether two images of a group are within each other's support.
    pub(super) fn in_support(&self, group: usize, i: u32, j: u32) -> bool {
        let [a, b] = [i, j].map(|place| &self.motion[place as usize].position);
        let r = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let lengths = self.sequence.smoothing_lengths();
        let h = |place: u32| {
            let own = lengths.get(place as usize);
            own.copied().unwrap_or(self.lengths[group].longest)
        };
        let range = (h(i) + h(j)).max(self.lengths[group].least);
        r[0] * r[0] + r[1] * r[1] + r[2] * r[2] < range * range
    }

    pub(super) fn memory(&self) -> usize {
        self.sequence.memory()
            + self.motion.capacity() * size_of::<MotionRecord>()
            + self.clusters.memory()
            + self.foreign.memory()
    }
}

/// The groups' smoothing lengths where these are constant.
fn group_lengths(case: &Case, contact: &ContactTable) -> Vec<Lengths> {
    let constant = case.sph.smoothing_length == SmoothingLength::Constant;
    (0..contact.group_count())
        .map(|group| {
            let members = contact.members(group);
            let h = || members.clone().map(|b| case.bodies[b].smoothing_length);
            let longest = h().fold(0.0, f64::max);
            Lengths {
                longest,
                least: if case.self_contact.is_some() {
                    2.0 * longest
                } else {
                    0.0
                },
                uniform: constant && h().all(|h| h.to_bits() == longest.to_bits()),
                rigid: contact.rigid[group],
            }
        })
        .collect()
}

/// The store is put in order if more than one particle in so many does not follow the one before.
const ASTRAY: usize = 256;

/// Elements that a task handles at least.
pub(super) const GRAIN: usize = 1024;

impl Simulation {
    pub(super) fn find_neighbours(&mut self) {
        let (store, mirrors) = (&self.store, self.halo.mirrors());
        let (groups, body_groups) = (&self.contact.groups, self.contact.body_groups);
        let search = &mut self.search;
        let (owned, others) = (store.owned(), self.halo.others());
        let below = self.halo.below();
        let (spare, common) = (self.spare_calm, &search.common_velocity);
        resize(&mut search.motion, owned + others.len());
        let motion = Scatter::new(&mut search.motion);
        let facts = |image: Image| {
            let (base, code) = (image.base(), image.code());
            let mut group = groups[store.body[base] as usize];
            if store.stress_mass.get(base).is_some_and(|&mass| mass > 0.0) {
                group += body_groups;
            }
            let velocity = || Mirrors::reflect_vector(&store.predicted_velocity[base], code);
            ImageFacts {
                position: mirrors.reflect_position(&store.position[base], code),
                id: store.id[base],
                group,
                smoothing_length: store.smoothing_length[base],
                moving: !spare || velocity() != common[group],
            }
        };
        let stresses = &mut self.sweeps.stresses;
        resize(stresses, owned + others.len());
        // Stresses come later: until then the sort works in their memory.
        let scratch = bytemuck::cast_slice_mut(stresses);
        let sequence = &mut search.sequence;
        sequence.build(scratch, owned, (others, below), facts, |place, image| {
            let (base, code) = (image.base(), image.code());
            let record = MotionRecord {
                position: mirrors.reflect_position(&store.position[base], code),
                velocity: Mirrors::reflect_vector(&store.predicted_velocity[base], code),
                volume: store.mass[base] / store.predicted_density[base],
                mass: store.mass[base],
            };
            // SAFETY: each place is emitted once.
            unsafe { *motion.slot(place) = record };
        });
        if self.case.sph.smoothing_length != SmoothingLength::Constant {
            for (group, lengths) in search.lengths.iter_mut().enumerate() {
                lengths.longest = search.sequence.smoothing_lengths()[search.sequence.group(group)]
                    .par_iter()
                    .copied()
                    // same bits in any order: a largest number
                    .reduce(|| 0.0, f64::max);
            }
        }
        search.clusters.build(&search.sequence, &search.lengths);
        self.part_neighbours();
        let (store, search) = (&self.store, &mut self.search);
        if self.contact.has_pairs() {
            let images = search.sequence.images();
            search.foreign.build(
                &search.clusters,
                &search.sequence,
                &search.motion,
                &self.contact.foreign,
                |place| store.body[images[place as usize].base()] as usize,
            );
        }
    }

    /// Puts the store into the canonical order of the last search, so that memory follows space,
    /// unless it nearly is. Results do not depend on it. Returns whether there was such a search.
    pub(super) fn restore_order(&mut self) -> bool {
        let owned = self.store.owned();
        self.order.clear();
        for image in self.search.sequence.images() {
            if image.code() == 0 && image.base() < owned {
                #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
                self.order.push(image.base() as u32);
            }
        }
        let known = self.order.len() == owned;
        let astray = self.order.windows(2).filter(|pair| pair[1] != pair[0] + 1);
        if known && astray.count() > owned / ASTRAY {
            // Stresses are of the last step: their memory is free.
            let scratch = bytemuck::cast_slice_mut(&mut self.sweeps.stresses);
            self.store.keep(&self.order, scratch);
        }
        known
    }
}
