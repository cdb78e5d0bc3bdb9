//! Random numbers that are a function of their keys: the same on any machine and any ranks, in any
//! order and after a restart.

/// The next word of a counter generator (Steele, Lea & Flood 2014, "Fast splittable pseudorandom
/// number generators").
pub fn split_mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A number above zero and below one, evenly drawn for each set of keys.
#[inline]
#[must_use]
pub fn uniform<const N: usize>(keys: [u64; N]) -> f64 {
    let word = keys.into_iter().fold(0, |word, key| {
        let mut state = word ^ key;
        split_mix(&mut state)
    });
    #[allow(clippy::cast_precision_loss)] // 53 bits, of which 52 are drawn
    let fraction = (word >> 12 << 1 | 1) as f64 / (1_u64 << 53) as f64;
    fraction
}

/// A number of the exponential distribution of mean one, drawn for each set of keys.
#[inline]
#[must_use]
pub fn exponential<const N: usize>(keys: [u64; N]) -> f64 {
    -libm::log(uniform(keys))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean, variance and the correlation of neighbours along each key are those of even draws.
    #[test]
    fn draws_are_even_and_free_of_their_neighbours() {
        let (n, count) = (100_000, 1e5_f64);
        for key in 0..3 {
            let at = |i: u64| {
                let mut keys = [7, 1_000_003, 5];
                keys[key] = i;
                uniform(keys) - 0.5
            };
            let mean = |f: &dyn Fn(u64) -> f64| (0..n).map(f).sum::<f64>() / count;
            let scatter = 3.0 / count.sqrt();
            assert!(mean(&at).abs() < scatter / 12.0_f64.sqrt());
            assert!((mean(&|i| at(i) * at(i)) - 1.0 / 12.0).abs() < scatter / 180.0_f64.sqrt());
            assert!(mean(&|i| at(i) * at(i + 1)).abs() < scatter / 12.0);
        }
        let mean = (0..n).map(|i| exponential([1, i])).sum::<f64>() / count;
        assert!((mean - 1.0).abs() < 3.0 / count.sqrt(), "{mean}");
    }
}
