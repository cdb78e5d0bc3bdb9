//! The stress that a body begins under.

use super::{Axis, Place, Profile, Vec3};

/// The stress that a body begins under.
#[derive(Debug, Clone, PartialEq)]
pub enum Loading {
    /// A pressure (Pa), compression positive.
    Pressure(Profile),
    /// A stress `xx yy zz xy xz yz` (Pa), tension positive.
    Stress(Box<[Profile; 6]>),
    /// That of the weight of the matter above.
    Overburden(Column),
}

impl Loading {
    /// Its key in the input.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::Pressure(_) => "pressure",
            Self::Stress(_) => "stress",
            Self::Overburden(_) => "overburden",
        }
    }

    /// The stress `xx yy zz xy xz yz` (Pa), tension positive, at a position (m), which is a place of the body.
    #[must_use]
    pub fn at(&self, position: &Vec3, place: &Place) -> [f64; 6] {
        match self {
            Self::Pressure(pressure) => {
                let stress = -pressure.at(place);
                [stress, stress, stress, 0.0, 0.0, 0.0]
            }
            Self::Stress(components) => components.each_ref().map(|c| c.at(place)),
            Self::Overburden(column) => column.stress(position),
        }
    }

    /// `true` if it is not the same everywhere.
    #[must_use]
    pub fn varies(&self) -> bool {
        match self {
            Self::Pressure(pressure) => pressure.constant().is_none(),
            Self::Stress(components) => components.iter().any(|c| c.constant().is_none()),
            Self::Overburden(_) => true,
        }
    }
}

/// Intervals of a column.
const INTERVALS: u32 = 256;

/// Stress under the weight of a column of matter: the vertical stress is `σ_v = ∫ ρ g dz`, both lateral ones are a share of
/// it.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    of: ColumnOf,
    /// Vertical stress (Pa), compression positive, and its growth in an interval (Pa), at each node of the depth.
    rows: Vec<[f64; 2]>,
}

/// What a column is of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColumnOf {
    /// The axis of gravity.
    pub axis: Axis,
    /// 1 or −1: the sense of the axis in which things fall.
    pub down: f64,
    /// Where the axis enters the body (m).
    pub top: f64,
    /// How deep the body is (m).
    pub depth: f64,
    /// Lateral stress over vertical stress.
    pub lateral: f64,
    /// Vertical stress of what lies on the body (Pa).
    pub above: f64,
}

impl Column {
    /// A column of matter whose specific weight (N/m³) at a depth (m) and a pressure (Pa) is `weight`, by Runge and Kutta's
    /// fourth-order rule; none where the matter has none.
    #[must_use]
    pub fn new(of: ColumnOf, weight: impl Fn(f64, f64) -> Option<f64>) -> Option<Self> {
        let width = of.depth / f64::from(INTERVALS);
        let share = (1.0 + 2.0 * of.lateral) / 3.0;
        let growth = |depth: f64, vertical: f64| Some(width * weight(depth, share * vertical)?);
        let mut vertical = of.above;
        let mut rows = vec![[vertical, growth(0.0, vertical)?]];
        for n in 0..INTERVALS {
            let depth = width * f64::from(n);
            let a = rows[n as usize][1];
            let b = growth(depth + 0.5 * width, vertical + 0.5 * a)?;
            let c = growth(depth + 0.5 * width, vertical + 0.5 * b)?;
            let d = growth(depth + width, vertical + c)?;
            vertical += (a + 2.0 * (b + c) + d) / 6.0;
            rows.push([vertical, growth(depth + width, vertical)?]);
        }
        Some(Self { of, rows })
    }

    /// Vertical stress (Pa), compression positive, at a depth (m), which stays within the body.
    #[must_use]
    pub fn vertical(&self, depth: f64) -> f64 {
        let place = f64::from(INTERVALS) * (depth / self.of.depth).clamp(0.0, 1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the table
        let n = (place as usize).min(self.rows.len() - 2);
        #[allow(clippy::cast_precision_loss, reason = "at most 256")]
        let t = place - n as f64;
        let ([a, of_a], [b, of_b]) = (self.rows[n], self.rows[n + 1]);
        let (s, rise) = (1.0 - t, b - a);
        a * s + b * t + t * s * ((of_a - rise) * s - (of_b - rise) * t)
    }

    /// Stress `xx yy zz xy xz yz` (Pa), tension positive, at a position (m).
    #[must_use]
    pub fn stress(&self, position: &Vec3) -> [f64; 6] {
        let (axis, of) = (self.of.axis.index(), &self.of);
        let vertical = self.vertical(of.down * (position[axis] - of.top));
        let mut stress = [0.0; 6];
        for (a, component) in stress[..3].iter_mut().enumerate() {
            *component = -vertical * if a == axis { 1.0 } else { of.lateral };
        }
        stress
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `ρ = ρ₀ exp(p/K)` under its own weight: `p = −K ln(1 − ρ₀ g z/K)`.
    #[test]
    fn a_column_has_the_pressure_of_its_weight() {
        let (weight, modulus) = (2.6e4, 3e10);
        let of = ColumnOf {
            axis: Axis::Y,
            down: -1.0,
            top: 5.0,
            depth: 1e5,
            lateral: 1.0,
            above: 0.0,
        };
        let column = Column::new(of, |_, p| Some(weight * (p / modulus).exp())).unwrap();
        for depth in [0.0, 1.0, 777.0, 3.3e4, 1e5] {
            let exact = -modulus * (1.0 - weight * depth / modulus).ln();
            let found = column.stress(&Vec3::new(9.0, 5.0 - depth, 0.0));
            for component in &found[..3] {
                assert!(
                    (component + exact).abs() <= 1e-9 * exact,
                    "{found:?} {exact}"
                );
            }
        }
        let rows = Column::new(
            ColumnOf {
                above: 7.0,
                lateral: 0.5,
                ..of
            },
            |_, _| Some(0.0),
        );
        let found = rows.unwrap().stress(&Vec3::new(0.0, -50.0, 0.0));
        assert_eq!(found, [-3.5, -7.0, -3.5, 0.0, 0.0, 0.0]);
        assert_eq!(
            Column::new(of, |depth, _| (depth < 10.0).then_some(1.0)),
            None
        );
    }
}
