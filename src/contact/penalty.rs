//! Penalty between boundary particles, after Campbell, Vignjevic & Libersky (2000).
//!
//! The outermost particles of a body and their normals are found after Randles & Libersky (1996):
//! the corrected gradient of what the body fills, `b_i = B_i s_i` with `s_i = −Σ V_j ∇W_ij` and
//! `B_i⁻¹ = −Σ V_j ∇W_ij ⊗ r_ij` over the own body, points out of it and is longest on its outermost
//! layer. Boundary particles of two bodies push each other along the mean of their normals; a corner,
//! which has two, along that of the face it is pressed on, and two corners along the line between
//! them, as pinballs do (Belytschko & Neal 1991), whose laws these are.

use super::boundary::CORNER;
use super::hold::{Bearing, Resisting};
use super::{ContactView, Gap, Pair, Party, Reaction};
use crate::domain::Mirrors;
use crate::numerics::vector::{dot, square};

/// The outward normal of the receiver at `place`, as long as it counts beside others, from the images
/// of its own group; zero inside of the body.
#[must_use]
pub fn boundary(view: &ContactView, place: u32, own: &[u32]) -> [f64; 3] {
    let i = view.party(place);
    let pair = view.table.pair(i.body, i.body);
    let (mut outward, mut filled) = ([0.0; 3], 0.0);
    // B⁻¹; one on axes that the case does not have.
    let mut matrix = [[0.0; 3]; 3];
    for &other in own {
        let record = &view.motion[other as usize];
        let r: [f64; 3] = std::array::from_fn(|a| i.position[a] - record.position[a]);
        let distance = square(&r).sqrt();
        filled += record.volume * pair.kernel.value(distance);
        if distance == 0.0 {
            continue;
        }
        let pull = -record.volume * pair.kernel.slope(distance) / distance;
        for a in 0..3 {
            outward[a] += pull * r[a];
            for b in 0..3 {
                matrix[a][b] += pull * r[a] * r[b];
            }
        }
    }
    for a in view.table.kernel.dimension()..3 {
        matrix[a][a] = 1.0;
    }
    let corrected = solve(&matrix, &outward).unwrap_or(outward);
    let length = square(&corrected).sqrt();
    let known = view.table.boundary(i.body);
    if length * pair.spacing > known.outer {
        let scale = known.weight(filled) / length;
        corrected.map(|c| c * scale)
    } else {
        [0.0; 3]
    }
}

/// `A⁻¹ v` of a symmetric positive matrix; `None` where that is as good as singular, as about a
/// lone particle.
fn solve(a: &[[f64; 3]; 3], v: &[f64; 3]) -> Option<[f64; 3]> {
    let minor = |i: usize, j: usize| {
        let (k, l, m, n) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        a[k][m] * a[l][n] - a[k][n] * a[l][m]
    };
    let determinant = a[0][0] * minor(0, 0) + a[0][1] * minor(0, 1) + a[0][2] * minor(0, 2);
    (determinant > 1e-3).then(|| {
        std::array::from_fn(|i| {
            (v[0] * minor(0, i) + v[1] * minor(1, i) + v[2] * minor(2, i)) / determinant
        })
    })
}

/// Directions from `j` to `i` in which the two press on each other, with their shares, which sum to
/// one: the mean of both normals as they count, and the line between the two as far as no normal says
/// how they lie, as of two corners or of faces that look the same way. `None` unless both are of the
/// boundary.
fn directions(
    view: &ContactView,
    [i, j]: [&Party; 2],
    gap: &Gap,
    code: u8,
) -> Option<[(f64, [f64; 3]); 2]> {
    let here = view.store.boundary_normal[i.base];
    let there = Mirrors::reflect_vector(&view.store.boundary_normal[j.base], code);
    let (a, b) = (square(&here).sqrt(), square(&there).sqrt());
    if a == 0.0 || b == 0.0 {
        return None;
    }
    // As long as they count: of a corner not at all.
    let count = |length: f64| (length - CORNER).max(0.0) / ((1.0 - CORNER) * length);
    let (of_i, of_j) = (count(a), count(b));
    let normal: [f64; 3] = std::array::from_fn(|k| of_j * there[k] - of_i * here[k]);
    let known = square(&normal).sqrt();
    let line = (1.0 - known).max(0.0);
    let [normal, along] = [(normal, known), (gap.r, gap.distance)]
        .map(|(v, length)| v.map(|x| x / length.max(f64::MIN_POSITIVE)));
    Some([(1.0 - line, normal), (line, along)])
}

/// What a pair does to `i`.
#[derive(Default)]
struct Push {
    /// Force (N).
    force: [f64; 3],
    /// Its length (N).
    size: f64,
    /// Half the energy of the pair (J).
    energy: f64,
    /// Stiffness for the time step (N/m).
    stiffness: f64,
}

