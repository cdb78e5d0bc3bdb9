//! Regions: means and extremes of what matter holds in a part of space, or of what began there.

use std::borrow::Cow;

use rayon::prelude::*;

use super::figure::{Figure, Findings};
use super::matter::{Matter, raise};
use super::reading::{MOST, Reading};
use comm::Comm;
use model::Zone;
use numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use numerics::ordered::{disordered, ordered};
use particles::{GRAIN, ParticleStore};

/// Values of some material of a region: its mass and the sums of mass times each value; extremes of
/// each value and of its opposite.
#[derive(Clone)]
struct Part {
    sums: Vec<ExactSum>,
    most: Vec<f64>,
}

impl Part {
    fn new(values: usize) -> Self {
        Self {
            sums: vec![ExactSum::default(); 1 + values],
            most: vec![f64::NEG_INFINITY; 2 * values],
        }
    }

    fn join(mut self, other: &Self) -> Self {
        let sums = self.sums.iter_mut().zip(&other.sums);
        sums.for_each(|(sum, other)| sum.merge(other));
        let most = self.most.iter_mut().zip(&other.most);
        most.for_each(|(most, other)| raise(most, *other));
        self
    }

    fn add(&mut self, mass: f64, values: impl Iterator<Item = f64>) {
        self.sums[0].add(mass);
        for (k, value) in values.enumerate() {
            self.sums[1 + k].add(mass * value);
            raise(&mut self.most[2 * k], value);
            raise(&mut self.most[2 * k + 1], -value);
        }
    }
}

/// True if a region reads particle `i` where its image stands (m).
fn reads(zone: &Zone, matter: &Matter, particles: &ParticleStore, i: usize, x: &[f64; 3]) -> bool {
    let body = matter.body_of(i);
    let right = zone.body.map_or_else(
        || matter.case.bodies[body].rigid.is_none(),
        |wanted| wanted == body,
    );
    right
        && match zone.mark {
            Some(mark) => particles.measure_marks[i] >> mark & 1 == 1,
            None => zone.place.contains(x),
        }
}

/// The measures of a region. Collective.
pub fn zone(zone: &Zone, particles: &ParticleStore, matter: &Matter, comm: &Comm) -> Findings {
    let readings: Vec<Reading> = zone
        .fields
        .iter()
        .filter_map(|name| Reading::named(name))
        .collect();
    let values: usize = readings.iter().map(|reading| reading.endings().len()).sum();
    let of_chunk = |mut part: Part, chunk: usize| {
        for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(matter.len()) {
            for mirror_mask in matter.mirrors.masks() {
                let x = matter
                    .mirrors
                    .reflect_position(&matter.position[i], mirror_mask);
                if reads(zone, matter, particles, i, &x) {
                    let read = |reading: &Reading| {
                        let values: [f64; MOST] =
                            reading.read(matter.case, particles, i, mirror_mask);
                        values.into_iter().take(reading.endings().len())
                    };
                    part.add(matter.mass[i], readings.iter().flat_map(read));
                }
            }
        }
        part
    };
    let chunks = (0..matter.len().div_ceil(GRAIN)).into_par_iter();
    // same bits in any order: exact sums, and some value among all
    let mut all = chunks
        .fold(|| Part::new(values), of_chunk)
        .reduce(|| Part::new(values), |a, b| a.join(&b));
    let mut limbs = Vec::new();
    gather_limbs(all.sums.iter_mut(), &mut limbs);
    comm.sum_i64(&mut limbs);
    scatter_limbs(all.sums.iter_mut(), &limbs);
    let mut words: Vec<u64> = all.most.iter().map(|&most| ordered(most)).collect();
    comm.max_u64(&mut words);
    let most: Vec<f64> = words.into_iter().map(disordered).collect();
    let mass = all.sums[0].value();
    let mut figures = vec![Figure::number("mass", mass, "kg")];
    let names = readings.iter().flat_map(|reading| {
        let name = |ending: &&str| (format!("{}{ending}", reading.name()), reading.unit());
        reading.endings().iter().map(name).collect::<Vec<_>>()
    });
    for (k, (name, unit)) in names.enumerate() {
        let there = |value: f64| if mass > 0.0 { value } else { f64::NAN };
        let mut report = |what: &str, value: f64| {
            let name: Cow<'static, str> = format!("{name}_{what}").into();
            figures.push(Figure::number(name, there(value), unit));
        };
        report("mean", all.sums[1 + k].value() / mass);
        report("least", 0.0 - most[2 * k + 1]);
        report("largest", most[2 * k]);
    }
    Findings {
        figures,
        distributions: Vec::new(),
    }
}
