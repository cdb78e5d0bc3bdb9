//! Plates: hole, lips, bulge, what has left it, and the verdict.

use std::f64::consts::PI;

use super::attached::Attached;
use super::figure::{Figure, Findings};
use super::frame::sector;
use super::mask::{Mask, diameter};
use super::matter::{Matter, raise};
use super::remains::{Belongs, Remains};
use comm::Comm;
use model::{NumericalLimits, Slab};
use numerics::vector::dot;

/// A gap or a flying piece counts if it is this many voxels wide, a hole if it is wider.
const LEAST: f64 = 2.0;

/// A pinhole is decided where it is this many voxels wide.
const DECIDED: f64 = 4.0;

/// Sectors about the hole in which lips are looked for.
const SECTORS: usize = 48;

/// Lips are told where they stand around this part of the hole.
const LEAST_AROUND: f64 = 0.25;

/// Lips are looked for as far as this many radii of the hole.
const FARTHEST: f64 = 3.0;

/// Nothing acts on a plate whose parts move and press less than this over the natural speed of the case, and the stress
/// of a wave with that speed.
const STILL: f64 = 1e-6;

/// A plate that has this kinetic energy density over its yield stress, and so may stretch as much, still moves.
const STRETCHES: f64 = 0.01;

/// Fate of a plate, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// A rod passes it, or what struck it is behind it.
    Perforated,
    /// Matter of the plate has left its rear side.
    DetachedSpall,
    /// A way leads through it that is no wider than voxels can tell.
    Pinhole,
    /// There is a gap inside, and what lies behind it has not left.
    AttachedSpall,
    /// Nothing has acted on it yet.
    NotLoaded,
    /// It goes on to the rear faster than its strength stops at once.
    StillMoving,
    /// None of these.
    Held,
}

impl Verdict {
    /// Its word in tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Perforated => "perforated",
            Self::DetachedSpall => "detached spall",
            Self::Pinhole => "pinhole",
            Self::AttachedSpall => "attached spall",
            Self::NotLoaded => "not_loaded",
            Self::StillMoving => "still_moving",
            Self::Held => "held",
        }
    }
}

/// Masses (kg) of the whole that have left a plate or passed it.
struct Left {
    front: f64,
    rear: f64,
    /// Mass within a voxel of what remains.
    doubtful: f64,
    /// Mass of what struck that is behind the plate and has not flown past its rim.
    passed: f64,
    /// Largest speed (m/s) of what remains towards the rear.
    speed: f64,
}

impl Left {
    fn find(slab: &Slab, remains: &Remains, matter: &Matter, comm: &Comm) -> Self {
        let middle = 0.5 * (slab.front + slab.rear);
        let behind = slab.rear - slab.spacing;
        let footprint = remains.footprint(slab, matter);
        let sums = matter.sums::<4>(comm, |i, sums| {
            let (body, mass, x) = (matter.body_of(i), matter.mass[i], &matter.position[i]);
            if body != slab.body {
                let passed = slab.before.contains(&body)
                    && remains.height(x) < behind
                    && remains.is_behind(x)
                    && footprint.let_through(x, &matter.velocity[i]);
                if passed {
                    sums.add(&[0.0, 0.0, 0.0, mass]);
                }
                return;
            }
            match remains.holds(i) {
                Belongs::Yes => {}
                Belongs::Nearly => sums.add(&[0.0, 0.0, mass, 0.0]),
                // What lies in the crater of a plate that is bent has not left to the rear.
                Belongs::No if remains.height(x) <= middle && remains.is_behind(x) => {
                    sums.add(&[0.0, mass, 0.0, 0.0]);
                }
                Belongs::No => sums.add(&[mass, 0.0, 0.0, 0.0]),
            }
        });
        let [speed] = matter.largest::<1>(comm, |i, most| {
            let is_its = matter.body_of(i) == slab.body;
            if is_its && remains.holds(i) == Belongs::Yes {
                raise(&mut most[0], -dot(&slab.normal, &matter.velocity[i]));
            }
        });
        let whole = super::Whole::new(&matter.mirrors);
        let [front, rear, doubtful, passed] = sums.map(|sum| whole.sum(sum));
        Self {
            front,
            rear,
            doubtful,
            passed,
            speed: speed.max(0.0),
        }
    }
}

