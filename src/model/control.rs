//! Options of the method and controls of a run.

use serde::Deserialize;

use super::{Axis, Body, Cadence, Region, TermOptions};

/// True if the smoothing length of the SPH sums follows the density. Contact always keeps the
/// reference h₀.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SmoothingLength {
    /// h = h₀ for ever.
    Constant,
    /// h = h₀ (ρ₀/ρ)^{1/d} between two bounds.
    Variable {
        /// Smallest h/h₀.
        min: f64,
        /// Largest h/h₀.
        max: f64,
    },
}

/// How the SPH sums take gradients.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SphForm {
    /// By the gradient of the kernel.
    Conventional,
    /// By gradients that a smooth function of the neighbours' moments corrects.
    Corrected,
    /// By the corrected gradient of the normalised kernel.
    Normalised,
    /// By linear fits at stress points between the particles, which carry mass and velocity alone.
    StressPoints,
}

/// Options of the SPH sums.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphOptions {
    /// How gradients are taken.
    pub form: SphForm,
    /// Linear coefficient α of the Monaghan–Gingold viscosity.
    pub alpha: f64,
    /// Quadratic coefficient β of the Monaghan–Gingold viscosity.
    pub beta: f64,
    /// Constant or variable smoothing length.
    pub smoothing_length: SmoothingLength,
    /// Pair terms.
    pub terms: TermOptions,
    /// Stiffness ξ of the hourglass control of the corrected form, over the P-wave modulus.
    pub hourglass: f64,
}

/// With this α and `courant` and more viscosity waves of any length die down in the corrected form; whatever the viscosity
/// they do, or grow too slowly to matter, with the shorter step.
const ENOUGH_VISCOSITY: f64 = 0.2;
const LONG_STEP: f64 = 0.5;
const SHORT_STEP: f64 = 0.25;

impl SphOptions {
    /// The `courant` up to which short waves of the corrected form lose more by viscosity than they grow: by (ω Δt)⁴/8 a
    /// step, and viscosity takes α ω Δt times a constant, so that Δt goes with the cube root of α (theory page "Time
    /// integration").
    #[must_use]
    pub fn longest_courant(&self) -> f64 {
        let longest = LONG_STEP * (self.alpha / ENOUGH_VISCOSITY).cbrt();
        // Rounded down, so that who takes this number is below.
        (100.0 * longest.max(SHORT_STEP)).floor() / 100.0
    }
}

/// Factors of steps where a case states none: impacts in space hold with longer ones (theory page "Time integration").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefaultFactors {
    /// Of the sound and viscosity criterion.
    pub courant: f64,
    /// Of the acceleration criterion.
    pub force: f64,
    /// Of the contact criterion.
    pub contact: f64,
}

impl DefaultFactors {
    /// Of a case of so many dimensions with these sums. What is squeezed in the total form needs the shorter ones.
    #[must_use]
    pub fn of(dimension: usize, sph: &SphOptions, bodies: &[Body]) -> Self {
        if dimension < 3 || bodies.iter().any(|body| body.total) {
            return Self {
                courant: 0.5,
                force: 0.25,
                contact: 0.8,
            };
        }
        Self {
            courant: sph.longest_courant().clamp(0.5, 0.65),
            force: 0.2,
            contact: 1.0,
        }
    }
}

/// Stability factors of the explicit scheme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeStepOptions {
    /// Factor of the sound and viscosity criterion.
    pub courant: f64,
    /// Factor of the acceleration criterion √(h/|a|).
    pub force: f64,
    /// Safety factor of the contact criterion.
    pub contact: f64,
    /// Upper bound of the step (s); infinite when there is none.
    pub max: f64,
}

/// Distribution over ranks, which never touches results, and the box of interest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DomainOptions {
    /// Levels of slabs; chosen by the halo when absent.
    pub levels: Option<usize>,
    /// Axes of the slabs by level; the longest of the others when absent.
    pub axes: [Option<Axis>; 3],
    /// Most steps between two balances of the work; 0 keeps the first faces.
    pub balance_every: u64,
    /// What of space is of interest: particles that leave it are taken out; everything if absent.
    pub keep: Option<Region>,
}

