//! Plans without ranks: counts against an obvious reference.

use crate::common::random::Random;
use comm::Comm;
use engine::domain::{Balance, Decomposition, NestedSlabs, RankSpeeds, Sent, Tally, tally};
use files::input::parse;
use files::plan::Particles;
use model::{Axis, SymmetryPlane};
use particles::Mirrors;

/// True if a place is within a range (m) of a box.
fn is_near(place: [f64; 3], [lower, upper]: [[f64; 3]; 2], range: f64) -> bool {
    let gaps = (0..3).map(|a| (lower[a] - place[a]).max(place[a] - upper[a]).max(0.0));
    gaps.map(|gap| gap * gap).sum::<f64>() <= range * range
}

/// The box about some places.
fn around(places: &[([f64; 3], f64)]) -> [[f64; 3]; 2] {
    let mut ends = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for (place, _) in places {
        for a in 0..3 {
            ends[0][a] = ends[0][a].min(place[a]);
            ends[1][a] = ends[1][a].max(place[a]);
        }
    }
    ends
}

/// Each rank asks each other one for each of its particles and each image.
fn by_asking_all(
    slabs: &NestedSlabs,
    planes: [Option<f64>; 3],
    particles: &[([f64; 3], f64)],
) -> (Vec<Tally>, Vec<Sent>) {
    let ranks = slabs.ranks();
    let mut dealt = vec![Vec::new(); ranks];
    for particle in particles {
        dealt[slabs.owner(&particle.0)].push(*particle);
    }
    let farthest = |rank: usize| dealt[rank].iter().map(|p| p.1).fold(0.0, f64::max);
    let image = |place: [f64; 3], code: usize| -> Option<[f64; 3]> {
        let mut image = place;
        for a in (0..3).filter(|a| code >> a & 1 == 1) {
            image[a] = 2.0 * planes[a]? - place[a];
        }
        Some(image)
    };
    let mut tallies = vec![Tally::default(); ranks];
    let mut sent = Vec::new();
    for from in 0..ranks {
        tallies[from].owned = dealt[from].len() as u64;
        for to in (0..ranks).filter(|&to| !dealt[to].is_empty() && !dealt[from].is_empty()) {
            let [there, here] = [to, from].map(|rank| around(&dealt[rank]));
            let corner = std::array::from_fn(|a| here[0][a].max(there[0][a].min(here[1][a])));
            if from != to && !is_near(corner, there, farthest(from) + farthest(to)) {
                continue;
            }
            let mut count = 0;
            for &(place, reach) in &dealt[from] {
                let first = usize::from(from == to);
                let images = (first..8).filter_map(|code| image(place, code));
                let near = images.filter(|&at| is_near(at, there, reach + farthest(to)));
                let near = near.count() as u64;
                tallies[to].images += near;
                count += u64::from(near > 0);
            }
            if from != to {
                tallies[from].peers += 1;
                tallies[to].halo += count;
                sent.push(Sent {
                    from,
                    to,
                    particles: count,
                });
            }
        }
    }
    (tallies, sent)
}

fn mirrors(planes: [Option<f64>; 3]) -> Mirrors {
    let all = [Axis::X, Axis::Y, Axis::Z].into_iter().zip(planes);
    let planes: Vec<SymmetryPlane> = all
        .filter_map(|(axis, position)| position.map(|position| SymmetryPlane { axis, position }))
        .collect();
    Mirrors::new(&planes)
}

/// Any levels and axes, faces anywhere, ranks without particles, and planes of symmetry.
#[test]
fn counts_are_those_of_asking_all() {
    let mut random = Random::new(20);
    for round in 0..120 {
        let planes = [0, 1, 2].map(|_| (random.below(2) == 0).then_some(-0.25));
        let most = if round % 3 == 0 { 0.3 } else { 1.5 };
        let particles: Vec<([f64; 3], f64)> = (0..300)
            .map(|_| {
                let place = [0; 3].map(|_| random.within(-0.25, 10.0));
                (place, random.within(0.05, most))
            })
            .collect();
        let ranks = 1 + random.below(24);
        let faces = (1..ranks).map(|_| random.within(-1.0, 11.0)).collect();
        let first = random.below(3);
        let axes = [first, (first + 1) % 3, (first + 2) % 3];
        let slabs = NestedSlabs::of_any(axes, 1 + random.below(3), faces);
        let (positions, reach): (Vec<_>, Vec<_>) = particles.iter().copied().unzip();
        let mut sent = Vec::new();
        let told = tally(&slabs, &mirrors(planes), (&positions, &reach), |one| {
            sent.push(one);
        });
        let (expected, expected_sent) = by_asking_all(&slabs, planes, &particles);
        assert_eq!(told, expected, "round {round}");
        assert_eq!(sent, expected_sent, "round {round}");
    }
}

/// A hundred thousand ranks are counted in seconds, in slabs of any levels.
#[test]
#[ignore = "slow"]
fn many_ranks_are_soon_counted() {
    let mut random = Random::new(3);
    let positions: Vec<[f64; 3]> = (0..200_000)
        .map(|_| [30.0, 20.0, 10.0].map(|length| random.within(0.0, length)))
        .collect();
    let (work, reach) = (vec![1; positions.len()], vec![0.05; positions.len()]);
    for levels in 1..=3 {
        let mut slabs = NestedSlabs::on_first([0, 1, 2], levels, 100_000);
        let all = (positions.as_slice(), work.as_slice());
        Balance::default().cut(&Comm::solo(), &mut slabs, all, &RankSpeeds::default());
        let mut sent = 0;
        let told = tally(&slabs, &Mirrors::default(), (&positions, &reach), |one| {
            sent += one.particles;
        });
        assert_eq!(told.iter().map(|one| one.owned).sum::<u64>(), 200_000);
        assert_eq!(told.iter().map(|one| one.halo).sum::<u64>(), sent);
        assert!(told.iter().all(|one| one.halo == one.images));
    }
}

/// A snapshot that tells no smoothing lengths has those of the start.
#[test]
fn particles_without_lengths_reach_as_far_as_at_the_start() {
    let case = parse(
        "lengths",
        include_str!("../../inputs/quarter-impact/case.toml"),
        &[],
    );
    let case = case.unwrap_or_else(|error| panic!("{error}"));
    let start = Particles::at_start(&case);
    let rows = start.positions.iter().zip(&start.body);
    let rows = rows.map(|(position, &body)| {
        let body = body as usize;
        let mass = case.particle_mass(&case.bodies[body]);
        (*position, body, mass, Ok(0.0))
    });
    let saved = Particles::of(&case, rows).unwrap();
    assert!(saved.reach.iter().all(|&reach| reach > 0.0));
    assert_eq!(saved.reach, start.reach);
}
