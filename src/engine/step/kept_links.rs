//! Links between inactive particles, so that labels of the pieces of bodies need no lists of all particles.
//!
//! As long as a part of the store is inactive, everything within the support of its particles rests. So its links stay as
//! they were in the lists of the step that deactivated it.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use rayon::prelude::*;

use crate::fragments::Sets;
use numerics::collector::Collector;
use numerics::lanes::LANES;
use particles::neighbours::{Chunk, Cluster, Lists};
use particles::{GRAIN, PART};

/// Links of parts of the store that are kept, kept from step to step.
#[derive(Debug, Default)]
pub(super) struct KeptLinks {
    /// By part: for each of its particles the first one that links within the part connect it with.
    firsts: Vec<[u8; PART]>,
    /// By part: whether it has links with parts that are not kept.
    borders: Vec<AtomicBool>,
    /// Links between such first ones, and with images behind symmetry planes.
    links: Vec<Link>,
    spare: Vec<Link>,
    collector: Collector,
}

/// Two particles, and the mirror mask of the image of the second one.
type Link = [u32; 3];

/// True if links of a part are kept.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Keeping {
    /// Its links are not kept.
    #[default]
    No,
    /// They are from now on.
    New,
    /// They have been.
    Old,
}

impl Keeping {
    /// This where `is_so`, else [`Self::No`].
    pub fn only_if(self, is_so: bool) -> Self {
        if is_so { self } else { Self::No }
    }
}

impl KeptLinks {
    /// Forgets links with parts that are not `kept` any more.
    pub fn forget(&mut self, kept: impl Fn(usize) -> bool + Sync) {
        let (links, borders) = (&self.links, &self.borders);
        self.spare.clear();
        let all = (links.len(), GRAIN);
        self.collector.extend(&mut self.spare, all, |k| {
            let [a, b, _] = links[k];
            let parts = [a, b].map(|i| i as usize / PART);
            let is_kept = parts.map(&kept);
            for (part, other) in [(0, 1), (1, 0)] {
                if is_kept[part] && !is_kept[other] {
                    borders[parts[part]].store(true, Relaxed);
                }
            }
            (is_kept == [true; 2]).then_some(links[k])
        });
        std::mem::swap(&mut self.links, &mut self.spare);
    }

    /// True if a part that is kept has links with parts that are not.
    pub fn is_border(&self, part: usize) -> bool {
        self.borders[part].load(Relaxed)
    }

    /// Joins the particles that links of the `kept` parts connect.
    pub fn join(&self, kept: impl Fn(usize) -> bool + Sync, sets: &Sets) {
        let firsts = self.firsts.par_iter().enumerate();
        firsts
            .filter(|(part, _)| kept(*part))
            .for_each(|(part, firsts)| {
                for (k, &first) in firsts.iter().enumerate() {
                    sets.join(place(part, k), place(part, first.into()));
                }
            });
        let links = self.links.par_iter().with_min_len(GRAIN);
        links.for_each(|&[a, b, mirror_mask]| {
            sets.mark(a, mirror_mask);
            sets.join(a, b);
        });
    }

    /// Takes up the links of new parts, whose particles all have lists, and finds which parts have links with parts that
    /// are not kept. `sets` is memory to work in, every particle by itself.
    pub fn note(&mut self, lists: &Lists, keeping: impl Fn(usize) -> Keeping + Sync, sets: &Sets) {
        let parts = sets.len() / PART;
        self.firsts.resize(parts, [0; PART]);
        self.borders.resize_with(parts, AtomicBool::default);
        let seen = Seen {
            lists,
            keeping,
            parts,
        };
        seen.clear(&self.borders);
        seen.look(sets, &self.borders);
        let firsts = self.firsts.par_iter_mut().enumerate();
        let new = firsts.filter(|(part, _)| (seen.keeping)(*part) == Keeping::New);
        new.for_each(|(part, firsts)| {
            for (k, first) in firsts.iter_mut().enumerate() {
                let root = sets.root(place(part, k)) as usize;
                #[allow(clippy::cast_possible_truncation, reason = "within a part")]
                let within = (root - PART * part) as u8;
                *first = within;
            }
        });
        let Self {
            firsts,
            links,
            spare,
            collector,
            ..
        } = self;
        let chunks = lists.chunks();
        spare.clear();
        collector.extend(spare, (chunks.len(), 1), |k| seen.links(&chunks[k], firsts));
        spare.par_sort_unstable();
        let found = &*spare;
        collector.extend(links, (found.len(), GRAIN), |k| {
            (k == 0 || found[k] != found[k - 1]).then_some(found[k])
        });
    }

    pub fn memory(&self) -> usize {
        size_of::<[u8; PART]>() * self.firsts.capacity()
            + self.borders.capacity()
            + size_of::<Link>() * (self.links.capacity() + self.spare.capacity())
            + self.collector.memory()
    }
}

#[allow(clippy::cast_possible_truncation, reason = "particles fit u32")]
fn place(part: usize, k: usize) -> u32 {
    (PART * part + k) as u32
}

/// The lists, and the parts whose links they give.
struct Seen<'a, F> {
    lists: &'a Lists,
    keeping: F,
    parts: usize,
}

