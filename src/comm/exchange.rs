//! One packed byte message to and from each peer of a phase.

use std::ffi::{c_int, c_void};
use std::ops::{AddAssign, Range, Sub};

use mpi::ffi;
use mpi::traits::AsRaw;

use super::virtual_ranks::{Rank, Tag, Ticket};
use super::waiting::waiting;
use super::{Comm, RawComm, Transport};

/// Largest piece of a message: counts are `i32`.
const PIECE: usize = 1 << 30;
/// Bytes of the size of a message.
const SIZE: usize = 8;
const TAG_SIZE: c_int = 1;
const TAG_DATA: c_int = 2;

/// Ranges of at most `most` that cover `0..length` in order.
pub fn pieces(length: usize, most: usize) -> impl Iterator<Item = Range<usize>> {
    let starts = (0..length).step_by(most);
    starts.map(move |start| start..length.min(start.saturating_add(most)))
}

/// Takes a value from the start of a message.
///
/// # Panics
/// If the message has ended.
pub fn read_pod<T: bytemuck::Pod>(bytes: &mut &[u8]) -> T {
    let (value, rest) = bytes.split_at(size_of::<T>());
    *bytes = rest;
    bytemuck::pod_read_unaligned(value)
}

/// Messages and bytes sent, for reports.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Messages sent.
    pub messages: u64,
    /// Bytes sent.
    pub bytes: u64,
}

impl Traffic {
    /// A message that gives a peer the size of the next one.
    pub const OF_SIZE: Self = Self {
        messages: 1,
        bytes: SIZE as u64,
    };

    /// A message of this many bytes to a peer.
    #[must_use]
    pub fn of(bytes: u64) -> Self {
        Self {
            messages: bytes.div_ceil(PIECE as u64),
            bytes,
        }
    }
}

impl AddAssign for Traffic {
    fn add_assign(&mut self, other: Self) {
        self.messages += other.messages;
        self.bytes += other.bytes;
    }
}

impl Sub for Traffic {
    type Output = Self;

    /// Traffic since another time.
    fn sub(self, before: Self) -> Self {
        Self {
            messages: self.messages - before.messages,
            bytes: self.bytes - before.bytes,
        }
    }
}

/// A rank that messages go to and come from.
#[derive(Default)]
pub struct Peer {
    rank: c_int,
    send: Vec<u8>,
    receive: Vec<u8>,
}

impl Peer {
    /// Its rank.
    #[must_use]
    pub fn rank(&self) -> usize {
        usize::try_from(self.rank).unwrap_or(0)
    }

    /// The message to it, to be filled.
    pub fn outgoing(&mut self) -> &mut Vec<u8> {
        &mut self.send
    }

    /// Its message.
    #[must_use]
    pub fn incoming(&self) -> &[u8] {
        &self.receive
    }

    /// Replaces the message to it by an answer to its own, which is taken.
    pub fn answer(&mut self, write: impl FnOnce(&[u8], &mut Vec<u8>)) {
        self.send.clear();
        write(&self.receive, &mut self.send);
        self.receive.clear();
    }
}

/// Buffers and requests of one exchange with a set of peers; every peer both sends and receives,
/// perhaps nothing. Buffers are kept from step to step.
///
/// Either [`Exchange::post`] when both sides know the sizes ([`Exchange::expect`]), or
/// [`Exchange::post_with_sizes`]; then [`Exchange::wait`], which waits for incoming messages only: a
/// peer that is still computing delays no rank that needs nothing from it.
#[derive(Default)]
pub struct Exchange {
    peers: Vec<Peer>,
    count: usize,
    receives: Vec<ffi::MPI_Request>,
    sends: Vec<ffi::MPI_Request>,
    /// In place of both, on a virtual rank: the rank itself, and the messages expected from peers.
    expected: Option<(Rank, Vec<(usize, Ticket)>)>,
    /// Size of the message to and from each peer.
    sizes: Vec<[u64; 2]>,
    /// Messages and bytes that this exchange has sent so far.
    pub traffic: Traffic,
}

impl Exchange {
    /// Sets the peers, emptying all messages. Both sides must name each other.
    ///
    /// # Panics
    /// If messages are still under way.
    pub fn set_peers(&mut self, ranks: impl Iterator<Item = usize>) {
        let idle = self.receives.is_empty() && self.expected.is_none();
        assert!(idle, "an exchange is still under way");
        wait_all(&mut self.sends);
        self.count = 0;
        for rank in ranks {
            if self.count == self.peers.len() {
                self.peers.push(Peer::default());
            }
            let peer = &mut self.peers[self.count];
            peer.rank = c_int::try_from(rank).expect("a rank fits an int");
            peer.send.clear();
            peer.receive.clear();
            self.count += 1;
        }
    }

    /// Number of peers.
    #[must_use]
    pub fn peers(&self) -> usize {
        self.count
    }

    /// Rank of the k-th peer.
    #[must_use]
    pub fn rank(&self, k: usize) -> usize {
        self.peers[k].rank()
    }

