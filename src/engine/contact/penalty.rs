//! Penalty between boundary particles, after Campbell, Vignjevic & Libersky (2000).
//!
//! The outermost particles of a body and their normals are found after Randles & Libersky (1996):
//! the corrected gradient of what the body fills, `b_i = B_i s_i` with `s_i = −Σ V_j ∇W_ij` and
//! `B_i⁻¹ = −Σ V_j ∇W_ij ⊗ r_ij` over the own body, points out of it and is longest on its
//! outermost layer. Boundary particles of two bodies push each other along the mean of their
//! normals; a corner, which has two, along that of the face it is pressed on, and two corners along
//! the line between them, as pinballs do (Belytschko & Neal 1991), whose laws these are.

mod boundary;

use rayon::prelude::*;

use super::mode::{MeasuredChunks, Mode, PairForce, ParticlePair, Scene, fill, for_each_chunk};
use super::pair::{Between, Constants};
use super::view::{ContactParticle, ContactView};
use boundary::{Boundary, CORNER, normal};
use model::{ContactClass, Penalty, PenaltyLaw};
use numerics::vector::{dot, minus, norm};
use particles::Mirrors;
use particles::neighbours::CHUNKS_AT_ONCE;
use particles::{HaloPhase, Owner, Scatter};

/// Constants of an ordered pair of bodies.
#[derive(Debug, Clone, Default)]
pub(crate) struct PenaltyPair {
    /// κ times the smaller p-wave modulus (Pa).
    modulus: f64,
    /// True if the force is no more than what stops the approach in one step.
    pinball: bool,
    /// Limits that distinguish boundary particles of the receiver's body.
    boundary: Boundary,
}

impl Constants for Penalty {
    type Pair = PenaltyPair;

    const HALO: HaloPhase = HaloPhase::CONTACT;
    const OWNER: Owner = Owner::PENALTY;

    fn pair(&self, of: &Between) -> PenaltyPair {
        let body = of.bodies[0];
        PenaltyPair {
            modulus: self.stiffness * of.modulus,
            pinball: self.law == PenaltyLaw::Pinball,
            boundary: Boundary::of_lattice(of.kernel, body.smoothing_length / body.lattice.spacing),
        }
    }
}

impl Mode for Penalty {
    /// A particle and its normal.
    type Measured = (usize, [f64; 3]);
    type Side = ();

    /// Normals of the boundary particles that may be pressed on.
    fn measure(found: &mut MeasuredChunks<Self>, scene: &mut Scene) {
        let view = scene.view();
        for_each_chunk(
            found,
            scene.lists,
            ContactClass::Penalty,
            |found, list, own| {
                if list.is_empty() {
                    return;
                }
                // Receivers of both lists stand in the same order.
                let mut wanted = list.iter().peekable();
                for (cluster, neighbours, _) in own.iter() {
                    for &index in &cluster.receivers[..cluster.lanes] {
                        if let Some((_, foreign)) = wanted.next_if(|(at, _)| *at == index) {
                            let i = view.particle(index);
                            let j = view.particle(foreign[0]);
                            let known =
                                &view.table.own::<Self>(i.size_class, j.size_class).boundary;
                            found.push((i.slot, normal(&view, &i, neighbours, known)));
                        }
                    }
                }
            },
        );
        fill(&mut scene.particles.boundary_normal, [0.0; 3]);
        let normals = Scatter::new(&mut scene.particles.boundary_normal);
        let chunks = found.par_iter().with_max_len(CHUNKS_AT_ONCE);
        chunks.flatten_iter().for_each(|&(i, normal)| {
            // SAFETY: a particle is receiver in one task.
            unsafe { *normals.slot(i) = normal };
        });
    }

    fn side(_: &ContactView, _: &ContactParticle) {}

