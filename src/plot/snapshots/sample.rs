//! A sample of very many values of particles.

use crate::colour::Scale;

/// Values that one snapshot adds at most, about.
const MOST: usize = 1 << 18;

/// A sample of the values of some snapshots, with their ends.
#[derive(Debug, Default)]
pub struct Sampled {
    values: Vec<f64>,
    ends: Option<[f64; 2]>,
    /// `true` if some are NaN.
    pub lost: bool,
}

/// Of how many of a snapshot's particles one is taken.
#[must_use]
pub fn every(particles: usize) -> usize {
    particles.div_ceil(MOST).max(1)
}

impl Sampled {
    /// Takes up some of the values of a snapshot of so many particles.
    pub fn extend(&mut self, values: impl Iterator<Item = f64>, particles: usize) {
        let every = every(particles);
        for (k, value) in values.enumerate() {
            if !value.is_finite() {
                self.lost = true;
                continue;
            }
            let [low, high] = self.ends.unwrap_or([value; 2]);
            self.ends = Some([low.min(value), high.max(value)]);
            if k.is_multiple_of(every) {
                self.values.push(value);
            }
        }
    }

    /// The value that a share of all do not reach; infinite without any.
    #[must_use]
    pub fn quantile(&self, share: f64) -> f64 {
        let mut sorted = self.values.clone();
        sorted.sort_by(f64::total_cmp);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a share of a length"
        )]
        let at = (share * sorted.len() as f64) as usize;
        sorted.get(at).copied().unwrap_or(f64::INFINITY)
    }

    /// The scale over a range, or over all.
    pub fn scale(&self, range: Option<[f64; 2]>) -> Scale {
        let ends = self.ends.into_iter().flatten();
        Scale::new(self.values.iter().copied().chain(ends), range)
    }
}
