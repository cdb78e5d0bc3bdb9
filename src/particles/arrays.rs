//! Arrays of what particles hold: their order and length.

use rayon::prelude::*;

/// Words of scratch memory for each particle when a store is reordered: so much of a particle's
/// element moves at once.
pub const SCRATCH_WORDS: usize = 3;

/// Reorders `values[..order.len()]` so that new element k is old element `order[k]`.
pub(super) fn gather<T: bytemuck::Pod>(values: &mut [T], order: &[u32], scratch: &mut [u64]) {
    if !size_of::<T>().is_multiple_of(8) {
        let values: &mut [u32] = bytemuck::cast_slice_mut(values);
        return gather_words(values, 1, order, scratch);
    }
    let values: &mut [u64] = bytemuck::cast_slice_mut(values);
    gather_words(values, size_of::<T>() / 8, order, scratch);
}

/// Reorders elements of `size` words, a few words of each at a time: scratch stays small.
fn gather_words<W: bytemuck::Pod + Send + Sync>(
    values: &mut [W],
    size: usize,
    order: &[u32],
    scratch: &mut [u64],
) {
    let copy: &mut [W] = bytemuck::cast_slice_mut(scratch);
    for first in (0..size).step_by(SCRATCH_WORDS) {
        let piece = first..size.min(first + SCRATCH_WORDS);
        let width = piece.len();
        copy.par_chunks_exact_mut(width)
            .zip(order)
            .with_min_len(GRAIN)
            .for_each(|(slot, &old)| {
                let old = old as usize * size;
                slot.copy_from_slice(&values[old + piece.start..old + piece.end]);
            });
        values
            .par_chunks_exact_mut(size)
            .zip(copy.par_chunks_exact(width))
            .take(order.len())
            .with_min_len(GRAIN)
            .for_each(|(value, new)| value[piece.clone()].copy_from_slice(new));
    }
}

/// Elements that a task moves at least.
pub(super) const GRAIN: usize = 4096;

/// The array of a field, whatever its kind.
pub(super) enum FieldArray<'a> {
    Scalar(&'a mut Vec<f64>),
    Vector(&'a mut Vec<[f64; 3]>),
    Symmetric(&'a mut Vec<[f64; 6]>),
    Tensor(&'a mut Vec<[f64; 9]>),
    Id(&'a mut Vec<u64>),
    Index(&'a mut Vec<u32>),
}

impl FieldArray<'_> {
    /// Sets the length, zero-filling.
    pub fn resize(&mut self, length: usize) {
        match self {
            Self::Scalar(values) => resize(values, length),
            Self::Vector(values) => resize(values, length),
            Self::Symmetric(values) => resize(values, length),
            Self::Tensor(values) => resize(values, length),
            Self::Id(values) => resize(values, length),
            Self::Index(values) => resize(values, length),
        }
    }

    /// The values as bytes.
    pub fn bytes(&mut self) -> &mut [u8] {
        match self {
            Self::Scalar(values) => bytemuck::cast_slice_mut(values),
            Self::Vector(values) => bytemuck::cast_slice_mut(values),
            Self::Symmetric(values) => bytemuck::cast_slice_mut(values),
            Self::Tensor(values) => bytemuck::cast_slice_mut(values),
            Self::Id(values) => bytemuck::cast_slice_mut(values),
            Self::Index(values) => bytemuck::cast_slice_mut(values),
        }
    }
}

/// Sets the length, zero-filling; grows by a sixteenth more than asked, not by doubling, since
/// most of a rank's memory is here (and at first by just what is asked).
///
/// All threads touch the memory of a first allocation, so that a machine that keeps a page near
/// whoever touches it first spreads them.
pub fn resize<T: bytemuck::Zeroable + Copy + Send + Sync>(values: &mut Vec<T>, length: usize) {
    if values.capacity() == 0 {
        *values = bytemuck::zeroed_vec(length);
        let touch = |chunk: &mut [T]| chunk.fill(T::zeroed());
        values.par_chunks_mut(GRAIN).for_each(touch);
        return;
    }
    if length > values.capacity() {
        values.reserve_exact(length + length / 16 - values.len());
    }
    if length > values.len() + GRAIN {
        let zeros = rayon::iter::repeat_n(T::zeroed(), length - values.len());
        return values.par_extend(zeros.with_min_len(GRAIN));
    }
    values.resize(length, T::zeroed());
}

/// Empties a buffer, and gives room back that is far more than what it held took: other matter comes to
/// a chunk from step to step, and with it the most that any has.
pub fn empty<T>(values: &mut Vec<T>) {
    if values.capacity() > 4 * values.len() + 16 {
        values.shrink_to(2 * values.len());
    }
    values.clear();
}
