//! `whipple check`: is a case sound, and what will it cost?

use std::path::PathBuf;

use super::EXIT_INPUT;
use crate::contact::ContactTable;
use crate::input;
use crate::model::Case;
use crate::output::snapshot;
use crate::populate;

/// Check a case without running it: particles by body, memory, expected steps
///
/// Exits with 0 if the case can run and with 2 if anything is wrong; things that are allowed but
/// look like mistakes are warnings.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple check inputs/quarter-impact
  whipple check inputs/quarter-impact/case.toml --set spacing=0.01mm")]
pub struct CheckArgs {
    /// Case file (TOML), or a folder with a case.toml
    #[arg(value_name = "CASE")]
    case: PathBuf,

    /// Change a value of the case, as in spacing=0.015mm; may be given many times
    #[arg(short, long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Bytes that a particle takes with its lists and buffers on one rank at the peak, as `whipple
/// bench` measures them on a block of a million particles; halo particles come on top.
const BYTES_PER_PARTICLE: f64 = 590.0;
/// What contact between bodies and images behind symmetry planes add, as measured on the quarter
/// impact of 400,000.
const BYTES_FOR_CONTACT: f64 = 170.0;

/// Runs the command; returns the exit code.
pub fn run(args: &CheckArgs) -> u8 {
    let case = match input::load(&args.case, &args.set) {
        Ok(case) => case,
        Err(error) => {
            eprintln!("{}", error.to_string().trim_end());
            return EXIT_INPUT;
        }
    };
    if let Err(error) = snapshot::quantities(&case.output.fields) {
        eprintln!("error: {error}");
        return EXIT_INPUT;
    }
    let warnings = input::warnings(&case);
    for warning in warnings.into_iter().chain(input::advice(&case)) {
        eprintln!("warning: {warning}");
    }
    print_report(&case);
    0
}

#[allow(clippy::cast_precision_loss, reason = "for people")]
fn print_report(case: &Case) {
    println!("{} ({}-D): sound", case.title, case.dimension);
    let mut total = 0;
    for body in &case.bodies {
        let count = populate::count(body, case.dimension, &case.symmetry, None);
        total += count;
        println!(
            "  {:<16} {count:>10} particles of {}, spacing {:.4} mm, h {:.4} mm",
            body.name,
            case.materials[body.material].name,
            body.lattice.spacing * 1e3,
            body.smoothing_length * 1e3,
        );
    }
    let contact = if ContactTable::new(case).is_active() {
        BYTES_FOR_CONTACT
    } else {
        0.0
    };
    let memory = total as f64 * (BYTES_PER_PARTICLE + contact) / 1e6;
    println!(
        "  {:<16} {total:>10} particles, about {memory:.0} MB over all ranks",
        "all"
    );
    if let Some(steps) = expected_steps(case) {
        println!(
            "  about {steps:.0} steps to {:.4} us",
            case.run.end_time * 1e6
        );
    }
}

/// Steps that the sound criterion asks for, with the sound speed of the undeformed materials and
/// the approach speed of the impact; shocks take more, rarefaction less.
fn expected_steps(case: &Case) -> Option<f64> {
    let speed = case.impact_speed();
    let dt = case
        .bodies
        .iter()
        .filter(|body| body.rigid.is_none())
        .map(|body| {
            let material = &case.materials[body.material];
            let c = (material.p_wave_modulus() / material.reference_density).sqrt();
            let signal = c + 0.6 * (case.sph.alpha * c + case.sph.beta * 0.25 * speed);
            case.time_step.courant * body.smoothing_length / signal
        })
        .fold(case.time_step.max, f64::min);
    (dt.is_finite() && dt > 0.0 && case.run.end_time.is_finite()).then(|| case.run.end_time / dt)
}
