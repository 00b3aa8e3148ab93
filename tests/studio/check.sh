#!/usr/bin/env bash
# The studio's page in Chromium and in Firefox, as a person uses it: builds the program, serves folders with the sample vest,
# and acts on them. The browsers come from Debian (root installs what is missing), what drives them from npm, into target/studio.
#
#     tests/studio/check.sh [TEST...]     files of this folder, all without one
#
# TOILE_BIN is the program, built anew without one; BROWSERS the browsers, "chromium firefox" without any; PAGE=studio/page takes
# the page's scripts and styles from that folder, not from the program, so that they can be edited without building it.
set -euo pipefail
cd "$(dirname "$0")/../.."

if [ -z "${TOILE_BIN:-}" ]; then
    cargo build --release --locked -p toile
    TOILE_BIN="${CARGO_TARGET_DIR:-target}/release/toile"
fi
TOILE_BIN="$(realpath "$TOILE_BIN")"
tools="${STUDIO_TOOLS:-target/studio}"
mkdir -p "$tools"
# Later versions ask Firefox for what it does not know yet.
if [ ! -d "$tools/node_modules/axe-core" ] || ! grep -qs '"version": "1\.61\.' "$tools/node_modules/playwright-core/package.json"; then
    npm install --silent --no-save --no-fund --no-audit --prefix "$tools" playwright-core@1.61 axe-core@4
fi
STUDIO_TOOLS="$(realpath "$tools")"
export TOILE_BIN STUDIO_TOOLS

installed() {
    command -v "$1" > /dev/null || apt-get install -y --no-install-recommends "${@:2}" > /dev/null 2>&1
}

tests=("$@")
[ ${#tests[@]} -gt 0 ] || tests=(tests/studio/*.test.mjs)
# One file after the other: each has a program and a browser of its own.
for browser in ${BROWSERS:-chromium firefox}; do
    echo "== $browser"
    case "$browser" in
        chromium)
            installed chromium chromium
            CHROMIUM="$(command -v chromium)" node --test --test-concurrency=1 "${tests[@]}"
            ;;
        firefox)
            if ! installed firefox-esr firefox-esr || ! installed xvfb-run xvfb xauth; then
                echo "skipped: Firefox cannot be installed"
                continue
            fi
            # It has 3D without a graphics card on a screen, not without one.
            FIREFOX="$(command -v firefox-esr)" LIBGL_ALWAYS_SOFTWARE=1 \
                xvfb-run -a -s "-screen 0 1400x900x24" node --test --test-concurrency=1 "${tests[@]}"
            ;;
        *)
            echo "no such browser: $browser"
            exit 2
            ;;
    esac
done
