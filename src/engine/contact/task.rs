//! Contact of the receivers of one task.

use super::force::TaskForces;
use super::friction::Friction;
use super::mode::normal_load;
use super::view::ContactView;
use model::ContactClass;
use particles::empty;
use particles::neighbours::{Chunk, ForeignChunk};

/// Results of a task before they go into the store, kept from step to step.
#[derive(Default)]
pub(super) struct Task {
    /// Of each particle that has any: its load (N), friction and damping.
    pub friction: Vec<(usize, f64, Friction)>,
    pub forces: TaskForces,
}

impl Task {
    pub fn memory(&self) -> usize {
        size_of::<(usize, f64, Friction)>() * self.friction.capacity() + self.forces.memory()
    }

    /// Friction and damping of one chunk's receivers, which stand in the same order in all lists.
    pub fn resist(&mut self, view: &ContactView, foreign: &ForeignChunk, own: &Chunk) {
        empty(&mut self.friction);
        let mut lists = foreign
            .lists()
            .each_ref()
            .map(|list| list.iter().peekable());
        for (cluster, _, _) in own.iter() {
            for &index in &cluster.receivers[..cluster.lanes] {
                let neighbours = lists.each_mut().map(|list| {
                    let next = list.next_if(|(at, _)| *at == index);
                    next.map_or(&[][..], |(_, neighbours)| neighbours)
                });
                if neighbours.iter().all(|list| list.is_empty()) {
                    continue;
                }
                let i = view.particle(index);
                let load = normal_load(view, &i, &neighbours);
                let friction = load.friction(view, &i);
                self.friction
                    .extend(friction.map(|(load, friction)| (i.slot, load, friction)));
            }
        }
    }

    /// Forces on one chunk's receivers, mode after mode.
    pub fn add_forces<const FRICTION: bool>(&mut self, view: &ContactView, chunk: &ForeignChunk) {
        self.forces.clear();
        for &class in ContactClass::ALL {
            let list = chunk.of(class).iter();
            self.forces.add::<FRICTION>(view, class, list);
        }
    }

    /// Adds the forces of joints on one chunk's receivers.
    pub fn add_joints(&mut self, view: &ContactView, chunk: &ForeignChunk) {
        for &class in ContactClass::ALL {
            self.forces.add_joints(view, chunk.of(class).iter());
        }
    }
}
