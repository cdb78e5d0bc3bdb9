//! Impact of a row of elastic bars in uniaxial strain with the program's own laws, for any time:
//! fronts are followed from one collision to the next.
//!
//! A bar is a sequence of constant states (velocity v, stretch λ) with fronts between them. In
//! reference coordinates a front into the state 0 that leaves the stretch λ behind changes the
//! velocity by `s φ(λ; λ₀)`, `s` = 1 if it runs to the left and −1 if to the right, with the laws
//! of [`finite_strain`](super::finite_strain):
//!
//! | | φ(λ; λ₀) | speed |
//! |---|---|---|
//! | λ < λ₀, a shock | `−√((σ − σ₀)(λ − λ₀)/ρ₀)` | `√((σ − σ₀)/(λ − λ₀)/ρ₀)` |
//! | λ > λ₀, a fan | `L(λ) − L(λ₀)` | the same, for each of the steps that the fan is cut into |
//!
//! Fronts that meet, and fronts that meet a face, are a Riemann problem: φ rises with λ, so the
//! state between is found by bisection. Faces are free, moved, or press on the next bar, with one
//! stress and velocity, until they would pull; open ones close when the gap is used up. Shocks and
//! their collisions are exact, fans to the size of their steps. Source of the method: Dafermos
//! (1972), J. Math. Anal. Appl. 38, 33.

mod strand;

use super::finite_strain::Medium;
use super::{Profile, bisect};
use strand::{SPECK, STRETCHES, State, Strand, Wave};

/// Steps of velocity in the largest difference of velocities there is.
const STEPS: f64 = 64.0;

/// A bar at the start, without stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// Its law.
    pub medium: Medium,
    /// Coordinate of the left end (m).
    pub left: f64,
    /// Length (m).
    pub length: f64,
    /// Velocity (m/s).
    pub velocity: f64,
}

/// Boundary condition of an outer end of the row.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// No stress.
    Free,
    /// A velocity (m/s), or none where it is free, from each time (s) on, first time first; free
    /// before.
    Moved(Vec<(f64, Option<f64>)>),
}

/// Bars from left to right in frictionless contact without tension, with gaps or without.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The bars.
    pub bars: Vec<Bar>,
    /// Boundary conditions of the outer ends, left and right.
    pub ends: [End; 2],
}

/// The next event.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Event {
    /// A front of a bar meets the next one.
    Fronts(usize, usize),
    /// A front meets the left (0) or right (1) end of a bar.
    Face(usize, usize),
    /// The velocity of an outer end changes.
    Given(usize),
    /// A gap closes.
    Gap(usize),
}

/// The waves in a row at some time.
#[derive(Debug, Clone)]
pub struct Waves {
    strands: Vec<Strand>,
    ends: [End; 2],
    /// Gaps of the joints (m); absent while they press.
    gaps: Vec<Option<f64>>,
    time: f64,
    /// Largest velocity of one step of a fan (m/s).
    step: f64,
}