    /// Over the directions n of [`directions`] with shares s: `p = Δp̄ − r·n`, `w = s ⟨1 −
    /// t²/Δp̄²⟩₊²` over the offset t across n, `F₂ = w κ M V̄/Δp̄ (p/Δp̄)^{3/2}` along n; by the
    /// law of pinballs their sum is no more than `F₁ = Σw m_i m_j/(m_i + m_j) ṗ/Δt` while the two
    /// approach along it and nothing while they part.
    fn force(pair: &ParticlePair<Self>, stiffness: &mut f64) -> Option<PairForce> {
        let ParticlePair { view, i, j, .. } = *pair;
        let (separation, spacing) = (&pair.separation, pair.constants.spacing);
        let volume = 0.5 * (i.volume + j.volume);
        let (mut force, mut energy, mut weights, mut slope) = ([0.0; 3], 0.0, 0.0, 0.0);
        for (share, n) in directions(pair)? {
            let along = dot(&separation.r, &n);
            let aside =
                (separation.distance * separation.distance - along * along) / (spacing * spacing);
            let depth = 1.0 - along / spacing;
            if share == 0.0 || aside >= 1.0 || depth <= 0.0 || depth >= 2.0 {
                continue;
            }
            let weight = share * (1.0 - aside) * (1.0 - aside);
            weights += weight;
            let modulus = pair.own.modulus * pair.mean_stiffening();
            let strength = weight * modulus * volume / spacing;
            let root = depth.sqrt();
            for a in 0..3 {
                force[a] += strength * depth * root * n[a];
            }
            energy += 0.2 * strength * spacing * depth * depth * root;
            // Twice the slope of both, since both particles yield.
            slope += 2.0 * 1.5 * strength * root / spacing;
        }
        let mut size = norm(&force);
        if size == 0.0 {
            return None;
        }
        *stiffness += slope;
        energy *= pair.own_share();
        if pair.own.pinball {
            // It stores nothing: what it takes is lost.
            energy = 0.0;
            if view.dt > 0.0 {
                let (m_i, m_j) = (view.particles.mass[i.slot], view.particles.mass[j.slot]);
                let v = minus(&i.velocity, &j.velocity);
                let rate = (-dot(&v, &force) / size).max(0.0);
                let most = weights * (m_i * m_j / (m_i + m_j)) * rate / view.dt;
                let part = (most / size).min(1.0);
                force = force.map(|f| part * f);
                size *= part;
            }
        }
        Some(PairForce {
            force,
            drag: 0.0,
            energy,
            loads: [0.5 * size; 2],
        })
    }
}

/// Directions from `j` to `i` in which the two press on each other, with their shares, which sum to
/// one: the mean of both normals as they count, and the line between the two as far as no normal
/// says how they lie, as of two corners or of faces that look the same way. `None` unless both are
/// of the boundary.
fn directions(pair: &ParticlePair<Penalty>) -> Option<[(f64, [f64; 3]); 2]> {
    let outward = |of: &ContactParticle| {
        Mirrors::reflect_vector(
            &pair.view.particles.boundary_normal[of.slot],
            of.mirror_mask,
        )
    };
    let (here, there) = (outward(pair.i), outward(pair.j));
    let (a, b) = (norm(&here), norm(&there));
    if a == 0.0 || b == 0.0 {
        return None;
    }
    // As long as they count: of a corner not at all.
    let count = |length: f64| (length - CORNER).max(0.0) / ((1.0 - CORNER) * length);
    let (of_i, of_j) = (count(a), count(b));
    let mean: [f64; 3] = std::array::from_fn(|k| of_j * there[k] - of_i * here[k]);
    let known = norm(&mean);
    let line = (1.0 - known).max(0.0);
    let separation = &pair.separation;
    let [mean, along] = [(mean, known), (separation.r, separation.distance)]
        .map(|(v, length)| v.map(|x| x / length.max(f64::MIN_POSITIVE)));
    Some([(1.0 - line, mean), (line, along)])
}
