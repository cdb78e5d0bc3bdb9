//! The bounding lattice of a body: where the site of a triple of indices lies.

use std::f64::consts::FRAC_PI_2;

use model::{Body, LatticeKind, Shape, Vec3};

/// Nearest distance of a hexagonal close-packed lattice with one site in a unit volume, 2^(1/6).
pub(super) const CLOSE_PACKED: f64 = 1.122_462_048_309_373;
/// Nearest distance of a triangular lattice with one site in a unit area, √(2/√3).
pub(super) const TRIANGULAR: f64 = 1.074_569_931_823_542;
/// √3/2: distance of the rows of a triangular layer, in nearest distances.
const ROW: f64 = 0.866_025_403_784_438_6;
/// √(2/3): distance of close-packed layers, in nearest distances.
const LAYER: f64 = 0.816_496_580_927_726;

/// More than the offset of sites of alternate rows and layers, in spacings.
const MOST_ASIDE: f64 = 0.65;

/// Sites this close to a face, relative to the body's half width, count as outside: whether a
/// lattice point on a face belongs to the body must not hang on rounding, or halves would differ.
const FACE: f64 = 1.0 - 1e-9;

/// Distances of sites in a row, of rows in a layer and of layers, for a spacing of one.
pub(super) fn pitches(kind: LatticeKind, dimension: usize) -> [f64; 3] {
    match (kind, dimension) {
        (LatticeKind::Hexagonal, 3) => [CLOSE_PACKED, ROW * CLOSE_PACKED, LAYER * CLOSE_PACKED],
        (LatticeKind::Hexagonal, 2) => [TRIANGULAR, ROW * TRIANGULAR, 1.0],
        _ => [1.0; 3],
    }
}

/// Shifts of a row along itself and of a layer along y, for a spacing of one: alternate rows are
/// half a pitch apart, alternate layers a third of two rows, both evenly about zero.
pub(super) fn shifts(kind: LatticeKind, dimension: usize, j: u64, k: u64) -> [f64; 2] {
    let sign = |odd: u64| if odd % 2 == 1 { 1.0 } else { -1.0 };
    match (kind, dimension) {
        (LatticeKind::Hexagonal, 3) => [
            sign(j + k) * 0.25 * CLOSE_PACKED,
            sign(k) * (ROW / 6.0) * CLOSE_PACKED,
        ],
        (LatticeKind::Hexagonal, 2) => [sign(j) * 0.25 * TRIANGULAR, 0.0],
        _ => [0.0; 2],
    }
}

/// The sites of the bounding lattice that belong to the body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inside {
    /// Half width of the faces that the lattice does not fill exactly; infinite elsewhere (m).
    pub flat: [f64; 3],
    /// Axes that count for the radius: 1 or 0 each.
    pub round: [f64; 3],
    /// Square of the radius; infinite without one (m²).
    pub radius_squared: f64,
    /// Square of the radius of a hole; negative without one (m²).
    pub hole_squared: f64,
}

impl Inside {
    /// `true` if an offset from the centre (m) lies within the outer faces of the body.
    pub fn contains(&self, o: [f64; 3]) -> bool {
        (0..3).all(|a| o[a].abs() < self.flat[a]) && self.square(o) < self.radius_squared
    }

    /// `true` if an offset from the centre (m) lies in the hole.
    pub fn hollows(&self, o: [f64; 3]) -> bool {
        self.square(o) < self.hole_squared
    }

    fn square(&self, o: [f64; 3]) -> f64 {
        (0..3).fold(0.0, |sum, a| sum + self.round[a] * (o[a] * o[a]))
    }
}

/// The bounding lattice of one body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stack {
    kind: LatticeKind,
    dimension: usize,
    spacing: f64,
    centre: [f64; 3],
    /// Cosine and sine of the turn about z.
    turn: [f64; 2],
    /// Sites of a row (of the longest one), rows of a layer, layers.
    pub counts: [u64; 3],
    /// Radius of the innermost ring (m).
    innermost: f64,
    /// Their distances (m); those of a lattice that is fitted are its own by axis.
    pub pitch: [f64; 3],
    /// The part of the lattice that the shape cuts out.
    pub inside: Inside,
}

