//! Links between particles that are near each other.

use rayon::prelude::*;

use super::bridges::is_bridge;
use super::labels::{Labels, TOUCHES};
use super::matter::{Matter, Rule, Surroundings, link_reach};
use crate::domain::Halo;
use comm::Comm;
use particles::connected::{Grid, Place, Sets, distance_squared, grids};
use particles::{Image, MirrorMask, Mirrors};

/// Bytes that a search takes for each particle or image while it lasts: its place, twice, and the
/// numbers of some eighteen neighbours, with spare room.
pub const BYTES_OF_SEARCH: usize = 2 * size_of::<Place>() + 160;

/// Cubes of a grid that a task looks at.
const SHARE: usize = 512;

/// Neighbours of this rank's particles, as one task has found them.
#[derive(Default)]
struct Near {
    /// Each receiver's place, and where its neighbours end.
    ends: Vec<(u32, u32)>,
    neighbours: Vec<u32>,
    /// Receivers of larger size that these places are near to, with them.
    larger: Vec<(u32, u32)>,
}

/// Links among places, numbered through all grids.
struct Links<'a> {
    matter: &'a Matter<'a>,
    across_bodies: bool,
    grids: Vec<Grid>,
    /// Number of each grid's first place.
    firsts: Vec<usize>,
    near: Vec<Near>,
    /// Further neighbours of receivers: smaller ones, by receiver.
    smaller: Vec<(u32, u32)>,
}

/// Links particles, and labels connected components of all ranks. `others` are the images near
/// this rank's particles. Collective.
pub(super) fn link(
    (comm, mut halo): (&Comm, Option<&mut Halo>),
    matter: &Matter,
    Surroundings { mirrors, others }: Surroundings,
    rule: &Rule,
    labels: &mut Labels,
) {
    let links = Links::new(matter, mirrors, others, rule);
    // In one dimension every particle is a bridge.
    let cuts = !rule.bridges && rule.dimension > 1;
    let mut bridges = links.bridges(cuts);
    if cuts && let Some(halo) = &mut halo {
        halo.exchange_values(comm, &mut bridges);
    }
    labels.begin(matter.ids.len());
    links.join(&bridges, labels.sets());
    labels.finish(comm, halo, matter.ids, matter.owned);
}

impl<'a> Links<'a> {
    fn new(matter: &'a Matter, mirrors: &Mirrors, others: &[Image], rule: &Rule) -> Self {
        let own = (0..matter.owned).map(|i| Image::new(i, MirrorMask::OWN));
        let place = |image: Image| {
            let i = image.slot();
            let found = matter.included[i] && matter.size[i] > 0.0;
            let position = mirrors.reflect_position(&matter.position[i], image.mirror_mask());
            (found && position.iter().all(|x| x.is_finite())).then(|| {
                let gradient = matter.deformation.get(i);
                let gradient = gradient.map(|f| Mirrors::reflect_tensor(f, image.mirror_mask()));
                let (reach, deformed) = link_reach(rule.link, matter.size[i], gradient.as_ref());
                Place {
                    position,
                    reach,
                    metric: deformed.map(|deformed| deformed.metric()),
                    image,
                }
            })
        };
        let places = own.chain(others.iter().copied()).filter_map(place);
        let grids = grids(places.collect());
        let mut firsts = vec![0];
        for grid in &grids {
            firsts.push(firsts[firsts.len() - 1] + grid.places.len());
        }
        let mut links = Self {
            matter,
            across_bodies: rule.across_bodies,
            grids,
            firsts,
            near: Vec::new(),
            smaller: Vec::new(),
        };
        links.search();
        links
    }

    /// Finds the neighbours of all receivers.
    fn search(&mut self) {
        let links = &*self;
        let tasks = links.grids.iter().enumerate().flat_map(|(class, grid)| {
            let starts = (0..grid.cubes()).step_by(SHARE);
            starts.map(move |from| (class, from..grid.cubes().min(from + SHARE)))
        });
        let tasks: Vec<_> = tasks.collect();
        let found = tasks.into_par_iter().map(|(class, cubes)| {
            let mut near = Near::default();
            cubes.for_each(|cube| links.look(class, cube, &mut near));
            near
        });
        let near: Vec<Near> = found.collect();
        self.smaller = near
            .iter()
            .flat_map(|near| near.larger.iter().copied())
            .collect();
        self.smaller.par_sort_unstable();
        self.near = near;
    }

