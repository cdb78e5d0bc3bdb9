//! The second sweep over the clusters of a task.

use super::corrected::CorrectedRecord;
use super::from_mirrors::FromMirrors;
use super::momentum::{Forces, Momentum, PairStress, StressRecord, Viscosity};
use super::neighbourhood::Sources;
use super::normalised::{NormalisedRecord, stress_power};
use super::scale::Scale;
use super::step::Side;
use super::terms::{PairTerms, with_terms};
use super::total::TotalRecord;
use crate::with_scale;
use numerics::dispatch::{Vectorised, instructions};
use numerics::kernel::PairScale;
use numerics::lanes::{F64x8, Lanes};
use particles::MirrorForce;
use particles::neighbours::{Chunk, Cluster};
use particles::{Image, Scatter};

/// Inputs and outputs of the second sweep.
pub struct ForceSweep<'a, R> {
    /// Places, velocities and volumes of all particles and images.
    pub motion: Sources<'a, Scale>,
    /// All particles and images, in the order of the lists.
    pub images: &'a [Image],
    /// Odd of those behind symmetry planes.
    pub mirrored: &'a [u8],
    /// Stress records of all particles and images.
    pub stresses: &'a [R],
    /// Coefficients of the artificial viscosity.
    pub viscosity: Viscosity,
    /// The pair terms of the case.
    pub terms: PairTerms<'a>,
    /// Side of the clusters that are swept.
    pub side: Side,
    /// By group: whether other lists than these have its sums.
    pub elsewhere: &'a [bool],
    /// Its target.
    pub target: ForceTarget<'a>,
}

/// Records that the second sweep is compiled for.
pub trait Swept: PairStress {
    /// Sweeps the clusters of a task.
    fn sweep(all: &ForceSweep<Self>, chunk: &Chunk, from_mirrors: &mut FromMirrors);
}

/// All of it is compiled here, whoever calls it.
macro_rules! swept {
    ($($record:ty),+) => {
        $(
            impl Swept for $record {
                fn sweep(all: &ForceSweep<Self>, chunk: &Chunk, from_mirrors: &mut FromMirrors) {
                    with_scale!(all.motion.scale, scale => with_terms!(all.terms.set, TERMS => {
                        instructions().run(MomentumChunk::<_, Self, TERMS> {
                            all,
                            motion: all.motion.with(scale),
                            chunk,
                            from_mirrors,
                        });
                    }));
                }
            }
        )+
    };
}
swept!(StressRecord, CorrectedRecord, NormalisedRecord, TotalRecord);

/// Target of the second sweep.
pub struct ForceTarget<'a> {
    /// Mass (kg).
    pub mass: &'a [f64],
    /// Acceleration (m/s²).
    pub acceleration: Scatter<'a, [f64; 3]>,
    /// Rate of the specific energy (W/kg).
    pub power: Scatter<'a, f64>,
    /// The largest speed of approach (m/s).
    pub approach: Scatter<'a, f64>,
    /// Correction of the drift by XSPH (m/s), if the case has it.
    pub correction: Option<Scatter<'a, [f64; 3]>>,
    /// Inputs of the power of corrected stresses.
    pub stress_power: StressPower<'a>,
}

impl ForceTarget<'_> {
    #[inline(always)]
    fn store<R: PairStress, const TERMS: bool>(
        &self,
        images: &[Image],
        cluster: &Cluster,
        forces: &Forces,
    ) {
        for k in 0..cluster.lanes {
            let i = images[cluster.receivers[k] as usize].slot();
            // SAFETY: particle `i` belongs to this cluster alone, and this thread has the cluster.
            unsafe {
                *self.acceleration.slot(i) = std::array::from_fn(|a| forces.acceleration[a].0[k]);
                *self.power.slot(i) = forces.power.0[k];
                *self.approach.slot(i) = forces.approach.0[k];
                if R::CORRECTED {
                    *self.power.slot(i) += self.stress_power.of(i);
                }
                if TERMS && let Some(correction) = &self.correction {
                    *correction.slot(i) = std::array::from_fn(|a| forces.correction[a].0[k]);
                }
            }
        }
    }
}

