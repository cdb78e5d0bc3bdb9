//! Names of mirror images: the planes that they stand behind.

/// Symmetry planes that an image of a particle stands behind, by the axes that they are normal to;
/// the particle itself stands behind none.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
#[repr(transparent)]
pub struct MirrorMask(u8);

impl MirrorMask {
    /// The particle itself.
    pub const OWN: Self = Self(0);

    /// Mask whose bit a is set if the image stands behind the plane normal to axis a.
    #[inline(always)]
    #[must_use]
    pub const fn from_bits(bits: u8) -> Self {
        debug_assert!(bits < 8);
        Self(bits)
    }

    /// Bit a set: behind the plane normal to axis a.
    #[inline(always)]
    #[must_use]
    pub const fn bits(self) -> u8 {
        self.0
    }

    /// True if this is the particle itself.
    #[inline(always)]
    #[must_use]
    pub const fn is_own(self) -> bool {
        self.0 == 0
    }

    /// True if the plane normal to an axis is among these.
    #[inline(always)]
    #[must_use]
    pub const fn has(self, axis: usize) -> bool {
        self.0 >> axis & 1 == 1
    }

    /// These planes and the one normal to an axis.
    #[inline(always)]
    #[must_use]
    pub const fn with(self, axis: usize) -> Self {
        Self(self.0 | 1 << axis)
    }

    /// True if all of these are among other planes.
    #[inline(always)]
    #[must_use]
    pub const fn is_within(self, planes: Self) -> bool {
        self.0 & !planes.0 == 0
    }

    /// True if none of these is among other planes.
    #[inline(always)]
    #[must_use]
    pub const fn is_disjoint(self, planes: Self) -> bool {
        self.0 & planes.0 == 0
    }

    /// True if the component of a tensor along two axes changes its sign.
    #[inline(always)]
    #[must_use]
    pub const fn flips(self, a: usize, b: usize) -> bool {
        (self.0 >> a ^ self.0 >> b) & 1 == 1
    }

    /// All masks, that of the particle itself first.
    #[inline(always)]
    pub fn all() -> impl Iterator<Item = Self> {
        (0..8).map(Self)
    }

    /// Masks of the images behind some or all of these planes, and of the particle itself first if
    /// `own`.
    #[inline(always)]
    pub fn subsets(self, own: bool) -> impl Iterator<Item = Self> {
        let masks = (u8::from(!own)..8).map(Self);
        masks.filter(move |mask| mask.is_within(self))
    }
}
