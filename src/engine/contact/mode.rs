//! Modes of contact: what each of them says of a pair of particles, and what is done with it in the
//! same way for all.

use rayon::prelude::*;

use super::ContactTable;
use super::force::{ContactStress, Receiver, TaskForces};
use super::pair::{Listed, Pair};
use super::resistance::{NormalLoad, PairFriction};
use super::view::{ContactParticle, ContactView, Separation};
use model::{ContactClass, contact_modes};
use particles::neighbours::{CHUNKS_AT_ONCE, Chunk, Lists, PairList};
use particles::{GRAIN, ParticleStore, empty};

/// A mode of contact, in a file of its own and listed in `contact_modes!`.
pub(crate) trait Mode: Listed + Sized {
    /// Measurement of a particle before the forces.
    type Measured: Send + Sync;
    /// Values of a particle that its forces read.
    type Side: Copy;

    /// Measures before the forces, and stores what these read. `found` is kept from step to step.
    fn measure(_found: &mut MeasuredChunks<Self>, _scene: &mut Scene) {}

    /// Measures for the first time, before any forces, what the start of a case is to be forgiven;
    /// gives the number of particles of which not all can be.
    fn begin(_found: &mut MeasuredChunks<Self>, _scene: &mut Scene) -> i64 {
        0
    }

    /// Values of a particle that forces read.
    fn side(view: &ContactView, particle: &ContactParticle) -> Self::Side;

    /// Force of a pair on its first particle, if any; adds to the stiffness for the time step (N/m)
    /// of this particle.
    fn force(pair: &ParticlePair<Self>, stiffness: &mut f64) -> Option<PairForce>;

    /// Adds what friction and damping of the receiver `i` rest on: half of each force, if not said
    /// otherwise.
    fn normal_load(
        view: &ContactView,
        i: &ContactParticle,
        neighbours: &[u32],
        load: &mut NormalLoad,
    ) {
        let here = Self::side(view, i);
        for (_, j) in view.others(i, neighbours) {
            let pair = ParticlePair::<Self>::new(view, [i, &j], here);
            if !pair.constants.friction.is_any() {
                continue;
            }
            if let Some(PairForce { force, loads, .. }) = Self::force(&pair, &mut 0.0) {
                let mut force = force.map(|f| 0.5 * f);
                view.mirror(&mut force);
                load.add(pair.constants, [i, &j], loads[0], &force);
                load.face(1.0, &force);
            }
        }
    }
}

/// Measurements of a mode, chunk by chunk.
pub(crate) type MeasuredChunks<M> = Vec<Vec<<M as Mode>::Measured>>;

/// Input of the measurements of a mode, after a step of `dt` (s).
pub(crate) struct Scene<'a> {
    pub particles: &'a mut ParticleStore,
    pub lists: &'a Lists,
    pub table: &'a ContactTable,
    pub dt: f64,
}

impl Scene<'_> {
    pub fn view(&self) -> ContactView<'_> {
        ContactView::new(self.particles, self.lists, self.table, self.dt)
    }
}

/// A particle and a foreign neighbour.
pub(crate) struct ParticlePair<'a, M: Mode> {
    pub view: &'a ContactView<'a>,
    pub i: &'a ContactParticle,
    pub j: &'a ContactParticle,
    pub separation: Separation,
    pub constants: &'a Pair,
    /// Factors of the stiffness of both.
    pub stiffening: [f64; 2],
    /// Constants of the mode.
    pub own: &'a M::Pair,
    pub here: M::Side,
    pub there: M::Side,
}

/// Force of a pair on its first particle.
pub(crate) struct PairForce {
    /// Force of the energy, and friction (N).
    pub force: [f64; 3],
    /// Force of the viscosity of the contact along the line between the two (N): positive pushes i
    /// away from j.
    pub drag: f64,
    /// Its half of the energy (J).
    pub energy: f64,
    /// Load of friction from the side of each (N).
    pub loads: [f64; 2],
}

