//! Matter whose fragments are looked for, and by which rule.

use model::{Body, Case, FragmentOptions, Include, edge};
use numerics::ellipsoid::Ellipsoid;
use particles::Image;
use particles::Mirrors;

/// Rule by which particles hang together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Largest distance of linked particles, over the mean of their sizes at the start.
    pub link: f64,
    /// True if a single particle joins what hangs together by nothing else.
    pub bridges: bool,
    /// True if particles of different bodies are linked.
    pub across_bodies: bool,
    /// Least number of particles of a fragment; the rest is dust.
    pub least: u64,
    /// Dimensions of the model.
    pub dimension: usize,
}

impl Rule {
    /// That of a case's options.
    #[must_use]
    pub fn new(options: &FragmentOptions, dimension: usize) -> Self {
        Self {
            link: options.link,
            bridges: options.bridges,
            across_bodies: options.across_bodies,
            least: options.min_particles,
            dimension,
        }
    }
}

/// Particles of this rank, and of some of it halo particles after them.
#[derive(Debug, Clone, Copy)]
pub struct Matter<'a> {
    /// Particles of this rank.
    pub owned: usize,
    /// Number of bodies.
    pub bodies: usize,
    /// Identities, of halo particles too.
    pub ids: &'a [u64],
    /// Indices of bodies, of halo particles too.
    pub body: &'a [u32],
    /// Positions (m), of halo particles too.
    pub position: &'a [[f64; 3]],
    /// Sizes at the start (m), of halo particles too: zero for what is no matter.
    pub size: &'a [f64],
    /// Deformation gradients, of halo particles too: zero for what has none. Empty if nothing has one.
    pub deformation: &'a [[f64; 9]],
    /// True if each may belong to a fragment.
    pub included: &'a [bool],
    /// Masses (kg).
    pub mass: &'a [f64],
    /// Velocities (m/s).
    pub velocity: &'a [[f64; 3]],
    /// Temperatures (K); NaN where there is none.
    pub temperature: &'a [f64],
    /// Equivalent plastic strains.
    pub plastic_strain: &'a [f64],
}

/// Surroundings of a rank's particles.
#[derive(Debug, Clone, Copy)]
pub struct Surroundings<'a> {
    /// The symmetry planes.
    pub mirrors: &'a Mirrors,
    /// Halo particles, and images behind planes, that may be linked with this rank's particles.
    pub others: &'a [Image],
}

/// Size of the particles of a body at the start.
#[derive(Debug, Clone, Copy)]
pub struct FirstSizes {
    /// Spacing (m); the finest where it varies.
    pub spacing: f64,
    /// The coarsest (m).
    pub coarsest: f64,
    /// Initial density (kg/m³).
    pub density: f64,
}

impl FirstSizes {
    /// Of a body of a case.
    #[must_use]
    pub fn new(case: &Case, body: &Body) -> Self {
        Self {
            spacing: body.lattice.spacing,
            coarsest: body.lattice.coarsest(),
            density: case.initial_density(body),
        }
    }

    /// Size (m) of a particle of a mass: the spacing, or where that varies `(m/ρ₀)^(1/d)`; zero of
    /// what has no mass.
    #[must_use]
    pub fn of(&self, mass: f64, dimension: usize) -> f64 {
        if mass <= 0.0 || mass.is_nan() {
            0.0
        } else if self.coarsest > self.spacing {
            let size = edge(mass / self.density, dimension);
            // Whatever a file says.
            if size.is_finite() { size } else { 0.0 }
        } else {
            self.spacing
        }
    }
}

/// Reach of a particle of a size (m), and what its deformation gradient has made of that in each direction, if it has one. Two
/// are linked within the sum of both.
#[must_use]
pub fn link_reach(link: f64, size: f64, gradient: Option<&[f64; 9]>) -> (f64, Option<Ellipsoid>) {
    let reach = 0.5 * link * size;
    let deformed = gradient.and_then(|gradient| Ellipsoid::image(reach, gradient));
    let farthest = deformed.map_or(reach, |deformed| deformed.farthest());
    (farthest, deformed)
}

/// The images behind planes that a rank by itself needs of its particles.
#[must_use]
pub fn images(mirrors: &Mirrors, matter: &Matter, link: f64) -> Vec<Image> {
    if mirrors.is_empty() {
        return Vec::new();
    }
    let reach = |i: usize| link_reach(link, matter.size[i], matter.deformation.get(i)).0;
    let reaches: Vec<f64> = (0..matter.owned).map(reach).collect();
    let farthest = reaches.iter().copied().fold(0.0, f64::max);
    let all = matter.position.iter().zip(reaches).enumerate();
    let near = all.flat_map(|(i, (position, reach))| {
        let near = mirrors.near(position, reach + farthest);
        let mirror_masks = near.subsets(false);
        mirror_masks.map(move |mirror_mask| Image::new(i, mirror_mask))
    });
    near.collect()
}

/// True if a particle of a damage belongs to fragments.
#[must_use]
pub fn belongs(include: Include, damage: f64) -> bool {
    include == Include::All || damage < 1.0
}
