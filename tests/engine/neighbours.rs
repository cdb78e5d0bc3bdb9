//! The order of particles and the neighbour lists against slow, obvious references.

use std::collections::BTreeMap;

use crate::cloud::{Cloud, Found, Recipe};
use crate::common::random::Random;
use model::ContactClass;
use numerics::ordered::ordered;
use particles::neighbours::{
    Chunk, ForeignLists, ForeignTable, GroupRanges, PairList, SizeClasses,
};
use particles::{Image, MirrorMask};
use proptest::prelude::*;

fn recipe() -> impl Strategy<Value = Recipe> {
    (1_usize..=3)
        .prop_flat_map(|dimension| {
            (
                Just(dimension),
                any::<u64>(),
                prop_oneof![1_usize..20, 200_usize..500],
                1_usize..=5,
                0..=dimension,
                prop_oneof![Just(1.0), 1.0..2.5],
                0_usize..6,
                0..dimension,
            )
        })
        .prop_map(
            |(dimension, seed, particles, bodies, planes, spread, runaways, along)| Recipe {
                seed,
                dimension,
                particles,
                bodies,
                planes,
                spread,
                runaways,
                along,
            },
        )
}

/// What an image is ordered by: group, cell across, position along the column as bits that order so, id, mirror mask.
type Key = (usize, [u32; 2], u64, u64, MirrorMask);

fn key(cloud: &Cloud, image: Image) -> Key {
    let (group, x) = (cloud.group(image.slot()), cloud.place(image));
    let grid = &cloud.grids[group];
    let along = ordered(x[grid.along]);
    (
        group,
        grid.cells(&x),
        along,
        cloud.id[image.slot()],
        image.mirror_mask(),
    )
}

fn square_of_distance(found: &Found, a: u32, b: u32) -> f64 {
    let [a, b] = [a, b].map(|place| found.motion[place as usize].position);
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum()
}

/// Clusters hold each owned particle once, and never two groups.
fn check_clusters(cloud: &Cloud, found: &Found) {
    let mut seen = vec![0; cloud.owned];
    let images = found.sequence.images();
    for (cluster, _, _) in found.clusters.chunks().iter().flat_map(Chunk::iter) {
        let (valid, padding) = cluster.receivers.split_at(cluster.lanes);
        assert!(valid.is_sorted());
        assert!(padding.iter().all(|place| place == valid.last().unwrap()));
        for &place in valid {
            let image = images[place as usize];
            assert!(image.mirror_mask().is_own());
            assert_eq!(cloud.group(image.slot()), cluster.group);
            seen[image.slot()] += 1;
        }
    }
    assert!(seen.iter().all(|&count| count == 1));
}

fn check_own_lists(cloud: &Cloud, found: &Found) {
    for (cluster, list, among) in found.clusters.chunks().iter().flat_map(Chunk::iter) {
        let key_of = |place: &u32| key(cloud, found.sequence.images()[*place as usize]);
        assert!(
            list.is_sorted_by(|a, b| key_of(a) < key_of(b)),
            "once each, in order"
        );
        let images = || list.iter().map(|&j| found.sequence.images()[j as usize]);
        assert_eq!(
            among.mirrors,
            images().any(|image| !image.mirror_mask().is_own())
        );
        let moves = |image: Image| cloud.velocity[image.slot()] != cloud.velocity[0];
        assert_eq!(among.moving, images().any(moves));
        assert_eq!(
            among.halo,
            images().any(|image| image.slot() >= cloud.owned)
        );
        let group = found.sequence.group(cluster.group);
        assert!(list.iter().all(|&place| group.contains(&(place as usize))));
        for &receiver in &cluster.receivers[..cluster.lanes] {
            assert!(group.contains(&(receiver as usize)));
            let h = |place: u32| found.sequence.smoothing_lengths()[place as usize];
            let is_near =
                |j: &u32| square_of_distance(found, receiver, *j) < (h(receiver) + h(*j)).powi(2);
            // All of the group one by one, in canonical order.
            let places = group.clone().map(|place| u32::try_from(place).unwrap());
            let mut reference: Vec<u32> = places.filter(is_near).collect();
            reference.sort_by_key(key_of);
            let inside: Vec<u32> = list.iter().copied().filter(is_near).collect();
            assert_eq!(inside, reference);
        }
    }
}

/// Contact between bodies of different groups: nothing, potential or overlap, with any range.
fn foreign_table(bodies: usize, random: &mut Random) -> ForeignTable {
    let groups = bodies.div_ceil(2);
    let mut table = ForeignTable {
        size_classes: SizeClasses::of_bodies(bodies),
        class: vec![None; bodies * bodies],
        reach2: vec![0.0; bodies * bodies],
        ranges: GroupRanges::new((0..groups).collect(), groups),
        most: None,
    };
    for a in 0..bodies {
        for b in 0..a {
            let class = [
                None,
                Some(ContactClass::Potential),
                Some(ContactClass::Overlap),
            ][random.below(3)];
            if a / 2 == b / 2 || class.is_none() {
                continue;
            }
            let range = random.within(0.5, 4.0);
            for (a, b) in [(a, b), (b, a)] {
                table.class[a * bodies + b] = class;
                table.reach2[a * bodies + b] = range * range;
                table.ranges.widen(a / 2, b / 2, range);
            }
        }
    }
    table
}

fn collect<'a>(lists: impl Iterator<Item = &'a PairList>) -> BTreeMap<u32, Vec<u32>> {
    let mut all = BTreeMap::new();
    for (receiver, list) in lists.flat_map(PairList::iter) {
        assert!(all.insert(receiver, list.to_vec()).is_none());
    }
    all
}

