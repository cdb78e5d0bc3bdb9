//! Particles of two or more bodies anywhere in space, what contact does to them, and the energy of
//! contact written down again.

use engine::contact::{BodyForce, ContactForce, ContactTable, ContactView, TaskForces, overlap};
use material::library;
use model::{
    Body, Case, ContactClass, ContactMode, Overlap, Potential, PotentialRange, Shape, Vec3,
};
use numerics::kernel::Kernel;
use particles::neighbours::MotionRecord;
use particles::{Image, MirrorMask, ParticleStore};

use crate::common::{body, case};

pub const SPACING: f64 = 1e-5;

/// Particles of the bodies of a case anywhere in space.
pub struct World {
    pub case: Case,
    pub table: ContactTable,
    /// Touching value of each ordered pair of bodies.
    touching: Vec<f64>,
    pub particles: ParticleStore,
    images: Vec<Image>,
    pub motion: Vec<MotionRecord>,
}

/// The foreign neighbours of each particle, for `overlap` and for `potential`.
pub type Lists = [Vec<Vec<u32>>; 2];

/// A body whose shape does not matter.
pub fn some_body(material: usize, spacing: f64, h: f64) -> Body {
    let shape = Shape::Box {
        lower: Vec3::zeros(),
        upper: Vec3::repeat(10.0 * spacing),
    };
    Body {
        material,
        smoothing_length: h * spacing,
        ..body("body", shape, spacing, Vec3::zeros())
    }
}

/// Aluminium and copper.
pub fn case_of(dimension: usize, bodies: Vec<Body>) -> Case {
    let mut case = case(dimension, bodies, 1.0);
    case.materials.push(library::find("copper").unwrap());
    case
}

/// A pair of particles of two bodies.
struct Pair {
    /// The smaller p-wave modulus (Pa).
    modulus: f64,
    /// The harmonic mean of the moduli (Pa).
    core_modulus: f64,
    h: f64,
    spacing: f64,
    r: f64,
    /// `W(r, h)`.
    kernel: f64,
}

impl World {
    pub fn new(case: Case, placed: &[(usize, [f64; 3])]) -> Self {
        let mut particles = ParticleStore::default();
        particles.resize_owned(placed.len());
        particles.contact_stiffening.fill(1.0);
        let mut motion = Vec::new();
        for (i, &(b, position)) in placed.iter().enumerate() {
            let body = &case.bodies[b];
            let volume = populate::particle_volume(body, case.dimension);
            particles.id[i] = i as u64;
            particles.body[i] = u32::try_from(b).unwrap();
            particles.mass[i] = volume * case.materials[body.material].reference_density;
            particles.position[i] = position;
            motion.push(MotionRecord {
                position,
                velocity: [0.0; 3],
                volume,
                mass: particles.mass[i],
            });
        }
        let touching = case
            .bodies
            .iter()
            .flat_map(|a| case.bodies.iter().map(move |b| (a, b)))
            .map(|(a, b)| populate::touching_value(a, b, case.dimension))
            .collect();
        Self {
            table: ContactTable::new(&case),
            touching,
            images: (0..placed.len())
                .map(|i| Image::new(i, MirrorMask::OWN))
                .collect(),
            case,
            particles,
            motion,
        }
    }

    pub fn len(&self) -> usize {
        self.motion.len()
    }

