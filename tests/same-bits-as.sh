#!/usr/bin/env bash
# Shows that two builds give the same bits: runs a table of cases with both, shortened to a second
# each, and compares whatever they write but for clocks, memory and messages between ranks.
#
#   tests/same-bits-as.sh OLD NEW [--quick]      OLD, NEW: two `whipple`; --quick: two minutes at most
#
# The program of another commit comes from a checkout of its own:
#
#   git worktree add /tmp/before COMMIT && cd /tmp/before && source jobs/env.sh
#   cargo build --locked --release          →  /tmp/before/target/release/whipple
#
# Compared are exit codes, warnings and errors, tables, post-mortems, all fields of all snapshots and
# checkpoints, what `whipple info` says of the last snapshot, and the numbers of the summary. Some cases
# then run again with NEW alone on other ranks, threads and instructions, and from a checkpoint of OLD,
# and must come to the bits of OLD's one rank. One line for each case; exits with 1 if any differs, and
# keeps the results of those.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
usage() { sed -n '/^#   tests/s/^#  //p' "$0" >&2; exit 2; }
quick=''
programs=()
for word in "$@"; do
    case $word in
        --quick) quick=1 ;;
        -*) usage ;;
        *) programs+=("$(realpath -- "$word")") ;;
    esac
done
[ ${#programs[@]} = 2 ] || usage
old=${programs[0]} new=${programs[1]}
for program in "$old" "$new"; do
    "$program" --version >/dev/null || { echo "$program does not run" >&2; exit 2; }
done
# shellcheck source=/dev/null
source "$root/jobs/env.sh"

# In memory where that is to be had: each run writes a few checkpoints, and disks are slow.
place=$(mktemp -d "${TMPDIR:-/dev/shm}/same-bits-as.XXXXXX" 2>/dev/null || mktemp -d)
trap 'rm -rf "$place"' EXIT
kept=${TMPDIR:-/tmp}/same-bits-as.$$

# Rows of MARKS | CASE | SETTINGS, which have no blanks in them. Marks: `q` also with --quick; `r` also on
# other ranks, threads and instructions, and from a checkpoint.
ready() { cat <<'END'
q  | inputs/bar-impact | run.max_steps=150
   | inputs/block-impact | spacing=0.04cm
   | inputs/contact-lab/case.toml |
   | inputs/contact-lab/seam.toml | run.max_steps=80
   | inputs/contact-lab/solid.toml | run.max_steps=40
   | inputs/contact-lab/seam-solid.toml | run.max_steps=40
   | inputs/ceramic-tile | spacing=1mm body.tile.spacing.inner=1mm body.back.spacing.inner=1mm run.max_steps=120
   | inputs/crater | spacing=0.8mm body.target.spacing.inner=0.8mm run.max_steps=60
q  | inputs/dam-break | spacing=0.73cm run.max_steps=150
q  | inputs/elastic-impact | spacing=0.12mm run.max_steps=60
q  | inputs/flyer-plate | run.max_steps=150
r  | inputs/hertz-cylinder | spacing=0.6mm
   | inputs/hertz-disc | spacing=0.5mm
   | inputs/hiermaier-1997 | spacing=1mm body.plate.spacing.inner=1mm body.plate.spacing.outer=2mm run.max_steps=80
   | inputs/honeycomb-panel | spacing=0.4mm body.core.spacing=0.6mm run.max_steps=60
   | inputs/noh | run.max_steps=300
   | inputs/punch | run.max_steps=60
q  | inputs/quarter-impact | spacing=0.05mm
   | inputs/ricochet | spacing=1mm run.max_steps=120
   | inputs/rubber-rings | spacing=2mm
   | inputs/sand-crater | run.max_steps=300
   | inputs/sliding-block | run.max_steps=30
   | inputs/sod |
   | inputs/stuffed-shield | spacing=0.4mm body.bumper.spacing.inner=0.4mm run.max_steps=60
   | inputs/taylor-bar | spacing=0.8mm
qr | inputs/tension-strip | run.max_steps=120
   | inputs/wave-pulse |
   | inputs/wave-step | sph.smoothing=1.2
   | inputs/whipple-shield | spacing=0.4mm body.bumper.spacing.inner=0.4mm run.max_steps=60
qr | tests/common/loaded.toml | run.max_steps=60
qr | tests/common/absorbed.toml |
qr | tests/common/tumbling.toml |
qr | tests/common/torn.toml |
q  | tests/common/flight.toml |
END
}

# fits FORM SETTINGS: whether a form of the sums goes with them.
fits() {
    case $1 in
        conventional) [[ $2 != *normal* ]] ;;
        stress_points) [[ $2 != *@(normal|penalty|kernel|self_contact|artificial_stress|balsara|conduction|xsph)* ]] ;;
    esac
}

