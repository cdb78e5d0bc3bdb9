//! All fragments at one time.

use std::ops::Range;

use rayon::prelude::*;

use super::fragment::Fragment;
use super::labels::{Labels, Member};
use super::links::link;
use super::matter::{Matter, Rule, Surroundings, images};
use super::sums::{Moments, Sums};
use crate::domain::Halo;
use comm::{Comm, Receivers, Record, Relay, read_pod};
use model::SymmetryPlane;
use numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use particles::Mirrors;

/// Particles that a task sums over.
const SHARE: usize = 8192;

/// Some of the model's matter.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Share {
    /// Particles, images behind planes included.
    pub particles: u64,
    /// Mass (kg).
    pub mass: f64,
}

/// All fragments at one time, of the whole model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Census {
    /// Fragments of at least the least number of particles, the heaviest first, equals by label; on
    /// rank 0 alone.
    pub fragments: Vec<Fragment>,
    /// All matter.
    pub total: Share,
    /// Share in fragments.
    pub in_fragments: Share,
    /// Share that hangs together in too few particles.
    pub dust: Share,
    /// Share that belongs to no fragment by its state.
    pub excluded: Share,
    /// The label of each of this rank's particles; `u64::MAX` of what belongs to no fragment.
    pub labels: Vec<u64>,
}

impl Census {
    /// Number of fragments; on rank 0.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.fragments.iter().map(|f| f.copies).sum()
    }
}

/// Finds all fragments. Without a halo there is one rank. Collective.
///
/// # Panics
/// If arrays of `matter` are too short.
pub fn find(
    (comm, halo): (&Comm, Option<&mut Halo>),
    matter: &Matter,
    around: Surroundings,
    rule: &Rule,
    labels: &mut Labels,
) -> Census {
    link((comm, halo), matter, around, rule, labels);
    let mirrors = around.mirrors;
    let known = labels.members();
    let member = |i: usize| {
        let takes_part = matter.included[i] && matter.size[i] > 0.0;
        takes_part.then(|| known.of(i))
    };
    let members: Vec<Option<Member>> = (0..matter.owned).into_par_iter().map(member).collect();
    let whole = |member: &Member| member.count << member.planes.count_ones();
    let is_fragment = |member: &Member| whole(member) >= rule.least;
    let mut census = shares(comm, matter, mirrors, |i| match &members[i] {
        Some(member) if is_fragment(member) => 0,
        Some(_) => 1,
        None => 2,
    });
    let label = |member: &Option<Member>| member.map_or(u64::MAX, |m| m.label);
    census.labels = members.par_iter().map(label).collect();
    let mut order: Vec<usize> = (0..matter.owned).collect();
    order.retain(|&i| members[i].as_ref().is_some_and(is_fragment));
    order.par_sort_unstable_by_key(|&i| (census.labels[i], i));
    let parts = segments(&order, &census.labels).into_par_iter();
    let parts: Vec<(Member, Part)> = parts
        .map(|range| {
            let member = members[order[range.start]].expect("it is of a fragment");
            let sums = sums_over(matter, &order[range]);
            let part = Part {
                label: member.label,
                count: member.count,
                planes: member.planes,
                sums,
            };
            (member, part)
        })
        .collect();
    let (crossing, whole): (Vec<_>, Vec<_>) =
        parts.into_iter().partition(|(member, _)| member.crosses);
    let mut crossing: Vec<Part> = crossing.into_iter().map(|(_, part)| part).collect();
    // The owner of a label adds up what ranks have of it.
    let mut owners = Relay::new(Receivers::Owners);
    let joined = owners.send(comm, &mut crossing, |all, part| all.sums.merge(&part.sums));
    let parts = whole.iter().map(|(_, part)| part).chain(&*joined);
    let model = (mirrors, rule.dimension);
    let mut fragments: Vec<Fragment> = parts.map(|part| part.fragment(model)).collect();
    let mut root = Relay::new(Receivers::Root);
    let fragments = root.send(comm, &mut fragments, |_, _| {});
    fragments.sort_by(|a, b| b.mass.total_cmp(&a.mass).then(a.label.cmp(&b.label)));
    census.fragments = std::mem::take(fragments);
    census
}

