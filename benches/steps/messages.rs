//! Times of messages between ranks and of collective calls.

use std::path::Path;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::machine::host;
use super::report::median;
use comm::{Comm, Exchange, Joint};
use files::output::{on_root, write_json};
use files::run::say::say;

/// Bytes of a message to measure the latency, and of one to measure the bandwidth.
const SHORT: usize = 64;
const LONG: usize = 1 << 22;
/// Messages that are timed together, and repetitions; the median counts.
const SHORT_ROUNDS: u32 = 200;
const LONG_ROUNDS: u32 = 5;
const REPEAT: usize = 21;
/// About the sums and minima of a step with contact.
const SUMS: usize = 1024;
const LEAST: usize = 16;

/// Times of communication, where pairs 0 and 1, 2 and 3, … exchange messages at the same time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Messages {
    /// True if the two of a pair are on different nodes.
    pub between_nodes: bool,
    /// Time of a message (s).
    pub latency: f64,
    /// Bytes that a node sends in a second.
    pub bandwidth: f64,
    /// Time of the two collective calls of a step for each doubling of the number of ranks (s).
    pub agreement_time: f64,
}

/// Measures messages; prints the result, and writes it to a file if there is one. Collective.
///
/// # Errors
/// If ranks are not pairs, or the file cannot be written.
pub(super) fn run(comm: &Comm, file: Option<&Path>) -> Result<(), String> {
    if comm.size() < 2 || comm.size() % 2 == 1 {
        return Err("messages go between pairs of ranks: start it by mpirun on 2, 4, …".to_owned());
    }
    let messages = measure(comm);
    on_root(comm, || {
        say(&messages.text());
        file.map_or(Ok(()), |file| write_json(file, &messages))
    })
    .map_err(|error| error.to_string())
}

impl Messages {
    /// Lines of a machine file.
    fn text(&self) -> String {
        let node = if self.between_nodes { "" } else { "node_" };
        format!(
            "{node}latency = {:.3e}\n{node}bandwidth = {:.3e}\nagreement_time = {:.3e}",
            self.latency, self.bandwidth, self.agreement_time
        )
    }
}

#[allow(clippy::cast_precision_loss, reason = "few ranks and bytes")]
fn measure(comm: &Comm) -> Messages {
    let other = comm.rank() ^ 1;
    let mut hosts = Vec::new();
    comm.all_gather_u64(&[host()], &mut hosts);
    let between_nodes = hosts[0] != hosts[1];
    hosts.sort_unstable();
    hosts.dedup();
    let mut exchange = Exchange::default();
    exchange.set_peers(std::iter::once(other));
    let mut swap = |bytes, rounds| {
        for _ in 0..rounds {
            exchange.outgoing(0).resize(bytes, 1);
            exchange.expect(0, bytes);
            exchange.post(comm);
            exchange.wait();
        }
    };
    let short = time_of(comm, SHORT_ROUNDS, &mut swap, SHORT);
    let long = time_of(comm, LONG_ROUNDS, &mut swap, LONG);
    let mut joint = Joint::default();
    let mut agree = |_, rounds| {
        for _ in 0..rounds {
            comm.max_u64(&mut [1; 3]);
            joint.sums.resize(SUMS, 1);
            joint.least.resize(LEAST, 1);
            comm.join(&mut joint);
        }
    };
    let both = time_of(comm, SHORT_ROUNDS, &mut agree, 0);
    let sent = comm.size() as f64 * LONG as f64;
    Messages {
        between_nodes,
        latency: short,
        bandwidth: sent / (long - short).max(1e-12) / hosts.len() as f64,
        agreement_time: both / (comm.size() as f64).log2(),
    }
}

/// The median time (s) of one of `rounds` rounds, the longest of all ranks. Collective.
fn time_of(comm: &Comm, rounds: u32, task: &mut dyn FnMut(usize, u32), bytes: usize) -> f64 {
    task(bytes, rounds);
    let times: Vec<f64> = (0..REPEAT)
        .map(|_| {
            comm.barrier();
            let begun = Instant::now();
            task(bytes, rounds);
            comm.max_f64(begun.elapsed().as_secs_f64() / f64::from(rounds))
        })
        .collect();
    median(&times)
}
