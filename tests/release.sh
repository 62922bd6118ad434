#!/usr/bin/env bash
# Makes a release: checks that the tree is clean, on main and of one version, runs all tests, builds the program, the Python wheel, man
# pages and completions, and packs them with checksums into target/release-VERSION/. Nothing leaves the machine.
#
#     tests/release.sh [--dry-run] [--skip-tests]
#
# --dry-run     checks, says everything that stands in the way and what would be made, and makes nothing
# --skip-tests  for a tree that ./test.sh has passed already
#
# Needs cargo, git, python3 with venv (and PyPI the first time) and strip; exit code 1 if something stands in the way.
set -euo pipefail
cd "$(dirname "$0")/.."

dry=false tests=true
for flag in "$@"; do
    case $flag in
    --dry-run) dry=true ;;
    --skip-tests) tests=false ;;
    *)
        sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2
        exit 2
        ;;
    esac
done

step() { printf '\n== %s\n' "$*"; }

wrong=0
# Something that stands in the way.
bad() {
    echo "not ready: $*" >&2
    wrong=1
}

step "tree"
branch=$(git rev-parse --abbrev-ref HEAD)
[ "$branch" = main ] || bad "the branch is $branch, not main"
[ -z "$(git status --porcelain)" ] || bad "the tree is not clean; see git status"
commit=$(git rev-parse --short HEAD)
echo "$branch at $commit"

step "versions"
# The version of the first manifest; every other place has to have the same.
version=$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)
echo "Cargo.toml: $version"
while read -r name its; do
    [ "$its" = "$version" ] || bad "$name has version $its"
done < <(cargo metadata --format-version 1 --no-deps --locked | python3 -c '
import json, sys
for p in json.load(sys.stdin)["packages"]:
    print(p["name"], p["version"])')
grep -qx "version = \"$version\"" crates/hexfill-mpi/Cargo.toml || bad "crates/hexfill-mpi/Cargo.toml has another version"
grep -qx 'dynamic = \["version"\]' python/pyproject.toml || bad "python/pyproject.toml does not take its version from Cargo"
grep -qx "version: $version" CITATION.cff || bad "CITATION.cff has another version"
grep -q "^## $version\b" CHANGELOG.md || bad "CHANGELOG.md has no heading '## $version (DATE)'"
[ -z "$(git tag --list "v$version" 2>/dev/null)" ] || bad "there is a tag v$version already"

target=${CARGO_TARGET_DIR:-target}
host=$(rustc -vV | sed -n 's/^host: //p')
out=$target/release-$version
name=hexfill-$version-$host
if $dry; then
    step "would make"
    $tests && echo "all tests: ./test.sh"
    printf '%s\n' "$out/$name.tar.gz" "$out/hexfill-$version-*.whl" "$out/SHA256SUMS"
    exit $wrong
fi
[ $wrong = 0 ] || exit 1

if $tests; then
    step "tests"
    HEXFILL_ALL=require HEXFILL_PYTHON=require ./test.sh
fi

step "program"
cargo build --release --locked -p hexfill-cli
rm -rf "$out"
tree=$out/$name
mkdir -p "$tree/bin" "$tree/share/man/man1" "$tree/share/bash-completion/completions" \
    "$tree/share/zsh/site-functions" "$tree/share/fish/vendor_completions.d"
strip -o "$tree/bin/hexfill" "$target/release/hexfill"
hexfill=$tree/bin/hexfill
[ "$("$hexfill" --version | head -1)" = "hexfill $version" ] || { echo "the program says $("$hexfill" --version)" >&2; exit 1; }
"$hexfill" fill :cube -o "$out/smoke.vtk" --quiet && "$hexfill" check "$out/smoke.vtk" --surface :cube >/dev/null
rm "$out/smoke.vtk"

step "man pages and completions"
"$hexfill" man >"$tree/share/man/man1/hexfill.1"
for command in $("$hexfill" --help | sed -n '/^Commands:/,/^Options:/s/^  \([a-z][a-z-]*\) .*/\1/p'); do
    [ "$command" = help ] || "$hexfill" man "$command" >"$tree/share/man/man1/hexfill-$command.1"
done
"$hexfill" completions bash >"$tree/share/bash-completion/completions/hexfill"
"$hexfill" completions zsh >"$tree/share/zsh/site-functions/_hexfill"
"$hexfill" completions fish >"$tree/share/fish/vendor_completions.d/hexfill.fish"
cp README.md CHANGELOG.md CITATION.cff LICENSE-APACHE LICENSE-MIT "$tree"
ls "$tree/share/man/man1"

step "python wheel"
# The version that the tests use.
maturin=$(grep -o 'maturin==[0-9.]*' tests/python.sh)
venv=$target/tmp/release-venv
[ -x "$venv/bin/maturin" ] || { python3 -m venv "$venv" && "$venv/bin/python" -m pip install --quiet "$maturin"; }
"$venv/bin/maturin" build --quiet --manifest-path python/Cargo.toml --release --locked --strip --out "$out"

step "archive"
# The same bytes from the same files: sorted, of the time of the commit, of nobody.
tar --directory "$out" --sort=name --mtime="@$(git log -1 --format=%ct)" --owner=0 --group=0 --numeric-owner \
    --create "$name" | gzip --no-name -9 >"$out/$name.tar.gz"
rm -r "$tree"
(cd "$out" && sha256sum -- *.tar.gz *.whl >SHA256SUMS && cat SHA256SUMS)
printf '\n%s holds the release of %s; tag it with: git tag v%s %s\n' "$out" "$version" "$version" "$commit"
