//! The conventional formulation: plain sums over pairs.

use rayon::prelude::*;

use super::Formulation;
use super::momentum_sweep::accelerate;
use crate::neighbours::{CHUNKS_AT_ONCE, Chunk, Lists};
use crate::numerics::dispatch::{Vectorised, instructions};
use crate::numerics::kernel::PairScale;
use crate::numerics::lanes::{F64x8, LANES, Lanes};
use crate::particles::{ParticleStore, material_points};
use crate::sph::gradient::VelocityGradient;
use crate::sph::material_update::MaterialUpdate;
use crate::sph::neighbourhood::Sources;
use crate::sph::signal::{SignalSpeed, Signals};
use crate::sph::step::{Side, Step};
use crate::sph::sums::{Sums, sources, with_scale};

/// The conventional formulation.
#[derive(Debug)]
pub struct Conventional;

impl Formulation for Conventional {
    fn rates(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        step: &Step,
    ) {
        let set = instructions();
        let scale = sums.scale;
        let update = &MaterialUpdate::new(material_points!(particles), sums, lists, step.dt);
        let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
        with_scale!(scale, scale => chunks.for_each(|chunk| {
            set.run(GradientChunk { chunk, motion: sources(lists, scale), update });
        }));
    }

    fn forces(
        &mut self,
        sums: &mut Sums,
        particles: &mut ParticleStore,
        lists: &Lists,
        side: Side,
    ) {
        sums.fill_stresses(particles, lists, side);
        sums.terms.show(particles, lists, side);
        let set = sums.terms.set();
        accelerate(sums, (set, &[]), particles, lists, side);
    }
}

impl SignalSpeed for Conventional {
    #[inline(always)]
    fn speed(_: &Signals, _: usize, plain: f64) -> f64 {
        plain
    }
}

/// The first sweep over one task's clusters.
struct GradientChunk<'a, S> {
    chunk: &'a Chunk,
    motion: Sources<'a, S>,
    update: &'a MaterialUpdate<'a>,
}

impl<S: PairScale> Vectorised for GradientChunk<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for (cluster, neighbours, among) in self.chunk.iter() {
            if !among.moving {
                // No relative velocity: the sum would be this, to the bit.
                let none = [F64x8([0.0; LANES]); 9];
                self.update.apply(cluster, &none, neighbours.len());
                continue;
            }
            let gradient = VelocityGradient {
                around: self.motion.around(cluster.receivers, neighbours),
            };
            self.update
                .apply(cluster, &gradient.run::<V>(), neighbours.len());
        }
    }
}
