#!/bin/sh
# Type-checks and tests the viewer, builds it again from the locked packages and compares it with the committed bundle.
# Needs node and npm; installs the locked packages if they are missing. Exit code 1 if the bundle is out of date.
set -eu
cd "$(dirname "$0")"
[ -d node_modules ] || npm ci --no-audit --no-fund
npm run --silent check
node test.mjs
fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
node build.mjs "$fresh/viewer.js"
if cmp "$fresh/viewer.js" dist/viewer.js; then
  echo "dist/viewer.js is up to date ($(wc -c < dist/viewer.js) bytes)"
else
  echo "dist/viewer.js differs from its sources: run 'npm run build' in $(pwd) and commit it" >&2
  exit 1
fi