    /// The message to the k-th peer, to be filled.
    pub fn outgoing(&mut self, k: usize) -> &mut Vec<u8> {
        wait_all(&mut self.sends);
        &mut self.peers[k].send
    }

    /// The peers, whose messages may be filled by any threads.
    pub fn outgoing_all(&mut self) -> &mut [Peer] {
        wait_all(&mut self.sends);
        &mut self.peers[..self.count]
    }

    /// The message of the k-th peer, after [`Self::wait`].
    #[must_use]
    pub fn incoming(&self, k: usize) -> &[u8] {
        &self.peers[k].receive
    }

    /// The peers, whose messages any threads may read after [`Self::wait`].
    #[must_use]
    pub fn incoming_all(&self) -> &[Peer] {
        &self.peers[..self.count]
    }

    /// Sets the number of bytes that the k-th peer will send.
    pub fn expect(&mut self, k: usize, bytes: usize) {
        self.peers[k].receive.resize(bytes, 0);
    }

    /// Starts all messages, each after its size; returns when the sizes of the others' have come.
    ///
    /// # Panics
    /// If a message is larger than memory can be.
    #[track_caller]
    pub fn post_with_sizes(&mut self, comm: &Comm) {
        wait_all(&mut self.sends);
        self.sizes.clear();
        let sends = self.peers[..self.count].iter().map(|peer| &peer.send);
        self.sizes.extend(sends.map(|send| [send.len() as u64, 0]));
        match &comm.transport {
            Transport::Solo => {}
            Transport::Mpi(world) => {
                let raw = world.as_raw();
                self.swap_sizes_by_mpi(raw);
                self.send_by_mpi(raw);
                wait_all(&mut self.receives);
                self.expect_sizes();
                self.receive_by_mpi(raw);
            }
            Transport::Virtual(rank) => {
                self.send_sizes_virtually(rank);
                self.send_virtually(rank);
                self.receive_sizes_virtually(rank);
                self.expect_sizes();
                self.expect_virtually(rank);
            }
        }
    }

    /// Starts all messages; returns at once.
    #[track_caller]
    pub fn post(&mut self, comm: &Comm) {
        match &comm.transport {
            Transport::Solo => {}
            Transport::Mpi(world) => {
                self.receive_by_mpi(world.as_raw());
                self.send_by_mpi(world.as_raw());
            }
            Transport::Virtual(rank) => {
                self.expect_virtually(rank);
                self.send_virtually(rank);
            }
        }
    }

    /// Waits for the messages of the peers. This rank's own may still be under way: their buffers
    /// stay untouched until then.
    ///
    /// # Panics
    /// If there are more messages than MPI can count; on a virtual rank, if a message has not the
    /// size that was expected.
    pub fn wait(&mut self) {
        wait_all(&mut self.receives);
        if let Some((rank, tickets)) = self.expected.take() {
            for (k, ticket) in tickets {
                let bytes = rank.receive(ticket);
                let receive = &mut self.peers[k].receive;
                assert_eq!(bytes.len(), receive.len(), "a message as expected");
                *receive = bytes;
            }
        }
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        let message = |peer: &Peer| peer.send.capacity() + peer.receive.capacity();
        self.peers.iter().map(message).sum::<usize>()
            + size_of::<Peer>() * self.peers.capacity()
            + size_of::<ffi::MPI_Request>() * (self.receives.capacity() + self.sends.capacity())
            + size_of::<[u64; 2]>() * self.sizes.capacity()
    }

    /// Expects messages of the sizes that have come.
    fn expect_sizes(&mut self) {
        for (peer, size) in self.peers[..self.count].iter_mut().zip(&self.sizes) {
            let bytes = usize::try_from(size[1]).expect("a size fits memory");
            peer.receive.resize(bytes, 0);
        }
    }

    fn swap_sizes_by_mpi(&mut self, raw: RawComm) {
        for k in 0..self.count {
            let rank = self.peers[k].rank;
            let size = self.sizes[k].as_mut_ptr();
            // SAFETY: `sizes` is owned by `self` and not touched before these requests end; the two
            // halves of an entry are distinct.
            unsafe {
                self.receive_piece(raw, size.add(1).cast(), SIZE, rank, TAG_SIZE);
                self.send_piece(raw, size.cast(), SIZE, rank, TAG_SIZE);
            }
        }
    }

    fn receive_by_mpi(&mut self, raw: RawComm) {
        for k in 0..self.count {
            let rank = self.peers[k].rank;
            let (pointer, length) = {
                let receive = &mut self.peers[k].receive;
                (receive.as_mut_ptr(), receive.len())
            };
            for Range { start, end } in pieces(length, PIECE) {
                // SAFETY: the buffer is owned by `self`, lives until the requests end, and the
                // piece lies in it.
                unsafe {
                    let piece = pointer.add(start).cast();
                    self.receive_piece(raw, piece, end - start, rank, TAG_DATA);
                }
            }
        }
    }

