//! Bodies of the total form: sums over the neighbours of their initial configuration (theory page "Total form").

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use rayon::prelude::*;

use super::gradient_sweep::{Gradient, strain};
use super::momentum_sweep::accelerate_with;
use crate::diagnose::Tear;
use crate::domain::InitialLayout;
use crate::sph::material_update::{Show, Updated};
use crate::sph::shared::{Sums, scratch_of, show_images, sources};
use comm::Comm;
use material::FAILED;
use model::Case;
use numerics::dispatch::{Vectorised, instructions};
use numerics::kernel::{Kernel, PairScale};
use numerics::lane_matrix::{full, read_all, store_all};
use numerics::lanes::{F64x8, LANES, Lanes};
use numerics::vector::{dot, minus, norm};
use numerics::virial::Virial;
use particles::neighbours::{Among, CHUNKS_AT_ONCE, Cluster, Groups, Lists};
use particles::{
    Active, HaloImages, Image, Mirrors, ParticleStore, Scatter, material_points, records_of, resize,
};
use sums::corrected::CorrectedRecord;
use sums::from_mirrors::FromMirrors;
use sums::neighbourhood::{Neighbourhood, Sources};
use sums::step::{Side, Step};
use sums::total::{
    Close, InitialPairs, InitialSums, LEAST_DETERMINANT, Total, TotalGradient, TotalRecord,
};
use sums::with_scale;

/// Distance over the smoothing length below which particles of a body meet.
const CLOSE: f64 = 0.6;

/// Relative change of density that rounding makes.
const LEAST_CHANGE: f64 = 1e-12;

/// Expansion at which what limits tension has torn.
const TORN: f64 = 1.1;

/// Plastic strain beyond which a particle has to have deformed accordingly: flow along a line strains by ⅔ of the logarithm of
/// the largest stretch over the smallest, simple shear by as much as that at a shear of 6.5, and what moves to and fro by more.
const SLIPS: f64 = 1.0;

/// Distance over twice the smoothing length beyond which particles of a body are strangers. Nearer ones roll over each
/// other at the rim of a foot, and their neighbours keep them apart.
const FAR: f64 = 3.0;

/// Factor of distances that a step does not exceed.
const ROOM: f64 = 1.1;

/// Bodies of the total form, with the neighbours of their initial configuration.
pub struct TotalBodies {
    lists: Lists,
    records: Vec<TotalRecord>,
    /// Sums over initial neighbours, by places of the lists.
    initial: Vec<InitialSums>,
    /// True if these are of the lists before.
    is_initial_due: bool,
    /// Positions of the images of the lists (m).
    positions: Vec<[f64; 4]>,
    from_mirrors: Vec<FromMirrors>,
    mirrors: Mirrors,
    /// Images that the lists are of: those of this rank's particles by their initial positions, and those of the halo.
    images: Vec<Image>,
    /// What the lists were made of.
    listed: Listed,
    /// Range of the longest initial pairs (m).
    range: f64,
    /// Group of each body.
    group_of_body: Vec<usize>,
    /// By group: whether its bodies are of another form.
    others: Vec<bool>,
    /// By group: why it leaves the form after this step, as [`Tear`] numbers that; zero if it does not.
    leaving: Vec<AtomicU64>,
    /// By group: why it has left the form.
    tears: Vec<Option<Tear>>,
    /// Square of the largest distance of initial neighbours over that of their smoothing length, as bits.
    farthest: AtomicU64,
    /// Words of messages.
    words: Vec<u64>,
}

/// Particles, images and forms that lists were made of: as long as they stay, so do the lists.
#[derive(Default, PartialEq)]
struct Listed {
    ids: Vec<u64>,
    halo: Vec<Image>,
    others: Vec<bool>,
}

/// Records of all particles and images by the lists of all bodies.
pub struct Shown<'a> {
    /// Records in the order of the lists.
    pub records: &'a mut [CorrectedRecord],
    /// True if nobody reads those that the first sweep would write.
    pub spared: bool,
    /// Places of the records of this rank's particles.
    pub places: &'a [u32],
    /// Those of halo particles.
    pub received: &'a [CorrectedRecord],
}