impl PairForce {
    /// Adds what friction and damping of the pair do.
    #[inline(always)]
    fn resist(&mut self, friction: &PairFriction) {
        for a in 0..3 {
            self.force[a] += friction.force[a];
        }
        self.energy += friction.energy;
    }
}

impl<'a, M: Mode> ParticlePair<'a, M> {
    #[inline(always)]
    pub fn new(view: &'a ContactView, [i, j]: [&'a ContactParticle; 2], here: M::Side) -> Self {
        Self {
            view,
            i,
            j,
            separation: Separation::between(i, j),
            constants: view.table.pair(i.size_class, j.size_class),
            stiffening: [view.stiffening(i), view.stiffening(j)],
            own: view.table.own::<M>(i.size_class, j.size_class),
            here,
            there: M::side(view, j),
        }
    }

    /// Mean of both factors of the stiffness: that of the energy which each side has half of.
    #[inline(always)]
    pub fn mean_stiffening(&self) -> f64 {
        0.5 * (self.stiffening[0] + self.stiffening[1])
    }

    /// Half of the pair's energy with its mean factor to that of this side.
    #[inline(always)]
    pub fn own_share(&self) -> f64 {
        self.stiffening[0] / self.mean_stiffening()
    }

    /// A force of `magnitude` (N) along the line between the two, or the part of it along the
    /// normal of the surface between them.
    #[inline(always)]
    pub fn along(&self, magnitude: f64, normal: bool) -> [f64; 3] {
        if normal {
            let normal = self.view.normal(self.i, self.j);
            self.separation.along_normal(magnitude, normal)
        } else {
            self.separation.along(magnitude)
        }
    }
}

impl TaskForces {
    /// Adds what one mode does to receivers with their foreign neighbours, with `FRICTION` friction
    /// and damping too.
    fn add_mode<'l, M: Mode, const FRICTION: bool>(
        &mut self,
        view: &ContactView,
        list: impl Iterator<Item = (u32, &'l [u32])>,
    ) {
        for (index, neighbours) in list {
            let i = view.particle(index);
            let here = M::side(view, &i);
            let rate = view.stiffening_rate(&i);
            let mut on = Receiver::new(&i, neighbours.len(), &mut self.by_body);
            let mut friction = FRICTION.then(|| PairFriction::of(view, &i));
            for (_, j) in view.others(&i, neighbours) {
                let pair = ParticlePair::<M>::new(view, [&i, &j], here);
                on.meet(&j, &pair.separation, pair.constants);
                let Some(mut exerted) = M::force(&pair, &mut on.sum.stiffness) else {
                    continue;
                };
                let mut heat = -rate * exerted.energy;
                if let Some(friction) = &mut friction {
                    friction.pair(view, [&i, &j], exerted.loads);
                    exerted.resist(friction);
                    heat += friction.heat;
                }
                view.mirror(&mut exerted.force);
                on.add(&j, &exerted.force, exerted.energy, heat);
                if exerted.drag > 0.0 {
                    let mut drag = pair.separation.along(exerted.drag);
                    view.mirror(&mut drag);
                    on.brake(&j, (&pair.separation, &drag), exerted.drag, pair.constants);
                }
            }
            if let Some(friction) = friction {
                on.sum.stiffness += friction.stiffness;
                on.sum.dashpot += friction.dashpot;
            }
            let sum = on.sum;
            self.particles.push(sum);
        }
    }
}

