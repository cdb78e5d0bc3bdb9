//! Rigid bodies that forces move, see the page on rigid bodies.
//!
//! Force and torque on a body are exact sums over its particles, so all ranks move it alike. It goes through the kicks and
//! drifts of the step as a particle does. Its particles take places and velocities from it: they are what all else sees.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::sums::sum_over;
use super::{Loads, Prescribed};
use comm::Comm;
use model::{Case, Freedom};
use numerics::attitude::{self, rotation, turned};
use numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use numerics::principal::principal;
use numerics::vector::{cross, dot, minus};
use particles::{GRAIN, ParticleStore};

/// A moment of inertia that is no more than this share of the largest one is none: the body does not turn about that axis.
const THIN: f64 = 1e-9;

/// A rigid body that forces move (SI); equal on all ranks.
///
/// Its reference point is the pivot, or the centre of mass, behind symmetry planes that of the whole.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidState {
    /// Index of the body.
    pub body: usize,
    /// Mass of its particles (kg).
    pub mass: f64,
    /// From the reference point to the centre of mass of its particles, at the start (m).
    pub lever: [f64; 3],
    /// `Σ m (r² 1 − r ⊗ r)` of its particles about the reference point at the start (kg m²): xx, yy, zz, xy, xz, yz.
    pub inertia: [f64; 6],
    /// Axes at the start about which it turns by itself.
    pub axes: [[f64; 3]; 3],
    /// One over the moments about these (1/(kg m²)), zero where it cannot turn.
    pub mobility: [f64; 3],
    /// Reference point at the start (m).
    pub origin: [f64; 3],
    /// Reference point (m).
    pub place: [f64; 3],
    /// Velocity of the reference point (m/s).
    pub velocity: [f64; 3],
    /// Rotation since the start: a unit quaternion, scalar part first.
    pub attitude: [f64; 4],
    /// Angular momentum about the reference point (kg m²/s), as far as it can turn.
    pub angular_momentum: [f64; 3],
    /// Force of contact on it now (N).
    pub force: [f64; 3],
    /// Torque of contact about the reference point now (N m).
    pub torque: [f64; 3],
}

/// Velocity of a point (m/s) and of rotation (rad/s).
#[derive(Debug, Clone, Copy, Default)]
struct Twist {
    velocity: [f64; 3],
    spin: [f64; 3],
}

impl Twist {
    /// Velocity (m/s) at `arm` (m) from the point.
    #[inline(always)]
    fn at(&self, arm: &[f64; 3]) -> [f64; 3] {
        let turn = cross(&self.spin, arm);
        std::array::from_fn(|a| self.velocity[a] + turn[a])
    }
}

/// Momentum (kg m/s) and angular momentum about the origin (kg m²/s), or force and torque.
type Screw = [[f64; 3]; 2];

/// `v` turned by a rotation.
fn apply(rotation: &[[f64; 3]; 3], v: &[f64; 3]) -> [f64; 3] {
    rotation.each_ref().map(|row| dot(row, v))
}

impl RigidState {
    /// Angular velocity (rad/s).
    #[must_use]
    pub fn spin(&self) -> [f64; 3] {
        let rotation = rotation(&self.attitude);
        let mut spin = [0.0; 3];
        for (axis, mobility) in self.axes.iter().zip(self.mobility) {
            let axis = apply(&rotation, axis);
            let rate = mobility * dot(&axis, &self.angular_momentum);
            for a in 0..3 {
                spin[a] += rate * axis[a];
            }
        }
        spin
    }

    fn twist(&self) -> Twist {
        Twist {
            velocity: self.velocity,
            spin: self.spin(),
        }
    }

    /// From the reference point to the centre of mass now (m).
    fn lever_now(&self) -> [f64; 3] {
        apply(&rotation(&self.attitude), &self.lever)
    }

