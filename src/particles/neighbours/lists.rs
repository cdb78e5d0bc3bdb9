//! From owned and halo particles to sorted images, their records and neighbour lists.

use rayon::prelude::*;

use super::cluster::Cluster;
use super::clusters::{Chunk, ClusterLists, Lengths};
use super::columns::ColumnGrid;
use super::facts::{ImageFacts, ImageState};
use super::foreign::{ForeignChunk, ForeignLists, ForeignTable};
use super::fragments::Membership;
use super::groups::Groups;
use super::motion::MotionRecord;
use super::sequence::Sequence;
use super::size_classes::SizeClasses;
use crate::Mirrors;
use crate::{Active, ActiveMut, GRAIN, HaloImages, Image, ParticleStore, Scatter, resize};
use model::{Body, Case, SmoothingLength};
use numerics::collector::Collector;
use numerics::extent::{Extent, around};
use numerics::kernel::SUPPORT;

/// The sequence of images, their motion records and the lists, kept from step to step.
pub struct Lists {
    /// The groups of bodies.
    pub groups: Groups,
    /// Spare the sums of what moves alike without stress; off to test that no bit changes, and to
    /// time the sums.
    pub spare_quiescent: bool,
    /// True if the store is to be put in order.
    pub is_order_due: bool,
    /// By group: whether other lists than these have its sums.
    pub elsewhere: Vec<bool>,
    /// Of lists of the initial configuration: specific volumes at the start (m^d/kg), by body.
    of_start: Option<Vec<f64>>,
    sequence: Sequence,
    motion: Vec<MotionRecord>,
    clusters: ClusterLists,
    foreign: ForeignLists,
    /// Smoothing lengths of each group.
    lengths: Vec<Lengths>,
    /// True if smoothing lengths change.
    is_variable: bool,
    /// Velocity of each group's first body at the start (m/s): where all move so and there is no
    /// stress, sums are zero to the bit and need not be made.
    common_velocity: Vec<[f64; 3]>,
    order: Vec<u32>,
    /// That of all, where some are inactive.
    full_order: Vec<u32>,
    collector: Collector,
}

/// The store is put in order if more than one particle in so many does not follow the one before.
const ASTRAY: usize = 256;

impl Lists {
    /// Empty lists of a case, of which the sites of body b stand in `boxes[b]` (m) and which is longest along the axis
    /// `longest` (0, 1, 2).
    ///
    /// # Panics
    /// If the case has no bodies.
    #[must_use]
    pub fn new(case: &Case, groups: Groups, boxes: &[Extent], longest: usize) -> Self {
        let lengths = group_lengths(case, &groups);
        let (first, rest) = lengths.split_first().expect("a case has bodies");
        let same =
            |group: &Lengths| group.uniform && group.longest.to_bits() == first.longest.to_bits();
        // Sums over rings read the lengths of both.
        let uniform = !case.axisymmetric && first.uniform && rest.iter().all(same);
        let common_velocity = |group| {
            let first = groups.members(group).next();
            first.map_or([0.0; 3], |body| case.bodies[body].velocity.into())
        };
        Self {
            spare_quiescent: true,
            is_order_due: true,
            elsewhere: vec![false; groups.count()],
            of_start: None,
            common_velocity: (0..groups.count()).map(common_velocity).collect(),
            sequence: Sequence::new(group_grids(case, &groups, boxes, longest), uniform),
            motion: Vec::new(),
            clusters: ClusterLists::new(
                (groups.count() > groups.of_bodies).then_some(groups.of_bodies),
            ),
            foreign: ForeignLists::default(),
            is_variable: case.sph.smoothing_length != SmoothingLength::Constant,
            order: Vec::new(),
            full_order: Vec::new(),
            collector: Collector::default(),
            lengths,
            groups,
        }
    }

    /// The same of the initial configuration: of positions and volumes at the start, given the specific volumes of bodies
    /// (m^d/kg).
    #[must_use]
    pub fn of_start(mut self, specific_volume: Vec<f64>) -> Self {
        self.of_start = Some(specific_volume);
        self
    }

    /// Sets which groups have their sums by other lists; `spared` lists name no neighbours of these.
    pub fn set_elsewhere(&mut self, groups: impl Iterator<Item = bool>, spared: bool) {
        let own = self.elsewhere.iter_mut().zip(&mut self.lengths);
        for (((elsewhere, lengths), &rigid), is_elsewhere) in
            own.zip(&self.groups.rigid).zip(groups)
        {
            *elsewhere = is_elsewhere;
            lengths.rigid = rigid || is_elsewhere && spared;
        }
    }

