//! The matter of an axisymmetric case in space, as measures of holes, craters and clouds look at it: a quarter of each
//! ring, as particles as wide as the ring is.

use super::matter::{HeldMatter, Matter};
use model::Case;

/// Matter of a quarter of the model in space.
pub struct Revolved {
    case: Case,
    held: HeldMatter,
}

impl Revolved {
    /// Of the matter of a case, if that is axisymmetric.
    #[must_use]
    pub fn of(flat: &Matter) -> Option<Self> {
        if !flat.case.axisymmetric {
            return None;
        }
        let mut space = Self {
            case: flat.case.revolved(),
            held: HeldMatter::default(),
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
        let held = &mut self.held;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number from one on"
        )]
        for n in 0..count as u32 {
            let angle = quarter * (f64::from(n) + 0.5) / count;
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            held.body.push(flat.body[i]);
            held.position.push([x * cosine, y, x * sine]);
            held.velocity.push([across * cosine, along, across * sine]);
            held.mass.push(mass);
            held.density.push(flat.density[i]);
            held.pressure.push(flat.pressure[i]);
            held.plastic_strain.push(flat.plastic_strain[i]);
            held.damage.extend(flat.damage.get(i));
        }
    }

    /// As measures take it.
    #[must_use]
    pub fn matter(&self) -> Matter<'_> {
        self.held.of(&self.case)
    }
}
