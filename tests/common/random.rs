//! Random numbers that are the same on every machine and in every run.

/// `SplitMix64` (Steele, Lea & Flood 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = self.0;
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `lower..upper`.
    pub fn within(&mut self, lower: f64, upper: f64) -> f64 {
        #[allow(clippy::cast_precision_loss, reason = "53 bits")]
        let unit = (self.bits() >> 11) as f64 * (0.5_f64).powi(53);
        lower + unit * (upper - lower)
    }

    /// Uniform in `0..end`.
    pub fn below(&mut self, end: usize) -> usize {
        usize::try_from(self.bits() % end as u64).unwrap()
    }

    /// Three numbers, each uniform in `-size..size`, zero beyond the dimension.
    pub fn vector(&mut self, dimension: usize, size: f64) -> [f64; 3] {
        std::array::from_fn(|a| {
            if a < dimension {
                self.within(-size, size)
            } else {
                0.0
            }
        })
    }

    /// Puts the elements in random order (Fisher & Yates).
    pub fn shuffle<T>(&mut self, values: &mut [T]) {
        for end in (1..values.len()).rev() {
            values.swap(end, self.below(end + 1));
        }
    }
}
