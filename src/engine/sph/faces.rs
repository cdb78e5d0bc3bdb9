//! Free faces of the bodies that a pressure acts on.

use rayon::prelude::*;

use super::shared::{Sums, sources};
use material::FAILED;
use model::Case;
use numerics::dispatch::{Vectorised, instructions};
use numerics::kernel::PairScale;
use numerics::lanes::Lanes;
use particles::neighbours::{CHUNKS_AT_ONCE, Chunk, Cluster, Groups, Lists};
use particles::{GRAIN, Image, Mirrors, ParticleStore, Scatter, resize};
use sums::face::{Face, FaceCorrection};
use sums::neighbourhood::Sources;
use sums::with_scale;

/// Free faces of the bodies that a pressure acts on.
#[derive(Default)]
pub struct Faces {
    /// By group: whether a pressure acts on a body of it; empty if none acts at all.
    pressed: Vec<bool>,
    /// By body: the same of its group.
    of_body: Vec<bool>,
    /// Matrices `G` of the images.
    corrections: Vec<[f64; 6]>,
}

impl Faces {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case, groups: &Groups) -> Self {
        let loads = &case.loads.pressures;
        let is_pressed = |body: usize| loads.iter().any(|load| load.body == body);
        if loads.is_empty() {
            return Self::default();
        }
        let of_group = |group: usize| groups.members(group).any(is_pressed);
        Self {
            pressed: (0..groups.count()).map(of_group).collect(),
            of_body: (groups.of_body.iter().map(|&group| of_group(group))).collect(),
            corrections: Vec::new(),
        }
    }

    /// True if a pressure acts on any body.
    #[must_use]
    pub fn is_any(&self) -> bool {
        !self.pressed.is_empty()
    }

    /// True if a body needs its neighbours for its faces, even if it rests.
    #[inline]
    #[must_use]
    pub fn has(&self, body: u32) -> bool {
        self.of_body.get(body as usize).is_some_and(|&has| has)
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.pressed.capacity()
            + self.of_body.capacity()
            + size_of::<[f64; 6]>() * self.corrections.capacity()
    }

    /// Finds the matrices of owned particles, before halo particles get them.
    pub(super) fn correct(&self, sums: &Sums, particles: &mut ParticleStore, lists: &Lists) {
        let (damage, body, found) = (
            &particles.damage,
            &particles.body,
            Scatter::new(&mut particles.face_correction),
        );
        let (scale, dimension, instructions) = (sums.scale, sums.dimension, instructions());
        let (images, found, pressed) = (lists.images(), &found, self.pressed.as_slice());
        let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
        with_scale!(scale, scale => chunks.for_each(|chunk| {
            let motion = sources(lists, scale);
            instructions.run(Corrections { chunk, motion, dimension, images, pressed, damage, body, sums, found });
        }));
    }

    /// Finds the faces of owned particles, after halo particles have their matrices.
    pub(super) fn find(&mut self, sums: &Sums, particles: &mut ParticleStore, lists: &Lists) {
        let images = lists.images();
        resize(&mut self.corrections, images.len());
        let all = self
            .corrections
            .par_iter_mut()
            .zip(images)
            .with_min_len(GRAIN);
        all.for_each(|(correction, image)| {
            let own = &particles.face_correction[image.slot()];
            *correction = Mirrors::reflect_symmetric(own, image.mirror_mask());
        });
        let found = &Scatter::new(&mut particles.face);
        let (scale, instructions) = (sums.scale, instructions());
        let (corrections, pressed) = (self.corrections.as_slice(), self.pressed.as_slice());
        let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
        with_scale!(scale, scale => chunks.for_each(|chunk| {
            let motion = sources(lists, scale);
            instructions.run(OfFaces { chunk, motion, images, pressed, corrections, found });
        }));
    }
}

/// The sweep over one task's clusters for the matrices.
struct Corrections<'a, S> {
    chunk: &'a Chunk,
    motion: Sources<'a, S>,
    dimension: usize,
    images: &'a [Image],
    pressed: &'a [bool],
    damage: &'a [f64],
    body: &'a [u32],
    sums: &'a Sums,
    found: &'a Scatter<'a, [f64; 6]>,
}

impl<S: PairScale> Corrections<'_, S> {
    /// Receivers that have failed and bear no shear: bit k is lane k.
    #[inline(always)]
    fn loose(&self, cluster: &Cluster) -> u8 {
        let mut loose = 0;
        for (k, &place) in cluster.valid().iter().enumerate() {
            let i = self.images[place as usize].slot();
            let failed = self.damage.get(i).is_some_and(|&damage| damage >= FAILED);
            let material =
                || &self.sums.materials[self.sums.material_of_body[self.body[i] as usize]];
            loose |= u8::from(failed && !material().failure.options.keeps_shear()) << k;
        }
        loose
    }
}

impl<S: PairScale> Vectorised for Corrections<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for (cluster, neighbours, _) in self.chunk.iter() {
            if !self.pressed[cluster.group] {
                continue;
            }
            let correction = FaceCorrection {
                around: self.motion.around(cluster.receivers, neighbours),
                dimension: self.dimension,
                plain: self.loose(cluster),
            }
            .run::<V>();
            for (k, &place) in cluster.valid().iter().enumerate() {
                let mut own = [0.0; 6];
                for c in 0..6 {
                    own[c] = correction[c].0[k];
                }
                // SAFETY: the particle belongs to this cluster alone, and this thread has the cluster.
                unsafe { *self.found.slot(self.images[place as usize].slot()) = own };
            }
        }
    }
}

/// The sweep over one task's clusters for the faces.
struct OfFaces<'a, S> {
    chunk: &'a Chunk,
    motion: Sources<'a, S>,
    images: &'a [Image],
    pressed: &'a [bool],
    /// Matrices of the images.
    corrections: &'a [[f64; 6]],
    found: &'a Scatter<'a, [f64; 3]>,
}

impl<S: PairScale> Vectorised for OfFaces<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for (cluster, neighbours, _) in self.chunk.iter() {
            if !self.pressed[cluster.group] {
                continue;
            }
            let face = Face {
                around: self.motion.around(cluster.receivers, neighbours),
                corrections: self.corrections,
            }
            .run::<V>();
            for (k, &place) in cluster.valid().iter().enumerate() {
                let own = [face[0].0[k], face[1].0[k], face[2].0[k]];
                // SAFETY: the particle belongs to this cluster alone, and this thread has the cluster.
                unsafe { *self.found.slot(self.images[place as usize].slot()) = own };
            }
        }
    }
}
