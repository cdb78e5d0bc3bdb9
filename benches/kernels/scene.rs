//! The block: particles as the engine sorts and lists them.

use engine::contact::{ContactTable, ContactView};
use files::input;
use model::Case;
use numerics::lanes::LANES;
use particles::neighbours::MotionRecord;
use particles::neighbours::{
    Chunk, ClusterLists, ColumnGrid, ForeignLists, ImageFacts, ImageState, Lengths, Sequence,
};
use particles::{Image, Inactive, ParticleStore};

/// Particles along an edge.
const EDGE: u32 = 48;
pub const COUNT: usize = (EDGE * EDGE * EDGE) as usize;
/// Particle spacing (m).
const SPACING: f64 = 2e-5;
/// Smoothing length (m).
pub const LENGTH: f64 = 1.3 * SPACING;
/// Density of aluminium 2024 (kg/m³).
pub const DENSITY: f64 = 2785.0;

/// Two halves of the block, which touch.
const CASE: &str = r#"
dimension = 3
spacing = "0.02 mm"

[run]
end_time = "1 s"

[sph]
smoothing = 1.3

[material.aluminium]
library = "aluminium-2024"

[[body]]
name = "left"
material = "aluminium"
shape.box = { lower = [0, 0, 0], upper = ["0.48 mm", "0.96 mm", "0.96 mm"] }

[[body]]
name = "right"
material = "aluminium"
shape.box = { lower = ["0.48 mm", 0, 0], upper = ["0.96 mm", "0.96 mm", "0.96 mm"] }

[contact]
mode = "overlap"
"#;

pub fn case() -> Case {
    input::parse("bench", CASE, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Particles, sorted and listed.
pub struct Scene {
    pub particles: ParticleStore,
    pub sequence: Sequence,
    scratch: Vec<u64>,
    clusters: ClusterLists,
    pub motion: Vec<MotionRecord>,
}

impl Scene {
    /// The block as one body or as two halves, each a group of its own.
    pub fn new(bodies: u32) -> Self {
        let mut particles = ParticleStore::default();
        particles.resize_owned(COUNT);
        for (i, site) in (0..EDGE * EDGE * EDGE).enumerate() {
            particles.id[i] = u64::from(site);
            particles.body[i] = site % EDGE * bodies / EDGE;
            particles.mass[i] = DENSITY * SPACING.powi(3);
            particles.position[i] = index(site);
        }
        let side = f64::from(EDGE) * SPACING;
        let grid = ColumnGrid::new([0.0; 3], [side; 3], SPACING, 0);
        let mut scene = Self {
            particles,
            sequence: Sequence::new((0..bodies).map(|_| grid.clone()), true),
            scratch: vec![0; Sequence::SCRATCH_WORDS * COUNT],
            clusters: ClusterLists::default(),
            motion: Vec::new(),
        };
        scene.sort();
        scene.list();
        let sorted = scene.sequence.images().iter();
        let motions = sorted.map(|image| motion(&scene.particles.position[image.slot()]));
        scene.motion = motions.collect();
        scene
    }

    pub fn sort(&mut self) {
        let particles = &self.particles;
        let facts = |image: Image| ImageFacts {
            position: particles.position[image.slot()],
            id: particles.id[image.slot()],
            group: particles.body[image.slot()] as usize,
            smoothing_length: LENGTH,
        };
        let scratch = &mut self.scratch;
        self.sequence.build(
            scratch,
            (COUNT, &Inactive::default()),
            (&[], 0),
            facts,
            |_, _| ImageState {
                moving: true,
                resting: false,
            },
        );
    }

    pub fn list(&mut self) {
        let lengths = Lengths {
            longest: LENGTH,
            least: 0.0,
            stretch: 1.0,
            uniform: true,
            rigid: false,
        };
        self.clusters
            .build(&self.sequence, &[lengths; 2], (None, true));
    }

    pub fn list_foreign(&self, table: &ContactTable, foreign: &mut ForeignLists) {
        let (images, body) = (self.sequence.images(), &self.particles.body);
        let body_of = |index: u32| body[images[index as usize].slot()] as usize;
        foreign.build(
            &self.clusters,
            &self.sequence,
            &self.motion,
            &table.foreign,
            body_of,
        );
    }

    /// Calls `work` with the receivers and the neighbours of each cluster.
    pub fn sweep(&self, mut work: impl FnMut([u32; LANES], &[u32])) {
        for (cluster, neighbours, _) in self.clusters.chunks().iter().flat_map(Chunk::iter) {
            work(cluster.receivers, neighbours);
        }
    }

    pub fn contact<'a>(&'a self, table: &'a ContactTable) -> ContactView<'a> {
        ContactView {
            images: self.sequence.images(),
            motion: &self.motion,
            particles: &self.particles,
            table,
            dt: 0.0,
        }
    }
}

/// A site of the lattice, off by up to a tenth of the spacing along each axis (m).
fn index(site: u32) -> [f64; 3] {
    let sites = [site % EDGE, site / EDGE % EDGE, site / EDGE / EDGE];
    let mut axis = 0;
    sites.map(|along| {
        axis += 1;
        (f64::from(along) + 0.5 + 0.1 * noise(3 * site + axis)) * SPACING
    })
}

/// A number of −1..1 that looks random.
pub fn noise(k: u32) -> f64 {
    f64::from(k.wrapping_mul(0x9e37_79b9) >> 8) / f64::from(1 << 23) - 1.0
}

fn motion(position: &[f64; 3]) -> MotionRecord {
    MotionRecord {
        position: *position,
        velocity: position.map(|x| -1e6 * x),
        volume: SPACING.powi(3),
        mass: DENSITY * SPACING.powi(3),
    }
}
