//! Joints: bonds between the particles of two bodies that touch at the start (theory page "Joints").
//!
//! Particles whose places at the start are within the kernel of each other are bonded. With `w_ij = V_i V_j |W'(r⁰_ij)|`
//! of these places a bond is a spring along the line between the two, of the force `c K w_ij (1 − d_ij)(r_ij − r⁰_ij)`.
//! So momentum and angular momentum are exact, and a turn of all strains nothing. `c` is such that a plane that opens by δ
//! bears `K δ` (moments of the kernel over half a space). Bonds bear no pressure, which contact does: what presses the
//! faces together shortens them without a force.
//!
//! The opening of the joint at a particle is the δ that explains its bonds best, of least `Σ w (r − r⁰ − δ·e)²` along
//! their directions e. Along the normal, the mean direction, and across it δ over that which bears the strength says how
//! far `d` has come, where a plane that slides is as stiff as its bonds lie: the traction falls linearly with the
//! opening, such that an area takes its energy (power law of exponent one for mixed modes; Camanho & Dávila 2002,
//! NASA/TM-2002-211737, eqs 14 to 20). Each end holds half of a bond. What it lets go of becomes heat.

use rayon::prelude::*;

use super::force::{ContactStress, Receiver, TaskForces};
use super::mode::{Scene, fill, for_each_chunk};
use super::pair::{Between, Pair};
use super::view::{ContactParticle, ContactView, Separation};
use model::{Case, ContactClass, Joint};
use numerics::kernel::{FixedKernel, Kernel};
use numerics::matrix::symmetric_adjugate;
use numerics::vector::{dot, norm};
use particles::neighbours::CHUNKS_AT_ONCE;
use particles::{Mirrors, Scatter};

/// Smoothing length of the bonds over that of contact, whose lists hold them until they have stretched by a ninth.
const LENGTH: f64 = 0.9;

/// Share of the sum over bonds that lies along each axis at least, so that few bonds tell no opening across them.
const REGULAR: f64 = 1e-3;

/// Constants of the joint of an ordered pair of size classes.
#[derive(Debug, Clone)]
pub(super) struct JointPair {
    /// `c K` (Pa/m).
    spring: f64,
    kernel: FixedKernel,
    /// One over the opening that bears the strengths in tension and shear, if it slides as stiffly as it opens (1/m).
    inverse_starts: [f64; 2],
    /// One over the ductilities: openings at which nothing is left over those above. Infinite if it breaks at once.
    brittleness: [f64; 2],
}

/// The joints of a case.
#[derive(Debug, Clone)]
pub(super) struct Joints {
    /// By ordered pair of size classes, as the pairs of the table.
    pairs: Vec<Option<JointPair>>,
    mirrors: Mirrors,
    /// One over the number of directions in the plane of a joint.
    per_direction: f64,
}

impl JointPair {
    fn new(joint: &Joint, kernel: &Kernel, modulus: f64, pair: &Pair) -> Self {
        let stiffness = Joint::stiffness(modulus, pair.spacing);
        let strengths = [joint.strength, joint.shear_strength];
        let brittleness = |energy: Option<f64>, strength: f64| {
            strength * strength / (2.0 * energy.unwrap_or(0.0) * stiffness)
        };
        Self {
            spring: moment(kernel.dimension()) * stiffness,
            kernel: kernel.of_length(LENGTH * pair.h),
            inverse_starts: strengths.map(|strength| stiffness / strength),
            brittleness: [
                brittleness(joint.energy, joint.strength),
                brittleness(joint.shear_energy, joint.shear_strength),
            ],
        }
    }
}

/// `c`: one over the sum of `|W'| r (e·n)²` of all pairs across a plane of normal n, by area, in units of density.
fn moment(dimension: usize) -> f64 {
    match dimension {
        1 => 2.0,
        2 => 0.75 * std::f64::consts::PI,
        _ => 8.0 / 3.0,
    }
}

impl Joints {
    /// Of a case, without pairs.
    pub fn of(case: &Case) -> Self {
        Self {
            pairs: Vec::new(),
            mirrors: Mirrors::of(case),
            per_direction: if case.extent() == 3 { 0.5 } else { 1.0 },
        }
    }

    /// Adds the next pair of the table.
    pub fn push(&mut self, of: &Between) {
        let [a, b] = of.indices;
        let joint = of.case.joint_between(a, b).filter(|_| a != b);
        let pair = joint.map(|joint| JointPair::new(joint, of.kernel, of.modulus, of.pair));
        self.pairs.push(pair);
    }

    /// True if any bodies are joined.
    pub fn any(&self) -> bool {
        self.pairs.iter().any(Option::is_some)
    }