    fn view(&self) -> ContactView<'_> {
        ContactView {
            images: &self.images,
            motion: &self.motion,
            particles: &self.particles,
            table: &self.table,
            dt: 0.0,
        }
    }

    fn bodies(&self, i: usize, j: usize) -> (usize, usize) {
        (
            self.particles.body[i] as usize,
            self.particles.body[j] as usize,
        )
    }

    fn distance(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (self.motion[i].position, self.motion[j].position);
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
    }

    /// Foreign neighbours of a receiver in one algorithm, by brute force.
    pub fn neighbours(&self, i: usize, class: ContactClass) -> Vec<u32> {
        (0..self.len())
            .filter(|&j| {
                let (a, b) = self.bodies(i, j);
                let classes = &self.table.foreign.size_classes;
                let pair = classes.smallest(a) * classes.count() + classes.smallest(b);
                a != b
                    && self.table.foreign.class[pair] == Some(class)
                    && self.distance(i, j).powi(2) < self.table.foreign.reach2[pair]
            })
            .map(|j| u32::try_from(j).unwrap())
            .collect()
    }

    pub fn lists(&self) -> Lists {
        [ContactClass::Overlap, ContactClass::Potential]
            .map(|class| (0..self.len()).map(|i| self.neighbours(i, class)).collect())
    }

    /// Fractions of all particles into the store, as the step does.
    pub fn fractions(&mut self, [overlap, _]: &Lists) -> Vec<overlap::Fraction> {
        let all: Vec<_> = (0_u32..)
            .zip(overlap)
            .map(|(place, list)| {
                let offset = self.particles.touch_relief[place as usize];
                overlap::fraction(&self.view(), place, list, offset)
            })
            .collect();
        for (i, fraction) in all.iter().enumerate() {
            self.particles.foreign_fraction[i] = fraction.fraction;
            self.particles.contact_excess[i] = fraction.excess;
            self.particles.contact_modulus[i] = fraction.modulus;
            self.particles.touching_value[i] = fraction.touching;
            self.particles.contact_slope[i] = fraction.slope;
        }
        all
    }

    /// Forces on particle `i` by `overlap` and by `potential`, and what of them each body exerts.
    fn force(
        &self,
        i: usize,
        overlap: &[u32],
        potential: &[u32],
    ) -> (ContactForce, Vec<BodyForce>) {
        let (place, view) = (u32::try_from(i).unwrap(), self.view());
        let mut found = TaskForces::default();
        for (class, list) in [
            (ContactClass::Overlap, overlap),
            (ContactClass::Potential, potential),
        ] {
            found.add::<false>(&view, class, std::iter::once((place, list)));
        }
        let [mut sum, other] = [found.particles[0], found.particles[1]];
        for a in 0..3 {
            sum.force[a] += other.force[a];
        }
        sum.energy += other.energy;
        sum.stiffness += other.stiffness;
        (sum, found.by_body)
    }

    /// Forces on all particles at their positions, and what of them each body exerts.
    pub fn forces(&mut self, lists: &Lists) -> (Vec<ContactForce>, Vec<BodyForce>) {
        self.fractions(lists);
        let all = (0..self.len()).map(|i| self.force(i, &lists[0][i], &lists[1][i]));
        let (forces, by_body): (_, Vec<_>) = all.unzip();
        (forces, by_body.concat())
    }

    /// What particle j alone does to particle i, after [`Self::fractions`].
    pub fn pair_force(&self, i: usize, j: usize, class: ContactClass) -> [f64; 3] {
        let j = [u32::try_from(j).unwrap()];
        let (force, _) = match class {
            ContactClass::Overlap => self.force(i, &j, &[]),
            _ => self.force(i, &[], &j),
        };
        force.force
    }

    fn volume(&self, i: usize) -> f64 {
        populate::particle_volume(
            &self.case.bodies[self.particles.body[i] as usize],
            self.case.dimension,
        )
    }

    /// The contact energy by the formulas of the physics page, section 5, from the case alone.
    pub fn energy(&self) -> f64 {
        let mut energy = 0.0;
        for i in 0..self.len() {
            let (mut fraction, mut modulus, mut touching) = (0.0, 0.0, 0.0);
            for j in 0..self.len() {
                let (a, b) = self.bodies(i, j);
                if a == b {
                    continue;
                }
                let pair = self.pair(i, j);
                match self.case.contact_between(a, b) {
                    ContactMode::Overlap(overlap) => {
                        let weight = self.volume(j) * pair.kernel;
                        fraction += weight;
                        modulus += weight * overlap.stiffness * pair.modulus;
                        touching += weight * self.touching[a * self.case.bodies.len() + b];
                        // Each pair is met twice.
                        energy += 0.5 * self.core_energy(i, j, &pair, overlap);
                    }
                    ContactMode::Potential(potential) => {
                        energy += 0.5 * self.potential_energy(i, j, &pair, potential);
                    }
                    ContactMode::None | ContactMode::Kernel | ContactMode::Penalty(_) => {}
                }
            }
            if fraction > 0.0 {
                let offset = self.particles.touch_relief[i];
                let excess = (fraction - touching / fraction - offset).max(0.0);
                energy += 0.5 * (modulus / fraction) * self.volume(i) * excess * excess;
            }
        }
        energy
    }

    fn pair(&self, i: usize, j: usize) -> Pair {
        let (a, b) = self.bodies(i, j);
        let (a, b) = (&self.case.bodies[a], &self.case.bodies[b]);
        let modulus = |body: &Body| self.case.materials[body.material].p_wave_modulus();
        let h = 0.5 * (a.smoothing_length + b.smoothing_length);
        let r = self.distance(i, j);
        Pair {
            modulus: modulus(a).min(modulus(b)),
            core_modulus: 2.0 * modulus(a) * modulus(b) / (modulus(a) + modulus(b)),
            h,
            spacing: 0.5 * (a.lattice.spacing + b.lattice.spacing),
            r,
            kernel: Kernel::new(self.case.dimension).value(r, h),
        }
    }

    /// `½ κ_c M V̄ ⟨1 − r/r_c⟩₊²`, of bodies at rest.
    fn core_energy(&self, i: usize, j: usize, pair: &Pair, overlap: &Overlap) -> f64 {
        let depth = (1.0 - pair.r / (overlap.core_radius * pair.spacing)).max(0.0);
        let volume = 0.5 * (self.volume(i) + self.volume(j));
        0.5 * overlap.core_stiffness * pair.core_modulus * volume * depth * depth
    }

    /// `V_i V_j K wⁿ` with `w = W/W(Δp)` in the support; closer than the spacing
    /// `V_i V_j K [wⁿ − 1 − n (w − 1)]`.
    fn potential_energy(&self, i: usize, j: usize, pair: &Pair, potential: &Potential) -> f64 {
        let kernel = Kernel::new(self.case.dimension);
        let ratio = pair.kernel / kernel.value(pair.spacing, pair.h);
        let steep = ratio.powi(i32::try_from(potential.exponent).unwrap());
        let steep = match potential.range {
            PotentialRange::Support => steep,
            PotentialRange::Spacing if pair.r >= pair.spacing => return 0.0,
            PotentialRange::Spacing => steep - 1.0 - f64::from(potential.exponent) * (ratio - 1.0),
        };
        let k = potential.stiffness * pair.modulus / kernel.power(pair.spacing);
        self.volume(i) * self.volume(j) * k * steep
    }

    pub fn shift(&mut self, i: usize, axis: usize, by: f64) {
        self.particles.position[i][axis] += by;
        self.motion[i].position[axis] += by;
    }
}
