//! Memory of a rank from its numbers of particles.

use super::waves::{RESTING, can_rest};
use engine::contact::ContactTable;
use engine::domain::MOST_UNEVEN;
use engine::gravity;
use engine::step::bytes_of_options;
use model::Case;

/// Memory of a process with MPI and HDF5 before it has a particle (bytes). This and the figures
/// below are peaks of the resident memory of ranks that step and write, measured on the quarter
/// impact with 48,000 and 195,000 particles on one to four ranks.
const PROCESS: f64 = 46.6e6;
/// An owned particle with its lists, those of glass, and buffers (bytes).
const OWNED: f64 = 700.0;
/// Addition for contact between bodies and images behind symmetry planes (bytes).
const CONTACT: f64 = 170.0;
/// A halo particle with its lists and messages (bytes).
const HALO: f64 = 1200.0;
/// Capacity of growing arrays over their content.
const SPARE: f64 = 1.06;

/// Rise of a rank's share of moving particles as work is balanced: broken or touching ones take more.
pub const UNEVEN: f64 = 1.2;

/// Most rise of the share of one of `ranks` ranks: particles at rest take less work, so that a rank gets more of them, but
/// no more than balances allow.
#[allow(clippy::cast_precision_loss, reason = "few ranks")]
pub(super) fn uneven(case: &Case, ranks: usize) -> f64 {
    if case.domain.balance_every == 0 || ranks < 2 {
        return 1.0;
    }
    if !can_rest(case) {
        return UNEVEN;
    }
    // All that moves is on the other ranks.
    let (moves, rests) = ((ranks - 1) as f64, 1.0 / RESTING);
    let most = ranks as f64 * rests / (moves + rests);
    most.min(MOST_UNEVEN as f64)
}

/// Peak memory of a rank (bytes).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Costs {
    /// Before it has a particle.
    process: f64,
    /// For each particle that it owns.
    owned: f64,
    /// For each of other ranks.
    halo: f64,
}

impl Costs {
    /// Costs of a case.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "an estimate")]
    pub fn of_case(case: &Case) -> Self {
        let contact = ContactTable::of_kinds(case).is_active();
        let trees = case.loads.self_gravity.map_or([0; 2], |_| gravity::BYTES);
        let options = bytes_of_options(case);
        let options = [0, 1].map(|k| SPARE * (options[k] + trees[k]) as f64);
        let meshes = case.meshes().into_iter().map(|(_, mesh)| mesh.memory());
        // Each rank reads all of a file.
        let clouds = case.bodies.iter().filter_map(|body| body.cloud());
        let read = clouds.map(|(cloud, _)| cloud.memory());
        Self {
            process: PROCESS + meshes.chain(read).sum::<usize>() as f64,
            owned: OWNED + if contact { CONTACT } else { 0.0 } + options[0],
            halo: HALO + options[1],
        }
    }

    /// Memory (bytes) of a rank with `owned` particles and `halo` of others; stress points count as particles.
    #[must_use]
    pub fn of(self, owned: f64, halo: f64) -> f64 {
        self.process + owned * self.owned + halo * self.halo
    }
}
