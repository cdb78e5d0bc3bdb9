//! The material library as a page of the book.

use std::fmt::Write as _;

use crate::materials::{Sources, table};
use material::{Constant, Material, library};

/// The text before the tables.
const HEAD: &str = "\
# Materials

<!-- Written by `whipple generate materials`: change the library (src/material/library), not this page. -->

The library has the materials below. A case takes one by its name:

```toml
[material.sphere]
library = \"aluminium-2024\"
```

Single values may be changed beside the name, and laws of failure added:

```toml
[material.sphere]
library = \"aluminium-2024\"
strength.von_mises.yield_stress = \"0.3 GPa\"
failure.spall = { pressure = \"-1.4 GPa\" }
```

One metal has several names, which differ in what they know:

| name | strength | take it for |
|---|---|---|
| `aluminium-6061` | constant yield stress (von Mises) | shocks far above the yield stress; a first run |
| `aluminium-6061-johnson-cook` | yield stress of Johnson and Cook: strain, strain rate and temperature | rods, bars and plates that bend, bulge and heat |
| `aluminium-6061-ductile` | the same, and it **fails** (Johnson and Cook, spall where it is known) | perforation, holes, debris |
| `aluminium-6061-steinberg-guinan` | modulus and yield stress that grow with pressure | strain rates above some 10⁵/s, as under craters |
| `aluminium-tillotson` | constant yield stress, an equation of state with vapour | impacts that vaporise material, above some 10 km/s |

Of metals only the `-ductile` ones fail by themselves; rock, ice and ceramics do, and [keep friction](../theory/granular.md). Debris that never fails holds together as long as it can: add `failure.spall` or another
[law](../theory/failure.md) to whatever breaks.

The formulas stand in [Materials](../theory/materials.md), all keys in the [input reference](input-reference.md). `whipple materials NAME`
prints one of the tables below, ready to be copied into a case and changed; `whipple materials --json` prints all of them for programs.

## Overview

Sound is the longitudinal speed at rest, √(M/ρ₀) with the P-wave modulus M.

| name | what it is | ρ₀, kg/m³ | sound, m/s | equation of state, strength, failure |
|---|---|---|---|---|
";

/// The page.
pub fn page() -> String {
    let mut page = HEAD.to_owned();
    let all = || library::names().into_iter();
    for (name, material) in
        all().filter_map(|name| library::find(name).map(|material| (name, material)))
    {
        write_row(&mut page, name, &material);
    }
    page.push_str("\n## Constants\n\nA source stands beside the first number that comes from it. The numbers below without one come from the same. Where a source states a range, \
         it stands before the source; [`--scatter KEY=stated`](sweeps.md#bands) takes its ends.\n");
    for (name, table) in
        all().filter_map(|name| table(name, Sources::Once).map(|table| (name, table)))
    {
        let _ = writeln!(page, "\n### {name}\n\n```toml\n{}\n```", table.trim_end());
    }
    page
}

fn write_row(page: &mut String, name: &str, material: &Material) {
    let constants = material.constants();
    let sound = material.longitudinal_speed();
    let laws: Vec<String> = ["eos", "strength", "failure"]
        .iter()
        .flat_map(|kind| laws(&constants, kind))
        .collect();
    let _ = writeln!(
        page,
        "| [`{name}`](#{name}) | {} | {} | {sound:.0} | {} |",
        library::title(name).unwrap_or_default(),
        material.reference_density,
        laws.join(", "),
    );
}

/// The laws of a kind that the constants belong to: `eos.tait` of `eos.tait.b`.
fn laws(constants: &[Constant], kind: &str) -> Vec<String> {
    let mut laws: Vec<String> = Vec::new();
    for constant in constants {
        let words: Vec<&str> = constant.key.split('.').collect();
        if let [first, law, _] = words[..]
            && first == kind
        {
            laws.push(format!("`{kind}.{law}`"));
        }
    }
    laws.dedup();
    laws
}
