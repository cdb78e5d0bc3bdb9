//! Differences of the particles of two files, matched by id.

use std::cmp::Ordering;

use super::super::results::{GRID, POINT_DATA, ResultsError, component_names};
use super::{Report, text};
use files::output::Block;
use files::output::checkpoint::FIELDS;
use files::output::h5::{Array, Content, Element};

/// Rows compared at a time.
const CHUNK: usize = 1 << 18;

/// Compares two snapshots. Fields that only one has are listed: the choice of output is free.
pub fn snapshots(
    a: &Content,
    b: &Content,
    what: &str,
    report: &mut Report,
) -> Result<(), ResultsError> {
    for file in [a, b] {
        file.partitions(GRID)?;
    }
    let time = |file: &Content| file.all::<f64>("/VTKHDF/FieldData/TimeValue");
    let (times, mut differences) = ([time(a)?, time(b)?], Differences::default());
    if bytemuck::cast_slice::<f64, u64>(&times[0]) != bytemuck::cast_slice::<f64, u64>(&times[1]) {
        differences
            .lines
            .push(format!("time: {:?} against {:?}", times[0], times[1]));
    }
    let particles = fields(
        [a, b],
        POINT_DATA,
        &["/VTKHDF/Points"],
        &mut differences,
        |_, letter, name| {
            report.note(format!("{what}: only {letter} has the field {name}"));
        },
    )?;
    differences.record(what, particles, report);
    Ok(())
}

/// Beginnings of what the state holds of sums at the last row of tables, of extremes over rows, and of measures.
const BY_ROWS: [&str; 9] = [
    "angular_momentum_put_in",
    "angular_momentum_scale",
    "interpenetrated",
    "momentum_put_in",
    "most_",
    "remembered",
    "totals.",
    "work_put_in",
    "worst.",
];

/// Compares two checkpoints: all fields, and the run's own state; sums and extremes of rows of tables only if `rows_are_same`.
pub fn checkpoints(
    a: &Content,
    b: &Content,
    what: &str,
    rows_are_same: bool,
    report: &mut Report,
) -> Result<(), ResultsError> {
    let mut differences = Differences::default();
    let steps = [a.number::<u64>("/", "step")?, b.number("/", "step")?];
    if steps[0] != steps[1] {
        differences
            .lines
            .push(format!("step: {} against {}", steps[0], steps[1]));
    }
    let times = [a.number::<f64>("/", "time")?, b.number("/", "time")?];
    if times[0].to_bits() != times[1].to_bits() {
        differences
            .lines
            .push(format!("time: {:?} against {:?}", times[0], times[1]));
    }
    let by_rows = |line: &String| {
        let name = line.split(": ").next().unwrap_or_default();
        BY_ROWS.iter().any(|begin| name.starts_with(begin)) || name.contains(".extremes.")
    };
    for line in text::states(&a.text("/state")?, &b.text("/state")?) {
        if rows_are_same || !by_rows(&line) {
            differences.lines.push(format!("state {line}"));
        }
    }
    let particles = fields(
        [a, b],
        FIELDS,
        &[],
        &mut differences,
        |differences, letter, name| {
            differences
                .lines
                .push(format!("{name}: only {letter} has it"));
        },
    )?;
    differences.record(what, particles, report);
    Ok(())
}

/// Compares the arrays `others` and then those of a group that both have, and passes to `lone`
/// those that one alone has; returns the number of particles that both have. Only snapshots have
/// `others`.
fn fields(
    [a, b]: [&Content; 2],
    group: &str,
    others: &[&str],
    differences: &mut Differences,
    mut lone: impl FnMut(&mut Differences, &str, &str),
) -> Result<usize, ResultsError> {
    let vtk = !others.is_empty();
    let matching = Matching::new(a, b, &format!("{group}/id"), differences)?;
    for path in others {
        matching.compare(a, b, path, vtk, differences)?;
    }
    let (mine, theirs) = (a.arrays(group)?, b.arrays(group)?);
    for (one, other, letter) in [(&mine, &theirs, "A"), (&theirs, &mine, "B")] {
        for array in one.iter().filter(|array| !has(other, array)) {
            lone(differences, letter, &array.name);
        }
    }
    for array in mine.iter().filter(|array| has(&theirs, array)) {
        matching.compare(a, b, &format!("{group}/{}", array.name), vtk, differences)?;
    }
    Ok(matching.common())
}