impl Waves {
    /// Follows a row from the start until a time (s).
    #[must_use]
    pub fn new(row: &Row, until: f64) -> Self {
        let given = row.ends.iter().flat_map(|end| match end {
            End::Free => &[][..],
            End::Moved(steps) => &steps[..],
        });
        let velocities = row.bars.iter().map(|bar| bar.velocity);
        let ends = velocities
            .chain(given.filter_map(|step| step.1))
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
                [low.min(v), high.max(v)]
            });
        let strand = |bar: &Bar| Strand {
            medium: bar.medium,
            length: bar.length,
            left: bar.left,
            fronts: Vec::new(),
            states: vec![State {
                velocity: bar.velocity,
                stretch: 1.0,
            }],
        };
        let gap = |pair: &[Bar]| Some((pair[1].left - pair[0].left - pair[0].length).max(0.0));
        let mut waves = Self {
            strands: row.bars.iter().map(strand).collect(),
            ends: row.ends.clone(),
            gaps: row.bars.windows(2).map(gap).collect(),
            time: 0.0,
            step: (ends[1] - ends[0]) / STEPS,
        };
        let last = waves.strands.len() - 1;
        waves.answer(0, 0);
        waves.answer(last, 1);
        while let Some((time, event)) = waves.next().filter(|next| next.0 <= until) {
            waves.advance(time);
            match event {
                Event::Fronts(bar, front) => waves.collide(bar, front),
                Event::Face(bar, end) => {
                    waves.absorb(bar, end);
                    waves.answer(bar, end);
                }
                Event::Given(end) => waves.answer(if end == 0 { 0 } else { last }, end),
                Event::Gap(joint) => waves.press(joint),
            }
        }
        waves.advance(until);
        waves
    }

    /// All bars from left to right, where they are now; within a fan a sample for each step.
    #[must_use]
    pub fn profile(&self) -> Profile {
        self.strands.iter().map(Strand::samples).collect()
    }

    /// Momentum (kg/(m s)) and the kinetic and strain energy (J/m²) of all bars.
    #[must_use]
    pub fn sums(&self) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for strand in &self.strands {
            for (state, ends) in strand.pieces() {
                let mass = strand.medium.reference_density * (ends[1] - ends[0]);
                sums[0] += mass * state.velocity;
                sums[1] += 0.5 * mass * state.velocity * state.velocity;
                sums[2] += mass * strand.medium.strain_energy(state.stretch);
            }
        }
        sums
    }

    /// Stress at a joint, tension positive (Pa), while it presses.
    #[must_use]
    pub fn joint_stress(&self, joint: usize) -> Option<f64> {
        let strand = &self.strands[joint];
        let pressed = self.gaps[joint].is_none();
        pressed.then(|| strand.medium.stress(strand.outer(1).stretch))
    }

    /// The next event and its time.
    fn next(&self) -> Option<(f64, Event)> {
        let mut next: Option<(f64, Event)> = None;
        let instant = SPECK * self.time;
        let mut offer = |wait: f64, event: Event| {
            let time = self.time + wait.max(0.0);
            if next.is_none_or(|first| time < first.0) {
                next = Some((time, event));
            }
        };
        for (k, strand) in self.strands.iter().enumerate() {
            for (i, pair) in strand.fronts.windows(2).enumerate() {
                let closing = pair[0].speed - pair[1].speed;
                if closing > 0.0 {
                    offer((pair[1].at - pair[0].at) / closing, Event::Fronts(k, i));
                }
            }
            if let Some(front) = strand.fronts.first().filter(|f| f.speed < 0.0) {
                offer(front.at / -front.speed, Event::Face(k, 0));
            }
            if let Some(front) = strand.fronts.last().filter(|f| f.speed > 0.0) {
                offer((strand.length - front.at) / front.speed, Event::Face(k, 1));
            }
        }
        for (end, held) in self.ends.iter().enumerate() {
            if let End::Moved(steps) = held
                && let Some(step) = steps.iter().find(|step| step.0 > self.time + instant)
            {
                offer(step.0 - self.time, Event::Given(end));
            }
        }
        for (joint, gap) in self.gaps.iter().enumerate() {
            let closing = self.closing(joint);
            if let Some(gap) = gap.filter(|_| closing > 0.0) {
                offer(gap / closing, Event::Gap(joint));
            }
        }
        next
    }

    /// Speed at which an open joint closes (m/s); steps of a fan at one face are no motion.
    fn closing(&self, joint: usize) -> f64 {
        let faces = [
            &self.strands[joint].outer(1),
            &self.strands[joint + 1].outer(0),
        ];
        let closing = faces[0].velocity - faces[1].velocity;
        if closing > 1e-6 * self.step {
            closing
        } else {
            0.0
        }
    }

    /// Advances to a time without event.
    fn advance(&mut self, time: f64) {
        let wait = time - self.time;
        for joint in 0..self.gaps.len() {
            let opening =
                self.strands[joint + 1].outer(0).velocity - self.strands[joint].outer(1).velocity;
            if let Some(gap) = &mut self.gaps[joint] {
                *gap = (*gap + opening * wait).max(0.0);
            }
        }
        for strand in &mut self.strands {
            strand.left += strand.outer(0).velocity * wait;
            for front in &mut strand.fronts {
                front.at += front.speed * wait;
            }
        }
        self.time = time;
    }

    /// Two fronts of a bar meet.
    fn collide(&mut self, bar: usize, front: usize) {
        let strand = &mut self.strands[bar];
        let medium = strand.medium;
        let [left, right] = [strand.states[front], strand.states[front + 2]];
        let apart = right.velocity - left.velocity;
        let stretch = bisect(STRETCHES[0], STRETCHES[1], |stretch| {
            medium.change(stretch, left.stretch) + medium.change(stretch, right.stretch) - apart
        });
        let at = strand.fronts[front].at;
        let mut waves = Wave::new(&medium, left, stretch, 1.0, self.step, at);
        let other = Wave::new(&medium, right, stretch, -1.0, self.step, at);
        // From left to right; the state between the waves is listed once, or is that of a side
        // which has no wave.
        if other.fronts.is_empty() {
            waves.states.pop();
        }
        waves.states.extend(other.states.iter().rev().skip(1));
        waves.fronts.extend(other.fronts.iter().rev());
        let gone = if waves.fronts.is_empty() { 2 } else { 1 };
        strand.fronts.splice(front..front + 2, waves.fronts);
        strand.states.splice(front + 1..=front + gone, waves.states);
        debug_assert_eq!(strand.states.len(), strand.fronts.len() + 1);
    }

    /// Takes away the front that has come to an end, which takes the state behind it.
    fn absorb(&mut self, bar: usize, end: usize) {
        let strand = &mut self.strands[bar];
        if end == 0 {
            strand.fronts.remove(0);
            strand.states.remove(0);
        } else {
            strand.fronts.pop();
            strand.states.pop();
        }
    }

    /// An end answers to the state that has come to it.
    fn answer(&mut self, bar: usize, end: usize) {
        let joint = if end == 0 {
            bar.checked_sub(1)
        } else {
            Some(bar)
        };
        match joint.filter(|&joint| joint < self.gaps.len()) {
            Some(joint)
                if self.gaps[joint].is_none_or(|gap| gap < SPECK * self.strands[bar].length) =>
            {
                self.press(joint);
            }
            Some(_) => self.strands[bar].send(end, 1.0, self.step),
            None => {
                let given = match &self.ends[end] {
                    End::Free => None,
                    End::Moved(steps) => {
                        let now = self.time * (1.0 + SPECK);
                        steps.iter().rev().find(|step| step.0 <= now)
                    }
                };
                let stretch = match given.and_then(|step| step.1) {
                    Some(velocity) => self.strands[bar].stretch_at(end, velocity),
                    None => 1.0,
                };
                self.strands[bar].send(end, stretch, self.step);
            }
        }
    }

    /// Faces in touch: one stress and velocity, or none if they would pull.
    fn press(&mut self, joint: usize) {
        let [a, b] = [&self.strands[joint], &self.strands[joint + 1]];
        let [left, right] = [a.outer(1), b.outer(0)];
        let other = |stretch: f64| b.medium.stretch(a.medium.stress(stretch));
        let stretch = bisect(STRETCHES[0], 1.0, |stretch| {
            left.velocity - right.velocity
                + a.medium.change(stretch, left.stretch)
                + b.medium.change(other(stretch), right.stretch)
        });
        if stretch < 1.0 - SPECK {
            let there = other(stretch);
            self.gaps[joint] = None;
            self.strands[joint].send(1, stretch, self.step);
            self.strands[joint + 1].send(0, there, self.step);
        } else {
            self.gaps[joint] = Some(0.0);
            self.strands[joint].send(1, 1.0, self.step);
            self.strands[joint + 1].send(0, 1.0, self.step);
        }
    }
}
