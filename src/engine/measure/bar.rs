//! Bars: length, foot and profile, by the places of particles.
//!
//! Slices across the bar hold equal shares of its matter, at least one and a half layers of the start. So they are as
//! thin as the layers are where a foot is squeezed. In each of its sectors, nearly as many as there were particles
//! around the bar at the start, a slice has an outermost particle, beyond which half a spacing lies. The diameter is the
//! trimmed mean of the widths of opposite sectors: a stray particle changes one of them, which is left out.

use std::f64::consts::PI;

use super::figure::{Distribution, Figure, Findings};
use super::frame::{Frame, sector};
use super::matter::{Matter, raise};
use comm::Comm;
use model::{Bar, edge};

/// Layers in a slice at least. Layers of an even filling are whole, so it has two.
const LAYERS: f64 = 1.5;

/// Most slices of a bar; longer ones have thicker slices.
const MOST_SLICES: f64 = 512.0;

/// Heights that are told apart.
const HEIGHTS: usize = 4096;

/// Quarters of the sectors about the axis, so that planes of symmetry lie between sectors: from and to.
const QUARTER: (f64, f64) = (2.0, 64.0);

/// Spacings of the start that a sector is wide, about.
const ARC: f64 = 1.2;

/// A stray particle and its images widen so many pairs of opposite sectors at most.
const STRAY: usize = 2;

/// The next particle of a sector inwards is this part of an edge away at least: others lie beside the outermost.
const BESIDE: f64 = 0.25;

/// A spacing is this part of an edge at least.
const LEAST_SPACING: f64 = 0.5;

/// Whole numbers in which volume is counted: so many in a cube of the spacing.
const VOLUME: f64 = 1_073_741_824.0;

/// Whole numbers in which places are counted: so many in a spacing.
const PLACE: f64 = 4096.0;

/// A bar at the start: its length and its diameter (m), that of the circle with its mean section.
#[derive(Debug, Clone, Copy)]
struct Start {
    length: f64,
    diameter: f64,
}

impl Start {
    /// Of a bar whose matter, images included, has a volume (m³).
    fn new(bar: &Bar, matter: &Matter, volume: f64) -> Self {
        let solid = matter.case.bodies[bar.body]
            .shape
            .solid(matter.case.dimension);
        let (mut high, mut low) = (
            solid.support(&bar.foot.into()),
            -solid.support(&bar.foot.map(|c| -c).into()),
        );
        // The image of a bar that is cut across doubles it.
        for a in (0..3).filter(|&a| bar.foot[a].abs() == 1.0) {
            if let Some(plane) = matter.mirrors.plane(a) {
                let plane = bar.foot[a] * plane;
                (high, low) = (high.max(2.0 * plane - low), low.min(2.0 * plane - high));
            }
        }
        let length = (high - low).max(bar.spacing);
        Self {
            length,
            diameter: 2.0 * (volume / (PI * length)).sqrt(),
        }
    }

    /// Sectors about the axis, by the spacing (m).
    fn sectors(self, spacing: f64) -> usize {
        let (least, most) = QUARTER;
        let quarter = (0.25 * PI * self.diameter / (ARC * spacing)).round();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "within these"
        )]
        let quarter = quarter.clamp(least, most) as usize;
        4 * quarter
    }
}

/// What lies between two heights.
#[derive(Debug, Clone, Copy)]
struct Slice {
    /// Its volume (m³).
    volume: f64,
    /// Number of its particles.
    count: f64,
    /// Distance (m) of its middle from the outermost particle at the foot.
    middle: f64,
    /// The same of its first and its last particle.
    ends: [f64; 2],
}

/// The matter of a bar by its distance from the foot.
struct Column<'a> {
    bar: &'a Bar,
    matter: &'a Matter<'a>,
    frame: Frame,
    /// Height (m) of the outermost particle at the foot.
    high: f64,
    /// Distance (m) between the outermost particles.
    between: f64,
}

