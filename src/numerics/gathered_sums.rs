//! Several exact sums of terms that come together, such as those of one particle after the other.

use super::exact_sum::{BLOCK, ExactSum};

/// Powers of two would have all of a particle's terms in the same lines of the cache.
const STRIDE: usize = BLOCK + 8;

/// Exact sums of `N` quantities: terms wait until there are enough to be added at once.
#[derive(Debug, Clone)]
pub struct GatheredSums<const N: usize> {
    sums: [ExactSum; N],
    /// [`BLOCK`] terms of each quantity, [`STRIDE`] from those of the one before; in place, since steps add
    /// sums and may not allocate.
    waiting: [[f64; STRIDE]; N],
    count: usize,
}

impl<const N: usize> Default for GatheredSums<N> {
    fn default() -> Self {
        Self {
            sums: std::array::from_fn(|_| ExactSum::default()),
            waiting: [[0.0; STRIDE]; N],
            count: 0,
        }
    }
}

impl<const N: usize> GatheredSums<N> {
    /// Adds a term to each sum.
    #[inline]
    pub fn add(&mut self, terms: &[f64; N]) {
        for (waiting, term) in self.waiting.iter_mut().zip(terms) {
            waiting[self.count] = *term;
        }
        self.count += 1;
        if self.count == BLOCK {
            self.add_waiting();
        }
    }

    /// Adds what other terms have been summed up to.
    pub fn merge_sums(&mut self, others: &[ExactSum; N]) {
        for (sum, other) in self.sums.iter_mut().zip(others) {
            sum.merge(other);
        }
    }

    /// The sums, of all terms so far.
    pub fn sums(&mut self) -> &mut [ExactSum; N] {
        self.add_waiting();
        &mut self.sums
    }

    /// The sums, of all terms.
    #[must_use]
    pub fn into_sums(mut self) -> [ExactSum; N] {
        self.add_waiting();
        self.sums
    }

    fn add_waiting(&mut self) {
        let count = std::mem::take(&mut self.count);
        for (sum, terms) in self.sums.iter_mut().zip(&self.waiting) {
            sum.add_all(&terms[..count]);
        }
    }
}

/// Sums of no terms.
#[must_use]
pub fn none<const N: usize>() -> [ExactSum; N] {
    std::array::from_fn(|_| ExactSum::default())
}

/// Sums of the terms of both: for `reduce`, which passes values.
#[must_use]
#[allow(clippy::needless_pass_by_value)]
pub fn merged<const N: usize>(mut sums: [ExactSum; N], others: [ExactSum; N]) -> [ExactSum; N] {
    for (sum, other) in sums.iter_mut().zip(&others) {
        sum.merge(other);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gathered_sums_are_those_of_their_terms() {
        let term = |i: u32| {
            let x = f64::from(i) - 300.0;
            [1.0 / x, x * 1e-40, x * x * x * 1e200]
        };
        let mut gathered = [GatheredSums::default(), GatheredSums::default()];
        let mut plain: [ExactSum; 3] = std::array::from_fn(|_| ExactSum::default());
        for i in 0..777 {
            let terms = if i == 300 { [0.0; 3] } else { term(i) };
            gathered[usize::from(i % 3 == 0)].add(&terms);
            for (sum, term) in plain.iter_mut().zip(terms) {
                sum.add(term);
            }
        }
        let [mut all, other] = gathered;
        all.merge_sums(&other.into_sums());
        for (sum, plain) in all.into_sums().iter().zip(&plain) {
            assert_eq!(sum.value().to_bits(), plain.value().to_bits());
        }
    }
}
