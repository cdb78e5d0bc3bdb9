//! Tables of an equation, for people and for programs, and of shots beside it.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::laws::Law;
use crate::output_format;
use desk::sweep::{Onset, Shot, onset};
use files::output::Sheet;

/// A millimetre (m) and a kilometre in a second (m/s).
const UNITS: [f64; 2] = [1e-3, 1e3];

/// The table that is printed: km/s and mm.
pub(super) fn text(law: &Law, speeds: &[f64]) -> String {
    let [mm, km_s] = UNITS;
    let widths: Vec<usize> = law
        .names
        .iter()
        .map(|n| n.chars().count().max(10))
        .collect();
    let mut text = format!("{}\n\n{:>8}", law.subtitle, "km/s");
    for (name, width) in law.names.iter().zip(&widths) {
        let _ = write!(text, "  {name:>width$}");
    }
    text += "\n";
    for &speed in speeds {
        let row = (law.at)(speed);
        let _ = write!(text, "{:>8}", decimals(speed / km_s, 3));
        for (value, width) in row.values.iter().zip(&widths) {
            let _ = write!(text, "  {:>width$}", format!("{:.3} mm", value / mm));
        }
        if !row.remark.is_empty() {
            let _ = write!(text, "  {}", row.remark);
        }
        text += "\n";
    }
    text + "\n"
}

