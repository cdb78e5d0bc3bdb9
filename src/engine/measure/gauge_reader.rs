//! Reading of one gauge from the particles of a rank.
//!
//! A fixed gauge reads the mean of the particles about it, weighted with kernel and volume (Shepard):
//! `Σ V_j W_j f_j / Σ V_j W_j`, of all images in whose support it is. The sum below, its *coverage*,
//! is about one inside of material, half at a face and zero in the void, where there is nothing to read.
//! Terms are added in canonical order, the images behind each set of symmetry planes after the
//! particles themselves, to eight sums in turn and these in a fixed order: a pure function of the state.

use super::near::{LaneSum, Near, One};
use super::reading::{Reading, along, stress};
use super::surroundings;
use model::{Case, Gauge};
use numerics::dispatch::{Vectorised, instructions};
use numerics::kernel::Kernel;
use numerics::lanes::{LANES, Lanes};
use particles::Mirrors;
use particles::ParticleStore;
use particles::neighbours::{Lists, PointSearch};

/// Sums of a gauge before its readings: coverage and position, the latter of a carried gauge alone.
pub const FIRST: usize = 4;

/// Particles that gauges read.
pub struct Matter<'a> {
    pub case: &'a Case,
    pub particles: &'a ParticleStore,
    pub lists: &'a Lists,
}

/// Kernel and mirrors of means.
#[derive(Debug)]
pub struct Means {
    pub kernel: Kernel,
    pub mirrors: Mirrors,
}

/// Memory to read a gauge.
#[derive(Debug, Default)]
pub struct Scratch {
    /// Images that it reads.
    pub near: Near,
    search: PointSearch,
}

/// State of one gauge from reading to reading.
#[derive(Debug)]
pub struct Reader {
    pub gauge: Gauge,
    /// Its readings, with the first column of each.
    pub readings: Vec<(Reading, usize)>,
    /// Place in the store of the particle that carries it, as far as this rank knows.
    pub place: Option<usize>,
    /// True if it reads now.
    pub due: bool,
    /// True if a particle of this rank is near.
    pub met: bool,
    /// Coverage, position, then its readings, the normal stress and the surroundings, each times its weight.
    pub sums: Vec<f64>,
}

impl Reader {
    /// The reader of a gauge among some readings, with the first column of each.
    pub fn new(gauge: &Gauge, readings: &[(Reading, usize)]) -> Self {
        let own =
            |(reading, _): &&(Reading, usize)| gauge.fields.iter().any(|n| n == reading.name());
        let readings: Vec<_> = readings.iter().filter(own).copied().collect();
        let numbers: usize = readings.iter().map(|(r, _)| r.endings().len()).sum();
        let around = gauge.particle.map_or(0, |_| surroundings::NUMBERS);
        let sums = FIRST + numbers + usize::from(gauge.along.is_some()) + around;
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
        instructions().run(Sum {
            reader: self,
            matter,
            means,
            scratch,
        });
    }

    /// Adds up what has been found.
    #[inline(always)]
    fn add_up<V: Lanes>(&mut self, matter: &Matter, near: &Near) {
        self.met = near.len() > 0;
        self.sums.fill(0.0);
        self.sums[0] = near.coverage::<V>();
        let particles = matter.particles;
        if self.gauge.moves
            && let Some(carrier) = near.iter().next()
        {
            self.sums[1..FIRST].copy_from_slice(&particles.position[carrier.i]);
        }
        let mut rest = &mut self.sums[FIRST..];
        for (reading, _) in &self.readings {
            let (sums, others) = rest.split_at_mut(reading.endings().len());
            reading.add_up::<V>(matter.case, particles, near, sums);
            rest = others;
        }
        if let (Some(_), Some(carrier)) = (self.gauge.particle, near.iter().next()) {
            let (others, numbers) = rest.split_at_mut(rest.len() - surroundings::NUMBERS);
            numbers.copy_from_slice(&surroundings::around(matter, carrier.i));
            rest = others;
        }
        if let (Some(normal), [sum, ..]) = (&self.gauge.along, rest) {
            let mut lanes = LaneSum::default();
            for (k, one) in near.iter().enumerate() {
                let stress = stress(particles, one.i, one.mirror_mask);
                lanes.add(k, one.weight * along(&stress, normal));
            }
            *sum = lanes.total();
        }
    }

    /// The terms of one image, as many as there are sums, in their order.
    pub fn terms(&self, matter: &Matter, one: &One, terms: &mut Vec<f64>) {
        let particles = matter.particles;
        terms.clear();
        terms.push(one.weight);
        if self.gauge.moves {
            terms.extend(particles.position[one.i]);
        } else {
            terms.extend([0.0; FIRST - 1]);
        }
        for (reading, _) in &self.readings {
            let values = reading.read(matter.case, particles, one.i, one.mirror_mask);
            let own = &values[..reading.endings().len()];
            terms.extend(own.iter().map(|value| one.weight * value));
        }
        if let Some(normal) = &self.gauge.along {
            let stress = stress(particles, one.i, one.mirror_mask);
            terms.push(one.weight * along(&stress, normal));
        }
    }

