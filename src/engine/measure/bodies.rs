//! Figures of each body: the rows of `bodies.csv`.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::matter::raise;
use super::{Whole, reading};
use comm::Comm;
use material::FAILED;
use model::{Case, edge};
use numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use numerics::gathered_sums::{GatheredSums, none};
use numerics::ordered::{disordered, ordered};
use numerics::vector::{cross, norm};
use particles::{Active, GRAIN, KeptBlocks, ParticleStore};

/// Figures of a body (SI), the images behind symmetry planes with it. Values that no particle has
/// are NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyFigures {
    /// Number of its particles.
    pub particles: u64,
    /// Mass (kg).
    pub mass: f64,
    /// Momentum (kg m/s).
    pub momentum: [f64; 3],
    /// Angular momentum about the origin (kg m²/s).
    pub angular_momentum: [f64; 3],
    /// `Σ ½ m v²` (J).
    pub kinetic_energy: f64,
    /// `Σ m e` (J).
    pub internal_energy: f64,
    /// Plastic work so far (J).
    pub plastic_energy: f64,
    /// Velocity of its centre of mass (m/s).
    pub velocity: [f64; 3],
    /// Smallest and largest components of the velocities of its particles (m/s).
    pub velocities: [[f64; 3]; 2],
    /// Largest speed (m/s).
    pub speed: f64,
    /// Centre of mass (m).
    pub centre: [f64; 3],
    /// Smallest and largest coordinates (m), half an edge of the outermost particles beyond their
    /// centres.
    pub extents: [[f64; 3]; 2],
    /// Mass that has failed (kg).
    pub failed_mass: f64,
    /// Mass at or above the melting temperature (kg).
    pub molten_mass: f64,
    /// Smallest and largest pressure (Pa), compression positive.
    pub pressures: [f64; 2],
    /// Highest temperature (K).
    pub temperature: f64,
    /// Largest equivalent plastic strain.
    pub plastic_strain: f64,
}

/// Sums of a body: mass, momentum, angular momentum, energies, failed and molten mass, `Σ m x`, and
/// the number of particles.
const SUMS: usize = 16;

/// Largest values of a body: coordinates and velocities with either sign, speed, pressure with
/// either sign, temperature, plastic strain.
const EXTREMES: usize = 17;

/// Extremes that hang on the size of a particle.
const SIZED: usize = 6;

/// Bodies whose parts a task holds; those of more would be large where there are many.
const HELD: usize = 16;

/// Bodies whose sums are joined over ranks at once.
const AT_ONCE: usize = 1024;

/// Sums and extremes of some particles of a body.
struct Part {
    sums: GatheredSums<SUMS>,
    extremes: [f64; EXTREMES],
}

impl Part {
    fn new() -> Self {
        Self {
            sums: GatheredSums::default(),
            extremes: [f64::NEG_INFINITY; EXTREMES],
        }
    }

    /// Takes particle `i` of the store in, of a temperature (K) if it has one.
    fn add(&mut self, case: &Case, particles: &ParticleStore, i: usize, temperature: f64) {
        let (m, thermal) = (particles.mass[i], particles.thermal_mass(i));
        let (x, v) = (&particles.position[i], &particles.velocity[i]);
        let (density, energy) = (particles.density[i], particles.specific_energy[i]);
        let damage = particles.damage.get(i).copied().unwrap_or_default();
        let work = particles.plastic_energy.get(i).copied();
        let material = &case.materials[case.bodies[particles.body[i] as usize].material];
        let distension = particles.distension.get(i).copied().unwrap_or_default();
        let melting = material.melting_temperature(density, distension);
        let molten = melting.is_some_and(|melting| temperature >= melting);
        let (turn, speed) = (cross(x, v), norm(v));
        let mass_if = |yes: bool| if yes { thermal } else { 0.0 };
        self.sums.add(&[
            m,
            m * v[0],
            m * v[1],
            m * v[2],
            m * turn[0],
            m * turn[1],
            m * turn[2],
            0.5 * m * speed * speed,
            thermal * energy,
            thermal * work.unwrap_or_default(),
            mass_if(damage >= FAILED),
            mass_if(molten),
            m * x[0],
            m * x[1],
            m * x[2],
            1.0,
        ]);
        self.reach(x, thermal / density / case.around(x), case.dimension);
        let pressure = particles.pressure[i];
        let extremes = [v, &v.map(|c| -c), &[speed, pressure, -pressure]];
        let last = [temperature, particles.plastic_strain[i]];
        let values = extremes.into_iter().flatten().chain(&last);
        for (most, &value) in self.extremes[SIZED..].iter_mut().zip(values) {
            raise(most, value);
        }
    }

