//! The history of one particle, as a replay has read it at each step.

use std::path::Path;

use super::plot;
use files::output::{OutputError, RunFolder, gauge_records, read_sheet};
use files::run::say::{say, seconds, warn};
use model::readable::with_unit;
use results::sheet::Sheet;

/// What is read of it, beside its position and its neighbours.
const FIELDS: [&str; 13] = [
    "pressure",
    "von_mises_stress",
    "density",
    "specific_energy",
    "temperature",
    "plastic_strain",
    "damage",
    "sound_speed",
    "smoothing_length",
    "velocity",
    "acceleration",
    "contact_acceleration",
    "foreign_fraction",
];

/// Name of the gauge that a particle carries.
fn name(id: u64) -> String {
    format!("particle-{id}")
}

/// The override that lets a particle carry a gauge that reads it at each step.
pub(super) fn gauge(id: u64) -> String {
    format!(
        "gauge+={{ name = \"{}\", particle = {id}, fields = {FIELDS:?} }}",
        name(id)
    )
}

/// Tells what happened to a particle, and draws it; false if the replay has no such particle.
pub(super) fn tell(out: &Path, id: u64) -> Result<bool, OutputError> {
    let folder = RunFolder::at(out);
    let wanted = name(id);
    let of_many = gauge_records::sheet(&folder, Some(std::slice::from_ref(&wanted)))?;
    let sheet = of_many.map_or_else(|| read_sheet(&folder.gauges()), Ok)?;
    let history = History::of(&sheet, &wanted);
    if history.times.is_empty() {
        warn(&format!(
            "error: there is no particle {id} in {}",
            out.display()
        ));
        return Ok(false);
    }
    history.tell(id);
    draw(out, &wanted);
    Ok(true)
}

/// Rows of one gauge that a particle carried.
struct History<'a> {
    sheet: &'a Sheet,
    rows: Vec<&'a [String]>,
    times: Vec<f64>,
}

impl<'a> History<'a> {
    /// The rows of the gauge of a name, while its particle was there.
    fn of(sheet: &'a Sheet, gauge: &str) -> Self {
        let column = |name: &str| sheet.names.iter().position(|own| own == name);
        let (of_gauge, coverage) = (column("gauge"), column("coverage"));
        let is_there = |cells: &&[String]| {
            let cell = |column: Option<usize>| {
                column
                    .and_then(|column| cells.get(column))
                    .map_or("", String::as_str)
            };
            cell(of_gauge) == gauge && cell(coverage).parse().is_ok_and(|share: f64| share > 0.0)
        };
        let rows = sheet.rows.iter().map(|(_, cells)| &cells[..]);
        let mut history = Self {
            sheet,
            rows: rows.filter(is_there).collect(),
            times: Vec::new(),
        };
        history.times = history.values("time");
        history
    }

    /// A column; not a number where there is no value.
    fn values(&self, name: &str) -> Vec<f64> {
        let column = self.sheet.names.iter().position(|own| own == name);
        let value = |cells: &&[String]| cells.get(column?)?.parse().ok();
        let values = self.rows.iter().map(value);
        values.map(|value| value.unwrap_or(f64::NAN)).collect()
    }

    /// A value of a column, with its unit.
    fn shown(&self, name: &str, value: f64) -> String {
        let column = self.sheet.names.iter().position(|own| own == name);
        with_unit(value, column.map_or("", |column| &self.sheet.units[column]))
    }

    /// The first row in which a column holds something.
    fn first(&self, name: &str, holds: impl Fn(f64) -> bool) -> Option<usize> {
        self.values(name).into_iter().position(holds)
    }

    /// The row with the largest value of a column by an order.
    fn most(&self, name: &str, size: impl Fn(f64) -> f64) -> Option<(usize, f64)> {
        let numbers = self.values(name).into_iter().enumerate();
        let numbers = numbers.filter(|(_, value)| value.is_finite());
        numbers.max_by(|(_, a), (_, b)| size(*a).total_cmp(&size(*b)))
    }

    fn tell(&self, id: u64) {
        let at = |row: usize| seconds(self.times[row]);
        let last = self.times.len() - 1;
        say(&format!(
            "particle {id}, {} steps from {} to {}:",
            self.times.len(),
            at(0),
            at(last)
        ));
        let mut events: Vec<(usize, String)> = Vec::new();
        let strain = self.values("plastic_strain");
        let begun = strain.first().copied().unwrap_or(f64::NAN);
        let yields = self.first("plastic_strain", |strain| begun == 0.0 && strain > 0.0);
        events.extend(yields.map(|row| (row, "it yields".to_owned())));
        let meets = self.first("foreign_neighbours", |count| count > 0.0);
        events.extend(meets.map(|row| (row, "first particle of another body near it".to_owned())));
        let fails = self.first("damage", |damage| damage >= 1.0);
        events.extend(fails.map(|row| {
            let strain = self.shown("plastic_strain", strain[row]);
            let pressure = self.shown("pressure", self.values("pressure")[row]);
            let text = format!("it has failed, at a plastic strain of {strain} and {pressure}");
            (row, text)
        }));
        let alone = self.first("neighbours", |count| count == 0.0);
        events.extend(alone.map(|row| (row, "no neighbour of its body is left".to_owned())));
        for (row, text) in &mut events {
            if *row == 0 {
                *text = format!("already: {text}");
            }
        }
        let tension = self.most("pressure", |p| -p).filter(|(_, p)| *p < 0.0);
        events.extend(tension.map(|(row, pressure)| {
            let tension = self.shown("pressure", -pressure);
            (row, format!("largest tension, {tension}"))
        }));
        let most = [
            ("pressure", "largest pressure"),
            ("von_mises_stress", "largest equivalent stress"),
            ("temperature", "highest temperature"),
        ];
        let most = most.map(|(column, what)| (column, what, self.most(column, |value| value)));
        let closest = self.most("closest_foreign", |distance| -distance);
        let closest = (
            "closest_foreign",
            "closest particle of another body",
            closest,
        );
        for (column, what, found) in most.into_iter().chain([closest]) {
            let found = found.filter(|(_, value)| *value != 0.0);
            events.extend(found.map(|(row, value)| {
                let value = self.shown(column, value);
                (row, format!("{what}, {value}"))
            }));
        }
        events.sort_by_key(|(row, _)| *row);
        let neighbours = self.values("neighbours");
        for (row, text) in events {
            let around = if neighbours[row].is_finite() {
                format!(" ({} neighbours)", neighbours[row])
            } else {
                String::new()
            };
            say(&format!("  {:<12} {text}{around}", at(row)));
        }
    }
}

/// Draws the stresses of a gauge beside its readings.
fn draw(out: &Path, gauge: &str) {
    let folder = RunFolder::at(out);
    let (table, records) = (folder.gauges(), folder.gauge_records());
    let picture = out.join(format!("{gauge}.png"));
    let source = if table.exists() { table } else { records };
    let words = [
        source.into_os_string(),
        "--gauges".into(),
        gauge.into(),
        "--xy".into(),
        "time:pressure,von_mises_stress".into(),
        "--out".into(),
        picture.clone().into_os_string(),
    ];
    match plot::by_words(words) {
        Ok(()) => say(&format!("  {} shows its stresses", picture.display())),
        Err(message) => warn(&format!("error: {message}")),
    }
}
