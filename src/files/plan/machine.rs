//! The constants of a machine, and their file.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::sharing::Sharing;

/// Speeds of a machine, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Machine {
    /// Its name.
    pub name: String,
    /// Cores of a node.
    pub cores_per_node: f64,
    /// Time of one core for a step of a particle (s).
    pub particle_time: f64,
    /// Time of one core for a step of an image or of another rank's particle (s).
    pub image_time: f64,
    /// Fraction of the time of a step that each further thread of a rank adds to all.
    pub thread_loss: f64,
    /// Fraction by which a core is slower while all cores of its node are busy.
    pub crowding: f64,
    /// Time of a message between two nodes (s).
    pub latency: f64,
    /// Bytes that a node sends in a second.
    pub bandwidth: f64,
    /// Time of a message within a node (s).
    pub node_latency: f64,
    /// Bytes that ranks of one node send each other in a second.
    pub node_bandwidth: f64,
    /// Time that each doubling of the number of ranks adds to a step (s), by collective calls.
    pub agreement_time: f64,
    /// Fraction of the computing time in which messages are transferred: stresses travel while forces are summed that need none
    /// of others.
    pub overlap: f64,
    /// Bytes that all ranks together write in a second.
    pub disk_bandwidth: f64,
    /// Bytes of memory that the ranks of a node may take together; infinite if unknown.
    pub memory_per_node: f64,
    /// The longest time (s) that a batch job may ask for.
    pub longest_job: f64,
}

/// A number of a machine: its key, description, accessor and range.
pub struct Constant {
    /// Its key in the file.
    pub key: &'static str,
    /// Its unit and description.
    pub what: &'static str,
    get: fn(&mut Machine) -> &mut f64,
    range: [f64; 2],
}

/// Times (s) and rates (1/s) of any machine.
const TIMES: [f64; 2] = [1e-12, 1.0];
const RATES: [f64; 2] = [1e3, 1e18];

/// All numbers of a machine.
pub const CONSTANTS: [Constant; 14] = [
    Constant {
        key: "cores_per_node",
        what: "cores of a node",
        get: |machine| &mut machine.cores_per_node,
        range: [1.0, 1e6],
    },
    Constant {
        key: "particle_time",
        what: "s, one core, a step of a particle",
        get: |machine| &mut machine.particle_time,
        range: TIMES,
    },
    Constant {
        key: "image_time",
        what: "s, one core, a step of an image or of another rank's particle",
        get: |machine| &mut machine.image_time,
        range: [0.0, 1.0],
    },
    Constant {
        key: "thread_loss",
        what: "part of the time that each further thread of a rank adds",
        get: |machine| &mut machine.thread_loss,
        range: [0.0, 10.0],
    },
    Constant {
        key: "crowding",
        what: "part by which a core is slower while all of its node work",
        get: |machine| &mut machine.crowding,
        range: [0.0, 100.0],
    },
    Constant {
        key: "latency",
        what: "s, a message between two nodes",
        get: |machine| &mut machine.latency,
        range: [0.0, 1.0],
    },
    Constant {
        key: "bandwidth",
        what: "bytes/s, all that a node sends",
        get: |machine| &mut machine.bandwidth,
        range: RATES,
    },
    Constant {
        key: "node_latency",
        what: "s, a message within a node",
        get: |machine| &mut machine.node_latency,
        range: [0.0, 1.0],
    },
    Constant {
        key: "node_bandwidth",
        what: "bytes/s, all messages within a node",
        get: |machine| &mut machine.node_bandwidth,
        range: RATES,
    },
    Constant {
        key: "agreement_time",
        what: "s, for each doubling of the number of ranks",
        get: |machine| &mut machine.agreement_time,
        range: [0.0, 1.0],
    },
    Constant {
        key: "overlap",
        what: "part of the computing time in which messages fly",
        get: |machine| &mut machine.overlap,
        range: [0.0, 1.0],
    },
    Constant {
        key: "disk_bandwidth",
        what: "bytes/s, what all ranks together write",
        get: |machine| &mut machine.disk_bandwidth,
        range: RATES,
    },
    Constant {
        key: "memory_per_node",
        what: "bytes, what the ranks of a node may take; inf: not told",
        get: |machine| &mut machine.memory_per_node,
        range: [1e6, f64::INFINITY],
    },
    Constant {
        key: "longest_job",
        what: "s, the longest time that a batch job may ask for",
        get: |machine| &mut machine.longest_job,
        range: [600.0, 1e8],
    },
];

