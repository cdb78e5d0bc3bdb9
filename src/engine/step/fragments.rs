//! The fragments of a running case.

use rayon::prelude::*;

use super::simulation::Simulation;
use super::space::Space;
use crate::domain::Reaches;
use crate::fragments::{Census, FirstSizes, Matter, Rule, Surroundings, belongs, find, link_reach};
use comm::Comm;
use model::{Case, FragmentOptions, SphForm};
use particles::{ActiveMut, Inactive, ParticleStore};

/// Finds the fragments of all ranks. Between steps: halo particles are others afterwards. Collective.
pub fn find_in(simulation: &mut Simulation, comm: &Comm, options: &FragmentOptions) -> Census {
    let Simulation {
        case,
        particles,
        search,
        space: Space { partition, halo },
        sph,
        ..
    } = simulation;
    let rule = Rule::new(options, case.dimension);
    let first = case.bodies.iter().map(|body| FirstSizes::new(case, body));
    let first: Vec<FirstSizes> = first.collect();
    let size_of = |mass: f64, body: u32| first[body as usize].of(mass, rule.dimension);
    let total = sph.total().filter(|total| !total.is_empty());
    let mut deformation = total.map_or_else(Vec::new, |total| total.gradients(particles));
    let reach = |particles: &ParticleStore, i: usize| {
        let size = size_of(particles.mass[i], particles.body[i]);
        link_reach(rule.link, size, deformation.get(i)).0
    };
    let all = (0..particles.owned()).into_par_iter();
    // same bits in any order: a largest number
    let farthest = all.map(|i| reach(particles, i)).reduce(|| 0.0, f64::max);
    let reaches = Reaches {
        slabs: partition.slabs(),
        farthest: comm.max_f64(farthest),
    };
    let all = ActiveMut {
        particles,
        inactive: &Inactive::default(),
    };
    halo.exchange_motion(comm, reaches, all, reach);
    let owned = particles.owned();
    let masses = particles.mass.par_iter().zip(&particles.body);
    let sizes: Vec<f64> = masses.map(|(&m, &body)| size_of(m, body)).collect();
    let damage = |i: usize| particles.damage.get(i).copied().unwrap_or_default();
    let mut included: Vec<u8> = vec![0; particles.id.len()];
    for (i, included) in included[..owned].iter_mut().enumerate() {
        *included = belongs(options.include, damage(i)).into();
    }
    halo.exchange_values(comm, &mut included);
    if total.is_some() {
        deformation.resize(particles.id.len(), [0.0; 9]);
        halo.exchange_values(comm, &mut deformation);
    }
    let included: Vec<bool> = included.iter().map(|&is| is != 0).collect();
    let temperature = temperatures(case, particles);
    let matter = Matter {
        owned,
        bodies: case.bodies.len(),
        ids: &particles.id,
        body: &particles.body,
        position: &particles.position,
        size: &sizes,
        deformation: &deformation,
        included: &included,
        mass: &particles.mass,
        velocity: &particles.velocity,
        temperature: &temperature,
        plastic_strain: &particles.plastic_strain,
    };
    let (mirrors, others) = (*halo.mirrors(), halo.others().to_vec());
    let around = Surroundings {
        mirrors: &mirrors,
        others: &others,
    };
    find(
        (comm, Some(halo)),
        &matter,
        around,
        &rule,
        &mut search.labels,
    )
}

/// Temperatures (K) of this rank's particles; NaN where there is none.
fn temperatures(case: &Case, particles: &ParticleStore) -> Vec<f64> {
    // Stress points hold the state of the particles about them.
    if case.sph.form == SphForm::StressPoints {
        return vec![f64::NAN; particles.owned()];
    }
    let of = |i: usize| {
        let material = &case.materials[case.bodies[particles.body[i] as usize].material];
        particles.temperature(material, i)
    };
    let all = (0..particles.owned()).into_par_iter();
    all.map(|i| of(i).unwrap_or(f64::NAN)).collect()
}
