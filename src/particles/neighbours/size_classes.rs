//! Size classes of particles, as contact tells them apart: bodies, those that are alike together, and classes of size where
//! the particles of a body are unequal.

use std::collections::BTreeMap;
use std::ops::Range;

use model::{Body, Case, Heat, Shape, SmoothingLength, cube};

/// Sizes of a class are this many times those of the one before,
const STEP: f64 = 1.05;
/// or more times, so that a body has no more classes than these.
const MOST_CLASSES: f64 = 64.0;

/// Ratio of the sizes of a class of a body to those of the one before.
fn step(body: &Body) -> f64 {
    let [least, most] = body.lattice.sizes.unwrap_or([1.0; 2]);
    STEP.max(libm::pow(most / least, 1.0 / (MOST_CLASSES - 1.0)))
}

/// The size classes of a case. Bodies whose particles are equal have one size class, which bodies share that contact
/// takes alike.
#[derive(Debug, Clone, Default)]
pub struct SizeClasses {
    /// The size classes of each body.
    of_body: Vec<Range<usize>>,
    /// Mass (kg) from which on a particle is of the next size class of its body.
    limits: Vec<f64>,
    /// The first body of each size class.
    body: Vec<usize>,
    /// True if other bodies share a size class.
    shared: Vec<bool>,
    /// Size of its particles against the spacing of the body.
    size: Vec<f64>,
}

impl SizeClasses {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let mut size_classes = Self::default();
        let alike = Alike::new(case);
        let mut known = BTreeMap::new();
        for (b, body) in case.bodies.iter().enumerate() {
            let first = size_classes.count();
            if let Some(key) = alike.key(b) {
                let class = *known.entry(key).or_insert(first);
                if class < first {
                    size_classes.shared[class] = true;
                    size_classes.of_body.push(class..class + 1);
                    continue;
                }
            }
            let [least, most] = body.lattice.sizes.unwrap_or([1.0; 2]);
            let step = step(body);
            let mass = case.particle_mass(body);
            let mut size = least;
            loop {
                let limit = size * step.sqrt();
                size_classes.body.push(b);
                size_classes.size.push(size);
                size_classes.shared.push(false);
                size_classes.limits.push(mass * cube(limit, case.dimension));
                if limit >= most {
                    break;
                }
                size *= step;
            }
            let end = size_classes.count();
            size_classes.of_body.push(first..end);
        }
        size_classes
    }

    /// One size class for each of so many bodies.
    #[must_use]
    pub fn of_bodies(count: usize) -> Self {
        Self {
            of_body: (0..count).map(|body| body..body + 1).collect(),
            shared: vec![false; count],
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

    /// How many times as large a particle of a body may count in contact as it is: that takes sizes of classes.
    #[must_use]
    pub fn widening(body: &Body) -> f64 {
        match body.lattice.sizes {
            None => 1.0,
            // And rounding.
            Some(_) => (1.0 + 1e-9) * step(body).sqrt(),
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
        self.of_body.len()
    }

    /// True if several bodies share a size class.
    #[must_use]
    pub fn is_shared(&self, size_class: usize) -> bool {
        self.shared[size_class]
    }

    /// The size class of a particle of a body with a mass (kg).
    #[inline(always)]
    #[must_use]
    pub fn of(&self, body: usize, mass: f64) -> usize {
        let Range { start: first, end } = self.of_body[body];
        if end - first == 1 {
            return first;
        }
        let limits = &self.limits[first..end - 1];
        first + limits.partition_point(|&limit| limit <= mass)
    }

    /// The size class of a body that has the smallest particles.
    #[must_use]
    pub fn smallest(&self, body: usize) -> usize {
        self.of_body[body].start
    }

    /// The first body of a size class.
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

/// What makes bodies alike for contact.
struct Alike<'a> {
    case: &'a Case,
    /// Bodies that a load or a pair names.
    named: Vec<bool>,
    /// True if bodies differ for their velocities.
    by_velocity: bool,
}

/// Equal for bodies that are alike: the surfaces that act on them, their material and filling, bits of lengths, densities
/// and velocities.
type Key = (Vec<bool>, [usize; 2], [u64; 6]);

impl<'a> Alike<'a> {
    fn new(case: &'a Case) -> Self {
        let all = case.bodies.len();
        let mut named = vec![false; all];
        let pairs = case.contacts.iter().flat_map(|pair| pair.bodies);
        let loads = case.loads.velocities.iter().map(|load| load.body);
        for body in pairs.chain(loads) {
            named[body] = true;
        }
        Self {
            case,
            named,
            by_velocity: case.meets_fast(),
        }
    }

    /// Of a body, unless it is like no other.
    fn key(&self, index: usize) -> Option<Key> {
        let (case, body) = (self.case, &self.case.bodies[index]);
        // Fragments of one body meet as two bodies do, or not at all.
        let own = case.self_contact.as_ref();
        let is_own_mode = own.is_none_or(|own| own.mode() == case.default_contact);
        let is_plain = body.rigid.is_none()
            && body.lattice.sizes.is_none()
            && body.initial.heat == Heat::Reference
            && body.cloud().is_none()
            && (!self.by_velocity || body.speed_spread() == 0.0);
        if self.named[index] || !is_own_mode || !is_plain {
            return None;
        }
        let velocity: [f64; 3] = if self.by_velocity {
            body.velocity.into()
        } else {
            [0.0; 3]
        };
        let [x, y, z] = velocity.map(f64::to_bits);
        let density = body.density.map_or(u64::MAX, f64::to_bits);
        let [spacing, length] = [body.lattice.spacing, body.smoothing_length].map(f64::to_bits);
        let surfaces = case.loads.surfaces.iter();
        let acting = surfaces.map(|surface| surface.bodies[index]).collect();
        let lattice = &body.lattice;
        let turned = usize::from(lattice.axis.is_some() || matches!(body.shape, Shape::Solid(_)));
        let kinds = [body.material, 2 * lattice.kind as usize + turned];
        Some((acting, kinds, [spacing, length, density, x, y, z]))
    }
}
