//! The configuration whose neighbours the sums of a body are over.

use super::{Case, ClosingSpeeds, ContactMode, Quantity, SmoothingLength, SphForm};
use serde::Deserialize;

/// Speed of bodies against each other, over the longitudinal sound speed, up to which the total form is the default: what
/// meets faster tears at once.
const SLOW: f64 = 0.1;

/// Choice of the configuration whose neighbours the sums of a body are over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BodyForm {
    /// The initial one of what yields and nothing meets faster than a tenth of its sound speed.
    #[default]
    Auto,
    /// The initial one, until the body tears.
    Total,
    /// That of each step.
    Updated,
}

impl Case {
    /// Obstacle to the total form of a body, in words; none if there is none.
    #[must_use]
    pub fn total_obstacle(&self, body: usize) -> Option<String> {
        let (sph, own) = (&self.sph, &self.bodies[body]);
        let term = sph.terms.acting().next();
        let term = term.map(|(_, key)| format!("`sph.{key}` needs the neighbours of each step"));
        let obstacles = [
            (self.axisymmetric, "its particles are rings about an axis"),
            (own.rigid.is_some(), "it is rigid"),
            (
                sph.form != SphForm::Corrected,
                "`sph.form` is another than \"corrected\"",
            ),
            (
                self.materials[own.material].strength.shear_modulus() <= 0.0,
                "its material is a fluid",
            ),
            (
                sph.smoothing_length != SmoothingLength::Constant,
                "the smoothing length is variable",
            ),
            (term.is_some(), term.as_deref().unwrap_or_default()),
            (
                self.is_joined(body),
                "`kernel` contact needs the neighbours of each step",
            ),
            (
                self.loads.absorbers.iter().any(|zone| zone.body == body),
                "an absorbing zone relaxes it",
            ),
            (
                own.holds(Quantity::Density),
                "its file gives each particle a density",
            ),
            (
                self.loads.pressures.iter().any(|load| load.body == body),
                "a pressure acts on its faces",
            ),
            (
                own.initial.varies_in_stress(),
                "the stress that it begins under gives each particle a density",
            ),
        ];
        let first = obstacles.into_iter().find(|(is_there, _)| *is_there);
        first.map(|(_, why)| why.to_owned())
    }

    /// True if `kernel` contact joins a body with another.
    fn is_joined(&self, body: usize) -> bool {
        let joins = |mode: &ContactMode| matches!(mode, ContactMode::Kernel);
        if joins(&self.default_contact) {
            let mut others = (0..self.bodies.len()).filter(|&other| other != body);
            return others.any(|other| joins(self.contact_between(body, other)));
        }
        let mut pairs = self.contacts.iter();
        pairs.any(|pair| pair.bodies.contains(&body) && joins(&pair.mode))
    }

    /// True if a body flows, slowly: its material yields, but not under its own weight as sand does, and nothing meets the body faster than a
    /// tenth of its longitudinal sound speed, as far as the case with these speeds says, and it does not deform faster
    /// either.
    #[must_use]
    pub fn flows_slowly(&self, body: usize, speeds: &ClosingSpeeds) -> bool {
        let own = &self.bodies[body];
        let outside = if self.loads.surfaces.is_empty() && self.symmetry.is_empty() {
            0.0
        } else {
            own.velocity.norm()
        };
        let material = &self.materials[own.material];
        let (slow, spread) = (SLOW * material.longitudinal_speed(), own.speed_spread());
        let is_slow = || {
            let velocities = self.known_velocities(body);
            outside + spread <= slow && !speeds.exceed(body, &velocities, spread, slow)
        };
        let strength = &material.strength;
        strength.yields() && strength.yield_stress() > 0.0 && is_slow()
    }
}
