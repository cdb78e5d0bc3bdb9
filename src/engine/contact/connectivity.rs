//! Self-contact: the parts that a body has come apart into (theory page "Contact").

use rayon::prelude::*;

use crate::fragments::{Labels, Members, Sets};
use model::Case;
use particles::Mirrors;
use particles::neighbours::{Fragment, Lists, Membership};
use particles::{GRAIN, Image, ParticleStore, resize};

/// Steps between two looks at what is still connected.
pub(crate) const EVERY: u64 = 10;
/// Particles that are asked what rests.
const SAMPLE: usize = 256;
/// Every symmetry plane: at the start nothing is cut off from any.
const ALL_PLANES: u32 = 7;

/// Fragments of the images, kept from step to step; empty without self-contact.
#[derive(Debug, Default)]
pub struct Connectivity {
    /// True if there is self-contact.
    is_active: bool,
    /// 1 over the distance of folds (1/m), by body; empty without.
    per_fold: Vec<f64>,
    of_images: Vec<Fragment>,
    /// Places at the start over the distance of folds.
    references: Vec<[f64; 3]>,
    /// By body: the label of most of what rests of it on this rank, as a sample tells, and its lead in that.
    at_rest: Vec<(u64, u32)>,
}

impl Connectivity {
    /// Bytes that self-contact takes for each image, beside fields and lists.
    #[must_use]
    pub fn bytes_of_image(case: &Case) -> usize {
        let Some(own) = &case.self_contact else {
            return 0;
        };
        let indices = if own.folds.is_some() {
            size_of::<[f64; 3]>()
        } else {
            0
        };
        size_of::<Fragment>() + indices + Labels::BYTES
    }

    pub(crate) fn new(case: &Case) -> Self {
        let folds = case.self_contact.as_ref().and_then(|s| s.folds);
        let bodies = case.bodies.iter().map(|body| body.lattice.coarsest());
        Self {
            is_active: case.self_contact.is_some(),
            at_rest: vec![(0, 0); case.bodies.len()],
            per_fold: folds.map_or(Vec::new(), |f| bodies.map(|dp| 1.0 / (f * dp)).collect()),
            ..Self::default()
        }
    }

    pub(crate) fn memory(&self) -> usize {
        size_of::<Fragment>() * self.of_images.capacity()
            + size_of::<[f64; 3]>() * self.references.capacity()
    }

    /// Reads what the images show.
    fn show(&mut self, lists: &Lists, particles: &ParticleStore, mirrors: &Mirrors) {
        let images = lists.images();
        resize(&mut self.of_images, images.len());
        let fragments = self.of_images.par_iter_mut().with_min_len(GRAIN);
        fragments.zip(images).for_each(|(part, image)| {
            let i = image.slot();
            // Behind a plane that cuts the part stands the part itself.
            let mirror_mask = u32::from(image.mirror_mask().bits()) & !particles.part_planes[i];
            *part = Fragment {
                label: particles.part[i],
                mirror_mask: mirror_mask.into(),
            };
        });
        if self.per_fold.is_empty() {
            return;
        }
        resize(&mut self.references, images.len());
        let references = self.references.par_iter_mut().with_min_len(GRAIN);
        references.zip(images).for_each(|(index, image)| {
            let i = image.slot();
            let start =
                mirrors.reflect_position(&particles.reference_position[i], image.mirror_mask());
            let scale = self.per_fold[particles.body[i] as usize];
            *index = start.map(|x| x * scale);
        });
    }

    /// Links what has a particle of this rank within the support of another: particles of one
    /// fragment that no chain of neighbours connects have come apart. These are out of each other's
    /// support, so that no force changes by it.
    pub(crate) fn link(lists: &Lists, sets: &Sets) {
        let images = lists.images();
        #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
        let slot = |index: u32| images[index as usize].slot() as u32;
        lists.chunks().par_iter().for_each(|chunk| {
            for (cluster, neighbours, _) in chunk.iter() {
                let own = cluster.receivers.map(slot);
                let mut here = own.map(|i| sets.root(i));
                for &j in neighbours {
                    let mirror_mask = images[j as usize].mirror_mask();
                    let mut there = sets.root(slot(j));
                    for (k, &i) in cluster.valid().iter().enumerate() {
                        // Roots may be old, which costs a look more.
                        if (there == here[k] && mirror_mask.is_own())
                            || !lists.in_support(cluster.group, i, j)
                        {
                            continue;
                        }
                        sets.mark(own[k], mirror_mask.bits().into());
                        sets.join(here[k], there);
                        here[k] = sets.root(own[k]);
                        there = here[k];
                    }
                }
            }
        });
    }

    /// Labels owned particles by the sets that links have joined.
    pub(crate) fn set_labels(members: &Members, particles: &mut ParticleStore) {
        let owned = particles.owned();
        let parts = particles.part[..owned].par_iter_mut();
        let parts = parts.zip(&mut particles.part_planes[..owned]);
        parts.enumerate().for_each(|(i, (part, planes))| {
            let member = members.of(i);
            (*part, *planes) = (member.label, member.planes);
        });
    }

    /// A body begins as one fragment.
    pub(crate) fn begin(particles: &mut ParticleStore, i: usize, label: u64) {
        if let Some(part) = particles.part.get_mut(i) {
            *part = label;
            particles.part_planes[i] = ALL_PLANES;
        }
        if let Some(start) = particles.reference_position.get_mut(i) {
            *start = particles.position[i];
        }
    }

    /// Takes strangers out of the own lists, before foreign ones are built.
    pub(crate) fn separate(
        &mut self,
        particles: &ParticleStore,
        lists: &mut Lists,
        mirrors: &Mirrors,
    ) {
        if !self.is_active {
            return;
        }
        self.show(lists, particles, mirrors);
        lists.separate(&Membership {
            fragments: &self.of_images,
            references: &self.references,
        });
    }

    /// Asks some particles, `rests` tells which of them rest, of which fragment that is. Only lists that are
    /// spared hang on it, no result.
    pub(crate) fn sample(&mut self, particles: &ParticleStore, rests: impl Fn(usize) -> bool) {
        if !self.is_active {
            return;
        }
        self.at_rest.fill((0, 0));
        let owned = particles.owned();
        let every = owned.div_ceil(SAMPLE).max(1);
        // The label of more than half of them, if there is one (Boyer & Moore 1991).
        for i in (0..SAMPLE).map(|k| k * every).take_while(|&i| i < owned) {
            if rests(i) {
                let (label, lead) = &mut self.at_rest[particles.body[i] as usize];
                if *label == particles.part[i] {
                    *lead += 1;
                } else if *lead == 0 {
                    (*label, *lead) = (particles.part[i], 1);
                } else {
                    *lead -= 1;
                }
            }
        }
    }

    /// True if an image of an owned particle that rests is no stranger to what else rests of its body.
    pub(crate) fn lets_rest(&self, particles: &ParticleStore, image: Image) -> bool {
        let (i, mirror_mask) = (image.slot(), u32::from(image.mirror_mask().bits()));
        !self.is_active
            || particles.part[i] == self.at_rest[particles.body[i] as usize].0
                && mirror_mask & !particles.part_planes[i] == 0
    }

    /// True if there is self-contact.
    pub(crate) fn is_active(&self) -> bool {
        self.is_active
    }

    /// True if pieces are to be labelled at a step, from lists of all active particles.
    pub(crate) fn is_due(&self, step: u64) -> bool {
        self.is_active && step.is_multiple_of(EVERY)
    }
}
