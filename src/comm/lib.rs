//! Messages between ranks: the only module that names MPI.
//!
//! MPI is initialised *funneled*: every call comes from the main thread. A [`Comm`] without it
//! ([`Comm::solo`]) is a single rank that never touches MPI, for tests and library use;
//! [`virtual_ranks`] are many such ranks in one process.

mod exchange;
mod joint;
mod relay;
mod virtual_ranks;
mod waiting;

pub use exchange::{Exchange, Peer, Traffic, pieces, read_pod};
pub use joint::Joint;
pub use relay::{PlainRecord, Receivers, Record, Relay};
pub use virtual_ranks::{Call, CallTraffic, Computing, Machine, VirtualTime, virtual_ranks};
pub use waiting::{progress, waited};

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;

use mpi::collective::SystemOperation;
use mpi::ffi;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{AsRaw, Communicator, CommunicatorCollectives, Group, Root};
use virtual_ranks::Rank;
use waiting::waiting;

/// The communicator handle that parallel HDF5 takes.
pub type RawComm = ffi::MPI_Comm;

/// MPI initialised for this process; finalised when dropped. Drop every [`Comm`] user first.
pub struct Session {
    _universe: mpi::environment::Universe,
}

impl Session {
    /// Initialises MPI; `None` if it was already initialised or lacks funneled threads.
    #[must_use]
    pub fn start() -> Option<(Self, Comm)> {
        spare_shared_pointers();
        let (universe, threading) = mpi::initialize_with_threading(mpi::Threading::Funneled)?;
        if threading < mpi::Threading::Funneled {
            return None;
        }
        let comm = Comm::of(Transport::Mpi(universe.world()));
        waiting::set_on(comm.size() > 1);
        Some((
            Self {
                _universe: universe,
            },
            comm,
        ))
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        waiting::set_on(false);
    }
}

/// Asks Open MPI for no shared file pointers by a file beside each file: it holds the path of that in 256 bytes, and a
/// longer one ends the program (4.1.4). Nothing here uses such pointers.
fn spare_shared_pointers() {
    const CHOICE: &str = "OMPI_MCA_sharedfp";
    if std::env::var_os(CHOICE).is_none() {
        // SAFETY: no other thread reads or writes the environment this early.
        unsafe { std::env::set_var(CHOICE, "individual") };
    }
}

/// Name and version of the MPI library, which need not be started.
#[must_use]
pub fn library() -> String {
    let version = mpi::environment::library_version().unwrap_or_default();
    // Some versions have several lines, or continue with build options.
    let first = version.lines().next().unwrap_or_default();
    let first = first.split(',').next().unwrap_or_default();
    // MPICH says "MPICH Version:".
    let words = first.split_whitespace().filter(|word| *word != "Version:");
    let words: Vec<&str> = words.collect();
    words.join(" ")
}

/// A group of ranks.
pub struct Comm {
    transport: Transport,
    scratch: RefCell<Vec<u64>>,
}

/// The carrier of messages.
enum Transport {
    /// Nothing: there is one rank.
    Solo,
    Mpi(SimpleCommunicator),
    Virtual(Rank),
}

impl Comm {
    fn of(transport: Transport) -> Self {
        Self {
            transport,
            scratch: RefCell::default(),
        }
    }

    /// One rank by itself, without MPI.
    #[must_use]
    pub fn solo() -> Self {
        Self::of(Transport::Solo)
    }

    fn on_virtual_rank(rank: Rank) -> Self {
        Self::of(Transport::Virtual(rank))
    }

    /// Some of the ranks by themselves, numbered from zero; this one is among them, and all of them
    /// ask for the same. Collective for them alone.
    ///
    /// # Panics
    /// If this rank is not among them.
    #[must_use]
    pub fn among(&self, members: Range<usize>) -> Self {
        assert!(members.contains(&self.rank()), "a rank of {members:?}");
        Self::of(match &self.transport {
            Transport::Solo => Transport::Solo,
            Transport::Mpi(world) => {
                let number = |rank| i32::try_from(rank).expect("a rank fits an int");
                let numbers: Vec<i32> = members.map(number).collect();
                let group = world.group().include(&numbers);
                let subgroup = waiting(|| world.split_by_subgroup(&group));
                Transport::Mpi(subgroup.expect("this rank is among them"))
            }
            Transport::Virtual(rank) => Transport::Virtual(rank.among(&members)),
        })
    }

