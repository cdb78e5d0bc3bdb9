//! Parameters of every pair of size classes of particles, computed once at set-up.

use std::collections::BTreeMap;

use super::gas::Gas;
use super::joint::{JointPair, Joints};
use super::pair::{Between, Listed, ModePairs, Pair, needs};
use model::{Body, Case, ContactMode, ContactPair, Loads, SelfContact, cube};
use numerics::kernel::{Kernel, SUPPORT};
use particles::neighbours::{ForeignTable, GroupRanges, Groups, SizeClasses};
use particles::{HaloPhase, Owner, ParticleStore};

/// All pairs of size classes.
#[derive(Debug, Clone)]
pub struct ContactTable {
    /// The kernel that contact weights with.
    pub kernel: Kernel,
    /// Groups of bodies, which see each other in the SPH sums and have no other contact.
    pub groups: Groups,
    /// Mode of each pair, and its range.
    pub foreign: ForeignTable,
    /// Fields that halo particles need before the forces of contact, at once with those of stress.
    pub halo: HaloPhase,
    /// Constants of the modes, in the order of the pairs.
    modes: ModePairs,
    pairs: Vec<Pair>,
    inverse_densities: Vec<f64>,
    /// Multiple of its reference volume that a particle's material may fill, by body.
    expansions: Vec<f64>,
    /// Bodies of gas, by body.
    pub(super) gases: Vec<Option<Gas>>,
    /// What holds bodies together.
    pub(super) joints: Joints,
    owners: Owner,
    /// True if parts of a body have contact.
    has_own: bool,
    /// True if particles are rings about an axis.
    pub(super) rings: bool,
    /// By size class: volume (m³) of a particle of which a ring has many.
    grains: Vec<f64>,
}