/// Fields of all particles that give the power that stresses put into heat.
pub struct StressPower<'a> {
    /// Pressure (Pa).
    pub pressure: &'a [f64],
    /// Deviatoric stress xx, yy, zz, xy, xz, yz (Pa).
    pub deviatoric_stress: &'a [[f64; 6]],
    /// Velocity gradient, row by row (1/s).
    pub velocity_gradient: &'a [[f64; 9]],
    /// Predicted density (kg/m³).
    pub predicted_density: &'a [f64],
}

impl StressPower<'_> {
    /// Of owned particle `i` (W/kg).
    #[inline(always)]
    fn of(&self, i: usize) -> f64 {
        stress_power(
            self.pressure[i],
            &self.deviatoric_stress[i],
            &self.velocity_gradient[i],
            self.predicted_density[i],
        )
    }
}

/// The second sweep over one task's clusters.
struct MomentumChunk<'a, S, R, const TERMS: bool> {
    all: &'a ForceSweep<'a, R>,
    motion: Sources<'a, S>,
    chunk: &'a Chunk,
    from_mirrors: &'a mut FromMirrors,
}

impl<S: PairScale, R: PairStress, const TERMS: bool> Vectorised for MomentumChunk<'_, S, R, TERMS> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        let ForceSweep {
            images,
            mirrored,
            stresses,
            viscosity,
            terms,
            side,
            elsewhere,
            target,
            ..
        } = self.all;
        let FromMirrors {
            indices,
            forces: from_mirrors,
        } = self.from_mirrors;
        let chunk = self.chunk.iter().enumerate();
        for (number, (cluster, neighbours, among)) in
            chunk.filter(|(_, (_, _, among))| side.takes(among.halo))
        {
            if elsewhere[cluster.group] {
                continue;
            }
            let free = |&j: &u32| stresses[j as usize].is_free();
            if among.resting || !among.moving && neighbours.iter().all(free) {
                target.store::<R, TERMS>(images, cluster, &Forces::NONE);
                continue;
            }
            // With all neighbours, and where there are images with these alone: in a loop, so that the sum is
            // compiled once.
            for alone in [false, true] {
                let neighbours = if alone {
                    let is_image = |&j: &u32| mirrored[j as usize] & 1 == 1;
                    indices.clear();
                    indices.extend(neighbours.iter().copied().filter(is_image));
                    &*indices
                } else {
                    neighbours
                };
                let mut around = self.motion.around(cluster.receivers, neighbours);
                if !alone {
                    around = around.close(self.chunk.close(number));
                }
                let sums = Momentum::<S, R, TERMS> {
                    around,
                    stresses,
                    viscosity: *viscosity,
                    terms: *terms,
                };
                let forces = sums.run::<V>();
                if alone {
                    let couple = R::couple::<V, S>(&around, stresses);
                    push_forces(
                        from_mirrors,
                        images,
                        target.mass,
                        cluster,
                        (&forces, &couple),
                    );
                } else {
                    target.store::<R, TERMS>(images, cluster, &forces);
                }
                if !among.mirrors {
                    break;
                }
            }
        }
    }
}

/// Keeps what images do to the receivers of a cluster: forces and torques.
#[inline(always)]
fn push_forces(
    from_mirrors: &mut Vec<MirrorForce>,
    images: &[Image],
    mass: &[f64],
    cluster: &Cluster,
    (forces, couple): (&Forces, &[F64x8; 3]),
) {
    for k in 0..cluster.lanes {
        let i = images[cluster.receivers[k] as usize].slot();
        let force = |a: usize| mass[i] * forces.acceleration[a].0[k];
        from_mirrors.push(MirrorForce {
            particle: i,
            force: [force(0), force(1), force(2)],
            couple: [couple[0].0[k], couple[1].0[k], couple[2].0[k]],
        });
    }
}
