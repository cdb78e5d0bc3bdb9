#!/usr/bin/env bash
# Runs the tests and ends with what ran: with cargo-nextest where it is installed, else with
# plain cargo and a summary of our own. `make test` calls it in the environment of jobs/env.sh. The
# feature lets tests put faults into the program (src/run/fault.rs), which a user's has not.
#
#   jobs/cargo-test.sh [--ignored]      --ignored: only the slow tests
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=(--locked --features fault-injection)
if cargo nextest --version >/dev/null 2>&1; then
    if [ "${1:-}" = --ignored ]; then
        exec cargo nextest run "${build[@]}" --run-ignored only
    fi
    cargo test "${build[@]}" --doc
    exec cargo nextest run "${build[@]}"
fi

log=target/test.log
code=0
cargo test "${build[@]}" --no-fail-fast -- "$@" 2>&1 | tee "$log" || code=$?
awk '/^test .* \.\.\. FAILED$/ { failures = failures "\n  FAILED " $2 }
     /^test result:/ { binaries++; passed += $4; failed += $6; ignored += $8 }
     END { printf "\nSummary: %d test binaries, %d passed, %d failed, %d skipped%s\n",
           binaries, passed, failed, ignored, failures }' "$log"
exit "$code"
