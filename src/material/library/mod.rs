//! Ready materials, each number with its source.
//!
//! Only records of `ceramics`, `composites`, `ductile`, `fabrics` and `rocks`, concrete and pumice, fail. Spall strengths depend on the rate of the load: theirs are those
//! of plate impacts, and a case may state its own.

use super::{Eos, Failure, Material, Strength, Thermal, ThermalConstants};

/// One material of the library.
struct Record {
    name: &'static str,
    /// Description, in a line.
    title: &'static str,
    make: fn() -> Parts,
    /// Keys, or what they begin with, and where their numbers come from; the first that fits
    /// counts.
    sources: &'static [(&'static str, &'static str)],
}

/// Declares records: name and title, what makes the material, and its sources.
macro_rules! records {
    ($($name:literal, $title:literal: $make:expr, $sources:expr;)+) => {
        pub(super) const RECORDS: &[super::Record] = &[$(super::Record {
            name: $name,
            title: $title,
            make: || $make,
            sources: $sources,
        }),+];
    };
}

mod alloys;
mod ceramics;
mod composites;
mod ductile;
mod explosives;
mod fabrics;
mod fluids;
mod heavy;
mod impact;
mod metal;
mod metals;
mod paper;
mod polymers;
mod porous;
mod ranges;
mod rocks;

/// Parts from which a record makes its material.
struct Parts {
    /// kg/m³
    density: f64,
    eos: Eos,
    strength: Strength,
    thermal: Option<ThermalConstants>,
    failure: Failure,
}

/// All records, sorted by name.
fn records() -> Vec<&'static Record> {
    let lists = [
        alloys::RECORDS,
        ceramics::RECORDS,
        composites::RECORDS,
        ductile::RECORDS,
        explosives::RECORDS,
        fabrics::RECORDS,
        fluids::RECORDS,
        heavy::RECORDS,
        impact::RECORDS,
        metals::RECORDS,
        paper::RECORDS,
        polymers::RECORDS,
        porous::RECORDS,
        rocks::RECORDS,
    ];
    let mut all: Vec<&Record> = lists.into_iter().flatten().collect();
    all.sort_by_key(|record| record.name);
    all
}

/// Names of all materials, in alphabetical order.
#[must_use]
pub fn names() -> Vec<&'static str> {
    records().iter().map(|record| record.name).collect()
}

/// The material of this name, if the library has it.
#[must_use]
pub fn find(name: &str) -> Option<Material> {
    record(name).map(|record| {
        let parts = (record.make)();
        let heat = |constants| Thermal::new(constants, parts.density, &parts.eos);
        let porosity = porous::of(record.name, parts.density, &parts.eos)
            .or_else(|| fabrics::of(record.name, parts.density, &parts.eos));
        Material {
            name: record.name.to_owned(),
            reference_density: porosity
                .as_ref()
                .map_or(parts.density, |pores| pores.density),
            thermal: parts.thermal.map(heat),
            eos: parts.eos,
            strength: parts.strength,
            failure: parts.failure,
            porosity,
        }
    })
}

/// Description of the material of this name, in a line.
#[must_use]
pub fn title(name: &str) -> Option<&'static str> {
    record(name).map(|record| record.title)
}

/// Source of the number at a key (`eos.mie_gruneisen.c0`) of the material of this name.
#[must_use]
pub fn source(name: &str, key: &str) -> Option<&'static str> {
    let fits = |(begin, _): &&(&str, &str)| key.starts_with(begin);
    let sources = record(name)?.sources;
    sources.iter().find(fits).map(|(_, source)| *source)
}

/// The least and the largest number (SI) that the source of the number at a key of the material of this name states; nothing where it
/// states none.
#[must_use]
pub fn range(name: &str, key: &str) -> Option<[f64; 2]> {
    let mut all = ranges::RANGES.iter();
    let found = all.find(|(material, of, _)| (*material, *of) == (name, key));
    found.map(|(.., range)| *range)
}

fn record(name: &str) -> Option<&'static Record> {
    records().into_iter().find(|record| record.name == name)
}

/// Thermal constants: specific heat (J/(kg K)), reference and melting temperatures (K).
fn heat(specific_heat: f64, reference: f64, melting: Option<f64>) -> ThermalConstants {
    ThermalConstants {
        specific_heat,
        reference_temperature: reference,
        melting_temperature: melting,
        taylor_quinney: 1.0,
    }
}
