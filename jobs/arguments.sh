# shellcheck shell=bash
# Sourced, never run: the arguments of a job script, from where they cannot be passed as such.

# whipple_arguments: sets `words` to those of $WHIPPLE_ARGS, which stands in for arguments under PBS.
# Words are parted by blanks and taken as they stand: no quotes, no patterns. PBS itself parts the
# variables of `qsub -v` at commas, so words with commas or blanks come from a file with one argument
# a line, as WHIPPLE_ARGS=@FILE.
whipple_arguments() {
    words=()
    # PBS starts jobs in the user's home.
    if [ -n "${PBS_O_WORKDIR:-}" ]; then cd "$PBS_O_WORKDIR" || exit 2; fi
    case ${WHIPPLE_ARGS:-} in
        @*)
            if [ ! -f "${WHIPPLE_ARGS#@}" ]; then
                printf 'error: WHIPPLE_ARGS names no file of arguments: %q\n' "${WHIPPLE_ARGS#@}" >&2
                exit 2
            fi
            mapfile -t words <"${WHIPPLE_ARGS#@}"
            ;;
        *) read -r -d '' -a words <<<"${WHIPPLE_ARGS:-}" || true ;;
    esac
}

# whipple_count OPTION VALUE: ends the script unless VALUE is a whole number from 1 on.
whipple_count() {
    if [[ ! $2 =~ ^[1-9][0-9]{0,6}$ ]]; then
        printf 'error: -%s takes a whole number from 1 on, not %q\n' "$1" "$2" >&2
        exit 2
    fi
}
