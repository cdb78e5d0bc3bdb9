//! Matter with three directions of its own: fibres along 1, layers across 3.
//!
//! The elastic strain ε in the frame of the directions has the energy of C, and the equation of state stands for the part of its
//! own modulus K in it:
//!
//! ```text
//! W = ½ ε̃ C ε̃ − ½ K g²,    ε̃ = dev ε + g I/3,    σ = ∂W/∂ε − p(ρ, e) I,    K = ρ₀ ∂p/∂ρ of the reference state
//! ```
//!
//! with `g = tr ε` in tension and `tr ε/(1 − tr ε/ε₀)` in compression, `ε₀ = .1`. So small strains follow C whatever the equation of state,
//! change of shape has a pressure and change of volume a deviator; and of strong compression the equation of state alone tells the pressure, for
//! shock data of a laminate have another modulus than C. Nothing but energy is stored: no closed path gives any. With `g = tr ε`
//! and `K = Σ_ij C_ij/9` (i, j = 1 … 3) this is the split of Anderson, Cox, Johnson & Maudlin (1994), *A constitutive
//! formulation for anisotropic materials suitable for wave propagation computer programs II*, Comput. Mech. 15, 201; for
//! composites under impact Clegg, White, Riedel & Harwick (2006), *Hypervelocity impact damage prediction in composites:
//! Part I*, Int. J. Impact Eng. 33, 190.
//!
//! Fibres and layers are lines and planes of the matter: direction 1 is carried along by the deformation, direction 3 is what is
//! across the plane of 1 and 2. The strain grows by the rate of deformation in the frame, half of it before the frame turns and
//! half after. A turn of any size leaves it as it is.
//!
//! Where the pressure is positive, the equivalent stress of the deviator is at most the crush stress, if there is one: the deviator
//! returns along its radius by a flow without change of volume. What is pulled cracks before.

use super::jaumann::conjugate;
use super::neo_hookean::increment;
use super::{Conditions, Contradiction, FAILED, LANES, Law, PointBatch};
use crate::at_least;
use numerics::vector::{cross, dot};

law! {
    /// Orthotropic elasticity with the pressure of the equation of state.
    Orthotropic {
        /// Young's modulus along direction 1 (Pa).
        e1: "Pa",
        /// Young's modulus along direction 2 (Pa).
        e2: "Pa",
        /// Young's modulus along direction 3 (Pa).
        e3: "Pa",
        /// Contraction along 2 over the stretch along 1.
        nu12: "",
        /// Contraction along 3 over the stretch along 1.
        nu13: "",
        /// Contraction along 3 over the stretch along 2.
        nu23: "",
        /// Shear modulus of 1 and 2 (Pa).
        g12: "Pa",
        /// Shear modulus of 1 and 3 (Pa).
        g13: "Pa",
        /// Shear modulus of 2 and 3 (Pa).
        g23: "Pa",
        /// Largest equivalent stress of the deviator of what is pressed (Pa); zero without a limit.
        crush_stress: "Pa",
    }
}

/// Compression at which half of the volume counts for what is elastic.
const DENSE: f64 = 0.1;

/// Elastic moduli in the frame of the directions (Pa).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness {
    /// `C_ij` of stretches.
    pub stretch: [[f64; 3]; 3],
    /// Shear moduli of the planes 12, 13, 23.
    pub shear: [f64; 3],
    /// K, that of the volume which the equation of state stands for.
    pub volume: f64,
}

impl Stiffness {
    /// None at all.
    pub const ZERO: Self = Self {
        stretch: [[0.0; 3]; 3],
        shear: [0.0; 3],
        volume: 0.0,
    };

    /// Stress `11 22 33 12 13 23` (Pa) of an elastic strain of the same components, beside the pressure of the equation of
    /// state.
    #[inline(always)]
    #[must_use]
    pub fn stress(&self, strain: &[f64; 6]) -> [f64; 6] {
        let [a, b, c, xy, xz, yz] = *strain;
        let volume = a + b + c;
        // The volume that counts, and its derivative.
        let (mut counts, mut slope) = (volume, 1.0);
        if volume < 0.0 {
            let share = 1.0 / (1.0 - volume / DENSE);
            (counts, slope) = (volume * share, share * share);
        }
        let less = (counts - volume) * (1.0 / 3.0);
        let stretch = [a + less, b + less, c + less];
        let mut stress = [
            dot(&self.stretch[0], &stretch),
            dot(&self.stretch[1], &stretch),
            dot(&self.stretch[2], &stretch),
            2.0 * self.shear[0] * xy,
            2.0 * self.shear[1] * xz,
            2.0 * self.shear[2] * yz,
        ];
        let mean = (stress[0] + stress[1] + stress[2]) * (1.0 / 3.0);
        let left = (mean - self.volume * counts) * slope - mean;
        for normal in &mut stress[..3] {
            *normal += left;
        }
        stress
    }

