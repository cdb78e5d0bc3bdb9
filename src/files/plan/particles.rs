//! Positions and ranges of particles.

use std::convert::Infallible;

use engine::sph::Smoothing;
use model::{Body, Case, Quantity, SphForm, edge};
use populate;

/// Particles of a case at one time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Particles {
    /// Positions (m).
    pub positions: Vec<[f64; 3]>,
    /// Range of each (m): two particles interact within the sum of theirs.
    pub reach: Vec<f64>,
    /// Their bodies.
    pub body: Vec<u32>,
}

impl Particles {
    /// The initial particles of a case, stress points included.
    #[must_use]
    pub fn at_start(case: &Case) -> Self {
        let smoothing = Smoothing::new(case);
        let mut particles = Self::default();
        let counts = populate::counts(case, None);
        let Ok(()) = populate::for_each_body(case, None, &counts, |b, sites| {
            let body = &case.bodies[b];
            let whole = case.particle_mass(body);
            for site in sites {
                let mass = mass_in_file(body, site.index).unwrap_or(whole * site.share);
                let length = body.smoothing_length * edge(site.share, case.dimension);
                particles.add(b, site.position, smoothing.reach_of(b, mass, length));
            }
            if case.sph.form != SphForm::StressPoints {
                return Ok::<(), Infallible>(());
            }
            // Stress points have no mass of their own.
            let reach = smoothing.reach_of(b, 0.0, body.smoothing_length);
            for site in populate::stress_sites(body, case.dimension, &case.symmetry, None) {
                particles.add(b, site.position, reach);
            }
            Ok(())
        });
        particles
    }

    /// Saved particles of a case: position (m), body, mass (kg), and the smoothing length (m), zero for that
    /// of the start, or the density (kg/m³) that it follows.
    ///
    /// # Errors
    /// If one is of a body that does not exist.
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

    /// Appends other particles.
    pub fn append(&mut self, mut more: Self) {
        self.positions.append(&mut more.positions);
        self.reach.append(&mut more.reach);
        self.body.append(&mut more.body);
    }

    /// Adds a particle of a body at a position (m) with a range (m).
    pub fn add(&mut self, body: usize, position: [f64; 3], reach: f64) {
        self.positions.push(position);
        self.reach.push(reach);
        self.body.push(u32::try_from(body).unwrap_or(u32::MAX));
    }
}

/// The mass (kg) of a particle in the file of its body, if it has one.
fn mass_in_file(body: &Body, index: u64) -> Option<f64> {
    let (cloud, _) = body.cloud()?;
    let row = usize::try_from(index).ok()?;
    match cloud.get(Quantity::Mass, row) {
        Some(&[mass]) => Some(mass),
        _ => None,
    }
}
