//! The virial of contact forces, for what snapshots show (theory page "Contact").

use rayon::prelude::*;

use super::force::Borne;
use super::mode::borne_of;
use super::phase::Contact;
use super::view::ContactView;
use model::ContactClass;
use particles::ParticleStore;
use particles::neighbours::{CHUNKS_AT_ONCE, Lists};

impl Contact {
    /// What the contact forces of the last step, of `dt` (s), carry through owned particles, with
    /// their indices, ascending; none of those that nothing presses on. Lists and halo must still
    /// be those of that step.
    pub(crate) fn borne(
        &self,
        particles: &ParticleStore,
        lists: &Lists,
        dt: f64,
    ) -> Vec<(usize, Borne)> {
        let view = ContactView::new(particles, lists, &self.table, dt);
        let friction = self.table.has_friction();
        let chunks = lists.foreign().par_iter().with_max_len(CHUNKS_AT_ONCE);
        let mut borne: Vec<(usize, Borne)> = chunks
            .flat_map_iter(|chunk| {
                let mut found = Vec::new();
                for &class in ContactClass::ALL {
                    found.extend(chunk.of(class).iter().map(|(index, neighbours)| {
                        let i = view.party(index);
                        (i.base, borne_of(&view, class, &i, neighbours, friction))
                    }));
                }
                found
            })
            .collect();
        borne.extend(self.surfaces.borne());
        borne.sort_by_key(|(i, _)| *i);
        borne.dedup_by(|(next, more), (i, sum)| {
            let same = next == i;
            if same {
                sum.join(more);
            }
            same
        });
        borne.retain(|(_, borne)| borne.press != [0.0; 3]);
        borne
    }
}
