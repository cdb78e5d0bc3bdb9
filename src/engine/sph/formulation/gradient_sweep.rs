//! The first sweep of the formulations whose stress stands at the particles: velocity gradients,
//! and the material's answer to them.

use rayon::prelude::*;

use crate::sph::material_update::{MaterialUpdate, Show};
use crate::sph::shared::{Sums, sources};
use numerics::dispatch::{Vectorised, instructions};
use numerics::kernel::PairScale;
use numerics::lanes::{F64x8, Lanes};
use particles::neighbours::{Among, CHUNKS_AT_ONCE, Chunk, Cluster, Lists};
use particles::{MaterialPoints, Records};
use sums::neighbourhood::{Neighbourhood, Sources};
use sums::step::Step;
use sums::with_scale;

/// Velocity gradients of a formulation.
pub(super) trait Gradient: Sync {
    /// Type that shows the stresses of a cluster.
    type Show<'a, S: PairScale>: Show
    where
        Self: 'a;

    /// Velocity gradients (1/s, row-major) of the receivers of a cluster, `around` which its
    /// neighbours stand, and what is to show their stresses; `failed` tells which receivers had
    /// failed before this step (bit k is lane k).
    fn of<'a, V: Lanes, S: PairScale>(
        &'a self,
        cluster: &Cluster,
        among: Among,
        around: Neighbourhood<'a, S>,
        failed: impl FnOnce() -> u8,
    ) -> ([F64x8; 9], Self::Show<'a, S>);

    /// Shows at a place a particle that rests, of this density (kg/m³) and sound speed (m/s). Nothing rests in forms
    /// whose sums of it need neighbours.
    ///
    /// # Safety
    /// No other thread may read or write what belongs to the place.
    unsafe fn show_resting(&self, _place: usize, _state: [f64; 2]) {}
}

/// The sweep over all clusters, after a step.
pub(super) fn strain<G: Gradient>(
    gradient: &G,
    sums: &Sums,
    points: (MaterialPoints, Records),
    lists: &Lists,
    step: &Step,
) {
    let instructions = instructions();
    let scale = sums.scale;
    let update = &MaterialUpdate::new(points, sums, lists, step);
    let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
    with_scale!(scale, scale => chunks.for_each(|chunk| {
        let motion = sources(lists, scale);
        let elsewhere = &lists.elsewhere;
        instructions.run(GradientChunk { chunk, motion, gradient, update, elsewhere });
    }));
}

/// The sweep over one task's clusters.
struct GradientChunk<'a, S, G> {
    chunk: &'a Chunk,
    motion: Sources<'a, S>,
    gradient: &'a G,
    update: &'a MaterialUpdate<'a>,
    /// By group: whether other lists have its sums.
    elsewhere: &'a [bool],
}

impl<S: PairScale, G: Gradient> Vectorised for GradientChunk<'_, S, G> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        for (number, (cluster, neighbours, among)) in self.chunk.iter().enumerate() {
            if self.elsewhere[cluster.group] {
                continue;
            }
            let update = self.update;
            if among.resting {
                // SAFETY: the places belong to this cluster alone.
                let show = |place, state| unsafe { self.gradient.show_resting(place, state) };
                update.rest(cluster, show);
                continue;
            }
            let around = self.motion.around(cluster.receivers, neighbours);
            let around = around.close(self.chunk.close(number));
            let loose = || update.loose(cluster);
            let (gradient, show) = self.gradient.of::<V, S>(cluster, among, around, loose);
            update.apply::<V>(cluster, &gradient, neighbours.len(), &show);
        }
    }
}
