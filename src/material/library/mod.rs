//! Ready materials, each number with its source.
//!
//! No record has a spall cut-off: spall strengths depend on the rate of the load, so a case
//! states its own.

pub mod metals;

use super::Material;

/// One material of the library.
struct Record {
    name: &'static str,
    make: fn() -> Material,
    sources: &'static str,
}

/// Names of all materials, in alphabetical order.
#[must_use]
pub fn names() -> Vec<&'static str> {
    metals::RECORDS.iter().map(|record| record.name).collect()
}

/// The material of this name, if the library has it.
#[must_use]
pub fn find(name: &str) -> Option<Material> {
    record(name).map(|record| (record.make)())
}

/// Where each number of the material of this name comes from, if the library has it.
#[must_use]
pub fn sources(name: &str) -> Option<&'static str> {
    record(name).map(|record| record.sources)
}

fn record(name: &str) -> Option<&'static Record> {
    metals::RECORDS.iter().find(|record| record.name == name)
}