    /// Momenta of its particles.
    fn momenta(&self) -> Screw {
        let rotation = rotation(&self.attitude);
        let (lever, spin) = (apply(&rotation, &self.lever), self.spin());
        let linear = self.twist().at(&lever).map(|v| self.mass * v);
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        let back: [f64; 3] =
            std::array::from_fn(|a| (0..3).fold(0.0, |sum, b| sum + rotation[b][a] * spin[b]));
        let inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let own = apply(&rotation, &apply(&inertia, &back));
        let (of_place, of_lever) = (cross(&self.place, &linear), cross(&lever, &self.velocity));
        let angular = std::array::from_fn(|a| of_place[a] + self.mass * of_lever[a] + own[a]);
        [linear, angular]
    }

    /// Force and torque about the origin of contact and gravity (m/s²).
    fn load(&self, gravity: &[f64; 3]) -> Screw {
        let weight = gravity.map(|g| self.mass * g);
        let lever = self.lever_now();
        let centre = std::array::from_fn(|a| self.place[a] + lever[a]);
        let (push, fall) = (cross(&self.place, &self.force), cross(&centre, &weight));
        [
            std::array::from_fn(|a| self.force[a] + weight[a]),
            std::array::from_fn(|a| self.torque[a] + push[a] + fall[a]),
        ]
    }

    /// What contact and gravity (m/s²) give in a time (s).
    fn kick(&mut self, freedom: &Freedom, gravity: &[f64; 3], time: f64) {
        let fall = cross(&self.lever_now(), &gravity.map(|g| self.mass * g));
        for a in 0..3 {
            if freedom.moves[a] {
                self.velocity[a] += time * (self.force[a] / self.mass + gravity[a]);
            }
            if freedom.turns[a] {
                self.angular_momentum[a] += time * (self.torque[a] + fall[a]);
            }
        }
    }

    /// Motion without force for a time (s).
    ///
    /// With the moments `I₁, I₂, I₃` and the components `l` of the angular momentum `L` along the axes of the body, the energy is
    /// `L²/2I₁ + ½(1/I₂ − 1/I₁) l₂² + ½(1/I₃ − 1/I₁) l₃²`. Each part alone turns the body at a constant rate, the first about
    /// `L` in space; it commutes with the others, which take turns (Touma & Wisdom 1994). `L` is constant to the bit, and
    /// the motion of a body with two equal moments exact.
    fn drift(&mut self, time: f64) {
        for a in 0..3 {
            self.place[a] += time * self.velocity[a];
        }
        let m = self.mobility;
        let apart = |&[p, q, _]: &[usize; 3]| (m[p] - m[q]).abs();
        let nearest = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
        let nearest = nearest
            .into_iter()
            .min_by(|a, b| apart(a).total_cmp(&apart(b)));
        let [p, q, s] = nearest.unwrap_or([0, 1, 2]);
        self.turn_about(q, (m[q] - m[p]) * (0.5 * time));
        self.turn_about(s, (m[s] - m[p]) * time);
        self.turn_about(q, (m[q] - m[p]) * (0.5 * time));
        let turn = self.angular_momentum.map(|l| m[p] * time * l);
        self.attitude = turned(&self.attitude, &turn);
    }

    /// Turns it about one of its axes by the angular momentum along that times `factor` (s/(kg m²)).
    fn turn_about(&mut self, axis: usize, factor: f64) {
        let axis = apply(&rotation(&self.attitude), &self.axes[axis]);
        let angle = factor * dot(&axis, &self.angular_momentum);
        self.attitude = turned(&self.attitude, &axis.map(|a| angle * a));
    }

    /// True if all numbers are finite, the body has a mass and its attitude is a rotation.
    pub(crate) fn is_sound(&self) -> bool {
        let vectors = [
            self.lever,
            self.mobility,
            self.origin,
            self.place,
            self.velocity,
            self.angular_momentum,
            self.force,
            self.torque,
        ];
        let mut all = (vectors.iter().chain(&self.axes).flatten()).chain(&self.inertia);
        let length2 = self.attitude.iter().fold(0.0, |sum, q| sum + q * q);
        self.mass > 0.0
            && self.mass.is_finite()
            && (length2 - 1.0).abs() < 1e-9
            && all.all(|value| value.is_finite())
    }
}

