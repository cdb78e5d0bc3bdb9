//! The shape of a particle, and how far particles fill a place together.
//!
//! A particle fills a cell about it of its own size s, the spacing of the volume it has now, or of what its deformation
//! gradient has made of its first one. Each has the weight
//!
//! ```text
//! w(r) = ((2 − r²/s²)/(2 − 1/4))⁴   for r < √2 s, else 0 ,
//! ```
//!
//! which is one at r = s/2, and a place is filled if the weights of a body's particles add up to
//! one. So a lone particle is a ball of diameter s. On a cubic lattice of any dimension the power
//! makes 2 w(s/√2) and 4 w(√3/2 s) one, too: the free surface is plane, .50 to .55 spacings outside
//! the outermost layer, and the sum inside is two or more, without holes. A lattice that is deformed evenly is drawn as
//! the deformed picture of it.
//!
//! Particles with deformation gradients are of a body that has not torn, and those no less dense than at the start are in the
//! midst of matter, which may be glass without order. There a place is filled as well where they are around it: where the mean of 1 − r²/4 s² over r < 2 s is more than [`AROUND`] of that in full matter. On a free
//! surface it is a half.

use numerics::ellipsoid::{Ellipsoid, MOST};

/// Reach of a particle's weight, in its own sizes.
const REACH: f64 = std::f64::consts::SQRT_2;

/// Reach of what tells whether particles are around a place, in their sizes.
const WIDE: f64 = 2.0;

/// Share of full matter around a place that fills it.
const AROUND: f64 = 0.6;

/// The integral of 1 − r²/4 over r < 2 in one dimension, two and three.
const FULL: [f64; 3] = {
    let pi = std::f64::consts::PI;
    [8.0 / 3.0, 2.0 * pi, 64.0 / 15.0 * pi]
};

/// The shape of a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// A ball of radius s, or what has become of it.
    pub ellipsoid: Ellipsoid,
    /// What one such particle in the middle of a place is of all around it that fills it; zero if it may lie apart.
    around: f64,
    /// Its own weight: one, or zero of a shape that fills nothing by itself.
    own: f64,
}

impl Shape {
    /// A ball of a size s (m).
    #[must_use]
    pub fn ball(size: f64) -> Self {
        Self {
            ellipsoid: Ellipsoid::ball(size),
            around: 0.0,
            own: 1.0,
        }
    }

    /// A ball of a size s (m) in the midst of matter, in a model of some dimensions.
    #[must_use]
    pub fn dense(size: f64, dimension: usize) -> Self {
        Self {
            ellipsoid: Ellipsoid::ball(size),
            around: around(dimension),
            own: 1.0,
        }
    }

    /// What a deformation gradient makes of a ball of the first size (m), in a model of some dimensions; none if there is no
    /// gradient.
    #[must_use]
    pub fn image(first: f64, gradient: &[f64; 9], dimension: usize) -> Option<Self> {
        let ellipsoid = Ellipsoid::image(first, gradient)?;
        Some(Self {
            ellipsoid,
            around: around(dimension),
            own: 1.0,
        })
    }

    /// One of three dimensions that is as much matter as this one, spread so many times as wide, and that fills a place where half of what is
    /// around is matter: flat faces stay where they are, whatever the layers of a lattice, and edges are rounded by a part of the
    /// width.
    #[must_use]
    pub fn averaged(&self, wider: f64) -> Self {
        Self {
            ellipsoid: self.ellipsoid.scaled(wider),
            around: around(3) * (AROUND / 0.5) / (wider * wider * wider),
            own: 0.0,
        }
    }

    /// The farthest that a particle reaches whose first size, or present size if it has no gradient, are at most these (m).
    #[must_use]
    pub fn farthest(first: f64, present: f64) -> f64 {
        (WIDE * MOST * first).max(REACH * present)
    }

    /// The same along three unit vectors.
    #[must_use]
    pub fn along(&self, axes: &[[f64; 3]; 3]) -> Self {
        let ellipsoid = self.ellipsoid.along(axes);
        Self { ellipsoid, ..*self }
    }

    /// Its image in a mirror normal to an axis.
    #[must_use]
    pub fn mirrored(&self, axis: usize) -> Self {
        let ellipsoid = self.ellipsoid.mirrored(axis);
        Self { ellipsoid, ..*self }
    }

    /// Its size along an axis (m).
    #[must_use]
    pub fn size(&self, axis: usize) -> f64 {
        self.ellipsoid.reach(axis)
    }

    /// Places farther than this along an axis (m) it has no part in.
    #[must_use]
    pub fn reach(&self, axis: usize) -> f64 {
        let sizes = if self.around > 0.0 { WIDE } else { REACH };
        sizes * self.size(axis)
    }
}

/// What one particle in the middle of a place is of all that fills it.
fn around(dimension: usize) -> f64 {
    1.0 / (AROUND * FULL[dimension.clamp(1, 3) - 1])
}

/// How far particles fill a place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Fill {
    sum: f64,
    around: f64,
}

impl Fill {
    /// Adds a particle at a squared distance in units of its size, and returns its weight.
    pub fn add(&mut self, shape: &Shape, distance: f64) -> f64 {
        let rest = ((2.0 - distance) / 1.75).max(0.0);
        let weight = (rest * rest) * (rest * rest);
        self.sum += shape.own * weight;
        self.around += shape.around * (1.0 - 0.25 * distance).max(0.0);
        weight
    }

    /// At least one where the place is filled.
    #[must_use]
    pub fn level(&self) -> f64 {
        self.sum.max(self.around)
    }
}
