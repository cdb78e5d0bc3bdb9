//! Own neighbours that are none: particles of another fragment of the same body leave the lists of
//! the SPH sums and become foreign ones. Lists whose particles are all of one fragment stay as they
//! are.

use super::cluster::{Among, Cluster, Lists};
use super::pairs::PairList;
use numerics::lanes::LANES;

/// The fragment of a body that an image belongs to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Fragment {
    /// Smallest id of its particles.
    pub label: u64,
    /// Code of the symmetry planes behind which the image stands and that do not cut the fragment.
    pub mirror_mask: u64,
}

/// Facts by which particles of one fragment differ from strangers.
#[derive(Debug, Clone, Copy)]
pub struct Membership<'a> {
    /// Fragments of the images, by their indices.
    pub fragments: &'a [Fragment],
    /// Indices of the images at the start, where those that began farther from each other than one
    /// are strangers too; else empty.
    pub references: &'a [[f64; 3]],
}

impl Membership<'_> {
    /// True if two images belong together.
    #[must_use]
    pub fn own(&self, a: u32, b: u32) -> bool {
        self.fragments[a as usize] == self.fragments[b as usize] && self.near(a, b)
    }

    fn near(&self, a: u32, b: u32) -> bool {
        if self.references.is_empty() {
            return true;
        }
        let (a, b) = (&self.references[a as usize], &self.references[b as usize]);
        let r = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        r[0] * r[0] + r[1] * r[1] + r[2] * r[2] <= 1.0
    }

    /// True if all of a cluster belong together with all of its neighbours.
    fn one(&self, cluster: &Cluster, neighbours: &[u32]) -> bool {
        let receivers = &cluster.receivers[..cluster.lanes];
        let fragment = self.fragments[receivers[0] as usize];
        let same = |&index: &u32| self.fragments[index as usize] == fragment;
        receivers.iter().all(same)
            && neighbours.iter().all(same)
            && (self.references.is_empty()
                || receivers
                    .iter()
                    .all(|&i| neighbours.iter().all(|&j| self.near(i, j))))
    }

    /// True if two receivers have the same strangers among `neighbours`.
    fn agree(&self, a: u32, b: u32, neighbours: &[u32]) -> bool {
        self.fragments[a as usize] == self.fragments[b as usize]
            && (self.references.is_empty()
                || neighbours.iter().all(|&j| self.own(a, j) == self.own(b, j)))
    }
}

/// The strangers of a chunk's receivers, and lists in the making.
#[derive(Debug, Clone, Default)]
pub(super) struct Split {
    pub(super) strangers: PairList,
    lists: Lists,
}

impl Split {
    pub(super) fn memory(&self) -> usize {
        self.strangers.memory() + self.lists.memory()
    }

    /// Takes strangers out of `lists`.
    pub(super) fn part(&mut self, membership: &Membership, lists: &mut Lists) {
        self.strangers.clear();
        let whole = |(cluster, list, _): (&Cluster, &[u32], Among)| {
            list.is_empty() || membership.one(cluster, list)
        };
        if lists.iter().all(whole) {
            return;
        }
        self.lists.clear();
        for (cluster, list, among) in lists.iter() {
            if whole((cluster, list, among)) {
                self.lists.neighbours.extend_from_slice(list);
                self.lists.push(*cluster, among);
            } else {
                self.split(membership, cluster, list, among);
            }
        }
        std::mem::swap(&mut self.lists, lists);
    }

    /// Takes over what of `cluster` belongs together with all its neighbours, in the order of its
    /// first receivers, each part with its own neighbours.
    fn split(
        &mut self,
        membership: &Membership,
        cluster: &Cluster,
        neighbours: &[u32],
        among: Among,
    ) {
        let receivers = &cluster.receivers[..cluster.lanes];
        let mut done = [false; LANES];
        for lead in 0..receivers.len() {
            if done[lead] {
                continue;
            }
            let mut part = *cluster;
            part.lanes = 0;
            for (k, &receiver) in receivers.iter().enumerate().skip(lead) {
                if !done[k]
                    && (k == lead || membership.agree(receivers[lead], receiver, neighbours))
                {
                    done[k] = true;
                    part.receivers[part.lanes..].fill(receiver);
                    part.lanes += 1;
                }
            }
            let own = |&&j: &&u32| membership.own(receivers[lead], j);
            self.lists.neighbours.extend(neighbours.iter().filter(own));
            for &receiver in &part.receivers[..part.lanes] {
                let others = neighbours.iter().filter(|j| !own(j));
                self.strangers.add(receiver, others.copied());
            }
            let parted = Among {
                parted: true,
                ..among
            };
            self.lists.push(part, parted);
        }
    }
}
