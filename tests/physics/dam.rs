//! The breaking dam (`inputs/dam-break`) at twice its spacing, until it stands at the far wall.

use crate::physics_support::dam::{report, run};

/// Bounds as for the ready case, see `validation_dam`.
#[test]
fn a_dam_breaks() {
    let dam = run(&["spacing=\"0.73 cm\""], 0.35);
    report(&dam);
    assert!(
        dam.arrivals.iter().all(|&ratio| (ratio - 1.0).abs() < 0.1),
        "{:?}",
        dam.arrivals
    );
    assert!(dam.volume < 0.01, "{}", dam.volume);
    assert!(dam.wall > 0.0, "water in a wall: {}", dam.wall);
}
