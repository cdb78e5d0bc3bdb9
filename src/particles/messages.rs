//! Particles in messages: field by field, packed and unpacked by all threads.

use rayon::prelude::*;

use super::arrays::GRAIN;
use super::fields::{FIELDS, ParticleStore};
use super::select::Select;

/// Bytes that a task copies.
const PIECE: usize = 1 << 16;

/// Copies bytes by all threads.
///
/// # Panics
/// If there are not as many slots.
pub fn copy_at_once(values: &[u8], slots: &mut [u8]) {
    assert_eq!(values.len(), slots.len(), "bytes and slots");
    let pieces = slots.par_chunks_mut(PIECE).zip(values.par_chunks(PIECE));
    pieces.for_each(|(slots, values)| slots.copy_from_slice(values));
}

impl ParticleStore {
    /// Appends to `buffer` the fields of `which` of the particles `indices`, field by field.
    pub fn pack(&self, which: impl Select, indices: &[u32], buffer: &mut Vec<u8>) {
        let start = buffer.len();
        buffer.resize(start + indices.len() * self.bytes_per_particle(which), 0);
        let (mut rest, mut fields) = (&mut buffer[start..], self.held(which));
        let parts: [_; FIELDS.len()] = std::array::from_fn(|_| {
            let field = fields.next()?;
            let length = indices.len() * field.kind.bytes();
            let (part, after) = std::mem::take(&mut rest).split_at_mut(length);
            rest = after;
            Some((field, part))
        });
        parts.into_par_iter().flatten().for_each(|(field, part)| {
            let (size, bytes) = (field.kind.bytes(), self.bytes(field.id));
            let slots = part.par_chunks_exact_mut(size).zip(indices);
            slots.with_min_len(GRAIN).for_each(|(slot, &index)| {
                let start = index as usize * size;
                slot.copy_from_slice(&bytes[start..start + size]);
            });
        });
    }

    /// Writes what [`Self::pack`] produced for `count` particles into slots `first..`.
    ///
    /// # Panics
    /// If `bytes` is not exactly `count` particles of those fields.
    pub fn unpack(&mut self, which: impl Select, first: usize, count: usize, bytes: &[u8]) {
        self.unpack_all(which, first, &[count], |_| bytes);
    }

    /// The same of several messages one after the other, of so many particles each.
    ///
    /// # Panics
    /// If a message is not exactly so many particles of those fields.
    pub fn unpack_all<'a>(
        &mut self,
        which: impl Select,
        first: usize,
        counts: &[usize],
        message: impl Fn(usize) -> &'a [u8] + Sync,
    ) {
        let (places, size) = (self.places(which), self.bytes_per_particle(which));
        for (k, count) in counts.iter().enumerate() {
            let is_whole = message(k).len() == count * size;
            assert!(is_whole, "a particle message of the wrong length");
        }
        let held = self.arrays().into_par_iter().zip(places).enumerate();
        held.for_each(|(row, (mut array, place))| {
            let Some(place) = place else { return };
            let size = FIELDS[row].kind.bytes();
            let mut rest = &mut array.bytes()[first * size..];
            for (k, count) in counts.iter().enumerate() {
                let (slots, after) = rest.split_at_mut(count * size);
                let values = &message(k)[count * place..][..slots.len()];
                copy_at_once(values, slots);
                rest = after;
            }
        });
    }
}