/// A free body in a step.
#[derive(Debug)]
struct Moving {
    body: usize,
    /// Its ledger.
    by: u8,
    freedom: Freedom,
    /// True if something holds it.
    is_held: bool,
    /// Its reference point (m) in the half kick that comes next.
    place: [f64; 3],
    /// Before the drift or after it, in the middle of the step.
    middle: Twist,
    /// At its end.
    end: Twist,
}

/// The rigid bodies of a case that forces move.
#[derive(Debug, Default)]
pub(super) struct FreeBodies {
    bodies: Vec<Moving>,
    /// By bit of a particle's loads.
    of_bit: [u8; model::Loads::MOST],
    bits: u32,
    /// Force and torque about the reference point, of this rank and then of all.
    sums: Vec<[ExactSum; 6]>,
    limbs: Vec<i64>,
}

impl FreeBodies {
    /// Of those among the rigid bodies of a case, the first of which has the bit `first`.
    pub fn new(case: &Case, first: usize, rigid: &[usize]) -> Self {
        let mut free = Self::default();
        for (bit, &body) in (first..)
            .zip(rigid)
            .filter(|(_, body)| case.bodies[**body].is_free())
        {
            let freedom = case.freedom_of(&case.bodies[body]);
            free.of_bit[bit] = u8::try_from(free.bodies.len()).unwrap_or(u8::MAX);
            free.bits |= 1 << bit;
            free.bodies.push(Moving {
                body,
                by: u8::try_from(bit).unwrap_or(u8::MAX),
                freedom,
                is_held: is_held(&freedom, case.dimension),
                place: [0.0; 3],
                middle: Twist::default(),
                end: Twist::default(),
            });
            free.sums.push(Default::default());
        }
        free
    }

    /// The bits of particles of these bodies.
    #[inline(always)]
    pub fn bits(&self) -> u32 {
        self.bits
    }

    pub fn memory(&self) -> usize {
        (size_of::<Moving>() + 6 * size_of::<ExactSum>()) * self.bodies.capacity()
            + size_of::<i64>() * self.limbs.capacity()
    }

    /// Velocities of a particle at `x` (m) of the body that these bits name.
    #[inline]
    pub fn at(&self, bits: u32, x: &[f64; 3]) -> Prescribed {
        let body = &self.bodies[self.slot(bits)];
        let arm = minus(x, &body.place);
        Prescribed {
            by: [Some(body.by); 3],
            middle: body.middle.at(&arm),
            end: body.end.at(&arm),
            rigid: false,
        }
    }

    /// Place of the body that these bits name among these bodies.
    #[inline(always)]
    fn slot(&self, bits: u32) -> usize {
        self.of_bit[(bits & self.bits).trailing_zeros() as usize] as usize
    }

    /// Gives particles the places and velocities of their bodies.
    fn carry(&self, particles: &mut ParticleStore, states: &[RigidState]) {
        if self.bits == 0 {
            return;
        }
        let owned = particles.owned();
        let (start, loads) = (&particles.reference_position, &particles.load);
        // At most so many as a particle has bits.
        let mut rotations = [[[0.0; 3]; 3]; model::Loads::MOST];
        for (own, state) in rotations.iter_mut().zip(states) {
            *own = rotation(&state.attitude);
        }
        (
            particles.position[..owned].par_chunks_mut(GRAIN),
            particles.velocity[..owned].par_chunks_mut(GRAIN),
            particles.predicted_velocity[..owned].par_chunks_mut(GRAIN),
        )
            .into_par_iter()
            .enumerate()
            .for_each(|(chunk, (x, v, v_p))| {
                for k in 0..x.len() {
                    let i = chunk * GRAIN + k;
                    if loads[i] & self.bits == 0 {
                        continue;
                    }
                    let slot = self.slot(loads[i]);
                    let (body, state) = (&self.bodies[slot], &states[slot]);
                    let arm = apply(&rotations[slot], &minus(&start[i], &state.origin));
                    x[k] = std::array::from_fn(|a| state.place[a] + arm[a]);
                    v[k] = body.middle.at(&arm);
                    v_p[k] = body.end.at(&arm);
                }
            });
    }
}

