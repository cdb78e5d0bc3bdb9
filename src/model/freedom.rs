//! How a rigid body that forces move can move.

use super::{Body, Case, Vec3};

/// Axes along which and about which a rigid body is free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Freedom {
    /// Axes along which it can move.
    pub moves: [bool; 3],
    /// Axes about which it can turn: all, one or none.
    pub turns: [bool; 3],
    /// The point that stays where it is, and about which the body turns (m), if any.
    pub pivot: Option<Vec3>,
}

impl Default for Freedom {
    fn default() -> Self {
        Self {
            moves: [true; 3],
            turns: [true; 3],
            pivot: None,
        }
    }
}

impl Case {
    /// The freedom of a rigid body with what dimension, pivot and symmetry planes leave it: all of these cut it.
    #[must_use]
    pub fn freedom_of(&self, body: &Body) -> Freedom {
        let Freedom {
            moves,
            turns,
            pivot,
        } = body.freedom;
        let is_plane = |a: usize| self.symmetry.iter().any(|plane| plane.axis.index() == a);
        let planes = |a: usize| self.symmetry.iter().all(|plane| plane.axis.index() == a);
        let spans = |a: usize| self.dimension == 3 || (self.dimension == 2 && a == 2);
        let is_left = |a: usize| a < self.dimension && !is_plane(a);
        Freedom {
            moves: std::array::from_fn(|a| moves[a] && pivot.is_none() && is_left(a)),
            turns: std::array::from_fn(|a| turns[a] && spans(a) && planes(a)),
            pivot,
        }
    }
}