impl ContactTable {
    /// Table of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let size_classes = SizeClasses::new(case);
        let n = size_classes.count();
        let groups = Groups::new(case);
        let mut table = Self {
            kernel: Kernel::new(case.extent()),
            foreign: ForeignTable {
                class: vec![None; n * n],
                reach2: vec![0.0; n * n],
                ranges: group_ranges(&groups, &size_classes),
                most: case
                    .bodies
                    .iter()
                    .any(|body| body.lattice.sizes.is_some())
                    .then(|| SizeClasses::longest_range(case)),
                size_classes,
            },
            groups,
            halo: HaloPhase::empty(),
            modes: ModePairs::default(),
            pairs: Vec::with_capacity(n * n),
            inverse_densities: Vec::with_capacity(case.bodies.len()),
            expansions: Vec::with_capacity(case.bodies.len()),
            gases: case.bodies.iter().map(|body| Gas::of(case, body)).collect(),
            joints: Joints::of(case),
            owners: Owner::empty(),
            has_own: case.self_contact.is_some(),
            rings: case.axisymmetric,
            grains: Vec::new(),
        };
        for body in &case.bodies {
            table
                .inverse_densities
                .push(1.0 / case.initial_density(body));
            // Beyond that, what may fail has voids.
            let bursts = case.materials[body.material].failure.has_memory();
            table
                .expansions
                .push(if bursts { 1.0 } else { f64::INFINITY });
        }
        let bodies: Vec<Body> = (0..n)
            .map(|size_class| table.foreign.size_classes.body_of_size(case, size_class))
            .collect();
        table.grains = (bodies.iter())
            .map(|body| cube(body.lattice.spacing, case.extent()))
            .collect();
        let speed = case.impact_speed();
        for a in 0..n {
            for b in 0..n {
                table.add(case, speed, [a, b], [&bodies[a], &bodies[b]]);
            }
        }
        if table.has_pairs() || !case.loads.surfaces.is_empty() {
            table.owners |= Owner::CONTACT;
            if table.gases.iter().any(Option::is_some) {
                table.owners |= Owner::GAS_CONTACT;
                table.halo |= HaloPhase::CONTACT;
            }
        }
        if table.has_friction() {
            table.owners |= Owner::FRICTION;
        }
        if table.has_joints() {
            table.owners |= Owner::JOINTS;
            table.halo |= HaloPhase::CONTACT;
        }
        table
    }

    /// Table of two bodies of each kind that contact tells apart, which has the needs of that of all: fields, messages and
    /// friction.
    #[must_use]
    pub fn of_kinds(case: &Case) -> Self {
        let named = |body: usize| case.contacts.iter().any(|pair| pair.bodies.contains(&body));
        let mut seen: BTreeMap<_, u32> = BTreeMap::new();
        let kept = case.bodies.iter().enumerate().filter(|(index, body)| {
            let own = named(*index).then_some(*index);
            let soft = case.contact_modulus(body) > 0.0;
            let rigid = [body.rigid.is_some(), body.is_free()];
            let kind = (own, body.material, rigid, soft);
            let count = seen.entry(kind).or_default();
            *count += 1;
            *count <= 2
        });
        let kept: Vec<usize> = kept.map(|(index, _)| index).collect();
        if kept.len() == case.bodies.len() {
            return Self::new(case);
        }
        // What is named is kept.
        let place = |body: &usize| kept.partition_point(|kept| kept < body);
        let contacts = case.contacts.iter().map(|pair| ContactPair {
            bodies: pair.bodies.each_ref().map(place),
            mode: pair.mode.clone(),
            joint: pair.joint,
        });
        Self::new(&Case {
            contacts: contacts.collect(),
            bodies: kept.iter().map(|&body| case.bodies[body].clone()).collect(),
            loads: Loads {
                velocities: Vec::new(),
                ..case.loads.clone()
            },
            ..case.clone()
        })
    }

    /// Adds the next pair of a case with an impact speed (m/s).
    fn add(
        &mut self,
        case: &Case,
        impact_speed: f64,
        size_classes: [usize; 2],
        bodies: [&Body; 2],
    ) {
        let [a, b] = size_classes.map(|size_class| self.foreign.size_classes.body(size_class));
        // Of those that share a size class any two stand for all.
        let mode = if self.foreign.size_classes.is_shared(size_classes[0]) && a == b {
            case.default_contact.clone()
        } else {
            mode_between(case, a, b)
        };
        let pair = Pair::new(case, &self.kernel, bodies, &mode);
        let modulus = bodies.map(|body| case.contact_modulus(body));
        let of = Between {
            case,
            kernel: &self.kernel,
            bodies,
            indices: [a, b],
            modulus: modulus[0].min(modulus[1]),
            impact_speed,
            pair: &pair,
        };
        self.modes.push(&of, &mode);
        self.joints.push(&of);
        self.pairs.push(pair);
        let [group, other] = [a, b].map(|body| self.groups.of_body[body]);
        if mode.class().is_none() || (group == other && a != b) {
            return;
        }
        let (halo, owner) = needs(&mode);
        self.halo |= halo;
        self.owners |= owner;
        let (at, range) = (self.at(size_classes[0], size_classes[1]), SUPPORT * pair.h);
        self.foreign.class[at] = mode.class();
        self.foreign.reach2[at] = range * range;
        // What a body meets of itself is found among the own neighbours, not as of another group.
        if a != b || self.foreign.size_classes.is_shared(size_classes[0]) {
            self.foreign.ranges.widen(group, other, range);
        }
    }

    /// The longest range of contact between two groups (m), zero without.
    pub(crate) fn longest_range(&self) -> f64 {
        self.foreign.ranges.longest()
    }

    /// Constants of a mode for a receiver of size class `a` and a neighbour of size class `b`.
    #[inline(always)]
    pub(super) fn own<M: Listed>(&self, a: usize, b: usize) -> &M::Pair {
        &M::list(&self.modes)[self.at(a, b)]
    }

    /// The joint of a receiver of size class `a` and a neighbour of size class `b`, if they have one.
    #[inline(always)]
    pub(super) fn joint(&self, a: usize, b: usize) -> Option<&JointPair> {
        self.joints.get(self.at(a, b))
    }

    #[inline(always)]
    fn at(&self, a: usize, b: usize) -> usize {
        a * self.foreign.size_classes.count() + b
    }

    /// Parameters of a receiver of size class `a` and a neighbour of size class `b`.
    #[inline]
    #[must_use]
    pub fn pair(&self, a: usize, b: usize) -> &Pair {
        &self.pairs[self.at(a, b)]
    }

    /// The size class of a particle of a body with a mass (kg).
    #[inline(always)]
    #[must_use]
    pub fn size_class(&self, body: usize, mass: f64) -> usize {
        self.foreign.size_classes.of(body, mass)
    }

    /// Number of bodies.
    #[must_use]
    pub fn bodies(&self) -> usize {
        self.foreign.size_classes.bodies()
    }

    /// Parameters of the smallest particles of two bodies, if they have contact beyond the SPH sums.
    #[must_use]
    pub fn between(&self, a: usize, b: usize) -> Option<&Pair> {
        if a == b && !self.has_own {
            return None;
        }
        let [a, b] = [a, b].map(|body| self.foreign.size_classes.smallest(body));
        self.foreign.class[self.at(a, b)].map(|_| self.pair(a, b))
    }

    /// Multiple of its reference volume that the material of a particle of a body may fill: beyond
    /// that, material that may fail has voids, which are not of the body.
    #[inline(always)]
    pub(super) fn expansion(&self, body: usize) -> f64 {
        self.expansions[body]
    }

    /// Volume (m³) of a particle of a size class, of which a ring has many.
    #[inline(always)]
    pub(super) fn grain(&self, size_class: usize) -> f64 {
        self.grains[size_class]
    }

    /// 1/ρ of a body at the start (m³/kg).
    #[inline]
    #[must_use]
    pub fn inverse_density(&self, body: usize) -> f64 {
        self.inverse_densities[body]
    }

    /// The options of the table of fields that this contact has.
    #[must_use]
    pub fn owners(&self) -> Owner {
        self.owners
    }

    /// True if there is contact beyond the SPH sums: of pairs of bodies, or with rigid surfaces.
    #[must_use]
    pub fn is_active(&self) -> bool {
        self.owners.contains(Owner::CONTACT)
    }

    /// True if any pair of bodies has contact beyond the SPH sums.
    #[must_use]
    pub fn has_pairs(&self) -> bool {
        self.foreign.class.iter().any(Option::is_some)
    }

    /// True if the stiffness of any contact follows the pressure of a gas.
    pub(super) fn has_gas(&self) -> bool {
        self.owners.contains(Owner::GAS_CONTACT)
    }

    /// Relative rate of the factor of the stiffness of a particle (1/s), see [`gas`](super::gas).
    pub(super) fn stiffening_rate(&self, particles: &ParticleStore, i: usize) -> f64 {
        if !self.has_gas() {
            return 0.0;
        }
        let gas = self.gases[particles.body[i] as usize].as_ref();
        gas.map_or(0.0, |gas| gas.rate(particles, i))
    }

    /// True if any bodies are joined.
    pub(super) fn has_joints(&self) -> bool {
        self.joints.any()
    }

    /// True if contact of bodies exchanges heat with their particles.
    #[must_use]
    pub fn has_heat(&self) -> bool {
        self.has_friction() || self.has_gas() || self.has_joints()
    }

    /// True if any pair of bodies has friction or damping.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        let mut pairs = self.pairs.iter();
        pairs.any(|pair| pair.friction.is_any())
    }

    /// The shortest mean smoothing length (m) of two bodies with contact beyond the SPH sums, infinite without.
    #[must_use]
    pub(crate) fn shortest(&self) -> f64 {
        let size_classes = &self.foreign.size_classes;
        let all = 0..size_classes.count();
        let pairs = all.clone().flat_map(|a| all.clone().map(move |b| (a, b)));
        let apart = pairs.filter(|&(a, b)| {
            size_classes.body(a) != size_classes.body(b) || size_classes.is_shared(a)
        });
        let lengths = apart.filter_map(|(a, b)| {
            let at = self.at(a, b);
            self.foreign.class[at].map(|_| self.pairs[at].h)
        });
        lengths.fold(f64::INFINITY, f64::min)
    }
}

