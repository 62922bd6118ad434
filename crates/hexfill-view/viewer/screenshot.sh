#!/bin/sh
# Looks at the viewer in headless Chromium: writes the demonstration pages, exercises them and saves pictures.
# Usage: screenshot.sh [FOLDER]   (default: target/view-shots). Needs cargo, node and chromium; exit code 1 on any failure.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
shots=$(realpath -m "${1:-$here/../../../target/view-shots}")
mkdir -p "$shots"
(cd "$here/../../.." && cargo run --quiet -p hexfill-view --example view_demo -- "$shots")
drive() {
  page=$1 name=$2
  shift 2
  node "$here/drive.mjs" "$shots/$page.html" --shot "$shots/view-$name.png" "$@"
}
drive ball exercised --exercise
drive refinement refinement --exercise
drive broken broken
drive empty empty
drive ball start
drive ball cut --hash 'cut=0.5&shrink=0.85'
drive ball xray --hash 'singular=inside&boundary=xray&chord=all' --dark
drive ball-plain sheets --hash 'sheet=all&sheetAs=surface&boundary=glass&cut=0.5'
drive groups groups --exercise
drive pair pair --pair --size 1400x800
drive grid-plain build --hash 'shown=40&shrink=0.9' --dark
drive grid narrow --size 420x860
drive ball still --no-webgl
