//! Gauges: what matter holds at a place, fixed in space or carried along.
//!
//! A fixed gauge reads the mean of the matter about it, weighted with kernel and volume (Shepard):
//! `Σ V_j W_j f_j / Σ V_j W_j`, of all images in whose support it is. The sum below, its *coverage*,
//! is about one inside of matter, half at a face and zero in the void, where there is nothing to read.
//! Each rank adds its own particles, found by the columns of the neighbour search.

use rayon::prelude::*;

use super::reading::{MOST, Reading, along, stress};
use crate::comm::Comm;
use crate::domain::Mirrors;
use crate::model::{Cadence, Case, Gauge};
use crate::neighbours::Lists;
use crate::numerics::exact_sum::{ExactSum, gather_limbs, scatter_limbs};
use crate::numerics::kernel::Kernel;
use crate::numerics::vector::{minus, norm, square};
use crate::particles::ParticleStore;

/// The gauges of a case.
#[derive(Debug)]
pub struct Gauges {
    kernel: Kernel,
    mirrors: Mirrors,
    /// What any of them reads, with the first column of each.
    readings: Vec<(Reading, usize)>,
    /// Column of the normal stress, if any reads it.
    along: Option<usize>,
    columns: usize,
    readers: Vec<Reader>,
    limbs: Vec<i64>,
    /// Carried ids that are looked for, with their gauges.
    missing: Vec<(u64, usize)>,
}

/// What one gauge needs from reading to reading.
#[derive(Debug)]
struct Reader {
    gauge: Gauge,
    /// Its readings, with the first column of each.
    readings: Vec<(Reading, usize)>,
    /// Place in the store of the particle that carries it, as far as this rank knows.
    place: Option<usize>,
    /// Whether it reads now.
    due: bool,
    /// Coverage, position, then its readings and the normal stress, each times its weight.
    sums: Vec<ExactSum>,
}

/// What a gauge has read.
#[derive(Debug, Clone, PartialEq)]
pub struct GaugeRow {
    /// Index of the gauge.
    pub gauge: usize,
    /// Where it is (m).
    pub position: [f64; 3],
    /// `Σ V W` about it; one of a carried gauge, zero where there is no matter.
    pub coverage: f64,
    /// By column; nothing where the gauge does not read it. Not a number without matter.
    pub values: Vec<Option<f64>>,
}

/// Sums of a gauge before its readings.
const FIRST: usize = 4;

