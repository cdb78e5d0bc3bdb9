//! The matter of an axisymmetric case in space, as measures of holes, craters and clouds look at it: a quarter of each
//! ring, as particles as wide as the ring is.

use super::matter::Matter;
use model::Case;
use particles::Mirrors;

/// Matter of a quarter of the model in space.
pub struct Revolved {
    case: Case,
    mirrors: Mirrors,
    body: Vec<u32>,
    position: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    mass: Vec<f64>,
    density: Vec<f64>,
    pressure: Vec<f64>,
    plastic_strain: Vec<f64>,
    damage: Vec<f64>,
}

impl Revolved {
    /// Of the matter of a case, if that is axisymmetric.
    #[must_use]
    pub fn of(flat: &Matter) -> Option<Self> {
        if !flat.case.axisymmetric {
            return None;
        }
        let case = flat.case.revolved();
        let mut space = Self {
            mirrors: Mirrors::of(&case),
            case,
            body: Vec::new(),
            position: Vec::new(),
            velocity: Vec::new(),
            mass: Vec::new(),
            density: Vec::new(),
            pressure: Vec::new(),
            plastic_strain: Vec::new(),
            damage: Vec::new(),
        };
        for i in 0..flat.len() {
            space.add(flat, i);
        }
        Some(space)
    }

    /// Adds a quarter of a ring.
    fn add(&mut self, flat: &Matter, i: usize) {
        let ([x, y, _], [across, along, _]) = (flat.position[i], flat.velocity[i]);
        let quarter = std::f64::consts::FRAC_PI_2;
        let arc = quarter * x;
        // Particles as long as the ring is wide.
        let area = 0.25 * flat.volume(i) / arc.max(f64::MIN_POSITIVE);
        let count = (arc / area.sqrt()).round().max(1.0);
        let mass = 0.25 * flat.mass[i] / count;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number from one on"
        )]
        for n in 0..count as u32 {
            let angle = quarter * (f64::from(n) + 0.5) / count;
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            self.body.push(flat.body[i]);
            self.position.push([x * cosine, y, x * sine]);
            self.velocity.push([across * cosine, along, across * sine]);
            self.mass.push(mass);
            self.density.push(flat.density[i]);
            self.pressure.push(flat.pressure[i]);
            self.plastic_strain.push(flat.plastic_strain[i]);
            self.damage.extend(flat.damage.get(i));
        }
    }

    /// As measures take it.
    #[must_use]
    pub fn matter(&self) -> Matter<'_> {
        Matter {
            case: &self.case,
            mirrors: self.mirrors,
            body: &self.body,
            position: &self.position,
            velocity: &self.velocity,
            mass: &self.mass,
            stress_mass: &[],
            density: &self.density,
            pressure: &self.pressure,
            plastic_strain: &self.plastic_strain,
            damage: &self.damage,
        }
    }
}
