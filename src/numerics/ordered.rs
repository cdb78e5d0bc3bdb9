//! Doubles as words that order as they do: what is smallest or largest of all ranks.

const SIGN: u64 = 1 << 63;

/// Bits that order as the doubles do.
#[must_use]
pub fn ordered(x: f64) -> u64 {
    let bits = x.to_bits();
    if bits & SIGN == 0 { bits | SIGN } else { !bits }
}

/// The double of [`ordered`] bits.
#[must_use]
pub fn disordered(bits: u64) -> f64 {
    f64::from_bits(if bits & SIGN == 0 {
        !bits
    } else {
        bits & !SIGN
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_order_as_their_doubles() {
        let all = [
            f64::NEG_INFINITY,
            -2.0,
            -1e-300,
            -0.0,
            0.0,
            1e-300,
            3.0,
            f64::INFINITY,
        ];
        for pair in all.windows(2) {
            assert!(ordered(pair[0]) < ordered(pair[1]), "{pair:?}");
        }
        for x in all {
            assert_eq!(disordered(ordered(x)).to_bits(), x.to_bits());
        }
    }
}
