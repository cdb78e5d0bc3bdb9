#!/usr/bin/env bash
# Measures contact on small cases and writes the tables of the book's page on choosing a contact, and
# its pictures. Twenty minutes on two cores, a third of them for sliding blocks.
#
#   jobs/contact-lab.sh [FOLDER [PICTURES]]      FOLDER: of runs and table.md, target/contact-lab by
#                                                default; PICTURES: docs/src/images by default
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source jobs/env.sh

folder=${1:-target/contact-lab}
pictures=${2:-docs/src/images}
whipple=${WHIPPLE_PROGRAM:-target/release/whipple}
mkdir -p "$folder"
table=$folder/table.md
: >"$table"

say() { printf '%s\n' "$@" | tee -a "$table"; }

# number FILE KEY: a value of a summary; phase FILE: share of the contact phases in %
number() { sed -nE "s/^ *\"$2\": ([^,]*),?$/\1/p" "$1" | head -n 1; }
share() {
    awk -F'[:,]' '/seconds_by_phase/ { on = 1; next } on && /}/ { on = 0 }
        on { all += $2; if ($1 ~ /contact/) part += $2 }
        END { if (all > 0) printf "%.0f %%", 100 * part / all; else printf "–" }' "$1"
}

# energy FILE: largest change of total energy, and its change at the end, of the first kinetic
# energy, in %, from history.csv; what loads put in is taken off.
energy() {
    awk -F, '/^#/ { next } !named { for (i = 1; i <= NF; i++) at[$i] = i; named = 1; next }
        { e = $at["total_energy"] - $at["load_work"]
          if (!seen) { first = e; scale = $at["kinetic_energy"]; seen = 1 }
          w = $at["load_work"]; if (w < 0) w = -w; if (w > scale) scale = w
          d = e - first; if (d < 0) d = -d; if (d > most) most = d }
        END { if (scale > 0) printf "%.3f, %.3f", 100 * most / scale, 100 * d / scale
              else printf "–" }' "$1"
}

