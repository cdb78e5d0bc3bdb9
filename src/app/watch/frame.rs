//! A run in a few lines of text.

use std::time::Duration;

use indicatif::HumanDuration;

use super::Seen;
use files::output::{Energies, Outlook};
use files::run::say::{counted, seconds};
use model::readable::{one_line, shown};

/// Heights of a column of text.
const HEIGHTS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
/// Columns of names.
const NAMES: usize = 10;
/// Columns that numbers behind a curve take.
const NUMBERS: usize = 28;
/// Columns of a curve at most.
const CURVE: usize = 48;

/// The lines, none wider than `width` columns.
pub fn frame(seen: &Seen, width: usize) -> Vec<String> {
    let mut lines = vec![seen.state.clone()];
    let status = &seen.status;
    match &status.outlook {
        Some(outlook) => {
            lines.extend(progress(seen, outlook, width));
            lines.extend(energies(outlook, width));
            lines.push(ranks(outlook, width));
        }
        None => lines.push(format!("step {}, {}", status.step, seconds(status.time))),
    }
    if seen.code.is_none() {
        lines.push(match seen.age {
            Some(age) => format!("as of {} ago", duration(age)),
            None => "nothing tells how old this is".to_owned(),
        });
    }
    let cut = |line: String| console::truncate_str(&line, width - 1, "…").into_owned();
    lines.into_iter().map(cut).collect()
}

fn duration(seconds: f64) -> String {
    Duration::try_from_secs_f64(seconds).map_or_else(
        |_| "ages".to_owned(),
        |time| HumanDuration(time).to_string(),
    )
}

#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "for people, and clamped"
)]
fn progress(seen: &Seen, outlook: &Outlook, width: usize) -> [String; 3] {
    let status = &seen.status;
    let steps = outlook.max_steps.unwrap_or(u64::MAX) as f64;
    let done = (status.time / outlook.end_time).max(status.step as f64 / steps);
    let done = done.clamp(0.0, 1.0);
    let columns = CURVE.min(width.saturating_sub(NAMES + NUMBERS));
    let full = (done * columns as f64) as usize;
    let bar = format!("{}{}", "█".repeat(full), "░".repeat(columns - full));
    let most = outlook
        .max_steps
        .map_or_else(String::new, |most| format!(" of {most}"));
    let (at, end) = (seconds(status.time), seconds(outlook.end_time));
    let left = outlook.seconds_left.filter(|_| seen.code.is_none());
    let left = left.map_or_else(String::new, |left| {
        format!(", about {} left", duration(left))
    });
    [
        format!(
            "{:<NAMES$}{bar} {:.0} %, {at} of {end}",
            "done",
            100.0 * done
        ),
        format!(
            "{:<NAMES$}{}{left}",
            "clock",
            duration(outlook.wall_seconds)
        ),
        format!(
            "{:<NAMES$}{}{most}, Δt {} ({}), {} each",
            "step",
            status.step,
            seconds(outlook.dt),
            one_line(&outlook.dt_reason),
            seconds(outlook.seconds_per_step)
        ),
    ]
}

/// Curves of all energies, on one scale.
fn energies(outlook: &Outlook, width: usize) -> Vec<String> {
    let energies = &outlook.energies;
    if energies.time.is_empty() || !energies.is_whole() {
        return Vec::new();
    }
    let Energies {
        kinetic,
        internal,
        contact,
        total,
        ..
    } = energies;
    let all = || [kinetic, internal, contact, total].into_iter().flatten();
    let most = all().fold(0.0, |a: f64, b| a.max(*b));
    let least = all().fold(0.0, |a: f64, b| a.min(*b));
    let columns = CURVE.min(width.saturating_sub(NAMES + NUMBERS));
    let line = |name: &str, values: &[f64]| {
        let (first, last) = (values[0], values[values.len() - 1]);
        let curve: String = (over_time(&energies.time, values, columns))
            .map(|value| height((value - least) / (most - least)))
            .collect();
        let scale = most.max(-least);
        let change = 100.0 * (last - first) / scale;
        let change = if name == "total" && change.is_finite() {
            format!(" ({change:+.3} %)")
        } else {
            String::new()
        };
        let unit = one_line(&outlook.energy_unit);
        format!("{name:<NAMES$}{curve} {}{change}", shown(last, &unit))
    };
    vec![
        line("kinetic", kinetic),
        line("internal", internal),
        line("contact", contact),
        line("total", total),
    ]
}