    #[inline(always)]
    pub fn get(&self, at: usize) -> Option<&JointPair> {
        self.pairs[at].as_ref()
    }

    /// Where a particle, image or point began (m).
    #[inline(always)]
    fn start(&self, view: &ContactView, of: &ContactParticle) -> [f64; 3] {
        let start = &view.particles.reference_position[of.slot];
        if view.table.rings {
            return view.shown(of, start);
        }
        self.mirrors.reflect_position(start, of.mirror_mask)
    }
}

/// A bond of two particles.
struct Bond<'a> {
    j: ContactParticle,
    constants: &'a JointPair,
    separation: Separation,
    /// `V_j |W'|` (1/m).
    weight: f64,
    /// How much longer it is than at the start (m).
    longer: f64,
    /// The same without what presses the faces together, and that before the last step (m).
    stretch: f64,
    stretch_before: f64,
    /// How much of the change of its length in the step is due to what presses them together (m).
    pressing: f64,
    /// Share that has come apart, and that before the last step.
    damage: [f64; 2],
}

impl Bond<'_> {
    /// False if it had come apart for good before the last step.
    fn holds(&self) -> bool {
        self.damage[1] < 1.0
    }

    /// Stiffness of the spring with a particle of a volume, whole (N/m).
    fn stiffness(&self, volume: f64) -> f64 {
        self.constants.spring * volume * self.weight
    }

    /// Energy of the last step over its stiffness (m²) that becomes heat: with the work of the forces at both ends of the
    /// step it balances what a spring holds that softens, and whose length at rest moves.
    fn released(&self) -> f64 {
        let [now, before] = self.damage;
        let softened = (now - before) * (self.stretch * self.stretch_before).max(0.0);
        let pulls = (1.0 - now) * self.stretch + (1.0 - before) * self.stretch_before;
        0.5 * (softened + pulls * self.pressing)
    }
}

/// Share of a particle's joint that has come apart, and that before the last step.
#[inline(always)]
fn damage(view: &ContactView, of: &ContactParticle) -> [f64; 2] {
    let damage = view.particles.joint_damage[of.slot];
    [damage, damage - view.particles.joint_growth[of.slot]]
}

/// How far pressure moves a particle against the bodies that it is joined to, and that before the last step (m).
#[inline(always)]
fn pressed(view: &ContactView, of: &ContactParticle) -> [[f64; 3]; 2] {
    let all = view.particles;
    let (now, change) = (all.joint_pressed[of.slot], all.joint_pressing[of.slot]);
    let before = std::array::from_fn(|a| now[a] - change[a]);
    [now, before].map(|vector| view.shown(of, &vector))
}

/// The bonds of a receiver with some of its foreign neighbours.
fn bonds<'v>(
    view: &'v ContactView<'v>,
    i: &'v ContactParticle,
    neighbours: &'v [u32],
) -> impl Iterator<Item = Bond<'v>> {
    let joints = &view.table.joints;
    let (start, here) = (joints.start(view, i), damage(view, i));
    let pressed_here = pressed(view, i);
    view.others(i, neighbours).filter_map(move |(_, j)| {
        let constants = view.table.joint(i.size_class, j.size_class)?;
        let there = damage(view, &j);
        let damage = [0, 1].map(|when| 0.5 * (here[when] + there[when]));
        let other = joints.start(view, &j);
        let [x, y, z] = [
            start[0] - other[0],
            start[1] - other[1],
            start[2] - other[2],
        ];
        let distance = (x * x + y * y + z * z).sqrt();
        let slope = -constants.kernel.slope(distance);
        if slope <= 0.0 {
            return None;
        }
        let separation = Separation::between(i, &j);
        let pressed_there = pressed(view, &j);
        let before = separation.before(i, &j, view.dt);
        let [now, then] = [(&separation, 0), (&before, 1)].map(|(separation, when)| {
            let along = separation.along(0.5);
            let short = dot(&pressed_here[when], &along) - dot(&pressed_there[when], &along);
            (separation.distance - distance, short)
        });
        let weight = j.volume * slope;
        Some(Bond {
            j,
            constants,
            separation,
            weight,
            longer: now.0,
            stretch: now.0 - now.1,
            stretch_before: then.0 - then.1,
            pressing: now.1 - then.1,
            damage,
        })
    })
}

/// Measurement of the joint of one particle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measured {
    particle: usize,
    /// Share that has come apart as the bonds are stretched now.
    damage: f64,
    /// What presses it against the other bodies (m).
    pressed: [f64; 3],
}

