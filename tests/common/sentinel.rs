//! Particles whose every number tells where it belongs.

use particles::FIELDS;

/// The id of particle k: no order in it, 40 bits.
pub fn id(k: u64) -> u64 {
    mix(k) >> 24 << 16 | k
}

/// The bytes of a field's row. Random bits, so NaN payloads, infinities and −0.0 are among them.
pub fn sentinel(id: u64, field: usize, bytes: &mut [u8]) {
    if FIELDS[field].name == "id" {
        bytes.copy_from_slice(&id.to_ne_bytes());
        return;
    }
    for (component, number) in bytes.chunks_mut(8).enumerate() {
        let seed = mix(id ^ (field as u64 * 16 + component as u64) << 56);
        let bits = match seed % 11 {
            0 => 0x7ff0_0000_dead_beef,
            1 => 0xfff8_0000_0000_0001,
            2 => 0x8000_0000_0000_0000,
            3 => 1,
            _ => mix(seed),
        };
        number.copy_from_slice(&bits.to_ne_bytes()[..number.len()]);
    }
}

/// `SplitMix64`.
pub fn mix(seed: u64) -> u64 {
    let z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