/// Values at so many times from the first to the last, each that of the latest time before.
#[allow(clippy::cast_precision_loss, reason = "few")]
fn over_time<'a>(
    times: &'a [f64],
    values: &'a [f64],
    columns: usize,
) -> impl Iterator<Item = f64> + 'a {
    let (first, last) = (times[0], times[times.len() - 1]);
    (0..columns).map(move |column| {
        let part = (column + 1) as f64 / columns as f64;
        let time = first + part * (last - first);
        // The last column is that of the last time, to more than rounding.
        let after = times.partition_point(|&t| t <= time);
        let at = if column + 1 == columns {
            times.len()
        } else {
            after
        };
        values[at.max(1) - 1]
    })
}

/// A column that is so high, from 0 to 1.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped"
)]
fn height(part: f64) -> char {
    let part = if part.is_finite() { part } else { 0.0 };
    HEIGHTS[(part.clamp(0.0, 1.0) * 7.0).round() as usize]
}

/// The work of ranks, or of groups of them.
fn ranks(outlook: &Outlook, width: usize) -> String {
    let most = outlook.loads.iter().copied().fold(0.0, f64::max);
    let room = width.saturating_sub(NAMES + 2);
    let bars = outlook.loads.iter().take(room.min(64));
    let bars: String = bars.map(|load| height(load / most)).collect();
    let (ranks, threads) = (
        counted(outlook.ranks as u64, "rank"),
        counted(outlook.threads as u64, "thread"),
    );
    let busiest = if outlook.ranks > 1 {
        format!(", busiest {:.2} of the mean", outlook.largest_load)
    } else {
        String::new()
    };
    format!(
        "{:<NAMES$}{bars} {} on {ranks} x {threads}{busiest}",
        "work",
        counted(outlook.particles, "particle"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use files::output::{Phase, Status};

    fn seen(energies: Energies) -> Seen {
        let outlook = Outlook {
            computed_share: 1.0,
            wall_seconds: 65.0,
            seconds_left: Some(30.0),
            seconds_per_step: 0.012,
            end_time: 2e-7,
            dt: 1e-9,
            dt_reason: "sound".to_owned(),
            ranks: 3,
            threads: 1,
            particles: 3000,
            loads: vec![1.0, 0.5, 1.0],
            largest_load: 1.2,
            energy_unit: "J".to_owned(),
            energies,
            ..Outlook::default()
        };
        Seen {
            status: Status {
                outlook: Some(outlook),
                ..Status::new(Phase::Running, 100, 1e-7)
            },
            state: "runs/a: running".to_owned(),
            age: Some(1.0),
            code: None,
        }
    }

    #[test]
    fn a_frame_has_its_lines_within_the_terminal() {
        let mut energies = Energies::default();
        for n in 0..=7_u8 {
            let part = f64::from(n) / 7.0;
            energies.push([part, 1.0 - part, part, 0.0, 1.0]);
        }
        let lines = frame(&seen(energies), 46);
        assert_eq!(
            lines,
            [
                "runs/a: running",
                "done      ████░░░░ 50 %, 0.1 us of 0.2 us",
                "clock     65 seconds, about 30 seconds left",
                "step      100, Δt 1 ns (sound), 12 ms each",
                "kinetic   █▇▆▅▄▃▂▁ 0 J",
                "internal  ▁▂▃▄▅▆▇█ 1 J",
                "contact   ▁▁▁▁▁▁▁▁ 0 J",
                "total     ████████ 1 J (+0.000 %)",
                "work      █▅█ 3000 particles on 3 ranks x 1 …",
                "as of 1 second ago",
            ]
        );
        // Of a run that is over nothing is left.
        let over = Seen {
            code: Some(1),
            ..seen(Energies::default())
        };
        assert_eq!(frame(&over, 46)[2], "clock     65 seconds");
        for width in [20, 80, 300] {
            let lines = frame(&seen(Energies::default()), width);
            assert_eq!(lines.len(), 6);
            for line in lines {
                assert!(console::measure_text_width(&line) < width, "{line}");
            }
        }
    }

    /// A status that somebody has made up.
    #[test]
    fn odd_numbers_are_borne() {
        let mut energies = Energies::default();
        energies.push([1e300, -1e308, 1e308, 0.0, 0.0]);
        energies.push([-1.0; 5]);
        let mut odd = seen(energies);
        let outlook = odd.status.outlook.as_mut().unwrap();
        outlook.end_time = 0.0;
        outlook.seconds_left = Some(1e300);
        outlook.loads = vec![-1.0; 1000];
        outlook.dt_reason = "\u{1b}[2J".to_owned();
        let text = frame(&odd, 80).concat();
        assert!(!text.contains('\u{1b}') && text.contains("ages"), "{text}");
    }
}