/// Lets joints of all particles come apart as far as their bonds are stretched. Collects in `found`.
pub(super) fn measure(found: &mut Vec<Vec<Measured>>, scene: &mut Scene) {
    if !scene.table.has_joints() {
        return;
    }
    fill(&mut scene.particles.joint_growth, 0.0);
    fill(&mut scene.particles.joint_pressing, [0.0; 3]);
    for &class in ContactClass::ALL {
        let view = scene.view();
        for_each_chunk(found, scene.lists, class, |found, list, _| {
            found.extend(list.iter().filter_map(|(index, neighbours)| {
                let i = view.particle(index);
                come_apart(&view, &i, neighbours)
            }));
        });
        let particles = &mut *scene.particles;
        let [all, growth] = [&mut particles.joint_damage, &mut particles.joint_growth]
            .map(|field| Scatter::new(field));
        let [pressed, pressing] = [&mut particles.joint_pressed, &mut particles.joint_pressing]
            .map(|field| Scatter::new(field));
        let chunks = found.par_iter().with_max_len(CHUNKS_AT_ONCE);
        chunks.flatten_iter().for_each(|now| {
            // SAFETY: a particle is receiver in one task, and each thread has its own tasks.
            let (damage, grown, short, shorter) = unsafe {
                let at = now.particle;
                (
                    all.slot(at),
                    growth.slot(at),
                    pressed.slot(at),
                    pressing.slot(at),
                )
            };
            if now.damage > *damage {
                *grown = now.damage - *damage;
                *damage = now.damage;
            }
            *shorter = std::array::from_fn(|a| now.pressed[a] - short[a]);
            *short = now.pressed;
        });
    }
}

/// How the joint of a particle fares as its bonds are stretched; none if it has none.
fn come_apart(view: &ContactView, i: &ContactParticle, neighbours: &[u32]) -> Option<Measured> {
    let (mut weight, mut normal, mut pull, mut spread) = (0.0, [0.0; 3], [0.0; 3], [0.0; 6]);
    let (mut inverse_starts, mut brittle) = ([0.0; 2], [0.0; 2]);
    for Bond {
        constants,
        separation,
        weight: w,
        longer,
        ..
    } in bonds(view, i, neighbours)
    {
        let e = separation.along(1.0);
        weight += w;
        for a in 0..3 {
            normal[a] += w * e[a];
            pull[a] += w * longer * e[a];
        }
        let products = [
            e[0] * e[0],
            e[1] * e[1],
            e[2] * e[2],
            e[0] * e[1],
            e[0] * e[2],
            e[1] * e[2],
        ];
        for (sum, product) in spread.iter_mut().zip(products) {
            *sum += w * product;
        }
        for mode in 0..2 {
            inverse_starts[mode] += w * constants.inverse_starts[mode];
            brittle[mode] += w * constants.brittleness[mode];
        }
    }
    view.mirror(&mut normal);
    view.mirror(&mut pull);
    let size = norm(&normal);
    if size == 0.0 {
        return None;
    }
    if view.table.rings {
        // Pairs of points of a ring cancel these.
        (spread[4], spread[5]) = (0.0, 0.0);
    }
    for diagonal in &mut spread[..3] {
        *diagonal += REGULAR * weight;
    }
    let ([xx, yy, zz, xy, xz, yz], determinant) = symmetric_adjugate(&spread);
    let opening =
        [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|row| dot(&row, &pull) / determinant);
    let normal = normal.map(|x| x / size);
    let apart = dot(&opening, &normal);
    let slide = norm(&std::array::from_fn(|a| opening[a] - apart * normal[a]));
    // Stiffness across the normal over that along it: faces in layers slide more easily than others.
    let [xx, yy, zz, xy, xz, yz] = spread;
    let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|row| dot(&row, &normal));
    let stiff = dot(&rows, &normal);
    let soft = (xx + yy + zz - stiff) * view.table.joints.per_direction / stiff;
    let [open, slid] = inverse_starts.map(|sum| sum / weight);
    let load = [apart.max(0.0) * open, slide * slid * soft];
    let brittle = [brittle[0] / weight, brittle[1] / (weight * soft)];
    Some(Measured {
        particle: i.slot,
        damage: softened(load, brittle.map(|brittle| brittle.min(1.0))),
        pressed: normal.map(|x| apart.min(0.0) * x),
    })
}

/// Share that has come apart at an opening and a slide over those that bear the strengths, given one over the ductilities: `(1 − d) λ` falls from one at `λ = 1` to nothing at the ductility.
fn softened([tension, shear]: [f64; 2], brittle: [f64; 2]) -> f64 {
    let square = tension * tension + shear * shear;
    if square <= 1.0 {
        return 0.0;
    }
    let load = square.sqrt();
    let inverse = (brittle[0] * (tension * tension) + brittle[1] * (shear * shear)) / square;
    let end = 1.0 / inverse;
    if load >= end {
        return 1.0;
    }
    end * (load - 1.0) / (load * (end - 1.0))
}