    fn send_by_mpi(&mut self, raw: RawComm) {
        for k in 0..self.count {
            let rank = self.peers[k].rank;
            let (pointer, length) = {
                let send = &self.peers[k].send;
                (send.as_ptr(), send.len())
            };
            for Range { start, end } in pieces(length, PIECE) {
                // SAFETY: as for receives; MPI only reads the piece.
                unsafe {
                    let piece = pointer.add(start).cast();
                    self.send_piece(raw, piece, end - start, rank, TAG_DATA);
                }
            }
        }
    }

    #[track_caller]
    fn send_sizes_virtually(&mut self, me: &Rank) {
        for (k, size) in self.sizes.iter().enumerate() {
            me.send(self.rank(k), Tag::Size, &size[0].to_ne_bytes(), 1);
            self.traffic.messages += 1;
            self.traffic.bytes += SIZE as u64;
        }
    }

    fn receive_sizes_virtually(&mut self, me: &Rank) {
        for k in 0..self.count {
            let bytes = me.receive(me.expect(self.rank(k), Tag::Size));
            self.sizes[k][1] = bytemuck::pod_read_unaligned(&bytes);
        }
    }

    fn expect_virtually(&mut self, me: &Rank) {
        let says = |k: &usize| !self.peers[*k].receive.is_empty();
        let ticket = |k: usize| (k, me.expect(self.rank(k), Tag::Data));
        let tickets = (0..self.count).filter(says).map(ticket);
        self.expected = Some((me.clone(), tickets.collect()));
    }

    #[track_caller]
    fn send_virtually(&mut self, me: &Rank) {
        for k in 0..self.count {
            if self.peers[k].send.is_empty() {
                continue;
            }
            let send = &self.peers[k].send;
            let messages = pieces(send.len(), PIECE).count() as u64;
            me.send(self.rank(k), Tag::Data, send, messages);
            self.traffic.messages += messages;
            self.traffic.bytes += send.len() as u64;
        }
    }

    unsafe fn receive_piece(
        &mut self,
        comm: RawComm,
        to: *mut c_void,
        bytes: usize,
        rank: c_int,
        tag: c_int,
    ) {
        self.receives.push(begin(bytes, |count, request| {
            // SAFETY: the caller keeps `to..to + bytes` alive and untouched until `wait`.
            unsafe { ffi::MPI_Irecv(to, count, ffi::RSMPI_UINT8_T, rank, tag, comm, request) }
        }));
    }

    unsafe fn send_piece(
        &mut self,
        comm: RawComm,
        from: *const c_void,
        bytes: usize,
        rank: c_int,
        tag: c_int,
    ) {
        self.sends.push(begin(bytes, |count, request| {
            // SAFETY: the caller keeps `from..from + bytes` alive and unchanged until `wait`.
            unsafe { ffi::MPI_Isend(from, count, ffi::RSMPI_UINT8_T, rank, tag, comm, request) }
        }));
        self.traffic.messages += 1;
        self.traffic.bytes += bytes as u64;
    }
}

/// Begins a message of `bytes` by a call that takes their count and sets the request.
fn begin(
    bytes: usize,
    call: impl FnOnce(c_int, *mut ffi::MPI_Request) -> c_int,
) -> ffi::MPI_Request {
    // SAFETY: a constant of the library.
    let mut request = unsafe { ffi::RSMPI_REQUEST_NULL };
    let count = c_int::try_from(bytes).expect("a piece fits an int");
    call(count, &raw mut request);
    request
}

impl Drop for Exchange {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            self.wait();
            wait_all(&mut self.sends);
        }
    }
}

/// Waits for requests whose buffers their owner keeps alive.
fn wait_all(requests: &mut Vec<ffi::MPI_Request>) {
    if requests.is_empty() {
        return;
    }
    let count = c_int::try_from(requests.len()).expect("requests fit an int");
    // SAFETY: the requests are live.
    waiting(|| unsafe {
        ffi::MPI_Waitall(count, requests.as_mut_ptr(), ffi::RSMPI_STATUSES_IGNORE);
    });
    requests.clear();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_of_more_than_two_thousand_million_rows_goes_in_pieces_that_mpi_can_count() {
        let row = 24;
        for rows in [1 << 31, (1 << 31) + 1, (1 << 32) - 1, 44_739_243] {
            let length = rows * row;
            let mut end = 0;
            for piece in pieces(length, PIECE) {
                assert_eq!(piece.start, end);
                assert!(c_int::try_from(piece.len()).is_ok_and(|count| count > 0));
                end = piece.end;
            }
            assert_eq!(end, length);
            assert_eq!(
                Traffic::of(length as u64).messages,
                pieces(length, PIECE).count() as u64
            );
        }
        assert_eq!(pieces(0, PIECE).count(), 0);
        assert_eq!(pieces(PIECE, PIECE).count(), 1);
        assert_eq!(pieces((1 << 31) * row, PIECE).count(), 48);
    }
}
