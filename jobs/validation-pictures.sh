#!/usr/bin/env bash
# Runs the cases of the book's validation page and draws its pictures.
#
#   jobs/validation-pictures.sh [FOLDER]      FOLDER: for the pictures, docs/src/images by default
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source jobs/env.sh

pictures=${1:-docs/src/images}
runs=target/validation
whipple=target/release/whipple

run() { "$whipple" run "inputs/$1" --out "$runs/$2" --force "${@:3}"; }
draw() { "$whipple" plot "$runs/$1" --width 760 --out "$pictures/$2.png" "${@:3}"; }

run wave-pulse contact
run wave-pulse one-piece --set contact.mode=kernel
draw contact wave-pulse --profile velocity.x --exact --with "$runs/one-piece"

run bar-impact bars
draw bars bar-impact --profile velocity.x --at 0.48us,2.7us,3us --exact
