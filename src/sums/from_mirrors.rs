//! What a sweep finds of the images behind symmetry planes.

use particles::MirrorForce;

/// What the images behind symmetry planes exert on the particles of a chunk.
#[derive(Debug, Clone, Default)]
pub struct FromMirrors {
    /// The images among the neighbours of one cluster.
    pub indices: Vec<u32>,
    /// What they do to single particles.
    pub forces: Vec<MirrorForce>,
}

impl FromMirrors {
    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        4 * self.indices.capacity() + size_of::<MirrorForce>() * self.forces.capacity()
    }
}
