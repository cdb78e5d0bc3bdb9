//! A fragment: what its sums say of it (theory page "Fragments").

use super::sums::Moments;
use comm::{Record, read_pod};
use numerics::principal::principal;
use particles::Mirrors;

/// A fragment of the whole model: one that reaches across symmetry planes has its images' mass, and
/// stands for as many equal ones as planes that it does not reach have images of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fragment {
    /// Smallest id of its particles.
    pub label: u64,
    /// Equal fragments of the whole model: this one and its images, none of which it reaches.
    pub copies: u64,
    /// Particles.
    pub particles: u64,
    /// Mass (kg; by length or area in models of fewer dimensions).
    pub mass: f64,
    /// Centre of mass (m).
    pub centre: [f64; 3],
    /// Velocity of the centre of mass (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s): that of a rigid body of its angular momentum and moments of
    /// inertia about the centre of mass.
    pub spin: [f64; 3],
    /// Principal diameters (m), the largest first: of the ellipsoid of even density with its second
    /// moments; zero along missing dimensions.
    pub sizes: [f64; 3],
    /// Mean temperature by mass (K); NaN where nothing has one.
    pub temperature: f64,
    /// Mean equivalent plastic strain by mass.
    pub plastic_strain: f64,
    /// Mass by body.
    pub mass_of: Vec<f64>,
}

/// Moments of inertia over the largest below which there is no turning about an axis.
const LEAST: f64 = 1e-9;

impl Fragment {
    /// Of the `moments` over those of its particles that stand on this side of the planes that it
    /// reaches across, a set of bits.
    pub(super) fn new(
        (label, count): (u64, u64),
        planes: u32,
        moments: &Moments,
        (mirrors, dimension): (&Mirrors, usize),
    ) -> Self {
        let reaches = |a: usize| planes >> a & 1 == 1;
        let all = mirrors.masks().count();
        let images = 1_u64 << planes.count_ones();
        let m = moments.mass;
        let mut centre = moments.position.map(|x| x / m);
        let mut velocity = moments.momentum.map(|p| p / m);
        let mut second = [[0.0; 3]; 3];
        for a in 0..3 {
            for b in 0..3 {
                second[a][b] = moments.second[a][b] / m - centre[a] * centre[b];
            }
        }
        let mut momentum = [0, 1, 2].map(|a: usize| {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            moments.spin[a] / m - (centre[b] * velocity[c] - centre[c] * velocity[b])
        });
        // With their images: what is odd in a coordinate vanishes.
        for a in (0..3).filter(|&a| reaches(a)) {
            let plane = mirrors.plane(a).unwrap_or_default();
            let off = centre[a] - plane;
            for b in 0..3 {
                if b == a {
                    second[a][a] += off * off;
                } else {
                    second[a][b] = 0.0;
                    second[b][a] = 0.0;
                    momentum[b] = 0.0;
                }
            }
            (centre[a], velocity[a]) = (plane, 0.0);
        }
        #[expect(clippy::cast_precision_loss, reason = "at most eight")]
        let fold = images as f64;
        Self {
            label,
            copies: (all as u64) / images,
            particles: count * images,
            mass: m * fold,
            centre,
            velocity,
            spin: spin(&second, &momentum),
            sizes: sizes(&second, moments.size / m, dimension),
            temperature: moments.heat[0] / moments.heat[1],
            plastic_strain: moments.strain / m,
            mass_of: moments.by_body.iter().map(|m| m * fold).collect(),
        }
    }

    /// Diameter (m) of a sphere, in two dimensions of a circle, of the volume of the ellipsoid.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        let [a, b, c] = self.sizes;
        if c > 0.0 {
            libm::cbrt(a * b * c)
        } else if b > 0.0 {
            (a * b).sqrt()
        } else {
            a
        }
    }
}

impl Record for Fragment {
    fn key(&self) -> u64 {
        self.label
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        let counts = [
            self.label,
            self.copies,
            self.particles,
            self.mass_of.len() as u64,
        ];
        bytes.extend_from_slice(bytemuck::cast_slice(&counts));
        bytes.extend_from_slice(bytemuck::bytes_of(&self.mass));
        for vector in [self.centre, self.velocity, self.spin, self.sizes] {
            bytes.extend_from_slice(bytemuck::cast_slice(&vector));
        }
        bytes.extend_from_slice(bytemuck::cast_slice(&[
            self.temperature,
            self.plastic_strain,
        ]));
        bytes.extend_from_slice(bytemuck::cast_slice(&self.mass_of));
    }

    fn read(bytes: &mut &[u8]) -> Self {
        let [label, copies, particles, bodies]: [u64; 4] = read_pod(bytes);
        Self {
            label,
            copies,
            particles,
            mass: read_pod(bytes),
            centre: read_pod(bytes),
            velocity: read_pod(bytes),
            spin: read_pod(bytes),
            sizes: read_pod(bytes),
            temperature: read_pod(bytes),
            plastic_strain: read_pod(bytes),
            mass_of: (0..bodies).map(|_| read_pod(bytes)).collect(),
        }
    }
}

/// Six components xx, yy, zz, xy, xz, yz.
fn symmetric(t: &[[f64; 3]; 3]) -> [f64; 6] {
    [t[0][0], t[1][1], t[2][2], t[0][1], t[0][2], t[1][2]]
}

/// `I⁻¹ L` of the moments of inertia `I = tr(G) 1 − G` and an angular momentum L, both over the
/// mass; about axes of no inertia zero.
fn spin(second: &[[f64; 3]; 3], momentum: &[f64; 3]) -> [f64; 3] {
    let trace = second[0][0] + second[1][1] + second[2][2];
    let mut inertia = second.map(|row| row.map(|x| -x));
    for (a, row) in inertia.iter_mut().enumerate() {
        row[a] += trace;
    }
    let (values, axes) = principal(&symmetric(&inertia));
    let largest = values.into_iter().fold(0.0, f64::max);
    let mut spin = [0.0; 3];
    for k in (0..3).filter(|&k| values[k] > LEAST * largest) {
        let along = (0..3).fold(0.0, |sum, a| sum + axes[a][k] * momentum[a]);
        for a in 0..3 {
            spin[a] += along / values[k] * axes[a][k];
        }
    }
    spin
}

/// `√(4 (d + 2) λ)` of the eigenvalues λ of the second moments, with those of the particles' own
/// cubes, `s²/12` along each axis, given the mean of `s²` (m²).
fn sizes(second: &[[f64; 3]; 3], own: f64, dimension: usize) -> [f64; 3] {
    let mut second = *second;
    for (a, row) in second.iter_mut().enumerate().take(dimension) {
        row[a] += own / 12.0;
    }
    let (mut values, _) = principal(&symmetric(&second));
    values.sort_by(|a, b| b.total_cmp(a));
    #[expect(clippy::cast_precision_loss, reason = "at most three")]
    let factor = 4.0 * (dimension as f64 + 2.0);
    values.map(|value| (factor * value.max(0.0)).sqrt())
}
