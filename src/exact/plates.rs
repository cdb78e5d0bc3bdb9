//! Two plates of Mie–Grüneisen materials without strength that meet: the shocks while they run.

use super::hugoniot::{Medium, Shock, impact};
use super::{Profile, Sample};

/// A plate at rest in itself, without pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// Its material.
    pub medium: Medium,
    /// Coordinate of the left face at the start (m).
    pub left: f64,
    /// Thickness (m).
    pub length: f64,
    /// Velocity at the start (m/s).
    pub velocity: f64,
}

/// The profile of two plates is unknown: a release wave runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Released {
    /// Time at which the first shock has reached a free face (s).
    pub since: f64,
}

impl Plate {
    fn undisturbed(&self, position: f64) -> Sample {
        Sample {
            position,
            velocity: self.velocity,
            density: self.medium.reference_density,
            pressure: 0.0,
            deviatoric_stress: 0.0,
            specific_energy: 0.0,
        }
    }
}

/// The states of two plates, left and right, at time `t` (s): undisturbed before they meet, then
/// shocked on both sides of the interface.
///
/// # Errors
/// [`Released`] once a shock has reached a free face.
pub fn profile([left, right]: [&Plate; 2], t: f64) -> Result<Profile, Released> {
    let closing = left.velocity - right.velocity;
    let gap = (right.left - (left.left + left.length)).max(0.0);
    let meet = if closing > 0.0 {
        gap / closing
    } else {
        f64::INFINITY
    };
    let [a, b] = [
        left.left + left.velocity * t,
        right.left + right.velocity * t,
    ];
    let ends = [a, a + left.length, b, b + right.length];
    if t <= meet {
        let line = |plate: &Plate, k: usize| {
            vec![plate.undisturbed(ends[k]), plate.undisturbed(ends[k + 1])]
        };
        return Ok(vec![line(left, 0), line(right, 2)]);
    }
    let result = impact(&left.medium, &right.medium, closing);
    let least =
        (left.length / result.flyer.shock_speed).min(right.length / result.target.shock_speed);
    if t > meet + least {
        return Err(Released {
            since: meet + least,
        });
    }
    let velocity = right.velocity + result.interface_velocity;
    let interface = left.left + left.length + left.velocity * meet;
    let at = |speed: f64| interface + speed * (t - meet);
    let shocked = |shock: &Shock, position: f64| Sample {
        position,
        velocity,
        density: shock.density,
        pressure: shock.pressure,
        deviatoric_stress: 0.0,
        specific_energy: shock.specific_energy,
    };
    let fronts = [
        at(left.velocity - result.flyer.shock_speed),
        at(right.velocity + result.target.shock_speed),
    ];
    let (flyer, target) = (&result.flyer, &result.target);
    Ok(vec![
        vec![
            left.undisturbed(ends[0]),
            left.undisturbed(fronts[0]),
            shocked(flyer, fronts[0]),
            shocked(flyer, at(velocity)),
        ],
        vec![
            shocked(target, at(velocity)),
            shocked(target, fronts[1]),
            right.undisturbed(fronts[1]),
            right.undisturbed(ends[3]),
        ],
    ])
}
