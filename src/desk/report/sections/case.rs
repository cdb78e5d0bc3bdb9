//! The simulated case: bodies, materials, spacing, contact, planes.

use std::collections::BTreeMap;

use crate::report::html::{Html, list, missing, note, swatch, table, table_of_texts};
use crate::report::run_files::{Rows, Run, in_words};
use plot::colour_of;

/// Tells the case.
pub fn render(run: &Run) -> Result<Html, String> {
    let case = run.case.as_ref().map_err(Clone::clone)?;
    let mut page = list(facts(run, case));
    page.push(bodies(run));
    if let Some(materials) = case.get("material").and_then(toml::Value::as_table) {
        page.push(Html::of("h3", "Materials"));
        let row = |(name, keys): (&String, &toml::Value)| vec![name.clone(), in_words(keys)];
        page.push(table_of_texts(
            &["material", "what is stated of it"],
            materials.iter().map(row),
        ));
    }
    page.push(boundaries(run));
    Ok(page)
}

/// Facts of the whole case, in a line each.
fn facts(run: &Run, case: &toml::Table) -> Vec<(&'static str, String)> {
    let words = |key: &str| case.get(key).map(in_words);
    let inside = |table: &str, key: &str| Some(in_words(case.get(table)?.get(key)?));
    let particles = run.number("particles").map(|count| format!("{count}"));
    let facts = [
        ("dimensions", words("dimension")),
        ("particle spacing", words("spacing")),
        ("particles computed", particles),
        ("form of SPH", inside("sph", "form")),
        ("contact", words("contact")),
        ("end time", inside("run", "end_time")),
        ("sums over time", run.folder.note_of_part("history.csv")),
    ];
    let entries = facts.into_iter();
    entries
        .filter_map(|(name, value)| Some((name, value?)))
        .collect()
}

/// A row for each body, with the colour that it has in pictures.
fn bodies(run: &Run) -> Html {
    let counted = counted(run);
    let of_case = run.case.as_ref().ok().and_then(|case| case.get("spacing"));
    let spacing = of_case.map_or("–".to_owned(), in_words);
    let mut colour = 0;
    let row = |body: &toml::Table| {
        let word = |key: &str| body.get(key).map_or("–".to_owned(), in_words);
        let square = swatch(colour_of(colour));
        colour += 1;
        let name = word("name");
        let of_bodies = counted
            .as_ref()
            .ok()
            .and_then(|table| table.get(&name).cloned());
        let [particles, mass] = of_bodies.unwrap_or_else(|| ["–".to_owned(), "–".to_owned()]);
        let texts = [
            word("material"),
            word("shape"),
            body.get("spacing")
                .map_or_else(|| spacing.clone(), in_words),
            word("velocity"),
            particles,
            mass,
        ];
        let mut cells = vec![square.then(Html::of("span", &name))];
        cells.extend(texts.iter().map(|text| Html::text(text)));
        cells
    };
    let rows: Vec<Vec<Html>> = run.entries("body").into_iter().map(row).collect();
    let head = [
        "body",
        "material",
        "shape",
        "spacing",
        "velocity",
        "particles",
        "mass",
    ];
    let mut page = Html::of("h3", "Bodies").then(table(&head, rows));
    page.push(match counted {
        Ok(_) => note(
            "Particles and masses are of the whole model with its mirror images, at the start.",
        ),
        Err(reason) => missing(&format!(
            "Particles and masses of bodies are not told: {reason}."
        )),
    });
    page
}

/// Particles of each body at the start, and the mass of it with all its images.
fn counted(run: &Run) -> Result<BTreeMap<String, [String; 2]>, String> {
    let rows = Rows::read(&run.folder.bodies())?;
    let [time, body] = [rows.column("time")?, rows.column("body")?];
    let first = rows.like(0, time);
    let entry = |row: usize| {
        let cells = ["particles", "mass"].map(|name| rows.cell(row, name));
        (rows.text(row, body).to_owned(), cells)
    };
    Ok(first.map(entry).collect())
}

/// Planes of symmetry, rigid surfaces, absorbing zones and loads.
fn boundaries(run: &Run) -> Html {
    let kinds = [
        ("symmetry", "plane of symmetry"),
        ("plane", "rigid surface"),
        ("absorb", "absorbing zone"),
        ("load", "load"),
    ];
    let row = |(key, kind): (&'static str, &'static str)| {
        let all = run.entries(key).into_iter();
        all.map(move |entry| {
            vec![
                kind.to_owned(),
                in_words(&toml::Value::Table(entry.clone())),
            ]
        })
    };
    let rows: Vec<Vec<String>> = kinds.into_iter().flat_map(row).collect();
    let title = Html::of("h3", "Boundaries");
    if rows.is_empty() {
        return title.then(Html::of("p", "No planes, zones or loads: bodies are free."));
    }
    title.then(table_of_texts(&["boundary", "where and how"], rows))
}