    /// Finds this rank's particles and their images behind symmetry planes that the gauge reads, in canonical
    /// order.
    pub fn find(&self, matter: &Matter, means: &Means, scratch: &mut Scratch) {
        instructions().run(Find {
            reader: self,
            matter,
            means,
            scratch,
        });
    }

    /// Of all of them, where the search has those alone that some particle sees. An image is as far from the gauge
    /// as the particle is from the image of the gauge.
    #[inline(always)]
    fn find_in<V: Lanes>(&self, matter: &Matter, means: &Means, scratch: &mut Scratch) {
        let Scratch { near, search } = scratch;
        let lists = matter.lists;
        near.clear();
        if self.gauge.moves {
            if let Some(i) = self.place {
                near.set_carrier(i);
            }
            return;
        }
        search.begin();
        let images = lists.images();
        let weights = Weights::<V>::new(&means.kernel, matter.particles);
        for mirror_mask in means.mirrors.masks() {
            let at = means.mirrors.reflect_position(&self.gauge.at, mirror_mask);
            for group in 0..lists.groups.count() {
                let begin = search.found().len();
                search.own(lists, group, &at);
                if self.gauge.body.is_some() || lists.groups.rigid[group] {
                    let body = |place: u32| matter.particles.body[images[place as usize].slot()];
                    search.keep(begin, |place| {
                        reads(matter.case, self.gauge.body, body(place))
                    });
                }
                near.part(search.found().len(), mirror_mask, group);
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "particles fit u32")]
        let particle = |place: u32| images[place as usize].slot() as u32;
        near.set(search.found(), particle);
        for eight in 0..near.eights() {
            let square = V::read(search.squares(eight * LANES));
            let found = weights.of(near.eight(eight), square);
            near.weigh(&found);
        }
        near.end();
    }
}

/// Finds and adds up.
struct Sum<'a> {
    reader: &'a mut Reader,
    matter: &'a Matter<'a>,
    means: &'a Means,
    scratch: &'a mut Scratch,
}

impl Vectorised for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        self.reader
            .find_in::<V>(self.matter, self.means, self.scratch);
        self.reader.add_up::<V>(self.matter, &self.scratch.near);
    }
}

/// Finds alone.
struct Find<'a> {
    reader: &'a Reader,
    matter: &'a Matter<'a>,
    means: &'a Means,
    scratch: &'a mut Scratch,
}

impl Vectorised for Find<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lanes>(self) {
        self.reader
            .find_in::<V>(self.matter, self.means, self.scratch);
    }
}

/// Weights of particles, most of which are as large as the first.
struct Weights<'a, V> {
    kernel: &'a Kernel,
    particles: &'a ParticleStore,
    length: V,
    inverse: V,
    height: V,
}

impl<'a, V: Lanes> Weights<'a, V> {
    #[inline(always)]
    fn new(kernel: &'a Kernel, particles: &'a ParticleStore) -> Self {
        let first = particles.smoothing_length.first().copied();
        let length = V::splat(first.unwrap_or(1.0));
        let (inverse, height) = Self::shape(kernel, length);
        Self {
            kernel,
            particles,
            length,
            inverse,
            height,
        }
    }

    /// `1/h` and `σ_d/h^d`.
    #[inline(always)]
    fn shape(kernel: &Kernel, h: V) -> (V, V) {
        let inverse = V::splat(1.0).div(h);
        let mut height = V::splat(kernel.normalisation());
        for _ in 0..kernel.dimension() {
            height = height.mul(inverse);
        }
        (inverse, height)
    }

    /// `m/ρ W(r)` of eight particles with the squares of their distances (m²).
    #[inline(always)]
    fn of(&self, particles: &[u32; LANES], square: V) -> [f64; LANES] {
        let (mut length, mut mass, mut density) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for (k, &i) in particles.iter().enumerate() {
            let i = i as usize;
            length[k] = self.particles.smoothing_length[i];
            mass[k] = self.particles.mass[i];
            density[k] = self.particles.density[i];
        }
        let h = V::read(&length);
        let same = h.less_than(self.length) | self.length.less_than(h) == 0;
        let (inverse, height) = if same {
            (self.inverse, self.height)
        } else {
            Self::shape(self.kernel, h)
        };
        let (zero, q) = (V::splat(0.0), square.sqrt().mul(inverse));
        let a = V::splat(2.0).sub(q).max(zero);
        let b = V::splat(1.0).sub(q).max(zero);
        let cubes = V::splat(0.25).mul(a.mul(a).mul(a)).sub(b.mul(b).mul(b));
        let volume = V::read(&mass).div(V::read(&density));
        volume.mul(height.mul(cubes)).store().0
    }
}

/// True if a gauge for a body, or for all that deform, reads particles of a body.
pub fn reads(case: &Case, wanted: Option<usize>, body: u32) -> bool {
    let body = body as usize;
    wanted.map_or_else(
        || case.bodies[body].rigid.is_none(),
        |wanted| wanted == body,
    )
}