impl<F: Fn(usize) -> Keeping + Sync> Seen<'_, F> {
    /// True if links of the part of a particle are kept.
    fn of(&self, i: usize) -> Keeping {
        let part = i / PART;
        if part < self.parts {
            (self.keeping)(part)
        } else {
            Keeping::No
        }
    }

    /// Unmarks all parts with lists as borders.
    fn clear(&self, borders: &[AtomicBool]) {
        let images = self.lists.images();
        self.lists.chunks().par_iter().for_each(|chunk| {
            let receivers = chunk.iter().flat_map(|(cluster, ..)| cluster.valid());
            for &i in receivers {
                let own = images[i as usize].slot();
                if self.of(own) != Keeping::No {
                    borders[own / PART].store(false, Relaxed);
                }
            }
        });
    }

    /// Joins particles that are linked within a new part, and marks parts with links to parts that are not kept.
    fn look(&self, sets: &Sets, borders: &[AtomicBool]) {
        let (images, lists) = (self.lists.images(), self.lists);
        lists.chunks().par_iter().for_each(|chunk| {
            for (cluster, neighbours, _) in chunk.iter() {
                let own = cluster.receivers.map(|i| images[i as usize].slot());
                let keeping = own.map(|i| self.of(i));
                if keeping == [Keeping::No; LANES] {
                    continue;
                }
                let mut here = own.map(|i| sets.root(place(0, i)));
                for &j in neighbours {
                    let (slot, mirror_mask) =
                        (images[j as usize].slot(), images[j as usize].mirror_mask());
                    let is_kept = self.of(slot) != Keeping::No;
                    for (k, &i) in cluster.valid().iter().enumerate() {
                        let part = own[k] / PART;
                        if !is_kept {
                            if keeping[k] != Keeping::No
                                && !borders[part].load(Relaxed)
                                && lists.in_support(cluster.group, i, j)
                            {
                                borders[part].store(true, Relaxed);
                            }
                        } else if keeping[k] == Keeping::New
                            && slot / PART == part
                            && mirror_mask.is_own()
                        {
                            // Roots may be old, which costs a look more.
                            let there = sets.root(place(0, slot));
                            if there != here[k] && lists.in_support(cluster.group, i, j) {
                                sets.join(here[k], there);
                                here[k] = sets.root(place(0, own[k]));
                            }
                        }
                    }
                }
            }
        });
    }

    /// Links of a chunk between two kept parts, one of them new, and with images; some more than once.
    fn links<'a>(
        &'a self,
        chunk: &'a Chunk,
        firsts: &'a [[u8; PART]],
    ) -> impl Iterator<Item = Link> + 'a {
        let images = self.lists.images();
        let first = move |i: usize| place(i / PART, firsts[i / PART][i % PART].into());
        // Neighbours in a row are of the same few parts.
        let mut recent = [[u32::MAX; 3]; RECENT];
        let mut receivers = Receivers::default();
        let pairs = chunk
            .iter()
            .flat_map(|(cluster, neighbours, _)| neighbours.iter().map(move |&j| (cluster, j)));
        pairs.flat_map(move |(cluster, j)| {
            if receivers.of != Some(cluster.receivers) {
                receivers.take(cluster, |i| {
                    let own = images[i as usize].slot();
                    let keeping = self.of(own);
                    (keeping != Keeping::No).then(|| (first(own), keeping))
                });
            }
            let (slot, mirror_mask) = (images[j as usize].slot(), images[j as usize].mirror_mask());
            let their = self.of(slot);
            let (mut links, mut count) = ([[0; 3]; LANES], 0);
            if their != Keeping::No {
                let there = first(slot);
                for &(here, keeping, lanes) in receivers.kept() {
                    let is_new = [keeping, their].contains(&Keeping::New);
                    let is_inner = here as usize / PART == slot / PART && mirror_mask.is_own();
                    if !is_new || is_inner {
                        continue;
                    }
                    let link = match u32::from(mirror_mask.bits()) {
                        // Seen from both sides.
                        0 => [here.min(there), here.max(there), 0],
                        mirror_mask => [here, there, mirror_mask],
                    };
                    let last = &mut recent[bucket(&link)];
                    let is_near = |lane: usize| {
                        let is_receiver = lanes >> lane & 1 == 1;
                        is_receiver
                            && self
                                .lists
                                .in_support(cluster.group, cluster.receivers[lane], j)
                    };
                    if *last != link && (0..LANES).any(is_near) {
                        *last = link;
                        links[count] = link;
                        count += 1;
                    }
                }
            }
            links.into_iter().take(count)
        })
    }
}

/// The receivers of a cluster that are kept. Those of a part that hang together stand there once.
#[derive(Default)]
struct Receivers {
    of: Option<[u32; LANES]>,
    /// The first one of their part that they hang together with, whether its links are kept, and a bit for each lane.
    kept: [(u32, Keeping, u32); LANES],
    count: usize,
}

impl Receivers {
    fn take(&mut self, cluster: &Cluster, first_of: impl Fn(u32) -> Option<(u32, Keeping)>) {
        (self.of, self.count) = (Some(cluster.receivers), 0);
        for (lane, &i) in cluster.valid().iter().enumerate() {
            let Some((first, keeping)) = first_of(i) else {
                continue;
            };
            let mut known = self.kept[..self.count].iter_mut();
            if let Some((.., lanes)) = known.find(|(other, ..)| *other == first) {
                *lanes |= 1 << lane;
            } else {
                self.kept[self.count] = (first, keeping, 1 << lane);
                self.count += 1;
            }
        }
    }

    fn kept(&self) -> &[(u32, Keeping, u32)] {
        &self.kept[..self.count]
    }
}

/// Links remembered so that few are found twice.
const RECENT: usize = 256;

fn bucket(&[a, b, mirror_mask]: &Link) -> usize {
    let mixed = (a ^ b.rotate_left(16) ^ mirror_mask).wrapping_mul(0x9e37_79b9);
    (mixed >> 24) as usize
}
