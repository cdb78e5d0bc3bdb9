//! Collective calls of real ranks, of all and of some by themselves.

use crate::common::collectives::{check_collectives, check_parts};
use crate::ranks::on_each;

#[test]
fn collective_calls_give_what_the_numbers_of_all_ranks_give() {
    on_each(
        "comm::collective_calls_give_what_the_numbers_of_all_ranks_give",
        &[1, 2, 5],
        |comm| {
            check_collectives(comm);
            check_parts(comm);
        },
    );
}
