//! `whipple limit`: ballistic limit equations as tables and charts.

mod arguments;
mod chart;
mod laws;
mod table;

use std::path::PathBuf;

use super::output_format::OutputFormat;
use super::plot::out::{PictureFormat, check_picture, save_text, write_chart};
use desk::sweep::{self, Shot, SweepError, Values};
use files::run::exit::{EXIT_FAILED, EXIT_INPUT};
use files::run::say::{say, warn};
use laws::Law;
use model::readable::one_line;
use plot::{PlotError, Quantity};

/// Print and plot ballistic limit equations, craters and hole diameters
///
/// The equations are fits to experiments: a designer's curve to lay beside runs. With --sweep the
/// runs of a sweep stand in the chart and the table beside the equation, failed and not.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple limit nno --bumper 1.2mm --wall 3.2mm --gap 100mm --yield 40ksi \\
      --plot nno.png
  whipple limit nno --bumper 1.27mm --wall 3.175mm --gap 50.8mm --yield 47ksi \\
      --sweep sweeps/whipple-shield
  whipple limit thin-bumper --bumper 0.3mm --wall 3.2mm --gap 100mm \\
      --yield 40ksi --speeds \"3..12/10 km/s\"
  whipple limit stuffed --bumper 2mm --wall 4.8mm --gap 114mm \\
      --yield 52ksi --stuffing \"8 kg/m^2\"
  whipple limit sizing --diameter 1cm --gap 30cm --yield 40ksi
  whipple limit crater --wall 20mm --brinell 95 --sound-speed 5.1km/s
  whipple limit crater --diameter 1cm --brinell 95 --sound-speed 5.1km/s
  whipple limit hole --diameter 10mm --bumper 4mm --sound-speed 5.33km/s")]
pub struct LimitArgs {
    #[command(subcommand)]
    equation: arguments::Equation,
}

/// Speeds, and where the answer goes.
#[derive(Debug, Clone, clap::Args)]
struct Output {
    /// Speeds of the table, as in "3, 5, 7 km/s" or "1..15/29 km/s"; the chart goes from the
    /// least to the greatest
    #[arg(long, value_name = "VALUES", default_value = "1..15/29 km/s")]
    speeds: String,

    #[command(flatten)]
    format: OutputFormat,

    /// Draw a chart into this SVG or PNG file
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,

    /// Write the table, in SI units
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,

    /// Width of the chart in pixels
    #[arg(long, value_name = "PIXELS")]
    width: Option<u32>,
}

/// A sweep whose runs stand beside a limit.
#[derive(Debug, Clone, clap::Args)]
struct Beside {
    /// Folder of a sweep (see `whipple sweep`) whose finished runs stand beside the equation
    /// [without --plot the chart is SWEEP/limit.png, or .svg]
    #[arg(long, value_name = "SWEEP")]
    sweep: Option<PathBuf>,

    #[command(flatten)]
    picture: PictureFormat,

    /// What counts as failed of a run, as in "failed wall" [default: what the sweep bisects, else
    /// whether a plate has failed]
    #[arg(long, value_name = "CONDITION", requires = "sweep")]
    failed: Option<String>,

    /// Body that is the projectile [default: the only ball that flies]
    #[arg(long, value_name = "BODY", requires = "sweep")]
    projectile: Option<String>,
}

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
enum LimitError {
    #[error("error: {0}")]
    Typed(String),
    #[error("{0}")]
    Sweep(#[from] SweepError),
    #[error("error: {0}")]
    Plot(#[from] PlotError),
}

/// Runs the command; returns the exit code.
#[must_use]
pub fn run(args: &LimitArgs) -> u8 {
    let Err(error) = limit(args) else {
        return 0;
    };
    warn(&error.to_string());
    match error {
        LimitError::Plot(PlotError::Save { .. }) | LimitError::Sweep(SweepError::Output(_)) => {
            EXIT_FAILED
        }
        _ => EXIT_INPUT,
    }
}

fn limit(args: &LimitArgs) -> Result<(), LimitError> {
    let (law, output, beside) = args.equation.law().map_err(LimitError::Typed)?;
    if let Some(path) = &output.plot {
        check_picture(path)?;
    }
    let speeds = speeds(&output.speeds).map_err(LimitError::Typed)?;
    let shots = match beside.and_then(|beside| Some((beside, beside.sweep.as_ref()?))) {
        None => Vec::new(),
        Some((beside, folder)) => {
            let (projectile, failed) = (beside.projectile.as_deref(), beside.failed.as_deref());
            let shots = sweep::shots(folder, projectile, failed)?;
            if shots.is_empty() {
                let folder = folder.display();
                return Err(LimitError::Typed(format!("{folder} has no finished run")));
            }
            shots
        }
    };
    output.format.begin();
    say(&law.title);
    say(table::text(&law, &speeds).trim_end_matches('\n'));
    say("");
    say(&format!("Source: {}.", law.source));
    say(&format!("Holds for {}.", law.holds));
    if !shots.is_empty() {
        say("");
        say(one_by_line(&table::shots(&law, &shots)).trim_end());
    }
    if let Some(path) = &output.csv {
        let sheet = table::sheet(&law, &speeds);
        save_text(path, &sheet.text())?;
    }
    let own = beside.and_then(|beside| {
        let name = format!("limit.{}", beside.picture.ending());
        Some(beside.sweep.as_ref()?.join(name))
    });
    if let Some(path) = output.plot.clone().or(own) {
        draw(&law, &speeds, &shots, &path, output.width)?;
    }
    output
        .format
        .print(|| table::document(&law, &speeds, &shots));
    Ok(())
}

/// Lines that do no more to a terminal than to show themselves.
fn one_by_line(text: &str) -> String {
    let lines = text.lines().map(|line| format!("{}\n", one_line(line)));
    lines.collect()
}

fn draw(
    law: &Law,
    speeds: &[f64],
    shots: &[Shot],
    path: &std::path::Path,
    width: Option<u32>,
) -> Result<(), LimitError> {
    let quantity = |label: &str, unit: &str, from_zero: bool| Quantity {
        label: label.to_owned(),
        unit: unit.to_owned(),
        from_zero,
        room: true,
        ..Quantity::default()
    };
    let axes = [
        quantity("speed", "m/s", false),
        quantity(law.what, "m", true),
    ];
    let chart = chart::chart(law, speeds, shots, axes);
    Ok(write_chart(&chart, width, path)?)
}

/// The speeds of the table (m/s).
fn speeds(text: &str) -> Result<Vec<f64>, String> {
    let values = Values::parse(text)?.all();
    let speeds = values.iter().map(|value| {
        let speed = arguments::speed(&value.text)?;
        if speed > 0.0 {
            Ok(speed)
        } else {
            Err(format!("`{}` is no speed: it must be positive", value.text))
        }
    });
    speeds.collect()
}
