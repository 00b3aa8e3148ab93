#!/usr/bin/env bash
# Builds the wheel, installs it in a fresh environment, and runs there all its tests, the slow ones too, and the checks of its
# types and lints.
#
#     python/check.sh [ARGUMENTS OF PYTEST]
set -euo pipefail
cd "$(dirname "$0")"

most_bytes=$((25 * 1000 * 1000))
rm -rf target/wheels target/fresh
python3 -m venv target/fresh
target/fresh/bin/pip install --quiet 'maturin>=1.9,<2'
PATH="$PWD/target/fresh/bin:$PATH" maturin build --release --locked --compression-level 9 --out target/wheels
wheel="$(ls target/wheels/*.whl)"
bytes="$(stat -c %s "$wheel")"
echo "$wheel: $bytes bytes"
test "$bytes" -le "$most_bytes"
target/fresh/bin/pip install --quiet "$wheel[test]"
target/fresh/bin/mypy --strict package/toile
target/fresh/bin/pytest -m '' "$@"
cargo fmt -- --check
PYO3_BUILD_EXTENSION_MODULE=1 cargo clippy --release --locked -- -D warnings
