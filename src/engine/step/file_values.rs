//! Values of particles from files, beside velocity, density, energy and plastic strain.

use model::{Body, Quantity};
use particles::ParticleStore;

/// Gives the particle at place `i` of the store the values of row `index` of the file of its body.
pub fn set_from_file(body: &Body, particles: &mut ParticleStore, i: usize, index: u64) {
    let (Some((cloud, _)), Ok(row)) = (body.cloud(), usize::try_from(index)) else {
        return;
    };
    // To the bit: a share of a mean volume is a rounding away from it.
    if let Some(&[mass]) = cloud.get(Quantity::Mass, row) {
        particles.mass[i] = mass;
    }
    let stress = cloud.get(Quantity::DeviatoricStress, row);
    if let Some(stress) = stress.and_then(|stress| stress.try_into().ok()) {
        particles.deviatoric_stress[i] = stress;
    }
    for (quantity, values) in [
        (Quantity::Damage, &mut particles.damage),
        (Quantity::FailureEnergy, &mut particles.failure_energy),
        (Quantity::Compaction, &mut particles.compaction),
        (Quantity::Burn, &mut particles.burn),
    ] {
        // Not every case has use for them.
        if let (Some(&[given]), Some(value)) = (cloud.get(quantity, row), values.get_mut(i)) {
            *value = given;
        }
    }
    let displacement = cloud.get(Quantity::HourglassDisplacement, row);
    if let (Some(&[x, y, z]), Some(value)) =
        (displacement, particles.hourglass_displacement.get_mut(i))
    {
        *value = [x, y, z];
    }
}
