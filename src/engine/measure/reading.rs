//! Readings of a particle: a field of the table, or a quantity that follows from some.

use super::near::{LaneSum, Near};
use material::LANES;
use model::Case;
use numerics::lanes::Lanes as Vector;
use particles::{
    FIELDS, FieldInfo, FieldKind, Mirror, MirrorMask, Mirrors, ParticleStore, STRESS, TEMPERATURE,
    VON_MISES_STRESS,
};

/// Something that particles hold, in numbers.
#[derive(Debug, Clone, Copy)]
pub enum Reading {
    /// A field of the table.
    Field(&'static FieldInfo),
    /// `s − p I`, tension positive.
    Stress,
    /// `√(3/2 s:s)`.
    VonMises,
    /// Temperature; not a number without thermal constants.
    Temperature,
}

/// Most numbers of a reading.
pub const MOST: usize = 9;

const VECTOR: [&str; 3] = ["_x", "_y", "_z"];
const SYMMETRIC: [&str; 6] = ["_xx", "_yy", "_zz", "_xy", "_xz", "_yz"];
const TENSOR: [&str; MOST] = [
    "_xx", "_xy", "_xz", "_yx", "_yy", "_yz", "_zx", "_zy", "_zz",
];

impl Reading {
    /// The reading of a name that a gauge may state.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            STRESS => Some(Self::Stress),
            VON_MISES_STRESS => Some(Self::VonMises),
            TEMPERATURE => Some(Self::Temperature),
            _ => FIELDS.iter().find(|f| f.name == name).map(Self::Field),
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Field(field) => field.name,
            Self::Stress => STRESS,
            Self::VonMises => VON_MISES_STRESS,
            Self::Temperature => TEMPERATURE,
        }
    }

    /// Its SI unit; empty for none.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Field(field) => field.unit,
            Self::Stress | Self::VonMises => "Pa",
            Self::Temperature => "K",
        }
    }

    /// Endings that the names of its numbers add to its own.
    #[must_use]
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Field(field) => match field.kind {
                FieldKind::Vector => &VECTOR,
                FieldKind::Symmetric => &SYMMETRIC,
                FieldKind::Tensor => &TENSOR,
                _ => &[""],
            },
            Self::Stress => &SYMMETRIC,
            _ => &[""],
        }
    }

    /// The numbers of owned particle `i` as its image of a mirror mask has them, at the front.
    #[must_use]
    pub fn read(
        self,
        case: &Case,
        particles: &ParticleStore,
        i: usize,
        mirror_mask: MirrorMask,
    ) -> [f64; MOST] {
        let mut all = [0.0; MOST];
        match self {
            Self::Field(field) => {
                let size = field.kind.components();
                // What a case does not hold is zero.
                let values: &[f64] = bytemuck::cast_slice(particles.bytes(field.id));
                if let Some(own) = values.get(i * size..(i + 1) * size) {
                    all[..size].copy_from_slice(own);
                }
                reflect(field.mirror, &mut all, mirror_mask);
            }
            Self::Stress => all[..6].copy_from_slice(&stress(particles, i, mirror_mask)),
            Self::VonMises => all[0] = von_mises(&particles.deviatoric_stress[i]),
            Self::Temperature => all[0] = temperature(case, particles, i).unwrap_or(f64::NAN),
        }
        all
    }
}

impl Reading {
    /// Sums of the numbers of some images, each times its weight.
    #[inline(always)]
    pub fn add_up<V: Vector>(
        self,
        case: &Case,
        particles: &ParticleStore,
        near: &Near,
        sums: &mut [f64],
    ) {
        match (self, sums) {
            (Self::Field(field), [sum]) => {
                let values: &[f64] = bytemuck::cast_slice(particles.bytes(field.id));
                // What a case does not hold is zero.
                if !values.is_empty() {
                    [*sum] = near.sums::<V, 1>(|i| [values[i]]);
                }
            }
            (Self::Field(field), [x, y, z]) => {
                let values: &[f64] = bytemuck::cast_slice(particles.bytes(field.id));
                let values = values.as_chunks::<3>().0;
                if values.is_empty() {
                    return;
                }
                [*x, *y, *z] = if near.any_behind() {
                    sums_of_images(field.mirror, values, near)
                } else {
                    near.sums::<V, 3>(|i| values[i])
                };
            }
            (_, sums) => {
                let mut lanes = [LaneSum::default(); MOST];
                for (k, one) in near.iter().enumerate() {
                    let values = self.read(case, particles, one.i, one.mirror_mask);
                    for (lanes, value) in lanes.iter_mut().zip(values) {
                        lanes.add(k, one.weight * value);
                    }
                }
                for (sum, lanes) in sums.iter_mut().zip(&lanes) {
                    *sum = lanes.total();
                }
            }
        }
    }
}

