#!/usr/bin/env bash
# The Python wheel: builds it with maturin (dev profile, as the tests), installs it into a virtual environment under target/tmp, and
# runs its tests there: pytest, the snippets of the book and of its README, the tutorial, and the type stubs.
#
# Needs python3 from 3.11 on with venv, and PyPI the first time. Where they cannot be had it says so and is skipped;
# HEXFILL_PYTHON=require makes that a failure, HEXFILL_PYTHON=skip skips.
set -euo pipefail
cd "$(dirname "$0")/.."

# Pinned, so that a new release cannot break the build.
packages=(maturin==1.16.0 numpy==2.4.6 pyvista==0.49.1 meshio==5.3.5 tqdm==4.70.1 pytest==9.2.0 nbclient==0.11.0
    ipykernel==7.4.0 mypy==2.4.1)
wish=${HEXFILL_PYTHON:-}
home=$PWD/${CARGO_TARGET_DIR:-target}/tmp/python-wheel
bin=$home/venv/bin

skip() {
    if [ "$wish" = require ]; then
        echo "python wheel: $*, and HEXFILL_PYTHON=require" >&2
        exit 1
    fi
    echo "skipped: $*"
    exit 0
}

[ "$wish" = skip ] && skip "HEXFILL_PYTHON=skip"
command -v python3 >/dev/null || skip "there is no python3"
python3 -c 'import sys, venv; sys.exit(sys.version_info < (3, 11))' || skip "python3 is older than 3.11 or has no venv"
mkdir -p "$home"
if [ "$(cat "$home/installed.txt" 2>/dev/null)" != "${packages[*]}" ]; then
    rm -f "$home/installed.txt"
    python3 -m venv --clear "$home/venv" || skip "no virtual environment could be made"
    "$bin/python" -m pip install --quiet --disable-pip-version-check "${packages[@]}" || skip "PyPI gave no packages"
    echo "${packages[*]}" >"$home/installed.txt"
fi

rm -rf "$home/wheels"
"$bin/maturin" build --quiet --manifest-path python/Cargo.toml --profile dev --locked --out "$home/wheels"
"$bin/python" -m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps "$home"/wheels/*.whl
# From the folder of the tests, so that the package is the installed one, not the sources.
cd python/tests
"$bin/pytest"
"$bin/mypy" --config-file ../pyproject.toml --cache-dir "$home/mypy" -p hexfill
# The stubs of the compiled half name what it has, with its arguments; panic_for_test exists in this profile only.
printf 'hexfill._native.%s\n' panic_for_test __all__ >"$home/allowed.txt"
"$bin/stubtest" --mypy-config-file ../pyproject.toml --allowlist "$home/allowed.txt" --concise hexfill._native
