//! Charts of a run's `history.csv`, `performance.csv` and `ranks.csv` over time: energies, steps,
//! momentum, defects, and the balance of the ranks.

use std::path::PathBuf;

use super::curves::{Chart, Curve, Line, Quantity};
use super::ranks::by_rank;
use super::table::{Table, wrong};
use crate::PlotError;
use crate::canvas::Rgb;
use crate::colour;
use crate::header::Mark;

/// The charts of a run's history.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum History {
    /// Energies of the model.
    Energies,
    /// Time steps, by what limits them.
    TimeStep,
    /// Components of the momentum of all particles.
    Momentum,
    /// The changes of the energy, and of that of contact, that nothing accounts for.
    Defect,
    /// The load of the busiest rank over the mean.
    Load,
    /// Work of each rank over the mean.
    Ranks,
}

/// Columns that are drawn of energies, their names in the legend and their colours.
const ENERGIES: [(&str, &str, Rgb); 5] = [
    ("total_energy", "total", [40, 40, 40]),
    ("kinetic_energy", "kinetic", [0, 114, 178]),
    ("internal_energy", "internal", [213, 94, 0]),
    ("contact_energy", "contact", [0, 158, 115]),
    ("self_gravity_energy", "self-gravity", [204, 121, 167]),
];

impl History {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Energies,
        Self::TimeStep,
        Self::Momentum,
        Self::Defect,
        Self::Load,
        Self::Ranks,
    ];

    /// As it is typed, and for names of files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Energies => "energies",
            Self::TimeStep => "time-step",
            Self::Momentum => "momentum",
            Self::Defect => "defect",
            Self::Load => "load",
            Self::Ranks => "ranks",
        }
    }

    /// The table of a run that has it.
    #[must_use]
    pub fn table(self) -> &'static str {
        match self {
            Self::Load => "performance.csv",
            Self::Ranks => "ranks.csv",
            _ => "history.csv",
        }
    }

    /// Its curves over time of some tables, each with a name.
    ///
    /// # Errors
    /// [`PlotError::Table`] if a file or a column is missing or a number cannot be read.
    pub fn chart(self, tables: &[(String, PathBuf)], title: &str) -> Result<Chart, PlotError> {
        let mut chart = self.empty(title);
        for (name, path) in tables {
            let table = Table::read(path)?;
            let read = self.read(&table, &mut chart);
            let lines = read.map_err(|reason| wrong(path, reason))?;
            for (line, own, points) in lines {
                let count = chart.curves.len();
                let (name, colour) = if tables.len() > 1 {
                    (format!("{name}: {line}"), colour::body(count))
                } else {
                    (line, own)
                };
                chart.curves.push(Curve {
                    name,
                    colour,
                    mark: self.mark(),
                    points,
                    ..Curve::default()
                });
            }
        }
        Ok(chart)
    }

    fn mark(self) -> Mark {
        match self {
            Self::TimeStep => Mark::Dots,
            _ => Mark::Line,
        }
    }

    /// Without curves.
    fn empty(self, title: &str) -> Chart {
        let axis = |label: &str, unit: &str, room| Quantity {
            label: label.to_owned(),
            unit: unit.to_owned(),
            from_zero: true,
            room,
            ..Quantity::default()
        };
        let time = axis("time", "s", false);
        let (subtitle, x, y) = match self {
            Self::Energies => ("energies", time, axis("energy", "J", true)),
            Self::TimeStep => (
                "time steps by what limits them",
                time,
                axis("time step", "s", true),
            ),
            Self::Momentum => ("momentum", time, axis("momentum", "kg m/s", true)),
            Self::Defect => (
                "energy that is not accounted for",
                time,
                axis("energy", "J", true),
            ),
            Self::Load => (
                "load of the busiest rank over the mean",
                axis("step", "", false),
                axis("load over the mean", "", true),
            ),
            Self::Ranks => (
                "work of each rank over the mean",
                axis("step", "", false),
                axis("work over the mean", "", true),
            ),
        };
        Chart {
            title: title.to_owned(),
            subtitle: subtitle.to_owned(),
            x,
            y,
            curves: Vec::new(),
        }
    }

    /// The lines of a table, whose unit the chart takes.
    fn read(self, table: &Table, chart: &mut Chart) -> Result<Vec<Line>, String> {
        let x = match self {
            Self::Load | Self::Ranks => "step",
            _ => "time",
        };
        let x = table.column(x)?;
        let against =
            |y: Vec<f64>| -> Vec<[f64; 2]> { x.iter().zip(y).map(|(&x, y)| [x, y]).collect() };
        let mut lines = Vec::new();
        let unit = match self {
            Self::Energies => {
                for (column, name, colour) in ENERGIES.into_iter().filter(|row| table.has(row.0)) {
                    lines.push((name.to_owned(), colour, against(table.column(column)?)));
                }
                "total_energy"
            }
            Self::TimeStep => {
                lines = by_reason(table, &x)?;
                "dt"
            }
            Self::Momentum => {
                for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
                    let momentum = table.column(&format!("momentum_{axis}"))?;
                    lines.push((axis.to_owned(), colour::body(k), against(momentum)));
                }
                "momentum_x"
            }
            Self::Defect => {
                let [all, contact] = defects(table)?;
                lines.push(("of the whole".to_owned(), ENERGIES[0].2, against(all)));
                lines.push(("of contact".to_owned(), ENERGIES[3].2, against(contact)));
                "total_energy"
            }
            Self::Load => {
                for (k, (column, name)) in [
                    ("work_imbalance", "work"),
                    ("particle_imbalance", "particles"),
                ]
                .into_iter()
                .enumerate()
                {
                    let load = table.column(column)?;
                    lines.push((name.to_owned(), colour::body(k), against(load)));
                }
                "work_imbalance"
            }
            Self::Ranks => {
                lines = by_rank(table, &x)?;
                "work_over_mean"
            }
        };
        let unit = table.unit(unit)?;
        if !["", "-"].contains(&unit) {
            unit.clone_into(&mut chart.y.unit);
        }
        Ok(lines)
    }
}