/// Stress by forces of one mode in a receiver: half of each pair's line is its side's.
fn stress_of_mode<M: Mode>(
    view: &ContactView,
    i: &ContactParticle,
    neighbours: &[u32],
    with_friction: bool,
) -> ContactStress {
    let here = M::side(view, i);
    let mut friction = with_friction.then(|| PairFriction::of(view, i));
    let mut carried = ContactStress::default();
    for (_, j) in view.others(i, neighbours) {
        let pair = ParticlePair::<M>::new(view, [i, &j], here);
        if let Some(mut exerted) = M::force(&pair, &mut 0.0) {
            let press = exerted.force;
            if let Some(friction) = &mut friction {
                friction.pair(view, [i, &j], exerted.loads);
                exerted.resist(friction);
            }
            let arm = pair.separation.r.map(|x| 0.5 * x);
            carried.add(&exerted.force, &press, &arm);
        }
    }
    if view.table.rings {
        carried.mirror();
    }
    carried
}

/// Sets all elements, on all threads.
pub(super) fn fill<T: Copy + Send + Sync>(values: &mut [T], value: T) {
    values
        .par_chunks_mut(16 * GRAIN)
        .for_each(|chunk| chunk.fill(value));
}

/// Calls `measure` for each chunk with the pairs of a class and the lists of the own body.
pub(super) fn for_each_chunk<T: Send>(
    found: &mut Vec<Vec<T>>,
    lists: &Lists,
    class: ContactClass,
    measure: impl Fn(&mut Vec<T>, &PairList, &Chunk) + Sync,
) {
    found.resize_with(lists.foreign().len(), Vec::new);
    found
        .par_iter_mut()
        .zip(lists.foreign())
        .zip(lists.chunks())
        .with_max_len(CHUNKS_AT_ONCE)
        .for_each(|((found, foreign), own)| {
            empty(found);
            measure(found, foreign.of(class), own);
        });
}

macro_rules! dispatch {
    ($($name:ident: $Mode:ident,)+) => {
        /// Measurements of all modes, kept from step to step.
        #[derive(Default)]
        pub(super) struct Measurements {
            $($name: MeasuredChunks<model::$Mode>,)+
        }

        impl Measurements {
            pub fn measure(&mut self, scene: &mut Scene) {
                $(<model::$Mode as Mode>::measure(&mut self.$name, scene);)+
            }

            pub fn begin(&mut self, scene: &mut Scene) -> i64 {
                0 $(+ <model::$Mode as Mode>::begin(&mut self.$name, scene))+
            }

            pub fn memory(&self) -> usize {
                0 $(+ memory(&self.$name))+
            }
        }

        impl TaskForces {
            /// Adds what contact of a class does to receivers with their foreign neighbours, with
            /// `FRICTION` friction and damping too.
            pub fn add<'l, const FRICTION: bool>(
                &mut self,
                view: &ContactView,
                class: ContactClass,
                list: impl Iterator<Item = (u32, &'l [u32])>,
            ) {
                match class {
                    $(ContactClass::$Mode => {
                        self.add_mode::<model::$Mode, FRICTION>(view, list);
                    })+
                }
            }
        }

        /// Stress that forces of a class carry through the receiver `i`, with friction and damping
        /// if there are any.
        pub(super) fn stress_of(
            view: &ContactView,
            class: ContactClass,
            i: &ContactParticle,
            neighbours: &[u32],
            friction: bool,
        ) -> ContactStress {
            match class {
                $(ContactClass::$Mode => {
                    stress_of_mode::<model::$Mode>(view, i, neighbours, friction)
                })+
            }
        }

        /// Load of friction and damping of the receiver `i`, given its neighbours by class.
        pub(super) fn normal_load(
            view: &ContactView,
            i: &ContactParticle,
            neighbours: &[&[u32]; ContactClass::COUNT],
        ) -> NormalLoad {
            let mut load = NormalLoad::default();
            $(
                let of_mode = neighbours[ContactClass::$Mode as usize];
                <model::$Mode as Mode>::normal_load(view, i, of_mode, &mut load);
            )+
            load
        }
    };
}
contact_modes!(dispatch);

fn memory<T>(found: &[Vec<T>]) -> usize {
    let chunks = found.iter().map(Vec::capacity).sum::<usize>();
    size_of_val(found) + size_of::<T>() * chunks
}
