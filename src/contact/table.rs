//! Parameters of every pair of bodies, computed once at set-up.

use super::boundary::Boundary;
use crate::model::{
    Body, Case, ContactDirection, ContactMode, PenaltyLaw, PotentialRange, Resistance,
};
use crate::neighbours::{ContactClass, ForeignTable, Groups};
use crate::numerics::kernel::{FixedKernel, Kernel, SUPPORT};
use crate::populate;

/// Reference constants of an ordered pair of bodies (receiver, other).
#[derive(Debug, Clone, Copy)]
pub struct Pair {
    /// Mean smoothing length `h_ij` (m).
    pub h: f64,
    /// The kernel of that length.
    pub kernel: FixedKernel,
    /// Mean particle spacing (m).
    pub spacing: f64,
    /// One over it (1/m).
    pub inverse_spacing: f64,
    /// `overlap`: κ times the smaller p-wave modulus (Pa).
    pub modulus: f64,
    /// `overlap`: touching value C* of the receiver's body on the other.
    pub touching: f64,
    /// `overlap`: `κ_c` times the scale `max(M', .85 ρ' v²)` of the core (Pa).
    pub core_modulus: f64,
    /// `overlap`: radius of the core (m).
    pub core_radius: f64,
    /// Whether forces act along the normals of the surfaces.
    pub along_normal: bool,
    /// `overlap`, `penalty`: friction and damping.
    pub resistance: PairResistance,
    /// `potential`: K (Pa/m^d).
    pub potential: f64,
    /// `potential`: exponent n.
    pub exponent: i32,
    /// `potential`: W/W(Δp̄) at which the force sets in, 1 where the range is the mean spacing and 0
    /// where it is the support.
    pub floor: f64,
    /// `potential`: 1/W(Δp̄) (m^d).
    pub inverse_kernel: f64,
    /// `penalty`: κ times the smaller p-wave modulus (Pa).
    pub penalty: f64,
    /// `penalty`: whether the force is no more than what stops the approach in one step.
    pub pinball: bool,
}

/// Friction and damping of an ordered pair of bodies.
#[derive(Debug, Clone, Copy, Default)]
pub struct PairResistance {
    /// Coefficient of friction of faces that stick.
    pub static_friction: f64,
    /// Coefficient of friction of faces that slide.
    pub kinetic_friction: f64,
    /// Stiffness of the spring that sticks over volume, `¼ M/Δp²` (Pa/m²).
    pub stick: f64,
    /// Damping over volume, `ζ √(M ρ₀)/Δp` (Pa s/m²).
    pub dashpot: f64,
    /// Share of heat that goes to the receiver: ½, or all where the other body is rigid.
    pub heat_share: f64,
}

impl PairResistance {
    /// Whether there is any.
    #[inline]
    #[must_use]
    pub fn is_any(&self) -> bool {
        self.static_friction > 0.0 || self.dashpot > 0.0
    }

    /// Of bodies that resist as `input` says. The softer body gives modulus and density.
    fn new(case: &Case, bodies: [&Body; 2], spacing: f64, input: &Resistance) -> Self {
        let facts = bodies.map(|body| {
            let modulus = case.materials[body.material].p_wave_modulus();
            (modulus, case.initial_density(body))
        });
        let softer = usize::from(facts[1].0 < facts[0].0);
        let (modulus, density) = facts[softer];
        Self {
            static_friction: input.static_friction,
            kinetic_friction: input.kinetic_friction,
            stick: 0.25 * modulus / (spacing * spacing),
            dashpot: input.damping * (modulus * density).sqrt() / spacing,
            heat_share: match bodies.map(|body| body.rigid.is_some()) {
                [false, false] => 0.5,
                [false, true] => 1.0,
                [true, _] => 0.0,
            },
        }
    }
}