impl Default for Machine {
    /// An ordinary cluster: times of a core from the page on performance, nodes of 128 cores with a network
    /// of 200 Gbit/s.
    fn default() -> Self {
        Self {
            name: "an ordinary cluster".to_owned(),
            cores_per_node: 128.0,
            particle_time: 1e-6,
            image_time: 0.08e-6,
            thread_loss: 0.02,
            crowding: 0.05,
            latency: 2e-6,
            bandwidth: 25e9,
            node_latency: 0.5e-6,
            node_bandwidth: 50e9,
            agreement_time: 10e-6,
            overlap: 0.0,
            disk_bandwidth: 2e9,
            memory_per_node: f64::INFINITY,
            longest_job: 86_400.0,
        }
    }
}

impl Machine {
    /// A machine on which steps take `times` the work for the same particles.
    #[must_use]
    pub fn at_work(self, times: f64) -> Self {
        Self {
            particle_time: times * self.particle_time,
            image_time: times * self.image_time,
            ..self
        }
    }

    /// A machine for steps in which a share of the particles moves: what rests is neither summed nor sent.
    #[must_use]
    pub fn at_rest(self, share: f64) -> Self {
        Self {
            bandwidth: self.bandwidth / share,
            node_bandwidth: self.node_bandwidth / share,
            ..self.at_work(share)
        }
    }

    /// Parses a file; numbers that it leaves out are those of an ordinary cluster.
    ///
    /// # Errors
    /// A message if the text is wrong.
    pub fn parse(text: &str) -> Result<Self, String> {
        let machine: Self = toml::from_str(text).map_err(|error| error.to_string())?;
        let mut numbers = machine.clone();
        for constant in &CONSTANTS {
            let (value, [least, most]) = (*constant.of(&mut numbers), constant.range);
            // NaN is in no range.
            if !(least..=most).contains(&value) {
                let key = constant.key;
                return Err(format!("{key} is {value}; it may be {least:e} to {most:e}"));
            }
        }
        Ok(machine)
    }

    /// The text of its file.
    #[must_use]
    pub fn text(&self) -> String {
        let name = toml::Value::from(self.name.as_str());
        let mut text = format!("name = {name}\n");
        let mut numbers = self.clone();
        for constant in &CONSTANTS {
            let (key, value) = (constant.key, *constant.of(&mut numbers));
            let _ = writeln!(text, "{key} = {value:?}  # {}", constant.what);
        }
        text
    }

    /// The machine with one constant twice as large.
    #[must_use]
    pub fn doubled(&self, constant: &Constant) -> Self {
        let mut machine = self.clone();
        *constant.of(&mut machine) *= 2.0;
        machine
    }

    /// Number of ranks of `threads` threads on a node.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a million at most"
    )]
    pub fn ranks_per_node(&self, threads: usize) -> usize {
        (self.cores_per_node as usize / threads).max(1)
    }

    /// The ways to share all cores of a node among ranks of equally many threads, one thread first.
    #[must_use]
    pub fn sharings(&self) -> Vec<Sharing> {
        let cores = self.ranks_per_node(1);
        let threads = (1..=cores).filter(|threads| cores.is_multiple_of(*threads));
        let sharing = |threads| Sharing {
            threads,
            ranks_per_node: cores / threads,
        };
        threads.map(sharing).collect()
    }
}

impl Constant {
    /// Its value in a machine.
    pub fn of<'a>(&self, machine: &'a mut Machine) -> &'a mut f64 {
        (self.get)(machine)
    }
}
