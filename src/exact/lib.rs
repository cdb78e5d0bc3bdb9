//! Analytic solutions, shared by tests and plots.
//!
//! Mathematics from `libm` and nothing of the engine, so that a solution is the same everywhere
//! and checks the engine from outside.

pub mod bars;
pub mod finite_strain;
pub mod hugoniot;
pub mod plates;
pub mod riemann;

/// Halvings of a bracket: more than a double can resolve.
const BISECTIONS: usize = 200;

/// The root of a function that is not positive at `low` and not negative at `high`.
#[must_use]
pub fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// The state of a material at a position, in one dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Current position (m).
    pub position: f64,
    /// Velocity (m/s).
    pub velocity: f64,
    /// Density (kg/m³).
    pub density: f64,
    /// Pressure, compression positive (Pa).
    pub pressure: f64,
    /// Deviatoric stress along the coordinate, tension positive (Pa).
    pub deviatoric_stress: f64,
    /// Specific internal energy (J/kg).
    pub specific_energy: f64,
}

impl Sample {
    /// Stress along the coordinate, tension positive (Pa).
    #[must_use]
    pub fn stress(&self) -> f64 {
        self.deviatoric_stress - self.pressure
    }

    /// The same state elsewhere.
    #[must_use]
    pub fn at(self, position: f64) -> Self {
        Self { position, ..self }
    }
}

/// Samples along a coordinate, a line for each connected stretch of material; two at one position
/// are the sides of a jump.
pub type Profile = Vec<Vec<Sample>>;