impl TotalBodies {
    /// Of a case; none if no body is of the form.
    #[must_use]
    pub fn new(case: &Case, groups: &Groups, layout: &InitialLayout) -> Option<Self> {
        let total = |group: usize| groups.members(group).any(|body| case.bodies[body].total);
        let others: Vec<bool> = (0..groups.count()).map(|group| !total(group)).collect();
        if others.iter().all(|&other| other) {
            return None;
        }
        let inverse = |body| 1.0 / case.initial_density(body);
        let specific_volume = case.bodies.iter().map(inverse).collect();
        let mut lists = Lists::new(case, groups.clone(), &layout.boxes, layout.longest);
        // Lists outlive the steps, and with them what moves.
        lists.spare_quiescent = false;
        Some(Self {
            range: lists.farthest(),
            lists: lists.of_start(specific_volume),
            images: Vec::new(),
            listed: Listed::default(),
            records: Vec::new(),
            initial: Vec::new(),
            is_initial_due: true,
            positions: Vec::new(),
            from_mirrors: Vec::new(),
            mirrors: Mirrors::of(case),
            group_of_body: groups.of_body.clone(),
            leaving: others.iter().map(|_| AtomicU64::new(0)).collect(),
            tears: vec![None; others.len()],
            others,
            farthest: AtomicU64::new(0),
            words: Vec::new(),
        })
    }

    /// True if a body is of this form now.
    #[must_use]
    pub fn holds(&self, body: usize) -> bool {
        !self.others[self.group_of_body[body]]
    }

