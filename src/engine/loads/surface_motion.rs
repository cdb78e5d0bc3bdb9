//! Positions and motion of rigid surfaces in a step.

use crate::domain::Span;
use model::{RigidSurface, SurfaceShape};
use numerics::vector::{cross, dot, norm};

/// A rigid surface in one step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SurfaceStep {
    /// Displacement since time zero at the end of the step (m).
    shift: [f64; 3],
    /// Velocities at the beginning, in the middle and at the end (m/s).
    velocity: [[f64; 3]; 3],
    turn: Option<Turn>,
}

/// Rotation of a surface about an axis.
#[derive(Debug, Clone, Copy)]
struct Turn {
    /// From the frame of the surface to space, at the end of the step.
    rotation: [[f64; 3]; 3],
    /// Rates (rad/s) at the beginning, in the middle and at the end.
    rate: [f64; 3],
}

impl SurfaceStep {
    /// The step from time `from` to `to` (s).
    pub(crate) fn new(surface: &RigidSurface, from: f64, to: f64) -> Self {
        let motion = &surface.motion;
        let mean = |from, to| std::array::from_fn(|a| motion.mean(a, from, to));
        Self {
            shift: std::array::from_fn(|a| motion.mean(a, 0.0, to) * to),
            velocity: [mean(from, from), mean(from, to), mean(to, to)],
            turn: surface.spin.as_ref().map(|spin| {
                let rate = |from, to| spin.rate.mean(0, from, to);
                Turn {
                    rotation: rotation(&spin.axis, rate(0.0, to) * to),
                    rate: [rate(from, from), rate(from, to), rate(to, to)],
                }
            }),
        }
    }

    /// Mean velocity (m/s) and rate (rad/s) in the first or the second half of the step.
    pub(crate) fn in_half(&self, first: bool) -> ([f64; 3], f64) {
        let end = if first { 0 } else { 2 };
        let [middle, end_velocity] = [self.velocity[1], self.velocity[end]];
        let rate = self.turn.map_or(0.0, |t| 0.5 * (t.rate[1] + t.rate[end]));
        (
            std::array::from_fn(|a| 0.5 * (middle[a] + end_velocity[a])),
            rate,
        )
    }
}

/// Rotation by an angle (rad) about a unit vector (Rodrigues).
fn rotation(axis: &[f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    let [x, y, z] = *axis;
    let skew = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let same = if i == j { c } else { 0.0 };
            same + s * skew[i][j] + (1.0 - c) * axis[i] * axis[j]
        })
    })
}

/// A surface as it stands at the end of a step.
#[derive(Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub surface: &'a RigidSurface,
    pub step: &'a SurfaceStep,
}

