//! The outlook in `status.json`, for watching a run.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use super::load::Load;
use crate::output::{Energies, Outlook, RunFolder, unit_of_model};
use comm::Comm;
use engine::step::{RunState, Simulation, measurements};
use model::RunControl;

/// Most energies that are kept.
const MOST: usize = 64;
/// Least time between two files.
const EVERY: Duration = Duration::from_secs(2);
/// Least time between two files over the time of writing one.
const SHARE: u32 = 100;

/// Data of a run that rank 0 keeps for its status.
#[derive(Debug)]
pub struct Watched {
    control: RunControl,
    dimension: usize,
    /// Share of the model that is computed.
    computed_share: f64,
    begun: Instant,
    first_step: u64,
    energies: Energies,
    /// Rows so far; every `stride`-th is kept.
    rows: usize,
    stride: usize,
    ranks: usize,
    particles: u64,
    loads: Vec<f64>,
    largest_load: f64,
    last: Instant,
    wait: Duration,
}

impl Watched {
    /// Of a run in its folder that begins, or continues with the energies of its past.
    pub fn begin(comm: &Comm, folder: &RunFolder, simulation: &Simulation, goes_on: bool) -> Self {
        let before = (goes_on && comm.is_root()).then(|| folder.status().ok()?.outlook);
        let share = 1.0 / f64::from(measurements::images(simulation).copies());
        // Energies of what is computed do not go on as those of the whole.
        let past = (before.flatten())
            .filter(|outlook| outlook.computed_share.to_bits() == share.to_bits());
        let past = past.map(|outlook| outlook.energies);
        let case = &simulation.case;
        Self {
            computed_share: share,
            ..Self::of(&case.run, case.extent(), &simulation.state, past)
        }
    }

    /// Of a run that begins at a state.
    fn of(
        control: &RunControl,
        dimension: usize,
        state: &RunState,
        past: Option<Energies>,
    ) -> Self {
        let mut energies = past.filter(Energies::is_whole).unwrap_or_default();
        let times = energies.time.clone();
        energies.retain(|n| times[n] <= state.time);
        Self {
            control: *control,
            dimension,
            computed_share: 1.0,
            begun: Instant::now(),
            first_step: state.step,
            rows: energies.time.len(),
            energies,
            stride: 1,
            ranks: 1,
            particles: 0,
            loads: Vec::new(),
            largest_load: 1.0,
            last: Instant::now(),
            wait: EVERY,
        }
    }

    /// Adds a row of the tables, of the state of the whole model.
    pub fn row(&mut self, state: &RunState, load: &Load) {
        self.ranks = load.ranks();
        self.particles = load.particles[0];
        self.loads = load.by_group().map(|group| digits(group.work)).collect();
        self.largest_load = digits(load.imbalance(load.work));
        let totals = &state.totals;
        let values = [
            state.time,
            totals.kinetic_energy,
            totals.internal_energy,
            state.contact_energy,
            totals.energy(),
        ];
        if values.iter().any(|value| !value.is_finite()) {
            return;
        }
        // The last row is always there; the next replaces it unless it is one to be kept.
        let last = self.energies.time.len();
        if self.rows > 0 && !(self.rows - 1).is_multiple_of(self.stride) {
            self.energies.retain(|n| n + 1 < last);
        }
        self.energies.push(values.map(digits));
        self.rows += 1;
        if self.energies.time.len() > MOST {
            self.energies.retain(|n| n % 2 == 0);
            self.stride *= 2;
        }
    }

    /// Returns true if the file is to be rewritten.
    pub fn is_due(&self) -> bool {
        self.last.elapsed() >= self.wait
    }

    /// Notes that it has been written, beginning at a time.
    pub fn wrote(&mut self, begun: Instant) {
        self.last = Instant::now();
        self.wait = EVERY.max(begun.elapsed() * SHARE);
    }

    /// The outlook, with the time left if that is known.
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    pub fn outlook(&self, state: &RunState, wall: f64, left: Option<Duration>) -> Outlook {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        let steps = (state.step - self.first_step).max(1) as f64;
        Outlook {
            written: since.map_or(0, |since| since.as_secs()),
            wall_seconds: digits(wall),
            seconds_left: left.map(|left| digits(left.as_secs_f64())),
            seconds_per_step: digits(self.begun.elapsed().as_secs_f64() / steps),
            end_time: self.control.end_time,
            max_steps: self.control.max_steps,
            dt: state.last_dt,
            dt_reason: state.last_reason.name().to_owned(),
            ranks: self.ranks,
            threads: rayon::current_num_threads(),
            particles: self.particles,
            loads: self.loads.clone(),
            largest_load: self.largest_load,
            energy_unit: unit_of_model("J", self.dimension).to_owned(),
            energies: self.energies.clone(),
            computed_share: self.computed_share,
        }
    }
}

/// Rounds a number for display to six digits.
fn digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::step::Totals;

    fn state(time: f64) -> RunState {
        RunState {
            time,
            totals: Totals {
                kinetic_energy: 2.0 - time,
                internal_energy: time,
                ..Totals::default()
            },
            ..RunState::default()
        }
    }

    fn after(rows: u32) -> Watched {
        let control = RunControl {
            end_time: 1.0,
            max_steps: None,
        };
        let mut watched = Watched::of(&control, 3, &RunState::default(), None);
        let load = Load::of_equals(3, 12);
        for n in 0..rows {
            watched.row(&state(f64::from(n)), &load);
        }
        watched
    }

    #[test]
    fn energies_of_any_run_are_few_even_and_reach_its_end() {
        for rows in [1, 2, 64, 65, 66, 67, 200, 1000, 12_345] {
            let watched = after(rows);
            let time = &watched.energies.time;
            assert!(time.len() <= MOST && watched.energies.is_whole());
            assert!(rows < 40 || time.len() > 30, "{rows}: {}", time.len());
            assert_eq!((time[0], time[time.len() - 1]), (0.0, f64::from(rows - 1)));
            let gaps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
            // All alike but the last, which is shorter.
            let most = gaps.iter().copied().fold(0.0, f64::max);
            let even = gaps
                .iter()
                .rev()
                .skip(1)
                .all(|gap| (gap - most).abs() < 1e-9);
            assert!(even, "{rows}: {gaps:?}");
        }
    }

    #[test]
    fn a_restart_goes_on_with_the_past_before_it() {
        let past = after(50).energies;
        let control = after(0).control;
        let watched = Watched::of(&control, 3, &state(20.0), Some(past));
        assert_eq!(watched.energies.time.len(), 21);
        let mut broken = after(5).energies;
        broken.total.pop();
        let watched = Watched::of(&control, 3, &state(20.0), Some(broken));
        assert_eq!(watched.energies, Energies::default());
    }

    #[test]
    fn loads_of_equal_ranks_are_one() {
        let outlook = after(3).outlook(&state(2.0), 5.0, None);
        assert_eq!((outlook.loads, outlook.ranks), (vec![1.0; 3], 3));
        assert!((digits(1.0 / 3.0) - 0.333_333).abs() < 1e-12);
    }
}