    /// The strain without change of volume by which an elastic strain must fall for its deviator (Pa) to be gone.
    #[inline(always)]
    fn shape(&self, compliance: &[[f64; 3]; 3], deviator: &[f64; 6]) -> [f64; 6] {
        let [a, b, c, xy, xz, yz] = *deviator;
        let (mut strain, mut pressed) = ([0.0; 3], [0.0; 3]);
        let (mut volume, mut softness) = (0.0, 0.0);
        for i in 0..3 {
            strain[i] = dot(&compliance[i], &[a, b, c]);
            pressed[i] = dot(&compliance[i], &[1.0; 3]);
            volume += strain[i];
            softness += pressed[i];
        }
        let pressure = volume / softness;
        let [g12, g13, g23] = self.shear;
        [
            strain[0] - pressure * pressed[0],
            strain[1] - pressure * pressed[1],
            strain[2] - pressure * pressed[2],
            0.5 * xy / g12,
            0.5 * xz / g13,
            0.5 * yz / g23,
        ]
    }

    /// Modulus (Pa) of the stiffest plane wave, `ρ c²`: the largest eigenvalue of the [acoustic tensor](Self::acoustic) along the directions
    /// and half way between two of them.
    #[inline(always)]
    #[must_use]
    pub fn wave_modulus(&self) -> f64 {
        let c = &self.stretch;
        let mut largest = c[0][0];
        for (plane, [i, j]) in [[0, 1], [0, 2], [1, 2]].into_iter().enumerate() {
            let g = self.shear[plane];
            let (middle, apart) = (0.25 * (c[i][i] + c[j][j]), 0.25 * (c[i][i] - c[j][j]));
            let across = 0.5 * (c[i][j] + g);
            let between = middle + 0.5 * g + (apart * apart + across * across).sqrt();
            largest = at_least(at_least(largest, c[j][j]), at_least(g, between));
        }
        largest
    }

    /// The acoustic tensor `n C n` (Pa) of a direction n as `xx yy zz xy xz yz`: its eigenvalues are `ρ c²` of plane waves.
    #[must_use]
    pub fn acoustic(&self, n: &[f64; 3]) -> [f64; 6] {
        let (c, [g12, g13, g23]) = (&self.stretch, self.shear);
        let [x, y, z] = n.map(|component| component * component);
        [
            c[0][0] * x + g12 * y + g13 * z,
            g12 * x + c[1][1] * y + g23 * z,
            g13 * x + g23 * y + c[2][2] * z,
            (c[0][1] + g12) * n[0] * n[1],
            (c[0][2] + g13) * n[0] * n[2],
            (c[1][2] + g23) * n[1] * n[2],
        ]
    }
}

impl Orthotropic {
    /// Compliances `S_ij` of stretches (1/Pa).
    #[inline(always)]
    fn compliance(&self) -> [[f64; 3]; 3] {
        let (a, b, c) = (1.0 / self.e1, 1.0 / self.e2, 1.0 / self.e3);
        let (ab, ac, bc) = (-self.nu12 * a, -self.nu13 * a, -self.nu23 * b);
        [[a, ab, ac], [ab, b, bc], [ac, bc, c]]
    }

    /// The moduli, the inverse of the compliances, beside an equation of state of a reference bulk modulus (Pa).
    #[inline(always)]
    #[must_use]
    pub fn stiffness(&self, bulk_modulus: f64) -> Stiffness {
        let s = self.compliance();
        let mut stretch = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                // Cofactors by cyclic permutation.
                let ([a, b], [c, d]) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
                stretch[i][j] = s[a][c] * s[b][d] - s[a][d] * s[b][c];
            }
        }
        let over = 1.0 / dot(&s[0], &stretch[0]);
        for row in &mut stretch {
            for modulus in row {
                *modulus *= over;
            }
        }
        Stiffness {
            stretch,
            shear: [self.g12, self.g13, self.g23],
            volume: bulk_modulus,
        }
    }
}

/// Directions 1, 2, 3 of lane k as the rows of a matrix, row-major; those of x, y, z where none are given.
#[inline(always)]
pub(super) fn frame(point: &PointBatch, k: usize) -> [f64; 9] {
    let (f, n) = (&point.fibre, &point.normal);
    let (a, c) = ([f[0][k], f[1][k], f[2][k]], [n[0][k], n[1][k], n[2][k]]);
    if a == [0.0; 3] {
        return [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    }
    let b = cross(&c, &a);
    [a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]]
}

