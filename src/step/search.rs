//! From owned and halo particles to sorted images, their records and neighbour lists.

use rayon::prelude::*;

use super::simulation::Simulation;
use crate::domain::Mirrors;
use crate::neighbours::{ClusterLists, ColumnGrid, ForeignLists, ImageFacts, Sequence};
use crate::sph::gradient::MotionRecord;

/// The sequence of images, their motion records and the lists, kept from step to step.
pub struct Search {
    pub(super) sequence: Sequence,
    pub(super) motion: Vec<MotionRecord>,
    pub(super) clusters: ClusterLists,
    pub(super) foreign: ForeignLists,
    reach: Vec<f64>,
}

impl Search {
    pub(super) fn new(grids: Vec<ColumnGrid>) -> Self {
        Self {
            reach: vec![0.0; grids.len()],
            sequence: Sequence::new(grids),
            motion: Vec::new(),
            clusters: ClusterLists::default(),
            foreign: ForeignLists::default(),
        }
    }

    pub(super) fn memory(&self) -> usize {
        self.sequence.memory()
            + self.motion.capacity() * size_of::<MotionRecord>()
            + self.clusters.memory()
            + self.foreign.memory()
    }
}

/// Elements that a task handles at least.
pub(super) const GRAIN: usize = 1024;

impl Simulation {
    pub(super) fn find_neighbours(&mut self) {
        let (store, mirrors) = (&self.store, self.halo.mirrors());
        let groups = &self.contact.groups;
        let search = &mut self.search;
        search.sequence.build(self.halo.images(), |image| {
            let base = image.base();
            ImageFacts {
                position: mirrors.reflect_position(&store.position[base], image.code()),
                id: store.id[base],
                group: groups[store.body[base] as usize],
                smoothing_length: store.smoothing_length[base],
            }
        });
        let blank = MotionRecord {
            position: [0.0; 3],
            velocity: [0.0; 3],
            volume: 0.0,
            smoothing_length: 0.0,
        };
        search.motion.resize(search.sequence.images().len(), blank);
        search
            .motion
            .par_iter_mut()
            .zip(search.sequence.images())
            .with_min_len(GRAIN)
            .for_each(|(record, image)| {
                let (base, code) = (image.base(), image.code());
                *record = MotionRecord {
                    position: mirrors.reflect_position(&store.position[base], code),
                    velocity: Mirrors::reflect_vector(&store.predicted_velocity[base], code),
                    volume: store.mass[base] / store.predicted_density[base],
                    smoothing_length: store.smoothing_length[base],
                };
            });
        for group in 0..search.sequence.groups() {
            search.reach[group] = search.motion[search.sequence.group(group)]
                .iter()
                .fold(0.0, |most, record| f64::max(most, record.smoothing_length));
        }
        search
            .clusters
            .build(&search.sequence, store.owned(), &search.reach);
        if self.contact.is_active() {
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

    /// Puts the store into the canonical order of the last search, so that memory follows space.
    /// Results do not depend on it.
    pub(super) fn restore_order(&mut self) {
        let owned = self.store.owned();
        self.order.clear();
        for image in self.search.sequence.images() {
            if image.code() == 0 && image.base() < owned {
                #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
                self.order.push(image.base() as u32);
            }
        }
        if self.order.len() == owned {
            self.store.keep(&self.order, &mut self.scratch);
        }
    }
}
