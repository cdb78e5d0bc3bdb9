//! Data of particles for other ranks beside their fields.

/// Bytes of this rank's particles, and those that it has received of halo particles.
pub trait Payload: Sync {
    /// Bytes of a particle.
    fn size(&self) -> usize;

    /// Those of a particle of this rank.
    fn of(&self, particle: usize) -> &[u8];

    /// Buffer for those of so many halo particles, one after the other.
    fn received(&mut self, halo: usize) -> &mut [u8];
}