/// Motion of what remains of a plate, against its mean velocity.
struct Motion {
    /// True if nothing has acted on it.
    rests: bool,
    /// Mean speed (m/s) towards the rear, by kinetic energy.
    speed: f64,
    /// Mass (kg) of the whole that has as much kinetic energy at that speed.
    mass: f64,
    /// Its kinetic energy density over the yield stress: the stretch that may still come.
    stretch: f64,
    /// Time (s) in which the yield stress about its rim stops the moving part; not a number where there is none.
    settling: f64,
}

impl Motion {
    fn find(slab: &Slab, remains: &Remains, matter: &Matter, comm: &Comm) -> Self {
        let is_its = |i: usize| matter.body_of(i) == slab.body && remains.holds(i) == Belongs::Yes;
        let rearwards = |i: usize| -dot(&slab.normal, &matter.velocity[i]);
        let [mass, momentum] = matter.sums::<2>(comm, |i, sums| {
            if is_its(i) {
                sums.add(&[matter.mass[i], matter.mass[i] * rearwards(i)]);
            }
        });
        let mean = momentum / mass;
        let [energy, flow] = matter.sums::<2>(comm, |i, sums| {
            let w = rearwards(i) - mean;
            if is_its(i) && w > 0.0 {
                let m = matter.mass[i] * w * w;
                sums.add(&[m, m * w]);
            }
        });
        let [faster, slower, pressure] = matter.largest::<3>(comm, |i, most| {
            if is_its(i) {
                raise(&mut most[0], rearwards(i));
                raise(&mut most[1], -rearwards(i));
                raise(&mut most[2], matter.pressure[i].abs());
            }
        });
        let material = &matter.case.materials[matter.case.bodies[slab.body].material];
        let still = STILL * NumericalLimits::natural_speed(matter.case);
        let wave = material.reference_density * material.longitudinal_speed() * still;
        let has_flowed = material.shows_flow() && remains.attached().is_some();
        let rests = !has_flowed && faster + slower <= still && pressure <= wave;
        if !(energy > 0.0 && material.strength.yields()) {
            return Self {
                rests,
                speed: 0.0,
                mass: 0.0,
                stretch: 0.0,
                settling: f64::NAN,
            };
        }
        let speed = flow / energy;
        let density = matter.case.density_of(slab.body);
        let strength = material.strength.yield_stress();
        // A plug of the moving mass, or a strip of it in the plane, which its rim shears at Y/√3.
        let mass = super::Whole::new(&matter.mirrors).sum(energy / (speed * speed));
        let area = mass / (density * slab.thickness());
        let arm = match matter.case.dimension {
            3 => 0.5 * (area / PI).sqrt(),
            2 => 0.5 * area,
            _ => f64::NAN,
        };
        Self {
            rests,
            speed,
            mass,
            stretch: 0.5 * density * speed * speed / strength,
            settling: 3.0_f64.sqrt() * density * arm * speed / strength,
        }
    }

    /// True if it goes on, and more of it than a mass (kg).
    fn goes_on(&self, least: f64) -> bool {
        self.mass >= least && self.stretch > STRETCHES && self.settling.is_finite()
    }
}

/// Inner and outer diameter (m) of a lip.
struct Lip {
    inner: f64,
    outer: f64,
}

impl Lip {
    const NONE: Self = Self {
        inner: f64::NAN,
        outer: f64::NAN,
    };