/// A number with so many decimals at most.
fn decimals(number: f64, most: usize) -> String {
    let text = format!("{number:.most$}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The table that is written: SI units.
pub(super) fn sheet(law: &Law, speeds: &[f64]) -> Sheet {
    let words = |name: &&str| name.replace(" & ", "_").replace(' ', "_").to_lowercase();
    let mut names = vec!["speed".to_owned()];
    names.extend(law.names.iter().map(words));
    names.push("remark".to_owned());
    let mut units = vec!["m/s".to_owned()];
    units.extend(law.names.iter().map(|_| "m".to_owned()));
    units.push(String::new());
    let row = |&speed: &f64| {
        let row = (law.at)(speed);
        let mut cells = vec![format!("{speed:?}")];
        cells.extend(row.values.iter().map(|value| format!("{value:?}")));
        cells.push(row.remark.to_owned());
        cells
    };
    Sheet {
        computed_share: None,
        names,
        units,
        rows: speeds.iter().map(row).enumerate().collect(),
    }
}

/// Of a logistic curve the distance of 95 % from its middle, in scales: ln 19.
pub(super) const TAIL: f64 = 2.944_438_979_166_44;

/// The whole report, in SI units.
pub(super) fn document(law: &Law, speeds: &[f64], beside: &[Shot]) -> Value {
    let shots = beside.iter().map(|shot| {
        let critical = law.limit.map(|at| (law.at)(shot.speed).values[at]);
        json!({
            "run": shot.run,
            "speed": shot.speed,
            "diameter": shot.diameter,
            "failed": shot.failed,
            "critical_diameter": critical,
        })
    });
    let mut document = output_format::table(&sheet(law, speeds));
    document["title"] = law.title.as_str().into();
    document["subtitle"] = law.subtitle.as_str().into();
    document["source"] = law.source.into();
    document["holds_for"] = law.holds.into();
    document["shots"] = shots.collect();
    document["onset"] = onset_document(&onset_of(law, beside));
    document
}

/// Shots beside the limit, a line for each, and how many of them it predicts.
pub(super) fn shots(law: &Law, shots: &[Shot]) -> String {
    let [mm, km_s] = UNITS;
    let Some(limit) = law.limit else {
        return String::new();
    };
    let mut text = format!(
        "{:>8}  {:>10}  {:>8}  {:<6}  {:<8}  folder\n",
        "km/s", "diameter", "d/d_c", "run", "equation"
    );
    let mut agreeing = 0;
    for shot in shots {
        let part = shot.diameter / (law.at)(shot.speed).values[limit];
        let fails = part > 1.0;
        agreeing += usize::from(fails == shot.failed);
        let word = |failed| if failed { "failed" } else { "held" };
        let _ = writeln!(
            text,
            "{:>8}  {:>10}  {part:>8.3}  {:<6}  {:<8}  {}",
            decimals(shot.speed / km_s, 3),
            format!("{:.3} mm", shot.diameter / mm),
            word(shot.failed),
            word(fails),
            shot.run,
        );
    }
    let _ = writeln!(
        text,
        "run and equation agree on {agreeing} of {} shots",
        shots.len()
    );
    text += &onset_in_words(&onset_of(law, shots));
    text
}

/// What shots say of the diameter from which on runs fail, as the logarithm of its ratio to that of the equation.
pub(super) fn onset_of(law: &Law, shots: &[Shot]) -> Onset {
    let Some(limit) = law.limit else {
        return Onset::Unknown;
    };
    let ratio = |shot: &Shot| {
        let critical = (law.at)(shot.speed).values[limit];
        (libm::log(shot.diameter / critical), shot.failed)
    };
    let ratios: Vec<(f64, bool)> = shots.iter().map(ratio).collect();
    onset(&ratios)
}

fn onset_in_words(onset: &Onset) -> String {
    let part = |x: f64| format!("{:.3}", libm::exp(x));
    match *onset {
        Onset::Unknown => String::new(),
        Onset::Between(held, failed) => format!(
            "runs hold up to {} and fail from {} times the diameter of the equation on\n",
            part(held),
            part(failed)
        ),
        Onset::Curve {
            middle,
            scale,
            error,
        } => format!(
            "half of the runs fail at {} times the diameter of the equation (standard error {:.1} %), 5 % at {}, 95 % at {} \
             (logistic curve)\n",
            part(middle),
            100.0 * error,
            part(middle - scale * TAIL),
            part(middle + scale * TAIL)
        ),
    }
}

/// As numbers: ratios of diameters.
fn onset_document(onset: &Onset) -> Value {
    match *onset {
        Onset::Unknown => Value::Null,
        Onset::Between(held, failed) => json!({
            "held_up_to": libm::exp(held),
            "failed_from": libm::exp(failed),
        }),
        Onset::Curve {
            middle,
            scale,
            error,
        } => json!({
            "half_fail_at": libm::exp(middle),
            "standard_error": error,
            "scale": scale,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::super::laws::{Row, limit};
    use super::*;
    use desk::ballistic::{Limit, Regime, Shield};

    /// A millimetre at a kilometre in a second, two at two.
    fn law() -> Law {
        let shield = Shield {
            bumper: 1e-3,
            wall: 1e-3,
            gap: 0.1,
            yield_strength: 3e8,
            bumper_density: 2700.0,
            wall_density: 2700.0,
            stuffing: 0.0,
        };
        let flight = desk::ballistic::Shot {
            speed: 0.0,
            angle: 0.0,
            density: 2700.0,
        };
        limit(
            "Straight line",
            "nobody",
            "nothing",
            shield,
            flight,
            |_, shot| Limit {
                diameter: shot.speed * 1e-6,
                regime: Regime::Shatter,
            },
        )
    }

    #[test]
    fn tables_have_readable_units_for_people_and_si_for_programs() {
        let text = text(&law(), &[1000.0, 2500.0]);
        assert!(text.contains("    1    "), "{text}");
        assert!(text.contains("2.5           2.500 mm  shatter\n"), "{text}");
        let sheet = sheet(&law(), &[1000.0, 2500.0]);
        assert_eq!(sheet.names, ["speed", "critical_diameter", "remark"]);
        assert_eq!(sheet.units, ["m/s", "m", ""]);
        assert_eq!(sheet.rows[1].1, ["2500.0", "0.0025", "shatter"]);
        let Row { values, .. } = (law().at)(2500.0);
        assert_eq!(values, [2500.0 * 1e-6]);
    }

    #[test]
    fn shots_are_told_from_the_equation() {
        let shot = |diameter, failed| Shot {
            run: "a".to_owned(),
            diameter,
            speed: 1000.0,
            failed,
        };
        let text = shots(
            &law(),
            &[shot(0.8e-3, false), shot(1.2e-3, true), shot(1.3e-3, false)],
        );
        assert!(text.contains("1.200  failed  failed"), "{text}");
        assert!(text.contains("agree on 2 of 3 shots\n"), "{text}");
        assert!(text.contains("half of the runs fail at "), "{text}");
        let document = document(
            &law(),
            &[1000.0],
            &[shot(0.8e-3, false), shot(1.2e-3, true)],
        );
        assert_eq!(
            document["onset"]["failed_from"]
                .as_f64()
                .map(|x| (1e9 * x).round()),
            Some(1.2e9)
        );
        let text = shots(&law(), &[shot(0.8e-3, false), shot(1.2e-3, true)]);
        assert!(
            text.contains("hold up to 0.800 and fail from 1.200 times"),
            "{text}"
        );
        assert!(shots(&law(), &[shot(0.8e-3, false)]).ends_with("of 1 shots\n"));
    }
}