/// All pairs of bodies.
#[derive(Debug, Clone)]
pub struct ContactTable {
    /// The kernel that contact weights with.
    pub kernel: Kernel,
    /// Groups of bodies, which see each other in the SPH sums and have no other contact.
    pub groups: Groups,
    /// Which algorithm handles a pair, and its range.
    pub foreign: ForeignTable,
    pairs: Vec<Pair>,
    inverse_densities: Vec<f64>,
    boundaries: Vec<Boundary>,
    has_surfaces: bool,
}

impl ContactTable {
    /// Table of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let kernel = Kernel::new(case.dimension);
        let n = case.bodies.len();
        let groups = Groups::new(case);
        let group_count = groups.count();
        let mut foreign = ForeignTable {
            bodies: n,
            class: vec![ContactClass::None; n * n],
            reach2: vec![0.0; n * n],
            group_range: vec![0.0; group_count * group_count],
        };
        let mut pairs = Vec::with_capacity(n * n);
        for a in 0..n {
            for b in 0..n {
                let (class, pair) = make_pair(case, &kernel, a, b);
                pairs.push(pair);
                let range = SUPPORT * pair.h;
                if a == b && class != ContactClass::None {
                    // Found among the own neighbours, not as of another group.
                    foreign.class[a * n + a] = class;
                    foreign.reach2[a * n + a] = range * range;
                }
                if groups.of_body[a] == groups.of_body[b] || class == ContactClass::None {
                    continue;
                }
                foreign.class[a * n + b] = class;
                foreign.reach2[a * n + b] = range * range;
                let slot =
                    &mut foreign.group_range[groups.of_body[a] * group_count + groups.of_body[b]];
                *slot = slot.max(range);
            }
        }
        let inverse_densities = case
            .bodies
            .iter()
            .map(|body| 1.0 / case.initial_density(body))
            .collect();
        let boundaries = case.bodies.iter().map(|body| {
            Boundary::of_lattice(&kernel, body.smoothing_length / body.lattice.spacing)
        });
        Self {
            boundaries: boundaries.collect(),
            kernel,
            groups,
            foreign,
            pairs,
            inverse_densities,
            has_surfaces: !case.loads.surfaces.is_empty(),
        }
    }

    /// Parameters of a receiver of body `a` and a neighbour of body `b`.
    #[inline]
    #[must_use]
    pub fn pair(&self, a: usize, b: usize) -> &Pair {
        &self.pairs[a * self.foreign.bodies + b]
    }

    /// 1/ρ of a body at the start (m³/kg).
    #[inline]
    #[must_use]
    pub fn inverse_density(&self, body: usize) -> f64 {
        self.inverse_densities[body]
    }

    /// What tells boundary particles of a body.
    #[inline]
    #[must_use]
    pub fn boundary(&self, body: usize) -> &Boundary {
        &self.boundaries[body]
    }

    /// Whether there is contact beyond the SPH sums: of pairs of bodies, or with rigid surfaces.
    #[must_use]
    pub fn is_active(&self) -> bool {
        self.has_surfaces || self.has_pairs()
    }

    /// Whether any pair of bodies has contact beyond the SPH sums.
    #[must_use]
    pub fn has_pairs(&self) -> bool {
        self.foreign.class.iter().any(|&c| c != ContactClass::None)
    }

    /// Whether any pair of bodies has overlap contact, which alone measures foreign fractions.
    #[must_use]
    pub fn has_overlap(&self) -> bool {
        self.foreign.class.contains(&ContactClass::Overlap)
    }

    /// Whether any pair of bodies has friction or damping.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        let mut pairs = self.pairs.iter();
        pairs.any(|pair| pair.resistance.is_any())
    }

    /// Whether any pair of bodies has penalty contact, which alone looks for boundaries.
    #[must_use]
    pub fn has_penalty(&self) -> bool {
        self.foreign.class.contains(&ContactClass::Penalty)
    }

    /// The unordered pairs of bodies with contact beyond the SPH sums; a body with itself where its
    /// parts have contact.
    #[must_use]
    pub fn active_pairs(&self) -> Vec<[usize; 2]> {
        let n = self.foreign.bodies;
        (0..n)
            .flat_map(|a| (a..n).map(move |b| [a, b]))
            .filter(|&[a, b]| self.foreign.class[a * n + b] != ContactClass::None)
            .collect()
    }
}

