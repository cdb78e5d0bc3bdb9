//! Coordinate axes, and planes normal to them.

use serde::Deserialize;

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// First coordinate.
    X,
    /// Second coordinate.
    Y,
    /// Third coordinate.
    Z,
}

impl Axis {
    /// All three axes in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The axis of a [`Self::name`].
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|axis| axis.name() == name)
    }

    /// 0, 1 or 2.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// `"x"`, `"y"` or `"z"`.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["x", "y", "z"][self.index()]
    }
}

/// A plane of symmetry normal to a coordinate axis. The model keeps the side above it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SymmetryPlane {
    /// Normal of the plane.
    pub axis: Axis,
    /// Position of the plane on that axis (m).
    pub position: f64,
}
