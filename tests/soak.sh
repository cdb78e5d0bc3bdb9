#!/usr/bin/env bash
# Kills and stops a run again and again, restarts it on other numbers of ranks, and compares each
# finished run with an untouched one, to the last bit. `make soak` calls it.
#
#   tests/soak.sh [-m MINUTES] [-s SEED]
#
# The seed fixes ranks, faults and waits; when a fault meets the run is the machine's. Ends with a
# table: fault, times, exit codes of mpirun, seconds until all ranks had ended, steps lost since the
# last checkpoint. Exit code 1 at the first difference, hang or failed restart.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/jobs/env.sh"
cd "$root"
minutes=30 seed=1
while getopts m:s: option; do
    case $option in
        m) minutes=$OPTARG ;;
        s) seed=$OPTARG ;;
        *) sed -n '/^#   tests/s/^#  //p' "$0" >&2; exit 2 ;;
    esac
done
RANDOM=$seed
program=${WHIPPLE_PROGRAM:-$root/target/release/whipple}
# A user's program does not know this; it would end each first leg.
export WHIPPLE_TEST_FAULT=panic:0:5
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

# Contact across slabs, two planes of symmetry, particles that leave their range on the way.
case=(inputs/quarter-impact --set spacing=0.03mm --set trouble.density_max=1.25
    --set trouble.policy=freeze --set output.checkpoint_every_steps=10 --set output.history_every=1
    --set output.snapshot_every=0.02us)
faults=(kill-rank term-rank usr1-rank usr1-mpirun term-mpirun kill-mpirun stop-file none)
patience=120

declare -A times codes waits lost
legs=0 runs=0 most_ranks=5

fail() { echo "soak: $*; seed $seed, leg $legs" >&2; table >&2; cp -r "$place" "${TMPDIR:-/tmp}/soak-failed.$$" || true; exit 1; }

table() {
    echo
    echo "| fault | times | exit codes of mpirun | all ended after: median, at most | steps lost, at most |"
    echo "|---|---|---|---|---|"
    local fault
    for fault in "${faults[@]}"; do
        [ -n "${times[$fault]:-}" ] || continue
        echo "| $fault | ${times[$fault]} | $(tr ' ' '\n' <<<"${codes[$fault]}" | sort -nu | tr '\n' ' ')|" \
            "$(median "${waits[$fault]}"), $(largest "${waits[$fault]}") ms | ${lost[$fault]} |"
    done
    echo
    echo "$legs legs, $runs finished runs with the same bits, seed $seed"
}

sorted() { tr ' ' '\n' <<<"$1" | grep . | sort -n; }
median() { sorted "$1" | sed -n "$((($(wc -w <<<"$1") + 1) / 2))p"; }
largest() { sorted "$1" | tail -n 1; }
now() { date +%s%3N; }
last_step() { tail -n 1 "$run/history.csv" 2>/dev/null | grep -oE '^[0-9]+' || echo 0; }
newest_checkpoint() {
    local found
    found=$({ compgen -G "$run/checkpoints/step-*[0-9]" || true; } | sort | tail -n 1)
    found=${found##*step-}
    echo $((10#${found:-0}))
}

# Ranks that live, by their number in the list of mpirun's children.
ranks_of() { pgrep -P "$1" -x whipple || true; }
random_rank() { ranks_of "$job" | sort -n | sed -n "$(((RANDOM >> 5) % ranks + 1))p"; }
send() { [ -n "$2" ] && kill -"$1" "$2" 2>/dev/null; }

# Fails where there is nothing to strike yet: no rank has been started, the run has no folder.
strike() {
    case $1 in
        kill-rank) send KILL "$(random_rank)" ;;
        term-rank) send TERM "$(random_rank)" ;;
        usr1-rank) send USR1 "$(random_rank)" ;;
        usr1-mpirun) send USR1 "$job" ;;
        term-mpirun) send TERM "$job" ;;
        kill-mpirun) send KILL "$job" ;;
        stop-file) touch "$run/stop" 2>/dev/null ;;
    esac
}

lives() { [ -d "/proc/$1" ] && ! grep -q '^State:.Z' "/proc/$1/status" 2>/dev/null; }

# Waits for mpirun and the ranks that it had; sets `code` and `took` (ms), in which a time when
# everything here stood still does not count.
wait_for_all() {
    local last passed children alive pid
    last=$(now)
    took=0
    children=$1
    while :; do
        alive=''
        for pid in $job $children; do
            if lives "$pid"; then alive=1; fi
        done
        [ -n "$alive" ] || break
        if [ "$took" -gt $((patience * 1000)) ]; then fail "a hang after $fault"; fi
        sleep 0.02
        passed=$(($(now) - last))
        last=$((last + passed))
        took=$((took + (passed < 200 ? passed : 200)))
    done
    code=0
    { wait "$job" || code=$?; } 2>/dev/null
}

# One leg: from the newest checkpoint or from the start, with a fault on the way.
leg() {
    local children wait_ms
    legs=$((legs + 1))
    ranks=$(((RANDOM >> 5) % most_ranks + 1))
    fault=${faults[(RANDOM >> 5) % ${#faults[@]}]}
    wait_ms=$((RANDOM * 5000 / 32768))
    if [ "$(newest_checkpoint)" -gt 0 ]; then
        mpirun -n "$ranks" "$program" restart "$run" -t 1 </dev/null >"$place/out" 2>&1 &
    else
        mpirun -n "$ranks" "$program" run "${case[@]}" --out "$run" --force -t 1 </dev/null >"$place/out" 2>&1 &
    fi
    job=$!
    if [ "$fault" != none ]; then
        sleep "$((wait_ms / 1000)).$(printf %03d $((wait_ms % 1000)))"
    fi
    children=$(ranks_of "$job")
    # A leg that has ended before its fault, or not begun, is one without.
    lives "$job" && strike "$fault" || fault=none
    wait_for_all "$children"
    times[$fault]=$((${times[$fault]:-0} + 1))
    codes[$fault]="${codes[$fault]:-} $code"
    if [ "$fault" = none ]; then took=0; fi
    waits[$fault]="${waits[$fault]:-} $took"
    local gone=$(($(last_step) - $(newest_checkpoint)))
    if [ "$gone" -gt "${lost[$fault]:--1}" ]; then lost[$fault]=$gone; fi
    # A restart that cannot go on says so with 2; nothing here may cause that.
    if [ "$code" = 2 ]; then cat "$place/out" >&2; fail "a leg was refused"; fi
    if [ "$fault" = none ] && [ "$code" != 0 ]; then cat "$place/out" >&2; fail "an untouched leg ended with $code"; fi
}

finished() { grep -qs '"finished"' "$run/status.json"; }

run=$place/reference
mpirun -n 1 "$program" run "${case[@]}" --out "$run" -t 1 </dev/null >/dev/null
end=$(($(now) + minutes * 60000))
while [ "$(now)" -lt "$end" ]; do
    run=$place/run
    rm -rf "$run"
    until finished; do leg; done
    if ! "$program" compare "$place/reference" "$run" >"$place/compare"; then
        cat "$place/compare" >&2
        fail "other bits"
    fi
    if [ "$(ls "$place/reference/snapshots")" != "$(ls "$run/snapshots")" ]; then fail "other snapshots"; fi
    runs=$((runs + 1))
done
table