impl Loads {
    /// Rigid bodies that forces move, before they begin.
    pub(crate) fn free_bodies(&self) -> Vec<RigidState> {
        let of = |moving: &Moving| RigidState {
            body: moving.body,
            ..RigidState::default()
        };
        self.free.bodies.iter().map(of).collect()
    }

    /// Weighs the rigid bodies that forces move, and gives their particles the first velocities. Collective.
    pub(crate) fn begin_free(
        &mut self,
        comm: &Comm,
        case: &Case,
        particles: &mut ParticleStore,
        states: &mut [RigidState],
    ) {
        for (moving, state) in self.free.bodies.iter_mut().zip(&mut *states) {
            let mut sum = |terms: &(dyn Fn(usize) -> [f64; 6] + Sync)| {
                let is_own = |i: usize| particles.body[i] as usize == moving.body;
                let own = |i: usize| is_own(i).then(|| terms(i));
                let mut sums = sum_over(particles.owned(), own);
                join(comm, std::slice::from_mut(&mut sums), &mut self.free.limbs);
                sums.map(|sum| sum.value())
            };
            let (mass, position) = (&particles.mass, &particles.position);
            let [total, x, y, z, ..] = sum(&|i| {
                let [x, y, z] = position[i].map(|x| mass[i] * x);
                [mass[i], x, y, z, 0.0, 0.0]
            });
            let centre = [x, y, z].map(|sum| sum / total);
            let body = &case.bodies[moving.body];
            let mut origin = body.freedom.pivot.map_or(centre, Into::into);
            for plane in &case.symmetry {
                origin[plane.axis.index()] = plane.position;
            }
            let inertia = sum(&|i| {
                let [x, y, z] = minus(&position[i], &origin);
                let m = mass[i];
                let [xx, yy, zz] = [
                    m * (y * y + z * z),
                    m * (x * x + z * z),
                    m * (x * x + y * y),
                ];
                [xx, yy, zz, -m * (x * y), -m * (x * z), -m * (y * z)]
            });
            let turns = moving.freedom.turns;
            let (moments, columns) = if turns == [true; 3] {
                principal(&inertia)
            } else {
                let [x, y, z, ..] = inertia;
                principal(&[x, y, z, 0.0, 0.0, 0.0])
            };
            let thin = THIN
                * moments
                    .iter()
                    .fold(0.0, |most: f64, &moment| most.max(moment));
            let can_turn = |k: usize| moments[k] > thin && (turns == [true; 3] || turns[k]);
            *state = RigidState {
                body: moving.body,
                mass: total,
                lever: minus(&centre, &origin),
                inertia,
                axes: std::array::from_fn(|k| std::array::from_fn(|a| columns[a][k])),
                mobility: std::array::from_fn(|k| if can_turn(k) { 1.0 / moments[k] } else { 0.0 }),
                origin,
                place: origin,
                velocity: std::array::from_fn(|a| {
                    let given = body.velocity_at(&origin.into())[a];
                    if moving.freedom.moves[a] { given } else { 0.0 }
                }),
                attitude: attitude::START,
                ..RigidState::default()
            };
            // `L = I ω`, with the moments about the axes about which it turns.
            let spin: [f64; 3] = body.angular_velocity.into();
            for k in (0..3).filter(|&k| can_turn(k)) {
                let along = moments[k] * dot(&state.axes[k], &spin);
                for a in 0..3 {
                    state.angular_momentum[a] += along * state.axes[k][a];
                }
            }
            moving.place = state.place;
            (moving.middle, moving.end) = (state.twist(), state.twist());
        }
        self.free.carry(particles, states);
    }

    /// First half kick of rigid bodies in a step `dt` (s), and their drift. Their particles have not moved yet.
    pub(crate) fn advance_free(&mut self, states: &mut [RigidState], dt: f64) {
        self.move_free(states, 0.5 * dt, |moving, state, kick| {
            moving.place = state.place;
            kick(state);
            moving.middle = state.twist();
            state.drift(dt);
        });
    }

