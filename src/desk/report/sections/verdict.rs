//! Verdict on the run's figures: each against the bound that the book names.

use crate::report::html::{Html, missing, note, table};
use crate::report::run_files::{Rows, Run};
use files::output::Phase;
use model::readable::short;
use std::fmt::Write as _;

/// A figure against its bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Within,
    Beyond,
    Unknown,
    /// No bound fits every case: the reader judges.
    Open,
}

impl Outcome {
    fn of(holds: Option<bool>) -> Self {
        match holds {
            Some(true) => Self::Within,
            Some(false) => Self::Beyond,
            None => Self::Unknown,
        }
    }

    /// Its word and its sign, so that nobody needs the colour.
    fn badge(self) -> Html {
        let (class, word) = match self {
            Self::Within => ("badge within", "✓ within"),
            Self::Beyond => ("badge beyond", "✗ beyond"),
            Self::Unknown => ("badge untold", "– not told"),
            Self::Open => ("badge untold", "? to judge"),
        };
        Html::element("span", &[("class", class)], Html::text(word))
    }
}

/// A figure and its bound.
struct Check {
    what: String,
    value: String,
    bound: &'static str,
    source: &'static str,
    outcome: Outcome,
}

/// The bound of a figure of the summary: the largest that it may be.
struct Bound {
    key: &'static str,
    what: &'static str,
    most: f64,
    /// `true` if it is printed in percent.
    percent: bool,
    words: &'static str,
    source: &'static str,
}

const MAIN_JOB: &str = "book, Validation: the main job";
const CONTACT: &str = "book, Contact: the contact defect";
const OUTPUT: &str = "book, Output: summary.json";
const LAWS: &str = "book, Laws: nothing is lost in silence";
const SPACING: &str = "book, Choose spacing";
const PLATES: &str = "book, Measures: plates";
const FAILED: &str = "book, Failure: what failed matter keeps";

/// Bodies that a row of the table names at most.
const NAMED: usize = 3;

/// The bounds of the book.
const BOUNDS: [Bound; 8] = [
    Bound {
        key: "energy_error_max",
        what: "energy error",
        most: 5e-3,
        percent: true,
        words: "≤ 0.5 % of the largest kinetic energy, or of the work put in",
        source: MAIN_JOB,
    },
    Bound {
        key: "contact_defect",
        what: "contact defect",
        most: 5e-3,
        percent: true,
        words: "≤ 0.5 %, as part of the energy error",
        source: CONTACT,
    },
    Bound {
        key: "momentum_error",
        what: "momentum error",
        most: 1e-12,
        percent: false,
        words: "≤ 1e-12 of the largest Σ|m v|, or of the impulse put in",
        source: MAIN_JOB,
    },
    Bound {
        key: "angular_momentum_error",
        what: "angular momentum error",
        most: 1e-2,
        percent: true,
        words: "≤ 1 % of the largest Σ|(x − x̄) × m v|, beyond which a run warns",
        source: OUTPUT,
    },
    Bound {
        key: "interpenetrated_particles",
        what: "interpenetrated particles",
        most: 0.0,
        percent: false,
        words: "0",
        source: MAIN_JOB,
    },
    Bound {
        key: "removed_particles",
        what: "particles removed, out of range",
        most: 0.0,
        percent: false,
        words: "0",
        source: LAWS,
    },
    Bound {
        key: "frozen_particles",
        what: "particles frozen, out of range",
        most: 0.0,
        percent: false,
        words: "0",
        source: LAWS,
    },
    Bound {
        key: "absorbing_zones.yielded_mass",
        what: "mass yielded in absorbing zones",
        most: 0.0,
        percent: false,
        words: "none",
        source: "book, Output: history.csv",
    },
];

/// Tells the verdict.
pub fn render(run: &Run) -> Html {
    let mut checks: Vec<Check> = vec![ended(run)];
    let applies = |bound: &&Bound| {
        bound.key != "absorbing_zones.yielded_mass" || run.figure(bound.key).is_some()
    };
    checks.extend(BOUNDS.iter().filter(applies).map(|bound| check(run, bound)));
    checks.insert(checks.len().min(5), nearest(run));
    checks.push(mass(run));
    checks.push(across(run));
    checks.extend(unfinished(run));
    checks.extend(failed(run));
    let mut page = headline(&checks);
    if let Err(reason) = &run.summary {
        page.push(missing(&format!("Most figures are not told: {reason}.")));
    }
    let row = |check: &Check| {
        vec![
            check.outcome.badge(),
            Html::text(&check.what),
            Html::element("span", &[("class", "figure")], Html::text(&check.value)),
            Html::text(check.bound),
            Html::text(check.source),
        ]
    };
    page.push(table(
        &[
            "verdict",
            "figure",
            "of this run",
            "bound",
            "where it is named",
        ],
        checks.iter().map(row),
    ));
    page.push(note(
        "Bounds of the main job hold for its spacing: the contact defect is an error of the time step \
         where few particles meet, and falls with the spacing (book, Validation). What a run does not \
         measure is not told: with contact “kernel” and “none” bodies are not told apart.",
    ));
    page
}

