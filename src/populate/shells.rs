//! Concentric layers of round bodies: on each the particles are in rings about an axis of its own,
//! all with the same part of its area.

use std::f64::consts::{PI, TAU};

use super::cells::drawn;
use super::parts::{Parts, best};
use super::row::Cut;
use super::{Share, Site, Wanted};
use model::{Body, LatticeKind, Shape, Vec3};

/// So many sites in a row are looked at one by one.
const FEW: u64 = 8;
/// More layers than any body has that can be run.
const MOST_LAYERS: f64 = 1e5;
/// Rings follow each other by this part of a turn, the root of three less one: rings of two are
/// nearly across, and there are no near repeats.
const ONWARD: f64 = 0.732_050_807_568_877_3;

/// The layers of one body, innermost first.
#[derive(Debug, Clone)]
pub(super) struct Shells {
    centre: Vec3,
    layers: Vec<Layer>,
    is_absurd: bool,
}

#[derive(Debug, Clone)]
struct Layer {
    /// Radius (m).
    radius: f64,
    /// Number of rings, and of sites in all of them.
    rings: u64,
    sites: u64,
    /// The first index of its sites.
    first: u64,
    /// From its own axes to those of space.
    turn: nalgebra::Matrix3<f64>,
}

/// A ring of a layer, as seen from the axis of that.
#[derive(Debug, Clone, Copy)]
struct Ring {
    /// Numbers of its sites in the layer.
    first: u64,
    end: u64,
    /// Height over the centre and radius, over those of the layer.
    height: f64,
    radius: f64,
    /// Angle of the first site (rad).
    phase: f64,
}

#[allow(clippy::cast_precision_loss, reason = "far fewer than 2^52")]
impl Shells {
    /// Of a body, if it is filled with them.
    pub fn of(body: &Body) -> Option<Self> {
        let (centre, radius, hole) = match body.shape {
            _ if body.lattice.kind != LatticeKind::Shells => return None,
            Shape::Sphere { centre, radius } => (centre, radius, 0.0),
            Shape::Shell {
                centre,
                radius,
                inner_radius,
            } => (centre, radius, inner_radius),
            _ => return None,
        };
        let spacing = body.lattice.spacing;
        let wanted = ((radius - hole) / spacing).round();
        let number = wanted.min(MOST_LAYERS);
        let pitch = (radius - hole) / number.max(1.0);
        let (mut layers, mut first, mut n) = (Vec::new(), 0, 0);
        while f64::from(n) < number {
            let at = hole + (f64::from(n) + 0.5) * pitch;
            let layer = Layer::new(at, pitch / spacing, spacing, n, first);
            first += layer.sites;
            layers.push(layer);
            n += 1;
        }
        Some(Self {
            centre,
            layers,
            is_absurd: wanted > MOST_LAYERS,
        })
    }

    /// One more than the largest index.
    pub fn index_end(&self) -> u64 {
        match self.layers.last() {
            _ if self.is_absurd => u64::MAX,
            Some(last) => last.first + last.sites,
            None => 0,
        }
    }

    /// All rings, by the numbers of their layers and their own.
    fn rings(&self) -> impl Iterator<Item = (&Layer, Ring)> {
        let layers = self.layers.iter();
        layers.flat_map(|layer| (0..layer.rings).map(move |n| (layer, layer.ring(n))))
    }

    fn position(&self, layer: &Layer, ring: &Ring, number: u64) -> [f64; 3] {
        let angle = ring.angle(number as f64);
        let along = Vec3::new(
            ring.radius * libm::cos(angle),
            ring.radius * libm::sin(angle),
            ring.height,
        );
        (self.centre + layer.turn * (along * layer.radius)).into()
    }

    /// Box (m) around some sites of a ring.
    fn around_arc(&self, layer: &Layer, ring: &Ring, first: u64, end: u64) -> ([f64; 3], [f64; 3]) {
        let last = (end - 1) as f64;
        let half = 0.5 * (ring.angle(last) - ring.angle(first as f64));
        if half > 0.5 * PI {
            return self.around_zone(layer, ring, ring);
        }
        // From the middle of the arc no site is farther away than its ends.
        let angle = 0.5 * (ring.angle(last) + ring.angle(first as f64));
        let middle = Vec3::new(
            ring.radius * libm::cos(angle),
            ring.radius * libm::sin(angle),
            ring.height,
        );
        let middle = self.centre + layer.turn * (middle * layer.radius);
        let aside = layer.radius * (2.0 * ring.radius * libm::sin(0.5 * half) + 1e-9);
        (
            middle.add_scalar(-aside).into(),
            middle.add_scalar(aside).into(),
        )
    }

