//! Penalty between boundary particles, after Campbell, Vignjevic & Libersky (2000).
//!
//! The outermost particles of a body and their normals are found after Randles & Libersky (1996):
//! the corrected gradient of what the body fills, `b_i = B_i s_i` with `s_i = −Σ V_j ∇W_ij` and
//! `B_i⁻¹ = −Σ V_j ∇W_ij ⊗ r_ij` over the own body, points out of it and is longest on its outermost
//! layer. Boundary particles of two bodies push each other along the mean of their normals; at a
//! corner, which has two normals, along that of the face it is pressed on. The laws are those of
//! pinballs (Belytschko & Neal 1991).

use super::{ContactView, Gap, Pair, Party, Reaction};
use crate::domain::Mirrors;
use crate::sph::kernel::Kernel;

/// A boundary vector longer than this times that of a flat face is one of a corner; that of a right
/// angle is √2 as long.
const CORNER: f64 = 1.2;

/// Lengths of the boundary vector `|b| Δp` that tell particles of a body apart.
#[derive(Debug, Clone, Copy, Default)]
pub struct Boundary {
    /// Above it a particle is of the outermost layer.
    pub outer: f64,
    /// Above it, of a corner.
    pub corner: f64,
}

impl Boundary {
    /// For a cubic lattice of unit spacing with a flat face and the smoothing length `h`: half-way
    /// between the first layer and the second.
    #[must_use]
    pub fn of_lattice(kernel: &Kernel, h: f64) -> Self {
        let layer = |depth: i32| {
            let (mut outward, mut slope) = (0.0, 0.0);
            let across = |a: usize| {
                if a < kernel.dimension() - 1 {
                    -6..=6
                } else {
                    0..=0
                }
            };
            for x in across(0) {
                for y in across(1) {
                    for z in -depth..=6 {
                        let square = f64::from(x * x + y * y + z * z);
                        if square > 0.0 {
                            let r = square.sqrt();
                            let pull = -kernel.slope(r, h) / r;
                            outward += pull * f64::from(z);
                            slope += pull * f64::from(z * z);
                        }
                    }
                }
            }
            outward / slope
        };
        let first = layer(0);
        Self {
            outer: 0.5 * (first + layer(1)),
            corner: CORNER * first,
        }
    }
}

/// The boundary vector times spacing of the receiver at `place`, `|b| Δp` long, from the images of
/// its own group; zero inside of the body.
#[must_use]
pub fn boundary(view: &ContactView, place: u32, own: &[u32]) -> [f64; 3] {
    let i = view.party(place);
    let pair = view.table.pair(i.body, i.body);
    let kernel = &view.table.kernel;
    let mut outward = [0.0; 3];
    // B⁻¹; one on axes that the case does not have.
    let mut matrix = [[0.0; 3]; 3];
    for &other in own {
        let record = &view.motion[other as usize];
        let r: [f64; 3] = std::array::from_fn(|a| i.position[a] - record.position[a]);
        let square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        if square == 0.0 {
            continue;
        }
        let distance = square.sqrt();
        let pull = -record.volume * kernel.slope(distance, pair.h) / distance;
        for a in 0..3 {
            outward[a] += pull * r[a];
            for b in 0..3 {
                matrix[a][b] += pull * r[a] * r[b];
            }
        }
    }
    for a in kernel.dimension()..3 {
        matrix[a][a] = 1.0;
    }
    let corrected = solve(&matrix, &outward).unwrap_or(outward);
    let vector = corrected.map(|c| c * pair.spacing);
    let limit = view.table.boundary(i.body).outer;
    if length2(&vector) > limit * limit {
        vector
    } else {
        [0.0; 3]
    }
}