/// One sentence in colour and words.
fn headline(checks: &[Check]) -> Html {
    let of = |outcome: Outcome| checks.iter().filter(move |check| check.outcome == outcome);
    let known = of(Outcome::Within).count() + of(Outcome::Beyond).count();
    let beyond: Vec<&str> = of(Outcome::Beyond)
        .map(|check| check.what.as_str())
        .collect();
    let mut open = String::new();
    for check in of(Outcome::Open) {
        let _ = write!(open, " Judge the {}: {}.", check.what, check.value);
    }
    let unknown = match of(Outcome::Unknown).count() {
        0 => String::new(),
        count => format!(" Not told: {count}."),
    };
    let (class, text) = if !beyond.is_empty() {
        let text = format!(
            "✗ Look closer: {} of {known} figures beyond their bounds: {}.{open}{unknown}",
            beyond.len(),
            beyond.join(", ")
        );
        ("verdict beyond", text)
    } else if known > 1 {
        (
            "verdict within",
            format!("✓ Sound: all {known} figures are within their bounds.{open}{unknown}"),
        )
    } else {
        (
            "verdict untold",
            "– No verdict: the run does not tell its figures.".to_owned(),
        )
    };
    Html::element("p", &[("class", class)], Html::text(&text))
}

/// The check that the run has come to its end.
fn ended(run: &Run) -> Check {
    let status = run.status.as_ref().ok();
    let value = status.map_or("–".to_owned(), |status| match &status.reason {
        Some(reason) => format!("{}: {reason}", status.state.name()),
        None => status.state.name().to_owned(),
    });
    Check {
        what: "how the run ended".to_owned(),
        value,
        bound: "finished",
        source: "book, Output: status.json",
        outcome: Outcome::of(status.map(|status| status.state == Phase::Finished)),
    }
}

/// The largest size of a figure, which may have components.
fn size(value: &serde_json::Value) -> Option<f64> {
    match value {
        serde_json::Value::Object(parts) => {
            let sizes: Option<Vec<f64>> = parts.values().map(size).collect();
            Some(sizes?.into_iter().fold(0.0, f64::max))
        }
        value => value.as_f64().map(f64::abs),
    }
}

fn check(run: &Run, bound: &Bound) -> Check {
    let computed = run.figure(bound.key).and_then(size);
    let value = computed.map_or("–".to_owned(), |value| {
        if bound.percent {
            format!("{} %", short(100.0 * value))
        } else {
            short(value)
        }
    });
    Check {
        what: bound.what.to_owned(),
        value,
        bound: bound.words,
        source: bound.source,
        outcome: Outcome::of(computed.map(|value| value <= bound.most)),
    }
}

/// The nearest two particles of two bodies; without any near pair there is nothing to hold.
fn nearest(run: &Run) -> Check {
    let closest = run.number("closest_foreign_pair");
    let bodies = run
        .figure("closest_foreign_particles.bodies")
        .and_then(|names| names.as_array());
    let names = bodies
        .into_iter()
        .flatten()
        .filter_map(|name| name.as_str());
    let names = names.collect::<Vec<_>>().join(" – ");
    let value = closest.map_or("–".to_owned(), |closest| {
        format!("{} spacings {names}", short(closest))
    });
    Check {
        what: "nearest foreign pair".to_owned(),
        value: value.trim_end().to_owned(),
        bound: "≥ 0.28 spacings",
        source: OUTPUT,
        outcome: Outcome::of(closest.map(|closest| closest >= 0.28)),
    }
}

