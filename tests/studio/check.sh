#!/usr/bin/env bash
# The studio's page in a browser, as a person uses it: builds the program, serves folders with the sample vest, and acts on
# them. The browser comes from Debian (root installs it where it is missing), what drives it from npm, into target/studio.
#
#     tests/studio/check.sh [TEST...]     files of this folder, all without one
#
# TOILE_BIN is the program, built anew without one; CHROMIUM the browser, /usr/bin/chromium without one.
set -euo pipefail
cd "$(dirname "$0")/../.."

if [ -z "${TOILE_BIN:-}" ]; then
    cargo build --release --locked -p toile
    TOILE_BIN="${CARGO_TARGET_DIR:-target}/release/toile"
fi
TOILE_BIN="$(realpath "$TOILE_BIN")"
CHROMIUM="${CHROMIUM:-/usr/bin/chromium}"
if [ ! -x "$CHROMIUM" ]; then
    apt-get install -y --no-install-recommends chromium > /dev/null
fi
tools="${STUDIO_TOOLS:-target/studio}"
mkdir -p "$tools"
if [ ! -d "$tools/node_modules/axe-core" ] || [ ! -d "$tools/node_modules/playwright-core" ]; then
    npm install --silent --no-save --no-fund --no-audit --prefix "$tools" playwright-core@1 axe-core@4
fi
STUDIO_TOOLS="$(realpath "$tools")"
export TOILE_BIN CHROMIUM STUDIO_TOOLS

tests=("$@")
[ ${#tests[@]} -gt 0 ] || tests=(tests/studio/*.test.mjs)
# One file after the other: each has a program and a browser of its own.
node --test --test-concurrency=1 "${tests[@]}"