/// Ranges between groups, without contact so far: bodies of one size class are groups of one kind, unless they form a group
/// with others.
fn group_ranges(groups: &Groups, size_classes: &SizeClasses) -> GroupRanges {
    let mut members = vec![0; groups.of_bodies];
    for &group in &groups.of_body {
        members[group] += 1;
    }
    // The last kind is that of stress points, which have no contact.
    let all = size_classes.count() + groups.of_bodies;
    let mut kinds = vec![all; groups.count()];
    for (body, &group) in groups.of_body.iter().enumerate() {
        kinds[group] = if members[group] == 1 {
            size_classes.smallest(body)
        } else {
            size_classes.count() + group
        };
    }
    let mut known = kinds.clone();
    known.sort_unstable();
    known.dedup();
    let place = |kind: usize| known.partition_point(|&known| known < kind);
    let kinds = kinds.into_iter().map(place).collect();
    GroupRanges::new(kinds, known.len())
}

/// Mode of contact between two bodies, or fragments of one.
fn mode_between(case: &Case, a: usize, b: usize) -> ContactMode {
    let [one, other] = [a, b].map(|body| &case.bodies[body]);
    if one.driven().is_some() && other.driven().is_some() {
        ContactMode::None
    } else if a == b {
        let own = case.self_contact.as_ref().filter(|_| one.rigid.is_none());
        own.map_or(ContactMode::None, SelfContact::mode)
    } else {
        case.contact_between(a, b).clone()
    }
}