/// The bodies with the fewest particles across, for what their figures need.
fn across(run: &Run) -> Check {
    let bodies = run
        .figure("particles_across")
        .and_then(|bodies| bodies.as_object());
    let mut found: Vec<(&str, [f64; 2])> = bodies
        .into_iter()
        .flatten()
        .filter_map(|(name, of)| {
            let number = |key: &str| of.get(key).and_then(serde_json::Value::as_f64);
            Some((name.as_str(), [number("particles")?, number("least")?]))
        })
        .collect();
    let ratio = |[particles, least]: [f64; 2]| particles / least;
    found.sort_by(|(_, a), (_, b)| ratio(*a).total_cmp(&ratio(*b)));
    // Rounding may add or remove a layer.
    let is_thin = |&&(_, [particles, least]): &&(&str, [f64; 2])| particles < least - 0.01;
    let thin = found.iter().filter(is_thin).count();
    let named: Vec<String> = found
        .iter()
        .take(thin.clamp(1, NAMED))
        .map(|(name, [particles, least])| format!("{name} {}, wants {least}", short(*particles)))
        .collect();
    let more = match thin.saturating_sub(NAMED) {
        0 => String::new(),
        more => format!("; {more} bodies more"),
    };
    let value = if named.is_empty() {
        "–".to_owned()
    } else {
        named.join("; ") + &more
    };
    Check {
        what: "particles across".to_owned(),
        value,
        bound: "6 across the thinnest part, 10 of what strikes in three dimensions",
        source: SPACING,
        outcome: Outcome::of((!found.is_empty()).then_some(thin == 0)),
    }
}

/// The last verdicts on plates that are none yet.
fn unfinished(run: &Run) -> Vec<Check> {
    let found = || -> Result<Vec<Check>, String> {
        let rows = Rows::read(&run.folder.measures())?;
        let [time, measure, figure, value] =
            ["time", "measure", "figure", "value"].map(|name| rows.column(name));
        let [time, measure, figure, value] = [time?, measure?, figure?, value?];
        let verdicts = rows
            .like_last(time)
            .filter(|&row| rows.text(row, figure) == "verdict");
        let open =
            verdicts.filter(|&row| ["not_loaded", "still_moving"].contains(&rows.text(row, value)));
        Ok(open
            .map(|row| Check {
                what: format!("verdict on {}", rows.text(row, measure)),
                value: rows.text(row, value).replace('_', " "),
                bound: "one that lasts: let the run go on",
                source: PLATES,
                outcome: Outcome::Beyond,
            })
            .collect())
    };
    // A run without measures has no verdict to wait for.
    found().unwrap_or_default()
}

/// The share of each body that has failed, if any has.
fn failed(run: &Run) -> Option<Check> {
    let rows = Rows::read(&run.folder.bodies()).ok()?;
    let [time, body, mass, failed] =
        ["time", "body", "mass", "failed_mass"].map(|name| rows.column(name).ok());
    let [time, body, mass, failed] = [time?, body?, mass?, failed?];
    let share = |row: usize| rows.number(row, failed) / rows.number(row, mass);
    let mut shares: Vec<(f64, &str)> = rows
        .like_last(time)
        .map(|row| (share(row), rows.text(row, body)))
        .filter(|(share, _)| *share > 0.0)
        .collect();
    shares.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    let named = shares.iter().take(NAMED);
    let words: Vec<String> = named
        .map(|(share, name)| format!("{} % of {name}", short(100.0 * share)))
        .collect();
    (!words.is_empty()).then(|| Check {
        what: "failed share".to_owned(),
        value: words.join(", "),
        bound: "what the case means to break",
        source: FAILED,
        outcome: Outcome::Open,
    })
}

/// Mass at the end, with all that left or was taken out, against that at the start.
fn mass(run: &Run) -> Check {
    let defect = mass_defect(run);
    Check {
        what: "mass defect".to_owned(),
        value: defect
            .as_ref()
            .map_or_else(|reason| format!("– ({reason})"), |defect| short(*defect)),
        bound: "≤ 1e-12: round-off of a sum, as of momentum",
        source: LAWS,
        outcome: Outcome::of(defect.ok().map(|defect| defect <= 1e-12)),
    }
}

