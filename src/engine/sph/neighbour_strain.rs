//! Plastic strains of the neighbours, for materials that soften where deformation localises.

use rayon::prelude::*;

use super::shared::{Sums, sources};
use material::FAILED;
use numerics::dispatch::{Vectorised, instructions};
use numerics::kernel::PairScale;
use numerics::lanes::Lanes;
use particles::neighbours::{CHUNKS_AT_ONCE, Chunk, Lists};
use particles::{GRAIN, Image, ParticleStore, Scatter, resize};
use sums::neighbour_mean::NeighbourMean;
use sums::neighbourhood::Sources;
use sums::with_scale;

/// Finds the mean plastic strain of the neighbours of owned particles that have flowed, at the beginning of a step; zero of
/// others. `strains` is memory for that of all images.
pub(super) fn find(
    strains: &mut Vec<f64>,
    sums: &Sums,
    particles: &mut ParticleStore,
    lists: &Lists,
) {
    if particles.neighbour_strain.is_empty() {
        return;
    }
    let images = lists.images();
    resize(strains, images.len());
    let all = strains.par_iter_mut().zip(images).with_min_len(GRAIN);
    all.for_each(|(strain, image)| {
        let failed = particles.damage[image.slot()] >= FAILED;
        let own = particles.plastic_strain[image.slot()];
        *strain = if failed { f64::INFINITY } else { own };
    });
    let (strains, scale, instructions) = (&*strains, sums.scale, instructions());
    let dimension = sums.dimension;
    let found = &Scatter::new(&mut particles.neighbour_strain);
    let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
    with_scale!(scale, scale => chunks.for_each(|chunk| {
        let (motion, elsewhere) = (sources(lists, scale), &lists.elsewhere);
        instructions.run(Means { chunk, motion, dimension, elsewhere, images, strains, found });
    }));
}

/// The sweep over one task's clusters.
struct Means<'a, S> {
    chunk: &'a Chunk,
    motion: Sources<'a, S>,
    dimension: usize,
    /// By group: whether other lists have its sums.
    elsewhere: &'a [bool],
    images: &'a [Image],
    /// Plastic strains of the images.
    strains: &'a [f64],
    found: &'a Scatter<'a, f64>,
}

impl<S: PairScale> Vectorised for Means<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for (cluster, neighbours, _) in self.chunk.iter() {
            let flowed = |&place: &u32| self.strains[place as usize] > 0.0;
            if self.elsewhere[cluster.group] {
                continue;
            }
            let mean = if cluster.valid().iter().any(flowed) {
                let around = self.motion.around(cluster.receivers, neighbours);
                let values = self.strains;
                NeighbourMean {
                    around,
                    values,
                    dimension: self.dimension,
                }
                .run::<V>()
                .0
            } else {
                [0.0; numerics::lanes::LANES]
            };
            for (place, mean) in cluster.valid().iter().zip(mean) {
                // Whether others of the cluster have flowed depends on ranks.
                let mean = if flowed(place) { mean } else { 0.0 };
                // SAFETY: the particle belongs to this cluster alone, and this thread has the cluster.
                unsafe { *self.found.slot(self.images[*place as usize].slot()) = mean };
            }
        }
    }
}
