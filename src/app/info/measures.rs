//! The last rows of a run's measures.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::Path;

use serde_json::Value;

use crate::output_format;
use files::output::{RunFolder, Sheet, gauge_records};
use model::readable::{shown, shown_vector};

/// Bytes of the end of a table that are read: the rows of the last time of some hundred bodies.
const END: u64 = 1 << 16;

/// Bytes of its beginning, which has the units and names of the columns.
const BEGIN: u64 = 1 << 14;

/// Names and figures of what a run has measured: of bodies, measures, witness planes and gauges at the last
/// time of their tables.
pub fn last_figures(folder: &RunFolder) -> Vec<(String, String)> {
    let mut lines = Vec::new();
    if let Some(last) = Last::of(&folder.bodies()) {
        lines.extend(last.lines(
            "body",
            &["mass", "velocity", "kinetic_energy", "failed_mass"],
        ));
    }
    if let Some(last) = Last::of(&folder.measures()) {
        lines.extend(last.figures());
    }
    if let Some(mut last) = Last::of(&folder.witness()) {
        last.keep(|last, row| last.number(row, "particles") > 0.0);
        let passed = ["mass", "momentum", "kinetic_energy"];
        lines.extend(last.lines("witness", &passed));
    }
    if let Some(last) = last_of_gauges(folder) {
        let reads = ["pressure", "velocity", "normal_stress"];
        lines.extend(last.lines("gauge", &reads));
    }
    lines
}

/// The rows of the last time of the same tables, and of the history.
pub fn last_rows(folder: &RunFolder) -> Value {
    let tables = [
        ("history", Last::of(&folder.history())),
        ("bodies", Last::of(&folder.bodies())),
        ("measures", Last::of(&folder.measures())),
        ("witness", Last::of(&folder.witness())),
        ("gauges", last_of_gauges(folder)),
        ("fragments", Last::of(&folder.fragments())),
    ];
    let values = |(name, last): (&str, Option<Last>)| {
        Some((name.to_owned(), output_format::table(&last?.sheet)))
    };
    tables.into_iter().filter_map(values).collect()
}

/// The last readings of gauges, few or many.
fn last_of_gauges(folder: &RunFolder) -> Option<Last> {
    Last::of(&folder.gauges()).or_else(|| {
        let many = gauge_records::last_rows(folder).ok().flatten();
        many.and_then(Last::of_sheet)
    })
}

/// The rows of the last time of a table.
struct Last {
    sheet: Sheet,
}

impl Last {
    /// Of a table, if there is one with rows.
    fn of(path: &Path) -> Option<Self> {
        let mut file = File::open(path).ok().filter(|file| {
            let about = file.metadata();
            about.is_ok_and(|about| about.is_file())
        })?;
        let length = file.metadata().ok()?.len();
        let mut text = Vec::new();
        (&file).take(BEGIN.max(END)).read_to_end(&mut text).ok()?;
        if length > text.len() as u64 {
            let header = end_of_header(&text)?;
            text.truncate(header);
            file.seek(SeekFrom::Start(length - END)).ok()?;
            let mut end = Vec::new();
            file.take(END).read_to_end(&mut end).ok()?;
            // The first line is the rest of one.
            let whole = end.iter().position(|&byte| byte == b'\n')?;
            text.extend_from_slice(&end[whole + 1..]);
        }
        Self::of_sheet(Sheet::parse(std::str::from_utf8(&text).ok()?).ok()?)
    }

    /// Of a table, if it has rows.
    fn of_sheet(mut sheet: Sheet) -> Option<Self> {
        let columns = sheet.names.len();
        sheet.rows.retain(|(_, cells)| cells.len() == columns);
        let time = sheet.names.iter().position(|name| name == "time")?;
        let last = sheet.rows.last()?.1[time].clone();
        sheet.rows.retain(|(_, cells)| cells[time] == last);
        Some(Self { sheet })
    }

    fn keep(&mut self, which: impl Fn(&Self, usize) -> bool) {
        let kept: Vec<bool> = (0..self.sheet.rows.len())
            .map(|row| which(self, row))
            .collect();
        let mut kept = kept.into_iter();
        self.sheet.rows.retain(|_| kept.next().unwrap_or(false));
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.sheet.names.iter().position(|other| other == name)
    }

    fn cell(&self, row: usize, name: &str) -> &str {
        self.column(name)
            .map_or("", |at| &self.sheet.rows[row].1[at])
    }

    fn number(&self, row: usize, name: &str) -> f64 {
        self.cell(row, name).parse().unwrap_or(f64::NAN)
    }

    /// A line for each row: what it is of, and some of its figures with their units.
    fn lines(&self, of: &str, figures: &[&str]) -> Vec<(String, String)> {
        let many = self.sheet.rows.len() > MOST;
        let rows = 0..self.sheet.rows.len().min(MOST);
        let line = |row: usize| {
            let mut name = format!("{of} {}", self.cell(row, of));
            for more in ["body", "direction"].iter().filter(|more| **more != of) {
                let longer = format!("{name} {}", self.cell(row, more));
                longer.trim_end().clone_into(&mut name);
            }
            let values: Vec<_> = (figures.iter())
                .filter_map(|figure| self.figure(row, figure))
                .collect();
            let values = match self.figure(row, "coverage") {
                _ if !values.is_empty() => values.join(", "),
                Some(_) if self.number(row, "coverage") > 0.0 => self.readings(row),
                Some(_) => "nothing to read: no matter is there".to_owned(),
                None => String::new(),
            };
            (name, values)
        };
        let mut lines: Vec<_> = rows.map(line).collect();
        if many {
            let left = self.sheet.rows.len() - MOST;
            lines.push((format!("{of} …"), format!("{left} more in the table")));
        }
        lines
    }

