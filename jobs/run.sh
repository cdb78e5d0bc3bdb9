#!/usr/bin/env bash
#SBATCH --job-name=whipple
#SBATCH --nodes=1
#SBATCH --ntasks-per-node=4
#SBATCH --cpus-per-task=8
#SBATCH --time=04:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --ignore-pbs
#PBS -N whipple
#PBS -l select=1:ncpus=32:mpiprocs=4:ompthreads=8
#PBS -l walltime=04:00:00
# Runs a case on several ranks, here or as a batch job.
#
#   jobs/run.sh [-n RANKS] [-t THREADS] CASE [options of whipple run]
#   jobs/run.sh [-n RANKS] [-t THREADS] restart RUN [options of whipple restart]
#   sbatch jobs/run.sh CASE …            ranks and threads are the allocation's
#   qsub -v WHIPPLE_ARGS="CASE …" jobs/run.sh       words without commas; else WHIPPLE_ARGS=@FILE
#
# On Lustre WHIPPLE_STRIPES=N spreads each file of a new run over N servers (-1: all), in pieces of
# WHIPPLE_STRIPE_SIZE (as 4M) if that is set; give output.alignment the same size.
#
# On a workstation: two ranks, and the cores shared out among them as threads. Ctrl-C, TERM, or
# the scheduler's USR1 stop the run softly: it writes a checkpoint and exits with 75, and
# `jobs/run.sh restart RUN` goes on from there. A second Ctrl-C kills it.
set -euo pipefail

# Schedulers run a copy of this script from their spool folder.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ -f "$root/jobs/env.sh" ] || root=${SLURM_SUBMIT_DIR:-${PBS_O_WORKDIR:-$PWD}}
source "$root/jobs/env.sh"
source "$root/jobs/arguments.sh"

usage() { sed -n '/^#   jobs/s/^#  //p' "$root/jobs/run.sh" >&2; exit 2; }

ranks='' threads=''
# PBS passes no arguments, only variables.
if [ $# = 0 ]; then
    whipple_arguments
    set -- "${words[@]}"
fi
while getopts n:t: option; do
    case $option in
        n) ranks=$OPTARG ;;
        t) threads=$OPTARG ;;
        *) usage ;;
    esac
    whipple_count "$option" "$OPTARG"
done
shift $((OPTIND - 1))
[ $# -gt 0 ] || usage
command=run
if [ "$1" = restart ]; then command=restart; shift; fi
[ $# -gt 0 ] || usage

# Pinned to its own cores where a scheduler gave them; unbound beside other work elsewhere.
placement=() batch=''
if [ -n "${SLURM_JOB_ID:-}${PBS_JOBID:-}" ]; then
    unset OMPI_MCA_hwloc_base_binding_policy OMPI_MCA_rmaps_base_oversubscribe \
        OMPI_MCA_mpi_yield_when_idle PRTE_MCA_hwloc_default_binding_policy \
        PRTE_MCA_rmaps_default_mapping_policy
    [ -n "$ranks" ] || ranks=${SLURM_NTASKS:-$(wc -l <"${PBS_NODEFILE:-/dev/null}")}
    threads=${threads:-${SLURM_CPUS_PER_TASK:-${OMP_NUM_THREADS:-1}}}
    batch=1
fi
[ "${ranks:-0}" != 0 ] || ranks=2
if [ -z "$threads" ]; then
    threads=$(($(nproc) / ranks))
    [ "$threads" -ge 1 ] || threads=1
fi

program=${WHIPPLE_PROGRAM:-${CARGO_TARGET_DIR:-$root/target}/release/whipple}
# From a package these scripts stand beside no Makefile, and the program is on the path.
if [ ! -x "$program" ] && [ ! -f "$root/Makefile" ]; then
    program=$(command -v whipple)
fi
if [ ! -x "$program" ]; then
    make -C "$root" release
fi
if [ -n "$batch" ]; then
    case $("$program" --version 2>/dev/null || true) in
        *MPICH*) placement=(-bind-to "core:$threads") ;;
        *) placement=(--map-by "slot:PE=$threads" --bind-to core) ;;
    esac
fi

# The folder of a new run's results, as the program chooses it.
results() {
    local case=$1 name
    shift
    while [ $# -gt 0 ]; do
        case $1 in
            -o | --out) printf '%s' "${2:-}"; return ;;
            --out=*) printf '%s' "${1#--out=}"; return ;;
            -o?*) printf '%s' "${1#-o}"; return ;;
        esac
        shift
    done
    name=$(basename "${case%/}")
    [ -d "$case" ] || name=${name%.*}
    # Of case.toml the folder.
    if [ "$name" = case ] && [ "$(dirname "$case")" != . ]; then
        name=$(basename "$(dirname "$case")")
    fi
    printf 'runs/%s' "$name"
}

# On Lustre a file lies on one server unless its folder says otherwise, and what is made in a folder
# inherits that. A restart into the same folder finds it so.
if [ "$command" = run ] && [ -n "${WHIPPLE_STRIPES:-}" ]; then
    folder=$(results "$@")
    mkdir -p "$folder"
    lfs setstripe -c "$WHIPPLE_STRIPES" ${WHIPPLE_STRIPE_SIZE:+-S "$WHIPPLE_STRIPE_SIZE"} "$folder" || {
        echo "error: WHIPPLE_STRIPES=$WHIPPLE_STRIPES is set, but lfs cannot stripe $folder" >&2
        exit 2
    }
fi

# mpirun answers TERM and INT by killing its ranks within two seconds, but passes USR1 on to
# them, which asks for a soft stop. While it starts up it may drop the signal, hence the repeats.
job='' caught='' interrupted='' repeats=''
# shellcheck disable=SC2317  # the traps call these
repeat() { while sleep 10 && kill -USR1 "$job"; do :; done; }
# shellcheck disable=SC2317
stop() {
    caught=1
    if [ "$1" = interrupt ] && [ -n "$interrupted" ]; then
        kill -TERM "$job" || true
        return
    fi
    [ "$1" != interrupt ] || interrupted=1
    [ -z "$repeats" ] || return 0
    echo "stopping after this step, with a checkpoint; a second Ctrl-C kills the run" >&2
    kill -USR1 "$job" || true
    repeat >/dev/null 2>&1 &
    repeats=$!
}
trap 'stop interrupt' INT
trap 'stop softly' TERM USR1 HUP

# A process group of its own (set -m), so that a terminal's Ctrl-C reaches this script alone.
set -m
mpirun -n "$ranks" "${placement[@]}" \
    "$program" "$command" "$@" --threads "$threads" </dev/null &
job=$!
set +m

# A signal ends `wait` early, so wait again until it returns mpirun's own code.
while :; do
    caught=''
    code=0
    wait "$job" || code=$?
    [ -n "$caught" ] || break
done
[ -z "$repeats" ] || kill "$repeats" 2>/dev/null || true
# mpirun says nothing when a rank is killed.
if [ "$code" -gt 128 ]; then
    echo "a rank was ended by signal $((code - 128)) (9: out of memory, or killed by somebody); what" \
        "the run wrote is whole, and 'jobs/run.sh restart RUN' goes on from its last checkpoint" >&2
fi
exit "$code"