impl Gauges {
    /// Those of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let gauges = &case.measure.gauges;
        let mut readings: Vec<(Reading, usize)> = Vec::new();
        let mut columns = 0;
        for name in gauges.iter().flat_map(|gauge| &gauge.fields) {
            if readings.iter().any(|(known, _)| known.name() == name) {
                continue;
            }
            if let Some(reading) = Reading::named(name) {
                readings.push((reading, columns));
                columns += reading.endings().len();
            }
        }
        let along = gauges.iter().any(|gauge| gauge.along.is_some());
        let along = along.then_some(columns);
        columns += usize::from(along.is_some());
        let reader = |gauge: &Gauge| {
            let own = |(reading, _): &&(Reading, usize)| {
                gauge.fields.iter().any(|name| name == reading.name())
            };
            let readings: Vec<_> = readings.iter().filter(own).copied().collect();
            let numbers: usize = readings.iter().map(|(r, _)| r.endings().len()).sum();
            let sums = FIRST + numbers + usize::from(gauge.along.is_some());
            Reader {
                gauge: gauge.clone(),
                readings,
                place: None,
                due: false,
                sums: vec![ExactSum::default(); sums],
            }
        };
        Self {
            kernel: Kernel::new(case.dimension),
            mirrors: Mirrors::new(&case.symmetry),
            readers: gauges.iter().map(reader).collect(),
            readings,
            along,
            columns,
            limbs: Vec::new(),
            missing: Vec::new(),
        }
    }

    /// Names and SI units of the columns of all readings.
    pub fn columns(&self) -> impl Iterator<Item = (String, &'static str)> {
        let readings = self.readings.iter().flat_map(|(reading, _)| {
            let name = |ending: &&str| (format!("{}{ending}", reading.name()), reading.unit());
            reading.endings().iter().map(name).collect::<Vec<_>>()
        });
        let along = self.along.map(|_| ("normal_stress".to_owned(), "Pa"));
        readings.chain(along)
    }

    /// Whether there are any.
    #[must_use]
    pub fn any(&self) -> bool {
        !self.readers.is_empty()
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let sums = self.readers.iter().map(|reader| reader.sums.capacity());
        size_of::<ExactSum>() * sums.sum::<usize>() + 8 * self.limbs.capacity()
    }

    /// The particles that carry gauges, in their order: nearest at the start of the body that the
    /// gauge names, of those as near that of the smallest id; the largest id where there is none.
    /// After a search of neighbours. Collective.
    #[must_use]
    pub fn choose(
        &self,
        case: &Case,
        particles: &ParticleStore,
        lists: &Lists,
        comm: &Comm,
    ) -> Vec<u64> {
        let carried: Vec<&Gauge> = self.carried().map(|reader| &reader.gauge).collect();
        let nearest = |gauge: &&Gauge| nearest(gauge, case, particles, lists);
        let own: Vec<[u64; 2]> = carried.iter().map(nearest).collect();
        let mut distances: Vec<u64> = own.iter().map(|[distance, _]| *distance).collect();
        comm.min_u64(&mut distances);
        let of_nearest =
            own.iter().zip(&distances).map(
                |([distance, id], least)| {
                    if distance == least { *id } else { u64::MAX }
                },
            );
        let mut ids: Vec<u64> = of_nearest.collect();
        comm.min_u64(&mut ids);
        ids
    }

    /// Gauges that particles carry.
    fn carried(&self) -> impl Iterator<Item = &Reader> {
        self.readers.iter().filter(|reader| reader.gauge.moves)
    }

    /// Number of gauges that particles carry.
    #[must_use]
    pub fn count_carried(&self) -> usize {
        self.carried().count()
    }

    /// What the gauges read whose turn it is; `carriers` are those of [`Self::choose`]. Right after
    /// a step, before particles change; on all ranks the same. Collective.
    pub fn read(
        &mut self,
        case: &Case,
        (particles, lists): (&ParticleStore, &Lists),
        carriers: &[u64],
        is_due: impl Fn(Cadence) -> bool,
        comm: &Comm,
    ) -> Vec<GaugeRow> {
        for reader in &mut self.readers {
            reader.due = is_due(reader.gauge.every);
        }
        if !self.readers.iter().any(|reader| reader.due) {
            return Vec::new();
        }
        self.find_carriers(particles, carriers);
        let means = (&self.kernel, &self.mirrors);
        // Each gauge has its own sums: nothing depends on threads.
        (self.readers.par_iter_mut().with_max_len(AT_ONCE))
            .filter(|reader| reader.due)
            .for_each(|reader| reader.add(case, particles, lists, means));
        let due = |reader: &&mut Reader| reader.due;
        let mut limbs = std::mem::take(&mut self.limbs);
        limbs.clear();
        let sums = self.readers.iter_mut().filter(due);
        gather_limbs(sums.flat_map(|reader| &mut reader.sums), &mut limbs);
        comm.sum_i64(&mut limbs);
        let sums = self.readers.iter_mut().filter(due);
        scatter_limbs(sums.flat_map(|reader| &mut reader.sums), &limbs);
        self.limbs = limbs;
        let columns = (self.columns, self.along);
        let readers = self.readers.iter_mut().enumerate();
        readers
            .filter(|(_, reader)| reader.due)
            .map(|(gauge, reader)| reader.take(gauge, columns))
            .collect()
    }

    /// Tells particles which of them are carriers, at the start of a case.
    pub fn mark(&self, particles: &mut ParticleStore, carriers: &[u64]) {
        if carriers.is_empty() {
            return;
        }
        let mut sorted = carriers.to_vec();
        sorted.sort_unstable();
        for i in 0..particles.owned() {
            let carries = sorted.binary_search(&particles.id[i]).is_ok();
            particles.measure_marks[i] |= CARRIES * u32::from(carries);
        }
    }

    /// Looks up where the carriers stand in the store, if they are this rank's.
    fn find_carriers(&mut self, particles: &ParticleStore, carriers: &[u64]) {
        let ids = &particles.id[..particles.owned()];
        self.missing.clear();
        let carried = self.readers.iter_mut().enumerate();
        let carried = carried.filter(|(_, reader)| reader.gauge.moves);
        for ((gauge, reader), &id) in carried.zip(carriers) {
            if reader.place.and_then(|i| ids.get(i)) != Some(&id) {
                reader.place = None;
                self.missing.push((id, gauge));
            }
        }
        if self.missing.is_empty() {
            return;
        }
        self.missing.sort_unstable();
        let carriers = particles.measure_marks.iter().zip(ids).enumerate();
        for (i, (_, &id)) in carriers.filter(|(_, (marks, _))| **marks & CARRIES != 0) {
            let at = self.missing.partition_point(|(other, _)| *other < id);
            let same = self.missing[at..]
                .iter()
                .take_while(|(other, _)| *other == id);
            for (_, gauge) in same {
                self.readers[*gauge].place = Some(i);
            }
        }
    }
}

