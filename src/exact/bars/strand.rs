//! A bar with waves in it: constant states with fronts between them, and the waves that its ends send.

use crate::finite_strain::Medium;
use crate::{Sample, bisect};

/// Changes of stretch below this are none.
pub(super) const SPECK: f64 = 1e-9;
/// Stretches between which all states lie.
pub(super) const STRETCHES: [f64; 2] = [1e-3, 1e3];

/// The constant state between two fronts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    pub(super) velocity: f64,
    pub(super) stretch: f64,
}

/// A jump between two states.
#[derive(Debug, Clone, Copy)]
pub(super) struct Front {
    /// Distance from the left end in reference coordinates (m).
    pub(super) at: f64,
    /// Speed in reference coordinates, to the right positive (m/s).
    pub(super) speed: f64,
    /// A step of a fan, no shock.
    pub(super) fan: bool,
}

/// A bar with waves in it.
#[derive(Debug, Clone)]
pub(super) struct Strand {
    pub(super) medium: Medium,
    pub(super) length: f64,
    /// Current position of the left end (m).
    pub(super) left: f64,
    pub(super) fronts: Vec<Front>,
    /// One more than fronts.
    pub(super) states: Vec<State>,
}

/// A shock, or the steps of a fan, from the state it runs into.
pub(super) struct Wave {
    pub(super) fronts: Vec<Front>,
    /// Behind each front.
    pub(super) states: Vec<State>,
}

impl Wave {
    /// The wave into a state that leaves a stretch; `side` is 1 if it runs to the left, else −1.
    pub(super) fn new(
        medium: &Medium,
        ahead: State,
        stretch: f64,
        side: f64,
        step: f64,
        at: f64,
    ) -> Self {
        let mut wave = Self {
            fronts: Vec::new(),
            states: Vec::new(),
        };
        let change = stretch - ahead.stretch;
        if change.abs() < SPECK {
            return wave;
        }
        let gain = medium.change(stretch, ahead.stretch);
        let fan = change > 0.0;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small count"
        )]
        let steps = if fan {
            (gain / step).round().max(1.0) as u32
        } else {
            1
        };
        let mut last = ahead.stretch;
        for k in 1..=steps {
            let next = ahead.stretch + change * f64::from(k) / f64::from(steps);
            wave.fronts.push(Front {
                at,
                speed: -side * medium.front_speed(last, next),
                fan,
            });
            wave.states.push(State {
                velocity: ahead.velocity + side * medium.change(next, ahead.stretch),
                stretch: next,
            });
            last = next;
        }
        wave
    }
}

impl Strand {
    /// The state at the left (0) or right (1) end.
    pub(super) fn outer(&self, end: usize) -> State {
        self.states[if end == 0 { 0 } else { self.states.len() - 1 }]
    }

    /// The stretch behind a wave from an end that moves at a velocity (m/s).
    pub(super) fn stretch_at(&self, end: usize, velocity: f64) -> f64 {
        let state = self.outer(end);
        let gain = (velocity - state.velocity) * if end == 0 { -1.0 } else { 1.0 };
        bisect(STRETCHES[0], STRETCHES[1], |stretch| {
            self.medium.change(stretch, state.stretch) - gain
        })
    }

    /// Sends a wave from an end that leaves a stretch.
    pub(super) fn send(&mut self, end: usize, stretch: f64, step: f64) {
        let ahead = self.outer(end);
        if end == 0 {
            let wave = Wave::new(&self.medium, ahead, stretch, -1.0, step, 0.0);
            self.fronts.splice(0..0, wave.fronts.into_iter().rev());
            self.states.splice(0..0, wave.states.into_iter().rev());
        } else {
            let wave = Wave::new(&self.medium, ahead, stretch, 1.0, step, self.length);
            self.fronts.extend(wave.fronts);
            self.states.extend(wave.states);
        }
    }

    /// The states and their ends in reference coordinates (m).
    pub(super) fn pieces(&self) -> impl Iterator<Item = (State, [f64; 2])> {
        let end = |k: usize| self.fronts.get(k).map_or(self.length, |front| front.at);
        let from = move |k: usize| if k == 0 { 0.0 } else { end(k - 1) };
        let states = self.states.iter().enumerate();
        states.map(move |(k, state)| (*state, [from(k), end(k)]))
    }

    /// Both ends of each state, and the middle of each step of a fan.
    pub(super) fn samples(&self) -> Vec<Sample> {
        let in_fan = |k: usize| self.fronts.get(k).is_some_and(|front| front.fan);
        let mut samples = Vec::new();
        let mut left = self.left;
        for (k, (state, ends)) in self.pieces().enumerate() {
            let width = (ends[1] - ends[0]) * state.stretch;
            let sample = self.sample(state);
            let step = k > 0 && in_fan(k - 1) && in_fan(k);
            if step && width < self.widest_step() {
                samples.push(sample.at(left + 0.5 * width));
            } else {
                samples.extend([sample.at(left), sample.at(left + width)]);
            }
            left += width;
        }
        samples
    }

    /// States between steps of fans that are wider are plateaus (m).
    fn widest_step(&self) -> f64 {
        0.01 * self.length
    }

    fn sample(&self, state: State) -> Sample {
        let medium = &self.medium;
        let pressure = medium.pressure(state.stretch);
        Sample {
            position: 0.0,
            velocity: state.velocity,
            density: medium.reference_density / state.stretch,
            pressure,
            deviatoric_stress: medium.stress(state.stretch) + pressure,
            specific_energy: medium.strain_energy(state.stretch),
        }
    }
}