fn mass_defect(run: &Run) -> Result<f64, String> {
    let bodies = Rows::read(&run.folder.bodies())?;
    let [time, mass] = [bodies.column("time")?, bodies.column("mass")?];
    let sum = |rows: &mut dyn Iterator<Item = usize>| {
        rows.map(|row| bodies.number(row, mass)).sum::<f64>()
    };
    let [first, last] = [
        sum(&mut bodies.like(0, time)),
        sum(&mut bodies.like_last(time)),
    ];
    // Rows of particles that have left exist at more times than those of bodies.
    let now = bodies.text(bodies.len() - 1, time);
    let gone = |path: std::path::PathBuf| -> Result<f64, String> {
        if !path.exists() {
            return Ok(0.0);
        }
        let rows = Rows::read(&path)?;
        let [time, mass] = [rows.column("time")?, rows.column("mass")?];
        let of_now = (0..rows.len()).filter(|&row| rows.text(row, time) == now);
        let masses: Vec<f64> = of_now.map(|row| rows.number(row, mass)).collect();
        if masses.is_empty() {
            return Err("what has gone is not told at the last time of bodies".to_owned());
        }
        // Bodies are listed with all images, so are these unless the table states no share.
        let images = if rows.states_share() {
            1.0
        } else {
            run.copies()
        };
        Ok(images * masses.into_iter().sum::<f64>())
    };
    let gone = gone(run.folder.removed())? + gone(run.folder.departed())?;
    let defect = (last + gone - first).abs() / first;
    defect
        .is_finite()
        .then_some(defect)
        .ok_or_else(|| "masses are no numbers".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use files::output::RunFolder;

    /// Bodies are written less often than particles that have left: a run that is stopped or goes
    /// on has times of those alone.
    #[test]
    fn masses_of_one_time_are_added_up() {
        let dir = tempfile::tempdir().unwrap();
        let folder = RunFolder::at(dir.path());
        let bodies = "time,body,mass\n0.0,a,4.0\n0.0,b,2.0\n0.5,a,3.0\n0.5,b,2.0\n";
        std::fs::write(folder.bodies(), bodies).unwrap();
        let removed = "time,body,mass\n0.0,a,0.0\n0.0,b,0.0\n0.5,a,0.75\n0.5,b,0.0\n\
                       0.6,a,0.75\n0.6,b,1.0\n";
        std::fs::write(folder.removed(), removed).unwrap();
        let departed = "time,body,mass\n0.5,a,0.25\n0.5,b,0.0\n0.6,a,2.0\n0.6,b,0.0\n";
        std::fs::write(folder.departed(), departed).unwrap();
        let defect = || mass_defect(&Run::read(&folder));
        assert_eq!(defect(), Ok(0.0));
        std::fs::write(folder.departed(), "time,body,mass\n0.6,a,0.25\n").unwrap();
        assert!(defect().is_err());
    }

    /// A run that has ended well and within its bounds, with coarse bodies, a plate on its way and failed matter.
    #[test]
    fn coarse_bodies_open_verdicts_and_failed_matter_are_in_the_headline() {
        let dir = tempfile::tempdir().unwrap();
        let folder = RunFolder::at(dir.path());
        let write = |path: std::path::PathBuf, text: &str| std::fs::write(path, text).unwrap();
        let headline = || {
            let page = render(&Run::read(&folder)).into_markup();
            let (_, rest) = page.split_once("<p class=\"verdict").unwrap();
            rest.split_once("</p>").unwrap().0.to_owned()
        };
        let summary = |across: f64| {
            let sphere = serde_json::json!({ "particles": across, "least": 10 });
            let all = serde_json::json!({ "energy_error_max": 1e-4, "particles_across": { "sphere": sphere } });
            write(folder.summary(), &all.to_string());
        };
        let bodies = |failed: f64| {
            let text =
                format!("time,body,mass,failed_mass\n0.0,wall,4.0,0.0\n1.0,wall,4.0,{failed}\n");
            write(folder.bodies(), &text);
        };
        let measures = |word: &str| {
            let text = format!(
                "time,measure,figure,value\n0.0,wall,verdict,not_loaded\n1.0,wall,verdict,{word}\n"
            );
            write(folder.measures(), &text);
        };
        let status = r#"{ "state": "finished", "step": 9, "time": 1.0 }"#;
        write(folder.status_file(), status);
        summary(12.0);
        bodies(0.0);
        assert!(headline().contains("✓ Sound"), "{}", headline());
        measures("held");
        assert!(headline().contains("✓ Sound"), "{}", headline());
        bodies(1.0);
        let found = headline();
        assert!(found.contains("✓ Sound"), "{found}");
        assert!(
            found.contains("Judge the failed share: 25 % of wall."),
            "{found}"
        );
        measures("still_moving");
        let found = headline();
        assert!(
            found.contains("✗ Look closer") && found.contains("verdict on wall"),
            "{found}"
        );
        summary(6.0);
        let found = headline();
        assert!(
            found.contains("particles across, verdict on wall"),
            "{found}"
        );
    }
}
