//! Random clouds of particles with their mirror images, sorted and listed by the engine.

use std::sync::atomic::{AtomicU32, Ordering};

use model::{Axis, SymmetryPlane};
use particles::neighbours::MotionRecord;
use particles::neighbours::{ClusterLists, ColumnGrid, ImageFacts, ImageState, Lengths, Sequence};
use particles::{Image, Inactive, MirrorMask, Mirrors};

use crate::common::random::Random;

/// What a cloud is made of.
#[derive(Debug, Clone, Copy)]
pub struct Recipe {
    pub seed: u64,
    pub dimension: usize,
    pub particles: usize,
    /// Bodies; body b belongs to group b/2.
    pub bodies: usize,
    /// Symmetry planes x = 0, y = 0, z = 0 among the first so many axes.
    pub planes: usize,
    /// Largest over smallest smoothing length.
    pub spread: f64,
    /// Particles that have flown far away.
    pub runaways: usize,
    /// Axis along the columns.
    pub along: usize,
}

/// Particles of several bodies on a jittered lattice of spacing 1, in no order. The last fifth
/// are halo particles.
#[derive(Clone)]
pub struct Cloud {
    pub dimension: usize,
    pub owned: usize,
    pub id: Vec<u64>,
    pub body: Vec<usize>,
    pub position: Vec<[f64; 3]>,
    pub velocity: Vec<[f64; 3]>,
    pub smoothing_length: Vec<f64>,
    pub mirrors: Mirrors,
    pub grids: Vec<ColumnGrid>,
}

/// What the engine makes of a cloud.
pub struct Found {
    pub sequence: Sequence,
    pub motion: Vec<MotionRecord>,
    pub clusters: ClusterLists,
}

/// A small cloud of three bodies, two particles of which have flown away.
pub fn small(dimension: usize, spread: f64, planes: usize, seed: u64) -> Cloud {
    Cloud::new(&Recipe {
        seed,
        dimension,
        particles: [60, 150, 260][dimension - 1],
        bodies: 3,
        planes,
        spread,
        runaways: 2,
        along: 0,
    })
}

impl Cloud {
    pub fn new(recipe: &Recipe) -> Self {
        let mut random = Random::new(recipe.seed);
        let dimension = recipe.dimension;
        #[allow(clippy::cast_precision_loss, reason = "few particles")]
        let edge = (recipe.particles as f64)
            .powf(1.0 / dimension as f64)
            .ceil();
        let mut position = Vec::new();
        for k in 0..recipe.particles {
            #[allow(clippy::cast_precision_loss, reason = "few particles")]
            let mut rest = k as f64;
            position.push(std::array::from_fn(|a| {
                if a >= dimension {
                    return 0.0;
                }
                let site = rest % edge;
                rest = (rest / edge).floor();
                site + random.within(0.1, 0.9)
            }));
        }
        for _ in 0..recipe.runaways {
            let far = 10.0_f64.powf(random.within(0.0, 6.0)) * edge;
            let who = random.below(recipe.particles);
            position[who] = random.vector(dimension, far);
            for x in &mut position[who][..recipe.planes] {
                *x = x.abs();
            }
        }
        random.shuffle(&mut position);
        let planes: Vec<SymmetryPlane> = Axis::ALL[..recipe.planes]
            .iter()
            .map(|&axis| SymmetryPlane {
                axis,
                position: 0.0,
            })
            .collect();
        let upper = std::array::from_fn(|a| if a < dimension { edge } else { 0.0 });
        let groups = recipe.bodies.div_ceil(2);
        let mut id: Vec<u64> = (0..recipe.particles as u64).map(|k| 3 * k + 1).collect();
        random.shuffle(&mut id);
        Self {
            dimension,
            owned: recipe.particles - recipe.particles / 5,
            body: (0..recipe.particles)
                .map(|_| random.below(recipe.bodies))
                .collect(),
            smoothing_length: (0..recipe.particles)
                .map(|_| random.within(1.3, 1.3 * recipe.spread))
                .collect(),
            velocity: (0..recipe.particles)
                .map(|_| random.vector(dimension, 1.0))
                .collect(),
            id,
            position,
            mirrors: Mirrors::new(&planes),
            grids: (0..groups)
                .map(|_| ColumnGrid::new([0.0; 3], upper, 1.0, recipe.along))
                .collect(),
        }
    }

