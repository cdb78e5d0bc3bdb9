# shellcheck shell=bash
# Sourced, never run: the environment in which whipple is built, tested and launched.
# Whatever the caller has set already stays.

whipple_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# Rust as rustup leaves it, for shells that never read a profile (CI, batch systems).
if ! command -v cargo >/dev/null && [ -x "$HOME/.cargo/bin/cargo" ]; then
    PATH=$HOME/.cargo/bin:$PATH
fi

# WHIPPLE_MPI=mpich takes MPICH where Debian has it beside Open MPI: its wrapper and launcher, by scripts that come first on
# the path, its HDF5, and a folder of its own for what is built.
case ${WHIPPLE_MPI:-} in
    '' | openmpi) ;;
    mpich)
        whipple_scripts=$whipple_root/target/mpich/bin
        if command -v mpirun.mpich >/dev/null; then
            mkdir -p "$whipple_scripts"
            # Not links: the launcher looks for its own programs where its name leads.
            for whipple_name in mpicc mpirun mpiexec; do
                [ ! -x "$whipple_scripts/$whipple_name" ] || continue
                whipple_new=$(mktemp "$whipple_scripts/XXXXXX")
                printf '#!/bin/sh\nexec %s "$@"\n' "$(command -v "$whipple_name.mpich")" >"$whipple_new"
                chmod 755 "$whipple_new"
                mv "$whipple_new" "$whipple_scripts/$whipple_name"
            done
            case :$PATH: in
                *":$whipple_scripts:"*) ;;
                *) PATH=$whipple_scripts:$PATH ;;
            esac
            export MPICC=$whipple_scripts/mpicc
        fi
        export WHIPPLE_MPI CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$whipple_root/target/mpich}
        ;;
    *) echo "error: WHIPPLE_MPI is openmpi or mpich, not $WHIPPLE_MPI" >&2 ;;
esac

# Open MPI binds each of one or two ranks to a single core, which all threads of the rank would
# then share; it refuses more ranks than cores; and an idle rank spins: 4 ranks on 2 cores take
# 17.5 ms a step that way and 1.3 ms with these three. Batch jobs pin instead (jobs/run.sh).
export OMPI_MCA_hwloc_base_binding_policy=${OMPI_MCA_hwloc_base_binding_policy-none}
export OMPI_MCA_rmaps_base_oversubscribe=${OMPI_MCA_rmaps_base_oversubscribe-1}
export OMPI_MCA_mpi_yield_when_idle=${OMPI_MCA_mpi_yield_when_idle-1}
# No essay of mpirun's own after an exit code that is not zero: `--quiet`, which 5 refuses.
export OMPI_MCA_orte_execute_quiet=${OMPI_MCA_orte_execute_quiet-1}
# Open MPI 5 (Debian 13) launches through PRRTE, which has its own names for the first two.
export PRTE_MCA_hwloc_default_binding_policy=${PRTE_MCA_hwloc_default_binding_policy-none}
export PRTE_MCA_rmaps_default_mapping_policy=${PRTE_MCA_rmaps_default_mapping_policy-:oversubscribe}

# Containers run as root, which Open MPI refuses unless told twice.
if [ "$(id -u)" = 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi

# Parallel HDF5. The build takes $HDF5_DIR, else what `pkg-config hdf5` names, else a serial
# library, which it then refuses. So HDF5_DIR is set wherever pkg-config does not lead to the
# right one: to a folder of links to Debian's flavour for the MPI, or to a module's folder.

# Whether an include folder belongs to a parallel HDF5.
whipple_parallel_hdf5() {
    grep -qsE '^#define H5_HAVE_PARALLEL 1' "$1"/H5pubconf*.h
}

# whipple_pkg_folder I|L PACKAGE: the first include or library folder that pkg-config names.
whipple_pkg_folder() {
    { pkg-config "--cflags-only-I" "--libs-only-L" "$2" 2>/dev/null || true; } |
        tr ' ' '\n' | sed -n "s/^-$1//p" | head -n 1
}

# Sets HDF5_DIR where the build needs it; fails when there is no parallel HDF5.
whipple_find_hdf5() {
    local flavour=${WHIPPLE_MPI:-openmpi} plain flavoured dir wrapper
    local links=$whipple_root/target/hdf5
    [ "$flavour" = openmpi ] || links=$links-$flavour
    case ${HDF5_DIR:-} in "$whipple_root"/target/hdf5*) unset HDF5_DIR ;; esac
    if [ -n "${HDF5_DIR:-}" ]; then
        whipple_parallel_hdf5 "$HDF5_DIR/include"
        return
    fi
    plain=$(whipple_pkg_folder I hdf5)
    flavoured=$(whipple_pkg_folder I "hdf5-$flavour")
    if [ -n "$flavoured" ]; then
        [ "$plain" != "$flavoured" ] || return 0
        # Another HDF5 is Debian's default, and this one's headers and library lie apart.
        mkdir -p "$links"
        ln -sfn "$flavoured" "$links/include"
        ln -sfn "$(whipple_pkg_folder L "hdf5-$flavour")" "$links/lib"
        export HDF5_DIR=$links
        return 0
    fi
    if whipple_parallel_hdf5 "$plain"; then return 0; fi
    # Modules of clusters: their own variables, or the folder above the compiler wrapper.
    wrapper=$(command -v h5pcc || true)
    for dir in "${HDF5_ROOT:-}" "${HDF5_HOME:-}" "${EBROOTHDF5:-}" "${wrapper%/bin/h5pcc}"; do
        if [ -n "$dir" ] && whipple_parallel_hdf5 "$dir/include"; then
            export HDF5_DIR=$dir
            export LD_LIBRARY_PATH=$dir/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
            return 0
        fi
    done
    return 1
}
whipple_find_hdf5 || true
