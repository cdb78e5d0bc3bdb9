//! Foreign fractions, and the normals that go with them.

use rayon::prelude::*;

use super::constants;
use crate::contact::mode::{MeasuredChunks, Scene, fill, for_each_chunk};
use crate::contact::view::{ContactParticle, ContactView, Separation};
use model::{ContactClass, Overlap};
use numerics::vector::norm;
use particles::Scatter;
use particles::neighbours::{CHUNKS_AT_ONCE, Chunk};

/// A particle is enclosed whose foreign fraction with current volumes exceeds this, unless there is room for it.
const ENCLOSED_FRACTION: f64 = 0.5;

/// Largest touching value plus initial overlap offset: beyond it a particle counts as inside the
/// other body.
pub const OFFSET_LIMIT: f64 = 0.45;

/// The foreign fraction of one receiver and what follows from it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Fraction {
    /// `S_i`.
    pub fraction: f64,
    /// `M̄_i` (Pa), stiffness included.
    pub modulus: f64,
    /// `C̄_i`.
    pub touching: f64,
    /// `E_i`.
    pub excess: f64,
    /// `g_i = Σ V_j |∇W_ij|` (1/m).
    pub slope: f64,
    /// `Σ V_j W_ij` with current volumes, those of voids left out.
    pub current: f64,
    /// Material of its own body that it lacks: `λ_i = ⟨1 − 2 Σ V_j W_ij/C̄_i⟩₊` over those of its body.
    pub isolation: f64,
}

/// Measurement of one particle by overlap contact.
pub(crate) struct Measured {
    pub particle: usize,
    /// Its place in the sequence.
    place: u32,
    pub fraction: Fraction,
    /// For how long it has been enclosed after this step (s).
    enclosed: f64,
    /// Its normal, see [`normal`]; zero without friction.
    normal: [f64; 3],
}

/// The initial overlap offset of a particle laid with foreign fraction `fraction` and touching
/// value `touching`, and whether it had to be capped.
#[must_use]
pub fn initial_offset(fraction: &Fraction) -> (f64, bool) {
    let wanted = (fraction.fraction - fraction.touching).max(0.0);
    let limit = (OFFSET_LIMIT - fraction.touching).max(0.0);
    (wanted.min(limit), wanted > limit)
}

/// Current volume (m³) of the matter of an image, without the voids in it, or what a point stands for of it.
#[inline(always)]
fn matter(view: &ContactView, index: u32, particle: &ContactParticle) -> f64 {
    let most = particle.whole * view.table.expansion(particle.body);
    let matter = view.motion[index as usize].volume.min(most);
    if view.table.rings {
        return matter * (particle.volume / particle.whole);
    }
    matter
}

/// Sums the foreign fraction of the receiver at `index`, whose initial overlap offset is `offset`.
#[must_use]
pub fn fraction(view: &ContactView, index: u32, neighbours: &[u32], offset: f64) -> Fraction {
    let i = view.particle(index);
    let mut sum = Fraction::default();
    for (other, j) in view.others(&i, neighbours) {
        let (pair, own) = constants(view, &i, &j);
        let separation = Separation::between(&i, &j);
        let kernel = pair.kernel.value(separation.distance);
        let share = j.volume * kernel;
        sum.fraction += share;
        sum.modulus += share * own.modulus;
        sum.touching += share * own.touching;
        sum.slope -= j.volume * pair.kernel.slope(separation.distance);
        sum.current += matter(view, other, &j) * kernel;
    }
    if sum.fraction > 0.0 {
        sum.modulus /= sum.fraction;
        sum.touching /= sum.fraction;
        sum.excess = (sum.fraction - sum.touching - offset).max(0.0);
    }
    sum
}

/// The normal that the receiver at `index` sees, `−∇S_i/|∇S_i|`, times `S_i²`: how much it knows.
/// The particle that sees a face knows the normal; one of a face that sees a lone particle does
/// not.
fn normal(view: &ContactView, index: u32, neighbours: &[u32], fraction: &Fraction) -> [f64; 3] {
    let i = view.particle(index);
    let mut sum = [0.0; 3];
    for (_, j) in view.others(&i, neighbours) {
        let separation = Separation::between(&i, &j);
        let slope = -constants(view, &i, &j).0.kernel.slope(separation.distance);
        let along = separation.along(j.volume * slope);
        for a in 0..3 {
            sum[a] += along[a];
        }
    }
    view.mirror(&mut sum);
    let weight = fraction.fraction * fraction.fraction / norm(&sum).max(f64::MIN_POSITIVE);
    sum.map(|x| x * weight)
}