    /// This rank's number.
    #[must_use]
    pub fn rank(&self) -> usize {
        match &self.transport {
            Transport::Solo => 0,
            Transport::Mpi(world) => usize::try_from(world.rank()).unwrap_or(0),
            Transport::Virtual(rank) => rank.number(),
        }
    }

    /// Number of ranks.
    #[must_use]
    pub fn size(&self) -> usize {
        match &self.transport {
            Transport::Solo => 1,
            Transport::Mpi(world) => usize::try_from(world.size()).unwrap_or(1),
            Transport::Virtual(rank) => rank.size(),
        }
    }

    /// Returns true on rank 0, which prints.
    #[must_use]
    pub fn is_root(&self) -> bool {
        self.rank() == 0
    }

    /// The handle for parallel HDF5; `None` without MPI, where one rank alone may write.
    #[must_use]
    pub fn raw(&self) -> Option<RawComm> {
        match &self.transport {
            Transport::Mpi(world) => Some(world.as_raw()),
            Transport::Solo | Transport::Virtual(_) => None,
        }
    }

    /// The time and messages of this rank so far, if it is a virtual one.
    #[must_use]
    pub fn virtual_time(&self) -> Option<VirtualTime> {
        match &self.transport {
            Transport::Virtual(_) => Some(Rank::time()),
            Transport::Solo | Transport::Mpi(_) => None,
        }
    }