/// The transposed matrix.
#[inline(always)]
fn transposed(a: &[f64; 9]) -> [f64; 9] {
    [a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]]
}

/// Carries the directions of lane k along with a deformation `f`, row-major, and keeps them orthonormal.
#[inline(always)]
fn carry(point: &mut PointBatch, k: usize, from: &[f64; 9], f: &[f64; 9]) {
    let rows = [[f[0], f[1], f[2]], [f[3], f[4], f[5]], [f[6], f[7], f[8]]];
    let (first, second) = ([from[0], from[1], from[2]], [from[3], from[4], from[5]]);
    let (mut a, mut b) = ([0.0; 3], [0.0; 3]);
    for i in 0..3 {
        a[i] = dot(&rows[i], &first);
        b[i] = dot(&rows[i], &second);
    }
    let mut c = cross(&a, &b);
    let (along, across) = (1.0 / dot(&a, &a).sqrt(), 1.0 / dot(&c, &c).sqrt());
    for i in 0..3 {
        a[i] *= along;
        c[i] *= across;
    }
    let off = dot(&a, &c);
    for i in 0..3 {
        point.fibre[i][k] = a[i];
        point.normal[i][k] = c[i] - off * a[i];
    }
}

/// Elastic strain of lane k in its `frame`.
#[inline(always)]
pub(super) fn held_strain(point: &PointBatch, k: usize, frame: &[f64; 9]) -> [f64; 6] {
    let e = &point.elastic_strain;
    conjugate(
        frame,
        &[e[0][k], e[1][k], e[2][k], e[3][k], e[4][k], e[5][k]],
    )
}

/// Sets that of lane k.
#[inline(always)]
pub(super) fn hold_strain(point: &mut PointBatch, k: usize, frame: &[f64; 9], strain: &[f64; 6]) {
    let strain = conjugate(&transposed(frame), strain);
    for c in 0..6 {
        point.elastic_strain[c][k] = strain[c];
    }
}

/// Share of the volume of lane k that matter has, the rest being open cracks.
#[inline(always)]
pub(crate) fn solid_share(point: &PointBatch, k: usize) -> f64 {
    let open = point.opening_1[k] + point.opening_2[k] + point.opening_3[k];
    if open > 0.0 && point.damage[k] < FAILED {
        libm::exp(-open)
    } else {
        1.0
    }
}

/// Sets the deviator of lane k to that of a stress in its `frame` (Pa).
#[inline(always)]
pub(super) fn bear(point: &mut PointBatch, k: usize, frame: &[f64; 9], stress: &[f64; 6]) {
    let mean = (stress[0] + stress[1] + stress[2]) * (1.0 / 3.0);
    let deviator = [
        stress[0] - mean,
        stress[1] - mean,
        stress[2] - mean,
        stress[3],
        stress[4],
        stress[5],
    ];
    let deviator = conjugate(&transposed(frame), &deviator);
    for c in 0..6 {
        point.deviatoric_stress[c][k] = deviator[c];
    }
}

/// Square of the equivalent stress (Pa²) of a stress.
#[inline(always)]
pub(super) fn equivalent_squared(s: &[f64; 6]) -> f64 {
    let [a, b, c] = [s[0] - s[1], s[1] - s[2], s[2] - s[0]];
    0.5 * (a * a + b * b + c * c) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])
}

