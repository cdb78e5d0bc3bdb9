//! A particle or what stands of it behind symmetry planes.

use crate::Mirrors;

/// A particle or one of its mirror images: index in the store and the planes it is behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct Image(u32);

impl Image {
    /// Largest number of particles of a rank.
    pub const MAX_PARTICLES: usize = 1 << 29;

    /// Image of particle `base` behind the planes whose axis bits are set in `code`.
    #[inline]
    #[must_use]
    pub fn new(base: usize, code: u8) -> Self {
        debug_assert!(base < Self::MAX_PARTICLES && code < 8);
        #[allow(
            clippy::cast_possible_truncation,
            reason = "checked when particles are counted"
        )]
        Self(base as u32 | u32::from(code) << 29)
    }

    /// Index in the store.
    #[inline]
    #[must_use]
    pub fn base(self) -> usize {
        self.0 as usize & (Self::MAX_PARTICLES - 1)
    }

    /// Bit a set: behind the symmetry plane normal to axis a.
    #[inline]
    #[must_use]
    pub fn code(self) -> u8 {
        (self.0 >> 29) as u8
    }
}

/// What an own particle of a rank may meet beside the other own ones.
#[derive(Debug, Clone, Copy)]
pub struct HaloImages<'a> {
    /// The images of owned particles behind symmetry planes, and the halo particles with theirs.
    pub images: &'a [Image],
    /// How many of them, the first ones, stand below this rank's own particles as far as ranks can say: a hint for
    /// their sort.
    pub below: usize,
    /// The symmetry planes.
    pub mirrors: &'a Mirrors,
}
