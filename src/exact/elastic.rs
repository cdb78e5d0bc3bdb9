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

use super::steps::Steps;

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

/// What holds an outer end of the row.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// No stress.
    Free,
    /// A velocity (m/s) from each time (s) on, first time first; free before.
    Moved(Vec<(f64, f64)>),
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
        let mut solver = Solver::new(row);
        solver.run(until);
        solver.waves
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
        let mut pieces: Vec<Piece> = Vec::new();
        for (k, bar) in self.bars.iter().enumerate() {
            let edges = self.fronts(k, t);
            let first = pieces.len();
            for ends in edges.windows(2) {
                let state = self.at(k, 0.5 * (ends[0] + ends[1]), t);
                let to = bar.left + ends[1];
                match pieces[first..].last_mut() {
                    Some(last) if last.state == state => last.to = to,
                    _ => pieces.push(Piece {
                        bar: k,
                        from: bar.left + ends[0],
                        to,
                        state,
                    }),
                }
            }
        }
        pieces
    }

    /// Mean velocity of a bar (m/s) at time `t` (s).
    #[must_use]
    pub fn mean_velocity(&self, bar: usize, t: f64) -> f64 {
        let pieces = self.profile(t).into_iter().filter(|p| p.bar == bar);
        let moved: f64 = pieces.map(|p| (p.to - p.from) * p.state.velocity).sum();
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

/// Goes from event to event.
struct Solver<'a> {
    row: &'a Row,
    waves: Waves,
    /// Gap of each joint (m).
    gaps: Vec<f64>,
    /// Gaps narrower than this are none (m).
    touching: f64,
    /// Times closer than this are one (s).
    instant: f64,
    /// Velocities closer than this are one (m/s).
    speck: f64,
}

impl<'a> Solver<'a> {
    fn new(row: &'a Row) -> Self {
        let bars = &row.bars;
        let transits = bars.iter().map(Bar::transit);
        let given = row.ends.iter().flat_map(|end| match end {
            End::Free => &[][..],
            End::Moved(steps) => &steps[..],
        });
        let velocities = bars
            .iter()
            .map(|b| b.velocity)
            .chain(given.map(|&(_, v)| v));
        let gap = |pair: &[Bar]| pair[1].left - (pair[0].left + pair[0].length);
        let mut gaps: Vec<f64> = bars.windows(2).map(gap).collect();
        for (gap, joint) in gaps.iter_mut().zip(&row.joints) {
            if *joint == Joint::Bonded {
                *gap = 0.0;
            }
        }
        Self {
            row,
            gaps,
            touching: ROUND_OFF * bars.iter().map(|b| b.length).fold(f64::INFINITY, f64::min),
            instant: ROUND_OFF * transits.fold(f64::INFINITY, f64::min),
            speck: ROUND_OFF * velocities.fold(0.0, |most, v| v.abs().max(most)),
            waves: Waves {
                bars: bars.clone(),
                sent: bars
                    .iter()
                    .map(|b| [0, 1].map(|_| Steps::new(b.velocity)))
                    .collect(),
                links: vec![Vec::new(); row.joints.len()],
            },
        }
    }

    fn run(&mut self, until: f64) {
        let mut now = 0.0;
        loop {
            self.answer(now);
            let next = self.next_event(now);
            if next > until {
                return;
            }
            for (gap, links) in self.gaps.iter_mut().zip(&self.waves.links) {
                let link = links.last().expect("a joint has its first state");
                *gap += (link.velocities[1] - link.velocities[0]) * (next - now);
            }
            now = next;
        }
    }

    /// Lets every end answer to what arrives at `now`.
    fn answer(&mut self, now: f64) {
        let last = self.row.bars.len() - 1;
        let left = self.end(0, self.arriving(0, 0, now), now);
        self.send(0, 0, now, left);
        for joint in 0..last {
            self.answer_at_joint(joint, now);
        }
        let right = self.end(1, self.arriving(last, 1, now), now);
        self.send(last, 1, now, right);
    }

    fn answer_at_joint(&mut self, joint: usize, now: f64) {
        let pair = [&self.row.bars[joint], &self.row.bars[joint + 1]];
        let [z_a, z_b] = pair.map(Bar::impedance);
        let r = self.arriving(joint, 1, now);
        let l = self.arriving(joint + 1, 0, now);
        let touch = match self.row.joints[joint] {
            Joint::Bonded => true,
            Joint::Contact => self.gaps[joint] <= self.touching && l - r < -self.speck,
        };
        let (velocities, stress) = if touch {
            self.gaps[joint] = 0.0;
            let common = (z_a * r + z_b * l) / (z_a + z_b);
            ([common; 2], z_a * z_b * (l - r) / (z_a + z_b))
        } else {
            ([r, l], 0.0)
        };
        self.send(joint, 1, now, 2.0 * velocities[0] - r);
        self.send(joint + 1, 0, now, 2.0 * velocities[1] - l);
        let link = Link {
            time: now,
            velocities,
            stress,
            gap: self.gaps[joint],
        };
        let links = &mut self.waves.links[joint];
        let same = |old: &Link| old.velocities == velocities && old.stress == stress;
        if !links.last().is_some_and(same) {
            links.push(link);
        }
    }

    /// What an outer end sends when `arrived` comes to it.
    fn end(&self, end: usize, arrived: f64, now: f64) -> f64 {
        match &self.row.ends[end] {
            End::Free => arrived,
            End::Moved(steps) => {
                let given = steps.iter().rev().find(|s| s.0 <= now + self.instant);
                given.map_or(arrived, |&(_, v)| 2.0 * v - arrived)
            }
        }
    }

    /// What comes to an end (0 left, 1 right) of a bar from its other one.
    fn arriving(&self, bar: usize, end: usize, now: f64) -> f64 {
        let delay = self.row.bars[bar].transit();
        self.waves.sent[bar][1 - end].at(now - delay + self.instant)
    }

    fn send(&mut self, bar: usize, end: usize, now: f64, value: f64) {
        let steps = &mut self.waves.sent[bar][end];
        if (value - steps.last()).abs() > self.speck {
            steps.push(now, value);
        }
    }

    /// The next arrival, change of a given velocity, or closing of a gap after `now` (s).
    fn next_event(&self, now: f64) -> f64 {
        let mut next = f64::INFINITY;
        let mut vote = |time: f64| {
            if time > now + self.instant && time < next {
                next = time;
            }
        };
        for (bar, sent) in self.row.bars.iter().zip(&self.waves.sent) {
            for steps in sent {
                if let Some(time) = steps.first_after(now - bar.transit() + self.instant) {
                    vote(time + bar.transit());
                }
            }
        }
        for end in &self.row.ends {
            if let End::Moved(steps) = end {
                steps.iter().for_each(|&(time, _)| vote(time));
            }
        }
        for (gap, links) in self.gaps.iter().zip(&self.waves.links) {
            let [a, b] = links.last().map_or([0.0; 2], |link| link.velocities);
            if *gap > self.touching && a - b > self.speck {
                vote(now + (gap / (a - b)).max(2.0 * self.instant));
            }
        }
        next
    }
}