impl Stack {
    pub fn new(body: &Body, dimension: usize) -> Self {
        let lattice = &body.lattice;
        let (centre, half, round, radius) = extent(&body.shape, dimension);
        let hole_squared = match body.shape {
            Shape::Shell { inner_radius, .. } => inner_radius * inner_radius * FACE,
            _ => -1.0,
        };
        let turn = if lattice.angle == 0.0 {
            [1.0, 0.0]
        } else {
            [libm::cos(lattice.angle), libm::sin(lattice.angle)]
        };
        let mut pitch = pitches(lattice.kind, dimension).map(|p| p * lattice.spacing);
        let mut counts = [1; 3];
        let mut flat = [f64::INFINITY; 3];
        let mut innermost = 0.0;
        for a in 0..dimension {
            let is_filled = !round[a] && (lattice.angle == 0.0 || a == 2);
            counts[a] = if is_filled {
                let count = (2.0 * half[a] / pitch[a]).round();
                if lattice.fit && count > 0.0 {
                    pitch[a] = 2.0 * half[a] / count;
                }
                as_count(count)
            } else {
                if !round[a] {
                    flat[a] = half[a] * FACE;
                }
                // The layers of an even number are half a pitch off the centre; one more on each
                // side has room for the shifts.
                as_count((turned_half(half, turn, a) / pitch[a]).ceil() + 1.0).saturating_mul(2)
            };
        }
        if lattice.kind == LatticeKind::Rings {
            let rings = ((radius - hole_squared.max(0.0).sqrt()) / lattice.spacing).round();
            innermost = radius - (rings - 0.5) * lattice.spacing;
            counts[0] = quarter(radius - 0.5 * lattice.spacing, lattice.spacing);
            counts[1] = as_count(rings).saturating_mul(4);
        }
        Self {
            kind: lattice.kind,
            dimension,
            spacing: lattice.spacing,
            centre,
            turn,
            counts,
            innermost,
            pitch,
            inside: Inside {
                flat,
                round: round.map(|r| if r { 1.0 } else { 0.0 }),
                radius_squared: radius * radius * FACE,
                hole_squared,
            },
        }
    }

    /// Vector from the centre to a site (m).
    #[allow(clippy::cast_precision_loss)] // indices stay far below 2^52
    pub fn offset(&self, i: u64, j: u64, k: u64) -> [f64; 3] {
        if self.kind == LatticeKind::Rings {
            return self.on_ring(i, j, k);
        }
        let along = |index: u64, axis: usize| {
            (index as f64 - 0.5 * (self.counts[axis] as f64 - 1.0)) * self.pitch[axis]
        };
        let shifts = shifts(self.kind, self.dimension, j, k);
        let [across, up] = [
            along(i, 0) + shifts[0] * self.spacing,
            along(j, 1) + shifts[1] * self.spacing,
        ];
        let [cos, sin] = self.turn;
        [
            cos * across - sin * up,
            sin * across + cos * up,
            along(k, 2),
        ]
    }

    /// The number of kinds of layers that follow each other in turn: layers of one kind have their
    /// sites at the same x and y, to the bit.
    pub fn layer_kinds(&self) -> u64 {
        match (self.kind, self.dimension) {
            (LatticeKind::Hexagonal, 3) => 2,
            _ => 1,
        }
    }

    /// `true` if the shape cuts the same out of all layers of a kind.
    pub fn has_layers_alike(&self) -> bool {
        self.inside.round[2] == 0.0
    }

    /// `true` if rows are along x, so that y is the same to the bit all along one.
    pub fn is_along_x(&self) -> bool {
        !self.has_rings() && self.turn[1] == 0.0
    }

    /// By how much row `j` of layer `k` is shifted along itself (m).
    pub fn shift(&self, j: u64, k: u64) -> f64 {
        shifts(self.kind, self.dimension, j, k)[0] * self.spacing
    }

    /// Box around the sites of a block of indices `first..end` (m).
    #[allow(clippy::cast_precision_loss)] // as above
    pub fn block(&self, first: [u64; 3], end: [u64; 3]) -> ([f64; 3], [f64; 3]) {
        let [i, j, k] = [0, 1, 2].map(|a| [first[a], end[a] - 1]);
        let mut lower = [f64::INFINITY; 3];
        let mut upper = [f64::NEG_INFINITY; 3];
        let mut take = |p: [f64; 3]| {
            for a in 0..3 {
                lower[a] = lower[a].min(p[a]);
                upper[a] = upper[a].max(p[a]);
            }
        };
        for k in k {
            for j in j {
                take(self.position(i[0], j, k));
                take(self.position(i[1].min(self.sites(j) - 1), j, k));
            }
        }
        let is_one_row = j[0] == j[1];
        let aside = if self.has_rings() && !is_one_row {
            // Rings may go all around the centre.
            let radius = self.innermost + (j[1] / 4) as f64 * self.spacing;
            for a in 0..2 {
                lower[a] = self.centre[a] - radius;
                upper[a] = self.centre[a] + radius;
            }
            0.0
        } else if self.kind == LatticeKind::Hexagonal && !(is_one_row && k[0] == k[1]) {
            MOST_ASIDE * self.spacing
        } else {
            0.0
        };
        for a in 0..self.dimension.min(2) {
            lower[a] -= aside;
            upper[a] += aside;
        }
        (lower, upper)
    }

    /// `true` if a box (m) may hold sites of the body.
    pub fn may_hold(&self, lower: &[f64; 3], upper: &[f64; 3]) -> bool {
        let [nearest, farthest] = [0, 1].map(|far| {
            std::array::from_fn(|a| {
                let [l, u] = [lower[a] - self.centre[a], upper[a] - self.centre[a]];
                if far == 1 {
                    l.abs().max(u.abs())
                } else {
                    l.max(-u).max(0.0)
                }
            })
        });
        // Rounding may put a site half a bit outside.
        let inward = |o: [f64; 3]| o.map(|x| x - 1e-9 * self.spacing);
        let outward = |o: [f64; 3]| o.map(|x| x + 1e-9 * self.spacing);
        self.has_rings()
            || (self.inside.contains(inward(nearest)) && !self.inside.hollows(outward(farthest)))
    }