    /// Looks about the places of a cube, among those of their own size and of larger ones.
    fn look(&self, class: usize, cube: usize, near: &mut Near) {
        let members = self.grids[class].members(cube);
        let mut rows = Vec::with_capacity(9);
        self.grids[class].about(self.cube_of(class, members.start), |row| rows.push(row));
        for member in members {
            let place = self.grids[class].places[member];
            let receives = self.receives(&place);
            let number = self.number(class, member);
            if receives {
                for other in rows.iter().cloned().flatten() {
                    let there = &self.grids[class].places[other];
                    if other != member && self.linked(&place, there) {
                        near.neighbours.push(self.number(class, other));
                    }
                }
            }
            for coarse in 0..class {
                let grid = &self.grids[coarse];
                grid.about(grid.cube(&place.position), |row| {
                    for other in row {
                        let there = &grid.places[other];
                        if !self.linked(&place, there) {
                            continue;
                        }
                        let far = self.number(coarse, other);
                        if receives {
                            near.neighbours.push(far);
                        }
                        if self.receives(there) {
                            near.larger.push((far, number));
                        }
                    }
                });
            }
            if receives {
                near.ends.push((number, whole(near.neighbours.len())));
            }
        }
    }

    fn cube_of(&self, class: usize, place: usize) -> [u64; 3] {
        let grid = &self.grids[class];
        grid.cube(&grid.places[place].position)
    }

    fn number(&self, class: usize, place: usize) -> u32 {
        whole(self.firsts[class] + place)
    }

    fn place(&self, number: u32) -> &Place {
        let class = self
            .firsts
            .partition_point(|&first| first <= number as usize)
            - 1;
        &self.grids[class].places[number as usize - self.firsts[class]]
    }

    /// True if a place is a particle of this rank itself.
    fn receives(&self, place: &Place) -> bool {
        place.image.mirror_mask().is_own() && place.image.slot() < self.matter.owned
    }

    fn linked(&self, a: &Place, b: &Place) -> bool {
        let body = |place: &Place| self.matter.body[place.image.slot()];
        a.is_linked(b) && (self.across_bodies || body(a) == body(b))
    }

    /// Calls `visit` with each receiver and its neighbours.
    fn receivers(&self, visit: impl Fn(&Place, &[u32]) + Sync) {
        self.near.par_iter().for_each(|near| {
            let mut begin = 0;
            let mut all = Vec::new();
            for &(receiver, end) in &near.ends {
                let own = &near.neighbours[begin as usize..end as usize];
                begin = end;
                let from = self.smaller.partition_point(|pair| pair.0 < receiver);
                let more = self.smaller[from..]
                    .iter()
                    .take_while(|pair| pair.0 == receiver);
                all.clear();
                all.extend(own.iter().copied().chain(more.map(|pair| pair.1)));
                visit(self.place(receiver), &all);
            }
        });
    }

    /// Flags of this rank's particles that are bridges, and room for halo particles.
    fn bridges(&self, cuts: bool) -> Vec<u8> {
        use std::sync::atomic::{AtomicU8, Ordering::Relaxed};
        let mut bridges: Vec<AtomicU8> = Vec::new();
        bridges.resize_with(self.matter.ids.len(), AtomicU8::default);
        if cuts {
            self.receivers(|place, neighbours| {
                let near = neighbours.iter().map(|&k| *self.place(k));
                let is = u8::from(is_bridge(near));
                bridges[place.image.slot()].store(is, Relaxed);
            });
        }
        bridges.into_iter().map(AtomicU8::into_inner).collect()
    }

    /// Joins linked particles; a bridge is joined with its nearest neighbour that is none, alone.
    fn join(&self, bridges: &[u8], sets: &Sets) {
        let is_bridge = |place: &Place| bridges[place.image.slot()] != 0;
        self.receivers(|place, neighbours| {
            let own = whole(place.image.slot());
            let near = neighbours.iter().map(|&k| self.place(k));
            let firm = near.clone().filter(|other| !is_bridge(other));
            if is_bridge(place) {
                let order = |a: &&Place, b: &&Place| {
                    let key = |other: &Place| {
                        let id = self.matter.ids[other.image.slot()];
                        (other.image.mirror_mask(), id)
                    };
                    let [x, y] = [a, b].map(|o| distance_squared(&place.position, &o.position));
                    x.total_cmp(&y).then_with(|| key(a).cmp(&key(b)))
                };
                if let Some(nearest) = firm.min_by(order) {
                    sets.join(own, whole(nearest.image.slot()));
                }
                return;
            }
            for other in firm {
                let mirror_mask = other.image.mirror_mask();
                sets.join(own, whole(other.image.slot()));
                if !mirror_mask.is_own() {
                    sets.mark(own, mirror_mask.bits().into());
                }
            }
            // A bridge of another rank may be joined with this one, which that rank alone knows.
            let is_far = |other: &Place| other.image.slot() >= self.matter.owned;
            if near.clone().any(|other| is_bridge(other) && is_far(other)) {
                sets.mark(own, TOUCHES);
            }
        });
    }
}

fn whole(i: usize) -> u32 {
    u32::try_from(i).unwrap_or(u32::MAX)
}
