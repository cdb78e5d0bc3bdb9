//! The arguments of the equations.

/// A bumper, a gap, stuffing in it or none, and a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shield {
    /// Thickness of the bumper t_b (m).
    pub bumper: f64,
    /// Thickness of the wall t_w (m).
    pub wall: f64,
    /// Distance from the bumper to the wall S (m).
    pub gap: f64,
    /// Yield strength of the wall σ (Pa).
    pub yield_strength: f64,
    /// Density of the bumper ρ_b (kg/m³).
    pub bumper_density: f64,
    /// Density of the wall ρ_w (kg/m³).
    pub wall_density: f64,
    /// Areal mass of the stuffing (kg/m²).
    pub stuffing: f64,
}

/// A projectile that flies, but for its size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shot {
    /// Speed V (m/s).
    pub speed: f64,
    /// Angle from the normal of the shield θ (rad).
    pub angle: f64,
    /// Density of the projectile ρ_p (kg/m³).
    pub density: f64,
}

impl Shot {
    /// The same at another speed (m/s).
    #[must_use]
    pub fn at(self, speed: f64) -> Self {
        Self { speed, ..self }
    }
}
