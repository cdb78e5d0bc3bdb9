//! Kinetic energy that comes from nowhere.
//!
//! The sums keep the total energy to rounding whatever happens, also where they are not stable: what
//! goes mad then takes its kinetic energy from an internal energy that falls below all that there is
//! to be had, without a limit. So the total does not tell; this does:
//! `K ≤ G (K₀ + U₀ + Φ₀ + W + H)` with the energies at the start, the largest work W of loads or
//! gravity so far, and H, what bodies hold that begin compressed or stretched. In a sound run K stays
//! below the sum itself, but for heat of the reference state that an expansion may take.

use super::ledger::RunState;
use crate::domain::InitialLayout;
use crate::loads::Loads;
use comm::Comm;
use model::{Body, Case, NumericalLimits};
use numerics::vector::square;
use particles::ParticleStore;
use populate;

/// Energy allowed to particles at rest, over `½ m U²` with the speed U that is natural to the case.
const ROUNDING: f64 = 1e-9;

/// `½ m c² (ρ/ρ₀ − 1)²` of all bodies, and what rounding may do (J). Collective.
pub(crate) fn hidden_energy(case: &Case, comm: &Comm) -> f64 {
    let natural = NumericalLimits::natural_speed(case);
    let of_body = |(body, count): (&Body, &u64)| {
        let material = &case.materials[body.material];
        let (density, reference) = (case.initial_density(body), material.reference_density);
        #[allow(clippy::cast_precision_loss, reason = "an estimate")]
        let volume = match body.lattice.grading {
            _ if case.axisymmetric => {
                populate::rings(case, body) * populate::particle_volume(body, case.dimension)
            }
            None => *count as f64 * populate::particle_volume(body, case.dimension),
            Some(_) => body.shape.volume_above(&case.symmetry, case.dimension),
        };
        let mass = density * volume;
        let strain = density / reference - 1.0;
        let square = strain * strain * material.p_wave_modulus() / reference;
        0.5 * mass * (square + ROUNDING * natural * natural)
    };
    let counts = InitialLayout::counts(case, comm);
    let bodies = case.bodies.iter().zip(&counts);
    let deforming = bodies.filter(|(body, _)| body.rigid.is_none());
    deforming.map(of_body).sum()
}

/// True if the kinetic energy, as of the last totals, can have come from what there was, what has
/// been put in and the `hidden` energy (J), or from `most` times that.
pub(crate) fn is_explained(state: &RunState, hidden: f64, most: f64) -> bool {
    let first = &state.initial;
    let there = first.kinetic_energy
        + first.internal_energy.max(0.0)
        + first.contact_energy.max(0.0)
        + state.work_put_in
        + hidden;
    state.totals.kinetic_energy <= most * there
}

/// Identity of the fastest particle that nobody drives. Collective.
pub(crate) fn fastest(comm: &Comm, particles: &ParticleStore, loads: &Loads) -> u64 {
    let mut best = (u64::MAX, u64::MAX);
    // In a run that blows up, not in every step.
    for i in 0..particles.owned() {
        if loads.has_motions() && loads.is_driven(particles.load[i]) {
            continue;
        }
        // Positive doubles order as their bits, so that their complements order downwards.
        let slowness = !square(&particles.velocity[i]).to_bits();
        best = best.min((slowness, particles.id[i]));
    }
    let mut slowness = [best.0];
    comm.min_u64(&mut slowness);
    let mut id = [if best.0 == slowness[0] {
        best.1
    } else {
        u64::MAX
    }];
    comm.min_u64(&mut id);
    id[0]
}