    pub fn group(&self, particle: usize) -> usize {
        self.body[particle] / 2
    }

    /// All particles and, behind each plane that is near enough to matter, their images.
    pub fn images(&self) -> Vec<Image> {
        let farthest = self.smoothing_length.iter().copied().fold(0.0, f64::max);
        let mut images: Vec<Image> = (0..self.id.len())
            .map(|i| Image::new(i, MirrorMask::OWN))
            .collect();
        for (i, position) in self.position.iter().enumerate() {
            let near = self.mirrors.near(position, 2.0 * farthest);
            let masks = near.subsets(false);
            images.extend(masks.map(|mirror_mask| Image::new(i, mirror_mask)));
        }
        images
    }

    pub fn place(&self, image: Image) -> [f64; 3] {
        self.mirrors
            .reflect_position(&self.position[image.slot()], image.mirror_mask())
    }

    pub fn find(&self) -> Found {
        let mut sequence = Sequence::new(self.grids.clone(), false);
        let facts = |image: Image| ImageFacts {
            position: self.place(image),
            id: self.id[image.slot()],
            group: self.group(image.slot()),
            smoothing_length: self.smoothing_length[image.slot()],
        };
        let others: Vec<Image> = self.images().split_off(self.owned);
        let emitted: Vec<AtomicU32> = std::iter::repeat_with(AtomicU32::default)
            .take(self.owned + others.len())
            .collect();
        let mut scratch = vec![0; Sequence::SCRATCH_WORDS * emitted.len()];
        let others = (&others[..], others.len() / 3);
        let inactive = Inactive::default();
        let owned = (self.owned, &inactive);
        sequence.build(&mut scratch, owned, others, facts, |place, image| {
            emitted[place].fetch_add(1, Ordering::Relaxed);
            ImageState {
                moving: self.velocity[image.slot()] != self.velocity[0],
                resting: false,
            }
        });
        assert!(emitted.iter().all(|n| n.load(Ordering::Relaxed) == 1));
        let motion: Vec<MotionRecord> = sequence
            .images()
            .iter()
            .map(|&image| MotionRecord {
                position: self.place(image),
                velocity: Mirrors::reflect_vector(
                    &self.velocity[image.slot()],
                    image.mirror_mask(),
                ),
                volume: 1.0,
                mass: 1.0,
            })
            .collect();
        let lengths: Vec<Lengths> = (0..sequence.groups())
            .map(|group| {
                let all = || {
                    sequence.smoothing_lengths()[sequence.group(group)]
                        .iter()
                        .copied()
                };
                let longest = all().fold(0.0, f64::max);
                Lengths {
                    longest,
                    least: 0.0,
                    stretch: 1.0,
                    uniform: all().all(|h| h == longest),
                    rigid: false,
                }
            })
            .collect();
        let mut clusters = ClusterLists::default();
        clusters.build(&sequence, &lengths, (None, true));
        Found {
            sequence,
            motion,
            clusters,
        }
    }

    /// The same particles, stored in another order.
    pub fn permuted(&self, random: &mut Random) -> Self {
        let mut order: Vec<usize> = (0..self.id.len()).collect();
        let (owned, halo) = order.split_at_mut(self.owned);
        random.shuffle(owned);
        random.shuffle(halo);
        Self {
            id: order.iter().map(|&k| self.id[k]).collect(),
            body: order.iter().map(|&k| self.body[k]).collect(),
            position: order.iter().map(|&k| self.position[k]).collect(),
            velocity: order.iter().map(|&k| self.velocity[k]).collect(),
            smoothing_length: order.iter().map(|&k| self.smoothing_length[k]).collect(),
            ..self.clone()
        }
    }
}

impl Found {
    /// (id, mirror mask) of the images in canonical order.
    pub fn names(&self, cloud: &Cloud) -> Vec<(u64, MirrorMask)> {
        let images = self.sequence.images().iter();
        images
            .map(|image| (cloud.id[image.slot()], image.mirror_mask()))
            .collect()
    }
}
