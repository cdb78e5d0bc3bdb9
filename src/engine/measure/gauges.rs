//! Gauges: what matter holds at a place, fixed in space or carried along.
//!
//! Each rank reads what its own particles give; what particles of several ranks give to one gauge is
//! joined in [`super::gauge_shares`].

use rayon::prelude::*;

use super::gauge_reader::{FIRST, Matter, Means, Reader, Scratch, reads};
use super::gauge_shares::Shares;
use super::reading::Reading;
use super::surroundings;
use comm::Comm;
use model::{Cadence, Case, Gauge};
use numerics::collector::Collector;
use numerics::kernel::Kernel;
use particles::Mirrors;
use particles::neighbours::Lists;
use particles::{GRAIN, ParticleStore};

/// The gauges of a case.
#[derive(Debug)]
pub struct Gauges {
    means: Means,
    /// Readings of any of them, with the first column of each.
    readings: Vec<(Reading, usize)>,
    /// Column of the normal stress, if any reads it.
    along: Option<usize>,
    /// First column of the surroundings, if any reads them.
    around: Option<usize>,
    columns: usize,
    readers: Vec<Reader>,
    shares: Shares,
    /// Carried ids that are looked for, with their gauges.
    missing: Vec<(u64, usize)>,
    /// Places in the store of this rank's carriers.
    carriers: Vec<u32>,
    collector: Collector,
}

