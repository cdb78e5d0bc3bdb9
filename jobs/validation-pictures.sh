#!/usr/bin/env bash
# Runs the cases of the book's validation page and draws its pictures: the paper's Figures 3, 4, 6
# to 10 and 12 to 16, what is measured on the dam, and the picture of the README. Some three
# minutes on two cores.
#
#   jobs/validation-pictures.sh [FOLDER]      FOLDER: for the pictures, docs/src/images by default
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source jobs/env.sh

pictures=${1:-docs/src/images}
runs=target/validation
whipple=target/release/whipple

# run CASE FOLDER [OPTION…]: the last part of FOLDER is the run's name in pictures.
run() { "$whipple" run "inputs/$1" --out "$runs/$2" --force "${@:3}"; }
# draw FOLDER PICTURE [OPTION…]: $width pixels wide, 760 unless set
draw() { "$whipple" plot "$runs/$1" --out "$pictures/$2.png" --width "${width:-760}" "${@:3}"; }

# Figures 3 and 4: the wave in two bars, beside one piece and the exact wave.
for wave in wave-step wave-pulse; do
    for h in 1.0 1.2; do
        run $wave $wave-$h/contact --set sph.smoothing=$h
        run $wave $wave-$h/one-piece --set sph.smoothing=$h --set contact.mode=kernel
        draw $wave-$h/contact $wave-$h --profile velocity.x --exact \
            --with $runs/$wave-$h/one-piece
    done
done

# Figures 6 to 10: the bars without and with contact.
run bar-impact bars/contact
run bar-impact bars/no-contact --set contact.mode=kernel
bars() { draw bars/contact "$1" --exact --with $runs/bars/no-contact "${@:2}"; }
bars bar-pressure-0.48us --profile pressure --time 0.48us
bars bar-velocity-0.48us --profile velocity.x --time 0.48us
bars bar-velocity-3us --profile velocity.x --time 3us
draw bars/contact bar-energies-contact --history
draw bars/no-contact bar-energies-no-contact --history

# Figures 12 and 13: the blocks without and with contact.
run block-impact blocks/contact
run block-impact blocks/no-contact --set contact.mode=kernel
for time in 1us 2us; do
    draw blocks/no-contact block-pressure-$time --panels --field pressure --time $time \
        --with $runs/blocks/contact
done

# Figure 14: the dam, and its front beside Martin & Moyce's.
run dam-break dam
draw dam dam-frames --panels --field velocity --time 0s,0.2s,0.7s,1s --view -1.5:60,-1.5:40cm
draw dam dam-front --front water --view 0:0.35s --range 0:0.7m \
    --points inputs/dam-break/martin_moyce_1.125in.csv --points inputs/dam-break/martin_moyce_2.25in.csv

# Figures 15 and 16: the sphere and the plate.
run quarter-impact quarter
width=1300 draw quarter quarter-impact --panels
width=1300 draw quarter quarter-isometric --view isometric --no-mirror --panels --time 0us,0.2us
draw quarter view-isometric --view isometric --time 0.1us

# The same whole and without a lattice, half as long again: the picture of the README.
run quarter-impact whole --set 'symmetry=[]' --set 'run.end_time="0.3 us"' \
    --set body.plate.lattice=glass --set body.sphere.lattice=glass
width=1300 draw whole whole-impact --panels --time 0us,0.14us,0.3us --view -1.6:1.6,-1.75:1.2mm