    /// Takes in how far a particle at `x` (m) of a volume (mᵈ) reaches.
    fn reach(&mut self, x: &[f64; 3], volume: f64, dimension: usize) {
        let (upper, lower) = self.extremes[..SIZED].split_at(3);
        let room = (0..3).map(|a| (upper[a] - x[a]).min(lower[a] + x[a]));
        let room = 2.0 * room.fold(f64::INFINITY, f64::min);
        // The root is taken of those alone that may reach beyond all others so far, to more than rounding.
        let within = (1..dimension).fold(room, |power, _| power * room);
        if room > 0.0 && within > 1.1 * volume {
            return;
        }
        let half = 0.5 * edge(volume, dimension);
        for a in 0..3 {
            raise(&mut self.extremes[a], x[a] + half);
            raise(&mut self.extremes[3 + a], half - x[a]);
        }
    }
}

/// Sums and extremes of particles of one body: of an inactive block, or of all.
#[derive(Debug)]
struct Kept {
    body: usize,
    sums: [ExactSum; SUMS],
    extremes: [f64; EXTREMES],
}

impl Kept {
    fn none(body: usize) -> Self {
        Self {
            body,
            sums: none(),
            extremes: [f64::NEG_INFINITY; EXTREMES],
        }
    }

    /// Takes in what other particles of the body come to.
    fn join(&mut self, other: &Self) {
        for (sum, other) in self.sums.iter_mut().zip(&other.sums) {
            sum.merge(other);
        }
        for (most, &other) in self.extremes.iter_mut().zip(&other.extremes) {
            *most = most.max(other);
        }
    }

    /// The figures of the whole, of the sums of all ranks.
    fn figures(&self, whole: Whole) -> BodyFigures {
        let sums = self.sums.each_ref().map(ExactSum::value);
        let three = |first: usize| [sums[first], sums[first + 1], sums[first + 2]];
        let most = |k: usize| match self.extremes[k] {
            f64::NEG_INFINITY => f64::NAN,
            value => value,
        };
        let range = |first: usize| {
            [
                std::array::from_fn(|a| 0.0 - most(first + 3 + a)),
                std::array::from_fn(|a| most(first + a)),
            ]
        };
        let (mass, momentum) = (sums[0], three(1));
        let whole_momentum = whole.momentum(momentum);
        let whole_mass = whole.sum(mass);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count"
        )]
        let particles = whole.sum(sums[15]) as u64;
        BodyFigures {
            particles,
            mass: whole_mass,
            momentum: whole_momentum,
            angular_momentum: whole.angular_momentum(three(4), momentum),
            kinetic_energy: whole.sum(sums[7]),
            internal_energy: whole.sum(sums[8]),
            plastic_energy: whole.sum(sums[9]),
            velocity: whole_momentum.map(|p| p / whole_mass),
            velocities: whole.velocities(range(6)),
            speed: most(12),
            centre: whole.mean_position(three(12).map(|c| c / mass)),
            extents: whole.extents(range(0)),
            failed_mass: whole.sum(sums[10]),
            molten_mass: whole.sum(sums[11]),
            pressures: [0.0 - most(14), most(13)],
            temperature: most(15),
            plastic_strain: most(16),
        }
    }
}

/// Sums and extremes of inactive particles of bodies, kept from one row to the next.
#[derive(Debug, Default)]
pub struct KeptBodies(KeptBlocks<Kept>);

impl KeptBodies {
    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.0.memory()
    }
}

/// The figures of each body, in the order of the case, with the `kept` ones of inactive particles. Collective.
#[must_use]
pub fn bodies(
    case: &Case,
    active: Active,
    kept: &mut KeptBodies,
    whole: Whole,
    comm: &Comm,
) -> Vec<BodyFigures> {
    let particles = active.particles;
    let all = Shared::of(case.bodies.len());
    let add = |places: Range<usize>, parts: &mut Parts| {
        let mut temperatures = [0.0; GRAIN];
        for first in places.clone().step_by(GRAIN) {
            let temperatures = &mut temperatures[..GRAIN.min(places.end - first)];
            reading::temperatures(case, particles, first, temperatures);
            for (k, &temperature) in temperatures.iter().enumerate() {
                let i = first + k;
                let part = parts.of(particles.body[i] as usize);
                part.add(case, particles, i, temperature);
            }
        }
    };
    let of_inactive = |places: Range<usize>| {
        let of = &particles.body[places.clone()];
        of.iter().all(|body| *body == of[0]).then_some(())?;
        let mut parts = Parts::of_shared(&all);
        add(places, &mut parts);
        let (body, Part { sums, extremes }) = parts.held.pop()?;
        Some(Kept {
            body,
            sums: sums.into_sums(),
            extremes,
        })
    };
    (kept.0)
        .each(active.particles.owned(), active.inactive)
        // same bits in any order: exact sums are integers, and extremes are some value among all
        .for_each_init(
            || Parts::of_shared(&all),
            |parts, mut block| match block.kept(of_inactive) {
                Some(kept) => all.take(kept),
                None => add(block.places(), parts),
            },
        );
    figures(all, whole, comm)
}

