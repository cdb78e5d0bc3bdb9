//! `whipple materials`: the library, each number with its unit and source.

use std::fmt::Write as _;

use serde_json::json;

use super::output_format::OutputFormat;
use files::run::exit::EXIT_INPUT;
use files::run::say::{say, warn};
use material::{Constant, Material, Value, library};

/// Print the material library: all names, or each number of one material with its source
///
/// What is printed of a material is a table of the input that gives the same material. Where a source states a range, it stands
/// before the source.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple materials
  whipple materials copper-johnson-cook
  whipple materials copper --json")]
pub struct MaterialsArgs {
    /// Name of a material
    #[arg(value_name = "NAME")]
    name: Option<String>,

    #[command(flatten)]
    format: OutputFormat,
}

/// Runs the command; returns the exit code.
pub fn run(args: &MaterialsArgs) -> u8 {
    args.format.begin();
    let Some(name) = &args.name else {
        say(list().trim_end());
        args.format.print(|| {
            let all: Vec<_> = library::names().into_iter().filter_map(as_json).collect();
            all.into()
        });
        return 0;
    };
    if let (Some(text), Some(document)) = (table(name, Sources::All), as_json(name)) {
        say(text.trim_end());
        args.format.print(|| document);
        return 0;
    }
    let names = library::names().join(", ");
    warn(&format!(
        "error: unknown material `{name}`\n  = help: the library has {names}"
    ));
    EXIT_INPUT
}

/// All materials, one in a line.
fn list() -> String {
    let mut text = format!(
        "{:<32} {:>9}  {:<14} {:<20} what it is\n",
        "name", "kg/m^3", "eos", "strength"
    );
    for name in library::names() {
        let Some(material) = library::find(name) else {
            continue;
        };
        let constants = material.constants();
        let _ = writeln!(
            text,
            "{name:<32} {:>9}  {:<14} {:<20} {}",
            material.reference_density,
            law(&constants, "eos"),
            law(&constants, "strength"),
            library::title(name).unwrap_or_default(),
        );
    }
    text + "\n`whipple materials NAME` prints each number of one with its source.\n"
}

/// The law of a kind that the constants belong to: `tait` of `eos.tait.b`.
fn law<'a>(constants: &'a [Constant], kind: &str) -> &'a str {
    let second = |constant: &'a Constant| {
        let mut words = constant.key.split('.');
        (words.next() == Some(kind)).then(|| words.next().unwrap_or("none"))
    };
    constants.iter().find_map(second).unwrap_or("none")
}

/// Lines with a source beside them.
#[derive(Clone, Copy, PartialEq)]
pub enum Sources {
    /// All lines.
    All,
    /// The first of those that follow each other and have the same source.
    Once,
}

/// A material as a table of the input, with sources as comments.
pub fn table(name: &str, sources: Sources) -> Option<String> {
    let material = library::find(name)?;
    let title = library::title(name).unwrap_or_default();
    let mut text = format!("# {title}\n[material.{name}]\n");
    let lines: Vec<(String, String, &str)> = material
        .constants()
        .iter()
        .map(|constant| {
            let line = format!("{} = {}", constant.key, written(constant.value));
            let source = library::source(name, &constant.key).unwrap_or("no source");
            (line, range(name, constant), source)
        })
        .collect();
    let width = lines.iter().map(|(line, ..)| line.len()).max().unwrap_or(0);
    let mut last = "";
    for (line, range, source) in lines {
        let said = match sources {
            Sources::Once if source == last => "",
            _ => source,
        };
        let parts: Vec<&str> = [&range[..], said]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect();
        let _ = match &parts[..] {
            [] => writeln!(text, "{line}"),
            parts => writeln!(text, "{line:<width$}  # {}", parts.join("; ")),
        };
        last = source;
    }
    let _ = writeln!(text, "# {}", derived(&material));
    Some(text)
}

/// The range that the source of a number states, as in `-1.7 GPa to -1.1 GPa`; nothing where it states none.
fn range(name: &str, constant: &Constant) -> String {
    let range = library::range(name, &constant.key);
    match (range, constant.value) {
        (Some([least, largest]), Value::Number(_, unit)) => {
            let [least, largest] = [least, largest].map(|end| scaled(end, unit, usize::MAX));
            format!("{least} to {largest}")
        }
        _ => String::new(),
    }
}

/// Quantities that users compare and no table holds.
fn derived(material: &Material) -> String {
    format!(
        "p-wave modulus {}, longitudinal sound speed {:.0} m/s",
        scaled(material.p_wave_modulus(), "Pa", 4),
        material.longitudinal_speed()
    )
}