/// Sums of vectors of images, some of which stand behind symmetry planes, each times its weight.
fn sums_of_images(rule: Mirror, values: &[[f64; 3]], near: &Near) -> [f64; 3] {
    let mut lanes = [LaneSum::default(); 3];
    for (k, one) in near.iter().enumerate() {
        let own = &values[one.i];
        let image = match rule {
            Mirror::Vector => Mirrors::reflect_vector(own, one.mirror_mask),
            _ => *own,
        };
        for (lanes, value) in lanes.iter_mut().zip(image) {
            lanes.add(k, one.weight * value);
        }
    }
    lanes.map(|lanes| lanes.total())
}

/// The image of a field's numbers.
fn reflect(rule: Mirror, all: &mut [f64; MOST], mirror_mask: MirrorMask) {
    match rule {
        Mirror::Same | Mirror::Place => {}
        Mirror::Vector => {
            let vector = Mirrors::reflect_vector(&[all[0], all[1], all[2]], mirror_mask);
            all[..3].copy_from_slice(&vector);
        }
        Mirror::Symmetric => {
            let tensor = std::array::from_fn(|c| all[c]);
            all[..6].copy_from_slice(&Mirrors::reflect_symmetric(&tensor, mirror_mask));
        }
        Mirror::Tensor => *all = Mirrors::reflect_tensor(all, mirror_mask),
    }
}

/// The stress (Pa, tension positive) `s − p I` of an owned particle's image.
#[must_use]
pub fn stress(particles: &ParticleStore, i: usize, mirror_mask: MirrorMask) -> [f64; 6] {
    let mut stress = Mirrors::reflect_symmetric(&particles.deviatoric_stress[i], mirror_mask);
    for normal in &mut stress[..3] {
        *normal -= particles.pressure[i];
    }
    stress
}

/// The part of a stress (xx yy zz xy xz yz) that acts along a unit normal, `n·σ·n`.
#[must_use]
pub fn along(stress: &[f64; 6], n: &[f64; 3]) -> f64 {
    let [xx, yy, zz, xy, xz, yz] = *stress;
    let normal = xx * n[0] * n[0] + yy * n[1] * n[1] + zz * n[2] * n[2];
    let shear = xy * n[0] * n[1] + xz * n[0] * n[2] + yz * n[1] * n[2];
    normal + 2.0 * shear
}

/// `√(3/2 s:s)` (Pa) of a deviatoric stress xx, yy, zz, xy, xz, yz (Pa).
fn von_mises(s: &[f64; 6]) -> f64 {
    let normal = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
    let shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    (1.5 * (normal + 2.0 * shear)).sqrt()
}

/// Temperature (K) of an owned particle, if its material has thermal constants.
#[must_use]
pub fn temperature(case: &Case, particles: &ParticleStore, i: usize) -> Option<f64> {
    let material = &case.materials[case.bodies[particles.body[i] as usize].material];
    particles.temperature(material, i)
}

/// Temperatures (K) of the owned particles from `first` on; minus infinity where a material has no
/// thermal constants.
pub fn temperatures(case: &Case, particles: &ParticleStore, first: usize, all: &mut [f64]) {
    let material = |i: usize| case.bodies[particles.body[i] as usize].material;
    // Eight that rest are as the eight before them.
    let mut last = None;
    for (eight, all) in all.chunks_mut(LANES).enumerate() {
        let first = first + eight * LANES;
        let end = first + all.len();
        if all.len() < LANES || (first..end).any(|i| material(i) != material(first)) {
            for (k, one) in all.iter_mut().enumerate() {
                *one = temperature(case, particles, first + k).unwrap_or(f64::NEG_INFINITY);
            }
            continue;
        }
        let lanes =
            |field: &[f64]| std::array::from_fn(|k| field.get(first + k).map_or(0.0, |x| *x));
        let state = [
            lanes(&particles.density),
            lanes(&particles.specific_energy),
            lanes(&particles.plastic_energy),
            lanes(&particles.damage),
            lanes(&particles.distension),
        ];
        let temperatures = match last {
            Some((known, its, temperatures)) if known == material(first) && its == state => {
                temperatures
            }
            _ => {
                let material = &case.materials[material(first)];
                let [density, energy, work, damage, distension] = &state;
                let energy = material.thermal_energies(energy, work);
                let temperatures = material.temperatures([density, &energy, damage, distension]);
                temperatures.unwrap_or([f64::NEG_INFINITY; LANES])
            }
        };
        all.copy_from_slice(&temperatures);
        last = Some((material(first), state, temperatures));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use particles::gauge_names;

    #[test]
    fn everything_that_a_gauge_may_state_can_be_read() {
        for name in gauge_names() {
            let reading = Reading::named(name).unwrap();
            assert_eq!(reading.name(), name);
            assert!(reading.endings().len() <= MOST);
        }
    }

    #[test]
    fn stress_along_a_normal_is_that_of_its_plane() {
        let stress = [1.0, 2.0, 4.0, 0.5, -0.25, 3.0];
        assert_eq!(along(&stress, &[0.0, 0.0, 1.0]), 4.0);
        let n = [0.6, 0.0, 0.8];
        let expected = 0.36 + 4.0 * 0.64 - 2.0 * 0.25 * 0.48;
        assert!((along(&stress, &n) - expected).abs() < 1e-15);
    }
}