    /// Second half kick of rigid bodies in a step `dt` (s).
    pub(crate) fn kick_free(&mut self, states: &mut [RigidState], dt: f64) {
        self.move_free(states, 0.5 * dt, |moving, state, kick| {
            moving.middle = state.twist();
            kick(state);
            moving.end = state.twist();
        });
    }

    /// Lets rigid bodies `go` through a half kick of half a step (s), and books what holds them.
    fn move_free(
        &mut self,
        states: &mut [RigidState],
        half: f64,
        go: impl Fn(&mut Moving, &mut RigidState, &dyn Fn(&mut RigidState)),
    ) {
        let gravity = self.gravity;
        for (moving, state) in self.free.bodies.iter_mut().zip(states) {
            let books = moving.is_held && self.keeps_books;
            let before = books.then(|| (state.momenta(), state.load(&gravity)));
            let freedom = moving.freedom;
            go(moving, state, &|state| state.kick(&freedom, &gravity, half));
            let Some((momenta, load)) = before else {
                continue;
            };
            // What the body has gained beyond what it bore.
            let now = state.momenta();
            let sums = [
                &mut self.sums[moving.by as usize][..3],
                &mut self.angular_impulse,
            ];
            for (part, sums) in sums.into_iter().enumerate() {
                for (a, sum) in sums.iter_mut().enumerate() {
                    sum.add(now[part][a] - momenta[part][a] - half * load[part][a]);
                }
            }
        }
    }

    /// Moves the particles of rigid bodies after their drift, and predicts their velocities.
    pub(crate) fn carry_free(
        &mut self,
        particles: &mut ParticleStore,
        states: &[RigidState],
        dt: f64,
    ) {
        for (moving, state) in self.free.bodies.iter_mut().zip(states) {
            moving.place = state.place;
            moving.middle = state.twist();
            let mut predicted = *state;
            // Force and torque of the beginning of the step, as with particles.
            predicted.kick(&moving.freedom, &self.gravity, 0.5 * dt);
            moving.end = predicted.twist();
        }
        self.free.carry(particles, states);
    }

    /// Sums what contact does to rigid bodies over all ranks. Collective.
    pub(crate) fn press_free(
        &mut self,
        comm: &Comm,
        particles: &ParticleStore,
        states: &mut [RigidState],
    ) {
        let FreeBodies {
            bodies,
            bits,
            sums,
            limbs,
            ..
        } = &mut self.free;
        if *bits == 0 {
            return;
        }
        for (moving, sums) in bodies.iter().zip(&mut *sums) {
            let bit = 1 << moving.by;
            *sums = sum_over(particles.owned(), |i| {
                (particles.load[i] & bit != 0).then_some(())?;
                let contact = particles.contact_acceleration.get(i);
                let contact = contact.copied().unwrap_or_default();
                let drag = &particles.acceleration[i];
                let force = std::array::from_fn(|a| particles.mass[i] * (drag[a] + contact[a]));
                let [x, y, z] = force;
                let arm = minus(&particles.position[i], &moving.place);
                let [turn_x, turn_y, turn_z] = cross(&arm, &force);
                Some([x, y, z, turn_x, turn_y, turn_z])
            });
        }
        join(comm, sums, limbs);
        for (sums, state) in sums.iter().zip(states) {
            let [x, y, z, torque @ ..] = sums.each_ref().map(ExactSum::value);
            (state.force, state.torque) = ([x, y, z], torque);
        }
    }
}

/// True if a body is not free to do all that a dimension has.
fn is_held(freedom: &Freedom, dimension: usize) -> bool {
    let turns = match dimension {
        3 => &freedom.turns[..],
        2 => &freedom.turns[2..],
        _ => &[],
    };
    freedom.moves[..dimension].contains(&false) || turns.contains(&false)
}

/// Joins sums of all ranks, with memory to do so. Collective.
fn join(comm: &Comm, sums: &mut [[ExactSum; 6]], limbs: &mut Vec<i64>) {
    limbs.clear();
    gather_limbs(sums.iter_mut().flatten(), limbs);
    comm.sum_i64(limbs);
    scatter_limbs(sums.iter_mut().flatten(), limbs);
}