fn length2(v: &[f64; 3]) -> f64 {
    v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
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

/// The direction from `j` to `i` that both normals give, if both are of the boundary.
fn direction(view: &ContactView, i: &Party, j: &Party, code: u8) -> Option<[f64; 3]> {
    let here = view.store.boundary_normal[i.base];
    let there = Mirrors::reflect_vector(&view.store.boundary_normal[j.base], code);
    let (a, b) = (length2(&here).sqrt(), length2(&there).sqrt());
    if a == 0.0 || b == 0.0 {
        return None;
    }
    let corner = |length: f64, body: usize| length > view.table.boundary(body).corner;
    // Of a corner and a face the face's normal holds.
    let (weight_i, weight_j) = match (corner(a, i.body), corner(b, j.body)) {
        (true, false) => (0.0, 1.0),
        (false, true) => (1.0, 0.0),
        _ => (1.0, 1.0),
    };
    let sum: [f64; 3] = std::array::from_fn(|k| weight_j * there[k] / b - weight_i * here[k] / a);
    let length = length2(&sum).sqrt();
    // Faces that look the same way do not press on each other.
    (length > 0.5).then(|| sum.map(|x| x / length))
}

/// Adds what the foreign neighbours do to the receiver at `place` to `reaction`.
pub fn react(view: &ContactView, place: u32, neighbours: &[u32], reaction: &mut Reaction) {
    let i = view.party(place);
    for &other in neighbours {
        let j = view.party(other);
        let gap = Gap::between(&i, &j);
        let pair = view.table.pair(i.body, j.body);
        let code = view.images[other as usize].code();
        let push = direction(view, &i, &j, code)
            .map(|normal| (normal, push(pair, &i, &j, &gap, &normal, view)));
        let Some((normal, [force, energy, stiffness])) = push else {
            reaction.book(&j, &gap, pair, [0.0; 3], 0.0);
            continue;
        };
        reaction.stiffness += stiffness;
        reaction.book(&j, &gap, pair, normal.map(|n| force * n), energy);
    }
}

/// Force along `normal` (N), half the energy of the pair (J) and stiffness for the time step (N/m):
/// `p = Δp̄ − r·n`, `w = ⟨1 − t²/Δp̄²⟩₊²` over the offset t along the face,
/// `F₂ = w κ M V̄/Δp̄ (p/Δp̄)^{3/2}`, and by the law of pinballs no more than
/// `F₁ = w m_i m_j/(m_i + m_j) ṗ/Δt` while they approach and nothing while they part.
fn push(
    pair: &Pair,
    i: &Party,
    j: &Party,
    gap: &Gap,
    normal: &[f64; 3],
    view: &ContactView,
) -> [f64; 3] {
    let dot = |v: &[f64; 3]| v[0] * normal[0] + v[1] * normal[1] + v[2] * normal[2];
    let along = dot(&gap.r);
    let aside = (gap.distance * gap.distance - along * along) / (pair.spacing * pair.spacing);
    let depth = 1.0 - along / pair.spacing;
    if aside >= 1.0 || depth <= 0.0 || depth >= 2.0 {
        return [0.0; 3];
    }
    let weight = (1.0 - aside) * (1.0 - aside);
    let volume = 0.5 * (i.volume + j.volume);
    let strength = weight * pair.penalty * volume / pair.spacing;
    let root = depth.sqrt();
    let mut force = strength * depth * root;
    let mut energy = 0.2 * strength * pair.spacing * depth * depth * root;
    // Twice the slope of both, since both particles yield.
    let stiffness = 2.0 * 1.5 * strength * root / pair.spacing;
    if pair.pinball {
        // It stores nothing: what it takes is lost.
        energy = 0.0;
    }
    if pair.pinball && view.dt > 0.0 {
        let (m_i, m_j) = (view.store.mass[i.base], view.store.mass[j.base]);
        let v: [f64; 3] = std::array::from_fn(|a| i.velocity[a] - j.velocity[a]);
        let rate = (-dot(&v)).max(0.0);
        force = force.min(weight * (m_i * m_j / (m_i + m_j)) * rate / view.dt);
    }
    [force, energy, stiffness]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A face in one dimension and the rows of a flat one in three have lengths that are well
    /// apart, and a right angle is longer than a face.
    #[test]
    fn layers_are_told_apart() {
        for dimension in 1..=3 {
            for h in [1.0, 1.2, 1.3, 1.5] {
                let kernel = Kernel::new(dimension);
                let known = Boundary::of_lattice(&kernel, h);
                let first = known.corner / CORNER;
                let second = 2.0 * known.outer - first;
                println!("{dimension}-D h {h}: {first:.3} {second:.3}");
                assert!(second < 0.7 * first && second >= 0.0);
            }
        }
    }

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