    /// Box (m) around the rings of a layer from one to another.
    fn around_zone(&self, layer: &Layer, first: &Ring, last: &Ring) -> ([f64; 3], [f64; 3]) {
        let is_across = first.height > 0.0 && last.height < 0.0;
        let widest = if is_across {
            1.0
        } else {
            first.radius.max(last.radius)
        };
        let (mut lower, mut upper) = ([0.0; 3], [0.0; 3]);
        for a in 0..3 {
            let up = layer.turn[(a, 2)];
            let across = (1.0 - up * up).max(0.0).sqrt() * widest + 1e-9;
            let ends = [up * first.height, up * last.height];
            lower[a] = self.centre[a] + layer.radius * (ends[0].min(ends[1]) - across);
            upper[a] = self.centre[a] + layer.radius * (ends[0].max(ends[1]) + across);
        }
        (lower, upper)
    }

    /// Tells the runs of sites of a ring that the cuts leave, in order.
    fn runs(&self, layer: &Layer, ring: &Ring, cuts: &[Cut], mut emit: impl FnMut(u64, u64)) {
        let mut waiting = vec![(0, ring.end - ring.first)];
        while let Some((first, end)) = waiting.pop() {
            if first == end {
                continue;
            }
            let (lower, upper) = self.around_arc(layer, ring, first, end);
            if cuts.iter().any(|cut| cut.drops(&lower, &upper)) {
                continue;
            }
            let keeps = |cut: &Cut| cut.keeps(&lower) && cut.keeps(&upper);
            if cuts.iter().all(keeps) {
                emit(first, end);
            } else if end - first <= FEW {
                for number in first..end {
                    let position = self.position(layer, ring, number);
                    if cuts.iter().all(|cut| cut.keeps(&position)) {
                        emit(number, number + 1);
                    }
                }
            } else {
                let half = u64::midpoint(first, end);
                waiting.extend([(half, end), (first, half)]);
            }
        }
    }

    /// All sites that the cuts leave, in the order of their index.
    pub fn sites(self, cuts: Vec<Cut>) -> impl Iterator<Item = Site> + use<> {
        let rings = self.layers.iter().enumerate();
        let rings = rings.flat_map(|(at, layer)| (0..layer.rings).map(move |n| (at, n)));
        let rings: Vec<(usize, u64)> = rings.collect();
        rings.into_iter().flat_map(move |(at, n)| {
            let layer = &self.layers[at];
            let ring = layer.ring(n);
            let mut sites = Vec::new();
            self.runs(layer, &ring, &cuts, |first, end| {
                sites.extend((first..end).map(|number| Site {
                    position: self.position(layer, &ring, number),
                    index: layer.first + ring.first + number,
                    share: 1.0,
                }));
            });
            sites
        })
    }

    /// The number of sites.
    pub fn count(&self, cuts: &[Cut]) -> u64 {
        let mut count = 0;
        for (layer, ring) in self.rings() {
            self.runs(layer, &ring, cuts, |first, end| count += end - first);
        }
        count
    }

    /// Tells the coordinates on an axis (m) of one of several shares of the rings.
    pub fn tally(&self, cuts: &[Cut], axis: usize, share: Share, mut add: impl FnMut(f64, u64)) {
        let rings = self.rings().skip(share.part);
        for (layer, ring) in rings.step_by(share.parts.max(1)) {
            self.runs(layer, &ring, cuts, |first, end| {
                for number in first..end {
                    add(self.position(layer, &ring, number)[axis], 1);
                }
            });
        }
    }

    /// The sites where `value` is smallest, smallest first: see [`super::search()`].
    pub fn smallest(
        &self,
        cuts: &[Cut],
        wanted: Wanted,
        bound: impl Fn(&[f64; 3], &[f64; 3]) -> f64,
        value: impl Fn(&[f64; 3]) -> f64,
    ) -> Vec<(f64, [f64; 3])> {
        let shells = self;
        best(&Rings { shells, cuts }, wanted, bound, value)
    }