impl TaskForces {
    /// Adds what joints do to receivers with their foreign neighbours.
    pub(super) fn add_joints<'l>(
        &mut self,
        view: &ContactView,
        list: impl Iterator<Item = (u32, &'l [u32])>,
    ) {
        for (index, neighbours) in list {
            let i = view.particle(index);
            let mut on = Receiver::new(&i, 0, &mut self.by_body);
            let mut any = false;
            for bond in bonds(view, &i, neighbours).filter(Bond::holds) {
                let j = &bond.j;
                let stiffness = bond.stiffness(i.volume);
                let left = stiffness * (1.0 - bond.damage[0]);
                let mut force = bond.separation.along(-left * bond.stretch);
                view.mirror(&mut force);
                // Each side has half of both.
                let square = bond.stretch * bond.stretch;
                let heat = if view.dt > 0.0 {
                    let share = view.table.pair(i.size_class, j.size_class).heat_share;
                    share * stiffness * bond.released() / view.dt
                } else {
                    0.0
                };
                // Heat goes half with this kick and half with the next one, which the energy keeps until then.
                on.add(j, &force, 0.25 * left * square + 0.5 * heat * view.dt, heat);
                on.sum.stiffness += 2.0 * left;
                any = true;
            }
            if any {
                let sum = on.sum;
                self.particles.push(sum);
            }
        }
    }
}

/// Adds the stress that joints carry through the receiver `i`.
pub(super) fn add_stress(
    view: &ContactView,
    i: &ContactParticle,
    neighbours: &[u32],
    carried: &mut ContactStress,
) {
    for bond in bonds(view, i, neighbours).filter(Bond::holds) {
        let left = bond.stiffness(i.volume) * (1.0 - bond.damage[0]);
        let mut force = bond.separation.along(-left * bond.stretch);
        view.mirror(&mut force);
        carried.add(&force, &force, &bond.separation.r.map(|x| 0.5 * x));
    }
}

#[cfg(test)]
mod tests {
    use super::{moment, softened};
    use numerics::kernel::Kernel;

    /// Sum over the pairs of two half spaces of `|W'| (e·n)²`.
    #[test]
    fn a_plane_that_opens_bears_its_stiffness() {
        let fine = 24;
        let step = 2.0 / f64::from(fine);
        let at = |k: i32| (f64::from(k) + 0.5) * step;
        for dimension in 1..=3 {
            let kernel = Kernel::new(dimension).of_length(1.0);
            let across = if dimension > 1 { -fine..fine } else { 0..1 };
            let third = if dimension > 2 { -fine..fine } else { 0..1 };
            let mut open = 0.0;
            for a in 0..fine {
                for b in across.clone() {
                    for c in third.clone() {
                        let x = at(a);
                        let y = if dimension > 1 { at(b) } else { 0.0 };
                        let z = if dimension > 2 { at(c) } else { 0.0 };
                        let r = (x * x + y * y + z * z).sqrt();
                        // As many pairs stand so far apart across the plane.
                        let weight = -kernel.slope(r) * x * kernel_cell(step, dimension);
                        open += weight * (x / r) * (x / r);
                    }
                }
            }
            let c = moment(dimension);
            assert!((c * open - 1.0).abs() < 4e-3, "{dimension}: {}", c * open);
        }
    }

    fn kernel_cell(step: f64, dimension: usize) -> f64 {
        (0..dimension).map(|_| step).product()
    }

    /// The traction rises to the strength, falls in a straight line, and encloses the energy.
    #[test]
    fn softening_takes_its_energy() {
        let end = 7.0;
        let steps = 20_000;
        let step = end / f64::from(steps);
        for (mode, brittle) in [(0, [1.0 / end, 1.0]), (1, [1.0, 1.0 / end])] {
            let traction = |load: f64| {
                let mut loads = [0.0; 2];
                loads[mode] = load;
                (1.0 - softened(loads, brittle)) * load
            };
            let work: f64 = (0..steps)
                .map(|k| step * traction((f64::from(k) + 0.5) * step))
                .sum();
            assert!((work - 0.5 * end).abs() < 1e-4, "{work}");
            assert!((traction(4.0) - 0.5).abs() < 1e-12);
            assert!(softened([0.9, 0.4], brittle) == 0.0 && softened([8.0, 8.0], brittle) == 1.0);
        }
        // Mixed: (G_I/G_Ic) + (G_II/G_IIc) = 1 of equal shares of both.
        let mixed = softened([2.0, 2.0], [1.0 / 3.0, 1.0 / 6.0]);
        let (load, end) = (8.0_f64.sqrt(), 4.0);
        assert!((mixed - end * (load - 1.0) / (load * (end - 1.0))).abs() < 1e-12);
    }
}