/// Parts of a few bodies that a task holds; what it holds no longer goes to those of all.
struct Parts<'a> {
    held: Vec<(usize, Part)>,
    /// Place of the part that was added to last, and of the one that makes room next.
    last: usize,
    next: usize,
    all: &'a Shared,
}

impl<'a> Parts<'a> {
    fn of_shared(all: &'a Shared) -> Self {
        Self {
            held: Vec::new(),
            last: 0,
            next: 0,
            all,
        }
    }

    /// The part of a body.
    fn of(&mut self, body: usize) -> &mut Part {
        let is_last = (self.held.get(self.last)).is_some_and(|(held, _)| *held == body);
        if !is_last {
            let place = self.held.iter().position(|(held, _)| *held == body);
            self.last = place.unwrap_or_else(|| self.begin(body));
        }
        &mut self.held[self.last].1
    }

    /// Begins the part of another body, and tells where it is held.
    fn begin(&mut self, body: usize) -> usize {
        let part = (body, Part::new());
        if self.held.len() < HELD {
            self.held.push(part);
            return self.held.len() - 1;
        }
        let place = self.next;
        self.next = (place + 1) % HELD;
        self.all
            .take(&std::mem::replace(&mut self.held[place], part).into());
        place
    }
}

impl Drop for Parts<'_> {
    fn drop(&mut self) {
        for part in self.held.drain(..) {
            self.all.take(&part.into());
        }
    }
}

impl From<(usize, Part)> for Kept {
    fn from((body, part): (usize, Part)) -> Self {
        let Part { sums, extremes } = part;
        Self {
            body,
            sums: sums.into_sums(),
            extremes,
        }
    }
}

/// What bodies with particles here come to, joined by any tasks in any order.
struct Shared(Vec<Mutex<Option<Box<Kept>>>>);

impl Shared {
    fn of(bodies: usize) -> Self {
        Self((0..bodies).map(|_| Mutex::new(None)).collect())
    }

    fn take(&self, kept: &Kept) {
        let mut body = self.0[kept.body]
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        body.get_or_insert_with(|| Box::new(Kept::none(kept.body)))
            .join(kept);
    }
}

/// The figures of all bodies, some at a time: their sums take far more memory. Collective.
fn figures(all: Shared, whole: Whole, comm: &Comm) -> Vec<BodyFigures> {
    let mut figures = Vec::with_capacity(all.0.len());
    let mut bodies = (all.0.into_iter())
        .map(|body| body.into_inner().unwrap_or_else(PoisonError::into_inner))
        .enumerate();
    loop {
        let some = bodies.by_ref().take(AT_ONCE);
        let mut some: Vec<Box<Kept>> = some
            .map(|(body, kept)| kept.unwrap_or_else(|| Box::new(Kept::none(body))))
            .collect();
        if some.is_empty() {
            return figures;
        }
        join_ranks(&mut some, comm);
        figures.extend(some.iter().map(|kept| kept.figures(whole)));
    }
}

/// Joins what bodies come to on all ranks. Collective.
fn join_ranks(bodies: &mut [Box<Kept>], comm: &Comm) {
    let mut limbs = Vec::new();
    let sums = bodies.iter_mut().flat_map(|body| &mut body.sums);
    gather_limbs(sums, &mut limbs);
    comm.sum_i64(&mut limbs);
    let sums = bodies.iter_mut().flat_map(|body| &mut body.sums);
    scatter_limbs(sums, &limbs);
    let extremes = bodies.iter().flat_map(|body| body.extremes);
    let mut words: Vec<u64> = extremes.map(ordered).collect();
    comm.max_u64(&mut words);
    let extremes = bodies.iter_mut().flat_map(|body| &mut body.extremes);
    for (most, &word) in extremes.zip(&words) {
        *most = disordered(word);
    }
}
