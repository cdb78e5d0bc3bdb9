//! Where particles stand, and how far they reach.

use engine::sph::Smoothing;
use model::{Body, Case, Quantity, SphForm, edge};
use populate;

/// Particles of a case at one time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Particles {
    /// Where they stand (m).
    pub positions: Vec<[f64; 3]>,
    /// How far each reaches (m): two of them see each other within the sum.
    pub reach: Vec<f64>,
    /// Their bodies.
    pub body: Vec<u32>,
}

impl Particles {
    /// Those that a case begins with, stress points among them.
    #[must_use]
    pub fn at_start(case: &Case) -> Self {
        let smoothing = Smoothing::new(case);
        let mut particles = Self::default();
        for (b, body) in case.bodies.iter().enumerate() {
            let whole = case.particle_mass(body);
            for site in populate::sites(body, case.dimension, &case.symmetry, None) {
                let told = told_mass(body, site.index);
                let mass = told.unwrap_or(whole * site.share);
                let length = body.smoothing_length * edge(site.share, case.dimension);
                particles.add(b, site.position, smoothing.reach_of(b, mass, length));
            }
            if case.sph.form != SphForm::StressPoints {
                continue;
            }
            // They have no mass of their own.
            let reach = smoothing.reach_of(b, 0.0, body.smoothing_length);
            for site in populate::stress_sites(body, case.dimension, &case.symmetry, None) {
                particles.add(b, site.position, reach);
            }
        }
        particles
    }

    /// Saved ones of a case: position (m), body, mass (kg), and the smoothing length (m), zero for that
    /// of the start, or the density (kg/m³) that it follows.
    ///
    /// # Errors
    /// Where one is of a body that there is not.
    pub fn of(
        case: &Case,
        rows: impl Iterator<Item = ([f64; 3], usize, f64, Result<f64, f64>)>,
    ) -> Result<Self, String> {
        let smoothing = Smoothing::new(case);
        let mut particles = Self::default();
        for (position, body, mass, length) in rows {
            if body >= case.bodies.len() {
                return Err(format!(
                    "a particle of none of its {} bodies",
                    case.bodies.len()
                ));
            }
            let length = length.unwrap_or_else(|density| smoothing.length(body, mass, density));
            particles.add(body, position, smoothing.reach_of(body, mass, length));
        }
        Ok(particles)
    }

    /// Takes in more.
    pub fn append(&mut self, mut more: Self) {
        self.positions.append(&mut more.positions);
        self.reach.append(&mut more.reach);
        self.body.append(&mut more.body);
    }

    /// Takes in one more, of a body, at a position (m), which reaches so far (m).
    pub fn add(&mut self, body: usize, position: [f64; 3], reach: f64) {
        self.positions.push(position);
        self.reach.push(reach);
        self.body.push(u32::try_from(body).unwrap_or(u32::MAX));
    }
}

/// What a file tells of the mass (kg) of a particle.
fn told_mass(body: &Body, index: u64) -> Option<f64> {
    let (cloud, _) = body.cloud()?;
    let row = usize::try_from(index).ok()?;
    match cloud.get(Quantity::Mass, row) {
        Some(&[mass]) => Some(mass),
        _ => None,
    }
}
