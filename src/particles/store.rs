//! Walks over the table of fields: sizes and order.

use std::borrow::Cow;

use rayon::prelude::*;

use super::arrays::SCRATCH_WORDS;
use super::columns::{HaloPhase, Life, Owner};
use super::fields::{FIELDS, FieldInfo, ParticleStore};
use super::select::Select;
use material::Material;

impl ParticleStore {
    /// Number of particles this rank owns.
    #[must_use]
    pub fn owned(&self) -> usize {
        self.owned
    }

    /// Temperature (K) of particle `i` of this material, if that has thermal constants.
    #[must_use]
    pub fn temperature(&self, material: &Material, i: usize) -> Option<f64> {
        let held = |field: &[f64]| field.get(i).copied().unwrap_or_default();
        let work = held(&self.plastic_energy);
        let energy = material.thermal_energy(self.specific_energy[i], work);
        let state = [held(&self.damage), held(&self.distension)];
        material.temperature(self.density[i], energy, state)
    }

    /// Number of halo particles.
    #[must_use]
    pub fn halo(&self) -> usize {
        self.halo
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.capacity_bytes()
    }

    /// The mass that a particle's specific energy belongs to (kg): also of stress points, which
    /// have no mass that moves.
    #[inline]
    #[must_use]
    pub fn thermal_mass(&self, i: usize) -> f64 {
        self.mass[i] + self.stress_mass.get(i).copied().unwrap_or_default()
    }

    /// Gives up the fields that only the options `unused` of a case have use for.
    pub fn drop_fields(&mut self, unused: Owner) {
        self.unused |= unused;
        let unused = self.unused;
        for field in rows(unused).filter(|field| !field.is_held_without(unused)) {
            self.free_field(field.id);
        }
    }

