//! Wall time by phase of the step.

use std::time::{Duration, Instant};

use comm;

macro_rules! phases {
    ($( $(#[doc = $doc:literal])+ $name:ident = $text:literal, )+) => {
        /// A phase of the step.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Phase { $( $(#[doc = $doc])+ $name, )+ }

        impl Phase {
            /// All phases with their names in reports.
            pub const ALL: &[(Self, &str)] = &[ $( (Self::$name, $text), )+ ];
        }
    };
}

phases! {
    /// Kicks and drift.
    Integrate = "integrate",
    /// New faces between slabs, and the order of the store.
    Balance = "balance",
    /// Particles that change ranks.
    Migrate = "migrate",
    /// Copies of positions and velocities.
    HaloMotion = "halo_motion",
    /// Sort and lists.
    Neighbours = "neighbours",
    /// Velocity gradient and the material's answer to it.
    Material = "velocity_gradient_and_material",
    /// Foreign fractions.
    ContactFractions = "contact_fractions",
    /// Copies of stresses.
    HaloStress = "halo_stress",
    /// Momentum and energy.
    Momentum = "momentum_and_energy",
    /// Contact forces.
    ContactForces = "contact_forces",
    /// Self-gravity.
    SelfGravity = "self_gravity",
    /// Time-step candidates and conserved sums.
    TimeStep = "vote_and_sums",
    /// Histories, snapshots and checkpoints.
    Output = "output",
}

/// Seconds by phase since the start of this process's run.
#[derive(Debug, Clone)]
pub struct Timers {
    seconds: [f64; Phase::ALL.len()],
    /// Particle updates that this rank has made.
    pub updates: u64,
    busy: f64,
    last: Instant,
    /// Time that this rank had waited for others by then.
    waited: Duration,
}

impl Default for Timers {
    fn default() -> Self {
        Self {
            seconds: [0.0; Phase::ALL.len()],
            updates: 0,
            busy: 0.0,
            last: Instant::now(),
            waited: comm::waited(),
        }
    }
}

impl Timers {
    /// Starts the next phase without booking the time since the last.
    pub fn skip(&mut self) {
        (self.last, self.waited) = (Instant::now(), comm::waited());
    }

    /// Books the time since the last call to `phase`.
    pub fn lap(&mut self, phase: Phase) {
        let (last, waited) = (self.last, self.waited);
        self.skip();
        let seconds = (self.last - last).as_secs_f64();
        self.seconds[phase as usize] += seconds;
        // How long files take says nothing of the particles, and HDF5 waits for others by itself.
        if phase != Phase::Output {
            self.busy += seconds - self.waited.saturating_sub(waited).as_secs_f64();
        }
    }

    /// Seconds of this rank's own work on its particles: all phases but the output, without the
    /// time that calls in them waited for other ranks.
    #[must_use]
    pub fn busy(&self) -> f64 {
        self.busy
    }

    /// Name and seconds of each phase.
    pub fn report(&self) -> impl Iterator<Item = (&'static str, f64)> {
        Phase::ALL
            .iter()
            .map(|&(phase, name)| (name, self.seconds[phase as usize]))
    }
}
