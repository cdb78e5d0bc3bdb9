//! Images near a box: eight of the sequence at a time.

use super::sequence::{Eight, Sequence};
use numerics::lanes::{LANES, Lanes};

/// Box tests reach this much farther than the kernel, so that rounding
/// never drops a pair with a contribution.
pub(super) const INFLATION: f64 = 1.0 + 1e-9;

/// Three values, each in all lanes. The `map` of an array may be compiled apart from its caller, without its instructions.
#[inline(always)]
pub(super) fn splat_each<V: Lanes>([x, y, z]: [f64; 3]) -> [V; 3] {
    [V::splat(x), V::splat(y), V::splat(z)]
}

/// Calls `found` with each eight images of a group that stand by a box, the index of the first, a bit for
/// each of them that is nearer than `range` (m), which is nowhere more than `far`, and the squares of their
/// distances (m²).
/// `hints` are where the last box nearby began to read columns, by the last bits of their indices.
#[inline(always)]
pub(super) fn near_box<V: Lanes>(
    sequence: &Sequence,
    group: usize,
    (lower, upper): (&[f64; 3], &[f64; 3]),
    far: f64,
    hints: &mut [usize; 64],
    range: impl Fn(&Eight) -> V,
    mut found: impl FnMut(usize, u8, &Eight, V),
) {
    let (low, high) = (splat_each::<V>(*lower), splat_each::<V>(*upper));
    let along = sequence.along(group);
    let (from, to) = (lower[along] - far, upper[along] + far);
    for ([a, b], column) in sequence.columns_near(group, lower, upper, far) {
        let hint = &mut hints[(a & 7) << 3 | b & 7];
        *hint = sequence.seek::<V>(group, &column, from, *hint);
        let mut first = *hint;
        for eight in sequence.eights(first..column.end) {
            if eight.coordinates[along][0] > to {
                break;
            }
            let [x, y, z] = gaps(&eight, &low, &high);
            let square = z.mul_add(z, y.mul_add(y, x.mul(x)));
            let range = range(&eight);
            let mut bits = square.less_than(range.mul(range));
            let left = column.end - first;
            if left < LANES {
                bits &= (1 << left) - 1;
            }
            found(first, bits, &eight, square);
            first += LANES;
        }
    }
}

/// Distances of images from a box along each axis (m).
#[inline(always)]
fn gaps<V: Lanes>(eight: &Eight, low: &[V; 3], high: &[V; 3]) -> [V; 3] {
    let mut gaps = [V::splat(0.0); 3];
    for a in 0..3 {
        let x = V::read(eight.coordinates[a]);
        gaps[a] = low[a].sub(x).max(x.sub(high[a])).max(gaps[a]);
    }
    gaps
}

/// Writes `first + k` for each set bit k at `list[used..]`; returns the new end.
#[inline(always)]
pub(super) fn push_places(list: &mut Vec<u32>, used: usize, first: usize, bits: u8) -> usize {
    if list.len() < used + LANES {
        grow(list, used + LANES);
    }
    let offsets = OFFSETS[bits as usize];
    #[allow(clippy::cast_possible_truncation, reason = "images fit u32")]
    let first = first as u32;
    let mut indices = [first; LANES];
    for k in 0..LANES {
        indices[k] += u32::from(offsets[k]);
    }
    list[used..used + LANES].copy_from_slice(&indices);
    used + bits.count_ones() as usize
}

/// Writes the numbers of a vector's set bits at `list[used..]`, as [`push_places`] does with places.
#[inline(always)]
pub(super) fn push_numbers(list: &mut Vec<f64>, used: usize, numbers: &[f64; LANES], bits: u8) {
    // Whoever reads them by eights reads as far beyond the last one.
    if list.len() < used + 2 * LANES {
        list.resize(used + used / 4 + 512, 0.0);
    }
    let offsets = OFFSETS[bits as usize];
    let mut chosen = [0.0; LANES];
    for k in 0..LANES {
        // The mask spares a look at the bound.
        chosen[k] = numbers[usize::from(offsets[k]) & (LANES - 1)];
    }
    list[used..used + LANES].copy_from_slice(&chosen);
}

/// Lists fill most of a rank's memory beside the particles: they grow by little.
#[cold]
fn grow(list: &mut Vec<u32>, length: usize) {
    let wanted = (length + length / 16).max(1 << 12);
    list.reserve_exact(wanted - list.len());
    list.resize(wanted, 0);
}

/// For each set of bits, its members in ascending order, and whatever.
static OFFSETS: [[u8; LANES]; 256] = {
    let mut table = [[0; LANES]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut k, mut next) = (0, 0);
        while k < 8 {
            if bits >> k & 1 == 1 {
                table[bits][next] = k;
                next += 1;
            }
            k += 1;
        }
        bits += 1;
    }
    table
};