    /// Rows of the table that this store holds and `which` takes.
    pub fn held<S: Select>(&self, which: S) -> impl Iterator<Item = &'static FieldInfo> + use<S> {
        let unused = self.unused;
        rows(which).filter(move |field| field.is_held_without(unused))
    }

    /// True if the case has use for a field.
    #[must_use]
    pub fn holds(&self, field: &FieldInfo) -> bool {
        field.is_held_without(self.unused)
    }

    /// Bytes that a particle's fields of `which` take in a message.
    #[must_use]
    pub fn bytes_per_particle(&self, which: impl Select) -> usize {
        self.held(which).map(|field| field.kind.bytes()).sum()
    }

    /// A field's values as bytes, zeros for a field that is not held.
    #[must_use]
    pub fn bytes_or_zeros(&self, field: &FieldInfo) -> Cow<'_, [u8]> {
        let bytes = self.bytes(field.id);
        let size = self.owned * field.kind.bytes();
        if bytes.len() < size {
            Cow::Owned(vec![0; size])
        } else {
            Cow::Borrowed(bytes)
        }
    }

    /// Sets the number of owned particles, zero-filling new ones; drops the halo.
    pub fn resize_owned(&mut self, owned: usize) {
        self.owned = owned;
        self.halo = 0;
        self.resize_fields(FieldInfo::any, owned);
    }

    /// Sets the number of owned particles and sizes `fields` alone, zero-filling new values; drops
    /// the halo. [`Self::resize_owned`] sizes the others, before anything else is done with them.
    pub fn resize_owned_in(&mut self, fields: &[&FieldInfo], owned: usize) {
        self.owned = owned;
        self.halo = 0;
        let mut arrays = self.arrays();
        for field in fields {
            arrays[field.id as usize].resize(owned);
        }
    }

    /// Appends the owned particles of another store, with zeros for what that does not hold; drops
    /// the halo.
    pub fn append(&mut self, other: &Self) {
        let first = self.owned;
        self.resize_owned(first + other.owned);
        for field in self.held(FieldInfo::any) {
            let size = field.kind.bytes();
            let bytes = &mut self.bytes_mut(field.id)[first * size..];
            bytes.copy_from_slice(&other.bytes_or_zeros(field)[..other.owned * size]);
        }
    }

    /// The messages in which halo particles get fields.
    #[must_use]
    pub fn halo_phases(&self) -> HaloPhase {
        if self.unused.contains(Owner::LOCALISED) {
            HaloPhase::all() - HaloPhase::STRAIN
        } else {
            HaloPhase::all()
        }
    }

    /// What halo particles get with their motion.
    #[must_use]
    pub fn motion_phase(&self) -> HaloPhase {
        self.halo_phases() & (HaloPhase::MOTION | HaloPhase::STRAIN)
    }

    /// Sets the number of halo particles.
    pub fn resize_halo(&mut self, halo: usize) {
        self.halo = halo;
        self.resize_fields(self.halo_phases(), self.owned + halo);
    }

    fn resize_fields(&mut self, which: impl Select, length: usize) {
        let places = self.places(which);
        let arrays = self.arrays();
        let held = arrays.into_par_iter().zip(places);
        held.filter(|(_, place)| place.is_some())
            .for_each(|(mut array, _)| array.resize(length));
    }

    /// For each row of the table where the bytes of its field begin in those of a particle, if `which`
    /// takes it.
    pub(super) fn places(&self, which: impl Select) -> [Option<usize>; FIELDS.len()] {
        let (mut places, mut next) = ([None; FIELDS.len()], 0);
        for field in self.held(which) {
            places[field.id as usize] = Some(next);
            next += field.kind.bytes();
        }
        places
    }

    /// Keeps the owned particles `order`, in that order; drops the halo. `scratch` is memory to
    /// work in, at least [`SCRATCH_WORDS`] for each.
    ///
    /// # Panics
    /// If `scratch` is too short.
    pub fn keep(&mut self, order: &[u32], scratch: &mut [u64]) {
        self.unmoved = 0;
        self.rearrange(order, scratch);
    }

    /// [`Self::keep`] of an order in which inactive particles stay where they are.
    ///
    /// # Panics
    /// If `scratch` is too short.
    pub fn rearrange(&mut self, order: &[u32], scratch: &mut [u64]) {
        assert!(
            scratch.len() >= SCRATCH_WORDS * order.len(),
            "too little scratch"
        );
        self.resize_halo(0);
        for field in self.held(FieldInfo::any) {
            self.gather_field(field.id, order, scratch);
        }
        self.resize_owned(order.len());
    }

    /// Number of the first owned particles among which the inactive ones stand where they did at the last call.
    pub fn take_unmoved(&mut self) -> usize {
        let unmoved = self.unmoved.min(self.owned);
        self.unmoved = usize::MAX;
        unmoved
    }

    /// Removes owned particles and the halo; the last ones take the places of those `leaving`
    /// (indices in any order, which this sorts). `moves` is scratch.
    pub fn remove(&mut self, leaving: &mut [u32], moves: &mut Vec<(u32, u32)>) {
        self.resize_halo(0);
        leaving.sort_unstable();
        let left = self.owned - leaving.len();
        self.unmoved = self.unmoved.min(left);
        #[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
        let (left_u32, owned) = (left as u32, self.owned as u32);
        let (holes, gone) = leaving.split_at(leaving.partition_point(|&i| i < left_u32));
        let staying = (left_u32..owned).filter(|i| gone.binary_search(i).is_err());
        moves.clear();
        moves.extend(holes.iter().copied().zip(staying));
        for field in self.held(FieldInfo::any) {
            let size = field.kind.bytes();
            let bytes = self.bytes_mut(field.id);
            for &(to, from) in moves.iter() {
                let from = from as usize * size;
                bytes.copy_within(from..from + size, to as usize * size);
            }
        }
        self.resize_owned(left);
    }

    /// Overwrites every field that is not state with NaN (or the largest integer), so that a
    /// step which reads it before it writes it shows. For tests and debugging.
    pub fn poison(&mut self) {
        for field in FIELDS {
            if field.life != Life::State {
                self.bytes_mut(field.id).fill(0xff);
            }
        }
    }
}

/// Rows of the table that `which` takes.
pub fn rows<S: Select>(which: S) -> impl Iterator<Item = &'static FieldInfo> + use<S> {
    FIELDS.iter().filter(move |field| which.takes(field))
}

/// Names that a snapshot can be asked for: fields of the table and what is derived from them.
pub fn snapshot_names() -> impl Iterator<Item = &'static str> {
    rows(FieldInfo::is_shown).map(|field| field.name).chain([
        VON_MISES_STRESS,
        TEMPERATURE,
        FRAGMENT,
    ])
}

/// Names of what a gauge can read.
pub fn gauge_names() -> impl Iterator<Item = &'static str> {
    rows(|field: &FieldInfo| field.is_shown() && field.kind.is_real())
        .map(|field| field.name)
        .chain([STRESS, VON_MISES_STRESS, TEMPERATURE])
}

/// The stress that matter bears, tension positive: that of its material.
pub const STRESS: &str = "stress";
/// A quantity that snapshots derive from the stress.
pub const VON_MISES_STRESS: &str = "von_mises_stress";
/// A quantity of fragments in snapshots.
pub const FRAGMENT: &str = "fragment";
/// A quantity that snapshots derive from density and specific energy.
pub const TEMPERATURE: &str = "temperature";

#[cfg(test)]
mod tests {
    use super::*;

