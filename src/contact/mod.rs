//! Contact between bodies: a table of body pairs, and one file for each mode.
//!
//! Contact sees reference volumes `V = m/ρ₀`, reference smoothing lengths and reference moduli
//! only, so that its energy is a function of positions alone and its forces are that function's
//! exact gradient (physics page, section 5).

mod books;
mod boundary;
mod connectivity;
pub mod friction;
pub mod hold;
pub mod overlap;
pub mod penalty;
mod phase;
pub mod potential;
mod sums;
mod surfaces;
mod table;
mod task;

pub use connectivity::Connectivity;
pub use phase::Contact;
pub use sums::{Closest, PairExtremes};
pub(crate) use sums::{ContactSums, PairBook, PairSums, least, pair_key};
pub(crate) use surfaces::SurfaceForces;
pub use table::{ContactTable, Pair, PairResistance};

use crate::domain::Mirrors;
use crate::neighbours::{Lists, MotionRecord};
use crate::particles::{Image, ParticleStore};

/// What the contact sums read.
#[derive(Clone, Copy)]
pub struct ContactView<'a> {
    /// The images in canonical order.
    pub images: &'a [Image],
    /// Their positions.
    pub motion: &'a [MotionRecord],
    /// The particles behind them.
    pub store: &'a ParticleStore,
    /// Parameters of all pairs of bodies.
    pub table: &'a ContactTable,
    /// The step that led here (s); zero at the start.
    pub dt: f64,
}

/// One end of a contact pair.
#[derive(Clone, Copy)]
pub(crate) struct Party {
    /// Index in the store.
    base: usize,
    body: usize,
    /// Reference volume (m^d).
    volume: f64,
    mirrored: bool,
    position: [f64; 3],
    velocity: [f64; 3],
}

impl<'a> ContactView<'a> {
    /// After a step of `dt` (s).
    fn new(store: &'a ParticleStore, lists: &'a Lists, table: &'a ContactTable, dt: f64) -> Self {
        Self {
            images: lists.images(),
            motion: lists.motion(),
            store,
            table,
            dt,
        }
    }
}

impl ContactView<'_> {
    #[inline(always)]
    fn party(&self, place: u32) -> Party {
        let image = self.images[place as usize];
        let base = image.base();
        let body = self.store.body[base] as usize;
        let record = &self.motion[place as usize];
        Party {
            base,
            body,
            volume: record.mass * self.table.inverse_density(body),
            mirrored: image.code() != 0,
            position: record.position,
            velocity: record.velocity,
        }
    }
}

impl ContactView<'_> {
    /// The normal of the surface between two particles: that of both, from their bodies' corrected
    /// gradients, into the first one's body; none inside bodies.
    fn normal(&self, i: u32, j: u32) -> Option<[f64; 3]> {
        let inward = |place: u32| {
            let image = self.images[place as usize];
            Mirrors::reflect_vector(&self.store.gradient_shift[image.base()], image.code())
        };
        let (a, b) = (inward(i), inward(j));
        let n = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let size = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
        (size > 0.0).then(|| n.map(|x| x / size))
    }
}

/// What contact does to one receiver.
#[derive(Debug, Clone, Default)]
pub struct Reaction {
    /// Force (N).
    pub force: [f64; 3],
    /// The part of `force` that images behind symmetry planes exert (N).
    pub from_mirrors: [f64; 3],
    /// Its share of the contact energy (J).
    pub energy: f64,
    /// Stiffness for the time step (N/m).
    pub stiffness: f64,
    /// Damping for the time step (N s/m).
    pub dashpot: f64,
    /// Its share of the heat by friction and damping (W).
    pub heat: f64,
    /// Smallest distance to a foreign particle in mean spacings.
    pub closest: f64,
    /// Largest approach speed `|μ|` towards a foreign particle (m/s).
    pub approach: f64,
    /// The same by the other body.
    pub by_body: Vec<BodyReaction>,
}

/// What one foreign body does to one receiver.
#[derive(Debug, Clone, Copy)]
pub struct BodyReaction {
    /// The other body.
    pub body: usize,
    /// Force (N).
    pub force: [f64; 3],
    /// Share of the contact energy (J).
    pub energy: f64,
    /// Share of the heat by friction and damping (W).
    pub heat: f64,
    /// Smallest distance to a particle of that body in mean spacings.
    pub closest: f64,
    /// Index of that particle in the store.
    pub nearest: usize,
}

