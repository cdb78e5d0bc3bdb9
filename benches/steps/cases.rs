//! The fixed cases.

use std::fmt::Write as _;

use files::input::{self, InputError};
use model::Case;

/// A case whose speed is measured.
pub struct BenchCase {
    /// Name on the command line and in reports.
    pub name: &'static str,
    /// Description on one line.
    pub what: &'static str,
    text: &'static str,
    set: &'static [&'static str],
    /// Time of the case at which the measurement begins (s).
    pub begin: f64,
    /// Steps that are timed.
    pub steps: u64,
    /// True for small cases that only test the command.
    pub quick: bool,
    /// Measured only where it is named.
    pub on_demand: bool,
}

/// All cases.
pub const CASES: &[BenchCase] = &[
    BenchCase {
        name: "block-100k",
        what: "a block of 47 x 47 x 47 particles at rest",
        set: &[],
        ..BLOCK
    },
    BenchCase {
        name: "block-1m",
        what: "a block of 100 x 100 x 100 particles at rest",
        set: &[r#"body.block.shape.box.size=["2 mm", "2 mm", "2 mm"]"#],
        steps: 20,
        ..BLOCK
    },
    BenchCase {
        name: "quarter-50k",
        what: "the quarter impact, shocked: spacing 0.02 mm, from 0.05 us on",
        ..QUARTER
    },
    BenchCase {
        name: "quarter-400k",
        what: "the same with a spacing of 0.01 mm",
        set: &["run.end_time=1us", "spacing=0.01mm"],
        ..QUARTER
    },
    BenchCase {
        name: "debris-50k",
        what: "the quarter impact, the plate perforated: spacing 0.02 mm, from 0.2 us on",
        begin: 0.2e-6,
        ..QUARTER
    },
    BenchCase {
        name: "block-10k",
        what: "small: a block of 22 x 22 x 22 particles",
        set: &[r#"body.block.shape.box.size=["0.44 mm", "0.44 mm", "0.44 mm"]"#],
        steps: 20,
        quick: true,
        ..BLOCK
    },
    BenchCase {
        name: "quarter-3k",
        what: "small: the quarter impact with a spacing of 0.05 mm",
        set: &["run.end_time=1us", "spacing=0.05mm"],
        steps: 20,
        quick: true,
        ..QUARTER
    },
    BenchCase {
        name: "plate",
        what: "where it is named: a plate of 100 x 100 x 4 particles",
        set: &[r#"body.block.shape.box.size=["2 mm", "2 mm", "0.08 mm"]"#],
        on_demand: true,
        ..BLOCK
    },
    BenchCase {
        name: "half-plate",
        what: "where it is named: half of that, before a plane of symmetry",
        set: &[
            r#"body.block.shape.box.size=["2 mm", "2 mm", "0.04 mm"]"#,
            r#"symmetry=[{ axis = "z", position = "-0.02 mm" }]"#,
        ],
        on_demand: true,
        ..BLOCK
    },
];

const BLOCK: BenchCase = BenchCase {
    name: "",
    what: "",
    text: r#"
title = "Block at rest"
dimension = 3
spacing = "0.02 mm"

[run]
end_time = "1 s"

[sph]
smoothing = 1.3

[material.aluminium]
library = "aluminium-2024"

[[body]]
name = "block"
material = "aluminium"
shape.box = { size = ["0.94 mm", "0.94 mm", "0.94 mm"] }
lattice = "cubic"
"#,
    set: &[],
    begin: 0.0,
    steps: 50,
    quick: false,
    on_demand: false,
};

// Longer than the input's own end, which no measurement is to meet.
const QUARTER: BenchCase = BenchCase {
    name: "",
    what: "",
    text: include_str!("../../inputs/quarter-impact/case.toml"),
    set: &["run.end_time=1us"],
    begin: 0.05e-6,
    steps: 50,
    quick: false,
    on_demand: false,
};

impl BenchCase {
    /// The case itself.
    ///
    /// # Errors
    /// Never for the cases of [`CASES`], as a test makes sure.
    pub fn read(&self) -> Result<Case, InputError> {
        let set: Vec<String> = self.set.iter().map(|&set| set.to_owned()).collect();
        input::parse(self.name, self.text, &set)
    }
}

/// The names and descriptions of all cases, for `--help`.
pub fn table() -> String {
    CASES.iter().fold(String::new(), |mut text, case| {
        let start = if text.is_empty() { "" } else { "\n" };
        let _ = write!(text, "{start}  {:<14} {}", case.name, case.what);
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_have_as_many_particles_as_they_say() {
        let counts = CASES.iter().map(|bench| {
            let case = bench.read().expect(bench.name);
            let count = |body| populate::count(body, case.dimension, &case.symmetry, None);
            case.bodies.iter().map(count).sum::<u64>()
        });
        let counts: Vec<u64> = counts.collect();
        let block = |side: u64| side * side * side;
        assert_eq!([counts[0], counts[1], counts[5]], [47, 100, 22].map(block));
        let plates = [100 * 100 * 4, 100 * 100 * 2];
        assert_eq!([counts[7], counts[8]], plates);
        for (k, about) in [(2, 50_000), (3, 400_000), (4, 50_000), (6, 3_000)] {
            assert!(
                counts[k].abs_diff(about) * 10 < about,
                "{}: {}",
                CASES[k].name,
                counts[k]
            );
        }
    }
}