# Forms of the sums × contact.
contacts() {
    local form=$1 base
    for base in 'inputs/bar-impact | run.max_steps=120' 'inputs/contact-lab/case.toml | run.max_steps=60' \
        'inputs/quarter-impact | spacing=0.06mm'; do
        while IFS='|' read -r mark settings; do
            fits "$form" "$settings" || continue
            # The short list has all of it in two dimensions.
            [[ $base = *contact-lab* ]] || mark=${mark#q}
            echo "$mark | $base sph.form=$form $settings"
        done <<'END'
q| contact.mode=overlap
 | contact.overlap={stiffness=3,core_stiffness=1.5,core_radius=0.7}
q| contact.overlap.direction=normal
q| contact.friction={static=0.4,kinetic=0.3} contact.damping=0.1
 | contact.friction=0.2 contact.overlap.direction=normal
q| contact.mode=potential contact.potential.stiffness=0.03
 | contact.mode=potential contact.potential={exponent=2,range="spacing"}
 | contact.mode=potential contact.potential={direction="normal"}
q| contact.mode=penalty
 | contact.mode=penalty contact.penalty.law=pinball
q| contact.mode=penalty contact.friction={static=0.4,kinetic=0.3} contact.damping=0.1
q| contact.mode=kernel
 | contact.mode=none
 | contact.self_contact=true
q| contact.self_contact={folds=5} contact.friction=0.3 contact.damping=0.2
END
    done
}

# Forms × the options of the sums and the trouble with numbers.
options() {
    local form=$1 base
    for base in 'inputs/contact-lab/solid.toml | spacing=0.15mm run.max_steps=40' 'inputs/bar-impact | run.max_steps=120' \
        'inputs/quarter-impact | spacing=0.06mm'; do
        while IFS='|' read -r mark settings; do
            fits "$form" "$settings" || continue
            [[ $base = *quarter* ]] || mark=${mark#q}
            echo "$mark | $base sph.form=$form $settings"
        done <<'END'
 | sph.artificial_stress=0.3
 | sph.balsara=true
 | sph.conduction=1
q| sph.xsph=0.5
q| sph.smoothing_length=variable
 | sph.artificial_stress=0.3 sph.xsph=0.5
q| sph.artificial_stress=0.3 sph.balsara=true sph.conduction=1 sph.xsph=0.5
 | sph.artificial_stress=0.3 sph.balsara=true sph.conduction=1 sph.xsph=0.5 sph.smoothing_length=variable
 | sph.smoothing=1.7 sph.alpha=0.5 sph.beta=1 time_step={courant=0.3,force=0.1,contact=0.5}
 | trouble.density_max=1.25
q| trouble.density_max=1.25 trouble.policy=remove
q| trouble.density_max=1.25 trouble.policy=freeze
END
    done
}

others() {
    local name
    while read -r name; do
        echo " | inputs/contact-lab/solid.toml | spacing=0.2mm run.max_steps=60 material.aluminium.library=$name"
    done < <("$old" materials | awk '$2 ~ /^[0-9.]+$/ { print $1 }')
    cat <<'END'
q  | inputs/contact-lab/solid.toml | spacing=0.2mm material.aluminium.library=copper-johnson-cook output.fields=["temperature","von_mises_stress"]
   | inputs/contact-lab/solid.toml | spacing=0.2mm material.aluminium.failure.spall.pressure=-1GPa material.aluminium.strength=none
q  | inputs/quarter-impact | spacing=0.05mm material.aluminium.failure.spall.after=recompacts sph.form=corrected
   | inputs/quarter-impact | spacing=0.05mm material.aluminium.failure.spall.after=hold
   | inputs/contact-lab/seam.toml | contact.pair=[{bodies=["left","right"],mode="kernel"},{bodies=["left","above"],mode="penalty",friction=0.3}]
q  | inputs/contact-lab/seam.toml | contact.pair=[{bodies=["left","right"],friction=0.3},{bodies=["right","above"],mode="potential"}] run.max_steps=60
   | inputs/contact-lab/seam.toml | body.above.lattice=rings body.left.lattice={kind="hexagonal",angle="20deg"}
   | inputs/contact-lab/case.toml | body.above.spacing=0.15mm gravity=[0,"-1e9m/s^2"] sph.form=normalised
   | inputs/quarter-impact | spacing=0.06mm symmetry=[]
q  | inputs/quarter-impact | spacing=0.06mm self_gravity.constant=1e7m^3/(kg*s^2)
   | inputs/taylor-bar | spacing=0.8mm plane.anvil.friction=0.2 plane.anvil.damping=0.1
q  | inputs/hertz-disc | spacing=0.5mm plane.plate.friction={static=0.4,kinetic=0.3} plane.plate.damping=0.2 run.max_steps=100
   | inputs/punch | surface.punch.friction=0.3 surface.die.damping=0.3 sph.form=normalised run.max_steps=60
   | inputs/sliding-block | contact.friction={static=0.4,kinetic=0.3} plane.tool.friction=0.1 run.max_steps=30
   | inputs/dam-break | spacing=0.73cm run.max_steps=150 sph.form=normalised contact.friction=0.3
   | inputs/dam-break | spacing=0.73cm run.max_steps=150 sph.form=stress_points
   | tests/common/loaded.toml | sph.form=normalised
   | tests/common/loaded.toml | sph.form=stress_points
   | tests/common/loaded.toml | contact.friction=0.3 contact.mode=overlap sph.xsph=0.5 sph.smoothing_length=variable
   | tests/common/torn.toml | sph.form=normalised
   | inputs/quarter-impact | sph.form=stress_points contact.mode=kernel
   | inputs/quarter-impact | sph.form=stress_points sph.xsph=0.5
qr | inputs/quarter-impact | spacing=0.05mm contact.friction=0.3 contact.damping=0.1 sph.artificial_stress=0.3 sph.balsara=true sph.conduction=1 sph.xsph=0.5 sph.smoothing_length=variable
r  | inputs/quarter-impact | spacing=0.06mm sph.form=normalised contact.overlap.direction=normal trouble.density_max=1.25 trouble.policy=remove
r  | inputs/quarter-impact | spacing=0.06mm contact.mode=penalty contact.friction={static=0.4,kinetic=0.3} contact.damping=0.1
r  | inputs/quarter-impact | spacing=0.06mm contact.mode=potential trouble.density_max=1.25 trouble.policy=freeze
r  | inputs/quarter-impact | spacing=0.06mm sph.form=stress_points contact.friction=0.3
r  | inputs/bar-impact | sph.form=normalised run.max_steps=120
r  | tests/common/flight.toml |
END
}

rows() {
    local form
    ready
    for form in conventional normalised stress_points; do
        contacts $form
        options $form
    done
    others
}

# Every field that snapshots can have, in all cases; temperatures are refused without constants of heat.
fields=$({ "$old" check "$root/inputs/bar-impact" --set 'output.fields=["?"]' 2>&1 || true; } |
    sed -n 's/.*the choices are //p' | tr '`' '"' | sed -E 's/, "(peak_)?temperature"//g')
[ -n "$fields" ] || { echo "$old does not tell the names of fields" >&2; exit 2; }

# start FOLDER RANKS PROGRAM ARGUMENTS…: what it says and its exit code stay in FOLDER.
start() {
    local folder=$1 ranks=$2 launch=()
    [ "$ranks" = 1 ] || launch=(mpirun -n "$ranks")
    mkdir -p "$folder"
    (cd "$folder" && code=0 && { "${launch[@]}" "${@:3}" </dev/null >out 2>err || code=$?; } && echo "$code" >code)
}

# Numbers of a summary that no clock, count of ranks or way of storing has a part in.
numbers() {
    sed -e '/"seconds_by_phase": {/,/}/d' -e '/"decomposition": {/,/}/d' -e '/"decomposition": null/d' -e '/"output_seconds": {/,/}/d' -e '/^ *"\(bytes_per_particle\|bytes_sent_per_rank_and_step\|commit\|instructions\|messages_per_rank_and_step\|million_updates_per_second_per_core\|output_share\|ranks\|set_up_seconds\|threads\|version\|wall_seconds\)"/d' "$1"
}

# State of a run, without the run's id and what is of clocks.
state() {
    sed -e '/"outlook"/,$d' -e '/^ *"run":/d' "$1"
}

# What `info` says of the last snapshot, but for the program, ranks and threads that wrote it.
last_snapshot() {
    local files=("$1"/snapshots/step-*.vtkhdf)
    if [ -e "${files[-1]}" ]; then "$old" info "${files[-1]}" | grep -vE '^(snapshot|version|ranks x threads) '; fi
}

# same A B: tells what differs between the runs in two folders; nothing if all agrees.
same() {
    local a=$1/run b=$2/run found=$place/found
    [ -d "$a" ] || [ -d "$b" ] || return 0
    if [ ! -d "$a" ] || [ ! -d "$b" ]; then echo "only one has results"; return; fi
    "$old" compare "$a" "$b" >"$found" 2>&1 || cat "$found"
    # What only one has is no difference to `compare`.
    grep -E 'only [AB] has' "$found" || true
    diff <(cd "$a" && ls -d ./*.csv) <(cd "$b" && ls -d ./*.csv) || true
    local table
    for table in "$a"/*.csv; do
        if [[ ! ${table##*/} =~ ^(performance|ranks).csv$ ]]; then cmp "$table" "$b/${table##*/}" 2>&1 || true; fi
    done
    # What follows is of clocks, ranks and where the run began.
    diff <(state "$a/status.json") <(state "$b/status.json") || true
    if [ -e "$a/summary.json" ]; then diff <(numbers "$a/summary.json") <(numbers "$b/summary.json") || true; fi
    diff <(last_snapshot "$a") <(last_snapshot "$b") || true
}