    /// `true` if a site of the lattice, by its indices, belongs to the body.
    pub fn holds(&self, [i, j, k]: [u64; 3]) -> bool {
        if self.has_rings() {
            return i < self.sites(j);
        }
        let offset = self.offset(i, j, k);
        self.inside.contains(offset) && !self.inside.hollows(offset)
    }

    /// `true` if rows are quarters of rings: whole rows belong to the body.
    pub fn has_rings(&self) -> bool {
        self.kind == LatticeKind::Rings
    }

    /// [`Self::offset`] in rings: four rows, quarter after quarter, make one. Each is the mirror
    /// image of the one before to the bit.
    #[allow(clippy::cast_precision_loss)] // as above
    fn on_ring(&self, i: u64, j: u64, k: u64) -> [f64; 3] {
        let radius = self.innermost + (j / 4) as f64 * self.spacing;
        let angle = FRAC_PI_2 * ((i as f64 + 0.5) / self.sites(j) as f64);
        let [right, up] = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]][(j % 4) as usize];
        let layer = (k as f64 - 0.5 * (self.counts[2] as f64 - 1.0)) * self.pitch[2];
        [
            right * (radius * libm::cos(angle)),
            up * (radius * libm::sin(angle)),
            layer,
        ]
    }

    /// Sites of row `j`.
    #[allow(clippy::cast_precision_loss)] // as above
    pub fn sites(&self, j: u64) -> u64 {
        if self.has_rings() {
            quarter(self.innermost + (j / 4) as f64 * self.spacing, self.spacing)
        } else {
            self.counts[0]
        }
    }

    /// Position of a site (m).
    pub fn position(&self, i: u64, j: u64, k: u64) -> [f64; 3] {
        let o = self.offset(i, j, k);
        [0, 1, 2].map(|a| self.centre[a] + o[a])
    }

    /// Step from a site to the next one of row `j` (m); of rings, the signs of each.
    pub fn step(&self, j: u64) -> [f64; 3] {
        if self.has_rings() {
            let [right, up] =
                [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]][(j % 4) as usize];
            return [right, up, 0.0];
        }
        [
            self.turn[0] * self.pitch[0],
            self.turn[1] * self.pitch[0],
            0.0,
        ]
    }

    /// Direction of one axis of the lattice.
    pub fn direction(&self, axis: usize) -> [f64; 3] {
        let [cos, sin] = self.turn;
        [[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]][axis]
    }

    pub fn index(&self, i: u64, j: u64, k: u64) -> u64 {
        i + self.counts[0] * (j + self.counts[1] * k)
    }

    pub fn index_end(&self) -> u64 {
        self.counts.iter().fold(1, |n, &m| n.saturating_mul(m))
    }
}

/// Centre, half widths, round axes and radius of a shape (m).
fn extent(shape: &Shape, dimension: usize) -> ([f64; 3], [f64; 3], [bool; 3], f64) {
    let centre = shape.centre();
    let (half, round, radius) = match *shape {
        // Filled by cells, never by rows.
        Shape::Solid(_) => (Vec3::zeros(), [false; 3], f64::INFINITY),
        Shape::Box { lower, upper } => ((upper - lower) * 0.5, [false; 3], f64::INFINITY),
        Shape::Sphere { radius, .. } | Shape::Shell { radius, .. } => {
            ([radius; 3].into(), [0, 1, 2].map(|a| a < dimension), radius)
        }
        Shape::Cylinder {
            axis,
            radius,
            length,
            ..
        } => {
            let mut half = [radius; 3];
            half[axis.index()] = 0.5 * length;
            let round = [0, 1, 2].map(|a| a < dimension && a != axis.index());
            (half.into(), round, radius)
        }
    };
    let used = [0, 1, 2].map(|a| if a < dimension { centre[a] } else { 0.0 });
    (used, half.into(), round, radius)
}

/// Half width of the bounding box in the turned lattice's own frame (m).
fn turned_half(half: [f64; 3], [c, s]: [f64; 2], axis: usize) -> f64 {
    match axis {
        0 => c.abs() * half[0] + s.abs() * half[1],
        1 => s.abs() * half[0] + c.abs() * half[1],
        _ => half[2],
    }
}

/// Particles of a quarter of a ring of `radius` (m), about one spacing apart.
fn quarter(radius: f64, spacing: f64) -> u64 {
    as_count((FRAC_PI_2 * radius / spacing).round()).max(1)
}

/// A rounded, non-negative number as a count; absurd ones saturate.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturating is meant
fn as_count(value: f64) -> u64 {
    value as u64
}