impl Column<'_> {
    /// Coordinates (m) of a particle of the bar and of its images: two across it, then the number of its height from
    /// the foot.
    fn places(&self, i: usize) -> impl Iterator<Item = ([f64; 2], usize)> {
        let is_its = self.matter.body_of(i) == self.bar.body;
        let images = is_its.then(|| self.matter.images(i));
        images.into_iter().flatten().map(|(x, _)| {
            let [u, w, at] = self.frame.turned(&x);
            #[expect(clippy::cast_precision_loss, reason = "small")]
            let height = (self.high - at) / self.between * HEIGHTS as f64;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "no less than zero and cut at the last"
            )]
            let height = (height.max(0.0) as usize).min(HEIGHTS - 1);
            ([u, w], height)
        })
    }

    /// Distance (m) of the middle of a height from the outermost particle.
    fn depth(&self, height: usize) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "small")]
        let part = (height as f64 + 0.5) / HEIGHTS as f64;
        part * self.between
    }

    /// Volume (m³) and number of particles by height. Collective.
    fn volumes(&self, comm: &Comm) -> Vec<[f64; 2]> {
        let cube = self.bar.spacing * self.bar.spacing * self.bar.spacing;
        let counts = self.matter.counts(comm, 2 * HEIGHTS, |i, counts| {
            #[expect(clippy::cast_possible_truncation, reason = "far below the most")]
            let volume = (self.matter.volume(i) / cube * VOLUME).round() as i64;
            for (_, height) in self.places(i) {
                counts[2 * height] += volume;
                counts[2 * height + 1] += 1;
            }
        });
        let pairs = counts.as_chunks::<2>().0.iter();
        #[expect(clippy::cast_precision_loss, reason = "rounded once")]
        let pair = |&[volume, count]: &[i64; 2]| [volume as f64 / VOLUME * cube, count as f64];
        pairs.map(pair).collect()
    }

    /// Slices from the foot on that hold at least some volume (m³) each, and the slice of each height.
    fn slices(&self, volumes: &[[f64; 2]], least: f64) -> (Vec<Slice>, Vec<usize>) {
        let mut slices: Vec<Slice> = Vec::new();
        let mut of_height = vec![0; HEIGHTS];
        let mut rest: f64 = volumes.iter().map(|[volume, _]| volume).sum();
        let mut is_full = true;
        for (height, &[volume, count]) in volumes.iter().enumerate() {
            if count > 0.0 {
                let depth = self.depth(height);
                // What is left over belongs to the last.
                if is_full && (rest >= least || slices.is_empty()) {
                    slices.push(Slice {
                        volume: 0.0,
                        count: 0.0,
                        middle: 0.0,
                        ends: [depth; 2],
                    });
                    is_full = false;
                }
                if let Some(slice) = slices.last_mut() {
                    slice.volume += volume;
                    slice.count += count;
                    slice.middle += volume * depth;
                    slice.ends[1] = depth;
                    is_full = slice.volume >= least;
                }
                rest -= volume;
            }
            of_height[height] = slices.len().saturating_sub(1);
        }
        for slice in &mut slices {
            slice.middle /= slice.volume;
        }
        (slices, of_height)
    }

    /// Mean places (m) of the particles of slices, across the bar. Collective.
    fn centres(&self, slices: &[Slice], of_height: &[usize], comm: &Comm) -> Vec<[f64; 2]> {
        let scale = PLACE / self.bar.spacing;
        let sums = self.matter.counts(comm, 2 * slices.len(), |i, sums| {
            for (place, height) in self.places(i) {
                let slice = of_height[height];
                for a in 0..2 {
                    #[expect(clippy::cast_possible_truncation, reason = "far below the most")]
                    let whole = (place[a] * scale).round() as i64;
                    sums[2 * slice + a] += whole;
                }
            }
        });
        let pairs = sums.as_chunks::<2>().0.iter().zip(slices);
        #[expect(clippy::cast_precision_loss, reason = "rounded once")]
        let centre =
            |(sums, slice): (&[i64; 2], &Slice)| sums.map(|c| c as f64 / scale / slice.count);
        pairs.map(centre).collect()
    }

    /// Diameters (m) of slices. Collective.
    fn diameters(
        &self,
        start: Start,
        slices: &[Slice],
        of_height: &[usize],
        comm: &Comm,
    ) -> Vec<f64> {
        let sectors = start.sectors(self.bar.spacing);
        let centres = self.centres(slices, of_height, comm);
        let edges: Vec<f64> = slices.iter().map(|slice| self.edge(slice)).collect();
        let radii = |below: &(dyn Fn(usize, usize) -> f64 + Sync)| {
            let bins = slices.len() * sectors;
            self.matter.largest_by_bin(comm, bins, |i, most| {
                for ([u, w], height) in self.places(i) {
                    let slice = of_height[height];
                    let (x, y) = (u - centres[slice][0], w - centres[slice][1]);
                    let bin = slice * sectors + sector(x, y, sectors);
                    let radius = libm::hypot(x, y);
                    if radius < below(slice, bin) {
                        raise(&mut most[bin], radius);
                    }
                }
            })
        };
        let outer = radii(&|_, _| f64::INFINITY);
        let next = radii(&|slice, bin| outer[bin] - BESIDE * edges[slice]);
        let rows = outer.chunks(sectors).zip(next.chunks(sectors)).zip(edges);
        rows.map(|((outer, next), edge)| diameter(outer, next, edge, start.diameter))
            .collect()
    }

    /// Edge (m) of the mean particle of a slice.
    fn edge(&self, slice: &Slice) -> f64 {
        edge(slice.volume / slice.count, self.matter.case.dimension)
    }

    /// Half the distance (m) of layers at an end, of its slice and the one after that, and of layers of a volume (m³);
    /// at most half an edge: slices of a point are thick.
    fn margin(&self, end: &Slice, after: Option<&Slice>, layer: f64) -> f64 {
        let apart = after.map_or(f64::INFINITY, |after| {
            let layers = 0.5 * (end.volume + after.volume) / layer;
            (after.middle - end.middle).abs() / layers
        });
        0.5 * apart.min(self.edge(end))
    }
}