/// When a run ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunControl {
    /// The case's own end (s); the last step is clipped to it.
    pub end_time: f64,
    /// Stop after this many steps, if given.
    pub max_steps: Option<u64>,
}

/// What is written, and when.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputOptions {
    /// Time between snapshots (s); none if absent. The first and the last state are always written.
    pub snapshot_every: Option<f64>,
    /// Time between checkpoints (s); none if absent. A soft stop always writes one.
    pub checkpoint_every: Option<f64>,
    /// Steps between checkpoints; none if absent.
    pub checkpoint_every_steps: Option<u64>,
    /// Time of the clock between checkpoints; none if absent.
    pub checkpoint_every_wall: Option<ClockInterval>,
    /// How many checkpoints are kept.
    pub checkpoints_kept: usize,
    /// When rows of `history.csv` and the tables that go with it are written; some hundreds of a run if
    /// absent.
    pub history_every: Option<Cadence>,
    /// Names of the snapshot fields; the field table's defaults when empty.
    pub fields: Vec<String>,
    /// Further snapshots, with schedules of their own.
    pub snapshots: Vec<SnapshotSchedule>,
    /// How files of all ranks are written.
    pub sharing: Sharing,
}

/// How files of all ranks are written, which never touches what is in them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Sharing {
    /// How many ranks write; by bytes if absent.
    pub writers: Option<usize>,
    /// Arrays begin at multiples of so many bytes; anywhere if absent.
    pub alignment: Option<u64>,
}

impl OutputOptions {
    /// Names of all fields that snapshots are asked for.
    pub fn all_fields(&self) -> impl Iterator<Item = &String> {
        let more = self.snapshots.iter().flat_map(|schedule| &schedule.fields);
        self.fields.iter().chain(more)
    }
}

/// Time of the clock between checkpoints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ClockInterval {
    /// So many seconds.
    Fixed(f64),
    /// What loses the least time, by what a checkpoint costs.
    Auto {
        /// Mean time between two failures of the machine (s).
        failures: f64,
    },
}

impl ClockInterval {
    /// Seconds from the end of a checkpoint to the next one, where one takes `cost` seconds.
    ///
    /// A failure, once in M seconds, costs half an interval τ, and checkpoints of δ seconds cost δ/τ of
    /// the time: the sum is least for τ = √(2 δ M) (Young, Comm. ACM 17 (1974) 530). It is the first
    /// order in δ/M; from δ = M/2 on it is M, where the higher orders end too (Daly, Future Gener.
    /// Comput. Syst. 22 (2006) 303).
    #[must_use]
    pub fn seconds(self, cost: f64) -> f64 {
        match self {
            Self::Fixed(seconds) => seconds,
            Self::Auto { failures } => (2.0 * cost * failures).sqrt().min(failures),
        }
    }
}

/// Snapshots beside the usual ones, of a part of the model or of other fields.
#[derive(Debug, Clone, PartialEq)]
pub struct SnapshotSchedule {
    /// Name of its folder.
    pub name: String,
    /// Time between them (s); the first and the last state alone if absent.
    pub every: Option<f64>,
    /// Names of the fields; the field table's defaults when empty.
    pub fields: Vec<String>,
    /// Bodies whose particles it holds; all if absent.
    pub bodies: Option<Vec<usize>>,
    /// What of space it holds; all if absent.
    pub region: Option<Region>,
    /// Of its numbers.
    pub precision: Precision,
}

/// How many digits numbers are written with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// Floating-point numbers of 64 bits.
    Double,
    /// Of 32 bits.
    Single,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checkpoints_come_as_often_as_loses_the_least_time() {
        let six_hours = 6.0 * 3600.0;
        let auto = ClockInterval::Auto {
            failures: six_hours,
        };
        // 14 s for 284 GB: 13 minutes.
        let interval = auto.seconds(14.0);
        assert!((interval - 777.7).abs() < 0.1, "{interval}");
        let lost = |interval: f64| 14.0 / interval + interval / (2.0 * six_hours);
        for other in [0.5, 0.9, 1.1, 2.0] {
            assert!(lost(other * interval) > lost(interval));
        }
        assert!(auto.seconds(six_hours) <= six_hours);
        assert!((ClockInterval::Fixed(5.0).seconds(14.0) - 5.0).abs() < f64::EPSILON);
    }
}
