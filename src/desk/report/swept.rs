//! The page of a sweep: what was asked, limits with their bands, what matters, all points.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::html::{Html, list, note, or_reason, table_of_texts};
use super::page::{Section, whole};
use super::picture::{WIDTH, chart as drawn, image};
use crate::sweep::{Definition, draw, draw_effects};
use files::output::{Sheet, read_sheet, read_small};
use model::readable::with_unit;

/// The chart that `whipple limit --sweep` lays beside an equation, if it is a picture of pixels.
const EQUATION: &str = "limit.png";

/// The page of a sweep's folder.
///
/// # Errors
/// Why the folder has no readable sweep.
pub fn swept(folder: &Path) -> Result<String, String> {
    let definition = Definition::read(folder).map_err(|error| error.to_string())?;
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let points = sheet(folder, "sweep.csv");
    let state = match &points {
        Ok(points) => format!("Sweep {name}, {} points", points.rows.len()),
        Err(reason) => format!("Sweep {name}; {reason}"),
    };
    let scattered = definition.scattered();
    let mut sections: Vec<Section> = vec![("asked", "What was asked", Ok(asked(&definition)))];
    if let Ok(limits) = sheet(folder, "limits.csv") {
        sections.push(("limits", "Limits", Ok(table(&limits))));
    }
    let chart = match draw(folder, &scattered, None) {
        Ok(Some((chart, _))) => Ok(drawn(
            Ok(chart),
            "the answer over the last key that is a number",
        )),
        Ok(None) => Err("no key and no answer is a number".to_owned()),
        Err(error) => Err(error.to_string()),
    };
    sections.push(("chart", "Chart", chart));
    if let Ok(bytes) = read_small(&folder.join(EQUATION)) {
        let source = format!("data:image/png;base64,{}", STANDARD.encode(bytes));
        let attributes = [
            ("src", &source[..]),
            ("alt", "runs beside a ballistic limit equation"),
        ];
        let image = Html::element("img", &attributes, Html::default());
        let figure = Html::element("figure", &[], image);
        sections.push(("equation", "Beside the equation", Ok(figure)));
    }
    if scattered.contains(&true) {
        let bands = sheet(folder, "bands.csv").map(|bands| {
            table(&bands).then(note(
                "Deviation is the standard deviation of one run; least and largest are those of all runs.",
            ))
        });
        sections.push(("bands", "Bands", bands));
        let effects = sheet(folder, "effects.csv").map(|effects| {
            let picture = match draw_effects(folder, None) {
                Ok(Some((chart, _))) => {
                    let canvas = chart.draw(Some(WIDTH)).map_err(|error| error.to_string());
                    image(canvas, "what each scattered key does to the answer")
                }
                _ => Html::default(),
            };
            let effects = match &points {
                Ok(points) => with_values(effects, points),
                Err(_) => effects,
            };
            picture.then(table(&strongest_first(effects))).then(note(
                "Means over all other scattered keys at the value of each key that gives the least and the largest of them.",
            ))
        });
        sections.push(("effects", "What matters", effects));
    }
    sections.push(("points", "Points", points.map(|points| table(&points))));
    Ok(whole(&format!("Sweep {name}"), &state, sections))
}

/// The definition of a sweep.
fn asked(definition: &Definition) -> Html {
    let mut entries = vec![("case".to_owned(), definition.case.display().to_string())];
    for (name, texts) in [
        ("set", &definition.settings),
        ("varied", &definition.vary),
        ("scattered", &definition.scatter),
    ] {
        entries.extend(texts.iter().map(|text| (name.to_owned(), text.clone())));
    }
    if let Some(condition) = &definition.bisect {
        entries.push(("bisected".to_owned(), condition.clone()));
        let within = format!("{} of the range", definition.within);
        entries.push(("to within".to_owned(), within));
    }
    list(entries)
}

fn sheet(folder: &Path, name: &str) -> Result<Sheet, String> {
    read_sheet(&folder.join(name)).map_err(|error| error.to_string())
}

/// A table with its numbers in units that fit.
fn table(sheet: &Sheet) -> Html {
    let own_unit = sheet.names.iter().position(|name| name == "unit");
    let of_answers = ["mean", "deviation", "least", "largest", "effect"];
    let head: Vec<String> = sheet
        .names
        .iter()
        .map(|name| name.replace('_', " "))
        .collect();
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let rows = sheet.rows.iter().map(|(_, row)| {
        let cell = |(k, text): (usize, &String)| {
            let own = own_unit.filter(|_| of_answers.contains(&&sheet.names[k][..]));
            let unit = own.map_or(&sheet.units[k][..], |unit| &row[unit][..]);
            match text.parse::<f64>() {
                Ok(number) if text.contains(['.', 'e']) => {
                    with_unit(number, unit.trim_matches('-'))
                }
                _ => text.clone(),
            }
        };
        row.iter().enumerate().map(cell).collect()
    });
    or_reason(if sheet.rows.is_empty() {
        Err("there is none yet".to_owned())
    } else {
        Ok(table_of_texts(&head, rows))
    })
}

/// Effects with the values of keys in units that fit, which the columns of points have.
fn with_values(mut effects: Sheet, points: &Sheet) -> Sheet {
    let column = |name: &str| effects.names.iter().position(|own| own == name);
    if let [Some(key), Some(low), Some(high)] = ["key", "at", "at_largest"].map(column) {
        for (_, row) in &mut effects.rows {
            let own = points.names.iter().position(|name| *name == row[key]);
            let unit = own.map_or("", |own| points.units[own].trim_matches('-'));
            for at in [low, high] {
                if let Ok(number) = row[at].parse::<f64>() {
                    row[at] = with_unit(number, unit);
                }
            }
        }
    }
    effects
}

/// Effects by answer, the largest first.
fn strongest_first(mut effects: Sheet) -> Sheet {
    let column = |name: &str| effects.names.iter().position(|own| own == name);
    if let [Some(answer), Some(effect)] = ["answer", "effect"].map(column) {
        let size = |row: &[String]| row[effect].parse::<f64>().unwrap_or(0.0);
        effects.rows.sort_by(|(_, a), (_, b)| {
            let by_key = a[..answer]
                .cmp(&b[..answer])
                .then(a[answer].cmp(&b[answer]));
            by_key.then(size(b).total_cmp(&size(a)))
        });
    }
    effects
}
