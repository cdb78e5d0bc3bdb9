#!/usr/bin/env bash
# Builds whipple with Open MPI and, in target/mpich, with MPICH beside it; runs a small case on one, two and four ranks with both,
# which must have the same bits; and runs tests of real ranks with MPICH. Ranks of MPICH spin while they wait, so that more of
# them than cores take long: the tests are those of collective calls, and of files on every rank.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# with openmpi|mpich COMMAND …: in the environment of that MPI.
with() (
    export WHIPPLE_MPI=$1
    shift
    source jobs/env.sh
    "$@"
)

for mpi in openmpi mpich; do
    with "$mpi" jobs/install-deps.sh
    with "$mpi" cargo build --locked
done
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT
for ranks in 1 2 4; do
    for mpi in openmpi mpich; do
        program=target/debug/whipple
        [ "$mpi" = openmpi ] || program=target/mpich/debug/whipple
        with "$mpi" mpirun -n "$ranks" "$program" run inputs/quarter-impact --threads 1 --quiet --out "$runs/$mpi-$ranks" \
            --set spacing=0.04mm --set output.checkpoint_every_steps=20
    done
    target/debug/whipple compare "$runs/openmpi-$ranks" "$runs/mpich-$ranks"
done
with mpich cargo nextest run --locked --test mpi \
    -E 'test(comm::) | test(on_every_rank) | test(by_every_rank) | test(any_ranks_restore)'