/// Adds the neighbours that friction and damping of `i` rest on: half of each push.
pub(super) fn bear(view: &ContactView, i: &Party, neighbours: &[u32], bearing: &mut Bearing) {
    for &other in neighbours {
        let j = view.party(other);
        let pair = view.table.pair(i.body, j.body);
        if !pair.resistance.is_any() {
            continue;
        }
        let code = view.images[other as usize].code();
        let gap = Gap::between(i, &j);
        if let Some(push) = push(view, pair, [i, &j], &gap, code) {
            let force = push.force.map(|f| 0.5 * f);
            bearing.add(pair, [i, &j], 0.5 * push.size, &force);
            for (facing, part) in bearing.facing.iter_mut().zip(force) {
                *facing += part;
            }
        }
    }
}

/// Adds what the foreign neighbours do to the receiver at `place` to `reaction`, with `FRICTION`
/// friction and damping too.
pub fn react<const FRICTION: bool>(
    view: &ContactView,
    place: u32,
    neighbours: &[u32],
    reaction: &mut Reaction,
) {
    let i = view.party(place);
    let mut resisting = FRICTION.then(|| Resisting::of(view, &i));
    for &other in neighbours {
        let j = view.party(other);
        let gap = Gap::between(&i, &j);
        let pair = view.table.pair(i.body, j.body);
        let code = view.images[other as usize].code();
        let Some(push) = push(view, pair, [&i, &j], &gap, code) else {
            reaction.book(&j, &gap, pair, [0.0; 3], 0.0);
            continue;
        };
        reaction.stiffness += push.stiffness;
        let (mut force, mut energy) = (push.force, push.energy);
        if let Some(at) = &mut resisting {
            at.pair(view, [&i, &j], other, || [0.5 * push.size; 2]);
            for a in 0..3 {
                force[a] += at.force[a];
            }
            energy += at.energy;
        }
        reaction.book(&j, &gap, pair, force, energy);
        if let Some(at) = &resisting {
            at.book_heat(j.body, reaction);
        }
    }
    if let Some(at) = resisting {
        at.finish(reaction);
    }
}

/// Over the directions n of [`directions`] with shares s: `p = Δp̄ − r·n`,
/// `w = s ⟨1 − t²/Δp̄²⟩₊²` over the offset t across n, `F₂ = w κ M V̄/Δp̄ (p/Δp̄)^{3/2}` along n; by the
/// law of pinballs their sum is no more than `F₁ = Σw m_i m_j/(m_i + m_j) ṗ/Δt` while the two approach
/// along it and nothing while they part. `None` if they do not press on each other.
fn push(view: &ContactView, pair: &Pair, [i, j]: [&Party; 2], gap: &Gap, code: u8) -> Option<Push> {
    let volume = 0.5 * (i.volume + j.volume);
    let (mut push, mut weights) = (Push::default(), 0.0);
    for (share, n) in directions(view, [i, j], gap, code)? {
        let along = dot(&gap.r, &n);
        let aside = (gap.distance * gap.distance - along * along) / (pair.spacing * pair.spacing);
        let depth = 1.0 - along / pair.spacing;
        if share == 0.0 || aside >= 1.0 || depth <= 0.0 || depth >= 2.0 {
            continue;
        }
        let weight = share * (1.0 - aside) * (1.0 - aside);
        weights += weight;
        let strength = weight * pair.penalty * volume / pair.spacing;
        let root = depth.sqrt();
        for a in 0..3 {
            push.force[a] += strength * depth * root * n[a];
        }
        push.energy += 0.2 * strength * pair.spacing * depth * depth * root;
        // Twice the slope of both, since both particles yield.
        push.stiffness += 2.0 * 1.5 * strength * root / pair.spacing;
    }
    push.size = square(&push.force).sqrt();
    if push.size == 0.0 {
        return None;
    }
    if pair.pinball {
        // It stores nothing: what it takes is lost.
        push.energy = 0.0;
        if view.dt > 0.0 {
            let (m_i, m_j) = (view.store.mass[i.base], view.store.mass[j.base]);
            let v: [f64; 3] = std::array::from_fn(|a| i.velocity[a] - j.velocity[a]);
            let rate = (-dot(&v, &push.force) / push.size).max(0.0);
            let most = weights * (m_i * m_j / (m_i + m_j)) * rate / view.dt;
            let part = (most / push.size).min(1.0);
            push.force = push.force.map(|f| part * f);
            push.size *= part;
        }
    }
    Some(push)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matrix_is_solved() {
        let a = [[2.0, 0.5, 0.1], [0.5, 1.5, -0.2], [0.1, -0.2, 1.0]];
        let x = [0.3, -1.0, 2.0];
        let v = std::array::from_fn(|i| a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2]);
        let found = solve(&a, &v).expect("a solution");
        for k in 0..3 {
            assert!((found[k] - x[k]).abs() < 1e-14);
        }
        assert!(solve(&[[0.0; 3]; 3], &v).is_none());
    }
}