fn has(arrays: &[Array], array: &Array) -> bool {
    arrays.iter().any(|other| other.name == array.name)
}

/// Differences of one pair of files.
#[derive(Default)]
struct Differences {
    lines: Vec<String>,
    fields: usize,
    /// Particle id and text of the difference of the lowest id.
    first: Option<(u64, String)>,
}

impl Differences {
    fn record(mut self, what: &str, particles: usize, report: &mut Report) {
        if let Some((_, text)) = &self.first {
            self.lines.insert(0, format!("first difference: {text}"));
        }
        let agreement = format!("{particles} particles agree in {} fields", self.fields);
        report.record(what, &agreement, &self.lines);
    }
}

/// Consecutive rows that are in both files.
struct Stretch {
    a: u64,
    b: u64,
    count: usize,
}

impl Stretch {
    /// Adds a pair of rows behind all others.
    fn lengthen(stretches: &mut Vec<Self>, a: usize, b: usize) {
        let (a, b) = (a as u64, b as u64);
        if let Some(last) = stretches.last_mut() {
            let count = last.count as u64;
            if (last.a + count, last.b + count) == (a, b) {
                last.count += 1;
                return;
            }
        }
        stretches.push(Self { a, b, count: 1 });
    }
}

/// The rows that belong together.
struct Matching {
    ids: Vec<u64>,
    stretches: Vec<Stretch>,
}

impl Matching {
    /// Matches the ids of two files, each in ascending order.
    fn new(
        a: &Content,
        b: &Content,
        path: &str,
        differences: &mut Differences,
    ) -> Result<Self, ResultsError> {
        let (mine, theirs) = (a.ids(path)?, b.ids(path)?);
        let mut stretches: Vec<Stretch> = Vec::new();
        let mut lone: [Vec<u64>; 2] = [Vec::new(), Vec::new()];
        let (mut row, mut other_row) = (0, 0);
        loop {
            let order = match (mine.get(row), theirs.get(other_row)) {
                (Some(id), Some(other)) => id.cmp(other),
                (Some(_), None) => Ordering::Less,
                (None, Some(_)) => Ordering::Greater,
                (None, None) => break,
            };
            match order {
                Ordering::Less => lone[0].push(mine[row]),
                Ordering::Greater => lone[1].push(theirs[other_row]),
                Ordering::Equal => Stretch::lengthen(&mut stretches, row, other_row),
            }
            row += usize::from(order.is_le());
            other_row += usize::from(order.is_ge());
        }
        for (letter, ids) in ["A", "B"].into_iter().zip(lone) {
            if let Some(first) = ids.first() {
                let count = ids.len();
                let text = format!("only {letter} has {count} particles; the first has id {first}");
                differences.lines.push(text);
            }
        }
        Ok(Self {
            ids: mine,
            stretches,
        })
    }

    fn common(&self) -> usize {
        self.stretches.iter().map(|stretch| stretch.count).sum()
    }

    /// Compares a field of the particles that both have.
    fn compare(
        &self,
        a: &Content,
        b: &Content,
        path: &str,
        vtk: bool,
        differences: &mut Differences,
    ) -> Result<(), ResultsError> {
        let (array, other) = (a.array(path)?, b.array(path)?);
        differences.fields += 1;
        if array.row != other.row {
            differences
                .lines
                .push(format!("{}: the types differ", array.name));
            return Ok(());
        }
        let mut tally = Tally::new(&array, vtk);
        let (mut mine, mut theirs) = (Vec::new(), Vec::new());
        for stretch in &self.stretches {
            for start in (0..stretch.count).step_by(CHUNK) {
                let count = CHUNK.min(stretch.count - start);
                let block = |first: u64, total: u64| Block {
                    total,
                    first: first + start as u64,
                    count,
                };
                mine.resize(count * array.row.bytes(), 0);
                theirs.resize(count * array.row.bytes(), 0);
                a.rows(path, array.row, block(stretch.a, array.rows), &mut mine)?;
                b.rows(path, array.row, block(stretch.b, other.rows), &mut theirs)?;
                if mine != theirs {
                    let first = usize::try_from(stretch.a).unwrap_or(usize::MAX) + start;
                    tally.add(&self.ids[first..first + count], &mine, &theirs);
                }
            }
        }
        tally.add_to(differences);
        Ok(())
    }
}