/// The mark of a particle that carries a gauge.
const CARRIES: u32 = 1;

/// Gauges that a task reads at most.
const AT_ONCE: usize = 16;

impl Reader {
    /// Adds what this rank's particles give, and their images behind symmetry planes: all of them, where the
    /// search has those alone that some particle sees. An image is as far from the gauge as the particle is
    /// from the image of the gauge.
    fn add(
        &mut self,
        case: &Case,
        particles: &ParticleStore,
        lists: &Lists,
        (kernel, mirrors): (&Kernel, &Mirrors),
    ) {
        if self.gauge.moves {
            if let Some(i) = self.place {
                self.add_particle(case, particles, (i, 0), 1.0);
            }
            return;
        }
        for code in std::iter::once(0).chain(mirrors.codes()) {
            let at = mirrors.reflect_position(&self.gauge.at, code);
            lists.near_point(&at, None, |index| {
                let image = lists.images()[index];
                let i = image.base();
                let own = image.code() == 0 && i < particles.owned();
                if !own || !reads(case, self.gauge.body, particles.body[i]) {
                    return;
                }
                let distance = norm(&minus(&particles.position[i], &at));
                let volume = particles.mass[i] / particles.density[i];
                let weight = volume * kernel.value(distance, particles.smoothing_length[i]);
                if weight > 0.0 {
                    self.add_particle(case, particles, (i, code), weight);
                }
            });
        }
    }

    /// Adds an image of a particle.
    fn add_particle(
        &mut self,
        case: &Case,
        particles: &ParticleStore,
        (i, code): (usize, u8),
        weight: f64,
    ) {
        let (first, rest) = self.sums.split_at_mut(FIRST);
        first[0].add(weight);
        if self.gauge.moves {
            for (sum, x) in first[1..].iter_mut().zip(particles.position[i]) {
                sum.add(x);
            }
        }
        let mut sums = rest.iter_mut();
        for (reading, _) in &self.readings {
            let values: [f64; MOST] = reading.read(case, particles, i, code);
            let own = values[..reading.endings().len()].iter();
            for (value, sum) in own.zip(&mut sums) {
                sum.add(weight * value);
            }
        }
        if let (Some(normal), Some(sum)) = (&self.gauge.along, sums.next()) {
            sum.add(weight * along(&stress(particles, i, code), normal));
        }
    }

    /// What the sums of all ranks say, among so many columns and with that of the normal stress;
    /// forgets them.
    fn take(&mut self, gauge: usize, (columns, along): (usize, Option<usize>)) -> GaugeRow {
        let mut sums = self.sums.iter_mut().map(std::mem::take);
        let mut next = || sums.next().map_or(0.0, |sum| sum.value());
        let coverage = next();
        let carried = [next(), next(), next()];
        let mut values = vec![None; columns];
        for (reading, column) in &self.readings {
            for k in 0..reading.endings().len() {
                values[column + k] = Some(next() / coverage);
            }
        }
        if let (Some(column), Some(_)) = (along, self.gauge.along) {
            values[column] = Some(next() / coverage);
        }
        let position = match (self.gauge.moves, coverage > 0.0) {
            (false, _) => self.gauge.at,
            (true, true) => carried,
            // Its particle has been taken out.
            (true, false) => [f64::NAN; 3],
        };
        GaugeRow {
            gauge,
            position,
            coverage,
            values,
        }
    }
}

/// Whether a gauge for a body, or for all that deform, reads particles of a body.
fn reads(case: &Case, wanted: Option<usize>, body: u32) -> bool {
    let body = body as usize;
    wanted.map_or_else(
        || case.bodies[body].rigid.is_none(),
        |wanted| wanted == body,
    )
}

/// Bits of the square of the distance of this rank's nearest particle, and its id.
fn nearest(gauge: &Gauge, case: &Case, particles: &ParticleStore, lists: &Lists) -> [u64; 2] {
    let mut best = [u64::MAX; 2];
    let mut range = 2.0 * lists.longest();
    // Each rank looks as far as it has particles: twice as far each time.
    for _ in 0..DOUBLINGS {
        lists.near_point(&gauge.at, Some(range), |index| {
            let image = lists.images()[index];
            let i = image.base();
            let own = image.code() == 0 && i < particles.owned();
            if own && reads(case, gauge.body, particles.body[i]) {
                let distance = square(&minus(&particles.position[i], &gauge.at));
                best = best.min([distance.to_bits(), particles.id[i]]);
            }
        });
        if best[0] != u64::MAX {
            break;
        }
        range *= 2.0;
    }
    best
}

/// How often a search for the nearest particle reaches twice as far: 2²⁰ smoothing lengths.
const DOUBLINGS: u32 = 20;
