//! Fronts: where a shock is on a line, and how fast it goes.

use rayon::prelude::*;

use super::figure::{Figure, Findings};
use super::matter::{Matter, raise};
use comm::Comm;
use model::FrontLine;
use numerics::ordered::{disordered, ordered};
use numerics::vector::{dot, minus, norm, square};
use particles::GRAIN;

/// The front is where pressure passes this part of the largest on the line, if the input does not state a
/// pressure.
const PART: f64 = 0.5;

/// Most pieces of a line.
const MOST: f64 = 65536.0;

/// Largest pressure by piece of the line, and whether a shock has arrived there at all.
struct Line {
    piece: f64,
    /// Largest pressures (Pa); −∞ where there is no matter.
    pressures: Vec<f64>,
    /// True if any of them is beyond the arrival of a shock in its matter.
    arrived: bool,
}

fn read(line: &FrontLine, matter: &Matter, comm: &Comm) -> Line {
    let way = minus(&line.to, &line.from);
    let length = norm(&way);
    let along = way.map(|c| c / length);
    let count = (length / line.piece).ceil().clamp(1.0, MOST);
    let piece = length / count;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within the most"
    )]
    let pieces = count as usize;
    let arrivals: Vec<f64> = (matter.case.bodies.iter())
        .map(|body| {
            let material = &matter.case.materials[body.material];
            matter.case.measure.arrival_of(material)
        })
        .collect();
    let none = || vec![f64::NEG_INFINITY; pieces + 1];
    let of_chunk = |mut most: Vec<f64>, chunk: usize| {
        for i in chunk * GRAIN..((chunk + 1) * GRAIN).min(matter.len()) {
            let body = matter.body_of(i);
            if matter.case.bodies[body].rigid.is_some() {
                continue;
            }
            for (x, _) in matter.images(i) {
                let off = minus(&x, &line.from);
                let at = dot(&off, &along);
                let aside = square(&off) - at * at;
                if at >= 0.0 && at < length && aside <= line.radius * line.radius {
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "on the line"
                    )]
                    let k = ((at / piece) as usize).min(pieces - 1);
                    raise(&mut most[k], matter.pressure[i]);
                    raise(&mut most[pieces], matter.pressure[i] / arrivals[body]);
                }
            }
        }
        most
    };
    let join = |mut most: Vec<f64>, others: Vec<f64>| {
        most.iter_mut().zip(others).for_each(|(a, b)| raise(a, b));
        most
    };
    let chunks = (0..matter.len().div_ceil(GRAIN)).into_par_iter();
    // same bits in any order: some value among all
    let most = chunks.fold(none, of_chunk).reduce(none, join);
    let mut words: Vec<u64> = most.iter().map(|&most| ordered(most)).collect();
    comm.max_u64(&mut words);
    let mut pressures: Vec<f64> = words.into_iter().map(disordered).collect();
    let arrived = pressures.pop().is_some_and(|most| most >= 1.0);
    Line {
        piece,
        pressures,
        arrived,
    }
}

impl Line {
    /// Way (m) along the line with pressure beyond a threshold (Pa): to where the straight line
    /// between the last piece beyond it and the next one that holds material passes it.
    fn passes(&self, threshold: f64) -> Option<f64> {
        let last = self.pressures.iter().rposition(|&p| p >= threshold)?;
        let middle = |k: usize| {
            #[expect(clippy::cast_precision_loss, reason = "at most some thousands")]
            let k = k as f64;
            (k + 0.5) * self.piece
        };
        let mut beyond = self.pressures.iter().enumerate().skip(last + 1);
        let next = beyond.find(|(_, pressure)| pressure.is_finite());
        let Some((next, &lower)) = next else {
            return Some(middle(last));
        };
        let upper = self.pressures[last];
        let part = (upper - threshold) / (upper - lower);
        Some(middle(last) + part * (middle(next) - middle(last)))
    }
}

/// The measures of a front at a time (s). `before` is the time and the position that were told
/// last, and becomes these. Collective.
pub fn front(
    line: &FrontLine,
    time: f64,
    before: &mut Option<[f64; 2]>,
    matter: &Matter,
    comm: &Comm,
) -> Findings {
    let found = read(line, matter, comm);
    let largest = found
        .pressures
        .iter()
        .fold(f64::NEG_INFINITY, |a, &b| a.max(b));
    let position = match line.pressure {
        Some(pressure) => found.passes(pressure),
        None if found.arrived => found.passes(PART * largest),
        None => None,
    };
    let speed = match (position, *before) {
        (Some(position), Some([then, place])) if time > then => (position - place) / (time - then),
        _ => f64::NAN,
    };
    let since = before.map_or(f64::NAN, |[then, _]| time - then);
    *before = position.map(|position| [time, position]);
    let pressure = if largest.is_finite() {
        largest
    } else {
        f64::NAN
    };
    Findings {
        figures: vec![
            Figure::number("position", position.unwrap_or(f64::NAN), "m").within(found.piece),
            Figure::number("speed", speed, "m/s").within(found.piece / since),
            Figure::number("largest_pressure", pressure, "Pa"),
        ],
        distributions: Vec::new(),
    }
}
