//! Formulations of the SPH sums: one file each.

mod conventional;
mod corrected;
mod gradient_sweep;
mod momentum_sweep;
mod normalised;
mod stress_points;
mod stresses;
mod total;

pub use conventional::Conventional;
pub use corrected::Corrected;
pub use normalised::Normalised;
pub use stress_points::StressPoints;
pub use total::TotalBodies;

use super::shared::Sums;
use super::signal::SignalSpeed;
use crate::domain::Payload;
use particles::ParticleStore;
use particles::neighbours::Lists;
use sums::step::{Side, Step};

/// A formulation: how velocities strain matter, and how its stress moves it.
pub(super) trait Formulation: SignalSpeed {
    /// The first sweep: strain rates, density, stress and what else the material answers, after the
    /// step; owned particles.
    fn rates(&mut self, sums: &mut Sums, particles: &mut ParticleStore, lists: &Lists, step: &Step);

    /// The second sweep: accelerations by stress and viscosity, and the power they put into heat,
    /// of the receivers of a side.
    fn forces(&mut self, sums: &mut Sums, particles: &mut ParticleStore, lists: &Lists, side: Side);

    /// The drift in a step `dt` (s) that velocities and `gravity` (m/s²) do not tell.
    fn drift(&self, _particles: &mut ParticleStore, _dt: f64, _gravity: &[f64; 3]) {}

    /// Data of halo particles beside fields that the second sweep needs, if any.
    fn payload(&mut self) -> Option<&mut dyn Payload> {
        None
    }

    /// Memory for so many images that is free until [`Self::rates`], in words.
    fn scratch(&mut self, images: usize) -> &mut [u64];

    /// Bytes allocated.
    fn memory(&self) -> usize;
}
