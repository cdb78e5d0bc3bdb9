//! Elastic waves along a row of bars in uniaxial strain, exact, by characteristics.
//!
//! In each bar `ρ ∂v/∂t = ∂σ/∂X`, `∂σ/∂t = M ∂v/∂X` (small strain, tension positive) carry the
//! invariants `r = v − σ/Z` to the right and `l = v + σ/Z` to the left, unchanged, at
//! `c = √(M/ρ)`; `Z = ρ c`. So the whole solution follows from what each end of each bar sends
//! into it as a function of time, and as velocities are given as steps, that is a step function:
//! a list of times and values. Every end answers to what arrives:
//!
//! | | condition | sends |
//! |---|---|---|
//! | free | σ = 0 | what arrives |
//! | moved | v = V(t) | 2 V − what arrives |
//! | bonded, or contact while it presses | v and σ common | `v = (Z_a r + Z_b l)/(Z_a + Z_b)`, `σ = Z_a Z_b (l − r)/(Z_a + Z_b)` |
//! | contact that would pull, or is open | σ = 0 | what arrives |
//!
//! An open contact closes when the gap between its faces, the integral of the difference of
//! their velocities, is used up. Nothing is approximated but for round-off.
//!
//! Source of the method: any text on waves in bars, as Graff (1975), *Wave Motion in Elastic
//! Solids*, §2.

mod solver;

pub use exact::bars::End;

use super::steps::Steps;
use solver::Solver;

/// Times closer than this share of the shortest transit are one event, values closer than this
/// share of the largest are the same: far above round-off, far below what anyone reads off.
const ROUND_OFF: f64 = 1e-12;

/// A homogeneous bar, at rest in its stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// p-wave modulus M (Pa).
    pub modulus: f64,
    /// Density ρ (kg/m³).
    pub density: f64,
    /// Coordinate of the left end at the start (m).
    pub left: f64,
    /// Length (m).
    pub length: f64,
    /// Velocity at the start (m/s).
    pub velocity: f64,
}

impl Bar {
    /// Wave speed c (m/s).
    #[must_use]
    pub fn wave_speed(&self) -> f64 {
        (self.modulus / self.density).sqrt()
    }

    /// Impedance Z = ρ c (Pa s/m).
    #[must_use]
    pub fn impedance(&self) -> f64 {
        (self.modulus * self.density).sqrt()
    }

    /// Time that a wave takes from end to end (s).
    #[must_use]
    pub fn transit(&self) -> f64 {
        self.length / self.wave_speed()
    }
}

/// How neighbouring bars meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Joint {
    /// For ever.
    Bonded,
    /// Without tension: they separate, and close again when their faces meet.
    Contact,
}

/// The row at the start: bars from left to right, as many joints as pairs of neighbours.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Bars; between the faces of neighbours in contact there may be a gap.
    pub bars: Vec<Bar>,
    /// What is between them.
    pub joints: Vec<Joint>,
    /// The outer ends, left and right.
    pub ends: [End; 2],
}

/// Velocity (m/s) and stress (Pa, tension positive).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Velocity (m/s).
    pub velocity: f64,
    /// Stress along the bar, tension positive (Pa).
    pub stress: f64,
}

/// A stretch of a bar in one state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Index of the bar.
    pub bar: usize,
    /// Where it begins, in coordinates of the start (m).
    pub from: f64,
    /// Where it ends, in coordinates of the start (m).
    pub to: f64,
    /// Its state.
    pub state: State,
}

/// What a joint does from some time on, until the next entry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// From this time on (s).
    pub time: f64,
    /// Velocities of the left and the right face (m/s).
    pub velocities: [f64; 2],
    /// Common stress, tension positive (Pa).
    pub stress: f64,
    /// Gap between the faces at `time` (m).
    pub gap: f64,
}

/// The motion of a row until some time.
#[derive(Debug, Clone, PartialEq)]
pub struct Waves {
    bars: Vec<Bar>,
    /// For each bar, what its left end sends to the right and its right end to the left.
    sent: Vec<[Steps; 2]>,
    /// For each joint.
    links: Vec<Vec<Link>>,
}

impl Waves {
    /// Follows a row until `until` (s).
    ///
    /// # Panics
    /// If there is no bar, the joints are not one fewer than the bars, or a length, density or
    /// modulus is not positive.
    #[must_use]
    pub fn new(row: &Row, until: f64) -> Self {
        assert_eq!(row.joints.len() + 1, row.bars.len(), "a joint between bars");
        for bar in &row.bars {
            let sizes = [bar.modulus, bar.density, bar.length];
            assert!(sizes.iter().all(|&s| s > 0.0), "a bar without size");
        }
        Solver::new(row).run(until)
    }

