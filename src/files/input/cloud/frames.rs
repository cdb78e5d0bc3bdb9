//! Texts of frames, of which the last one counts: LAMMPS dumps and extended XYZ.

use std::collections::BTreeMap;
use std::str::Lines;

use super::columns::{Head, MOST_COLUMNS, Rows};
use super::text::{at, shortened};
use super::{Fault, Request, Table, UnitSystem};

/// Lines with their numbers.
type Numbered<'t> = std::iter::Enumerate<Lines<'t>>;

/// Rows of a frame: where they begin, and how many they are.
struct Frame<'t, H> {
    head: H,
    rows: Numbered<'t>,
    count: usize,
}

/// Reads the last frame of a LAMMPS dump.
///
/// # Errors
/// The fault, with its line.
pub fn lammps(text: &str, request: &Request) -> Result<Table, Fault> {
    let mut lines = text.lines().enumerate();
    let (mut is_si, mut count, mut last) = (false, 0, None);
    while let Some((n, line)) = lines.next() {
        let Some(item) = line.strip_prefix("ITEM: ") else {
            if line.trim().is_empty() {
                continue;
            }
            return Err(at(n, "it is no LAMMPS dump: an `ITEM:` stands here").into());
        };
        let item = item.trim();
        if let Some(names) = item.strip_prefix("ATOMS") {
            let rows = lines.clone();
            skip(&mut lines, count, n)?;
            let head = names;
            last = Some((n, Frame { head, rows, count }));
        } else if item.starts_with("BOX BOUNDS") {
            skip(&mut lines, 3, n)?;
        } else {
            let (n, value) = lines.next().ok_or_else(|| at(n, ENDS))?;
            match item {
                "UNITS" => is_si = value.trim() == "si",
                "NUMBER OF ATOMS" => count = whole(value).map_err(|what| at(n, what))?,
                "TIME" | "TIMESTEP" => {}
                _ => {
                    let item = shortened(item);
                    return Err(at(n - 1, format!("the item `{item}` is not read")).into());
                }
            }
        }
    }
    let (n, frame) = last.ok_or("it is no LAMMPS dump: it has no `ITEM: ATOMS`")?;
    let names = frame.head.split_whitespace();
    let names: Vec<String> = names.take(MOST_COLUMNS).map(usual).collect();
    if names.iter().any(|name| name == "xs" || name == "xsu") {
        return Err(at(n, "scaled places are not read: dump `x y z`").into());
    }
    let head = Head {
        units: vec![None; names.len()],
        names,
    };
    let si = Request {
        units: UnitSystem {
            length: Some(1.0),
            mass: Some(1.0),
            time: Some(1.0),
        },
        columns: request.columns.clone(),
        parts: request.parts.clone(),
        ..*request
    };
    rows(
        &head,
        frame.rows.take(frame.count),
        if is_si { &si } else { request },
        &["type"],
    )
}

/// The name of a column of LAMMPS here: unwrapped places are places.
fn usual(name: &str) -> String {
    match name {
        "xu" | "yu" | "zu" => &name[..1],
        name => name,
    }
    .to_owned()
}

/// Reads the last frame of an extended XYZ file.
///
/// # Errors
/// The fault, with its line.
pub fn xyz(text: &str, request: &Request) -> Result<Table, Fault> {
    let mut lines = text.lines().enumerate();
    let mut last = None;
    while let Some((n, line)) = lines.next() {
        if line.trim().is_empty() {
            continue;
        }
        let wrong = |_| at(n, "it is no XYZ file: a number of particles stands here");
        let count = whole(line).map_err(wrong)?;
        let (n, head) = lines.next().ok_or_else(|| at(n, ENDS))?;
        let rows = lines.clone();
        skip(&mut lines, count, n)?;
        last = Some((n, Frame { head, rows, count }));
    }
    let (n, frame) = last.ok_or("it is no XYZ file: it is empty")?;
    let head = xyz_head(frame.head).map_err(|what| at(n, what))?;
    rows(&head, frame.rows.take(frame.count), request, &["species"])
}

/// Columns by the `Properties` of a frame; its `units`, as this program writes them, are theirs.
fn xyz_head(line: &str) -> Result<Head, String> {
    let of = |key: &str| attributes(line).find(|(known, _)| known.eq_ignore_ascii_case(key));
    let (_, properties) = of("Properties").ok_or("it has no `Properties`, as extended XYZ has")?;
    let units = of("units").map_or("", |(_, units)| units);
    let units = units.split(", ").filter_map(|pair| pair.split_once(": "));
    let units: BTreeMap<&str, &str> = units.filter(|(_, unit)| unit.len() < 100).collect();
    let mut head = Head::default();
    let words: Vec<&str> = properties.split(':').collect();
    for property in words.chunks(3).take(MOST_COLUMNS) {
        let [name, _, width] = property else {
            return Err("its `Properties` are not name, type and number of columns".to_owned());
        };
        let width = whole(width)?;
        if !(1..=9).contains(&width) {
            return Err(format!(
                "the property `{}` has {width} columns",
                shortened(name)
            ));
        }
        let name = match *name {
            "velo" => "velocity",
            name => name,
        };
        // Of tensors each component is a property.
        let tensor = name.rsplit_once('_').map_or(name, |(tensor, _)| tensor);
        let of_whole = if name == "pos" { "position" } else { tensor };
        let unit = units.get(name).or_else(|| units.get(of_whole));
        for k in 0..width {
            let axis = ["x", "y", "z"].get(k).unwrap_or(&"more");
            let name = match (name, width) {
                ("pos", _) => (*axis).to_owned(),
                (_, 1) => name.to_owned(),
                _ => format!("{name}_{axis}"),
            };
            head.names.push(name);
            head.units.push(unit.map(|unit| (*unit).to_owned()));
        }
    }
    Ok(head)
}

/// Keys with their values, which quotes may hold together.
fn attributes(line: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut rest = line;
    std::iter::from_fn(move || {
        let (key, value) = rest.split_once('=')?;
        let key = key.rsplit(char::is_whitespace).next().unwrap_or_default();
        let (value, after) = match value.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').unwrap_or((quoted, "")),
            None => value.split_once(char::is_whitespace).unwrap_or((value, "")),
        };
        rest = after;
        Some((key, value))
    })
}

const ENDS: &str = "the file ends too early";

fn whole(word: &str) -> Result<usize, String> {
    let count = word.trim().parse::<usize>().ok();
    let count = count.filter(|count| *count <= super::MOST);
    count.ok_or_else(|| format!("`{}` is no number of things", shortened(word.trim())))
}

/// Passes over so many lines behind the one of a number.
fn skip(lines: &mut Numbered, count: usize, n: usize) -> Result<(), String> {
    let is_there = count == 0 || lines.nth(count - 1).is_some();
    is_there.then_some(()).ok_or_else(|| at(n, ENDS))
}

/// The table of lines of words.
fn rows<'t>(
    head: &Head,
    lines: impl Iterator<Item = (usize, &'t str)>,
    request: &Request,
    parts: &[&str],
) -> Result<Table, Fault> {
    let mut rows = Rows::of(head, request, parts)?;
    let mut words: Vec<&str> = Vec::new();
    for (n, line) in lines {
        words.clear();
        words.extend(line.split_whitespace());
        if words.len() != head.names.len() {
            let (found, wanted) = (words.len(), head.names.len());
            return Err(at(n, format!("{found} values, and {wanted} columns")).into());
        }
        rows.add(|place| Ok(words[place]))
            .map_err(|what| at(n, what))?;
    }
    rows.table()
}

#[cfg(test)]
mod tests;