/// Measures the receivers of all chunks.
pub(super) fn weigh(found: &mut MeasuredChunks<Overlap>, scene: &Scene) {
    let friction = scene.table.has_friction();
    let view = scene.view();
    for_each_chunk(
        found,
        scene.lists,
        ContactClass::Overlap,
        |found, list, own| {
            found.extend(list.iter().map(|(index, neighbours)| {
                let particle = view.images[index as usize].slot();
                let offset = view.particles.touch_relief[particle];
                let fraction = fraction(&view, index, neighbours, offset);
                let is_enclosed = fraction.current > ENCLOSED_FRACTION;
                Measured {
                    particle,
                    place: index,
                    fraction,
                    enclosed: if is_enclosed {
                        view.particles.enclosed_time[particle] + scene.dt
                    } else {
                        0.0
                    },
                    normal: if friction {
                        normal(&view, index, neighbours, &fraction)
                    } else {
                        [0.0; 3]
                    },
                }
            }));
            look_at_own(&view, found, own);
        },
    );
}

/// Measures how isolated the receivers in contact are and whether the enclosed ones have room, from the lists of their
/// own bodies.
fn look_at_own(view: &ContactView, found: &mut [Measured], own: &Chunk) {
    // What bears stress elsewhere has its stress points in these lists.
    let groups = &view.table.groups;
    let is_elsewhere = groups.count() > groups.of_bodies;
    let needs = |measured: &Measured| measured.fraction.excess > 0.0 || measured.enclosed > 0.0;
    if is_elsewhere || !found.iter().any(needs) {
        return;
    }
    // Both stand in the same order.
    let mut wanted = found.iter_mut().peekable();
    for (cluster, neighbours, _) in own.iter() {
        for &place in cluster.valid() {
            let Some(measured) = wanted.next_if(|measured| measured.place == place) else {
                continue;
            };
            let fraction = &mut measured.fraction;
            if fraction.excess > 0.0 {
                fraction.isolation = isolation(view, place, neighbours, fraction.touching);
            }
            if measured.enclosed > 0.0 && has_room(view, place, neighbours, fraction.current) {
                measured.enclosed = 0.0;
            }
        }
    }
}

/// True if its own and foreign matter (the fraction `current`) together leave room for a particle: with half of itself
/// they fill its support at most once. A particle in a vacancy of a foreign lattice has room, one between
/// sites has none.
fn has_room(view: &ContactView, index: u32, own: &[u32], current: f64) -> bool {
    let i = view.particle(index);
    let mut filled = current;
    for (other, j) in view.others(&i, own) {
        let distance = Separation::between(&i, &j).distance;
        let kernel = view
            .table
            .pair(i.size_class, j.size_class)
            .kernel
            .value(distance);
        let share = matter(view, other, &j) * kernel;
        let itself = other == index && !view.table.rings;
        filled += if itself { 0.5 * share } else { share };
        if filled > 1.0 {
            return false;
        }
    }
    true
}

/// `λ_i = ⟨1 − 2 Σ V_j W_ij/C̄_i⟩₊` over the neighbours in its own body: 0 where these fill half as much
/// of its support as a body in touch does, 1 where there are none. Rigid bodies are not isolated.
fn isolation(view: &ContactView, index: u32, own: &[u32], touching: f64) -> f64 {
    let i = view.particle(index);
    let groups = &view.table.groups;
    if groups.rigid[groups.of_body[i.body]] {
        return 0.0;
    }
    let half = 0.5 * touching;
    let mut left = half;
    for (other, j) in view.others(&i, own) {
        if other != index || view.table.rings {
            let distance = Separation::between(&i, &j).distance;
            left -= j.volume
                * view
                    .table
                    .pair(i.size_class, j.size_class)
                    .kernel
                    .value(distance);
            if left <= 0.0 {
                return 0.0;
            }
        }
    }
    left / half
}

/// Stores what has been measured; nothing of particles without foreign neighbours.
pub(super) fn store(found: &MeasuredChunks<Overlap>, scene: &mut Scene) {
    let particles = &mut *scene.particles;
    // What else there is of a fraction nobody reads without excess.
    for field in [
        &mut particles.foreign_fraction,
        &mut particles.contact_excess,
        &mut particles.enclosed_time,
        &mut particles.isolation,
    ] {
        fill(field, 0.0);
    }
    fill(&mut particles.contact_normal, [0.0; 3]);
    let fields = [
        &mut particles.foreign_fraction,
        &mut particles.contact_excess,
        &mut particles.enclosed_time,
        &mut particles.contact_modulus,
        &mut particles.touching_value,
        &mut particles.contact_slope,
        &mut particles.isolation,
    ]
    .map(|field| Scatter::new(field));
    let friction = scene.table.has_friction();
    let normals = friction.then(|| Scatter::new(&mut particles.contact_normal));
    let particles = |measured: &Measured| {
        let (i, f) = (measured.particle, &measured.fraction);
        let values = [
            f.fraction,
            f.excess,
            measured.enclosed,
            f.modulus,
            f.touching,
            f.slope,
            f.isolation,
        ];
        // SAFETY: a particle is receiver in one task, and each thread has its own tasks.
        unsafe {
            for (field, value) in fields.iter().zip(values) {
                *field.slot(i) = value;
            }
            if let Some(normals) = &normals {
                *normals.slot(i) = measured.normal;
            }
        }
    };
    let chunks = found.par_iter().with_max_len(CHUNKS_AT_ONCE);
    chunks.for_each(|chunk| chunk.iter().for_each(particles));
}
