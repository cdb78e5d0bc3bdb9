//! Speeds of the fastest signals, for the time step.

use sums::momentum::Viscosity;

/// Inputs of the signal speeds of owned particles.
#[derive(Debug, Clone, Copy)]
pub struct Signals<'a> {
    pub(super) viscosity: Viscosity,
    pub(super) dimension: usize,
    pub(super) sound_speed: &'a [f64],
    pub(super) approach_speed: &'a [f64],
    /// In the normalised form.
    pub(super) correction_norm: &'a [f64],
    /// Of stress points.
    pub(super) fit_norm: &'a [f64],
}

/// Effect of a formulation on the speed of signals.
pub trait SignalSpeed: Sync {
    /// Speed (m/s) for the step of particle `i`, from that by plain sums.
    fn speed(signals: &Signals, i: usize, plain: f64) -> f64;
}

impl Signals<'_> {
    /// Speed (m/s) of sound and viscosity of particle `i`: no less than that of the approach,
    /// however little viscosity there is. Sound counts as no faster than `fastest` (m/s).
    #[inline(always)]
    #[must_use]
    pub fn of<F: SignalSpeed>(&self, i: usize, fastest: f64) -> f64 {
        let Viscosity { alpha, beta, .. } = self.viscosity;
        let own = self.sound_speed[i];
        // NaN stays NaN.
        let c = if own > fastest { fastest } else { own };
        let approach = self.approach_speed[i];
        let signal = c + 0.6 * (alpha * c + beta * approach);
        // Not `max`, which would hide what is NaN.
        let signal = if approach > signal { approach } else { signal };
        F::speed(self, i, signal)
    }
}