fn make_pair(case: &Case, kernel: &Kernel, a: usize, b: usize) -> (ContactClass, Pair) {
    let (body_a, body_b) = (&case.bodies[a], &case.bodies[b]);
    let modulus = |body: &Body| case.materials[body.material].p_wave_modulus();
    let smaller = modulus(body_a).min(modulus(body_b));
    let spacing = 0.5 * (body_a.lattice.spacing + body_b.lattice.spacing);
    let h = 0.5 * (body_a.smoothing_length + body_b.smoothing_length);
    let mut pair = Pair {
        h,
        kernel: kernel.of_length(h),
        spacing,
        inverse_spacing: 1.0 / spacing,
        modulus: 0.0,
        touching: 0.0,
        core_modulus: 0.0,
        core_radius: 0.0,
        along_normal: false,
        resistance: PairResistance::default(),
        potential: 0.0,
        exponent: 1,
        floor: 0.0,
        inverse_kernel: 0.0,
        penalty: 0.0,
        pinball: false,
    };
    if body_a.rigid.is_some() && body_b.rigid.is_some() {
        return (ContactClass::None, pair);
    }
    let own = case
        .self_contact
        .map(|own| ContactMode::Overlap(own.overlap));
    let mode = if a == b {
        own.as_ref().unwrap_or(&ContactMode::None)
    } else {
        case.contact_between(a, b)
    };
    match mode {
        ContactMode::None | ContactMode::Kernel => (ContactClass::None, pair),
        ContactMode::Potential(potential) => {
            pair.potential = potential.stiffness * smaller / kernel.power(spacing);
            pair.along_normal = potential.direction == ContactDirection::Normal;
            pair.exponent = i32::try_from(potential.exponent).unwrap_or(i32::MAX);
            pair.inverse_kernel = 1.0 / pair.kernel.value(spacing);
            pair.floor = match potential.range {
                PotentialRange::Support => 0.0,
                PotentialRange::Spacing => 1.0,
            };
            (ContactClass::Potential, pair)
        }
        ContactMode::Penalty(penalty) => {
            pair.penalty = penalty.stiffness * smaller;
            pair.pinball = penalty.law == PenaltyLaw::Pinball;
            pair.resistance =
                PairResistance::new(case, [body_a, body_b], spacing, &penalty.resistance);
            (ContactClass::Penalty, pair)
        }
        ContactMode::Overlap(overlap) => {
            pair.modulus = overlap.stiffness * smaller;
            pair.touching = populate::touching_value(body_a, body_b, case.dimension);
            pair.core_modulus = overlap.core_stiffness * core_scale(case, a, b);
            pair.core_radius = overlap.core_radius * spacing;
            pair.along_normal = overlap.direction == ContactDirection::Normal;
            pair.resistance =
                PairResistance::new(case, [body_a, body_b], spacing, &overlap.resistance);
            (ContactClass::Overlap, pair)
        }
    }
}

/// What the core of two bodies is as stiff as (Pa): `max(M, .85 ρ v²)` with v (m/s) the largest speed
/// against each other that the case states. M and ρ are harmonic means of moduli and densities, as
/// the mass of two particles that meet head-on is; what is rigid counts as infinite.
fn core_scale(case: &Case, a: usize, b: usize) -> f64 {
    let bodies = [&case.bodies[a], &case.bodies[b]];
    let harmonic_mean = |value: &dyn Fn(&Body) -> f64| {
        let soft = bodies.iter().filter(|body| body.rigid.is_none());
        2.0 / soft.map(|body| 1.0 / value(body)).sum::<f64>()
    };
    let modulus = harmonic_mean(&|body| case.materials[body.material].p_wave_modulus());
    let density = harmonic_mean(&|body| case.initial_density(body));
    let speed = case.closing_speed(a, b);
    modulus.max(0.85 * density * speed * speed)
}
