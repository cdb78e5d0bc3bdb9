//! Isentropic release of a shocked Mie–Grüneisen material at a free surface.

use exact::hugoniot::{Impact, Medium, Shock};

/// Steps of the fourth-order integration along a release isentrope.
const STEPS: u32 = 1000;

/// Velocity of the free back surface of the target (m/s), before any release from elsewhere.
pub fn free_surface_velocity(target: &Medium, impact: &Impact) -> f64 {
    impact.interface_velocity + release_velocity(target, &impact.target)
}

/// Velocity gained by isentropic release of a shocked state to zero pressure (m/s).
///
/// Riemann integral `∫ dp/(ρ c)` along `dρ/dp = 1/c²`, `de/dp = p/(ρ c)²` from the shocked
/// pressure to zero, by Runge–Kutta of fourth order.
fn release_velocity(medium: &Medium, shock: &Shock) -> f64 {
    let step = -shock.pressure / f64::from(STEPS);
    let mut state = [shock.density, shock.specific_energy, 0.0];
    for i in 0..STEPS {
        let p = shock.pressure + f64::from(i) * step;
        let k1 = along_isentrope(medium, p, state);
        let k2 = along_isentrope(medium, p + 0.5 * step, moved(state, k1, 0.5 * step));
        let k3 = along_isentrope(medium, p + 0.5 * step, moved(state, k2, 0.5 * step));
        let k4 = along_isentrope(medium, p + step, moved(state, k3, step));
        for (j, value) in state.iter_mut().enumerate() {
            *value += step / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]);
        }
    }
    -state[2]
}

/// Derivatives of `[ρ, e, ∫ dp/(ρ c)]` by pressure, on the isentrope.
fn along_isentrope(medium: &Medium, p: f64, [rho, e, _]: [f64; 3]) -> [f64; 3] {
    let at = medium.eos.response(medium.reference_density, rho, e);
    let c_squared = at.dp_drho + p / (rho * rho) * at.dp_de;
    let impedance = rho * c_squared.sqrt();
    [
        1.0 / c_squared,
        p / (impedance * impedance),
        1.0 / impedance,
    ]
}

fn moved(state: [f64; 3], slope: [f64; 3], by: f64) -> [f64; 3] {
    std::array::from_fn(|k| state[k] + by * slope[k])
}
