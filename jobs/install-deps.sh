#!/usr/bin/env bash
# Installs what the build needs beside Rust and a C compiler: Open MPI (MPICH with WHIPPLE_MPI=mpich), parallel HDF5, libclang
# (for the bindings) and, with --tests, Python's venv, OpenGL without a display and a headless Chromium. Silent
# and quick when all of it is there. MPICH comes beside Open MPI: where both are installed, mpicc and mpirun stay Debian's
# choice, which is Open MPI.
#
#   jobs/install-deps.sh [--tests]
#
# Uses apt as root or through sudo; where it may not, prints the command and exits with 2. On a
# cluster, load the modules first: their mpicc, HDF5 and libclang count.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source jobs/env.sh

want_tests=
case "${1:-}" in
    --tests) want_tests=1 ;;
    '') ;;
    *) echo "usage: jobs/install-deps.sh [--tests]" >&2; exit 2 ;;
esac

have_libclang() {
    if [ -n "${LIBCLANG_PATH:-}" ]; then
        [ -f "$LIBCLANG_PATH" ] || compgen -G "$LIBCLANG_PATH/libclang*.so*" >/dev/null
        return
    fi
    compgen -G '/usr/lib/llvm-*/lib/libclang*.so*' >/dev/null ||
        compgen -G '/usr/lib*/libclang*.so*' >/dev/null ||
        compgen -G "$(llvm-config --libdir 2>/dev/null || echo /nowhere)/libclang*.so*" >/dev/null
}

# What VTK draws with where there is no display; only the tests of Python clients need it.
have_opengl() {
    [ "${WHIPPLE_SKIP_CLIENTS:-}" = 1 ] ||
        python3 -c 'import ctypes; ctypes.CDLL("libEGL.so.1")' 2>/dev/null
}

# The browser that the tests of `whipple report` drive.
have_chromium() {
    local program
    [ "${WHIPPLE_SKIP_CLIENTS:-}" != 1 ] || return 0
    for program in chromium-headless-shell chromium chromium-browser google-chrome; do
        if command -v "$program" >/dev/null; then return 0; fi
    done
    return 1
}

# What lacks, one line each.
lacking() {
    command -v cc >/dev/null || echo "a C compiler (cc)"
    if [ "${WHIPPLE_MPI:-}" = mpich ]; then
        { command -v mpicc.mpich && command -v mpirun.mpich; } >/dev/null || echo "MPICH (mpicc.mpich, mpirun.mpich)"
    else
        { command -v mpicc && command -v mpirun; } >/dev/null || echo "Open MPI (mpicc, mpirun)"
    fi
    command -v pkg-config >/dev/null || [ -n "${HDF5_DIR:-}" ] || echo "pkg-config"
    whipple_find_hdf5 || echo "HDF5 built for MPI (pkg-config hdf5-${WHIPPLE_MPI:-openmpi}, h5pcc or HDF5_DIR)"
    have_libclang || echo "libclang (LIBCLANG_PATH may name its folder)"
    [ -z "$want_tests" ] || python3 -c 'import venv, ensurepip' 2>/dev/null ||
        echo "Python 3 with venv (for the tests)"
    [ -z "$want_tests" ] || have_opengl ||
        echo "OpenGL without a display, libEGL (for the tests)"
    [ -z "$want_tests" ] || have_chromium || echo "Chromium (for the tests)"
}

mapfile -t missing < <(lacking)
if ! command -v cargo >/dev/null; then
    echo "whipple is built with Rust; install it from https://rustup.rs, then run this again" >&2
    exit 2
fi
[ ${#missing[@]} -gt 0 ] || exit 0

echo "whipple needs, and this machine lacks:"
printf '  %s\n' "${missing[@]}"

packages=(build-essential libclang-dev pkg-config)
if [ "${WHIPPLE_MPI:-}" = mpich ]; then
    packages+=(mpich libmpich-dev libhdf5-mpich-dev)
else
    packages+=(openmpi-bin libopenmpi-dev libhdf5-openmpi-dev)
fi
chromium=chromium-headless-shell
if grep -qs '^ID=ubuntu' /etc/os-release; then chromium=chromium-browser; fi
[ -z "$want_tests" ] || packages+=(python3-venv libegl1 libgl1-mesa-dri "$chromium")
install=(install -y --no-install-recommends "${packages[@]}")

on_cluster=
if [ -n "${MODULESHOME:-}${LMOD_CMD:-}" ] && [ "$(id -u)" != 0 ]; then on_cluster=1; fi
if [ -n "$on_cluster" ] || ! command -v apt-get >/dev/null; then
    echo "load modules that bring them (such as: module load openmpi hdf5 llvm python), or install" >&2
    echo "the like of Debian's: ${packages[*]}" >&2
    exit 2
fi
if [ "$(id -u)" = 0 ]; then
    as_root=()
elif sudo -n true 2>/dev/null || { command -v sudo >/dev/null && [ -t 0 ]; }; then
    as_root=(sudo)
else
    echo "install them as root with" >&2
    echo "  apt-get update && apt-get ${install[*]}" >&2
    exit 2
fi

# Mirrors fail now and then, and another apt may hold the lock on a machine that just started.
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive
    apt-get -q -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300)
for attempt in 1 2 3; do
    if "${apt[@]}" update && "${apt[@]}" "${install[@]}"; then
        # What has come since.
        source jobs/env.sh
        break
    fi
    if [ "$attempt" = 3 ]; then
        echo "apt failed three times; the command was: apt-get update && apt-get ${install[*]}" >&2
        exit 1
    fi
    sleep $((10 * attempt))
done

mapfile -t missing < <(lacking)
if [ ${#missing[@]} -gt 0 ]; then
    echo "still lacking after the installation:" >&2
    printf '  %s\n' "${missing[@]}" >&2
    exit 1
fi
