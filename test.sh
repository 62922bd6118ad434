#!/usr/bin/env bash
# All tests: formatting, lints as errors, tests, documentation with broken links denied, licences, the viewer's bundle, and
# the Python wheel, the README's main command. Needs cargo and python3; node and npm for the viewer's bundle, PyPI for the wheel's
# tests (skipped, with a word, without).
set -euo pipefail
cd "$(dirname "$0")"

step() { printf '\n== %s\n' "$*"; }

# What cannot be run is skipped with a word; with HEXFILL_ALL=require that is a failure.
skipped() {
    if [ "${HEXFILL_ALL:-}" = require ]; then
        echo "$*, and HEXFILL_ALL=require" >&2
        exit 1
    fi
    echo "skipped: $*"
}

step "formatting"
cargo fmt --all --check

step "lints"
cargo clippy --workspace --all-targets --locked -- -D warnings

step "tests"
cargo test --workspace --locked

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

step "licences"
cargo metadata --format-version 1 --locked | python3 tests/licences.py

step "viewer bundle"
if command -v npm >/dev/null; then
    sh crates/hexfill-view/viewer/check-bundle.sh
else
    skipped "npm is not installed"
fi

step "MPI driver"
if command -v mpirun >/dev/null && command -v mpicc >/dev/null; then
    CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/target} cargo test --manifest-path crates/hexfill-mpi/Cargo.toml --locked
else
    skipped "MPI is not installed (apt-get install -y mpich libmpich-dev libclang-dev)"
fi

step "python wheel"
tests/python.sh

step "the README's main command"
python3 tests/readme.py

step "files as people have them"
# With the packages that the tests of the readers installed.
python=${CARGO_TARGET_DIR:-target}/tmp/foreign-venv/bin/python
if [ -x "$python" ]; then
    "$python" tests/ordinary_files.py "${CARGO_TARGET_DIR:-target}/debug/hexfill" --out target/ordinary-files
else
    skipped "meshio and Gmsh are not installed"
fi

step "hostile surfaces"
# The program as the tests built it: alone it would be built again, with the features of its own dependencies.
python3 tests/hostile.py "${CARGO_TARGET_DIR:-target}/debug/hexfill" --quick --count 44 --out target/hostile
