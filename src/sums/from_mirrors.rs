//! Forces that a sweep finds of the images behind symmetry planes.

use particles::MirrorForce;

/// Forces of the images behind symmetry planes on the particles of a chunk.
#[derive(Debug, Clone, Default)]
pub struct FromMirrors {
    /// The images among the neighbours of one cluster.
    pub indices: Vec<u32>,
    /// Their forces on single particles.
    pub forces: Vec<MirrorForce>,
}

impl FromMirrors {
    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        4 * self.indices.capacity() + size_of::<MirrorForce>() * self.forces.capacity()
    }
}