impl Placed<'_> {
    /// From the axis of rotation to `x` (m).
    fn arm(&self, x: &[f64; 3]) -> [f64; 3] {
        let point = self
            .surface
            .spin
            .as_ref()
            .map_or([0.0; 3], |spin| spin.point);
        std::array::from_fn(|a| x[a] - self.step.shift[a] - point[a])
    }

    /// A place (m) in the frame of the surface, where it stood at time zero.
    pub(crate) fn local(&self, x: &[f64; 3]) -> [f64; 3] {
        let (Some(turn), Some(spin)) = (&self.step.turn, &self.surface.spin) else {
            return std::array::from_fn(|a| x[a] - self.step.shift[a]);
        };
        let (r, arm) = (&turn.rotation, self.arm(x));
        std::array::from_fn(|a| {
            spin.point[a] + (r[0][a] * arm[0] + r[1][a] * arm[1] + r[2][a] * arm[2])
        })
    }

    /// A vector of the surface's frame in space.
    pub(crate) fn outward(&self, v: [f64; 3]) -> [f64; 3] {
        self.step
            .turn
            .map_or(v, |turn| turn.rotation.map(|row| dot(&row, &v)))
    }

    /// Velocity of what turns with the surface at `x` (m/s), at the end of the step.
    pub(crate) fn velocity(&self, x: &[f64; 3]) -> [f64; 3] {
        let velocity = self.step.velocity[2];
        let (Some(turn), Some(spin)) = (&self.step.turn, &self.surface.spin) else {
            return velocity;
        };
        let around = cross(&spin.axis, &self.arm(x));
        std::array::from_fn(|a| velocity[a] + turn.rate[2] * around[a])
    }

    /// Largest speed (m/s) at which particles and the surface come nearer from time `from`, now, to
    /// `to` (s), or somewhat more.
    pub(crate) fn closing_speed(&self, particles: &Span, from: f64, to: f64) -> f64 {
        let motion = &self.surface.motion;
        let ground = std::array::from_fn(|a| motion.range(a, from, to).unwrap_or_default());
        let Some(spin) = &self.surface.spin else {
            return match &self.surface.shape {
                SurfaceShape::Plane { normal, .. } => particles.onto_plane(normal, &ground),
                _ => norm(&particles.against(&ground)),
            };
        };
        let speed = norm(&particles.against(&ground));
        let [least, most] = spin.rate.range(0, from, to).unwrap_or_default();
        let centre = std::array::from_fn(|a| spin.point[a] + self.step.shift[a]);
        // As far from the axis as they are or get.
        let arm = particles.farthest_from(&centre, &spin.axis) + speed * (to - from);
        speed + least.abs().max(most.abs()) * arm
    }

    /// Torque of a force (N) at `x` about the axis of rotation (N m); zero without one.
    pub(crate) fn torque(&self, x: &[f64; 3], force: &[f64; 3]) -> f64 {
        let spin = self.surface.spin.as_ref();
        spin.map_or(0.0, |spin| dot(&spin.axis, &cross(&self.arm(x), force)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::{Motion, Resistance, Spin, SurfaceShape};

    /// A point that rides on a surface stays where it is in the surface's frame, and the velocity
    /// there is how it rides.
    #[test]
    fn frames_follow_translation_and_rotation() {
        let along_x = Motion {
            times: vec![0.0, 2.0],
            velocities: [Some(vec![0.0, 4.0]), None, Some(vec![1.0, 1.0])],
        };
        let surface = RigidSurface {
            name: String::new(),
            shape: SurfaceShape::Sphere {
                centre: [0.0; 3],
                radius: 1.0,
            },
            inside: false,
            stiffness: 2.0,
            resistance: Resistance::default(),
            bodies: Vec::new(),
            motion: along_x,
            spin: Some(Spin {
                point: [1.0, 2.0, 3.0],
                axis: [0.0, 0.6, 0.8],
                rate: Motion {
                    times: vec![0.0, 1.0],
                    velocities: [Some(vec![0.5, 1.5]), None, None],
                },
            }),
        };
        let rider = [0.3, -0.4, 1.7];
        let at = |t: f64| {
            let step = SurfaceStep::new(&surface, t, t);
            let placed = Placed {
                surface: &surface,
                step: &step,
            };
            let turned = placed.outward(std::array::from_fn(|a| rider[a] - [1.0, 2.0, 3.0][a]));
            let x: [f64; 3] =
                std::array::from_fn(|a| [1.0, 2.0, 3.0][a] + turned[a] + step.shift[a]);
            let back = placed.local(&x);
            for a in 0..3 {
                assert!((back[a] - rider[a]).abs() < 1e-14);
            }
            (x, placed.velocity(&x))
        };
        let d = 1e-5;
        let (before, after) = (at(0.8 - d).0, at(0.8 + d).0);
        let (x, v) = at(0.8);
        for a in 0..3 {
            assert!((v[a] - (after[a] - before[a]) / (2.0 * d)).abs() < 1e-8);
        }
        // 2t² · ½ and t along the axes, (0.5 + ½ t) t of turn.
        assert!((at(0.0).0[0] - 0.3).abs() < 1e-15);
        assert!(x[2] > 0.8);
    }
}