    /// By group: whether it has its sums here.
    pub fn groups(&self) -> impl Iterator<Item = bool> + '_ {
        self.others.iter().map(|other| !other)
    }

    /// True if no body is of this form any more.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.others.iter().all(|&other| other)
    }

    /// True if all bodies are of this form.
    pub(super) fn holds_all(&self) -> bool {
        !self.others.contains(&true)
    }

    /// Memory for so many images that is free until [`Self::rates`], in words.
    pub(super) fn scratch(&mut self, images: usize) -> &mut [u64] {
        scratch_of(&mut self.records, images)
    }

    /// Why a body has left the form, as far as this process knows.
    #[must_use]
    pub fn tear(&self, body: usize) -> Option<Tear> {
        self.tears[self.group_of_body[body]]
    }

    /// Gives bodies some of whose particles have been taken out to the corrected form for good.
    pub fn release(&mut self, leaves: impl Fn(usize) -> bool) {
        for (body, &group) in self.group_of_body.iter().enumerate() {
            if leaves(body) && !self.others[group] {
                self.others[group] = true;
                self.tears[group] = Some(Tear::Removal);
            }
        }
    }

    /// Lists the neighbours of the initial configuration, in the order of initial positions, where particles or images have
    /// changed.
    pub fn list(&mut self, active: Active, halo: HaloImages) {
        if self.is_empty() {
            self.from_mirrors.clear();
            return;
        }
        let (particles, mirrors) = (active.particles, halo.mirrors);
        let is_listed = self.is_listed(active, halo);
        if !is_listed {
            self.list_images(particles);
            let images = self.images.len() + particles.owned();
            let scratch = scratch_of(&mut self.records, images);
            let own = HaloImages {
                images: &self.images,
                below: 0,
                mirrors,
            };
            self.lists.leave_out(&self.others);
            self.lists
                .build(active, own, None, |_| false, false, scratch);
            self.is_initial_due = true;
        }
        resize(&mut self.positions, self.lists.images().len());
        self.lists
            .refresh(&mut self.positions, |position, motion, image| {
                let (slot, mirror_mask) = (image.slot(), image.mirror_mask());
                let [x, y, z] = mirrors.reflect_position(&particles.position[slot], mirror_mask);
                *position = [x, y, z, 0.0];
                motion.velocity =
                    Mirrors::reflect_vector(&particles.predicted_velocity[slot], mirror_mask);
            });
    }

    /// True if the lists are of these particles and images already; notes what they are to be of.
    fn is_listed(&mut self, active: Active, halo: HaloImages) -> bool {
        let particles = active.particles;
        let ids = &particles.id[..particles.owned() + particles.halo()];
        let of_halo = halo.images.iter().copied();
        let of_halo = of_halo.filter(|image| image.slot() >= particles.owned());
        let listed = &mut self.listed;
        if active.inactive.is_empty()
            && listed.others == self.others
            && listed.ids == ids
            && listed.halo.iter().copied().eq(of_halo.clone())
        {
            return true;
        }
        listed.others.clone_from(&self.others);
        listed.ids.clear();
        // Lists of some of the particles do not outlive a step.
        if active.inactive.is_empty() {
            listed.ids.extend_from_slice(ids);
        }
        listed.halo.clear();
        listed.halo.extend(of_halo);
        false
    }

    /// Finds the images of the lists.
    fn list_images(&mut self, particles: &ParticleStore) {
        self.images.clear();
        // one thread: not in every step
        for i in 0..particles.owned() {
            if self.others[self.group_of_body[particles.body[i] as usize]] {
                continue;
            }
            let planes = (self.mirrors).near(&particles.reference_position[i], self.range);
            let masks = planes.subsets(false);
            self.images.extend(masks.map(|mask| Image::new(i, mask)));
        }
        self.images.extend_from_slice(&self.listed.halo);
    }

    /// The first sweep, after that of all other bodies. Its particles show their records there, too.
    pub(super) fn rates(
        &mut self,
        sums: &Sums,
        particles: &mut ParticleStore,
        step: &Step,
        hourglass: f64,
        shown: &mut Shown,
    ) {
        particles.correction_norm.fill(1.0);
        if self.is_empty() {
            return;
        }
        resize(&mut self.records, self.lists.images().len());
        if std::mem::take(&mut self.is_initial_due) {
            self.list_close(sums);
            self.sum_initial_pairs(sums);
        }
        self.farthest.store(0, Relaxed);
        let gradient = TotalGradients {
            dimension: sums.dimension,
            lists: &self.lists,
            initial: &self.initial,
            positions: &self.positions,
            alpha: sums.viscosity.alpha,
            stiffness: hourglass,
            modulus: Scatter::new(&mut particles.hourglass_modulus),
            deformation: Scatter::new(&mut particles.deformation_gradient),
            records: Scatter::new(&mut self.records),
            shown: (!shown.spared).then(|| (Scatter::new(shown.records), shown.places)),
            predicted_density: &particles.predicted_density,
            norm: Scatter::new(&mut particles.correction_norm),
            leaving: &self.leaving,
            farthest: &self.farthest,
        };
        let points = (material_points!(particles), records_of!(particles));
        strain(&gradient, sums, points, &self.lists, step);
    }

    /// Lists the neighbours of each particle by itself.
    fn list_close(&mut self, sums: &Sums) {
        let set = instructions();
        with_scale!(sums.scale, scale => self.lists.list_close(
            |(records, lengths), cluster, neighbours, bits| {
                let sources = Sources { records, lengths, scale };
                let around = sources.around(cluster.receivers, neighbours);
                set.run(Close { around, bits });
            },
        ));
    }

    /// Sums over the initial neighbours of each particle of the lists.
    fn sum_initial_pairs(&mut self, sums: &Sums) {
        let (lists, set) = (&self.lists, instructions());
        resize(&mut self.initial, lists.images().len());
        let initial = Scatter::new(&mut self.initial);
        let chunks = lists.chunks().par_iter().with_max_len(CHUNKS_AT_ONCE);
        with_scale!(sums.scale, scale => chunks.for_each(|chunk| {
            let motion = sources(lists, scale);
            for (cluster, neighbours, _) in chunk.iter() {
                let around = motion.around(cluster.receivers, neighbours);
                let own = set.run(InitialPairs { around });
                for (&place, own) in cluster.valid().iter().zip(own) {
                    // SAFETY: the place belongs to this cluster alone, and this thread has the cluster.
                    unsafe { *initial.slot(place as usize) = own };
                }
            }
        }));
    }

    /// The second sweep, after images have got their records.
    pub(super) fn forces(
        &mut self,
        sums: &Sums,
        particles: &mut ParticleStore,
        shown: &Shown,
        side: Side,
    ) {
        if self.is_empty() {
            return;
        }
        let (owned, lists, mirrors) = (particles.owned(), &self.lists, &self.mirrors);
        let (positions, moduli) = (&particles.position, &particles.hourglass_modulus);
        let deformations = &particles.deformation_gradient;
        show_images(
            &mut self.records,
            owned,
            lists,
            side,
            |_, slot, mirror_mask| {
                let record = match slot.checked_sub(owned) {
                    None => &shown.records[shown.places[slot] as usize],
                    Some(k) => &shown.received[k],
                };
                TotalRecord {
                    stress: Mirrors::reflect_tensor(&record.stress, mirror_mask),
                    hourglass: moduli[slot],
                    density: record.density,
                    viscous_speed: record.viscous_speed,
                    position: mirrors.reflect_position(&positions[slot], mirror_mask),
                    half_deformation: half(&Mirrors::reflect_tensor(
                        &deformations[slot],
                        mirror_mask,
                    )),
                }
            },
        );
        let all = (&*self.records, &mut self.from_mirrors);
        accelerate_with(sums, all, particles, lists, side);
    }

    /// Forces of images behind symmetry planes in the last second sweep, by chunks.
    #[must_use]
    pub fn mirror_forces(&self) -> &[FromMirrors] {
        &self.from_mirrors
    }

    /// Bodies whose particles fail, are turned inside out or meet others of the same body leave the form after this step.
    /// Returns the factor by which neighbours may be farther apart than they were. Collective.
    pub fn finish(&mut self, comm: &Comm) -> f64 {
        if self.is_empty() {
            return 1.0;
        }
        let words = &mut self.words;
        words.clear();
        words.extend(self.leaving.iter().map(|leaves| leaves.load(Relaxed)));
        words.push(self.farthest.load(Relaxed));
        comm.max_u64(words);
        for (group, &word) in words[..self.others.len()].iter().enumerate() {
            self.leaving[group].store(0, Relaxed);
            if let Some(tear) = Tear::ALL.iter().find(|tear| tear.word() == word) {
                self.others[group] = true;
                self.tears[group] = Some(*tear);
            }
        }
        let square = words.last().map_or(0.0, |&bits| f64::from_bits(bits));
        (0.5 * square.sqrt()).max(1.0) * ROOM
    }

    /// Finds bodies that meet themselves: two particles that began far from each other are closer than two may be, while
    /// both expect the other far away. `lists` are those of all bodies.
    pub fn find_folds(&self, particles: &ParticleStore, lists: &Lists) {
        if self.is_empty() {
            return;
        }
        let (images, motion) = (lists.images(), lists.motion());
        lists.chunks().par_iter().for_each(|chunk| {
            for (cluster, neighbours, _) in chunk.iter() {
                if self.others[cluster.group] {
                    continue;
                }
                let meets = |&place: &u32| {
                    let (own, here) = (images[place as usize], &motion[place as usize]);
                    neighbours.iter().any(|&other| {
                        let there = &motion[other as usize];
                        let apart = minus(&here.position, &there.position);
                        let h = particles.smoothing_length[own.slot()];
                        dot(&apart, &apart) < CLOSE * CLOSE * h * h
                            && self.are_strangers(particles, own, images[other as usize])
                    })
                };
                if cluster.valid().iter().any(meets) {
                    self.leaving[cluster.group].fetch_max(Tear::Fold.word(), Relaxed);
                }
            }
        });
    }

    /// True if two images began far from each other, and the deformation of both would leave them apart.
    fn are_strangers(&self, particles: &ParticleStore, a: Image, b: Image) -> bool {
        let start = |image: Image| {
            let own = &particles.reference_position[image.slot()];
            self.mirrors.reflect_position(own, image.mirror_mask())
        };
        let apart = minus(&start(a), &start(b));
        let h = particles.smoothing_length[a.slot()] + particles.smoothing_length[b.slot()];
        let far = FAR * h;
        let expects = |image: Image| {
            let own = &particles.deformation_gradient[image.slot()];
            let deformation = Mirrors::reflect_tensor(own, image.mirror_mask());
            let row = |a: usize| dot(&[0, 1, 2].map(|b| deformation[3 * a + b]), &apart);
            norm(&[row(0), row(1), row(2)]) > far
        };
        norm(&apart) > far && expects(a) && expects(b)
    }

    /// Deformation gradients of this rank's particles: zero of bodies that have another form, whose fields no step writes.
    #[must_use]
    pub fn gradients(&self, particles: &ParticleStore) -> Vec<[f64; 9]> {
        let gradient = |i: usize| {
            let holds = self.holds(particles.body[i] as usize);
            if holds {
                particles.deformation_gradient[i]
            } else {
                [0.0; 9]
            }
        };
        (0..particles.owned())
            .into_par_iter()
            .map(gradient)
            .collect()
    }

    /// Sorted images and their neighbours in the initial configuration.
    #[must_use]
    pub fn lists(&self) -> &Lists {
        &self.lists
    }

    /// `−Σ_j ½ sym(f_ij ⊗ (x_i − x_j))` (J) of an owned particle by stress, given its place among the images of
    /// [`Self::lists`] and its neighbours there.
    #[must_use]
    pub fn virial(
        &self,
        kernel: &Kernel,
        lengths: &[f64],
        place: u32,
        neighbours: &[u32],
    ) -> Virial {
        let (motion, images) = (self.lists.motion(), self.lists.images());
        let of = |place: u32| (&motion[place as usize], &self.records[place as usize]);
        let h = |place: u32| lengths[images[place as usize].slot()];
        let (start, own) = of(place);
        let mut virial = Virial::default();
        for &other in neighbours {
            let (there, their) = of(other);
            let apart = minus(&start.position, &there.position);
            let distance = norm(&apart);
            let slope = kernel.slope(distance, 0.5 * (h(place) + h(other)));
            if distance == 0.0 || slope == 0.0 {
                continue;
            }
            let r = minus(&own.position, &their.position);
            let weights = start.volume * there.volume * slope;
            let pull = weights * own.pull(their, &apart, &r) / norm(&r);
            let force = std::array::from_fn(|a| {
                let row = |b: usize| (own.stress[3 * a + b] + their.stress[3 * a + b]) * apart[b];
                weights / distance * (row(0) + row(1) + row(2)) + pull * r[a]
            });
            virial.add(&force, &r.map(|x| 0.5 * x));
        }
        virial
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let lists: usize = self.lists.memory_by_part().iter().sum();
        let mirrors: usize = self.from_mirrors.iter().map(FromMirrors::memory).sum();
        lists
            + mirrors
            + self.records.capacity() * size_of::<TotalRecord>()
            + self.initial.capacity() * size_of::<InitialSums>()
            + self.positions.capacity() * size_of::<[f64; 4]>()
    }
}

