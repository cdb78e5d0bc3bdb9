//! Kinds of particles, as contact tells them apart: bodies, and classes of size where the particles
//! of a body are unequal.

use model::{Body, Case, SmoothingLength, cube};

/// Sizes of a class are this many times those of the one before,
const STEP: f64 = 1.05;
/// or more times, so that a body has no more classes than these.
const MOST_CLASSES: f64 = 64.0;

/// How many times larger the sizes of a class of a body are than those of the one before.
fn step(body: &Body) -> f64 {
    let [least, most] = body.lattice.sizes.unwrap_or([1.0; 2]);
    STEP.max(libm::pow(most / least, 1.0 / (MOST_CLASSES - 1.0)))
}

/// The kinds of a case. Bodies whose particles are alike have one kind each.
#[derive(Debug, Clone, Default)]
pub struct Kinds {
    /// The first kind of each body, and at last how many kinds there are.
    first: Vec<usize>,
    /// Mass (kg) from which on a particle is of the next kind of its body.
    limits: Vec<f64>,
    /// Body of each kind.
    body: Vec<usize>,
    /// Size of its particles against the spacing of the body.
    size: Vec<f64>,
}

impl Kinds {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let mut kinds = Self {
            first: vec![0],
            ..Self::default()
        };
        for (b, body) in case.bodies.iter().enumerate() {
            let [least, most] = body.lattice.sizes.unwrap_or([1.0; 2]);
            let step = step(body);
            let mass = case.particle_mass(body);
            let mut size = least;
            loop {
                let limit = size * step.sqrt();
                kinds.body.push(b);
                kinds.size.push(size);
                kinds.limits.push(mass * cube(limit, case.dimension));
                if limit >= most {
                    break;
                }
                size *= step;
            }
            kinds.first.push(kinds.body.len());
        }
        kinds
    }

    /// One kind for each of so many bodies.
    #[must_use]
    pub fn of_bodies(count: usize) -> Self {
        Self {
            first: (0..=count).collect(),
            limits: vec![f64::INFINITY; count],
            body: (0..count).collect(),
            size: vec![1.0; count],
        }
    }

    /// The longest range of contact of unequal particles over the sum of both smoothing lengths:
    /// ranges are those of the start, and of classes of size.
    #[must_use]
    pub fn longest_range(case: &Case) -> f64 {
        let widest = case.bodies.iter().map(step).fold(1.0, f64::max);
        match case.sph.smoothing_length {
            SmoothingLength::Constant => widest,
            SmoothingLength::Variable { min, .. } => widest / min,
        }
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.body.len()
    }

    /// Of how many bodies.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.first.len() - 1
    }

    /// The kind of a particle of a body with a mass (kg).
    #[inline(always)]
    #[must_use]
    pub fn of(&self, body: usize, mass: f64) -> usize {
        let (first, end) = (self.first[body], self.first[body + 1]);
        if end - first == 1 {
            return first;
        }
        let limits = &self.limits[first..end - 1];
        first + limits.partition_point(|&limit| limit <= mass)
    }

    /// The kind of a body that has the smallest particles.
    #[must_use]
    pub fn smallest(&self, body: usize) -> usize {
        self.first[body]
    }

    /// The body of a kind.
    #[must_use]
    pub fn body(&self, kind: usize) -> usize {
        self.body[kind]
    }

    /// A body with a spacing as that of a kind.
    #[must_use]
    pub fn body_of_size(&self, case: &Case, kind: usize) -> Body {
        let mut body = case.bodies[self.body[kind]].clone();
        body.lattice.spacing *= self.size[kind];
        body.smoothing_length *= self.size[kind];
        body
    }
}