    /// Calls `refresh` with each image of the last search, the record of its motion and a value of its place.
    pub fn refresh<T: Send>(
        &mut self,
        values: &mut [T],
        refresh: impl Fn(&mut T, &mut MotionRecord, Image) + Sync,
    ) {
        let records = self.motion.par_iter_mut().zip(self.sequence.images());
        let all = values.par_iter_mut().zip(records).with_min_len(GRAIN);
        all.for_each(|(value, (record, image))| refresh(value, record, *image));
    }

    /// Particles of these groups are no receivers, from the next search on.
    pub fn leave_out(&mut self, groups: &[bool]) {
        self.clusters.leave_out(groups);
    }

    /// The images in canonical order.
    #[must_use]
    pub fn images(&self) -> &[Image] {
        self.sequence.images()
    }

    /// The order of images.
    #[must_use]
    pub fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    /// Motion of each image.
    #[must_use]
    pub fn motion(&self) -> &[MotionRecord] {
        &self.motion
    }

    /// Clusters of receivers with the neighbours of their own group.
    #[must_use]
    pub fn chunks(&self) -> &[Chunk] {
        self.clusters.chunks()
    }

    /// Receivers with their foreign neighbours, as the tasks of [`Self::chunks`] have them.
    #[must_use]
    pub fn foreign(&self) -> &[ForeignChunk] {
        self.foreign.chunks()
    }

    /// True if two images of a group are within each other's support.
    #[must_use]
    pub fn in_support(&self, group: usize, i: u32, j: u32) -> bool {
        let [a, b] = [i, j].map(|index| &self.motion[index as usize].position);
        let r = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let lengths = self.sequence.smoothing_lengths();
        let h = |index: u32| {
            let own = lengths.get(index as usize);
            own.copied().unwrap_or(self.lengths[group].longest)
        };
        let range = (h(i) + h(j)).max(self.lengths[group].least);
        r[0] * r[0] + r[1] * r[1] + r[2] * r[2] < range * range
    }

    /// Calls `visit`, in canonical order, with the place of each image that is nearer than `range` (m) to a
    /// point (m), and with the square of its distance (m²).
    pub fn near_point(&self, point: &[f64; 3], range: f64, mut visit: impl FnMut(usize, f64)) {
        for group in 0..self.lengths.len() {
            self.sequence.near_point(group, point, range, &mut visit);
        }
    }

    /// Key by which points (m) are best ordered that are looked up one after the other: their
    /// column, and their position along it, by the first group.
    #[must_use]
    pub fn order_of(&self, point: &[f64; 3]) -> [u64; 2] {
        self.sequence.order_of(0, point)
    }

    /// The longest support in a group (m), and whether it is that of all particles of the case.
    pub(super) fn support(&self, group: usize) -> (f64, bool) {
        let uniform = self.sequence.smoothing_lengths().is_empty();
        (SUPPORT * self.lengths[group].longest, uniform)
    }

    /// The longest range of any list (m).
    #[must_use]
    pub fn farthest(&self) -> f64 {
        let ranges = self.lengths.iter().map(Lengths::range);
        ranges.fold(0.0, f64::max)
    }

    /// True if the particles of a group have no velocity where it is at rest in itself.
    #[must_use]
    pub fn is_still(&self, group: usize) -> bool {
        self.common_velocity[group] == [0.0; 3]
    }

    /// The longest smoothing length (m).
    #[must_use]
    pub fn longest(&self) -> f64 {
        let lengths = self.lengths.iter().map(|lengths| lengths.longest);
        lengths.fold(0.0, f64::max)
    }

    /// Neighbours in the lists, summed over this rank's particles.
    #[must_use]
    pub fn entries(&self) -> u64 {
        let clusters = self.chunks().iter().flat_map(Chunk::iter);
        clusters
            .map(|(cluster, list, _)| (cluster.lanes * list.len()) as u64)
            .sum()
    }

    /// Bytes allocated for the order of places, records of motion, neighbours of the own group and
    /// foreign ones.
    #[must_use]
    pub fn memory_by_part(&self) -> [usize; 4] {
        let orders = 4 * (self.order.capacity() + self.full_order.capacity());
        [
            self.sequence.memory() + orders,
            self.motion.capacity() * size_of::<MotionRecord>(),
            self.clusters.memory(),
            self.foreign.memory(),
        ]
    }

