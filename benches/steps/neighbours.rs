//! Numbers of neighbours of particles: of the sums, and of the lists.

use comm::Comm;
use engine::step::Simulation;

/// Particles whose neighbours are counted, more or less.
const SAMPLE: u64 = 500;

/// Words of one sampled particle: position (m), smoothing length (m), group, id.
const WORDS: usize = 6;

/// Mean number of particles and mirror images of the own group within 2h of a particle, itself not
/// counted: by brute force over all particles, for a sample of them that depends on their ids
/// alone. Collective.
#[allow(clippy::cast_precision_loss, reason = "a mean")]
pub fn true_mean(comm: &Comm, simulation: &Simulation) -> f64 {
    let mut sample = Vec::new();
    comm.all_gather_u64(&sampled(comm, simulation), &mut sample);
    let receivers = || sample.chunks_exact(WORDS).filter(|words| words[3] != 0);
    let mut count = [receivers().map(|words| count(simulation, words)).sum()];
    comm.sum_u64(&mut count);
    count[0] as f64 / (receivers().count() as f64).max(1.0)
}

/// Mean length of the list that a particle's cluster walks. Collective.
#[allow(clippy::cast_precision_loss, reason = "a mean")]
pub fn list_mean(comm: &Comm, simulation: &Simulation) -> f64 {
    let mut sums = [
        simulation.search.lists.entries(),
        simulation.particles.owned() as u64,
    ];
    comm.sum_u64(&mut sums);
    sums[0] as f64 / (sums[1] as f64).max(1.0)
}

/// This rank's share of the sample, padded with zeros to the same length on all ranks: a particle has
/// a positive smoothing length.
fn sampled(comm: &Comm, simulation: &Simulation) -> Vec<u64> {
    let particles = &simulation.particles;
    let mut all = [particles.owned() as u64];
    comm.sum_u64(&mut all);
    // Ids follow the lattice, so every n-th would be a choice of layers: multiplication by 2^64 over
    // the golden ratio scatters them evenly over all numbers.
    let limit = (u64::MAX / all[0].max(1)).saturating_mul(SAMPLE);
    let mut words = Vec::new();
    for i in 0..particles.owned() {
        if particles.id[i].wrapping_mul(0x9e37_79b9_7f4a_7c15) <= limit {
            words.extend(particles.position[i].map(f64::to_bits));
            words.push(particles.smoothing_length[i].to_bits());
            words.push(simulation.contact().groups.of_body[particles.body[i] as usize] as u64);
            words.push(particles.id[i]);
        }
    }
    let mut longest = [words.len() as u64];
    comm.max_u64(&mut longest);
    words.resize(usize::try_from(longest[0]).unwrap_or(0), 0);
    words
}

/// Neighbours of a sampled particle among this rank's particles and their images. That an image of
/// a particle is near the receiver is the same as that the particle is near the receiver's image.
fn count(simulation: &Simulation, words: &[u64]) -> u64 {
    let particles = &simulation.particles;
    let receiver = [0, 1, 2].map(|a| f64::from_bits(words[a]));
    let h = f64::from_bits(words[3]);
    let (group, id) = (words[4], words[5]);
    let mut images = vec![receiver];
    for plane in &simulation.case.symmetry {
        let axis = plane.axis.index();
        for k in 0..images.len() {
            let mut image = images[k];
            image[axis] = 2.0 * plane.position - image[axis];
            images.push(image);
        }
    }
    let mut count = 0;
    for i in 0..particles.owned() {
        if simulation.contact().groups.of_body[particles.body[i] as usize] as u64 != group {
            continue;
        }
        let reach = h + particles.smoothing_length[i];
        for (k, image) in images.iter().enumerate() {
            let square: f64 = (0..3)
                .map(|a| (particles.position[i][a] - image[a]).powi(2))
                .sum();
            let itself = k == 0 && particles.id[i] == id;
            count += u64::from(square < reach * reach && !itself);
        }
    }
    count
}
