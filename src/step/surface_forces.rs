//! Rigid surfaces in the step: a frictionless penalty on particles nearer than half a spacing, see
//! [`crate::contact::surface`].

use rayon::prelude::*;

use super::search::GRAIN;
use super::simulation::Simulation;
use crate::contact::{ContactTable, surface};
use crate::model::{Case, RigidSurface};
use crate::particles::ParticleStore;

/// A rigid surface in one step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SurfaceStep {
    /// How far it has moved since time zero at the end of the step (m).
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
    pub(super) fn new(surface: &RigidSurface, from: f64, to: f64) -> Self {
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
    pub(super) fn in_half(&self, first: bool) -> ([f64; 3], f64) {
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

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A surface as it stands at the end of a step.
#[derive(Clone, Copy)]
struct Placed<'a> {
    surface: &'a RigidSurface,
    step: &'a SurfaceStep,
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
    fn local(&self, x: &[f64; 3]) -> [f64; 3] {
        let (Some(turn), Some(spin)) = (&self.step.turn, &self.surface.spin) else {
            return std::array::from_fn(|a| x[a] - self.step.shift[a]);
        };
        let (r, arm) = (&turn.rotation, self.arm(x));
        std::array::from_fn(|a| {
            spin.point[a] + (r[0][a] * arm[0] + r[1][a] * arm[1] + r[2][a] * arm[2])
        })
    }

    /// A vector of the surface's frame in space.
    fn outward(&self, v: [f64; 3]) -> [f64; 3] {
        self.step
            .turn
            .map_or(v, |turn| turn.rotation.map(|row| dot(&row, &v)))
    }

    /// Velocity of what turns with the surface at `x` (m/s), at the end of the step.
    fn velocity(&self, x: &[f64; 3]) -> [f64; 3] {
        let velocity = self.step.velocity[2];
        let (Some(turn), Some(spin)) = (&self.step.turn, &self.surface.spin) else {
            return velocity;
        };
        let around = cross(&spin.axis, &self.arm(x));
        std::array::from_fn(|a| velocity[a] + turn.rate[2] * around[a])
    }

    /// Torque of a force (N) at `x` about the axis of rotation (N m); zero without one.
    fn torque(&self, x: &[f64; 3], force: &[f64; 3]) -> f64 {
        let spin = self.surface.spin.as_ref();
        spin.map_or(0.0, |spin| dot(&spin.axis, &cross(&self.arm(x), force)))
    }
}

/// What a surface does to one particle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Push {
    particle: usize,
    surface: usize,
    /// Force (N) and its torque about the axis that the surface turns about (N m).
    force: [f64; 3],
    torque: f64,
    energy: f64,
    stiffness: f64,
    approach: f64,
}

/// Constants of a surface and a body that it acts on.
#[derive(Debug, Clone, Copy)]
struct Penalty {
    /// Stiffness over volume, `κ M/Δp²` (Pa/m²).
    stiffness: f64,
    /// Where it begins, ½Δp (m).
    reach: f64,
    h: f64,
}

/// The surfaces of a case and what they do, kept from step to step.
#[derive(Debug, Default)]
pub(super) struct SurfaceForces {
    /// By surface and body; absent where a surface does not act.
    penalties: Vec<Vec<Option<Penalty>>>,
    /// By task.
    pushes: Vec<Vec<Push>>,
}

impl SurfaceForces {
    pub(super) fn new(case: &Case) -> Self {
        let penalties = case.loads.surfaces.iter().map(|surface| {
            let bodies = case.bodies.iter().zip(&surface.bodies);
            let penalty = bodies.map(|(body, &acts)| {
                let spacing = body.lattice.spacing;
                acts.then(|| Penalty {
                    stiffness: surface.stiffness * case.materials[body.material].p_wave_modulus()
                        / (spacing * spacing),
                    reach: 0.5 * spacing,
                    h: body.smoothing_length,
                })
            });
            penalty.collect()
        });
        Self {
            penalties: penalties.collect(),
            pushes: Vec::new(),
        }
    }

    pub(super) fn memory(&self) -> usize {
        let penalties = self.penalties.iter().map(Vec::capacity).sum::<usize>();
        let pushes = self.pushes.iter().map(Vec::capacity).sum::<usize>();
        penalties * size_of::<Option<Penalty>>() + pushes * size_of::<Push>()
    }
}

impl Penalty {
    /// How far from the surface particles are looked for: where they feel it or approach it, and
    /// as far behind it as no penalty lets them come.
    fn limit(&self) -> f64 {
        2.0 * self.h.max(self.reach)
    }

