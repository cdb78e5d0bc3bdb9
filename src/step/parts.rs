//! Self-contact: the parts that a body has come apart into (theory page "Contact").

use rayon::prelude::*;

use super::search::{GRAIN, Search};
use super::simulation::Simulation;
use crate::comm::Comm;
use crate::domain::{Halo, Mirrors};
use crate::model::Case;
use crate::neighbours::{Kin, Part};
use crate::particles::{HaloPhase, ParticleStore, resize};

/// Steps between two looks at what is still connected.
const EVERY: u64 = 10;
/// Every symmetry plane: at the start nothing is cut off from any.
const ALL_PLANES: u32 = 7;

/// Parts of the images, and the union of what is connected, kept from step to step; empty without
/// self-contact.
#[derive(Debug, Default)]
pub(super) struct Parts {
    /// Whether there is self-contact.
    pub(super) active: bool,
    /// 1 over the distance of folds (1/m), by body; empty without.
    per_fold: Vec<f64>,
    of_images: Vec<Part>,
    /// Places at the start over the distance of folds.
    references: Vec<[f64; 3]>,
    /// Union-find over particles, halo included: parent, and at roots label and planes.
    parents: Vec<u32>,
    labels: Vec<(u64, u32)>,
}

/// Bytes that self-contact takes for each image, beside fields and lists.
pub(super) fn bytes_of_image(case: &Case) -> usize {
    let Some(own) = &case.self_contact else {
        return 0;
    };
    let union = size_of::<u32>() + size_of::<(u64, u32)>();
    let places = if own.folds.is_some() {
        size_of::<[f64; 3]>()
    } else {
        0
    };
    size_of::<Part>() + places + union
}

impl Parts {
    pub(super) fn new(case: &Case) -> Self {
        let folds = case.self_contact.as_ref().and_then(|s| s.folds);
        let bodies = case.bodies.iter().map(|body| body.lattice.spacing);
        Self {
            active: case.self_contact.is_some(),
            per_fold: folds.map_or(Vec::new(), |f| bodies.map(|dp| 1.0 / (f * dp)).collect()),
            ..Self::default()
        }
    }

    pub(super) fn memory(&self) -> usize {
        size_of::<Part>() * self.of_images.capacity()
            + size_of::<[f64; 3]>() * self.references.capacity()
            + 4 * self.parents.capacity()
            + size_of::<(u64, u32)>() * self.labels.capacity()
    }

    /// Reads what the images show.
    fn show(&mut self, search: &Search, store: &ParticleStore, mirrors: &Mirrors) {
        let images = search.sequence.images();
        resize(&mut self.of_images, images.len());
        let parts = self.of_images.par_iter_mut().with_min_len(GRAIN);
        parts.zip(images).for_each(|(part, image)| {
            let i = image.base();
            // Behind a plane that cuts the part stands the part itself.
            let code = u32::from(image.code()) & !store.part_planes[i];
            *part = Part {
                label: store.part[i],
                code: code.into(),
            };
        });
        if self.per_fold.is_empty() {
            return;
        }
        resize(&mut self.references, images.len());
        let references = self.references.par_iter_mut().with_min_len(GRAIN);
        references.zip(images).for_each(|(place, image)| {
            let i = image.base();
            let start = mirrors.reflect_position(&store.reference_position[i], image.code());
            let scale = self.per_fold[store.body[i] as usize];
            *place = start.map(|x| x * scale);
        });
    }

    fn root(&mut self, mut i: u32) -> u32 {
        loop {
            let parent = self.parents[i as usize];
            if parent == i {
                return i;
            }
            let above = self.parents[parent as usize];
            self.parents[i as usize] = above;
            i = above;
        }
    }

    /// Joins what has a particle of this rank within the support of another.
    fn join(&mut self, search: &Search, particles: usize) {
        self.parents.clear();
        self.parents
            .extend(0..u32::try_from(particles).unwrap_or(u32::MAX));
        self.labels.clear();
        self.labels.resize(particles, (u64::MAX, 0));
        let images = search.sequence.images();
        #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
        let base = |place: u32| images[place as usize].base() as u32;
        for chunk in search.clusters.chunks() {
            for (cluster, neighbours, _) in chunk.iter() {
                for &i in &cluster.receivers[..cluster.lanes] {
                    let mut here = self.root(base(i));
                    for &j in neighbours {
                        let code = images[j as usize].code();
                        let there = base(j);
                        if (self.parents[there as usize] == here && code == 0)
                            || !search.in_support(cluster.group, i, j)
                        {
                            continue;
                        }
                        let other = self.root(there);
                        let planes = self.labels[other as usize].1
                            | self.labels[here as usize].1
                            | u32::from(code);
                        let (low, high) = (here.min(other), here.max(other));
                        self.parents[high as usize] = low;
                        self.labels[low as usize].1 = planes;
                        here = low;
                    }
                }
            }
        }
    }

    /// Labels of all ranks' particles. Collective.
    fn label(&mut self, comm: &Comm, halo: &mut Halo, store: &mut ParticleStore) {
        let owned = store.owned();
        let particles = store.part.len();
        store.part.copy_from_slice(&store.id[..particles]);
        // Roots know what their own pairs have found.
        store.part_planes.fill(0);
        loop {
            for i in 0..particles {
                let root = self.root(u32::try_from(i).unwrap_or(u32::MAX)) as usize;
                let label = &mut self.labels[root];
                label.0 = label.0.min(store.part[i]);
                label.1 |= store.part_planes[i];
            }
            let mut changed = false;
            for i in 0..owned {
                let root = self.root(u32::try_from(i).unwrap_or(u32::MAX)) as usize;
                let label = self.labels[root];
                changed |= (store.part[i], store.part_planes[i]) != label;
                (store.part[i], store.part_planes[i]) = label;
            }
            if !comm.any(changed) {
                return;
            }
            halo.post(comm, store, HaloPhase::PARTS);
            halo.finish(store, HaloPhase::PARTS);
        }
    }
}

impl Simulation {
    /// A body begins as one part.
    pub(super) fn begin_parts(store: &mut ParticleStore, i: usize, label: u64) {
        if let Some(part) = store.part.get_mut(i) {
            *part = label;
            store.part_planes[i] = ALL_PLANES;
        }
        if let Some(start) = store.reference_position.get_mut(i) {
            *start = store.position[i];
        }
    }

    /// Takes strangers out of the own lists, before foreign ones are built.
    pub(super) fn part_neighbours(&mut self) {
        if !self.parts.active {
            return;
        }
        let (parts, search) = (&mut self.parts, &mut self.search);
        parts.show(search, &self.store, self.halo.mirrors());
        search.clusters.part(&Kin {
            parts: &parts.of_images,
            references: &parts.references,
        });
    }

    /// Finds out, every few steps, what has come apart: particles of one part that no chain of
    /// neighbours connects. These are out of each other's support, so that no force changes by it.
    /// Collective.
    pub(super) fn find_parts(&mut self, comm: &Comm) {
        if !self.parts.active || !self.state.step.is_multiple_of(EVERY) {
            return;
        }
        let particles = self.store.owned() + self.store.halo();
        self.parts.join(&self.search, particles);
        self.parts.label(comm, &mut self.halo, &mut self.store);
    }
}