/// Differences of one field.
struct Tally<'a> {
    array: &'a Array,
    names: &'static [&'static str],
    particles: usize,
    first: Option<(u64, String)>,
    largest: f64,
    at: String,
}

impl<'a> Tally<'a> {
    fn new(array: &'a Array, vtk: bool) -> Self {
        Self {
            array,
            names: component_names(array.row.components, vtk),
            particles: 0,
            first: None,
            largest: -1.0,
            at: String::new(),
        }
    }

    fn add(&mut self, ids: &[u64], mine: &[u8], theirs: &[u8]) {
        let (row, size) = (self.array.row.bytes(), self.array.row.element.bytes());
        let rows = mine.chunks_exact(row).zip(theirs.chunks_exact(row));
        for (&id, (mine, theirs)) in ids.iter().zip(rows) {
            if mine == theirs {
                continue;
            }
            self.particles += 1;
            let values = mine.chunks_exact(size).zip(theirs.chunks_exact(size));
            for (k, (mine, theirs)) in values.enumerate() {
                if mine == theirs {
                    continue;
                }
                let (one, other) = (self.number(mine), self.number(theirs));
                let at = format!("id {id} {}", self.component(k));
                let distance = distance(one.0, other.0);
                if distance > self.largest {
                    self.largest = distance;
                    self.at.clone_from(&at);
                }
                if self.first.is_none() {
                    let text = format!("{at}: {} against {}", one.1, other.1);
                    self.first = Some((id, text));
                }
            }
        }
    }

    fn component(&self, k: usize) -> String {
        let name = self.names.get(k).copied().unwrap_or_default();
        if name.is_empty() {
            self.array.name.clone()
        } else {
            format!("{} {name}", self.array.name)
        }
    }

    /// A value as a number and as text that gives all bits.
    fn number(&self, bytes: &[u8]) -> (f64, String) {
        let mut wide = [0; 8];
        wide[..bytes.len()].copy_from_slice(bytes);
        let bits = u64::from_le_bytes(wide);
        match self.array.row.element {
            Element::F64 => {
                let value = f64::from_bits(bits);
                if value.is_nan() {
                    (value, format!("NaN ({bits:#x})"))
                } else {
                    (value, format!("{value:?}"))
                }
            }
            Element::F32 => {
                let value = f32::from_ne_bytes(std::array::from_fn(|k| wide[k]));
                (value.into(), format!("{value:?}"))
            }
            #[allow(clippy::cast_precision_loss, reason = "only the size of a difference")]
            _ => (bits as f64, bits.to_string()),
        }
    }

    fn add_to(self, differences: &mut Differences) {
        let Some(first) = self.first else { return };
        let unit = if self.array.unit.is_empty() {
            String::new()
        } else {
            format!(" {}", self.array.unit)
        };
        differences.lines.push(format!(
            "{}: {} particles differ; first {}; largest difference {:e}{unit} at {}",
            self.array.name, self.particles, first.1, self.largest, self.at
        ));
        if differences
            .first
            .as_ref()
            .is_none_or(|(id, _)| first.0 < *id)
        {
            differences.first = Some(first);
        }
    }
}

/// |a − b|, infinite where one of them is not finite.
fn distance(a: f64, b: f64) -> f64 {
    let distance = (a - b).abs();
    if distance.is_finite() {
        distance
    } else {
        f64::INFINITY
    }
}