    /// About a hole, of cells with matter beyond a face.
    fn about(hole: &Mask, raised: &Mask, attached: &Attached) -> Self {
        let edge = attached.window.edge;
        let across = attached.window.counts[1];
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        let place = |cell: usize| [(cell / across) as f64, (cell % across) as f64];
        #[expect(clippy::cast_precision_loss, reason = "counts are small")]
        let count = hole.count() as f64;
        let middle: [f64; 2] =
            std::array::from_fn(|a| hole.cells().map(|cell| place(cell)[a]).sum::<f64>() / count);
        let farthest = FARTHEST * (count / PI).sqrt() + 2.0 * LEAST;
        // Distances of raised cells by sector, in cells.
        let mut sectors = vec![Vec::new(); SECTORS];
        for cell in raised.cells() {
            let [x, y] = place(cell);
            let (x, y) = (x - middle[0], y - middle[1]);
            let distance = libm::hypot(x, y);
            if distance <= farthest {
                sectors[sector(x, y, SECTORS)].push(distance);
            }
        }
        let (mut inner, mut outer, mut found) = (0.0, 0.0, 0.0);
        for distances in &mut sectors {
            distances.sort_by(f64::total_cmp);
            let Some(&first) = distances.first() else {
                continue;
            };
            // Up to where there is none for two cells.
            let mut last = first;
            for &distance in distances.iter() {
                if distance > last + LEAST {
                    break;
                }
                last = distance;
            }
            inner += first - 0.5;
            outer += last + 0.5;
            found += 1.0;
        }
        #[expect(clippy::cast_precision_loss, reason = "small")]
        let around = found / SECTORS as f64;
        if around < LEAST_AROUND {
            return Self::NONE;
        }
        Self {
            inner: 2.0 * edge * inner / found,
            outer: 2.0 * edge * outer / found,
        }
    }
}

/// Shape of a plate by its window.
struct Shape {
    /// True if a way leads through it.
    open: bool,
    /// Diameter (m) of the largest rod along the normal that passes; zero unless it is open.
    hole: f64,
    /// Diameters (m) of circles with the area of what one sees through, and of what is open half way between the
    /// faces; zero unless it is open. The latter is not a number where most of that is a plate that has bent away.
    opening: f64,
    middle: f64,
    lips: [Lip; 2],
    /// Greatest heights (m) beyond the front and the rear face.
    heights: [f64; 2],
    /// Greatest way (m) of both faces of a column to the rear.
    dish: f64,
    parted: bool,
    edge: f64,
}

impl Shape {
    fn of(slab: &Slab, attached: &Attached) -> Self {
        let edge = attached.window.edge;
        let is_open = attached.is_open();
        let open = attached.open();
        let rod = open.inside().largest_disc();
        let hole = open.largest_inside();
        let middle = 0.5 * (slab.front + slab.rear);
        let bent_by = |[low, high]: [f64; 2]| f64::min(slab.rear - low, slab.front - high);
        let at_middle = attached.open_between(middle, middle).largest_inside();
        let ends: Vec<_> = attached.ends().collect();
        let half = 0.5 * (slab.front - slab.rear);
        let has_left = |&cell: &usize| ends[cell].is_some_and(|ends| bent_by(ends) > half);
        let left_middle = at_middle.cells().filter(has_left).count();
        // What is open there and not inside the plate reaches beyond what is looked at: the plate has bent away.
        let (above, below) = (slab.front + 0.25 * edge, slab.rear - 0.25 * edge);
        let raised = [
            attached.filled_between(above, f64::MAX),
            attached.filled_between(f64::MIN, below),
        ];
        let width = |cells: usize| {
            if is_open { diameter(cells, edge) } else { 0.0 }
        };
        let opening = width(hole.count());
        let lips = raised.map(|raised| {
            if opening > LEAST * edge {
                Lip::about(&hole, &raised, attached)
            } else {
                Lip::NONE
            }
        });
        let [front, rear, dish] = ends.iter().copied().flatten().fold(
            [0.0; 3],
            |[front, rear, dish]: [f64; 3], [low, high]| {
                [
                    front.max(high - slab.front),
                    rear.max(slab.rear - low),
                    dish.max(bent_by([low, high])),
                ]
            },
        );
        let wide = |mask: &Mask| diameter(mask.largest_part().count(), edge) >= LEAST * edge;
        Self {
            open: is_open,
            hole: width(rod),
            opening,
            middle: if is_open
                && (at_middle.count() < hole.count() || 2 * left_middle > at_middle.count())
            {
                f64::NAN
            } else {
                width(at_middle.count())
            },
            lips,
            heights: [front, rear],
            dish,
            parted: wide(&attached.parted()),
            edge,
        }
    }