# measure NAME CASE [OVERRIDE…]: runs CASE and writes a row.
measure() {
    local name=$1 case=$2 run=$folder/${1//[^a-zA-Z0-9.]/-} set=() summary
    shift 2
    for override; do set+=(--set "$override"); done
    if ! "$whipple" run "inputs/$case" --out "$run" --force "${set[@]}" >"$run.log" 2>&1; then
        say "| $name | stopped: $(tail -n 1 "$run.log") | | | | | |"
        return
    fi
    summary=$run/summary.json
    say "$(printf '| %s | %s | %s | %s | %s, %s | %s | %s |' "$name" \
        "$(number "$summary" closest_foreign_pair | cut -c 1-5)" \
        "$(awk -v d="$(number "$summary" contact_defect)" 'BEGIN { printf "%.3f", 100 * d }')" \
        "$(energy "$run/history.csv")" \
        "$(number "$summary" steps)" "$(number "$summary" contact_limited_steps)" \
        "$(number "$summary" interpenetrated_particles)" "$(share "$summary")")"
}

heading() {
    say '' "## $1" '' \
        '| | closest foreign pair, Δp | contact defect, % | energy, largest and last, % | steps, limited by contact | interpenetrated | share of the time |' \
        '|---|---|---|---|---|---|---|'
}

# box LEFT BOTTOM RIGHT TOP in spacings, disc RADIUS
box() { echo "shape={ box = { lower = [\"$1 spacing\", \"$2 spacing\"], upper = [\"$3 spacing\", \"$4 spacing\"] } }"; }
# solid BODY LOWER… UPPER… in spacings
solid() {
    echo "body.$1.shape={ box = { lower = [\"$2 spacing\", \"$3 spacing\", \"$4 spacing\"], upper = [\"$5 spacing\", \"$6 spacing\", \"$7 spacing\"] } }"
}
plus() { awk -v a="$1" -v b="$2" 'BEGIN { print a + b }'; }
# Its surface meets the corner of a cube on the diagonal.
ball='body.below.shape={ sphere = { centre = ["-4.619 spacing", "-4.619 spacing", "-4.619 spacing"], radius = "8 spacing" } }'
disc='body.above.shape={ sphere = { centre = [0, "6 spacing"], radius = "6 spacing" } }'
on='body.above.touch={ body = "below", direction = "-y" }'

# All two-dimensional geometries of the laboratory, in one mode of contact.
geometries() {
    local mode=$1
    shift
    try() { local name=$1; shift; measure "$mode: $name" contact-lab "$mode_is" "$@"; }
    local mode_is=contact.mode=$mode
    try 'block, flat'
    try 'one particle on flat' "body.above.$(box 0 0 1 1)"
    try 'one on one' "body.above.$(box 0 0 1 1)" "body.below.$(box 0 -1 1 0)"
    try 'one on one, aside' "body.above.$(box 0.25 0 1.25 1)" "body.below.$(box 0 -1 1 0)"
    try 'edge on edge' "body.above.$(box 14 0 30 8)"
    try 'sheet on edge' "body.above.$(box -10 0 10 1)" "body.below.$(box -1 -10 2 0)"
    try 'finer on coarser' 'body.above.spacing="0.05 mm"'
    try 'coarser on finer' 'body.below.spacing="0.05 mm"'
    # Seven times as dense and as stiff at the same speed of sound: no metal, but the ratio of tungsten
    # to aluminium.
    try 'on dense' 'material.dense={ library = "aluminium-2024", density = "19.3 g/cm^3" }' \
        body.below.material=dense
    try '11.7 km/s' 'body.above.velocity=[0, "-11.7 km/s"]'
    for angle in 15 30 45; do
        try "lattice at $angle°" "body.above.lattice={ kind = \"cubic\", angle = \"$angle deg\" }" "$on"
    done
    try 'disc' "$disc"
    try 'disc, 30°' "$disc" 'body.above.velocity=["3.5 km/s", "-6.062 km/s"]'
    try 'disc, 60°' "$disc" 'body.above.velocity=["6.062 km/s", "-3.5 km/s"]'
    local seam=inputs/contact-lab/seam.toml
    [ ! -f "$seam" ] || measure "$mode: seam" contact-lab/seam.toml "$mode_is"
}

# Of the same in three dimensions those that ask for no particle in a certain place, in terms of `try`.
bulks() {
    local tungsten='material.tungsten={ library = "tungsten" }'
    try 'corner on a sphere' "$ball" "$(solid above 0 0 0 6 6 6)" \
        'body.above.velocity=["-4.0415 km/s", "-4.0415 km/s", "-4.0415 km/s"]'
    try 'edge on edge' "$(solid below -8 -1 -8 8 1 0)" "$(solid above -1 -8 0 1 8 8)"
    try 'sphere'
    try 'sphere, 30°' 'body.above.velocity=["3.5 km/s", 0, "-6.062 km/s"]'
    try 'sphere, 60°' 'body.above.velocity=["6.062 km/s", 0, "-3.5 km/s"]'
    try 'sphere on tungsten' "$tungsten" body.below.material=tungsten
    try 'tungsten on aluminium' "$tungsten" body.above.material=tungsten
    try 'copper on copper' 'material.aluminium={ library = "copper" }'
}

# On cubic lattices.
solids() {
    local mode_is=contact.mode=$1 name=$1
    try() { local what=$1; shift; measure "$name: $what, solid" contact-lab/solid.toml "$mode_is" "$@"; }
    local one plate='body.below.lattice={ kind = "cubic", angle = "45 deg" }'
    local tungsten='material.tungsten={ library = "tungsten" }'
    one() { solid above "$1" "$2" 0 "$(plus "$1" 1)" "$(plus "$2" 1)" 1; }
    try 'one particle on a particle' "$(one 0 0)"
    try 'one particle on a pore' "$(one 0.5 0.5)"
    try 'one particle on a bridge' "$(one 0.5 0)"
    try 'one on one' "$(one 0 0)" "$(solid below 0 0 -1 1 1 0)"
    try 'one on one, aside' "$(one 0.25 0.1)" "$(solid below 0 0 -1 1 1 0)"
    try 'sheet on sheet, edges' "$(solid below -8 0 -8 8 1 0)" "$(solid above 0 -8 0 1 8 8)"
    try 'sheet on edge' "$(solid below -8 -1 -8 8 1 0)" "$(solid above -6 -6 0 6 6 1)"
    try 'sheet on sheet' "$(solid below -8 -8 -1 8 8 0)" "$(solid above -6 -6 0 6 6 1)"
    bulks
    try 'sphere on a lattice at 45°' "$plate" 'body.above.touch={ body = "below", direction = "-z" }'
    try 'one particle on tungsten' "$tungsten" body.below.material=tungsten "$(one 0 0)"
    try 'one on one of tungsten' "$tungsten" body.below.material=tungsten "$(one 0 0)" \
        "$(solid below 0 0 -1 1 1 0)"
    try 'one on one of copper' 'material.aluminium={ library = "copper" }' "$(one 0 0)" \
        "$(solid below 0 0 -1 1 1 0)"
    measure "$name: seam, solid" contact-lab/seam-solid.toml "$mode_is"
}

# Glass on glass, each seed a filling of its own, and glass on the cubic lattice.
glasses() {
    local mode_is=contact.mode=$1 name glass seed
    glass() { echo "body.$1.lattice={ kind = \"glass\", seed = $2 }"; }
    try() { local what=$1; shift; measure "$name: $what" contact-lab/solid.toml "$mode_is" "$@" "${glass[@]}"; }
    for seed in 1 2 3; do
        name="$1, glass on glass $seed"
        glass=("$(glass above $seed)" "$(glass below $((seed + 10)))")
        bulks
        measure "$name: seam" contact-lab/seam-solid.toml "$mode_is" "$(glass above $seed)" \
            "$(glass left $((seed + 10)))" "$(glass right $((seed + 20)))"
        name="$1, glass on cubic $seed" glass=("$(glass above $seed)")
        bulks
        measure "$name: seam" contact-lab/seam-solid.toml "$mode_is" "${glass[@]}"
    done
}

for mode in overlap potential penalty; do
    heading "Two bodies at 7 km/s, \`$mode\`"
    geometries "$mode"
    heading "In three dimensions, \`$mode\`"
    solids "$mode"
    heading "Glass, \`$mode\`"
    glasses "$mode"
done

heading 'Stiffness, core and time step of `overlap`'
lone=("body.above.$(box 0 0 1 1)" "body.below.$(box 0 -1 1 0)")
for kappa in 2 4 6 8; do
    measure "κ = $kappa, block" contact-lab "contact.overlap.stiffness=$kappa"
done
for core in 2 2.5 3 4; do
    measure "core $core, block" contact-lab "contact.overlap.core_stiffness=$core"
    measure "core $core, one on one" contact-lab "contact.overlap.core_stiffness=$core" "${lone[@]}"
done
for courant in 0.5 0.25 0.1; do
    measure "courant $courant, block" contact-lab "time_step.courant=$courant"
    measure "courant $courant, one on one" contact-lab "time_step.courant=$courant" "${lone[@]}"
done

heading 'Ready cases'
for mode in overlap potential penalty; do
    for case in bar-impact block-impact elastic-impact; do
        measure "$case, $mode" "$case" "contact.mode=$mode"
    done
    measure "quarter-impact at .05 mm, $mode" quarter-impact "contact.mode=$mode" \
        'spacing="0.05 mm"' 'run.end_time="0.1 us"'
done

# draw PICTURE CASE END [OVERRIDE…]: three modes side by side at END.
draw() {
    local picture=$1 case=$2 end=$3 set=() runs=$folder/$1 mode with=()
    shift 3
    for override; do set+=(--set "$override"); done
    for mode in overlap potential penalty; do
        "$whipple" run "inputs/$case" --out "$runs/$mode" --force --set contact.mode=$mode \
            --set "run.end_time=\"$end\"" "${set[@]}" >"$runs.log" 2>&1
        [ $mode = overlap ] || with+=(--with "$runs/$mode")
    done
    "$whipple" plot "$runs/overlap" --panels --index 1 "${with[@]}" --width 1200 --out "$pictures/$picture.png"
}
draw contact-turned contact-lab '0.12 us' "$on" \
    'body.above.lattice={ kind = "cubic", angle = "30 deg" }'
draw contact-seam contact-lab/seam.toml '0.1 us'
"$whipple" run inputs/hertz-disc --out "$folder/hertz-disc" --force >"$folder/hertz-disc.log" 2>&1
"$whipple" plot "$folder/hertz-disc" --field von_mises --width 760 --out "$pictures/hertz-disc.png"

# Every mode on every problem.
cargo test --locked --test validation contacts:: -- --ignored --nocapture |
    sed -nE '/^## /,/^test /{/^test /!p}' | tee -a "$table"