/// The mean of some numbers without the least and the largest tenth of them, at least [`STRAY`] on either side, or
/// without all but the one or two in the middle; nothing of none.
fn trimmed_mean(mut values: Vec<f64>) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len().checked_sub(1)? / 2;
    let out = (values.len() / 10).max(STRAY).min(middle);
    let kept = &values[out..values.len() - out];
    #[expect(clippy::cast_precision_loss, reason = "small")]
    let count = kept.len() as f64;
    Some(kept.iter().sum::<f64>() / count)
}

/// The diameter (m) of a slice: of distances (m) from its middle of the outermost particles of its sectors and of those
/// next inwards, −∞ where there is none, the edge (m) of its particles and its diameter (m) at the start.
///
/// It is the trimmed mean of the widths of opposite sectors and a spacing along the radius: that of the ways inwards to
/// the next particle, of half an edge at least, and no more than an edge that has grown as the circumference has.
fn diameter(outer: &[f64], next: &[f64], edge: f64, before: f64) -> f64 {
    let (ahead, behind) = outer.split_at(outer.len() / 2);
    let widths = ahead.iter().zip(behind).map(|(a, b)| a + b);
    let mean = |values: &mut dyn Iterator<Item = f64>| {
        trimmed_mean(values.filter(|value| value.is_finite()).collect())
    };
    let widths = mean(&mut { widths });
    let alone = || mean(&mut outer.iter().copied());
    let Some(width) = widths.or_else(|| Some(2.0 * alone()?)) else {
        return f64::NAN;
    };
    let gaps = outer.iter().zip(next).map(|(a, b)| a - b);
    let gap = mean(&mut { gaps }).unwrap_or(edge);
    let grown = ((width + edge) / before).max(1.0);
    width + gap.clamp(LEAST_SPACING * edge, grown * edge)
}

/// The measures of a bar. Collective.
pub fn bar(bar: &Bar, matter: &Matter, comm: &Comm) -> Findings {
    let frame = Frame::new(&bar.foot);
    let [high, low] = matter.largest::<2>(comm, |i, most| {
        if matter.body_of(i) == bar.body {
            for (x, _) in matter.images(i) {
                let at = frame.turned(&x)[2];
                raise(&mut most[0], at);
                raise(&mut most[1], -at);
            }
        }
    });
    let number = |name, value: f64| Figure::number(name, value, "m").within(bar.spacing);
    if !high.is_finite() {
        let names = ["length", "foot_diameter", "largest_diameter", "largest_at"];
        return Findings {
            figures: names.map(|name| number(name, f64::NAN)).to_vec(),
            distributions: Vec::new(),
        };
    }
    let column = Column {
        bar,
        matter,
        frame,
        high,
        between: (high + low).max(f64::MIN_POSITIVE),
    };
    let volumes = column.volumes(comm);
    let volume: f64 = volumes.iter().map(|[volume, _]| volume).sum();
    let start = Start::new(bar, matter, volume);
    let layer = volume * bar.spacing / start.length;
    let least = (LAYERS * layer).max(volume / MOST_SLICES);
    let (slices, of_height) = column.slices(&volumes, least);
    let profile = column.diameters(start, &slices, &of_height, comm);
    let (first, last) = (&slices[0], slices.len() - 1);
    let margins = [
        column.margin(first, slices.get(1), layer),
        column.margin(
            &slices[last],
            last.checked_sub(1).map(|k| &slices[k]),
            layer,
        ),
    ];
    let length = high + low + margins[0] + margins[1];
    // Slices meet half way between the particles of both.
    let meets = |k: usize| margins[0] + 0.5 * (slices[k].ends[1] + slices[k + 1].ends[0]);
    let bounds = |k: usize| {
        let begin = k.checked_sub(1).map_or(0.0, meets);
        [begin, if k < last { meets(k) } else { length }]
    };
    let largest = profile.iter().enumerate().fold(
        0,
        |best, (k, &d)| {
            if d > profile[best] { k } else { best }
        },
    );
    let bins = profile.iter().enumerate().map(|(k, &d)| {
        let [from, to] = bounds(k);
        [from, to, d]
    });
    let [from, to] = bounds(largest);
    Findings {
        figures: vec![
            number("length", length),
            number("foot_diameter", profile[0]),
            number("largest_diameter", profile[largest]),
            number("largest_at", 0.5 * (from + to)),
        ],
        distributions: vec![Distribution {
            name: "diameter_from_foot",
            along: "m",
            unit: "m",
            bins: bins.collect(),
        }],
    }
}