/// Steps over time, apart for each reason, in the order in which they first come.
fn by_reason(table: &Table, time: &[f64]) -> Result<Vec<Line>, String> {
    let mut lines: Vec<Line> = Vec::new();
    let steps = table.column("dt")?;
    for ((&time, step), reason) in time.iter().zip(steps).zip(table.texts("dt_reason")?) {
        // Before the first step there is none.
        if step == 0.0 {
            continue;
        }
        let known = lines.iter().position(|line| line.0 == reason);
        let at = known.unwrap_or_else(|| {
            let colour = colour::body(lines.len());
            lines.push((reason.to_owned(), colour, Vec::new()));
            lines.len() - 1
        });
        lines[at].2.push([time, step]);
    }
    Ok(lines)
}

/// The total energy less that of loads and of particles that have left, from the start; and the
/// energy of contact that its work and its heat do not account for.
fn defects(table: &Table) -> Result<[Vec<f64>; 2], String> {
    let column = |name: &str| table.column(name);
    let gained = |name: &str| -> Result<Vec<f64>, String> {
        let all = column(name)?;
        let first = all.first().copied().unwrap_or_default();
        Ok(all.into_iter().map(|value| value - first).collect())
    };
    let mut all = gained("total_energy")?;
    take(&mut all, &gained("load_work")?, -1.0);
    if table.has("departed_energy") {
        take(&mut all, &gained("departed_energy")?, 1.0);
    }
    let mut contact = gained("contact_energy")?;
    for name in ["contact_work", "contact_heat"] {
        take(&mut contact, &gained(name)?, 1.0);
    }
    Ok([all, contact])
}

/// Adds values times a factor to others.
fn take(sums: &mut [f64], values: &[f64], factor: f64) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += factor * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "# units: -,s,s,-,J,J,J,J,kg m/s,kg m/s,kg m/s,J,J,J\n\
        step,time,dt,dt_reason,kinetic_energy,internal_energy,contact_energy,total_energy,\
        momentum_x,momentum_y,momentum_z,load_work,contact_work,contact_heat\n\
        0,0.0,0.0,sound,3,1,0,4,0,0,-2,0,0,0\n5,1e-8,2e-9,sound,2,1.5,0.5,4.25,1,0,-2,0.25,-0.75,0.25\n\
        9,2e-8,1e-9,contact,2,1.5,0.5,4.5,1,0,-2,0.25,-0.75,0.5\n";

    fn lines(of: History, text: &str) -> Result<Vec<Line>, String> {
        of.read(&Table::parse(text)?, &mut of.empty(""))
    }

    #[test]
    fn every_energy_is_a_curve() {
        let energies = lines(History::Energies, TABLE).unwrap();
        assert_eq!(energies[1].2[..2], [[0.0, 3.0], [1e-8, 2.0]]);
        assert_eq!(energies[3].2[1], [1e-8, 0.5]);
        let message = lines(History::Energies, "time,kinetic_energy\n0,1\n").unwrap_err();
        assert!(message.contains("no column total_energy"), "{message}");
    }

    #[test]
    fn steps_go_by_their_reason() {
        let steps = lines(History::TimeStep, TABLE).unwrap();
        let [(sound, _, first), (contact, _, second)] = &steps[..] else {
            panic!("{steps:?}");
        };
        assert_eq!((&sound[..], &contact[..]), ("sound", "contact"));
        assert_eq!(
            (&first[..], &second[..]),
            (&[[1e-8, 2e-9]][..], &[[2e-8, 1e-9]][..])
        );
    }

    #[test]
    fn defects_are_what_nothing_accounts_for() {
        let defects = lines(History::Defect, TABLE).unwrap();
        let values = defects
            .iter()
            .map(|line| line.2.iter().map(|point| point[1]));
        let values: Vec<Vec<f64>> = values.map(Iterator::collect).collect();
        assert_eq!(values, [[0.0, 0.0, 0.25], [0.0, 0.0, 0.25]]);
        assert_eq!(
            lines(History::Momentum, TABLE).unwrap()[2].2[0],
            [0.0, -2.0]
        );
    }

    #[test]
    fn several_runs_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("performance.csv");
        let text =
            "# units: -,s,-,-\nstep,wall_seconds,particle_imbalance,work_imbalance\n0,1,1.5,1.25\n";
        std::fs::write(&path, text).unwrap();
        let tables = ["a", "b"].map(|name| (name.to_owned(), path.clone()));
        let chart = History::Load.chart(&tables, "").unwrap();
        let names: Vec<&str> = chart.curves.iter().map(|curve| &curve.name[..]).collect();
        assert_eq!(
            names,
            ["a: work", "a: particles", "b: work", "b: particles"]
        );
        assert!(History::Energies.chart(&tables, "").is_err());
    }
}