/// Reading of a gauge.
#[derive(Debug, Clone, PartialEq)]
pub struct GaugeRow {
    /// Index of the gauge.
    pub gauge: usize,
    /// Its position (m).
    pub position: [f64; 3],
    /// `Σ V W` about it; one of a carried gauge, zero where there is no material.
    pub coverage: f64,
    /// By column; nothing where the gauge does not read it. NaN without material.
    pub values: Vec<Option<f64>>,
}

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
        let around = gauges.iter().any(|gauge| gauge.particle.is_some());
        let around = around.then_some(columns);
        columns += around.map_or(0, |_| surroundings::NUMBERS);
        Self {
            means: Means {
                kernel: Kernel::new(case.extent()),
                mirrors: Mirrors::of(case),
            },
            readers: gauges.iter().map(|g| Reader::new(g, &readings)).collect(),
            readings,
            along,
            around,
            columns,
            shares: Shares::default(),
            missing: Vec::new(),
            carriers: Vec::new(),
            collector: Collector::default(),
        }
    }

    /// Names and SI units of the columns of all readings.
    pub fn columns(&self) -> impl Iterator<Item = (String, &'static str)> {
        let readings = self.readings.iter().flat_map(|(reading, _)| {
            let name = |ending: &&str| (format!("{}{ending}", reading.name()), reading.unit());
            reading.endings().iter().map(name).collect::<Vec<_>>()
        });
        let along = self.along.map(|_| ("normal_stress".to_owned(), "Pa"));
        let around = surroundings::COLUMNS
            .iter()
            .filter(|_| self.around.is_some());
        let around = around.map(|(name, unit)| ((*name).to_owned(), *unit));
        readings.chain(along).chain(around)
    }

    /// True if there are any.
    #[must_use]
    pub fn any(&self) -> bool {
        !self.readers.is_empty()
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let sums = self.readers.iter().map(|reader| reader.sums.capacity());
        8 * sums.sum::<usize>()
            + self.shares.memory()
            + 4 * self.carriers.capacity()
            + self.collector.memory()
    }

    /// The particles that carry gauges that name none, in their order: nearest at the start of the body that the
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
        let carried: Vec<&Gauge> = self.chosen().map(|reader| &reader.gauge).collect();
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

    /// Gauges that particles carry which are chosen at the start.
    fn chosen(&self) -> impl Iterator<Item = &Reader> {
        let all = self.readers.iter().map(|reader| (reader, &reader.gauge));
        let chosen = all.filter(|(_, gauge)| gauge.moves && gauge.particle.is_none());
        chosen.map(|(reader, _)| reader)
    }

    /// Number of particles that are chosen at the start to carry gauges.
    #[must_use]
    pub fn count_chosen(&self) -> usize {
        self.chosen().count()
    }

    /// Readings of gauges whose turn it is; `carriers` are those of [`Self::choose`]. Right after
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
        let matter = Matter {
            case,
            particles,
            lists,
        };
        let means = &self.means;
        let mut due: Vec<&mut Reader> = self.readers.iter_mut().filter(|r| r.due).collect();
        due.sort_by_cached_key(|reader| lists.order_of(&reader.gauge.at));
        // Each gauge has its own sums, in canonical order: nothing depends on threads.
        (due.into_par_iter().with_min_len(AT_ONCE)).for_each_init(
            Scratch::default,
            |scratch, reader| {
                reader.sum(&matter, means, scratch);
            },
        );
        self.shares.join(&mut self.readers, &matter, means, comm);
        let columns = (self.columns, self.along, self.around);
        let readers = self.readers.iter().enumerate();
        readers
            .filter(|(_, reader)| reader.due)
            .map(|(gauge, reader)| row(reader, gauge, columns))
            .collect()
    }

    /// Tells particles which of them are carriers, at the start of a case.
    pub fn mark(&self, particles: &mut ParticleStore, carriers: &[u64]) {
        if carriers.is_empty() {
            return;
        }
        let mut sorted = carriers.to_vec();
        sorted.sort_unstable();
        // At the start, not in every step.
        for i in 0..particles.owned() {
            let carries = sorted.binary_search(&particles.id[i]).is_ok();
            particles.measure_marks[i] |= CARRIES * u32::from(carries);
        }
    }

    /// Looks up where the carriers stand in the store, if they are this rank's.
    fn find_carriers(&mut self, particles: &ParticleStore, carriers: &[u64]) {
        let ids = &particles.id[..particles.owned()];
        self.missing.clear();
        let mut chosen = carriers.iter().copied();
        let carried = self.readers.iter_mut().enumerate();
        for (gauge, reader) in carried.filter(|(_, reader)| reader.gauge.moves) {
            let Some(id) = reader.gauge.particle.or_else(|| chosen.next()) else {
                continue;
            };
            if reader.place.and_then(|i| ids.get(i)) != Some(&id) {
                reader.place = None;
                self.missing.push((id, gauge));
            }
        }
        if self.missing.is_empty() {
            return;
        }
        self.missing.sort_unstable();
        let marks = &particles.measure_marks;
        // Particles that gauges name are not marked: a replay names them, and leaves the state as it is.
        let missing = &self.missing;
        let is_named = self
            .readers
            .iter()
            .any(|reader| reader.gauge.particle.is_some());
        self.carriers.clear();
        let all = (ids.len(), GRAIN);
        self.collector.extend(&mut self.carriers, all, |i| {
            let known = || missing.binary_search_by_key(&ids[i], |(id, _)| *id).is_ok();
            let carries =
                marks.get(i).is_some_and(|mark| mark & CARRIES != 0) || is_named && known();
            carries.then(|| u32::try_from(i).unwrap_or(u32::MAX))
        });
        for i in self.carriers.iter().map(|&i| i as usize) {
            let id = ids[i];
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

/// Gauges that a task reads at least.
const AT_ONCE: usize = 16;

/// Row of a gauge by its sums, among so many columns and with those of the normal stress and the surroundings.
fn row(
    reader: &Reader,
    gauge: usize,
    (columns, along, around): (usize, Option<usize>, Option<usize>),
) -> GaugeRow {
    let (first, rest) = reader.sums.split_at(FIRST);
    let coverage = first[0];
    let mut means = rest.iter().map(|sum| sum / coverage);
    let mut values = vec![None; columns];
    for (reading, column) in &reader.readings {
        let places = &mut values[*column..*column + reading.endings().len()];
        for (value, mean) in places.iter_mut().zip(&mut means) {
            *value = Some(mean);
        }
    }
    if let (Some(column), Some(_)) = (along, reader.gauge.along) {
        values[column] = means.next();
    }
    if let (Some(column), Some(_)) = (around, reader.gauge.particle) {
        for value in &mut values[column..column + surroundings::NUMBERS] {
            *value = means.next();
        }
    }
    let position = match (reader.gauge.moves, coverage > 0.0) {
        (false, _) => reader.gauge.at,
        (true, true) => [first[1], first[2], first[3]],
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

/// Bits of the square of the distance of this rank's nearest particle, and its id.
fn nearest(gauge: &Gauge, case: &Case, particles: &ParticleStore, lists: &Lists) -> [u64; 2] {
    let mut best = [u64::MAX; 2];
    let mut range = 2.0 * lists.longest();
    // Each rank looks as far as it has particles: twice as far each time.
    for _ in 0..DOUBLINGS {
        lists.near_point(&gauge.at, range, |index, square| {
            let image = lists.images()[index];
            let i = image.slot();
            let own = image.mirror_mask().is_own() && i < particles.owned();
            if own && reads(case, gauge.body, particles.body[i]) {
                best = best.min([square.to_bits(), particles.id[i]]);
            }
        });
        if best[0] != u64::MAX {
            break;
        }
        range *= 2.0;
    }
    best
}

/// Times that a search for the nearest particle reaches twice as far: 2²⁰ smoothing lengths.
const DOUBLINGS: u32 = 20;
