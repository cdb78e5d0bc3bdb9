//! Stress by contact, which snapshots show and no step needs.

use rayon::prelude::*;

use super::simulation::Simulation;
use crate::sph::{StressForces, stress};
use comm::Comm;
use numerics::kernel::Kernel;
use numerics::vector::{dot, minus, norm};
use numerics::virial::Virial;
use particles::Mirrors;
use particles::neighbours::{CHUNKS_AT_ONCE, Lists};
use particles::{HaloPhase, ParticleStore};

/// Stress that the pair forces of a particle in contact carry.
#[derive(Debug, Clone, Copy)]
pub struct Carried {
    /// Index of the particle.
    pub particle: usize,
    /// Virial of all its pair forces, by stress and by contact, over its volume (Pa, tension
    /// positive).
    pub stress: [f64; 6],
    /// The direction in which contact presses on it.
    pub normal: [f64; 3],
}

/// Stress that the pair forces of each owned particle in contact carry. Right after a step, before the
/// particles change.
#[must_use]
pub fn carried_in(simulation: &Simulation) -> Vec<Carried> {
    let (particles, lists) = (&simulation.particles, &simulation.search.lists);
    let carried = (simulation.contact).carried(particles, lists, simulation.state.last_dt);
    let forces = StressForces::new(&simulation.case, particles, lists, &simulation.sph);
    let total = total_virials(simulation, |i| {
        carried.binary_search_by_key(&i, |(i, _)| *i).is_ok()
    });
    of_receivers(lists, |i, place, neighbours| {
        let at = carried.binary_search_by_key(&i, |(i, _)| *i).ok()?;
        let carried = &carried[at].1;
        let mut virial = match total.binary_search_by_key(&i, |(i, _)| *i) {
            Ok(at) => total[at].1,
            Err(_) => forces.virial(place, neighbours),
        };
        virial.join(&carried.virial);
        let volume = particles.mass[i] / particles.density[i];
        let press = norm(&carried.press);
        Some(Carried {
            particle: i,
            stress: virial.0.map(|v| v / volume),
            normal: carried.press.map(|f| f / press),
        })
    })
}

/// Virials of stress of chosen particles whose bodies have the total form, by particle.
fn total_virials(
    simulation: &Simulation,
    chosen: impl Fn(usize) -> bool + Sync,
) -> Vec<(usize, Virial)> {
    let Some(total) = simulation.sph.total() else {
        return Vec::new();
    };
    let kernel = Kernel::new(simulation.case.extent());
    let lengths = &simulation.particles.smoothing_length;
    let mut all = of_receivers(total.lists(), |i, place, neighbours| {
        chosen(i).then(|| (i, total.virial(&kernel, lengths, place, neighbours)))
    });
    all.par_sort_unstable_by_key(|(i, _)| *i);
    all
}

/// Writes into `contact_stress` the traction across each particle in contact beyond that of its own
/// stress. Right after a step, before the particles change. Collective.
///
/// The traction is that of [`carried_in`], as the kernel averages it over the particles of the body that
/// are in contact, on the plane that contact presses on (theory page "Contact").
pub fn measure_in(simulation: &mut Simulation, comm: &Comm) {
    if !simulation.contact.table.is_active() {
        return;
    }
    let mut carried = carried_in(simulation);
    carried.retain(|of| of.stress != [0.0; 6]);
    let Simulation {
        case,
        particles,
        search,
        space,
        ..
    } = simulation;
    let field = &mut particles.contact_stress;
    field.fill([0.0; 6]);
    for of in &carried {
        field[of.particle] = of.stress;
    }
    space.halo.exchange(comm, particles, HaloPhase::SHOWN);
    let (all, lists) = (&*particles, &search.lists);
    let kernel = Kernel::new(case.extent());
    let means = of_receivers(lists, |i, place, neighbours| {
        let is_there = all.contact_stress[i] != [0.0; 6];
        is_there.then(|| mean_carried(&kernel, all, lists, place, neighbours))
    });
    for (of, mean) in carried.iter().zip(means) {
        let own = stress(particles, of.particle);
        let more = std::array::from_fn(|k| mean[k] - own[k]);
        particles.contact_stress[of.particle] = on_plane(&more, &of.normal);
    }
}

