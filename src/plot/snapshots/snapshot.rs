//! A snapshot with what it says of its case.

use std::ops::Range;
use std::path::Path;

use super::extent::{Extent, Mover};
use super::shape::Shape;
use crate::PlotError;
use model::{Axis, SymmetryPlane};
use results::{Opener, SnapshotReader};

/// Particles read at a time, so that a large snapshot is never whole in memory.
const CHUNK: usize = 1 << 20;

/// An open snapshot and its case.
#[derive(Debug)]
pub struct Snapshot {
    /// Its file.
    pub file: Box<dyn SnapshotReader>,
    /// Time (s).
    pub time: f64,
    /// Title of the case.
    pub title: String,
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// Dimensions d of the model, 1 to 3.
    pub dimension: i32,
    /// Particle spacing Δp of each body (m); the finest where it varies.
    pub spacings: Vec<f64>,
    /// The coarsest of each body (m); snapshots of older versions, where none varies, do not say it.
    coarsest: Vec<f64>,
    /// Initial density ρ₀ of each body (kg/m³), of which a particle's mass is `ρ₀ Δp^d`; snapshots
    /// of older versions do not say it.
    densities: Option<Vec<f64>>,
    /// `true` for rigid bodies.
    pub rigid: Vec<bool>,
    /// Planes of symmetry.
    pub symmetry: Vec<SymmetryPlane>,
    /// `true` if particles may be frozen.
    freezes: bool,
    /// `true` if it holds deformation gradients.
    deforms: bool,
}

/// Largest size of a particle in spacings of its body at the start: beyond twice a smoothing length
/// particles do not know of each other, however thin they are.
const LARGEST: f64 = 4.0;

/// Largest size over that at the start of a particle in the midst of matter, of 97 % of the initial density.
const DENSE: f64 = 1.01;

/// The field of deformation gradients, zero where a body has none.
const DEFORMATION: &str = "deformation_gradient";

/// The field that marks frozen particles.
pub const FROZEN: &str = "frozen";

impl Snapshot {
    /// Opens a snapshot and reads what it says of its case.
    ///
    /// # Errors
    /// [`PlotError::Read`] if it cannot be read, [`PlotError::Snapshot`] if what it says makes no sense.
    pub fn open(opener: &dyn Opener, path: &Path) -> Result<Self, PlotError> {
        let file = opener.snapshot(path)?;
        let damaged = |reason: String| PlotError::Snapshot {
            path: path.to_owned(),
            reason,
        };
        let title = file.attribute("/whipple", "title")?;
        let bodies: Vec<String> = json(file.as_ref(), "bodies")?;
        let spacings: Vec<f64> = json(file.as_ref(), "spacings")?;
        let coarsest: Vec<f64> =
            json(file.as_ref(), "coarsest_spacings").unwrap_or_else(|_| spacings.clone());
        let rigid: Vec<bool> = json(file.as_ref(), "rigid")?;
        let planes: Vec<(String, f64)> = json(file.as_ref(), "symmetry")?;
        let densities: Option<Vec<f64>> = json(file.as_ref(), "densities").ok();
        for (count, what) in [
            (spacings.len(), "spacings"),
            (coarsest.len(), "coarsest spacings"),
            (rigid.len(), "marks of rigid"),
            (
                densities.as_ref().map_or(bodies.len(), Vec::len),
                "densities",
            ),
        ] {
            if count != bodies.len() {
                let b = bodies.len();
                return Err(damaged(format!("{b} bodies but {count} {what}")));
            }
        }
        let mut all = spacings.iter().chain(&coarsest);
        if let Some(&bad) = all.find(|&&s| !(s > 0.0 && s.is_finite())) {
            return Err(damaged(format!(
                "a spacing of {bad} m; it must be positive"
            )));
        }
        let dimension = file.number("/whipple", "dimension")?;
        let Some(dimension) = (1..=3).find(|&d: &i32| u64::try_from(d) == Ok(dimension)) else {
            return Err(damaged(format!("a model of {dimension} dimensions")));
        };
        let symmetry = symmetry(planes).map_err(damaged)?;
        let names = file.names()?;
        let has = |field: &str| names.iter().any(|name| name == field);
        Ok(Self {
            time: file.time()?,
            freezes: has(FROZEN),
            deforms: has(DEFORMATION) && file.components(DEFORMATION)? == 9,
            file,
            title,
            bodies,
            dimension,
            spacings,
            coarsest,
            densities,
            rigid,
            symmetry,
        })
    }

