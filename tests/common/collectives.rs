//! Collective calls and messages, on ranks of any kind.

use comm::{Comm, Exchange, Joint};

use super::sentinel::mix;

/// Some number of a rank in a round.
fn number(rank: usize, round: u64, k: u64) -> u64 {
    mix(rank as u64 ^ round << 20 ^ k << 40) >> 16
}

/// Compares what collective calls give with what the numbers of all ranks do.
pub fn check_collectives(comm: &Comm) {
    let (me, ranks) = (comm.rank(), comm.size());
    for round in 0..4 {
        let mine = [0, 1, 2].map(|k| number(me, round, k));
        let all: Vec<[u64; 3]> = (0..ranks)
            .map(|rank| [0, 1, 2].map(|k| number(rank, round, k)))
            .collect();
        let over = |combine: fn(u64, u64) -> u64| {
            [0, 1, 2].map(|k| all.iter().map(|v| v[k]).reduce(combine).unwrap())
        };
        let (mut sum, mut most, mut least) = (mine, mine, mine);
        comm.sum_u64(&mut sum);
        comm.max_u64(&mut most);
        comm.min_u64(&mut least);
        let sums = over(|a, b| a + b);
        assert_eq!([sum, most, least], [sums, over(u64::max), over(u64::min)]);
        // What has the highest bit is large, not negative.
        let mut most = [if me.is_multiple_of(2) { u64::MAX } else { 5 }];
        let mut least = most;
        comm.max_u64(&mut most);
        comm.min_u64(&mut least);
        let wanted = if ranks > 1 { 5 } else { u64::MAX };
        assert_eq!([most, least], [[u64::MAX], [wanted]]);
        let mut signed = mine.map(|v| -v.cast_signed());
        comm.sum_i64(&mut signed);
        assert_eq!(signed, sums.map(|v| -v.cast_signed()));
        #[allow(clippy::cast_precision_loss, reason = "48 bits")]
        let real = |v: u64| -(v as f64);
        assert_eq!(comm.max_f64(real(mine[0])), real(over(u64::min)[0]));
        assert_eq!(comm.min_f64(real(mine[0])), real(over(u64::max)[0]));
        // Ranks differ in later words as well.
        let list = |v: &[u64; 3]| [v[0] % 3, v[1] % 7, v[2]];
        let mut joint = Joint::default();
        joint.sums.extend(mine.map(u64::cast_signed));
        joint.least.extend(&mine[..2]);
        (joint.first, joint.bits) = (list(&mine), mine[0] & mine[1]);
        comm.join(&mut joint);
        assert_eq!(joint.sums, sums.map(u64::cast_signed));
        assert_eq!(joint.least, over(u64::min)[..2]);
        assert_eq!(joint.first, all.iter().map(list).min().unwrap());
        assert_eq!(joint.bits, all.iter().fold(0, |bits, v| bits | v[0] & v[1]));
        assert!(!comm.any(false));
        let last = me + 1 == ranks;
        assert!(comm.any(last));
        comm.barrier();
        let mut gathered = vec![7; 5];
        comm.all_gather_u64(&mine, &mut gathered);
        assert!(gathered == all.as_flattened());
        let from = usize::try_from(round).unwrap() * 5 % ranks;
        let said = vec![u8::try_from(round + 1).unwrap(); [13, 0, 8, 70_001][from % 4]];
        let mut heard = if me == from {
            said.clone()
        } else {
            vec![9; me % 3]
        };
        comm.broadcast_from(from, &mut heard);
        assert!(heard == said);
    }
}

/// Some ranks by themselves: their calls and messages have nothing to do with those of all.
pub fn check_parts(comm: &Comm) {
    let (me, ranks) = (comm.rank(), comm.size());
    for parts in 1..=ranks.min(4) {
        let start = |part: usize| part * ranks / parts;
        let part = (0..parts).rfind(|&part| start(part) <= me).unwrap();
        let members = start(part)..start(part + 1);
        let group = comm.among(members.clone());
        assert_eq!(group.size(), members.len());
        assert_eq!(group.rank(), me - members.start);
        check_collectives(&group);
        if members.len() > 10 {
            continue;
        }
        let (mut of_all, mut of_group) = (Exchange::default(), Exchange::default());
        post(comm, &mut of_all, members.filter(|&rank| rank != me), 1);
        let others = (0..group.size()).filter(|&rank| rank != group.rank());
        post(&group, &mut of_group, others, 2);
        for (mut exchange, byte) in [(of_group, 2), (of_all, 1)] {
            exchange.wait();
            assert!((0..exchange.peers()).all(|k| exchange.incoming(k) == [byte]));
        }
    }
}

/// Sends a byte to some ranks that send one here.
fn post(comm: &Comm, exchange: &mut Exchange, peers: impl Iterator<Item = usize>, byte: u8) {
    exchange.set_peers(peers);
    for k in 0..exchange.peers() {
        exchange.outgoing(k).push(byte);
        exchange.expect(k, 1);
    }
    exchange.post(comm);
}
