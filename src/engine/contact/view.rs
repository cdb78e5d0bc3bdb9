//! Inputs of the contact sums: particles as they meet, and their separations.

use super::ContactTable;
use super::gas::stiffening;
use numerics::arc::{Arc, POINTS};
use numerics::kernel::SUPPORT;
use numerics::lanes::{F64x8, Lanes};
use numerics::vector::square;
use particles::neighbours::{Lists, MotionRecord};
use particles::{Image, MirrorMask, Mirrors, ParticleStore};

/// Inputs of the contact sums.
#[derive(Clone, Copy)]
pub struct ContactView<'a> {
    /// The images in canonical order.
    pub images: &'a [Image],
    /// Their positions.
    pub motion: &'a [MotionRecord],
    /// The particles behind them.
    pub particles: &'a ParticleStore,
    /// Parameters of all pairs of bodies.
    pub table: &'a ContactTable,
    /// The step that led here (s); zero at the start.
    pub dt: f64,
}

/// One end of a contact pair.
#[derive(Clone, Copy)]
pub(crate) struct ContactParticle {
    /// Index in the store.
    pub slot: usize,
    pub body: usize,
    /// Of particles, as contact tells them apart.
    pub size_class: usize,
    /// Reference volume (m^d); of a point of a ring what that stands for of it.
    pub volume: f64,
    /// The same of all of it.
    pub whole: f64,
    /// Cosine and sine of the angle of a point of a ring.
    turn: [f64; 2],
    /// The planes that it is mirrored by.
    pub mirror_mask: MirrorMask,
    pub position: [f64; 3],
    pub velocity: [f64; 3],
}

impl<'a> ContactView<'a> {
    /// After a step of `dt` (s).
    pub(super) fn new(
        particles: &'a ParticleStore,
        lists: &'a Lists,
        table: &'a ContactTable,
        dt: f64,
    ) -> Self {
        Self {
            images: lists.images(),
            motion: lists.motion(),
            particles,
            table,
            dt,
        }
    }

    #[inline(always)]
    pub(crate) fn particle(&self, index: u32) -> ContactParticle {
        let image = self.images[index as usize];
        let slot = image.slot();
        let body = self.particles.body[slot] as usize;
        let record = &self.motion[index as usize];
        let volume = record.mass * self.table.inverse_density(body);
        ContactParticle {
            slot,
            body,
            size_class: self.table.size_class(body, record.mass),
            volume,
            whole: volume,
            turn: [1.0, 0.0],
            mirror_mask: image.mirror_mask(),
            position: record.position,
            velocity: record.velocity,
        }
    }

    /// The neighbours of a particle with their indices, of rings all [points](numerics::arc) in reach.
    #[inline(always)]
    pub(crate) fn others<'n>(
        &'n self,
        i: &'n ContactParticle,
        neighbours: &'n [u32],
    ) -> Others<'n> {
        Others {
            view: self,
            i,
            neighbours: neighbours.iter(),
            ring: None,
        }
    }

    /// A vector of a particle as it stands at its image or point.
    #[inline(always)]
    pub(super) fn shown(&self, of: &ContactParticle, vector: &[f64; 3]) -> [f64; 3] {
        if self.table.rings {
            return [vector[0] * of.turn[0], vector[1], vector[0] * of.turn[1]];
        }
        Mirrors::reflect_vector(vector, of.mirror_mask)
    }

    /// Takes out of a vector that stands for a pair of points of a ring what these cancel.
    #[inline(always)]
    pub(super) fn mirror(&self, vector: &mut [f64; 3]) {
        if self.table.rings {
            vector[2] = 0.0;
        }
    }

    /// Volume (m^d) over which two particles have a core: the mean of both, as often as there are such pairs.
    #[inline(always)]
    pub(super) fn core_volume(&self, [i, j]: [&ContactParticle; 2]) -> f64 {
        let (pairs, [a, b], _) = self.meeting([i, j]);
        pairs * (0.5 * (a + b))
    }

    /// Of two particles that meet: how many pairs they stand for, and in each of these both volumes (m^d) and both masses (kg).
    #[inline(always)]
    pub(super) fn meeting(&self, [i, j]: [&ContactParticle; 2]) -> (f64, [f64; 2], [f64; 2]) {
        let masses = [i, j].map(|particle| self.particles.mass[particle.slot]);
        if self.table.rings {
            let [a, b] = [i, j].map(|particle| self.table.grain(particle.size_class));
            let [m_i, m_j] = masses;
            let pairs = i.volume * j.volume / (a * b);
            return (pairs, [a, b], [m_i * (a / i.whole), m_j * (b / j.whole)]);
        }
        (1.0, [i.volume, j.volume], masses)
    }

    /// Factor of the stiffness of a particle, see [`gas`](super::gas).
    #[inline(always)]
    pub(super) fn stiffening(&self, particle: &ContactParticle) -> f64 {
        stiffening(self.particles, particle.slot)
    }

    /// Its relative rate (1/s).
    pub(super) fn stiffening_rate(&self, particle: &ContactParticle) -> f64 {
        self.table.stiffening_rate(self.particles, particle.slot)
    }

    /// The normal of the surface between two particles: that of both, from their bodies' corrected
    /// gradients, into the first one's body; none inside bodies.
    pub(super) fn normal(&self, i: &ContactParticle, j: &ContactParticle) -> Option<[f64; 3]> {
        let inward = |of: &ContactParticle| self.shown(of, &self.particles.gradient_shift[of.slot]);
        let (a, b) = (inward(i), inward(j));
        let n = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let size = square(&n).sqrt();
        (size > 0.0).then(|| n.map(|x| x / size))
    }
}

