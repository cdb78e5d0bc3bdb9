//! The virial of contact forces, for what snapshots show (theory page "Contact").

use rayon::prelude::*;

use super::mode::borne_of;
use super::phase::Contact;
use super::view::ContactView;
use crate::model::ContactClass;
use crate::neighbours::{CHUNKS_AT_ONCE, Lists};
use crate::numerics::virial::Virial;
use crate::particles::{ParticleStore, Scatter};

/// What contact forces carry through the matter of a particle.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Borne {
    /// Of all forces, over half of the line of each pair and all of that to a rigid surface.
    pub virial: Virial,
    /// The sum of what presses, without friction of pairs (N); zero without contact.
    pub press: [f64; 3],
}

impl Borne {
    /// Adds a force and the part of it that presses (N), over an arm (m).
    #[inline(always)]
    pub(super) fn add(&mut self, force: &[f64; 3], press: &[f64; 3], arm: &[f64; 3]) {
        self.virial.add(force, arm);
        for a in 0..3 {
            self.press[a] += press[a];
        }
    }

    fn join(&mut self, other: &Self) {
        self.virial.join(&other.virial);
        for a in 0..3 {
            self.press[a] += other.press[a];
        }
    }
}

impl Contact {
    /// What the contact forces of the last step, of `dt` (s), carry through each owned particle.
    /// Lists and halo must still be those of that step.
    pub(crate) fn borne(&self, particles: &ParticleStore, lists: &Lists, dt: f64) -> Vec<Borne> {
        let mut borne = vec![Borne::default(); particles.owned()];
        let view = ContactView::new(particles, lists, &self.table, dt);
        let slots = Scatter::new(&mut borne);
        let friction = self.table.has_friction();
        let chunks = lists.foreign().par_iter().with_max_len(CHUNKS_AT_ONCE);
        chunks.for_each(|chunk| {
            for &class in ContactClass::ALL {
                for (index, neighbours) in chunk.of(class).iter() {
                    let i = view.party(index);
                    let more = borne_of(&view, class, &i, neighbours, friction);
                    // SAFETY: a particle is receiver in one chunk.
                    unsafe { slots.slot(i.base) }.join(&more);
                }
            }
        });
        self.surfaces.bear(&mut borne);
        borne
    }
}