/// Gradients over the initial neighbours, and where stresses and what they are judged by go.
struct TotalGradients<'a> {
    dimension: usize,
    lists: &'a Lists,
    initial: &'a [InitialSums],
    positions: &'a [[f64; 4]],
    /// Linear coefficient of the artificial viscosity.
    alpha: f64,
    /// Stiffness ξ of the hourglass control.
    stiffness: f64,
    modulus: Scatter<'a, f64>,
    deformation: Scatter<'a, [f64; 9]>,
    records: Scatter<'a, TotalRecord>,
    /// Records by the lists of all bodies, and the places of this rank's particles there, if anybody reads them.
    shown: Option<(Scatter<'a, CorrectedRecord>, &'a [u32])>,
    predicted_density: &'a [f64],
    norm: Scatter<'a, f64>,
    leaving: &'a [AtomicU64],
    farthest: &'a AtomicU64,
}

impl Gradient for TotalGradients<'_> {
    type Show<'b, S: PairScale>
        = ShowTotal<'b>
    where
        Self: 'b;

    #[inline(always)]
    fn of<'b, V: Lanes, S: PairScale>(
        &'b self,
        cluster: &Cluster,
        _: Among,
        around: Neighbourhood<'b, S>,
        _: impl FnOnce() -> u8,
    ) -> ([F64x8; 9], ShowTotal<'b>) {
        let sums = TotalGradient {
            around,
            initial: self.initial,
            positions: self.positions,
            dimension: self.dimension,
        };
        let total = sums.run::<V>();
        let show = ShowTotal {
            target: self,
            group: cluster.group,
            total,
        };
        (total.gradient, show)
    }
}

