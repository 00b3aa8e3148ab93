#!/bin/sh
# What a scene leaves out costs nothing: instructions of a solve without body and without self-contact, against builds of the
# engine that do not have that code (toile_without="body", toile_without="self_contact"). One thread; needs valgrind.
#
#     tests/costs/left_out.sh [CELLS]          from the root of the repository; default 24
#
# Exit code 1 where a part that is left out costs more than 2 %, or where the answers differ.
set -eu
cells=${1:-24}
most=1.02
dir=$(cargo metadata --no-deps --format-version 1 | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')/left_out
mkdir -p "$dir"

# A wrapper hands the cut to the crates of the workspace alone, so that the dependencies are built once for all variants.
build() {
    wrapper="$dir/rustc-$1.sh"
    cut=""
    # What only the part that is cut out uses is no fault.
    [ "$1" = full ] || cut="--cfg 'toile_without=\"$1\"' --cap-lints allow"
    printf '#!/bin/sh\nexec "$@" %s\n' "$cut" > "$wrapper.new"
    chmod +x "$wrapper.new"
    cmp -s "$wrapper.new" "$wrapper" || mv "$wrapper.new" "$wrapper"
    rm -f "$wrapper.new"
    RUSTC_WORKSPACE_WRAPPER="$wrapper" cargo build --quiet --release -p toile-cloth --example left_out --target-dir "$dir/build"
    cp "$dir/build/release/examples/left_out" "$dir/$1"
}

# Instructions of a run; its answer goes to $dir/NAME.txt.
count() {
    RAYON_NUM_THREADS=1 valgrind --tool=callgrind --callgrind-out-file="$dir/$1.callgrind" "$dir/$1" "$cells" \
        > "$dir/$1.txt" 2> "$dir/$1.log"
    sed -n 's/.*Collected : \([0-9]*\).*/\1/p' "$dir/$1.log"
}

for part in full body self_contact; do
    build "$part"
done
full=$(count full)
echo "all parts:            $full instructions; $(cat "$dir/full.txt")"
failed=0
for part in body self_contact; do
    without=$(count "$part")
    ratio=$(awk "BEGIN { printf \"%.4f\", $full / $without }")
    echo "without $part: $without instructions; with it, but left out by the scene: x$ratio"
    cmp -s "$dir/full.txt" "$dir/$part.txt" || { echo "without $part: another answer: $(cat "$dir/$part.txt")"; failed=1; }
    awk "BEGIN { exit !($ratio > $most) }" && failed=1
done
exit $failed