    /// A line for each measure with its figures and their units.
    fn figures(&self) -> Vec<(String, String)> {
        let mut lines: Vec<(String, String)> = Vec::new();
        for row in 0..self.sheet.rows.len() {
            let cell = |name: &str| self.cell(row, name);
            let of = format!("{} {}", cell("kind"), cell("measure"));
            let words = cell("figure").replace('_', " ");
            let value = match cell("value").parse::<f64>() {
                Ok(value) if value.is_nan() => continue,
                Ok(value) => format!("{words} {}", shown(value, cell("unit"))),
                Err(_) => cell("value").to_owned(),
            };
            match lines.last_mut().filter(|(name, _)| *name == of) {
                Some((_, values)) => {
                    values.push_str(", ");
                    values.push_str(&value);
                }
                None => lines.push((of, value)),
            }
        }
        lines
    }

    /// The first numbers that a gauge has read.
    fn readings(&self, row: usize) -> String {
        let names = self.sheet.names.iter();
        let read = names.skip_while(|name| *name != "coverage").skip(1);
        let values = read.filter_map(|name| self.figure(row, name)).take(3);
        values.collect::<Vec<_>>().join(", ")
    }

    /// A figure or a vector with its unit, if the row has it.
    fn figure(&self, row: usize, name: &str) -> Option<String> {
        let words = name.replace('_', " ");
        let unit = |name: &str| self.column(name).map_or("", |at| &self.sheet.units[at]);
        let unit = |name: &str| unit(name).trim_matches('-').to_owned();
        if self.column(name).is_some() {
            let value = self.number(row, name);
            return (!value.is_nan()).then(|| format!("{words} {}", shown(value, &unit(name))));
        }
        let names = ["x", "y", "z"].map(|axis| format!("{name}_{axis}"));
        let values = [0, 1, 2].map(|k| self.number(row, &names[k]));
        let known = values.iter().all(|value| !value.is_nan());
        known.then(|| format!("{words} {}", shown_vector(&values, &unit(&names[0]))))
    }
}

/// Rows that are printed of each table.
const MOST: usize = 20;

/// Offset of the first row of a table: after the units and the names.
fn end_of_header(text: &[u8]) -> Option<usize> {
    let mut end = 0;
    for line in text.split_inclusive(|&byte| byte == b'\n') {
        end += line.len();
        if !line.starts_with(b"#") {
            return line.ends_with(b"\n").then_some(end);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use files::output::Column;
    use files::output::gauge_records::GaugeRecords;
    use std::fmt::Write as _;

    #[test]
    fn the_last_rows_are_told_however_long_the_table_is() {
        let folder = tempfile::tempdir().unwrap();
        let run = RunFolder::at(folder.path());
        let mut text = String::from(
            "# units: s,-,kg,m/s,m/s,m/s,J\ntime,body,mass,velocity_x,velocity_y,velocity_z,kinetic_energy\n",
        );
        for n in 0..2000 {
            for body in ["plate", "sphere"] {
                writeln!(text, "{n}.0,{body},0.002,0.0,0.0,-{n}.0,NaN").unwrap();
            }
        }
        text.push_str("2000.0,pla");
        std::fs::write(run.bodies(), &text).unwrap();
        let lines = last_figures(&run);
        assert_eq!(lines.len(), 2, "{lines:?}");
        assert_eq!(lines[0].0, "body plate");
        assert_eq!(lines[1].1, "mass 0.002 kg, velocity [0, 0, -1.999] km/s");
        std::fs::write(run.witness(), "time,witness,body,direction,particles,mass\n0.5,a,b,forwards,3,1\n0.5,a,b,backwards,0,0\n").unwrap();
        let lines = last_figures(&run);
        assert_eq!(lines[2].0, "witness a b forwards");
        assert_eq!(lines.len(), 3);
        std::fs::write(
            run.gauges(),
            "# units: s,-,-,Pa,kg/m^3\ntime,gauge,coverage,pressure,density\n\
             0.5,inside,1.0,2e9,2785\n0.5,void,0.0,NaN,NaN\n0.5,density,0.5,,2785\n",
        )
        .unwrap();
        let values: Vec<String> = last_figures(&run).into_iter().map(|line| line.1).collect();
        assert_eq!(
            values[3..],
            [
                "pressure 2 GPa",
                "nothing to read: no matter is there",
                "density 2785 kg/m^3"
            ]
        );
    }

    #[test]
    fn many_gauges_are_told_to_people_and_programs() {
        let dir = tempfile::tempdir().unwrap();
        let run = RunFolder::at(dir.path());
        let columns = ["step", "time", "gauge", "pressure"].map(|name| Column::new(name, ""));
        let names = ["front", "rear"].map(str::to_owned);
        let mut records = GaugeRecords::new(&run, columns.to_vec(), names.to_vec());
        for step in 0..3_u32 {
            for gauge in 0..2 {
                let pressure = f64::from(10 * step + gauge);
                let time = f64::from(step);
                records.add(step.into(), time, gauge, std::iter::once(pressure));
            }
        }
        records.write().unwrap();
        let lines = last_figures(&run);
        let values: Vec<&str> = lines.iter().map(|line| line.1.as_str()).collect();
        assert_eq!(values, ["pressure 20", "pressure 21"]);
        assert!(last_rows(&run)["gauges"].to_string().contains("rear"));
    }
}