    /// Smallest and largest coordinates (m) of the sites, if there are any.
    pub fn extremes(&self, cuts: &[Cut]) -> Option<([f64; 3], [f64; 3])> {
        let wanted = Wanted {
            most: 1,
            limit: f64::INFINITY,
            any: false,
        };
        let (mut lowest, mut highest) = ([0.0; 3], [0.0; 3]);
        for a in 0..3 {
            let low = self.smallest(cuts, wanted, |lower, _| lower[a], |x| x[a]);
            let high = self.smallest(cuts, wanted, |_, upper| -upper[a], |x| -x[a]);
            lowest[a] = low.first()?.0;
            highest[a] = -high.first()?.0;
        }
        Some((lowest, highest))
    }
}

#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "far fewer than 2^52, and no less than nought"
)]
impl Layer {
    /// A layer of a radius (m) and a thickness (spacings): its sites have the volume of a cube of the
    /// spacing (m) each.
    fn new(radius: f64, thickness: f64, spacing: f64, number: u32, first: u64) -> Self {
        let at = radius / spacing;
        let volume = 2.0 * TAU * thickness * (at * at + thickness * thickness / 12.0);
        Self {
            radius,
            rings: (PI * at).round().max(1.0) as u64,
            sites: volume.round().max(1.0) as u64,
            first,
            turn: drawn(number.into(), 3).0,
        }
    }

    /// The number of sites in the rings before one.
    fn before(&self, ring: u64) -> u64 {
        let angle = PI * (ring as f64 / self.rings as f64);
        (0.5 * self.sites as f64 * (1.0 - libm::cos(angle))).round() as u64
    }

    /// A ring; rings have the area of the sphere that belongs to their sites.
    fn ring(&self, number: u64) -> Ring {
        let [first, end] = [number, number + 1].map(|ring| self.before(ring));
        let height = 1.0 - (first + end) as f64 / self.sites as f64;
        Ring {
            first,
            end,
            height,
            radius: (1.0 - height * height).max(0.0).sqrt(),
            phase: TAU * (number as f64 * ONWARD).fract(),
        }
    }
}

impl Ring {
    #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
    fn angle(&self, number: f64) -> f64 {
        self.phase + TAU * (number / (self.end - self.first) as f64)
    }
}

/// The sites of a body within some cuts, by numbers in a ring, of the ring and of the layer.
struct Rings<'a> {
    shells: &'a Shells,
    cuts: &'a [Cut],
}

impl Parts for Rings<'_> {
    fn all(&self) -> [u64; 3] {
        let layers = &self.shells.layers;
        let rings = layers.iter().map(|layer| layer.rings).max().unwrap_or(0);
        // The longest ring is the one around the middle of the largest layer, or next to it.
        let sites = self.shells.rings().map(|(_, ring)| ring.end - ring.first);
        [sites.max().unwrap_or(0), rings, layers.len() as u64]
    }

    /// First layer from layer, then ring from ring.
    fn longest(&self, first: [u64; 3], end: [u64; 3]) -> usize {
        (0..3).rev().find(|&a| end[a] - first[a] > 1).unwrap_or(0)
    }

    #[allow(clippy::cast_possible_truncation)] // they are in memory
    fn around(&self, first: [u64; 3], end: [u64; 3]) -> Option<([f64; 3], [f64; 3])> {
        let layer = &self.shells.layers[end[2] as usize - 1];
        let last = end[1].min(layer.rings);
        let (lower, upper) = if end[2] - first[2] > 1 {
            let aside = layer.radius;
            let centre = self.shells.centre;
            (
                centre.add_scalar(-aside).into(),
                centre.add_scalar(aside).into(),
            )
        } else if first[1] >= last {
            return None;
        } else if last - first[1] > 1 {
            let [from, to] = [first[1], last - 1].map(|ring| layer.ring(ring));
            self.shells.around_zone(layer, &from, &to)
        } else {
            let ring = layer.ring(first[1]);
            let end = end[0].min(ring.end - ring.first);
            if first[0] >= end {
                return None;
            }
            self.shells.around_arc(layer, &ring, first[0], end)
        };
        let is_cut = self.cuts.iter().any(|cut| cut.drops(&lower, &upper));
        (!is_cut).then_some((lower, upper))
    }

    #[allow(clippy::cast_possible_truncation)] // as above
    fn emit(&self, at: [u64; 3], mut emit: impl FnMut([f64; 3])) {
        let layer = &self.shells.layers[at[2] as usize];
        if at[1] >= layer.rings {
            return;
        }
        let ring = layer.ring(at[1]);
        if at[0] < ring.end - ring.first {
            let position = self.shells.position(layer, &ring, at[0]);
            if self.cuts.iter().all(|cut| cut.keeps(&position)) {
                emit(position);
            }
        }
    }
}