    /// Sorts all active particles and images, and lists the neighbours of each in its own group. Where lists are
    /// `spared`, particles that rest far from moving ones, and from `contact` if there is any, have none: `rests` says of
    /// an image of a particle of this rank that nothing changes it as long as nothing moves around it. `scratch` is memory
    /// to work in, see [`Sequence::build`].
    pub fn build<R: bytemuck::Pod>(
        &mut self,
        active: Active,
        halo: HaloImages,
        contact: Option<&ForeignTable>,
        rests: impl Fn(Image) -> bool + Sync,
        spared: bool,
        scratch: &mut [R],
    ) {
        let particles = active.particles;
        let (owned, others) = (particles.owned(), halo.images);
        let (mirrors, groups) = (halo.mirrors, &self.groups);
        let (spare, common) = (self.spare_quiescent, &self.common_velocity);
        resize(&mut self.motion, active.count() + others.len());
        let motion = Scatter::new(&mut self.motion);
        let group_of = |slot: usize| group_of(groups, particles, slot);
        let of_start = self.of_start.as_deref();
        let positions = match of_start {
            None => &particles.position,
            Some(_) => &particles.reference_position,
        };
        let facts = |image: Image| {
            let (slot, mirror_mask) = (image.slot(), image.mirror_mask());
            ImageFacts {
                position: mirrors.reflect_position(&positions[slot], mirror_mask),
                id: particles.id[slot],
                group: group_of(slot),
                smoothing_length: particles.smoothing_length[slot],
            }
        };
        let scratch = bytemuck::cast_slice_mut(scratch);
        let sequence = &mut self.sequence;
        sequence.build(
            scratch,
            (owned, active.inactive),
            (others, halo.below),
            facts,
            |index, image| {
                let (slot, mirror_mask) = (image.slot(), image.mirror_mask());
                let record = MotionRecord {
                    position: mirrors.reflect_position(&positions[slot], mirror_mask),
                    velocity: Mirrors::reflect_vector(
                        &particles.predicted_velocity[slot],
                        mirror_mask,
                    ),
                    volume: match of_start {
                        None => particles.mass[slot] / particles.predicted_density[slot],
                        Some(volumes) => {
                            particles.mass[slot] * volumes[particles.body[slot] as usize]
                        }
                    },
                    mass: particles.mass[slot],
                };
                // SAFETY: each place is emitted once.
                unsafe { *motion.slot(index) = record };
                let moving = !spare || record.velocity != common[group_of(slot)];
                ImageState {
                    moving,
                    resting: !moving && slot < owned && rests(image),
                }
            },
        );
        if self.is_variable {
            self.measure_lengths();
        }
        let ranges = contact.map(|table| &table.ranges);
        self.clusters
            .build(&self.sequence, &self.lengths, (ranges, spared));
    }

    /// Finds the longest smoothing length of each group among its images.
    fn measure_lengths(&mut self) {
        for (group, lengths) in self.lengths.iter_mut().enumerate() {
            lengths.longest = self.sequence.smoothing_lengths()[self.sequence.group(group)]
                .par_iter()
                .copied()
                // same bits in any order: a largest number
                .reduce(|| 0.0, f64::max);
        }
    }

    /// Lists for each receiver by itself which of its cluster's neighbours it sums, after [`Self::build`]: `near` is told the motion
    /// and the smoothing lengths of all images, a cluster and its neighbours, and writes for each of these a byte with a bit
    /// for each lane that does.
    pub fn list_close(
        &mut self,
        near: impl Fn((&[MotionRecord], &[f64]), &Cluster, &[u32], &mut Vec<u8>) + Sync,
    ) {
        let all = (&*self.motion, self.sequence.smoothing_lengths());
        self.clusters
            .list_close(|cluster, list, bits| near(all, cluster, list, bits));
    }

    /// Takes those of another fragment out of the lists of the own group, before
    /// [`Self::build_foreign`] takes them in.
    pub fn separate(&mut self, membership: &Membership) {
        self.clusters.part(membership);
    }

    /// Lets clusters of sparse matter share lanes, after [`Self::build_foreign`], if there are any such.
    pub fn join(&mut self) {
        self.clusters.join();
    }

    /// Lists the neighbours of other groups that contact knows, after [`Self::build`].
    pub fn build_foreign(&mut self, particles: &ParticleStore, table: &ForeignTable) {
        let images = self.sequence.images();
        self.foreign.build(
            &self.clusters,
            &self.sequence,
            &self.motion,
            table,
            |index| {
                let slot = images[index as usize].slot();
                let body = particles.body[slot] as usize;
                table.size_classes.of(body, particles.mass[slot])
            },
        );
    }

