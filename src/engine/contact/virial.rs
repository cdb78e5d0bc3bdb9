//! The virial of contact forces, for what snapshots show (theory page "Contact").

use rayon::prelude::*;

use super::force::ContactStress;
use super::joint::add_stress;
use super::mode::stress_of;
use super::phase::Contact;
use super::view::ContactView;
use model::ContactClass;
use particles::ParticleStore;
use particles::neighbours::{CHUNKS_AT_ONCE, Lists};

impl Contact {
    /// Stress that the contact forces of the last step, of `dt` (s), carry through owned particles,
    /// with their indices, ascending; none of those that nothing presses on. Lists and halo must
    /// still be those of that step.
    pub(crate) fn carried(
        &self,
        particles: &ParticleStore,
        lists: &Lists,
        dt: f64,
    ) -> Vec<(usize, ContactStress)> {
        let view = ContactView::new(particles, lists, &self.table, dt);
        let (friction, joints) = (self.table.has_friction(), self.table.has_joints());
        let chunks = lists.foreign().par_iter().with_max_len(CHUNKS_AT_ONCE);
        let mut carried: Vec<(usize, ContactStress)> = chunks
            .flat_map_iter(|chunk| {
                let mut found = Vec::new();
                for &class in ContactClass::ALL {
                    found.extend(chunk.of(class).iter().map(|(index, neighbours)| {
                        let i = view.particle(index);
                        let mut stress = stress_of(&view, class, &i, neighbours, friction);
                        if joints {
                            add_stress(&view, &i, neighbours, &mut stress);
                        }
                        (i.slot, stress)
                    }));
                }
                found
            })
            .collect();
        carried.extend(self.surfaces.carried());
        carried.sort_by_key(|(i, _)| *i);
        carried.dedup_by(|(next, more), (i, sum)| {
            let same = next == i;
            if same {
                sum.join(more);
            }
            same
        });
        carried.retain(|(_, carried)| carried.press != [0.0; 3]);
        carried
    }
}
