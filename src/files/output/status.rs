//! `status.json`: the state of a run, for scripts that chain runs and for watching one.

use std::io;

use serde::{Deserialize, Serialize};
use serde_json::ser::{Formatter, PrettyFormatter, Serializer};
use uuid::Uuid;

/// Phase of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// It runs, or was killed while it did.
    Running,
    /// It reached its end.
    Finished,
    /// It was asked to stop and wrote a checkpoint.
    Stopped,
    /// It ended by an error.
    Failed,
}

impl Phase {
    /// Its name in `status.json`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Finished => "finished",
            Self::Stopped => "stopped",
            Self::Failed => "failed",
        }
    }
}

/// `status.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Status {
    /// Phase of the run.
    pub state: Phase,
    /// Last step.
    pub step: u64,
    /// Time reached (s).
    pub time: f64,
    /// Reason of a stop or failure.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub reason: Option<String>,
    /// Exit code of the program, once it is over.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub exit_code: Option<u8>,
    /// Progress, as rank 0 sees it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub outlook: Option<Outlook>,
    /// Id of the run.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub run: Option<Uuid>,
}

impl Status {
    /// A status without the optional entries.
    #[must_use]
    pub fn new(state: Phase, step: u64, time: f64) -> Self {
        Self {
            state,
            step,
            time,
            reason: None,
            exit_code: None,
            outlook: None,
            run: None,
        }
    }

    /// The content of the file: a line for each entry, lists in one.
    pub(super) fn text(&self) -> Vec<u8> {
        let mut text = Vec::new();
        let mut serializer = Serializer::with_formatter(&mut text, Lines::default());
        // It is made of numbers and words, and memory takes all that is written.
        let _ = self.serialize(&mut serializer);
        text.push(b'\n');
        text
    }
}

/// Progress of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Outlook {
    /// Time of writing (seconds since 1970, UTC).
    pub written: u64,
    /// Seconds that this process has run.
    pub wall_seconds: f64,
    /// Seconds left, once the first steps have been timed.
    pub seconds_left: Option<f64>,
    /// Seconds that a step takes, the mean of this process.
    pub seconds_per_step: f64,
    /// The case's end (s).
    pub end_time: f64,
    /// The last step that the case allows, if it does.
    pub max_steps: Option<u64>,
    /// Last time step (s).
    pub dt: f64,
    /// The limit that set it.
    pub dt_reason: String,
    /// Number of ranks.
    pub ranks: usize,
    /// Threads of each.
    pub threads: usize,
    /// Particles of all ranks.
    pub particles: u64,
    /// Work of ranks over the mean, as of the last row; of groups of ranks if there are many.
    pub loads: Vec<f64>,
    /// Work of the busiest rank over the mean.
    pub largest_load: f64,
    /// Unit of energies.
    pub energy_unit: String,
    /// Energies so far, of the whole model.
    pub energies: Energies,
    /// Share of it that is computed; of what a program told that did not know it all.
    #[serde(default = "all")]
    pub computed_share: f64,
}

fn all() -> f64 {
    1.0
}

/// Energies (SI) at some times (s), the first and the last of the run so far among them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// Times (s).
    pub time: Vec<f64>,
    /// Kinetic energy.
    pub kinetic: Vec<f64>,
    /// Internal energy.
    pub internal: Vec<f64>,
    /// Energy of contact.
    pub contact: Vec<f64>,
    /// Total energy, that of gravity included.
    pub total: Vec<f64>,
}

impl Energies {
    /// The lists, that of times first.
    fn lists(&mut self) -> [&mut Vec<f64>; 5] {
        [
            &mut self.time,
            &mut self.kinetic,
            &mut self.internal,
            &mut self.contact,
            &mut self.total,
        ]
    }

    /// Adds a time and its energies.
    pub fn push(&mut self, values: [f64; 5]) {
        for (list, value) in self.lists().into_iter().zip(values) {
            list.push(value);
        }
    }

    /// Drops the entries, by number, that `keeps` refuses.
    pub fn retain(&mut self, keeps: impl Fn(usize) -> bool) {
        for list in self.lists() {
            let mut n = 0..;
            list.retain(|_| n.next().is_some_and(&keeps));
        }
    }

    /// Returns true if there is one of each energy for each time.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let others = [&self.kinetic, &self.internal, &self.contact, &self.total];
        others.iter().all(|list| list.len() == self.time.len())
    }
}

/// JSON with a line for each entry of an object, and each list in one line.
#[derive(Default)]
struct Lines(PrettyFormatter<'static>);

impl Formatter for Lines {
    fn begin_object<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.0.begin_object(out)
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.0.end_object(out)
    }

    fn begin_object_key<W: ?Sized + io::Write>(
        &mut self,
        out: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.0.begin_object_key(out, first)
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.0.begin_object_value(out)
    }

    fn end_object_value<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.0.end_object_value(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_status_has_a_line_for_each_entry_and_comes_back() {
        let mut status = Status::new(Phase::Running, 7, 1e-8);
        assert_eq!(
            String::from_utf8(status.text()).unwrap(),
            "{\n  \"state\": \"running\",\n  \"step\": 7,\n  \"time\": 1e-8\n}\n"
        );
        let mut outlook = Outlook::default();
        for n in 0..6_u32 {
            outlook.energies.push([f64::from(n); 5]);
        }
        outlook.energies.retain(|n| n % 2 == 0);
        assert_eq!(outlook.energies.total, [0.0, 2.0, 4.0]);
        assert!(outlook.energies.is_whole());
        status.outlook = Some(outlook);
        let text = String::from_utf8(status.text()).unwrap();
        assert!(
            text.contains("      \"kinetic\": [0.0,2.0,4.0],\n"),
            "{text}"
        );
        assert_eq!(serde_json::from_str::<Status>(&text).unwrap(), status);
    }

    /// Written by programs that had fewer entries.
    #[test]
    fn an_older_status_is_read() {
        let text = r#"{"state": "stopped", "step": 3, "time": 0.5, "reason": "why"}"#;
        let status: Status = serde_json::from_str(text).unwrap();
        assert_eq!((status.state, status.outlook), (Phase::Stopped, None));
    }
}