# same_words A B: the same of exit codes, warnings, errors and post-mortems, of runs on one rank.
same_words() {
    diff "$1/code" "$2/code" || true
    diff "$1/err" "$2/err" || true
    if [ -e "$1/run/trouble" ] || [ -e "$2/run/trouble" ]; then diff -r "$1/run/trouble" "$2/run/trouble" || true; fi
}

cases=0 different=0 refused=0
# tell WHAT DIFFERENCES: the line of a case; keeps the results if there are differences.
tell() {
    cases=$((cases + 1))
    if [ -z "$2" ]; then
        echo "same       $1"
        return
    fi
    different=$((different + 1))
    echo "DIFFERENT  $1"
    sed -n '1,12s/^/             /p' <<<"$2"
    mkdir -p "$kept/$different"
    printf '%s\n%s\n' "$1" "$2" >"$kept/$different/differences"
    cp -r "$place"/{old,new} "$kept/$different/"
}

# again WHAT RANKS PROGRAM ARGUMENTS…: NEW once more, beside OLD's one rank.
again() {
    start "$place/new" "${@:2}"
    tell "$1" "$([ "$(<"$place/new/code")" = 0 ] || cat "$place/new/err"; same "$place/old" "$place/new")"
}

launches=('2 1' '3 1' '5 1' '1 2' '2 2') sets=(avx512 avx2 portable) restarts=(1 2)
if [ -n "$quick" ]; then launches=('3 2') sets=(portable) restarts=(2); fi
SECONDS=0
while IFS='|' read -r marks case settings; do
    [[ -z $quick || $marks = *q* ]] || continue
    read -r case <<<"$case"
    read -ra settings <<<"$settings"
    what="$case ${settings[*]}"
    arguments=("$root/$case" --out run)
    for setting in run.max_steps=100 "output.fields=[$fields]" output.history_every=1 \
        output.checkpoint_every_steps=40 output.checkpoints_kept=99 "${settings[@]}"; do
        arguments+=(--set "$setting")
    done
    rm -rf "$place"/{old,new}
    start "$place/old" 1 "$old" run "${arguments[@]}" --threads 1 &
    start "$place/new" 1 "$new" run "${arguments[@]}" --threads 1
    wait $!
    if [ "$(<"$place/old/code")" = 2 ]; then
        refused=$((refused + 1))
        what+=" (refused)"
    fi
    tell "$what" "$(same_words "$place/old" "$place/new"; same "$place/old" "$place/new")"
    [[ $marks = *r* ]] || continue
    for launch in "${launches[@]}"; do
        read -r ranks threads <<<"$launch"
        rm -rf "$place/new"
        again "$what: $ranks ranks x $threads threads" "$ranks" "$new" run "${arguments[@]}" --threads "$threads" \
            --set domain.balance_every=7
    done
    for instructions in "${sets[@]}"; do
        rm -rf "$place/new"
        again "$what: $instructions" 1 env WHIPPLE_SIMD="$instructions" "$new" run "${arguments[@]}" --threads 1
    done
    for ranks in "${restarts[@]}"; do
        rm -rf "$place/new"
        mkdir "$place/new"
        cp -r "$place/old/run" "$place/new/run"
        checkpoints=("$place"/new/run/checkpoints/step-*)
        rm -rf "${checkpoints[@]:1}"
        again "$what: from a checkpoint of before, on $ranks ranks" "$ranks" "$new" restart run --threads 1
    done
done < <(rows)

echo "$cases cases in $SECONDS s, $refused of them refused by the old program: $different differ"
if [ "$different" != 0 ]; then
    echo "their results are in $kept"
    exit 1
fi