    #[allow(clippy::cast_possible_truncation, reason = "below 251")]
    /// A store whose every number tells its field, particle and component.
    fn sentinel(owned: usize) -> ParticleStore {
        let mut particles = ParticleStore::default();
        particles.resize_owned(owned);
        for (row, field) in FIELDS.iter().enumerate() {
            for (at, byte) in particles.bytes_mut(field.id).iter_mut().enumerate() {
                *byte = ((row * 31 + at * 7 + at / 8 * 13) % 251) as u8;
            }
        }
        particles
    }

    #[test]
    fn keep_reorders_every_field() {
        let before = sentinel(9);
        let mut after = before.clone();
        let order = [4, 0, 8, 3];
        after.keep(&order, &mut [0; 4 * SCRATCH_WORDS]);
        assert_eq!(after.owned(), 4);
        for field in FIELDS {
            let size = field.kind.bytes();
            for (new, &old) in order.iter().enumerate() {
                let old = old as usize;
                assert_eq!(
                    after.bytes(field.id)[new * size..(new + 1) * size],
                    before.bytes(field.id)[old * size..(old + 1) * size],
                    "{}",
                    field.name
                );
            }
        }
    }

    #[test]
    fn who_leaves_is_gone_and_who_stays_is_whole() {
        let before = sentinel(9);
        for leaving in [
            &[][..],
            &[8],
            &[0],
            &[7, 2, 8],
            &[0, 1, 2, 3, 4, 5, 6, 7, 8],
        ] {
            let mut after = before.clone();
            after.remove(&mut leaving.to_vec(), &mut Vec::new());
            assert_eq!(after.owned(), 9 - leaving.len());
            let row = |particles: &ParticleStore, i: usize| -> Vec<u8> {
                let part = |f: &FieldInfo| {
                    let size = f.kind.bytes();
                    particles.bytes(f.id)[i * size..(i + 1) * size].to_vec()
                };
                FIELDS.iter().flat_map(part).collect()
            };
            let mut left: Vec<_> = (0..after.owned()).map(|i| row(&after, i)).collect();
            let stays = |i: &usize| leaving.iter().all(|&k| k as usize != *i);
            let mut wanted: Vec<_> = (0..9).filter(stays).map(|i| row(&before, i)).collect();
            left.sort();
            wanted.sort();
            assert!(left == wanted);
        }
    }

    #[test]
    fn a_store_has_no_trace_of_what_it_dropped() {
        for unused in [Owner::CONTACT, Owner::LOADS, Owner::XSPH, Owner::all()] {
            let mut particles = sentinel(4);
            let message = particles.bytes_per_particle(FieldInfo::leaves);
            particles.drop_fields(Owner::BALSARA);
            particles.drop_fields(unused);
            particles.resize_owned(6);
            particles.resize_halo(3);
            particles.keep(&[2, 0], &mut [0; 2 * SCRATCH_WORDS]);
            assert!(particles.bytes_per_particle(FieldInfo::leaves) < message);
            for field in rows(unused | Owner::BALSARA) {
                assert!(particles.bytes(field.id).is_empty(), "{}", field.name);
                let zeros = particles.bytes_or_zeros(field);
                assert_eq!(*zeros, vec![0; 2 * field.kind.bytes()]);
            }
        }
    }

    /// Without a material that asks for strains about it nobody sends them, and halo particles have none.
    #[test]
    fn strains_of_halo_particles_are_held_where_they_are_sent() {
        for (unused, held) in [(Owner::empty(), 7), (Owner::LOCALISED, 4)] {
            let mut particles = sentinel(4);
            particles.drop_fields(unused);
            particles.resize_halo(3);
            assert_eq!(particles.plastic_strain.len(), held);
            assert_eq!(particles.damage.len(), held);
        }
    }

    #[test]
    fn messages_carry_every_field_of_their_phase() {
        assert_carried(FieldInfo::leaves);
        for phase in HaloPhase::all() {
            assert_carried(phase);
        }
    }

    fn assert_carried(which: impl Select) {
        let source = sentinel(7);
        let indices = [6, 2, 5];
        let mut message = Vec::new();
        source.pack(which, &indices, &mut message);
        assert_eq!(message.len(), 3 * source.bytes_per_particle(which));
        let mut target = ParticleStore::default();
        target.resize_owned(5);
        target.unpack(which, 1, 3, &message);
        for field in rows(which) {
            let size = field.kind.bytes();
            for (k, &old) in indices.iter().enumerate() {
                let old = old as usize;
                assert_eq!(
                    target.bytes(field.id)[(1 + k) * size..(2 + k) * size],
                    source.bytes(field.id)[old * size..(old + 1) * size],
                    "{}",
                    field.name
                );
            }
        }
    }
}
