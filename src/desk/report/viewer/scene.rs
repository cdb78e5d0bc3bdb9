//! All frames of a viewer with what they share: bodies, fields and their scales, the camera's first look.

use std::path::{Path, PathBuf};

use super::chosen::{Chosen, spread};
use super::frames::{Ends, Frame, Kept};
use files::FileOpener;
use model::readable::Readable;
use model::{Axis, SymmetryPlane};
use plot::{Drawn, PlotError, Rgb, Scale, Snapshot, colour_of, decimals, hex};

/// Fields that may be coloured by, as far as snapshots have them.
const FIELDS: [&str; 6] = [
    "pressure",
    "velocity",
    "temperature",
    "plastic_strain",
    "damage",
    "von_mises",
];

/// Most frames that are taken without being asked for.
const MOST_FRAMES: usize = 60;

/// Most particles of a frame.
pub const MOST_PARTICLES: usize = 300_000;

/// Share of the particles at each end of an axis that may lie outside the first look.
const TAIL: f64 = 0.005;

/// A body and its colour.
#[derive(Debug)]
pub struct Shade {
    /// Its name.
    pub name: String,
    /// As pictures have it.
    pub colour: Rgb,
}

/// A field and its scale of colours.
#[derive(Debug)]
pub struct Field {
    /// With its unit: `pressure (GPa)`.
    pub name: String,
    /// Numbers at even shares of the scale.
    pub ticks: Vec<String>,
    /// Colours at even shares of the scale, `#rrggbb`.
    pub stops: Vec<String>,
    /// Values at both ends, in SI.
    range: [f64; 2],
}

/// The data of a viewer.
#[derive(Debug)]
pub struct Scene {
    /// Dimensions of the model.
    pub dimension: i32,
    /// Bodies in their order.
    pub bodies: Vec<Shade>,
    /// Fields to colour by.
    pub fields: Vec<Field>,
    /// Planes of symmetry.
    pub mirrors: Vec<SymmetryPlane>,
    /// Corners of what is seen at first (m).
    pub lower: [f64; 3],
    pub upper: [f64; 3],
    /// Distance of the farthest particle or image from the middle of these (m).
    pub reach: f64,
    /// Edge of the largest particle (m).
    pub size: f64,
    /// Size of particles in pictures over the true one, since some are left out.
    pub enlarge: f64,
    /// Unit of lengths.
    pub unit: Readable,
    /// The first direction of the camera (rad).
    pub yaw: f64,
    /// Most particles that a frame shows, and that it would show if none were left out.
    pub kept: usize,
    pub total: usize,
    /// Frames in the order of time.
    pub frames: Vec<Frame>,
}

impl Scene {
    /// Reads snapshots (time in s, path), at least one: `frames` of them, or as many as have room in so many
    /// bytes.
    pub fn read(
        snapshots: &[(f64, PathBuf)],
        particles: usize,
        frames: Option<usize>,
        room: usize,
    ) -> Result<Self, PlotError> {
        let first = Snapshot::open(&FileOpener, &snapshots[0].1)?;
        let drawn = drawn(&first)?;
        let rows = most_particles(snapshots)?;
        let most = particles.min(MOST_PARTICLES);
        let chosen = Chosen::new(most, rows);
        // A guess on the safe side: a place takes six bytes that hardly pack, and base64 a third more.
        let each = (4 * (6 + drawn.len()) / 3 + 1) * most.min(rows);
        let wanted = frames.unwrap_or((room / each.max(1)).clamp(2, MOST_FRAMES));
        let read = |k: usize| {
            Kept::read(
                &Snapshot::open(&FileOpener, &snapshots[k].1)?,
                &drawn,
                chosen,
                most,
            )
        };
        let all: Result<Vec<Kept>, _> = spread(snapshots.len(), wanted)
            .into_iter()
            .map(read)
            .collect();
        let all = all?;
        let ends: Vec<Ends> = all.iter().map(|kept| kept.ends(0.0)).collect();
        let mut scene = Self::shared(&first, &drawn, &all, &ends);
        let ranges: Vec<[f64; 2]> = scene.fields.iter().map(|field| field.range).collect();
        scene.frames = all
            .iter()
            .zip(ends)
            .map(|(kept, ends)| Frame::new(kept, ends, scene.size, &ranges))
            .collect();
        if frames.is_none() {
            scene.fit(room);
        }
        Ok(scene)
    }

    /// The common data of all frames.
    fn shared(first: &Snapshot, drawn: &[Drawn], all: &[Kept], ends: &[Ends]) -> Self {
        let kept = all.iter().map(|kept| kept.bodies.len()).max().unwrap_or(0);
        let total = all.iter().map(|kept| kept.whole).max().unwrap_or(0);
        let sizes = all.iter().flat_map(|kept| &kept.sizes);
        let [lower, upper] = corners(all, TAIL, &first.symmetry);
        let width = [0, 1, 2].map(|k| upper[k] - lower[k]);
        let shade = |(k, name): (usize, &String)| Shade {
            name: name.clone(),
            colour: colour_of(k),
        };
        let field = |(k, drawn): (usize, &Drawn)| match drawn {
            Drawn::Body => None,
            Drawn::Field(field) => {
                let values = all.iter().flat_map(|kept| &kept.values[k]);
                let scale = Scale::new(values.map(|&value| f64::from(value)), None);
                Some(Field::new(&field.label, &field.unit, &scale))
            }
        };
        Self {
            dimension: first.dimension,
            bodies: first.bodies.iter().enumerate().map(shade).collect(),
            fields: drawn.iter().enumerate().filter_map(field).collect(),
            mirrors: first.symmetry.clone(),
            reach: reach(ends, [lower, upper], &first.symmetry),
            lower,
            upper,
            size: f64::from(sizes.copied().fold(f32::MIN_POSITIVE, f32::max)),
            enlarge: (total as f64 / kept.max(1) as f64).powf(1.0 / f64::from(first.dimension)),
            unit: Readable::axes(width.into_iter().fold(0.0, f64::max)),
            yaw: yaw(&first.symmetry, [lower, upper]),
            kept,
            total,
            frames: Vec::new(),
        }
    }