/// Neighbours of a particle, one after the other.
pub(crate) struct Others<'n> {
    view: &'n ContactView<'n>,
    i: &'n ContactParticle,
    neighbours: std::slice::Iter<'n, u32>,
    /// The ring in hand.
    ring: Option<Ring>,
}

/// A ring, of which points are told.
struct Ring {
    index: u32,
    whole: ContactParticle,
    /// At the point that comes next.
    arc: Arc<F64x8>,
    /// Points that are left.
    left: usize,
}

impl Iterator for Others<'_> {
    type Item = (u32, ContactParticle);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        if self.view.table.rings {
            return self.on_ring();
        }
        let &index = self.neighbours.next()?;
        Some((index, self.view.particle(index)))
    }
}

impl Others<'_> {
    #[cold]
    #[inline(never)]
    fn on_ring(&mut self) -> Option<(u32, ContactParticle)> {
        while self.ring.is_none() {
            let &index = self.neighbours.next()?;
            self.ring = self.ring(index);
        }
        let ring = self.ring.as_mut()?;
        let [r_i, r_j] = [self.i, &ring.whole].map(|particle| F64x8::splat(particle.position[0]));
        let [x, z] = ring.arc.apart(r_i, r_j).map(|all| all.0[0]);
        let turn = ring.arc.turn().map(|all| all.0[0]);
        let [radius, along, _] = ring.whole.velocity;
        let point = ContactParticle {
            volume: ring.whole.volume * ring.arc.share.0[0],
            turn,
            position: [self.i.position[0] - x, ring.whole.position[1], -z],
            velocity: [radius * turn[0], along, radius * turn[1]],
            ..ring.whole
        };
        let index = ring.index;
        ring.arc.advance();
        ring.left -= 1;
        if ring.left == 0 {
            self.ring = None;
        }
        Some((index, point))
    }

    /// The ring of an index, if some of it is in reach.
    fn ring(&self, index: u32) -> Option<Ring> {
        let whole = self.view.particle(index);
        let [x, y] = [0, 1].map(|a| self.i.position[a] - whole.position[a]);
        let (flat, table) = (y * y + x * x, self.view.table);
        let reach = SUPPORT * table.pair(self.i.size_class, whole.size_class).h;
        let radii = [self.i, &whole].map(|particle| F64x8::splat(particle.position[0]));
        (flat < reach * reach).then(|| Ring {
            index,
            whole,
            arc: Arc::new(radii, F64x8::splat(flat), F64x8::splat(reach)),
            left: POINTS,
        })
    }
}

/// Separation of two particles.
pub(super) struct Separation {
    /// `x_i − x_j` (m).
    pub r: [f64; 3],
    /// Its length (m), never zero.
    pub distance: f64,
    /// `(v_i − v_j)·(x_i − x_j)` (m²/s).
    pub rate: f64,
}

impl Separation {
    #[inline(always)]
    pub fn between(i: &ContactParticle, j: &ContactParticle) -> Self {
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

    /// That before a step `dt` (s).
    pub fn before(&self, i: &ContactParticle, j: &ContactParticle, dt: f64) -> Self {
        let moved = |a: usize| dt * (i.velocity[a] - j.velocity[a]);
        let r: [f64; 3] = std::array::from_fn(|a| self.r[a] - moved(a));
        let distance = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt().max(1e-30);
        Self {
            r,
            distance,
            rate: self.rate,
        }
    }

    /// Speed of approach along the line between the two (m/s), negative for receding pairs.
    #[inline(always)]
    pub fn approach(&self) -> f64 {
        -self.rate / self.distance
    }

    /// Raises `largest` to the approach speed `|μ_ij|` of the viscosity, zero for receding pairs
    /// (m/s): foreign pairs limit the time step as those inside a body do.
    #[inline(always)]
    pub fn raise_approach(&self, h: f64, largest: &mut f64) {
        let soft = self.distance * self.distance + 0.01 * (h * h);
        let steep = -h * self.rate;
        if steep > *largest * soft {
            *largest = steep / soft;
        }
    }

    /// `magnitude` (N) along `r`: positive pushes i away from j.
    #[inline(always)]
    pub fn along(&self, magnitude: f64) -> [f64; 3] {
        if magnitude == 0.0 {
            return [0.0; 3];
        }
        let scale = magnitude / self.distance;
        self.r.map(|x| x * scale)
    }

    /// [`Self::along`], of which only the part along a unit normal stays: it never attracts, and is
    /// opposite for the other side.
    pub fn along_normal(&self, magnitude: f64, normal: Option<[f64; 3]>) -> [f64; 3] {
        let Some(n) = normal else {
            return self.along(magnitude);
        };
        let cosine = self.r[0] * n[0] + self.r[1] * n[1] + self.r[2] * n[2];
        let scale = magnitude / self.distance * cosine;
        n.map(|x| x * scale)
    }
}