    /// Seconds by this rank's clock, which for a virtual one is that of its machine; only differences mean anything.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        match &self.transport {
            Transport::Virtual(_) => Rank::time().now,
            Transport::Solo | Transport::Mpi(_) => waiting::since_start(),
        }
    }

    /// The traffic of this rank so far by the calls in the source that caused it, if it is a virtual one.
    #[must_use]
    pub fn traffic_by_call(&self) -> BTreeMap<Call, CallTraffic> {
        match &self.transport {
            Transport::Virtual(_) => virtual_ranks::calls(),
            Transport::Solo | Transport::Mpi(_) => BTreeMap::new(),
        }
    }

    /// Advances the clock of a virtual rank by seconds of computing, where they are
    /// [reported](Computing::Reported). Does nothing else.
    pub fn compute(&self, seconds: f64) {
        if let Transport::Virtual(rank) = &self.transport {
            rank.compute(seconds);
        }
    }

    /// Waits for all ranks.
    #[track_caller]
    pub fn barrier(&self) {
        match &self.transport {
            Transport::Solo => {}
            Transport::Mpi(world) => waiting(|| world.barrier()),
            Transport::Virtual(rank) => rank.barrier(),
        }
    }

    /// Replaces each number by its sum over ranks (wrapping is the caller's concern).
    #[track_caller]
    pub fn sum_i64(&self, values: &mut [i64]) {
        self.reduce(values, SystemOperation::sum(), i64::wrapping_add);
    }

    /// Replaces each number by its sum over ranks.
    #[track_caller]
    pub fn sum_u64(&self, values: &mut [u64]) {
        self.reduce(values, SystemOperation::sum(), u64::wrapping_add);
    }

    /// Replaces each number by its largest over ranks.
    #[track_caller]
    pub fn max_u64(&self, values: &mut [u64]) {
        self.reduce_unsigned(values, SystemOperation::max(), i64::max);
    }

    /// Replaces each number by its smallest over ranks.
    #[track_caller]
    pub fn min_u64(&self, values: &mut [u64]) {
        self.reduce_unsigned(values, SystemOperation::min(), i64::min);
    }

    /// Largest of a number over ranks.
    #[track_caller]
    #[must_use]
    pub fn max_f64(&self, value: f64) -> f64 {
        let mut values = [value];
        self.reduce(&mut values, SystemOperation::max(), f64::max);
        values[0]
    }

    /// Smallest of a number over ranks.
    #[track_caller]
    #[must_use]
    pub fn min_f64(&self, value: f64) -> f64 {
        let mut values = [value];
        self.reduce(&mut values, SystemOperation::min(), f64::min);
        values[0]
    }

    /// Returns true on every rank if `yes` is true on any.
    #[track_caller]
    #[must_use]
    pub fn any(&self, yes: bool) -> bool {
        let mut values = [u64::from(yes)];
        self.max_u64(&mut values);
        values[0] != 0
    }

    /// Joins every rank's `values` (the same length everywhere) in rank order into `all`.
    #[track_caller]
    pub fn all_gather_u64(&self, values: &[u64], all: &mut Vec<u64>) {
        all.resize(values.len() * self.size(), 0);
        match &self.transport {
            Transport::Solo => all.copy_from_slice(values),
            Transport::Mpi(world) => waiting(|| world.all_gather_into(values, all.as_mut_slice())),
            Transport::Virtual(rank) => rank.all_gather(values, all),
        }
    }

    /// Gives every rank the root's bytes.
    #[track_caller]
    pub fn broadcast(&self, bytes: &mut Vec<u8>) {
        self.broadcast_from(0, bytes);
    }

    /// Gives every rank the bytes of rank `from`.
    ///
    /// # Panics
    /// If there is no such rank.
    #[track_caller]
    pub fn broadcast_from(&self, from: usize, bytes: &mut Vec<u8>) {
        match &self.transport {
            Transport::Solo => assert_eq!(from, 0, "there is one rank"),
            Transport::Mpi(world) => broadcast_by_mpi(world, from, bytes),
            Transport::Virtual(rank) => rank.broadcast(from, bytes),
        }
    }

    /// Combines numbers over ranks by an operation that compares. MPICH 4.0 compares unsigned numbers as signed ones
    /// (`MPI_MIN` of 5 and 2⁶⁴ − 1 is the latter), so they are signed ones in the same order meanwhile.
    #[track_caller]
    fn reduce_unsigned(
        &self,
        values: &mut [u64],
        operation: SystemOperation,
        combine: fn(i64, i64) -> i64,
    ) {
        let signed: &mut [i64] = bytemuck::cast_slice_mut(values);
        let turn = |values: &mut [i64]| values.iter_mut().for_each(|value| *value ^= i64::MIN);
        turn(signed);
        self.reduce(signed, operation, combine);
        turn(signed);
    }

    /// Combines values of eight bytes over ranks, by MPI's operation or the function that does the same.
    #[track_caller]
    fn reduce<T>(&self, values: &mut [T], operation: SystemOperation, combine: fn(T, T) -> T)
    where
        T: bytemuck::Pod + mpi::traits::Equivalence,
        [T]: mpi::traits::Buffer + mpi::traits::BufferMut,
    {
        if self.size() == 1 {
            return;
        }
        match &self.transport {
            Transport::Solo => {}
            Transport::Mpi(world) => {
                let mut scratch = self.scratch.borrow_mut();
                let words = size_of_val(values).div_ceil(8);
                if scratch.len() < words {
                    scratch.resize(words, 0);
                }
                let mine: &mut [T] = bytemuck::cast_slice_mut(&mut scratch[..words]);
                mine.copy_from_slice(values);
                waiting(|| world.all_reduce_into(&*mine, values, operation));
            }
            Transport::Virtual(rank) => {
                rank.reduce(bytemuck::cast_slice_mut(values), |all, mine| {
                    for (all, &mine) in all.iter_mut().zip(mine) {
                        *all = bytemuck::cast(combine(bytemuck::cast(*all), bytemuck::cast(mine)));
                    }
                });
            }
        }
    }
}

fn broadcast_by_mpi(world: &SimpleCommunicator, from: usize, bytes: &mut Vec<u8>) {
    let root = world.process_at_rank(i32::try_from(from).expect("a rank fits an int"));
    let mut length = [bytes.len() as u64];
    waiting(|| root.broadcast_into(&mut length));
    bytes.resize(usize::try_from(length[0]).unwrap_or(0), 0);
    for piece in bytes.chunks_mut(1 << 30) {
        waiting(|| root.broadcast_into(piece));
    }
}

/// Ends all ranks of a running MPI job at once, as a panic must: without this a panic unwinds into
/// `MPI_Finalize` and the job hangs. Does nothing outside MPI.
pub fn abort_job(exit_code: i32) {
    if mpi::is_initialized() {
        // SAFETY: MPI is initialised; `MPI_Abort` takes any live communicator and does not return.
        unsafe {
            ffi::MPI_Abort(ffi::RSMPI_COMM_WORLD, exit_code);
        }
    }
}