/// A value as the input writes it.
pub(crate) fn written(value: Value) -> String {
    match value {
        Value::Word(word) => format!("\"{word}\""),
        Value::Number(number, "") => format!("{number:?}"),
        Value::Number(number, unit) => format!("\"{}\"", scaled(number, unit, usize::MAX)),
    }
}

/// A number with its unit and the prefix that makes it short; all its digits, or so many. The
/// decimal point only moves, so that reading it gives the same bits.
fn scaled(number: f64, unit: &str, digits: usize) -> String {
    if number < 0.0 {
        return format!("-{}", scaled(-number, unit, digits));
    }
    if let Some(divisor) = unit.strip_prefix('1') {
        return format!("{number:?}{divisor}");
    }
    let scientific = if digits == usize::MAX {
        format!("{number:e}")
    } else {
        format!("{number:.*e}", digits - 1)
    };
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let power = exponent.div_euclid(3) * 3;
    let prefix = match power {
        3 => "k",
        6 => "M",
        9 => "G",
        _ => return format!("{number} {unit}"),
    };
    if !["Pa", "J/kg"].contains(&unit) {
        return format!("{number} {unit}");
    }
    let digits = mantissa.replace('.', "");
    let whole = 1 + usize::try_from(exponent - power).unwrap_or(0);
    let (front, back) = digits.split_at(whole.min(digits.len()));
    let point = if back.is_empty() { "" } else { "." };
    format!("{front:0<whole$}{point}{back} {prefix}{unit}")
}

fn as_json(name: &str) -> Option<serde_json::Value> {
    let material = library::find(name)?;
    let constants: Vec<_> = material
        .constants()
        .iter()
        .map(|constant| {
            let (value, unit) = match constant.value {
                Value::Number(number, unit) => (json!(number), unit),
                Value::Word(word) => (json!(word), ""),
            };
            let source = library::source(name, &constant.key);
            let range = library::range(name, &constant.key);
            json!({ "key": constant.key, "value": value, "unit": unit, "range": range, "source": source })
        })
        .collect();
    Some(json!({
        "name": name,
        "title": library::title(name),
        "p_wave_modulus": material.p_wave_modulus(),
        "constants": constants,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use files::input::parse;

    #[test]
    fn every_table_gives_its_material_again() {
        for name in library::names() {
            let table = table(name, Sources::All).unwrap();
            assert!(!table.contains("no source"), "{table}");
            let text = format!(
                "dimension = 3\nspacing = \"1 mm\"\nrun.end_time = \"1 us\"\ncontact.mode = \"none\"\n\
                 [[body]]\nname = \"b\"\nmaterial = \"{name}\"\nshape.box.size = [\"1 cm\", \"1 cm\", \"1 cm\"]\n{table}"
            );
            let case = parse(name, &text, &[]).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(Some(&case.materials[0]), library::find(name).as_ref());
        }
    }

    #[test]
    fn ranges_stand_beside_their_numbers() {
        let text = table("copper-ductile", Sources::All).unwrap();
        let line = text
            .lines()
            .find(|line| line.starts_with("failure.spall.pressure"));
        let line = line.unwrap();
        assert!(
            line.contains("# -2 GPa to -1.2 GPa; assumed: the middle"),
            "{line}"
        );
        let document = as_json("copper-ductile").unwrap();
        let constants = document["constants"].as_array().unwrap();
        let ranges: Vec<_> = constants
            .iter()
            .filter(|constant| !constant["range"].is_null())
            .collect();
        assert_eq!(ranges.len(), 1);
        assert_eq!(ranges[0]["range"], json!([-2.0e9, -1.2e9]));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(scaled(28.6e9, "Pa", usize::MAX), "28.6 GPa");
        assert_eq!(scaled(1.002e-3, "Pa s", usize::MAX), "0.001002 Pa s");
        assert_eq!(scaled(4.72e6, "J/kg", usize::MAX), "4.72 MJ/kg");
        assert_eq!(scaled(6.52e-11, "1/Pa", usize::MAX), "6.52e-11/Pa");
        assert_eq!(scaled(1.0, "1/s", usize::MAX), "1.0/s");
        assert_eq!(scaled(0.0, "Pa", usize::MAX), "0 Pa");
        assert_eq!(scaled(2e11, "Pa", usize::MAX), "200 GPa");
        assert_eq!(scaled(123_456.0e6, "Pa", 4), "123.5 GPa");
    }
}
