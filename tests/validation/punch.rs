//! Punch and die (`inputs/punch`): an elastic block in uniaxial strain, pressed by rigid surfaces.

use crate::physics_support::{ready, run_with, start};
use engine::step::LoadState;

/// The die carries what the punch presses with, and both do the work that the block has got. The
/// law of the block in uniaxial strain gives the force `A M ln(H/h)` and the work that is its
/// integral; conventional sums make the layers at a free face too soft, which adds the give of some
/// spacings to that of the block: `F = A M ln(H/h) / (1 + c Δp/H)`. Without it, that is
/// extrapolated from two spacings, the force is the exact one.
#[test]
#[ignore = "slow: make validation"]
fn the_reaction_of_the_die() {
    let (area, height, moved) = (1e-4, 10e-3, 0.12e-3);
    let strain = f64::ln(height / (height - moved));
    let give = ["1 mm", "0.5 mm"].map(|spacing| {
        let mut s = start(ready("punch", &[&format!("spacing=\"{spacing}\"")]));
        let exact = area * s.case.materials[0].p_wave_modulus() * strain;
        let laid = |load: &LoadState| load.force.iter().all(|f| f.abs() < 1e-9 * exact);
        assert!(s.state.loads.iter().all(laid));
        let (mut force, mut count) = ([[0.0; 3]; 2], 0.0);
        run_with(&mut s, 1.0, |s| {
            if s.state.time > 85e-6 {
                count += 1.0;
                for (sum, load) in force.iter_mut().zip(&s.state.loads) {
                    for a in 0..3 {
                        sum[a] += load.force[a];
                    }
                }
            }
        });
        let [die, punch] = force.map(|f| f.map(|c| c / (count * exact)));
        let (worst, state) = (&s.state.worst, &s.state);
        let work = state.load_work();
        // ∫ F dh of a force that grows as the exact one does.
        let drawn = die[2] * exact * (moved / strain - (height - moved));
        println!(
            "spacing {spacing}: die {:.5}, punch {:.5} of {exact:.0} N, work {:.5}, {worst:?}",
            die[2],
            punch[2],
            work / drawn
        );
        assert!((die[2] / punch[2] + 1.0).abs() < 1e-3);
        assert!(die[0].hypot(die[1]) < 1e-9);
        assert!((work / drawn - 1.0).abs() < 0.01);
        let impulse = state.loads[0].impulse[2];
        let off = worst.momentum_deviation;
        assert!(off.iter().all(|d| d.abs() < 1e-13 * impulse), "{off:?}");
        assert!(worst.energy_error < 1e-4, "{:e}", worst.energy_error);
        1.0 / die[2]
    });
    let exact = 2.0 * give[1] - give[0];
    println!("force without the give of the faces: {:.5}", 1.0 / exact);
    assert!((exact - 1.0).abs() < 0.02, "{exact}");
}