    /// The smallest particle spacing (m).
    pub fn finest(&self) -> f64 {
        self.spacings.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The coarsest particle spacing (m).
    pub fn coarsest(&self) -> f64 {
        self.coarsest.iter().copied().fold(0.0, f64::max)
    }

    /// Distance beyond which a particle has no part in a place (m).
    #[must_use]
    pub fn reach(&self) -> f64 {
        let first = if self.deforms { self.coarsest() } else { 0.0 };
        Shape::farthest(first, LARGEST * self.coarsest())
    }

    /// The rows of the snapshot in portions that fit in memory.
    pub fn chunks(&self) -> impl Iterator<Item = Range<usize>> {
        let total = self.file.particles();
        (0..total)
            .step_by(CHUNK)
            .map(move |first| first..total.min(first + CHUNK))
    }

    /// The body of each particle of some rows, as indices into `bodies`.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the rows cannot be read, [`PlotError::Snapshot`] if one is of no body.
    pub fn body_of(&self, rows: Range<usize>) -> Result<Vec<usize>, PlotError> {
        let values = self.file.scalar("body", 0, rows)?;
        let index = |value: f64| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "an integer field; whatever it holds is checked next"
            )]
            let index = value as usize;
            if index < self.bodies.len() && value >= 0.0 {
                Ok(index)
            } else {
                Err(PlotError::Snapshot {
                    path: self.file.path().to_owned(),
                    reason: format!("body {value} of {} bodies", self.bodies.len()),
                })
            }
        };
        values.into_iter().map(index).collect()
    }

    /// `true` for rows that are still part of the model: those that are not frozen. A picture of a
    /// run that freezes particles is that of one which removes them.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn active(&self, rows: Range<usize>) -> Result<Vec<bool>, PlotError> {
        if !self.freezes {
            return Ok(vec![true; rows.len()]);
        }
        let frozen = self.file.scalar(FROZEN, 0, rows)?;
        Ok(frozen.into_iter().map(|frozen| frozen == 0.0).collect())
    }

    /// Smallest, largest and mean finite coordinate of what is not frozen along each axis (m).
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn extent(&self) -> Result<[Extent; 3], PlotError> {
        let mut extents = [Extent::default(); 3];
        for rows in self.chunks() {
            let active = self.active(rows.clone())?;
            let points = self.file.points(rows)?.into_iter().zip(active);
            for (point, _) in points.filter(|(_, active)| *active) {
                for (extent, coordinate) in extents.iter_mut().zip(point) {
                    extent.add(coordinate);
                }
            }
        }
        Ok(extents)
    }

    /// Spacing of some particles at the start (m), `(m/ρ₀)^(1/d)` where it varies within bodies.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn first_sizes(&self, rows: Range<usize>, bodies: &[usize]) -> Result<Vec<f64>, PlotError> {
        let (Some(first), true) = (&self.densities, self.coarsest != self.spacings) else {
            return Ok(bodies.iter().map(|&body| self.spacings[body]).collect());
        };
        let masses = self.file.scalar("mass", 0, rows)?;
        let size = |(&body, mass): (&usize, f64)| {
            let size = (mass / first[body]).powf(1.0 / f64::from(self.dimension));
            // Whatever a file says.
            let size = if size.is_finite() { size } else { 0.0 };
            size.clamp(0.5 * self.spacings[body], 2.0 * self.coarsest[body])
        };
        Ok(bodies.iter().zip(masses).map(size).collect())
    }

    /// Size of some particles: the spacing of the volume that they have now, `(m/ρ)^(1/d)` (m),
    /// from a quarter of their first spacing to four times that. Where the snapshot does not hold
    /// the density, or it is NaN, the first spacing itself.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn sizes(&self, rows: Range<usize>, bodies: &[usize]) -> Result<Vec<f64>, PlotError> {
        let spacings = self.first_sizes(rows.clone(), bodies)?;
        let (Some(first), true) = (&self.densities, self.has("density")?) else {
            return Ok(spacings);
        };
        let density = self.file.scalar("density", 0, rows)?;
        let growth = |(&body, now): (&usize, f64)| {
            let growth = (first[body] / now).powf(1.0 / f64::from(self.dimension));
            if growth.is_finite() {
                growth.clamp(0.25, LARGEST)
            } else {
                1.0
            }
        };
        let growths = bodies.iter().zip(density).map(growth);
        let spacings = spacings.into_iter();
        Ok(spacings
            .zip(growths)
            .map(|(s, growth)| s * growth)
            .collect())
    }

    /// Shape of some particles along the axes of the model: what their deformation gradient makes of a ball of
    /// their first spacing, or a ball of their [size](Self::sizes) where the snapshot holds none.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn shapes(&self, rows: Range<usize>, bodies: &[usize]) -> Result<Vec<Shape>, PlotError> {
        let sizes = self.sizes(rows.clone(), bodies)?.into_iter();
        let first = self.first_sizes(rows.clone(), bodies)?.into_iter();
        let images = self.images(rows, bodies)?.into_iter();
        let dimension = self.dimension();
        let ball = |size: f64, first: f64| {
            if size <= DENSE * first {
                Shape::dense(size, dimension)
            } else {
                Shape::ball(size)
            }
        };
        let all = sizes.zip(first).zip(images);
        Ok(all
            .map(|((size, first), image)| image.unwrap_or_else(|| ball(size, first)))
            .collect())
    }

    /// What the deformation gradients of some particles make of balls of their first spacing; none of those without.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn images(
        &self,
        rows: Range<usize>,
        bodies: &[usize],
    ) -> Result<Vec<Option<Shape>>, PlotError> {
        if !self.deforms {
            return Ok(vec![None; rows.len()]);
        }
        let first = self.first_sizes(rows.clone(), bodies)?;
        let gradients = self.file.values(DEFORMATION, rows)?;
        let all = first.into_iter().zip(gradients.as_chunks::<9>().0);
        let image =
            |(first, gradient): (f64, &[f64; 9])| Shape::image(first, gradient, self.dimension());
        Ok(all.map(image).collect())
    }

    fn dimension(&self) -> usize {
        usize::try_from(self.dimension).unwrap_or(3)
    }

    /// Masses of some particles (kg; per metre or square metre of a flat model): those that the
    /// snapshot holds, else ρ₀ Δp^d.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn masses(&self, rows: Range<usize>) -> Result<Vec<f64>, PlotError> {
        if self.has("mass")? {
            return Ok(self.file.scalar("mass", 0, rows)?);
        }
        let first = self.densities.as_ref().ok_or_else(|| PlotError::Snapshot {
            path: self.file.path().to_owned(),
            reason: "it tells neither masses nor initial densities".to_owned(),
        })?;
        let bodies = self.body_of(rows)?;
        let mass = |&body: &usize| first[body] * self.spacings[body].powi(self.dimension);
        Ok(bodies.iter().map(mass).collect())
    }

    /// The position and motion of each body.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn movers(&self) -> Result<Vec<Mover>, PlotError> {
        let mut movers = vec![Mover::default(); self.bodies.len()];
        let moves = self.has("velocity")?;
        for rows in self.chunks() {
            let bodies = self.body_of(rows.clone())?;
            let active = self.active(rows.clone())?;
            let mut velocities = vec![0.0; 3 * rows.len()];
            if moves {
                velocities = self.file.values("velocity", rows.clone())?;
            }
            let (velocities, _) = velocities.as_chunks::<3>();
            let sizes = self.first_sizes(rows.clone(), &bodies)?;
            let points = self.file.points(rows)?;
            let all = points.iter().zip(velocities).zip(bodies).zip(active);
            for ((((point, velocity), body), active), size) in all.zip(sizes) {
                if !active || !point.iter().chain(velocity).all(|c| c.is_finite()) {
                    continue;
                }
                let mover = &mut movers[body];
                for k in 0..3 {
                    mover.extents[k].add(point[k]);
                    mover.velocity[k] += velocity[k];
                }
                mover.particles += 1.0;
                mover.mass += (size / self.spacings[body]).powi(self.dimension);
            }
        }
        for (body, mover) in movers.iter_mut().enumerate() {
            let count = mover.particles.max(1.0);
            mover.velocity = mover.velocity.map(|sum| sum / count);
            let density = self.densities.as_ref().map_or(1.0, |first| first[body]);
            mover.mass *= density * self.spacings[body].powi(self.dimension);
        }
        Ok(movers)
    }

    /// The coordinate of the particle that lies nearest to a position along an axis (m).
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn nearest(&self, axis: Axis, position: f64) -> Result<Option<f64>, PlotError> {
        let distance = |x: &f64| (x - position).abs();
        let mut nearest: Option<f64> = None;
        for rows in self.chunks() {
            let active = self.active(rows.clone())?;
            let points = self.file.points(rows)?.into_iter().zip(active);
            let finite = points
                .filter(|(point, active)| *active && point.iter().all(|c| c.is_finite()))
                .map(|(point, _)| point[axis.index()]);
            nearest = finite
                .chain(nearest)
                .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        }
        Ok(nearest)
    }

    /// `true` if the snapshot holds a field.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read, [`PlotError::Snapshot`] if what it holds makes no sense.
    pub fn has(&self, field: &str) -> Result<bool, PlotError> {
        Ok(self.file.names()?.iter().any(|name| name == field))
    }
}

