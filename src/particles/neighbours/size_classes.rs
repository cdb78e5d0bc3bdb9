//! Size classes of particles, as contact tells them apart: bodies, and classes of size where the particles
//! of a body are unequal.

use model::{Body, Case, SmoothingLength, cube};

/// Sizes of a class are this many times those of the one before,
const STEP: f64 = 1.05;
/// or more times, so that a body has no more classes than these.
const MOST_CLASSES: f64 = 64.0;

/// Ratio of the sizes of a class of a body to those of the one before.
fn step(body: &Body) -> f64 {
    let [least, most] = body.lattice.sizes.unwrap_or([1.0; 2]);
    STEP.max(libm::pow(most / least, 1.0 / (MOST_CLASSES - 1.0)))
}

/// The size classes of a case. Bodies whose particles are alike have one size class each.
#[derive(Debug, Clone, Default)]
pub struct SizeClasses {
    /// The first size class of each body, and at last how many size classes there are.
    first: Vec<usize>,
    /// Mass (kg) from which on a particle is of the next size class of its body.
    limits: Vec<f64>,
    /// Body of each size class.
    body: Vec<usize>,
    /// Size of its particles against the spacing of the body.
    size: Vec<f64>,
}

impl SizeClasses {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let mut size_classes = Self {
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
                size_classes.body.push(b);
                size_classes.size.push(size);
                size_classes.limits.push(mass * cube(limit, case.dimension));
                if limit >= most {
                    break;
                }
                size *= step;
            }
            size_classes.first.push(size_classes.body.len());
        }
        size_classes
    }

    /// One size class for each of so many bodies.
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

    /// Number of classes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.body.len()
    }

    /// Of how many bodies.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.first.len() - 1
    }

    /// The size class of a particle of a body with a mass (kg).
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

    /// The size class of a body that has the smallest particles.
    #[must_use]
    pub fn smallest(&self, body: usize) -> usize {
        self.first[body]
    }

    /// The body of a size class.
    #[must_use]
    pub fn body(&self, size_class: usize) -> usize {
        self.body[size_class]
    }

    /// A body with a spacing as that of a size class.
    #[must_use]
    pub fn body_of_size(&self, case: &Case, size_class: usize) -> Body {
        let mut body = case.bodies[self.body[size_class]].clone();
        body.lattice.spacing *= self.size[size_class];
        body.smoothing_length *= self.size[size_class];
        body
    }
}
