#!/usr/bin/env bash
# Every crate builds by itself: in a build of the whole workspace the features that one crate asks of another are there for all.
#
#     tests/each_crate_alone.sh [CRATE...]     all members of the workspace, and plugins that are workspaces of their own, without names
set -euo pipefail
cd "$(dirname "$0")/.."

failed=()
check() {
    echo "$1"
    cargo check --quiet --release "${@:2}" || failed+=("$1")
}

members() {
    cargo metadata --no-deps --format-version 1 --offline |
        grep -o '"name":"[^"]*","version":"[^"]*","id":' | cut -d '"' -f 4 | sort -u
}

if [ $# -gt 0 ]; then
    for crate in "$@"; do check "$crate" -p "$crate"; done
else
    for crate in $(members); do check "$crate" -p "$crate"; done
    for manifest in plugins/*/Cargo.toml; do
        ! grep -q '^\[workspace\]' "$manifest" || check "$manifest" --manifest-path "$manifest"
    done
fi

if [ ${#failed[@]} -gt 0 ]; then
    echo "do not build alone: ${failed[*]}"
    exit 1
fi
