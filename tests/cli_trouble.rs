//! Numerical trouble: what is out of range stops a run with a post-mortem, or is removed and booked,
//! with the same bits on any ranks and through a restart.

mod cli_support;

use std::path::Path;
use std::process::Command;

use cli_support::{assert_same, coarse_run, end, json, ranks, status};

/// The shock compresses the metal by half: whatever is compressed by more than a quarter is out of
/// range here, beside the faces of slabs and symmetry planes too.
fn removing(number: usize, folder: &Path) -> Command {
    let mut command = coarse_run(number, folder);
    command.args(["--set", "trouble.density_max=1.25"]);
    command.args([
        "--set",
        "trouble.policy=remove",
        "--poison",
        "--threads",
        "1",
    ]);
    command
}

#[test]
fn a_particle_out_of_range_stops_a_run_with_a_post_mortem() {
    let place = tempfile::tempdir().unwrap();
    for (key, what) in [
        ("density_max=1.25", "has a density outside"),
        ("energy_max=\"1 kJ/kg\"", "has a specific energy beyond"),
        ("speed_max=\"7.1 km/s\"", "is faster than"),
        ("step_min=\"1 ns\"", "asks for a time step below"),
    ] {
        let run = place.path().join(&key[..6]);
        let set = format!("trouble.{key}");
        let mut command = coarse_run(2, &run);
        let ended = end(command.args(["--set", &set])).with_code(1);
        assert!(ended.stderr.contains(what), "{ended:#?}");
        if key.starts_with("step") {
            continue; // at the start, before there is a step to look back at
        }
        let (state, step, reason) = status(&run);
        assert_eq!(state, "failed");
        let stem = run.join(format!("trouble/step-{step:08}"));
        assert!(reason.contains(&stem.display().to_string()), "{reason}");
        let text = std::fs::read_to_string(stem.with_extension("txt")).unwrap();
        for part in [
            what,
            "on rank ",
            "velocity ",
            "Neighbours",
            "Contact partners",
            "last votes",
        ] {
            assert!(text.contains(part), "no {part} in {text}");
        }
        assert!(stem.with_extension("h5").metadata().unwrap().len() > 10_000);
    }
}

#[test]
fn removed_particles_are_booked_with_the_same_bits_on_any_ranks_and_through_a_restart() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    let one = at("1");
    end(&mut removing(1, &one)).with_code(0);
    for number in 2..=5 {
        let other = at(&number.to_string());
        end(&mut removing(number, &other)).with_code(0);
        assert_same(&one, &other);
    }
    let stopped = at("stopped");
    end(removing(3, &stopped).args(["--until", "0.03us"])).with_code(0);
    end(ranks(2).arg("restart").arg(&stopped).arg("--poison")).with_code(0);
    assert_same(&one, &stopped);

    let summary = json(&one.join("summary.json"));
    let figure = |name: &str| summary[name].as_f64().unwrap();
    let removed = figure("removed_particles");
    assert_eq!(removed + figure("particles"), 3056.0, "{summary:#}");
    assert!(removed > 30.0, "{removed} removed");
    // As without removal: see the figures of the validation page.
    assert!(figure("energy_error_max") < 1e-3, "{summary:#}");
    for axis in ["x", "y", "z"] {
        let error = summary["momentum_error"][axis].as_f64().unwrap();
        assert!(error < 1e-12, "momentum {axis}: {error}");
    }
    assert!(figure("contact_defect") < 1e-3, "{summary:#}");
    let table = std::fs::read_to_string(one.join("removed.csv")).unwrap();
    let last = table.lines().last().unwrap();
    assert!(last.contains(",sphere,"), "{last}");
    eprintln!(
        "{removed} removed, energy {:e}, contact {:e}, momentum {}",
        figure("energy_error_max"),
        figure("contact_defect"),
        summary["momentum_error"]
    );
}