    /// Puts the active particles of the store into the canonical order of the last search, so that memory follows space,
    /// unless they nearly are. Results do not depend on it. Returns whether there was such a search.
    /// `scratch` is memory to work in.
    pub fn restore_order<R: bytemuck::Pod>(
        &mut self,
        active: ActiveMut,
        scratch: &mut [R],
    ) -> bool {
        let ActiveMut {
            particles,
            inactive,
        } = active;
        let (owned, images) = (particles.owned(), self.sequence.images());
        let own = |image: &Image| {
            image.mirror_mask().is_own() && image.slot() < owned && !inactive.holds(image.slot())
        };
        self.order.clear();
        let all = (images.len(), GRAIN);
        self.collector.extend(&mut self.order, all, |index| {
            #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
            let place = |image: Image| image.slot() as u32;
            Some(images[index]).filter(own).map(place)
        });
        let active = inactive.count_active(owned);
        let known = self.order.len() == active;
        let pairs = self.order.par_windows(2).with_min_len(GRAIN);
        let follows = |a: u32, b: u32| b == a + 1 || b > a && inactive.is_gap(a + 1, b);
        let astray = pairs.filter(|pair| !follows(pair[0], pair[1]));
        if !known || astray.count() <= active / ASTRAY {
            return known;
        }
        let scratch = bytemuck::cast_slice_mut(scratch);
        if inactive.is_empty() {
            particles.keep(&self.order, scratch);
            return true;
        }
        #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
        let itself = |i: usize| i as u32;
        self.full_order.clear();
        let all = (0..owned).into_par_iter().with_min_len(GRAIN);
        self.full_order.par_extend(all.map(itself));
        let full = Scatter::new(&mut self.full_order);
        let order = self.order.par_iter().enumerate().with_min_len(GRAIN);
        order.for_each(|(n, &place)| {
            // SAFETY: each place in the store is that of one active particle.
            unsafe { *full.slot(inactive.nth_active(n)) = place };
        });
        particles.rearrange(&self.full_order, scratch);
        true
    }
}

/// The group of a particle: stress points have groups of their own.
#[inline(always)]
fn group_of(groups: &Groups, particles: &ParticleStore, slot: usize) -> usize {
    let group = groups.of_body[particles.body[slot] as usize];
    let stress_mass = particles.stress_mass.get(slot);
    if stress_mass.is_some_and(|&mass| mass > 0.0) {
        group + groups.of_bodies
    } else {
        group
    }
}

/// The groups' smoothing lengths where these are constant.
fn group_lengths(case: &Case, groups: &Groups) -> Vec<Lengths> {
    let constant = case.sph.smoothing_length == SmoothingLength::Constant;
    (0..groups.count())
        .map(|group| {
            let members = groups.members(group);
            let bodies = || members.clone().map(|b| &case.bodies[b]);
            let h = || bodies().map(|body| body.smoothing_length);
            let longest = bodies().map(Body::longest_smoothing_length);
            let longest = longest.fold(0.0, f64::max);
            let uneven = bodies().any(|body| body.lattice.sizes.is_some());
            Lengths {
                longest,
                least: if case.self_contact.is_some() && !uneven {
                    2.0 * longest
                } else {
                    0.0
                },
                stretch: if case.self_contact.is_some() && uneven {
                    SizeClasses::longest_range(case)
                } else {
                    1.0
                },
                uniform: constant && h().all(|h| h.to_bits() == longest.to_bits()) && !uneven,
                rigid: groups.rigid[group],
            }
        })
        .collect()
}

/// The column grid of each group of bodies: a function of the case alone.
fn group_grids(case: &Case, groups: &Groups, boxes: &[Extent], longest: usize) -> Vec<ColumnGrid> {
    (0..groups.count())
        .map(|group| {
            let members = groups.members(group);
            let (lower, upper) = around(members.clone().map(|b| boxes[b]));
            // Where sizes differ, between the smallest and the largest ones.
            let middle = |b: usize| {
                let lattice = &case.bodies[b].lattice;
                let [least, most] = lattice.sizes.unwrap_or([1.0; 2]);
                lattice.spacing * (least * most).sqrt()
            };
            let spacing = members.map(middle).fold(0.0, f64::max);
            ColumnGrid::new(lower, upper, spacing, longest)
        })
        .collect()
}
