//! A particle or what stands of it behind symmetry planes.

use crate::{MirrorMask, Mirrors};

/// A particle or one of its mirror images: index in the store and the planes it is behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct Image(u32);

impl Image {
    /// Largest number of particles of a rank.
    pub const MAX_PARTICLES: usize = 1 << 29;

    /// Image of particle `slot` behind the planes of a mirror mask.
    #[inline]
    #[must_use]
    pub fn new(slot: usize, mirror_mask: MirrorMask) -> Self {
        debug_assert!(slot < Self::MAX_PARTICLES);
        #[allow(
            clippy::cast_possible_truncation,
            reason = "checked when particles are counted"
        )]
        Self(slot as u32 | u32::from(mirror_mask.bits()) << 29)
    }

    /// Index in the store.
    #[inline]
    #[must_use]
    pub fn slot(self) -> usize {
        self.0 as usize & (Self::MAX_PARTICLES - 1)
    }

    /// The symmetry planes that it stands behind.
    #[inline]
    #[must_use]
    pub fn mirror_mask(self) -> MirrorMask {
        MirrorMask::from_bits((self.0 >> 29) as u8)
    }
}

/// Images that an own particle of a rank may meet beside the other own ones.
#[derive(Debug, Clone, Copy)]
pub struct HaloImages<'a> {
    /// The images of owned particles behind symmetry planes, and the halo particles with theirs.
    pub images: &'a [Image],
    /// Number of the first of them that are below this rank's own particles as far as ranks can
    /// say: a hint for their sort.
    pub below: usize,
    /// The symmetry planes.
    pub mirrors: &'a Mirrors,
}