    /// Leaves out frames until the others have room.
    fn fit(&mut self, room: usize) {
        let size = |frames: &[Frame]| frames.iter().map(|frame| frame.packed.len()).sum::<usize>();
        while size(&self.frames) > room && self.frames.len() > 2 {
            let share = room as f64 / size(&self.frames) as f64;
            let fits = (1..self.frames.len())
                .rev()
                .find(|&n| n as f64 <= share * self.frames.len() as f64);
            let keep = spread(self.frames.len(), fits.unwrap_or(2).max(2));
            let mut slot = 0..;
            self.frames
                .retain(|_| slot.next().is_some_and(|k| keep.contains(&k)));
        }
    }
}

impl Field {
    fn new(label: &str, unit: &str, scale: &Scale) -> Self {
        let [low, high] = [scale.low, scale.high];
        let largest = low.abs().max(high.abs());
        let unit = Readable::new(unit, largest);
        let at = |k: u32, of: u32| low + (high - low) * f64::from(k) / f64::from(of);
        let digits = decimals(largest / unit.size);
        let tick = |k: u32| {
            let beyond = match k {
                0 if scale.below => "≤ ",
                4 if scale.above => "≥ ",
                _ => "",
            };
            format!("{beyond}{}", unit.number(at(k, 4), digits))
        };
        Self {
            name: unit.label(label),
            ticks: (0..=4).map(tick).collect(),
            stops: (0..=32).map(|k| hex(scale.colour(at(k, 32)))).collect(),
            range: [low, high],
        }
    }
}

/// The fields of the first snapshot. Stress points have theirs apart from the particles: of such a
/// model only the velocity is drawn.
fn drawn(first: &Snapshot) -> Result<Vec<Drawn>, PlotError> {
    let points = first.has("stress_mass")?;
    let names = FIELDS.iter().filter(|name| !points || **name == "velocity");
    Ok(names
        .filter_map(|name| Drawn::find(first, name).ok())
        .collect())
}

/// Rows of the snapshot with the most particles, frozen ones and stress points among them.
fn most_particles(snapshots: &[(f64, PathBuf)]) -> Result<usize, PlotError> {
    let count = |path: &Path| Ok(Snapshot::open(&FileOpener, path)?.file.particles());
    let counts: Result<Vec<usize>, PlotError> =
        snapshots.iter().map(|(_, path)| count(path)).collect();
    Ok(counts?.into_iter().max().unwrap_or(0))
}

/// Corners of all frames, mirrored in all planes but the last, without a share of the particles at each end.
fn corners(all: &[Kept], without: f64, planes: &[SymmetryPlane]) -> [[f64; 3]; 2] {
    let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for ends in all
        .iter()
        .filter(|kept| !kept.bodies.is_empty())
        .map(|kept| kept.ends(without))
    {
        for (axis, [low, high]) in ends.into_iter().enumerate() {
            lower[axis] = lower[axis].min(low);
            upper[axis] = upper[axis].max(high);
        }
    }
    if lower.iter().any(|x| !x.is_finite()) {
        return [[0.0; 3], [1.0; 3]];
    }
    for plane in planes.iter().rev().skip(1) {
        let k = plane.axis.index();
        let images = [lower[k], upper[k]].map(|x| 2.0 * plane.position - x);
        lower[k] = lower[k].min(images[1]);
        upper[k] = upper[k].max(images[0]);
    }
    [lower, upper]
}

/// Distance of the farthest particle or image from the middle of a box (m).
fn reach(ends: &[Ends], [lower, upper]: [[f64; 3]; 2], planes: &[SymmetryPlane]) -> f64 {
    let mut squares = 0.0;
    for axis in 0..3 {
        let middle = 0.5 * (lower[axis] + upper[axis]);
        let images = |x: f64| {
            let own = planes.iter().filter(|plane| plane.axis.index() == axis);
            let image = own.map(move |plane| 2.0 * plane.position - x);
            image
                .chain([x])
                .map(|x| (x - middle).abs())
                .fold(0.0, f64::max)
        };
        let far = ends
            .iter()
            .flat_map(|ends| ends[axis])
            .map(images)
            .fold(0.0, f64::max);
        squares += far * far;
    }
    squares.sqrt().max(f64::MIN_POSITIVE)
}

/// The camera's first angle (rad): it looks at the plane of symmetry that is left open, from outside.
fn yaw(planes: &[SymmetryPlane], [lower, upper]: [[f64; 3]; 2]) -> f64 {
    use std::f64::consts::{FRAC_PI_2, PI};
    let Some(open) = planes.last() else {
        return 0.0;
    };
    let k = open.axis.index();
    let above = 0.5 * (lower[k] + upper[k]) >= open.position;
    match (open.axis, above) {
        (Axis::X, true) => -FRAC_PI_2,
        (Axis::X, false) => FRAC_PI_2,
        (Axis::Y, true) | (Axis::Z, _) => 0.0,
        (Axis::Y, false) => PI,
    }
}