    /// The approach speed of a particle at a gap (m) that changes at `rate` (m/s): that towards its
    /// mirror image, see `contact::Gap::approach`.
    fn approach(&self, gap: f64, rate: f64) -> f64 {
        let soft = 4.0 * (gap * gap) + 0.01 * (self.h * self.h);
        (-4.0 * self.h * rate * gap.abs() / soft).max(0.0)
    }
}

impl Simulation {
    /// Adds what the rigid surfaces do to the forces of contact.
    pub(super) fn surface_forces(&mut self) {
        if self.loads.surfaces.is_empty() {
            return;
        }
        self.find_pushes();
        let (store, sums) = (&mut self.store, &mut self.sums);
        for push in self.surface_forces.pushes.iter().flatten() {
            let i = push.particle;
            let per_mass = 1.0 / store.mass[i];
            for a in 0..3 {
                store.contact_acceleration[i][a] += push.force[a] * per_mass;
            }
            store.contact_energy[i] += push.energy;
            store.contact_stiffness[i] += push.stiffness;
            store.approach_speed[i] = store.approach_speed[i].max(push.approach);
            sums.contact_energy.add(push.energy);
            sums.add_push(push.surface, &push.force, push.torque);
        }
    }

    /// The particles near surfaces, chunk after chunk.
    fn find_pushes(&mut self) {
        let owned = self.store.owned();
        let SurfaceForces { penalties, pushes } = std::mem::take(&mut self.surface_forces);
        let mut pushes = pushes;
        pushes.resize(owned.div_ceil(GRAIN), Vec::new());
        let view = View {
            store: &self.store,
            table: &self.contact,
            surfaces: &self.case.loads.surfaces,
            steps: &self.loads.surfaces,
            penalties: &penalties,
        };
        let chunks = pushes.par_iter_mut().enumerate();
        chunks.for_each(|(chunk, pushes)| {
            pushes.clear();
            for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(owned) {
                pushes.extend((0..view.surfaces.len()).filter_map(|n| view.push(i, n)));
            }
        });
        self.surface_forces = SurfaceForces { penalties, pushes };
    }
}

/// What a push depends on.
struct View<'a> {
    store: &'a ParticleStore,
    table: &'a ContactTable,
    surfaces: &'a [RigidSurface],
    steps: &'a [SurfaceStep],
    penalties: &'a [Vec<Option<Penalty>>],
}

impl View<'_> {
    /// What surface `n` does to particle `i`, if that is near it.
    fn push(&self, i: usize, n: usize) -> Option<Push> {
        let body = self.store.body[i] as usize;
        let penalty = self.penalties[n][body].as_ref()?;
        let placed = Placed {
            surface: &self.surfaces[n],
            step: &self.steps[n],
        };
        let x = &self.store.position[i];
        let local = placed.local(x);
        let escape = surface::escape(placed.surface, &local, penalty.reach, penalty.limit())?;
        let gap = escape.foot.gap;
        // Stress points have no mass and no contact.
        if gap >= penalty.h.max(penalty.reach) || self.store.mass[i] == 0.0 {
            return None;
        }
        let volume = self.store.mass[i] * self.table.inverse_density(body);
        let stiffness = penalty.stiffness * volume;
        let force = placed.outward(escape.way.map(|u| stiffness * u));
        let (v, surface_v) = (&self.store.predicted_velocity[i], placed.velocity(x));
        let rate = dot(
            &placed.outward(escape.foot.normal),
            &[
                v[0] - surface_v[0],
                v[1] - surface_v[1],
                v[2] - surface_v[2],
            ],
        );
        Some(Push {
            particle: i,
            surface: n,
            torque: placed.torque(x, &force),
            force,
            energy: 0.5 * stiffness * escape.depth2,
            stiffness: stiffness * escape.walls,
            approach: penalty.approach(gap, rate),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Motion, Spin, SurfaceShape};

    /// At its own mirror image, twice the speed at twice the distance.
    #[test]
    fn a_surface_is_approached_like_a_mirror() {
        let penalty = Penalty {
            stiffness: 3e11,
            reach: 0.5e-3,
            h: 1.3e-3,
        };
        let approach = penalty.approach(0.5e-3, -10.0);
        let expected = 1.3e-3 * 20.0 * 1e-3 / (1e-6 + 0.01 * 1.69e-6);
        assert!((approach / expected - 1.0).abs() < 1e-14);
    }

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
            file: None,
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