    /// The state of a bar at `x` (m from its left end, in coordinates of the start) and time `t`
    /// (s), up to the time that was asked for.
    #[must_use]
    pub fn at(&self, bar: usize, x: f64, t: f64) -> State {
        let [from_left, from_right] = &self.sent[bar];
        let b = &self.bars[bar];
        let c = b.wave_speed();
        state(
            b,
            from_left.at(t - x / c),
            from_right.at(t - (b.length - x) / c),
        )
    }

    /// Displacement of a point of a bar (m); arguments as of [`Self::at`].
    #[must_use]
    pub fn displacement(&self, bar: usize, x: f64, t: f64) -> f64 {
        let [from_left, from_right] = &self.sent[bar];
        let b = &self.bars[bar];
        let delays = [x, b.length - x].map(|way| way / b.wave_speed());
        let right = from_left.integral(-delays[0], t - delays[0]);
        let left = from_right.integral(-delays[1], t - delays[1]);
        0.5 * (right + left)
    }

    /// All bars at time `t` (s), from left to right, in stretches of one state.
    #[must_use]
    pub fn profile(&self, t: f64) -> Vec<Piece> {
        let mut fragments: Vec<Piece> = Vec::new();
        for (k, bar) in self.bars.iter().enumerate() {
            let edges = self.fronts(k, t);
            let first = fragments.len();
            for ends in edges.windows(2) {
                let state = self.at(k, 0.5 * (ends[0] + ends[1]), t);
                let to = bar.left + ends[1];
                match fragments[first..].last_mut() {
                    Some(last) if last.state == state => last.to = to,
                    _ => fragments.push(Piece {
                        bar: k,
                        from: bar.left + ends[0],
                        to,
                        state,
                    }),
                }
            }
        }
        fragments
    }

    /// Mean velocity of a bar (m/s) at time `t` (s).
    #[must_use]
    pub fn mean_velocity(&self, bar: usize, t: f64) -> f64 {
        let fragments = self.profile(t).into_iter().filter(|p| p.bar == bar);
        let moved: f64 = fragments.map(|p| (p.to - p.from) * p.state.velocity).sum();
        moved / self.bars[bar].length
    }

    /// Kinetic and strain energy of all bars (J/m²) at time `t` (s).
    #[must_use]
    pub fn energies(&self, t: f64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for piece in self.profile(t) {
            let (bar, length) = (&self.bars[piece.bar], piece.to - piece.from);
            sums[0] += 0.5 * length * bar.density * piece.state.velocity * piece.state.velocity;
            sums[1] += 0.5 * length * piece.state.stress * piece.state.stress / bar.modulus;
        }
        sums
    }

    /// What a joint did, in order of time; the first entry is the start.
    #[must_use]
    pub fn joint(&self, joint: usize) -> &[Link] {
        &self.links[joint]
    }

    /// When a joint that has pressed parts for the first time (s), if it does.
    #[must_use]
    pub fn separation(&self, joint: usize) -> Option<f64> {
        let pressed = self.links[joint].iter().skip_while(|l| l.stress >= 0.0);
        let parted = pressed.into_iter().find(|l| l.stress >= 0.0);
        parted.map(|link| link.time)
    }

    /// Distances of all fronts and both ends of a bar from its left end (m), sorted.
    fn fronts(&self, bar: usize, t: f64) -> Vec<f64> {
        let b = &self.bars[bar];
        let tiny = ROUND_OFF * b.length;
        let inside = |x: &f64| *x > tiny && *x < b.length - tiny;
        let way = |time: f64| (t - time) * b.wave_speed();
        let [from_left, from_right] = &self.sent[bar];
        let mut edges: Vec<f64> = from_left.times().map(way).filter(inside).collect();
        let to_left = from_right.times().map(|time| b.length - way(time));
        edges.extend(to_left.filter(inside));
        edges.extend([0.0, b.length]);
        edges.sort_by(f64::total_cmp);
        edges.dedup_by(|a, b| (*a - *b).abs() < tiny);
        edges
    }
}

/// The state of a bar where the invariants are `r` and `l`.
fn state(bar: &Bar, r: f64, l: f64) -> State {
    State {
        velocity: 0.5 * (r + l),
        stress: 0.5 * bar.impedance() * (l - r),
    }
}