/// Mean over a particle in contact and its neighbours that are in contact too,
/// `Σ V_j W_ij S_j / Σ V_j W_ij`, of the values S in `contact_stress`.
fn mean_carried(
    kernel: &Kernel,
    particles: &ParticleStore,
    lists: &Lists,
    place: u32,
    neighbours: &[u32],
) -> [f64; 6] {
    let (images, motion) = (lists.images(), lists.motion());
    let h = |place: u32| particles.smoothing_length[images[place as usize].slot()];
    let (mut sum, mut weights) = ([0.0; 6], 0.0);
    for &other in neighbours {
        let (image, record) = (images[other as usize], &motion[other as usize]);
        let carried = &particles.contact_stress[image.slot()];
        if *carried == [0.0; 6] {
            continue;
        }
        let distance = norm(&minus(&motion[place as usize].position, &record.position));
        let weight = record.volume * kernel.value(distance, 0.5 * (h(place) + h(other)));
        let carried = Mirrors::reflect_symmetric(carried, image.mirror_mask());
        weights += weight;
        for k in 0..6 {
            sum[k] += weight * carried[k];
        }
    }
    let weights = weights.max(f64::MIN_POSITIVE);
    sum.map(|s| s / weights)
}

/// Results of `work` for owned particles, in the order of the lists. It is given the index of each, its place
/// among the images and its neighbours in its own body, itself among them.
fn of_receivers<T: Send>(
    lists: &Lists,
    work: impl Fn(usize, u32, &[u32]) -> Option<T> + Sync,
) -> Vec<T> {
    let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
    let found = chunks.flat_map_iter(|chunk| {
        let mut found = Vec::new();
        for (cluster, neighbours, _) in chunk.iter() {
            for &place in &cluster.receivers[..cluster.lanes] {
                let i = lists.images()[place as usize].slot();
                found.extend(work(i, place, neighbours));
            }
        }
        found
    });
    found.collect()
}

/// The part of a symmetric tensor that acts on the plane of a unit normal: with the same traction
/// there, and none between directions in the plane.
fn on_plane(tensor: &[f64; 6], n: &[f64; 3]) -> [f64; 6] {
    let [xx, yy, zz, xy, xz, yz] = *tensor;
    let t = [
        dot(&[xx, xy, xz], n),
        dot(&[xy, yy, yz], n),
        dot(&[xz, yz, zz], n),
    ];
    let normal = dot(&t, n);
    let part = |a: usize, b: usize| n[a] * t[b] + t[a] * n[b] - normal * (n[a] * n[b]);
    [
        part(0, 0),
        part(1, 1),
        part(2, 2),
        part(0, 1),
        part(0, 2),
        part(1, 2),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The traction stays on the plane itself, and vanishes between directions in it.
    #[test]
    fn only_the_plane_of_contact_bears_more() {
        let tensor = [3.0, -1.0, 2.0, 0.5, 0.25, -2.0];
        let along_y = on_plane(&tensor, &[0.0, 1.0, 0.0]);
        assert_eq!(along_y, [0.0, -1.0, 0.0, 0.5, 0.0, -2.0]);
        let n = [0.6, 0.0, 0.8];
        let [xx, yy, zz, xy, xz, yz] = on_plane(&tensor, &n);
        let traction = [
            xx * n[0] + xz * n[2],
            xy * n[0] + yz * n[2],
            xz * n[0] + zz * n[2],
        ];
        let expected = [
            3.0 * 0.6 + 0.25 * 0.8,
            0.5 * 0.6 - 2.0 * 0.8,
            0.25 * 0.6 + 2.0 * 0.8,
        ];
        for a in 0..3 {
            assert!((traction[a] - expected[a]).abs() < 1e-14);
        }
        let across = [0.8, 0.0, -0.6];
        let in_plane = xx * across[0] * across[0]
            + 2.0 * xz * across[0] * across[2]
            + zz * across[2] * across[2];
        assert!(yy.abs() < 1e-14 && in_plane.abs() < 1e-14);
    }
}