fn check_foreign_lists(cloud: &Cloud, found: &Found, table: &ForeignTable) {
    let images = found.sequence.images();
    let body = |place: u32| cloud.body[images[place as usize].slot()];
    let mut lists = ForeignLists::default();
    lists.build(&found.clusters, &found.sequence, &found.motion, table, body);
    let places = 0..u32::try_from(images.len()).unwrap();
    for wanted in [ContactClass::Overlap, ContactClass::Potential] {
        let mut expected = BTreeMap::new();
        for receiver in places.clone() {
            let image = images[receiver as usize];
            if !image.mirror_mask().is_own() || image.slot() >= cloud.owned {
                continue;
            }
            let row = body(receiver) * table.size_classes.count();
            let mut list: Vec<u32> = places
                .clone()
                .filter(|&j| {
                    let pair = row + body(j);
                    table.class[pair] == Some(wanted)
                        && square_of_distance(found, receiver, j) < table.reach2[pair]
                })
                .collect();
            list.sort_by_key(|&place| key(cloud, images[place as usize]));
            if !list.is_empty() {
                expected.insert(receiver, list);
            }
        }
        let found = collect(lists.chunks().iter().map(|chunk| chunk.of(wanted)));
        assert_eq!(found, expected);
    }
}

/// The order of the engine against a plain sort by (group, column, along, id, mirror mask).
fn check_order(cloud: &Cloud, found: &Found) {
    let mut images = cloud.images();
    let mut first = BTreeMap::new();
    for &image in &images {
        let (group, cells, ..) = key(cloud, image);
        let least = first.entry(group).or_insert(cells);
        for k in 0..2 {
            least[k] = least[k].min(cells[k]);
        }
    }
    images.sort_by_key(|&image| {
        let (group, cells, along, id, mirror_mask) = key(cloud, image);
        let column = [0, 1].map(|k| cloud.grids[group].after(k, first[&group][k], cells[k]));
        (group, column, along, id, mirror_mask)
    });
    assert_eq!(found.sequence.images(), images);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn lists_and_order_agree_with_brute_force(recipe in recipe()) {
        let cloud = Cloud::new(&recipe);
        let found = cloud.find();
        check_clusters(&cloud, &found);
        check_own_lists(&cloud, &found);
        check_order(&cloud, &found);
        let mut random = Random::new(recipe.seed ^ 1);
        check_foreign_lists(&cloud, &found, &foreign_table(recipe.bodies, &mut random));
        let permuted = cloud.permuted(&mut random);
        assert_eq!(permuted.find().names(&permuted), found.names(&cloud));
    }
}

/// Enough particles for several tasks, chunks and halves of the sort.
#[test]
fn large_clouds_agree_with_brute_force() {
    for (dimension, along, runaways) in [(1, 0, 3), (2, 0, 4), (3, 2, 9)] {
        let cloud = Cloud::new(&Recipe {
            seed: 11,
            dimension,
            particles: 6000,
            bodies: 3,
            planes: 1,
            spread: 1.5,
            runaways,
            along,
        });
        let found = cloud.find();
        check_clusters(&cloud, &found);
        check_own_lists(&cloud, &found);
        check_order(&cloud, &found);
        let table = foreign_table(3, &mut Random::new(5));
        check_foreign_lists(&cloud, &found, &table);
    }
}

/// Many particles at one point, or at points with one coordinate in common: ids and mirror masks decide.
#[test]
fn ties_are_ordered_by_id_and_mirror_mask() {
    for planes in [0, 2] {
        let mut cloud = Cloud::new(&Recipe {
            seed: 3,
            dimension: 3,
            particles: 120,
            bodies: 3,
            planes,
            spread: 1.0,
            runaways: 0,
            along: 1,
        });
        let mut random = Random::new(9);
        for position in &mut cloud.position {
            // Zero and minus zero, on and off the planes.
            *position = [0.0, [0.0, -0.0, 1.0][random.below(3)], -0.0];
        }
        let found = cloud.find();
        check_clusters(&cloud, &found);
        check_own_lists(&cloud, &found);
        check_order(&cloud, &found);
        let permuted = cloud.permuted(&mut random);
        assert_eq!(permuted.find().names(&permuted), found.names(&cloud));
    }
}

/// A particle's place in the order does not depend on what else this rank holds.
#[test]
fn order_and_neighbours_do_not_depend_on_the_rest() {
    let recipe = Recipe {
        seed: 21,
        dimension: 3,
        particles: 800,
        bodies: 4,
        planes: 2,
        spread: 1.4,
        runaways: 5,
        along: 0,
    };
    let whole = Cloud::new(&recipe);
    let mut part = whole.clone();
    let kept: Vec<usize> = (0..800).filter(|&k| whole.position[k][2] < 6.0).collect();
    part.id = kept.iter().map(|&k| whole.id[k]).collect();
    part.body = kept.iter().map(|&k| whole.body[k]).collect();
    part.position = kept.iter().map(|&k| whole.position[k]).collect();
    part.velocity = kept.iter().map(|&k| whole.velocity[k]).collect();
    part.smoothing_length = kept.iter().map(|&k| whole.smoothing_length[k]).collect();
    part.owned = kept.len();
    let names = part.find().names(&part);
    let kept: Vec<_> = whole
        .find()
        .names(&whole)
        .into_iter()
        .filter(|name| part.id.contains(&name.0))
        .collect();
    // `whole` may have images that `part`, with a smaller farthest reach, leaves out.
    let both: Vec<_> = kept.into_iter().filter(|n| names.contains(n)).collect();
    assert_eq!(both, names);
}