/// What a rank has of a fragment, or some ranks have.
#[derive(Clone)]
struct Part {
    label: u64,
    /// Of the whole.
    count: u64,
    planes: u32,
    sums: Sums,
}

impl Part {
    fn fragment(&self, model: (&Mirrors, usize)) -> Fragment {
        let values: Vec<f64> = self.sums.values().collect();
        let moments = Moments::new(&values);
        Fragment::new((self.label, self.count), self.planes, &moments, model)
    }
}

impl Record for Part {
    fn key(&self) -> u64 {
        self.label
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        let words = [self.label, self.count, self.planes.into()];
        bytes.extend_from_slice(bytemuck::cast_slice(&words));
        self.sums.write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Self {
        let [label, count, planes]: [u64; 3] = read_pod(bytes);
        Self {
            label,
            count,
            planes: u32::try_from(planes).unwrap_or_default(),
            sums: Sums::read(bytes),
        }
    }
}

/// Finds all fragments of a model whose particles are all here.
#[must_use]
pub fn find_alone(matter: &Matter, planes: &[SymmetryPlane], rule: &Rule) -> Census {
    let mirrors = &Mirrors::new(planes);
    let around = Surroundings {
        mirrors,
        others: &images(mirrors, matter, rule.link),
    };
    find(
        (&Comm::solo(), None),
        matter,
        around,
        rule,
        &mut Labels::default(),
    )
}

/// The parts of `order` that have one label each.
fn segments(order: &[usize], labels: &[u64]) -> Vec<Range<usize>> {
    let mut begin = 0;
    let parts = order.chunk_by(|&a, &b| labels[a] == labels[b]);
    let part = |part: &[usize]| {
        begin += part.len();
        begin - part.len()..begin
    };
    parts.map(part).collect()
}

fn sums_over(matter: &Matter, particles: &[usize]) -> Sums {
    let sum = |particles: &[usize]| {
        let mut sums = Sums::new(matter.bodies);
        for &i in particles {
            sums.add(matter, i);
        }
        sums
    };
    if particles.len() <= SHARE {
        return sum(particles);
    }
    let parts: Vec<Sums> = particles.par_chunks(SHARE).map(sum).collect();
    let mut parts = parts.into_iter();
    let mut all = parts.next().expect("there are particles");
    parts.for_each(|part| all.merge(&part));
    all
}

/// Particles and masses of three kinds of matter, told apart by `kind`: fragments, dust, what is
/// excluded. Collective.
fn shares(
    comm: &Comm,
    matter: &Matter,
    mirrors: &Mirrors,
    kind: impl Fn(usize) -> usize + Sync,
) -> Census {
    let fold = mirrors.masks().count() as u64;
    let tasks = matter.owned.div_ceil(SHARE);
    let parts = (0..tasks).into_par_iter().map(|task| {
        let mut sums = [const { ExactSum::new() }; 3];
        let mut counts = [0_u64; 3];
        for i in task * SHARE..((task + 1) * SHARE).min(matter.owned) {
            if matter.size[i] > 0.0 {
                let kind = kind(i);
                sums[kind].add(matter.mass[i]);
                counts[kind] += 1;
            }
        }
        (sums, counts)
    });
    let parts: Vec<_> = parts.collect();
    let mut sums = [const { ExactSum::new() }; 3];
    let mut counts = [0; 3];
    for (part, more) in &parts {
        for k in 0..3 {
            sums[k].merge(&part[k]);
            counts[k] += more[k];
        }
    }
    let mut limbs = Vec::new();
    gather_limbs(sums.iter_mut(), &mut limbs);
    comm.sum_i64(&mut limbs);
    comm.sum_u64(&mut counts);
    scatter_limbs(sums.iter_mut(), &limbs);
    #[expect(clippy::cast_precision_loss, reason = "at most eight")]
    let share = |particles: u64, sum: &ExactSum| Share {
        particles: particles * fold,
        mass: sum.value() * fold as f64,
    };
    let [in_fragments, dust, excluded] = [0, 1, 2].map(|k| share(counts[k], &sums[k]));
    let mut all = sums[0].clone();
    all.merge(&sums[1]);
    all.merge(&sums[2]);
    Census {
        total: share(counts.iter().sum(), &all),
        in_fragments,
        dust,
        excluded,
        ..Census::default()
    }
}