/// Shows the stresses of a cluster.
struct ShowTotal<'a> {
    target: &'a TotalGradients<'a>,
    group: usize,
    total: Total,
}

impl Show for ShowTotal<'_> {
    #[inline(always)]
    fn set_density(&self, density: &mut [f64; LANES], indices: &[u32; LANES]) {
        for (k, &index) in indices.iter().enumerate() {
            let motion = &self.target.lists.motion()[index as usize];
            let expansion = self.total.determinant.0[k].max(LEAST_DETERMINANT);
            let exact = motion.mass / (motion.volume * expansion);
            // Rates leave what rests as it is, to the bit.
            let is_rounding = (density[k] / exact - 1.0).abs() < LEAST_CHANGE;
            if !is_rounding {
                density[k] = exact;
            }
        }
    }

    #[inline(always)]
    unsafe fn show<V: Lanes>(&self, points: &Updated) {
        let (target, after, total) = (self.target, points.after, &self.total);
        let deviator: [V; 6] = read_all(&after.deviatoric_stress);
        let pressure = V::read(&after.pressure);
        let mut sigma = full(&deviator);
        for a in 0..3 {
            sigma[4 * a] = sigma[4 * a].sub(pressure);
        }
        let stress: [F64x8; 9] = store_all::<V, 9>(&total.apply(&sigma));
        let (mut leaves, mut farthest) = (0, 0.0_f64);
        points.each(|k, i, index| {
            let motion = &target.lists.motion()[index];
            // The volume now, over that at the start.
            let expansion = motion.mass / (target.predicted_density[i] * motion.volume);
            let mut own = [0.0; 9];
            for c in 0..9 {
                own[c] = expansion * stress[c].0[k];
            }
            let viscous_speed = after.viscous_speed(k, total.limiter.linear.0[k]);
            let sound_speed = after.sound_speed[k];
            let state = [after.density[k], sound_speed, viscous_speed, 1.0];
            let expands = total.determinant.0[k];
            let mut deformation = [0.0; 9];
            for c in 0..9 {
                deformation[c] = total.deformation[c].0[k];
            }
            let plastic = after.plastic_strain[k];
            let slips = plastic > SLIPS && plastic > log_ratio(&deformation, total.squeeze.0[k]);
            let torn = [
                (Tear::Failure, after.damage[k] >= FAILED),
                (Tear::Inversion, expands <= LEAST_DETERMINANT),
                (Tear::Slip, slips),
                (Tear::Void, points.limits_tension && expands > TORN),
            ];
            for (tear, is_so) in torn {
                leaves = if is_so {
                    tear.word().max(leaves)
                } else {
                    leaves
                };
            }
            farthest = farthest.max(total.farthest.0[k]);
            // Signals of the linear viscosity are those of its limiter.
            let alpha = 0.6 * target.alpha;
            let speed = (1.0 + alpha * total.limiter.linear.0[k]) / (1.0 + alpha);
            let yields = points.yield_stress;
            let flow = 3.0 * points.shear_modulus * plastic;
            let share = if flow > 0.0 && yields.is_finite() {
                yields / (yields + flow)
            } else {
                1.0
            };
            let wave_modulus = after.density[k] * after.sound_speed[k] * after.sound_speed[k];
            let modulus = 0.5 * target.stiffness * share * wave_modulus;
            let [x, y, z, _] = target.positions[index];
            // SAFETY: by the contract of this function.
            unsafe {
                let record = CorrectedRecord::new(&own, &[0.0; 3], 0.0, state);
                *target.records.slot(index) = TotalRecord {
                    stress: record.stress,
                    hourglass: modulus,
                    density: record.density,
                    viscous_speed: record.viscous_speed,
                    position: [x, y, z],
                    half_deformation: half(&deformation),
                };
                *target.modulus.slot(i) = modulus;
                *target.deformation.slot(i) = deformation;
                if let Some((shown, places)) = &target.shown {
                    *shown.slot(places[i] as usize) = record;
                }
                *target.norm.slot(i) = (total.squeeze.0[k] * speed).max(1.0);
            }
        });
        if leaves > 0 {
            target.leaving[self.group].fetch_max(leaves, Relaxed);
        }
        // Bits of positive numbers are in their order.
        target.farthest.fetch_max(farthest.to_bits(), Relaxed);
    }
}

/// Half a matrix.
#[inline(always)]
fn half(matrix: &[f64; 9]) -> [f64; 9] {
    let mut half = *matrix;
    for component in &mut half {
        *component *= 0.5;
    }
    half
}

/// Logarithm of the largest stretch of a deformation gradient over its smallest, given the inverse of that; up to ln √3 larger.
fn log_ratio(deformation: &[f64; 9], squeeze: f64) -> f64 {
    let square: f64 = deformation.iter().map(|c| c * c).sum();
    libm::log(square.sqrt() * squeeze)
}
