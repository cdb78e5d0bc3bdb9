//! What one gauge reads of the particles of a rank.
//!
//! A fixed gauge reads the mean of the matter about it, weighted with kernel and volume (Shepard):
//! `Σ V_j W_j f_j / Σ V_j W_j`, of all images in whose support it is. The sum below, its *coverage*,
//! is about one inside of matter, half at a face and zero in the void, where there is nothing to read.
//! Terms are added in canonical order, the images behind each set of symmetry planes after the
//! particles themselves: a pure function of the state.

use super::reading::{Near, Reading, along, stress};
use crate::domain::Mirrors;
use crate::model::{Case, Gauge};
use crate::neighbours::{Lists, PointSearch};
use crate::numerics::kernel::Kernel;
use crate::numerics::vector::{minus, norm};
use crate::particles::ParticleStore;

/// Sums of a gauge before its readings: coverage and position, the latter of a carried gauge alone.
pub const FIRST: usize = 4;

/// What gauges read.
pub struct Matter<'a> {
    pub case: &'a Case,
    pub particles: &'a ParticleStore,
    pub lists: &'a Lists,
}

/// How means are made.
#[derive(Debug)]
pub struct Means {
    pub kernel: Kernel,
    pub mirrors: Mirrors,
}

/// Memory to read a gauge.
#[derive(Debug, Default)]
pub struct Scratch {
    /// What it reads.
    pub near: Vec<Near>,
    search: PointSearch,
}

/// What one gauge needs from reading to reading.
#[derive(Debug)]
pub struct Reader {
    pub gauge: Gauge,
    /// Its readings, with the first column of each.
    pub readings: Vec<(Reading, usize)>,
    /// Place in the store of the particle that carries it, as far as this rank knows.
    pub place: Option<usize>,
    /// Whether it reads now.
    pub due: bool,
    /// Whether a particle of this rank is near.
    pub met: bool,
    /// Coverage, position, then its readings and the normal stress, each times its weight.
    pub sums: Vec<f64>,
}

impl Reader {
    /// The reader of a gauge among some readings, with the first column of each.
    pub fn new(gauge: &Gauge, readings: &[(Reading, usize)]) -> Self {
        let own =
            |(reading, _): &&(Reading, usize)| gauge.fields.iter().any(|n| n == reading.name());
        let readings: Vec<_> = readings.iter().filter(own).copied().collect();
        let numbers: usize = readings.iter().map(|(r, _)| r.endings().len()).sum();
        let sums = FIRST + numbers + usize::from(gauge.along.is_some());
        Self {
            gauge: gauge.clone(),
            readings,
            place: None,
            due: false,
            met: false,
            sums: vec![0.0; sums],
        }
    }

    /// Adds up what this rank's particles give.
    pub fn sum(&mut self, matter: &Matter, means: &Means, scratch: &mut Scratch) {
        self.find(matter, means, scratch);
        let near = &scratch.near;
        self.met = !near.is_empty();
        self.sums.fill(0.0);
        self.sums[0] = near.iter().map(|one| one.weight).fold(0.0, |a, b| a + b);
        let particles = matter.particles;
        if self.gauge.moves
            && let [carrier] = &near[..]
        {
            self.sums[1..FIRST].copy_from_slice(&particles.position[carrier.i]);
        }
        let mut rest = &mut self.sums[FIRST..];
        for (reading, _) in &self.readings {
            let (sums, others) = rest.split_at_mut(reading.endings().len());
            reading.add_up(matter.case, particles, near, sums);
            rest = others;
        }
        if let (Some(normal), [sum, ..]) = (&self.gauge.along, rest) {
            for one in near {
                *sum += one.weight * along(&stress(particles, one.i, one.code), normal);
            }
        }
    }

    /// The terms of one image, as many as there are sums, in their order.
    pub fn terms(&self, matter: &Matter, one: &Near, terms: &mut Vec<f64>) {
        let particles = matter.particles;
        terms.clear();
        terms.push(one.weight);
        if self.gauge.moves {
            terms.extend(particles.position[one.i]);
        } else {
            terms.extend([0.0; FIRST - 1]);
        }
        for (reading, _) in &self.readings {
            let values = reading.read(matter.case, particles, one.i, one.code);
            let own = &values[..reading.endings().len()];
            terms.extend(own.iter().map(|value| one.weight * value));
        }
        if let Some(normal) = &self.gauge.along {
            let stress = stress(particles, one.i, one.code);
            terms.push(one.weight * along(&stress, normal));
        }
    }

    /// This rank's particles and their images behind symmetry planes that the gauge reads, in canonical
    /// order: all of them, where the search has those alone that some particle sees. An image is as far
    /// from the gauge as the particle is from the image of the gauge.
    pub fn find(&self, matter: &Matter, means: &Means, Scratch { near, search }: &mut Scratch) {
        near.clear();
        let lists = matter.lists;
        if self.gauge.moves {
            near.extend(self.place.map(|i| Near {
                i,
                code: 0,
                weight: 1.0,
                listed: [0; 2],
            }));
            return;
        }
        for code in std::iter::once(0).chain(means.mirrors.codes()) {
            let at = means.mirrors.reflect_position(&self.gauge.at, code);
            for group in 0..lists.groups.count() {
                let places = search.own(lists, group, &at);
                self.weigh(matter, means, (group, places), (code, &at), near);
            }
        }
    }

    /// Those of some places in a group that have a weight at the image of the gauge.
    fn weigh(
        &self,
        matter: &Matter,
        means: &Means,
        (group, places): (usize, &[u32]),
        (code, at): (u8, &[f64; 3]),
        near: &mut Vec<Near>,
    ) {
        let (particles, images) = (matter.particles, matter.lists.images());
        let sequence = matter.lists.sequence();
        let any = self.gauge.body.is_none() && !matter.lists.groups.rigid[group];
        // Most particles are as large as the one before.
        let (mut length, mut kernel) = (f64::NAN, means.kernel.of_length(1.0));
        for &index in places {
            let index = index as usize;
            let i = images[index].base();
            if !any && !reads(matter.case, self.gauge.body, particles.body[i]) {
                continue;
            }
            let h = particles.smoothing_length[i];
            if h.to_bits() != length.to_bits() {
                (length, kernel) = (h, means.kernel.of_length(h));
            }
            // The position of the particle, where the search has just read it.
            let distance = norm(&minus(&sequence.position(index), at));
            let weight = particles.mass[i] / particles.density[i] * kernel.value(distance);
            if weight > 0.0 {
                near.push(Near {
                    i,
                    code,
                    weight,
                    listed: [group, index],
                });
            }
        }
    }
}

/// Whether a gauge for a body, or for all that deform, reads particles of a body.
pub fn reads(case: &Case, wanted: Option<usize>, body: u32) -> bool {
    let body = body as usize;
    wanted.map_or_else(
        || case.bodies[body].rigid.is_none(),
        |wanted| wanted == body,
    )
}
