//! The breaking dam (`inputs/dam-break`) to its end at 1 s.

use crate::physics_support::dam::{report, run};

/// Times of the front within 10 % of Martin & Moyce (1952), volume within 1 %, no water in a wall.
#[test]
#[ignore = "slow: make validation"]
fn the_dam_keeps_its_bars() {
    let dam = run(&[], 1.0);
    report(&dam);
    assert!(
        dam.arrivals.iter().all(|&ratio| (ratio - 1.0).abs() < 0.1),
        "{:?}",
        dam.arrivals
    );
    assert!(dam.volume < 0.01, "{}", dam.volume);
    assert!(dam.wall > 0.0, "water in a wall: {}", dam.wall);
    assert!(dam.simulation.is_finished());
}

/// The less viscosity the earlier the front. It leads by up to 13 % at first and by as long all the
/// way: a wall that vanishes at once is not Martin & Moyce's. 15 % leave room for other spacings.
#[test]
#[ignore = "slow: make validation"]
fn the_front_by_viscosity() {
    for spacing in ["0.73", "0.365"] {
        let mut before = 0.0;
        for alpha in ["0.05", "0.2", "1"] {
            let spacing = format!("spacing=\"{spacing} cm\"");
            let alpha = format!("sph.alpha={alpha}");
            let dam = run(&[&spacing, &alpha], 0.3);
            print!("{spacing}, {alpha}: ");
            report(&dam);
            let first = dam.arrivals[0];
            assert!((first - 1.0).abs() < 0.15 && first > before, "{first}");
            before = first;
            assert!(dam.volume < 0.01 && dam.wall > 0.0, "water is lost");
        }
    }
}
