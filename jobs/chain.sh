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
# Runs a case to its end in as many legs as it takes: starts RUN if it is not there, else restarts
# it from its newest checkpoint, until RUN/status.json says finished.
#
#   jobs/chain.sh [-n RANKS] [-t THREADS] CASE RUN [options of whipple run, such as --walltime 1h]
#   sbatch jobs/chain.sh CASE RUN …      each job is one leg and submits the next
#   qsub -v WHIPPLE_ARGS="CASE RUN …" jobs/chain.sh       or WHIPPLE_ARGS=@FILE, as for run.sh
#
# A job script that ends in a call of this one names itself in WHIPPLE_JOB (whipple plan --job writes
# such scripts): the next job is then that script again, with its own headers.
#
# A leg ends softly when the scheduler's time is nearly up (USR1) or at --walltime; the chain then
# goes on. Ctrl-C, TERM (scancel --batch --signal=TERM JOB) and a file RUN/stop end the leg softly
# and the chain with it (75). A plain scancel signals mpirun too, which kills its ranks. A run that
# failed, or a leg without a new checkpoint, ends the chain as well: going on would repeat it.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ -f "$root/jobs/run.sh" ] || root=${SLURM_SUBMIT_DIR:-${PBS_O_WORKDIR:-$PWD}}

source "$root/jobs/arguments.sh"
if [ $# = 0 ]; then
    whipple_arguments
    set -- "${words[@]}"
fi
arguments=("$@")
launch=()
while getopts n:t: option; do
    case $option in
        n | t)
            whipple_count "$option" "$OPTARG"
            launch+=("-$option" "$OPTARG")
            ;;
        *) sed -n '/^#   jobs/s/^#  //p' "$root/jobs/chain.sh" >&2; exit 2 ;;
    esac
done
shift $((OPTIND - 1))
if [ $# -lt 2 ]; then sed -n '/^#   jobs/s/^#  //p' "$root/jobs/chain.sh" >&2; exit 2; fi
case=$1 run=$2
shift 2

# What this job was given, beyond the headers above, the next one is to have too.
same_job=()
if [ -n "${SLURM_JOB_ID:-}" ]; then
    same_job=(--job-name="$SLURM_JOB_NAME" --partition="$SLURM_JOB_PARTITION"
        --nodes="$SLURM_JOB_NUM_NODES" --ntasks="$SLURM_NTASKS"
        --time="$(squeue --noheader --jobs="$SLURM_JOB_ID" --format=%l)")
    # One that was not asked for has no variable.
    while read -r option value; do
        [ -z "$value" ] || same_job+=("--$option=$value")
    done <<END
ntasks-per-node ${SLURM_NTASKS_PER_NODE:-}
cpus-per-task ${SLURM_CPUS_PER_TASK:-}
account ${SLURM_JOB_ACCOUNT:-}
qos ${SLURM_JOB_QOS:-}
mem ${SLURM_MEM_PER_NODE:-}
mem-per-cpu ${SLURM_MEM_PER_CPU:-}
END
fi

# finished, stopped or failed; nothing before the first leg, and after the machine went down.
status() { grep -oEsm1 '"(finished|stopped|failed)"' "$run/status.json" | tr -d '"' || true; }
# By name, which is the step; one that is being written is called *.partial, and the one of the same
# step that it takes the place of *.old.
newest_checkpoint() {
    { compgen -G "$run/checkpoints/step-*[0-9]" || compgen -G "$run/checkpoints/step-*.old" || true; } |
        sed '/damaged/d' | sort | tail -n 1
}

# Of the options, those that a restart takes: what else was set is in the checkpoint.
first=("$@")
again=()
while [ $# -gt 0 ]; do
    option=$1
    case $option in
        -s | --set)
            option="--set=${2:-}"
            shift
            ;;
        -s*) option="--set=${option#-s}" ;;
    esac
    shift
    case $option in
        --set=run.* | --set=output.* | --set=domain.* | --set=trouble.*) again+=("$option") ;;
        --set=*) ;;
        *) again+=("$option") ;;
    esac
done

# Runs a leg and passes signals on to it; `caught` is the last one.
leg=''
caught=''
trap 'caught=USR1; kill -TERM "$leg" 2>/dev/null || true' USR1
trap 'caught=TERM; kill -TERM "$leg" 2>/dev/null || true' TERM INT
run_leg() {
    local before
    "$root/jobs/run.sh" "${launch[@]}" "$@" &
    leg=$!
    while :; do
        before=$caught
        code=0
        wait "$leg" || code=$?
        [ "$before" != "$caught" ] || break
    done
}

while [ "$(status)" != finished ]; do
    checkpoint=$(newest_checkpoint)
    if [ -n "$checkpoint" ]; then
        run_leg restart "$run" "${again[@]}"
    elif [ -e "$run/status.json" ]; then
        echo "$run has no checkpoint to restart from; remove it to start anew" >&2
        exit 1
    else
        run_leg "$case" --out "$run" "${first[@]}"
    fi
    [ "$code" = 0 ] || [ "$code" = 75 ] || exit "$code"
    [ "$(status)" != failed ] || exit 1
    [ "$(status)" != finished ] || break
    if [ "$caught" = TERM ] || [ -e "$run/stop" ]; then exit 75; fi
    if [ "$(newest_checkpoint)" = "$checkpoint" ]; then
        echo "no new checkpoint since the last leg: the chain ends" >&2
        exit 1
    fi
    if [ -n "${SLURM_JOB_ID:-}" ]; then
        next=("$root/jobs/chain.sh" "${arguments[@]}")
        [ -z "${WHIPPLE_JOB:-}" ] || next=("$WHIPPLE_JOB")
        exec sbatch "${same_job[@]}" "${next[@]}"
    elif [ -n "${PBS_JOBID:-}" ]; then
        [ -z "${WHIPPLE_JOB:-}" ] || exec qsub "$WHIPPLE_JOB"
        # Whatever they hold, they reach the next job as they are.
        list=$(realpath "$run")/chain.arguments
        case $list in
            *[,\\\"\']*)
                echo "PBS cannot pass the name $list, for its commas or quotes: the chain ends" >&2
                exit 1
                ;;
        esac
        printf '%s\n' "${arguments[@]}" >"$list"
        exec qsub -v WHIPPLE_ARGS="@$list" "$root/jobs/chain.sh"
    fi
done
echo "$run is finished"
