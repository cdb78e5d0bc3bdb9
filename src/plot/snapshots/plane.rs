//! The plane of a section, and which one shows a model best.

use super::extent::{Extent, Mover};
use super::snapshot::Snapshot;
use crate::PlotError;
use crate::units;
use model::{Axis, SymmetryPlane};

/// Speeds below this share of the largest are those of round-off.
const AT_REST: f64 = 1e-6;

/// A plane normal to an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Normal.
    pub axis: Axis,
    /// Its position on its axis (m).
    pub position: f64,
}

impl Plane {
    /// The axes that point right and up in the picture.
    pub fn picture_axes(&self) -> [Axis; 2] {
        match self.axis {
            Axis::X => [Axis::Y, Axis::Z],
            Axis::Y => [Axis::X, Axis::Z],
            Axis::Z => [Axis::X, Axis::Y],
        }
    }

    /// Unit vectors to the right and up in the picture, and along the normal.
    pub fn axes(&self) -> [[f64; 3]; 3] {
        let [right, up] = self.picture_axes();
        [right, up, self.axis].map(|axis| {
            let mut unit = [0.0; 3];
            unit[axis.index()] = 1.0;
            unit
        })
    }

    /// Reads `y=0.1mm`, or `y` without a position.
    pub fn read(text: &str) -> Result<(Axis, Option<f64>), PlotError> {
        let (name, position) = match text.split_once('=') {
            Some((name, position)) => (name, Some(position)),
            None => (text, None),
        };
        let axis = Axis::named(name.trim());
        let axis = axis.ok_or_else(|| PlotError::Section {
            text: text.to_owned(),
        })?;
        let position = position.map(|position| units::parse(position, "m"));
        Ok((axis, position.transpose()?))
    }

    /// Reads `y=0.1mm`; without a position the plane of symmetry or the middle of the model.
    pub fn parse(text: &str, snapshot: &Snapshot) -> Result<Self, PlotError> {
        match Self::read(text)? {
            (axis, Some(position)) => Ok(Self { axis, position }),
            (axis, None) => Ok(Self::through(axis, snapshot, &snapshot.extent()?)),
        }
    }

    /// The plane that shows the impact.
    ///
    /// z of a flat model. Else a plane along the direction of the impact through the body that
    /// moves most against the rest, which is the lighter one of two: a plane of symmetry that cuts
    /// this body, if there is one, else through the mean of its particles.
    pub fn best(snapshot: &Snapshot) -> Result<Self, PlotError> {
        if snapshot.dimension < 3 {
            return Ok(Self::through(Axis::Z, snapshot, &snapshot.extent()?));
        }
        let bodies = snapshot.movers()?;
        let (projectile, direction) = impact(&bodies);
        let Some(extents) = projectile.map(|body| &bodies[body].extents) else {
            return Ok(Self {
                axis: Axis::Y,
                position: 0.0,
            });
        };
        let room = 0.5 * snapshot.finest();
        let cuts = |plane: &&SymmetryPlane| {
            let extent = extents[plane.axis.index()];
            (extent.lowest - room..=extent.highest + room).contains(&plane.position)
        };
        let mut normals = vec![Axis::Y, Axis::Z, Axis::X];
        normals.retain(|axis| *axis != direction);
        let of = |axis: &Axis| {
            snapshot
                .symmetry
                .iter()
                .filter(cuts)
                .find(|p| p.axis == *axis)
        };
        if let Some(plane) = normals.iter().find_map(of) {
            return Ok(Self {
                axis: plane.axis,
                position: plane.position,
            });
        }
        let axis = normals[0];
        let mean = short(extents[axis.index()].mean(), room);
        let nearest = snapshot.nearest(axis, mean)?;
        Ok(Self {
            axis,
            // The middle of a body that is hollow, or has flown apart, may be empty.
            position: nearest.filter(|p| (p - mean).abs() > room).unwrap_or(mean),
        })
    }

    /// The plane of symmetry, or through the middle of the model.
    pub fn through(axis: Axis, snapshot: &Snapshot, extent: &[Extent; 3]) -> Self {
        let plane = snapshot.symmetry.iter().find(|plane| plane.axis == axis);
        // Without the round-off of a mean.
        let step = 1e-3 * snapshot.finest();
        let middle = (extent[axis.index()].mean() / step).round() * step;
        Self {
            axis,
            position: plane.map_or(middle, |plane| plane.position),
        }
    }
}

/// The body that moves most against the mean of all, and the axis along which it does so: upwards
/// where nothing moves, and then the lightest body.
fn impact(bodies: &[Mover]) -> (Option<usize>, Axis) {
    let present = || (0..bodies.len()).filter(|&b| bodies[b].mass > 0.0);
    let total: f64 = present().map(|b| bodies[b].mass).sum();
    let mean = [0, 1, 2].map(|k| {
        let momentum: f64 = present()
            .map(|b| bodies[b].mass * bodies[b].velocity[k])
            .sum();
        momentum / total
    });
    let speed = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    let against = |b: usize| [0, 1, 2].map(|k| bodies[b].velocity[k] - mean[k]);
    let fastest = present()
        .map(|b| speed(&bodies[b].velocity))
        .fold(0.0, f64::max);
    // The first of equals.
    let projectile = present()
        .rev()
        .max_by(|&a, &b| speed(&against(a)).total_cmp(&speed(&against(b))))
        .filter(|&b| speed(&against(b)) > AT_REST * fastest);
    let lightest = present().min_by(|&a, &b| bodies[a].mass.total_cmp(&bodies[b].mass));
    // A single body may move against what a snapshot does not hold: a plane, a surface.
    let motion = projectile.map_or(mean, against);
    let along = |axis: &Axis| motion[axis.index()].abs();
    let direction = Axis::ALL
        .into_iter()
        .max_by(|a, b| along(a).total_cmp(&along(b)));
    (projectile.or(lightest), direction.unwrap_or(Axis::Z))
}

/// A position as a number of few digits, moved by no more than half of `room`.
fn short(position: f64, room: f64) -> f64 {
    let per_step = 10_f64.powf(-room.log10().floor());
    (position * per_step).round() / per_step
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mover(mass: f64, velocity: [f64; 3]) -> Mover {
        Mover {
            mass,
            velocity,
            ..Mover::default()
        }
    }

    #[test]
    fn the_lighter_of_two_bodies_is_the_projectile() {
        let target = mover(9.0, [0.0; 3]);
        let sphere = mover(1.0, [0.0, 1.0, -7.0]);
        let (body, axis) = impact(&[target.clone(), sphere.clone()]);
        assert_eq!((body, axis), (Some(1), Axis::Z));
        assert_eq!(impact(&[sphere, target]).0, Some(0));
    }

    #[test]
    fn what_rests_or_is_alone_is_seen_from_the_side() {
        let rest = [mover(9.0, [0.0; 3]), mover(1.0, [0.0; 3]), Mover::default()];
        assert_eq!(impact(&rest), (Some(1), Axis::Z));
        assert_eq!(impact(&[mover(1.0, [3.0, 0.0, 1.0])]), (Some(0), Axis::X));
        assert_eq!(impact(&[]), (None, Axis::Z));
    }

    #[test]
    fn positions_have_few_digits() {
        assert_eq!(short(1.234e-4, 1e-5), 1.2e-4);
        assert_eq!(short(-3e-7, 5e-5), 0.0);
        assert_eq!(short(2.5e-3, 5e-4), 2.5e-3);
    }
}