    /// Of a plate in which nothing has flowed.
    fn untouched(slab: &Slab) -> Self {
        Self {
            open: false,
            hole: 0.0,
            opening: 0.0,
            middle: 0.0,
            lips: [Lip::NONE, Lip::NONE],
            heights: [0.0; 2],
            dish: 0.0,
            parted: false,
            edge: slab.spacing,
        }
    }
}

/// The measures of a plate. Collective.
pub fn plate(slab: &Slab, remains: &Remains, matter: &Matter, comm: &Comm) -> Findings {
    let shape = match remains.attached() {
        Some(attached) => Shape::of(slab, attached),
        None => Shape::untouched(slab),
    };
    let left = Left::find(slab, remains, matter, comm);
    let density = matter.case.density_of(slab.body);
    let least = density * (LEAST * shape.edge).powi(3);
    let motion = Motion::find(slab, remains, matter, comm);
    let verdict = if shape.hole > LEAST * shape.edge || left.passed >= least {
        Verdict::Perforated
    } else if left.rear >= least {
        Verdict::DetachedSpall
    } else if shape.open {
        Verdict::Pinhole
    } else if shape.parted {
        Verdict::AttachedSpall
    } else if motion.rests {
        Verdict::NotLoaded
    } else {
        Verdict::Held
    };
    // What may still get worse is no verdict.
    let may_fail = verdict == Verdict::Held || verdict == Verdict::AttachedSpall;
    let verdict = if may_fail && motion.goes_on(least) {
        Verdict::StillMoving
    } else {
        verdict
    };
    let length = |name, value: f64| Figure::number(name, value, "m").within(shape.edge);
    let mass = |name, value: f64| Figure::number(name, value, "kg");
    let [front, rear] = &shape.lips;
    // Of a way that is nowhere straight half of this run's. What has left besides does not decide it.
    let deciding = match (shape.open, verdict) {
        (false, _) | (true, Verdict::Perforated) => f64::NAN,
        (true, _) if shape.hole > 0.0 => shape.hole / DECIDED,
        (true, _) => 0.5 * shape.edge,
    };
    let (behind, stray) = if left.rear < least {
        (0.0, left.rear)
    } else {
        (left.rear, 0.0)
    };
    Findings {
        figures: vec![
            Figure::word("verdict", verdict.word()),
            length("hole_diameter", shape.hole),
            length("opening_diameter", shape.opening),
            length("mid_plane_hole_diameter", shape.middle),
            Figure::number("deciding_spacing", deciding, "m"),
            length("front_lip_inner_diameter", front.inner),
            length("front_lip_outer_diameter", front.outer),
            length("rear_lip_inner_diameter", rear.inner),
            length("rear_lip_outer_diameter", rear.outer),
            length("front_height", shape.heights[0]),
            length("rear_height", shape.heights[1]),
            length("dish_depth", shape.dish),
            mass("front_mass", left.front),
            mass("rear_mass", behind).within(stray),
            mass("removed_mass", left.front + left.rear).within(left.doubtful),
            mass("passed_mass", left.passed),
            Figure::number("rear_speed", left.speed, "m/s"),
            Figure::number("moving_speed", motion.speed, "m/s"),
            Figure::number("settling_time", motion.settling, "s"),
        ],
        distributions: Vec::new(),
    }
}