impl Law for Orthotropic {
    const STATE: &'static [&'static str] = &[
        "deviatoric_stress",
        "plastic_strain",
        "fibre",
        "normal",
        "elastic_strain",
    ];
    const FOLLOWS_STATE: bool = true;

    fn contradiction(&self) -> Option<Contradiction> {
        // Positive leading minors of the compliances over their diagonals.
        let s = self.compliance();
        let r = |i: usize, j: usize| s[i][j] * s[i][j] / (s[i][i] * s[j][j]);
        let triple = s[0][1] * s[0][2] * s[1][2] / (s[0][0] * s[1][1] * s[2][2]);
        let whole = 1.0 - r(0, 1) - r(0, 2) - r(1, 2) + 2.0 * triple;
        (r(0, 1) >= 1.0 || whole <= 0.0).then_some(Contradiction {
            keys: &["nu12", "nu13", "nu23"],
            title: "no matter has these Poisson's ratios: some strain would give energy instead of taking it",
        })
    }

    /// That beside the modulus of volume of the directions, `Σ C_ij/9`.
    fn shear_modulus(&self) -> f64 {
        let stiffness = self.stiffness(0.0);
        let volume = stiffness.stretch.iter().flatten().sum::<f64>() / 9.0;
        0.75 * (stiffness.wave_modulus() - volume)
    }

    #[inline(always)]
    fn shear_modulus_beside(&self, bulk_modulus: f64) -> f64 {
        at_least(
            0.75 * (self.stiffness(bulk_modulus).wave_modulus() - bulk_modulus),
            0.0,
        )
    }

    fn yield_stress(&self) -> f64 {
        if self.crush_stress > 0.0 {
            self.crush_stress
        } else {
            f64::INFINITY
        }
    }

    #[inline(always)]
    fn soften(&self, _point: &PointBatch, now: &mut Conditions) {
        now.stiffness = self.stiffness(now.bulk_modulus);
    }

    #[inline(never)]
    fn deform(&self, point: &mut PointBatch, now: &mut Conditions) {
        let dt = now.dt;
        for k in 0..LANES {
            if dt != 0.0 {
                strain(point, k, dt);
            }
            let axes = frame(point, k);
            let strain = held_strain(point, k, &axes);
            let share = solid_share(point, k);
            let mut stress = now.stiffness.stress(&strain);
            for component in &mut stress {
                *component *= share;
            }
            if dt != 0.0 {
                bear(point, k, &axes, &stress);
            }
            point.pressure[k] -= (stress[0] + stress[1] + stress[2]) * (1.0 / 3.0);
            now.shear_modulus[k] *= share;
        }
    }

    #[inline(always)]
    fn flow(&self, point: &mut PointBatch, now: &Conditions) {
        if now.dt == 0.0 || self.crush_stress == 0.0 {
            return;
        }
        self.crush(point, now);
    }
}

impl Orthotropic {
    /// Returns strain and stress of what is pressed to the crush stress.
    #[inline(never)]
    fn crush(&self, point: &mut PointBatch, now: &Conditions) {
        for k in 0..LANES {
            if point.pressure[k] <= 0.0 {
                continue;
            }
            let axes = frame(point, k);
            let mut strain = held_strain(point, k, &axes);
            let stress = now.stiffness.stress(&strain);
            let square = equivalent_squared(&stress);
            if square <= self.crush_stress * self.crush_stress || point.damage[k] >= FAILED {
                continue;
            }
            let kept = self.crush_stress / square.sqrt();
            let mean = (stress[0] + stress[1] + stress[2]) * (1.0 / 3.0);
            let mut deviator = stress;
            for normal in &mut deviator[..3] {
                *normal -= mean;
            }
            let flow = now.stiffness.shape(&self.compliance(), &deviator);
            // The work of the stress that stays, over the crush stress.
            let mut work = 0.0;
            for c in 0..6 {
                let increment = (1.0 - kept) * flow[c];
                let twice = if c < 3 { 1.0 } else { 2.0 };
                work += twice * kept * deviator[c] * increment;
                strain[c] -= increment;
                point.deviatoric_stress[c][k] *= kept;
            }
            hold_strain(point, k, &axes, &strain);
            let left = now.stiffness.stress(&strain);
            let rest = (left[0] + left[1] + left[2]) * (1.0 / 3.0);
            point.pressure[k] += solid_share(point, k) * (mean - rest);
            point.plastic_strain[k] += work / self.crush_stress;
        }
    }
}

/// Advances strain and directions of lane k by a step (s).
#[inline(always)]
pub(super) fn strain(point: &mut PointBatch, k: usize, dt: f64) {
    if point.damage[k] >= FAILED {
        for component in &mut point.elastic_strain {
            component[k] = 0.0;
        }
    }
    let l = |c: usize| point.velocity_gradient[c][k];
    let half = 0.5 * dt;
    let rate = [
        half * l(0),
        half * l(4),
        half * l(8),
        0.5 * half * (l(1) + l(3)),
        0.5 * half * (l(2) + l(6)),
        0.5 * half * (l(5) + l(7)),
    ];
    let before = frame(point, k);
    let mut strain = held_strain(point, k, &before);
    let mut gradient = [0.0; 9];
    for (c, component) in gradient.iter_mut().enumerate() {
        *component = point.velocity_gradient[c][k];
    }
    carry(point, k, &before, &increment(&gradient, half));
    if point.damage[k] >= FAILED {
        return;
    }
    let after = frame(point, k);
    let (first, second) = (conjugate(&before, &rate), conjugate(&after, &rate));
    for c in 0..6 {
        strain[c] += first[c] + second[c];
    }
    hold_strain(point, k, &after, &strain);
}
