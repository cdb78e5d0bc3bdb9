#!/usr/bin/env bash
# Runs the tests and ends with what ran: with cargo-nextest where it is installed, else with
# plain cargo and a summary of our own. `make test` calls it in the environment of jobs/env.sh. Builds
# of tests can put faults into the program (src/files/run/fault.rs), which a user's cannot.
#
#   jobs/cargo-test.sh                  the first tier
#   jobs/cargo-test.sh --ignored        the second tier, the slow tests, alone
#   jobs/cargo-test.sh --tenth          a tenth of the second tier but for the room `validation`, which takes
#                                       hours; the hash of the commit chooses it (WHIPPLE_TENTH=1…10 does
#                                       so by hand)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tier=${1:-first}
build=(--locked --workspace)
log=target/test.log
# Tests of the second tier that no tenth may have: those that take minutes by themselves, and cases at their own spacings.
too_long='a_kill_at_any_call|contact_lab|validation|of_many_makes|a_thousand|to_their_ends|recipes_are|of_ones_own'

# The tenth of this commit.
tenth() {
    local commit
    commit=$(git rev-parse HEAD 2>/dev/null || echo 0)
    echo "${WHIPPLE_TENTH:-$((16#${commit:0:7} % 10 + 1))}"
}

# Of the tests on standard input, one a line, those of the tenth $1.
share() {
    grep -vE "$too_long" | sort | awk -v tenth="$1" 'NR % 10 == tenth % 10' || true
}

# Ranks of tests share one machine: no other way between them is looked for (.2 s a launch), and what
# is left of a launch that fails goes at once (1 s).
export OMPI_MCA_pml=${OMPI_MCA_pml:-ob1} OMPI_MCA_odls_base_sigkill_timeout=0

mkdir -p target
code=0
if cargo nextest --version >/dev/null 2>&1; then
    if [ "$tier" = --ignored ]; then
        cargo nextest run "${build[@]}" --run-ignored only --final-status-level pass || code=$?
        exit "$code"
    fi
    if [ "$tier" = --tenth ]; then
        # Of each line the last word is the name of the test with its module.
        slow=$(cargo nextest list "${build[@]}" --run-ignored only -E 'not binary(validation)' \
            --message-format oneline | awk '{ print $NF }')
        chosen=$(share "$(tenth)" <<<"$slow" | sed 's/.*/test(=&)/' | paste -sd'|')
        printf 'Of the second tier, tenth %s:\n' "$(tenth)"
        cargo nextest run "${build[@]}" --run-ignored only -E "${chosen:-none()}" --no-tests pass ||
            code=$?
        exit "$code"
    fi
    # The one crate whose documentation has an example; nextest runs none.
    cargo test --locked -p whipple-numerics --doc
    cargo nextest run "${build[@]}" || code=$?
    exit "$code"
fi

# One slow test at a time: some tell times.
rest=()
case $tier in
    --ignored) rest=(--ignored --test-threads=1) ;;
    --tenth)
        for room in cli desk engine files fuzz mpi physics; do build+=(--test "$room"); done
        slow=$(cargo test "${build[@]}" -- --ignored --list 2>/dev/null | sed -n 's/: test$//p')
        mapfile -t chosen < <(share "$(tenth)" <<<"$slow")
        rest=(--ignored --test-threads=1 --exact "${chosen[@]:-none}")
        ;;
esac
cargo test "${build[@]}" --no-fail-fast -- "${rest[@]}" 2>&1 | tee "$log" || code=$?
awk '/^test .* \.\.\. FAILED$/ { failures = failures "\n  FAILED " $2 }
     /^test result:/ { binaries++; passed += $4; failed += $6; ignored += $8 }
     END { printf "\nSummary: %d test binaries, %d passed, %d failed, %d skipped%s\n",
           binaries, passed, failed, ignored, failures }' "$log"
exit "$code"
