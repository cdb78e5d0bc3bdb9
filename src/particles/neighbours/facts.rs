//! Facts of an image that the sequence needs.

/// Facts of one image that the sequence needs.
#[derive(Debug, Clone, Copy)]
pub struct ImageFacts {
    /// Its own position (m), mirrored where it is an image.
    pub position: [f64; 3],
    /// Identity of the particle.
    pub id: u64,
    /// Group of bodies.
    pub group: usize,
    /// Smoothing length (m).
    pub smoothing_length: f64,
}

/// True if there is anything to sum around an image.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ImageState {
    /// True if its velocity is another than the one common to its group at rest in itself.
    pub moving: bool,
    /// True if nothing changes it as long as nothing moves around it, as far as this rank knows.
    pub resting: bool,
}

impl ImageState {
    /// As flags.
    pub(super) fn flags(self) -> u8 {
        let moving = if self.moving { MOVING } else { 0 };
        let active = if self.resting { 0 } else { ACTIVE };
        moving | active
    }
}

/// Behind a symmetry plane.
pub(super) const MIRROR: u8 = 1;
/// Of another rank.
pub(super) const HALO: u8 = 2;
/// Not at the group's common velocity.
pub(super) const MOVING: u8 = 4;
/// Not [at rest](ImageState::resting).
pub(super) const ACTIVE: u8 = 8;
/// Everything but particles of this rank themselves.
pub(super) const IMAGE: u8 = MIRROR | HALO;