/// Planes of symmetry from the names and positions of a snapshot, or what is wrong with these.
fn symmetry(planes: Vec<(String, f64)>) -> Result<Vec<SymmetryPlane>, String> {
    let plane = |(name, position): (String, f64)| {
        let axis = Axis::named(&name);
        let axis = axis.ok_or_else(|| format!("a symmetry plane along \"{name}\""))?;
        Ok(SymmetryPlane { axis, position })
    };
    planes.into_iter().map(plane).collect()
}

/// Title of the case that wrote a snapshot.
///
/// # Errors
/// [`PlotError::Read`] if the snapshot cannot be read.
pub fn title(opener: &dyn Opener, path: &Path) -> Result<String, PlotError> {
    Ok(Snapshot::open(opener, path)?.title)
}

/// Names of the bodies of a snapshot, in the order of their numbers.
///
/// # Errors
/// [`PlotError::Read`] if the snapshot cannot be read.
pub fn bodies(opener: &dyn Opener, path: &Path) -> Result<Vec<String>, PlotError> {
    Ok(Snapshot::open(opener, path)?.bodies)
}

/// A JSON attribute of the group `/whipple`.
fn json<T: serde::de::DeserializeOwned>(
    file: &dyn SnapshotReader,
    name: &str,
) -> Result<T, PlotError> {
    let text = file.attribute("/whipple", name)?;
    serde_json::from_str(&text).map_err(|e| PlotError::Snapshot {
        path: file.path().to_owned(),
        reason: format!("attribute {name} of /whipple: {e}"),
    })
}