impl Reaction {
    /// Forgets everything but the buffer.
    pub fn clear(&mut self) {
        let by_body = std::mem::take(&mut self.by_body);
        *self = Self {
            by_body,
            closest: f64::INFINITY,
            ..Self::default()
        };
        self.by_body.clear();
    }

    /// Books what friction and damping of the pair with a body turn into heat (W) for the receiver,
    /// after [`Self::book`].
    fn book_heat(&mut self, body: usize, heat: f64) {
        self.heat += heat;
        self.by(body).heat += heat;
    }

    /// Books what the pair with `other` at `gap` does: distance, approach, force and energy.
    fn book(&mut self, other: &Party, gap: &Gap, pair: &Pair, force: [f64; 3], energy: f64) {
        self.meet(other, gap, pair);
        self.press(other, force, energy);
    }

    /// Distance and approach of the pair with `other` at `gap`.
    #[inline]
    fn meet(&mut self, other: &Party, gap: &Gap, pair: &Pair) {
        gap.raise_approach(pair.h, &mut self.approach);
        let distance = gap.distance * pair.inverse_spacing;
        self.closest = self.closest.min(distance);
        let body = self.by(other.body);
        if distance < body.closest {
            (body.closest, body.nearest) = (distance, other.base);
        }
    }

    /// Force and energy of the pair with `other`.
    #[inline]
    fn press(&mut self, other: &Party, force: [f64; 3], energy: f64) {
        self.energy += energy;
        for a in 0..3 {
            self.force[a] += force[a];
            if other.mirrored {
                self.from_mirrors[a] += force[a];
            }
        }
        let body = self.by(other.body);
        body.energy += energy;
        for a in 0..3 {
            body.force[a] += force[a];
        }
    }

    /// What is by one body, which few others are.
    #[inline]
    fn by(&mut self, body: usize) -> &mut BodyReaction {
        let at = self.by_body.iter().position(|e| e.body == body);
        let at = at.unwrap_or_else(|| {
            self.by_body.push(BodyReaction {
                body,
                force: [0.0; 3],
                energy: 0.0,
                heat: 0.0,
                closest: f64::INFINITY,
                nearest: 0,
            });
            self.by_body.len() - 1
        });
        &mut self.by_body[at]
    }
}

/// Geometry of a pair.
struct Gap {
    /// `x_i − x_j` (m).
    r: [f64; 3],
    /// Its length (m), never zero.
    distance: f64,
    /// `(v_i − v_j)·(x_i − x_j)` (m²/s).
    rate: f64,
}

impl Gap {
    #[inline(always)]
    fn between(i: &Party, j: &Party) -> Self {
        let r = [
            i.position[0] - j.position[0],
            i.position[1] - j.position[1],
            i.position[2] - j.position[2],
        ];
        let distance = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt().max(1e-30);
        let rate = (i.velocity[0] - j.velocity[0]) * r[0]
            + (i.velocity[1] - j.velocity[1]) * r[1]
            + (i.velocity[2] - j.velocity[2]) * r[2];
        Self { r, distance, rate }
    }

    /// Raises `largest` to the approach speed `|μ_ij|` of the viscosity, zero for receding pairs
    /// (m/s): foreign pairs limit the time step as those inside a body do.
    fn raise_approach(&self, h: f64, largest: &mut f64) {
        let soft = self.distance * self.distance + 0.01 * (h * h);
        let steep = -h * self.rate;
        if steep > *largest * soft {
            *largest = steep / soft;
        }
    }

    /// `magnitude` (N) along `r`: positive pushes i away from j.
    fn along(&self, magnitude: f64) -> [f64; 3] {
        if magnitude == 0.0 {
            return [0.0; 3];
        }
        let scale = magnitude / self.distance;
        self.r.map(|x| x * scale)
    }

    /// [`Self::along`], of which only the part along a unit normal stays: it never attracts, and is
    /// opposite for the other side.
    fn along_normal(&self, magnitude: f64, normal: Option<[f64; 3]>) -> [f64; 3] {
        let Some(n) = normal else {
            return self.along(magnitude);
        };
        let cosine = self.r[0] * n[0] + self.r[1] * n[1] + self.r[2] * n[2];
        let scale = magnitude / self.distance * cosine;
        n.map(|x| x * scale)
    }
}
